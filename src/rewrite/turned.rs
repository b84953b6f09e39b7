//! Knobs that the written program has turned otherwise than the original.

use super::knob_line;
use crate::interpret::{KnobState, Square};
use crate::limit::Change;
use crate::machine::{AXES, AxisValues, Knob, KnobArgument, KnobTarget, Machine};
use crate::motion::own_path_speed;

/// The words that switch `LinuxCNC`'s adaptive feed.
pub(crate) const SWITCH_ON: &str = "M52 P1";
const SWITCH_OFF: &str = "M52 P0";

/// See the module.
#[derive(Debug)]
pub(super) struct Turned<'m> {
    machine: &'m Machine,
    /// With their values.
    knobs: Vec<(usize, AxisValues)>,
    /// The share of the speed that was switched on (`LinuxCNC`'s M52).
    switched: Option<usize>,
}

/// What knobs act on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Acted {
    /// A block moves by a rapid.
    pub(super) rapids: bool,
    /// A block moves by a feed.
    pub(super) feeds: bool,
}

/// The limits that the original has in force.
#[derive(Debug, Clone, Copy)]
pub(super) struct InForce<'a> {
    pub(super) knobs: Option<&'a KnobState>,
    /// Millimetres in a unit of the program.
    pub(super) mm_per_unit: f64,
}

impl<'m> Turned<'m> {
    pub(super) fn new(machine: &'m Machine) -> Self {
        Self {
            machine,
            knobs: Vec::new(),
            switched: None,
        }
    }

    /// Whether all knobs stand as in the original; one that is switched on leaves the speed
    /// as it is.
    pub(super) fn is_empty(&self) -> bool {
        self.knobs.is_empty()
    }

    /// Lines before a block that moves: knobs that its change needs, and those that it
    /// must not have.
    pub(super) fn turn(
        &mut self,
        change: &Change,
        acted: Acted,
        in_force: InForce<'_>,
    ) -> Vec<String> {
        let mut lines = Vec::new();
        let wanted = change.knobs(self.machine);
        if wanted == [None; 4] && self.knobs.is_empty() {
            return lines;
        }
        // What is no longer needed is put back first: some words take the place of others.
        let needed = |knob: usize| wanted.iter().flatten().any(|(wanted, _)| *wanted == knob);
        let superfluous: Vec<usize> = self
            .knobs
            .iter()
            .map(|(knob, _)| *knob)
            .filter(|knob| !needed(*knob) && self.concerns(*knob, acted))
            .collect();
        lines.extend(
            superfluous
                .into_iter()
                .filter_map(|knob| self.restore_one(knob, in_force))
                .flatten(),
        );
        for (knob, values) in wanted.into_iter().flatten() {
            if self.knobs.contains(&(knob, values)) {
                continue;
            }
            if let Some(words) = knob_line::lines(self.machine, knob, &values) {
                lines.extend(self.switch_on(knob, in_force));
                lines.extend(self.in_unit(words, in_force));
                self.knobs.retain(|(turned, _)| *turned != knob);
                self.knobs.push((knob, values));
            }
        }
        lines
    }

    /// Lines that give all knobs the values of the original.
    pub(super) fn restore(&mut self, in_force: InForce<'_>) -> Vec<String> {
        let mut lines = Vec::new();
        let switched = self.switched.take();
        let mut share = switched;
        while let Some((knob, _)) = self.knobs.last().copied() {
            if self.is_speed_share(knob) {
                self.knobs.pop();
                share = Some(knob);
                continue;
            }
            lines.extend(self.restore_one(knob, in_force).into_iter().flatten());
        }
        if let Some((share, state)) = share.zip(in_force.knobs) {
            let output = self.machine.controller.knobs.get(share);
            let number = output.and_then(Knob::output);
            // Nothing may move any more, for which M67 waits.
            lines.extend(number.map(|number| knob_line::at_once(number, speed_share(state))));
            lines.extend(switched.map(|_| SWITCH_OFF.to_owned()));
        }
        lines
    }

    fn is_speed_share(&self, knob: usize) -> bool {
        let knob = self.machine.controller.knobs.get(knob);
        knob.is_some_and(|knob| knob.target == KnobTarget::SpeedShare)
    }

    /// The line that lets a share of the speed act, where the original has not.
    fn switch_on(&mut self, knob: usize, in_force: InForce<'_>) -> Option<String> {
        let acts = in_force.knobs.is_some_and(|state| state.adaptive);
        if acts || self.switched.is_some() || !self.is_speed_share(knob) {
            return None;
        }
        self.switched = Some(knob);
        Some(SWITCH_ON.to_owned())
    }

    /// Whether a knob acts on the moves of a block.
    fn concerns(&self, knob: usize, acted: Acted) -> bool {
        let knob = self.machine.controller.knobs.get(knob);
        knob.is_some_and(|knob| match knob.target {
            KnobTarget::FeedAccel => acted.feeds,
            KnobTarget::RapidAccel | KnobTarget::RapidSpeed => acted.rapids,
            KnobTarget::Accel
            | KnobTarget::Jerk
            | KnobTarget::Speed
            | KnobTarget::SpeedShare
            | KnobTarget::CruiseRatio => true,
        })
    }

    /// Lines that give a knob the value of the original.
    fn restore_one(&mut self, knob: usize, in_force: InForce<'_>) -> Option<Vec<String>> {
        self.knobs.retain(|(turned, _)| *turned != knob);
        let state = in_force.knobs?;
        let data = self.machine.controller.knobs.get(knob)?;
        if let Some(levels) = &data.levels {
            let level = state.levels.get(levels.group).copied().flatten()?;
            return knob_line::lines(self.machine, knob, &[f64::from(level); AXES]);
        }
        if data.target == KnobTarget::SpeedShare {
            // What the program has set does nothing where it has not switched it on.
            let share = if state.adaptive {
                speed_share(state)
            } else {
                1.0
            };
            return knob_line::lines(self.machine, knob, &[share; AXES]);
        }
        if data.argument == KnobArgument::Value {
            let value = match data.target {
                KnobTarget::Speed if state.path_speed_mm_s.is_finite() => state.path_speed_mm_s,
                KnobTarget::Speed => own_path_speed(self.machine)?,
                KnobTarget::CruiseRatio => {
                    state
                        .corner
                        .square()
                        .or_else(|| Square::of(self.machine))?
                        .cruise_ratio
                }
                _ => state.path_accel_mm_s2[0],
            };
            let value = if value > 0.0 { tidy(value) } else { value };
            return knob_line::lines(self.machine, knob, &[value; AXES]);
        }
        let printer = &self.machine.controller.language.printer;
        let unit = printer.limit_unit(in_force.mm_per_unit);
        let mut values = [0.0; AXES];
        for axis in self.machine.axis_set.iter() {
            let Some(axis_data) = &self.machine.axes[axis] else {
                continue;
            };
            let accel = match data.target {
                KnobTarget::RapidAccel => state.rapid_accel_mm_s2[axis],
                _ => state.feed_accel_mm_s2[axis],
            };
            values[axis] = tidy(match data.target {
                KnobTarget::RapidSpeed => state.rapid_factor * 100.0,
                KnobTarget::Jerk => state.jerk_factor[axis] * 100.0,
                KnobTarget::Speed => {
                    let speed_mm_s = state.speed_mm_s[axis];
                    let own = axis_data.rapid_mm_s;
                    let own = if speed_mm_s.is_finite() {
                        speed_mm_s
                    } else {
                        own
                    };
                    data.unit.speed_value(axis_data, own, unit)
                }
                _ => data.unit.value(axis_data, accel, unit),
            });
        }
        let lines = knob_line::lines(self.machine, knob, &values)?;
        Some(self.in_unit(lines, in_force))
    }

    /// Lines of a knob that are clear in millimetres alone, between G21 and G20.
    fn in_unit(&self, mut lines: Vec<String>, in_force: InForce<'_>) -> Vec<String> {
        let printer = &self.machine.controller.language.printer;
        if printer.limit_unit(in_force.mm_per_unit) != in_force.mm_per_unit {
            lines.insert(0, "G21".to_owned());
            lines.push("G20".to_owned());
        }
        lines
    }
}

/// The share of the speed that the original has set.
fn speed_share(state: &KnobState) -> f64 {
    state.speed_share_next.unwrap_or(state.speed_share)
}

/// Takes the rounding of a division off: twelve digits.
fn tidy(value: f64) -> f64 {
    let decimals = 11.0 - libm::floor(libm::log10(value));
    let scale = libm::pow(10.0, decimals.clamp(0.0, 18.0)).round();
    let rounded = (value * scale).round() / scale;
    if rounded.is_finite() { rounded } else { value }
}
