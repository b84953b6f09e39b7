//! Words that choose, change and measure tools.

use super::{LENGTH_AXIS, OFFSETS_OF_T, ToolLength};
use crate::code::GCode;
use crate::control::{Control, Run};
use crate::rules::ToolLengths;
use crate::tool_table::Tool;
use gwatt_machine::{ALL_AXES, AXES, AxisValues};
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// T: the tool must be in the table, where there is one (RS274/NGC; the
    /// others also have numbers of offsets and magazines in it).
    pub(crate) fn select_tool(&mut self, number: f64, run: &mut Run<'_, '_>) {
        let span = run.words.span(b'T', run.block);
        if self.rules.tools_are_listed {
            let Some(number) = tool_number(number, span, run) else {
                return;
            };
            if !self.tools.unknown() && self.tools.find(number).is_none() {
                unknown_tool(number, span, run);
                return;
            }
            self.tools.select(number);
        } else if number >= 0.0 && number <= f64::from(u32::MAX) {
            self.tools.select(number as u32);
            if self.t_is_offset() {
                self.offset_of_lathe(run);
            }
        }
    }

    /// Whether T puts offsets in force: on lathes.
    pub(crate) fn t_is_offset(&self) -> bool {
        let dialect = self.dialect();
        self.rules.t_selects_offset && (dialect.lathe.is_some() || dialect.diameter)
    }

    /// Fanuc's and Okuma's lathes: the last two digits of T are the number of an offset, 0 of
    /// none ("Tool Offset"; OSP-P200L 5238-E, "T Function"). The axes stay; the coordinates of the program change, where a table
    /// gives the offsets.
    fn offset_of_lathe(&mut self, run: &mut Run<'_, '_>) {
        let number = self.tools.selected % OFFSETS_OF_T;
        let known = if number == 0 {
            Some(Tool::default())
        } else {
            self.tools.find(number).filter(|_| !self.tools.unknown())
        };
        self.tools.guessed = known.is_none().then_some(self.tools.selected);
        if known.is_none() && !self.tools.unknown() {
            let span = run.words.span(b'T', run.block);
            let message = "offsets of tools that the table does not have are taken as 0";
            run.report.note_once("no-tool-offset", message, span);
        }
        let tool = known.unwrap_or_default();
        let offset = self.tool_offsets_mm(&tool);
        if offset != self.position.offsets().tool {
            self.position.change(|offsets| offsets.tool = offset);
        }
    }

    /// M6, and M61 Q of `LinuxCNC`, which only says what is loaded.
    pub(crate) fn load_tool(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        self.forget_way_back();
        self.tools.changes = self.tools.changes.saturating_add(1);
        if number == 60 {
            self.tools.loaded = self.tools.selected;
            self.tools.loaded_told = self.tools.selected_told;
            return;
        }
        let Some(value) = run.words.take(b'Q') else {
            run.report
                .error("tool-number", "M61 without a tool", span)
                .help("write its number as Q");
            return;
        };
        let at = run.words.span(b'Q', run.block);
        let Some(tool) = tool_number(value, at, run) else {
            return;
        };
        if !self.tools.unknown() && self.tools.find(tool).is_none() {
            unknown_tool(tool, at, run);
            return;
        }
        self.tools.loaded = tool;
        self.tools.loaded_told = true;
    }

    /// G43 and similar words: the axes stay, the program coordinates change.
    pub(crate) fn tool_length(&mut self, form: ToolLength, span: Span, run: &mut Run<'_, '_>) {
        let lengths = self.rules.tool_lengths;
        if lengths == ToolLengths::Elsewhere {
            // These have their lengths elsewhere than in H.
            let number = run.words.take(b'H').unwrap_or(0.0);
            let message = "the tool length is taken as 0";
            run.report.note_once("no-tool-table", message, span);
            self.tools.guessed = (form != ToolLength::Off).then_some(number as u32);
            return;
        }
        self.note_length_alone(form, span, run);
        let offset = match form {
            ToolLength::Off => Some([0.0; AXES]),
            ToolLength::Given => self.given_length(span, run),
            ToolLength::On | ToolLength::Reversed | ToolLength::Added
                if lengths == ToolLengths::Table =>
            {
                self.length_of_h(form, span, run)
            }
            ToolLength::On | ToolLength::Reversed | ToolLength::Added => {
                let number = run.words.take(b'H');
                self.fanuc_length(form, number, span, run)
            }
        };
        match form {
            ToolLength::Off => {
                self.tools.length = None;
                self.tools.guessed = None;
            }
            ToolLength::Given => self.tools.guessed = None,
            ToolLength::On | ToolLength::Reversed | ToolLength::Added => {}
        }
        if let Some(offset) = offset {
            self.position.change(|offsets| offsets.tool = offset);
        }
    }

    /// Says that a length which changes without a place of its axis may move it: by the
    /// length, where the offset moves axes and does not shift coordinates (Fanuc B-63944EN, "Tool
    /// Length Offset", parameter 5006 bit TOS).
    fn note_length_alone(&mut self, form: ToolLength, span: Span, run: &mut Run<'_, '_>) {
        let moves = GCode::Reference.group() | GCode::MachineCoordinates.group();
        let changes = form != ToolLength::Off || self.tools.length.is_some();
        let said = run.words.g.iter().find_map(|(code, ..)| match code {
            GCode::Absolute(absolute) => Some(*absolute),
            _ => None,
        });
        let absolute = said.unwrap_or(self.modal.absolute);
        let placed = run.words.has(ALL_AXES[LENGTH_AXIS].letter()) && absolute;
        let elsewhere = self.rules.tool_lengths != ToolLengths::Offsets;
        if elsewhere || !changes || placed || run.words.groups & moves != 0 {
            return;
        }
        if run.words.has(ALL_AXES[LENGTH_AXIS].letter()) {
            // How far it goes is not known then.
            self.position.unknown.insert(LENGTH_AXIS);
            let message = "an increment next to a tool length that changes: the length may come on \
                           top of it, so that the move counts at its full speed; write the place \
                           instead, as in G90 G43 Z50. H1";
            run.report.note_once("length-alone", message, span);
            return;
        }
        let message = "where the offset moves the axis (Fanuc: parameter 5006 bit TOS = 0), a tool \
                       length without an absolute place of its axis moves it by the length: that is \
                       not counted; write the place with it, as in G90 G43 Z50. H1";
        run.report.note_once("length-alone", message, span);
    }

    /// H in a block of its own while G43 is in force (Fanuc).
    pub(crate) fn tool_length_again(&mut self, run: &mut Run<'_, '_>) {
        if self.rules.tool_lengths != ToolLengths::Offsets {
            return;
        }
        let Some((form, _)) = self.tools.length else {
            return;
        };
        let span = run.words.span(b'H', run.block);
        let number = run.words.take(b'H');
        if number.is_some()
            && let Some(offset) = self.fanuc_length(form, number, span, run)
        {
            self.position.change(|offsets| offsets.tool = offset);
        }
    }

    fn length_of_h(
        &mut self,
        form: ToolLength,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> Option<AxisValues> {
        let h = run.words.take(b'H');
        if h.is_none() && form == ToolLength::Added {
            run.report
                .error("tool-number", "G43.2 without a tool", span)
                .help("write its number as H");
            return None;
        }
        let at = if h.is_some() {
            run.words.span(b'H', run.block)
        } else {
            span
        };
        let number = match h {
            Some(value) => tool_number(value, at, run)?,
            None => self.tools.loaded,
        };
        // H0 is the tool in the spindle.
        let number = if number == 0 {
            self.tools.loaded
        } else {
            number
        };
        let guessed = self.tools.find(number).is_none() || self.tools.unknown();
        self.tools.guessed = guessed.then_some(number);
        let tool = self.known_tool(number, at, run)?;
        let mut offset = self.tool_offsets_mm(&tool);
        if form == ToolLength::Added {
            let before = self.position.offsets().tool;
            for (sum, before) in offset.iter_mut().zip(before) {
                *sum += before;
            }
        }
        Some(offset)
    }

    /// G43.1: the axis words are the offsets; those not named stay.
    fn given_length(&mut self, span: Span, run: &mut Run<'_, '_>) -> Option<AxisValues> {
        let has_motion = run.facts.motion_word.is_some();
        if has_motion || !run.words.has_axes() {
            run.report
                .error("tool-length", "G43.1 needs axis words, and no motion", span)
                .help("write it in a block of its own, as in G43.1 Z12.5");
            return None;
        }
        let mut offset = self.position.offsets().tool;
        let words: arrayvec::ArrayVec<_, AXES> = run.words.axes().collect();
        for (axis, value) in words {
            run.words.take(ALL_AXES[axis].letter());
            offset[axis] = self.length_mm(axis, value);
        }
        Some(offset)
    }

    /// Fanuc: H is the number of an offset along Z; H0 takes it back.
    fn fanuc_length(
        &mut self,
        form: ToolLength,
        number: Option<f64>,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> Option<AxisValues> {
        let number = match number {
            Some(value) => tool_number(value, span, run)?,
            None => self.tools.length.map_or(0, |(_, number)| number),
        };
        self.tools.length = Some((form, number));
        let guessed = number != 0 && self.tools.find(number).is_none();
        self.tools.guessed = guessed.then_some(number);
        let tool = if number == 0 {
            Tool::default()
        } else {
            self.known_tool(number, span, run)?
        };
        let mut offset = [0.0; AXES];
        let length = self.tool_offsets_mm(&tool)[LENGTH_AXIS];
        offset[LENGTH_AXIS] = if form == ToolLength::Reversed {
            -length
        } else {
            length
        };
        Some(offset)
    }

    /// A tool; without a table one of no length, with a note.
    pub(crate) fn known_tool(
        &self,
        number: u32,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> Option<Tool> {
        if let Some(tool) = self.tools.find(number)
            && !(number == 0 && self.tools.unknown())
        {
            return Some(tool);
        }
        if self.tools.unknown() {
            let message = "without a tool table the tool length is taken as 0";
            run.report.note_once("no-tool-table", message, span);
            let number = number.max(self.tools.loaded);
            return Some(Tool {
                number,
                ..Tool::default()
            });
        }
        unknown_tool(number, span, run);
        None
    }

    /// Radius in mm and orientation of a tool, or of the one in the spindle;
    /// `None` if they are not known.
    pub(crate) fn tool_edge(&self, number: Option<u32>) -> Option<(f64, u8)> {
        let number = number.filter(|number| *number != 0);
        let number = number.unwrap_or(self.tools.loaded);
        let tool = self.tools.find(number)?;
        let native = self.position.offsets().native(0);
        let known = number != 0 || !self.tools.unknown();
        known.then_some((tool.diameter / 2.0 * native, tool.orientation))
    }

    /// Offsets of a tool in mm (degrees).
    pub(crate) fn tool_offsets_mm(&self, tool: &Tool) -> AxisValues {
        let offsets = self.position.offsets();
        std::array::from_fn(|axis| tool.offsets[axis] * offsets.native(axis))
    }
}

/// The number of a tool; anything else is reported.
pub(crate) fn tool_number(value: f64, span: Span, run: &mut Run<'_, '_>) -> Option<u32> {
    let whole = (value + 0.5).floor();
    // LinuxCNC takes what is this near to a whole number for one.
    if (whole - value).abs() < 1e-4 && (0.0..=99_999_999.0).contains(&whole) {
        return Some(whole as u32);
    }
    run.report
        .error("tool-number", "this is no number of a tool", span)
        .help("write a whole number from 0");
    None
}

fn unknown_tool(number: u32, span: Span, run: &mut Run<'_, '_>) {
    run.report
        .error(
            "unknown-tool",
            format!("tool {number} is not in the tool table"),
            span,
        )
        .help("add it to the table of --tool-table, or check the number");
}
