//! Resonances and anti-resonances of a model, and how far they are known.

use super::figure::Figure;
use super::transfer::{Factor, TransferFunction};

/// A resonance or anti-resonance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// rad/s.
    pub omega_rad_s: Figure,
    /// Damping ratio.
    pub damping: Figure,
}

/// Damping from which on a pair of zeros makes no dip, and a pair of poles no
/// peak: 1/√2.
const DIP: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Relative standard error of a frequency from which on a zero is not clear.
const UNCLEAR: f64 = 0.1;

/// Zeros, zeros that are not clear, and poles that swing, in ascending order: up to these
/// limits (rad/s) of zeros and of poles. `std` gives the standard error of a parameter.
pub(super) fn roots_of(
    transfer: &TransferFunction,
    (shown, highest): (f64, f64),
    std: impl Fn(usize) -> f64,
) -> [Vec<Root>; 3] {
    let mut at = 1;
    let mut zeros = Vec::new();
    let mut unclear_zeros = Vec::new();
    let mut poles = Vec::new();
    for (index, factor) in transfer.zeros.iter().chain(&transfer.poles).enumerate() {
        if let Factor::Pair {
            omega_rad_s,
            damping,
        } = *factor
        {
            let root = Root {
                omega_rad_s: Figure {
                    value: omega_rad_s,
                    std: omega_rad_s * std(at),
                },
                damping: Figure {
                    value: damping,
                    std: std(at + 1),
                },
            };
            let is_zero = index < transfer.zeros.len();
            let band = if is_zero { shown } else { highest };
            if damping.abs() < DIP && omega_rad_s < band {
                if is_zero && std(at) > UNCLEAR {
                    unclear_zeros.push(root);
                } else if is_zero {
                    zeros.push(root);
                } else {
                    poles.push(root);
                }
            }
        }
        at += factor.degree();
    }
    for list in [&mut zeros, &mut unclear_zeros, &mut poles] {
        list.sort_by(|a: &Root, b: &Root| a.omega_rad_s.value.total_cmp(&b.omega_rad_s.value));
    }
    [zeros, unclear_zeros, poles]
}

/// Damping below which a root after a command is the load's: what is damped more is a loop's,
/// or stands for dead time.
const RINGS: f64 = 0.5;

impl Root {
    /// Whether it rings, as the load does and a loop does not.
    pub(super) fn rings(&self) -> bool {
        self.damping.value.abs() < RINGS
    }

    /// Widens errors for what a recording of a command does not say: whether it is held
    /// between samples or runs on. Its strength differs by `(ωT)²/24` then, which tilts by
    /// `(ωT)²/12` at the root and moves that by as much of its damping.
    pub(super) fn runs_between_samples(&mut self, period_s: f64) {
        let omega = self.omega_rad_s.value;
        let tilt = omega * period_s * omega * period_s / 12.0;
        let damping = self.damping.value.abs();
        let widen = |figure: &mut Figure, by: f64| figure.std = libm::hypot(figure.std, by);
        widen(&mut self.omega_rad_s, omega * damping * tilt);
        widen(&mut self.damping, damping * tilt);
    }
}

/// Dead time after a command that zeros on the right stand for, s: with the poles that go
/// with them, twice what makes them late.
pub(super) fn stands_for_delay_s(transfer: &TransferFunction, from_command: bool) -> f64 {
    let late = transfer
        .zeros
        .iter()
        .map(|zero| zero.lag_s().min(0.0).abs());
    if from_command {
        2.0 * late.sum::<f64>()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 40 Hz at 1 kHz, damping 0.03: (ωT)²/12 = 0.0052638.
    #[test]
    fn what_runs_between_samples_widens_errors() {
        let figure = |value| Figure { value, std: 0.0 };
        let mut root = Root {
            omega_rad_s: figure(251.327_412),
            damping: figure(0.03),
        };
        root.runs_between_samples(1e-3);
        assert!((root.damping.std - 1.579e-4).abs() < 1e-7);
        assert!((root.omega_rad_s.std - 0.039_688).abs() < 1e-5);
    }

    /// A zero on the right of 1 ms stands for 2 ms; one on the left for nothing.
    #[test]
    fn zeros_on_the_right_stand_for_dead_time() {
        let model = TransferFunction {
            gain: 1.0,
            zeros: [-1e-3, 5e-3]
                .map(|time_constant_s| Factor::Real { time_constant_s })
                .to_vec(),
            poles: Vec::new(),
            delay_s: 0.0,
        };
        assert_eq!(stands_for_delay_s(&model, true), 2e-3);
        assert_eq!(stands_for_delay_s(&model, false), 0.0);
    }
}
