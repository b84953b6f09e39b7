//! How far the axes' responses lie apart, before and after the filters.

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;

use super::axis::{AxisResponse, Zero};
use super::correction::Correction;

type C = Complex<f64>;

/// Frequencies that are looked at.
const POINTS: u32 = 500;

/// The largest difference of two responses over a band.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Mismatch {
    /// Of the gains, dB.
    pub gain_db: f64,
    /// Of the phases, degrees.
    pub phase_deg: f64,
}

/// Two axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Their letters.
    pub letters: [char; 2],
    /// Without filters.
    pub before: Mismatch,
    /// With filters.
    pub after: Mismatch,
    /// Two standard errors of that, as far as it comes from the zeros; not
    /// finite where they have none.
    pub error: Mismatch,
}

impl Mismatch {
    fn include(&mut self, ratio: C) {
        let gain_db = 20.0 * libm::log10(ratio.norm());
        let phase_deg = libm::atan2(ratio.im, ratio.re) * 180.0 / PI;
        self.raise(gain_db.abs(), phase_deg.abs());
    }

    fn raise(&mut self, gain_db: f64, phase_deg: f64) {
        // A figure that is not known stays so.
        let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
        self.gain_db = larger(self.gain_db, gain_db);
        self.phase_deg = larger(self.phase_deg, phase_deg);
    }
}

/// All pairs of axes over DC to `band_hz`, by their models.
#[must_use]
pub fn mismatch(axes: &[AxisResponse], correction: &Correction, band_hz: f64) -> Vec<Pair> {
    let models: Vec<_> = axes.iter().map(AxisResponse::follows).collect();
    let mut pairs = Vec::new();
    for (i, first) in axes.iter().enumerate() {
        for (j, second) in axes.iter().enumerate().skip(i + 1) {
            let (Some(a), Some(b)) = (models.get(i), models.get(j)) else {
                continue;
            };
            let mut pair = Pair {
                letters: [first.letter, second.letter],
                before: Mismatch::default(),
                after: Mismatch::default(),
                error: Mismatch::default(),
            };
            for k in 1..=POINTS {
                let hz = band_hz * f64::from(k) / f64::from(POINTS);
                let ratio = a.at_hz(hz) / b.at_hz(hz);
                pair.before.include(ratio);
                let filters = correction.at_hz(i, hz) / correction.at_hz(j, hz);
                pair.after.include(ratio * filters);
                let zeros = first.zeros.iter().chain(&second.zeros);
                let (gain, phase) = zeros.fold((0.0, 0.0), |(gain, phase), zero| {
                    let [g, p] = deviation(zero, hz);
                    (gain + g * g, phase + p * p)
                });
                let db = 20.0 / std::f64::consts::LN_10;
                pair.error
                    .raise(2.0 * db * gain.sqrt(), 2.0 * phase.sqrt() * 180.0 / PI);
            }
            pairs.push(pair);
        }
    }
    pairs
}

/// Standard deviations of ln|N| and arg N of a zero. Its ω and ζ are taken as
/// independent, which for lightly damped ones they nearly are.
fn deviation(zero: &Zero, hz: f64) -> [f64; 2] {
    let (w, zeta) = (zero.omega_rad_s.value, zero.damping.value);
    let s = C::new(0.0, TAU * hz / w);
    let value = s * s + s * (2.0 * zeta) + 1.0;
    // ∂N/∂ω·ω = −(2ζ·s + 2·s²), ∂N/∂ζ = 2·s, with s in units of ω.
    let by_omega = -(s * (2.0 * zeta) + s * s * 2.0) / value * (zero.omega_rad_s.std / w);
    let by_damping = s * 2.0 / value * zero.damping.std;
    let join = |a: f64, b: f64| (a * a + b * b).sqrt();
    [
        join(by_omega.re, by_damping.re),
        join(by_omega.im, by_damping.im),
    ]
}
