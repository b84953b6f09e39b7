//! How many poles and zeros, and how much delay: models of growing order, each
//! started from the measured frequency response, and the one that Bayes'
//! criterion prefers.

use super::mode::with_mode;
use super::noise::{Whiteness, whitening};
use super::output_error::{Data, Effort, Estimate, refine, residuals};
use super::response_fit::grow;
use super::spectrum::{FrequencyResponse, measure};
use super::subspace::{Subspace, with_poles};
use super::transfer::{Factor, TransferFunction};

/// Poles at most.
pub const ORDER_MAX: usize = 8;
/// Periods of delay that are tried.
pub const LAG_MAX: usize = 12;
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
/// How far above the fastest mode another one is looked for at first.
const ABOVE: [f64; 3] = [1.5, 2.5, 4.0];
/// Steps of all of them at most: a recording that no model explains to its last
/// digit is not worth minutes.
const STEPS_MAX: usize = 500;
const STEPS_LAST: usize = 120;
/// Rounds of model and noise.
const ROUNDS_OF_NOISE: usize = 4;
/// Steps from model to model at most.
const ROUNDS_MAX: usize = 12;
/// Order of the filter that makes noise white, at most.
const WHITENING_MAX: usize = 40;
/// Lags over which residuals are tested.
pub const LAGS: usize = 40;

/// What is given instead of searched for.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given {
    /// Number of poles.
    pub order: Option<usize>,
    /// Number of zeros.
    pub zeros: Option<usize>,
    /// Delay, s.
    pub delay_s: Option<f64>,
}

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
    let mut best: Option<(Estimate, bool)> = None;
    // Noise that is not white shows only behind a model, and the model only
    // when the noise is known: a few rounds settle both, each from where the one
    // before came to.
    for _ in 0..ROUNDS_OF_NOISE {
        let before = best.as_ref().map(|(best, _)| &best.transfer);
        let found = ladder(&short, &response, given, &taps, before)?;
        let left = residuals(&short, &found.0)?;
        let exact = found.0.rest <= 1e-12 * found.0.power;
        let next = if exact || Whiteness::of(filtered(&left, &taps).as_slice(), LAGS).is_white() {
            None
        } else {
            Some(whitening(&left, WHITENING_MAX))
        };
        best = Some(found);
        match next {
            Some(next) => taps = next,
            None => break,
        }
    }
    let (short_estimate, delay_is_free) = best?;
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
    let mut is_restarted = false;
    let mut left = STEPS_MAX;
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
        left = left.max(STEPS_LAST);
        let before = best.criterion();
        if let Some(top) = top.filter(|top| is_better(top, Some(&best))) {
            tried.push(top.transfer.clone());
            best = top;
        }
        if best.criterion() < before - WORTH {
            is_restarted = false;
        } else if is_restarted {
            break;
        } else {
            is_restarted = true;
        }
    }
    if given.delay_s.is_some() {
        return Some((best, false));
    }
    Some(any_delay(data, best, taps))
}

/// True for models of one shape from which a fit comes to the same end.
fn are_alike(a: &TransferFunction, b: &TransferFunction) -> bool {
    const NEAR: f64 = 0.01;
    let factors = |x: &TransferFunction| -> Vec<Factor> {
        let all = x.zeros.iter().chain(&x.poles);
        all.copied().collect()
    };
    let same = |a: &Factor, b: &Factor| match (*a, *b) {
        (
            Factor::Pair {
                omega_rad_s,
                damping,
            },
            Factor::Pair {
                omega_rad_s: other,
                damping: than,
            },
        ) => {
            (omega_rad_s / other - 1.0).abs() < NEAR
                && (damping - than).abs() < NEAR * damping.abs().max(0.02)
        }
        (
            Factor::Real { time_constant_s },
            Factor::Real {
                time_constant_s: other,
            },
        ) => (time_constant_s / other - 1.0).abs() < 10.0 * NEAR,
        _ => false,
    };
    let (left, right) = (factors(a), factors(b));
    a.delay_s == b.delay_s
        && a.zeros.len() == b.zeros.len()
        && left.len() == right.len()
        && left.iter().zip(&right).all(|(a, b)| same(a, b))
}

/// Models that differ from one by a zero, a pair of zeros, a mode, or a period
/// of delay.
fn neighbours(
    from: &TransferFunction,
    response: &FrequencyResponse,
    given: Given,
    period_s: f64,
) -> Vec<TransferFunction> {
    let far_zero = far_zero(period_s);
    let lean = lean(from);
    let mut out = reflected(from, given, period_s);
    if given.order.is_none() {
        out.extend(cancelled(from));
    }
    if given.order.is_none() && lean.order() < from.order() {
        // Fast poles and zeros may have stood for a delay.
        let later = if given.delay_s.is_none() { 2 } else { 0 };
        for periods in 0..=later {
            let mut less = lean.clone();
            less.delay_s += f64::from(periods) * period_s;
            if less.zero_count() < less.order() {
                let mut more = less.clone();
                more.zeros.push(far_zero);
                out.push(more);
            }
            out.push(less);
        }
    }
    let mut shapes = vec![from.clone()];
    if from.zero_count() < from.order() {
        let mut more = from.clone();
        more.zeros.push(far_zero);
        shapes.push(more);
    }
    for index in 0..from.zeros.len() {
        let mut less = from.clone();
        less.zeros.remove(index);
        shapes.push(less.clone());
        less.zeros.push(far_zero);
        shapes.push(less);
    }
    out.extend(shapes.iter().skip(1).cloned());
    if given.delay_s.is_none() {
        for shape in &shapes {
            let mut sooner = shape.clone();
            sooner.delay_s -= period_s;
            if sooner.delay_s > -0.5 * period_s {
                sooner.delay_s = sooner.delay_s.max(0.0);
                out.push(sooner);
            }
        }
        for shape in &shapes {
            let mut later = shape.clone();
            later.delay_s += period_s;
            out.push(later);
        }
    }
    if given.order.is_none() {
        if from.order() + 2 <= ORDER_MAX {
            out.extend(with_mode(from, response, period_s));
        }
        out.extend(without_mode(from, far_zero));
    }
    if let Some(zeros) = given.zeros {
        out.retain(|model| model.zero_count() == zeros);
    }
    out
}

/// Without a pole and a zero that stand for nothing beside one another.
fn cancelled(from: &TransferFunction) -> Vec<TransferFunction> {
    const NEAR: f64 = 0.05;
    let mut out = Vec::new();
    for (index, pole) in from.poles.iter().enumerate() {
        let is_near = |zero: &Factor| {
            let apart = libm::log(zero.corner_rad_s() / pole.corner_rad_s());
            zero.degree() == pole.degree() && apart.abs() < NEAR
        };
        if let Some(at) = from.zeros.iter().position(is_near) {
            let mut less = from.clone();
            less.poles.remove(index);
            less.zeros.remove(at);
            out.push(less);
        }
    }
    out
}

/// Dampers make a real zero far above the band: seldom seen in the response, but
/// not nothing.
fn far_zero(period_s: f64) -> Factor {
    Factor::Real {
        time_constant_s: 0.1 * period_s,
    }
}

/// Zeros that swing come from what hangs on the load, and that is damped: where
/// they came out undamped, the same ones damped, with less delay.
fn reflected(from: &TransferFunction, given: Given, period_s: f64) -> Vec<TransferFunction> {
    let mut damped = from.clone();
    let mut is_other = false;
    for zero in &mut damped.zeros {
        if zero.oscillates()
            && let Factor::Pair { damping, .. } = zero
            && *damping < 0.0
        {
            *damping = -*damping;
            is_other = true;
        }
    }
    if !is_other {
        return Vec::new();
    }
    let sooner = if given.delay_s.is_none() { 3 } else { 1 };
    (0..sooner)
        .map(|periods| from.delay_s - f64::from(periods) * period_s)
        .filter(|delay_s| *delay_s >= 0.0)
        .map(|delay_s| TransferFunction {
            delay_s,
            ..damped.clone()
        })
        .collect()
}

/// What swings of a model: the rest often stands for nothing but noise.
fn lean(from: &TransferFunction) -> TransferFunction {
    let swings =
        |factor: &&Factor| matches!(factor, Factor::Pair { damping, .. } if damping.abs() < 0.7);
    let poles: Vec<Factor> = from.poles.iter().filter(swings).copied().collect();
    let order = 2 * poles.len();
    let mut zeros: Vec<Factor> = from.zeros.iter().filter(swings).copied().collect();
    zeros.truncate(order / 2);
    TransferFunction {
        zeros,
        poles,
        ..from.clone()
    }
}

/// Where no neighbour is better: the slowest of what swings, with one faster mode
/// placed anew, by the response or well above. Outside the band of the excitation
/// a mode may have gone astray.
fn restarts(
    from: &TransferFunction,
    response: &FrequencyResponse,
    given: Given,
    period_s: f64,
) -> Vec<TransferFunction> {
    if given.order.is_some() || given.zeros.is_some() {
        return Vec::new();
    }
    let lean = lean(from);
    (1..=lean.poles.len())
        .flat_map(|count| {
            let mut slow = lean.clone();
            for list in [&mut slow.zeros, &mut slow.poles] {
                list.sort_by(|a, b| a.corner_rad_s().total_cmp(&b.corner_rad_s()));
                list.truncate(count);
            }
            let mut starts = with_mode(&slow, response, period_s);
            for above in ABOVE {
                let mut stiff = slow.clone();
                let fastest = slow.poles.last().map(|pole| pole.corner_rad_s());
                stiff.poles.extend(fastest.map(|omega| Factor::Pair {
                    omega_rad_s: above * omega,
                    damping: 0.05,
                }));
                starts.push(stiff.clone());
                stiff.zeros.push(far_zero(period_s));
                starts.push(stiff);
            }
            starts
        })
        .collect()
}

/// Without one pole, and without none or one of the zeros: the nearest first.
fn without_mode(from: &TransferFunction, far_zero: Factor) -> Vec<TransferFunction> {
    let mut out = Vec::new();
    for (at, pole) in from.poles.iter().enumerate() {
        let distance = |zero: &Factor| libm::log(zero.corner_rad_s() / pole.corner_rad_s()).abs();
        let mut less = from.clone();
        less.poles.remove(at);
        let mut zeros: Vec<(f64, usize)> = less
            .zeros
            .iter()
            .enumerate()
            .filter(|(_, zero)| zero.degree() == pole.degree())
            .map(|(index, zero)| (distance(zero), index))
            .collect();
        zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut shapes: Vec<TransferFunction> = zeros
            .iter()
            .map(|(_, index)| {
                let mut lesser = less.clone();
                lesser.zeros.remove(*index);
                lesser
            })
            .collect();
        shapes.push(less);
        for shape in shapes {
            if shape.zero_count() < shape.order() {
                let mut more = shape.clone();
                more.zeros.push(far_zero);
                out.push(more);
            }
            if shape.zero_count() <= shape.order() {
                out.push(shape);
            }
        }
    }
    out
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
        .take(2)
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
