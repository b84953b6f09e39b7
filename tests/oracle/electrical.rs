//! Electrical power of an axis, and what converters see.
//!
//! `F = m·a + b·v + Fc·sign(v) + Fg`, `p = v·F`; the bus sees `p/η` where it is
//! driven, `p·η` where it is fed back, and `R·F²` besides. The real acceleration
//! lies between the command and the command times `servo_factor_motor` while
//! speed grows, `servo_factor_regen` while it falls; friction between the cold
//! machine's and `friction_min_ratio` of it.

use super::plant::{Axis, LETTERS, Plant};

/// An axis at an instant: speed and acceleration in its units, and the sign of
/// the motion, 0 where it stands.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AxisState {
    pub v: f64,
    pub a: f64,
    pub sign: f64,
}

/// What an axis draws at most, feeds back at most, and draws as commanded, W.
#[derive(Debug, Clone, Copy, Default)]
#[allow(clippy::struct_field_names, reason = "suffixes are units")]
pub struct AxisPower {
    pub drawn_w: f64,
    pub fed_w: f64,
    pub nominal_w: f64,
}

impl Axis {
    /// Force with factors of acceleration and friction.
    pub fn force(&self, state: AxisState, [accel, friction]: [f64; 2]) -> f64 {
        let (v, a) = (state.v * self.unit, state.a * self.unit);
        let drag = self.viscous * v + self.coulomb * state.sign;
        self.mass * a * accel + drag * friction + self.gravity
    }

    /// Electrical power at a force.
    pub fn electrical_w(&self, v: f64, force: f64) -> f64 {
        let p = v * self.unit * force;
        let converted = if p > 0.0 {
            p / self.efficiency
        } else {
            p * self.efficiency
        };
        converted + self.copper * force * force
    }

    /// The powers of a state.
    pub fn power(&self, state: AxisState) -> AxisPower {
        let growing = state.a * state.sign > 0.0;
        let [motor, regen] = self.factors;
        let real = if growing { motor } else { regen };
        let w = |corner| self.electrical_w(state.v, self.force(state, corner));
        let all = [[1.0, 1.0], [real, 1.0], [1.0, self.warm], [real, self.warm]];
        let most = |sign: f64| {
            let powers = all.iter().map(|corner| sign * w(*corner));
            powers.fold(f64::NEG_INFINITY, f64::max)
        };
        AxisPower {
            drawn_w: most(1.0),
            fed_w: most(-1.0),
            nominal_w: w([1.0, 1.0]),
        }
    }
}

/// What the spindle draws next to the axes: as `AxisPower`; base load in `idle_w`.
#[derive(Debug, Clone, Copy, Default)]
pub struct SpindleLoad {
    pub power_w: f64,
    pub idle_w: f64,
}

/// Of one converter: largest power drawn and fed back, and both as commanded.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_field_names, reason = "suffixes are units")]
pub struct Bus {
    pub drawn_w: f64,
    pub fed_w: f64,
    pub nominal_w: f64,
    pub nominal_fed_w: f64,
}

impl Plant {
    /// What a converter sees: `Σ max(0, P)` and `Σ max(0, −P)`, or the plain sum
    /// where it credits what is fed back. `loads` has a bit for each load that is
    /// on; axes without a state stand and hold their weight.
    pub fn bus(&self, which: usize, states: &[AxisState], loads: u32, load: SpindleLoad) -> Bus {
        let converter = &self.converters[which];
        let mut idle_w = converter.base_w + load.idle_w;
        for (bit, (power_w, fed_by)) in self.loads.iter().enumerate() {
            if loads & (1 << bit) != 0 && *fed_by == which {
                idle_w += power_w;
            }
        }
        let own = |axis: &&Axis| converter.axes.contains(&axis.index);
        let mut list = [AxisPower::default(); LETTERS.len() + 1];
        list[0] = AxisPower {
            drawn_w: load.power_w,
            fed_w: -load.power_w,
            nominal_w: load.power_w,
        };
        let mut count = 1;
        for axis in self.axes.iter().filter(own) {
            list[count] = axis.power(states[axis.index]);
            count += 1;
        }
        let powers = &list[..count];
        let sum = |of: &dyn Fn(&AxisPower) -> f64| powers.iter().map(of).sum::<f64>();
        if converter.credit {
            let nominal_w = idle_w + sum(&|it| it.nominal_w);
            return Bus {
                drawn_w: idle_w + sum(&|it| it.drawn_w),
                fed_w: (sum(&|it| it.fed_w) - idle_w).max(0.0),
                nominal_w,
                nominal_fed_w: (-nominal_w).max(0.0),
            };
        }
        Bus {
            drawn_w: idle_w + sum(&|it| it.drawn_w.max(0.0)),
            fed_w: sum(&|it| it.fed_w.max(0.0)),
            nominal_w: idle_w + sum(&|it| it.nominal_w.max(0.0)),
            nominal_fed_w: sum(&|it| (-it.nominal_w).max(0.0)),
        }
    }
}
