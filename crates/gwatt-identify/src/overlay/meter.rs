//! The prediction as the meter of the log would show it.

use super::align::Place;
use super::curve::Curve;
use super::trace::PowerTrace;

/// What stands for an instantaneous sample, as a share of the time between two.
pub(super) const INSTANT: f64 = 1e-3;
/// Samples by which measured and predicted power may differ in time, at most.
pub(super) const SLACK: f64 = 2.0;

/// The prediction as a meter shows it that averages over `width_s`: at each time the mean up to
/// it.
pub(super) fn shown(curve: &Curve, times_s: &[f64], place: Place, width_s: f64) -> Vec<f64> {
    let pace = place.pace(curve);
    let at = |t: f64| (t - place.start_s) / pace;
    let first_s = times_s.first().copied().unwrap_or_default();
    let mut from = curve.reader_from(at(first_s - width_s));
    let mut to = curve.reader_from(at(first_s));
    let means = times_s.iter().map(|t| {
        let energy_j = to.energy_j(at(*t)) - from.energy_j(at(t - width_s));
        energy_j * pace / width_s
    });
    means.collect()
}

/// The times of samples, and those at which pieces of the curve end, in order: a mean over a ramp
/// is largest at its end.
pub(super) fn times_looked_at(curve: &Curve, log: &PowerTrace, place: Place) -> Vec<f64> {
    let pace = place.pace(curve);
    let ends = curve.times_s().iter().map(|t| place.start_s + t * pace);
    let mut looked_at_s: Vec<f64> = ends.chain(log.time_s.iter().copied()).collect();
    looked_at_s.sort_by(f64::total_cmp);
    looked_at_s
}

/// Pearson's correlation of two series of the same length.
pub(super) fn correlation(a: &[f64], b: &[f64]) -> f64 {
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
