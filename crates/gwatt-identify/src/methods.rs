//! The methods that estimate a flexible axis.

use super::arx;
use super::candidate_models::{LAG_MAX, ORDER_MAX};
use super::choice::Choice;
use super::chosen::CHOSEN;
use super::data::Data;
use super::disturbance::as_it_is;
use super::measured_noise::Noise;
use super::output_error::Estimate;
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
    pub(super) response: FrequencyResponse,
    pub(super) has_errors: bool,
}

pub(super) fn by_search(data: &Data<'_>, prepared: &Prepared, choice: &Choice) -> Option<Modelled> {
    let found = search(data, prepared.excitation.as_deref(), choice.given)?;
    Some(Modelled {
        estimate: found.estimate,
        delay_is_free: found.delay_is_free,
        delay_doubt_s: found.delay_doubt_s,
        noise: found.noise,
        response: found.response,
        has_errors: true,
    })
}

pub(super) fn by_response(
    data: &Data<'_>,
    prepared: &Prepared,
    choice: &Choice,
) -> Option<Modelled> {
    let mut response = response_of(data, prepared.excitation.as_deref(), None)?;
    if !response.periodic {
        // Windows blur sharp resonances: the longest stretches blur least.
        response = response_of(
            data,
            prepared.excitation.as_deref(),
            Some((data.len() / 4).next_power_of_two()),
        )?;
    }
    let t = data.period_s;
    let lags = match choice.given.delay_s {
        Some(delay) => {
            let lag = libm::round(delay / t) as usize;
            lag..=lag
        }
        None => 0..=LAG_MAX,
    };
    // Growing by modes may stop short where there is little noise; subspaces do
    // not.
    let mut grown: Vec<_> = lags
        .filter_map(|lag| response_fit::grow(&response, lag, choice.given.order, ORDER_MAX, t))
        .collect();
    grown.sort_by(|a, b| a.criterion().total_cmp(&b.criterion()));
    let mut starts = from_subspace(&data.head(CHOSEN), choice);
    starts.extend(grown.into_iter().take(GROWN).map(|best| best.transfer));
    let best = response_fit::best_of(&response, &starts, t)?;
    let mut estimate = as_it_is(data, &best.transfer)?;
    estimate.covariance = best.covariance;
    Some(Modelled {
        estimate,
        delay_is_free: false,
        delay_doubt_s: 0.0,
        noise: Noise::default(),
        // Few long stretches say little of their noise, and windows blur what rings.
        has_errors: response.periodic,
        response,
    })
}

fn from_subspace(data: &Data<'_>, choice: &Choice) -> Vec<TransferFunction> {
    let t = data.period_s;
    let lag = choice
        .given
        .delay_s
        .map_or(0, |d| libm::round(d / t) as usize);
    let input = late(data.input, lag);
    let orders = choice
        .given
        .order
        .map_or(vec![2, 4, 6], |order| vec![order]);
    let Some(subspace) = Subspace::new(&input, data.output) else {
        return Vec::new();
    };
    orders
        .into_iter()
        .filter_map(|order| {
            let model = with_poles(subspace.poles(order)?, &input, data.output)?;
            let mut start = model.to_continuous(t, FAR / t).ok()?;
            start.delay_s = lag as f64 * t;
            Some(start)
        })
        .collect()
}

/// Zeros beyond this many rad per period are artefacts of the conversion.
const FAR: f64 = 1.5 * std::f64::consts::PI;

pub(super) fn by_arx(data: &Data<'_>, prepared: &Prepared, choice: &Choice) -> Option<Modelled> {
    let orders = match choice.given.order {
        Some(order) => order..=order,
        None => 1..=ORDER_MAX,
    };
    let t = data.period_s;
    let lag = choice
        .given
        .delay_s
        .map_or(0, |d| libm::round(d / t) as usize);
    let input = late(data.input, lag);
    let best = orders
        .filter_map(|order| arx::fit(&input, data.output, order))
        .min_by(|a, b| a.criterion.total_cmp(&b.criterion))?;
    let transfer = best.discrete()?.to_continuous(t, FAR / t).ok()?;
    finish_plain(data, prepared, transfer, lag)
}

pub(super) fn by_subspace(
    data: &Data<'_>,
    prepared: &Prepared,
    choice: &Choice,
) -> Option<Modelled> {
    let t = data.period_s;
    let lag = choice
        .given
        .delay_s
        .map_or(0, |d| libm::round(d / t) as usize);
    let input = late(data.input, lag);
    let subspace = Subspace::new(&input, data.output)?;
    let orders: Vec<usize> = match choice.given.order {
        Some(order) => vec![order],
        None => (1..=ORDER_MAX).collect(),
    };
    let mut best: Option<(f64, TransferFunction)> = None;
    for order in orders {
        let transfer = subspace
            .poles(order)
            .and_then(|poles| with_poles(poles, &input, data.output))
            .and_then(|model| model.to_continuous(t, FAR / t).ok());
        if let Some(transfer) = transfer
            && let Some(estimate) = as_it_is(data, &transfer)
            && best
                .as_ref()
                .is_none_or(|(least, _)| estimate.criterion() < *least)
        {
            best = Some((estimate.criterion(), transfer));
        }
    }
    finish_plain(data, prepared, best?.1, lag)
}

fn late(x: &[f64], lag: usize) -> Vec<f64> {
    let first = x.first().copied().unwrap_or_default();
    std::iter::repeat_n(first, lag)
        .chain(x.iter().copied())
        .take(x.len())
        .collect()
}

fn finish_plain(
    data: &Data<'_>,
    prepared: &Prepared,
    mut transfer: TransferFunction,
    lag: usize,
) -> Option<Modelled> {
    transfer.delay_s = lag as f64 * data.period_s;
    Some(Modelled {
        estimate: as_it_is(data, &transfer)?,
        delay_is_free: false,
        delay_doubt_s: 0.0,
        noise: Noise::default(),
        response: response_of(data, prepared.excitation.as_deref(), None)?,
        has_errors: false,
    })
}
