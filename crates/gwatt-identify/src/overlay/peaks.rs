//! Measured peaks next to predicted ones.

use std::collections::BTreeMap;
use std::ops::Range;

use super::align::Place;
use super::curve::Curve;
use super::line::Line;
use super::meter::{SLACK, shown, times_looked_at};
use super::tops::{Model, STATED, tops};
use super::trace::PowerTrace;
use crate::peak_factor::{HALF, PeakFactor, factor_of};

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
    pub fn measured_by_predicted(&self) -> f64 {
        self.measured_w / self.predicted_w
    }
}

/// By which factor peaks exceed what is predicted.
pub(super) struct Peaks {
    pub(super) factor: PeakFactor,
    /// Through all samples.
    pub(super) line: Line,
    /// The error of the largest of them, as it is stated.
    pub(super) error: f64,
    /// Those with too few samples.
    pub(super) short: usize,
    /// Whether the largest is among these, or most are.
    pub(super) is_sampled_slowly: bool,
    /// The largest power that is predicted near each sample, W: as near as tops are.
    pub(super) near_w: Vec<f64>,
}

/// A factor with its error.
#[derive(Clone, Copy)]
struct Exceeds {
    factor: f64,
    error: f64,
}

/// Compares the peaks of a log with those of the prediction. No peak counts with less than what
/// its samples, fitted by the prediction, show, and none of its samples exceeds what is predicted
/// near it by more; all of them together not with less than the fitted line shows.
pub(super) fn compare(model: &Model<'_>, log: &PowerTrace) -> Peaks {
    compare_from(model, log, true)
}

/// The same of a prediction that is raised where axes draw, and not where they feed back: the
/// line through all of it shows no factor.
pub(super) fn compare_raised(model: &Model<'_>, log: &PowerTrace) -> Peaks {
    compare_from(model, log, false)
}

fn compare_from(model: &Model<'_>, log: &PowerTrace, from_line: bool) -> Peaks {
    let (place, curve) = (model.place, model.curve);
    let step_s = log.step_s();
    let looked_at_s = times_looked_at(curve, log, place);
    let looked_at = shown(curve, &looked_at_s, place, model.width_s);
    let near = |slack_s: f64| largest_near(&log.time_s, (&looked_at_s, &looked_at), slack_s);
    let is_inside = |k: usize| {
        let t = log.time_s.get(k);
        t.is_some_and(|t| (place.start_s..=place.end_s).contains(t))
    };
    let widest_w = near(SLACK * step_s + model.width_s / 2.0);
    let all = widest_w.iter().enumerate();
    let inside = all.filter(|(k, _)| is_inside(*k)).map(|(_, w)| *w);
    let peak_w = inside.fold(0.0, f64::max);
    let predicted_w = shown(curve, &log.time_s, place, model.width_s);
    let line = Line::of(model, log, &predicted_w);
    let tops = tops(model, log, &log.power_w, (&predicted_w, peak_w));
    let slack_s = tops.slack(step_s) * step_s + model.width_s / 2.0;
    let (mut ratios, mut short, mut is_sampled_slowly) = (Vec::new(), 0, false);
    let mut seen = Exceeds {
        factor: if from_line { line.gain } else { 0.0 },
        error: line.error,
    };
    let mut tops_left = tops.found.iter().peekable();
    for run in runs(&widest_w, HALF * peak_w, is_inside) {
        let mut most = Exceeds {
            factor: 0.0,
            error: 0.0,
        };
        let mut highest_w = 0.0_f64;
        let samples = log.power_w.iter().zip(&widest_w).enumerate();
        for (_, (own, near)) in samples.skip(run.start).take(run.len()) {
            highest_w = highest_w.max(*near);
            most = most.or_more(own / near, STATED * tops.scatter_w / near);
        }
        let mut has_top = false;
        while let Some(top) = tops_left.next_if(|it| it.sample < run.end) {
            has_top |= top.sample >= run.start;
            most = most.or_more(top.factor, top.error);
        }
        if !has_top {
            // Of its own it shows too little.
            most = most.or_more(line.gain, line.error);
        }
        if !has_top && tops.is_whole {
            short += 1;
            is_sampled_slowly |= highest_w >= peak_w;
        }
        seen = seen.or_more(most.factor, most.error);
        ratios.push(most.factor);
    }
    let mut factor = factor_of(&ratios);
    factor.seen = factor.seen.max(seen.factor);
    factor.factor = factor.factor.max(factor.seen);
    Peaks {
        factor,
        line,
        error: seen.error,
        short,
        is_sampled_slowly: is_sampled_slowly || 2 * short > factor.peaks,
        near_w: near(slack_s),
    }
}

impl Exceeds {
    fn or_more(self, factor: f64, error: f64) -> Self {
        if factor > self.factor {
            Self { factor, error }
        } else {
            self
        }
    }
}

/// The ranges of samples above a power.
fn runs(near_w: &[f64], above_w: f64, is_inside: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (k, near) in near_w.iter().enumerate() {
        if *near > 0.0 && *near >= above_w && is_inside(k) {
            match found.last_mut() {
                Some(last) if last.end == k => last.end = k + 1,
                _ => found.push(k..k + 1),
            }
        }
    }
    found
}

/// At each time the largest of the values whose own times are so near; both ascend.
fn largest_near(time_s: &[f64], (own_s, values): (&[f64], &[f64]), slack_s: f64) -> Vec<f64> {
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

/// The largest powers of each block, measured and predicted near.
pub(super) fn by_block(
    curve: &Curve,
    log: &PowerTrace,
    near_w: &[f64],
    place: Place,
) -> Vec<BlockPeaks> {
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
