//! Recordings: CSV with a header that names quantities and units.

use std::io::Read;

use super::column::{Kind, Quantity, Reading, axis_of, read, units_of};
use super::rows::{Lines, Rows, no_number};
use super::trouble::{Outcome, Trouble};

/// Intervals may differ from the period by this share of it.
const JITTER: f64 = 0.01;
/// Fewer samples than this are never enough.
const SAMPLES_MIN: usize = 100;
/// More samples than this are refused: they would not fit into memory.
const SAMPLES_MAX: usize = 50_000_000;

/// One recorded signal, in SI.
#[derive(Debug, Clone)]
pub struct Signal {
    /// Name in the header.
    pub name: String,
    /// What it is.
    pub quantity: Quantity,
    /// Sliding or turning.
    pub kind: Kind,
    /// Samples.
    pub values: Vec<f64>,
}

/// Signals that were sampled evenly.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Sampling period, s.
    pub period_s: f64,
    /// Signals besides the time.
    pub signals: Vec<Signal>,
    /// Columns that were passed over.
    pub ignored: Vec<String>,
}

impl Recording {
    /// Reads CSV; of columns with an axis letter in front, those of `axis`.
    ///
    /// # Errors
    ///
    /// Anything that keeps the data from being used, with what to do.
    pub fn read(input: impl Read, axis: Option<char>) -> Outcome<Self> {
        let mut rows = Rows::open(input)?;
        let (columns, ignored) = columns(&rows.names, axis)?;
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
        let mut lines = Lines::default();
        while let Some(line) = rows.next_line()? {
            lines.add(line);
            for ((index, name, _), list) in columns.iter().zip(&mut values) {
                let cell = rows.cell(*index);
                let value: f64 = cell.parse().unwrap_or(f64::NAN);
                if !value.is_finite() {
                    return Err(no_number(line, name, cell));
                }
                list.push(value);
            }
            if values.first().is_some_and(|list| list.len() > SAMPLES_MAX) {
                return Err(Trouble::new(
                    format!("the recording has more than {SAMPLES_MAX} samples"),
                    "cut it, or record at a lower rate",
                ));
            }
        }
        let mut time = Vec::new();
        let mut signals = Vec::new();
        for ((_, name, meaning), mut values) in columns.into_iter().zip(values) {
            for value in &mut values {
                *value *= meaning.to_si;
            }
            if meaning.quantity == Quantity::Time {
                time = values;
            } else {
                signals.push(Signal {
                    name,
                    quantity: meaning.quantity,
                    kind: meaning.kind,
                    values,
                });
            }
        }
        if time.len() < SAMPLES_MIN {
            return Err(Trouble::new(
                format!("the recording is too short: {} samples", time.len()),
                format!("record at least {SAMPLES_MIN} samples, better several seconds"),
            ));
        }
        Ok(Self {
            period_s: period(&time, &lines)?,
            signals,
            ignored,
        })
    }

    /// Refers what was recorded at a motor to the slide that its screw drives:
    /// torques become forces, angles become travel. `force_per_torque` is in N per
    /// N·m, and so in rad of the motor per m of the slide. Signals that are about
    /// sliding stay as they are.
    ///
    /// # Errors
    ///
    /// An angle of the load: the load of a screw slides.
    pub fn refer_to_slide(&mut self, force_per_torque: f64) -> Outcome<()> {
        for signal in &mut self.signals {
            if signal.kind != Kind::Rotary {
                continue;
            }
            let factor = match signal.quantity {
                Quantity::Force | Quantity::Excitation => force_per_torque,
                Quantity::Command
                | Quantity::Position
                | Quantity::Velocity
                | Quantity::Acceleration => 1.0 / force_per_torque,
                Quantity::Time | Quantity::Power => continue,
            };
            if signal.name.to_ascii_lowercase().contains("load_") {
                return Err(Trouble::new(
                    format!("{} turns, but the load of a screw slides", signal.name),
                    "leave --lead-mm out if the load turns; name the column without load_ if it is the motor's encoder",
                ));
            }
            for value in &mut signal.values {
                *value *= factor;
            }
            signal.kind = Kind::Linear;
        }
        Ok(())
    }

    /// Turns force, torque, excitation and command about: they were counted the other
    /// way than the motion.
    pub fn reverse(&mut self) {
        for signal in &mut self.signals {
            if matches!(
                signal.quantity,
                Quantity::Force | Quantity::Excitation | Quantity::Command
            ) {
                for value in &mut signal.values {
                    *value = -*value;
                }
            }
        }
    }

    /// The signal of a quantity.
    #[must_use]
    pub fn get(&self, quantity: Quantity) -> Option<&Signal> {
        self.signals
            .iter()
            .find(|signal| signal.quantity == quantity)
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.signals.first().map_or(0, |signal| signal.values.len())
    }

    /// True without samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

type Column = (usize, String, super::column::Meaning);

fn columns(header: &[String], axis: Option<char>) -> Outcome<(Vec<Column>, Vec<String>)> {
    let mut columns: Vec<Column> = Vec::new();
    let mut ignored = Vec::new();
    for (index, name) in header.iter().enumerate() {
        let is_ours = match (axis_of(name), axis) {
            (Some(found), Some(wanted)) => found == wanted,
            _ => true,
        };
        match read(name) {
            Reading::Known(meaning) if is_ours => {
                if let Some((_, other, _)) = columns
                    .iter()
                    .find(|(_, _, known)| known.quantity == meaning.quantity)
                {
                    return Err(Trouble::new(
                        format!("{other} and {name} are the same quantity"),
                        "leave one of them in the file, or put the axis letter in front, such as x_position_mm",
                    ));
                }
                columns.push((index, name.clone(), meaning));
            }
            Reading::UnitInDoubt(quantity) if is_ours => {
                return Err(Trouble::new(
                    format!("the unit of column {name} is in doubt"),
                    format!("end its name with the unit, one of: {}", units_of(quantity)),
                ));
            }
            _ => ignored.push(name.clone()),
        }
    }
    if columns
        .iter()
        .all(|(_, _, meaning)| meaning.quantity != Quantity::Time)
    {
        return Err(Trouble::new(
            "there is no column time_s",
            "name the column of time time_s (or time_ms); the header must name quantities and units",
        ));
    }
    Ok((columns, ignored))
}

/// The sampling period, if there is one.
fn period(time: &[f64], lines: &Lines) -> Outcome<f64> {
    let intervals: Vec<f64> = time
        .iter()
        .zip(time.iter().skip(1))
        .map(|(before, after)| after - before)
        .collect();
    let mut sorted = intervals.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
    if usual.is_nan() || usual <= 0.0 {
        return Err(Trouble::new(
            "the time does not go on",
            "time_s must grow from line to line",
        ));
    }
    for (index, interval) in intervals.iter().enumerate() {
        let (before, line) = (lines.of(index), lines.of(index + 1));
        let deviation = (interval - usual) / usual;
        if deviation.abs() <= JITTER {
            continue;
        }
        if *interval <= 0.0 {
            return Err(Trouble::new(
                format!("line {line}: the time goes back or stands still"),
                "sort the samples by time, each once",
            ));
        }
        let many = intervals
            .iter()
            .filter(|other| ((*other - usual) / usual).abs() > JITTER)
            .count();
        if deviation > 0.5 && many * 50 < intervals.len() {
            return Err(Trouble::new(
                format!("a gap after line {before}: {interval:.6} s instead of {usual:.6} s"),
                "cut the recording there, or record again without losses",
            ));
        }
        return Err(Trouble::new(
            format!(
                "sampling is uneven: line {line} comes after {interval:.6} s, others after {usual:.6} s ({many} intervals are off by more than {} %)",
                100.0 * JITTER
            ),
            "record with a fixed period, and write the time with enough digits",
        ));
    }
    let span = time.last().copied().unwrap_or_default() - time.first().copied().unwrap_or_default();
    Ok(span / intervals.len() as f64)
}
