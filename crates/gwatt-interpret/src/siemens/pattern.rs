//! Patterns of holes ("Row of holes (HOLES1)", "Circle of holes (HOLES2)"): at
//! each place the cycle that MCALL has set.

use super::cycle_call::{Call, Kind};
use super::frame_words::at_angle;
use super::{Called, PatternAt, Siemens};
use crate::control::{Control, Run};
use crate::jump::{Siemens as Go, Transfer};
use gwatt_motion::MoveKind;

/// Holes of one pattern.
const HOLES_MAX: f64 = 10_000.0;

impl Control<'_> {
    pub(super) fn hole_pattern(&mut self, state: &mut Siemens, call: &Call, run: &mut Run<'_, '_>) {
        let unit = self.modal.mm_per_unit;
        let value = |place| call.value(place).unwrap_or(0.0);
        let count = value(6);
        let [first, second, _] = self.modal.plane;
        let depth = state.scopes.len();
        let modal = match &state.modal_call {
            Some(modal) if modal.depth == depth => Some(modal.what.clone()),
            _ => None,
        };
        if !(1.0..=HOLES_MAX).contains(&count) || count.fract() != 0.0 {
            run.report
                .error(
                    "cycle",
                    "a pattern of fewer than 1 or more than 10000 holes",
                    call.span,
                )
                .help("write the number of holes as sixth argument");
            return;
        }
        let from = [value(1) * unit, value(2) * unit];
        let hole = |number: f64| -> [f64; 2] {
            let [along, across] = if call.kind == Kind::Row {
                // SPCA, SPCO, STA1, FDIS, DBH, NUM
                at_angle((value(4) + number * value(5)) * unit, value(3))
            } else {
                // CPA, CPO, RAD, STA1, INDA, NUM
                let step = match value(5) {
                    0.0 => 360.0 / count,
                    step => step,
                };
                at_angle(value(3) * unit, value(4) + number * step)
            };
            [from[0] + along, from[1] + across]
        };
        // A row begins at the end that is nearer.
        let here = state.program_place(&self.position.at);
        let distance = |[x, y]: [f64; 2]| libm::hypot(x - here[first], y - here[second]);
        let nearer = distance(hole(count - 1.0)) < distance(hole(0.0));
        let begun = state.pattern.take().filter(|begun| begun.depth == depth);
        let backwards = begun.map_or(call.kind == Kind::Row && nearer, |begun| begun.backwards);
        let errors = run.report.diagnostics.errors;
        for number in begun.map_or(0, |begun| begun.next)..count as u32 {
            let next = number + 1;
            let number = f64::from(number);
            let [along, across] = hole(if backwards {
                count - 1.0 - number
            } else {
                number
            });
            let target = self.target_at(state, &[(first, along), (second, across)]);
            self.siemens_go(state, run, MoveKind::Rapid, &target, None);
            match &modal {
                Some(Called::Cycle(cycle)) if !cycle.is_pattern() => self.cycle(state, cycle, run),
                Some(Called::Cycle(_)) => {
                    run.report
                        .error("cycle", "a pattern of patterns of holes", call.span)
                        .help("set the cycle of a hole by MCALL");
                }
                Some(Called::Program { name, arguments }) => {
                    // The rest comes when the subprogram has returned to here.
                    let again = f64::from(next) < count;
                    state.pattern = again.then_some(PatternAt {
                        depth,
                        next,
                        backwards,
                    });
                    state.pending.clone_from(arguments);
                    self.transfer = Some(Transfer::Siemens(Go::Call {
                        name: name.clone(),
                        times: 1,
                        again,
                    }));
                    return;
                }
                None => {}
            }
            if run.report.diagnostics.errors != errors {
                return;
            }
        }
    }
}
