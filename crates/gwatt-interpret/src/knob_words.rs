//! Words by which a program itself limits acceleration or rapid speed.

use super::control::{Control, Run};
use gwatt_machine::{KnobArgument, KnobTarget};

impl Control<'_> {
    /// Words by which the program itself limits acceleration or rapid speed.
    pub(super) fn turn_knobs(&mut self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.knobs.len() {
            let (which, assigned, span) = run.words.knobs[index];
            let Some(knob) = self.machine.controller.knobs.get(which) else {
                continue;
            };
            if knob.levels.is_some() {
                self.select_level(which, span, run);
                continue;
            }
            run.facts.turns_knob = true;
            let unit = self.modal.mm_per_unit;
            self.knobs.set_in(self.machine, unit);
            let mut turned = false;
            let mut fine = true;
            let valid = |value: f64| value.is_finite() && value > 0.0;
            match (&knob.argument, assigned) {
                (KnobArgument::Assign, Some(value)) if valid(value) => {
                    self.knobs.turn(self.machine, knob, None, value, unit);
                    turned = true;
                }
                (KnobArgument::Axes, None) => {
                    for (axis, value) in run.words.axes().collect::<arrayvec::ArrayVec<_, 10>>() {
                        run.words.take(gwatt_machine::ALL_AXES[axis].letter());
                        fine &= valid(value);
                        self.knobs.turn(self.machine, knob, Some(axis), value, unit);
                        turned = true;
                    }
                }
                (KnobArgument::Path(letters), None) => {
                    for letter in letters {
                        let Some(value) = run.words.take(*letter) else {
                            continue;
                        };
                        fine &= valid(value);
                        self.knobs.turn_path(*letter, value, unit);
                        turned = true;
                    }
                }
                _ => {}
            }
            if knob.target == KnobTarget::Speed {
                self.settle();
            }
            if !turned || !fine {
                let code = &knob.name;
                run.report
                    .error(
                        "knob-value",
                        format!("{code} needs values above 0 in the form that its profile states"),
                        span,
                    )
                    .help("see `argument` of this word in the controller profile");
            }
        }
    }
}
