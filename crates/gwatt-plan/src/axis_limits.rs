//! The limits of single axes during a move.

use super::overrides::{Caps, Overrides};
use gwatt_machine::{Axis, Machine};
use gwatt_motion::{Move, MoveKind};

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
