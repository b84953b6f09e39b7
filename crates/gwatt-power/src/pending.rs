//! Moves that wait for their successors.

mod judging;

use super::assessment::Assessment;
use super::robust::Part;
use gwatt_motion::Move;
use gwatt_plan::SpeedBound;

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
