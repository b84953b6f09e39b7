//! A recording of the power that a machine draws, laid over its prediction.
//!
//! Input: the predicted power of a program as a [`Curve`], and a [`PowerTrace`]. Output: when
//! the program begins in the log and at what pace it runs, how long the meter averages, how far
//! both agree, and by which factor measured peaks exceed predicted ones, of all, block by block
//! and, where the log has them, axis by axis.

mod align;
mod axes;
mod curve;
mod meter;
mod peaks;
mod trace;

pub use axes::{AxisCurve, AxisFactor};
pub use curve::Curve;
use meter::{SLACK, shown, times_looked_at};
pub use peaks::BlockPeaks;
pub use trace::{AxisTrace, PowerTrace};

use crate::error::{IdentifyError, Outcome};
use crate::peak_factor::PeakFactor;
use align::{Place, align};

/// Correlation from which on the log is that of the program.
const SAME: f64 = 0.7;
/// Correlation from which on both go together in time.
const TOGETHER: f64 = 0.9;
/// Samples of a meter that are averaged over, and by which share of what is missing to 1 the
/// correlation must be better for it to count.
const AVERAGED: [f64; 10] = [1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 35.0, 60.0];
const WORTH: f64 = 0.1;
/// What stands for an instantaneous sample, as a share of the time between two.
const INSTANT: f64 = 1e-3;
/// Shifts that are tried with each, in samples.
const SHIFTS: [f64; 8] = [-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0];

/// What laying both over each other comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// When the program begins, s, in the time of the log.
    pub start_s: f64,
    /// The time that it takes by the time that is planned.
    pub pace: f64,
    /// Pearson's correlation, over the whole log.
    pub correlation: f64,
    /// For how long the meter averages, s; 0 where its samples are as good as instantaneous.
    pub averaging_s: f64,
    /// Measured power by predicted, less `offset_w`, as least squares find them while the
    /// program runs.
    pub gain: f64,
    /// What is measured where nothing is predicted, W.
    pub offset_w: f64,
    /// Root of the mean square of measured less predicted power while the program runs, W.
    pub rms_w: f64,
    /// Energy measured by energy predicted, while the program runs.
    pub energy_ratio: f64,
    /// The largest power measured while the program runs, W.
    pub measured_peak_w: f64,
    /// By which factor peaks exceed their prediction.
    pub factor: PeakFactor,
    /// By which factors the acceleration of axes draws more, where the log has their powers.
    pub axes: Vec<AxisFactor>,
    /// By which factor peaks exceed the prediction that has these.
    pub factor_beyond_axes: PeakFactor,
    /// The largest powers of each block, in order of their numbers.
    pub blocks: Vec<BlockPeaks>,
    /// The prediction as the meter would show it, W, at each sample of the log.
    pub predicted_w: Vec<f64>,
}

/// What the figures are good for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Agreement {
    /// Both go together: peaks can be compared.
    Good,
    /// The program does not run as planned: feeds, overrides or waits differ along it.
    RunsOtherwise,
    /// The log is not that of this program.
    AnotherProgram,
}

impl Agreement {
    /// In a few words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::RunsOtherwise => "runs otherwise",
            Self::AnotherProgram => "another program",
        }
    }
}

impl Overlay {
    /// What the figures are good for.
    #[must_use]
    pub fn agreement(&self) -> Agreement {
        match self.correlation {
            r if r >= TOGETHER => Agreement::Good,
            r if r >= SAME => Agreement::RunsOtherwise,
            _ => Agreement::AnotherProgram,
        }
    }

    /// The margin with which all measured peaks stay within the converter's power where the
    /// predicted ones do: `limits.margin` of a machine file.
    #[must_use]
    pub fn margin(&self) -> f64 {
        1.0 - 1.0 / self.factor.seen
    }

    /// The same where the machine file has the factors of axes that were found.
    #[must_use]
    pub fn margin_beyond_axes(&self) -> f64 {
        1.0 - 1.0 / self.factor_beyond_axes.seen
    }

    /// The margin for 95 % of peaks that were not recorded, with 95 % confidence.
    #[must_use]
    pub fn margin_of_others(&self) -> f64 {
        1.0 - 1.0 / self.factor.factor
    }
}

/// Lays a log over a prediction; `axes`: the same of single axes, with points at the same times.
///
/// # Errors
/// When the program takes no time, or nothing of both goes up and down together.
pub fn overlay(curve: &Curve, axes: &[AxisCurve], log: &PowerTrace) -> Outcome<Overlay> {
    if curve.duration_s() <= 0.0 {
        return Err(IdentifyError::new(
            "the program takes no time",
            "verify a program that moves",
        ));
    }
    let place = align(curve, log).ok_or_else(|| {
        IdentifyError::new(
            "the log does not go up and down as the program would",
            "record the same program, from before it begins until it has ended",
        )
    })?;
    let (place, averaging_s) = averaged(curve, log, place);
    let width_s = averaging_s.max(log.step_s() * INSTANT);
    let predicted_w = shown(curve, &log.time_s, place, width_s);
    let pace = place.pace(curve);
    let running: Vec<(f64, f64)> = log
        .time_s
        .iter()
        .zip(log.power_w.iter().zip(&predicted_w))
        .filter(|(t, _)| (place.start_s..=place.end_s).contains(*t))
        .map(|(_, (measured, predicted))| (*measured, *predicted))
        .collect();
    let n = running.len().max(1) as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| running.iter().map(of).sum::<f64>() / n;
    let (measured, predicted) = (mean(|it| it.0), mean(|it| it.1));
    let (mut both, mut square, mut error) = (0.0, 0.0, 0.0);
    for (own, model) in &running {
        both += (own - measured) * (model - predicted);
        square += (model - predicted) * (model - predicted);
        error += (own - model) * (own - model);
    }
    let gain = if square > 0.0 { both / square } else { 1.0 };
    let pairs = axes.iter().filter_map(|axis| {
        let own = log.axes.iter().find(|own| own.letter == axis.letter)?;
        Some((axis, axes::factor(axis, own, log, place, width_s)?))
    });
    let pairs: Vec<(&AxisCurve, AxisFactor)> = pairs.collect();
    let more = pairs.iter().map(|(axis, it)| (it.motor - 1.0, &axis.accel));
    let near_w = largest_near(curve, log, place, width_s);
    let peaks = peaks::compare(curve, log, &near_w, place);
    let factor_beyond_axes = if pairs.is_empty() {
        peaks.factor
    } else {
        let near_w = largest_near(&curve.raised(more), log, place, width_s);
        peaks::factor(log, &near_w, place)
    };
    Ok(Overlay {
        start_s: place.start_s,
        pace,
        correlation: correlation(&log.power_w, &predicted_w),
        averaging_s,
        gain,
        offset_w: measured - gain * predicted,
        rms_w: (error / n).sqrt(),
        energy_ratio: measured / predicted,
        measured_peak_w: running.iter().map(|it| it.0).fold(0.0, f64::max),
        factor: peaks.factor,
        axes: pairs.into_iter().map(|(_, factor)| factor).collect(),
        factor_beyond_axes,
        blocks: peaks.blocks,
        predicted_w,
    })
}

/// For how long the meter averages, with the place that goes with it: what it shows comes half
/// of that late, which the place was found without.
fn averaged(curve: &Curve, log: &PowerTrace, place: Place) -> (Place, f64) {
    let step_s = log.step_s();
    let judged = |shift_s: f64, averaging_s: f64| {
        let moved = Place {
            start_s: place.start_s + shift_s,
            end_s: place.end_s + shift_s,
            ..place
        };
        let shown = shown(curve, &log.time_s, moved, averaging_s.max(step_s * INSTANT));
        (correlation(&log.power_w, &shown), moved, averaging_s)
    };
    // The best of a few shifts by less than a sample, each way.
    let best_of = |averaging_s: f64| {
        let mut best = judged(-averaging_s / 2.0, averaging_s);
        for shift in SHIFTS {
            let found = judged(shift * step_s - averaging_s / 2.0, averaging_s);
            if found.0 > best.0 {
                best = found;
            }
        }
        best
    };
    let mut best = best_of(0.0);
    let mut worse = 0;
    for samples in AVERAGED {
        let averaging_s = samples * step_s;
        if averaging_s > place.pace(curve) * curve.duration_s() / 10.0 || worse > 2 {
            break;
        }
        let found = best_of(averaging_s);
        if found.0 > best.0 + WORTH * (1.0 - best.0) {
            best = found;
            worse = 0;
        } else {
            worse += 1;
        }
    }
    (best.1, best.2)
}

/// The largest power that is predicted near each sample, as the meter would show it: looked at
/// where samples are, and where pieces of the curve end, since a mean over a ramp is largest at
/// its end.
fn largest_near(curve: &Curve, log: &PowerTrace, place: Place, width_s: f64) -> Vec<f64> {
    let slack_s = SLACK * log.step_s() + width_s / 2.0;
    let looked_at_s = times_looked_at(curve, log, place);
    let shown = shown(curve, &looked_at_s, place, width_s);
    peaks::largest_near(&log.time_s, (&looked_at_s, &shown), slack_s)
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().max(1) as f64;
    let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        let (a, b) = (a - mean_a, b - mean_b);
        ab += a * b;
        aa += a * a;
        bb += b * b;
    }
    if aa > 0.0 && bb > 0.0 {
        ab / (aa * bb).sqrt()
    } else {
        0.0
    }
}
