//! The power of single axes next to its prediction: by which factor their acceleration draws
//! more.
//!
//! A servo factor multiplies the acceleration, not the friction. Of each recorded power the least
//! factor counts with which the prediction reaches it somewhere near that time; samples around a
//! top, fitted by the prediction, may show a larger one.

use super::align::Place;
use super::curve::Curve;
use super::meter::{SLACK, shown, times_looked_at};
use super::tops::{Model, tops};
use super::trace::{AxisTrace, PowerTrace};
use crate::peak_factor::HALF;

/// Share of the predicted power that the acceleration must have: where friction is most of it,
/// more power says nothing of the acceleration.
const LEADS: f64 = 0.5;

/// The predicted power of one axis.
#[derive(Debug, Clone, Default)]
pub struct AxisCurve {
    /// The letter of the axis, large.
    pub letter: char,
    /// What it draws, W; negative where it feeds back.
    pub power: Curve,
    /// By how much that grows, W, where the acceleration is twice as large: what its servo
    /// factor multiplies. 0 where it draws nothing.
    pub accel: Curve,
}

/// By which factor the acceleration of an axis draws more than predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisFactor {
    /// The letter of the axis, large.
    pub letter: char,
    /// `servo_factor_motor` with which no peak exceeds its prediction; at least 1.
    pub motor: f64,
    /// The peaks in which it speeds up.
    pub peaks: usize,
    /// The largest power measured, W.
    pub measured_peak_w: f64,
    /// The largest power predicted, W.
    pub predicted_peak_w: f64,
}

/// The factor of an axis; `None` where the log has no peak of its acceleration.
pub(super) fn factor(
    curve: &AxisCurve,
    own: &AxisTrace,
    log: &PowerTrace,
    (place, width_s): (Place, f64),
) -> Option<AxisFactor> {
    let slack_s = SLACK * log.step_s() + width_s / 2.0;
    let looked_at_s = times_looked_at(&curve.power, log, place);
    let power = shown(&curve.power, &looked_at_s, place, width_s);
    let accel = shown(&curve.accel, &looked_at_s, place, width_s);
    let points: Vec<(f64, f64, f64)> = looked_at_s
        .iter()
        .zip(power.iter().zip(&accel))
        .map(|(t, (power_w, accel_w))| (*t, *power_w, *accel_w))
        .collect();
    let predicted_peak_w = power.iter().copied().fold(0.0, f64::max);
    let (mut from, mut is_inside) = (0, false);
    let (mut motor, mut peaks, mut measured_peak_w) = (1.0_f64, 0, 0.0_f64);
    for (t, measured_w) in log.time_s.iter().zip(&own.power_w) {
        while points.get(from).is_some_and(|it| it.0 < t - slack_s) {
            from += 1;
        }
        if !(place.start_s..=place.end_s).contains(t) || measured_w.is_nan() {
            continue;
        }
        measured_peak_w = measured_peak_w.max(*measured_w);
        let near = points.get(from..).unwrap_or_default();
        let near = near.iter().take_while(|it| it.0 <= t + slack_s);
        let most = near.clone().max_by(|a, b| a.1.total_cmp(&b.1));
        let is_peak = most.is_some_and(|(_, power_w, accel_w)| {
            *power_w > 0.0 && *power_w >= HALF * predicted_peak_w && *accel_w >= LEADS * power_w
        });
        if is_peak {
            let needed = near.filter(|it| it.2 > 0.0);
            let needed = needed.map(|(_, power_w, accel_w)| 1.0 + (measured_w - power_w) / accel_w);
            motor = motor.max(needed.fold(f64::INFINITY, f64::min));
            peaks += usize::from(!is_inside);
        }
        is_inside = is_peak;
    }
    let model = Model {
        curve: &curve.power,
        part: Some(&curve.accel),
        place,
        width_s,
    };
    (peaks > 0 && motor.is_finite()).then(|| AxisFactor {
        letter: curve.letter,
        motor: motor.max(fitted(&model, own, log, predicted_peak_w)),
        peaks,
        measured_peak_w,
        predicted_peak_w,
    })
}

/// The largest factor that fits the samples of a peak, or those of all peaks together.
fn fitted(model: &Model<'_>, own: &AxisTrace, log: &PowerTrace, peak_w: f64) -> f64 {
    let (accel_w, fixed_w) = model.at(&log.time_s, 0.0);
    // Where friction leads there is no top.
    let rows = accel_w.iter().zip(&fixed_w).map(|(accel, fixed)| {
        if *accel >= LEADS * (accel + fixed) {
            accel + fixed
        } else {
            f64::NEG_INFINITY
        }
    });
    let rows: Vec<f64> = rows.collect();
    let found = tops(model, log, &own.power_w, (&rows, peak_w)).found;
    let (mut both, mut square) = (0.0, 0.0);
    let samples = log.time_s.iter().zip(&own.power_w).zip(&rows);
    for (((t, own), whole), (accel, fixed)) in samples.zip(accel_w.iter().zip(&fixed_w)) {
        let is_inside = (model.place.start_s..=model.place.end_s).contains(t);
        if is_inside && *whole >= HALF * peak_w && !own.is_nan() {
            both += accel * (own - fixed);
            square += accel * accel;
        }
    }
    let of_all = if square > 0.0 { both / square } else { 1.0 };
    found.iter().map(|it| it.factor).fold(of_all, f64::max)
}
