//! A command of the spindle that waits.

use gwatt_motion::Action;

/// A command that waits for the moves before it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Queued {
    /// How many moves come before it.
    pub(super) after: u64,
    pub(super) action: Action,
}
