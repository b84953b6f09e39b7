//! The prediction as the meter of the log would show it.

use super::align::Place;
use super::curve::Curve;
use super::trace::PowerTrace;

/// Samples by which measured and predicted power may differ in time.
pub(super) const SLACK: f64 = 2.0;

/// The prediction as a meter shows it that averages over `width_s`: at each time the mean up to
/// it.
pub(super) fn shown(curve: &Curve, times_s: &[f64], place: Place, width_s: f64) -> Vec<f64> {
    let pace = place.pace(curve);
    let (mut from, mut to) = (curve.reader(), curve.reader());
    let at = |t: f64| (t - place.start_s) / pace;
    let means = times_s.iter().map(|t| {
        let energy_j = to.energy_j(at(*t)) - from.energy_j(at(t - width_s));
        energy_j * pace / width_s
    });
    means.collect()
}

/// The times of samples, and those at which pieces of the curve end, in order.
pub(super) fn times_looked_at(curve: &Curve, log: &PowerTrace, place: Place) -> Vec<f64> {
    let pace = place.pace(curve);
    let ends = curve.times_s().iter().map(|t| place.start_s + t * pace);
    let mut looked_at_s: Vec<f64> = ends.chain(log.time_s.iter().copied()).collect();
    looked_at_s.sort_by(f64::total_cmp);
    looked_at_s
}
