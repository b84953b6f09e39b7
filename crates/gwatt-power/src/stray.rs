//! What a path draws that lies near the planned one: spirals that end on another circle than
//! they start on.
//!
//! With unit vectors of direction that are at most d apart, and accelerations that are at
//! most α larger, the speed of an axis differs by up to d·v, and its acceleration by up to
//! (2d + α)·â. So its power differs by no more than `(3d + α)·v·(m·â·k + b·v + Fc + |Fg|)/η`,
//! and where the axis turns round elsewhere, its force by up to 2·Fc more: what is lost in
//! copper differs by no more than `R·(2·F̂ + ΔF)·ΔF`, `ΔF = (2d + α)·F̂ + 2·Fc`.

use super::axis::Side;
use super::demand::Demand;
use super::model::{ConverterPower, PowerModel};
use gwatt_machine::AxisValues;
use gwatt_motion::{Move, Stray};

impl PowerModel {
    /// A demand with what the controller's own path may add to it, at speeds up to
    /// `top_speed_mm_s` along the path.
    #[cold]
    pub(super) fn with_stray(&self, demand: Demand, mv: &Move, top_speed_mm_s: f64) -> Demand {
        let mut strayed = demand;
        for (index, converter) in self.converters.iter().enumerate() {
            let moves = |axis| mv.moving.contains(axis);
            let more_w = self.stray_w(converter, mv.stray, &mv.accel_mm_s2, top_speed_mm_s, moves);
            strayed.load_ratio = strayed
                .load_ratio
                .max(demand.load_ratio + more_w / self.least_limit_w(index));
            if index == demand.converter {
                strayed.peak_w += more_w;
                strayed.regen_w += more_w;
            }
            strayed.spindle_converter_w = strayed.spindle_converter_w.map(|peak_w| peak_w + more_w);
        }
        strayed
    }

    /// What a converter may give or take more over the axes that move, W.
    fn stray_w(
        &self,
        converter: &ConverterPower,
        stray: Stray,
        accel_mm_s2: &AxisValues,
        top_speed_mm_s: f64,
        moves: impl Fn(usize) -> bool,
    ) -> f64 {
        let (d, alpha) = (stray.direction, stray.accel);
        let force_share = 2.0 * d + alpha;
        let mut more_w = 0.0;
        for axis in converter.axes.iter().filter(|axis| moves(*axis)) {
            let power = &self.axes[axis];
            let v = top_speed_mm_s * power.si_per_unit;
            let accel = accel_mm_s2[axis] * (1.0 + alpha) * power.si_per_unit;
            let factors = [
                power.accel_factor(Side::Motor, true),
                power.accel_factor(Side::Regen, false),
            ];
            let force = power.mass * accel * factors[0].max(factors[1])
                + power.viscous_most() * v
                + power.coulomb_most()
                + power.gravity.abs();
            more_w += (d + force_share) * v * force * power.inverse_efficiency;
            let change = force_share * force + 2.0 * power.coulomb_most();
            more_w += power.copper * (2.0 * force + change) * change;
        }
        more_w
    }

    /// The lower of a converter's limits, drawn or fed back, W.
    fn least_limit_w(&self, converter: usize) -> f64 {
        let regen_w = self.regen_limit_w(converter).unwrap_or(f64::INFINITY);
        self.limit_w(converter).min(regen_w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gwatt_machine::{AXES, Machine};

    const AXIS: &str = "schema = 1\nname = \"t\"\ncontroller = \"linuxcnc\"\n[converter]\n\
                        peak_power_w = 1e6\n[axes.X]\nrapid_mm_min = 60000\naccel_mm_s2 = 2000\n\
                        mass_kg = 300\ncoulomb_n = 200\nviscous_n_s_m = 300\ngravity_n = 80\n\
                        efficiency = 0.8\ncopper_w_n2 = 1e-4\n";

    /// Directions and accelerations that differ by as much as is said: no axis draws or
    /// feeds back more beyond the other path than is added.
    #[test]
    fn what_is_added_covers_the_difference() {
        let (machine, _) = Machine::from_toml("t.toml", AXIS).unwrap();
        let model = PowerModel::new(&machine);
        let power = &model.axes[0];
        let at = |speed_mm_s: f64, a: f64| {
            let v = speed_mm_s * 1e-3;
            let sign = if v == 0.0 { 0.0 } else { v.signum() };
            power.electrical(v, power.force(Side::Motor, v, a, sign))
        };
        for (direction, accel) in [(0.01, 0.02), (0.05, 0.0), (0.1, 0.2)] {
            let stray = Stray {
                direction,
                accel,
                in_chords: false,
            };
            for top_mm_s in [1.0, 100.0, 900.0] {
                let limits = [2000.0; AXES];
                let added = model.stray_w(&model.converters[0], stray, &limits, top_mm_s, |axis| {
                    axis == 0
                });
                for case in 0..84 {
                    let u = f64::from(case / 4) / 10.0 - 1.0;
                    let more = if case % 2 == 0 { direction } else { -direction };
                    let a = if case % 4 < 2 { 2.0 } else { -2.0 };
                    let own = at(u * top_mm_s, a);
                    let changed = a * (1.0 + 2.0 * direction + accel);
                    let other = at((u + more).clamp(-1.0, 1.0) * top_mm_s, changed);
                    assert!((other - own).abs() <= added, "{own} {other} {added}");
                }
            }
        }
    }
}
