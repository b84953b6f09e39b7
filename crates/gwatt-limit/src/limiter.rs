//! All moves in their order: those with stops by themselves, blended ones
//! together with their neighbours.
//!
//! A move waits until nothing after it can change it any more: a blended one
//! until the move after the next is known, all others not at all.

use super::slot::{Outcome, Slot, Waiting};
use std::collections::VecDeque;

use super::case::{Case, Ends};
use super::change::Change;
use super::depth::Depths;
use super::lever::levers;
use super::options::{LimitOptions, Strategy};
use super::pace::{Paces, fitting_mm_s};
use super::road::SPLIT_TRIES;
use super::settle;
use super::solver::Solver;
use super::window;
use gwatt_machine::{Machine, RapidJoint};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::plan;
use gwatt_power::{Assessment, Certificate};

/// Decides for the moves of one program.
#[derive(Debug)]
pub struct Limiter<'m> {
    solver: Solver<'m>,
    slots: VecDeque<Slot>,
    depths: Depths,
    /// The speed at which the last move ends, mm/s, where that is known to be slower than
    /// it was.
    arrives_mm_s: Option<f64>,
    /// A move has been changed since the spindle was steady last: those after
    /// it meet its run later than in the original.
    shifted: bool,
}

impl<'m> Limiter<'m> {
    /// A limiter for a machine. `depths` is what an earlier round has found to
    /// be needed.
    #[must_use]
    pub fn new(machine: &'m Machine, how: LimitOptions, depths: Depths) -> Self {
        Self {
            solver: Solver::new(machine, how),
            slots: VecDeque::new(),
            depths,
            arrives_mm_s: None,
            shifted: false,
        }
    }

    /// Whether the change of a move stands for a preset that the machine does not have.
    #[must_use]
    pub fn fell_back(&self, mv: &Move, outcome: &Outcome) -> bool {
        outcome.change.is_some() && self.solver.falls_back(mv)
    }

    /// Whether blocks may be written as several.
    #[must_use]
    pub fn splits(&self) -> bool {
        self.solver.how.strategy == Strategy::Split
    }

    /// Takes the next move. Outcomes are passed on in the order of the moves;
    /// until then the caller keeps them, and `find` gives the one at a place,
    /// counted from the first that waits. It is asked only where that matters.
    pub fn push<'a>(
        &mut self,
        mv: &Move,
        assessment: &Assessment,
        find: &impl Fn(usize) -> Option<Waiting<'a>>,
        sink: &mut impl FnMut(Outcome),
    ) {
        let joined = assessment.joined;
        self.shifted &= assessment.spindle.runs;
        if assessment.ahead {
            self.settle(find, sink);
            let depth = self.depth(mv);
            let ends = match assessment.certificate {
                _ if depth == 0 && !assessment.blended => Ends::Rest,
                Certificate::Planned => Ends::Any(depth),
                Certificate::Robust => Ends::Any(depth.max(2)),
            };
            let outcome = self.alone(mv, assessment, ends, find);
            self.shifted |= outcome.change.is_some();
            if self.splits() && mv.length_mm > 0.0 {
                self.arrives_mm_s = self.arrival(mv, assessment, &outcome, find);
            }
            sink(outcome);
            return;
        }
        self.arrives_mm_s = None;
        if !assessment.blended {
            let outcome = self.alone(mv, assessment, Ends::Rest, find);
            self.shifted |= outcome.change.is_some();
            if joined && !self.slots.is_empty() {
                let mut slot = Slot::new(mv, assessment);
                slot.rider = true;
                slot.outcome = outcome;
                self.slots.push_back(slot);
                return;
            }
            self.settle(find, sink);
            sink(outcome);
            return;
        }
        let previous = self.last_moving();
        let mut slot = Slot::new(mv, assessment);
        if self.solver.how.always
            && let Some(Waiting { permit, .. }) = find(self.slots.len())
        {
            window::put_anyway(&self.solver, &mut slot, mv, &permit);
        }
        self.slots.push_back(slot);
        let mut needed = self.slots.len() - 1;
        if let Some(center) = previous {
            self.slots[center].joined = joined;
            settle::settle(&self.solver, &mut self.slots, find, center);
            if joined {
                needed = center;
            }
        }
        self.emit(needed, sink);
    }

    /// Whether a move is all right as it is: it ends at rest, fits, and no
    /// other one waits.
    #[must_use]
    pub fn passes(&self, assessment: &Assessment) -> bool {
        self.slots.is_empty()
            && !assessment.blended
            && !assessment.ahead
            && !self.solver.how.always
            && (!self.shifted || !assessment.spindle.runs)
            && self.solver.model.fits(&assessment.demand)
    }

    /// Passes on what was waiting, at the end of the program.
    pub fn finish<'a>(
        &mut self,
        find: &impl Fn(usize) -> Option<Waiting<'a>>,
        sink: &mut impl FnMut(Outcome),
    ) {
        self.settle(find, sink);
    }

    /// Decides what is waiting; nothing that follows is joined to it.
    #[inline]
    fn settle<'a>(
        &mut self,
        find: &impl Fn(usize) -> Option<Waiting<'a>>,
        sink: &mut impl FnMut(Outcome),
    ) {
        if self.slots.is_empty() {
            return;
        }
        if let Some(center) = self.last_moving() {
            self.slots[center].joined = false;
            settle::settle(&self.solver, &mut self.slots, find, center);
        }
        self.emit(self.slots.len(), sink);
    }

    /// Passes on the first `count` that wait.
    fn emit(&mut self, count: usize, sink: &mut impl FnMut(Outcome)) {
        for _ in 0..count {
            let Some(slot) = self.slots.pop_front() else {
                break;
            };
            self.shifted |= slot.outcome.change.is_some();
            sink(slot.outcome);
        }
    }

    /// The last move with a length.
    fn last_moving(&self) -> Option<usize> {
        self.slots.iter().rposition(|slot| !slot.rider)
    }

    /// How deep a move that stays one block is to be lowered: the first rounds try others
    /// pieces.
    fn depth(&self, mv: &Move) -> u8 {
        let depth = self.depths.of(mv);
        if self.splits() {
            depth.saturating_sub(SPLIT_TRIES)
        } else {
            depth
        }
    }

    #[inline]
    fn alone<'a>(
        &self,
        mv: &Move,
        assessment: &Assessment,
        ends: Ends,
        find: &impl Fn(usize) -> Option<Waiting<'a>>,
    ) -> Outcome {
        if assessment.ahead
            && assessment.certificate == Certificate::Planned
            && let Some(paces) = self.depths.paces()
            && let Some(outcome) = self.by_measure(paces, (mv, assessment), ends, find)
        {
            return outcome;
        }
        let tries = if self.splits() {
            self.depths.of(mv)
        } else {
            self.depth(mv)
        };
        let deeper = assessment.ahead && tries > 0;
        let fits_alone = self.solver.model.fits(&assessment.demand);
        let fits = fits_alone && !deeper;
        let later = self.shifted && assessment.spindle.runs;
        let always = self.solver.how.always;
        if fits && !later && !always {
            return Outcome::default();
        }
        let Some(Waiting { permit, .. }) = find(self.slots.len()) else {
            return Outcome::default();
        };
        if fits && (!later || self.solver.fits_later(mv, assessment, &permit, ends)) {
            return if always {
                let case = Case {
                    mv,
                    assessment,
                    permit: &permit,
                    ends,
                    exact_stop: false,
                };
                let levers = levers(self.solver.machine, self.solver.how, mv, &permit);
                Outcome::anyway(self.solver.anyway(case, &levers))
            } else {
                Outcome::default()
            };
        }
        let solved = self.solver.solve(mv, assessment, &permit, ends);
        let mut outcome = Outcome::default();
        if self.splits() && !fits {
            // What fits by itself is no measure next to its neighbours.
            let otherwise = solved.as_ref().ok().filter(|_| !fits_alone);
            let how = (tries - u8::from(fits_alone), self.arrives_mm_s);
            let pieces = self.solver.pieces(mv, assessment, &permit, how, otherwise);
            match pieces {
                Ok(split) => {
                    let last = split.pieces.last().and_then(|piece| piece.accel);
                    let change = Change {
                        accel: last,
                        cruise: split.cruise,
                        ..Change::NONE
                    };
                    outcome.change = Some(Box::new(change));
                    outcome.split = Some(Box::new(split));
                    return outcome;
                }
                Err(_) if fits_alone && self.depth(mv) == 0 => return outcome,
                Err(reason) => outcome.unsplit = Some(reason),
            }
        }
        match solved {
            Ok(change) => outcome.change = (!change.is_none()).then(|| Box::new(change)),
            Err(obstacle) => outcome.obstacle = Some(Box::new(obstacle)),
        }
        outcome
    }
}

impl Limiter<'_> {
    /// The speed at which a move ends with what was decided for it, where that is slower
    /// than it was.
    fn arrival<'a>(
        &self,
        mv: &Move,
        assessment: &Assessment,
        outcome: &Outcome,
        find: &impl Fn(usize) -> Option<Waiting<'a>>,
    ) -> Option<f64> {
        let [start_mm_s, end_mm_s] = assessment.ends2.map(f64::sqrt);
        let slower = |speed_mm_s: f64| (speed_mm_s < end_mm_s * (1.0 - 1e-9)).then_some(speed_mm_s);
        if let Some(split) = &outcome.split {
            return slower(split.end_mm_s);
        }
        if outcome.change.is_none() && self.arrives_mm_s.is_none() {
            return None;
        }
        let (machine, largest) = (self.solver.machine, self.solver.largest);
        let start_mm_s = self.arrives_mm_s.unwrap_or(start_mm_s);
        let planned = match &outcome.change {
            Some(change) => {
                let Waiting { permit, .. } = find(self.slots.len())?;
                plan(machine, &change.apply(machine, mv, &permit), largest)
            }
            None => plan(machine, mv, largest),
        };
        let reached2 = start_mm_s * start_mm_s + 2.0 * planned.accel_mm_s2 * mv.length_mm;
        slower(reached2.sqrt().min(planned.speed_limit_mm_s))
    }

    /// What a move gets that is held to a speed by measure, or by how far it exceeds the
    /// limit next to its neighbours; `None` where it is solved like others.
    fn by_measure<'a>(
        &self,
        paces: &Paces,
        (mv, assessment): (&Move, &Assessment),
        ends: Ends,
        find: &impl Fn(usize) -> Option<Waiting<'a>>,
    ) -> Option<Outcome> {
        let solver = &self.solver;
        let joint = solver.machine.controller.planner.rapid_joint;
        if mv.kind == MoveKind::Rapid && joint != RapidJoint::All {
            // As a feed it runs between two stops, by itself.
            return None;
        }
        // One factor on all feeds is one on F, not on what axes or curvature leave of it.
        let asked_mm_s = if mv.feed_mm_s.is_finite() {
            mv.feed_mm_s
        } else {
            assessment.speed_mm_s
        };
        let own_mm_s = asked_mm_s * solver.largest.feed;
        let exceeds = !solver.model.fits(&assessment.demand);
        let mut most_mm_s = paces.of(mv, own_mm_s);
        if most_mm_s.is_none() && !(exceeds && paces.measures()) {
            return (!paces.measures()).then(Outcome::default);
        }
        let whole = self.depths.of(mv) >= SPLIT_TRIES || most_mm_s.is_some();
        if self.splits() && exceeds && paces.measures() && !whole {
            return None;
        }
        let Waiting { permit, .. } = find(self.slots.len())?;
        let levers = levers(solver.machine, solver.how, mv, &permit);
        if levers.speed.is_none() {
            return (!paces.measures()).then(Outcome::default);
        }
        let pairs = levers.accel.is_some() && solver.how.strategy != Strategy::Speed;
        let mut with = Change::NONE;
        if exceeds && paces.measures() {
            if pairs {
                // The acceleration by itself; what neighbours make of it is measured.
                with = solver.solve(mv, assessment, &permit, ends).ok()?;
            } else if most_mm_s.is_none() {
                most_mm_s = fitting_mm_s(&solver.model, mv, assessment);
            }
        }
        let case = Case {
            mv,
            assessment,
            permit: &permit,
            ends,
            exact_stop: false,
        };
        let held = |case: Case<'_>| match most_mm_s {
            Some(most_mm_s) => solver.held(case, &levers, &with, most_mm_s),
            None => Ok(with),
        };
        let mut outcome = Outcome::default();
        match solver.sooner_stopped(case, held) {
            Ok(change) => outcome.change = (!change.is_none()).then(|| Box::new(change)),
            Err(obstacle) => outcome.obstacle = Some(Box::new(obstacle)),
        }
        Some(outcome)
    }
}
