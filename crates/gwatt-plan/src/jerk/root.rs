//! The roots of a smooth function on an interval whose critical points are
//! known.
//!
//! Between two of them the function is monotone: a change of sign holds one
//! root, which Newton's method finds, with halving where it would leave the
//! bracket.

use arrayvec::ArrayVec;

/// Steps at most; halving alone needs 64.
const STEPS: u32 = 128;
/// Rounding of a value, relative to its terms.
const ROUNDING: f64 = 1e-14;
/// A value that counts as 0 at the end of an interval, relative to its terms:
/// a state that was planned before and read back must not lead to a detour.
const ZERO_AT_END: f64 = 1e-12;

/// A value of a function with its slope and the size of its terms.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    pub value: f64,
    pub slope: f64,
    pub size: f64,
}

/// Calls `found` with each root of `f` between `low` and `high`, and with how
/// far from 0 the function is there, relative to its terms. The ends are
/// handed out too, since rounding may have put a root just next to one.
pub(super) fn roots(
    (low, high): (f64, f64),
    critical: [f64; 2],
    f: impl Fn(f64) -> Sample,
    mut found: impl FnMut(f64, f64),
) {
    let mut points = ArrayVec::<f64, 4>::new();
    points.push(low);
    for point in [critical[0].min(critical[1]), critical[0].max(critical[1])] {
        if point > low && point < high {
            points.push(point);
        }
    }
    points.push(high);
    let mut from: Option<(f64, Sample)> = None;
    for point in points {
        let value = f(point);
        let residual = if value.value == 0.0 {
            0.0
        } else {
            (value.value / value.size).abs()
        };
        found(point, residual);
        if let Some((start, first)) = from {
            let beyond_rounding = [first, value]
                .iter()
                .all(|value| value.value.abs() > ROUNDING * value.size);
            if beyond_rounding && (first.value < 0.0) != (value.value < 0.0) {
                found(between(start, point, first.value > 0.0, &f), 0.0);
            }
        }
        from = Some((point, value));
    }
}

/// Whether a value that [`roots`] handed out is a root but for rounding.
pub(super) fn is_root(residual: f64) -> bool {
    residual <= ZERO_AT_END
}

/// The root between two points of different signs.
fn between(start: f64, end: f64, falling: bool, f: &impl Fn(f64) -> Sample) -> f64 {
    let (mut low, mut high) = (start, end);
    let mut x = 0.5 * (low + high);
    for _ in 0..STEPS {
        let Sample { value, slope, size } = f(x);
        if (value > 0.0) == falling {
            low = x;
        } else {
            high = x;
        }
        let step = value / slope;
        let small = value.abs() <= 0.1 * f64::EPSILON * size;
        if small || step.abs() <= 0.5 * f64::EPSILON * x.abs() {
            return x - if step.is_finite() { step } else { 0.0 };
        }
        let newton = x - step;
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return x;
        }
        let next = if newton > low && newton < high {
            newton
        } else {
            middle
        };
        x = next;
    }
    x
}
