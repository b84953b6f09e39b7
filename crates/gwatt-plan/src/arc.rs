//! Arcs and helices: which directions they meet and how fast they may run.
//!
//! Input: an arc of a move. Output: the range of each plane axis' tangent over
//! the sweep, and the path limits under the controller's [`ArcRule`].
//!
//! With θ along the arc the plane axes have the tangents `τ = σ·(−sin θ, cos θ)`
//! (σ the sense of the sweep). Of a path of length L the plane sees the share
//! `ρ = r·|sweep|/L`; the rest belongs to the axes that follow in proportion.
//!
//! With v, a and j along the arc, of the third derivative of the position
//!
//! ```text
//! j − v³/r²   is along the tangent,   3·a·v/r   along the normal.
//! ```
//!
//! Each gets 1/√2 of the smallest jerk of the plane's axes, as acceleration is
//! shared, so that no axis exceeds its own at any angle; of the part along the
//! tangent turning (v³/r²) takes half at most, which limits the speed. The
//! acceleration is limited by the second at the largest speed that axes and
//! turning permit, whatever F asks for.
//!
//! Where drives have curves of force, turning takes its share of what they leave at
//! the speed of the arc; how the arc speeds up under them is the matter of `drive`.

use super::arc_plane::{
    LINUXCNC_NORMAL_SHARE, LINUXCNC_TANGENTIAL_SHARE, largest_parts, plane_axes, plane_share,
};
use super::axis_limits::lower;
use super::drive;
use super::overrides::Caps;
use super::path_limits::PathLimits;
use super::s_curve::cbrt_of_square;
use gwatt_machine::{ArcRule, AxisKind, Machine};
use gwatt_motion::{Arc, Move};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

/// √(1 + 3/4) − 1: all of an axis' acceleration along a helix, and √3/2 across.
const LINUXCNC_HELIX_EXCESS: f64 = 0.322_875_655_532_295_3;

/// The axes' own speeds on an arc or a helix.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisSpeeds {
    /// The largest of the plane's axes, mm/s; infinite of one that stands.
    pub plane_mm_s: [f64; 2],
    /// Path speed that the axes across the plane permit, mm/s.
    pub across_mm_s: f64,
    share: f64,
}

impl AxisSpeeds {
    pub fn of(machine: &Machine, mv: &Move, arc: &Arc) -> Self {
        let mut speeds = Self {
            plane_mm_s: [f64::INFINITY; 2],
            across_mm_s: f64::INFINITY,
            share: plane_share(mv, arc),
        };
        let raised = mv.rapid_factor.max(1.0);
        for (axis, limit) in crate::axis_limits::moving(machine, mv) {
            let speed = limit.rapid_mm_s * raised;
            if let Some(i) = arc.plane.iter().position(|&plane| plane == axis) {
                speeds.plane_mm_s[i] = speed;
            } else {
                let part = (mv.end[axis] - mv.start[axis]).abs() / mv.length_mm;
                speeds.across_mm_s = speeds.across_mm_s.min(speed / part);
            }
        }
        speeds
    }

    /// See [`axis_speed`].
    pub fn along_path(&self, machine: &Machine, arc: &Arc) -> f64 {
        if runs_chords(machine) {
            self.fastest(arc)
        } else {
            self.all_along(largest_parts(machine, arc))
        }
    }

    /// Path speed that is permitted all along the arc, of which its axes have these parts
    /// at most.
    fn all_along(&self, parts: [f64; 2]) -> f64 {
        let plane = self.plane_mm_s.into_iter().zip(parts);
        let plane = plane.map(|(speed, part)| speed / (self.share * part));
        plane.fold(self.across_mm_s, f64::min)
    }

    /// The largest path speed anywhere on the arc: each of its chords may run as fast as
    /// its own direction permits.
    fn fastest(&self, arc: &Arc) -> f64 {
        let [first, second] = self.plane_mm_s;
        // Where both axes are at their limits.
        let balanced = libm::atan2(second, first);
        let ends = [0.0, arc.sweep_rad].map(|turned| {
            let (sin, cos) = libm::sincos(arc.start_angle_rad + turned);
            self.all_along([sin.abs(), cos.abs()])
        });
        let meets = [balanced, PI - balanced, balanced - PI, -balanced]
            .into_iter()
            .any(|heading| meets(arc, heading));
        if meets {
            lower(self.across_mm_s, libm::hypot(first, second) / self.share)
        } else {
            ends[0].max(ends[1])
        }
    }
}

/// Whether a path along an arc heads to an angle, from the plane's first axis, somewhere.
fn meets(arc: &Arc, heading_rad: f64) -> bool {
    let start = arc.start_angle_rad + FRAC_PI_2.copysign(arc.sweep_rad);
    let turned = (heading_rad - start) * arc.sweep_rad.signum();
    turned.rem_euclid(2.0 * PI) <= arc.sweep_rad.abs()
}

/// Path speed that the axes' own speeds permit: all along the arc, or of its fastest chord
/// where the controller runs it as chords.
pub(super) fn axis_speed(machine: &Machine, mv: &Move, arc: &Arc) -> f64 {
    AxisSpeeds::of(machine, mv, arc).along_path(machine, arc)
}

/// Whether the controller runs arcs as chords.
pub(super) fn runs_chords(machine: &Machine) -> bool {
    let look_ahead = machine.controller.planner.look_ahead.as_ref();
    look_ahead.is_some_and(|rules| rules.chords.is_some())
}

/// What the axes and the arc rule permit.
pub(super) fn limits(machine: &Machine, mv: &Move, arc: &Arc, caps: &Caps) -> PathLimits {
    let share = plane_share(mv, arc);
    let parts = largest_parts(machine, arc);
    let mut limits = PathLimits::NONE;
    let mut plane_jerk = f64::INFINITY;
    let raised = mv.rapid_factor.max(1.0);
    let mut plane_accel = f64::INFINITY;
    let mut linear_accel = f64::INFINITY;
    for (axis, limit) in crate::axis_limits::moving(machine, mv) {
        let accel = crate::axis_limits::accel(mv, axis, caps);
        if limit.kind == AxisKind::Linear {
            linear_accel = linear_accel.min(accel);
        }
        let jerk = crate::axis_limits::jerk(limit, mv);
        if let Some(i) = arc.plane.iter().position(|&plane| plane == axis) {
            plane_accel = plane_accel.min(accel);
            plane_jerk = plane_jerk.min(jerk);
            let speed = limit.rapid_mm_s * raised / (share * parts[i]);
            limits.speed_mm_s = limits.speed_mm_s.min(speed);
        } else {
            limits.take(mv, axis, limit.rapid_mm_s * raised, accel, jerk);
        }
    }
    let radius = arc.radius_mm;
    let (turning, speeding_up) = match machine.controller.planner.arc_rule {
        ArcRule::Shared => {
            let half = linear_accel.min(plane_accel) * FRAC_1_SQRT_2;
            ((half * radius).sqrt() / share, half)
        }
        ArcRule::LinuxCnc => {
            let rise_mm = mv.length_mm * (1.0 - share * share).max(0.0).sqrt();
            let turning = linuxcnc_turning(plane_accel, radius) / share;
            let accel = limits.accel_mm_s2.min(plane_accel / share);
            let speed = limits.speed_mm_s.min(turning);
            let (cut, along) = linuxcnc(speed, accel, radius + rise_mm * rise_mm / radius);
            (turning.min(cut), along)
        }
    };
    let turning = if machine.force_curves.is_empty() {
        turning
    } else {
        let normal_share = match machine.controller.planner.arc_rule {
            ArcRule::Shared => FRAC_1_SQRT_2,
            ArcRule::LinuxCnc => LINUXCNC_NORMAL_SHARE,
        };
        let axes = plane_axes(machine, mv, arc);
        let most = turning.min(limits.speed_mm_s);
        drive::turning_speed(machine, axes, [radius, share, normal_share], most)
    };
    let mut limits = PathLimits {
        speed_mm_s: limits.speed_mm_s.min(turning),
        accel_mm_s2: limits.accel_mm_s2.min(speeding_up),
        jerk_mm_s3: limits.jerk_mm_s3,
    };
    if plane_jerk < f64::INFINITY {
        limits.share_jerk(plane_jerk, radius, share);
    }
    limits
}

impl PathLimits {
    /// Shares the jerk of the plane's axes, see above. Along the path the limits
    /// are larger than in the plane, by 1/`share`, which is left aside.
    fn share_jerk(&mut self, jerk: f64, radius: f64, share: f64) {
        let part = jerk * FRAC_1_SQRT_2;
        let turning = cbrt_of_square((0.5 * part).sqrt() * radius) / share;
        self.speed_mm_s = self.speed_mm_s.min(turning);
        let v = self.speed_mm_s * share;
        let turn = v / radius;
        let left = part - v * turn * turn;
        self.accel_mm_s2 = self.accel_mm_s2.min(part / (3.0 * turn));
        self.jerk_mm_s3 = self.jerk_mm_s3.min(left);
    }
}

/// See [`super::SpeedBound::excess`].
pub(super) fn excess(machine: &Machine, mv: &Move) -> f64 {
    let steep = |arc: &Arc| plane_share(mv, arc) < 1.0 - 1e-12;
    match machine.controller.planner.arc_rule {
        ArcRule::LinuxCnc if mv.arc.as_ref().is_some_and(steep) => LINUXCNC_HELIX_EXCESS,
        _ => 0.0,
    }
}

/// The speed at which turning takes its share of `LinuxCNC`'s acceleration, mm/s.
pub(super) fn linuxcnc_turning(accel: f64, radius_mm: f64) -> f64 {
    (LINUXCNC_NORMAL_SHARE * accel * radius_mm).sqrt()
}

/// `LinuxCNC` 2.9: an arc's speed and its acceleration along the path, of those
/// that it has without its curvature. Of the speed counts the largest that axes
/// and turning permit, whatever F asks for.
///
/// `radius_mm` is `r + h²/r` for a helix that rises by h in all: measured, though
/// the radius of its curvature has h per radian. Steep helices so exceed the axes'
/// accelerations, up to `√(1 + 3/4)` times in the plane.
pub(super) fn linuxcnc(speed: f64, accel: f64, radius_mm: f64) -> (f64, f64) {
    let normal_share = speed * speed / (radius_mm * accel);
    if normal_share > LINUXCNC_NORMAL_SHARE {
        let turning = linuxcnc_turning(accel, radius_mm);
        return (turning, accel * LINUXCNC_TANGENTIAL_SHARE);
    }
    (speed, accel * (1.0 - normal_share * normal_share).sqrt())
}
