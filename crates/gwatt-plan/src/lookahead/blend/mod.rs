//! Blend arcs: how `LinuxCNC` 2.9 rounds the corner of two elements in G64.
//!
//! Input: both sides of a joint. Output: the circle, what it takes from each
//! side, and the speed that it is planned for. Facts from the planner's source
//! (`blendmath.c`) and measurements; lengths in mm, angles in rad.
//!
//! ```text
//!        P          θ half the inside angle, φ = π − 2θ the turn. A circle of
//!       ╱│╲         radius R stands R/sin θ from P on the bisector, touches
//!      ╱ │ ╲        the sides d = R/tan θ from P and passes P at a distance of
//!     ╱ (R) ╲       R/sin θ − R: the tolerance, so R = s·p/(1 − s).
//! ```

mod arcs;
mod corner;
mod side;

use super::vector::{Vector, angle, scale};
use side::{ANGLE_MIN, ARC_LENGTH_MIN_MM};
pub(super) use side::{Axes, Circle, Fit, Leg, Side};

pub(super) use corner::Corner;

/// The blend of a joint, if there is one that fits; `cycle_s` is the servo's.
pub(super) fn fit(sides: [&Side; 2], axes: &Axes, accel: Vector, cycle_s: f64) -> Option<Fit> {
    let legs = sides.map(|side| &side.leg);
    let corner = Corner::of(legs[0].tangent, legs[1].tangent)?;
    if sides.iter().all(|side| side.circle.is_none()) {
        let rounding = corner.round_lines(legs, axes, accel)?;
        return Some(corner.fit(legs, &rounding));
    }
    arcs::fit(corner, sides, axes, accel, cycle_s)
}

/// The inside angle of a corner.
pub(super) fn angle_between(before: Vector, after: Vector) -> f64 {
    angle(scale(before, -1.0), after)
}
