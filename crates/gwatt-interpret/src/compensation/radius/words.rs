//! The radius that G41 and G42 take.

use crate::code::GCode;
use crate::compensation::words::Nose;
use crate::control::{Control, Run};
use crate::tools::OFFSETS_OF_T;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// The edge by the words and tables of controls other than LinuxCNC's.
    /// Without any table its radius is taken as 0, as lengths are.
    pub(in crate::compensation) fn nose_by_offset(
        &mut self,
        run: &mut Run<'_, '_>,
        span: Span,
    ) -> Option<Nose> {
        if self.rules.tool_edges {
            return self.nose_of_edge(run, span);
        }
        let number = if self.dialect().lathe.is_some() {
            run.words.take(b'D');
            let tool = self.tools.selected;
            if tool < OFFSETS_OF_T {
                tool
            } else {
                tool % OFFSETS_OF_T
            }
        } else {
            self.offset_number(run)?
        };
        if number == 0 {
            return Some(Nose::POINT);
        }
        let known = self.tools.find(number).is_some();
        let (radius_mm, orientation) = self.tool_edge(Some(number)).unwrap_or_default();
        if known && !(self.tools.unknown() && radius_mm == 0.0) {
            let lathe = self.dialect().lathe.is_some();
            let orientation = if lathe { orientation } else { 0 };
            return Some(Nose {
                radius_mm,
                orientation,
            });
        }
        self.radius_not_known(number, span, run)
    }

    /// The radius of the cutter that the words of the block choose.
    pub(crate) fn cutter_radius_mm(&mut self, run: &mut Run<'_, '_>, span: Span) -> Option<f64> {
        Some(self.nose_by_offset(run, span)?.radius_mm)
    }

    /// D, or H where no tool length takes it (parameter 5001 bit OFH); without
    /// them the last one.
    fn offset_number(&mut self, run: &mut Run<'_, '_>) -> Option<u32> {
        let length = GCode::ToolLength(crate::tools::ToolLength::On).group();
        let letter = if !run.words.has(b'D') && run.words.groups & length == 0 {
            b'H'
        } else {
            b'D'
        };
        let Some(value) = run.words.take(letter) else {
            return Some(self.choice.number.unwrap_or(0));
        };
        let at = run.words.span(letter, run.block);
        let number = crate::tools::words::tool_number(value, at, run)?;
        self.choice.number = Some(number);
        Some(number)
    }

    /// SINUMERIK ("Selection of the tool radius compensation"): `$TC_DP6` of
    /// the program, else the table's tool, which has one edge.
    fn nose_of_edge(&self, run: &mut Run<'_, '_>, span: Span) -> Option<Nose> {
        let edge = self.choice.number.unwrap_or(1);
        if edge == 0 {
            return Some(Nose::POINT);
        }
        if let Some(radius_mm) = self.choice.radius_mm {
            return Some(Nose {
                radius_mm,
                orientation: 0,
            });
        }
        let tool = Some(self.tools.loaded).filter(|tool| *tool != 0);
        let tool = tool.unwrap_or(self.tools.selected);
        if self.tools.unknown() || tool == 0 {
            return self.radius_not_known(tool, span, run);
        }
        if edge != 1 {
            let message = format!("the table has one edge of a tool, and D{edge} is another");
            run.report
                .error("tool-radius", message, span)
                .help("set its radius in the program: $TC_DP6[…]");
            return None;
        }
        match self.tool_edge(Some(tool)) {
            Some((radius_mm, _)) => Some(Nose {
                radius_mm,
                orientation: 0,
            }),
            None => self.radius_not_known(tool, span, run),
        }
    }

    /// Without a tool table the radius is taken as 0, with a note.
    fn radius_not_known(&self, number: u32, span: Span, run: &mut Run<'_, '_>) -> Option<Nose> {
        if self.tools.unknown() || number == 0 {
            let message = "without a tool table the radius of G41 and G42 is taken as 0: \
                           the tool's centre runs on the programmed path";
            run.report.note_once("no-tool-radius", message, span);
            return Some(Nose::POINT);
        }
        let message = format!("the radius of G41 and G42, number {number}, is not known");
        run.report
            .error("tool-radius", message, span)
            .help("add it to the table of --tool-table: T, D for the diameter, on lathes Q");
        None
    }
}
