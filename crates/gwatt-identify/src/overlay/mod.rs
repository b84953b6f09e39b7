//! A recording of the power that a machine draws, laid over its prediction.
//!
//! Input: the predicted power of a program as a [`Curve`], and a [`PowerTrace`]. Output: when
//! the program begins in the log and at what pace it runs, how long the meter averages, how far
//! both agree, and by which factor measured peaks exceed predicted ones, of all, block by block
//! and, where the log has them, axis by axis.

mod align;
mod axes;
mod curve;
mod line;
mod meter;
mod peaks;
mod refined;
mod tops;
mod trace;

pub use axes::{AxisCurve, AxisFactor};
pub use curve::Curve;
pub use peaks::BlockPeaks;
pub use trace::{AxisTrace, PowerTrace};

use crate::error::{IdentifyError, Outcome};
use crate::peak_factor::PeakFactor;
use align::align;
use meter::{INSTANT, correlation, shown};
use refined::refined;
use std::ops::RangeInclusive;
use tops::Model;

/// Correlation from which on the log is that of the program.
const SAME: f64 = 0.7;
/// How many times the prediction a measured power may be, of the program in the same unit.
const UNITS: RangeInclusive<f64> = 0.1..=10.0;
/// Correlation from which on both go together in time.
const TOGETHER: f64 = 0.9;

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
    /// By which factor peaks exceed their prediction; not less than `gain`.
    pub factor: PeakFactor,
    /// The error of the largest of them: two standard deviations.
    pub factor_error: f64,
    /// Peaks that have too few samples for a factor of their own.
    pub short_peaks: usize,
    /// Whether the largest is among these, or most are.
    pub is_sampled_slowly: bool,
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
    /// Both go together, and peaks are too short for the samples: margins rest on `gain`.
    SampledSlowly,
    /// The program does not run as planned: feeds, overrides or waits differ along it.
    RunsOtherwise,
    /// Both go together, and one is many times the other.
    AnotherUnit,
    /// The log is not that of this program.
    AnotherProgram,
}

impl Agreement {
    /// In a few words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::SampledSlowly => "sampled too slowly for peaks",
            Self::RunsOtherwise => "runs otherwise",
            Self::AnotherUnit => "another unit",
            Self::AnotherProgram => "another program",
        }
    }

    /// Whether the log is that of the program as it was planned.
    #[must_use]
    pub fn is_of_the_program(self) -> bool {
        matches!(self, Self::Good | Self::SampledSlowly)
    }
}

impl Overlay {
    /// What the figures are good for.
    #[must_use]
    pub fn agreement(&self) -> Agreement {
        match self.correlation {
            r if r >= SAME && !UNITS.contains(&self.gain) => Agreement::AnotherUnit,
            r if r >= TOGETHER && self.is_sampled_slowly => Agreement::SampledSlowly,
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
    let (place, averaging_s) = refined(curve, log, place);
    let width_s = averaging_s.max(log.step_s() * INSTANT);
    let predicted_w = shown(curve, &log.time_s, place, width_s);
    let model = |curve| Model {
        curve,
        part: None,
        place,
        width_s,
    };
    let peaks = peaks::compare(&model(curve), log);
    let line = peaks.line;
    let pairs = axes.iter().filter_map(|axis| {
        let own = log.axes.iter().find(|own| own.letter == axis.letter)?;
        Some((axis, axes::factor(axis, own, log, (place, width_s))?))
    });
    let pairs: Vec<(&AxisCurve, AxisFactor)> = pairs.collect();
    let more = pairs.iter().map(|(axis, it)| (it.motor - 1.0, &axis.accel));
    let factor_beyond_axes = if pairs.is_empty() {
        peaks.factor
    } else {
        peaks::compare_raised(&model(&curve.raised(more)), log).factor
    };
    Ok(Overlay {
        start_s: place.start_s,
        pace: place.pace(curve),
        correlation: correlation(&log.power_w, &predicted_w),
        averaging_s,
        gain: line.gain,
        offset_w: line.offset_w,
        rms_w: line.rms_w,
        energy_ratio: line.energy_ratio,
        measured_peak_w: line.measured_peak_w,
        factor: peaks.factor,
        factor_error: peaks.error,
        short_peaks: peaks.short,
        is_sampled_slowly: peaks.is_sampled_slowly,
        axes: pairs.into_iter().map(|(_, factor)| factor).collect(),
        factor_beyond_axes,
        blocks: peaks::by_block(curve, log, &peaks.near_w, place),
        predicted_w,
    })
}
