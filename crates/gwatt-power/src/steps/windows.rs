//! Means over the response time, and their power.

use super::peaks::{Mean, Peaks};
use super::slowed::{Changes, Window};
use super::{Placed, Steps};
use crate::demand::{Demand, Want, larger};
use crate::model::PowerModel;
use gwatt_machine::{AXES, AxisValues};
use gwatt_motion::Move;

/// Parts of a response time over which a mean is bounded in one go.
const PARTS: f64 = 4.0;
/// Share of a response time that is rounding.
pub(super) const NO_TIME: f64 = 1e-9;
/// Shares of the largest overrides at which steps are looked at.
const RUNGS: [f64; 8] = [1.0, 0.9, 0.8, 0.7, 0.6, 0.45, 0.3, 0.15];
/// Means longer than the response time that are looked at for one step.
const LONGER: usize = 8;

/// One end of a mean: a span, or rest where there is none, and an instant.
#[derive(Clone, Copy)]
struct End<'a> {
    placed: Option<&'a Placed>,
    at_s: f64,
    rest_mm: &'a AxisValues,
}

impl End<'_> {
    fn passed(&self) -> f64 {
        self.placed.map_or(0.0, |placed| placed.passed(self.at_s))
    }

    /// Speed and place of an axis after a share of the span's time.
    fn state(&self, axis: usize, passed: f64) -> [f64; 2] {
        match self.placed {
            Some(placed) => {
                let [speed, way] = placed.at(axis, passed);
                [speed, placed.place_mm[axis] + way]
            }
            None => [0.0, self.rest_mm[axis]],
        }
    }
}

/// What no mean over the response time exceeds that ends in the last span.
struct Reach {
    speed_mm_s: AxisValues,
    accel_mm_s2: AxisValues,
}

impl Steps {
    /// What the means ask for that end in the last span and have a step within, on
    /// the loads of `mv`.
    pub fn demand(&self, model: &PowerModel, mv: &Move, want: Want) -> Demand {
        let mut demand = Demand::NONE;
        let reach = self.reach();
        for (index, converter) in model.converters.iter().enumerate() {
            let mut peaks = Peaks::new(model, converter, &self.axes, mv, want);
            let shares = if self.lower { &RUNGS[..] } else { &RUNGS[..1] };
            for &share in shares {
                let most = |axis: usize| [share * reach.speed_mm_s[axis], reach.accel_mm_s2[axis]];
                if !peaks.covers(most) {
                    self.over_response(share, &mut peaks);
                }
                self.over_longer(share, &mut peaks);
            }
            demand.add(index, converter, peaks.totals);
        }
        demand
    }

    /// What no mean over the response time or a share of it exceeds, at lower overrides either:
    /// all steps and the steepest ramp. Where a share of the speeds is left the time is as
    /// much shorter, and the steps are as much smaller.
    fn reach(&self) -> Reach {
        let mut reach = Reach {
            speed_mm_s: [0.0; AXES],
            accel_mm_s2: [0.0; AXES],
        };
        let mut steps = [0.0; AXES];
        let last_s = self.spans.back().map_or(0.0, |last| last.start_s);
        let from_s = last_s - (1.0 + NO_TIME) * self.response_s;
        let near = self.spans.iter().rev();
        for placed in near.take_while(|placed| placed.end_s() >= from_s) {
            let per_s = placed.span.beyond.ramp / placed.span.duration_s;
            let [first, last] = &placed.span.axes_mm_s;
            for &axis in &self.axes {
                let (from, to) = (first[axis], last[axis]);
                let (speed, ramp) = (larger(from.abs(), to.abs()), (to - from).abs() * per_s);
                reach.speed_mm_s[axis] = larger(reach.speed_mm_s[axis], speed);
                reach.accel_mm_s2[axis] = larger(reach.accel_mm_s2[axis], ramp);
                if placed.start_s >= from_s {
                    steps[axis] += placed.step_mm_s[axis].abs();
                }
            }
        }
        for &axis in &self.axes {
            reach.accel_mm_s2[axis] += steps[axis] / self.response_s;
        }
        reach
    }

    /// Means over the response time, at the largest overrides or where a share of their
    /// speeds is left: what takes that long there takes a share of it here.
    fn over_response(&self, share: f64, peaks: &mut Peaks<'_>) {
        let (Some(last), Some(first)) = (self.spans.back(), self.spans.front()) else {
            return;
        };
        let tau = share * self.response_s;
        let until_s = last.end_s().min(self.last_step_s + tau);
        let mut end_s = last.start_s;
        let begun = self.spans.partition_point(|it| it.start_s <= end_s - tau);
        // Which span the mean begins in; 0: before all.
        let mut begun = begun;
        let mut within = self.changes(begun);
        // What rounding leaves of the last part has no step within.
        while until_s - end_s > NO_TIME * tau {
            let from_s = end_s - tau;
            let placed = begun.checked_sub(1).and_then(|index| self.spans.get(index));
            let leaves_s = placed.map_or(first.start_s, Placed::end_s);
            if leaves_s - from_s <= NO_TIME * tau && begun < self.spans.len() {
                begun += 1;
                within = self.changes(begun);
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
            let [first_changes, last_changes] = [0.0, step_s].map(|on_s| {
                let mut changes = within;
                if self.lower {
                    changes.ramp(&self.axes, last, [0.0, last.passed(end_s + on_s)]);
                    if let Some(placed) = placed {
                        let passed = placed.passed(from_s + on_s);
                        changes.ramp(&self.axes, placed, [passed, 1.0]);
                    }
                }
                changes
            });
            let changes = first_changes.most(&last_changes, &self.axes);
            let window = Window {
                means: &means,
                step_s,
                over_s: tau,
                changes,
            };
            self.raise_at(share, &window, peaks);
            let next_s = end_s + step_s;
            if next_s <= end_s {
                break;
            }
            end_s = next_s;
        }
    }

    /// Means from one step to another that is further away; `share` as above.
    fn over_longer(&self, share: f64, peaks: &mut Peaks<'_>) {
        let Some(last) = self.spans.back().filter(|last| last.steps) else {
            return;
        };
        let tau = share * self.response_s;
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
            let window = Window {
                means: &[self.mean([from, to], away_s(placed)); 2],
                step_s: 0.0,
                over_s: away_s(placed),
                changes: self.changes(index),
            };
            self.raise_at(share, &window, peaks);
        }
    }

    /// Raises the peaks by a window at the largest overrides, and by what lower ones make of
    /// it; or by one where a share of the speeds is left.
    fn raise_at(&self, share: f64, window: &Window<'_>, peaks: &mut Peaks<'_>) {
        if peaks.covers(|axis| window.most(axis, share, self.lower)) {
            return;
        }
        let axes = &self.axes;
        if share < 1.0 {
            // A step is as it is where its joint permits no more at any override.
            for steps in [share, share * share] {
                peaks.raise(&window.slowed(axes, share, steps));
            }
            return;
        }
        peaks.raise_closely(window.means, window.step_s);
        if self.lower {
            for share in RUNGS.into_iter().chain([0.0]) {
                // Where several steps lie within the response time fewer do, down to o² of
                // their sum.
                for steps in [1.0, share * share] {
                    peaks.raise(&window.partly_slowed(axes, share, steps));
                }
            }
        }
    }

    /// What the spans from `first` on change with their joints, but for the ramp of the last.
    fn changes(&self, first: usize) -> Changes {
        let mut changes = Changes::default();
        if self.lower {
            for placed in self.spans.iter().skip(first) {
                for &axis in &self.axes {
                    changes.steps[axis] += placed.step_mm_s[axis];
                }
            }
            let whole = self.spans.len().saturating_sub(first + 1);
            for placed in self.spans.iter().skip(first).take(whole) {
                changes.ramp(&self.axes, placed, [0.0, 1.0]);
            }
        }
        changes
    }

    fn mean(&self, ends: [End<'_>; 2], over_s: f64) -> Mean {
        let [from, to] = &ends;
        let passed = [from.passed(), to.passed()];
        let mut mean = Mean {
            speed: [0.0; AXES],
            accel: [0.0; AXES],
        };
        for &axis in &self.axes {
            let from = from.state(axis, passed[0]);
            let to = to.state(axis, passed[1]);
            mean.accel[axis] = (to[0] - from[0]) / over_s;
            mean.speed[axis] = (to[1] - from[1]) / over_s;
        }
        mean
    }
}
