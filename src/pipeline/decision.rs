//! What is decided about a line.

use crate::interpret::{Facts, KnobState};
use crate::limit::Change;
use crate::rewrite::{FeedAround, Mark};
use crate::syntax::Block;

/// What a line gets.
#[derive(Debug, Clone)]
pub(super) struct Decision {
    pub(super) change: Change,
    pub(super) block: Block,
    pub(super) facts: Facts,
    pub(super) before: Mark,
    pub(super) after: Mark,
    pub(super) around: FeedAround,
    pub(super) knobs: Option<KnobState>,
    pub(super) rapids: bool,
    pub(super) feeds: bool,
    /// See [`BlockView::stops`](crate::rewrite::BlockView).
    pub(super) stops: bool,
}
