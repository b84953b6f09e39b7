//! Moves that wait for their successors.

use super::assess::Assessor;
use super::assessment::{Assessment, Certificate};
use super::demand::Demand;
use super::duty_cycle::Buffered;
use super::robust::{Extremes, Part};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{PathFigures, SpeedBound, blended_bound, path_bound, path_figures};

/// A move that waits for its successor.
#[derive(Debug)]
pub(super) struct Pending {
    pub mv: Move,
    pub text: Vec<u8>,
    pub assessment: Assessment,
    /// Its largest speeds, its neighbours left aside.
    pub bound: SpeedBound,
    /// The move before it, or a dwell, has ended at rest.
    pub rested: bool,
    /// Moves of no length after it: controllers leave them out and blend
    /// across them.
    pub riders: Vec<Rider>,
}

impl Pending {
    pub fn part(&self) -> Part<'_> {
        Part {
            bound: &self.bound,
            accel_mm_s2: &self.mv.accel_mm_s2,
        }
    }
}

/// A move of no length that waits with the move before it.
#[derive(Debug)]
pub(super) struct Rider {
    pub mv: Move,
    pub text: Vec<u8>,
    pub assessment: Assessment,
}

/// What stands after a move that waits.
#[derive(Debug, Clone, Copy)]
pub(super) enum Successor<'a> {
    /// A stop: a dwell, or a move that begins at rest.
    Stop,
    /// The end of the program.
    End,
    /// A move that it runs into.
    Move(Part<'a>),
    /// So much that moves no axis that it may have stopped.
    Doubt,
}

impl Assessor<'_> {
    /// Lets a move wait for its successor; the one that waited is handed on.
    pub(super) fn hold(
        &mut self,
        mv: &Move,
        text: &[u8],
        assessment: Assessment,
        figures: Option<&PathFigures>,
        rested: bool,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let bound = match figures {
            Some(path) if mv.arc.is_none() && !mv.stray.is_far() => {
                path_bound(self.machine, mv, path.speed_limit_mm_s)
            }
            _ => blended_bound(self.machine, mv, self.largest),
        };
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
    pub(super) fn release(
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
                    self.machine,
                    &self.model,
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
