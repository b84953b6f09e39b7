//! The interpolation-period planner: speed commands.
//!
//! Every period it decides again, from what the last period put out, which curve
//! of two or three phases leads to the target, and goes along it for one period.
//! A phase that ends inside the period ends there: holding its jerk to the end
//! of the period would overshoot.

use super::curve::{LimitError, positive};
use super::limits::Limits;
use super::phase::Motion;
use super::ramp::Ramp;

/// Share of a limit that rounding may add, and that is taken off again.
const ROUNDING: f64 = 1e-9;

/// What one period puts out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Step {
    /// Speed and acceleration at the end of the period.
    pub motion: Motion,
    /// Mean jerk over the period.
    pub jerk: f64,
    /// Way that the period goes.
    pub distance: f64,
    /// The target is reached and held.
    pub reached: bool,
    /// By how much the target is passed before the motion turns, because the
    /// acceleration cannot be taken to zero in time: after a limit shrank or
    /// the target moved. The smallest possible; 0 if it is not passed.
    pub overshoot: f64,
    /// By how much the acceleration exceeds its limit at the start or the end of
    /// the period, because the limit has shrunk; it is brought back at full jerk.
    pub excess: f64,
    /// The last speed that can be reached, where the target cannot be.
    pub out_of_reach: Option<f64>,
}

/// Plans one drive period by period.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedPlanner {
    motion: Motion,
}

impl SpeedPlanner {
    /// A planner that starts from a state of motion.
    ///
    /// # Errors
    /// Speed or acceleration is not finite.
    pub fn new(motion: Motion) -> Result<Self, LimitError> {
        finite(motion.speed, "the speed")?;
        finite(motion.accel, "the acceleration")?;
        Ok(Self { motion })
    }

    /// Speed and acceleration that the last period put out.
    #[must_use]
    pub fn motion(&self) -> Motion {
        self.motion
    }

    /// Plans one period of `period_s` towards `target`. Target, period and
    /// limits may be others at every call.
    ///
    /// # Errors
    /// The target is not finite, or the period not positive; nothing moves then.
    pub fn step(
        &mut self,
        target: f64,
        period_s: f64,
        limits: &Limits,
    ) -> Result<Step, LimitError> {
        finite(target, "the target")?;
        positive(period_s, "the period")?;
        let start = self.motion;
        let ramp = Ramp::new(start, target, &limits.for_period(period_s));
        let step = along(&ramp, start, target, period_s, limits);
        self.motion = step.motion;
        Ok(step)
    }
}

/// `value` if it is finite.
pub(super) fn finite(value: f64, name: &'static str) -> Result<f64, LimitError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(LimitError::NotFinite(name))
    }
}

/// The limit of the acceleration in the direction of `motion`'s.
fn limit_at(motion: Motion, limits: &Limits) -> f64 {
    limits.up(motion.speed * motion.accel.signum())
}

/// One period along a ramp.
fn along(ramp: &Ramp, start: Motion, target: f64, period_s: f64, limits: &Limits) -> Step {
    let (mut motion, distance) = ramp.at(period_s);
    inside(&mut motion, ramp, start, period_s, limits);
    let excess = |at: Motion| at.accel.abs() - limit_at(at, limits);
    let excess = excess(start).max(excess(motion)).max(0.0);
    let out_of_reach = (ramp.end_speed != target).then_some(ramp.end_speed);
    Step {
        motion,
        jerk: (motion.accel - start.accel) / period_s,
        distance,
        reached: motion.speed == target && motion.accel == 0.0,
        overshoot: ramp.overshoot,
        excess,
        out_of_reach,
    }
}

/// Takes back what rounding has added: a limit is a limit to the last digit.
pub(super) fn inside(
    motion: &mut Motion,
    ramp: &Ramp,
    start: Motion,
    period_s: f64,
    limits: &Limits,
) {
    let end = ramp.end_speed;
    // Nothing passes the target that can do without.
    if ramp.overshoot == 0.0 && (motion.speed - end) * (start.speed - end) < 0.0 {
        motion.speed = end;
    }
    let limit = limit_at(*motion, limits);
    if motion.accel.abs() <= limit * (1.0 + ROUNDING) {
        motion.accel = motion.accel.clamp(-limit, limit);
    }
    let most = limits.jerk.largest();
    for _ in 0..4 {
        let jerk = (motion.accel - start.accel) / period_s;
        if jerk > most {
            motion.accel = motion.accel.next_down();
        } else if jerk < -most {
            motion.accel = motion.accel.next_up();
        } else {
            break;
        }
    }
}
