//! Means over the response time, and their power.

use super::{Placed, Steps};
use crate::interpret::Move;
use crate::machine::{AXES, AxisValues};
use crate::power::axis::Side;
use crate::power::demand::{Demand, Totals};
use crate::power::model::{ConverterPower, PowerModel};

/// Parts of a response time over which a mean is bounded in one go.
const PARTS: f64 = 4.0;
/// Share of a response time that is rounding.
pub(super) const NO_TIME: f64 = 1e-9;
/// Speeds below are rounding of a mean over places, in m/s or rad/s.
const AT_REST: f64 = 1e-9;
/// Shares of the largest overrides at which steps are looked at.
const RUNGS: [f64; 8] = [1.0, 0.9, 0.8, 0.7, 0.6, 0.45, 0.3, 0.15];
/// Means longer than the response time that are looked at for one step.
const LONGER: usize = 8;

/// Mean speeds and accelerations of the axes, mm/s and mm/s².
#[derive(Clone, Copy)]
pub(super) struct Mean {
    pub speed: AxisValues,
    pub accel: AxisValues,
}

/// One end of a mean: a span, or rest where there is none, and an instant.
#[derive(Clone, Copy)]
struct End<'a> {
    placed: Option<&'a Placed>,
    at_s: f64,
    rest_mm: &'a AxisValues,
}

impl End<'_> {
    /// Speed and place of each axis; of others 0.
    fn state(&self, axes: &[usize]) -> [AxisValues; 2] {
        let mut state = [[0.0; AXES], *self.rest_mm];
        if let Some(placed) = self.placed {
            let passed = placed.passed(self.at_s);
            for &axis in axes {
                let [speed, way] = placed.at(axis, passed);
                state[0][axis] = speed;
                state[1][axis] = placed.place_mm[axis] + way;
            }
        }
        state
    }
}

impl Steps {
    /// What the means ask for that end in the last span and have a step within, on
    /// the loads of `mv`.
    pub fn demand(&self, model: &PowerModel, mv: &Move) -> Demand {
        let mut demand = Demand::NONE;
        for (index, converter) in model.converters.iter().enumerate() {
            let idle_w = converter.idle_w(mv, &model.axes, converter.axes);
            let mut totals = Totals::new(idle_w);
            self.over_response(model, converter, &mut totals);
            self.over_longer(model, converter, &mut totals);
            demand.add(index, converter, totals);
        }
        demand
    }

    /// Means over the response time.
    fn over_response(&self, model: &PowerModel, converter: &ConverterPower, totals: &mut Totals) {
        let (Some(last), Some(first)) = (self.spans.back(), self.spans.front()) else {
            return;
        };
        let tau = self.response_s;
        let until_s = last.end_s().min(self.last_step_s + tau);
        let mut end_s = last.start_s;
        let begun = self.spans.partition_point(|it| it.start_s <= end_s - tau);
        // Which span the mean begins in; 0: before all.
        let mut begun = begun;
        let mut stepped = self.stepped(begun, tau);
        // What rounding leaves of the last part has no step within.
        while until_s - end_s > NO_TIME * tau {
            let from_s = end_s - tau;
            let placed = begun.checked_sub(1).and_then(|index| self.spans.get(index));
            let leaves_s = placed.map_or(first.start_s, Placed::end_s);
            if leaves_s - from_s <= NO_TIME * tau && begun < self.spans.len() {
                begun += 1;
                stepped = self.stepped(begun, tau);
                continue;
            }
            let step_s = (leaves_s - from_s).min(tau / PARTS).min(until_s - end_s);
            let means = [0.0, step_s].map(|on_s| {
                let end = |placed, at_s| End {
                    placed,
                    at_s,
                    rest_mm: &first.place_mm,
                };
                self.mean(
                    [end(placed, from_s + on_s), end(Some(last), end_s + on_s)],
                    tau,
                )
            });
            raise(model, converter, &self.axes, &means, step_s, totals);
            if self.lower {
                raise_lower(model, converter, &self.axes, &means, &stepped, totals);
            }
            let next_s = end_s + step_s;
            if next_s <= end_s {
                break;
            }
            end_s = next_s;
        }
    }

    /// Means from one step to another that is further away.
    fn over_longer(&self, model: &PowerModel, converter: &ConverterPower, totals: &mut Totals) {
        let Some(last) = self.spans.back().filter(|last| last.steps) else {
            return;
        };
        let tau = self.response_s;
        let away_s = |placed: &Placed| last.start_s - placed.start_s;
        let earlier = (0..self.spans.len()).rev();
        let earlier = earlier.filter_map(|index| Some((index, self.spans.get(index)?)));
        let far = earlier
            .skip_while(|(_, placed)| away_s(placed) <= (1.0 - NO_TIME) * tau)
            .take_while(|(_, placed)| away_s(placed) < (2.0 + NO_TIME) * tau)
            .filter(|(_, placed)| placed.steps);
        for (index, placed) in far.take(LONGER) {
            let before = index.checked_sub(1).and_then(|index| self.spans.get(index));
            let from = End {
                placed: before,
                at_s: placed.start_s,
                rest_mm: &placed.place_mm,
            };
            let to = End {
                placed: Some(last),
                at_s: last.start_s,
                rest_mm: &last.place_mm,
            };
            let mean = self.mean([from, to], away_s(placed));
            raise(model, converter, &self.axes, &[mean; 2], 0.0, totals);
            if self.lower {
                let stepped = self.stepped(index, away_s(placed));
                raise_lower(model, converter, &self.axes, &[mean; 2], &stepped, totals);
            }
        }
    }

    /// What the steps at the starts of the spans from `first` on add to a mean, mm/s².
    fn stepped(&self, first: usize, over_s: f64) -> AxisValues {
        let mut stepped = [0.0; AXES];
        if self.lower {
            for placed in self.spans.iter().skip(first) {
                for &axis in &self.axes {
                    stepped[axis] += placed.step_mm_s[axis] / over_s;
                }
            }
        }
        stepped
    }

    fn mean(&self, ends: [End<'_>; 2], over_s: f64) -> Mean {
        let [from, to] = ends.map(|end| end.state(&self.axes));
        let mut mean = Mean {
            speed: [0.0; AXES],
            accel: [0.0; AXES],
        };
        for &axis in &self.axes {
            mean.accel[axis] = (to[0][axis] - from[0][axis]) / over_s;
            mean.speed[axis] = (to[1][axis] - from[1][axis]) / over_s;
        }
        mean
    }
}

/// Raises the peaks by all that lies between two means `step_s` apart: the
/// acceleration changes evenly, and the power of an axis is largest at a corner of
/// what speed and acceleration may be.
pub(super) fn raise(
    model: &PowerModel,
    converter: &ConverterPower,
    axes: &[usize],
    means: &[Mean; 2],
    step_s: f64,
    totals: &mut Totals,
) {
    let (mut drawn_w, mut fed_back_w) = (0.0, 0.0);
    for &axis in axes.iter().filter(|axis| converter.axes.contains(**axis)) {
        let power = &model.axes[axis];
        let accels = means.map(|mean| mean.accel[axis] * power.si_per_unit);
        let mut speeds = means.map(|mean| mean.speed[axis] * power.si_per_unit);
        let [a, b] = accels;
        if a * b < 0.0 {
            // Where the acceleration is 0 the speed turns.
            let turn = speeds[0] + 0.5 * step_s * a * a / (a - b);
            if a > 0.0 {
                let top = usize::from(speeds[1] > speeds[0]);
                speeds[top] = speeds[top].max(turn);
            } else {
                let low = usize::from(speeds[1] < speeds[0]);
                speeds[low] = speeds[low].min(turn);
            }
        }
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
    let credit_w = if converter.credit_regen {
        totals.idle_w
    } else {
        0.0
    };
    totals.raise_peak(totals.idle_w + drawn_w);
    totals.raise_regen(fed_back_w - credit_w);
}

/// Raises the peaks by what lower overrides make of two means, of which `stepped` comes
/// from steps.
///
/// At the share o of the speed a step is o times as large, and where several lie within
/// the response time fewer do, down to o² of their sum; and the ramps around may have
/// ended before. So each axis is accelerated by something between `o·S`, `o²·S` and the
/// same with the ramp.
#[cold]
fn raise_lower(
    model: &PowerModel,
    converter: &ConverterPower,
    axes: &[usize],
    means: &[Mean; 2],
    stepped: &AxisValues,
    totals: &mut Totals,
) {
    for share in RUNGS {
        let mut lower = *means;
        for &axis in axes {
            let steps = [share, share * share].map(|share| share * stepped[axis]);
            let ramps = means.map(|mean| mean.accel[axis] - stepped[axis]);
            let extreme =
                |of: fn(f64, f64) -> f64| of(steps[0], steps[1]) + of(of(ramps[0], ramps[1]), 0.0);
            let accels = [f64::min, f64::max].map(extreme);
            for (mean, accel) in lower.iter_mut().zip(accels) {
                mean.speed[axis] *= share;
                mean.accel[axis] = accel;
            }
        }
        raise(model, converter, axes, &lower, 0.0, totals);
    }
}
