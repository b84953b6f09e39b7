//! Knobs in force: words by which a program lowers acceleration or rapid speed.

use gwatt_machine::{AXES, AxisSet, AxisValues, Knob, KnobTarget, KnobUnit, LEVEL_GROUPS, Machine};
use gwatt_motion::{Corner, MoveKind, own_path_accel, own_path_speed, raise_to_path};

/// Limits in force after the knobs that a program has turned.
#[derive(Debug, Clone, PartialEq)]
pub struct KnobState {
    /// Acceleration limits of feed moves, mm/s².
    pub feed_accel_mm_s2: AxisValues,
    /// Acceleration limits of rapids, mm/s².
    pub rapid_accel_mm_s2: AxisValues,
    /// Limits along the path of moves that extrude, of others, and of those
    /// that M204's P and T spare (Marlin's M204 P, T and R); infinite without one.
    pub path_accel_mm_s2: [f64; 3],
    /// Share of each axis' own limit of jerk.
    pub jerk_factor: AxisValues,
    /// Share of the rapid speed.
    pub rapid_factor: f64,
    /// Share of the speed of all moves that an output sets, where it acts.
    pub speed_share: f64,
    /// The same, set and not in force before the next move.
    pub speed_share_next: Option<f64>,
    /// It acts (`LinuxCNC`'s M52).
    pub adaptive: bool,
    /// What acted on the last move; 0 after a stop.
    pub(super) speed_share_last: f64,
    /// A knob that is set and does not act yet, with its value.
    pub(super) pending: Option<(usize, f64)>,
    /// Largest speed along the path of moves that the extruder does not make alone, mm/s
    /// (Klipper's VELOCITY); infinite where the machine's own limits hold.
    pub path_speed_mm_s: f64,
    /// Largest speed of each axis, mm/s (M203); infinite where the machine's own holds.
    pub speed_mm_s: AxisValues,
    /// The program has set limits whose unit is not known: inches count, which are more.
    pub unsure_unit: bool,
    /// How the look-ahead planner takes corners and hills.
    pub corner: Corner,
    /// The level in force of each group of words that select one; `None`: any of them may be.
    pub levels: [Option<u8>; LEVEL_GROUPS],
    /// Accelerations of feed moves and of rapids that the levels in force give, of which
    /// percentages are taken, mm/s².
    pub(super) base_accel_mm_s2: [AxisValues; 2],
    /// The share of the rapid speed that the levels in force give, of which percentages are
    /// taken.
    pub(super) base_rapid_factor: f64,
}

impl KnobState {
    /// The machine's own limits.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        let accel =
            std::array::from_fn(|axis| machine.axes[axis].map_or(0.0, |axis| axis.accel_mm_s2));
        let mut state = Self {
            feed_accel_mm_s2: accel,
            rapid_accel_mm_s2: accel,
            path_accel_mm_s2: path_accel(machine),
            jerk_factor: [1.0; AXES],
            rapid_factor: 1.0,
            speed_share: 1.0,
            speed_share_next: None,
            adaptive: false,
            speed_share_last: 0.0,
            pending: None,
            path_speed_mm_s: f64::INFINITY,
            speed_mm_s: [f64::INFINITY; AXES],
            unsure_unit: false,
            corner: Corner::default(),
            levels: [None; LEVEL_GROUPS],
            base_accel_mm_s2: [accel; 2],
            base_rapid_factor: 1.0,
        };
        for knob in &machine.controller.knobs {
            if let Some(levels) = &knob.levels {
                state.select(machine, knob, Some(levels.power_on));
            }
        }
        state
    }

    /// Puts a level in force; `None`: any of them may be, so that the largest of all count.
    /// Percentages that the program has set stay.
    pub(super) fn select(&mut self, machine: &Machine, knob: &Knob, level: Option<usize>) {
        let Some(levels) = &knob.levels else {
            return;
        };
        let found = level.and_then(|level| levels.list.get(level));
        let (accel_mm_s2, rapid_factor) = match found {
            Some(level) => (level.accel_mm_s2, level.rapid_factor),
            None => levels.largest(),
        };
        if let Some(slot) = self.levels.get_mut(levels.group) {
            *slot = level.and_then(|level| u8::try_from(level).ok());
        }
        if levels.list.iter().any(|level| level.rapid_factor != 1.0) {
            if self.rapid_factor == self.base_rapid_factor {
                self.rapid_factor = rapid_factor;
            } else {
                self.rapid_factor *= rapid_factor / self.base_rapid_factor;
            }
            self.base_rapid_factor = rapid_factor;
        }
        let [feed_base, rapid_base] = &mut self.base_accel_mm_s2;
        let limits = [
            (
                KnobTarget::RapidAccel,
                feed_base,
                &mut self.feed_accel_mm_s2,
            ),
            (
                KnobTarget::FeedAccel,
                rapid_base,
                &mut self.rapid_accel_mm_s2,
            ),
        ];
        for (other, base, limit) in limits {
            if knob.target == other || !knob.sets_accel() {
                continue;
            }
            for axis in machine.axis_set.iter() {
                // Exact where no percentage is in force.
                if limit[axis] == base[axis] {
                    limit[axis] = accel_mm_s2[axis];
                } else {
                    limit[axis] *= accel_mm_s2[axis] / base[axis];
                }
                base[axis] = accel_mm_s2[axis];
            }
        }
    }

    /// Puts the levels of an earlier state in force again.
    pub(super) fn select_all(&mut self, machine: &Machine, saved: [Option<u8>; LEVEL_GROUPS]) {
        for knob in &machine.controller.knobs {
            let group = knob.levels.as_ref().map(|levels| levels.group);
            if let Some(level) = group.and_then(|group| saved.get(group)) {
                self.select(machine, knob, level.map(usize::from));
            }
        }
    }

    /// Whether it is known which level of each group is in force.
    #[must_use]
    pub fn knows_levels(&self, machine: &Machine) -> bool {
        let knobs = machine.controller.knobs.iter();
        let mut groups = knobs.filter_map(|knob| Some(knob.levels.as_ref()?.group));
        groups.all(|group| self.levels.get(group).is_some_and(Option::is_some))
    }

    /// Sets the limit of acceleration along the path of moves that the extruder does not
    /// make alone (Klipper's `max_accel`): X and Y have no other.
    pub(super) fn limit_path_accel(&mut self, machine: &Machine, accel_mm_s2: f64) {
        self.path_accel_mm_s2[..2].fill(accel_mm_s2);
        for limits in [&mut self.feed_accel_mm_s2, &mut self.rapid_accel_mm_s2] {
            raise_to_path(machine, limits, accel_mm_s2);
        }
    }

    /// Notes that the program sets limits, in this unit.
    pub(super) fn set_in(&mut self, machine: &Machine, mm_per_unit: f64) {
        let in_mm = machine.controller.language.printer.limits_in_mm;
        self.unsure_unit |= in_mm && mm_per_unit != 1.0;
    }

    /// Sets the largest speed along the path, mm/s; the machine's own takes it back.
    pub(super) fn limit_path_speed(&mut self, machine: &Machine, speed_mm_s: f64) {
        let own = own_path_speed(machine).is_some_and(|own| same(own, speed_mm_s));
        self.path_speed_mm_s = if own { f64::INFINITY } else { speed_mm_s };
    }

    /// Sets the largest speed of an axis, mm/s; the machine's own takes it back.
    pub(super) fn limit_axis_speed(&mut self, machine: &Machine, axis: usize, speed_mm_s: f64) {
        let Some(data) = &machine.axes[axis] else {
            return;
        };
        let own = same(data.rapid_mm_s, speed_mm_s);
        self.speed_mm_s[axis] = if own { f64::INFINITY } else { speed_mm_s };
    }

    /// Takes the higher of these limits and `other`: which of both hold is not known.
    pub(super) fn raise_to(&mut self, machine: &Machine, other: &Self) {
        let lists = [
            (&mut self.feed_accel_mm_s2[..], &other.feed_accel_mm_s2[..]),
            (&mut self.rapid_accel_mm_s2, &other.rapid_accel_mm_s2),
            (&mut self.path_accel_mm_s2, &other.path_accel_mm_s2),
            (&mut self.jerk_factor, &other.jerk_factor),
        ];
        for (own, others) in lists {
            for (own, other) in own.iter_mut().zip(others) {
                *own = own.max(*other);
            }
        }
        // Infinite: the machine's own, which a program may exceed.
        let or = |speed_mm_s: f64, own_mm_s: f64| match speed_mm_s {
            speed_mm_s if speed_mm_s.is_finite() => speed_mm_s,
            _ => own_mm_s,
        };
        let own = own_path_speed(machine).unwrap_or(f64::INFINITY);
        let most = or(self.path_speed_mm_s, own).max(or(other.path_speed_mm_s, own));
        self.limit_path_speed(machine, most);
        for axis in 0..AXES {
            let own = machine.axes[axis].map_or(f64::INFINITY, |data| data.rapid_mm_s);
            let most = or(self.speed_mm_s[axis], own).max(or(other.speed_mm_s[axis], own));
            self.limit_axis_speed(machine, axis, most);
        }
        self.rapid_factor = self.rapid_factor.max(other.rapid_factor);
    }

    /// Whether a speed is limited otherwise than by the machine.
    pub(super) fn limits_speed(&self) -> bool {
        self.path_speed_mm_s.is_finite() || self.speed_mm_s.iter().any(|cap| cap.is_finite())
    }

    /// Share of the limits of jerk during a move of these axes: the largest.
    #[inline]
    pub(super) fn jerk_of(&self, moving: AxisSet) -> f64 {
        let shares = moving.iter().filter_map(|axis| self.jerk_factor.get(axis));
        shares.copied().reduce(f64::max).unwrap_or(1.0)
    }

    /// Acceleration limits of moves of this kind, mm/s².
    pub(super) fn accel(&self, kind: MoveKind) -> &AxisValues {
        if kind == MoveKind::Rapid {
            &self.rapid_accel_mm_s2
        } else {
            &self.feed_accel_mm_s2
        }
    }

    /// Sets the limit along the path; `letter` says for which moves.
    pub(super) fn turn_path(&mut self, letter: u8, value: f64, mm_per_unit: f64) {
        let accel = value * mm_per_unit;
        match letter {
            b'P' => self.path_accel_mm_s2[0] = accel,
            b'T' => self.path_accel_mm_s2[1] = accel,
            b'R' => self.path_accel_mm_s2[2] = accel,
            _ => self.path_accel_mm_s2[..2].fill(accel),
        }
    }

    /// Turns a knob for one axis, or for all (`None`); `mm_per_unit` is the
    /// program's unit of length.
    pub(super) fn turn(
        &mut self,
        machine: &Machine,
        knob: &Knob,
        axis: Option<usize>,
        value: f64,
        mm_per_unit: f64,
    ) {
        if knob.target == KnobTarget::CruiseRatio {
            return;
        }
        if knob.target == KnobTarget::SpeedShare {
            self.speed_share = value;
            return;
        }
        if knob.target == KnobTarget::RapidSpeed {
            self.rapid_factor = value / 100.0;
            return;
        }
        let which = axis.map_or(0..AXES, |axis| axis..axis + 1);
        if knob.target == KnobTarget::Speed {
            for axis in which {
                if let Some(data) = &machine.axes[axis] {
                    let speed_mm_s = knob.unit.speed_mm_s(data, value, mm_per_unit);
                    self.limit_axis_speed(machine, axis, speed_mm_s);
                }
            }
            return;
        }
        if knob.target == KnobTarget::Jerk {
            for axis in which {
                self.jerk_factor[axis] = value / 100.0;
            }
            return;
        }
        for axis in which {
            let Some(data) = &machine.axes[axis] else {
                continue;
            };
            let accel = knob.unit.accel_mm_s2(data, value, mm_per_unit);
            let of_base = matches!(knob.unit, KnobUnit::Percent | KnobUnit::Share);
            let share = |base: &AxisValues| {
                if of_base && base[axis] != data.accel_mm_s2 {
                    base[axis] / data.accel_mm_s2
                } else {
                    1.0
                }
            };
            let [feed, rapid] = self.base_accel_mm_s2.each_ref().map(share);
            if knob.with_jerk {
                self.jerk_factor[axis] = accel / data.accel_mm_s2;
            }
            if knob.target != KnobTarget::RapidAccel {
                self.feed_accel_mm_s2[axis] = accel * feed;
            }
            if knob.target != KnobTarget::FeedAccel {
                self.rapid_accel_mm_s2[axis] = accel * rapid;
            }
        }
    }
}

/// Limits along the path when a program begins: Klipper's for all axes, or those that M204
/// sets.
fn path_accel(machine: &Machine) -> [f64; 3] {
    let all = own_path_accel(machine);
    let [print, travel, alone] = machine.path.accel_mm_s2;
    [print.min(all), travel.min(all), alone]
}

/// What a limit that is read back may differ from the machine's own by, as a share.
const ROUNDING: f64 = 1e-9;

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a
}
