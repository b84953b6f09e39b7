#![doc = include_str!("../README.md")]
//!
//! # From bytes to blocks
//!
//! Input is one line with its line end ([`source::LineReader`]); output
//! is a [`Block`] and, where asked for, the [`Piece`]s of the line. No text
//! fails: what is not understood becomes an [`Issue`] of the block.
//!
//! [`parse_line`] is the grammar. [`scan_line`] gives the same block many times
//! faster for lines of plain words and hands every other line to the grammar.
//! Joining the pieces gives the bytes back.

pub mod source;
pub mod edit;
pub mod diagnostic;

mod block;
mod expression;
mod foreign;
mod issue;
mod parser;
mod piece;
mod program;
mod scanner;
mod token;
mod word;

pub use block::{Block, MAX_ISSUES};
pub use foreign::{FOREIGN_BYTES, Foreign, foreign};
pub use issue::{Issue, IssueKind};
pub use parser::parse_line;
pub use piece::{Piece, PieceKind};
pub use program::{Line, Program};
pub use scanner::scan_line;
pub use word::Word;
