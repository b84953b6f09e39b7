//! How many poles and zeros, and how much delay: from models that grew by modes to
//! their neighbours, and the one that Bayes' criterion prefers; after a command the
//! dead time by its profile.

use super::chosen::{
    CHOSEN, COARSE, COMPARED, Chosen, WHITENING_MAX, fewer_rows, filtered, is_white, many,
};
use nalgebra::Complex;

use super::any_delay::{Timed, any_delay};
use super::candidate_models::{Given, ONE, cancelled};
use super::data::Data;
use super::delay_profile::{Bounds, doubt_s, profile};
use super::estimate::Estimate;
use super::friction_loop::{self, FrictionLoop, Passed};
use super::integrated;
use super::measured_noise::Noise;
use super::mode_starts;
use super::next_to_friction;
use super::noise::whitening;
use super::output_error::{Effort, Fitting, residuals};
use super::response_starts;
use super::spectral_lines::Lines;
use super::spectrum::{FrequencyResponse, measure};
use super::stepwise_search::{Ladder, Reach, Restart, SEARCH_STEPS, STEPS_LAST, best_of};
use super::transfer::TransferFunction;

const COMPARED_COMMAND: usize = 16_000;
/// Steps of all of them at most: a recording that no model explains to its last
/// digit is not worth minutes.
const STEPS_MAX: usize = 500;
/// The same for commands, of which more samples are looked at, and whose dead time
/// is sought afterwards.
const STEPS_COMMAND: usize = 50;
/// Rounds of model and noise.
const ROUNDS_OF_NOISE: usize = 4;

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
    /// The loop through which it came, where friction made one.
    pub friction_loop: Option<FrictionLoop>,
    /// The measured frequency response.
    pub response: FrequencyResponse,
}

/// Searches for the model. `None` if none can be fitted.
#[must_use]
pub fn search(data: &Data<'_>, instrument: Option<&[f64]>, given: Given) -> Option<Found> {
    let response = response_of(data, instrument, None)?;
    let compared = compared(data, &response);
    // How an axis turns round says nothing of its modes.
    let straight = data.without_turning();
    let chosen = if !data.from_command && data.measured.integrators() > 0 {
        integrated::choose(&straight, &response, compared, given)?
    } else {
        choose(&straight, &response, compared, given)?
    };
    let (estimate, noise, friction_loop) = on_all(data, &chosen, given)?;
    Some(Found {
        estimate,
        delay_is_free: chosen.delay_is_free,
        delay_doubt_s: chosen.delay_doubt_s,
        noise,
        friction_loop,
        response,
    })
}

fn choose(
    data: &Data<'_>,
    response: &FrequencyResponse,
    compared: usize,
    given: Given,
) -> Option<Chosen> {
    let band_rad_s = response.shown_rad_s();
    let step_s = data.period_s * mode_starts::delay_step(data.from_command);
    let (all_rows, long) = (data.head(compared), data.head(CHOSEN));
    let fewer = fewer_rows(&all_rows, compared, band_rad_s);
    let short = fewer
        .as_ref()
        .map_or(all_rows, |fewer| fewer.data(&all_rows));
    let shown = if data.from_command {
        Vec::new()
    } else {
        // Without a loop about it what is measured shows the axis itself.
        let mut shown = response_starts::starts(response, given, data.period_s);
        shown.extend(response_starts::from_subspace(&all_rows, given));
        shown
    };
    let mut noise = Noise::default();
    let mut best: Option<Chosen> = None;
    // Noise that is not white shows only after a model, and the model only
    // when the noise is known: a few rounds settle both, each from where the one
    // before came to.
    for _ in 0..ROUNDS_OF_NOISE {
        let before = best.as_ref().map(|best| &best.found.transfer);
        let taps = &noise.taps;
        let coarse = Lines::new(data, &noise, band_rad_s, COARSE);
        // What was found before comes first: the others are given up where they are far off.
        let mut starts: Vec<TransferFunction> = before.into_iter().cloned().collect();
        starts.extend(coarse.map_or(Vec::new(), |lines| mode_starts::starts(&lines, given)));
        starts.extend(shown.iter().cloned());
        let on_short = Fitting::new(short, taps);
        let on_long = (short.len() != data.len()).then(|| Fitting::new(long, taps));
        let on_long = on_long.as_ref().unwrap_or(&on_short);
        let ladder = Ladder {
            fitting: &on_short,
            early_s: data.early_s,
            step_s,
            period_s: data.period_s,
            response,
            given,
        };
        let reach = reach(before.is_none(), data.from_command);
        let mut tried = ladder.climb(ladder.fitted(&starts, before.is_some()), reach);
        let mut others = doubt_s(&tried);
        if data.from_command && given.delay_s.is_none() {
            let profiled = by_profile(&on_short, data, given, band_rad_s, tried.clone());
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
        let (found, delay_is_free, delay_doubt_s) =
            timed((on_long, found), data, given, (others, step_s));
        let found = on_long.settled(found)?;
        let left = residuals(&long, &found)?;
        let is_settled = found.is_exact() || is_white(&left, taps);
        best = Some(Chosen {
            found,
            delay_is_free,
            delay_doubt_s,
            noise: noise.clone(),
        });
        if is_settled {
            break;
        }
        noise.taps = whitening(&left, WHITENING_MAX);
    }
    best
}

/// A model with any delay, where that can be found: whether it is free, and how far it is in
/// doubt; `others_s` is how far other models have other delays.
fn timed(
    (fitting, found): (&Fitting<'_>, Estimate),
    data: &Data<'_>,
    given: Given,
    (others_s, step_s): (f64, f64),
) -> (Estimate, bool, f64) {
    // Between the steps there is nothing to be found.
    let is_open = given.delay_s.is_none() && !(data.from_command && others_s > step_s);
    let Timed {
        found,
        is_free,
        alone_s,
    } = if is_open {
        any_delay(fitting, data.period_s, found)
    } else {
        Timed::as_it_is(found)
    };
    let doubt_s = match given.delay_s {
        Some(_) => 0.0,
        None => libm::hypot(others_s, alone_s),
    };
    (found, is_free, doubt_s)
}

/// The last fit, on all samples, and the noise that goes with it.
fn on_all(
    raw: &Data<'_>,
    chosen: &Chosen,
    given: Given,
) -> Option<(Estimate, Noise, Option<FrictionLoop>)> {
    let first = many(raw).unwrap_or(*raw);
    let noise = chosen.noise.clone();
    let noise = noise.closer(&first, &chosen.found.transfer);
    let best = next_to_noise(raw, chosen, given, &noise)?;
    let passed = friction_loop::fitted(raw, &noise, chosen.delay_is_free, &best);
    Some(match passed {
        Some(Passed {
            found,
            noise,
            through,
        }) => (found, noise, Some(through)),
        None => (best, noise, None),
    })
}

/// The last fit next to this noise.
fn next_to_noise(raw: &Data<'_>, chosen: &Chosen, given: Given, noise: &Noise) -> Option<Estimate> {
    let found = &chosen.found.transfer;
    let leaky = noise.held(raw);
    let data = leaky.as_ref().map_or(*raw, |leaky| leaky.data(raw));
    let is_open = given.order.is_none() && given.zeros.is_none();
    let head = data.without_turning().head(CHOSEN);
    let less = (is_open && !data.friction.is_empty())
        .then(|| next_to_friction::without_its_pairs(&head, &noise.taps, chosen));
    let found = less.as_ref().unwrap_or(found);
    let best = fitted(
        &data,
        &noise.taps,
        chosen,
        found,
        leaky.is_some() && is_open,
    )?;
    let best = next_to_friction::with_errors_of_bursts(&data, &noise.taps, best);
    Some(next_to_friction::with_errors_of_turning(
        &data,
        &noise.taps,
        best,
    ))
}

/// The fit to all samples; what stood for noise as it was supposed at first may stand for
/// nothing now.
fn fitted(
    data: &Data<'_>,
    taps: &[f64],
    chosen: &Chosen,
    from: &TransferFunction,
    may_be_less: bool,
) -> Option<Estimate> {
    let free = chosen.delay_is_free;
    let Some(first) = many(data) else {
        let fitting = Fitting::new(*data, taps);
        let best = fitting.settled(fitting.refine(from, free, Effort::FULL)?)?;
        return Some(if may_be_less {
            without_what_is_cancelled(&fitting, free, best)
        } else {
            best
        });
    };
    // What goes on the first samples alone may be needed on all.
    let on_first = Fitting::new(first, taps);
    let found = on_first.refine(from, free, Effort::FULL)?;
    let mut starts = vec![found.transfer.clone()];
    if may_be_less {
        let less = without_what_is_cancelled(&on_first, free, found).transfer;
        if less.order() < starts.first()?.order() {
            starts.insert(0, less);
        }
    }
    drop(on_first);
    let fitting = Fitting::new(*data, taps);
    let as_it_is = Effort {
        steps: 0,
        to_beat: f64::MAX,
    };
    let each = starts.iter();
    let each = each.filter_map(|start| fitting.refine(start, free, as_it_is));
    let best = each.min_by(|a, b| a.criterion().total_cmp(&b.criterion()))?;
    fitting.settled(fitting.refine(&best.transfer, free, Effort::FULL)?)
}

/// The model without poles and zeros that cancel, where it is as good.
fn without_what_is_cancelled(fitting: &Fitting<'_>, free: bool, mut best: Estimate) -> Estimate {
    for less in cancelled(&best.transfer, ONE) {
        let less = fitting.refine(&less, free, Effort::FULL);
        let less = less.and_then(|less| fitting.settled(less));
        let less = less.filter(|less| less.criterion() <= best.criterion());
        best = less.unwrap_or(best);
    }
    best
}

/// How far the first round or a later one goes.
fn reach(is_first: bool, from_command: bool) -> Reach {
    let (steps, spare) = match (is_first, from_command) {
        (false, _) => (STEPS_LAST, STEPS_LAST),
        (true, true) => (STEPS_COMMAND, 0),
        (true, false) => (STEPS_MAX, 3 * STEPS_LAST),
    };
    Reach {
        steps,
        spare,
        restart: Restart::First,
    }
}

/// The model after a command by the profile of its dead time, and how far that is in
/// doubt, s.
fn by_profile(
    fitting: &Fitting<'_>,
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
        is_given
            .then(|| fitting.refine(start, false, effort))
            .flatten()
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
