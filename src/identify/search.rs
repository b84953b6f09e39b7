//! How many poles and zeros, and how much delay: from models that grew by modes to
//! their neighbours, and the one that Bayes' criterion prefers; behind a command the
//! dead time by its profile.

use nalgebra::Complex;

use super::data::Data;
use super::delay_profile::{Bounds, doubt_s, profile};
use super::disturbance::{Noise, next_noise};
use super::fewer_rows::FewerRows;
use super::mode_starts;
use super::neighbours::{Given, are_alike, cancelled, neighbours, restarts};
use super::noise::Whiteness;
use super::output_error::{Effort, Estimate, Fitting, refine, residuals};
use super::response_starts;
use super::spectral_lines::Lines;
use super::spectrum::{FrequencyResponse, measure};
use super::transfer::{Factor, TransferFunction};

/// Samples on which models are compared; of commands more, as a sweep shows each
/// mode but once, and of forces where the first ones show less than all do.
const COMPARED: usize = 8_000;
const COMPARED_COMMAND: usize = 16_000;
/// Samples on which the best of them are; the last fit takes all.
const CHOSEN: usize = 24_000;
/// Lines on which modes are looked for, about.
pub const COARSE: usize = 700;
/// Models of different kinds that are gone on with.
const KEPT: usize = 5;
/// A model better by this much is gone on from without looking at others.
const CLEAR: f64 = 4.0;
/// By how much a delay between samples has to be better than one of whole
/// periods.
const CLEAR_DELAY: f64 = 10.0;
/// A model better by less is the same one.
const WORTH: f64 = 0.5;
/// A pole and a zero no farther apart, as a share, are one.
const ONE: f64 = 0.02;
/// Steps of each fit on the way.
pub const SEARCH_STEPS: usize = 20;
/// Steps of all of them at most: a recording that no model explains to its last
/// digit is not worth minutes.
const STEPS_MAX: usize = 500;
const STEPS_LAST: usize = 200;
/// The same for commands, of which more samples are looked at, and whose dead time
/// is sought afterwards.
const STEPS_COMMAND: usize = 50;
/// Rounds of model and noise.
const ROUNDS_OF_NOISE: usize = 4;
/// Steps from model to model at most.
const ROUNDS_MAX: usize = 12;
/// Order of the filter that makes noise white, at most.
pub const WHITENING_MAX: usize = 40;
/// Lags over which residuals are tested.
pub const LAGS: usize = 40;

/// A model with how it was found.
#[derive(Debug, Clone)]
pub struct Found {
    /// The model.
    pub estimate: Estimate,
    /// Whether the delay was fitted.
    pub delay_is_free: bool,
    /// How far it is in doubt besides, s: other models have other delays.
    pub delay_doubt_s: f64,
    /// What made the noise white.
    pub noise: Noise,
    /// The measured frequency response.
    pub response: FrequencyResponse,
}

/// Searches for the model. `None` if none can be fitted.
#[must_use]
pub fn search(data: &Data<'_>, instrument: Option<&[f64]>, given: Given) -> Option<Found> {
    let response = response_of(data, instrument, None)?;
    let band_rad_s = response.shown_rad_s();
    let step_s = data.period_s * mode_starts::delay_step(data.from_command);
    let compared = compared(data, &response);
    let is_integrated = !data.from_command && data.measured.integrators() > 0;
    let raw = data;
    let (mut noise, mut first_starts) = (Noise::default(), None);
    if is_integrated {
        let (first, starts) = Noise::first(raw, raw.head(COMPARED), band_rad_s, given);
        (noise, first_starts) = (first, Some(starts));
    }
    // The response says the same whatever the noise is taken for.
    let mut shown: Option<Vec<TransferFunction>> = None;
    let mut best: Option<(Estimate, bool, f64, Noise)> = None;
    // Noise that is not white shows only behind a model, and the model only
    // when the noise is known: a few rounds settle both, each from where the one
    // before came to.
    for _ in 0..ROUNDS_OF_NOISE {
        let before = best.as_ref().map(|(best, ..)| &best.transfer);
        let leaky = noise.held(raw);
        let data = &leaky.as_ref().map_or(*raw, |leaky| leaky.data(raw));
        let (all_rows, long) = (data.head(compared), data.head(CHOSEN));
        let fewer = (compared > COMPARED).then(|| FewerRows::of(&all_rows, band_rad_s));
        let fewer = fewer.flatten();
        let short = fewer
            .as_ref()
            .map_or(all_rows, |fewer| fewer.data(&all_rows));
        let taps = &noise.taps;
        let mut starts = first_starts.take().unwrap_or_else(|| {
            let coarse = Lines::new(raw, &noise, band_rad_s, COARSE);
            coarse.map_or(Vec::new(), |lines| mode_starts::starts(&lines, given))
        });
        if !data.from_command {
            // Without a loop about it what is measured shows the axis itself.
            let shown = shown
                .get_or_insert_with(|| response_starts::starts(&response, given, data.period_s));
            starts.extend(shown.iter().cloned());
            starts.extend(response_starts::from_subspace(&all_rows, given));
        }
        starts.extend(before.cloned());
        let on_short = Fitting::new(short, taps);
        let fit = |start: &TransferFunction, delay_is_free: bool, effort: Effort| {
            on_short.refine(start, delay_is_free, effort)
        };
        let on_long = (short.len() != data.len()).then(|| Fitting::new(long, taps));
        let on_long = on_long.as_ref().unwrap_or(&on_short);
        let fit_long = |start: &TransferFunction, delay_is_free: bool, effort: Effort| {
            on_long.refine(start, delay_is_free, effort)
        };
        let budget = budget(before.is_none(), data.from_command);
        let mut tried = ladder(&fit, data, step_s, &response, given, &starts, budget);
        let mut others = doubt_s(&tried);
        if data.from_command && given.delay_s.is_none() {
            let profiled = by_profile(&fit, data, given, band_rad_s, tried.clone());
            if let Some((found, apart_s)) = profiled {
                others = libm::hypot(apart_s, step_s / 12.0_f64.sqrt());
                tried = vec![found];
            }
        }
        let effort = Effort {
            steps: SEARCH_STEPS,
            to_beat: f64::MAX,
        };
        // On more samples another one may be the best.
        let again = |found: Estimate| {
            if short.len() == data.len() {
                Some(found)
            } else {
                on_long.refine(&found.transfer, false, effort)
            }
        };
        let Some(found) = best_of(best_of(tried).filter_map(again).collect()).next() else {
            break;
        };
        let (found, delay_is_free, alone_s) = match given.delay_s {
            Some(_) => (found, false, 0.0),
            // Between the steps there is nothing to be found.
            None if data.from_command && others > step_s => (found, false, 0.0),
            None => any_delay(&fit_long, data.period_s, found),
        };
        let delay_doubt_s = match given.delay_s {
            Some(_) => 0.0,
            None => libm::hypot(others, alone_s),
        };
        let found = on_long.settled(found)?;
        let left = residuals(&long, &found)?;
        let exact = found.rest <= 1e-12 * found.power;
        let is_white = || Whiteness::of(filtered(&left, taps).as_slice(), LAGS).is_white();
        let next = (!exact && !is_white()).then(|| {
            let head = is_integrated.then(|| raw.head(compared));
            next_noise(head.as_ref(), &found.transfer, &noise, &left)
        });
        best = Some((found, delay_is_free, delay_doubt_s, noise.clone()));
        match next.flatten() {
            Some(next) => noise = next,
            None => break,
        }
    }
    let (short_estimate, delay_is_free, delay_doubt_s, noise) = best?;
    let noise = noise.closer(raw, &short_estimate.transfer);
    let estimate = on_all(raw, &short_estimate.transfer, delay_is_free, &noise, given)?;
    Some(Found {
        estimate,
        delay_is_free,
        delay_doubt_s,
        noise,
        response,
    })
}

/// The last fit, on all samples.
fn on_all(
    raw: &Data<'_>,
    found: &TransferFunction,
    delay_is_free: bool,
    noise: &Noise,
    given: Given,
) -> Option<Estimate> {
    let leaky = noise.held(raw);
    let data = leaky.as_ref().map_or(*raw, |leaky| leaky.data(raw));
    let fit =
        |from: &TransferFunction| refine(&data, from, delay_is_free, &noise.taps, Effort::FULL);
    let mut best = fit(found)?;
    if leaky.is_some() && given.order.is_none() && given.zeros.is_none() {
        // What stood for noise as it was supposed at first stands for nothing now.
        for less in cancelled(&best.transfer, ONE) {
            let less = fit(&less).filter(|less| less.criterion() <= best.criterion());
            best = less.unwrap_or(best);
        }
    }
    Some(best)
}

/// Steps of the first round or a later one, and those to spare.
fn budget(is_first: bool, from_command: bool) -> (usize, usize) {
    match (is_first, from_command) {
        (false, _) => (STEPS_LAST, STEPS_LAST),
        (true, true) => (STEPS_COMMAND, 0),
        (true, false) => (STEPS_MAX, 3 * STEPS_LAST),
    }
}

/// The model behind a command by the profile of its dead time, and how far that is in
/// doubt, s.
fn by_profile(
    fit: &Fit<'_>,
    data: &Data<'_>,
    given: Given,
    band_rad_s: f64,
    tried: Vec<Estimate>,
) -> Option<(Estimate, f64)> {
    let bounds = Bounds {
        least_s: data.early_s,
        step_periods: mode_starts::delay_step(true),
        period_s: data.period_s,
        band_rad_s,
    };
    let fit = |start: &TransferFunction, effort: Effort| {
        let is_given = given.order.is_none_or(|order| start.order() == order)
            && given.zeros.is_none_or(|zeros| start.zero_count() == zeros);
        is_given.then(|| fit(start, false, effort)).flatten()
    };
    let found = profile(fit, tried, bounds)?;
    Some((found.estimate, found.doubt_s))
}

/// Samples on which models are compared: the first ones of a force, unless they show
/// clearly less of the axis than all do, as of a sweep, whose end comes last.
fn compared(data: &Data<'_>, response: &FrequencyResponse) -> usize {
    const LESS: f64 = 0.7;
    if data.from_command {
        return COMPARED_COMMAND;
    }
    let first = data.head(COMPARED);
    let shown = response_of(&first, first.undisturbed, None);
    match shown {
        Some(shown) if shown.band_rad_s() < LESS * response.band_rad_s() => CHOSEN,
        _ => COMPARED,
    }
}

/// The measured response, as of an input that is held; of positions by their second
/// differences, as slow motion would leak into fast.
#[must_use]
pub fn response_of(
    data: &Data<'_>,
    instrument: Option<&[f64]>,
    stretch: Option<usize>,
) -> Option<FrequencyResponse> {
    if data.positions {
        let twice = |x: &[f64]| filtered(x, &[-2.0, 1.0]);
        let (input, output) = (twice(data.input), twice(data.output));
        return measure(&input, &output, instrument, data.period_s, stretch);
    }
    let mut response = measure(data.input, data.output, instrument, data.period_s, stretch)?;
    as_held(&mut response, data.measured.integrators(), data.period_s);
    Some(response)
}

/// What a response would be were the input held: each difference of the output (or
/// order of the spline) makes it late by half a period and weaker.
fn as_held(response: &mut FrequencyResponse, times: usize, period_s: f64) {
    let values = response.response.iter_mut().zip(&mut response.variance);
    for ((value, variance), hz) in values.zip(&response.frequency_hz) {
        let half = std::f64::consts::PI * hz * period_s;
        let (sin, cos) = libm::sincos(half);
        let early = Complex::new(cos, sin) * (half / sin);
        for _ in 0..times {
            *value *= early;
            *variance *= early.norm_sqr();
        }
    }
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

/// Fits a model from a start, with its delay or without.
type Fit<'a> = dyn Fn(&TransferFunction, bool, Effort) -> Option<Estimate> + 'a;

/// The best of models, one of each kind, the very best first.
fn best_of(mut found: Vec<Estimate>) -> impl Iterator<Item = Estimate> {
    found.sort_by(|a, b| a.criterion().total_cmp(&b.criterion()));
    let mut kept: Vec<Estimate> = Vec::new();
    for found in found {
        let is_known = kept
            .iter()
            .any(|other| is_of_kind(&found.transfer, &other.transfer));
        if !is_known && kept.len() < KEPT {
            kept.push(found);
        }
    }
    kept.into_iter()
}

/// True for models with as many zeros and poles at about the same places, and with
/// the same delay.
fn is_of_kind(a: &TransferFunction, b: &TransferFunction) -> bool {
    const NEAR: f64 = 0.2;
    let corners = |list: &[Factor]| -> Vec<f64> {
        let mut corners: Vec<f64> = list.iter().map(|x| x.corner_rad_s()).collect();
        corners.sort_by(f64::total_cmp);
        corners
    };
    let are_near = |a: &[Factor], b: &[Factor]| {
        let (a, b) = (corners(a), corners(b));
        let apart = |(a, b): (&f64, &f64)| libm::log(a / b).abs() < NEAR;
        a.len() == b.len() && a.iter().zip(&b).all(apart)
    };
    a.delay_s == b.delay_s && are_near(&a.zeros, &b.zeros) && are_near(&a.poles, &b.poles)
}

/// All models that were tried on the way from the best of the starts to what no
/// neighbour is better than.
fn ladder(
    fit: &Fit<'_>,
    data: &Data<'_>,
    step_s: f64,
    response: &FrequencyResponse,
    given: Given,
    starts: &[TransferFunction],
    (mut left, mut spare): (usize, usize),
) -> Vec<Estimate> {
    let period_s = data.period_s;
    let is_possible = |start: &TransferFunction| start.delay_s > data.early_s - 1e-6 * period_s;
    let mut all: Vec<Estimate> = Vec::new();
    let mut best: Option<Estimate> = None;
    for start in starts.iter().filter(|start| is_possible(start)) {
        let effort = Effort {
            steps: SEARCH_STEPS,
            to_beat: f64::MAX,
        };
        if let Some(found) = fit(start, false, effort) {
            all.push(found.clone());
            if is_better(&found, best.as_ref()) {
                best = Some(found);
            }
        }
    }
    let Some(mut best) = best else {
        return all;
    };
    // Where the first model is taken from, what shows is mostly right, and the
    // rest not.
    let mut is_restarted = true;
    let mut idle = 0;
    let mut tried = vec![best.transfer.clone()];
    for _ in 0..ROUNDS_MAX {
        let mut top: Option<Estimate> = None;
        let needed = needed(&best, response.band_rad_s());
        let next = if is_restarted {
            restarts(&best.transfer, response, given, period_s)
        } else {
            neighbours(&best.transfer, response, given, period_s, step_s)
        };
        for start in next {
            if left == 0 {
                break;
            }
            if tried.iter().any(|other| are_alike(other, &start))
                || lacks(&start, &needed)
                || !is_possible(&start)
            {
                continue;
            }
            tried.push(start.clone());
            let effort = Effort {
                steps: SEARCH_STEPS,
                to_beat: top.as_ref().unwrap_or(&best).criterion(),
            };
            let found = fit(&start, false, effort);
            left = left.saturating_sub(found.as_ref().map_or(1, |found| found.steps));
            if let Some(found) = found {
                all.push(found.clone());
                if is_better(&found, top.as_ref()) {
                    let is_clear = found.criterion() < best.criterion() - CLEAR;
                    top = Some(found);
                    if is_clear {
                        break;
                    }
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
    all
}

/// Zeros and poles that ring and are known well: without one of them no model fits as well.
/// One that another one nearly cancels is not, nor one beyond the band, which may
/// stand for noise.
fn needed(found: &Estimate, band_rad_s: f64) -> Vec<(bool, Factor)> {
    const KNOWN: f64 = 0.05;
    const BEYOND: f64 = 1.2;
    const CANCELS: f64 = 0.05;
    let model = &found.transfer;
    let others = |is_zero: bool| {
        let others = if is_zero { &model.poles } else { &model.zeros };
        others.iter().filter(|other| other.degree() == 2)
    };
    let is_near =
        |a: &Factor, b: &Factor| libm::log(a.corner_rad_s() / b.corner_rad_s()).abs() < CANCELS;
    let mut at = 1;
    let mut out = Vec::new();
    for (index, factor) in model.zeros.iter().chain(&model.poles).enumerate() {
        if let Factor::Pair { damping, .. } = factor
            && damping.abs() < 0.25
            && factor.corner_rad_s() < BEYOND * band_rad_s
            && !others(index < model.zeros.len()).any(|other| is_near(other, factor))
            && found.std(at).is_some_and(|std| std < KNOWN)
            && found.std(at + 1).is_some_and(|std| std < KNOWN)
        {
            out.push((index < model.zeros.len(), *factor));
        }
        at += factor.degree();
    }
    out
}

/// True for a model that has nothing near to one of those.
fn lacks(model: &TransferFunction, needed: &[(bool, Factor)]) -> bool {
    const NEAR: f64 = 0.3;
    needed.iter().any(|(is_zero, factor)| {
        let have = if *is_zero { &model.zeros } else { &model.poles };
        !have.iter().any(|other| {
            let apart = libm::log(other.corner_rad_s() / factor.corner_rad_s());
            other.degree() == factor.degree() && apart.abs() < NEAR
        })
    })
}

fn is_better(found: &Estimate, than: Option<&Estimate>) -> bool {
    than.is_none_or(|than| found.criterion() < than.criterion())
}

/// The delay set free, if that is clearly worth a parameter: beside a fast zero
/// and a fast pole it makes all of them uncertain. Where it stays as it was, also
/// how uncertain it would be, s.
fn any_delay(fit: &Fit<'_>, t: f64, best: Estimate) -> (Estimate, bool, f64) {
    let mut alone_s = 0.0;
    for part in [0.3, -0.3] {
        let mut start = best.transfer.clone();
        start.delay_s += part * t;
        if start.delay_s < 0.0 {
            continue;
        }
        if let Some(found) = fit(&start, true, Effort::FULL) {
            if found.criterion() < best.criterion() - CLEAR_DELAY {
                return (found, true, 0.0);
            }
            let apart = found.transfer.delay_s - best.transfer.delay_s;
            let std = found.std(found.count - 1).unwrap_or(0.0);
            if apart.abs() < t && found.likelihood() < best.likelihood() + 2.0 {
                alone_s = f64::max(alone_s, std.min(t));
            }
        }
    }
    (best, false, alone_s)
}
