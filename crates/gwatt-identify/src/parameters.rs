//! The parameters that a fit moves: what they are, how far they are moved to see
//! what they do, and what makes sense.

use super::transfer::{Factor, TransferFunction};

/// The parameters of a model: the gain, then of each zero and each pole `ln ω, ζ`
/// or `τ`, and the delay where it is free.
#[must_use]
pub fn parameters(transfer: &TransferFunction, delay_is_free: bool) -> Vec<f64> {
    let mut theta = vec![transfer.gain];
    for factor in transfer.zeros.iter().chain(&transfer.poles) {
        match *factor {
            Factor::Pair {
                omega_rad_s,
                damping,
            } => theta.extend([libm::log(omega_rad_s), damping]),
            Factor::Real { time_constant_s } => theta.push(time_constant_s),
        }
    }
    if delay_is_free {
        theta.push(transfer.delay_s);
    }
    theta
}

/// The model with other parameters.
#[must_use]
pub fn with(template: &TransferFunction, theta: &[f64]) -> TransferFunction {
    let mut transfer = template.clone();
    let mut rest = theta.iter().copied();
    transfer.gain = rest.next().unwrap_or_default();
    for factor in transfer.zeros.iter_mut().chain(&mut transfer.poles) {
        match factor {
            Factor::Pair {
                omega_rad_s,
                damping,
            } => {
                // What does not move stays as it is, to the last digit.
                let log = rest.next().unwrap_or_default();
                if log != libm::log(*omega_rad_s) {
                    *omega_rad_s = libm::exp(log);
                }
                *damping = rest.next().unwrap_or_default();
            }
            Factor::Real { time_constant_s } => {
                *time_constant_s = rest.next().unwrap_or_default();
            }
        }
    }
    if let Some(delay_s) = rest.next() {
        transfer.delay_s = delay_s;
    }
    transfer
}

/// How far each parameter is moved to see what it does.
#[must_use]
pub fn probes(transfer: &TransferFunction, delay_is_free: bool, period_s: f64) -> Vec<f64> {
    const SMALL: f64 = 1e-6;
    let mut steps = vec![SMALL * transfer.gain.abs().max(f64::MIN_POSITIVE)];
    for factor in transfer.zeros.iter().chain(&transfer.poles) {
        match *factor {
            Factor::Pair { .. } => steps.extend([SMALL, SMALL]),
            Factor::Real { time_constant_s } => {
                steps.push(SMALL * time_constant_s.abs().max(0.1 * period_s));
            }
        }
    }
    if delay_is_free {
        steps.push(1e-5 * period_s);
    }
    steps
}

/// True for a model that can be simulated and makes sense.
#[must_use]
pub fn is_admissible(transfer: &TransferFunction, period_s: f64) -> bool {
    let nyquist = std::f64::consts::PI / period_s;
    let is_in_range = |omega: f64| omega > 1e-6 / period_s && omega < 20.0 / period_s;
    let sound_pole = |pole: &Factor| match *pole {
        // What swings faster than half the sampling rate cannot be distinguished from
        // its image below.
        Factor::Pair {
            omega_rad_s: w,
            damping,
        } => {
            let swing = w * (1.0 - damping * damping).max(0.0).sqrt();
            is_in_range(w) && damping > 1e-7 && damping < 50.0 && swing < nyquist
        }
        Factor::Real { time_constant_s } => {
            time_constant_s > 1e-3 * period_s && time_constant_s < 1e6 * period_s
        }
    };
    let sound_zero = |zero: &Factor| match *zero {
        Factor::Pair {
            omega_rad_s: w,
            damping,
        } => is_in_range(w) && damping.abs() < 50.0,
        Factor::Real { time_constant_s } => time_constant_s.abs() < 1e6 * period_s,
    };
    transfer.poles.iter().all(sound_pole)
        && transfer.zeros.iter().all(sound_zero)
        && transfer.gain.is_finite()
        && (0.0..1000.0 * period_s).contains(&transfer.delay_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A section that does not move is taken over from where it was: it must not
    /// differ in its last digit.
    #[test]
    fn what_does_not_move_stays_the_same() {
        for k in 1..2000 {
            let omega_rad_s = 0.731 * f64::from(k);
            let pair = |damping| Factor::Pair {
                omega_rad_s,
                damping,
            };
            let transfer = TransferFunction {
                gain: 3.0,
                zeros: vec![pair(0.1)],
                poles: vec![pair(0.2)],
                delay_s: 1e-3,
            };
            let same = with(&transfer, &parameters(&transfer, true));
            assert_eq!(same, transfer);
        }
    }
}
