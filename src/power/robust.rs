//! The robust bound: a demand that no blending can exceed.
//!
//! Input: the largest speeds ([`SpeedBound`]) and accelerations of the axes in
//! a block and its neighbours. Output: a [`Demand`] that holds for any
//! look-ahead, corner blending and filtering that keeps each axis within them:
//!
//! ```text
//! P₀ + Σ [ v̂·(m·â·k + b·v̂ + Fc + Fg⁺)/η + R·F̂² ]
//! ```
//!
//! for each axis in its worse direction, k its servo factor. Fed back, with
//! the least friction and no losses but efficiency, and without credit for
//! what other axes draw: `η·max v·(m·â·k − (Fc + b·v)·w + Fg⁻)` over all
//! speeds up to v̂, w the ratio of warm friction.

use super::axis::{AxisPower, Side};
use super::demand::{Demand, Totals, Want};
use super::model::{ConverterPower, PowerModel};
use crate::interpret::Move;
use crate::machine::{AxisSet, AxisValues};
use crate::plan::SpeedBound;

impl PowerModel {
    /// The robust bound of a move (of which only the switched loads are read):
    /// `bound` and `accel_mm_s2` are the largest over the block and both its
    /// neighbours. The energy is 0.
    #[must_use]
    pub fn robust(&self, mv: &Move, bound: &SpeedBound, accel_mm_s2: &AxisValues) -> Demand {
        let mut demand = Demand::NONE;
        for (index, converter) in self.converters.iter().enumerate() {
            let totals = self.robust_totals(converter, mv, bound, accel_mm_s2);
            demand.add(index, converter, totals);
        }
        demand
    }

    /// The robust bound; where something above it stays below what is of
    /// interest, that.
    ///
    /// Above it is `Σ [v·(m·â·k + b·v + Fc + |Fg|)/η + R·F²]` with the larger
    /// speed of each axis; fed back is no more than `Σ v·(m·â·k − Fc·w + |Fg|)⁺`.
    pub(super) fn robust_for(
        &self,
        mv: &Move,
        bound: &SpeedBound,
        accel_mm_s2: &AxisValues,
        want: Want,
    ) -> Demand {
        let below = |converter: &ConverterPower| {
            let active = active(converter, bound);
            let mut drawn_w = converter.idle_w(mv, &self.axes, active);
            let mut fed_back_w = 0.0;
            for axis in active.iter() {
                let power = &self.axes[axis];
                let v = bound.positive[axis].max(bound.negative[axis]) * power.si_per_unit;
                let inertia = power.mass * accel_mm_s2[axis] * power.si_per_unit;
                let weight = power.gravity.abs();
                let force = inertia * power.accel_factor(Side::Motor, true)
                    + power.viscous * v
                    + power.coulomb
                    + weight;
                drawn_w += v * force * power.inverse_efficiency + power.copper * force * force;
                let braking = inertia * power.accel_factor(Side::Regen, false) + weight
                    - power.coulomb * power.friction_factor(Side::Regen);
                fed_back_w += v * braking.max(0.0);
            }
            Demand::below_floor(drawn_w, fed_back_w, want)
        };
        match self.converters.as_slice() {
            [converter] => below(converter),
            _ => None,
        }
        .unwrap_or_else(|| self.robust(mv, bound, accel_mm_s2))
    }

    /// The robust bound for one converter.
    pub(super) fn robust_totals(
        &self,
        converter: &ConverterPower,
        mv: &Move,
        bound: &SpeedBound,
        accel_mm_s2: &AxisValues,
    ) -> Totals {
        let active = active(converter, bound);
        let idle_w = converter.idle_w(mv, &self.axes, active);
        let (mut peak, mut regen) = (idle_w, 0.0);
        for axis in active.iter() {
            let power = &self.axes[axis];
            let unit = power.si_per_unit;
            let accel = accel_mm_s2[axis] * unit;
            let directions = [
                (bound.positive[axis] * unit, power.gravity),
                (bound.negative[axis] * unit, -power.gravity),
            ];
            let worst = |f: fn(&AxisPower, f64, f64, f64) -> f64| {
                directions
                    .into_iter()
                    .filter(|(v, _)| *v > 0.0)
                    .map(|(v, gravity)| f(power, v, accel, gravity))
                    .fold(0.0, super::demand::larger)
            };
            peak += worst(motoring);
            regen += worst(regenerating);
        }
        let mut totals = Totals::new(idle_w);
        totals.raise_peak(peak);
        totals.raise_regen(regen);
        totals
    }
}

/// The axes of a converter that may move.
#[inline]
fn active(converter: &ConverterPower, bound: &SpeedBound) -> AxisSet {
    let mut active = AxisSet::default();
    for axis in converter.axes.iter() {
        if bound.positive[axis] > 0.0 || bound.negative[axis] > 0.0 {
            active.insert(axis);
        }
    }
    active
}

/// Largest electrical power of an axis at speeds up to `v` in a direction in
/// which `gravity` has to be overcome.
fn motoring(axis: &AxisPower, v: f64, accel: f64, gravity: f64) -> f64 {
    let driven =
        axis.mass * accel * axis.accel_factor(Side::Motor, true) + axis.viscous * v + axis.coulomb;
    // Weight that helps still costs copper when it has to be braked.
    let largest_force = driven + gravity.abs();
    v * (driven + gravity.max(0.0)) * axis.inverse_efficiency
        + axis.copper * largest_force * largest_force
}

/// Largest power fed back by an axis at speeds up to `v`.
fn regenerating(axis: &AxisPower, v: f64, accel: f64, gravity: f64) -> f64 {
    let warm = axis.friction_factor(Side::Regen);
    let constant = axis.mass * accel * axis.accel_factor(Side::Regen, false) - axis.coulomb * warm
        + (-gravity).max(0.0);
    let viscous = axis.viscous * warm;
    // v·(constant − viscous·v) peaks at half the speed at which it is 0.
    let v = v.min(0.5 * constant.max(0.0) / viscous);
    axis.efficiency * v * (constant - viscous * v).max(0.0)
}
