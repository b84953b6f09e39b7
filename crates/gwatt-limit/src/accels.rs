//! The largest accelerations with which ramps of a way fit, by the speed at their top.

use super::accel_grid::{Accels, GRID};
use super::road::{HALVINGS, Road};
use gwatt_plan::{Phase, PhaseKind, Profile};

impl Road<'_> {
    /// The load of a ramp between two speeds.
    pub(super) fn ramp_load(&self, from_mm_s: f64, to_mm_s: f64, accel_mm_s2: f64) -> f64 {
        let mut profile = Profile::default();
        profile.phases.push(Phase {
            kind: PhaseKind::ConstantAcceleration,
            duration_s: (to_mm_s - from_mm_s).abs() / accel_mm_s2,
            position_mm: 0.0,
            velocity_mm_s: from_mm_s,
            end_velocity_mm_s: to_mm_s,
            accel_mm_s2: accel_mm_s2.copysign(to_mm_s - from_mm_s),
        });
        self.load(profile)
    }

    /// The largest acceleration with which a ramp between rest and a speed fits; `None`
    /// where hardly any does.
    pub(super) fn largest_mm_s2(&self, top_mm_s: f64, brakes: bool) -> Option<f64> {
        let [from_mm_s, to_mm_s] = if brakes {
            [top_mm_s, 0.0]
        } else {
            [0.0, top_mm_s]
        };
        let load = |accel: f64| self.ramp_load(from_mm_s, to_mm_s, accel);
        if load(self.accel_mm_s2) <= self.aim {
            return Some(self.accel_mm_s2);
        }
        let (mut low, mut high) = (1e-4 * self.accel_mm_s2, self.accel_mm_s2);
        let least = load(low);
        if least > self.aim || least.is_nan() {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if load(middle) <= self.aim {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(low)
    }

    /// The largest accelerations at all speeds up to the top.
    pub(super) fn accels(&self) -> Accels {
        let mut accels = Accels {
            tables: [Vec::with_capacity(GRID), Vec::with_capacity(GRID)],
            top_mm_s: self.top_mm_s,
        };
        for (table, brakes) in accels.tables.iter_mut().zip([false, true]) {
            for index in 1..=GRID {
                let speed_mm_s = self.top_mm_s * index as f64 / GRID as f64;
                match self.largest_mm_s2(speed_mm_s, brakes) {
                    Some(accel) => table.push(accel),
                    None => break,
                }
            }
        }
        accels
    }
}
