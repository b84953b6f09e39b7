//! What noise a position or speed was measured with, and what disturbs the axis next to
//! it: integrators with the leak after which it is predicted best.
//!
//! Noise of the measurement alone needs integrators that hardly leak, disturbances of
//! the force plain differences; where both are, it is in between, and an
//! autoregressive filter makes the rest white.

use super::candidate_models::Given;
use super::certainty;
use super::chosen::{COARSE, LAGS};
use super::data::Data;
use super::estimate::{Estimate, ROUNDING};
use super::leaky_integrator::Leaky;
use super::measured_noise::Noise;
use super::mode_starts;
use super::noise::{Whiteness, predicting};
use super::output_error::{Effort, refine, residuals};
use super::spectral_lines::Lines;
use super::stepwise_search::SEARCH_STEPS;
use super::transfer::TransferFunction;

/// Leaks that are tried, from sample to sample; nothing leaks for longer than the
/// recording lasts.
const LEAKS: [f64; 7] = [0.4, 0.16, 0.06, 0.025, 0.01, 0.004, 0.0016];
/// Samples in units of which the longest is.
const LASTS: f64 = 2.0;
/// Integrators leak no less: held for longer, what wanders leaves too few digits for what
/// swings, and slower than this nothing of an axis is.
const LEAST: f64 = 2e-5;
/// Leak of the integrators at first, as a share of the band.
const SLOW: f64 = 0.25;
/// Taps before any model was searched for: what is missing must not pass for noise.
const FIRST_MAX: usize = 4;
/// How far a model is moved for each.
const EFFORT: Effort = Effort {
    steps: 4,
    to_beat: f64::MAX,
};

/// The model as it is, with its offset and first state.
#[must_use]
pub fn as_it_is(data: &Data<'_>, transfer: &TransferFunction) -> Option<Estimate> {
    let effort = Effort {
        steps: 0,
        to_beat: f64::MAX,
    };
    let open = Data {
        undisturbed: None,
        ..*data
    };
    refine(&open, transfer, false, &[], effort)
}

impl Noise {
    /// Plain differences after the integrators that go with it; `None` for none.
    #[must_use]
    pub fn held(&self, data: &Data<'_>) -> Option<Leaky> {
        (self.leak > 0.0).then(|| Leaky::of(data, self.leak))
    }

    /// The noise next to the best of the models that a search starts from, found on the
    /// first samples, and these models.
    #[must_use]
    pub fn first(
        data: &Data<'_>,
        head: Data<'_>,
        band_rad_s: f64,
        given: Given,
    ) -> (Self, Vec<TransferFunction>) {
        let first = Self::leaking((SLOW * band_rad_s * data.period_s).min(0.5));
        let lines = Lines::new(data, &first, band_rad_s, COARSE);
        let starts = lines.map_or(Vec::new(), |lines| mode_starts::starts(&lines, given));
        let leaky = Leaky::of(&head, first.leak);
        let effort = Effort {
            steps: SEARCH_STEPS,
            to_beat: f64::MAX,
        };
        let found = starts
            .iter()
            .filter_map(|start| refine(&leaky.data(&head), start, false, &[], effort));
        let best = found.min_by(|a, b| a.criterion().total_cmp(&b.criterion()));
        let noise = best.and_then(|best| Self::next_to(&head, &best.transfer, FIRST_MAX, None));
        (noise.unwrap_or(first), starts)
    }

    /// The noise next to which a model, moved a little, explains plain differences best,
    /// with so many taps at most. `None` when none is clearly better than this one.
    #[must_use]
    pub fn next_to(
        data: &Data<'_>,
        transfer: &TransferFunction,
        taps_max: usize,
        than: Option<&Self>,
    ) -> Option<Self> {
        let now = than.and_then(|noise| {
            let leaky = noise.held(data);
            let data = leaky.as_ref().map_or(*data, |leaky| leaky.data(data));
            noise.criterion(&data, transfer).map(|(now, _)| now)
        });
        let found = match Self::uncoloured(data, transfer) {
            (found, true) => found,
            (found, false) => {
                let coloured = Self::coloured(data, transfer, taps_max);
                let both = found.into_iter().chain(coloured);
                both.min_by(|a, b| a.0.total_cmp(&b.0))
            }
        };
        let is_clear = |least: f64| now.is_none_or(|now| least < now - certainty::OTHER_NOISE);
        let found = found.filter(|(least, _)| is_clear(*least));
        found.map(|(_, noise)| noise)
    }

    /// The best leak alone with its criterion, and whether it makes the noise white. From
    /// leak to leak a model moves little.
    fn uncoloured(data: &Data<'_>, transfer: &TransferFunction) -> (Option<(f64, Self)>, bool) {
        let mut best: Option<(f64, Self)> = None;
        let mut is_white = false;
        let mut moved = transfer.clone();
        for leak in leaks(data.len()) {
            let noise = Self::leaking(leak);
            let leaky = noise.held(data);
            let data = leaky.as_ref().map_or(*data, |leaky| leaky.data(data));
            match noise.criterion(&data, &moved) {
                Some((criterion, found)) if is_less(criterion, best.as_ref()) => {
                    let left = residuals(&data, &found);
                    is_white = left.is_some_and(|left| Whiteness::of(&left, LAGS).is_white());
                    best = Some((criterion, noise));
                    moved = found.transfer;
                }
                _ => break,
            }
        }
        (best, is_white)
    }

    /// The best of all leaks with a filter after each, and its criterion.
    fn coloured(
        data: &Data<'_>,
        transfer: &TransferFunction,
        taps_max: usize,
    ) -> Option<(f64, Self)> {
        let mut best: Option<(f64, Self)> = None;
        let mut worse_in_a_row = 0;
        let mut moved = transfer.clone();
        for leak in leaks(data.len()) {
            let mut noise = Self::leaking(leak);
            let leaky = noise.held(data);
            let data = leaky.as_ref().map_or(*data, |leaky| leaky.data(data));
            let taps = |left: Option<Vec<f64>>| predicting(&left.unwrap_or_default(), taps_max);
            let before = as_it_is(&data, &moved);
            noise.taps = taps(before.and_then(|before| residuals(&data, &before)));
            worse_in_a_row += 1;
            if let Some((criterion, found)) = noise.criterion(&data, &moved) {
                noise.taps = taps(residuals(&data, &found));
                moved = found.transfer;
                if is_less(criterion, best.as_ref()) {
                    best = Some((criterion, noise));
                    worse_in_a_row = 0;
                }
            }
            if worse_in_a_row > 1 {
                break;
            }
        }
        best
    }

    /// White noise that was integrated, after integrators that leak less, as long as
    /// all samples are explained better with them.
    #[must_use]
    pub fn closer(self, data: &Data<'_>, transfer: &TransferFunction) -> Self {
        if self.leak == 0.0 || !self.taps.is_empty() {
            return self;
        }
        let mut best = self;
        let mut least = f64::MAX;
        let mut moved = transfer.clone();
        let first = best.leak;
        for leak in leaks(data.len()).filter(|leak| *leak > 0.0 && *leak <= first) {
            let noise = Self::leaking(leak);
            let leaky = Leaky::of(data, leak);
            match noise.criterion(&leaky.data(data), &moved) {
                Some((criterion, found)) if criterion < least => {
                    least = criterion;
                    moved = found.transfer;
                    best = noise;
                }
                _ => break,
            }
        }
        best
    }

    /// A criterion of this noise and a model together, the smaller, the better; with the
    /// model, moved to where it suits the noise.
    #[must_use]
    pub fn with(&self, data: &Data<'_>, transfer: &TransferFunction) -> Option<(f64, Estimate)> {
        let leaky = self.held(data);
        let data = leaky.as_ref().map_or(*data, |leaky| leaky.data(data));
        let (noise, found) = self.criterion(&data, transfer)?;
        let n = data.len() as f64;
        Some((
            noise + found.count as f64 * libm::log(n) + found.charge,
            found,
        ))
    }

    fn leaking(leak: f64) -> Self {
        Self {
            leak,
            taps: Vec::new(),
        }
    }

    /// Akaike's criterion of what could not be foreseen after the integrators, whatever
    /// was filtered by: each filter begins with 1. With the model that was moved for it.
    /// `None` also where motion leaves no digits for noise.
    fn criterion(&self, data: &Data<'_>, transfer: &TransferFunction) -> Option<(f64, Estimate)> {
        let found = refine(data, transfer, false, &self.taps, EFFORT)?;
        if data.leak > 0.0 && found.rest < ROUNDING * found.power {
            return None;
        }
        let each = found.rest / found.rows.max(1) as f64;
        let n = data.len() as f64;
        let criterion = n * libm::log(each.max(f64::MIN_POSITIVE)) + 2.0 * self.taps.len() as f64;
        Some((criterion, found))
    }
}

fn is_less(criterion: f64, than: Option<&(f64, Noise)>) -> bool {
    than.is_none_or(|(than, _)| criterion < *than)
}

/// The leaks that are tried on so many samples, ascending in time: 0 for no integrators.
pub(super) fn leaks(samples: usize) -> impl Iterator<Item = f64> {
    let least = (LASTS / samples.max(1) as f64).max(LEAST);
    let all = LEAKS.into_iter().filter(move |leak| *leak > least);
    std::iter::once(0.0).chain(all).chain([least])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_held_for_longer_than_digits_last() {
        assert_eq!(leaks(1000).last(), Some(2e-3));
        assert_eq!(leaks(1_000_000).last(), Some(LEAST));
    }
}
