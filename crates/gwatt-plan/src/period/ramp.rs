//! The fastest curve from a speed and an acceleration to a target speed.

use super::climb::{Climb, rounding};
use super::limits::Limits;
use super::phase::{Law, Motion, RampPhase};

/// The fastest curve from a state of motion to a rest at a target speed, under
/// limits that depend on the speed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ramp {
    /// Its phases in order of time.
    pub phases: Vec<RampPhase>,
    /// The speed at which it ends: the target, or the last that can be reached.
    pub end_speed: f64,
    /// By how much the speed passes the target before it turns; 0 if it does
    /// not. It is the smallest that the jerk limit allows.
    pub overshoot: f64,
}

impl Ramp {
    /// Plans it.
    ///
    /// The decision is made on signed quantities: taking the present
    /// acceleration to zero at full jerk changes `a²/2` by the integral of the
    /// jerk over the speed. If that ends below the target the curve goes up,
    /// if above, down. A start outside the limits is brought inside first.
    #[must_use]
    pub fn new(start: Motion, target: f64, limits: &Limits) -> Self {
        let Motion { speed, accel } = start;
        let side = if limits.jerk.is_unlimited() {
            target - speed
        } else {
            let missing = limits.jerk.integral(speed, target) - 0.5 * accel * accel.abs();
            let near = rounding(limits.jerk.largest(), speed, target, accel * accel);
            if missing.abs() > near {
                missing
            } else if accel != 0.0 {
                accel
            } else {
                target - speed
            }
        };
        if side == 0.0 {
            return Self {
                end_speed: target,
                ..Self::default()
            };
        }
        // Below a target everything is as it is above, with the signs turned.
        let sign = if side > 0.0 { 1.0 } else { -1.0 };
        let turned = Motion {
            speed: sign * speed,
            accel: sign * accel,
        };
        let climb = Climb::new(turned, sign * target, limits);
        let passed = sign * target - climb.lowest;
        let overshoot = if turned.speed >= sign * target && passed > 0.0 {
            passed
        } else {
            0.0
        };
        let mut phases = climb.phases;
        if sign < 0.0 {
            phases.iter_mut().for_each(turn);
        }
        Self {
            phases,
            end_speed: sign * climb.top,
            overshoot,
        }
    }

    /// How long it lasts in s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.phases.iter().map(|phase| phase.duration_s).sum()
    }

    /// Speed, acceleration and distance `t` seconds after the start; after the
    /// end it goes on at the end's speed.
    #[must_use]
    pub fn at(&self, t: f64) -> (Motion, f64) {
        let (mut rest, mut distance) = (t, 0.0);
        for phase in &self.phases {
            if rest < phase.duration_s {
                return (phase.at(rest), distance + phase.distance(rest));
            }
            distance += phase.distance(phase.duration_s);
            rest -= phase.duration_s;
        }
        let end = Motion {
            speed: self.end_speed,
            accel: 0.0,
        };
        (end, distance + self.end_speed * rest)
    }

    /// Its phases up to `t` seconds after the start, the last one cut.
    #[must_use]
    pub fn cut(&self, t: f64) -> Vec<RampPhase> {
        let mut rest = t;
        let mut phases = Vec::with_capacity(self.phases.len());
        for phase in &self.phases {
            if rest <= 0.0 {
                break;
            }
            let mut phase = *phase;
            if rest < phase.duration_s {
                phase.end = phase.at(rest);
                phase.duration_s = rest;
            }
            rest -= phase.duration_s;
            phases.push(phase);
        }
        phases
    }

    /// How far it goes until its end.
    #[must_use]
    pub fn distance(&self) -> f64 {
        let phases = self.phases.iter();
        phases.map(|phase| phase.distance(phase.duration_s)).sum()
    }
}

/// The same phase in the other direction.
fn turn(phase: &mut RampPhase) {
    let turned = |motion: Motion| Motion {
        speed: -motion.speed,
        accel: -motion.accel,
    };
    phase.start = turned(phase.start);
    phase.end = turned(phase.end);
    phase.law = match phase.law {
        Law::Jerk(jerk) => Law::Jerk(-jerk),
        Law::Curve(piece, direction) => Law::Curve(piece, -direction),
    };
}
