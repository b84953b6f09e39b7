//! How long the dead time after a command is, and how far that is known.
//!
//! A loop follows up to some frequency, and a recording shows little beyond: there
//! a mode, a lag or dead time make slow motion late alike. A search finds one of
//! these models; here the dead time is made shorter step by step, while poles that
//! are added and zeros that are left out take over what it was. Each dead time so
//! gets the likelihood of the best model that has it (the profile likelihood), and
//! the model is that of the mean.

use super::estimate::Estimate;
use super::output_error::Effort;
use super::transfer::{Factor, TransferFunction};

/// Steps of each fit: models go on from those of the dead time before.
const STEPS: usize = 14;
/// Dead times less likely than the best by so much (Akaike's criterion), so many in
/// a row, end the profile.
const UNLIKELY: f64 = 20.0;
const IN_A_ROW: usize = 3;
/// Poles at most.
const ORDER_MAX: usize = 10;
/// Where a mode is placed first, in times of the band; how fast it is at most, rad
/// per period; and its damping.
const ABOVE: f64 = 1.5;
const FAST: f64 = 2.5;
const DAMPING: f64 = 0.4;
/// Zeros damped less show in a recording: none of them is left out.
const SWINGS: f64 = 0.5;
/// Delays nearer than this, in periods, are the same.
const SAME: f64 = 1e-6;

/// A model with its dead time, and how uncertain that is.
pub struct Profile {
    /// The model.
    pub estimate: Estimate,
    /// Standard error of its delay, s.
    pub doubt_s: f64,
}

/// What is known beforehand.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// The shortest delay, s.
    pub least_s: f64,
    /// Steps of the delay, periods.
    pub step_periods: f64,
    /// Sampling period, s.
    pub period_s: f64,
    /// Up to where the recording shows the axis, rad/s.
    pub band_rad_s: f64,
}

impl Bounds {
    fn step_s(&self) -> f64 {
        self.step_periods * self.period_s
    }
}

/// The profile below the delay of the best of models, and the model of the mean.
#[must_use]
pub fn profile(
    fit: impl Fn(&TransferFunction, Effort) -> Option<Estimate>,
    tried: Vec<Estimate>,
    bounds: Bounds,
) -> Option<Profile> {
    let best = tried
        .iter()
        .min_by(|a, b| a.criterion().total_cmp(&b.criterion()))?;
    let effort = Effort {
        steps: STEPS,
        to_beat: f64::MAX,
    };
    let mut least = best.likelihood();
    let mut delay_s = best.transfer.delay_s;
    let mut chains = chains(&best.transfer, bounds);
    let mut all = tried;
    let mut unlikely = 0;
    while unlikely < IN_A_ROW && delay_s > bounds.least_s - SAME * bounds.period_s {
        let mut here = f64::MAX;
        for chain in &mut chains {
            if chain.delay_s < delay_s - SAME * bounds.period_s {
                continue;
            }
            chain.delay_s = delay_s;
            if let Some(found) = fit(chain, effort) {
                chain.clone_from(&found.transfer);
                here = here.min(found.likelihood());
                all.push(found);
            }
        }
        least = least.min(here);
        let is_unlikely = here > least + UNLIKELY;
        unlikely = if is_unlikely { unlikely + 1 } else { 0 };
        delay_s -= bounds.step_s();
    }
    // What a pole takes back a zero has given to noise.
    let (plain, noisy): (Vec<_>, Vec<_>) =
        all.into_iter().partition(|found| !cancels(&found.transfer));
    of_the_mean(if plain.is_empty() { &noisy } else { &plain }, bounds)
}

/// True for a zero that swings next to a pole that leaves nothing of it.
fn cancels(model: &TransferFunction) -> bool {
    let is_undone = |zero: &Factor| model.poles.iter().any(|pole| zero.is_undone_by(*pole));
    model.zeros.iter().any(is_undone)
}

/// Models that go on to shorter dead times, each from its own on: with all zeros or
/// without the fastest of those that do not swing, as it is and with a mode beyond
/// the band.
fn chains(best: &TransferFunction, bounds: Bounds) -> Vec<TransferFunction> {
    let mut out = vec![best.clone()];
    let swings =
        |zero: &Factor| matches!(zero, Factor::Pair { damping, .. } if damping.abs() < SWINGS);
    let zeros = best.zeros.iter().enumerate();
    let fastest = zeros
        .filter(|(_, zero)| !swings(zero))
        .max_by(|(_, a), (_, b)| a.corner_rad_s().total_cmp(&b.corner_rad_s()));
    if let Some((index, _)) = fastest {
        let mut less = best.clone();
        less.zeros.remove(index);
        out.push(less);
    }
    let more: Vec<TransferFunction> = out
        .iter()
        .filter(|model| model.order() + 2 <= ORDER_MAX)
        .map(|model| with_mode(model, best, bounds))
        .collect();
    out.extend(more);
    out
}

/// With a mode beyond the band: what it makes late is taken off the dead time.
fn with_mode(
    model: &TransferFunction,
    best: &TransferFunction,
    bounds: Bounds,
) -> TransferFunction {
    let room_s = best.delay_s - bounds.least_s + best.lag_s() - model.lag_s();
    let slowest = 2.0 * DAMPING / room_s.max(0.1 * bounds.period_s);
    let mut more = model.clone();
    more.poles.push(Factor::Pair {
        omega_rad_s: (ABOVE * bounds.band_rad_s)
            .max(slowest)
            .min(FAST / bounds.period_s),
        damping: DAMPING,
    });
    let steps = libm::round((more.lag_s() - best.lag_s()) / bounds.step_s());
    let delay_s = best.delay_s - steps.max(0.0) * bounds.step_s();
    more.delay_s = delay_s.max(bounds.least_s);
    more
}

/// Of models, that of the mean delay, each delay counting by its likelihood.
fn of_the_mean(all: &[Estimate], bounds: Bounds) -> Option<Profile> {
    let same_s = SAME * bounds.period_s;
    let mut delays: Vec<(f64, f64)> = Vec::new();
    for found in all {
        let (delay_s, likelihood) = (found.transfer.delay_s, found.likelihood());
        let is_same = |(other, _): &&mut (f64, f64)| (*other - delay_s).abs() < same_s;
        match delays.iter_mut().find(is_same) {
            Some((_, least)) => *least = least.min(likelihood),
            None => delays.push((delay_s, likelihood)),
        }
    }
    let likelihoods = delays.iter().map(|(_, likelihood)| *likelihood);
    let least = likelihoods.fold(f64::MAX, f64::min);
    for (_, likelihood) in &mut delays {
        *likelihood = libm::exp(0.5 * (least - *likelihood));
    }
    let sum: f64 = delays.iter().map(|(_, weight)| weight).sum();
    let mean = |of: &dyn Fn(f64) -> f64| -> f64 {
        let each = delays.iter().map(|(delay_s, weight)| weight * of(*delay_s));
        each.sum::<f64>() / sum
    };
    let mean_s = mean(&|delay_s| delay_s);
    let off_s = |found: &Estimate| (found.transfer.delay_s - mean_s).abs();
    let nearest_s = all.iter().map(off_s).fold(f64::MAX, f64::min);
    let estimate = all
        .iter()
        .filter(|found| off_s(found) < nearest_s + same_s)
        .min_by(|a, b| a.likelihood().total_cmp(&b.likelihood()))?
        .clone();
    let here_s = estimate.transfer.delay_s;
    let variance = mean(&|delay_s| (delay_s - here_s) * (delay_s - here_s));
    Some(Profile {
        estimate,
        doubt_s: variance.sqrt(),
    })
}

/// How far the delays of models that explain the recording as well are apart from
/// that of the best, s: each counts by how likely it makes the recording.
#[must_use]
pub fn doubt_s(tried: &[Estimate]) -> f64 {
    let Some(best) = tried
        .iter()
        .min_by(|a, b| a.criterion().total_cmp(&b.criterion()))
    else {
        return 0.0;
    };
    let mut kinds: Vec<(f64, f64)> = Vec::new();
    for found in tried {
        let (delay_s, likelihood) = (found.transfer.delay_s, found.likelihood());
        match kinds.iter_mut().find(|(delay, _)| *delay == delay_s) {
            Some((_, least)) => *least = least.min(likelihood),
            None => kinds.push((delay_s, likelihood)),
        }
    }
    let least = kinds.iter().map(|(_, x)| *x).fold(f64::MAX, f64::min);
    let (mut sum, mut weights) = (0.0, 0.0);
    for (delay_s, likelihood) in kinds {
        let weight = libm::exp(0.5 * (least - likelihood));
        let apart = delay_s - best.transfer.delay_s;
        sum += weight * apart * apart;
        weights += weight;
    }
    (sum / weights).sqrt()
}
