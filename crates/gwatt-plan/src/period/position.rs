//! The interpolation-period planner: position commands.

use super::cell::bisect;
use super::curve::{LimitError, positive};
use super::limits::Limits;
use super::phase::{Motion, RampPhase};
use super::planner::{finite, inside};
use super::ramp::Ramp;

/// Share of the ways in play that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// What one period of a position command puts out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PositionStep {
    /// Position at the end of the period.
    pub position: f64,
    /// Speed and acceleration there.
    pub motion: Motion,
    /// Mean jerk over the period.
    pub jerk: f64,
    /// The target is reached and held.
    pub reached: bool,
    /// By how much the target is passed before the motion turns, because it
    /// cannot be stopped in time; 0 if it is not passed.
    pub overshoot: f64,
}

/// Plans one drive period by period to a position, with a largest speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PositionPlanner {
    position: f64,
    motion: Motion,
}

impl PositionPlanner {
    /// A planner that starts from a position and a state of motion.
    ///
    /// # Errors
    /// A value is not finite.
    pub fn new(position: f64, motion: Motion) -> Result<Self, LimitError> {
        finite(position, "the position")?;
        finite(motion.speed, "the speed")?;
        finite(motion.accel, "the acceleration")?;
        Ok(Self { position, motion })
    }

    /// Position, speed and acceleration that the last period put out.
    #[must_use]
    pub fn state(&self) -> (f64, Motion) {
        (self.position, self.motion)
    }

    /// Plans one period towards the position `target`: as fast as `max_speed`
    /// and the limits allow for as long as it can still be stopped there, then
    /// the stop. Everything may be another at every call.
    ///
    /// # Errors
    /// The target is not finite, or period or speed are not positive; nothing
    /// moves then.
    pub fn step(
        &mut self,
        target: f64,
        max_speed: f64,
        period_s: f64,
        limits: &Limits,
    ) -> Result<PositionStep, LimitError> {
        finite(target, "the target")?;
        positive(max_speed, "the largest speed")?;
        positive(period_s, "the period")?;
        let planned = &limits.for_period(period_s);
        let (start, gap) = (self.motion, target - self.position);
        let stop = Ramp::new(start, 0.0, planned);
        let way = stop.distance();
        let near = ROUNDING * (self.position.abs() + target.abs() + way.abs());
        let missing = gap - way;
        let (ramp, mut motion, distance, passing) = if missing.abs() <= near {
            let (motion, distance) = stop.at(period_s);
            let passing = passed(&stop.phases, gap);
            (stop, motion, distance, passing)
        } else {
            let side = missing.signum();
            let run = Ramp::new(start, side * max_speed, planned);
            // Whether it can still be stopped after running on for s seconds.
            let too_long = |s: f64| {
                let (motion, distance) = run.at(s);
                let stop = Ramp::new(motion, 0.0, planned);
                side * (gap - distance - stop.distance()) < 0.0
            };
            let last = |from: f64, to: f64| {
                if too_long(to) {
                    bisect(from, to, too_long).next_down().max(from)
                } else {
                    to
                }
            };
            let runs = last(0.0, period_s);
            let (motion, ran) = run.at(runs);
            let stop = Ramp::new(motion, 0.0, planned);
            // Without a limit of jerk the stop begins with another acceleration.
            let (motion, stopped) = if runs < period_s {
                stop.at(period_s - runs)
            } else {
                (motion, 0.0)
            };
            // The whole way to the rest, where it may turn after the target.
            let mut passing = 0.0;
            let brakes = start.speed * start.accel < 0.0 || side * start.speed < 0.0;
            if runs < period_s || brakes {
                let until = if runs < period_s {
                    runs
                } else {
                    last(period_s, run.duration_s().max(period_s))
                };
                let mut phases = run.cut(until);
                phases.extend(Ramp::new(run.at(until).0, 0.0, planned).phases);
                passing = passed(&phases, gap);
            }
            let ramp = if runs < period_s { stop } else { run };
            (ramp, motion, ran + stopped, passing)
        };
        let overshoot = if passing > 4.0 * near { passing } else { 0.0 };
        inside(&mut motion, &ramp, start, period_s, limits);
        let mut position = self.position + distance;
        let at_rest = motion == Motion::default();
        if at_rest && (target - position).abs() <= 4.0 * near + f64::MIN_POSITIVE {
            position = target;
        }
        // What rounding would carry over the target stays at it.
        if overshoot == 0.0
            && (target - position) * gap < 0.0
            && (target - position).abs() <= 4.0 * near
        {
            position = target;
        }
        self.position = position;
        self.motion = motion;
        Ok(PositionStep {
            position,
            motion,
            jerk: (motion.accel - start.accel) / period_s,
            reached: at_rest && position == target,
            overshoot,
        })
    }
}

/// How far beyond the end of a way `gap` phases turn; 0 if they do not.
fn passed(phases: &[RampPhase], gap: f64) -> f64 {
    let (mut distance, mut most) = (0.0, 0.0_f64);
    // At the target, any way from it passes it.
    let first = phases.first().map_or(0.0, |phase| phase.start.speed);
    let side = if gap == 0.0 { first } else { gap }.signum();
    for phase in phases {
        distance += phase.distance(phase.duration_s);
        // The limits change at rest, so every turn is the end of a phase.
        if phase.end.speed == 0.0 && phase.start.speed * side > 0.0 {
            most = most.max((distance - gap) * side);
        }
    }
    most
}
