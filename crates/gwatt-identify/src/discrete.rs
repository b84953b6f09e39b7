//! From a discrete model to the continuous one with the same samples.
//!
//! With the input held between samples, `Rᵢ/(s − λᵢ)` becomes
//! `(Rᵢ/λᵢ)·(pᵢ − 1)/(z − pᵢ)`, `pᵢ = e^(λᵢ·T)`. So the residues of the
//! discrete model give those of the continuous one, exactly; its zeros follow
//! from the sum of the fractions. Taking logarithms of discrete zeros instead
//! is wrong: a damping of 2 % comes out 69 % off at 1 kHz.

use nalgebra::Complex;

use super::polynomial::{self, roots};
use super::transfer::{TransferFunction, factors};

type C = Complex<f64>;

/// `G(z) = gain · Π(z − zeros) / Π(z − poles)`; complex roots come with their
/// conjugates.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrete {
    /// Factor in front.
    pub gain: f64,
    /// Roots of the numerator, at most as many as poles.
    pub zeros: Vec<C>,
    /// Roots of the denominator.
    pub poles: Vec<C>,
}

/// Why a discrete model has no continuous twin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoTwin {
    /// A pole at zero or on the negative real axis.
    NegativePole,
    /// Two poles at one place, or figures that are not finite.
    Degenerate,
}

impl Discrete {
    /// Of polynomials in z, ascending. `None` if their roots cannot be found,
    /// or there are more zeros than poles.
    #[must_use]
    pub fn from_polynomials(numerator: &[f64], denominator: &[f64]) -> Option<Self> {
        let (zeros, poles) = (roots(numerator)?, roots(denominator)?);
        let leading = |p: &[f64]| p.iter().rev().find(|c| **c != 0.0).copied();
        let gain = leading(numerator)? / leading(denominator)?;
        (zeros.len() <= poles.len() && gain.is_finite()).then_some(Self { gain, zeros, poles })
    }

    /// The samples of a continuous system whose input is held, its delay left
    /// out. `None` if it has more zeros than poles or is not finite.
    #[must_use]
    pub fn held(transfer: &TransferFunction, period_s: f64) -> Option<Self> {
        let sampled = SampledResponse::new(transfer, period_s)?;
        let gain = sampled.numerator.iter().rev().find(|c| **c != 0.0)?;
        Some(Self {
            gain: *gain,
            zeros: roots(&sampled.numerator)?,
            poles: sampled.poles,
        })
    }

    /// The value at z.
    #[must_use]
    pub fn at(&self, z: C) -> C {
        let numerator: C = self.zeros.iter().map(|zero| z - zero).product();
        let denominator: C = self.poles.iter().map(|pole| z - pole).product();
        numerator / denominator * self.gain
    }

    /// The continuous system that has the same samples when its input is held.
    /// Zeros beyond `far_rad_s` are left out, their gain kept: they are what
    /// rounding and noise make of none.
    ///
    /// # Errors
    ///
    /// A pole that no continuous system has.
    pub fn to_continuous(&self, period_s: f64, far_rad_s: f64) -> Result<TransferFunction, NoTwin> {
        if self
            .poles
            .iter()
            .any(|p| p.norm() < 1e-12 || (p.re <= 0.0 && p.im.abs() < 1e-9))
        {
            return Err(NoTwin::NegativePole);
        }
        // In units of the period: λ·T.
        let lambdas: Vec<C> = self.poles.iter().map(|p| logarithm(*p)).collect();
        let direct = if self.zeros.len() == self.poles.len() {
            self.gain
        } else {
            0.0
        };
        let mut numerator = vec![C::new(0.0, 0.0); self.poles.len() + 1];
        add(&mut numerator, &monic(&lambdas), C::new(direct, 0.0));
        for (i, (pole, lambda)) in self.poles.iter().zip(&lambdas).enumerate() {
            let others = |list: &[C]| -> Vec<C> {
                let without = list.iter().enumerate().filter(|(j, _)| *j != i);
                without.map(|(_, x)| *x).collect()
            };
            let above: C = self.zeros.iter().map(|zero| pole - zero).product();
            let below: C = others(&self.poles)
                .iter()
                .map(|other| pole - other)
                .product();
            let residue = above / below * self.gain;
            let growth = if lambda.norm() < 1e-9 {
                C::new(1.0, 0.0)
            } else {
                *lambda / (pole - 1.0)
            };
            add(&mut numerator, &monic(&others(&lambdas)), residue * growth);
        }
        let numerator: Vec<f64> = numerator.iter().map(|c| c.re).collect();
        let mut zeros = roots(&numerator).ok_or(NoTwin::Degenerate)?;
        zeros.retain(|zero| zero.norm() <= far_rad_s * period_s);
        let scale = |list: &[C]| -> Vec<C> { list.iter().map(|x| x / period_s).collect() };
        let gain = self.at(C::new(1.0, 0.0)).re;
        if !gain.is_finite() {
            return Err(NoTwin::Degenerate);
        }
        Ok(TransferFunction {
            gain,
            zeros: factors(&scale(&zeros), false),
            poles: factors(&scale(&lambdas), true),
            delay_s: 0.0,
        })
    }

    /// The same with poles put where a stable continuous system can have them:
    /// mirrored at the unit circle, those on the negative axis turned to the
    /// positive one. A start for a search, not a result.
    #[must_use]
    pub fn tamed(mut self) -> Self {
        for pole in &mut self.poles {
            if pole.im.abs() < 1e-9 {
                pole.re = pole.re.abs().max(1e-3);
                pole.im = 0.0;
            }
            let size = pole.norm();
            if size > 1.0 {
                *pole /= size * size;
            }
            // On the circle itself a mode would ring for ever.
            if pole.norm() > 0.99999 {
                *pole *= 0.99999 / pole.norm();
            }
        }
        self
    }
}

/// The principal logarithm.
pub(super) fn logarithm(z: C) -> C {
    C::new(libm::log(z.norm()), libm::atan2(z.im, z.re))
}

/// Π(x − root), ascending.
fn monic(roots: &[C]) -> Vec<C> {
    let mut p = vec![C::new(1.0, 0.0)];
    for root in roots {
        let mut next = vec![C::new(0.0, 0.0); p.len() + 1];
        for (i, c) in p.iter().enumerate() {
            if let Some(slot) = next.get_mut(i + 1) {
                *slot += c;
            }
            if let Some(slot) = next.get_mut(i) {
                *slot -= c * root;
            }
        }
        p = next;
    }
    p
}

fn add(sum: &mut [C], p: &[C], factor: C) {
    for (slot, c) in sum.iter_mut().zip(p) {
        *slot += c * factor;
    }
}

/// Values that are worked on at a time.
pub const LANES: usize = 8;
/// So many of them.
pub type Lanes = [f64; LANES];

/// The response at sampling instants to a held input, ready for many
/// frequencies.
#[derive(Debug, Clone)]
pub struct SampledResponse {
    numerator: Vec<f64>,
    poles: Vec<C>,
}

impl SampledResponse {
    /// Of a continuous system, its delay left out. `None` if it has more zeros
    /// than poles or is not finite.
    #[must_use]
    pub fn new(transfer: &TransferFunction, period_s: f64) -> Option<Self> {
        let poles = transfer.pole_places(period_s);
        let numerator = scaled(&transfer.numerator(), period_s);
        let leading = *scaled(&transfer.denominator(), period_s).last()?;
        let n = poles.len();
        if numerator.len() > n + 1 {
            return None;
        }
        let direct = numerator.get(n).copied().unwrap_or(0.0) / leading;
        let discrete: Vec<C> = poles.iter().map(|p| exponential(*p)).collect();
        let mut sum = vec![C::new(0.0, 0.0); n + 1];
        add(&mut sum, &monic(&discrete), C::new(direct, 0.0));
        for (i, (lambda, pole)) in poles.iter().zip(&discrete).enumerate() {
            let without = |list: &[C]| -> Vec<C> {
                let rest = list.iter().enumerate().filter(|(j, _)| *j != i);
                rest.map(|(_, x)| *x).collect()
            };
            let below: C = without(&poles).iter().map(|other| lambda - other).product();
            let residue = polynomial::value(&numerator, *lambda) / (below * leading);
            let growth = if lambda.norm() < 1e-9 {
                C::new(1.0, 0.0)
            } else {
                (pole - 1.0) / lambda
            };
            add(&mut sum, &monic(&without(&discrete)), residue * growth);
        }
        let numerator: Vec<f64> = sum.iter().map(|c| c.re * transfer.gain).collect();
        numerator.iter().all(|c| c.is_finite()).then_some(Self {
            numerator,
            poles: discrete,
        })
    }

    /// The response at z on the unit circle.
    #[must_use]
    pub fn at(&self, z: C) -> C {
        let below: C = self.poles.iter().map(|pole| z - pole).product();
        polynomial::value(&self.numerator, z) / below
    }

    /// The same at several z at once, real and imaginary parts.
    #[must_use]
    pub fn at_each(&self, z: &[Lanes; 2]) -> [Lanes; 2] {
        let [x, y] = z;
        let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
        for c in self.numerator.iter().rev() {
            for k in 0..LANES {
                (re[k], im[k]) = (re[k] * x[k] - im[k] * y[k] + c, re[k] * y[k] + im[k] * x[k]);
            }
        }
        let (mut p, mut q) = ([1.0; LANES], [0.0; LANES]);
        for pole in &self.poles {
            for k in 0..LANES {
                let (a, b) = (x[k] - pole.re, y[k] - pole.im);
                (p[k], q[k]) = (p[k] * a - q[k] * b, p[k] * b + q[k] * a);
            }
        }
        for k in 0..LANES {
            let norm = p[k] * p[k] + q[k] * q[k];
            (re[k], im[k]) = (
                (re[k] * p[k] + im[k] * q[k]) / norm,
                (im[k] * p[k] - re[k] * q[k]) / norm,
            );
        }
        [re, im]
    }
}

fn exponential(z: C) -> C {
    let (sin, cos) = libm::sincos(z.im);
    C::new(cos, sin) * libm::exp(z.re)
}

/// Coefficients of the polynomial in s·T.
fn scaled(p: &[f64], period_s: f64) -> Vec<f64> {
    let mut unit = 1.0;
    p.iter()
        .map(|c| {
            let c = c * unit;
            unit /= period_s;
            c
        })
        .collect()
}

/// Coefficients of `Π(1 − rootᵢ·z⁻¹)`, ascending in z⁻¹.
#[must_use]
pub fn backward_coefficients(roots: &[C]) -> Vec<f64> {
    let mut p: Vec<f64> = monic(roots).iter().map(|c| c.re).collect();
    p.reverse();
    p
}

#[cfg(test)]
mod tests {
    use super::super::transfer::Factor;
    use super::*;

    /// Several at once are what each is alone.
    #[test]
    fn values_of_many_places_are_those_of_each() {
        let pair = |omega_rad_s| Factor::Pair {
            omega_rad_s,
            damping: 0.05,
        };
        let transfer = TransferFunction {
            gain: 3.0,
            zeros: vec![pair(200.0)],
            poles: vec![pair(300.0), pair(700.0)],
            delay_s: 0.0,
        };
        let sampled = SampledResponse::new(&transfer, 1e-3).unwrap();
        let theta: Lanes = std::array::from_fn(|k| 0.05 + 0.4 * k as f64);
        let [re, im] = sampled.at_each(&[theta.map(libm::cos), theta.map(libm::sin)]);
        for ((theta, re), im) in theta.iter().zip(re).zip(im) {
            let (sin, cos) = libm::sincos(*theta);
            let apart = sampled.at(C::new(cos, sin)) - C::new(re, im);
            assert!(apart.norm() < 1e-12, "{theta}: {apart}");
        }
    }
}
