//! A fitted model, and how models that were fitted to the same samples compare.

use nalgebra::DMatrix;

use super::figure::Figure;
use super::transfer::TransferFunction;

/// A fitted model.
#[derive(Debug, Clone)]
pub struct Estimate {
    /// The model.
    pub transfer: TransferFunction,
    /// Covariance of the parameters in the order of [`parameters()`](super::parameters::parameters).
    pub covariance: DMatrix<f64>,
    /// Sum of squares of the (whitened) differences.
    pub rest: f64,
    /// Rows that it is the sum of.
    pub rows: usize,
    /// Samples that they were made of.
    pub samples: usize,
    /// Sum of squares of the output: the model's differences count as no less
    /// than a share of it.
    pub power: f64,
    /// That share.
    pub floor: f64,
    /// Parameters that were fitted, offset and first state left out.
    pub count: usize,
    /// What the criterion charges for besides parameters.
    pub charge: f64,
    /// Steps that the search took.
    pub steps: usize,
    /// Offset of the output.
    pub offset: f64,
    /// State at the first sample, what leaky integrators held, and terms of friction.
    pub state: Vec<f64>,
    /// Terms of friction, with their errors.
    pub friction: Vec<Figure>,
}

impl Estimate {
    /// Bayes' information criterion with its [`charge()`](super::charge::charge); the smaller, the better.
    #[must_use]
    pub fn criterion(&self) -> f64 {
        let least = self.floor * self.power;
        criterion(self.rest, least, self.rows, self.count, self.samples) + self.charge
    }

    /// Whether nothing is left that another model could explain.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.rest <= self.floor * self.power
    }

    /// Akaike's criterion: the smaller, the likelier, whatever is rare.
    #[must_use]
    pub fn likelihood(&self) -> f64 {
        let n = self.rows as f64;
        let rest = self
            .rest
            .max(self.floor * self.power)
            .max(f64::MIN_POSITIVE);
        n * libm::log(rest / n) + 2.0 * self.count as f64
    }

    /// Standard error of the parameter at `index`.
    #[must_use]
    pub fn std(&self, index: usize) -> Option<f64> {
        (index < self.covariance.nrows()).then(|| self.covariance[(index, index)].sqrt())
    }
}

/// The share of a signal's squares that counts as rounding: what is left is as good as nothing.
pub(super) const ROUNDING: f64 = 1e-14;
/// The same next to friction: whatever it does besides being viscous and Coulomb friction is
/// more than that, and no mode of the axis.
pub(super) const FRICTION: f64 = 1e-6;

/// Bayes' information criterion of a sum of squares that counts as no less than `least`.
pub(super) fn criterion(rest: f64, least: f64, rows: usize, count: usize, samples: usize) -> f64 {
    let n = rows as f64;
    let rest = rest.max(least).max(f64::MIN_POSITIVE);
    n * libm::log(rest / n) + count as f64 * libm::log(samples as f64)
}
