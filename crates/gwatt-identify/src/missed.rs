//! Standard errors where what a model leaves is more than white noise.
//!
//! Errors by the inverse of the normal matrix hold for a model that leaves nothing but white
//! noise. Two things widen them here. Noise of another colour: whatever a figure weighs the
//! samples by, its variance grows by no more than the highest point of the noise's spectrum,
//! by its mean. And what the model misses of the axis: its energy in units of the noise is
//! the square of how many standard errors figures can be off by it (Cauchy and Schwarz), if
//! what shows of it in the residual is as large as what went into the figures.

use super::certainty;
use super::chosen::LAGS;
use super::noise::{Whiteness, autocorrelation};
use super::spectrum::coherent;

/// Frequencies with less of the input's power, by its highest, are those of its windows: what
/// they seem to explain is one and the same.
const NOTHING: f64 = 1e-6;
/// Frequencies at which the noise's spectrum is looked at.
const POINTS: usize = 200;

/// By which factor the highest point of a residual's spectrum exceeds its mean, where it is
/// not white; else 1.
#[must_use]
pub fn peak_of_colour(white: &[f64]) -> f64 {
    if Whiteness::of(white, LAGS).is_white() {
        return 1.0;
    }
    let rho = autocorrelation(white, LAGS);
    let at = |point: usize| {
        let theta = std::f64::consts::PI * point as f64 / POINTS as f64;
        let each = rho.iter().enumerate().skip(1).map(|(lag, r)| {
            let weight = 1.0 - lag as f64 / (LAGS + 1) as f64;
            2.0 * weight * r * libm::cos(lag as f64 * theta)
        });
        1.0 + each.sum::<f64>()
    };
    (0..=POINTS).map(at).fold(1.0, f64::max)
}

/// The energy of what a model misses, in units of what is left after the noise was made
/// white, as far as the input explains it more than by chance. 0 where chance may do.
#[must_use]
pub fn missed_energy(by: &[f64], white: &[f64], period_s: f64) -> f64 {
    // What came before the first whitened value.
    let by = by.get(by.len().saturating_sub(white.len())..);
    let found = coherent(by.unwrap_or_default(), white, period_s);
    let most = found.by_power.iter().copied().fold(0.0, f64::max);
    let is_excited = |power: f64| power > NOTHING * most;
    let excited = found.by_power.iter().filter(|power| is_excited(**power));
    let bins = excited.count() as f64;
    let (k, chance) = (found.independent, 1.0 / found.independent);
    if bins < 1.0 || chance >= 0.5 {
        return 0.0;
    }
    // What chance exceeds at one of all frequencies once in so many recordings.
    let highest = 1.0 - libm::pow(certainty::MISSED_SELDOM / bins, 1.0 / (k - 1.0));
    let (mut sum, mut all, mut power, mut peaks) = (0.0, 0.0, 0.0, 0.0);
    let all_bins = found.coherence.iter().zip(&found.power);
    for ((coherence, each), by) in all_bins.zip(&found.by_power) {
        power += each;
        if !is_excited(*by) {
            continue;
        }
        let more = (coherence - chance) / (1.0 - chance);
        sum += coherence - chance;
        all += each * more;
        if *coherence > highest {
            peaks += each * more;
        }
    }
    // Windows make neighbours alike: two frequencies count as one.
    let is_sure = sum > certainty::MISSED_ENERGY * chance * (2.0 * bins).sqrt();
    let explained = if is_sure { all.max(peaks) } else { peaks };
    if power > 0.0 {
        white.len() as f64 * explained / power
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(seed: u64, samples: usize) -> Vec<f64> {
        let mut state = seed;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..samples)
            .map(|_| (0..12).map(|_| uniform()).sum())
            .collect()
    }

    /// Of noise nothing is missed in 200 recordings but by chance; of a fifth of the input
    /// next to it 1/25 of the samples.
    #[test]
    fn what_the_input_explains_is_missed() {
        let samples = 8000;
        let pair = |seed: u64| {
            let mut both = noise(seed, 2 * samples);
            let left = both.split_off(samples);
            (both, left)
        };
        let by_chance = (0..200)
            .filter(|seed| {
                let (by, left) = pair(*seed);
                missed_energy(&by, &left, 1e-3) > 0.0
            })
            .count();
        assert!(by_chance <= 2, "{by_chance}");
        let (by, mut left) = pair(7);
        for (left, by) in left.iter_mut().zip(&by) {
            *left += 0.2 * by;
        }
        let energy = missed_energy(&by, &left, 1e-3);
        assert!((180.0..440.0).contains(&energy), "{energy}");
    }

    /// A first-order process `x + x₋₁/2` has its spectrum's highest point, (3/2)², at 0, with
    /// a mean of 5/4; the window takes little off.
    #[test]
    fn colour_counts_by_its_highest_point() {
        let white = noise(3, 20_000);
        assert_eq!(peak_of_colour(&white), 1.0);
        let coloured: Vec<f64> = white.windows(2).map(|w| w[1] + 0.5 * w[0]).collect();
        let peak = peak_of_colour(&coloured);
        assert!((1.6..2.1).contains(&peak), "{peak}");
    }
}
