//! A move that is to be solved by itself.

use super::change::Permit;
use gwatt_motion::Move;
use gwatt_power::Assessment;

/// A move to be solved, with all that is known of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Case<'a> {
    pub(super) mv: &'a Move,
    pub(super) assessment: &'a Assessment,
    pub(super) permit: &'a Permit,
    /// For how much of what may happen at its ends it has to fit.
    pub(super) ends: Ends,
    /// A rapid that is written as a feed runs in exact stop.
    pub(super) exact_stop: bool,
}

/// How a move begins and ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd)]
pub enum Ends {
    /// At rest.
    Rest,
    /// At rest as far as it is looked at by itself: what its neighbours make of it shows when
    /// the program is planned again. Each of these steps asks for less power.
    Alone(u8),
    /// At any speed up to its own, with any acceleration up to its own: it fits
    /// whatever its neighbours do. The depth of [`super::Depths`].
    Any(u8),
}
