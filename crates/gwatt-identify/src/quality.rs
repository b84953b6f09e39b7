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
    let changes = signal
        .values
        .iter()
        .zip(signal.values.iter().skip(1))
        .filter(|(a, b)| a != b)
        .count();
    let inside = signal
        .values
        .iter()
        .filter(|v| **v != low && **v != high)
        .count();
    if changes * 4 < n || inside * 4 < n {
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
