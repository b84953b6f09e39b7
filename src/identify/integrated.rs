//! The search where a position or speed was measured: model and noise, which show only
//! behind one another.
//!
//! The models that a search starts from are mostly near to what is sought, though the
//! noise is known but roughly: beside the best of them it is taken anew, and the search
//! goes on behind that. What is found may show still other noise: then the search goes
//! on from there, among neighbours.

use super::data::Data;
use super::delay_profile::doubt_s;
use super::disturbance::{Noise, as_it_is};
use super::fewer_rows::FewerRows;
use super::ladder::{Ladder, Reach, SEARCH_STEPS, STEPS_LAST, best_of};
use super::neighbours::Given;
use super::output_error::{Effort, Estimate, Fitting, residuals};
use super::response_starts;
use super::search::{
    CHOSEN, COMPARED, Chosen, ROUNDS_OF_NOISE, STEPS_MAX, WHITENING_MAX, any_delay, is_white,
};
use super::spectrum::FrequencyResponse;
use super::transfer::TransferFunction;

/// The model and the noise, chosen on some of the samples; the models are compared on
/// `compared` of them.
#[must_use]
pub fn choose(
    raw: &Data<'_>,
    response: &FrequencyResponse,
    compared: usize,
    given: Given,
) -> Option<Chosen> {
    let band_rad_s = response.shown_rad_s();
    let (mut noise, mut starts) = Noise::first(raw, raw.head(COMPARED), band_rad_s, given);
    starts.extend(response_starts::starts(response, given, raw.period_s));
    let mut chosen: Option<Chosen> = None;
    for round in 0..=ROUNDS_OF_NOISE {
        let leaky = noise.held(raw);
        let data = &leaky.as_ref().map_or(*raw, |leaky| leaky.data(raw));
        let (all_rows, long) = (data.head(compared), data.head(CHOSEN));
        let fewer = (compared > COMPARED).then(|| FewerRows::of(&all_rows, band_rad_s));
        let fewer = fewer.flatten();
        let short = fewer
            .as_ref()
            .map_or(all_rows, |fewer| fewer.data(&all_rows));
        if round == 0 {
            starts.extend(response_starts::from_subspace(&all_rows, given));
        }
        let on_short = Fitting::new(short, &noise.taps);
        let fit = |start: &TransferFunction, delay_is_free: bool, effort: Effort| {
            on_short.refine(start, delay_is_free, effort)
        };
        let ladder = Ladder {
            fit: &fit,
            early_s: data.early_s,
            step_s: data.period_s,
            period_s: data.period_s,
            response,
            given,
        };
        let next_noise = |found: &Estimate| {
            let head = raw.head(compared);
            other_noise(&head, &all_rows, found, &noise)
        };
        let mut tried = ladder.fitted(&starts, round > 0);
        if round == 0 {
            let best = best_of(tried.clone()).next()?;
            if let Some(next) = next_noise(&best) {
                noise = next;
                starts = best_of(tried).map(|found| found.transfer).collect();
                continue;
            }
        }
        tried = ladder.climb(tried, reach(round < 2));
        let others = doubt_s(&tried);
        let free = |found: Estimate, fitting: &Fitting<'_>| match given.delay_s {
            Some(_) => (found, false, 0.0),
            None => {
                let fit = |start: &TransferFunction, delay_is_free: bool, effort: Effort| {
                    fitting.refine(start, delay_is_free, effort)
                };
                any_delay(&fit, data.period_s, found)
            }
        };
        let best = best_of(tried.clone()).next()?;
        let (best, ..) = free(best, &on_short);
        let mut next = next_noise(&best);
        if next.is_none() || round == ROUNDS_OF_NOISE {
            let on_long = (short.len() != data.len()).then(|| Fitting::new(long, &noise.taps));
            let on_long = on_long.as_ref().unwrap_or(&on_short);
            let found = if short.len() == data.len() {
                best
            } else {
                best_again(on_long, tried)?
            };
            let (found, delay_is_free, alone_s) = free(found, on_long);
            let found = on_long.settled(found)?;
            chosen = Some(Chosen {
                found,
                delay_is_free,
                delay_doubt_s: given.delay_s.map_or(libm::hypot(others, alone_s), |_| 0.0),
                noise: noise.clone(),
            });
            next = None;
        } else {
            starts = vec![best.transfer];
        }
        match next {
            Some(next) => noise = next,
            None => break,
        }
    }
    chosen
}

/// How far the first search goes, or a later one from what it found.
fn reach(is_first: bool) -> Reach {
    let (steps, spare) = if is_first {
        (STEPS_MAX, 3 * STEPS_LAST)
    } else {
        (STEPS_LAST, STEPS_LAST)
    };
    Reach {
        steps,
        spare,
        is_known: !is_first,
    }
}

/// The best of models on more samples, where another one may be the best.
fn best_again(fitting: &Fitting<'_>, tried: Vec<Estimate>) -> Option<Estimate> {
    let mut best: Option<Estimate> = None;
    for found in best_of(tried) {
        let effort = Effort {
            steps: SEARCH_STEPS,
            to_beat: best.as_ref().map_or(f64::MAX, Estimate::criterion),
        };
        let found = fitting.refine(&found.transfer, false, effort);
        let is_better = |found: &Estimate| {
            best.as_ref()
                .is_none_or(|best| found.criterion() < best.criterion())
        };
        best = found.filter(is_better).or(best);
    }
    best
}

/// The noise beside a model where it is clearly other noise than was supposed: `raw` as
/// recorded, `data` behind what held it.
fn other_noise(raw: &Data<'_>, data: &Data<'_>, found: &Estimate, now: &Noise) -> Option<Noise> {
    let plain = as_it_is(data, &found.transfer)?;
    let left = residuals(data, &plain)?;
    let exact = found.rest <= 1e-12 * found.power;
    if exact || is_white(&left, &now.taps) {
        return None;
    }
    Noise::beside(raw, &found.transfer, WHITENING_MAX, Some(now))
}
