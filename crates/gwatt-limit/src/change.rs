//! Changes: values of the words that a block gets, and the move that results.

use super::knob_level::level_of;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_machine::{
    AXES, AxisId, AxisKind, AxisSet, AxisValues, Knob, KnobArgument, KnobTarget, Machine, PathMode,
};
use gwatt_motion::{Corner, FeedMode, Move, MoveKind, Square, hold_to_path, raise_to_path};

/// What may be changed about the block of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Permit {
    /// Words may be changed and inserted, and lines inserted before the block.
    pub edit: bool,
    /// F means length per minute and may stand in this block.
    pub feed_word: bool,
    /// A rapid may be written as a feed.
    pub as_feed: bool,
    /// Such a feed may run in exact stop, in place of dwells before and after it.
    pub exact_stop: bool,
    /// The axes stand before and after it, or may be made to by exact stop: a knob may be
    /// turned for which they have to.
    pub stands: bool,
    /// A line may come between it and the block before it, though both move.
    pub line_before: bool,
    /// Knobs may be turned on lines before it, and back after it.
    pub knobs: bool,
    /// What it changes is put back right after it, since other blocks may come then.
    pub apart: bool,
    /// A word in the block can let it end at rest where the control would blend it with
    /// the next one.
    pub stop_word: bool,
    /// Lines with words for levels may stand before it and after it.
    pub levels: bool,
    /// It starts and ends at rest as it is.
    pub rests: bool,
    /// Why the block may not be written as several; `None`: it may.
    pub unsplit: Option<&'static str>,
    /// Why not, for a person; empty when all is permitted.
    pub reason: &'static str,
    /// What the programmer can do about it; empty when nothing in particular.
    pub reason_help: &'static str,
    /// Millimetres in one program unit, for an F in the block.
    pub mm_per_unit: f64,
    /// The same for knobs, on a line before the block.
    pub knob_mm_per_unit: f64,
    /// The F in force in program units, if there is one.
    pub feed_before: Option<f64>,
    /// It does not cut: it homes the axes, or is a rapid that obeys F.
    pub positions: bool,
    /// Acceleration limits of feed moves in force, for a rapid that is written
    /// as one, mm/s².
    pub feed_accel_mm_s2: AxisValues,
    /// Speed limits of axes that the program has set, mm/s; infinite: the machine's own.
    pub speed_mm_s: AxisValues,
}

impl Permit {
    /// What can be done about its reason, or else what `usual` says.
    pub(super) fn help_or(&self, usual: &'static str) -> &'static str {
        if self.reason_help.is_empty() {
            usual
        } else {
            self.reason_help
        }
    }
}

/// The values that the words of a block get.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Change {
    /// F in program units per minute.
    pub feed: Option<f64>,
    /// The rapid is written as a feed.
    pub as_feed: bool,
    /// It ends at rest since it runs in exact stop; otherwise a dwell follows a rapid that is
    /// written as a feed where one is needed.
    pub exact_stop: bool,
    /// The control's word for an exact stop in one block ends it at rest, where it would
    /// be blended with the next one.
    pub stop: bool,
    /// The knob for rapid speed (index in `controller.knobs`), and percent.
    pub rapid_percent: Option<(usize, f64)>,
    /// The knob for acceleration or for jerk, and its value for each axis, in its unit; of one
    /// with levels, which may be those of the rapid speed, the index of the level.
    pub accel: Option<(usize, AxisValues)>,
    /// The same for the largest speed.
    pub speed: Option<(usize, AxisValues)>,
    /// The knob by which hills of speed need no cruise; its value is 0.
    pub cruise: Option<usize>,
}

impl Change {
    /// Nothing.
    pub const NONE: Self = Self {
        feed: None,
        as_feed: false,
        exact_stop: false,
        stop: false,
        rapid_percent: None,
        accel: None,
        speed: None,
        cruise: None,
    };

    /// A rapid of no length as a feed.
    pub const STANDING: Self = Self {
        as_feed: true,
        ..Self::NONE
    };

    /// A rapid as a feed at a path speed, mm/s.
    #[must_use]
    pub fn as_feed_at(machine: &Machine, mv: &Move, permit: &Permit, speed_mm_s: f64) -> Self {
        Self {
            feed: Some(feed_word(machine, mv, permit, speed_mm_s)),
            as_feed: true,
            ..Self::NONE
        }
    }

    /// The F at which no axis is faster than by a rapid of its own, in program units.
    #[must_use]
    pub fn slowest_rapid(machine: &Machine, mm_per_unit: f64) -> Option<f64> {
        let axes = machine.axis_set.iter();
        let feeds = axes.filter_map(|axis| {
            let data = machine.axes[axis].as_ref()?;
            let unit = if data.kind == AxisKind::Linear {
                mm_per_unit
            } else {
                1.0
            };
            Some(round_feed_down(data.rapid_mm_s * SECONDS_PER_MINUTE / unit))
        });
        feeds.min_by(f64::total_cmp)
    }

    /// The lower value of each word, for a block with several moves.
    #[must_use]
    pub fn lower(&self, other: &Self) -> Self {
        let lower = |a: f64, b: f64| a.min(b);
        let whole = |change: &Self| change.exact_stop && change.accel.is_some();
        let by_axis = |a: (usize, AxisValues), b: (usize, AxisValues)| {
            (a.0, std::array::from_fn(|axis| a.1[axis].min(b.1[axis])))
        };
        Self {
            feed: either(self.feed, other.feed, lower),
            as_feed: self.as_feed || other.as_feed,
            // Where a knob stops the axes it is exact stop that leaves the move whole.
            exact_stop: self.exact_stop && other.exact_stop || whole(self) || whole(other),
            // A stop that one run needs harms no other.
            stop: self.stop || other.stop,
            rapid_percent: either(self.rapid_percent, other.rapid_percent, |a, b| {
                (a.0, a.1.min(b.1))
            }),
            accel: either(self.accel, other.accel, by_axis),
            speed: either(self.speed, other.speed, by_axis),
            cruise: self.cruise.filter(|_| other.cruise.is_some()),
        }
    }

    /// True when nothing is changed.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// The knobs that it turns with their values, in the order in which they are written.
    #[must_use]
    pub fn knobs(&self, machine: &Machine) -> [Option<(usize, AxisValues)>; 4] {
        let rapid = self.rapid_percent.map(|(knob, percent)| {
            let data = machine.controller.knobs.get(knob);
            let value = data.map_or(percent, |data| data.of_percent(percent));
            (knob, [value; AXES])
        });
        let cruise = self.cruise.map(|knob| (knob, [0.0; AXES]));
        [self.accel, self.speed, cruise, rapid]
    }

    /// How corners and hills of a move are taken.
    #[must_use]
    pub fn corner(&self, machine: &Machine, mv: &Move) -> Corner {
        match (mv.corner, Square::of(machine)) {
            (corner, _) if self.cruise.is_none() => corner,
            (Corner::Square(square), _) | (_, Some(square)) => Corner::Square(Square {
                cruise_ratio: 0.0,
                ..square
            }),
            (corner, None) => corner,
        }
    }

    /// The move as the controller will run it, computed as the interpreter
    /// does from the words that will be written.
    #[must_use]
    pub fn apply(&self, machine: &Machine, mv: &Move, permit: &Permit) -> Move {
        let mut changed = mv.clone();
        if self.as_feed {
            changed.kind = MoveKind::Feed;
            changed.accel_mm_s2 = permit.feed_accel_mm_s2;
        }
        if self.exact_stop {
            changed.path_mode = PathMode::ExactStop;
        }
        if self.stop {
            changed.path_mode = PathMode::ExactStop;
        }
        if let Some(feed) = self.feed {
            changed.feed_mm_s = feed_speed(machine, mv, permit, feed);
            changed.feed_excess = 1.0;
        }
        changed.corner = self.corner(machine, mv);
        if let Some((knob, percent)) = self.rapid_percent {
            set_rapid_share(machine, &mut changed, knob, percent);
        }
        if let Some((knob, level)) = level_of(machine, self.accel) {
            super::knob_level::put(knob, level, &mut changed);
        } else if let Some((knob, values)) = self.accel
            && let Some(knob) = machine.controller.knobs.get(knob)
        {
            if knob.target == KnobTarget::Jerk {
                changed.jerk_factor = values[0] / 100.0;
                return under_cap(machine, changed, self.speed, permit);
            }
            if knob.argument == KnobArgument::Value {
                limit_path_accel(machine, &mut changed, values[0]);
                return under_cap(machine, changed, self.speed, permit);
            }
            let printer = &machine.controller.language.printer;
            let retracts = printer.may_retract(mv.unknown_start);
            for axis in machine.axis_set.iter() {
                if retracts && axis == AxisId::E as usize {
                    continue;
                }
                if let Some(data) = &machine.axes[axis] {
                    changed.accel_mm_s2[axis] =
                        knob.unit
                            .accel_mm_s2(data, values[axis], permit.knob_mm_per_unit);
                }
            }
            if knob.with_jerk {
                changed.jerk_factor = jerk_share(machine, &changed);
            }
        }
        under_cap(machine, changed, self.speed, permit)
    }
}

/// The share of the jerk limits that a word for accelerations which acts on them too leaves:
/// the largest of the axes.
fn jerk_share(machine: &Machine, mv: &Move) -> f64 {
    let axes = AxisSet(mv.moving.0 | mv.unknown_start.0);
    let shares = axes.iter().filter_map(|axis| {
        let own_mm_s2 = machine.axes[axis]?.accel_mm_s2;
        Some(mv.accel_mm_s2[axis] / own_mm_s2)
    });
    shares.reduce(f64::max).unwrap_or(1.0)
}

/// Sets a rapid's share of the rapid speed, in %, by a knob.
pub(super) fn set_rapid_share(machine: &Machine, mv: &mut Move, knob: usize, percent: f64) {
    mv.rapid_factor = percent / 100.0;
    let knob = machine.controller.knobs.get(knob);
    if knob.is_some_and(|knob| knob.target == KnobTarget::SpeedShare) {
        mv.pace = mv.rapid_factor;
    }
}

/// A move under a knob for the largest speed.
fn under_cap(
    machine: &Machine,
    mut mv: Move,
    cap: Option<(usize, AxisValues)>,
    permit: &Permit,
) -> Move {
    if let Some((knob, values)) = cap
        && let Some(knob) = machine.controller.knobs.get(knob)
    {
        let speed_mm_s = capped_mm_s(machine, &mv, knob, &values, permit);
        if speed_mm_s < mv.feed_mm_s {
            if mv.feed_mm_s.is_finite() {
                mv.feed_excess *= mv.feed_mm_s / speed_mm_s;
            }
            mv.feed_mm_s = speed_mm_s;
        }
    }
    mv
}

/// Sets a limit of acceleration along the path, as the interpreter does.
pub(super) fn limit_path_accel(machine: &Machine, mv: &mut Move, accel_mm_s2: f64) {
    mv.path_accel_mm_s2 = accel_mm_s2;
    raise_to_path(machine, &mut mv.accel_mm_s2, accel_mm_s2);
    if !mv.unknown_start.is_empty() {
        hold_to_path(machine, &mut mv.accel_mm_s2, accel_mm_s2);
    }
}

/// The speed along the path, mm/s, that the values of a knob leave.
fn capped_mm_s(
    machine: &Machine,
    mv: &Move,
    knob: &Knob,
    values: &AxisValues,
    permit: &Permit,
) -> f64 {
    if knob.argument == KnobArgument::Value {
        return values[0];
    }
    let commanded = AxisSet(mv.moving.0 | mv.unknown_start.0);
    let speeds = commanded.iter().filter_map(|axis| {
        let data = machine.axes[axis].as_ref()?;
        let unit = permit.knob_mm_per_unit;
        Some((axis, knob.unit.speed_mm_s(data, values[axis], unit)))
    });
    if !mv.unknown_start.is_empty() {
        return speeds.fold(0.0, |largest, (_, speed)| speed.max(largest));
    }
    let along = speeds.filter_map(|(axis, speed)| {
        let way_mm = (mv.end[axis] - mv.start[axis]).abs();
        (way_mm > 0.0).then(|| speed * mv.length_mm / way_mm)
    });
    along.fold(f64::INFINITY, f64::min)
}

/// One of two values, or both put together.
fn either<T>(a: Option<T>, b: Option<T>, both: impl FnOnce(T, T) -> T) -> Option<T> {
    match (a, b) {
        (Some(a), Some(b)) => Some(both(a, b)),
        (a, b) => a.or(b),
    }
}

/// The largest path speed of a feed on the way of a move, mm/s.
fn max_feed_mm_s(machine: &Machine, mv: &Move) -> f64 {
    if mv.arc.is_some() || !mv.unknown_start.is_empty() {
        return machine.path.max_feed_mm_s;
    }
    machine.max_feed_mm_s(&mv.start, &mv.end, mv.length_mm)
}

/// Path speed in mm/s (degrees/s) of an F in program units.
pub(super) fn feed_speed(machine: &Machine, mv: &Move, permit: &Permit, feed: f64) -> f64 {
    let speed_mm_s = feed * feed_unit(machine, mv, permit) / SECONDS_PER_MINUTE;
    speed_mm_s.min(max_feed_mm_s(machine, mv))
}

/// The F in program units, rounded down, of a path speed in mm/s (degrees/s): none that the
/// control does not take.
pub(super) fn feed_word(machine: &Machine, mv: &Move, permit: &Permit, speed_mm_s: f64) -> f64 {
    let speed_mm_s = speed_mm_s.min(max_feed_mm_s(machine, mv));
    round_feed_down(speed_mm_s * SECONDS_PER_MINUTE / feed_unit(machine, mv, permit))
}

/// Millimetres, or degrees, in the unit of length that F speaks of: under G93 the way of the
/// block itself.
pub(super) fn feed_unit(machine: &Machine, mv: &Move, permit: &Permit) -> f64 {
    if mv.feed_mode == FeedMode::InverseTime && mv.kind != MoveKind::Rapid {
        return mv.length_mm;
    }
    let commanded = mv.moving.0 | mv.unknown_start.0;
    let linear = AxisSet(commanded)
        .iter()
        .any(|axis| machine.axes[axis].is_some_and(|data| data.kind == AxisKind::Linear));
    if linear { permit.mm_per_unit } else { 1.0 }
}

/// Rounds a feed down to five significant digits (a loss of 1e-4 at most).
pub(super) fn round_feed_down(feed: f64) -> f64 {
    let magnitude = libm::floor(libm::log10(feed));
    let decimals = (4.0 - magnitude).clamp(0.0, 9.0);
    round_down(feed, libm::pow(10.0, decimals).round())
}

/// Rounds down to a multiple of `step`.
pub(super) fn round_to_step(value: f64, step: f64) -> f64 {
    if step <= 0.0 {
        return value;
    }
    let steps_in_one = 1.0 / step;
    if steps_in_one >= 1.0 && (steps_in_one - steps_in_one.round()).abs() < 1e-9 {
        round_down(value, steps_in_one.round())
    } else {
        (value / step).floor() * step
    }
}

/// Rounds down to a multiple of 1/`per_one`; the quotient of two whole numbers
/// is the decimal number that will be written.
fn round_down(value: f64, per_one: f64) -> f64 {
    let whole = (value * per_one).floor();
    let rounded = whole / per_one;
    if rounded <= value {
        rounded
    } else {
        (whole - 1.0) / per_one
    }
}

#[cfg(test)]
mod tests {
    use super::{round_feed_down, round_to_step};

    #[test]
    fn feeds_keep_five_digits() {
        assert_eq!(round_feed_down(1234.5678), 1234.5);
        assert_eq!(round_feed_down(123_456.7), 123_456.0);
        assert_eq!(round_feed_down(83.333_333), 83.333);
        assert_eq!(round_feed_down(0.012_345_67), 0.012_345);
        assert_eq!(round_feed_down(800.0), 800.0);
    }

    #[test]
    fn steps_go_down() {
        assert_eq!(round_to_step(47.39, 0.1), 47.3);
        assert_eq!(round_to_step(47.3, 0.1), 47.3);
        assert_eq!(round_to_step(47.9, 5.0), 45.0);
        assert_eq!(round_to_step(0.04, 0.1), 0.0);
    }
}
