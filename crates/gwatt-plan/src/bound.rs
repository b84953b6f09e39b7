//! Bounds of the axes' speeds that hold however a controller blends.
//!
//! Input: machine, move, overrides and caps. Output: a [`SpeedBound`], the
//! largest speed of each axis in each direction that the feed allows. It is
//! not lowered where a short move never reaches its speed, since blending may
//! carry the speed through.

use super::arc::{AxisSpeeds, axis_speed, excess, runs_chords};
use super::arc_plane::{plane_share, tangent_ranges};
use super::axis_limits::{feed_factor, moving, rapid_factor};
use super::lookahead::Blend;
use super::overrides::{Caps, Overrides};
use super::path_limits::PathLimits;
use gwatt_machine::{AXES, AxisSet, AxisValues, Machine, RapidPath};
use gwatt_motion::{Arc, FeedMode, Move, MoveKind};
use std::f64::consts::{FRAC_PI_2, PI};

/// Largest speed of each axis, mm/s or degrees/s, not negative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedBound {
    /// In + direction.
    pub positive: AxisValues,
    /// In − direction.
    pub negative: AxisValues,
    /// The share by which the controller may exceed the axes' accelerations; 0 but
    /// for rules that do.
    pub excess: f64,
}

impl SpeedBound {
    /// Raises each bound to that of `other`: a block and its neighbours.
    pub fn include(&mut self, other: &Self) {
        for axis in 0..AXES {
            self.positive[axis] = self.positive[axis].max(other.positive[axis]);
            self.negative[axis] = self.negative[axis].max(other.negative[axis]);
        }
        self.excess = self.excess.max(other.excess);
    }

    /// Raises the bound in the direction of a signed speed.
    fn raise(&mut self, axis: usize, speed: f64) {
        if speed > 0.0 {
            self.positive[axis] = self.positive[axis].max(speed);
        } else {
            self.negative[axis] = self.negative[axis].max(-speed);
        }
    }
}

/// The largest speeds that the feed and the axes allow in a move.
#[must_use]
pub fn speed_bound(machine: &Machine, mv: &Move, overrides: Overrides, caps: Caps) -> SpeedBound {
    let mut bound = SpeedBound::default();
    if mv.kind == MoveKind::Dwell {
        return bound;
    }
    if !mv.unknown_start.is_empty() {
        return unknown(machine, mv, overrides, &caps);
    }
    if mv.stray.strays() && mv.length_mm > 0.0 {
        return strayed(machine, mv, overrides, &caps);
    }
    bound.excess = excess(machine, mv);
    if mv.length_mm > 0.0 {
        let v = PathLimits::of(machine, mv, overrides, &caps).speed_mm_s;
        along(machine, mv, v, overrides, &caps, &mut bound);
    }
    bound
}

/// The largest speeds in a move that may be blended with others.
///
/// Arcs are not slowed down for their radius: a blend or a filter may cut
/// them short, and controllers differ in what they permit.
#[must_use]
pub fn blended_bound(machine: &Machine, mv: &Move, overrides: Overrides) -> SpeedBound {
    let caps = Caps::default();
    let strays = mv.stray.strays() || !mv.unknown_start.is_empty();
    if mv.arc.is_none() || strays || mv.length_mm <= 0.0 {
        return speed_bound(machine, mv, overrides, caps);
    }
    let mut bound = SpeedBound {
        excess: excess(machine, mv),
        ..SpeedBound::default()
    };
    let v = blended_speed(machine, mv, overrides);
    along(machine, mv, v, overrides, &caps, &mut bound);
    bound
}

/// The largest speeds of a move that runs along one straight path at a speed of
/// `v`; its start is known and it has a length.
#[must_use]
#[inline]
pub fn path_bound(machine: &Machine, mv: &Move, v: f64) -> SpeedBound {
    let mut bound = SpeedBound::default();
    for (axis, _) in moving(machine, mv) {
        let distance = mv.end[axis] - mv.start[axis];
        if distance != 0.0 {
            let speed = v * (distance.abs() / mv.length_mm);
            bound.raise(axis, speed.copysign(distance));
        }
    }
    bound
}

/// What a stretch of a path asks of its axes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathShares {
    /// The largest share of the path speed, and of the acceleration along it, that
    /// each axis takes in either direction.
    pub along: SpeedBound,
    /// The largest part of the squared path speed that it takes as acceleration, since
    /// the path turns, 1/mm.
    pub across: AxisValues,
}

impl PathShares {
    /// Of a path begun at a known place, of a length (a line, an arc or a helix): the
    /// stretch between two places on it, mm.
    #[must_use]
    pub fn of(mv: &Move, [from_mm, to_mm]: [f64; 2]) -> Self {
        let mut shares = Self::default();
        for axis in mv.moving.iter().filter(|axis| !in_plane(mv, *axis)) {
            let share = (mv.end[axis] - mv.start[axis]) / mv.length_mm;
            shares.along.raise(axis, share);
        }
        if let Some(arc) = &mv.arc {
            let turned = |mm: f64| arc.sweep_rad * (mm / mv.length_mm);
            let stretch = Arc {
                start_angle_rad: arc.start_angle_rad + turned(from_mm),
                sweep_rad: turned(to_mm - from_mm),
                ..*arc
            };
            let share = plane_share(mv, arc);
            raise_plane(&stretch, share, &mut shares.along);
            // Towards the centre is a quarter of a turn on.
            let inward = Arc {
                start_angle_rad: stretch.start_angle_rad + FRAC_PI_2.copysign(arc.sweep_rad),
                ..stretch
            };
            for (axis, range) in arc.plane.into_iter().zip(tangent_ranges(&inward)) {
                shares.across[axis] = range.largest() * share * share / arc.radius_mm;
            }
        }
        shares
    }

    /// The same of a stretch of a blend, the line that leads into it included.
    #[must_use]
    pub fn of_blend(blend: &Blend, ends_mm: [f64; 2]) -> Self {
        let turned = ends_mm.map(|mm| (mm - blend.lead_mm).max(0.0) / blend.radius_mm);
        let mut shares = Self::default();
        for (axis, (tangent, normal)) in blend.tangent.into_iter().zip(blend.normal).enumerate() {
            for share in swung([tangent, normal], turned) {
                shares.along.raise(axis, share);
            }
            // Towards the centre is a quarter of a turn on.
            let inward = swung([normal, -tangent], turned).into_iter();
            let largest = inward.fold(0.0, |most: f64, share| most.max(share.abs()));
            shares.across[axis] = largest / blend.radius_mm;
        }
        shares
    }
}

/// The least and the largest of `t·cos θ + n·sin θ` between two angles, rad.
fn swung([tangent, normal]: [f64; 2], ends: [f64; 2]) -> [f64; 2] {
    let at = |angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        tangent * cos + normal * sin
    };
    let [first, last] = ends.map(at);
    let swing = (tangent * tangent + normal * normal).sqrt();
    let largest = libm::atan2(normal, tangent);
    let inside = |angle: f64| {
        let mut turns = [-2.0 * PI, 0.0, 2.0 * PI].into_iter();
        turns.any(|turn| (ends[0]..=ends[1]).contains(&(angle + turn)))
    };
    [
        if inside(largest + PI) {
            -swing
        } else {
            first.min(last)
        },
        if inside(largest) {
            swing
        } else {
            first.max(last)
        },
    ]
}

/// Path speed in mm/s (degrees/s) to which [`blended_bound`] belongs.
#[must_use]
pub fn blended_speed(machine: &Machine, mv: &Move, overrides: Overrides) -> f64 {
    if mv.stray.strays() {
        // What the axes permit along the move says nothing of the path.
        let axes = moving(machine, mv).map(|(_, limit)| limit.rapid_mm_s);
        let most = axes.sum::<f64>() * rapid_factor(mv, overrides, &Caps::default());
        return (mv.feed_mm_s * overrides.feed).min(most);
    }
    match &mv.arc {
        Some(arc) => (mv.feed_mm_s * overrides.feed).min(axis_speed(machine, mv, arc)),
        None => PathLimits::of(machine, mv, overrides, &Caps::default()).speed_mm_s,
    }
}

/// The bounds of the axes at the path speed `v`.
fn along(
    machine: &Machine,
    mv: &Move,
    v: f64,
    overrides: Overrides,
    caps: &Caps,
    bound: &mut SpeedBound,
) {
    let independent = mv.kind == MoveKind::Rapid && machine.path.rapid == RapidPath::Independent;
    for (axis, _) in moving(machine, mv) {
        let distance = mv.end[axis] - mv.start[axis];
        let speed = if independent {
            PathLimits::of_rapid_axis(machine, mv, axis, overrides, caps).speed_mm_s
        } else {
            v * (distance.abs() / mv.length_mm)
        };
        if distance != 0.0 && !in_plane(mv, axis) {
            bound.raise(axis, speed.copysign(distance));
        }
    }
    if let Some(arc) = &mv.arc {
        raise_plane(arc, v * plane_share(mv, arc), bound);
        if runs_chords(machine) {
            // Of the fastest chord only one axis may be at its limit.
            let limits = AxisSpeeds::of(machine, mv, arc).plane_mm_s;
            for (axis, limit) in arc.plane.into_iter().zip(limits) {
                bound.positive[axis] = bound.positive[axis].min(limit);
                bound.negative[axis] = bound.negative[axis].min(limit);
            }
        }
    }
}

/// The bounds of the axes of an arc's plane at the speed `v` in it.
fn raise_plane(arc: &Arc, v: f64, bound: &mut SpeedBound) {
    for (axis, range) in arc.plane.into_iter().zip(tangent_ranges(arc)) {
        bound.raise(axis, v * range.max.max(0.0));
        bound.raise(axis, v * range.min.min(0.0));
    }
}

/// True for the plane axes of an arc.
fn in_plane(mv: &Move, axis: usize) -> bool {
    mv.arc.is_some_and(|arc| arc.plane.contains(&axis))
}

/// The bounds of a move whose path is another one: of the path speed each axis takes as
/// much as along the move, and of X, Y and Z as much more or less as the directions may
/// differ. What the axes themselves permit along the move says nothing of that path.
fn strayed(machine: &Machine, mv: &Move, overrides: Overrides, caps: &Caps) -> SpeedBound {
    let mut bound = SpeedBound {
        excess: (1.0 + excess(machine, mv)) * (1.0 + mv.stray.accel) - 1.0,
        ..SpeedBound::default()
    };
    let speed = (mv.feed_mm_s * feed_factor(mv.kind, overrides)).min(caps.speed_mm_s);
    let factor = rapid_factor(mv, overrides, caps);
    let along = PathShares::of(mv, [0.0, mv.length_mm]).along;
    for (axis, limit) in moving(machine, mv) {
        let more = if axis < 3 { mv.stray.direction } else { 0.0 };
        let largest = limit.rapid_mm_s * factor;
        let of = |share: f64| {
            let share = share + more;
            // An F that is not known is infinite.
            let speed = if share > 0.0 { speed * share } else { 0.0 };
            speed.min(largest)
        };
        bound.positive[axis] = of(along.positive[axis]);
        bound.negative[axis] = of(along.negative[axis]);
    }
    bound
}

/// Both directions at what the axis and F allow: from an unknown start neither
/// the direction of the path nor its length is known.
fn unknown(machine: &Machine, mv: &Move, overrides: Overrides, caps: &Caps) -> SpeedBound {
    let mut bound = SpeedBound::default();
    let commanded = AxisSet(mv.moving.0 | mv.unknown_start.0);
    let factor = rapid_factor(mv, overrides, caps);
    let feed = match mv.kind {
        MoveKind::Rapid => caps.speed_mm_s,
        _ => (mv.feed_mm_s * feed_factor(mv.kind, overrides)).min(caps.speed_mm_s),
    };
    for axis in commanded.iter() {
        let Some(limit) = machine.axes.get(axis).and_then(Option::as_ref) else {
            continue;
        };
        let mut speed = limit.rapid_mm_s * factor;
        if mv.feed_mode != FeedMode::InverseTime && feed_speaks_for(axis, commanded) {
            speed = speed.min(feed);
        }
        bound.positive[axis] = speed;
        bound.negative[axis] = speed;
    }
    bound
}

/// Whether no axis of a path can exceed the feed: X, Y, Z always, others only
/// when their kind moves alone, since F speaks for X, Y, Z where these move
/// and the others have to keep up.
fn feed_speaks_for(axis: usize, commanded: AxisSet) -> bool {
    const XYZ: u16 = 0b00_0000_0111;
    const ABC: u16 = 0b00_0011_1000;
    const UVW: u16 = 0b01_1100_0000;
    const E: u16 = 0b10_0000_0000;
    1_u16 << axis & XYZ != 0
        || [ABC, UVW, E]
            .into_iter()
            .any(|group| commanded.0 & !group == 0)
}
