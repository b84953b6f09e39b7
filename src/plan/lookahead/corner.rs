//! Corner speeds of controllers that run through the corner itself.
//!
//! Input: the elements on both sides. Output: the largest squared speed at
//! which the path may pass their joint.
//!
//! With `s` the sine of half the inside angle (`cos = −u·w` of the directions),
//! a circle that touches both sides and stays the distance d from the corner
//! has the radius `R = d·s/(1 − s)`, and is run at `v² = a·R` (Jeon 2011).

use std::f64::consts::{FRAC_PI_4, SQRT_2};

use super::element::Element;
use crate::machine::{AXES, AxisId, AxisValues, CornerAngle, CornerRule};

/// Cosines beyond this are no corner, or a reversal.
const STRAIGHT: f64 = 0.999_999;
const LINEAR: usize = 3;
const EXTRUDER: usize = AxisId::E as usize;

/// The largest squared speed at the joint of two elements; not yet limited by
/// their own speeds. 0: they meet at rest.
#[inline]
pub(super) fn speed2<T>(rule: &CornerRule, before: &Element<T>, after: &Element<T>) -> f64 {
    match rule {
        CornerRule::LinuxCnc { .. } => 0.0,
        CornerRule::JunctionDeviation {
            deviation_mm,
            angle,
            per_axis,
            small_block_mm,
        } => deviation(
            *deviation_mm,
            *angle,
            *per_axis,
            *small_block_mm,
            before,
            after,
        ),
        CornerRule::ClassicJerk { step_mm_s } => jerk(step_mm_s, before, after),
        CornerRule::SquareCorner {
            velocity_mm_s,
            extruder_step_mm_s,
        } => square(*velocity_mm_s, *extruder_step_mm_s, before, after),
        CornerRule::SpeedStep {
            step_mm_s,
            same_kind_only,
        } => step(step_mm_s, *same_kind_only, before, after),
    }
}

/// Squared speed at which motion may begin from rest.
pub(super) fn start2<T>(rule: &CornerRule, element: &Element<T>) -> f64 {
    let CornerRule::ClassicJerk { step_mm_s } = rule else {
        return 0.0;
    };
    let mut speed = element.top_mm_s();
    for (step, change) in step_mm_s.iter().zip(&element.start) {
        if *change != 0.0 {
            speed = speed.min(step / change.abs());
        }
    }
    speed * speed
}

fn dot(a: &AxisValues, b: &AxisValues, axes: usize) -> f64 {
    a.iter().zip(b).take(axes).map(|(a, b)| a * b).sum()
}

/// The cosine of the inside angle, negative for a shallow corner.
fn cosine(axes: usize, before: &AxisValues, after: &AxisValues) -> Option<f64> {
    let length2 = dot(before, before, axes) * dot(after, after, axes);
    if length2 <= 0.0 {
        return None;
    }
    Some((-dot(before, after, axes) / length2.sqrt()).clamp(-1.0, 1.0))
}

fn deviation<T>(
    deviation_mm: f64,
    angle: CornerAngle,
    per_axis: bool,
    small_block_mm: f64,
    before: &Element<T>,
    after: &Element<T>,
) -> f64 {
    let axes = match angle {
        CornerAngle::AllAxes => AXES,
        CornerAngle::Linear => LINEAR,
    };
    let Some(cos) = cosine(axes, &before.end, &after.start) else {
        return 0.0;
    };
    if cos > STRAIGHT {
        return 0.0;
    }
    if cos < -STRAIGHT {
        return f64::INFINITY;
    }
    let accel = if per_axis {
        let mut change = [0.0; AXES];
        for (i, value) in change.iter_mut().enumerate().take(axes) {
            *value = after.start[i] - before.end[i];
        }
        let length = dot(&change, &change, axes).sqrt();
        let limits = &after.axis_accel_mm_s2;
        let permitted = change.iter().zip(limits).filter(|(d, _)| **d != 0.0);
        permitted.fold(after.accel_mm_s2, |accel, (d, limit)| {
            accel.min(limit * length / d.abs())
        })
    } else {
        after.accel_mm_s2
    };
    let s = (0.5 * (1.0 - cos)).sqrt();
    let mut v2 = accel * deviation_mm * s / (1.0 - s);
    // Chords of a circle: radius = length / turn.
    if after.length_mm < small_block_mm && cos < -std::f64::consts::FRAC_1_SQRT_2 {
        let turn = libm::acos(-cos);
        if turn < FRAC_PI_4 {
            v2 = v2.min(accel * after.length_mm / turn);
        }
    }
    v2
}

/// A change of direction counts as the larger of both parts, as Marlin has it.
fn jerk<T>(steps: &AxisValues, before: &Element<T>, after: &Element<T>) -> f64 {
    let speed = before.top_mm_s().min(after.top_mm_s());
    let mut factor = 1.0_f64;
    for ((step, exit), entry) in steps.iter().zip(&before.end).zip(&after.start) {
        let (exit, entry) = (exit * speed, entry * speed);
        let jump = if exit * entry < 0.0 {
            exit.abs().max(entry.abs())
        } else {
            (exit - entry).abs()
        };
        if jump * factor > *step {
            factor = step / jump;
        }
    }
    let safe2 = start2(&CornerRule::ClassicJerk { step_mm_s: *steps }, after);
    let v2 = (speed * factor) * (speed * factor);
    // Both sides could as well begin and end on their own.
    let before_safe2 = start2(&CornerRule::ClassicJerk { step_mm_s: *steps }, before);
    let threshold2 = v2 * (0.99 * 0.99);
    if safe2 > threshold2 && before_safe2 > threshold2 {
        safe2
    } else {
        v2
    }
}

fn square<T>(v90: f64, extruder_step: f64, before: &Element<T>, after: &Element<T>) -> f64 {
    let Some(cos) = cosine(LINEAR, &before.end, &after.start) else {
        return 0.0;
    };
    let turn = (after.start[EXTRUDER] - before.end[EXTRUDER]).abs();
    let extruder2 = if turn > 0.0 {
        (extruder_step / turn) * (extruder_step / turn)
    } else {
        f64::INFINITY
    };
    let s = (0.5 * (1.0 - cos)).max(0.0).sqrt();
    let c = (0.5 * (1.0 + cos)).max(0.0).sqrt();
    if s >= 1.0 || c <= 0.0 {
        return extruder2;
    }
    // Half a block may bend into the circle: v² = a·(L/2)·tan(half angle).
    let half_tan = 0.5 * s / c;
    let bent = (after.length_mm * after.accel_mm_s2).min(before.length_mm * before.accel_mm_s2);
    (v90 * v90 * (SQRT_2 - 1.0) * s / (1.0 - s))
        .min(bent * half_tan)
        .min(extruder2)
}

fn step<T>(
    steps: &AxisValues,
    same_kind_only: bool,
    before: &Element<T>,
    after: &Element<T>,
) -> f64 {
    let prints = |element: &Element<T>| {
        let linear = element
            .start
            .iter()
            .take(LINEAR)
            .any(|change| *change != 0.0);
        (linear, element.start[EXTRUDER] > 0.0)
    };
    if same_kind_only && prints(before) != prints(after) {
        return 0.0;
    }
    let mut v = f64::INFINITY;
    for ((step, exit), entry) in steps.iter().zip(&before.end).zip(&after.start) {
        let change = (entry - exit).abs();
        if change > 0.0 {
            v = v.min(step / change);
        }
    }
    v * v
}
