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
use gwatt_machine::{AXES, AxisSet, AxisValues};
use gwatt_motion::Move;
use gwatt_plan::SpeedBound;

/// Largest speeds and accelerations of one move of a window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part<'a> {
    pub bound: &'a SpeedBound,
    pub accel_mm_s2: &'a AxisValues,
}

/// The same of several moves.
#[derive(Debug)]
pub(super) struct Extremes {
    pub bound: SpeedBound,
    pub accel_mm_s2: AxisValues,
}

impl Extremes {
    pub fn of(parts: &[Part<'_>]) -> Self {
        let (mut bound, mut accel_mm_s2) = (SpeedBound::default(), [0.0_f64; AXES]);
        for part in parts {
            bound.include(part.bound);
            for (largest, own) in accel_mm_s2.iter_mut().zip(part.accel_mm_s2) {
                *largest = largest.max(*own);
            }
        }
        Self { bound, accel_mm_s2 }
    }

    pub fn part(&self) -> Part<'_> {
        Part {
            bound: &self.bound,
            accel_mm_s2: &self.accel_mm_s2,
        }
    }
}

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

    /// The robust bound over a move (of which only the switched loads are read)
    /// and its neighbours; where something above it stays below what is of
    /// interest, that. Instead of a neighbour that is missing any other part
    /// may be given again.
    pub(super) fn robust_over(&self, mv: &Move, parts: &[Part<'_>; 3], want: Want) -> Demand {
        if let [converter] = self.converters.as_slice()
            && let Some(demand) = self.robust_below_floor(converter, mv, parts, want)
        {
            return demand;
        }
        let Extremes { bound, accel_mm_s2 } = Extremes::of(parts);
        self.robust(mv, &bound, &accel_mm_s2)
    }

    /// A quick bound above the robust one, if it stays below what is of
    /// interest: drawn is at most `P₀ + Σ [v·F/η + R·F²]`,
    /// `F = m·â·k + b·v + Fc + |Fg|`, with the larger speed of each axis, and
    /// fed back at most `Σ v·(m·â·k − Fc·w + |Fg|)⁺`.
    #[inline]
    fn robust_below_floor(
        &self,
        converter: &ConverterPower,
        mv: &Move,
        parts: &[Part<'_>; 3],
        want: Want,
    ) -> Option<Demand> {
        // Axes at rest hold their weight: counted for all.
        let mut drawn_w = converter.idle_w(mv, &self.axes, AxisSet::default());
        let mut fed_back_w = 0.0;
        for axis in converter.axes.iter() {
            let power = &self.axes[axis];
            let speeds =
                parts.map(|part| larger(part.bound.positive[axis], part.bound.negative[axis]));
            let accels = parts.map(|part| part.accel_mm_s2[axis] * (1.0 + part.bound.excess));
            let [v, accel] =
                [speeds, accels].map(|[a, b, c]| larger(larger(a, b), c) * power.si_per_unit);
            if v == 0.0 {
                continue;
            }
            let inertia = power.mass * accel;
            let weight = power.gravity.abs();
            let force = inertia * power.accel_factor(Side::Motor, true)
                + power.viscous_most() * v
                + power.coulomb_most()
                + weight;
            let braking = inertia * power.accel_factor(Side::Regen, false) + weight
                - power.coulomb * power.friction_factor(Side::Regen);
            let largest = larger(force, braking);
            drawn_w += v * force * power.inverse_efficiency + power.copper * largest * largest;
            fed_back_w += v * larger(braking, 0.0);
        }
        Demand::below_floor(drawn_w, fed_back_w, want)
    }

    /// The robust bound of one converter over a move and its neighbours: drawn
    /// and fed back, W.
    pub(super) fn robust_powers(
        &self,
        converter: usize,
        mv: &Move,
        parts: &[Part<'_>],
    ) -> [f64; 2] {
        let Some(converter) = self.converters.get(converter) else {
            return [f64::INFINITY; 2];
        };
        let Extremes { bound, accel_mm_s2 } = Extremes::of(parts);
        let totals = self.robust_totals(converter, mv, &bound, &accel_mm_s2);
        [totals.peak_w, totals.regen_w]
    }

    /// What one converter draws and takes back with all axes at rest, W.
    pub(super) fn resting_w(&self, converter: usize, mv: &Move) -> [f64; 2] {
        let converter = self.converters.get(converter);
        let idle_w = converter.map_or(f64::INFINITY, |converter| {
            converter.idle_w(mv, &self.axes, AxisSet::default())
        });
        [idle_w, 0.0]
    }

    /// The robust bound for one converter.
    pub(super) fn robust_totals(
        &self,
        converter: &ConverterPower,
        mv: &Move,
        bound: &SpeedBound,
        accel_mm_s2: &AxisValues,
    ) -> Totals {
        let mut active = AxisSet::default();
        for axis in converter.axes.iter() {
            if bound.positive[axis] > 0.0 || bound.negative[axis] > 0.0 {
                active.insert(axis);
            }
        }
        let idle_w = converter.idle_w(mv, &self.axes, active);
        let (mut peak, mut regen) = (idle_w, 0.0);
        for axis in active.iter() {
            let power = &self.axes[axis];
            let unit = power.si_per_unit;
            let accel = accel_mm_s2[axis] * (1.0 + bound.excess) * unit;
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

/// The larger of two numbers, in one instruction: `f64::max` also looks for
/// what is no number.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Largest electrical power of an axis at speeds up to `v` in a direction in
/// which `gravity` has to be overcome.
fn motoring(axis: &AxisPower, v: f64, accel: f64, gravity: f64) -> f64 {
    let driven = axis.mass * accel * axis.accel_factor(Side::Motor, true)
        + axis.viscous_most() * v
        + axis.coulomb_most();
    // Weight that helps still costs copper when it has to be braked.
    let held = axis.coulomb * axis.friction_factor(Side::Regen);
    let braked = axis.mass * accel * axis.accel_factor(Side::Regen, false) - held;
    let largest_force = larger(driven, braked) + gravity.abs();
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
