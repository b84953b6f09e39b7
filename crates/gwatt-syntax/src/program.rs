//! A whole program in memory, for tests and tools; a run streams instead.

use super::{Block, Piece, parse_line};
use crate::source::lines;

/// A program with all its lines.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Program<'a> {
    /// The lines in their order; empty for an empty program.
    pub lines: Vec<Line<'a>>,
}

/// One line of a program.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Line<'a> {
    /// The bytes, line end included.
    pub text: &'a [u8],
    /// What they consist of, without gaps.
    pub pieces: Vec<Piece>,
    /// What they mean.
    pub block: Block,
}

impl<'a> Program<'a> {
    /// Reads all of `bytes`; whatever they hold, there is a program.
    #[must_use]
    pub fn parse(bytes: &'a [u8]) -> Self {
        let lines = lines(bytes)
            .enumerate()
            .map(|(index, text)| {
                let mut line = Line {
                    text,
                    ..Line::default()
                };
                parse_line(text, index == 0, &mut line.pieces, &mut line.block);
                line
            })
            .collect();
        Self { lines }
    }

    /// The pieces of all lines joined: the bytes that were parsed.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        let pieces = self
            .lines
            .iter()
            .flat_map(|line| line.pieces.iter().map(|piece| piece.span.of(line.text)));
        pieces.collect::<Vec<_>>().concat()
    }
}
