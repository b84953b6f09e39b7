//! A piece of the written program on its way to the certifier.

use super::entry::Entry;
use super::expected::{Expected, ExpectedMove};
use crate::interpret::{FastPathState, Move, Step};
use crate::power::Assessment;

/// A piece of the written program with what it must do.
#[derive(Debug, Default)]
pub(super) struct Batch {
    /// Whole lines.
    pub(super) bytes: Vec<u8>,
    pub(super) expected: Vec<Expected>,
    /// The blocks of the original that the lines stand for, in order; after
    /// the last one there may be further lines.
    pub(super) blocks: Vec<WrittenBlock>,
    /// The moves of plain blocks.
    pub(super) moves: Vec<Move>,
    /// The original's state after each other block.
    pub(super) fast_path_states: Vec<FastPathState>,
}

/// What was written for a block of the original.
#[derive(Debug)]
pub(super) struct WrittenBlock {
    /// Bytes, those of added lines included.
    pub(super) length: usize,
    /// The block is plain: it makes the next one of the moves.
    pub(super) plain: bool,
    /// Byte for byte what the original has.
    pub(super) unchanged: bool,
}

impl Batch {
    /// Notes that all from `start` on was written for a block.
    pub(super) fn end_block(&mut self, start: usize, entry: &mut Entry) {
        let written = self.bytes.get(start..).unwrap_or_default();
        self.blocks.push(WrittenBlock {
            length: written.len(),
            plain: entry.fast_path_state.is_none(),
            unchanged: written == entry.text,
        });
        if let Some(fast_path_state) = entry.fast_path_state.take() {
            self.fast_path_states.push(fast_path_state);
        } else if let Some(Step::Move(mv)) = entry.steps.first() {
            self.moves.push(mv.clone());
        }
    }

    /// Notes that a plain block was copied, which makes `mv`.
    pub(super) fn pass(&mut self, length: usize, mv: &Move, assessment: &Assessment) {
        self.blocks.push(WrittenBlock {
            length,
            plain: true,
            unchanged: true,
        });
        self.moves.push(mv.clone());
        let expected = ExpectedMove::of(mv, assessment);
        self.expected.push(Expected::Move(expected));
    }

    /// Empties the piece and keeps its buffers.
    pub(super) fn clear(&mut self) {
        self.bytes.clear();
        self.expected.clear();
        self.blocks.clear();
        self.moves.clear();
        self.fast_path_states.clear();
    }
}
