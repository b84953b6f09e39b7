//! What a model costs besides its parameters.

use super::certainty;
use super::transfer::{Factor, TransferFunction};

/// What a model has to pay for besides its parameters. Which of many frequencies
/// and delays it was had to be found too, and noise is tried as often: each first
/// state explains the samples over which it swings, all of them where there is no
/// damping. Zeros that structures seldom have, but noise often, count twice: those
/// on the right, which stand for a delay, and leads that undo one.
#[must_use]
pub fn charge(
    transfer: &TransferFunction,
    samples: usize,
    period_s: f64,
    from_command: bool,
) -> f64 {
    let n = samples as f64;
    let lag = libm::floor(transfer.delay_s / period_s + 1e-9);
    let lasting = |decay_rad_s: f64| libm::log(1.0 + (1.0 / (decay_rad_s * period_s)).min(n));
    let states: f64 = transfer
        .poles
        .iter()
        .map(|pole| match *pole {
            Factor::Pair {
                omega_rad_s: w,
                damping,
            } => {
                let spread = (damping * damping - 1.0).max(0.0).sqrt();
                lasting(w * (damping - spread)) + lasting(w * (damping + spread))
            }
            Factor::Real { time_constant_s } => lasting(1.0 / time_constant_s),
        })
        .sum();
    let leads = leads(transfer, from_command);
    let seldom = transfer.zeros_on_the_right() + leads;
    let parts = parts_of_period(transfer, period_s, from_command);
    states
        + 2.0 * libm::log(1.0 + lag)
        + seldom as f64 * libm::log(n)
        + parts as f64 * certainty::PART_OF_PERIOD
}

/// Lags shorter than a period: what they do between two samples a delay does as well, which
/// has to be as clear. After a command the dead time is found by its profile, in which such
/// lags have their place.
fn parts_of_period(transfer: &TransferFunction, period_s: f64, from_command: bool) -> usize {
    let is_short = |pole: &&Factor| match **pole {
        Factor::Real { time_constant_s } => time_constant_s < period_s,
        Factor::Pair { .. } => false,
    };
    let poles = transfer.poles.iter().filter(|_| !from_command);
    poles.filter(is_short).count()
}

/// Damped zeros that are no dampers' next to the fastest mode: they lead by more than
/// such a one, whose time is `2ζ/ω`. A loop leads as it likes where it is slow: below
/// what swings slowest.
fn leads(transfer: &TransferFunction, from_command: bool) -> usize {
    const DAMPER: f64 = 0.5;
    const SWINGS: f64 = 0.3;
    let modes = || {
        let modes = transfer.poles.iter().filter(|pole| pole.degree() == 2);
        modes.map(|pole| pole.corner_rad_s())
    };
    let fastest = modes().fold(0.0, f64::max);
    let slowest = modes().fold(f64::INFINITY, f64::min);
    let leads = |zero: &&Factor| match **zero {
        Factor::Real { time_constant_s } => time_constant_s * fastest > DAMPER,
        Factor::Pair { damping, .. } => damping > SWINGS,
    };
    let is_fast = |zero: &&Factor| !from_command || zero.corner_rad_s() > slowest;
    let zeros = transfer.zeros.iter().filter(leads).filter(is_fast);
    zeros.map(|zero| zero.degree()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lag of a thousandth of a period is worth as much as a delay of a part of one; one of
    /// two periods, or of a loop that follows a command, is what it is.
    #[test]
    fn a_lag_within_a_period_pays_as_a_delay_does() {
        const T: f64 = 1e-3;
        let axis = |time_constant_s: f64| TransferFunction {
            gain: 1.0,
            zeros: Vec::new(),
            poles: vec![Factor::Real { time_constant_s }],
            delay_s: 0.0,
        };
        // Besides, its first state explains so many samples: ln(1 + τ/T).
        let besides = |periods: f64, from_command: bool| {
            let all = charge(&axis(periods * T), 1000, T, from_command);
            all - libm::log(1.0 + periods)
        };
        assert!((besides(0.001, false) - certainty::PART_OF_PERIOD).abs() < 1e-9);
        assert!(besides(2.0, false).abs() < 1e-9);
        assert!(besides(0.001, true).abs() < 1e-9);
    }
}
