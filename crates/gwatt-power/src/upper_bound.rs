//! A quick upper bound of a path's power, to pass over moves that cannot
//! matter where only the largest peak is wanted.
//!
//! With `u` the unit tangent of X Y Z, `Σ m_n·u_n² ≤ max m` and `|u_n| ≤ 1`, so
//!
//! ```text
//! drawn     P ≤ P₀ + v·(max m·k·a + Σ(Fc + |Fg|) + v·Σ b)/η_min + Σ R·F²
//! fed back  P ≤ v·(max m·k·a + Σ(|Fg| − k·Fc)⁺)
//! ```
//!
//! since friction takes from what an axis feeds back. On an arc `a` takes the
//! centripetal acceleration in: `Σ m·τ·ν ≤ max m` too. Other axes, whose share of
//! the path is the same all along, come on top one by one.

use super::axis::{AxisPower, Side};
use super::axis_bound::axis_bound_w;
use gwatt_machine::AxisSet;
use gwatt_motion::Move;

/// X, Y and Z: the axes whose directions make a unit vector.
const XYZ: u16 = 0b111;

/// The coefficients of the bound for one converter.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct UpperBound {
    /// The converter's axes.
    axes: AxisSet,
    si_per_unit: f64,
    mass: f64,
    friction: f64,
    /// Gravity that friction does not hold.
    excess: f64,
    viscous: f64,
    copper: f64,
    inverse_efficiency: f64,
}

impl UpperBound {
    /// The bound for the axes of `set`.
    pub fn new(axes: &[AxisPower], set: AxisSet) -> Self {
        let mut ceiling = Self {
            axes: set,
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
            let gravity = power.gravity.abs();
            ceiling.friction += power.coulomb_most() + gravity;
            let held = power.coulomb * power.friction_factor(Side::Regen);
            ceiling.excess += (gravity - held).max(0.0);
            ceiling.viscous += power.viscous_most();
            ceiling.copper += power.copper;
            ceiling.inverse_efficiency = ceiling.inverse_efficiency.max(power.inverse_efficiency);
        }
        ceiling
    }

    /// The bound of what a move from a known start draws and feeds back, W, at a
    /// speed and an acceleration (mm/s, mm/s²) of at most these.
    #[inline]
    pub fn of(&self, axes: &[AxisPower], mv: &Move, [v, a]: [f64; 2], idle_w: f64) -> [f64; 2] {
        let v_si = v * self.si_per_unit;
        let mut a_si = a * self.si_per_unit;
        if let Some(arc) = &mv.arc {
            a_si += v_si * v_si / (arc.radius_mm * self.si_per_unit);
        }
        let inertia = self.mass * a_si;
        let force = inertia + self.friction + self.viscous * v_si;
        // F² of each axis is at most that of all, whose sum is bounded too.
        let mut drawn_w =
            idle_w + v_si * force * self.inverse_efficiency + self.copper * force * force;
        let mut fed_back_w = v_si * (inertia + self.excess);
        for axis in AxisSet(mv.moving.0 & self.axes.0 & !XYZ).iter() {
            let [drawn, fed_back] = axis_bound_w(&axes[axis], axis, mv, [v, a]);
            drawn_w += drawn;
            fed_back_w += fed_back;
        }
        [drawn_w, fed_back_w]
    }
}
