//! Plans: one move, its trajectory and the figures that describe it.
//!
//! Input: the machine, a move, the overrides, and caps that try lower limits.
//! Output: a [`Plan`]. Nothing is allocated, save for independent rapids and
//! for moves from an unknown start.

use super::bound::{SpeedBound, speed_bound};
use super::drive;
use super::overrides::{Caps, Overrides};
use super::path_limits::PathLimits;
use super::phase::{Phase, PhaseKind};
use super::profile::{Outline, Profile};
use super::s_curve::{SCurve, Steepness};
use gwatt_machine::{AxisSet, AxisValues, Machine, RapidPath};
use gwatt_motion::{Move, MoveKind, path_length};

/// How a move runs in time.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "paths are the common case, and a box would be an allocation for each move"
)]
pub enum Trajectory {
    /// No axis moves.
    Rest,
    /// All axes follow one path.
    Path(Profile),
    /// Each axis runs its own profile, all starting together: axis index and
    /// profile, over the unsigned distance of the axis.
    Axes(Vec<(usize, Profile)>),
    /// Where the move starts is not known; only bounds are.
    Unknown(Box<UnknownMotion>),
}

/// What is known of a move from an unknown start.
#[derive(Debug, Clone, PartialEq)]
pub struct UnknownMotion {
    /// Largest speeds of the axes.
    pub bound: SpeedBound,
    /// Acceleration limits of the axes in force, mm/s².
    pub accel_mm_s2: AxisValues,
}

/// A planned move.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// How it runs.
    pub trajectory: Trajectory,
    /// How long it lasts in s.
    pub duration_s: f64,
    /// Path speed permitted by feed, override, axes, arc rule and caps in
    /// mm/s; 0 at rest. For independent rapids: of a straight path.
    pub speed_limit_mm_s: f64,
    /// Path acceleration in mm/s²; 0 at rest. For independent rapids: of a
    /// straight path.
    pub accel_mm_s2: f64,
    /// Path speed reached in mm/s. For independent rapids: the largest speed
    /// of an axis.
    pub top_speed_mm_s: f64,
}

impl Plan {
    /// A plan that moves nothing for `duration_s` seconds.
    #[must_use]
    #[inline]
    pub fn rest(duration_s: f64) -> Self {
        Self {
            trajectory: Trajectory::Rest,
            duration_s,
            speed_limit_mm_s: 0.0,
            accel_mm_s2: 0.0,
            top_speed_mm_s: 0.0,
        }
    }

    /// The ramps between rest and a speed (mm/s) at an acceleration (mm/s²),
    /// however long their path: what a move that may begin and end at any speed
    /// meets at most.
    #[must_use]
    pub fn ramps(speed_mm_s: f64, accel_mm_s2: f64) -> Self {
        let length_mm = speed_mm_s * speed_mm_s / accel_mm_s2;
        let profile = Profile::trapezoid(length_mm, speed_mm_s, accel_mm_s2);
        Self {
            duration_s: profile.duration_s(),
            trajectory: Trajectory::Path(profile),
            speed_limit_mm_s: speed_mm_s,
            accel_mm_s2,
            top_speed_mm_s: speed_mm_s,
        }
    }

    /// A cruise alone: what remains of a long move without its ramps.
    #[must_use]
    pub fn cruise(speed_mm_s: f64, length_mm: f64) -> Self {
        let mut profile = Profile::default();
        profile.phases.push(Phase {
            kind: PhaseKind::ConstantAcceleration,
            duration_s: length_mm / speed_mm_s,
            position_mm: 0.0,
            velocity_mm_s: speed_mm_s,
            end_velocity_mm_s: speed_mm_s,
            accel_mm_s2: 0.0,
        });
        Self {
            trajectory: Trajectory::Path(profile),
            duration_s: length_mm / speed_mm_s,
            speed_limit_mm_s: speed_mm_s,
            accel_mm_s2: 0.0,
            top_speed_mm_s: speed_mm_s,
        }
    }
}

/// Plans a move from rest to rest.
#[must_use]
#[inline]
pub fn plan(machine: &Machine, mv: &Move, overrides: Overrides) -> Plan {
    plan_with(machine, mv, overrides, Caps::default())
}

/// Plans a move from rest to rest under lower limits.
///
/// A speed of 0 (an override of 0) gives a rest of infinite duration.
#[must_use]
pub fn plan_with(machine: &Machine, mv: &Move, overrides: Overrides, caps: Caps) -> Plan {
    if mv.kind == MoveKind::Dwell {
        return Plan::rest(mv.dwell_s);
    }
    if !mv.unknown_start.is_empty() {
        return unknown(machine, mv, overrides, &caps);
    }
    if mv.length_mm <= 0.0 {
        return Plan::rest(0.0);
    }
    let limits = PathLimits::of(machine, mv, overrides, &caps);
    if !limits.permit_motion() {
        return Plan::rest(f64::INFINITY);
    }
    if is_independent(machine, mv) {
        return independent(machine, mv, overrides, &caps, limits);
    }
    if !machine.force_curves.is_empty() {
        return limits.plan(drive::path(machine, mv, &limits));
    }
    PathFigures::new(mv.length_mm, limits).plan(mv.length_mm)
}

/// What a plan on one path comes to, without its phases; the fields are those
/// of [`Plan`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "see Plan")]
pub struct PathFigures {
    pub duration_s: f64,
    pub speed_limit_mm_s: f64,
    pub accel_mm_s2: f64,
    pub top_speed_mm_s: f64,
    /// Path jerk in mm/s³; infinite: no limit.
    pub jerk_mm_s3: f64,
}

/// The figures of [`plan`] for a move on one path, at a fraction of its cost;
/// `None` for all others, and where drives have curves of force.
#[must_use]
#[inline]
pub fn path_figures(machine: &Machine, mv: &Move, overrides: Overrides) -> Option<PathFigures> {
    let on_path = mv.kind != MoveKind::Dwell
        && mv.unknown_start.is_empty()
        && mv.length_mm > 0.0
        && machine.force_curves.is_empty()
        && !is_independent(machine, mv);
    if !on_path {
        return None;
    }
    let limits = PathLimits::of(machine, mv, overrides, &Caps::default());
    limits
        .permit_motion()
        .then(|| PathFigures::new(mv.length_mm, limits))
}

impl PathFigures {
    #[inline]
    fn new(length: f64, limits: PathLimits) -> Self {
        if limits.jerk_mm_s3 < f64::INFINITY {
            return Self::smooth(length, limits);
        }
        let outline = Outline::new(length, limits.speed_mm_s, limits.accel_mm_s2);
        Self {
            duration_s: outline.duration_s(),
            speed_limit_mm_s: limits.speed_mm_s,
            accel_mm_s2: limits.accel_mm_s2,
            top_speed_mm_s: outline.top_speed,
            jerk_mm_s3: limits.jerk_mm_s3,
        }
    }

    fn smooth(length: f64, limits: PathLimits) -> Self {
        let curve = limits.s_curve(length);
        Self {
            duration_s: curve.duration_s(),
            speed_limit_mm_s: limits.speed_mm_s,
            accel_mm_s2: limits.accel_mm_s2,
            top_speed_mm_s: curve.top,
            jerk_mm_s3: limits.jerk_mm_s3,
        }
    }

    /// The whole plan of the path, `length` mm long.
    #[must_use]
    pub fn plan(self, length: f64) -> Plan {
        let limits = PathLimits {
            speed_mm_s: self.speed_limit_mm_s,
            accel_mm_s2: self.accel_mm_s2,
            jerk_mm_s3: self.jerk_mm_s3,
        };
        Plan {
            trajectory: Trajectory::Path(limits.profile(length)),
            duration_s: self.duration_s,
            speed_limit_mm_s: self.speed_limit_mm_s,
            accel_mm_s2: self.accel_mm_s2,
            top_speed_mm_s: self.top_speed_mm_s,
        }
    }
}

impl PathLimits {
    /// A plan under these limits.
    fn plan(&self, profile: Profile) -> Plan {
        Plan {
            duration_s: profile.duration_s(),
            speed_limit_mm_s: self.speed_mm_s,
            accel_mm_s2: self.accel_mm_s2,
            top_speed_mm_s: profile.top_speed_mm_s(),
            trajectory: Trajectory::Path(profile),
        }
    }

    /// The fastest profile from rest to rest under these limits.
    #[inline]
    pub(super) fn profile(&self, length: f64) -> Profile {
        if self.jerk_mm_s3 < f64::INFINITY {
            self.s_curve(length).profile()
        } else {
            Profile::trapezoid(length, self.speed_mm_s, self.accel_mm_s2)
        }
    }

    fn s_curve(&self, length: f64) -> SCurve {
        let steepness = Steepness {
            accel_mm_s2: self.accel_mm_s2,
            jerk_mm_s3: self.jerk_mm_s3,
        };
        SCurve::from_rest(length, self.speed_mm_s, steepness)
    }
}

/// The ramps between rest and the largest speed of a straight move on one path,
/// however long they are, without limits of jerk: what a move that begins and ends
/// at any speeds up to `ends_mm_s` meets at most. Where drives have curves of force
/// the ramps follow them.
#[must_use]
pub fn ramps(machine: &Machine, mv: &Move, overrides: Overrides, ends_mm_s: [f64; 2]) -> Plan {
    let mut limits = PathLimits::of(machine, mv, overrides, &Caps::default());
    let [start, end] = ends_mm_s;
    // No curve leaves more than the axes' own acceleration.
    let reached = 0.5 * (start * start + end * end) + limits.accel_mm_s2 * mv.length_mm;
    limits.speed_mm_s = limits.speed_mm_s.min(start.max(end).max(reached.sqrt()));
    if machine.force_curves.is_empty() {
        return Plan::ramps(limits.speed_mm_s, limits.accel_mm_s2);
    }
    limits.plan(drive::ramps(machine, mv, &limits))
}

/// The lowest acceleration along a path, in mm/s², that the drives leave
/// at any speed up to `speed_mm_s`; infinite where none has a curve of force.
#[must_use]
pub fn driven_accel(machine: &Machine, mv: &Move, speed_mm_s: f64) -> f64 {
    if machine.force_curves.is_empty() {
        return f64::INFINITY;
    }
    drive::lowest_on_path(machine, mv, speed_mm_s)
}

/// Whether each axis of a move runs for itself.
#[must_use]
#[inline]
pub fn is_independent(machine: &Machine, mv: &Move) -> bool {
    mv.kind == MoveKind::Rapid && machine.path.rapid == RapidPath::Independent
}

/// Each axis for itself at its own speed and acceleration; the slowest one
/// sets the duration. A limit along the path does not bind axes that follow
/// none.
fn independent(
    machine: &Machine,
    mv: &Move,
    overrides: Overrides,
    caps: &Caps,
    path: PathLimits,
) -> Plan {
    let mut plan = Plan {
        trajectory: Trajectory::Rest,
        duration_s: 0.0,
        speed_limit_mm_s: path.speed_mm_s,
        accel_mm_s2: path.accel_mm_s2,
        top_speed_mm_s: 0.0,
    };
    let mut axes = Vec::with_capacity(mv.moving.0.count_ones() as usize);
    for axis in mv.moving.iter() {
        let distance = (mv.end[axis] - mv.start[axis]).abs();
        let limits = PathLimits::of_rapid_axis(machine, mv, axis, overrides, caps);
        if distance > 0.0 {
            let profile = if machine.force_curves.is_empty() {
                limits.profile(distance)
            } else {
                let heading = (mv.end[axis] - mv.start[axis]).signum();
                drive::axis(machine, axis, distance, heading, &limits)
            };
            plan.duration_s = plan.duration_s.max(profile.duration_s());
            plan.top_speed_mm_s = plan.top_speed_mm_s.max(profile.top_speed_mm_s());
            axes.push((axis, profile));
        }
    }
    if !axes.is_empty() {
        plan.trajectory = Trajectory::Axes(axes);
    }
    plan
}

/// A move from an unknown start: bounds, and the time that it takes from where the axes
/// were taken to stand, which is 0 where nothing was known of them before.
fn unknown(machine: &Machine, mv: &Move, overrides: Overrides, caps: &Caps) -> Plan {
    let motion = UnknownMotion {
        bound: speed_bound(machine, mv, overrides, *caps),
        accel_mm_s2: std::array::from_fn(|axis| crate::axis_limits::accel(mv, axis, caps)),
    };
    let limits = PathLimits::of(machine, mv, overrides, caps);
    let mut plan = if mv.length_mm > 0.0 && limits.permit_motion() {
        let mut limits = limits;
        let driven = driven_accel(machine, mv, limits.speed_mm_s);
        limits.accel_mm_s2 = limits.accel_mm_s2.min(driven);
        PathFigures::new(mv.length_mm, limits).plan(mv.length_mm)
    } else {
        Plan::rest(0.0)
    };
    if mv.arc.is_none() {
        let whole = plan_with(machine, &assumed(mv), overrides, *caps);
        plan.duration_s = plan.duration_s.max(whole.duration_s);
    }
    plan.trajectory = Trajectory::Unknown(Box::new(motion));
    plan
}

/// A straight move from where its axes were taken to stand.
fn assumed(mv: &Move) -> Move {
    let mut whole = mv.clone();
    let commanded = AxisSet(mv.moving.0 | mv.unknown_start.0);
    whole.unknown_start = AxisSet::default();
    whole.moving = AxisSet::default();
    for axis in commanded
        .iter()
        .filter(|axis| mv.start[*axis] != mv.end[*axis])
    {
        whole.moving.insert(axis);
    }
    (whole.length_mm, _) = path_length(&mv.start, &mv.end, whole.moving, None);
    whole
}
