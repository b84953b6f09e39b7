//! Analog outputs that act on the motion (`LinuxCNC`, "M67", "M68"), where the machine file
//! says that they are wired: M68 sets one, and M66 waits until it acts.

use super::control::{Control, Run};
use gwatt_machine::KnobTarget;
use gwatt_motion::Step;
use gwatt_syntax::source::Span;

/// What is said where moves are held back meanwhile, and what helps.
const COMPENSATED: (&str, &str) = (
    "the acceleration changes under cutter compensation",
    "set it before G41 or G42, or after G40 and the move after that",
);

impl Control<'_> {
    /// M66 to M68 of such an output; false where it is another one, and the word means what
    /// it always does.
    pub(super) fn output_knob(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) -> bool {
        if number == 660 {
            return self.let_output_act(span, run);
        }
        let knobs = &self.machine.controller.knobs;
        let wanted = run.words.word(b'E', run.block).map(|word| word.value);
        let Some(which) = knobs.iter().position(|knob| {
            let output = knob.output().map(f64::from);
            output.is_some() && output == wanted
        }) else {
            return false;
        };
        run.words.take(b'E');
        let value = run.words.take(b'Q');
        run.facts.turns_knob = true;
        if knobs.get(which).map(|knob| knob.target) == Some(KnobTarget::SpeedShare) {
            self.set_speed_share(number, value, span, run);
            return true;
        }
        let refused = if number == 670 {
            Some((
                "M67 changes the acceleration of blocks that are planned already or not, whichever \
                 the control has come to",
                "write M68, and M66 P0 L0 after it",
            ))
        } else if self.compensation.is_some() {
            Some(COMPENSATED)
        } else if !value.is_some_and(|value| value > 0.0 && value <= 1.0) {
            Some((
                "the share of the acceleration is not from above 0 to 1",
                "1 is the machine's own acceleration; see [outputs] of the machine file",
            ))
        } else {
            None
        };
        if let Some((message, help)) = refused {
            run.report.error("knob-value", message, span).help(help);
            return true;
        }
        self.knobs.pending = value.map(|value| (which, value));
        true
    }

    /// M66 after M68: the axes have stopped, and what it sets acts from here on.
    fn let_output_act(&mut self, span: Span, run: &mut Run<'_, '_>) -> bool {
        let Some((which, value)) = self.knobs.pending.take() else {
            return false;
        };
        let Some(knob) = self.machine.controller.knobs.get(which) else {
            return false;
        };
        for letter in [b'P', b'E', b'L', b'Q'] {
            run.words.take(letter);
        }
        run.facts.turns_knob = true;
        self.input = None;
        if self.compensation.is_some() {
            let (message, help) = COMPENSATED;
            run.report.error("knob-value", message, span).help(help);
            return true;
        }
        self.knobs
            .turn(self.machine, knob, None, value, self.modal.mm_per_unit);
        self.dwell(run, knob.change_s);
        true
    }

    /// A block that moves between the two: whether it has the acceleration before or after
    /// is not known.
    #[inline]
    pub(super) fn refuse_too_early(&self, run: &mut Run<'_, '_>, before: usize) {
        if self.knobs.pending.is_none() {
            return;
        }
        let steps = run.steps.get(before..).unwrap_or_default();
        if steps.iter().any(Step::moves_axes) {
            let span = run.whole();
            run.report
                .error(
                    "knob-value",
                    "whether the acceleration that M68 has set holds for this move is not known",
                    span,
                )
                .help("write M66 P0 L0 after M68: it waits until the acceleration is in force");
        }
    }
}
