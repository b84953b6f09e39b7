//! Where the spindle is while the program goes on: steady, on a run of which
//! the curve is known, or somewhere on its way.
//!
//! Input: speeds that are asked for, and the time that passes, from at least to
//! at most. Output: a [`Window`] of power for any span of time.
//!
//! While a run is known and so is the time since its command, its power is exact.
//! Else the bound covers all that may happen: a time that is known in part moves
//! the window over the run; a speed that is not known between two limits counts
//! with full torque, up and down, over all speeds between them and the target.

use super::spindle::SpindlePower;
use super::spindle_trace::{SpindleSpan, SpindleTrace};
use gwatt_machine::Spindle;
use gwatt_plan::SpindleDrive;
use gwatt_plan::period::{Jerk, LimitError, Limits, Motion, Ramp};

/// A spindle's limits and coefficients.
#[derive(Debug, Clone)]
pub(super) struct SpindleMotor {
    pub power: SpindlePower,
    pub limits: Limits,
    /// The same limits without that of the jerk.
    hard: Limits,
}

impl SpindleMotor {
    pub fn new(spindle: &Spindle) -> Result<Self, LimitError> {
        let limits = SpindleDrive::new(spindle)?.limits().clone();
        let hard = Limits {
            jerk: Jerk::constant(f64::INFINITY)?,
            ..limits.clone()
        };
        Ok(Self {
            power: SpindlePower::motor(spindle),
            limits,
            hard,
        })
    }

    pub fn holding_w(&self, speed: f64) -> f64 {
        self.power.electrical_w(Motion { speed, accel: 0.0 })
    }

    pub fn trace(&self, start: Motion, target: f64) -> SpindleTrace {
        let ramp = Ramp::new(start, target, &self.limits);
        SpindleTrace::new(self.power, start, ramp)
    }

    /// Largest and smallest power at any speed between two, at any acceleration
    /// that the drive has.
    pub fn extremes(&self, low: f64, high: f64) -> [f64; 2] {
        let mut found = [self.holding_w(low), self.holding_w(high)];
        found.sort_by(f64::total_cmp);
        let [mut least, mut largest] = found;
        for (from, to) in [(low, high), (high, low)] {
            let start = Motion {
                speed: from,
                accel: 0.0,
            };
            let ramp = Ramp::new(start, to, &self.hard);
            let span = SpindleTrace::new(self.power, start, ramp).over(0.0, f64::INFINITY);
            largest = largest.max(span.largest_w);
            least = least.min(span.least_w);
        }
        [largest, least]
    }

    /// How long it takes at most from any speed between two, at any
    /// acceleration, to the target.
    fn longest_s(&self, low: f64, high: f64, target: f64) -> f64 {
        let mut longest = 0.0_f64;
        for (speed, sign) in [(low, -1.0), (high, 1.0)] {
            let accel = if self.limits.jerk.is_unlimited() {
                0.0
            } else {
                sign * self.limits.drive.at(speed).max(self.limits.brake.at(speed))
            };
            for accel in [0.0, accel] {
                let ramp = Ramp::new(Motion { speed, accel }, target, &self.limits);
                longest = longest.max(ramp.duration_s());
            }
        }
        longest
    }
}

/// Power over a span of time, without base load and cutting.
#[derive(Debug)]
pub(super) enum Window<'a> {
    /// Constant, W.
    Steady(f64),
    /// This run, from so many seconds after its command.
    Run(&'a SpindleTrace, f64),
    /// Between these two, W: largest and smallest.
    Between([f64; 2]),
}

#[derive(Debug)]
enum Course {
    Steady(f64),
    /// The time since the command, at least and at most, s.
    Run(Box<SpindleTrace>, [f64; 2]),
    /// Somewhere between two speeds on the way to a third, for so many seconds
    /// more at most; `None`: forever, nothing is known of the target.
    Somewhere {
        range: [f64; 2],
        target: f64,
        left_s: Option<f64>,
        /// Largest and smallest power there, W.
        extremes: [f64; 2],
    },
}

/// The spindle at one setting of the overrides; speeds in 1/min, signed.
#[derive(Debug)]
pub(super) struct SpindleState {
    course: Course,
}

impl SpindleState {
    /// At a steady speed.
    pub fn steady(speed: f64) -> Self {
        Self {
            course: Course::Steady(speed),
        }
    }

    /// At any speed between two.
    pub fn anywhere(motor: &SpindleMotor, low: f64, high: f64) -> Self {
        Self {
            course: Course::Somewhere {
                range: [low, high],
                target: high,
                left_s: None,
                extremes: motor.extremes(low, high),
            },
        }
    }

    /// The speed that is being reached, 1/min.
    pub fn target(&self) -> f64 {
        match &self.course {
            Course::Steady(speed) => *speed,
            Course::Run(trace, _) => trace.speeds_rpm()[1],
            Course::Somewhere { target, .. } => *target,
        }
    }

    pub fn is_steady(&self) -> bool {
        matches!(self.course, Course::Steady(_))
    }

    /// The speeds that it may have now or later.
    pub fn range(&self) -> [f64; 2] {
        let mut range = match &self.course {
            Course::Steady(speed) => [*speed; 2],
            Course::Run(trace, _) => trace.extent_rpm(),
            Course::Somewhere { range, target, .. } => {
                [range[0].min(*target), range[1].max(*target)]
            }
        };
        range.sort_by(f64::total_cmp);
        range
    }

    /// A new speed is asked for.
    pub fn command(&mut self, motor: &SpindleMotor, target: f64) {
        let start = match &self.course {
            Course::Steady(speed) if *speed == target => return,
            Course::Steady(speed) => Some(Motion {
                speed: *speed,
                accel: 0.0,
            }),
            Course::Run(trace, [least, most]) if least == most => Some(trace.at(*least)),
            // On its way there already.
            Course::Somewhere {
                target: asked,
                left_s: Some(_),
                ..
            } if *asked == target => return,
            _ => None,
        };
        match start {
            Some(start) => {
                let trace = motor.trace(start, target);
                self.course = Course::Run(Box::new(trace), [0.0; 2]);
            }
            None => self.wander(motor, self.range(), target),
        }
    }

    /// Somewhere between two speeds, and on the way to a target.
    pub fn wander(&mut self, motor: &SpindleMotor, range: [f64; 2], target: f64) {
        let own = self.range();
        let range = [
            own[0].min(range[0]).min(target),
            own[1].max(range[1]).max(target),
        ];
        self.course = Course::Somewhere {
            range,
            target,
            left_s: Some(motor.longest_s(range[0], range[1], target)),
            extremes: motor.extremes(range[0], range[1]),
        };
    }

    /// When its run began is not known any more: any of it may come as long as it lasts.
    pub fn blur(&mut self) {
        if let Course::Run(trace, _) = &self.course {
            let span = trace.over(0.0, f64::INFINITY);
            self.course = Course::Somewhere {
                range: self.range(),
                target: self.target(),
                left_s: Some(trace.duration_s()),
                extremes: [span.largest_w, span.least_w],
            };
        }
    }

    /// It may stop of itself, or turn on: until the next command nothing more
    /// is known.
    pub fn lose(&mut self, motor: &SpindleMotor) {
        let [low, high] = self.range();
        let target = self.target();
        if [low, high] != [0.0; 2] {
            let range = [low.min(0.0), high.max(0.0)];
            self.course = Course::Somewhere {
                range,
                target,
                left_s: None,
                extremes: motor.extremes(range[0], range[1]),
            };
        }
    }

    /// It has reached its target.
    pub fn settle(&mut self) {
        self.course = Course::Steady(self.target());
    }

    /// It has got a speed as it was to.
    pub fn follow(&mut self, speed: f64) {
        self.course = Course::Steady(speed);
    }

    /// Time passes, s: at least and at most.
    pub fn pass(&mut self, [least, most]: [f64; 2]) {
        match &mut self.course {
            Course::Steady(_) => {}
            Course::Run(trace, since) => {
                *since = [since[0] + least, since[1] + most];
                if since[0] >= trace.duration_s() {
                    self.settle();
                }
            }
            Course::Somewhere { left_s, .. } => {
                if let Some(left) = left_s {
                    *left -= least;
                    if *left <= 0.0 {
                        self.settle();
                    }
                }
            }
        }
    }

    /// How long it is until it surely has its speed, s.
    pub fn left_s(&self) -> f64 {
        match &self.course {
            Course::Steady(_) => 0.0,
            Course::Run(trace, since) => (trace.duration_s() - since[0]).max(0.0),
            Course::Somewhere { left_s, .. } => left_s.unwrap_or(0.0),
        }
    }

    /// What it may draw in the next `duration_s`.
    pub fn window(&self, motor: &SpindleMotor, duration_s: f64) -> Window<'_> {
        match &self.course {
            Course::Steady(speed) => Window::Steady(motor.holding_w(*speed)),
            Course::Run(trace, [least, most]) if least == most => Window::Run(trace, *least),
            Course::Run(trace, [least, most]) => {
                let span = trace.over(*least, *most + duration_s);
                Window::Between([span.largest_w, span.least_w])
            }
            Course::Somewhere { extremes, .. } => Window::Between(*extremes),
        }
    }

    /// Largest and smallest power from now on.
    pub fn henceforth(&self, motor: &SpindleMotor) -> [f64; 2] {
        match self.window(motor, f64::INFINITY) {
            Window::Steady(power_w) => [power_w; 2],
            Window::Run(trace, from) => {
                let span = trace.over(from, f64::INFINITY);
                [span.largest_w, span.least_w]
            }
            Window::Between(extremes) => extremes,
        }
    }

    /// What it does in the next `duration_s`, as far as that is known.
    pub fn span(&self, motor: &SpindleMotor, duration_s: f64) -> SpindleSpan {
        match &self.course {
            Course::Run(trace, [from, _]) => trace.over(*from, from + duration_s),
            _ => SpindleSpan::steady(motor.holding_w(self.target()), duration_s),
        }
    }

    /// The run that it is on, and the time since its command, at least and at most, s.
    pub fn on_run(&self) -> Option<(&SpindleTrace, [f64; 2])> {
        match &self.course {
            Course::Run(trace, since_s) => Some((trace, *since_s)),
            _ => None,
        }
    }

    /// The run that it is on, and the shortest time since its command, s.
    pub fn run(&self) -> Option<(&SpindleTrace, f64)> {
        self.on_run().map(|(trace, [since_s, _])| (trace, since_s))
    }

    /// The start and the target of the run that it is on, 1/min.
    pub fn run_rpm(&self) -> Option<[f64; 2]> {
        self.run().map(|(trace, _)| trace.speeds_rpm())
    }
}
