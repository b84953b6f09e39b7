//! How long a program waits, and what is known of places to wait at.

use crate::interpret::Move;
use crate::pipeline::outcome::Pause;

/// How long a program waits, and where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::pipeline) struct Plan {
    /// At each place, s; 0: it does not.
    pub(in crate::pipeline) each_s: f64,
    /// Only before this line; `None`: at all places.
    pub(in crate::pipeline) place: Option<u64>,
}

impl Plan {
    /// Nowhere.
    pub(in crate::pipeline) const NEVER: Self = Self {
        each_s: 0.0,
        place: None,
    };
}

/// What is known of places to wait at.
#[derive(Debug, Default)]
pub(super) struct Waits {
    /// `None`: waiting is not permitted.
    pub(super) plan: Option<Plan>,
    /// Lines before which it may wait, so far.
    pub(super) places: Vec<u64>,
    /// Where it waits.
    pub(super) pauses: Vec<Pause>,
    /// The rapid that the block before ended with, where nothing came after it.
    pub(super) last: Option<Move>,
}
