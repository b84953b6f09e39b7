//! A piece of an arc on which no axis turns back, as a function to maximise.
//!
//! Input: a phase of an arc between two quadrants, and the side that is asked
//! for. Output: samples of the power, and upper bounds between two samples for
//! `search`.

use super::arc_circle::Circle;
use super::axis::Side;
use super::circle::{Motion, Reach};
use super::search::Bounded;
use arrayvec::ArrayVec;
use gwatt_machine::AXES;
use gwatt_plan::Phase;

/// One piece of a phase, seen from one side.
pub(super) struct Piece<'a> {
    circle: &'a Circle<'a>,
    phase: &'a Phase,
    side: Side,
    /// What all axes together start from, W.
    base_w: f64,
    axes: ArrayVec<AxisBounds, AXES>,
}

/// What holds for one axis on the whole piece.
struct AxisBounds {
    /// Direction of motion.
    sign: f64,
    /// Second derivative of power, divided by 8.
    bend: f64,
    /// Rate of acceleration, divided by 2.
    jerk: f64,
    /// Rate of force, divided by 2.
    force_slope: f64,
}

/// Power at one instant.
#[derive(Clone)]
pub(super) struct Sample {
    t: f64,
    value: f64,
    axes: ArrayVec<AxisSample, AXES>,
}

/// Power of one axis at one instant: drawn (motor side) or fed back.
#[derive(Clone, Copy)]
struct AxisSample {
    /// The power. Of fed-back power, that of regenerating.
    first: f64,
    /// Of fed-back power, as if motoring: the smaller one is true.
    second: f64,
    /// How much more it would be with the other factor of acceleration.
    excess: f64,
    /// Acceleration in the direction of motion.
    accel: f64,
    /// Force in the direction of motion.
    force: f64,
}

impl<'a> Piece<'a> {
    /// The piece from `from` to `to` (s) of a phase; `reach` bounds its motion.
    pub fn new(
        circle: &'a Circle<'a>,
        phase: &'a Phase,
        side: Side,
        (from, to): (f64, f64),
        reach: &Reach,
    ) -> Self {
        let signs = circle.signs(phase, 0.5 * (from + to));
        let bounds = circle.axes.iter().zip(signs).map(|(arc_axis, sign)| {
            let axis = arc_axis.axis;
            let factor = if axis.is_spread() {
                axis.largest_factor()
            } else {
                axis.accel_factor(side, true)
                    .max(axis.accel_factor(side, false))
            };
            let (mechanical, copper) = arc_axis.curvature(reach, factor);
            let (jerk, force_slope) = arc_axis.slopes(reach, factor);
            let conversion = match side {
                Side::Regen if !circle.credit_regen => axis.efficiency,
                _ => axis.inverse_efficiency,
            };
            AxisBounds {
                sign,
                bend: 0.125 * (mechanical * conversion + copper),
                jerk: 0.5 * jerk,
                force_slope: 0.5 * force_slope,
            }
        });
        Self {
            circle,
            phase,
            side,
            base_w: match side {
                Side::Regen if circle.credit_regen => -circle.idle_w,
                Side::Regen => 0.0,
                _ => circle.idle_w,
            },
            axes: bounds.collect(),
        }
    }

    /// The power of one axis.
    fn axis_sample(&self, index: usize, m: &Motion) -> AxisSample {
        let arc_axis = &self.circle.axes[index];
        let sign = self.axes[index].sign;
        let axis = arc_axis.axis;
        let (v, a) = arc_axis.motion_towards(sign, m);
        let forces = |side: Side, growing: bool| {
            let friction = axis.friction_factor(side);
            let steady = friction * (axis.viscous * v + axis.coulomb * sign) + axis.gravity;
            axis.mass * a * axis.accel_factor(side, growing) + steady
        };
        let power = |growing: bool| {
            let own = forces(self.side, growing);
            let lowest = forces(Side::Regen, growing) * sign;
            if self.side != Side::Regen {
                let drawn = if axis.is_spread() && self.side == Side::Motor {
                    axis.most(v, [own, forces(Side::Regen, growing)])
                } else {
                    axis.electrical(v, own)
                };
                return ([drawn; 2], lowest);
            }
            let fed_back = |conversion: f64| {
                let force = if axis.is_spread() {
                    let other = forces(Side::Motor, growing);
                    let best = -0.5 * conversion * v / axis.copper;
                    best.max(own.min(other)).min(own.max(other))
                } else {
                    own
                };
                -v * force * conversion - axis.copper * force * force
            };
            (
                [axis.efficiency, axis.inverse_efficiency].map(fed_back),
                lowest,
            )
        };
        let growing = a * sign > 0.0;
        let ([first, second], force) = power(growing);
        let mut sample = AxisSample {
            first,
            second,
            excess: 0.0,
            accel: a * sign,
            force,
        };
        let factors = |growing: bool| {
            [Side::Motor, Side::Regen].map(|side| match side {
                own if own == self.side || axis.is_spread() => axis.accel_factor(own, growing),
                _ => 1.0,
            })
        };
        if factors(true) != factors(false) {
            let ([other_first, other_second], other_force) = power(!growing);
            sample.excess = f64::max(0.0, (other_first - first).max(other_second - second));
            sample.force = force.min(other_force);
        }
        sample
    }
}

impl Bounded for Piece<'_> {
    type Sample = Sample;

    fn sample(&self, t: f64) -> Sample {
        let motion = self.circle.motion(self.phase, t);
        let axes: ArrayVec<AxisSample, AXES> = (0..self.axes.len())
            .map(|index| self.axis_sample(index, &motion))
            .collect();
        let counted = axes.iter().map(|axis| {
            if self.circle.credit_regen {
                axis.first.min(axis.second)
            } else {
                axis.first.max(0.0)
            }
        });
        Sample {
            t,
            value: self.base_w + counted.sum::<f64>(),
            axes,
        }
    }

    fn value(&self, sample: &Sample) -> (f64, f64) {
        (sample.t, sample.value)
    }

    fn bound(&self, from: &Sample, to: &Sample) -> f64 {
        let (start, end, bend) = self.chord(from, to);
        start.max(end) + bend
    }
}

impl Piece<'_> {
    /// A chord above which the power does not rise by more than the third value:
    /// its power at both samples, and that.
    ///
    /// Each axis' power is smooth, or the larger of smooth functions, between
    /// the samples. Where it is the smaller of two, either is a bound. Where
    /// the factor of acceleration may change, the worse factor is.
    pub fn chord(&self, from: &Sample, to: &Sample) -> (f64, f64, f64) {
        let h = to.t - from.t;
        let (mut start, mut end, mut bend) = (self.base_w, self.base_w, 0.0);
        for ((axis, a), b) in self.axes.iter().zip(&from.axes).zip(&to.axes) {
            let axis_bend = axis.bend * h * h;
            let steady =
                a.accel * b.accel > 0.0 && a.accel.abs().min(b.accel.abs()) > axis.jerk * h;
            let (excess_a, excess_b) = if steady {
                (0.0, 0.0)
            } else {
                (a.excess, b.excess)
            };
            // An axis that is driven all along feeds nothing back.
            let driven = self.side == Side::Regen && a.force.min(b.force) > axis.force_slope * h;
            let credit = self.circle.credit_regen;
            let (f0, f1) = if credit && a.first + b.first > a.second + b.second {
                (a.second + excess_a, b.second + excess_b)
            } else {
                (a.first + excess_a, b.first + excess_b)
            };
            let negative = f0.max(f1) + axis_bend <= 0.0;
            if credit && (negative || !driven) {
                start += f0;
                end += f1;
                bend += axis_bend;
            } else if !credit && !negative && !driven {
                start += f0.max(0.0);
                end += f1.max(0.0);
                bend += axis_bend;
            }
        }
        (start, end, bend)
    }
}
