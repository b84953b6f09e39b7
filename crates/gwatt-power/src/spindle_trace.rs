//! A run of the spindle over time: what its motor draws and feeds back in any
//! span of time.
//!
//! Input: a [`Ramp`] from the instant of the command on. Output: [`SpindleSpan`],
//! exact. After the ramp the spindle holds its speed. The base load of its
//! drive is not in these figures.

use super::spindle::SpindlePower;
use gwatt_plan::period::{Motion, Ramp, RampPhase};

/// What the spindle's motor does in a span of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpindleSpan {
    /// Largest electrical power in W.
    pub largest_w: f64,
    /// Smallest electrical power in W; negative where it is fed back.
    pub least_w: f64,
    /// Electrical energy in J, what is fed back taken off.
    pub energy_j: f64,
    /// Electrical energy drawn in J, what is fed back left aside.
    pub drawn_j: f64,
}

impl SpindleSpan {
    /// A steady power over a time.
    #[must_use]
    pub fn steady(power_w: f64, duration_s: f64) -> Self {
        let energy_j = if power_w == 0.0 {
            0.0
        } else {
            power_w * duration_s
        };
        Self {
            largest_w: power_w,
            least_w: power_w,
            energy_j,
            drawn_j: energy_j.max(0.0),
        }
    }

    fn include(&mut self, other: &Self) {
        self.largest_w = self.largest_w.max(other.largest_w);
        self.least_w = self.least_w.min(other.least_w);
        self.energy_j += other.energy_j;
        self.drawn_j += other.drawn_j;
    }
}

/// A run of the spindle.
#[derive(Debug, Clone, PartialEq)]
pub struct SpindleTrace {
    power: SpindlePower,
    phases: Vec<RampPhase>,
    duration_s: f64,
    start: Motion,
    end_rpm: f64,
}

impl SpindleTrace {
    /// The trace of a ramp, in 1/min, that begins with `start`. `power` without
    /// base load.
    pub(super) fn new(power: SpindlePower, start: Motion, ramp: Ramp) -> Self {
        Self {
            power,
            duration_s: ramp.duration_s(),
            phases: ramp.phases,
            start,
            end_rpm: ramp.end_speed,
        }
    }

    /// How long it takes to the end of the ramp, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The speeds at its beginning and at its end, 1/min.
    #[must_use]
    pub fn speeds_rpm(&self) -> [f64; 2] {
        [self.start.speed, self.end_rpm]
    }

    /// The lowest and the highest speed on the way, 1/min.
    pub(super) fn extent_rpm(&self) -> [f64; 2] {
        let [start, end] = self.speeds_rpm();
        let mut extent = [start.min(end), start.max(end)];
        let mut take = |speed: f64| {
            extent = [extent[0].min(speed), extent[1].max(speed)];
        };
        for phase in &self.phases {
            take(phase.start.speed);
            take(phase.end.speed);
            if let Some(jerk) = phase.jerk() {
                // Where the acceleration changes its sign.
                let t = -phase.start.accel / jerk;
                if t > 0.0 && t < phase.duration_s {
                    take(phase.at(t).speed);
                }
            }
        }
        extent
    }

    /// Speed in 1/min and acceleration in 1/min per s, `t` seconds after the
    /// command.
    #[must_use]
    pub fn at(&self, t: f64) -> Motion {
        let mut rest = t;
        for phase in &self.phases {
            if rest < phase.duration_s {
                return phase.at(rest);
            }
            rest -= phase.duration_s;
        }
        Motion {
            speed: self.end_rpm,
            accel: 0.0,
        }
    }

    /// The same at two instants, by the law that holds at the second.
    pub(super) fn at_both(&self, [t, inside]: [f64; 2]) -> [Motion; 2] {
        let mut start = 0.0;
        for phase in &self.phases {
            if inside < start + phase.duration_s {
                return [t, inside].map(|t| phase.at((t - start).max(0.0)));
            }
            start += phase.duration_s;
        }
        let speed = self.end_rpm;
        [Motion { speed, accel: 0.0 }; 2]
    }

    /// What holds the speed at the end, W.
    #[must_use]
    pub fn holding_w(&self) -> f64 {
        self.held_w(self.end_rpm)
    }

    /// What holds a speed in 1/min, W.
    pub(super) fn held_w(&self, speed: f64) -> f64 {
        self.power.electrical_w(Motion { speed, accel: 0.0 })
    }

    /// What the motor does between two instants, s after the command; `to_s` may
    /// be infinite, the energies are then those until the end of the ramp.
    #[must_use]
    pub fn over(&self, from_s: f64, to_s: f64) -> SpindleSpan {
        let mut span: Option<SpindleSpan> = None;
        let mut take = |part: &SpindleSpan| match &mut span {
            Some(span) => span.include(part),
            None => span = Some(*part),
        };
        let mut start = 0.0;
        for phase in &self.phases {
            let end = start + phase.duration_s;
            let [from, to] = [from_s, to_s].map(|t| (t - start).clamp(0.0, phase.duration_s));
            if start <= to_s && end >= from_s && to >= from {
                let part = if to - from >= phase.duration_s {
                    *phase
                } else {
                    phase.between(from, to)
                };
                let run = self.power.phase(&part, 0.0);
                take(&SpindleSpan {
                    largest_w: run.peak_w,
                    least_w: run.least_w,
                    energy_j: run.energy_j,
                    drawn_j: run.drawn_j,
                });
            }
            start = end;
        }
        if to_s >= self.duration_s {
            let held_s = to_s - from_s.max(self.duration_s);
            let held_s = if held_s.is_finite() {
                held_s.max(0.0)
            } else {
                0.0
            };
            take(&SpindleSpan::steady(self.holding_w(), held_s));
        }
        span.unwrap_or_else(|| SpindleSpan::steady(self.holding_w(), 0.0))
    }

    /// The instants after one and up to another at which the law of motion
    /// changes, and that one, s after the command.
    pub(super) fn ends(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = f64> {
        let inside = move |t: &f64| *t > from_s && *t < to_s;
        let last = (to_s > from_s).then_some(to_s);
        self.instants().filter(inside).chain(last)
    }

    /// The instants at which the law of motion changes, s after the command.
    pub(super) fn instants(&self) -> impl Iterator<Item = f64> {
        let mut end = 0.0;
        self.phases.iter().map(move |phase| {
            end += phase.duration_s;
            end
        })
    }
}
