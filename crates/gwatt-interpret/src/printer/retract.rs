//! G10 and G11: filament that the firmware pulls back and pushes forward.

use super::line::{Parameters, has, value};
use crate::control::{Control, Run};
use crate::places::EXTRUDER;
use gwatt_machine::{AxisId, AxisSet};
use gwatt_motion::ActionKind;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// G10 and G11: retract and recover; with other values G10 sets a tool or
    /// an offset.
    ///
    /// Sources: Marlin G10, G11 (S1: a longer retract) and Klipper (`firmware_retraction.py`),
    /// which retract whatever else is given; Duet documentation G10 (P, R, S: temperatures;
    /// L2, L20 and axes: offsets).
    pub(super) fn retract_or_set(
        &mut self,
        run: &mut Run<'_, '_>,
        number: u16,
        parameters: &Parameters,
        span: Span,
    ) {
        let sets = self.machine.controller.language.printer.several_commands;
        let settings = sets
            && parameters
                .iter()
                .any(|one| one.letter != b'S' || one.value.is_some_and(|value| value > 1.0));
        if number == 110 {
            return self.recover(run, span);
        }
        if !settings {
            return self.retract(run, span);
        }
        let axes = parameters
            .iter()
            .any(|one| AxisId::from_letter(one.letter).is_some());
        if axes || has(parameters, b'L') {
            self.shift_axes(parameters);
        }
        let heats = [b'S', b'R'].map(|letter| value(parameters, letter));
        if heats.iter().any(Option::is_some) {
            self.switch_printer_loads(run, 568.0, parameters, span);
        }
        run.act(ActionKind::Other, 10.0);
    }

    fn retract(&mut self, run: &mut Run<'_, '_>, span: Span) {
        if self.printer.retracted || !self.may_retract(run, span) {
            return;
        }
        let retract = self.printer.retract;
        self.printer.retracted = true;
        self.slide(run, EXTRUDER, -retract.length_mm, retract.speed_mm_s);
        self.printer.lifted_mm = retract.lift_mm;
        self.slide(run, 2, retract.lift_mm, f64::INFINITY);
    }

    fn recover(&mut self, run: &mut Run<'_, '_>, span: Span) {
        if !self.printer.retracted || !self.may_retract(run, span) {
            return;
        }
        let retract = self.printer.retract;
        self.printer.retracted = false;
        let lifted = std::mem::take(&mut self.printer.lifted_mm);
        self.slide(run, 2, -lifted, f64::INFINITY);
        let length = retract.length_mm + retract.extra_mm;
        self.slide(run, EXTRUDER, length, retract.recover_mm_s);
    }

    fn may_retract(&self, run: &mut Run<'_, '_>, span: Span) -> bool {
        run.facts.own_feed = Some("it retracts filament");
        if self.machine.axes[EXTRUDER].is_none() {
            run.report
                .error("no-such-axis", "the machine has no E axis", span)
                .help("choose a machine with it, or describe it in the machine file: [axes.E]");
            return false;
        }
        if !self.printer.retract_given {
            let retract = &self.printer.retract;
            let message = format!(
                "G10 and G11 count with the profile's retract: {} mm at {} mm/s",
                retract.length_mm, retract.speed_mm_s
            );
            run.report.note_once("retract-default", &message, span);
        }
        true
    }

    /// Moves one axis by `by_mm`; its program coordinate stays.
    fn slide(&mut self, run: &mut Run<'_, '_>, axis: usize, by_mm: f64, speed_mm_s: f64) {
        if by_mm == 0.0 || self.machine.axes[axis].is_none() {
            return;
        }
        let mut end = self.position.at;
        end[axis] += by_mm;
        let speed_mm_s = speed_mm_s * self.printer.feed_factor.max(1.0);
        let none = AxisSet::default();
        self.go_at(run, &end, none, Some(speed_mm_s));
        self.position.shift(axis, by_mm);
    }
}
