//! Limits: how fast a move's path may run and how hard it may speed up.
//!
//! Input: machine, move, overrides and caps. Output: [`PathLimits`]. On a
//! straight path with direction `u` (change of an axis per unit of path)
//! `v ≤ v_n/|u_n|`, `a ≤ a_n/|u_n|` and `j ≤ j_n/|u_n|` for each axis n.

use super::arc;
use super::axis_limits::{accel, feed_factor, jerk, lower, moving, rapid_factor};
use super::overrides::{Caps, Overrides};
use super::path_limits::PathLimits;
use gwatt_machine::Machine;
use gwatt_motion::{Move, MoveKind};

impl PathLimits {
    /// The limits of a move's path.
    #[inline]
    pub fn of(machine: &Machine, mv: &Move, overrides: Overrides, caps: &Caps) -> Self {
        let axes = match &mv.arc {
            Some(arc) => arc::limits(machine, mv, arc, caps),
            None => straight(machine, mv, overrides, caps),
        };
        let feed = match mv.kind {
            MoveKind::Rapid => f64::INFINITY,
            _ => mv.feed_mm_s * feed_factor(mv.kind, overrides),
        };
        let path_accel = mv.path_accel_mm_s2 * caps.accel_factor;
        let speed = lower(lower(f64::MAX, axes.speed_mm_s), caps.speed_mm_s);
        let accel = lower(lower(f64::MAX, axes.accel_mm_s2), caps.path_accel_mm_s2);
        Self {
            speed_mm_s: lower(speed, feed),
            accel_mm_s2: lower(accel, path_accel),
            jerk_mm_s3: axes.jerk_mm_s3,
        }
    }

    /// The limits of one axis of an independent rapid.
    pub fn of_rapid_axis(
        machine: &Machine,
        mv: &Move,
        axis: usize,
        overrides: Overrides,
        caps: &Caps,
    ) -> Self {
        let share = (mv.end[axis] - mv.start[axis]).abs() / mv.length_mm;
        let capped = if caps.speed_mm_s < f64::INFINITY {
            caps.speed_mm_s * share
        } else {
            f64::INFINITY
        };
        let own = machine.axes[axis].as_ref();
        let rapid = own.map_or(f64::MAX, |limit| {
            limit.rapid_mm_s * rapid_factor(mv, overrides, caps)
        });
        Self {
            speed_mm_s: rapid.min(capped),
            accel_mm_s2: accel(mv, axis, caps).min(f64::MAX),
            jerk_mm_s3: own.map_or(f64::INFINITY, |limit| jerk(limit, mv)),
        }
    }

    /// False where speed or acceleration is 0 and the move would never end.
    #[inline]
    pub fn permit_motion(self) -> bool {
        self.speed_mm_s > 0.0 && self.accel_mm_s2 > 0.0
    }
}

/// What the axes permit on a straight path.
#[inline]
pub(super) fn straight(
    machine: &Machine,
    mv: &Move,
    overrides: Overrides,
    caps: &Caps,
) -> PathLimits {
    let factor = rapid_factor(mv, overrides, caps);
    let mut limits = PathLimits::NONE;
    for (axis, limit) in moving(machine, mv) {
        let accel = accel(mv, axis, caps);
        limits.take(mv, axis, limit.rapid_mm_s * factor, accel, jerk(limit, mv));
    }
    limits
}

impl PathLimits {
    /// No limit.
    pub const NONE: Self = Self {
        speed_mm_s: f64::INFINITY,
        accel_mm_s2: f64::INFINITY,
        jerk_mm_s3: f64::INFINITY,
    };

    /// Lowers the limits to what an axis permits that moves in proportion to
    /// the path.
    #[inline]
    pub fn take(&mut self, mv: &Move, axis: usize, speed: f64, accel: f64, jerk: f64) {
        let distance = (mv.end[axis] - mv.start[axis]).abs();
        if distance > 0.0 {
            let path_per_axis = mv.length_mm / distance;
            self.speed_mm_s = lower(self.speed_mm_s, speed * path_per_axis);
            self.accel_mm_s2 = lower(self.accel_mm_s2, accel * path_per_axis);
            self.jerk_mm_s3 = lower(self.jerk_mm_s3, jerk * path_per_axis);
        }
    }
}
