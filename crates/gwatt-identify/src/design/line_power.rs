//! How the power of a multisine is spread over its lines, so that the figures of an axis
//! are determined best.
//!
//! Each line adds to the information matrix M what the response there depends on the
//! parameters, by its power. A sum of variances, each by its weight, is least where no line
//! would lower it more than the others: `P_k ← P_k·√d_k`, with
//! `d_k = gᴴ·M⁻¹·W·M⁻¹·g`, comes nearer in each step (Pronzato & Pázman, *Design of
//! Experiments in Nonlinear Models*, 2013, section 9.1; Goodwin & Payne 1977 for spectra).
//! The weights follow: what is farthest from what is wanted counts most.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix};

use super::foreseen::{places, wanted, wanted_gain};
use super::known::Known;
use crate::parameters::{parameters, probes, with};
use crate::spectral_lines::{integrators, response};
use crate::transfer::Factor;

type C = Complex<f64>;

/// Frequencies at which responses are looked at, at most.
const POINTS: usize = 1500;
/// Steps: the variances are then within some percent of the least.
const STEPS: usize = 60;
/// Share of the power that is spread evenly over the band: what is not known yet is to
/// show too, and the order of the model with it.
const EVEN: f64 = 0.2;
/// How fast weights follow, and by how much a figure counts less at most that is better
/// known than it needs to be.
const BALANCE: f64 = 0.3;
const WEIGHT_MIN: f64 = 1e-3;
/// Where an axis moves less than this share of what a rigid one would, it is taken to
/// move as much.
const GAIN_MIN: f64 = 0.02;
/// The model is uncertain by so many standard errors of each frequency.
const UNCERTAIN: f64 = 2.0;

/// Powers of these lines (Hz), of which the sum is 1; as good as they can be for a force
/// of one size, or for an acceleration of one size (`quiet`). `None` where they do not
/// determine the axis.
pub(super) fn line_powers(known: &Known, lines_hz: &[f64], quiet: bool) -> Option<Vec<f64>> {
    let every = lines_hz.len().div_ceil(POINTS).max(1);
    let points: Vec<f64> = lines_hz.iter().copied().step_by(every).collect();
    let size = |hz: &f64| {
        let gain = known.transfer.at_hz(*hz).norm() / known.transfer.gain;
        if quiet { gain.max(GAIN_MIN) } else { 1.0 }
    };
    let sizes: Vec<f64> = points.iter().map(size).collect();
    let mut slopes = slopes(known, &points);
    for (slopes, size) in slopes.iter_mut().zip(&sizes) {
        for slope in slopes.iter_mut() {
            *slope /= *size;
        }
    }
    let wanted = weights(known);
    let mut weights = wanted.clone();
    let mut power = vec![1.0 / points.len().max(1) as f64; points.len()];
    for _ in 0..STEPS {
        let (gains, variances) = gains(&slopes, &power, &weights)?;
        balance(&mut weights, &wanted, &variances);
        for (power, gain) in power.iter_mut().zip(gains) {
            *power *= gain.max(0.0).sqrt();
        }
        let sum: f64 = power.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        for power in &mut power {
            *power /= sum;
        }
    }
    for (power, size) in power.iter_mut().zip(&sizes) {
        *power /= size * size;
    }
    let spread = spread(known, &points, &power);
    let even = EVEN / lines_hz.len() as f64;
    let all: Vec<f64> = (0..lines_hz.len())
        .map(|line| spread.get(line / every).copied().unwrap_or_default())
        .collect();
    let sum: f64 = all.iter().sum();
    Some(all.iter().map(|p| (1.0 - EVEN) * p / sum + even).collect())
}

/// What the response at each frequency depends on each parameter, by the noise there.
fn slopes(known: &Known, points: &[f64]) -> Vec<Vec<C>> {
    let is_late = known.transfer.delay_s > 0.0;
    let theta = parameters(&known.transfer, is_late);
    let moved: Vec<_> = probes(&known.transfer, is_late, known.period_s)
        .into_iter()
        .enumerate()
        .map(|(index, probe)| {
            let mut theta = theta.clone();
            if let Some(slot) = theta.get_mut(index) {
                *slot += probe;
            }
            (with(&known.transfer, &theta), probe)
        })
        .collect();
    let noise = &known.noise;
    let times = known.measured.integrators();
    let at = |hz: &f64| {
        let turn = TAU * hz * known.period_s;
        let weight = response(&noise.taps, turn) * integrators(noise.leak, times, turn);
        let base = known.transfer.at_hz(*hz);
        let slopes = moved.iter();
        slopes
            .map(|(moved, probe)| (moved.at_hz(*hz) - base) * (weight / probe))
            .collect()
    };
    points.iter().map(at).collect()
}

/// How much the variance of each parameter counts.
fn weights(known: &Known) -> Vec<f64> {
    let is_late = known.transfer.delay_s > 0.0;
    let mut weights = vec![0.0; parameters(&known.transfer, is_late).len()];
    let mut put = |at: usize, wanted: f64| {
        if let Some(slot) = weights.get_mut(at) {
            *slot = 1.0 / (wanted * wanted).max(f64::MIN_POSITIVE);
        }
    };
    put(0, wanted_gain() * known.transfer.gain);
    for (index, at) in places(known).into_iter().enumerate() {
        if let Some(at) = at {
            let [frequency, damping] = wanted(known, index);
            put(at, frequency);
            put(at + 1, damping);
        }
    }
    weights
}

/// Variances that are farther from what is wanted than others count more from now on: in
/// the end the largest of them is the least that can be had.
fn balance(weights: &mut [f64], wanted: &[f64], variances: &[f64]) {
    let excess = |(wanted, variance): (&f64, &f64)| (wanted * variance).sqrt();
    let all: Vec<f64> = wanted.iter().zip(variances).map(excess).collect();
    let most = all.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    for ((weight, wanted), excess) in weights.iter_mut().zip(wanted).zip(&all) {
        let least = WEIGHT_MIN * wanted;
        *weight = (*weight * libm::pow(excess / most, BALANCE)).max(least);
    }
}

/// By how much more power at each frequency would lower the sum of variances; and the
/// variances.
fn gains(slopes: &[Vec<C>], power: &[f64], weights: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = weights.len();
    let mut matrix = DMatrix::<f64>::zeros(n, n);
    for (g, power) in slopes.iter().zip(power) {
        for (i, a) in g.iter().enumerate() {
            for (j, b) in g.iter().enumerate().take(i + 1) {
                matrix[(i, j)] += power * (a.re * b.re + a.im * b.im);
            }
        }
    }
    for i in 0..n {
        for j in i + 1..n {
            matrix[(i, j)] = matrix[(j, i)];
        }
    }
    // Units differ by powers of ten: the diagonal is made 1.
    let scale: Vec<f64> = matrix.diagonal().iter().map(|d| 1.0 / d.sqrt()).collect();
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    let scales = |i: usize, j: usize| -> Option<f64> { Some(scale.get(i)? * scale.get(j)?) };
    for i in 0..n {
        for j in 0..n {
            matrix[(i, j)] *= scales(i, j)?;
        }
        matrix[(i, i)] += 1e-12;
    }
    let mut inverse = matrix.cholesky()?.inverse();
    for i in 0..n {
        for j in 0..n {
            inverse[(i, j)] *= scales(i, j)?;
        }
    }
    let variances = inverse.diagonal().iter().copied().collect();
    let mut weighed = inverse.clone();
    for (i, weight) in weights.iter().enumerate() {
        weighed.row_mut(i).scale_mut(*weight);
    }
    let matrix = inverse * weighed;
    let gain = |g: &Vec<C>| {
        let mut sum = 0.0;
        for (i, a) in g.iter().enumerate() {
            for (j, b) in g.iter().enumerate() {
                sum += matrix[(i, j)] * (a.re * b.re + a.im * b.im);
            }
        }
        sum
    };
    Some((slopes.iter().map(gain).collect(), variances))
}

/// Powers as wide as the model is uncertain: each root may be a little higher or lower.
fn spread(known: &Known, points: &[f64], power: &[f64]) -> Vec<f64> {
    let mut out = power.to_vec();
    for (root, share) in &known.roots {
        let Factor::Pair { omega_rad_s, .. } = *root else {
            continue;
        };
        let hz = omega_rad_s / TAU;
        let half = UNCERTAIN * share * hz;
        let step = points
            .first()
            .zip(points.get(1))
            .map_or(f64::INFINITY, |(a, b)| b - a);
        let reach = (half / step).min(points.len() as f64) as usize;
        if reach == 0 {
            continue;
        }
        // Only what lies about this root is moved.
        let near = |f: f64| (f - hz).abs() < 3.0 * half + 3.0 * step;
        let source = out.clone();
        for (index, f) in points.iter().enumerate() {
            if let Some(slot) = out.get_mut(index)
                && near(*f)
            {
                let from = index.saturating_sub(reach);
                let part = source.get(from..(index + reach + 1).min(source.len()));
                let part = part.unwrap_or_default();
                *slot = part.iter().sum::<f64>() / part.len().max(1) as f64;
            }
        }
    }
    out
}
