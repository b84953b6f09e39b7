//! For how long a move lasts whose timing is not known.

use crate::trace::Slice;

/// The shortest and the longest time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    /// In s.
    pub shortest_s: f64,
    /// In s; infinite where nothing is known.
    pub longest_s: f64,
}

impl Span {
    /// Nothing is known.
    pub const ANY: Self = Self {
        shortest_s: 0.0,
        longest_s: f64::INFINITY,
    };

    /// So long.
    pub const fn of(duration_s: f64) -> Self {
        Self {
            shortest_s: duration_s,
            longest_s: duration_s,
        }
    }

    /// The time that is worse for something that grows above a limit and shrinks
    /// below it.
    pub fn worse_s(self, above: bool) -> f64 {
        if above {
            self.longest_s
        } else {
            self.shortest_s
        }
    }
}

/// What is known of a move that does not run in turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Known {
    pub span: Span,
    /// What it draws and feeds back at most, W; nothing but the bound where `None`.
    pub most_w: Option<[f64; 2]>,
}

impl Known {
    /// For how long it may last.
    pub const fn lasting(span: Span) -> Self {
        Self { span, most_w: None }
    }
}

/// What may come when a move is over at the largest overrides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Late {
    pub slice: Slice,
    /// It is that of places which are passed more slowly then; else it lasts no longer.
    pub slower: bool,
}
