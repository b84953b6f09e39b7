//! Models to start a search from: those that fit the measured frequency response, and
//! those of subspaces of the data.

use super::candidate_models::{Given, LAG_MAX, ORDER_MAX};
use super::data::Data;
use super::response_fit::grow;
use super::spectrum::FrequencyResponse;
use super::subspace::{Subspace, with_poles};
use super::transfer::TransferFunction;

/// Models to start a search from: those that fit the frequency response best, for the
/// best delay and the one a period shorter (with a held input, a model without
/// direct path may as well be one with it, a period later).
#[must_use]
pub fn starts(response: &FrequencyResponse, given: Given, t: f64) -> Vec<TransferFunction> {
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
        .collect()
}

/// Models from subspaces of the data: good where there is little noise.
#[must_use]
pub fn from_subspace(data: &Data<'_>, given: Given) -> Vec<TransferFunction> {
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
