//! The power of means of speeds and accelerations, and of all that lies between two of them.

use crate::axis::{AxisPower, Side};
use crate::demand::{Totals, Want, larger};
use crate::model::{ConverterPower, PowerModel};
use gwatt_machine::AxisValues;
use gwatt_motion::Move;

/// Speeds below are rounding of a mean over places, in m/s or rad/s.
const AT_REST: f64 = 1e-9;
/// How closely what lies between two means is bounded, and how often it is halved for that.
const CLOSE: f64 = 1.0 + 1e-4;
const HALVINGS: u32 = 6;

/// Mean speeds and accelerations of the axes, mm/s and mm/s².
#[derive(Clone, Copy)]
pub(super) struct Mean {
    pub speed: AxisValues,
    pub accel: AxisValues,
}

/// An upper bound of what an axis draws and feeds back at a speed and an acceleration that are
/// no larger in amount than these, mm/s and mm/s²; in W.
pub(super) fn at_most_w(power: &AxisPower, speed_mm_s: f64, accel_mm_s2: f64) -> [f64; 2] {
    let [v, a] = [speed_mm_s, accel_mm_s2].map(|it| it * power.si_per_unit);
    let weight = power.gravity.abs();
    let drag = power.coulomb_most() + power.viscous_most() * v + weight;
    let [motor, regen] = [(Side::Motor, true), (Side::Regen, false)]
        .map(|(side, grows)| power.mass * a * power.accel_factor(side, grows));
    let force = larger(motor, regen) + drag;
    let drawn_w = v * (motor + drag) * power.inverse_efficiency + power.copper * force * force;
    let held = power.coulomb * power.friction_factor(Side::Regen);
    [drawn_w, v * larger(regen + weight - held, 0.0)]
}

/// The speeds of an axis between two means `step_s` apart: those at both ends, or where its
/// acceleration is 0 and the speed turns.
pub(super) fn swing(means: &[Mean; 2], axis: usize, step_s: f64) -> [f64; 2] {
    let [first, last] = means;
    let [a, b] = [first.accel[axis], last.accel[axis]];
    let mut speeds = [first.speed[axis], last.speed[axis]];
    if a * b < 0.0 {
        let turn = speeds[0] + 0.5 * step_s * a * a / (a - b);
        if a > 0.0 {
            let top = usize::from(speeds[1] > speeds[0]);
            speeds[top] = speeds[top].max(turn);
        } else {
            let low = usize::from(speeds[1] < speeds[0]);
            speeds[low] = speeds[low].min(turn);
        }
    }
    speeds
}

/// The peaks of a converter, as far as they are found.
pub(super) struct Peaks<'a> {
    model: &'a PowerModel,
    converter: &'a ConverterPower,
    axes: &'a [usize],
    want: Want,
    pub totals: Totals,
    /// Powers that the axes do come to, drawn and fed back, W: `totals` are bounds of them.
    reached_w: [f64; 2],
}

impl<'a> Peaks<'a> {
    /// None yet but for what is drawn at rest, on the loads of `mv`.
    pub fn new(
        model: &'a PowerModel,
        converter: &'a ConverterPower,
        axes: &'a [usize],
        mv: &Move,
        want: Want,
    ) -> Self {
        Self {
            model,
            converter,
            axes,
            want,
            totals: Totals::new(converter.idle_w(mv, &model.axes, converter.axes)),
            reached_w: [0.0; 2],
        }
    }

    /// Raises them by all that lies between two means.
    pub fn raise(&mut self, means: &[Mean; 2]) {
        let found = self.bound_w(means, 0.0);
        self.raise_to(found);
    }

    /// The same of all that is reached between means `step_s` apart.
    pub fn raise_closely(&mut self, means: &[Mean; 2], step_s: f64) {
        let [first, last] = means;
        self.reach(first);
        self.reach(last);
        self.closely((means, step_s), HALVINGS);
    }

    /// Whether what the axes do at no more than this speed and acceleration each adds nothing.
    pub fn covers(&self, most: impl Fn(usize) -> [f64; 2]) -> bool {
        let mut axes_w = [0.0; 2];
        for &axis in self.fed() {
            let [speed_mm_s, accel_mm_s2] = most(axis);
            let [drawn, fed_back] = at_most_w(&self.model.axes[axis], speed_mm_s, accel_mm_s2);
            axes_w = [axes_w[0] + drawn, axes_w[1] + fed_back];
        }
        self.covers_w(axes_w)
    }

    /// The axes that it feeds.
    fn fed(&self) -> impl Iterator<Item = &'a usize> {
        let of = self.converter.axes;
        self.axes.iter().filter(move |axis| of.contains(**axis))
    }

    /// What becomes of powers of the axes, drawn and fed back, W.
    fn with_rest_w(&self, [drawn_w, fed_back_w]: [f64; 2]) -> [f64; 2] {
        let idle_w = self.totals.idle_w;
        let credit_w = if self.converter.credit_regen {
            idle_w
        } else {
            0.0
        };
        [idle_w + drawn_w, fed_back_w - credit_w]
    }

    /// Whether powers of the axes are no larger than what is found, or of no interest.
    fn covers_w(&self, axes_w: [f64; 2]) -> bool {
        let found = self.with_rest_w(axes_w);
        let known = [self.totals.peak_w, self.totals.regen_w];
        found[0] <= known[0] && found[1] <= known[1] || self.want.passes(found)
    }

    fn raise_to(&mut self, axes_w: [f64; 2]) {
        let [peak_w, regen_w] = self.with_rest_w(axes_w);
        self.totals.raise_peak(peak_w);
        self.totals.raise_regen(regen_w);
    }

    /// The powers of the axes, drawn and fed back, by all that lies between two means
    /// `step_s` apart, W: the acceleration changes evenly, and the power of an axis is largest
    /// at a corner of what speed and acceleration may be.
    fn bound_w(&self, means: &[Mean; 2], step_s: f64) -> [f64; 2] {
        let (mut drawn_w, mut fed_back_w) = (0.0, 0.0);
        for &axis in self.fed() {
            let power = &self.model.axes[axis];
            let [first, last] = means;
            let accels = [first.accel[axis], last.accel[axis]];
            if accels == [0.0; 2] && [first.speed[axis], last.speed[axis]] == [0.0; 2] {
                drawn_w += power.holding_w();
                if self.converter.credit_regen {
                    fed_back_w -= power.holding_w();
                }
                continue;
            }
            let accels = accels.map(|a| a * power.si_per_unit);
            let (mut most, mut least) = (f64::NEG_INFINITY, f64::INFINITY);
            for speed in swing(means, axis, step_s) {
                let v = speed * power.si_per_unit;
                let sign = if v.abs() < AT_REST { 0.0 } else { v.signum() };
                let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
                for a in accels {
                    for side in [Side::Regen, Side::Motor] {
                        let force = power.force(side, v, a, sign);
                        (low, high) = (low.min(force), high.max(force));
                    }
                }
                most = most.max(power.most(v, [low, high]));
                least = least.min(power.least(v, [low, high]));
            }
            if self.converter.credit_regen {
                drawn_w += most;
                fed_back_w -= least;
            } else {
                drawn_w += most.max(0.0);
                fed_back_w += (-least).max(0.0);
            }
        }
        [drawn_w, fed_back_w]
    }

    /// Raises them by the largest powers between two means, halved as often as it takes to
    /// come close to what is reached anywhere, or until they add nothing.
    fn closely(&mut self, (means, step_s): (&[Mean; 2], f64), halvings: u32) {
        let bound = self.bound_w(means, step_s);
        if self.covers_w(bound) {
            return;
        }
        let close = |side: usize| bound[side] <= CLOSE * self.reached_w[side];
        if halvings == 0 || close(0) && close(1) {
            self.raise_to(bound);
            return;
        }
        let [first, last] = means;
        let mut middle = *first;
        for &axis in self.axes {
            let accel = 0.5 * (first.accel[axis] + last.accel[axis]);
            middle.accel[axis] = accel;
            middle.speed[axis] += 0.25 * step_s * (first.accel[axis] + accel);
        }
        self.reach(&middle);
        for half in [[*first, middle], [middle, *last]] {
            self.closely((&half, 0.5 * step_s), halvings - 1);
        }
    }

    /// A mean that the axes come to.
    fn reach(&mut self, mean: &Mean) {
        let found = self.bound_w(&[*mean; 2], 0.0);
        for (reached, found) in self.reached_w.iter_mut().zip(found) {
            *reached = reached.max(found);
        }
    }
}
