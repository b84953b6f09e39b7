//! Transfer functions of axes: a gain, zeros, poles, and a delay.
//!
//! `G(s) = gain · e^(−s·delay) · Π zeros / Π poles`; each factor is 1 at
//! s = 0, so that the gain of a torque's acceleration is 1/inertia.

use std::f64::consts::PI;

use nalgebra::Complex;

use super::polynomial::{self, product, roots};

/// One factor of a numerator or denominator; 1 at s = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Factor {
    /// `1 + 2·ζ·s/ω + s²/ω²`: a resonance among poles, an anti-resonance among
    /// zeros; two real roots where ζ ≥ 1.
    Pair {
        /// ω, rad/s; positive.
        omega_rad_s: f64,
        /// ζ; negative where the roots lie right of the imaginary axis.
        damping: f64,
    },
    /// `1 + τ·s`.
    Real {
        /// τ, s; of either sign.
        time_constant_s: f64,
    },
}

impl Factor {
    /// Its coefficients, ascending.
    #[must_use]
    pub fn coefficients(self) -> Vec<f64> {
        match self {
            Self::Pair {
                omega_rad_s: w,
                damping,
            } => vec![1.0, 2.0 * damping / w, 1.0 / (w * w)],
            Self::Real { time_constant_s } => vec![1.0, time_constant_s],
        }
    }

    /// How many roots it has.
    #[must_use]
    pub fn degree(self) -> usize {
        match self {
            Self::Pair { .. } => 2,
            Self::Real { .. } => 1,
        }
    }

    /// Distance of its roots from the origin, rad/s.
    #[must_use]
    pub fn corner_rad_s(self) -> f64 {
        match self {
            Self::Pair { omega_rad_s, .. } => omega_rad_s,
            Self::Real { time_constant_s } => 1.0 / time_constant_s.abs(),
        }
    }

    /// By how much a pole makes slow signals late, s; a zero makes them early.
    #[must_use]
    pub fn lag_s(self) -> f64 {
        match self {
            Self::Pair {
                omega_rad_s,
                damping,
            } => 2.0 * damping / omega_rad_s,
            Self::Real { time_constant_s } => time_constant_s,
        }
    }

    /// True for complex roots.
    #[must_use]
    pub fn oscillates(self) -> bool {
        matches!(self, Self::Pair { damping, .. } if damping.abs() < 1.0)
    }

    /// Its roots one by one, where they are real; else it is as it was.
    pub fn apart(self) -> impl Iterator<Item = Self> {
        let (first, second) = match self {
            Self::Pair {
                omega_rad_s,
                damping,
            } if damping.abs() > 1.0 => {
                let root = damping.abs() + (damping * damping - 1.0).sqrt();
                let real = |root_rad_s: f64| Self::Real {
                    time_constant_s: libm::copysign(1.0 / root_rad_s, damping),
                };
                (real(omega_rad_s / root), Some(real(omega_rad_s * root)))
            }
            other => (other, None),
        };
        std::iter::once(first).chain(second)
    }

    /// True for complex roots next to others that leave next to nothing of them: half
    /// a decibel, where they ring.
    #[must_use]
    pub fn is_undone_by(self, other: Self) -> bool {
        const LEFT: f64 = 0.05;
        match (self, other) {
            (
                Self::Pair {
                    omega_rad_s,
                    damping,
                },
                Self::Pair {
                    omega_rad_s: against,
                    damping: by,
                },
            ) => {
                let apart = libm::hypot(libm::log(omega_rad_s / against), damping - by);
                apart < LEFT * by.abs().min(1.0)
            }
            _ => false,
        }
    }
}

/// A rational transfer function with a delay.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferFunction {
    /// Gain at s = 0, in the units of output by input.
    pub gain: f64,
    /// Factors of the numerator.
    pub zeros: Vec<Factor>,
    /// Factors of the denominator.
    pub poles: Vec<Factor>,
    /// Delay in seconds, not negative.
    pub delay_s: f64,
}

impl TransferFunction {
    /// A gain without zeros, poles or delay: a rigid axis.
    #[must_use]
    pub fn constant(gain: f64) -> Self {
        Self {
            gain,
            zeros: Vec::new(),
            poles: Vec::new(),
            delay_s: 0.0,
        }
    }

    /// Coefficients of the numerator without the gain, ascending.
    #[must_use]
    pub fn numerator(&self) -> Vec<f64> {
        multiply(vec![1.0], &self.zeros)
    }

    /// Coefficients of the denominator, ascending; 1 at s = 0.
    #[must_use]
    pub fn denominator(&self) -> Vec<f64> {
        multiply(vec![1.0], &self.poles)
    }

    /// The same with its real roots one by one.
    #[must_use]
    pub fn apart(&self) -> Self {
        let each = |list: &[Factor]| list.iter().flat_map(|factor| factor.apart()).collect();
        Self {
            zeros: each(&self.zeros),
            poles: each(&self.poles),
            ..self.clone()
        }
    }

    /// By how much it makes slow signals late, s: what a recording shows of it,
    /// whatever fast poles, zeros and delay make of that.
    #[must_use]
    pub fn lag_s(&self) -> f64 {
        let sum = |list: &[Factor]| -> f64 { list.iter().map(|factor| factor.lag_s()).sum() };
        self.delay_s + sum(&self.poles) - sum(&self.zeros)
    }

    /// How many zeros lie right of the imaginary axis.
    #[must_use]
    pub fn zeros_on_the_right(&self) -> usize {
        let right = self.zeros.iter().filter(|zero| zero.lag_s() < 0.0);
        right.map(|zero| zero.degree()).sum()
    }

    /// The poles times `period_s`; two at one place are put a little apart, as
    /// partial fractions need it.
    pub(super) fn pole_places(&self, period_s: f64) -> Vec<Complex<f64>> {
        let mut places: Vec<Complex<f64>> = Vec::new();
        for pole in &self.poles {
            match *pole {
                Factor::Pair {
                    omega_rad_s,
                    damping,
                } => {
                    let w = omega_rad_s * period_s;
                    let spread = Complex::new(damping * damping - 1.0, 0.0).sqrt() * w;
                    let centre = Complex::new(-damping * w, 0.0);
                    places.extend([centre + spread, centre - spread]);
                }
                Factor::Real { time_constant_s } => {
                    places.push(Complex::new(-period_s / time_constant_s, 0.0));
                }
            }
        }
        for index in 1..places.len() {
            let (before, rest) = places.split_at_mut(index);
            if let Some(place) = rest.first_mut() {
                while before
                    .iter()
                    .any(|other| (*other - *place).norm() < 1e-7 * place.norm())
                {
                    *place *= 1.0 + 1e-6;
                }
            }
        }
        places
    }

    /// Number of poles.
    #[must_use]
    pub fn order(&self) -> usize {
        degree(&self.poles)
    }

    /// Number of zeros.
    #[must_use]
    pub fn zero_count(&self) -> usize {
        degree(&self.zeros)
    }

    /// True when all poles lie left of the imaginary axis.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.poles.iter().all(|pole| match *pole {
            Factor::Pair { damping, .. } => damping > 0.0,
            Factor::Real { time_constant_s } => time_constant_s >= 0.0,
        })
    }

    /// The response to a sine of `frequency_hz`, output by input.
    #[must_use]
    pub fn at_hz(&self, frequency_hz: f64) -> Complex<f64> {
        let omega = 2.0 * PI * frequency_hz;
        let s = Complex::new(0.0, omega);
        let (sin, cos) = libm::sincos(omega * self.delay_s);
        let rational =
            polynomial::value(&self.numerator(), s) / polynomial::value(&self.denominator(), s);
        rational * self.gain * Complex::new(cos, -sin)
    }

    /// The anti-resonances: complex zeros as (rad/s, damping).
    pub fn anti_resonances(&self) -> impl Iterator<Item = (f64, f64)> {
        self.zeros.iter().filter_map(|zero| match *zero {
            Factor::Pair {
                omega_rad_s,
                damping,
            } if zero.oscillates() => Some((omega_rad_s, damping)),
            _ => None,
        })
    }
}

fn multiply(start: Vec<f64>, factors: &[Factor]) -> Vec<f64> {
    factors
        .iter()
        .fold(start, |p, factor| product(&p, &factor.coefficients()))
}

fn degree(factors: &[Factor]) -> usize {
    factors.iter().map(|factor| factor.degree()).sum()
}

/// Factors whose roots are these, nearest to the origin first; roots come as
/// conjugates, and real ones of one sign are joined in pairs where `join`. A
/// root at the origin makes no factor.
#[must_use]
pub fn factors(roots: &[Complex<f64>], join: bool) -> Vec<Factor> {
    const REAL: f64 = 1e-9;
    let mut factors = Vec::new();
    let mut real: Vec<f64> = Vec::new();
    for root in roots {
        let size = root.norm();
        if !(size > 0.0 && size.is_finite()) {
            continue;
        }
        if root.im.abs() <= REAL * size {
            real.push(root.re);
        } else if root.im > 0.0 {
            factors.push(Factor::Pair {
                omega_rad_s: size,
                damping: -root.re / size,
            });
        }
    }
    real.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    while let Some(root) = (!real.is_empty()).then(|| real.remove(0)) {
        let partner = real.iter().position(|other| other * root > 0.0);
        match partner.filter(|_| join).map(|at| real.remove(at)) {
            Some(other) => {
                let omega = (root * other).sqrt();
                factors.push(Factor::Pair {
                    omega_rad_s: omega,
                    damping: -(root + other) / (2.0 * omega),
                });
            }
            None => factors.push(Factor::Real {
                time_constant_s: -1.0 / root,
            }),
        }
    }
    factors.sort_by(|a, b| a.corner_rad_s().total_cmp(&b.corner_rad_s()));
    factors
}

/// The factors of a polynomial with real coefficients, ascending.
#[must_use]
pub fn factors_of(p: &[f64], join: bool) -> Option<Vec<Factor>> {
    Some(factors(&roots(p)?, join))
}

#[cfg(test)]
mod tests {
    use super::Factor;

    fn pair(omega_rad_s: f64, damping: f64) -> Factor {
        Factor::Pair {
            omega_rad_s,
            damping,
        }
    }

    /// A pole next to a zero leaves nothing of it only where both ring alike.
    #[test]
    fn what_is_undone() {
        let zero = pair(250.0, 0.03);
        assert!(zero.is_undone_by(zero));
        assert!(zero.is_undone_by(pair(250.3, 0.03)));
        assert!(!zero.is_undone_by(pair(250.5, 0.03)));
        assert!(!zero.is_undone_by(pair(250.0, 0.032)));
        assert!(pair(250.0, 0.3).is_undone_by(pair(252.0, 0.305)));
        assert!(!zero.is_undone_by(Factor::Real {
            time_constant_s: 0.004,
        }));
    }
}
