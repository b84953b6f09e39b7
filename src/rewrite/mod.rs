//! Adjustments to bytes: the fewest edits that give each block its values and
//! leave the modal state of every other block as it was.
//!
//! Input: blocks in program order, each with the modal state before and after
//! it and the [`Change`](crate::limit::Change) of its moves. Output: the bytes
//! of the block, with words changed or inserted and lines inserted before it.
//! The rewriter never sees watts.
//!
//! Two states run side by side: what the original would have in force, and
//! what the written program has. Where a block depends on a word that differs,
//! the word is written; where somebody may look at the state (stops, tool
//! changes, the end, blocks that may be skipped) a line puts it right.

mod beforehand;
mod block;
mod called_cycle;
mod contour;
mod hole;
mod in_place;
mod knob_line;
mod number;
mod placed;
mod rapid_mark;
mod single;
mod state;
mod turned;

pub use beforehand::Return;
pub use block::{BlockView, FeedAround, PieceWords, Rewriter};
pub use called_cycle::{CallingBlock, without_modal_call};
pub use contour::contour_as_comment;
pub use hole::Placed;
pub use in_place::CalledBlock;
pub(crate) use knob_line::lines as knob_lines;
pub(crate) use number::has_at_most;
pub use rapid_mark::{Comment, RapidMark, RapidMarkError};
pub use single::{CycleBlock, Singles};
pub use state::{FeedValue, Mark};
pub(crate) use turned::SWITCH_ON;
