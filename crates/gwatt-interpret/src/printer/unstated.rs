//! Macros of the machine, of which nothing is known, and what they leave unstated.

use super::state::Unstated;
use crate::code::Motion;
use crate::control::{Control, Run};
use crate::knob::KnobState;
use crate::places::EXTRUDER;
use gwatt_machine::{ALL_AXES, ExtruderMode};
use gwatt_motion::Square;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// A macro of which only the machine knows what it does: it may move anywhere, heat, and
    /// leave another feed, other modes and the limits of the machine file.
    pub(super) fn unknown_macro(&mut self, run: &mut Run<'_, '_>, span: Span) {
        // Its own moves may run under the limits that it sets.
        run.facts.turns_knob = true;
        let factors = &mut self.printer;
        factors.feed_factor = factors.feed_factor.max(1.0);
        factors.flow = factors.flow.max(1.0);
        self.limits_at_least(&KnobState::new(self.machine));
        self.may_heat(run, span);
        self.unknown_moves(run, span);
        self.modal.feed = None;
        self.modal.motion = Motion::None;
        self.printer.unstated = Unstated::of(true, true);
        self.settle();
        let name = String::from_utf8_lossy(span.of(run.report.text)).into_owned();
        let message = format!(
            "what {name} sets only the machine knows: until the program sets them after it, limits \
             count as the machine file gives them, or as before where that is more; a file \
             {name}.gcode in the program's folder says what it does"
        );
        run.report.note_once("macro-settings", &message, span);
    }

    /// Limits that are those in force or these: the higher ones count.
    pub(super) fn limits_at_least(&mut self, other: &KnobState) {
        self.knobs.raise_to(self.machine, other);
        if let Some(own) = Square::of(self.machine) {
            let [now, other] = [&self.knobs, other].map(|knobs| knobs.square.unwrap_or(own));
            self.take_square(Some(now.or_faster(other)).filter(|square| *square != own));
        }
        self.settle();
    }

    /// G90 or G91.
    pub(crate) fn distance_stated(&mut self) {
        let follows = ExtruderMode::Follows;
        let unstated = &mut self.printer.unstated;
        unstated.distance = false;
        unstated.extruder &= self.machine.controller.language.printer.extruder_mode != follows;
        self.extruder_mode(None);
        self.settle();
    }

    /// M82 or M83.
    pub(crate) fn extruder_stated(&mut self, absolute: bool) {
        self.printer.unstated.extruder = false;
        self.extruder_mode(Some(absolute));
        self.settle();
    }

    /// Reports words of axes of which nobody knows whether they are absolute; true if it did.
    #[cold]
    pub(crate) fn refuses_unstated(&mut self, run: &mut Run<'_, '_>) -> bool {
        let mode = self.machine.controller.language.printer.extruder_mode;
        let unstated = self.printer.unstated;
        let words: arrayvec::ArrayVec<_, { gwatt_machine::AXES }> = run.words.axes().collect();
        for (axis, _) in words {
            let missing = if axis != EXTRUDER || mode == ExtruderMode::Either {
                unstated.distance.then_some("G90 or G91")
            } else {
                None
            };
            let own = unstated.extruder && (mode != ExtruderMode::Either || self.modal.absolute);
            let missing = missing.or((axis == EXTRUDER && own).then_some("M82 or M83"));
            let Some(missing) = missing else { continue };
            let letter = ALL_AXES[axis].letter();
            let message = format!(
                "whether {} is absolute is not known after a macro of the machine",
                char::from(letter)
            );
            let help = format!(
                "write {missing} after the macro, or the macro's commands into a file of its name; \
                 if it leaves feed and modes as they are, list it in `unknown_moves` under \
                 [language] of the machine file"
            );
            let span = run.words.span(letter, run.block);
            run.report.error("unstated-mode", message, span).help(help);
            // Once is enough.
            self.printer.unstated = Unstated::default();
            self.settle();
            return true;
        }
        false
    }

    /// Whether a macro has left modes that are not stated yet.
    #[inline]
    pub(crate) fn has_unstated(&self) -> bool {
        self.printer.adjusts && self.printer.unstated.any()
    }
}
