//! What creeps more slowly than a recording shows an axis to swing.
//!
//! Structures swing; a real pole next to a real zero that are as slow as that are what friction
//! and other disturbances did while it was recorded. The inertia is that of the motion above
//! them: at 0 Hz, which no recording shows, it would be what friction makes of it.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::figure::Figure;
use super::transfer::{Factor, TransferFunction};

/// What swings so many times only while a recording lasts may be a disturbance.
const SWINGS: f64 = 20.0;

/// Below this frequency, rad/s, a recording shows no swings.
pub(super) fn slow_rad_s(samples: usize, period_s: f64) -> f64 {
    SWINGS * 2.0 * PI / (samples as f64 * period_s)
}

/// The inertia of a model of an axis above what creeps, with its standard error, which is NaN
/// without a covariance of the parameters.
pub(super) fn inertia(
    transfer: &TransferFunction,
    slow_rad_s: f64,
    covariance: Option<&DMatrix<f64>>,
) -> Figure {
    let mut out = Slopes::of_gain(transfer);
    let creeping = [&transfer.zeros, &transfer.poles].map(|list| creep(list, slow_rad_s));
    let [zeros, poles] = &creeping;
    // A zero more, or a pole, has another unit than an inertia.
    if zeros.len() == poles.len() {
        let first_pole = 1 + transfer.zero_count();
        for root in zeros {
            out.take(root, 1, -1.0);
        }
        for root in poles {
            out.take(root, first_pole, 1.0);
        }
    }
    // A delay, which comes last, makes no inertia.
    let variance = |covariance: &DMatrix<f64>| -> f64 {
        let each = out.slopes.iter().zip(covariance.row_iter());
        let rows = each.map(|(slope, row)| {
            let sum: f64 = out.slopes.iter().zip(row.iter()).map(|(x, c)| x * c).sum();
            slope * sum
        });
        rows.sum::<f64>().abs()
    };
    Figure {
        value: out.inertia,
        std: out.inertia.abs() * covariance.map_or(f64::NAN, variance).sqrt(),
    }
}

/// A real root: its time constant, and how the logarithm of that goes with parameters, by
/// their place in the list.
struct Real {
    time_constant_s: f64,
    slopes: [(usize, f64); 2],
}

/// Roots on the left slower than that, of zeros or of poles.
fn creep(list: &[Factor], slow_rad_s: f64) -> Vec<Real> {
    let mut at = 0;
    let mut out = Vec::new();
    for factor in list {
        for (index, root) in factor.apart().enumerate() {
            if let Factor::Real { time_constant_s } = root
                && time_constant_s * slow_rad_s > 1.0
            {
                let slopes = match *factor {
                    // ln ω, and ζ: the slower root comes first.
                    Factor::Pair { damping, .. } => {
                        let by_damping = 1.0 / (damping * damping - 1.0).sqrt();
                        let sign = if index == 0 { 1.0 } else { -1.0 };
                        [(at, -1.0), (at + 1, sign * by_damping)]
                    }
                    Factor::Real { .. } => [(at, 1.0 / time_constant_s), (at, 0.0)],
                };
                out.push(Real {
                    time_constant_s,
                    slopes,
                });
            }
        }
        at += factor.degree();
    }
    out
}

/// An inertia, and how its logarithm goes with each parameter of a model.
struct Slopes {
    inertia: f64,
    slopes: Vec<f64>,
}

impl Slopes {
    /// That of motion at 0 Hz.
    fn of_gain(transfer: &TransferFunction) -> Self {
        let mut slopes = vec![0.0; 1 + transfer.zero_count() + transfer.order()];
        if let Some(slope) = slopes.first_mut() {
            *slope = -1.0 / transfer.gain;
        }
        Self {
            inertia: 1.0 / transfer.gain,
            slopes,
        }
    }

    /// That of motion faster than a root; `power` is 1 for a pole.
    fn take(&mut self, root: &Real, first: usize, power: f64) {
        self.inertia *= libm::pow(root.time_constant_s, power);
        for (at, by) in root.slopes {
            if let Some(slope) = self.slopes.get_mut(first + at) {
                *slope += power * by;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::parameters::{parameters, with};
    use super::*;

    fn axis(zero_s: f64, pole_s: f64) -> TransferFunction {
        let fast_s: f64 = 4e-4;
        let omega_rad_s = 1.0 / (pole_s * fast_s).sqrt();
        TransferFunction {
            gain: 1e-3,
            zeros: vec![
                Factor::Pair {
                    omega_rad_s: 400.0,
                    damping: 0.03,
                },
                Factor::Real {
                    time_constant_s: zero_s,
                },
            ],
            poles: vec![
                Factor::Pair {
                    omega_rad_s: 470.0,
                    damping: 0.03,
                },
                Factor::Pair {
                    omega_rad_s,
                    damping: 0.5 * (pole_s + fast_s) * omega_rad_s,
                },
            ],
            delay_s: 0.0,
        }
    }

    #[test]
    fn the_inertia_is_that_of_motion_above_what_creeps() {
        let slow = slow_rad_s(6000, 1e-3);
        let of = |model: &TransferFunction| inertia(model, slow, None).value;
        // 1000 kg at 0 Hz, of which the pair of real roots is a fifth.
        assert!((of(&axis(0.5, 0.4)) - 800.0).abs() < 1e-6);
        // What is faster swings often enough, or stays as it is.
        assert!((of(&axis(0.02, 0.016)) - 1000.0).abs() < 1e-9);
        // A zero alone leaves no inertia above it; on the right it is no friction.
        assert!((of(&axis(0.5, 0.016)) - 1000.0).abs() < 1e-9);
        assert!((of(&axis(-0.5, 0.4)) - 1000.0).abs() < 1e-9);
    }

    /// The slopes are those of small steps.
    #[test]
    fn its_error_goes_with_all_parameters_that_it_is_made_of() {
        let model = axis(0.5, 0.4);
        let slow = slow_rad_s(6000, 1e-3);
        let theta = parameters(&model, false);
        let n = theta.len();
        let covariance = DMatrix::from_fn(n, n, |i, j| {
            let share = 1e-3 * theta[i].abs().max(0.1);
            if i == j { share * share } else { 0.0 }
        });
        let step = |at: usize| {
            let by = 1e-6 * theta[at].abs();
            let mut next = theta.clone();
            next[at] += by;
            let moved = inertia(&with(&model, &next), slow, None).value;
            (moved - inertia(&model, slow, None).value) / by
        };
        let variance = (0..n).map(|at| step(at).powi(2) * covariance[(at, at)]);
        let expected = variance.sum::<f64>().sqrt();
        let std = inertia(&model, slow, Some(&covariance)).std;
        assert!((std / expected - 1.0).abs() < 1e-3, "{std} {expected}");
    }
}
