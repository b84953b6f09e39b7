//! Settings that change later moves: percentages, speed limits, retracts.

use super::line::{Parameters, value};
use crate::control::{Control, Run};
use crate::knob::KnobState;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_machine::{AxisId, KnobArgument};
use gwatt_motion::{ActionKind, Corner};
use gwatt_syntax::source::Span;

/// Largest percentage that is taken for one.
const PERCENT_MAX: f64 = 10_000.0;

impl Control<'_> {
    /// Reports a value that no firmware could mean.
    pub(super) fn bad_value(run: &mut Run<'_, '_>, span: Span, help: &'static str) {
        run.report
            .error("printer-value", "this value is out of range", span)
            .help(help);
    }

    /// Whether anything changes feeds or lengths of moves.
    pub(crate) fn settle(&mut self) {
        let state = &mut self.printer;
        state.adjusts = state.feed_factor != 1.0
            || state.flow * state.volumetric != 1.0
            || state.least_mm_s != [0.0; 2]
            || state.unstated.any()
            || self.knobs.limits_speed();
    }

    /// M220: percentage of all feeds; B puts it by, R takes it back.
    ///
    /// Source: Marlin M220; Klipper and `RepRapFirmware` have S alone, which is 100 on Klipper
    /// where it is not given (`gcode_move.py`).
    pub(super) fn feed_percent(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        if super::line::has(parameters, b'B') {
            self.printer.kept_feed_factor = self.printer.feed_factor;
        }
        if super::line::has(parameters, b'R') {
            self.printer.feed_factor = self.printer.kept_feed_factor;
        }
        if let Some(percent) = self.percent(parameters) {
            if !(percent > 0.0 && percent <= PERCENT_MAX) {
                return Self::bad_value(run, span, "write a percentage above 0");
            }
            self.printer.feed_factor = percent / 100.0;
        }
        run.facts.boundary = true;
        run.act(ActionKind::Other, 220.0);
        self.settle();
    }

    /// The percentage of M220 and M221.
    fn percent(&self, parameters: &Parameters) -> Option<f64> {
        let default = self.names_parameters().then_some(100.0);
        value(parameters, b'S').or(default)
    }

    /// M221: percentage of all lengths of filament.
    ///
    /// Source: Marlin M221, Klipper M221.
    pub(super) fn flow_percent(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        let tool = value(parameters, b'T').or_else(|| value(parameters, b'D'));
        if let Some(percent) = self.percent(parameters) {
            if !(percent > 0.0 && percent <= PERCENT_MAX) {
                return Self::bad_value(run, span, "write a percentage above 0");
            }
            if tool.is_some_and(|tool| tool != f64::from(self.printer.tool)) {
                return Self::bad_value(run, span, "only the flow of the tool in use is followed");
            }
            self.printer.flow = percent / 100.0;
        }
        run.act(ActionKind::Other, 221.0);
        self.settle();
    }

    /// M200: E in mm³ of filament of diameter D; D0 or S0 ends it.
    ///
    /// Source: Marlin M200, `RepRapFirmware` M200.
    pub(super) fn volumetric(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        let diameter = value(parameters, b'D');
        let on = value(parameters, b'S') != Some(0.0);
        match diameter {
            _ if !on => self.printer.volumetric = 1.0,
            Some(0.0) => self.printer.volumetric = 1.0,
            Some(diameter) if (0.1..=20.0).contains(&diameter) => {
                let radius = diameter / 2.0;
                self.printer.volumetric = 1.0 / (std::f64::consts::PI * radius * radius);
            }
            None if parameters.is_empty() => {}
            _ => {
                let help = "write the filament's diameter, as in M200 D1.75";
                return Self::bad_value(run, span, help);
            }
        }
        run.act(ActionKind::Other, 200.0);
        self.settle();
    }

    /// M203: largest speed of each axis.
    ///
    /// Source: Marlin M203 (units/s), `RepRapFirmware` M203 (mm/min, S1 mm/s; I: the smallest
    /// speed of any move).
    pub(super) fn speed_caps(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        let Some(unit) = self.machine.controller.language.printer.speed_cap_mm_s else {
            return;
        };
        // RepRapFirmware, GCodes2.cpp, case 203: mm/s after S1.
        let per_second = value(parameters, b'S').is_some_and(|s| s.trunc() == 1.0);
        let unit = if per_second { 1.0 } else { unit };
        for parameter in parameters {
            let axis = AxisId::from_letter(parameter.letter).map(|axis| axis as usize);
            let (Some(axis), Some(value)) = (axis, parameter.value) else {
                continue;
            };
            let cap = value * unit * self.modal.mm_per_unit;
            if !(cap > 0.0 && cap <= 1e6) {
                return Self::bad_value(run, span, "write a speed above 0");
            }
            self.knobs.limit_axis_speed(self.machine, axis, cap);
        }
        let has_least = self.machine.controller.language.printer.several_commands;
        if has_least && let Some(least) = value(parameters, b'I').filter(|least| *least >= 0.0) {
            self.printer.least_mm_s = [least * unit * self.modal.mm_per_unit; 2];
        }
        self.knobs.set_in(self.machine, self.modal.mm_per_unit);
        run.facts.turns_knob = true;
        self.settle();
    }

    /// M205 S and T: smallest speeds.
    ///
    /// Source: Marlin M205.
    pub(super) fn least_speeds(&mut self, parameters: &Parameters) {
        for (slot, letter) in [b'S', b'T'].into_iter().enumerate() {
            if let Some(speed) = value(parameters, letter).filter(|speed| *speed >= 0.0) {
                self.printer.least_mm_s[slot] = speed * self.modal.mm_per_unit;
            }
        }
        self.settle();
    }

    /// M207: S length, F speed in mm/min, Z lift; `RepRapFirmware` also R extra
    /// length and T speed of the way back.
    ///
    /// Source: Marlin M207, Duet documentation M207.
    pub(super) fn set_retract(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        let unit = self.modal.mm_per_unit;
        let mut retract = self.printer.retract;
        let speed = |value: f64| value * unit / SECONDS_PER_MINUTE;
        for parameter in parameters {
            let Some(value) = parameter.value else {
                continue;
            };
            match parameter.letter {
                b'S' => retract.length_mm = value * unit,
                b'Z' => retract.lift_mm = value * unit,
                b'R' => retract.extra_mm = value * unit,
                b'F' => {
                    retract.speed_mm_s = speed(value);
                    retract.recover_mm_s = retract.recover_mm_s.max(speed(value));
                }
                b'T' => retract.recover_mm_s = speed(value),
                _ => {}
            }
        }
        self.take_retract(run, retract, span);
        run.act(ActionKind::Other, 207.0);
    }

    /// M208: S extra length, F speed in mm/min of the way back.
    ///
    /// Source: Marlin M208.
    pub(super) fn set_recover(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) {
        let unit = self.modal.mm_per_unit;
        let mut retract = self.printer.retract;
        if let Some(extra) = value(parameters, b'S') {
            retract.extra_mm = extra * unit;
        }
        if let Some(feed) = value(parameters, b'F').filter(|feed| *feed > 0.0) {
            retract.recover_mm_s = feed * unit / SECONDS_PER_MINUTE;
        }
        let given = self.printer.retract_given;
        self.take_retract(run, retract, span);
        self.printer.retract_given = given;
        run.act(ActionKind::Other, 208.0);
    }

    pub(super) fn take_retract(
        &mut self,
        run: &mut Run<'_, '_>,
        retract: gwatt_machine::Retract,
        span: Span,
    ) {
        let lengths = [retract.length_mm, retract.lift_mm];
        let fine = lengths.iter().all(|length| (0.0..=1e4).contains(length))
            && retract.extra_mm.abs() <= 1e4
            && retract.speed_mm_s > 0.0
            && retract.recover_mm_s > 0.0;
        if !fine {
            return Self::bad_value(run, span, "write lengths from 0 and speeds above 0");
        }
        self.printer.retract = retract;
        self.printer.retract_given = true;
    }

    /// M92: what the program names is taken for the truth; another value for
    /// the same axis cannot be true as well.
    pub(super) fn steps_per_unit(&mut self, run: &mut Run<'_, '_>, parameters: &Parameters) {
        for parameter in parameters {
            let axis = AxisId::from_letter(parameter.letter).map(|axis| axis as usize);
            if let (Some(axis), Some(value)) = (axis, parameter.value) {
                self.steps_of(run, axis, value, parameter.span);
            }
        }
        run.act(ActionKind::Other, 92.0);
    }

    /// Steps per unit, or another scale, of one axis.
    pub(super) fn steps_of(&mut self, run: &mut Run<'_, '_>, axis: usize, value: f64, span: Span) {
        let steps = &mut self.printer.steps[axis];
        if *steps != 0.0 && *steps != value {
            run.report
                .error(
                    "steps-per-unit",
                    "a second scale for this axis: its real distances are not known",
                    span,
                )
                .help("give the scale once, at the beginning of the program");
            return;
        }
        *steps = value;
        let message = "the steps per unit in the program are taken to be the machine's true ones";
        run.report.note_once("steps-per-unit", message, span);
    }

    /// M204: limits along the path, by the letters of the profile; false where
    /// it has none. The letters stand in the order in which they are read.
    ///
    /// Source: Marlin M204 (S for P and T, before them), `RepRapFirmware` M204.
    pub(super) fn path_limits(
        &mut self,
        run: &mut Run<'_, '_>,
        parameters: &Parameters,
        span: Span,
    ) -> bool {
        let knobs = &self.machine.controller.knobs;
        let letters = knobs.iter().find_map(|knob| match &knob.argument {
            KnobArgument::Path(letters) if knob.code == Some((b'M', 2040)) => Some(letters),
            _ => None,
        });
        let Some(letters) = letters else { return false };
        for letter in letters {
            let Some(accel) = value(parameters, *letter) else {
                continue;
            };
            if !(accel > 0.0 && accel <= 1e9) {
                Self::bad_value(run, span, "write an acceleration above 0");
                return true;
            }
            self.knobs.turn_path(*letter, accel, self.modal.mm_per_unit);
            run.facts.turns_knob = true;
        }
        self.knobs.set_in(self.machine, self.modal.mm_per_unit);
        true
    }

    /// Klipper's limits of X and Y: `SET_VELOCITY_LIMIT`, `M204 S`.
    ///
    /// Source: Klipper, "G-Codes", `[toolhead]`: velocity and acceleration of
    /// the toolhead; Z and the extruder have limits of their own besides.
    pub(super) fn limit_velocity(
        &mut self,
        run: &mut Run<'_, '_>,
        velocity_mm_s: Option<f64>,
        accel_mm_s2: Option<f64>,
        span: Span,
    ) {
        let given = [velocity_mm_s, accel_mm_s2];
        if given
            .iter()
            .flatten()
            .any(|value| !(*value > 0.0 && *value <= 1e7))
        {
            return Self::bad_value(run, span, "write values above 0");
        }
        run.facts.turns_knob = true;
        if let Some(velocity) = velocity_mm_s {
            self.knobs.limit_path_speed(self.machine, velocity);
        }
        if let Some(accel) = accel_mm_s2 {
            self.knobs.limit_path_accel(self.machine, accel);
        }
        self.settle();
    }

    /// `RESET_VELOCITY_LIMIT`: the configured limits.
    pub(super) fn reset_velocity(&mut self, run: &mut Run<'_, '_>) {
        run.facts.turns_knob = true;
        self.take_corner(Corner::default());
        self.knobs = KnobState::new(self.machine);
        self.settle();
    }

    /// M501: the stored settings, which the machine file describes.
    ///
    /// Source: Marlin M501.
    pub(super) fn restore_settings(&mut self, run: &mut Run<'_, '_>, span: Span) {
        run.facts.turns_knob = true;
        run.facts.boundary = true;
        self.take_corner(Corner::default());
        self.knobs = KnobState::new(self.machine);
        let state = &mut self.printer;
        state.least_mm_s = [0.0; 2];
        state.volumetric = 1.0;
        state.retract = self.machine.controller.language.printer.retract;
        state.retract_given = false;
        // The offset of the home position (M206) is among them.
        self.position.unknown.0 |= self.machine.axis_set.0;
        let message = "M501: the stored settings are taken to be those of the machine file";
        run.report.note_once("stored-settings", message, span);
        run.act(ActionKind::Other, 501.0);
        self.settle();
    }
}

#[cfg(test)]
mod tests {
    use crate::printer::testing::execute;
    use gwatt_motion::EarlyLimits::{AxisAccel, PathAccel, Speed};
    use gwatt_motion::{ActionKind, EarlyLimits, Step};

    /// The limits that may act early, with their factors, on RepRapFirmware.
    fn early(lines: &[&str]) -> Vec<(EarlyLimits, f64)> {
        let y = "[axes.Y]\nrapid_mm_min = 6000\naccel_mm_s2 = 500\nmass_kg = 5\n";
        let (steps, found) = execute("reprap", y, lines);
        assert_eq!(found.errors, 0, "{:?}", found.list);
        let actions = steps.iter().filter_map(|step| match step {
            Step::Action(action) => Some(action),
            Step::Move(_) => None,
        });
        let early = actions.filter_map(|action| match action.kind {
            ActionKind::EarlyLimits(limits) => Some((limits, action.value)),
            _ => None,
        });
        early.collect()
    }

    #[test]
    fn a_line_with_a_motion_word_keeps_limits_off_the_move_before() {
        // Nothing has moved yet; the same again changes nothing.
        assert_eq!(early(&["M201 X400", "G1 X1 F60", "M201 X400"]), []);
        assert_eq!(early(&["G1 X1 F60", "M201 X1000"]), [(AxisAccel, 2.0)]);
        assert_eq!(
            early(&["G1 X1 F60", "M204 P100", "M201 X250"]),
            [(PathAccel, 1.0), (AxisAccel, 1.0)]
        );
        for barrier in ["G1", "G1 F60", "G0", "N7 G1 ; wait"] {
            assert_eq!(
                early(&["G1 X1 F60", barrier, "M201 X1000"]),
                [],
                "{barrier}"
            );
        }
        assert_eq!(
            early(&["G1 X1 F60", "G1", "G1 X2", "M203 X600"]),
            [(Speed, 1.0)]
        );
        // The machine's own 6000 mm/min, and three times as much.
        assert_eq!(
            early(&["M203 X600", "G1 X1 F60", "M203 X18000"]),
            [(Speed, 30.0)]
        );
        assert_eq!(early(&["G1 X1 F60", "M203 X18000"]), [(Speed, 3.0)]);
    }

    #[test]
    fn limits_of_axes_that_stand_and_words_after_an_arc_do_not_act_early() {
        assert_eq!(early(&["G1 X1 F60", "M201 Y1000", "M203 Y18000"]), []);
        assert_eq!(
            early(&["M204 P100", "G1 X1 F60", "M204 P1000"]),
            [(PathAccel, 10.0)]
        );
        // Its chords, of at most 1 mm, are all in the queue before the word is read.
        assert_eq!(early(&["G2 X20 Y0 I10 J0 F60", "M201 X1000"]), []);
        assert_eq!(
            early(&["G2 X0.5 Y0 I0.25 J0 F60", "M201 X1000"]),
            [(AxisAccel, 2.0)]
        );
    }
}
