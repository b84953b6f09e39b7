//! Polar coordinates ("Travel commands with polar coordinates").
//!
//! G110, G111 and G112 set the pole, from the last position, the zero point and
//! the last pole; AP is the angle from the first axis of the plane, RP the
//! distance from the pole.

use super::frame_words::at_angle;
use super::target::Target;
use super::{Measure, Siemens};
use crate::control::{Control, Run};
use crate::letters::AXIS_LETTERS;
use gwatt_machine::{AxisSet, AxisValues};
use gwatt_syntax::source::Span;

impl Control<'_> {
    pub(super) fn set_pole(
        &self,
        which: u8,
        span: Span,
        state: &mut Siemens,
        run: &mut Run<'_, '_>,
    ) {
        let [first, second, _] = self.modal.plane;
        let here = state.program_place(&self.position.at);
        if which == 0 && (self.is_unknown(first) || self.is_unknown(second)) {
            run.report
                .error(
                    "polar-pole",
                    "a pole from a position that is not known",
                    span,
                )
                .help("give --start X0,Y0,Z0, or write G111");
            return;
        }
        let base = match which {
            0 => [here[0], here[1], here[2]],
            1 => [0.0; 3],
            _ => state.polar.pole,
        };
        let mut pole = base;
        // Places of X like others: under DIAMON they are diameters, under DIAM90 those of G111.
        let halves = state.in_diameters() && !(state.radius_increments && which != 1);
        for (axis, value) in run.words.axes() {
            if let Some(slot) = pole.get_mut(axis) {
                let share = if axis == 0 && halves { 0.5 } else { 1.0 };
                *slot += value * self.unit_of(axis) * share;
            }
        }
        run.words.unused &= !AXIS_LETTERS;
        let angle = state.extra.polar_angle.map_or(0.0, |(_, angle)| angle);
        if let Some((_, radius)) = state.extra.polar_radius {
            let [along, across] = at_angle(radius * self.modal.mm_per_unit, angle);
            if let Some(slot) = pole.get_mut(first) {
                *slot += along;
            }
            if let Some(slot) = pole.get_mut(second) {
                *slot += across;
            }
        }
        state.polar.pole = pole;
        // A radius that does not come again is that of the last place.
        state.polar.angle_deg = 0.0;
        state.polar.radius = 0.0;
    }

    fn is_unknown(&self, axis: usize) -> bool {
        self.position.unknown.contains(axis)
    }

    /// AP and RP of a block.
    pub(super) fn polar_target(
        &self,
        state: &mut Siemens,
        target: &mut Target,
        from: &AxisValues,
        run: &mut Run<'_, '_>,
    ) {
        let (angle, radius) = (state.extra.polar_angle, state.extra.polar_radius);
        if angle.is_none() && radius.is_none() {
            return;
        }
        let span = run.whole();
        let [first, second, _] = self.modal.plane;
        if target.named.contains(first) || target.named.contains(second) {
            run.report
                .error(
                    "polar-mixed",
                    "polar coordinates with the axes of the plane",
                    span,
                )
                .help("write AP and RP, or the axes");
            return;
        }
        if first.max(second) > 2 || self.is_unknown(first) || self.is_unknown(second) {
            run.report
                .error(
                    "polar-from-unknown",
                    "a polar move from a position that is not known",
                    span,
                )
                .help("give --start X0,Y0,Z0, or move the axes first");
            return;
        }
        let pole = [state.polar.pole[first], state.polar.pole[second]];
        let here = [from[first] - pole[0], from[second] - pole[1]];
        let last_angle = if here == [0.0, 0.0] {
            state.polar.angle_deg
        } else {
            libm::atan2(here[1], here[0]).to_degrees()
        };
        let last_radius = libm::hypot(here[0], here[1]);
        let unit = self.modal.mm_per_unit;
        let increment = |measure: Measure| measure == Measure::Increment;
        let angle = match angle {
            Some((measure, value)) if increment(measure) => last_angle + value,
            Some((_, value)) => value,
            None => last_angle,
        };
        let radius = match radius {
            Some((measure, value)) if increment(measure) => last_radius + value * unit,
            Some((_, value)) => value * unit,
            None => last_radius,
        };
        if radius.is_nan() || radius < 0.0 {
            run.report
                .error("polar-radius", "a polar radius that is negative", span)
                .help("write a radius from 0 on");
            return;
        }
        state.polar.angle_deg = angle;
        state.polar.radius = radius;
        let [along, across] = at_angle(radius, angle);
        target.program[first] = pole[0] + along;
        target.program[second] = pole[1] + across;
        let mut plane = AxisSet::default();
        plane.insert(first);
        plane.insert(second);
        target.named.0 |= plane.0;
        if state.extra.machine_coordinates {
            run.report
                .error(
                    "polar-suppressed",
                    "polar coordinates with G53, G153 or SUPA",
                    span,
                )
                .help("write the axes");
        }
    }
}
