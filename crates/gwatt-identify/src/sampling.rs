//! Times of samples: the period, and what is not even about them.

use super::error::{IdentifyError, Outcome};
use super::rows::Lines;

/// Intervals may differ from the period by this share of it.
const JITTER: f64 = 0.01;
/// Up to this share, values at even times are taken from those around them.
const JITTER_MAX: f64 = 0.05;
/// So many samples in a row, and such a share of all, may be missing.
const LOST_MAX: usize = 3;
const LOST_SHARE: f64 = 0.01;

/// The period of a recording, s, and remarks. Values become those at even times: where
/// some samples are missing, or times are uneven by a little, cubics through the four
/// samples around each time take their place.
///
/// # Errors
///
/// When there is no period, or too much is missing.
pub fn even(time: &[f64], values: &mut [Vec<f64>], lines: &Lines) -> Outcome<(f64, Vec<String>)> {
    let intervals: Vec<f64> = time.windows(2).map(difference).collect();
    let mut sorted = intervals.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
    if usual.is_nan() || usual <= 0.0 {
        return Err(IdentifyError::new(
            "the time does not go on",
            "time_s must grow from line to line",
        ));
    }
    let off = |interval: f64| {
        let periods = libm::round(interval / usual);
        (
            (interval / usual - periods.max(1.0)).abs(),
            periods as usize,
        )
    };
    let mut jitter: f64 = 0.0;
    let mut lost: Vec<usize> = Vec::new();
    for (index, interval) in intervals.iter().enumerate() {
        let (apart, periods) = off(*interval);
        if *interval <= 0.0 || apart > JITTER_MAX || periods > 1 + LOST_MAX {
            return Err(uneven(&intervals, index, usual, lines));
        }
        if periods > 1 {
            lost.push(index);
        }
        jitter = jitter.max(apart);
    }
    if lost.len() as f64 > LOST_SHARE * intervals.len() as f64
        && let Some(first) = lost.first()
    {
        return Err(uneven(&intervals, *first, usual, lines));
    }
    let missing: usize = intervals.iter().map(|i| off(*i).1.max(1) - 1).sum();
    let span = time.last().copied().unwrap_or_default() - time.first().copied().unwrap_or_default();
    let periods = intervals.len() + missing;
    let period_s = span / periods as f64;
    let mut notes = Vec::new();
    if let Some(first) = lost.first() {
        notes.push(format!(
            "{missing} {} missing, the first after line {}: values between take the place",
            if missing == 1 {
                "sample is"
            } else {
                "samples are"
            },
            lines.of(*first)
        ));
    }
    if jitter > JITTER {
        notes.push(format!(
            "times are uneven by up to {:.1} % of the period: values are taken at even ones",
            100.0 * jitter
        ));
    }
    if !notes.is_empty() {
        for signal in values {
            *signal = at_even_times(time, signal, period_s, periods + 1);
        }
    }
    Ok((period_s, notes))
}

fn difference(pair: &[f64]) -> f64 {
    match pair {
        [before, after] => after - before,
        _ => 0.0,
    }
}

/// What is wrong with the interval after a sample.
fn uneven(intervals: &[f64], index: usize, usual: f64, lines: &Lines) -> IdentifyError {
    let interval = intervals.get(index).copied().unwrap_or_default();
    let (before, line) = (lines.of(index), lines.of(index + 1));
    if interval <= 0.0 {
        return IdentifyError::new(
            format!("line {line}: the time goes back or stands still"),
            "sort the samples by time, each once",
        );
    }
    let is_off = |other: &&f64| ((*other - usual) / usual).abs() > JITTER;
    let many = intervals.iter().filter(is_off).count();
    if interval > 1.5 * usual && many * 50 < intervals.len() {
        return IdentifyError::new(
            format!("a gap after line {before}: {interval:.6} s instead of {usual:.6} s"),
            "cut the recording there, or record again without losses",
        );
    }
    IdentifyError::new(
        format!(
            "sampling is uneven: line {line} comes after {interval:.6} s, others after {usual:.6} s ({many} intervals are off by more than {} %)",
            100.0 * JITTER
        ),
        "record with a fixed period, and write the time with enough digits",
    )
}

/// Values at `count` even times from the first one on, by cubics through the two samples
/// before and the two after each (Lagrange).
fn at_even_times(time: &[f64], values: &[f64], period_s: f64, count: usize) -> Vec<f64> {
    let start = time.first().copied().unwrap_or_default();
    let last = time.len().saturating_sub(4);
    let mut after = 0;
    (0..count)
        .map(|k| {
            let t = start + k as f64 * period_s;
            while time.get(after).is_some_and(|other| *other < t) {
                after += 1;
            }
            let from = after.saturating_sub(2).min(last);
            let (Some(times), Some(values)) =
                (time.get(from..from + 4), values.get(from..from + 4))
            else {
                return values.get(after).copied().unwrap_or_default();
            };
            let weight = |i: usize, ti: f64| -> f64 {
                let others = times.iter().enumerate().filter(|(j, _)| *j != i);
                others.map(|(_, tj)| (t - tj) / (ti - tj)).product()
            };
            let pairs = times.iter().zip(values).enumerate();
            pairs.map(|(i, (ti, value))| value * weight(i, *ti)).sum()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(count: usize) -> Lines {
        let mut lines = Lines::default();
        for line in 0..count {
            lines.add(line as u64 + 2);
        }
        lines
    }

    /// A cubic is what it was where one of its samples is missing and times are off.
    #[test]
    fn a_sample_that_is_missing_is_put_between_its_neighbours() {
        let cubic = |t: f64| 1.0 + t * (2.0 - t * (0.5 + 0.01 * t));
        let mut time: Vec<f64> = (0..200).map(f64::from).collect();
        time.remove(120);
        time[50] += 0.03;
        let mut values = vec![time.iter().map(|t| cubic(*t)).collect::<Vec<_>>()];
        let (period_s, notes) = even(&time, &mut values, &lines(199)).unwrap();
        assert_eq!(period_s, 1.0);
        assert_eq!(
            notes,
            [
                "1 sample is missing, the first after line 121: values between take the place",
                "times are uneven by up to 3.0 % of the period: values are taken at even ones",
            ]
        );
        assert_eq!(values[0].len(), 200);
        for (k, value) in values[0].iter().enumerate() {
            let expected = cubic(k as f64);
            assert!(
                (value - expected).abs() < 1e-9 * expected.abs().max(1.0),
                "{k}"
            );
        }
    }

    #[test]
    fn what_is_even_stays_as_it_is() {
        let time: Vec<f64> = (0..100).map(|k| 1e-3 * f64::from(k)).collect();
        let mut values = vec![time.clone()];
        let (period_s, notes) = even(&time, &mut values, &lines(100)).unwrap();
        assert!((period_s - 1e-3).abs() < 1e-15 && notes.is_empty());
        assert_eq!(values[0], time);
    }
}
