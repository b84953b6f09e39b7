//! Signals that cannot show anything: they do not move, or they are cut off.

use super::error::{IdentifyError, Outcome};
use super::recording::Signal;

/// Refuses a signal that stays the same.
///
/// # Errors
///
/// When it does.
pub fn moves(signal: &Signal, help: &str) -> Outcome<()> {
    let (low, high) = range(&signal.values);
    let size = low.abs().max(high.abs());
    if high - low > 1e-9 * size.max(f64::MIN_POSITIVE) && high > low {
        return Ok(());
    }
    Err(IdentifyError::new(
        format!("{} stays at {low}: there is no excitation", signal.name),
        help,
    ))
}

/// Where a signal is cut off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutOff {
    /// The value that it does not pass.
    pub level: f64,
    /// Whether that is its largest one, or else its smallest.
    pub is_largest: bool,
    /// Samples that stand there, in a row with others.
    pub samples: usize,
    /// Their share of all samples, those at the other end included.
    pub share: f64,
}

/// Whether a signal is cut off: a fair part of its samples stand, several
/// in a row, at exactly its largest or smallest value, while the rest varies
/// from sample to sample. Signals of few levels, such as an M-sequence, are
/// meant to.
#[must_use]
pub fn cut_off(signal: &Signal) -> Option<CutOff> {
    const SHARE: f64 = 0.01;
    const RUN: usize = 3;
    let n = signal.values.len();
    let (low, high) = range(&signal.values);
    let is_end = |v: f64| v == low || v == high;
    let inside = signal.values.iter().filter(|v| !is_end(**v)).count();
    if !varies(&signal.values) && !runs_between(&signal.values, is_end, inside) {
        return None;
    }
    let stuck = |level: f64| {
        let (mut run, mut stuck) = (0, 0);
        for value in &signal.values {
            run = if *value == level { run + 1 } else { 0 };
            if run == RUN {
                stuck += RUN;
            } else if run > RUN {
                stuck += 1;
            }
        }
        stuck
    };
    let (above, below) = (stuck(high), stuck(low));
    let found = [(high, true, above), (low, false, below)];
    let (level, is_largest, samples) = found
        .into_iter()
        .find(|(_, _, stuck)| *stuck as f64 > SHARE * n as f64)?;
    Some(CutOff {
        level,
        is_largest,
        samples,
        share: (above + below) as f64 / n as f64,
    })
}

/// Whether a fair part of a signal lies between its ends and changes from sample to sample.
fn varies(x: &[f64]) -> bool {
    let (low, high) = range(x);
    let changes = x.windows(2).filter(|pair| pair.first() != pair.last());
    let inside = x.iter().filter(|v| **v != low && **v != high);
    changes.count() * 4 >= x.len() && inside.count() * 4 >= x.len()
}

/// Whether a signal runs from end to end through many values, of which there are so many: one
/// of few levels jumps, through a sample or two of its filter.
fn runs_between(x: &[f64], is_end: impl Fn(f64) -> bool, inside: usize) -> bool {
    const RUN: usize = 5;
    const LEAST: f64 = 0.02;
    let runs = x.split(|v| is_end(*v)).filter(|run| run.len() >= RUN);
    let (mut samples, mut changes) = (0, 0);
    for run in runs {
        samples += run.len();
        let pairs = run.windows(2);
        changes += pairs.filter(|pair| pair.first() != pair.last()).count();
    }
    inside as f64 >= LEAST * x.len() as f64 && samples * 2 >= inside && changes * 2 >= samples
}

/// Refuses a signal that is cut off.
///
/// # Errors
///
/// When it is.
pub fn not_saturated(signal: &Signal) -> Outcome<()> {
    let Some(found) = cut_off(signal) else {
        return Ok(());
    };
    let name = if found.is_largest {
        "largest"
    } else {
        "smallest"
    };
    Err(IdentifyError::new(
        format!(
            "{} is saturated: {} samples stand at its {name} value {}",
            signal.name, found.samples, found.level
        ),
        "record again with a smaller amplitude, or with a larger range of the sensor",
    ))
}

fn range(x: &[f64]) -> (f64, f64) {
    x.iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(*v), high.max(*v))
        })
}
