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

use super::super::axis_limits::lower;
use super::vector::{Vector, angle, scale};
use gwatt_machine::{AxisValues, Machine};

pub(super) use corner::Corner;

/// Share of an element that the tolerance may be.
const TOLERANCE_SHARE: f64 = 0.25;
const ANGLE_MIN: f64 = 1e-6;
const ARC_LENGTH_MIN_MM: f64 = 1e-6;

/// The machine's limits; those of X, Y and Z are 0 for axes that it does not have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    exists: [bool; 3],
    pub speed: Vector,
    /// The lowest of them.
    pub least_speed: f64,
    /// Of all axes; infinite for those that the machine does not have.
    pub speeds: AxisValues,
    pub jerks: AxisValues,
}

impl Axes {
    pub fn of(machine: &Machine) -> Self {
        let axis = |i: usize| machine.axes.get(i).and_then(Option::as_ref);
        let speeds = [0, 1, 2].map(|i| axis(i).map(|axis| axis.rapid_mm_s));
        Self {
            exists: speeds.map(|speed| speed.is_some()),
            speed: speeds.map(Option::unwrap_or_default),
            least_speed: speeds.into_iter().flatten().fold(f64::INFINITY, f64::min),
            speeds: std::array::from_fn(|i| axis(i).map_or(f64::INFINITY, |axis| axis.rapid_mm_s)),
            jerks: std::array::from_fn(|i| {
                axis(i).map_or(f64::INFINITY, crate::axis_limits::own_jerk)
            }),
        }
    }

    pub fn accel(&self, limits: &AxisValues) -> Vector {
        self.masked([limits[0], limits[1], limits[2]])
    }

    /// The same of X, Y and Z.
    #[inline]
    pub fn masked(&self, limits: Vector) -> Vector {
        [0, 1, 2].map(|i| if self.exists[i] { limits[i] } else { 0.0 })
    }
}

/// One side of a joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub leg: Leg,
    /// Of an arc: from the joint to its centre, its radius, its angle and the
    /// normal of its plane.
    pub circle: Option<Circle>,
}

/// What a side of a joint is, straight or not.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg {
    /// Unit direction of motion at the joint.
    pub tangent: Vector,
    /// Length as programmed, and what earlier blends left of it.
    pub nominal_mm: f64,
    pub length_mm: f64,
    /// Largest speed, and the one asked for.
    pub max_speed: f64,
    pub asked_speed: f64,
    /// P of the program.
    pub tolerance_mm: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    pub center: Vector,
    pub radius: f64,
    pub angle: f64,
    pub normal: Vector,
}

/// A blend between two elements.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub radius: f64,
    pub sweep: f64,
    pub tangent: Vector,
    pub normal: Vector,
    /// What it takes from the first side and the second: mm of a line, rad of
    /// an arc.
    pub trims: [f64; 2],
    /// Speed that it is planned for, and acceleration of its plane.
    pub speed: f64,
    pub accel: f64,
}

impl Leg {
    #[inline]
    fn target_speed(&self) -> f64 {
        lower(self.asked_speed, self.max_speed)
    }

    #[inline]
    fn tolerance(&self) -> f64 {
        let most = self.nominal_mm * TOLERANCE_SHARE;
        if self.tolerance_mm == 0.0 {
            most
        } else {
            lower(self.tolerance_mm, most)
        }
    }
}

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
