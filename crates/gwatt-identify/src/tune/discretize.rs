//! From factors in s to second-order sections in z.
//!
//! *Tustin*: `s → (ω/tan(ω·T/2))·(1 − z⁻¹)/(1 + z⁻¹)` for each factor with its
//! own ω, so that what happens at ω happens there.
//!
//! *Zero-order hold*: the filter has, at sampling instants, the output of the
//! continuous one whose input is held.
//!
//! *Matched*: the denominator as by Tustin, in the numerator
//! `(1 + 10·z⁻¹ + z⁻²)/12` for 1, and second differences for s². Near ω·T = 0
//! Tustin's pair of zeros is `N(ω)·(1 − ω²T²/12)` after its own delay of one
//! period, for any N, and so is this 1 (Numerov's weights): axes with and
//! without zeros stay alike to the fourth order. It needs no denominator, so it
//! serves without a low-pass too.

use super::biquad::Biquad;
use super::held::held;
use super::low_pass::LowPass;
use crate::transfer::Factor;

/// How a filter becomes digital.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Discretization {
    /// Zeros by second differences, the low-pass by Tustin.
    Matched,
    /// Tustin's rule, pre-warped at each factor's own frequency.
    Tustin,
    /// Zero-order hold.
    Hold,
}

impl Discretization {
    /// The name in files and options.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Matched => "matched",
            Self::Tustin => "tustin",
            Self::Hold => "zoh",
        }
    }

    /// Of its name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Matched, Self::Tustin, Self::Hold]
            .into_iter()
            .find(|kind| kind.name() == name)
    }
}

/// Coefficients of z⁰, z⁻¹, z⁻².
type Quadratic = [f64; 3];

/// Sections of `Π numerator · F`, which is to be as late as a numerator of
/// `degree`. `None` if there are none.
pub(super) fn discretize(
    numerator: &[Factor],
    degree: usize,
    low_pass: LowPass,
    kind: Discretization,
    period_s: f64,
) -> Option<Vec<Biquad>> {
    if kind == Discretization::Hold {
        return held(numerator, low_pass, period_s);
    }
    let mut poles = low_pass.poles().into_iter();
    let mut zeros = numerator.iter();
    let mut sections = Vec::new();
    // The largest numerator of all axes is of `degree`: those of the others
    // are filled up by what is as late and as flat.
    let mut filled = 0;
    loop {
        let (zero, pole) = (zeros.next(), poles.next());
        if zero.is_none() && pole.is_none() && filled >= degree {
            break;
        }
        let numerator = match (kind, zero) {
            (Discretization::Tustin, Some(zero)) => tustin(*zero, period_s),
            (Discretization::Tustin, None) => one_by_tustin(pole),
            (_, Some(zero)) => differences(*zero, period_s)?,
            (_, None) if filled < degree => [1.0 / 12.0, 10.0 / 12.0, 1.0 / 12.0],
            (_, None) => one_by_tustin(pole),
        };
        filled += 2;
        let denominator = pole.map_or([1.0, 0.0, 0.0], |pole| tustin(pole, period_s));
        sections.push(section(numerator, denominator)?);
    }
    Some(sections)
}

/// The quotient with a gain of 1 at rest.
fn section(numerator: Quadratic, denominator: Quadratic) -> Option<Biquad> {
    let [n0, n1, n2] = numerator;
    let [d0, d1, d2] = denominator;
    let gain = (d0 + d1 + d2) / (n0 + n1 + n2) / d0;
    let b = [n0 * gain, n1 * gain, n2 * gain];
    let a = [d1 / d0, d2 / d0];
    b.iter()
        .chain(&a)
        .all(|c| c.is_finite())
        .then_some(Biquad { b, a })
}

/// A factor by Tustin's rule, times (1 + z⁻¹) for each of its roots.
fn tustin(factor: Factor, period_s: f64) -> Quadratic {
    match factor {
        Factor::Pair {
            omega_rad_s,
            damping,
        } => {
            let per_tan = 1.0 / libm::tan(0.5 * omega_rad_s * period_s);
            let (square, linear) = (per_tan * per_tan, 2.0 * damping * per_tan);
            [
                1.0 + linear + square,
                2.0 * (1.0 - square),
                1.0 - linear + square,
            ]
        }
        Factor::Real { time_constant_s } => {
            let per_tan = 1.0 / libm::tan(0.5 * period_s / time_constant_s);
            [1.0 + per_tan, 1.0 - per_tan, 0.0]
        }
    }
}

/// What Tustin's rule makes of 1 over a pole.
fn one_by_tustin(pole: Option<Factor>) -> Quadratic {
    match pole {
        Some(Factor::Real { .. }) => [1.0, 1.0, 0.0],
        _ => [1.0, 2.0, 1.0],
    }
}

/// A pair of zeros by central differences, late by one period: of the second
/// difference so much that the undamped pair is zero at its own frequency, of
/// the first so much that there the rest is as large as it should be.
fn differences(zero: Factor, period_s: f64) -> Option<Quadratic> {
    let Factor::Pair {
        omega_rad_s,
        damping,
    } = zero
    else {
        return None;
    };
    let (sin, _) = libm::sincos(0.5 * omega_rad_s * period_s);
    let square = sin * sin;
    // −4·sin²(ω·T/2) is the second difference of a sine, 2j·sin(ω·T) twice the
    // first; 1 − sin²(ω·T/2)/3 is the 1 of axes without this zero.
    let second = 0.25 / square;
    let first = damping * (1.0 - square / 3.0) / libm::sin(omega_rad_s * period_s);
    Some([second + first, 1.0 - 2.0 * second, second - first])
}
