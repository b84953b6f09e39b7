//! Moves that wait to be decided, and what is decided about them.

use super::change::{Change, Permit};
use super::lever::Obstacle;
use super::split::Split;
use gwatt_motion::Move;
use gwatt_power::Assessment;

/// What was decided for one move.
///
/// Boxed, since most moves fit and nothing is decided for them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// The change; `None` where the move fits or cannot be helped.
    pub change: Option<Box<Change>>,
    /// The pieces that it is written in, where these are more than one; the change is
    /// that of the last one then.
    pub split: Option<Box<Split>>,
    /// Why it is not, where that was asked for.
    pub unsplit: Option<&'static str>,
    /// Why a move that does not fit stays as it is.
    pub obstacle: Option<Box<Obstacle>>,
    /// Why one that fits does, though its preset says less and counts always.
    pub unset: Option<Box<Obstacle>>,
}

impl Outcome {
    /// What comes of a move that fits, by preset or law.
    pub(super) fn anyway(found: Result<Option<Change>, Obstacle>) -> Self {
        let mut outcome = Self::default();
        match found {
            Ok(change) => outcome.change = change.map(Box::new),
            Err(unset) => outcome.unset = Some(Box::new(unset)),
        }
        outcome
    }
}

/// A move that waits for its decision, and what may be changed about its block.
#[derive(Debug, Clone)]
pub struct Waiting<'a> {
    /// The move.
    pub mv: &'a Move,
    /// What may be changed.
    pub permit: Permit,
}

/// What is known of a move that may still be changed.
#[derive(Debug, Clone)]
pub(super) struct Slot {
    pub(super) assessment: Assessment,
    /// Switched loads during the move.
    pub(super) loads: u32,
    /// The move with its change, where it has one.
    pub(super) changed: Option<Box<Move>>,
    pub(super) outcome: Outcome,
    /// The controller may run from this move into the next one that moves.
    pub(super) joined: bool,
    /// It has no length and is passed on the way to the next.
    pub(super) rider: bool,
}

impl Slot {
    pub(super) fn new(mv: &Move, assessment: &Assessment) -> Self {
        Self {
            assessment: *assessment,
            loads: mv.loads,
            changed: None,
            outcome: Outcome::default(),
            joined: false,
            rider: false,
        }
    }
}
