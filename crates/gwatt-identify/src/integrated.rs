//! The search where a position or speed was measured: model and noise, which show only
//! after one another.
//!
//! The models that a search starts from are mostly near to what is sought, though the
//! noise is known but roughly: next to the best of them it is taken again, and the search
//! goes on after that. What is found may show still other noise, or may have modes that
//! stand for noise: then the search goes on from there, among neighbours.

use super::any_delay::{Timed, timed};
use super::candidate_models::{Given, simpler};
use super::chosen::{CHOSEN, COMPARED, Chosen, WHITENING_MAX, fewer_rows, is_white};
use super::creeping::slow_rad_s;
use super::data::Data;
use super::delay_profile::doubt_s;
use super::disturbance::as_it_is;
use super::estimate::Estimate;
use super::measured_noise::Noise;
use super::noise::predicting;
use super::output_error::{Effort, Fitting, residuals};
use super::response_starts::from_subspace;
use super::spectrum::FrequencyResponse;
use super::stepwise_search::{Ladder, Reach, Restart, STEPS_LAST, best_of};
use super::transfer::TransferFunction;

/// Rounds of model and noise, after the one that the starts are fitted in.
const ROUNDS: usize = 3;
/// Simpler models next to which the noise is taken.
const SIMPLE: usize = 2;
/// Steps of all fits of the first search, and as many to spare.
const STEPS: usize = 300;
/// Steps of a model on more samples.
const STEPS_AGAIN: usize = 10;

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
    let mut is_simple = false;
    for round in 0..=ROUNDS {
        let leaky = noise.held(raw);
        let data = leaky.as_ref().map_or(*raw, |leaky| leaky.data(raw));
        let rows = data.head(compared);
        let fewer = fewer_rows(&rows, compared, band_rad_s);
        let short = fewer.as_ref().map_or(rows, |fewer| fewer.data(&rows));
        let stage = Stage {
            raw: raw.head(compared),
            data,
            rows,
            fitting: Fitting::new(short, &noise.taps),
            is_all: short.len() == data.len(),
            noise: &noise,
            response,
            given,
        };
        if round == 0 {
            starts.extend(from_subspace(&rows, given));
        }
        let next = match stage.go_on(round, &starts, &mut is_simple)? {
            Next::Chosen(chosen) => return Some(*chosen),
            Next::Noise(next, from) => {
                starts = from;
                next
            }
        };
        noise = next;
    }
    None
}

/// What comes after a search.
enum Next {
    /// Another one, after other noise, from these models.
    Noise(Noise, Vec<TransferFunction>),
    /// Nothing: what was found.
    Chosen(Box<Chosen>),
}

/// A search after one noise.
struct Stage<'a> {
    /// The samples on which models are compared, as they were recorded.
    raw: Data<'a>,
    /// All samples, and those, after what holds the noise.
    data: Data<'a>,
    rows: Data<'a>,
    /// Fits of models that are compared, and whether to all samples.
    fitting: Fitting<'a>,
    is_all: bool,
    noise: &'a Noise,
    response: &'a FrequencyResponse,
    given: Given,
}

impl Stage<'_> {
    fn go_on(
        &self,
        round: usize,
        starts: &[TransferFunction],
        is_simple: &mut bool,
    ) -> Option<Next> {
        let ladder = Ladder {
            fitting: &self.fitting,
            early_s: self.data.early_s,
            step_s: self.data.period_s,
            period_s: self.data.period_s,
            response: self.response,
            given: self.given,
        };
        let mut tried = ladder.fitted(starts, round > 0);
        if round == 0 {
            let best = self
                .timed(&self.fitting, best_of(tried.clone()).next()?)
                .found;
            if let Some(next) = self.other_noise(&best) {
                let others = best_of(tried).map(|found| found.transfer);
                let starts = std::iter::once(best.transfer).chain(others).collect();
                return Some(Next::Noise(next, starts));
            }
            tried.push(best);
        }
        tried = ladder.climb(tried, reach(round < 2));
        let best = self.timed(&self.fitting, best_of(tried.clone()).next()?);
        if round < ROUNDS {
            if let Some(next) = self.other_noise(&best.found) {
                return Some(Next::Noise(next, vec![best.found.transfer]));
            }
            if !*is_simple {
                *is_simple = true;
                if let Some((next, less)) = self.simple(&best.found) {
                    return Some(Next::Noise(next, vec![less]));
                }
            }
        }
        self.chosen(tried, best)
    }

    /// A model with its delay.
    fn timed(&self, fitting: &Fitting<'_>, found: Estimate) -> Timed {
        match self.given.delay_s {
            None => timed(fitting, self.data.period_s, found),
            Some(_) => Timed::as_it_is(found),
        }
    }

    /// The noise next to a model, where it is clearly other noise than was supposed.
    fn other_noise(&self, found: &Estimate) -> Option<Noise> {
        let plain = as_it_is(&self.rows, &found.transfer)?;
        let left = residuals(&self.rows, &plain)?;
        if found.is_exact() || is_white(&left, &self.noise.taps) {
            return None;
        }
        Noise::next_to(&self.raw, &found.transfer, WHITENING_MAX, Some(self.noise))
    }

    /// The same noise with taps that suit the model that was found, where those next to the
    /// one before do not make it white.
    fn other_taps(&self, found: &Estimate) -> Option<Noise> {
        if self.noise.taps.is_empty() {
            return None;
        }
        let long = self.data.head(CHOSEN);
        let plain = as_it_is(&long, &found.transfer)?;
        let left = residuals(&long, &plain)?;
        (!found.is_exact() && !is_white(&left, &self.noise.taps)).then(|| Noise {
            leak: self.noise.leak,
            taps: predicting(&left, WHITENING_MAX),
        })
    }

    /// A simpler model with the noise next to it, where both together explain the
    /// recording better: slow modes may stand for what disturbs the axis, and lags for a
    /// part of a period of delay.
    fn simple(&self, best: &Estimate) -> Option<(Noise, TransferFunction)> {
        let raw = &self.raw;
        let slow_rad_s = slow_rad_s(raw.len(), raw.period_s);
        let band_rad_s = self.response.band_rad_s();
        let less = simpler(
            &best.transfer,
            band_rad_s,
            slow_rad_s,
            self.given,
            raw.period_s,
        );
        let fitted = less.iter().filter_map(|less| {
            let is_free = self.given.delay_s.is_none();
            let found = self.fitting.refine(less, is_free, Effort::FULL)?;
            Some(self.timed(&self.fitting, found).found)
        });
        let with_noise = |less: Estimate| {
            let noise = Noise::next_to(raw, &less.transfer, WHITENING_MAX, None)?;
            let (criterion, less) = noise.with(raw, &less.transfer)?;
            Some((criterion, noise, less.transfer))
        };
        let found = best_of(fitted.collect())
            .take(SIMPLE)
            .filter_map(with_noise)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let (criterion, noise, less) = found?;
        let (now, _) = self.noise.with(raw, &best.transfer)?;
        (criterion < now).then_some((noise, less))
    }

    /// The best model on more samples, and how far its delay is in doubt.
    fn chosen(&self, tried: Vec<Estimate>, best: Timed) -> Option<Next> {
        let others = doubt_s(&tried);
        let long = (!self.is_all).then(|| Fitting::new(self.data.head(CHOSEN), &self.noise.taps));
        let (fitting, best) = match &long {
            None => (&self.fitting, best),
            Some(long) => (long, self.timed(long, best_again(long, tried)?)),
        };
        let doubt_s = libm::hypot(others, best.alone_s);
        let noise = self.other_taps(&best.found);
        Some(Next::Chosen(Box::new(Chosen {
            found: fitting.settled(best.found)?,
            delay_is_free: best.is_free,
            delay_doubt_s: self.given.delay_s.map_or(doubt_s, |_| 0.0),
            noise: noise.unwrap_or_else(|| self.noise.clone()),
        })))
    }
}

/// How far the first search goes, or a later one from what it found.
fn reach(is_first: bool) -> Reach {
    let (steps, restart) = if is_first {
        (STEPS, Restart::WhereStuck)
    } else {
        (STEPS_LAST, Restart::Unless)
    };
    Reach {
        steps,
        spare: steps,
        restart,
    }
}

/// The best of models on more samples, where another one may be the best.
fn best_again(fitting: &Fitting<'_>, tried: Vec<Estimate>) -> Option<Estimate> {
    let mut best: Option<Estimate> = None;
    for found in best_of(tried) {
        let effort = Effort {
            steps: STEPS_AGAIN,
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
