//! All moves in their order: those with stops by themselves, blended ones
//! together with their neighbours.
//!
//! A move waits until nothing behind it can change it any more: a blended one
//! until the move after the next is known, all others not at all.

use std::collections::VecDeque;

use super::change::{Change, Permit};
use super::lever::Obstacle;
use super::options::LimitOptions;
use super::solver::Solver;
use super::window;
use crate::interpret::Move;
use crate::machine::Machine;
use crate::power::Assessment;

/// What was decided for one move.
///
/// Boxed, since most moves fit and nothing is decided for them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// The change; `None` where the move fits or cannot be helped.
    pub change: Option<Box<Change>>,
    /// Why a move that does not fit stays as it is.
    pub obstacle: Option<Box<Obstacle>>,
}

/// A move that may still be changed.
#[derive(Debug, Clone)]
pub(super) struct Slot {
    pub(super) mv: Move,
    /// The move with its change.
    pub(super) changed: Move,
    pub(super) assessment: Assessment,
    pub(super) permit: Permit,
    pub(super) change: Change,
    pub(super) obstacle: Option<Obstacle>,
    /// The controller may run from this move into the next one that moves.
    pub(super) joined: bool,
    /// It has no length and is passed on the way to the next.
    pub(super) rider: bool,
}

/// Decides for the moves of one program.
#[derive(Debug)]
pub struct Limiter<'m> {
    solver: Solver<'m>,
    slots: VecDeque<Slot>,
}

impl<'m> Limiter<'m> {
    /// A limiter for a machine.
    #[must_use]
    pub fn new(machine: &'m Machine, how: LimitOptions) -> Self {
        Self {
            solver: Solver::new(machine, how),
            slots: VecDeque::new(),
        }
    }

    /// Takes the next move; `permit` tells what may be changed about its block
    /// and is asked only where that matters. Outcomes are handed on in the
    /// order of the moves.
    pub fn push(
        &mut self,
        mv: &Move,
        assessment: &Assessment,
        permit: impl Fn() -> Permit,
        sink: &mut impl FnMut(Outcome),
    ) {
        let joined = assessment.joined;
        if !assessment.blended {
            let outcome = self.alone(mv, assessment, &permit);
            if joined && !self.slots.is_empty() {
                let mut slot = Slot::new(mv, assessment, permit());
                slot.rider = true;
                slot.change = outcome.change.map_or(Change::NONE, |change| *change);
                slot.obstacle = outcome.obstacle.map(|obstacle| *obstacle);
                self.slots.push_back(slot);
                return;
            }
            self.settle(sink);
            sink(outcome);
            return;
        }
        let previous = self.last_moving();
        self.slots.push_back(Slot::new(mv, assessment, permit()));
        let mut needed = self.slots.len() - 1;
        if let Some(center) = previous {
            self.slots[center].joined = joined;
            window::settle(&self.solver, &mut self.slots, center);
            if joined {
                needed = center;
            }
        }
        for slot in self.slots.drain(..needed) {
            sink(slot.outcome());
        }
    }

    /// Hands on what was waiting, at the end of the program.
    pub fn finish(&mut self, sink: &mut impl FnMut(Outcome)) {
        self.settle(sink);
    }

    /// Decides what is waiting; nothing that follows is joined to it.
    fn settle(&mut self, sink: &mut impl FnMut(Outcome)) {
        if let Some(center) = self.last_moving() {
            self.slots[center].joined = false;
            window::settle(&self.solver, &mut self.slots, center);
        }
        for slot in self.slots.drain(..) {
            sink(slot.outcome());
        }
    }

    fn last_moving(&self) -> Option<usize> {
        self.slots.iter().rposition(|slot| !slot.rider)
    }

    fn alone(&self, mv: &Move, assessment: &Assessment, permit: impl Fn() -> Permit) -> Outcome {
        if self.solver.model.fits(&assessment.demand) {
            return Outcome::default();
        }
        match self.solver.solve(mv, assessment, &permit()) {
            Ok(change) => Outcome {
                change: Some(Box::new(change)),
                obstacle: None,
            },
            Err(obstacle) => Outcome {
                change: None,
                obstacle: Some(Box::new(obstacle)),
            },
        }
    }
}

impl Slot {
    fn new(mv: &Move, assessment: &Assessment, permit: Permit) -> Self {
        Self {
            mv: mv.clone(),
            changed: mv.clone(),
            assessment: *assessment,
            permit,
            change: Change::NONE,
            obstacle: None,
            joined: false,
            rider: false,
        }
    }

    fn outcome(self) -> Outcome {
        Outcome {
            change: (!self.change.is_none()).then(|| Box::new(self.change)),
            obstacle: self.obstacle.map(Box::new),
        }
    }
}
