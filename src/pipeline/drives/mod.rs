//! Several drives on one supply, planned together in interpolation periods.
//!
//! Every period each drive plans again from what it put out last: with its own limits, and with
//! what its [share](share) of the supply leaves it to accelerate with. Braking takes no power and
//! is as hard as the drive's own limits; nothing that is fed back is credited.

mod column;
mod drive;
mod schedule;
mod share;

use std::io;

use self::drive::Drive;
use super::Failure;
use crate::diagnostic::Diagnostic;
use crate::machine::{AXES, Machine};
use crate::plan::period::{LimitError, Motion};
use crate::power::PowerModel;
use crate::source::Span;

pub use schedule::{DriveCommand, DriveId, DriveSchedule, For};

/// Periods that one run may have.
const PERIODS_MAX: u64 = 20_000_000;
/// Share of a period by which a row may come early: rounding of times.
const EARLY: f64 = 1e-6;
/// How long nothing comes nearer to its target before a command counts as one that cannot be
/// carried out, s.
const STUCK_S: f64 = 1.0;
/// By what share the power may be above the limit from rounding.
const FIT: f64 = 1e-9;
/// An overshoot below this share of the way is not worth a warning.
const WORTH_A_WARNING: f64 = 1e-9;

/// One drive at the end of a period. Positions in mm or degrees, speeds in mm/s, degrees/s or
/// 1/min.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveSample {
    /// Which.
    pub id: DriveId,
    /// Where an axis is; the revolutions of a spindle are not counted.
    pub position: f64,
    /// Its speed and acceleration.
    pub motion: Motion,
    /// Mean jerk over the period.
    pub jerk: f64,
    /// The largest power that it may draw, W.
    pub drawn_w: f64,
    /// The largest power that it may feed back, W.
    pub fed_back_w: f64,
}

/// All drives at the end of a period.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrivesSample {
    /// The time, s.
    pub time_s: f64,
    /// Power that the converter delivers, W, with its base load; of several converters the one
    /// nearest to its limit.
    pub power_w: f64,
    /// What it may deliver, W.
    pub limit_w: f64,
    /// Power that is fed back, W.
    pub fed_back_w: f64,
    /// The drives of the schedule.
    pub drives: Vec<DriveSample>,
}

/// What a row comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Done {
    /// Its line.
    pub line: u64,
    /// Its drive.
    pub id: DriveId,
    /// The time from its row on until it is carried out, s; `None`: another row came before.
    pub reached_s: Option<f64>,
    /// The largest power of the drive meanwhile, W.
    pub peak_w: f64,
}

/// What a schedule comes to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrivesSummary {
    /// How long it lasts, s.
    pub duration_s: f64,
    /// The largest power of a converter at the end of a period, W, and what it may deliver then.
    pub peak_w: f64,
    /// See `peak_w`.
    pub limit_w: f64,
    /// The largest power that is fed back, W.
    pub fed_back_w: f64,
    /// Rows of drives with commands, in their order.
    pub done: Vec<Done>,
    /// From when on the drives take more than there is, s, since they cannot do without: the
    /// supply was lowered while they ran, or does not cover what they draw at rest.
    pub exceeded_s: Option<f64>,
    /// Warnings.
    pub notes: Vec<Diagnostic>,
}

/// A row that a drive is carrying out.
#[derive(Debug, Clone, Copy)]
struct Active {
    /// Index of its row in the schedule, and of what it comes to.
    row: usize,
    done: usize,
    start_s: f64,
    carried_out: bool,
    warned: bool,
}

struct Run<'a> {
    machine: &'a Machine,
    model: PowerModel,
    schedule: &'a DriveSchedule,
    drives: Vec<Drive>,
    active: Vec<Option<Active>>,
    /// What the schedule leaves all of them together, W.
    shared_w: Option<f64>,
    period_s: f64,
    /// For how long no drive has come nearer to its target.
    idle_s: f64,
    sample: DrivesSample,
    summary: DrivesSummary,
}

/// Runs drives from rest at position 0 through a schedule, a sample a period, the first at the
/// time of the first row; `shared` says whether they share the supply, which is what the schedule
/// says or what the machine's converter delivers. A row takes effect with the first period that
/// begins at its time or later; after the last one the run ends when all is carried out.
///
/// # Errors
/// A limit with which nothing can be computed, a supply that does not cover what the drives
/// cannot do without, a command that cannot be carried out, more periods than a run may have, or
/// what `sink` returns.
pub fn run_drives(
    machine: &Machine,
    schedule: &DriveSchedule,
    period_s: f64,
    shared: bool,
    sink: &mut dyn FnMut(&DrivesSample) -> io::Result<()>,
) -> Result<DrivesSummary, Failure> {
    let mut run = Run::new(machine, schedule, period_s, shared).map_err(not_computable)?;
    let start_s = schedule.commands.first().map_or(0.0, |first| first.time_s);
    run.sample.time_s = start_s;
    let (mut from_s, mut count) = (start_s, 0_u32);
    let mut next = 0;
    for _ in 0..PERIODS_MAX {
        let now_s = from_s + f64::from(count) * run.period_s;
        let period_s = run.period_s;
        while let Some(row) = schedule.commands.get(next)
            && row.time_s <= now_s + EARLY * period_s
        {
            run.take(next, now_s).map_err(|error| unfit(row, error))?;
            next += 1;
        }
        if run.period_s != period_s {
            (from_s, count) = (now_s, 0);
        }
        if now_s == start_s {
            run.measure();
            sink(&run.sample).map_err(Failure::Output)?;
        }
        if next == schedule.commands.len() && run.is_done() {
            run.summary.duration_s = now_s - start_s;
            return Ok(run.summary);
        }
        count += 1;
        let end_s = from_s + f64::from(count) * run.period_s;
        run.period(end_s)?;
        sink(&run.sample).map_err(Failure::Output)?;
    }
    let last = schedule.commands.last();
    Err(refused(
        last,
        "schedule-time",
        format!("the run has more than {PERIODS_MAX} periods"),
        "a longer period, or rows that are nearer to each other",
    ))
}

impl<'a> Run<'a> {
    fn new(
        machine: &'a Machine,
        schedule: &'a DriveSchedule,
        period_s: f64,
        shared: bool,
    ) -> Result<Self, LimitError> {
        let mut drives: Vec<Drive> = Vec::new();
        for command in &schedule.commands {
            if let For::Drive(id) = command.of
                && !drives.iter().any(|drive| drive.id == id)
            {
                drives.extend(Drive::new(machine, id)?);
            }
        }
        Ok(Self {
            machine,
            model: PowerModel::new(machine),
            schedule,
            active: vec![None; drives.len()],
            drives,
            shared_w: (!shared).then_some(f64::INFINITY),
            period_s,
            idle_s: 0.0,
            sample: DrivesSample::default(),
            summary: DrivesSummary::default(),
        })
    }

    /// Takes a row at the beginning of a period.
    fn take(&mut self, index: usize, now_s: f64) -> Result<(), LimitError> {
        let row = &self.schedule.commands[index];
        self.idle_s = 0.0;
        let For::Drive(id) = row.of else {
            if self.shared_w != Some(f64::INFINITY) {
                self.shared_w = row.power_w.or(self.shared_w);
            }
            self.period_s = row.period_s.unwrap_or(self.period_s);
            return Ok(());
        };
        let place = self.drives.iter().position(|drive| drive.id == id);
        let Some((place, drive)) = place.and_then(|at| Some((at, self.drives.get_mut(at)?))) else {
            return Ok(());
        };
        drive.take(row)?;
        self.summary.done.push(Done {
            line: row.line,
            id,
            reached_s: None,
            peak_w: 0.0,
        });
        self.active[place] = Some(Active {
            row: index,
            done: self.summary.done.len() - 1,
            start_s: now_s,
            carried_out: false,
            warned: false,
        });
        Ok(())
    }

    fn is_done(&self) -> bool {
        self.active
            .iter()
            .flatten()
            .all(|active| active.carried_out)
    }

    /// One period, which ends at a time.
    fn period(&mut self, end_s: f64) -> Result<(), Failure> {
        let mut nearer = false;
        for converter in 0..self.machine.converters.len().max(1) {
            let members: Vec<usize> = (0..self.drives.len())
                .filter(|index| self.drives[*index].converter == converter)
                .collect();
            let drives: Vec<&Drive> = members.iter().map(|index| &self.drives[*index]).collect();
            let shares = share::shares(&drives, self.supply_w(converter));
            for (index, share_w) in members.into_iter().zip(shares) {
                nearer |= self.step(index, share_w, end_s)?;
            }
        }
        self.sample.time_s = end_s;
        self.measure();
        self.idle_s = if nearer {
            0.0
        } else {
            self.idle_s + self.period_s
        };
        let waits = self.schedule.commands.iter().any(|row| row.time_s > end_s);
        if self.idle_s > STUCK_S && !waits && !self.is_done() {
            let stuck = self.active.iter().flatten().find(|it| !it.carried_out);
            let row = stuck.and_then(|active| self.schedule.commands.get(active.row));
            return Err(refused(
                row,
                "schedule-power",
                "what the supply leaves does not carry this drive to its target".to_owned(),
                "a higher power, a lower speed, or fewer drives at a time",
            ));
        }
        Ok(())
    }

    /// Moves one drive; true where it comes nearer to its target.
    fn step(&mut self, index: usize, share_w: f64, end_s: f64) -> Result<bool, Failure> {
        let drive = &mut self.drives[index];
        let moved = drive.step(share_w, self.period_s).map_err(not_computable)?;
        let nearer = drive.is_on_its_way();
        let (motion, drawn_w) = (drive.motion, drive.law.drawn_w(drive.motion));
        self.sample.drives.retain(|sample| sample.id != drive.id);
        self.sample.drives.push(DriveSample {
            id: drive.id,
            position: drive.position,
            motion,
            jerk: moved.jerk,
            drawn_w,
            fed_back_w: drive.law.fed_back_w(motion),
        });
        let Some(active) = &mut self.active[index] else {
            return Ok(nearer);
        };
        let done = &mut self.summary.done[active.done];
        done.peak_w = done.peak_w.max(drawn_w);
        if moved.reached && !active.carried_out {
            active.carried_out = true;
            done.reached_s = Some(end_s - active.start_s);
        }
        if moved.overshoot > WORTH_A_WARNING * drive.position.abs().max(1.0) && !active.warned {
            active.warned = true;
            let row = &self.schedule.commands[active.row];
            let message = format!(
                "the target is passed by {:.3} before the drive turns: it cannot stop sooner",
                moved.overshoot
            );
            let whole = Span::new(0, row.text.len());
            let note = Diagnostic::warning("overshoot", message);
            self.summary.notes.push(note.at(row.line, whole, &row.text));
        }
        Ok(nearer)
    }

    /// What a converter has for the drives of the schedule, W: less its base load and what axes
    /// that are not in it need to hold their weight.
    fn supply_w(&self, converter: usize) -> f64 {
        self.limit_w(converter) - self.besides_w(converter)
    }

    fn limit_w(&self, converter: usize) -> f64 {
        self.shared_w
            .unwrap_or_else(|| self.model.limit_w(converter))
    }

    fn besides_w(&self, converter: usize) -> f64 {
        let Some(data) = self.machine.converters.get(converter) else {
            return 0.0;
        };
        let planned = |axis: usize| self.drives.iter().any(|it| it.id == DriveId::Axis(axis));
        let others = (0..AXES).filter(|axis| data.axes.contains(*axis) && !planned(*axis));
        let standing = others.filter_map(|axis| {
            let axis = self.machine.axes[axis].as_ref()?;
            Some(crate::power::DriveLaw::of_axis(axis).standing_w())
        });
        data.base_load_w + standing.sum::<f64>()
    }

    /// Adds up what the drives draw.
    fn measure(&mut self) {
        if self.sample.drives.is_empty() {
            let at_rest = self.drives.iter().map(|drive| DriveSample {
                id: drive.id,
                position: drive.position,
                motion: drive.motion,
                jerk: 0.0,
                drawn_w: drive.law.drawn_w(drive.motion),
                fed_back_w: 0.0,
            });
            self.sample.drives = at_rest.collect();
        }
        let order = |id: DriveId| self.drives.iter().position(|drive| drive.id == id);
        self.sample.drives.sort_by_key(|sample| order(sample.id));
        let mut worst = (f64::NEG_INFINITY, 0.0, 0.0);
        let mut fed_back_w = 0.0_f64;
        for converter in 0..self.machine.converters.len().max(1) {
            let members = self.drives.iter().zip(&self.sample.drives);
            let members = members.filter(|(drive, _)| drive.converter == converter);
            let (drawn, back) = members.fold((0.0, 0.0), |sum, (_, sample)| {
                (sum.0 + sample.drawn_w, sum.1 + sample.fed_back_w)
            });
            let (power_w, limit_w) = (drawn + self.besides_w(converter), self.limit_w(converter));
            if power_w - limit_w > worst.0 || converter == 0 {
                worst = (power_w - limit_w, power_w, limit_w);
            }
            fed_back_w = fed_back_w.max(back);
        }
        (_, self.sample.power_w, self.sample.limit_w) = worst;
        self.sample.fed_back_w = fed_back_w;
        let summary = &mut self.summary;
        if self.sample.power_w > self.sample.limit_w * (1.0 + FIT) {
            summary.exceeded_s.get_or_insert(self.sample.time_s);
        }
        if self.sample.power_w > summary.peak_w {
            (summary.peak_w, summary.limit_w) = (self.sample.power_w, self.sample.limit_w);
        }
        summary.fed_back_w = summary.fed_back_w.max(fed_back_w);
    }
}

fn not_computable(error: LimitError) -> Failure {
    Failure::Unsuitable(error.to_string())
}

fn unfit(row: &DriveCommand, error: LimitError) -> Failure {
    let help = "a limit that the drive can be planned with";
    refused(Some(row), "schedule-value", error.to_string(), help)
}

fn refused(
    row: Option<&DriveCommand>,
    rule: &'static str,
    message: String,
    help: &'static str,
) -> Failure {
    let mut error = Diagnostic::error(rule, message).help(help);
    if let Some(row) = row {
        let whole = Span::new(0, row.text.len());
        error = error.at(row.line, whole, &row.text);
    }
    Failure::Refused {
        diagnostics: vec![error],
        more: 0,
    }
}
