//! Pairs of a pole and a zero that stand for friction.
//!
//! When an axis turns round it may stick for a part of a sample, and the sign of its speed
//! is known but roughly meanwhile. What that leaves comes in bursts, as many as there are
//! reversals; a criterion that counts on noise of one strength takes them for modes, each
//! nearly undone by a zero. Where what is left comes and goes, such a pair has to explain
//! more than a little of it.

use nalgebra::DVector;

use super::candidate_models::{CANCELLED_SHARE, cancelled, lean};
use super::chosen::{Chosen, LAGS, filtered, many};
use super::data::Data;
use super::estimate::Estimate;
use super::noise::Whiteness;
use super::output_error::{Effort, Fitting, residuals};
use super::parameters::parameters;
use super::stepwise_search::SEARCH_STEPS;
use super::transfer::TransferFunction;

/// Fourth moment by the square of the second one: of normal noise, and from which on noise
/// comes in bursts; a sensor's steps have less.
const NORMAL: f64 = 3.0;
const BURSTS: f64 = 4.0;
/// By which share the squares of what is left may grow without all pairs that go.
const LITTLE: f64 = 0.25;

/// The model without the pairs that explain little of what comes and goes; on these samples,
/// after these taps.
#[must_use]
pub fn without_its_pairs(data: &Data<'_>, taps: &[f64], chosen: &Chosen) -> TransferFunction {
    let model = &chosen.found.transfer;
    if lesser(model).is_empty() {
        return model.clone();
    }
    let fitting = Fitting::new(*data, taps);
    let effort = Effort {
        steps: SEARCH_STEPS,
        to_beat: f64::MAX,
    };
    let fit = |from: &TransferFunction| fitting.refine(from, chosen.delay_is_free, effort);
    let Some(mut best) = fit(model) else {
        return model.clone();
    };
    let comes_in_bursts = |found: Estimate| {
        let left = residuals(data, &fitting.settled(found)?)?;
        Some(has_bursts(&filtered(&left, taps)))
    };
    if !comes_in_bursts(best.clone()).unwrap_or(false) {
        return model.clone();
    }
    let most = (1.0 + LITTLE) * best.rest;
    loop {
        let less = lesser(&best.transfer);
        let fitted = less.iter().filter_map(fit);
        let least = fitted.min_by(|a, b| a.rest.total_cmp(&b.rest));
        match least.filter(|least| least.rest <= most) {
            Some(least) => best = least,
            None => return best.transfer,
        }
    }
}

/// Models without a pair, and with nothing but what swings.
fn lesser(model: &TransferFunction) -> Vec<TransferFunction> {
    let mut out = cancelled(model, CANCELLED_SHARE);
    let swinging = lean(model, f64::INFINITY);
    if swinging.order() < model.order() {
        out.push(swinging);
    }
    out
}

/// An estimate next to friction with errors that hold in bursts: where the fourth moment is
/// so many times that of normal noise, so many times fewer samples say what noise is.
#[must_use]
pub fn with_errors_of_bursts(data: &Data<'_>, taps: &[f64], mut found: Estimate) -> Estimate {
    if !data.friction.is_empty()
        && let Some(left) = residuals(data, &found)
    {
        let wider = (fourth_moment(&filtered(&left, taps)) / NORMAL).max(1.0);
        found.covariance *= wider;
        for figure in &mut found.friction {
            figure.std *= wider.sqrt();
        }
    }
    found
}

/// An estimate with errors of how an axis turns round: by as much as figures are other ones
/// where nothing is known of that, they are in doubt.
#[must_use]
pub fn with_errors_of_turning(data: &Data<'_>, taps: &[f64], mut found: Estimate) -> Estimate {
    if data.turning == 0 {
        return found;
    }
    let delay_is_free = found.count > parameters(&found.transfer, false).len();
    let fit = |data: Data<'_>, from: &TransferFunction| {
        let fitting = Fitting::new(data, taps);
        fitting.refine(from, delay_is_free, Effort::FULL)
    };
    // How it turns round is the same all the time.
    let first = many(data);
    let known = first.and_then(|first| fit(first, &found.transfer));
    let known = known.map_or_else(|| found.transfer.clone(), |known| known.transfer);
    let looked_at = first.unwrap_or(*data);
    if let Some(other) = fit(looked_at.without_turning(), &known) {
        let of = |model: &TransferFunction| parameters(model, delay_is_free);
        let apart = of(&known).into_iter().zip(of(&other.transfer));
        let apart = apart.map(|(a, b)| a - b);
        let apart = DVector::from_iterator(found.count, apart);
        if apart.len() == found.covariance.nrows() {
            found.covariance += &apart * apart.transpose();
        }
    }
    found
}

/// Fourth moment by the square of the second one.
fn fourth_moment(x: &[f64]) -> f64 {
    let n = x.len().max(1) as f64;
    let mean = x.iter().map(|x| x * x).sum::<f64>() / n;
    let fourth = x.iter().map(|x| x * x * x * x).sum::<f64>() / n;
    let moment = fourth / (mean * mean);
    if moment.is_finite() { moment } else { NORMAL }
}

/// Whether noise is not of one strength.
fn has_bursts(x: &[f64]) -> bool {
    let squares: Vec<f64> = x.iter().map(|x| x * x).collect();
    fourth_moment(x) > BURSTS || !Whiteness::of(&squares, LAGS).is_white()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bursts_are_not_noise_of_one_strength() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let even: Vec<f64> = (0..2000).map(|_| uniform()).collect();
        assert!(!has_bursts(&even));
        // From −½ to ½: 1/80 by (1/12)².
        assert!((fourth_moment(&even) - 1.8).abs() < 0.05);
        assert!((fourth_moment(&[0.0; 4]) - NORMAL).abs() < 1e-12);
        let mut burst = even.clone();
        for x in burst.iter_mut().step_by(100) {
            *x *= 5.0;
        }
        assert!(has_bursts(&burst));
    }
}
