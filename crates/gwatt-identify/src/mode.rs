//! Where a model misses a resonance: one mode is added to it, placed where the
//! measured frequency response departs most from the model's.
//!
//! A lightly damped structure is a sum of modes, so the mode is added, not
//! multiplied: `G + (a + b·s)/(1 + 2ζ·s/ω + s²/ω²)`. For each ω and ζ of a grid
//! a and b follow by least squares.

use std::f64::consts::PI;

use nalgebra::Complex;

use super::places::thinned;
use super::polynomial::{product, roots};
use super::spectrum::FrequencyResponse;
use super::transfer::{Factor, TransferFunction, factors};

type C = Complex<f64>;

/// Dampings that are tried: of modes that ring, and of those that do not.
const RINGING: &[f64] = &[0.01, 0.04, 0.15];
const DAMPED: &[f64] = &[0.6];
/// Frequencies on which a place for a mode is looked for, about.
const SPARSE: usize = 1_500;
/// Up to this share of the sampling frequency.
const BAND: f64 = 0.45;

/// The model with one mode more, the best of the grid: one that rings, and one
/// that does not. None when the response says nothing.
#[must_use]
pub fn with_mode(
    transfer: &TransferFunction,
    response: &FrequencyResponse,
    period_s: f64,
) -> Vec<TransferFunction> {
    [RINGING, DAMPED]
        .into_iter()
        .filter_map(|dampings| best_of(dampings, transfer, response, period_s))
        .collect()
}

fn best_of(
    dampings: &[f64],
    transfer: &TransferFunction,
    response: &FrequencyResponse,
    period_s: f64,
) -> Option<TransferFunction> {
    let mut sorted = response.variance.clone();
    sorted.sort_by(f64::total_cmp);
    let strongest = response.response.iter().map(C::norm_sqr);
    let rounding = 1e-16 * strongest.fold(f64::MIN_POSITIVE, f64::max);
    let floor = (0.01 * sorted.get(sorted.len() / 2)?).max(rounding);
    let mut points = Points::default();
    let in_band = response
        .frequency_hz
        .partition_point(|f| f * period_s < BAND);
    for at in thinned(in_band, SPARSE) {
        let f = response.frequency_hz.get(at)?;
        let (g, variance) = (response.response.get(at)?, response.variance.get(at)?);
        let theta = 2.0 * PI * f * period_s;
        // The hold delays by half a period and the delay by the rest.
        let phase = theta * (transfer.delay_s / period_s + 0.5);
        let (sin, cos) = libm::sincos(phase);
        let bare = *g * C::new(cos, sin);
        let (ms, mc) = libm::sincos(theta * transfer.delay_s / period_s);
        let model = transfer.at_hz(*f) * C::new(mc, ms);
        points.push(theta, bare - model, 1.0 / variance.max(floor));
    }
    let (first, last) = (*points.theta.first()?, *points.theta.last()?);
    let mut best: Option<(f64, Factor, f64, f64)> = None;
    let mut omega = first;
    let mut share = Vec::new();
    while omega < last {
        share.clear();
        share.extend(points.theta.iter().map(|theta| theta / omega));
        for &damping in dampings {
            let pole = Factor::Pair {
                omega_rad_s: omega,
                damping,
            };
            if let Some((gain, a, b)) = points.amplitude(&share, damping)
                && best.as_ref().is_none_or(|(most, ..)| gain > *most)
            {
                best = Some((gain, pole, a, b));
            }
        }
        omega *= 1.02;
    }
    let (_, pole, a, b) = best?;
    join(transfer, pole, [a, b], period_s)
}

/// Points that are worked on at a time.
const LANES: usize = 8;
type Lanes = [f64; LANES];

/// What a model leaves of the response, by frequency.
#[derive(Default)]
struct Points {
    /// rad per period.
    theta: Vec<f64>,
    re: Vec<f64>,
    im: Vec<f64>,
    weight: Vec<f64>,
}

impl Points {
    fn push(&mut self, theta: f64, gap: C, weight: f64) {
        if gap.re.is_finite() && weight.is_finite() {
            self.theta.push(theta);
            self.re.push(gap.re);
            self.im.push(gap.im);
            self.weight.push(weight);
        }
    }

    /// How much of the gap such a mode explains, and its a and b; the frequencies in
    /// shares of its ω.
    fn amplitude(&self, shares: &[f64], damping: f64) -> Option<(f64, f64, f64)> {
        // The squares and the product of both parts, and what they have in common
        // with the gap.
        let mut sums = [0.0; 5];
        let lanes = |x: &[f64], from: usize| {
            let mut out = [0.0; LANES];
            for (slot, x) in out.iter_mut().zip(x.get(from..).unwrap_or_default()) {
                *slot = *x;
            }
            out
        };
        for from in (0..self.theta.len()).step_by(LANES) {
            let gap = [&self.re, &self.im].map(|x| lanes(x, from));
            let parts = parts(lanes(shares, from), gap, lanes(&self.weight, from), damping);
            for (sum, parts) in sums.iter_mut().zip(&parts) {
                // One by one, as they come: what no point stands for counts nothing.
                for part in parts {
                    *sum += part;
                }
            }
        }
        let [aa, bb, ab, ra, rb] = sums;
        let determinant = aa * bb - ab * ab;
        if determinant.is_nan() || determinant <= 1e-12 * aa * bb {
            return None;
        }
        let a = (ra * bb - rb * ab) / determinant;
        let b = (rb * aa - ra * ab) / determinant;
        Some((a * ra + b * rb, a, b))
    }
}

/// What some points add to the sums. With `x = j·y` the parts of a mode are
/// `1/(1 + 2ζ·x + x²)` and x times that.
fn parts(y: Lanes, [re, im]: [Lanes; 2], weight: Lanes, damping: f64) -> [Lanes; 5] {
    let mut out = [[0.0; LANES]; 5];
    let [aa, bb, ab, ra, rb] = &mut out;
    for k in 0..LANES {
        let (c, d) = (1.0 - y[k] * y[k], y[k] * (2.0 * damping));
        let norm = c * c + d * d;
        let (p, q) = (c / norm, -d / norm);
        let (r, s) = (-(y[k] * q), y[k] * p);
        aa[k] = weight[k] * (p * p + q * q);
        bb[k] = weight[k] * (r * r + s * s);
        ab[k] = weight[k] * (p * r + q * s);
        ra[k] = weight[k] * (p * re[k] + q * im[k]);
        rb[k] = weight[k] * (r * re[k] + s * im[k]);
    }
    out
}

/// `G + (a + b·s/ω)/(pole)` as one fraction; the pole in rad per period.
fn join(
    transfer: &TransferFunction,
    pole: Factor,
    [a, b]: [f64; 2],
    period_s: f64,
) -> Option<TransferFunction> {
    let per_period = |p: Vec<f64>| -> Vec<f64> {
        let mut unit = 1.0;
        p.into_iter()
            .map(|c| {
                let c = c * unit;
                unit /= period_s;
                c
            })
            .collect()
    };
    let omega = pole.corner_rad_s();
    let numerator = per_period(transfer.numerator());
    let denominator = per_period(transfer.denominator());
    let mut sum: Vec<f64> = product(&numerator, &pole.coefficients())
        .iter()
        .map(|c| c * transfer.gain)
        .collect();
    let added = product(&denominator, &[a, b / omega]);
    if sum.len() < added.len() {
        sum.resize(added.len(), 0.0);
    }
    for (slot, c) in sum.iter_mut().zip(&added) {
        *slot += c;
    }
    let gain = *sum.first()?;
    let zeros: Vec<C> = roots(&sum)?
        .iter()
        .filter(|root| root.norm() < 1.5 * PI)
        .map(|root| root / period_s)
        .collect();
    let mut poles = transfer.poles.clone();
    poles.push(match pole {
        Factor::Pair { damping, .. } => Factor::Pair {
            omega_rad_s: omega / period_s,
            damping,
        },
        Factor::Real { .. } => pole,
    });
    Some(TransferFunction {
        gain,
        zeros: factors(&zeros, false),
        poles,
        delay_s: transfer.delay_s,
    })
    .filter(|joined| joined.gain.is_finite() && joined.zero_count() <= joined.order())
}
