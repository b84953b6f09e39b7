//! A transfer function as a sum of sections next to one another, one for each
//! factor of its poles, sampled exactly.
//!
//! `G(s) = d + Σ (a + b·s/ω)/(1 + 2ζ·s/ω + s²/ω²)`: each section runs by itself,
//! and what a parameter does to the output is a sum of few signals. What is
//! measured of the output goes to the input: the differences of a speed are the
//! response to an input that runs straight from sample to sample, those of a
//! position to one that runs along parabolas (B-splines).

use nalgebra::{SMatrix, SVector};

use super::state_space::Measured;
use super::transfer::{Factor, TransferFunction};

/// Samples of the input that act at a time.
pub const TAPS: usize = 4;

/// Weights beyond this share of the gain stand for two sections with a pole in
/// common: their difference has no digits left.
const WEIGHT_MAX: f64 = 1e6;

/// One section: the states are its low-pass and the derivative of that by ω.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Section {
    /// `Φ`, by rows; of a real pole only the first element.
    pub phi: [f64; 4],
    /// What each sample of the input adds to the states.
    pub gamma: [[f64; 2]; TAPS],
    /// Poles.
    pub degree: usize,
}

impl Section {
    /// How fast the coefficients change from another section to this one, which
    /// is `probe` away.
    #[must_use]
    pub fn slope_from(&self, other: &Self, probe: f64) -> Self {
        let mut out = *self;
        for (slot, before) in out.phi.iter_mut().zip(&other.phi) {
            *slot = (*slot - before) / probe;
        }
        for (slot, before) in out.gamma.iter_mut().zip(&other.gamma) {
            for (slot, before) in slot.iter_mut().zip(before) {
                *slot = (*slot - before) / probe;
            }
        }
        out
    }
}

/// A sampled sum of sections.
#[derive(Debug, Clone, PartialEq)]
pub struct Parallel {
    /// The sections, one for each factor of the poles.
    pub sections: Vec<Section>,
    /// How the states of each section count in the output.
    pub weights: Vec<[f64; 2]>,
    /// How the samples of the input count in the output at once.
    pub direct: [f64; TAPS],
    /// Whole periods of delay.
    pub lag: usize,
}

impl Parallel {
    /// Samples a transfer function. `None` if it has more zeros than poles, two
    /// sections share a pole, or it is not finite.
    #[must_use]
    pub fn new(transfer: &TransferFunction, measured: Measured, period_s: f64) -> Option<Self> {
        Self::sampled(transfer, measured, period_s, |_, _| None)
    }

    /// Samples a transfer function that differs little from one that was sampled:
    /// sections that are the same are taken over.
    #[must_use]
    pub fn near(
        other: &Self,
        from: &TransferFunction,
        transfer: &TransferFunction,
        measured: Measured,
        period_s: f64,
    ) -> Option<Self> {
        let same_delay = from.delay_s == transfer.delay_s;
        Self::sampled(transfer, measured, period_s, |index, pole| {
            let is_same = same_delay && from.poles.get(index) == Some(&pole);
            other.sections.get(index).copied().filter(|_| is_same)
        })
    }

    fn sampled(
        transfer: &TransferFunction,
        measured: Measured,
        period_s: f64,
        known: impl Fn(usize, Factor) -> Option<Section>,
    ) -> Option<Self> {
        let periods = (transfer.delay_s / period_s).max(0.0);
        // Closer than this to a sampling instant counts as on it.
        let whole = libm::floor(periods + 1e-9);
        let late = (periods - whole).max(0.0);
        let late = if late > 1e-9 { late } else { 0.0 };
        let hold = Hold::new(measured, late);
        let (weights, direct) = fractions(transfer)?;
        let poles = transfer.poles.iter().enumerate();
        let sections: Option<Vec<Section>> = poles
            .map(|(index, pole)| known(index, *pole).or_else(|| hold.section(*pole, period_s)))
            .collect();
        Some(Self {
            sections: sections?,
            weights,
            direct: hold.at_sample().map(|share| share * direct),
            lag: whole as usize,
        })
    }

    /// Number of poles.
    #[must_use]
    pub fn order(&self) -> usize {
        self.sections.iter().map(|section| section.degree).sum()
    }
}

/// An element of the polynomials modulo a pole's: `p + q·x`, where
/// `x² = −1 − 2ζ·x`; of a real pole only p, the value at the pole.
#[derive(Debug, Clone, Copy)]
struct Element {
    p: f64,
    q: f64,
}

/// The pole that polynomials are taken modulo of.
#[derive(Debug, Clone, Copy)]
enum Modulus {
    Pair { omega_rad_s: f64, damping: f64 },
    Real { pole_rad_s: f64 },
}

impl Modulus {
    fn new(factor: Factor) -> Self {
        match factor {
            Factor::Pair {
                omega_rad_s,
                damping,
            } => Self::Pair {
                omega_rad_s,
                damping,
            },
            Factor::Real { time_constant_s } => Self::Real {
                pole_rad_s: -1.0 / time_constant_s,
            },
        }
    }

    /// A factor of another zero or pole.
    fn of(self, factor: Factor) -> Element {
        // Coefficients of s and s².
        let (first, second) = match factor {
            Factor::Pair {
                omega_rad_s: w,
                damping,
            } => (2.0 * damping / w, 1.0 / (w * w)),
            Factor::Real { time_constant_s } => (time_constant_s, 0.0),
        };
        match self {
            Self::Pair {
                omega_rad_s: w,
                damping,
            } => {
                let (first, second) = (first * w, second * w * w);
                Element {
                    p: 1.0 - second,
                    q: first - 2.0 * damping * second,
                }
            }
            Self::Real { pole_rad_s: s } => Element {
                p: 1.0 + s * (first + s * second),
                q: 0.0,
            },
        }
    }

    fn product(self, a: Element, b: Element) -> Element {
        let damping = match self {
            Self::Pair { damping, .. } => damping,
            Self::Real { .. } => 0.0,
        };
        let square = a.q * b.q;
        Element {
            p: a.p * b.p - square,
            q: a.p * b.q + a.q * b.p - 2.0 * damping * square,
        }
    }

    /// `a / b`; not finite where both have a root in common.
    fn quotient(self, a: Element, b: Element) -> Element {
        let damping = match self {
            Self::Pair { damping, .. } => damping,
            Self::Real { .. } => 0.0,
        };
        // b times its conjugate p − 2ζ·q − q·x is a number.
        let norm = b.p * b.p - 2.0 * damping * b.p * b.q + b.q * b.q;
        let conjugate = Element {
            p: (b.p - 2.0 * damping * b.q) / norm,
            q: -b.q / norm,
        };
        self.product(a, conjugate)
    }
}

/// The weights of the sections' states, and the direct path.
fn fractions(transfer: &TransferFunction) -> Option<(Vec<[f64; 2]>, f64)> {
    if transfer.zero_count() > transfer.order() {
        return None;
    }
    let leading = |factors: &[Factor]| -> f64 {
        let each = factors.iter().map(|factor| match *factor {
            Factor::Pair { omega_rad_s: w, .. } => 1.0 / (w * w),
            Factor::Real { time_constant_s } => time_constant_s,
        });
        each.product()
    };
    let direct = if transfer.zero_count() == transfer.order() {
        transfer.gain * leading(&transfer.zeros) / leading(&transfer.poles)
    } else {
        0.0
    };
    let most = WEIGHT_MAX * transfer.gain.abs().max(direct.abs());
    let mut weights = Vec::with_capacity(transfer.poles.len());
    for (at, pole) in transfer.poles.iter().enumerate() {
        let modulus = Modulus::new(*pole);
        let mut weight = Element {
            p: transfer.gain,
            q: 0.0,
        };
        for zero in &transfer.zeros {
            weight = modulus.product(weight, modulus.of(*zero));
        }
        for (other, factor) in transfer.poles.iter().enumerate() {
            if other != at {
                weight = modulus.quotient(weight, modulus.of(*factor));
            }
        }
        let size = weight.p.abs().max(weight.q.abs());
        if size.is_nan() || size > most {
            return None;
        }
        weights.push([weight.p, weight.q]);
    }
    direct.is_finite().then_some((weights, direct))
}

/// How the input runs between samples: a polynomial of the share σ of a period
/// since the last knot, in terms of the samples up to it.
pub struct Hold {
    measured: Measured,
    /// Share of a period by which knots come after the sampling instants.
    late: f64,
}

impl Hold {
    /// For a hold whose knots come `late` of a period after the samples.
    #[must_use]
    pub fn new(measured: Measured, late: f64) -> Self {
        Self { measured, late }
    }

    /// Value and two derivatives at σ, for the sample of the last knot and the
    /// ones before it.
    fn run(&self, sigma: f64) -> [[f64; 3]; 3] {
        let s = sigma;
        match self.measured {
            Measured::Direct => [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]],
            Measured::Velocity => [[s, 1.0, 0.0], [1.0 - s, -1.0, 0.0], [0.0; 3]],
            Measured::Position => [
                [0.5 * s * s, s, 1.0],
                [0.5 + s - s * s, 1.0 - 2.0 * s, -2.0],
                [0.5 * (1.0 - s) * (1.0 - s), s - 1.0, 1.0],
            ],
        }
    }

    /// The input at a sampling instant.
    #[must_use]
    pub fn at_sample(&self) -> [f64; TAPS] {
        let mut out = [0.0; TAPS];
        let (sigma, first) = if self.late > 0.0 {
            (1.0 - self.late, 1)
        } else {
            (0.0, 0)
        };
        for (slot, run) in out.iter_mut().skip(first).zip(self.run(sigma)) {
            let [value, ..] = run;
            *slot = value;
        }
        out
    }

    /// Samples the section of a pole.
    #[must_use]
    pub fn section(&self, pole: Factor, period_s: f64) -> Option<Section> {
        let (rest, second) = step(pole, period_s, 1.0 - self.late)?;
        let mut section = Section {
            phi: rest,
            degree: pole.degree(),
            ..Section::default()
        };
        // After the knot, from its start.
        for (slot, run) in section.gamma.iter_mut().zip(self.run(0.0)) {
            *slot = respond(&second, run);
        }
        if self.late > 0.0 {
            let (before, first) = step(pole, period_s, self.late)?;
            section.phi = matrix_product(rest, before);
            let runs = self.run(1.0 - self.late);
            for (slot, run) in section.gamma.iter_mut().skip(1).zip(runs) {
                let [x, y] = respond(&first, run);
                let [a, b, c, d] = rest;
                let [p, q] = *slot;
                *slot = [p + a * x + b * y, q + c * x + d * y];
            }
        }
        Some(section)
    }
}

/// What a run of the input adds to the states.
fn respond(responses: &[[f64; 2]; 3], run: [f64; 3]) -> [f64; 2] {
    let mut out = [0.0; 2];
    for (response, part) in responses.iter().zip(run) {
        for (slot, x) in out.iter_mut().zip(response) {
            *slot += x * part;
        }
    }
    out
}

fn matrix_product(x: [f64; 4], y: [f64; 4]) -> [f64; 4] {
    let [a, b, c, d] = x;
    let [e, f, g, h] = y;
    [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h]
}

/// `Φ` over a share of a period, and the responses to 1, τ and τ²/2, where τ
/// counts in periods.
fn step(pole: Factor, period_s: f64, share: f64) -> Option<([f64; 4], [[f64; 2]; 3])> {
    let mut joined = SMatrix::<f64, 5, 5>::zeros();
    match pole {
        Factor::Pair {
            omega_rad_s,
            damping,
        } => {
            let w = omega_rad_s * period_s;
            joined[(0, 1)] = w;
            joined[(1, 0)] = -w;
            joined[(1, 1)] = -2.0 * damping * w;
            joined[(1, 2)] = w;
        }
        Factor::Real { time_constant_s } => {
            let rate = period_s / time_constant_s;
            joined[(0, 0)] = -rate;
            joined[(0, 2)] = rate;
        }
    }
    joined[(2, 3)] = 1.0;
    joined[(3, 4)] = 1.0;
    let e = exponential(joined * share)?;
    let column = |at: usize| [e[(0, at)], e[(1, at)]];
    let phi = match pole {
        Factor::Pair { .. } => [e[(0, 0)], e[(0, 1)], e[(1, 0)], e[(1, 1)]],
        Factor::Real { .. } => [e[(0, 0)], 0.0, 0.0, 0.0],
    };
    Some((phi, [column(2), column(3), column(4)]))
}

/// The exponential of a small matrix: Taylor's series of the matrix halved until
/// it is small, squared as often.
fn exponential(m: SMatrix<f64, 5, 5>) -> Option<SMatrix<f64, 5, 5>> {
    const TERMS: i32 = 12;
    let ones = SVector::<f64, 5>::repeat(1.0);
    let mut size = (m.abs() * ones).max();
    if !size.is_finite() {
        return None;
    }
    let mut halvings = 0;
    let mut small = m;
    while size > 0.25 && halvings < 60 {
        size *= 0.5;
        small *= 0.5;
        halvings += 1;
    }
    let mut sum = SMatrix::identity();
    for k in (1..=TERMS).rev() {
        sum = SMatrix::identity() + small * sum / f64::from(k);
    }
    for _ in 0..halvings {
        sum *= sum;
    }
    sum.iter().all(|x| x.is_finite()).then_some(sum)
}
