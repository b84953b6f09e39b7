//! Both sides of a joint, what the machine permits there, and a blend that fits.

use super::super::super::axis_limits::lower;
use super::super::vector::Vector;
use gwatt_machine::{AxisValues, Machine};

/// Share of an element that the tolerance may be.
const TOLERANCE_SHARE: f64 = 0.25;

pub(super) const ANGLE_MIN: f64 = 1e-6;

pub(super) const ARC_LENGTH_MIN_MM: f64 = 1e-6;

/// The machine's limits; those of X, Y and Z are 0 for axes that it does not have.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Axes {
    pub(super) exists: [bool; 3],
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
pub(in super::super) struct Side {
    pub leg: Leg,
    /// Of an arc: from the joint to its centre, its radius, its angle and the
    /// normal of its plane.
    pub circle: Option<Circle>,
}

/// What a side of a joint is, straight or not.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Leg {
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
pub(in super::super) struct Circle {
    pub center: Vector,
    pub radius: f64,
    pub angle: f64,
    pub normal: Vector,
}

/// A blend between two elements.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Fit {
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
    pub(super) fn target_speed(&self) -> f64 {
        lower(self.asked_speed, self.max_speed)
    }

    #[inline]
    pub(super) fn tolerance(&self) -> f64 {
        let most = self.nominal_mm * TOLERANCE_SHARE;
        if self.tolerance_mm == 0.0 {
            most
        } else {
            lower(self.tolerance_mm, most)
        }
    }
}
