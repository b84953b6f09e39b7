//! One program line, understood as far as words go.

use super::{Issue, Word};

/// Most issues that a block keeps: a line of garbage needs no thousand
/// messages, and one is enough to refuse it.
pub const MAX_ISSUES: usize = 16;

/// One block: the words of a program line, with what else is known of it.
///
/// A block is a buffer that is filled again for each line, so that reading a
/// program allocates nothing once the buffers have grown.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Block {
    /// Words in the order of the text, N excluded; O included.
    pub words: Vec<Word>,
    /// The block number (the N word).
    pub number: Option<Word>,
    /// Level of block delete: 1 for `/`, 2 for `/2`; 0 without.
    pub delete_level: u8,
    /// True for a line that begins with `%`.
    pub tape: bool,
    /// End of the last word: where a further word may be inserted. Without
    /// words, the end of the N word, block delete or byte order mark, else 0.
    pub words_end: u32,
    /// First byte of the line end (= length of the line without one).
    pub text_end: u32,
    /// What is not understood; at most [`MAX_ISSUES`].
    pub issues: Vec<Issue>,
}

impl Block {
    /// Becomes a copy of another block, in the buffers that it has.
    pub fn copy_from(&mut self, other: &Self) {
        let Self {
            mut words,
            mut issues,
            ..
        } = std::mem::take(self);
        words.clear();
        words.extend_from_slice(&other.words);
        issues.clear();
        issues.extend_from_slice(&other.issues);
        *self = Self {
            words,
            issues,
            ..*other
        };
    }

    /// Empties the block and keeps its memory.
    pub fn clear(&mut self) {
        self.words.clear();
        self.number = None;
        self.delete_level = 0;
        self.tape = false;
        self.words_end = 0;
        self.text_end = 0;
        self.issues.clear();
    }
}
