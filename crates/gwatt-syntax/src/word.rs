//! A letter with its number.

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
