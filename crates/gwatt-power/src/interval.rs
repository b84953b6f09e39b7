//! Demand of an interval in which every axis has a constant acceleration.
//!
//! Input: the [`Ramp`] of each axis. Output: peaks and energy, added to the
//! [`Totals`].
//!
//! On the interval the speed of each axis is affine in time and keeps its
//! sign. Motoring power is convex in time (p is convex as b ≥ 0, conversion is
//! convex and growing as 1/η ≥ η, R·F² is convex, and so is the larger one of two),
//! so its peak is at an end. Regenerated power is not: it is a parabola for each axis
//! between the instants at which p or el changes its sign or the force its law. Between these instants, of all
//! axes together, the sum is one parabola: its vertex and Simpson's rule are
//! exact.

use super::axis::{AxisPower, Side};
use super::demand::{Totals, Want};
use arrayvec::ArrayVec;
use gwatt_machine::AXES;

/// Places at most at which the law of an axis' power changes.
const CHANGES: usize = 6;

/// An axis whose speed changes steadily, SI, signed.
pub(super) struct Ramp<'a> {
    /// Its coefficients.
    pub axis: &'a AxisPower,
    /// Speed at the start of the interval.
    pub start: f64,
    /// Speed at its end.
    pub end: f64,
    /// Acceleration.
    pub accel: f64,
}

/// The part of the force that does not depend on speed, and what does.
struct Force {
    constant: f64,
    per_speed: f64,
}

impl Ramp<'_> {
    /// The direction of motion.
    fn sign(&self) -> f64 {
        if self.start + self.end > 0.0 {
            1.0
        } else if self.start + self.end < 0.0 {
            -1.0
        } else {
            0.0
        }
    }

    /// The force `constant + per_speed·v`.
    fn force(&self, side: Side) -> Force {
        Force {
            constant: self.axis.force(side, 0.0, self.accel, self.sign()),
            per_speed: self.axis.viscous * self.axis.friction_factor(side),
        }
    }

    /// Speed at the fraction `x` of the interval.
    fn speed(&self, x: f64) -> f64 {
        self.start + (self.end - self.start) * x
    }

    /// Electrical power at the fraction `x` of the interval, W.
    fn electrical(&self, side: Side, x: f64) -> f64 {
        let axis = self.axis;
        axis.power(side, self.speed(x), self.accel, self.sign())
    }

    /// Fractions at which the law of the electrical power may change.
    ///
    /// Mechanical power changes its sign where F = 0. Electrical power, below it,
    /// is `η·v·F + R·F² = F·(η·v + R·F)`. Where the force lies between two, the least
    /// power leaves either for `F = −η·v/(2·R)`.
    fn changes(&self, side: Side) -> ArrayVec<f64, CHANGES> {
        let (r, eta) = (self.axis.copper, self.axis.efficiency);
        let spread = self.axis.is_spread() && side == Side::Regen;
        let forces = [side, Side::Motor];
        let mut changes = ArrayVec::new();
        for side in forces.into_iter().take(if spread { 2 } else { 1 }) {
            let Force {
                constant,
                per_speed,
            } = self.force(side);
            changes.push(-constant / per_speed);
            changes.push(-r * constant / (eta + r * per_speed));
            if spread {
                changes.push(-r * constant / (0.5 * eta + r * per_speed));
            }
        }
        for v in &mut changes {
            *v = (*v - self.start) / (self.end - self.start);
        }
        changes
    }
}

/// All axes of a converter over one interval.
pub(super) struct Interval<'a> {
    /// Whether fed-back power feeds the other axes.
    pub credit_regen: bool,
    /// Whether any of the axes has viscous friction or copper loss.
    pub curved: bool,
    /// What is drawn besides the axes in `ramps`, W.
    pub idle_w: f64,
    /// The axes, moving or arrived.
    pub ramps: &'a [Ramp<'a>],
    /// How long it lasts.
    pub duration_s: f64,
}

impl Interval<'_> {
    /// Raises the peaks and adds the energy. `Totals` must hold the idle
    /// energy already.
    pub fn evaluate(&self, want: Want, totals: &mut Totals) {
        for x in [0.0, 1.0] {
            totals.raise_peak(self.idle_w + self.drawn(Side::Motor, x));
        }
        if !self.curved {
            let (first, last) = (self.fed_back(0.0), self.fed_back(1.0));
            totals.raise_regen(larger_end(first, last));
            if want.energy {
                let ends = self.drawn(Side::Nominal, 0.0) + self.drawn(Side::Nominal, 1.0);
                totals.energy_j += 0.5 * ends * self.duration_s;
            }
            return;
        }
        self.pieces(Side::Regen, |from, to| {
            totals.raise_regen(parabola_peak(from, to, |x| self.fed_back(x)));
        });
        if want.energy {
            self.pieces(Side::Nominal, |from, to| {
                let ends = self.drawn(Side::Nominal, from) + self.drawn(Side::Nominal, to);
                let middle = self.drawn(Side::Nominal, 0.5 * (from + to));
                totals.energy_j += (to - from) * self.duration_s * (ends + 4.0 * middle) / 6.0;
            });
        }
    }

    /// Power of the axes as far as it counts towards peak and energy, W.
    fn drawn(&self, side: Side, x: f64) -> f64 {
        let powers = self.ramps.iter().map(|ramp| ramp.electrical(side, x));
        if self.credit_regen {
            powers.sum()
        } else {
            powers.map(|power| power.max(0.0)).sum()
        }
    }

    /// Power fed back, negative where power is drawn, W.
    fn fed_back(&self, x: f64) -> f64 {
        let powers = self
            .ramps
            .iter()
            .map(|ramp| -ramp.electrical(Side::Regen, x));
        if self.credit_regen {
            powers.sum::<f64>() - self.idle_w
        } else {
            powers.map(|power| power.max(0.0)).sum()
        }
    }

    /// Visits the pieces, as fractions of the interval, on which the power of
    /// each axis is one parabola.
    fn pieces(&self, side: Side, mut visit: impl FnMut(f64, f64)) {
        let mut ends = ArrayVec::<f64, { CHANGES * AXES + 1 }>::new();
        for ramp in self.ramps {
            for x in ramp.changes(side) {
                if x > 0.0 && x < 1.0 {
                    ends.push(x);
                }
            }
        }
        ends.push(1.0);
        ends.sort_unstable_by(f64::total_cmp);
        let mut from = 0.0;
        for to in ends {
            visit(from, to);
            from = to;
        }
    }
}

/// The larger value; infinite if either is undefined.
fn larger_end(a: f64, b: f64) -> f64 {
    super::demand::larger(a, b)
}

/// Largest value of a parabola over `[from, to]`, from three of its points.
fn parabola_peak(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let middle = 0.5 * (from + to);
    let (first, mid, last) = (f(from), f(middle), f(to));
    let ends = larger_end(first, last);
    let bend = first - 2.0 * mid + last;
    if bend < 0.0 {
        let vertex = middle - 0.25 * (to - from) * (last - first) / bend;
        if vertex > from && vertex < to {
            return larger_end(ends, f(vertex));
        }
    }
    ends
}
