//! How far a line that is written in pieces has been compared and judged.

use crate::power::Assessment;

/// Pieces of a line so far.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    /// That the written program has run.
    pub(super) done: usize,
    /// That are judged, and what is known of them together.
    pub(super) judged: usize,
    pub(super) sum: Option<Assessment>,
}

/// What a piece is found to be.
#[derive(Debug, Clone, Copy)]
pub(super) enum Found {
    Right,
    /// With what differs.
    Wrong(&'static str),
}
