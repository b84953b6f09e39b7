//! The methods that estimate a flexible axis, with one interface.

use std::ops::RangeInclusive;

use super::arx;
use super::candidate_models::{Given, LAG_MAX, ORDER_MAX};
use super::choice::Method;
use super::chosen::CHOSEN;
use super::data::Data;
use super::discrete::Discrete;
use super::disturbance::as_it_is;
use super::estimate::Estimate;
use super::friction_loop::FrictionLoop;
use super::measured_noise::Noise;
use super::prepared::Prepared;
use super::response_fit;
use super::search::{response_of, search};
use super::spectrum::FrequencyResponse;
use super::subspace::{Subspace, with_poles};
use super::transfer::TransferFunction;

/// Models of other delays that are compared on more frequencies.
const GROWN: usize = 3;

/// A model with what is known of it.
pub(super) struct Modelled {
    pub(super) estimate: Estimate,
    pub(super) delay_is_free: bool,
    /// How far the delay is in doubt besides, s.
    pub(super) delay_doubt_s: f64,
    pub(super) noise: Noise,
    /// The loop through which noise came, where friction made one.
    pub(super) friction_loop: Option<FrictionLoop>,
    pub(super) response: FrequencyResponse,
    pub(super) has_errors: bool,
}

/// A way to estimate a flexible axis.
pub(super) trait Estimator {
    /// The model of a recording, as far as it is not given. `None` where none fits.
    fn estimate(&self, data: &Data<'_>, prepared: &Prepared, given: Given) -> Option<Modelled>;

    /// Whether the delay is looked for; else it is none, or given.
    fn finds_delay(&self) -> bool {
        false
    }

    /// Whether friction may be a term of the model.
    fn has_friction(&self) -> bool {
        false
    }

    /// Whether standard errors hold for noise of any colour.
    fn knows_colour(&self) -> bool {
        false
    }
}

/// The estimator of a method.
pub(super) fn estimator(method: Method) -> &'static dyn Estimator {
    match method {
        Method::Iv => &Instruments,
        Method::Frequency => &Response,
        Method::Arx => &Arx,
        Method::Subspace => &Subspaces,
    }
}

/// Instrumental variables, by a search.
struct Instruments;

impl Estimator for Instruments {
    fn estimate(&self, data: &Data<'_>, prepared: &Prepared, given: Given) -> Option<Modelled> {
        let found = search(data, prepared.excitation.as_deref(), given)?;
        Some(Modelled {
            estimate: found.estimate,
            delay_is_free: found.delay_is_free,
            delay_doubt_s: found.delay_doubt_s,
            noise: found.noise,
            friction_loop: found.friction_loop,
            response: found.response,
            has_errors: true,
        })
    }

    fn finds_delay(&self) -> bool {
        true
    }

    fn has_friction(&self) -> bool {
        true
    }
}

/// Least squares through the averaged frequency response.
struct Response;

impl Estimator for Response {
    fn estimate(&self, data: &Data<'_>, prepared: &Prepared, given: Given) -> Option<Modelled> {
        let excitation = prepared.excitation.as_deref();
        let mut response = response_of(data, excitation, None)?;
        if !response.periodic {
            // Windows blur sharp resonances: the longest stretches blur least.
            let longest = (data.len() / 4).next_power_of_two();
            response = response_of(data, excitation, Some(longest))?;
        }
        let t = data.period_s;
        let lags = match given.delay_s {
            Some(_) => lag_of(given, t)..=lag_of(given, t),
            None => 0..=LAG_MAX,
        };
        // Growing by modes may stop short where there is little noise; subspaces do
        // not.
        let mut grown: Vec<_> = lags
            .filter_map(|lag| response_fit::grow(&response, lag, given.order, ORDER_MAX, t))
            .collect();
        grown.sort_by(|a, b| a.criterion().total_cmp(&b.criterion()));
        let mut starts = from_subspace(&data.head(CHOSEN), given);
        starts.extend(grown.into_iter().take(GROWN).map(|best| best.transfer));
        let best = response_fit::best_of(&response, &starts, t)?;
        let mut estimate = as_it_is(data, &best.transfer)?;
        estimate.covariance = best.covariance;
        Some(Modelled {
            estimate,
            delay_is_free: false,
            delay_doubt_s: 0.0,
            noise: Noise::default(),
            friction_loop: None,
            // Few long stretches say little of their noise, and windows blur what rings.
            has_errors: response.periodic,
            response,
        })
    }

    fn finds_delay(&self) -> bool {
        true
    }

    fn knows_colour(&self) -> bool {
        true
    }
}

/// Plain least squares.
struct Arx;

impl Estimator for Arx {
    fn estimate(&self, data: &Data<'_>, prepared: &Prepared, given: Given) -> Option<Modelled> {
        let input = late(data, given);
        let best = orders(given)
            .filter_map(|order| arx::fit(&input, data.output, order))
            .min_by(|a, b| a.criterion.total_cmp(&b.criterion))?;
        let transfer = continuous(&best.discrete()?, data)?;
        without_errors(data, prepared, transfer, given)
    }
}

/// Subspaces (MOESP).
struct Subspaces;

impl Estimator for Subspaces {
    fn estimate(&self, data: &Data<'_>, prepared: &Prepared, given: Given) -> Option<Modelled> {
        let input = late(data, given);
        let subspace = Subspace::new(&input, data.output)?;
        let fitted = |order: usize, input: &[f64], output: &[f64]| {
            let model = with_poles(subspace.poles(order)?, input, output)?;
            continuous(&model, data)
        };
        // The poles are those of the first samples: the order shows there too.
        let head = data.head(CHOSEN);
        let first = input.get(..head.len()).unwrap_or_default();
        let mut best: Option<(f64, usize)> = None;
        for order in orders(given) {
            if let Some(transfer) = fitted(order, first, head.output)
                && let Some(estimate) = as_it_is(&head, &transfer)
                && best.is_none_or(|(least, _)| estimate.criterion() < least)
            {
                best = Some((estimate.criterion(), order));
            }
        }
        let transfer = fitted(best?.1, &input, data.output)?;
        without_errors(data, prepared, transfer, given)
    }
}

fn from_subspace(data: &Data<'_>, given: Given) -> Vec<TransferFunction> {
    let input = late(data, given);
    let orders = given.order.map_or(vec![2, 4, 6], |order| vec![order]);
    let Some(subspace) = Subspace::new(&input, data.output) else {
        return Vec::new();
    };
    let lag_s = lag_of(given, data.period_s) as f64 * data.period_s;
    orders
        .into_iter()
        .filter_map(|order| {
            let model = with_poles(subspace.poles(order)?, &input, data.output)?;
            let mut start = continuous(&model, data)?;
            start.delay_s = lag_s;
            Some(start)
        })
        .collect()
}

/// Zeros beyond this many rad per period are artefacts of the conversion.
const FAR: f64 = 1.5 * std::f64::consts::PI;

fn continuous(model: &Discrete, data: &Data<'_>) -> Option<TransferFunction> {
    let t = data.period_s;
    model.to_continuous(t, FAR / t).ok()
}

/// Orders that are tried.
fn orders(given: Given) -> RangeInclusive<usize> {
    given.order.map_or(1..=ORDER_MAX, |order| order..=order)
}

/// The delay that is given, in whole periods.
fn lag_of(given: Given, period_s: f64) -> usize {
    let delay_s = given.delay_s.unwrap_or_default();
    libm::round(delay_s / period_s) as usize
}

/// The input, as late as is given.
fn late(data: &Data<'_>, given: Given) -> Vec<f64> {
    let x = data.input;
    let first = x.first().copied().unwrap_or_default();
    std::iter::repeat_n(first, lag_of(given, data.period_s))
        .chain(x.iter().copied())
        .take(x.len())
        .collect()
}

fn without_errors(
    data: &Data<'_>,
    prepared: &Prepared,
    mut transfer: TransferFunction,
    given: Given,
) -> Option<Modelled> {
    transfer.delay_s = lag_of(given, data.period_s) as f64 * data.period_s;
    Some(Modelled {
        estimate: as_it_is(data, &transfer)?,
        delay_is_free: false,
        delay_doubt_s: 0.0,
        noise: Noise::default(),
        friction_loop: None,
        response: response_of(data, prepared.excitation.as_deref(), None)?,
        has_errors: false,
    })
}
