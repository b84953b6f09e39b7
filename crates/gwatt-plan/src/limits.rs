//! Limits: how fast a move's path may run and how hard it may speed up.
//!
//! Input: machine, move, overrides and caps. Output: [`PathLimits`]. On a
//! straight path with direction `u` (change of an axis per unit of path)
//! `v ≤ v_n/|u_n|`, `a ≤ a_n/|u_n|` and `j ≤ j_n/|u_n|` for each axis n.

use super::arc;
use super::trajectory::{Caps, Overrides};
use gwatt_machine::{Axis, Machine};
use gwatt_motion::{Move, MoveKind};

/// Speed in mm/s, acceleration in mm/s² and jerk in mm/s³ that a path permits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PathLimits {
    /// Along the path.
    pub speed_mm_s: f64,
    /// Along the path.
    pub accel_mm_s2: f64,
    /// Along the path; infinite: no limit.
    pub jerk_mm_s3: f64,
}

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

/// The lower of two limits; one that is not a number (an override of 0 on an
/// infinite feed) counts as none. `f64::min` is several instructions more.
#[inline]
pub(super) fn lower(limit: f64, other: f64) -> f64 {
    if other < limit { other } else { limit }
}

/// Acceleration limit of an axis in force, mm/s².
#[inline]
pub(super) fn accel(mv: &Move, axis: usize, caps: &Caps) -> f64 {
    caps.accel_mm_s2.as_ref().unwrap_or(&mv.accel_mm_s2)[axis] * caps.accel_factor
}

/// Jerk limit of an axis during a move, in mm/s³; infinite where it has none.
#[inline]
pub(super) fn jerk(axis: &Axis, mv: &Move) -> f64 {
    own_jerk(axis) * mv.jerk_factor
}

/// The machine's own.
#[inline]
pub(super) fn own_jerk(axis: &Axis) -> f64 {
    if axis.jerk_mm_s3 > 0.0 {
        axis.jerk_mm_s3
    } else {
        f64::INFINITY
    }
}

/// Share of the rapid speed that a rapid runs at; feeds are capped by the
/// whole rapid speed, or by more where the program raised it.
#[inline]
pub(super) fn rapid_factor(mv: &Move, overrides: Overrides, caps: &Caps) -> f64 {
    match mv.kind {
        MoveKind::Rapid => mv.rapid_factor * overrides.rapid * caps.rapid_factor,
        _ => mv.rapid_factor.max(1.0),
    }
}

/// Override of a move at a feed: threads follow the spindle, a tap may follow
/// either.
#[inline]
pub(super) fn feed_factor(kind: MoveKind, overrides: Overrides) -> f64 {
    match kind {
        MoveKind::Thread => overrides.spindle,
        MoveKind::Tap => overrides.feed.max(overrides.spindle),
        _ => overrides.feed,
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

/// The axes that move, by index.
#[inline]
pub(super) fn moving<'a>(
    machine: &'a Machine,
    mv: &Move,
) -> impl Iterator<Item = (usize, &'a Axis)> + use<'a> {
    mv.moving
        .iter()
        .filter_map(|axis| Some((axis, machine.axes.get(axis)?.as_ref()?)))
}
