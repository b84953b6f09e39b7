//! Steps of speed next to pieces that are sped up or braked at lower overrides alone.
//!
//! At a lower override the steps at joints are no larger than at the largest, and no
//! more of them lie within the response time τ. The acceleration along the path comes
//! on top: within τ each axis is accelerated by no more than
//!
//! ```text
//! max(Σ of the steps up, Σ of the steps down)/τ + a·|u|
//! ```
//!
//! with the largest a and |u| of the pieces around, in the direction in which they may
//! be sped up or braked.

use super::Steps;
use super::peaks::{Mean, Peaks};
use super::placed::Surged;
use super::velocity;
use super::windows::NO_TIME;
use crate::demand::{Demand, Want};
use crate::model::PowerModel;
use gwatt_machine::{AXES, AxisValues};
use gwatt_motion::Move;

impl Steps {
    /// The last piece may be sped up or braked, or both, with an acceleration along the
    /// path, and run as fast as `speed_mm_s` then; `parts`: the least and the largest share
    /// that each axis has in it.
    pub fn surge(
        &mut self,
        [least, largest]: &[AxisValues; 2],
        [rises, falls]: [bool; 2],
        accel_mm_s2: f64,
        speed_mm_s: f64,
    ) {
        let mut surged = Surged {
            end_s: self.end_s,
            accel_mm_s2: [[0.0; AXES]; 2],
            speed_mm_s: [*least, *largest].map(|parts| velocity(&parts, speed_mm_s)),
        };
        let fastest = &mut self.most[0].speed_mm_s;
        let most = &mut self.most[0].accel_mm_s2;
        for &axis in &self.axes {
            for speed in surged.speed_mm_s {
                fastest[axis] = fastest[axis].max(speed[axis].abs());
            }
            let ahead = largest[axis].max(0.0) * accel_mm_s2;
            let back = (-least[axis]).max(0.0) * accel_mm_s2;
            let mut raise = |side: usize, accel: f64| {
                surged.accel_mm_s2[side][axis] = surged.accel_mm_s2[side][axis].max(accel);
                most[axis] = most[axis].max(accel);
            };
            if rises {
                raise(0, ahead);
                raise(1, back);
            }
            if falls {
                raise(0, back);
                raise(1, ahead);
            }
        }
        self.surges.push_back(surged);
    }

    /// Whether such a piece and a step lie so near that they count together.
    pub fn is_surged(&self) -> bool {
        let reach_s = self.end_s - 2.0 * self.response_s;
        let last = self.spans.back().map_or(0.0, |last| last.span.duration_s);
        let from_s = reach_s - last;
        self.last_step_s >= from_s && self.surges.back().is_some_and(|it| it.end_s >= from_s)
    }

    /// What the last span and the response time before it ask for at most, together
    /// with the acceleration along the path, on the loads of `mv`.
    pub fn surged_demand(&self, model: &PowerModel, mv: &Move) -> Demand {
        let mut means = [Mean {
            speed: [0.0; AXES],
            accel: [0.0; AXES],
        }; 2];
        let [least, most] = &mut means;
        let from_s = self.spans.back().map_or(0.0, |last| last.start_s) - self.response_s;
        // What is a response time away but for rounding counts.
        let from_s = from_s - NO_TIME * self.response_s;
        let until_s = self.last_step_s.max(from_s) + self.response_s;
        let (mut up, mut down) = ([0.0_f64; AXES], [0.0_f64; AXES]);
        for surged in self.surges.iter().filter(|it| it.end_s >= from_s) {
            let [rises, falls] = &surged.accel_mm_s2;
            let [slowest, fastest] = &surged.speed_mm_s;
            for &axis in &self.axes {
                up[axis] = up[axis].max(rises[axis]);
                down[axis] = down[axis].max(falls[axis]);
                most.speed[axis] = most.speed[axis].max(fastest[axis]);
                least.speed[axis] = least.speed[axis].min(slowest[axis]);
            }
        }
        for placed in &self.spans {
            let [first, last] = &placed.span.axes_mm_s;
            // No further away than the means reach.
            let ends = [from_s, until_s].map(|at_s| placed.passed(at_s));
            for &axis in &self.axes {
                let step = placed.step_mm_s[axis] * placed.span.beyond.joint;
                if placed.start_s >= from_s {
                    most.accel[axis] += step.max(0.0) / self.response_s;
                    least.accel[axis] += step.min(0.0) / self.response_s;
                }
                if placed.end_s() >= from_s {
                    let accel = (last[axis] - first[axis]) / placed.span.duration_s;
                    let accel = accel * placed.span.beyond.ramp;
                    up[axis] = up[axis].max(accel);
                    down[axis] = down[axis].max(-accel);
                    for passed in ends {
                        let [speed, _] = placed.at(axis, passed);
                        most.speed[axis] = most.speed[axis].max(speed);
                        least.speed[axis] = least.speed[axis].min(speed);
                    }
                }
            }
        }
        for &axis in &self.axes {
            most.accel[axis] += up[axis];
            least.accel[axis] -= down[axis];
        }
        let mut demand = Demand::NONE;
        for (index, converter) in model.converters.iter().enumerate() {
            let mut peaks = Peaks::new(model, converter, &self.axes, mv, Want::PEAKS);
            peaks.raise(&means);
            demand.add(index, converter, peaks.totals);
        }
        demand
    }
}
