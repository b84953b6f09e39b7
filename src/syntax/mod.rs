//! Program text to blocks, lossless: joining the pieces gives the bytes back.

use crate::source::Span;

/// A letter with its number, or `=` with its number (`G131 = 50`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Word {
    /// The letter in upper case; also `=`, `*` (checksum), `@`, `^`.
    pub letter: u8,
    /// Value of the number; always finite.
    pub value: f64,
    /// From the letter to the end of the number.
    pub span: Span,
    /// The number alone, sign included.
    pub number: Span,
}

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

/// What is wrong with the text of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Issue {
    /// Which fault.
    pub kind: IssueKind,
    /// Where in the line.
    pub span: Span,
}

/// The faults of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IssueKind {
    /// A byte that begins nothing known.
    UnknownText,
    /// A letter without a number behind it.
    MissingNumber,
    /// A number without a letter before it.
    MissingLetter,
    /// A number that is too large for f64.
    NotFinite,
    /// `(` without `)`.
    UnclosedComment,
    /// `#`, `[`, `<`, or a letter followed by one: variables and expressions.
    Expression,
    /// `O` with a name, or O-word flow (`o100 sub`, `if`, `while` …).
    Flow,
}

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
    /// End of the last word: where a further word may be inserted.
    pub words_end: u32,
    /// First byte of the line end (= length of the line without one).
    pub text_end: u32,
    /// What is not understood.
    pub issues: Vec<Issue>,
}
