//! The whole of a tuning: axes, filters, and how far the axes lie apart.

use super::axis::AxisResponse;
use super::correction::{Correction, Wish, design};
use super::delay::{Advice, advice};
use super::discretize::Discretization;
use super::mismatch::{Pair, mismatch};
use crate::error::{IdentifyError, Outcome};

/// Axes, their filters, and what these do.
#[derive(Debug, Clone)]
pub struct Tuned {
    /// The axes.
    pub axes: Vec<AxisResponse>,
    /// What was asked for.
    pub wish: Wish,
    /// Band in which the axes are compared, from 0 to Hz.
    pub band_hz: f64,
    /// The filters, in the order of the axes.
    pub correction: Correction,
    /// How far the axes lie apart.
    pub pairs: Vec<Pair>,
    /// Their delays, if they are known.
    pub advice: Option<Vec<Advice>>,
}

impl Tuned {
    /// Designs filters for these axes.
    ///
    /// # Errors
    ///
    /// Axes that cannot be compared, or a filter that cannot be realised.
    pub fn new(axes: Vec<AxisResponse>, wish: Wish, band_hz: f64) -> Outcome<Self> {
        if axes.is_empty() {
            return Err(IdentifyError::new(
                "there is no axis",
                "give a recording of each axis that moves along the path",
            ));
        }
        for (index, axis) in axes.iter().enumerate() {
            let others = axes.iter().take(index);
            if others.clone().any(|other| other.letter == axis.letter) {
                return Err(IdentifyError::new(
                    format!("axis {} is given twice", axis.letter),
                    "one recording for each axis",
                ));
            }
            if let Some(other) = others.clone().find(|o| o.from_command != axis.from_command) {
                let (command, force) = if axis.from_command {
                    (axis.letter, other.letter)
                } else {
                    (other.letter, axis.letter)
                };
                return Err(IdentifyError::new(
                    format!(
                        "axis {command} is known from its command, axis {force} from its force"
                    ),
                    "record all axes alike; --from-command takes the command where both are recorded",
                ));
            }
        }
        if !(band_hz > 0.0 && band_hz <= 0.5 / wish.period_s) {
            return Err(IdentifyError::new(
                format!("axes cannot be compared up to {band_hz} Hz"),
                format!(
                    "give --band-hz between 0 and {:.1}: filters know no more at this period",
                    0.5 / wish.period_s
                ),
            ));
        }
        let zeros: Vec<_> = axes.iter().map(|a| (a.letter, a.zero_factors())).collect();
        let correction = design(&zeros, &wish)?;
        refuse_distorted(&correction, band_hz)?;
        let pairs = mismatch(&axes, &correction, band_hz);
        let advice = advice(&axes);
        Ok(Self {
            axes,
            wish,
            band_hz,
            correction,
            pairs,
            advice,
        })
    }
}

/// How far filters may be from what they stand for, dB between two axes.
const DISTORTED_DB: f64 = 1.0;

/// A hold represents a wide low-pass over several zeros badly: the axes would be less alike
/// with such filters than without.
fn refuse_distorted(correction: &Correction, band_hz: f64) -> Outcome<()> {
    if correction.discretization != Discretization::Hold {
        return Ok(());
    }
    let mut most = 0.0_f64;
    for k in 1..=POINTS {
        let hz = band_hz * f64::from(k) / f64::from(POINTS);
        let errors = (0..correction.filters.len()).map(|axis| {
            let exact = correction.continuous(axis).at_hz(hz).norm();
            20.0 * libm::log10(correction.at_hz(axis, hz).norm() / exact)
        });
        let errors: Vec<f64> = errors.filter(|db| db.is_finite()).collect();
        let highest = errors.iter().copied().fold(f64::MIN, f64::max);
        let lowest = errors.iter().copied().fold(f64::MAX, f64::min);
        most = most.max(highest - lowest);
    }
    if most <= DISTORTED_DB {
        return Ok(());
    }
    Err(IdentifyError::new(
        format!(
            "as zoh makes them, the filters are up to {most:.1} dB from what they stand for, up to {band_hz} Hz"
        ),
        "lower --low-pass-hz, shorten --period-ms, or leave --discretize at matched",
    ))
}

/// Frequencies that are looked at.
const POINTS: u32 = 200;
