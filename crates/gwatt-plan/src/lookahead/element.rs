//! Path elements: what a look-ahead planner must know of a move.
//!
//! Input: a move and the limits of its machine. Output: an [`Element`] with the
//! direction at both ends, per unit of path, and the limits along the path.

use super::super::arc;
use super::super::axis_limits::lower;
use super::super::drive::{self, Heading};
use super::super::limits::{self};
use super::super::overrides::{Caps, Overrides};
use super::super::path_limits::PathLimits;
use gwatt_machine::{AXES, AxisValues, CornerRule, Machine};
use gwatt_motion::{Arc, Corner, Move, MoveKind, Square};

/// What happens at the end of an element, if the controller's rules permit it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Joint {
    /// A stop: exact stop mode, or a dwell, a tool change or another word
    /// after it for which the controller waits. Where the stop has such a
    /// reason the planner learns of it by [`super::PathPlanner::stop`].
    #[default]
    Stop,
    /// The path is kept; joints without a corner are run through.
    Exact,
    /// Corners are rounded or taken at a speed.
    Blend {
        /// How far the path may be left in mm; 0: as far as it takes.
        tolerance_mm: f64,
        /// How far lines that are put together may be left in mm; 0: none are.
        join_mm: f64,
    },
}

/// The curvature of an arc or a helix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// Axes of the plane, first and second.
    pub plane: [usize; 2],
    /// In the plane, mm.
    pub radius_mm: f64,
    /// Signed angle, positive from the first axis to the second.
    pub sweep_rad: f64,
    /// How far it moves across the plane in all, mm.
    pub rise_mm: f64,
    /// Acceleration along the path at which the plane and the axes across it stay
    /// within the smaller limit of the plane's axes and their own, mm/s².
    pub accel_mm_s2: f64,
    /// The largest speeds of the plane's axes, mm/s.
    pub axes_mm_s: [f64; 2],
    /// Speed along the path that the axes across the plane permit, mm/s.
    pub across_mm_s: f64,
}

/// What the program has set in place of the profile's values of its rule for corners.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum CornerSet {
    /// Nothing.
    #[default]
    None,
    /// The speed at a right angle, and the share of hills to cruise.
    Square(Square),
    /// The largest steps of speed of the axes, mm/s, and whether they hold only between two
    /// moves that extrude or two that do not.
    Steps(AxisValues, bool),
    /// The distance of a circle from the corner, mm.
    Deviation(f64),
}

impl CornerSet {
    #[inline]
    fn of(machine: &Machine, corner: Corner) -> Self {
        match corner {
            Corner::Exact | Corner::Round { .. } => Self::None,
            Corner::Square(square) => Self::Square(square),
            Corner::Deviation(deviation_mm) => Self::Deviation(deviation_mm),
            Corner::Steps(steps) => {
                let rules = machine.controller.planner.look_ahead;
                match rules.map(|rules| rules.corner) {
                    Some(
                        CornerRule::ClassicJerk { step_mm_s }
                        | CornerRule::SpeedStep { step_mm_s, .. },
                    ) => Self::Steps(steps.over(&step_mm_s), steps.same_kind_only),
                    _ => Self::None,
                }
            }
        }
    }

    /// The share of each hill of speed that is cruised at least; `own`: the profile's.
    pub(super) fn cruise_ratio(&self, own: f64) -> f64 {
        match self {
            Self::Square(square) => square.cruise_ratio,
            _ => own,
        }
    }

    /// The speed at a right angle, mm/s.
    pub(super) fn square_mm_s(&self, own: f64) -> f64 {
        match self {
            Self::Square(square) => square.corner_mm_s,
            _ => own,
        }
    }

    /// The steps of speed, mm/s.
    pub(super) fn steps_mm_s<'a>(&'a self, own: &'a AxisValues) -> &'a AxisValues {
        match self {
            Self::Steps(steps, _) => steps,
            _ => own,
        }
    }

    /// Whether steps hold between moves of one kind alone.
    pub(super) fn same_kind_only(&self, own: bool) -> bool {
        match self {
            Self::Steps(_, same_kind_only) => *same_kind_only,
            _ => own,
        }
    }

    /// The distance of the circle, mm.
    pub(super) fn deviation_mm(&self, own: f64) -> f64 {
        match self {
            Self::Deviation(deviation_mm) => *deviation_mm,
            _ => own,
        }
    }
}

/// A path element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element<T> {
    /// Given back with the result, such as the line and the index of a move.
    pub tag: T,
    /// A rapid, or a feed.
    pub rapid: bool,
    /// Path length in mm, positive.
    pub length_mm: f64,
    /// Speed that is asked for in mm/s; of a rapid infinite, unless its override is
    /// below 100 %.
    pub feed_mm_s: f64,
    /// What part of the speed that is asked for a share leaves which the control takes while
    /// it moves.
    pub pace: f64,
    /// Speed that the axes permit, mm/s. Of an arc without its curvature.
    pub speed_mm_s: f64,
    /// Acceleration along the path that the axes permit, mm/s². Of an arc by
    /// the controller's rule.
    pub accel_mm_s2: f64,
    /// The lowest acceleration along the path that the drives leave at any speed
    /// up to the element's, mm/s²; infinite without curves of force. It may grow
    /// as F falls, so that it is no part of `accel_mm_s2`.
    pub drive_accel_mm_s2: f64,
    /// Acceleration along the path that program and controller permit whatever
    /// the direction, mm/s²; infinite where only the axes have limits.
    pub path_accel_mm_s2: f64,
    /// Jerk along the path that the axes permit, mm/s³; infinite: no limit. Of
    /// an arc by the rule that shares it.
    pub jerk_mm_s3: f64,
    /// Share of the axes' own jerk limits in force.
    pub jerk_factor: f64,
    /// Speed that curvature permits, mm/s; infinite on a straight path.
    pub curve_speed_mm_s: f64,
    /// Acceleration limits of the axes, mm/s².
    pub axis_accel_mm_s2: AxisValues,
    /// Change of each axis per unit of path at the start.
    pub start: AxisValues,
    /// The same at the end.
    pub end: AxisValues,
    /// The curvature of an arc.
    pub curve: Option<Curve>,
    /// What the program has set for corners and hills.
    pub set: CornerSet,
    /// What happens at its end.
    pub joint: Joint,
}

impl<T> Element<T> {
    /// The element of a move that has a length and a known start; `None` for
    /// all others and where a limit is 0.
    pub fn of(
        machine: &Machine,
        mv: &Move,
        overrides: Overrides,
        joint: Joint,
        tag: T,
    ) -> Option<Self> {
        let mut element = Self::blank(tag);
        element
            .describe(machine, mv, overrides, joint)
            .then_some(element)
    }

    /// An element of nothing yet, for [`Self::describe`] to fill.
    #[must_use]
    pub fn blank(tag: T) -> Self {
        Self {
            tag,
            rapid: false,
            length_mm: 0.0,
            feed_mm_s: f64::INFINITY,
            pace: 1.0,
            speed_mm_s: f64::INFINITY,
            accel_mm_s2: f64::INFINITY,
            drive_accel_mm_s2: f64::INFINITY,
            path_accel_mm_s2: f64::INFINITY,
            jerk_mm_s3: f64::INFINITY,
            jerk_factor: 1.0,
            curve_speed_mm_s: f64::INFINITY,
            axis_accel_mm_s2: [0.0; AXES],
            start: [0.0; AXES],
            end: [0.0; AXES],
            curve: None,
            set: CornerSet::None,
            joint: Joint::Stop,
        }
    }

    /// Makes it the element of another move, in place: it is large. False where
    /// [`Self::of`] gives none; it is then not to be used.
    #[inline]
    #[must_use]
    pub fn describe(
        &mut self,
        machine: &Machine,
        mv: &Move,
        overrides: Overrides,
        joint: Joint,
    ) -> bool {
        if mv.kind == MoveKind::Dwell || mv.length_mm <= 0.0 || !mv.unknown_start.is_empty() {
            return false;
        }
        self.rapid = mv.kind == MoveKind::Rapid;
        self.length_mm = mv.length_mm;
        self.feed_mm_s = match mv.kind {
            MoveKind::Rapid => f64::INFINITY,
            kind => {
                let factor = crate::axis_limits::feed_factor(kind, overrides);
                mv.feed_mm_s * mv.feed_excess * factor
            }
        };
        self.pace = mv.pace;
        self.drive_accel_mm_s2 = f64::INFINITY;
        self.path_accel_mm_s2 = mv.path_accel_mm_s2;
        self.curve_speed_mm_s = f64::INFINITY;
        self.axis_accel_mm_s2 = mv.accel_mm_s2;
        self.start = [0.0; AXES];
        for axis in mv.moving.iter() {
            if let Some(change) = self.start.get_mut(axis) {
                *change = (mv.end[axis] - mv.start[axis]) / mv.length_mm;
            }
        }
        self.end = self.start;
        self.curve = None;
        self.set = CornerSet::of(machine, mv.corner);
        self.joint = joint;
        let caps = Caps::default();
        let limits = match &mv.arc {
            Some(_) => PathLimits::of(machine, mv, overrides, &caps),
            None => limits::straight(machine, mv, overrides, &caps),
        };
        self.speed_mm_s = limits.speed_mm_s;
        let share = overrides.rapid * mv.pace;
        if self.rapid && share > 0.0 && share < 1.0 {
            // The knob is turned while it runs; what is decided before knows nothing of it.
            self.feed_mm_s = limits.speed_mm_s;
            self.speed_mm_s = limits.speed_mm_s / share;
        }
        self.accel_mm_s2 = limits.accel_mm_s2.min(mv.path_accel_mm_s2);
        self.jerk_mm_s3 = limits.jerk_mm_s3;
        self.jerk_factor = mv.jerk_factor;
        if let Some(arc) = &mv.arc {
            self.bend(machine, mv, arc);
        }
        if mv.feed_excess > 1.0 {
            // What holds the feed back does so at any override.
            self.speed_mm_s = lower(self.speed_mm_s, mv.feed_mm_s);
            if let Some(curve) = &mut self.curve {
                curve.across_mm_s = lower(curve.across_mm_s, mv.feed_mm_s);
            }
        }
        if !machine.force_curves.is_empty() {
            self.drive(machine, mv);
        }
        self.top_mm_s() > 0.0 && self.accel_mm_s2 > 0.0
    }

    /// Takes in what the drives leave at speeds up to the element's.
    fn drive(&mut self, machine: &Machine, mv: &Move) {
        // It may be entered at its whole speed.
        let axes = lower(self.speed_mm_s, self.curve_speed_mm_s);
        let top = lower(axes, self.feed_mm_s / self.pace);
        self.drive_accel_mm_s2 = drive::lowest_on_path(machine, mv, top);
        let plane = self.curve.map(|curve| curve.plane);
        let axes = self.axis_accel_mm_s2.iter_mut().zip(&self.start);
        for (axis, (accel, change)) in axes.enumerate() {
            let turns = plane.is_some_and(|plane| plane.contains(&axis));
            let share = if turns { 1.0 } else { change.abs() };
            let left = drive::lowest(machine, axis, top * share, Heading::Both);
            *accel = accel.min(left);
        }
        if let Some(Curve { plane, .. }) = self.curve {
            let accel_mm_s2 = self.accel_along(plane);
            if let Some(curve) = &mut self.curve {
                curve.accel_mm_s2 = accel_mm_s2;
            }
        }
    }

    /// See [`Curve::accel_mm_s2`].
    fn accel_along(&self, plane: [usize; 2]) -> f64 {
        let (mut in_plane, mut share2, mut along) = (f64::INFINITY, 0.0, f64::INFINITY);
        let axes = self.axis_accel_mm_s2.iter().zip(&self.start).enumerate();
        for (axis, (accel, change)) in axes {
            if plane.contains(&axis) {
                in_plane = accel.min(in_plane);
                share2 += change * change;
            } else if *change != 0.0 {
                along = along.min(accel / change.abs());
            }
        }
        along.min(in_plane / share2.sqrt())
    }

    fn bend(&mut self, machine: &Machine, mv: &Move, of: &Arc) {
        let share = crate::arc_plane::plane_share(mv, of);
        let sense = of.sweep_rad.signum();
        for (angle, side) in [
            (of.start_angle_rad, &mut self.start),
            (of.start_angle_rad + of.sweep_rad, &mut self.end),
        ] {
            let (sin, cos) = libm::sincos(angle);
            let tangent = [-sense * sin * share, sense * cos * share];
            for (axis, change) in of.plane.into_iter().zip(tangent) {
                if let Some(value) = side.get_mut(axis) {
                    *value = change;
                }
            }
        }
        let speeds = arc::AxisSpeeds::of(machine, mv, of);
        self.speed_mm_s = speeds.along_path(machine, of);
        self.curve_speed_mm_s = arc::limits(machine, mv, of, &Caps::default()).speed_mm_s;
        self.curve = Some(Curve {
            plane: of.plane,
            radius_mm: of.radius_mm,
            sweep_rad: of.sweep_rad,
            rise_mm: self.length_mm * (1.0 - share * share).max(0.0).sqrt(),
            accel_mm_s2: self.accel_along(of.plane),
            axes_mm_s: speeds.plane_mm_s,
            across_mm_s: speeds.across_mm_s,
        });
    }

    /// See [`common_accel`].
    #[inline]
    pub(super) fn common_accel_mm_s2(&self) -> f64 {
        common_accel(self.path_accel_mm_s2, &self.axis_accel_mm_s2)
    }

    /// Whether the drives leave less than the axes' own acceleration at some speed of
    /// the element.
    #[must_use]
    #[inline]
    pub fn is_driven(&self) -> bool {
        self.drive_accel_mm_s2 < self.accel_mm_s2
    }

    /// Speed that feed, axes and curvature permit, mm/s.
    #[must_use]
    #[inline]
    pub fn top_mm_s(&self) -> f64 {
        let axes = lower(self.speed_mm_s, self.curve_speed_mm_s);
        lower(axes, self.feed_mm_s)
    }
}

/// The acceleration that the program or the controller sets for all paths, mm/s²:
/// that along the path, or of X and Y where that has no limit (Klipper's
/// `max_accel`); infinite where neither has one.
#[must_use]
#[inline]
pub fn common_accel(path_mm_s2: f64, axes_mm_s2: &AxisValues) -> f64 {
    let [x, y, ..] = *axes_mm_s2;
    let largest = if y > x { y } else { x };
    if largest > 0.0 {
        lower(path_mm_s2, largest)
    } else {
        path_mm_s2
    }
}
