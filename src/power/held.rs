//! Moves that wait for their successors.

use super::assessment::Assessment;
use super::robust::Part;
use crate::interpret::{Move, MoveKind};
use crate::plan::SpeedBound;

/// Moves of no length in a row that a controller may look across: more than
/// any queue holds.
pub(super) const RIDERS: usize = 4096;

/// A move that waits for its successor.
#[derive(Debug)]
pub(super) struct Held {
    pub mv: Move,
    pub text: Vec<u8>,
    pub assessment: Assessment,
    /// Its largest speeds, its neighbours left aside.
    pub bound: SpeedBound,
    /// A dwell stands before it.
    pub dwelt: bool,
    /// Moves of no length behind it: controllers leave them out and blend
    /// across them.
    pub riders: Vec<Rider>,
}

impl Held {
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

/// Whether any axis moves.
pub(super) fn moves(mv: &Move) -> bool {
    mv.kind != MoveKind::Dwell && !(mv.moving.is_empty() && mv.unknown_start.is_empty())
}
