//! Largest speeds and accelerations of moves that run into each other.

use gwatt_machine::{AXES, AxisValues};
use gwatt_plan::SpeedBound;

/// Largest speeds and accelerations over a window.
pub(super) fn envelope<'a>(
    parts: impl Iterator<Item = (SpeedBound, &'a AxisValues)>,
) -> (SpeedBound, AxisValues) {
    let mut bound = SpeedBound::default();
    let mut accel = [0.0_f64; AXES];
    for (part, part_accel) in parts {
        bound.include(&part);
        for axis in 0..AXES {
            accel[axis] = accel[axis].max(part_accel[axis]);
        }
    }
    (bound, accel)
}

/// A path speed that X, Y and Z together do not exceed, mm/s.
pub(super) fn path_speed(bound: &SpeedBound) -> f64 {
    let axes = bound.positive.iter().zip(&bound.negative).take(3);
    let squares = axes.map(|(positive, negative)| positive.max(*negative).powi(2));
    squares.sum::<f64>().sqrt()
}

/// The share of its speed at which a move stays under the cap on every axis.
pub(super) fn factor(bound: &SpeedBound, top: &SpeedBound, cap: f64) -> f64 {
    let mut factor = 1.0_f64;
    for axis in 0..AXES {
        let largest = top.positive[axis].max(top.negative[axis]);
        let own = bound.positive[axis].max(bound.negative[axis]);
        if own > 0.0 {
            factor = factor.min(cap * largest / own);
        }
    }
    factor
}

pub(super) fn scale(bound: &SpeedBound, factor: f64) -> SpeedBound {
    SpeedBound {
        positive: bound.positive.map(|speed| speed * factor),
        negative: bound.negative.map(|speed| speed * factor),
        ..*bound
    }
}
