//! The pieces that a line consists of.

use crate::source::Span;

/// What a piece of a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PieceKind {
    /// A byte order mark at the very beginning.
    ByteOrderMark,
    /// Blanks and tabs.
    Blank,
    /// `/` or `/2` at the beginning of a block.
    BlockDelete,
    /// A word.
    Word,
    /// A comment in parentheses, the parentheses included.
    Comment,
    /// A comment from `;` to the end of the line.
    LineComment,
    /// `%` and what follows it on the line.
    Tape,
    /// LF, CR or CRLF.
    LineEnd,
    /// What is not understood.
    Unknown,
}

/// A piece of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Piece {
    /// What it is.
    pub kind: PieceKind,
    /// Where it stands in its line.
    pub span: Span,
}
