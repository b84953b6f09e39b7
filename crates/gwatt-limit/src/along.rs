//! Knobs along the path, and those for the largest speed.

use super::case::Case;
use super::change::{Change, round_to_step};
use super::solver::{RETRIES, Solver};
use gwatt_machine::{AXES, AxisSet, AxisValues, KnobArgument};
use gwatt_motion::{Move, own_path_speed};

impl Solver<'_> {
    /// The values of a knob for the largest speed, rounded down, for a path speed at the
    /// largest override.
    pub(super) fn cap(
        &self,
        case: Case<'_>,
        trial: &Change,
        knob: usize,
        speed_mm_s: f64,
    ) -> Option<(usize, AxisValues)> {
        let mut speed_mm_s = speed_mm_s / self.largest.feed;
        for _ in 0..RETRIES {
            let values = self.cap_values(case, knob, speed_mm_s)?;
            let rounded = Change {
                speed: Some((knob, values)),
                ..*trial
            }
            .apply(self.machine, case.mv, case.permit);
            if self.load(case, &rounded) <= 1.0 {
                return Some((knob, values));
            }
            speed_mm_s *= 1.0 - 1e-4;
        }
        None
    }

    /// The values of a knob that leave a path speed; `None` where it does not go that low.
    pub(super) fn cap_values(
        &self,
        case: Case<'_>,
        knob: usize,
        speed_mm_s: f64,
    ) -> Option<AxisValues> {
        let data = self.machine.controller.knobs.get(knob)?;
        let Case { mv, permit, .. } = case;
        let down = |value: f64| {
            let value = round_to_step(value * (1.0 + 1e-12), data.step);
            (value >= data.min && value > 0.0).then_some(value)
        };
        if data.argument == KnobArgument::Value {
            // Along a diagonal axes may be bounded to more than the path's own limit, above
            // which the word would raise theirs.
            let own_mm_s = own_path_speed(self.machine).unwrap_or(speed_mm_s);
            return Some([down(speed_mm_s.min(own_mm_s))?; AXES]);
        }
        let mut values = [0.0; AXES];
        let mut limits = false;
        for axis in self.machine.axis_set.iter() {
            let Some(own) = &self.machine.axes[axis] else {
                continue;
            };
            let share = if mv.unknown_start.is_empty() {
                (mv.end[axis] - mv.start[axis]).abs() / mv.length_mm
            } else {
                f64::from(u8::from(
                    mv.moving.contains(axis) || mv.unknown_start.contains(axis),
                ))
            };
            let most_mm_s = own.rapid_mm_s.min(permit.speed_mm_s[axis]);
            let unit = |speed| data.unit.speed_value(own, speed, permit.knob_mm_per_unit);
            let capped = down(unit((speed_mm_s * share).min(most_mm_s))).filter(|_| share > 0.0);
            if capped.is_none() && share > 0.0 && !mv.unknown_start.is_empty() {
                return None;
            }
            limits |= capped.is_some();
            // An axis that hardly moves is held by the others.
            values[axis] = capped.unwrap_or(unit(most_mm_s));
        }
        limits.then_some(values)
    }

    /// The speed that no axis of a move exceeds, mm/s, at the largest override.
    pub(super) fn fastest_axis(&self, mv: &Move) -> f64 {
        let axes = AxisSet(mv.moving.0 | mv.unknown_start.0);
        let speeds = axes
            .iter()
            .filter_map(|axis| Some(self.machine.axes[axis].as_ref()?.rapid_mm_s));
        let own_mm_s = speeds.fold(0.0, f64::max) * mv.rapid_factor.max(1.0);
        own_mm_s.min(mv.feed_mm_s) * self.largest.feed
    }

    /// The slowest speed at which a rapid from an unknown place may run along its path: that
    /// of its slowest axis, at the largest override of a feed, mm/s.
    pub(super) fn slowest_axis(&self, mv: &Move) -> f64 {
        let axes = AxisSet(mv.moving.0 | mv.unknown_start.0);
        let speeds = axes
            .iter()
            .filter_map(|axis| Some(self.machine.axes[axis].as_ref()?.rapid_mm_s));
        speeds.fold(f64::INFINITY, f64::min) * mv.rapid_factor * self.largest.feed
    }

    /// The acceleration along the path of a move that a knob governs, mm/s²; `None` where
    /// it governs that of the axes.
    pub(super) fn along_path(&self, knob: usize, mv: &Move) -> Option<f64> {
        let knob = self.machine.controller.knobs.get(knob)?;
        (knob.argument == KnobArgument::Value)
            .then(|| straight_accel_mm_s2(mv).min(mv.path_accel_mm_s2))
    }

    /// The value of a knob that governs the acceleration along the path, rounded down.
    pub(super) fn path_values(&self, knob: usize, accel_mm_s2: f64) -> Option<AxisValues> {
        let data = self.machine.controller.knobs.get(knob)?;
        let value = round_to_step(accel_mm_s2 * (1.0 + 1e-12), data.step);
        (value >= data.min && value > 0.0).then_some([value; AXES])
    }

    /// The share of the acceleration in force that a change leaves.
    pub(super) fn accel_share(&self, case: Case<'_>, knob: usize, change: &Change) -> Option<f64> {
        let changed = change.apply(self.machine, case.mv, case.permit);
        if let Some(accel) = self.along_path(knob, case.mv) {
            return Some(changed.path_accel_mm_s2 / accel);
        }
        let axis = case.mv.moving.iter().next()?;
        Some(changed.accel_mm_s2[axis] / case.mv.accel_mm_s2[axis])
    }
}

/// The acceleration along a straight path that the axes permit, mm/s²; infinite where
/// there is none.
pub(super) fn straight_accel_mm_s2(mv: &Move) -> f64 {
    if mv.arc.is_some() || !mv.unknown_start.is_empty() {
        return f64::INFINITY;
    }
    let along = mv.moving.iter().map(|axis| {
        let way_mm = (mv.end[axis] - mv.start[axis]).abs();
        mv.accel_mm_s2[axis] * mv.length_mm / way_mm
    });
    along.fold(f64::INFINITY, f64::min)
}
