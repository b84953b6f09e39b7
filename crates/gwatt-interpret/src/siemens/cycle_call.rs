//! Drilling cycles by their names, and calls of them.

use gwatt_syntax::source::Span;

/// What is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// CYCLE81 and CYCLE82: drilling, with a dwell.
    Drill,
    /// CYCLE83: deep hole.
    Deep,
    /// CYCLE84: tapping without compensating chuck.
    Tap,
    /// CYCLE840: tapping with compensating chuck.
    FloatingTap,
    /// CYCLE85 and CYCLE89: boring, out again at a feed.
    Bore,
    /// CYCLE86: boring, out with the spindle turned to a place.
    BoreAside,
    /// HOLES1: a row.
    Row,
    /// HOLES2: a circle.
    Circle,
}

impl Kind {
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "CYCLE81" | "CYCLE82" => Self::Drill,
            "CYCLE83" => Self::Deep,
            "CYCLE84" => Self::Tap,
            "CYCLE840" => Self::FloatingTap,
            "CYCLE85" | "CYCLE89" => Self::Bore,
            "CYCLE86" => Self::BoreAside,
            "HOLES1" => Self::Row,
            "HOLES2" => Self::Circle,
            _ => return None,
        })
    }
}

/// A cycle with its arguments, as they were written.
#[derive(Debug, Clone)]
pub(super) struct Call {
    pub(super) kind: Kind,
    pub(super) values: Vec<Option<f64>>,
    /// It has feeds of its own (CYCLE85).
    pub(super) feeds: bool,
    pub(super) span: Span,
}
