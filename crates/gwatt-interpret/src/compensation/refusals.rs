//! What may not be written while compensation is on.
//!
//! LinuxCNC stops at each of these ("Cannot … with cutter radius compensation
//! on"), except at a change of units, G92.1 to G92.3 and words that the
//! interpreter does not follow there; those are refused here. Other controls
//! stop at fewer, and end the compensation for a while at some of them (Fanuc:
//! G28, G92), which is not followed.

use crate::code::GCode;
use crate::control::{Control, Run};
use crate::rules::ToolLengths;
use gwatt_syntax::source::Span;

/// G70 of `LinuxCNC` (number × 10).
const FINISHING: u16 = 700;

impl Control<'_> {
    /// Words that come before the compensation in the order of execution.
    pub(super) fn refuse_before(&self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.g.len() {
            let (code, _, span) = run.words.g[index];
            match code {
                GCode::Plane(plane) if plane != self.modal.plane => {
                    refuse("another plane", span, run);
                }
                GCode::Units { mm_per_unit } if mm_per_unit != self.modal.mm_per_unit => {
                    refuse("another unit", span, run);
                }
                _ => {}
            }
        }
        let switches = run.words.groups & GCode::CompensationOff.group() != 0;
        if self.rules.offset_numbers_stay && run.words.has(b'D') && !switches {
            let span = run.words.span(b'D', run.block);
            refuse("another radius", span, run);
        }
        for index in 0..run.words.m.len() {
            let (number, span) = run.words.m[index];
            if let Some(what) = m_name(number)
                && (number == 60 || self.rules.strict_compensation)
            {
                refuse(what, span, run);
            }
        }
        for index in 0..run.words.knobs.len() {
            let (_, _, span) = run.words.knobs[index];
            refuse("a change of limits", span, run);
        }
    }

    /// Whether other controls than LinuxCNC read a G word (number × 10) under
    /// compensation as elsewhere: path modes, lengths along the normal axis,
    /// the level that cycles return to, exact stop.
    fn permits(&self, number: u16) -> bool {
        let normal = self.modal.plane[2] == 2;
        match number {
            610 | 611 | 640 | 980 | 990 => !self.rules.strict_compensation,
            430 | 440 | 490 => normal && self.rules.tool_lengths == ToolLengths::Offsets,
            _ => false,
        }
    }

    /// Words that come after it.
    pub(super) fn refuse_behind(&self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            // The finishing pass runs along its contour as any other path.
            if code == GCode::LatheCycle(FINISHING) {
                continue;
            }
            if number == 100 && self.rules.strict_compensation && !sets_offsets(run) {
                continue;
            }
            if self.permits(number) {
                continue;
            }
            if let Some(what) = g_name(number) {
                refuse(what, span, run);
            }
        }
    }
}

/// Whether a G10 changes a coordinate system; its other forms are permitted.
fn sets_offsets(run: &Run<'_, '_>) -> bool {
    run.words
        .word(b'L', run.block)
        .is_none_or(|word| word.value == 2.0 || word.value == 20.0)
}

/// The name of a G word (number × 10) that is refused.
fn g_name(number: u16) -> Option<&'static str> {
    Some(match number {
        50..=53 => "a spline",
        100 | 540..=593 => "another coordinate system",
        280 | 300 | 740 | 750 => "a reference point",
        281 | 301 => "setting a reference point",
        330..=332 => "thread cutting",
        380..=389 => "probing",
        430..=439 | 490 => "another tool length offset",
        520 | 920..=923 => "an offset of the axes",
        530 | 1530 => "G53",
        500 | 501 | 510 | 511 => "scaling or mirroring",
        120 | 130 | 1500 => "a pocket",
        610 | 611 | 640 => "another path mode",
        680..=692 => "a rotation of the coordinates",
        700..=799 | 810..=899 => "a canned cycle",
        980 | 990 => "another retract mode",
        _ => return None,
    })
}

/// The name of an M word (number × 10) that is refused.
fn m_name(number: u16) -> Option<&'static str> {
    Some(match number {
        60 | 610 => "a tool change",
        480..=530 => "a change of override",
        620..=689 => "input and output",
        _ => return None,
    })
}

fn refuse(what: &str, span: Span, run: &mut Run<'_, '_>) {
    let message = format!("{what} under cutter compensation: the controller stops here");
    run.report
        .error("compensation", message, span)
        .help("switch the compensation off before: G40");
}
