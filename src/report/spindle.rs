//! A spindle's run as CSV, and in a few lines for people.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::figure::{Exact, Figure, round_to_digits};
use super::quantity::{duration, energy, power};
use crate::pipeline::{Sample, SpindleSummary};

/// The columns, in their order.
const COLUMNS: [&str; 7] = [
    "time_s",
    "speed_rpm",
    "accel_rpm_s",
    "jerk_rpm_s2",
    "torque_nm",
    "power_w",
    "target_rpm",
];
/// Digits of a time: to the nanosecond for hours.
const TIME_DIGITS: i32 = 13;
/// Changes that are listed.
const LISTED: usize = 20;

/// Writes samples as CSV below a header.
///
/// Speed, acceleration and jerk have all their digits: rounding them would
/// carry them over limits that they keep.
#[derive(Debug)]
pub struct SpindleRows<W: Write> {
    out: csv::Writer<W>,
}

impl<W: Write> SpindleRows<W> {
    /// Writes the header to `out`.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(out: W) -> io::Result<Self> {
        let mut out = csv::WriterBuilder::new()
            .has_headers(false)
            .terminator(csv::Terminator::CRLF)
            .from_writer(out);
        out.write_record(COLUMNS)?;
        Ok(Self { out })
    }

    /// Writes one sample.
    ///
    /// # Errors
    /// Those of the writer below.
    pub fn row(&mut self, sample: &Sample) -> io::Result<()> {
        Ok(self.out.serialize((
            Exact(round_to_digits(sample.time_s, TIME_DIGITS)),
            Exact(sample.motion.speed),
            Exact(sample.motion.accel),
            Exact(sample.jerk_rpm_s2),
            Figure(sample.torque_nm),
            Figure(sample.power_w),
            Exact(sample.target_rpm),
        ))?)
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

/// What a run comes to: a line, and one for each change of speed.
#[must_use]
pub fn spindle_text(schedule: &str, summary: &SpindleSummary) -> String {
    let mut text = format!(
        "{schedule}: {}; peak {}, {} fed back, {}\n",
        duration(summary.duration_s),
        power(summary.peak_w),
        power(summary.regen_w),
        energy(summary.energy_j)
    );
    let rpm = |speed: f64| round_to_digits(speed + 0.0, 5);
    for change in summary.changes.iter().take(LISTED) {
        let time = change.reached_s.map_or_else(
            || "not reached".to_owned(),
            |seconds| format!("in {}", duration(seconds)),
        );
        let _ = writeln!(
            text,
            "  line {}  {} → {} 1/min {time}  peak {}, {} fed back",
            change.line,
            rpm(change.from_rpm),
            rpm(change.target_rpm),
            power(change.peak_w),
            power(change.regen_w)
        );
    }
    if let Some(more) = summary.changes.len().checked_sub(LISTED).filter(|n| *n > 0) {
        let _ = writeln!(text, "  and {more} more");
    }
    text
}
