//! Which moves may glide, and what they are to the planner.

use gwatt_machine::{AXES, AxisId, AxisSet, AxisValues, CornerRule, LookAhead, Machine, PathMode};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::lookahead::{Line, common_accel};

const LINEAR: usize = 3;
const EXTRUDER: usize = AxisId::E as usize;

/// What may glide.
#[derive(Debug)]
pub(super) struct Terms {
    /// The axes that do: those of X, Y and Z, and an extruder next to them.
    axes: AxisSet,
    linear: AxisSet,
    /// Their speeds, mm/s.
    speed_mm_s: AxisValues,
    /// Override of feeds.
    pub feed: f64,
    /// The rules' own limit along any path, mm/s².
    path_accel_mm_s2: f64,
    /// Moves that may be open.
    pub blocks: u64,
    /// The acceleration of all paths counts.
    has_common: bool,
    /// The axes whose own limits a joint needs.
    at_joints: AxisSet,
}

impl Terms {
    /// `feed`: override; `blocks`: moves that may be open.
    pub fn new(machine: &Machine, rules: &LookAhead, feed: f64, blocks: usize) -> Self {
        let mut terms = Self {
            axes: AxisSet::default(),
            linear: AxisSet(0),
            speed_mm_s: [0.0; AXES],
            feed,
            path_accel_mm_s2: rules.path_accel_mm_s2,
            blocks: blocks as u64,
            at_joints: AxisSet::default(),
            has_common: rules.min_cruise_ratio > 0.0
                || matches!(rules.corner, CornerRule::SquareCorner { .. }),
        };
        if blocks > 0 && machine.force_curves.is_empty() {
            for index in (0..LINEAR).chain([EXTRUDER]) {
                if let Some(axis) = machine.axes.get(index).and_then(Option::as_ref) {
                    terms.axes.insert(index);
                    terms.speed_mm_s[index] = axis.rapid_mm_s;
                }
            }
            terms.linear = AxisSet(terms.axes.0 & !(1 << EXTRUDER));
            // The extruder has a step of speed of its own there.
            terms.at_joints = match rules.corner {
                CornerRule::SquareCorner { .. } => terms.linear,
                _ => terms.axes,
            };
        }
        terms
    }

    /// Whether a move may glide at some speed: a straight feed.
    #[inline]
    pub fn suit(&self, mv: &Move) -> bool {
        mv.kind == MoveKind::Feed
            && mv.moving.0 & !self.axes.0 == 0
            && mv.moving.0 & self.linear.0 != 0
            && mv.length_mm > 0.0
            && mv.arc.is_none()
            && mv.unknown_start.is_empty()
            && !mv.stray.strays()
            && mv.path_mode == PathMode::LookAhead
            // What the program has set is left to the planner.
            && !mv.corner.is_set()
    }

    /// Describes a move that suits, and a joint before it at which these axes move, in
    /// place; false where an axis does not permit the speed.
    #[inline]
    pub fn describe(&self, line: &mut Line, mv: &Move, axes: AxisSet, speed_mm_s: f64) -> bool {
        line.direction = [0.0; LINEAR];
        let per_mm = 1.0 / mv.length_mm;
        let mut permitted = true;
        for axis in AxisSet(mv.moving.0 & self.linear.0).iter() {
            let part = (mv.end[axis] - mv.start[axis]) * per_mm;
            permitted &= part.abs() * speed_mm_s <= self.speed_mm_s[axis];
            if let Some(change) = line.direction.get_mut(axis) {
                *change = part;
            }
        }
        line.length_mm = mv.length_mm;
        let path_accel_mm_s2 = lower(mv.path_accel_mm_s2, self.path_accel_mm_s2);
        let mut least_accel_mm_s2 = path_accel_mm_s2;
        for axis in AxisSet(axes.0 & self.at_joints.0).iter() {
            least_accel_mm_s2 = lower(mv.accel_mm_s2[axis], least_accel_mm_s2);
        }
        line.extrusion = 0.0;
        if mv.moving.contains(EXTRUDER) {
            line.extrusion = (mv.end[EXTRUDER] - mv.start[EXTRUDER]) * per_mm;
            let share = line.extrusion.abs();
            permitted &= share * speed_mm_s <= self.speed_mm_s[EXTRUDER];
            least_accel_mm_s2 = lower(mv.accel_mm_s2[EXTRUDER] / share, least_accel_mm_s2);
        }
        if self.has_common {
            let common_mm_s2 = common_accel(path_accel_mm_s2, &mv.accel_mm_s2);
            least_accel_mm_s2 = lower(least_accel_mm_s2, common_mm_s2);
            line.common_share = least_accel_mm_s2 / common_mm_s2;
        }
        line.least_accel_mm_s2 = least_accel_mm_s2;
        permitted
    }
}

/// `f64::min` is several instructions more.
#[inline]
pub(super) fn lower(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
