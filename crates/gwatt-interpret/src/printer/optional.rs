//! Parts of a program that the machine may leave out, as a condition of its own decides:
//! Bambu Lab's M622 to M623.

use super::state::Before;
use super::state::Unstated;
use crate::code::Motion;
use crate::control::{Control, Run};
use gwatt_motion::ActionKind;
use gwatt_syntax::source::Span;

/// Parts within parts.
const DEPTH_MAX: usize = 16;

impl Control<'_> {
    /// The part begins.
    pub(super) fn begin_optional(&mut self, run: &mut Run<'_, '_>, span: Span) {
        if self.printer.optional.len() >= DEPTH_MAX {
            let message =
                format!("more than {DEPTH_MAX} parts that may be left out in one another");
            run.report
                .error("optional-part", message, span)
                .help("end the parts with M623 before others begin");
            return;
        }
        let message = "the part from M622 to M623 may be left out by the machine: what holds after \
                       it counts both ways, and its first and next moves from anywhere";
        run.report.note_once("optional-part", message, span);
        let before = Before::new(&self.printer, &self.modal, &self.knobs, self.loads.on());
        self.printer.optional.push(before);
        self.at_full_speed(run, self.machine.axis_set);
        run.act(ActionKind::MayStop, 0.0);
    }

    /// The part ends: which of its words have acted is not known.
    pub(super) fn end_optional(&mut self, run: &mut Run<'_, '_>, span: Span) {
        let Some(before) = self.printer.optional.pop() else {
            run.report
                .error("optional-part", "M623 without an M622 before it", span)
                .help("write M622 before it, or take it out");
            return;
        };
        if self.modal.mm_per_unit != before.mm_per_unit {
            run.report
                .error(
                    "optional-part",
                    "the unit changes in a part that may be left out",
                    span,
                )
                .help("write G20 or G21 before M622, and none between it and M623");
            return;
        }
        run.facts.turns_knob = true;
        if self.modal.feed != before.feed {
            self.modal.feed = None;
        }
        if self.modal.motion != before.motion {
            self.modal.motion = Motion::None;
        }
        let distance = self.modal.absolute != before.absolute;
        let extruder = self.printer.extruder_absolute != before.extruder_absolute;
        self.loads.switch_on(before.loads);
        let state = &mut self.printer;
        state.unstated = state
            .unstated
            .or(before.unstated)
            .or(Unstated::of(distance, extruder));
        state.feed_factor = state.feed_factor.max(before.feed_factor);
        state.flow = state.flow.max(before.flow);
        state.maybe_lit |= before.maybe_lit;
        for (lit, before) in state.lit.iter_mut().zip(before.lit) {
            *lit |= before;
        }
        if state.tool != before.tool {
            // The next T changes it, whichever it names.
            state.tool = u32::MAX;
        }
        self.limits_at_least(&before.knobs);
        self.at_full_speed(run, self.machine.axis_set);
        run.act(ActionKind::MayStop, 0.0);
    }
}
