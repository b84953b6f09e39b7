//! How many poles and zeros, and how much delay: models of growing order, each
//! started from the measured frequency response, and the one that Bayes'
//! criterion prefers.

use super::data::Data;
use super::neighbours::{Given, LAG_MAX, ORDER_MAX, are_alike, neighbours, restarts};
use super::noise::{Whiteness, whitening};
use super::output_error::{Effort, Estimate, refine, residuals};
use super::response_fit::grow;
use super::spectrum::{FrequencyResponse, measure};
use super::subspace::{Subspace, with_poles};
use super::transfer::TransferFunction;

/// Samples on which models are compared; the last fit takes all.
const COMPARED: usize = 8_000;
/// A model better by this much is gone on from without looking at others.
const CLEAR: f64 = 4.0;
/// By how much a delay between samples has to be better than one of whole
/// periods.
const CLEAR_DELAY: f64 = 10.0;
/// A model better by less is the same one.
const WORTH: f64 = 0.5;
/// Steps of each fit on the way.
const SEARCH_STEPS: usize = 20;
/// Steps of all of them at most: a recording that no model explains to its last
/// digit is not worth minutes.
const STEPS_MAX: usize = 500;
const STEPS_LAST: usize = 200;
/// Rounds of model and noise.
const ROUNDS_OF_NOISE: usize = 4;
/// Steps from model to model at most.
const ROUNDS_MAX: usize = 12;
/// Order of the filter that makes noise white, at most.
const WHITENING_MAX: usize = 40;
/// Lags over which residuals are tested.
pub const LAGS: usize = 40;

/// A model with how it was found.
#[derive(Debug, Clone)]
pub struct Found {
    /// The model.
    pub estimate: Estimate,
    /// Whether the delay was fitted.
    pub delay_is_free: bool,
    /// Taps of the filter that made the noise white.
    pub whitening: Vec<f64>,
    /// The measured frequency response.
    pub response: FrequencyResponse,
}

/// Searches for the model. `None` if none can be fitted.
#[must_use]
pub fn search(data: &Data<'_>, instrument: Option<&[f64]>, given: Given) -> Option<Found> {
    let response = response_of(data, instrument, None)?;
    let short = data.head(COMPARED);
    let mut taps: Vec<f64> = Vec::new();
    let mut best: Option<(Estimate, bool, Vec<f64>)> = None;
    // Noise that is not white shows only behind a model, and the model only
    // when the noise is known: a few rounds settle both, each from where the one
    // before came to.
    for _ in 0..ROUNDS_OF_NOISE {
        let before = best.as_ref().map(|(best, ..)| &best.transfer);
        let Some((found, delay_is_free)) = ladder(&short, &response, given, &taps, before) else {
            break;
        };
        let left = residuals(&short, &found)?;
        let exact = found.rest <= 1e-12 * found.power;
        let is_white = || Whiteness::of(filtered(&left, &taps).as_slice(), LAGS).is_white();
        let next = (!exact && !is_white()).then(|| whitening(&left, WHITENING_MAX));
        best = Some((found, delay_is_free, taps));
        match next {
            Some(next) => taps = next,
            None => break,
        }
    }
    let (short_estimate, delay_is_free, taps) = best?;
    let estimate = refine(
        data,
        &short_estimate.transfer,
        delay_is_free,
        &taps,
        Effort::FULL,
    )?;
    Some(Found {
        estimate,
        delay_is_free,
        whitening: taps,
        response,
    })
}

/// The measured response; of positions by their second differences, as slow
/// motion would leak into fast.
#[must_use]
pub fn response_of(
    data: &Data<'_>,
    instrument: Option<&[f64]>,
    stretch: Option<usize>,
) -> Option<FrequencyResponse> {
    if !data.positions {
        return measure(data.input, data.output, instrument, data.period_s, stretch);
    }
    let twice = |x: &[f64]| filtered(x, &[-2.0, 1.0]);
    let (input, output) = (twice(data.input), twice(data.output));
    measure(&input, &output, instrument, data.period_s, stretch)
}

/// A signal behind the whitening filter, its beginning left out.
#[must_use]
pub fn filtered(x: &[f64], taps: &[f64]) -> Vec<f64> {
    let order = taps.len();
    x.windows(order + 1)
        .map(|window| {
            let past = window.iter().rev().skip(1);
            let sum: f64 = past.zip(taps).map(|(x, tap)| x * tap).sum();
            sum + window.last().copied().unwrap_or_default()
        })
        .collect()
}

/// Models of growing order; the best, and whether its delay is free.
fn ladder(
    data: &Data<'_>,
    response: &FrequencyResponse,
    given: Given,
    taps: &[f64],
    before: Option<&TransferFunction>,
) -> Option<(Estimate, bool)> {
    let mut starts = starts(data, response, given);
    starts.extend(before.cloned());
    let mut best: Option<Estimate> = None;
    for start in starts {
        let effort = Effort {
            steps: SEARCH_STEPS,
            to_beat: f64::MAX,
        };
        if let Some(found) = refine(data, &start, false, taps, effort)
            && is_better(&found, best.as_ref())
        {
            best = Some(found);
        }
    }
    let mut best = best?;
    // Where the first model is taken from, what shows is mostly right, and the
    // rest not.
    let mut is_restarted = true;
    let mut idle = 0;
    // What comes after another round has little left to look for.
    let (mut left, mut spare) = match before {
        Some(_) => (STEPS_LAST, STEPS_LAST),
        None => (STEPS_MAX, 3 * STEPS_LAST),
    };
    let mut tried = vec![best.transfer.clone()];
    for _ in 0..ROUNDS_MAX {
        let mut top: Option<Estimate> = None;
        let next = if is_restarted {
            restarts(&best.transfer, response, given, data.period_s)
        } else {
            neighbours(&best.transfer, response, given, data.period_s)
        };
        for start in next {
            if left == 0 {
                break;
            }
            if tried.iter().any(|other| are_alike(other, &start)) {
                continue;
            }
            tried.push(start.clone());
            let effort = Effort {
                steps: SEARCH_STEPS,
                to_beat: top.as_ref().unwrap_or(&best).criterion(),
            };
            let found = refine(data, &start, false, taps, effort);
            left = left.saturating_sub(found.as_ref().map_or(1, |found| found.steps));
            if let Some(found) = found
                && is_better(&found, top.as_ref())
            {
                let is_clear = found.criterion() < best.criterion() - CLEAR;
                top = Some(found);
                if is_clear {
                    break;
                }
            }
        }
        // Something is left for what comes next, to leave a wrong path.
        let more = STEPS_LAST.saturating_sub(left).min(spare);
        left += more;
        spare -= more;
        let before = best.criterion();
        if let Some(top) = top.filter(|top| is_better(top, Some(&best))) {
            tried.push(top.transfer.clone());
            best = top;
        }
        if best.criterion() < before - WORTH {
            is_restarted = false;
            idle = 0;
        } else if idle == 1 {
            break;
        } else {
            is_restarted = !is_restarted;
            idle = 1;
        }
    }
    if given.delay_s.is_some() {
        return Some((best, false));
    }
    Some(any_delay(data, best, taps))
}

/// Models to start from: those that fit the frequency response best, for the
/// best delay and the one a period shorter (with a held input, a model without
/// direct path may as well be one with it, a period later).
fn starts(data: &Data<'_>, response: &FrequencyResponse, given: Given) -> Vec<TransferFunction> {
    let t = data.period_s;
    let lags: Vec<usize> = match given.delay_s {
        Some(delay) => vec![libm::round(delay / t) as usize],
        None => (0..=LAG_MAX).collect(),
    };
    let mut fits: Vec<(f64, TransferFunction)> = Vec::new();
    let mut worse_in_a_row = 0;
    let mut least = f64::MAX;
    for lag in lags {
        let Some(fit) = grow(response, lag, given.order, ORDER_MAX, t) else {
            continue;
        };
        let criterion = fit.criterion();
        worse_in_a_row = if criterion < least {
            0
        } else {
            worse_in_a_row + 1
        };
        least = least.min(criterion);
        fits.push((criterion, fit.transfer));
        if worse_in_a_row >= 2 {
            break;
        }
    }
    fits.sort_by(|a, b| a.0.total_cmp(&b.0));
    fits.into_iter()
        .take(3)
        .map(|(_, transfer)| TransferFunction {
            delay_s: given.delay_s.unwrap_or(transfer.delay_s),
            ..transfer
        })
        .chain(from_subspace(data, given))
        .collect()
}

/// Models from subspaces of the data: good where there is little noise.
fn from_subspace(data: &Data<'_>, given: Given) -> Vec<TransferFunction> {
    let Some(subspace) = Subspace::new(data.input, data.output) else {
        return Vec::new();
    };
    let far = 1.5 * std::f64::consts::PI / data.period_s;
    let orders = match given.order {
        Some(order) => vec![order],
        None => vec![2, 4, 6],
    };
    orders
        .into_iter()
        .filter_map(|order| {
            let model = with_poles(subspace.poles(order)?, data.input, data.output)?;
            let start = model.to_continuous(data.period_s, far).ok()?;
            Some(TransferFunction {
                delay_s: given.delay_s.unwrap_or(0.0),
                ..start
            })
        })
        .collect()
}

fn is_better(found: &Estimate, than: Option<&Estimate>) -> bool {
    than.is_none_or(|than| found.criterion() < than.criterion())
}

/// The delay set free, if that is clearly worth a parameter: beside a fast zero
/// and a fast pole it makes all of them uncertain.
fn any_delay(data: &Data<'_>, best: Estimate, taps: &[f64]) -> (Estimate, bool) {
    let t = data.period_s;
    for part in [0.3, -0.3] {
        let mut start = best.transfer.clone();
        start.delay_s += part * t;
        if start.delay_s < 0.0 {
            continue;
        }
        if let Some(found) = refine(data, &start, true, taps, Effort::FULL)
            && found.criterion() < best.criterion() - CLEAR_DELAY
        {
            return (found, true);
        }
    }
    (best, false)
}
