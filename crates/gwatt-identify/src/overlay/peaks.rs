//! Measured peaks next to predicted ones.

use std::collections::BTreeMap;

use super::align::Place;
use super::curve::Curve;
use super::trace::PowerTrace;
use crate::peak_factor::{PeakFactor, factor_of, ratios};

/// The largest powers of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockPeaks {
    /// Its number: the line.
    pub block: u64,
    /// How often it ran in the time of the log.
    pub runs: u64,
    /// When its worst run begins, s, in the time of the log.
    pub start_s: f64,
    /// Measured while that ran, W.
    pub measured_w: f64,
    /// Predicted for that time, W.
    pub predicted_w: f64,
}

impl BlockPeaks {
    /// Measured by predicted power.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.measured_w / self.predicted_w
    }
}

/// What comparing them comes to.
pub(super) struct Peaks {
    pub(super) factor: PeakFactor,
    pub(super) blocks: Vec<BlockPeaks>,
}

/// Compares the peaks of a log with those of the prediction. Either may be a little late: a
/// measured power counts against the largest that is predicted near it.
pub(super) fn compare(curve: &Curve, log: &PowerTrace, near_w: &[f64], place: Place) -> Peaks {
    Peaks {
        factor: factor(log, near_w, place),
        blocks: by_block(curve, log, near_w, place),
    }
}

/// By which factor the peaks of a log exceed what is predicted near them.
pub(super) fn factor(log: &PowerTrace, near_w: &[f64], place: Place) -> PeakFactor {
    let inside = |t: f64| t >= place.start_s && t <= place.end_s;
    let of = |values: &[f64]| -> Vec<f64> {
        let all = log.time_s.iter().zip(values);
        all.filter(|(t, _)| inside(**t)).map(|(_, w)| *w).collect()
    };
    let (near, measured) = (of(near_w), of(&log.power_w));
    let peak_w = near.iter().copied().fold(0.0, f64::max);
    factor_of(&ratios(&near, &measured, peak_w))
}

/// At each time the largest of the values whose own times are so near; both ascend.
pub(super) fn largest_near(
    time_s: &[f64],
    (own_s, values): (&[f64], &[f64]),
    slack_s: f64,
) -> Vec<f64> {
    // Indices of values that fall, of which the first is the largest.
    let mut falling: std::collections::VecDeque<usize> = std::collections::VecDeque::new();
    let (mut next, mut found) = (0, Vec::with_capacity(time_s.len()));
    let value = |k: usize| values.get(k).copied().unwrap_or(f64::NEG_INFINITY);
    for t in time_s {
        while own_s.get(next).is_some_and(|other| *other <= t + slack_s) {
            while falling
                .back()
                .is_some_and(|last| value(*last) <= value(next))
            {
                falling.pop_back();
            }
            falling.push_back(next);
            next += 1;
        }
        let late = |k: &usize| own_s.get(*k).is_some_and(|other| *other < t - slack_s);
        while falling.front().is_some_and(late) {
            falling.pop_front();
        }
        found.push(falling.front().map_or(0.0, |k| value(*k)));
    }
    found
}

fn by_block(curve: &Curve, log: &PowerTrace, near_w: &[f64], place: Place) -> Vec<BlockPeaks> {
    let pace = place.pace(curve);
    let mut found: BTreeMap<u64, BlockPeaks> = BTreeMap::new();
    let mut at = 0;
    for (block, from, to) in curve.blocks() {
        let [from, to] = [from, to].map(|t| place.start_s + t * pace);
        while log.time_s.get(at).is_some_and(|t| *t < from) {
            at += 1;
        }
        let samples = log
            .time_s
            .iter()
            .zip(log.power_w.iter().zip(near_w))
            .skip(at);
        let samples = samples.take_while(|(t, _)| **t <= to);
        let worst = samples.fold(None, |worst: Option<(f64, f64)>, (_, (own, near))| {
            let excess = |(own, near): (f64, f64)| own - near;
            match worst {
                Some(worst) if excess(worst) >= own - near => Some(worst),
                _ => Some((*own, *near)),
            }
        });
        let Some((measured_w, predicted_w)) = worst else {
            continue;
        };
        let run = BlockPeaks {
            block,
            runs: 1,
            start_s: from,
            measured_w,
            predicted_w,
        };
        found
            .entry(block)
            .and_modify(|known| {
                let runs = known.runs + 1;
                if measured_w - predicted_w > known.measured_w - known.predicted_w {
                    *known = run;
                }
                known.runs = runs;
            })
            .or_insert(run);
    }
    found.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_near_is_that_of_a_window() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        let values = [1.0, 5.0, 2.0, 0.0, 0.0, 7.0, 1.0, 3.0];
        assert_eq!(
            largest_near(&time, (&time, &values), 1.0),
            [5.0, 5.0, 5.0, 2.0, 7.0, 7.0, 7.0, 3.0]
        );
    }
}
