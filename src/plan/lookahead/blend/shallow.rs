//! The circle in a shallow corner of two lines that is run at full speed.
//!
//! Input: the lines' directions and what they give up. Output: the same circle as
//! [`super::Corner`] gives, without most of the roots and divisions and without
//! an arc sine.
//!
//! With c and s of half the turn h, `t = c/s`, the circle that takes d of each
//! line has the radius `d/t` and the length `2·d·h/t`. Where the speed is known,
//! the least of three circles is one of two: the largest that the lines have room
//! for, and that which takes as long as two ramps, `R·2h = 2·v²/a`. A ramp that is
//! too short for v wants the former. With `a² = n²/m`, n the normal and m the
//! largest of its parts over the limits, what decides has squares alone.

use super::super::super::arc::LINUXCNC_NORMAL_SHARE as NORMAL_SHARE;
use super::super::super::limits::lower;
use super::super::vector::{Vector, add, cross, dot, sub};
use super::corner::{Rounding, legs_give, steepest};
use super::{ARC_LENGTH_MIN_MM, Axes, Leg};

/// Between these lies the square of the change of direction.
const CHANGE2_MIN: f64 = 1e-8;
const TAN2_MAX: f64 = 0.01;
/// Not above 1 + sin θ there, θ half of the angle inside.
const ONE_AND_SIN: f64 = 1.99;
/// What rounding may make of a comparison, as a share.
const ROUNDING: f64 = 1e-9;

/// The circle in a corner of two lines that is run at full speed.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Rounded {
    /// What it takes from each line, mm.
    pub trim: f64,
    pub length_mm: f64,
    pub curvature_per_mm: f64,
}

impl Rounded {
    /// Between two lines that ask for the same speed. `None`: the corner is not
    /// shallow, or nearly slows the motion down.
    #[inline]
    pub fn shallow(legs: [&Leg; 2], axes: &Axes, inverse_accel: Vector) -> Option<Self> {
        let (u, w) = (legs[0].tangent, legs[1].tangent);
        let speed = legs[0].target_speed();
        let [give_mm, other_mm] = legs_give(legs);
        let give_mm = lower(give_mm, other_mm);
        let tolerance_mm = lower(legs[0].tolerance(), legs[1].tolerance());
        let (sum, change) = (add(u, w), sub(w, u));
        let (sum2, change2) = (dot(sum, sum), dot(change, change));
        let give2 = give_mm * give_mm;
        // cos θ/(1 − sin θ) of the tolerance, cos θ half of the change.
        let tolerated = 2.0 * ONE_AND_SIN * tolerance_mm;
        let free = tolerated * tolerated > give2 * change2;
        if change2 < CHANGE2_MIN || change2 > TAN2_MAX * sum2 || !free || speed > axes.least_speed {
            return None;
        }
        let across2 = 0.25 * sum2 * change2;
        let inverse2 = inverse_accel.map(|inverse| inverse * inverse);
        let most = steepest(cross(u, w), across2, inverse2);
        let speed2 = speed * speed;
        let needed = speed2 * speed2 * most;
        let room = NORMAL_SHARE * give_mm * sum2;
        if room * room < 4.0 * (1.0 + ROUNDING) * needed {
            return None;
        }
        let tan2 = change2 / sum2;
        let arc = angle_over_tangent(tan2);
        let trim = if needed < give2 * across2 * arc * arc {
            speed2 * (most / across2).sqrt() / arc
        } else {
            give_mm
        };
        let length_mm = 2.0 * trim * arc;
        (length_mm >= ARC_LENGTH_MIN_MM * (1.0 + ROUNDING)).then(|| Self {
            trim,
            length_mm,
            curvature_per_mm: tan2.sqrt() / trim,
        })
    }

    /// Of any corner, with its circle.
    pub fn of(rounding: &Rounding) -> Self {
        Self {
            trim: rounding.trim,
            length_mm: rounding.radius * rounding.sweep,
            curvature_per_mm: 1.0 / rounding.radius,
        }
    }
}

/// An angle over its tangent, by the square of that: atan(t)/t up to [`TAN2_MAX`].
#[inline]
fn angle_over_tangent(tan2: f64) -> f64 {
    let tan4 = tan2 * tan2;
    let near = (1.0 - (1.0 / 3.0) * tan2) + tan4 * (1.0 / 5.0 - (1.0 / 7.0) * tan2);
    let far = (1.0 / 9.0 - (1.0 / 11.0) * tan2) + tan4 * (1.0 / 13.0 - (1.0 / 15.0) * tan2);
    near + tan4 * tan4 * far
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_over_tangents() {
        for i in 1..=100 {
            let t = 0.001 * f64::from(i);
            let error = angle_over_tangent(t * t) - libm::atan(t) / t;
            assert!(error.abs() < 4e-16, "{t}: {error}");
        }
    }
}
