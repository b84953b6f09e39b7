//! How far the directions of an arc reach.

use gwatt_machine::{ArcRule, Machine};
use gwatt_motion::{Arc, Move};
use std::f64::consts::PI;

/// Share of the acceleration limit that `LinuxCNC` 2.9 gives to turning: √3/2.
pub(super) const LINUXCNC_NORMAL_SHARE: f64 = 0.866_025_403_784_438_6;

/// Share that it leaves for speeding up.
pub(super) const LINUXCNC_TANGENTIAL_SHARE: f64 = 0.5;

/// Smallest and largest tangent component of one axis over a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TangentRange {
    /// At most 0 unless the axis only moves in + direction.
    pub min: f64,
    /// At least 0 unless the axis only moves in − direction.
    pub max: f64,
}

impl TangentRange {
    /// The largest size.
    pub fn largest(self) -> f64 {
        self.max.max(-self.min)
    }
}

/// The tangents of the first and the second axis of the plane.
pub(super) fn tangent_ranges(arc: &Arc) -> [TangentRange; 2] {
    let sense = if arc.sweep_rad < 0.0 { -1.0 } else { 1.0 };
    let (sin0, cos0) = libm::sincos(arc.start_angle_rad);
    let (sin1, cos1) = libm::sincos(arc.start_angle_rad + arc.sweep_rad);
    // A sinusoid has an extreme inside wherever its derivative changes sign.
    let first = range(arc, [-sense * sin0, -sense * sin1], [-cos0, -cos1]);
    let second = range(arc, [sense * cos0, sense * cos1], [-sin0, -sin1]);
    [first, second]
}

/// Range of a unit sinusoid from its values at both ends and its derivatives
/// in the sense of the sweep.
pub(super) fn range(arc: &Arc, value: [f64; 2], slope: [f64; 2]) -> TangentRange {
    let (mut min, mut max) = (value[0].min(value[1]), value[0].max(value[1]));
    let sweep = arc.sweep_rad.abs();
    if sweep >= 2.0 * PI {
        return TangentRange {
            min: -1.0,
            max: 1.0,
        };
    }
    let same_sign = slope[0] * slope[1] > 0.0;
    // Same slopes at both ends: no extreme inside within half a turn, one of
    // each kind beyond it. Opposite slopes: the one that the first leads to.
    if same_sign && sweep > PI {
        (min, max) = (-1.0, 1.0);
    } else if !same_sign {
        let rises = if slope[0] == 0.0 {
            slope[1] < 0.0
        } else {
            slope[0] > 0.0
        };
        if rises {
            max = 1.0;
        } else {
            min = -1.0;
        }
    }
    TangentRange { min, max }
}

/// Share of the path that runs in the plane, per unit of path.
pub(super) fn plane_share(mv: &Move, arc: &Arc) -> f64 {
    arc.radius_mm * arc.sweep_rad.abs() / mv.length_mm
}

/// The largest part of the speed in the plane that each of its axes has to keep
/// up with.
pub(super) fn largest_parts(machine: &Machine, arc: &Arc) -> [f64; 2] {
    match machine.controller.planner.arc_rule {
        ArcRule::Shared => tangent_ranges(arc).map(TangentRange::largest),
        // Whatever directions the arc meets.
        ArcRule::LinuxCnc => [1.0; 2],
    }
}

/// The axes of an arc's plane that move, each with its largest speed at a path speed
/// of 1.
pub(super) fn plane_axes(machine: &Machine, mv: &Move, arc: &Arc) -> [(usize, f64); 2] {
    let share = plane_share(mv, arc);
    let [first, second] = largest_parts(machine, arc);
    let [a, b] = arc.plane;
    [(a, share * first), (b, share * second)]
}
