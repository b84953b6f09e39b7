//! What the rewriter must know of a block, and of what stands around it.

use crate::interpret::{Facts, KnobState};
use crate::limit::Change;
use crate::machine::AxisValues;
use crate::rewrite::state::Mark;
use crate::syntax::Block;

/// A block with what the rewriter must know of it.
#[derive(Debug, Clone, Copy)]
pub struct BlockView<'a> {
    /// The line, line end included.
    pub text: &'a [u8],
    /// Its words.
    pub block: &'a Block,
    /// What it does.
    pub facts: &'a Facts,
    /// The original's modal state before it.
    pub before: &'a Mark,
    /// The original's modal state after it.
    pub after: &'a Mark,
    /// The original's limits in force for it; needed where the controller has
    /// knobs.
    pub knobs: Option<&'a KnobState>,
    /// Whether it moves by a rapid, and by a feed.
    pub rapids: bool,
    /// See `rapids`.
    pub feeds: bool,
    /// What its moves get.
    pub change: &'a Change,
    /// Pieces of its line that come before it.
    pub pieces: &'a [PieceWords],
    /// It starts and ends at rest: where the axes do not stand anyway, the shortest dwell
    /// stands before it, and after it unless it runs in exact stop.
    pub stops: bool,
    /// It ends at rest as it is.
    pub rests: bool,
}

/// The F around a block that is written by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FeedAround {
    /// Before it the original's is in force, and after it again.
    #[default]
    PutBack,
    /// What it leaves in force is put right where a later block counts on an F.
    LeftAfter,
    /// What is in force before it may be another block's: the original's is written.
    NotKnownBefore,
    /// Both: it states its own F, and what it leaves is put right by those that count on it.
    Stated,
    /// It is under compensation, where all stands in the blocks themselves.
    Within {
        /// Before it the original's words are in force; else it states them.
        known_before: bool,
        /// What it changes is put back on a line after it; else the next block does.
        put_back: bool,
    },
}

impl FeedAround {
    /// Whether what a block changes is put back after it.
    #[must_use]
    pub fn is_put_back(self) -> bool {
        !matches!(
            self,
            Self::Within {
                put_back: false,
                ..
            }
        )
    }
}

/// A piece that stands on a line of its own before the block.
#[derive(Debug, Clone, PartialEq)]
pub struct PieceWords {
    /// The words of its end, such as `X12.5 Y3`.
    pub place: String,
    /// The knob for acceleration, and its value for each axis; `None`: what is in force.
    pub accel: Option<(usize, AxisValues)>,
}
