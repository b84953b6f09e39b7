//! The largest acceleration from which everything ahead can still be kept.
//!
//! Over (v, w = a²), upwards to the target: a falling limit, a step down of it,
//! and the rest a = 0 at the target must be met with jerk −J, whose slope is
//! −2J. Walking back from the target, the envelope is the limit itself where it
//! falls no faster, and a line of slope −2J where it does. The target's line is
//! the landing.
//!
//! ```text
//!  w │ A²────┐
//!    │        ╲            line into a limit that falls too fast
//!    │         ╲___        constant power
//!    │             ─╲
//!    │               ╲     landing
//!    └────────────────┴→ v
//! ```

use super::cell::{Cell, bisect};

/// What bounds the acceleration on a stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bound {
    /// The limit's own curve.
    Curve,
    /// Slope −2J, down to this w at the end of the stretch.
    Line(f64),
}

/// A stretch of the envelope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    /// The cell that it lies in, cut to the stretch.
    pub cell: Cell,
    /// What bounds the acceleration.
    pub bound: Bound,
}

impl Stretch {
    /// w at speed `v`.
    pub fn w(&self, v: f64) -> f64 {
        match self.bound {
            Bound::Curve => self.cell.w(v),
            Bound::Line(end) => end + 2.0 * self.cell.jerk * (self.cell.high - v),
        }
    }
}

/// The envelope over ascending cells up to a rest at their end, ascending.
pub(super) fn envelope(cells: &[Cell]) -> Vec<Stretch> {
    let mut stretches = Vec::with_capacity(2 * cells.len() + 1);
    // What the stretch after allows where it begins.
    let mut end = 0.0;
    for cell in cells.iter().rev() {
        let mut push = |low: f64, high: f64, bound: Bound| {
            if low < high {
                let cell = Cell { low, high, ..*cell };
                stretches.push(Stretch { cell, bound });
            }
        };
        let (j2, low, high) = (2.0 * cell.jerk, cell.low, cell.high);
        let line = |v: f64| end + j2 * (high - v);
        // The lowest point of the curve over lines of slope −2J.
        let lowest = cell.where_slope(-j2, low, high);
        if cell.w(lowest) >= line(lowest) {
            push(low, high, Bound::Line(end));
            end = line(low);
            continue;
        }
        let cut = if cell.w(high) <= end {
            high
        } else if cell.is_constant() {
            (high - (cell.w(high) - end) / j2).max(low)
        } else {
            bisect(lowest, high, |v| cell.w(v) >= line(v))
        };
        push(cut, high, Bound::Line(end));
        push(lowest, cut, Bound::Curve);
        let floor = cell.w(lowest);
        push(low, lowest, Bound::Line(floor));
        end = floor + j2 * (lowest - low);
    }
    stretches.reverse();
    stretches
}
