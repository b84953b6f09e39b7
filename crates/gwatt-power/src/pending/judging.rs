//! How moves that wait are judged.

use super::{Pending, Successor};
use crate::assess::Assessor;
use crate::assessment::{Assessment, Certificate};
use crate::demand::Demand;
use crate::duty_cycle::Buffered;
use crate::robust::Extremes;
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{PathFigures, SpeedBound, blended_bound, path_bound, path_figures};

impl Assessor<'_> {
    /// The largest speeds that blending may carry through a move.
    pub(crate) fn blending_bound(&self, mv: &Move, figures: Option<&PathFigures>) -> SpeedBound {
        match figures {
            Some(path) if mv.arc.is_none() && !mv.stray.is_far() => {
                path_bound(self.machine, mv, path.speed_limit_mm_s)
            }
            _ => blended_bound(self.machine, mv, self.largest),
        }
    }

    /// Lets a move wait for its successor; the one that waited is passed on. `bound`: the
    /// largest speeds that blending may carry through it; `rested`: it begins at rest.
    pub(crate) fn hold(
        &mut self,
        mv: &Move,
        text: &[u8],
        assessment: Assessment,
        (bound, rested): (SpeedBound, bool),
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let fresh = match self.spare.take() {
            Some(mut fresh) => {
                fresh.mv.clone_from(mv);
                fresh.text.clear();
                fresh.text.extend_from_slice(text);
                fresh.assessment = assessment;
                fresh.bound = bound;
                fresh.rested = rested;
                fresh
            }
            None => Box::new(Pending {
                mv: mv.clone(),
                text: text.to_vec(),
                assessment,
                bound,
                rested,
                riders: Vec::new(),
            }),
        };
        let joined = assessment.joined;
        let successor = if joined {
            Successor::Move(fresh.part())
        } else {
            Successor::Stop
        };
        self.release(successor, sink);
        self.held = Some(fresh);
    }

    /// Judges what is held.
    pub(crate) fn release(
        &mut self,
        successor: Successor<'_>,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let Some(mut held) = self.held.take() else {
            return;
        };
        let joined = held.assessment.joined;
        // A rapid between two stops is planned like any other, and so is a straight feed
        // between dwells, or between rapids of a controller that waits at both.
        let stops = matches!(successor, Successor::Stop | Successor::End);
        let alone = !joined && stops && self.requested != Some(Certificate::Robust);
        if alone && held.mv.kind == MoveKind::Rapid {
            held.assessment.blended = false;
            self.observer
                .alone(self.machine, &self.model, &held.mv, self.largest);
        } else if alone
            && held.rested
            && !matches!(successor, Successor::End)
            && held.mv.arc.is_none()
            && !held.mv.stray.is_far()
        {
            let figures = path_figures(self.machine, &held.mv, self.largest);
            held.assessment = self.evaluate(&held.mv, figures.as_ref(), false);
            self.observer
                .alone(self.machine, &self.model, &held.mv, self.largest);
        } else {
            let demand = {
                let own = held.part();
                let before = self.before.as_deref().filter(|_| joined);
                let next = match successor {
                    Successor::Move(next) => next,
                    _ => own,
                };
                let window = [before.map_or(own, Pending::part), own, next];
                self.observer.blended(
                    (self.machine, &self.model),
                    &held.mv,
                    &window,
                    &mut Buffered::default(),
                    self.largest,
                );
                self.model.robust_over(&held.mv, &window, self.want)
            };
            held.assessment.demand = Demand {
                energy_j: held.assessment.demand.energy_j,
                ..demand
            };
            held.assessment.certificate = Certificate::Robust;
            self.needs_robust |= self.requested == Some(Certificate::Planned);
        }
        sink(&held.mv, &held.assessment, &held.text);
        if matches!(successor, Successor::Doubt)
            && let Some(before) = self.before.as_deref().filter(|_| joined)
        {
            // All of them may run into what nobody waited for.
            let both = Extremes::of(&[before.part(), held.part()]);
            (held.bound, held.mv.accel_mm_s2) = (both.bound, both.accel_mm_s2);
        }
        for rider in &held.riders {
            self.observer.pass();
            sink(&rider.mv, &rider.assessment, &rider.text);
        }
        held.riders.clear();
        self.spare = self.before.replace(held);
    }
}
