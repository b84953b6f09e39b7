//! A quick upper bound of a path's power, to pass over moves that cannot
//! matter where only the largest peak is wanted.
//!
//! With `u` the unit tangent of X Y Z, `Σ m_n·u_n² ≤ max m` and `|u_n| ≤ 1`, so
//!
//! ```text
//! P ≤ P₀ + B/η_min + Σ R·F²,   B = v·(max m·k·a + Σ(Fc + |Fg|) + v·Σ b)
//! ```
//!
//! and no more than B is fed back. On an arc `a` takes the centripetal
//! acceleration in, since `Σ m·τ·ν ≤ max m` too.

use super::axis::{AxisPower, Side};
use crate::interpret::Move;
use crate::machine::AxisSet;

/// X, Y and Z: the axes whose directions make a unit vector.
const XYZ: u16 = 0b111;

/// The coefficients of the bound for one converter.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ceiling {
    si_per_unit: f64,
    mass: f64,
    friction: f64,
    viscous: f64,
    copper: f64,
    inverse_efficiency: f64,
}

impl Ceiling {
    /// The bound for the axes of `set` among X, Y and Z.
    pub fn new(axes: &[AxisPower], set: AxisSet) -> Self {
        let mut ceiling = Self {
            inverse_efficiency: 1.0,
            ..Self::default()
        };
        for axis in AxisSet(set.0 & XYZ).iter() {
            let power = &axes[axis];
            let factor = power
                .accel_factor(Side::Motor, true)
                .max(power.accel_factor(Side::Regen, false));
            ceiling.si_per_unit = ceiling.si_per_unit.max(power.si_per_unit);
            ceiling.mass = ceiling.mass.max(power.mass * factor);
            ceiling.friction += power.coulomb + power.gravity.abs();
            ceiling.viscous += power.viscous;
            ceiling.copper += power.copper;
            ceiling.inverse_efficiency = ceiling.inverse_efficiency.max(power.inverse_efficiency);
        }
        ceiling
    }

    /// The bound of what a move from a known start draws and feeds back, W, at a
    /// speed and an acceleration (mm/s, mm/s²) of at most these; nothing where
    /// other axes move too.
    #[inline]
    pub fn of(&self, mv: &Move, v: f64, a: f64, idle_w: f64) -> Option<[f64; 2]> {
        if mv.moving.0 & !XYZ != 0 {
            return None;
        }
        let v = v * self.si_per_unit;
        let mut a = a * self.si_per_unit;
        if let Some(arc) = &mv.arc {
            a += v * v / (arc.radius_mm * self.si_per_unit);
        }
        let force = self.mass * a + self.friction + self.viscous * v;
        let mechanical = v * force;
        // F² of each axis is at most that of all, whose sum is bounded too.
        let drawn_w = idle_w + mechanical * self.inverse_efficiency + self.copper * force * force;
        Some([drawn_w, mechanical])
    }
}
