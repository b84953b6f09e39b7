//! A stretch of speed on which the limits have one law.
//!
//! Everything is upwards: towards more speed with a positive acceleration a.
//! Over the speed v, `w = a²` follows straight lines at constant jerk,
//! `dw/dv = 2j`, so planning over (v, w) is geometry with lines and the convex
//! curves `w = A(v)²`.

use super::curve::Piece;
use super::limits::Limits;

/// Halvings that bring a bracket to neighbouring numbers.
const HALVINGS: u32 = 100;

/// Speeds `low..high`, on which `law` limits the acceleration and `jerk` the jerk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// The lowest speed, signed.
    pub low: f64,
    /// The highest speed, signed.
    pub high: f64,
    /// The acceleration over the magnitude of the speed.
    pub law: Piece,
    /// The jerk.
    pub jerk: f64,
}

impl Cell {
    /// The largest acceleration at `v`.
    pub fn accel(&self, v: f64) -> f64 {
        self.law.at(v.abs()).max(0.0)
    }

    /// Its square.
    pub fn w(&self, v: f64) -> f64 {
        let a = self.accel(v);
        a * a
    }

    /// Slope of the square over the signed speed.
    pub fn slope_w(&self, v: f64) -> f64 {
        let u = v.abs();
        let mut slope = self.law.slope;
        if self.law.hyperbola != 0.0 {
            slope -= self.law.hyperbola / (u * u);
        }
        2.0 * self.accel(v) * if self.low < 0.0 { -slope } else { slope }
    }

    /// True when the acceleration does not depend on the speed.
    pub fn is_constant(&self) -> bool {
        self.law.hyperbola == 0.0 && self.law.slope == 0.0
    }

    /// The first speed in `from..=to` at which the curve's slope over v has
    /// risen to `slope`; `to` if it stays below. The slope grows, as w is convex.
    pub fn where_slope(&self, slope: f64, from: f64, to: f64) -> f64 {
        if self.slope_w(from) >= slope {
            return from;
        }
        if self.is_constant() || self.slope_w(to) < slope {
            return to;
        }
        bisect(from, to, |v| self.slope_w(v) >= slope)
    }
}

/// The first number in `from..=to` for which `is` holds, if it holds from there
/// on; `to` if it never does.
pub(super) fn bisect(from: f64, to: f64, is: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (from, to);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if is(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// The cells between two speeds, ascending.
pub(super) fn cells(limits: &Limits, low: f64, high: f64) -> Vec<Cell> {
    let mut borders = vec![low];
    let mut add = |v: f64| {
        if low < v && v < high {
            borders.push(v);
        }
    };
    add(0.0);
    limits.drive.borders().for_each(&mut add);
    limits.brake.borders().for_each(|v| add(-v));
    limits.jerk.borders().for_each(|v| {
        add(v);
        add(-v);
    });
    borders.sort_by(f64::total_cmp);
    borders.dedup();
    let mut ends = borders.iter().skip(1).copied();
    let mut cells = Vec::with_capacity(borders.len());
    for &from in &borders {
        let to = ends.next().unwrap_or(high);
        let middle = 0.5 * (from + to);
        let curve = if middle < 0.0 {
            &limits.brake
        } else {
            &limits.drive
        };
        cells.push(Cell {
            low: from,
            high: to,
            law: curve.piece(middle.abs()),
            jerk: limits.jerk.at(middle),
        });
    }
    cells
}
