//! The energy of a step of speed: what its axes' kinetic energy grows by comes from
//! the converters, and what it falls by goes back.

use crate::axis::AxisPower;
use crate::model::PowerModel;
use gwatt_machine::{AXES, AxisSet, AxisValues};

/// Speeds of the axes, mm/s, at a speed along the path.
pub(crate) fn velocity(direction: &AxisValues, speed_mm_s: f64) -> AxisValues {
    direction.map(|share| share * speed_mm_s)
}

/// A step of speed of all axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepEnergy {
    /// Before and after, mm/s.
    pub speeds_mm_s: [AxisValues; 2],
    /// Over how long the drives spread it, s.
    pub response_s: f64,
}

impl StepEnergy {
    /// What the axes of a set draw, and what they feed back, J.
    pub fn of(&self, model: &PowerModel, axes: AxisSet) -> [f64; 2] {
        let [before, after] = &self.speeds_mm_s;
        let mut sums = [0.0; 2];
        for axis in axes.iter().filter(|axis| *axis < AXES) {
            let (p, q) = (before[axis], after[axis]);
            if p == q {
                continue;
            }
            let power = &model.axes[axis];
            let [drawn_j, fed_back_j] =
                self.of_axis(power, p * power.si_per_unit, q * power.si_per_unit);
            sums[0] += drawn_j;
            sums[1] += fed_back_j;
        }
        sums
    }

    fn of_axis(&self, power: &AxisPower, p: f64, q: f64) -> [f64; 2] {
        let squares = if p * q < 0.0 {
            // It comes to rest between.
            [q * q, p * p]
        } else {
            [(q * q - p * p).max(0.0), (p * p - q * q).max(0.0)]
        };
        let force = power.mass * (q - p) / self.response_s;
        let copper_j = power.copper * force * force * self.response_s;
        let [grows, falls] = squares.map(|square| 0.5 * power.mass * square);
        [
            grows * power.inverse_efficiency + copper_j,
            falls * power.efficiency,
        ]
    }

    /// The energy that all converters supply for it, J: what is fed back counts where
    /// it is credited.
    pub fn supplied_j(&self, model: &PowerModel) -> f64 {
        let each = model.converters.iter().map(|converter| {
            let [drawn_j, fed_back_j] = self.of(model, converter.axes);
            if converter.credit_regen {
                drawn_j - fed_back_j
            } else {
                drawn_j
            }
        });
        each.sum()
    }
}
