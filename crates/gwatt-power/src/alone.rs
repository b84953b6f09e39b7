//! Independent rapids at lower overrides: axes that run alone on their converter.
//!
//! Input: a rapid whose axes run for themselves, and its plans at lower overrides.
//! Output: what such an axis draws and feeds back at most at any of them.

use super::demand::{Demand, Totals, Want, larger};
use super::independent;
use super::interval::{Interval, Ramp};
use super::knob::CLOSE;
use super::model::{ConverterPower, PowerModel};
use super::slower;
use gwatt_machine::AxisSet;
use gwatt_motion::Move;
use gwatt_plan::{Phase, PhaseKind, Plan, Profile, Trajectory};

/// What more may be fed back between two rungs of a ladder of speeds, as a share of what
/// would be without copper loss.
const BETWEEN: f64 = 0.006;

impl PowerModel {
    /// The demand of axes that run alone on their converter. Slower they pass the same
    /// states, up to lower speeds, and cruise there; limited in jerk they brake more
    /// gently, which costs less copper and may feed more back.
    pub(super) fn alone_at_any(
        &self,
        mv: &Move,
        profiles: &[(usize, Profile)],
        at: &impl Fn(f64) -> Plan,
        want: Want,
    ) -> Demand {
        let mut demand = Demand::NONE;
        for (index, converter) in self.converters.iter().enumerate() {
            let active = AxisSet(mv.moving.0 & converter.axes.0);
            let mut axes = profiles.iter().filter(|(axis, _)| active.contains(*axis));
            let (Some(own), None) = (axes.next(), axes.next()) else {
                continue;
            };
            if converter.curved.0 & active.0 == 0 {
                continue;
            }
            let mut totals = Totals::new(converter.idle_w(mv, &self.axes, active));
            self.cruise_alone(converter, mv, own, &mut totals);
            if own.1.phases.iter().any(jerks) && self.has_copper(mv) {
                totals.raise_regen(self.gentler_w(converter, mv, own, at, want));
            }
            demand.add(index, converter, totals);
        }
        demand
    }

    /// What an axis with limited jerk that is alone on its converter feeds back at most
    /// at any speed: as at the speeds of a ladder, and between two of its rungs.
    fn gentler_w(
        &self,
        converter: &ConverterPower,
        mv: &Move,
        own: &(usize, Profile),
        at: &impl Fn(f64) -> Plan,
        want: Want,
    ) -> f64 {
        let idle_w = converter.idle_w(mv, &self.axes, AxisSet(mv.moving.0 & converter.axes.0));
        let of = |model: &Self, one: &(usize, Profile)| {
            let one = std::slice::from_ref(one);
            independent::totals(model, converter, mv, one, idle_w, Want::PEAKS).regen_w
        };
        // Without copper loss nothing is fed back beyond the largest speed.
        let most_w = of(&self.lossless(), own);
        let own_w = of(self, own);
        if most_w <= larger(own_w * (1.0 + CLOSE), want.regen_floor_w) {
            return own_w;
        }
        let (mut worst_w, mut knob) = (own_w, 1.0);
        let mut top_mm_s = own.1.top_speed_mm_s();
        while knob > slower::LEAST {
            knob *= slower::RUNG_RATIO;
            let Trajectory::Axes(slower) = at(knob).trajectory else {
                break;
            };
            let same = slower.iter().find(|one| one.0 == own.0);
            let Some(one) = same.filter(|one| one.1.top_speed_mm_s() < top_mm_s) else {
                continue;
            };
            top_mm_s = one.1.top_speed_mm_s();
            worst_w = larger(worst_w, of(self, one));
        }
        let between_w = worst_w + BETWEEN * most_w;
        if between_w <= own_w {
            own_w
        } else {
            between_w.min(most_w)
        }
    }

    /// All speeds up to the largest of an axis that runs for itself.
    fn cruise_alone(
        &self,
        converter: &ConverterPower,
        mv: &Move,
        (axis, profile): &(usize, Profile),
        totals: &mut Totals,
    ) {
        let power = &self.axes[*axis];
        let unit = power.si_per_unit.copysign(mv.end[*axis] - mv.start[*axis]);
        let ramp = Ramp {
            axis: power,
            start: 0.0,
            end: unit * profile.top_speed_mm_s(),
            accel: 0.0,
        };
        let cruise = Interval {
            credit_regen: converter.credit_regen,
            curved: true,
            idle_w: totals.idle_w,
            ramps: &[ramp],
            duration_s: 0.0,
        };
        cruise.evaluate(Want::PEAKS, totals);
    }
}

/// Whether a phase has a limit of jerk.
fn jerks(phase: &Phase) -> bool {
    matches!(phase.kind, PhaseKind::ConstantJerk { .. })
}
