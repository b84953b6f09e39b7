//! The modal state that edits touch: motion word and feed.

use crate::interpret::{Feed, FeedMode, Modal, Motion};

/// Motion word, feed and units at one place of the original program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// The motion word in force.
    pub motion: Motion,
    /// The F in force, with its text.
    pub feed: Option<Feed>,
    /// Whether F means length per minute.
    pub per_minute: bool,
    /// Millimetres in a program unit.
    pub mm_per_unit: f64,
}

impl Mark {
    /// The mark of a modal state.
    #[must_use]
    pub fn of(modal: &Modal) -> Self {
        Self {
            motion: modal.motion,
            feed: modal.feed,
            per_minute: modal.feed_mode == FeedMode::PerMinute,
            mm_per_unit: modal.mm_per_unit,
        }
    }

    /// The feed as value and unit.
    pub(super) fn feed_value(&self) -> Option<FeedValue> {
        self.feed.as_ref().map(|feed| FeedValue {
            value: feed.value,
            mm_per_unit: feed.mm_per_unit,
        })
    }
}

/// An F by value, to tell whether two are the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FeedValue {
    pub(super) value: f64,
    pub(super) mm_per_unit: f64,
}

/// What the written program has in force.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Written {
    pub(super) motion: Motion,
    pub(super) feed: Option<FeedValue>,
}
