//! Words that set percentages of the axes' limits.
//!
//! Source for ACC: SINUMERIK 828D Function Manual "Basic Functions" (09/2011), "Percentage
//! acceleration override (ACC)": 0 to 200 % of the largest acceleration of an axis
//! (MD32300), in part programs; MD32320 says what holds after RESET and M30. Of the others
//! no manual was at hand: what is above 100 % counts, what is below where its user vouches
//! for the word.

use super::limits::Limits;
use super::reading::Reading;
use super::value::Val;
use crate::control::Control;
use crate::expression::{Grammar, Outcome};
use gwatt_machine::{AXES, AxisValues, Machine};

/// Largest percentage of ACC, OVRRAP and JERKLIM.
const PERCENT_MAX: f64 = 200.0;

const NOT_LOWERED: &str = "a limit that the program lowers by a percentage is counted at 100 %";

/// Words that count below 100 % where the profile vouches for them, and the note where it does
/// not.
const VOUCHED: [(&str, &str); 3] = [
    (
        "OVRRAP",
        "OVRRAP below 100 % is counted at 100 %, unless the profile has it with `verified = true`",
    ),
    (
        "VELOLIM",
        "VELOLIM below 100 % is counted at 100 %, unless the profile has it with `verified = true`",
    ),
    (
        "JERKLIM",
        "JERKLIM below 100 % is counted at 100 %, unless the profile has it with `verified = true`",
    ),
];

impl Reading<'_, '_, '_> {
    /// `ACC[X]=50`, `OVRRAP=70` and similar words; the name has been taken.
    pub(super) fn limit(&mut self, name: &str, start: usize) -> Outcome<()> {
        let axis = if self.cursor.peek() == Some(b'[') {
            self.limited_axis()?
        } else {
            None
        };
        let percent = self.value_behind(name, start)?;
        let most = match name {
            "ACC" if axis.is_some() => PERCENT_MAX,
            "OVRRAP" | "JERKLIM" => PERCENT_MAX,
            _ => 100.0,
        };
        if !(percent > 0.0 && percent <= most) {
            let message = format!("{name} of {percent} %");
            let help = if most > 100.0 {
                "values above 0 and up to 200 are read"
            } else {
                "only values above 0 and up to 100 are read: the machine's limits hold"
            };
            return Err(self.cursor.fault("override", message, help, start));
        }
        let unvouched = VOUCHED.iter().find(|(word, _)| *word == name);
        let unvouched = unvouched.filter(|_| !self.is_vouched_for(name));
        let counted = if unvouched.is_some() {
            percent.max(100.0)
        } else {
            percent
        };
        let limits = &mut self.state.limits;
        if name == "OVRRAP" {
            limits.rapids_may_be_slower = counted > percent;
        }
        let limit = match (name, axis) {
            ("ACC", Some(axis)) => Some(&mut limits.accel[axis]),
            ("VELOLIM", Some(axis)) => Some(&mut limits.speed[axis]),
            ("JERKLIM", Some(axis)) => Some(&mut limits.jerk[axis]),
            ("OVRRAP", _) => Some(&mut limits.rapid),
            _ => None,
        };
        let acts = limit.is_some();
        if let Some(limit) = limit {
            *limit = counted;
            self.extra().turns_limit = true;
        }
        if percent < 100.0 && (!acts || unvouched.is_some()) {
            let message = unvouched.map_or(NOT_LOWERED, |(_, message)| message);
            self.note("limit-not-lowered", message, start);
        }
        Ok(())
    }

    /// Whether the profile says that this word does what it is taken to do.
    fn is_vouched_for(&self, name: &str) -> bool {
        let mut knobs = self.control.machine.controller.knobs.iter();
        knobs.any(|knob| knob.name == name && knob.verified)
    }

    /// The axis in brackets; `None` for a spindle or another axis that the machine file
    /// does not have.
    fn limited_axis(&mut self) -> Outcome<Option<usize>> {
        self.cursor.expect(b'[')?;
        let before = self.cursor.at;
        let name = self.cursor.name();
        self.cursor.at += name.len();
        let own = !name.starts_with('$') && !self.is_variable(&name);
        let by_name = own && self.cursor.take(b']');
        let name = if by_name {
            name.to_string()
        } else {
            self.cursor.at = before;
            let Val::Text(name) = self.expression()? else {
                let help = "write an axis, or a variable of the type AXIS";
                let message = "a number names no axis";
                return Err(self.cursor.fault("no-such-axis", message, help, before));
            };
            self.cursor.expect(b']')?;
            name
        };
        let letter = self.axis_letter(&name);
        let axis = letter.and_then(gwatt_machine::AxisId::from_letter);
        Ok(axis.map(|axis| axis as usize))
    }
}

impl Control<'_> {
    /// Before the motion of a block that changes limits: whether they act in it already is
    /// not known, so the higher ones count.
    pub(super) fn raise_limits(&mut self, limits: &Limits) {
        let [feed, rapid] = self.accelerations(limits);
        let knobs = &mut self.knobs;
        for axis in 0..AXES {
            knobs.feed_accel_mm_s2[axis] = knobs.feed_accel_mm_s2[axis].max(feed[axis]);
            knobs.rapid_accel_mm_s2[axis] = knobs.rapid_accel_mm_s2[axis].max(rapid[axis]);
        }
        for axis in 0..AXES {
            knobs.jerk_factor[axis] = knobs.jerk_factor[axis].max(limits.jerk_factor()[axis]);
            let speed_mm_s = speed_mm_s(self.machine, axis, limits.speed[axis]);
            knobs.speed_mm_s[axis] = knobs.speed_mm_s[axis].max(speed_mm_s);
        }
        let factor = knobs.base_rapid_factor * limits.rapid / 100.0;
        knobs.rapid_factor = knobs.rapid_factor.max(factor);
        self.settle();
    }

    /// After the motion. Under compensation moves are held back: what is lower waits for
    /// its end.
    pub(super) fn settle_limits(&mut self, limits: &mut Limits) {
        limits.due = self.compensation.is_some();
        if limits.due {
            self.raise_limits(limits);
            return;
        }
        let [feed, rapid] = self.accelerations(limits);
        let knobs = &mut self.knobs;
        knobs.feed_accel_mm_s2 = feed;
        knobs.rapid_accel_mm_s2 = rapid;
        knobs.jerk_factor = limits.jerk_factor();
        knobs.speed_mm_s =
            std::array::from_fn(|axis| speed_mm_s(self.machine, axis, limits.speed[axis]));
        knobs.rapid_factor = knobs.base_rapid_factor * limits.rapid / 100.0;
        self.settle();
    }

    /// On the way to the reference point the machine's own limits count: whether
    /// percentages act there is not known.
    pub(super) fn unlimited_return(&mut self) {
        let [_, level] = self.knobs.base_accel_mm_s2;
        for axis in self.machine.axis_set.iter() {
            let own = self.machine.axes[axis].map_or(0.0, |axis| axis.accel_mm_s2);
            let limit = &mut self.knobs.rapid_accel_mm_s2[axis];
            *limit = limit.max(level[axis]).max(own);
        }
        let knobs = &mut self.knobs;
        knobs.rapid_factor = knobs.rapid_factor.max(knobs.base_rapid_factor);
        knobs.jerk_factor = knobs.jerk_factor.map(|share| share.max(1.0));
        knobs.speed_mm_s = [f64::INFINITY; AXES];
        self.settle();
    }

    /// Of feeds and of rapids: ACC's share of what the level in force gives.
    fn accelerations(&self, limits: &Limits) -> [AxisValues; 2] {
        let of =
            |base: AxisValues| std::array::from_fn(|axis| base[axis] * limits.accel[axis] / 100.0);
        self.knobs.base_accel_mm_s2.map(of)
    }
}

/// The largest speed of an axis at a percentage, mm/s; infinite at its own.
fn speed_mm_s(machine: &Machine, axis: usize, percent: f64) -> f64 {
    match machine.axes[axis] {
        Some(data) if percent < 100.0 => data.rapid_mm_s * percent / 100.0,
        _ => f64::INFINITY,
    }
}
