//! The power of means of speeds and accelerations, and of all that lies between two of them.

use crate::machine::AxisValues;
use crate::power::axis::Side;
use crate::power::demand::Totals;
use crate::power::model::{ConverterPower, PowerModel};

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

/// The speeds of an axis between two means `step_s` apart: those at both ends, or where its
/// acceleration is 0 and the speed turns.
pub(super) fn swing(means: &[Mean; 2], axis: usize, step_s: f64) -> [f64; 2] {
    let [a, b] = means.map(|mean| mean.accel[axis]);
    let mut speeds = means.map(|mean| mean.speed[axis]);
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

/// The powers of the axes, drawn and fed back, by all that lies between two means `step_s`
/// apart, W: the acceleration changes evenly, and the power of an axis is largest at a corner
/// of what speed and acceleration may be.
fn bound_w(
    model: &PowerModel,
    converter: &ConverterPower,
    axes: &[usize],
    means: &[Mean; 2],
    step_s: f64,
) -> [f64; 2] {
    let (mut drawn_w, mut fed_back_w) = (0.0, 0.0);
    for &axis in axes.iter().filter(|axis| converter.axes.contains(**axis)) {
        let power = &model.axes[axis];
        let accels = means.map(|mean| mean.accel[axis] * power.si_per_unit);
        let speeds = swing(means, axis, step_s).map(|speed| speed * power.si_per_unit);
        let (mut most, mut least) = (f64::NEG_INFINITY, f64::INFINITY);
        for v in speeds {
            let sign = if v.abs() < AT_REST { 0.0 } else { v.signum() };
            let forces = accels
                .map(|a| [Side::Regen, Side::Motor].map(|side| power.force(side, v, a, sign)));
            let [low, high] = [f64::min, f64::max].map(|f: fn(f64, f64) -> f64| {
                let [a, b] = forces.map(|[a, b]| f(a, b));
                f(a, b)
            });
            most = most.max(power.most(v, [low, high]));
            least = least.min(power.least(v, [low, high]));
        }
        if converter.credit_regen {
            drawn_w += most;
            fed_back_w -= least;
        } else {
            drawn_w += most.max(0.0);
            fed_back_w += (-least).max(0.0);
        }
    }
    [drawn_w, fed_back_w]
}

/// Raises the peaks by powers of the axes, W.
fn raise_to(converter: &ConverterPower, [drawn_w, fed_back_w]: [f64; 2], totals: &mut Totals) {
    let credit_w = if converter.credit_regen {
        totals.idle_w
    } else {
        0.0
    };
    totals.raise_peak(totals.idle_w + drawn_w);
    totals.raise_regen(fed_back_w - credit_w);
}

/// Raises the peaks by all that lies between two means.
pub(super) fn raise(
    model: &PowerModel,
    converter: &ConverterPower,
    axes: &[usize],
    means: &[Mean; 2],
    totals: &mut Totals,
) {
    raise_to(
        converter,
        bound_w(model, converter, axes, means, 0.0),
        totals,
    );
}

/// The same of all that is reached between means `step_s` apart.
pub(super) fn raise_closely(
    model: &PowerModel,
    converter: &ConverterPower,
    axes: &[usize],
    (means, step_s): (&[Mean; 2], f64),
    totals: &mut Totals,
) {
    let powers = |means: &[Mean; 2], step_s| bound_w(model, converter, axes, means, step_s);
    let found = closely(&powers, axes, (means, step_s), HALVINGS);
    raise_to(converter, found, totals);
}

/// The largest powers between two means, halved as often as it takes to come close.
fn closely(
    powers: &impl Fn(&[Mean; 2], f64) -> [f64; 2],
    axes: &[usize],
    (means, step_s): (&[Mean; 2], f64),
    halvings: u32,
) -> [f64; 2] {
    let bound = powers(means, step_s);
    let [first, last] = means.map(|mean| powers(&[mean; 2], 0.0));
    let close = |side: usize| bound[side] <= CLOSE * first[side].max(last[side]);
    if halvings == 0 || close(0) && close(1) {
        return bound;
    }
    let [first, last] = means;
    let mut middle = *first;
    for &axis in axes {
        let accel = 0.5 * (first.accel[axis] + last.accel[axis]);
        middle.accel[axis] = accel;
        middle.speed[axis] += 0.25 * step_s * (first.accel[axis] + accel);
    }
    let halves = [[*first, middle], [middle, *last]];
    let [a, b] = halves.map(|half| closely(powers, axes, (&half, 0.5 * step_s), halvings - 1));
    [0, 1].map(|side| a[side].max(b[side]))
}
