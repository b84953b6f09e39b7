//! One drive of several: its command, its limits and its state of motion.

use super::schedule::{DriveCommand, DriveId};
use crate::machine::Machine;
use crate::plan::SpindleDrive;
use crate::plan::period::{Curve, Jerk, LimitError, Limits, Motion, PositionPlanner, SpeedPlanner};
use crate::power::DriveLaw;

/// Shares of the largest speed and acceleration below which a drive does not get on.
const NEXT_TO_NOTHING: f64 = 1e-6;

/// The share of its acceleration that a drive has which has no power to accelerate with: none,
/// for a planner that needs some.
const NOTHING: f64 = 1e-12;

/// What a drive is to do.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Command {
    /// Nothing yet.
    Stand,
    /// Hold a speed.
    Speed(f64),
    /// Go to a position.
    Position {
        /// The position.
        target: f64,
        /// The largest speed on the way.
        most: f64,
    },
}

/// What comes out of one period.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Moved {
    /// Mean jerk.
    pub(super) jerk: f64,
    /// The command is carried out.
    pub(super) reached: bool,
    /// By how much its target is passed.
    pub(super) overshoot: f64,
}

/// A drive.
#[derive(Debug)]
pub(super) struct Drive {
    pub(super) id: DriveId,
    /// Index of its converter.
    pub(super) converter: usize,
    pub(super) law: DriveLaw,
    own: Limits,
    largest_speed: f64,
    /// Limits under which it runs, without its share of the power.
    limits: Limits,
    /// The most power that the schedule leaves it, W.
    pub(super) most_w: f64,
    command: Command,
    /// Position in mm or degrees; revolutions count nothing.
    pub(super) position: f64,
    pub(super) motion: Motion,
}

impl Drive {
    /// A drive of the machine at rest at 0.
    ///
    /// # Errors
    /// Numbers that are too large or too small to compute with.
    pub(super) fn new(machine: &Machine, id: DriveId) -> Result<Option<Self>, LimitError> {
        let found = match id {
            DriveId::Spindle => machine.spindle.as_ref().map(|spindle| {
                let own = SpindleDrive::new(spindle)?.limits().clone();
                let law = DriveLaw::of_spindle(spindle);
                Ok((law, own, spindle.max_rpm, spindle.converter))
            }),
            DriveId::Axis(axis) => machine.axes[axis].as_ref().map(|data| {
                let mut curves = machine.force_curves.iter();
                let curve = curves.find(|(of, _)| *of as usize == axis);
                let curve = curve.map_or(&[][..], |(_, points)| points.as_slice());
                let own = DriveLaw::limits_of_axis(data, curve)?;
                let mut converters = machine.converters.iter();
                let converter = converters.position(|it| it.axes.contains(axis));
                let law = DriveLaw::of_axis(data);
                Ok((law, own, data.rapid_mm_s, converter.unwrap_or(0)))
            }),
        };
        let Some((law, own, largest_speed, converter)) = found.transpose()? else {
            return Ok(None);
        };
        Ok(Some(Self {
            id,
            converter,
            law,
            limits: own.clone(),
            own,
            largest_speed,
            most_w: f64::INFINITY,
            command: Command::Stand,
            position: 0.0,
            motion: Motion::default(),
        }))
    }

    /// Takes a row of the schedule: its command, or the one before under other limits.
    ///
    /// # Errors
    /// A limit with which nothing can be computed.
    pub(super) fn take(&mut self, row: &DriveCommand) -> Result<(), LimitError> {
        let mut limits = self.own.clone();
        if let Some(accel) = row.accel {
            let cap = Curve::constant(accel)?;
            limits.drive = limits.drive.lowest(&cap);
            limits.brake = limits.brake.lowest(&cap);
        }
        if let Some(jerk) = row.jerk {
            limits.jerk = limits.jerk.lowest(&Jerk::constant(jerk)?);
        }
        self.limits = limits;
        self.most_w = row.power_w.unwrap_or(f64::INFINITY);
        self.command = match (row.position, row.speed, self.command) {
            (Some(target), speed, _) => Command::Position {
                target,
                most: speed.unwrap_or(self.largest_speed),
            },
            (None, Some(speed), _) => Command::Speed(speed),
            (None, None, last) => last,
        };
        Ok(())
    }

    /// What it cannot do without, W.
    pub(super) fn committed_w(&self) -> f64 {
        let jerk = self.limits.jerk.smallest();
        self.law.committed_w(self.motion, jerk)
    }

    /// What it would take if it had the supply for itself, W.
    pub(super) fn wanted_w(&self) -> f64 {
        let speed = match self.command {
            Command::Stand => return self.law.standing_w(),
            Command::Speed(speed) => speed,
            Command::Position { target, .. } if self.stands_at(target) => {
                return self.law.standing_w();
            }
            Command::Position { target, most } => most.copysign(target - self.position),
        };
        let holds = self.motion.speed == speed && self.motion.accel == 0.0;
        if holds {
            return self.committed_w();
        }
        let wanted = self.law.wanted_w(self.motion, speed, &self.limits.drive);
        wanted.min(self.most_w).max(self.committed_w())
    }

    fn stands_at(&self, target: f64) -> bool {
        self.position == target && self.motion == Motion::default()
    }

    /// Moves for a period with a share of the power, W. Where that leaves nothing to start
    /// with, it stays.
    ///
    /// # Errors
    /// Numbers that are too large or too small to compute with.
    pub(super) fn step(&mut self, share_w: f64, period_s: f64) -> Result<Moved, LimitError> {
        let drive = match self.law.within(&self.limits.drive, share_w) {
            Ok(drive) => drive,
            Err(_) if self.motion == Motion::default() => return Ok(self.waits()),
            // It goes on as it is, or brakes.
            Err(_) => Curve::constant(self.limits.drive.at(0.0) * NOTHING)?,
        };
        let limits = Limits {
            drive,
            ..self.limits.clone()
        };
        match self.command {
            Command::Stand => Ok(Moved {
                reached: true,
                ..Moved::default()
            }),
            Command::Position { target, most } => {
                let mut planner = PositionPlanner::new(self.position, self.motion)?;
                let step = planner.step(target, most, period_s, &limits)?;
                (self.position, self.motion) = (step.position, step.motion);
                Ok(Moved {
                    jerk: step.jerk,
                    reached: step.reached,
                    overshoot: step.overshoot,
                })
            }
            Command::Speed(target) => {
                let mut planner = SpeedPlanner::new(self.motion)?;
                let step = planner.step(target, period_s, &limits)?;
                self.position += step.distance;
                self.motion = step.motion;
                Ok(Moved {
                    jerk: step.jerk,
                    reached: step.reached,
                    overshoot: step.overshoot,
                })
            }
        }
    }

    /// Whether it moves towards its position, or its speed changes worth mentioning.
    pub(super) fn is_on_its_way(&self) -> bool {
        let travels = matches!(self.command, Command::Position { .. })
            && self.motion.speed.abs() > NEXT_TO_NOTHING * self.largest_speed;
        travels || self.motion.accel.abs() > NEXT_TO_NOTHING * self.limits.drive.at(0.0)
    }

    fn waits(&self) -> Moved {
        let reached = match self.command {
            Command::Stand => true,
            Command::Speed(speed) => speed == 0.0,
            Command::Position { target, .. } => self.position == target,
        };
        Moved {
            reached,
            ..Moved::default()
        }
    }
}
