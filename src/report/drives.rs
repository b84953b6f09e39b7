//! The run of several drives as CSV, and in a few lines for people.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::figure::{Exact, Figure, round_to_digits};
use super::quantity::{duration, power};
use crate::machine::units::SECONDS_PER_MINUTE;
use crate::machine::{ALL_AXES, AxisKind, Machine};
use crate::pipeline::{DriveCommand, DriveId, DriveSchedule, DrivesSample, DrivesSummary, For};

/// Digits of a time: to the nanosecond for hours.
const TIME_DIGITS: i32 = 13;
/// Rows that are listed.
const LISTED: usize = 40;

/// Writes samples as CSV below a header: `time_s,power_w,limit_w,fed_back_w`, then of each drive
/// its position, speed, acceleration, jerk and power.
///
/// Motion has all its digits: rounding would carry it over limits that it keeps.
#[derive(Debug)]
pub struct DriveRows<W: Write> {
    out: csv::Writer<W>,
    /// Whether the header stands.
    begun: bool,
}

impl<W: Write> DriveRows<W> {
    /// Rows to `out`.
    #[must_use]
    pub fn new(out: W) -> Self {
        let out = csv::WriterBuilder::new()
            .has_headers(false)
            .terminator(csv::Terminator::CRLF)
            .from_writer(out);
        Self { out, begun: false }
    }

    /// Writes one sample.
    ///
    /// # Errors
    /// Those of the writer below.
    pub fn row(&mut self, machine: &Machine, sample: &DrivesSample) -> io::Result<()> {
        if !self.begun {
            self.begun = true;
            let mut names: Vec<String> = ["time_s", "power_w", "limit_w", "fed_back_w"]
                .map(str::to_owned)
                .into();
            for drive in &sample.drives {
                names.extend(columns(machine, drive.id));
            }
            self.out.write_record(&names)?;
        }
        let mut cells = vec![Cell::Exact(round_to_digits(sample.time_s, TIME_DIGITS))];
        cells.extend([sample.power_w, sample.limit_w, sample.fed_back_w].map(Cell::Figure));
        for drive in &sample.drives {
            let speed = match drive.id {
                DriveId::Axis(_) => {
                    cells.push(Cell::Exact(drive.position));
                    drive.motion.speed * SECONDS_PER_MINUTE
                }
                DriveId::Spindle => drive.motion.speed,
            };
            cells.extend([speed, drive.motion.accel, drive.jerk].map(Cell::Exact));
            cells.push(Cell::Figure(drive.drawn_w));
        }
        Ok(self.out.serialize(cells)?)
    }

    /// Writes what is still held back and gives the writer below back.
    ///
    /// # Errors
    /// Those of the writer below.
    pub fn finish(self) -> io::Result<W> {
        self.out
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)
    }
}

/// A value of a row.
enum Cell {
    Exact(f64),
    Figure(f64),
}

impl serde::Serialize for Cell {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Exact(value) => Exact(value).serialize(serializer),
            Self::Figure(value) => Figure(value).serialize(serializer),
        }
    }
}

/// The columns of a drive.
fn columns(machine: &Machine, id: DriveId) -> Vec<String> {
    let name = name(id).to_ascii_lowercase();
    let columns: &[&str] = match id {
        DriveId::Spindle => &["speed_rpm", "accel_rpm_s", "jerk_rpm_s2", "power_w"],
        DriveId::Axis(axis) if is_rotary(machine, axis) => &[
            "position_deg",
            "speed_deg_min",
            "accel_deg_s2",
            "jerk_deg_s3",
            "power_w",
        ],
        DriveId::Axis(_) => &[
            "position_mm",
            "speed_mm_min",
            "accel_mm_s2",
            "jerk_mm_s3",
            "power_w",
        ],
    };
    columns
        .iter()
        .map(|column| format!("{name}_{column}"))
        .collect()
}

fn is_rotary(machine: &Machine, axis: usize) -> bool {
    machine.axes[axis].is_some_and(|data| data.kind == AxisKind::Rotary)
}

fn name(id: DriveId) -> String {
    match id {
        DriveId::Spindle => "spindle".to_owned(),
        DriveId::Axis(axis) => {
            let letter = ALL_AXES.get(axis).map_or('?', |id| id.letter() as char);
            letter.to_string()
        }
    }
}

/// What a run comes to: a line, and one for each row of the schedule; `alone` is the same run
/// without a shared supply.
#[must_use]
pub fn drives_text(
    file: &str,
    machine: &Machine,
    schedule: &DriveSchedule,
    summary: &DrivesSummary,
    alone: Option<&DrivesSummary>,
) -> String {
    let verdict = match summary.exceeded_s {
        None => "within the supply".to_owned(),
        Some(time_s) => format!("exceeds the supply from {} on", duration(time_s)),
    };
    let mut text = format!(
        "{file}: {verdict}: {}; peak {} of {}, {} fed back",
        duration(summary.duration_s),
        power(summary.peak_w),
        power(summary.limit_w),
        power(summary.fed_back_w)
    );
    if let Some(alone) = alone.filter(|alone| alone.peak_w > summary.peak_w) {
        let _ = write!(
            text,
            "; each for itself: {} and {}",
            duration(alone.duration_s),
            power(alone.peak_w)
        );
    }
    text.push('\n');
    for done in summary.done.iter().take(LISTED) {
        let mut rows = schedule.commands.iter();
        let row = rows.find(|row| row.line == done.line);
        let target = row.map_or_else(String::new, |row| target(machine, row));
        let time = done.reached_s.map_or_else(
            || "not reached before its next row".to_owned(),
            |seconds| format!("in {}", duration(seconds)),
        );
        let _ = writeln!(
            text,
            "  line {}  {}{target} {time}  peak {}",
            done.line,
            name(done.id),
            power(done.peak_w)
        );
    }
    if let Some(more) = summary.done.len().checked_sub(LISTED).filter(|n| *n > 0) {
        let _ = writeln!(text, "  and {more} more");
    }
    text
}

/// What a row asks for.
fn target(machine: &Machine, row: &DriveCommand) -> String {
    let For::Drive(id) = row.of else {
        return String::new();
    };
    let (length, speed, per_minute) = match id {
        DriveId::Spindle => ("", "1/min", 1.0),
        DriveId::Axis(axis) if is_rotary(machine, axis) => ("deg", "deg/min", SECONDS_PER_MINUTE),
        DriveId::Axis(_) => ("mm", "mm/min", SECONDS_PER_MINUTE),
    };
    let rounded = |value: f64| round_to_digits(value + 0.0, 6);
    match (row.position, row.speed) {
        (Some(position), _) => format!(" → {} {length}", rounded(position)),
        (None, Some(value)) => format!(" → {} {speed}", rounded(value * per_minute)),
        (None, None) => " under other limits".to_owned(),
    }
}
