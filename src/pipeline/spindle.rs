//! A spindle through its schedule, period by period.

use std::io;

use super::Failure;
use super::schedule::{Command, Schedule};
use crate::diagnostic::Diagnostic;
use crate::plan::SpindleDrive;
use crate::plan::period::{LimitError, Limits, Motion, Ramp, SpeedPlanner, Step};
use crate::power::{SpindlePower, SpindleRun};
use crate::source::Span;

/// Periods that one run may have.
const PERIODS_MAX: u64 = 50_000_000;
/// Share of a period by which a row may come early: rounding of times.
const EARLY: f64 = 1e-6;
/// Overshoots and excesses below this share of the speed or the acceleration
/// are not worth a warning.
const WORTH_TELLING: f64 = 1e-9;

/// The spindle at the end of a period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The time in s.
    pub time_s: f64,
    /// The speed that is asked for, in 1/min.
    pub target_rpm: f64,
    /// Speed in 1/min and acceleration in 1/min per s.
    pub motion: Motion,
    /// Mean jerk over the period in 1/min per s².
    pub jerk_rpm_s2: f64,
    /// Torque of the motor in N·m.
    pub torque_nm: f64,
    /// Electrical power in W; negative where it is fed back.
    pub power_w: f64,
}

/// What a row of the schedule comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Line number in the schedule.
    pub line: u64,
    /// The speed at which it begins, in 1/min.
    pub from_rpm: f64,
    /// The speed that is asked for.
    pub target_rpm: f64,
    /// Time to the target in s; `None` where the next row comes before.
    pub reached_s: Option<f64>,
    /// Largest power drawn in W.
    pub peak_w: f64,
    /// Largest power fed back in W; positive.
    pub regen_w: f64,
    /// Energy in J, what is fed back taken off.
    pub energy_j: f64,
}

/// What a schedule comes to. Powers and energies are exact, not those of the
/// samples.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpindleSummary {
    /// Its rows.
    pub changes: Vec<Change>,
    /// How long it lasts in s, up to the last target.
    pub duration_s: f64,
    /// Largest power drawn in W.
    pub peak_w: f64,
    /// Largest power fed back in W; positive.
    pub regen_w: f64,
    /// Energy in J, what is fed back taken off.
    pub energy_j: f64,
    /// Warnings.
    pub notes: Vec<Diagnostic>,
}

/// Runs a spindle from rest through a schedule, a sample a period, the first at
/// the time of the first row. A row takes effect with the first period that
/// begins at its time or later; after the last one it runs until the target.
///
/// # Errors
/// A limit with which nothing can be computed, more periods than a run may have,
/// or what `sink` returns.
pub fn run_schedule(
    schedule: &Schedule,
    drive: &SpindleDrive,
    power: &SpindlePower,
    period_s: f64,
    sink: &mut dyn FnMut(&Sample) -> io::Result<()>,
) -> Result<SpindleSummary, Failure> {
    let mut run = Run {
        power,
        planner: SpeedPlanner::default(),
        time_s: schedule.commands.first().map_or(0.0, |first| first.time_s),
        period_s,
        periods: 0,
        sink,
        summary: SpindleSummary::default(),
    };
    let start_s = run.time_s;
    if let Some(first) = schedule.commands.first() {
        run.sample(first.target_rpm, 0.0)?;
    }
    let mut next = schedule.commands.iter().skip(1);
    for command in &schedule.commands {
        let limits = drive.capped(&command.caps).map_err(|e| unfit(command, e))?;
        let until = next.next().map(|next| next.time_s);
        run.command(command, &limits, until)?;
    }
    run.summary.duration_s = run.time_s - start_s;
    Ok(run.summary)
}

struct Run<'a> {
    power: &'a SpindlePower,
    planner: SpeedPlanner,
    time_s: f64,
    period_s: f64,
    periods: u64,
    sink: &'a mut dyn FnMut(&Sample) -> io::Result<()>,
    summary: SpindleSummary,
}

impl Run<'_> {
    /// One row, until the next one's time or the target.
    fn command(
        &mut self,
        command: &Command,
        limits: &Limits,
        until_s: Option<f64>,
    ) -> Result<(), Failure> {
        let target = command.target_rpm;
        self.period_s = command.period_s.unwrap_or(self.period_s);
        let (start_s, start) = (self.time_s, self.planner.motion());
        let ramp = Ramp::new(start, target, limits);
        let lasts_s = until_s.map_or_else(|| ramp.duration_s(), |until| until - start_s);
        if self.periods as f64 + lasts_s / self.period_s > PERIODS_MAX as f64 {
            return Err(too_many(command));
        }
        let mut reached_s = None;
        let mut count = 0_u32;
        let mut announced = false;
        loop {
            // Not summed up: the rounding of a million sums would show.
            let now_s = start_s + f64::from(count) * self.period_s;
            let waits = until_s.is_some_and(|until| now_s < until - EARLY * self.period_s);
            if !waits && (until_s.is_some() || reached_s.is_some()) {
                break;
            }
            self.periods += 1;
            if self.periods > PERIODS_MAX || count == u32::MAX {
                return Err(too_many(command));
            }
            let step = self
                .planner
                .step(target, self.period_s, limits)
                .map_err(|error| unfit(command, error))?;
            if let Some(last) = step.out_of_reach {
                return Err(out_of_reach(command, last));
            }
            count += 1;
            self.time_s = start_s + f64::from(count) * self.period_s;
            if step.reached && reached_s.is_none() {
                reached_s = Some(self.time_s - start_s);
            }
            if !announced {
                announced = self.announce(command, &step, limits);
            }
            self.sample(target, step.jerk)?;
        }
        let spent_s = self.time_s - start_s;
        let done = self.power.phases(&ramp.cut(spent_s));
        self.sum_up(command, start.speed, reached_s, &done, spent_s);
        Ok(())
    }

    fn sample(&mut self, target_rpm: f64, jerk_rpm_s2: f64) -> Result<(), Failure> {
        let motion = self.planner.motion();
        let sample = Sample {
            time_s: self.time_s,
            target_rpm,
            motion,
            jerk_rpm_s2,
            torque_nm: self.power.torque_nm(motion),
            power_w: self.power.electrical_w(motion),
        };
        (self.sink)(&sample).map_err(Failure::Output)
    }

    fn sum_up(
        &mut self,
        command: &Command,
        from_rpm: f64,
        reached_s: Option<f64>,
        done: &SpindleRun,
        spent_s: f64,
    ) {
        let held_s = (spent_s - done.duration_s).max(0.0);
        let hold = Motion {
            speed: command.target_rpm,
            accel: 0.0,
        };
        let hold_w = self.power.electrical_w(hold);
        let mut change = Change {
            line: command.line,
            from_rpm,
            target_rpm: command.target_rpm,
            reached_s,
            peak_w: done.peak_w,
            regen_w: done.regen_w,
            energy_j: done.energy_j + held_s * hold_w,
        };
        if held_s > 0.0 {
            change.peak_w = change.peak_w.max(hold_w);
        }
        let summary = &mut self.summary;
        summary.peak_w = summary.peak_w.max(change.peak_w);
        summary.regen_w = summary.regen_w.max(change.regen_w);
        summary.energy_j += change.energy_j;
        summary.changes.push(change);
    }

    /// Warns of what cannot be helped; true when it has.
    fn announce(&mut self, command: &Command, step: &Step, limits: &Limits) -> bool {
        let worth = |value: f64, of: f64| value > WORTH_TELLING * of.abs().max(1.0);
        let most = limits.drive.at(0.0);
        let message = if worth(step.overshoot, command.target_rpm) {
            format!(
                "the speed passes {} 1/min by {:.1} 1/min before it turns: the acceleration cannot be taken back sooner",
                command.target_rpm, step.overshoot
            )
        } else if worth(step.excess, most) {
            format!(
                "the acceleration is {:.1} 1/min per s above the limit, which has shrunk; it is brought back at full jerk",
                step.excess
            )
        } else {
            return false;
        };
        let note = Diagnostic::warning("spindle-limit", message);
        let note = note.at(
            command.line,
            Span::new(0, command.text.len()),
            &command.text,
        );
        self.summary.notes.push(note);
        true
    }
}

fn refused(command: &Command, diagnostic: Diagnostic) -> Failure {
    let span = Span::new(0, command.text.len());
    Failure::Refused {
        diagnostics: vec![diagnostic.at(command.line, span, &command.text)],
        more: 0,
    }
}

fn unfit(command: &Command, error: LimitError) -> Failure {
    refused(
        command,
        Diagnostic::error("spindle-limit", error.to_string()),
    )
}

fn out_of_reach(command: &Command, last_rpm: f64) -> Failure {
    let message = format!(
        "the spindle does not reach {} 1/min: beyond {last_rpm:.0} 1/min no torque is left",
        command.target_rpm
    );
    refused(command, Diagnostic::error("spindle-limit", message))
}

fn too_many(command: &Command) -> Failure {
    let message = format!("the schedule takes more than {PERIODS_MAX} periods");
    let error = Diagnostic::error("spindle-periods", message);
    refused(
        command,
        error.help("a longer --period-ms, or larger limits"),
    )
}
