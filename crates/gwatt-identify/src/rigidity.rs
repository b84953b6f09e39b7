//! What a rigid model leaves: noise, or an axis that is not rigid.
//!
//! Noise of a sensor makes force and acceleration less alike; a resonance keeps
//! them alike, only in another ratio than slow motion has. So where the two cohere,
//! their ratio is compared with the mass. What has nothing to do with the acceleration at
//! all, such as the force of another axis, is neither.

use super::certainty;
use super::spectrum::{explained_share, measure};

/// Where the model misses more than this share of a frequency's force, and
/// [`certainty::NOT_RIGID`] standard errors of it, the axis is not rigid. What is not coherent, noise in the
/// force or in the acceleration, makes their ratio another one by as much at most; it
/// is taken twice.
const MISSED: f64 = 0.1;
/// In so many neighbouring frequencies.
const RUN: usize = 3;
/// Which share of the force follows from the acceleration of an axis that resonates, as any
/// linear system could make the one of the other.
const FOLLOWS: f64 = 0.5;

/// Whether an axis resonates within the band, Hz: by its force, friction taken off,
/// and its acceleration, every `step_s`.
#[must_use]
pub fn resonates(
    force: &[f64],
    acceleration: &[f64],
    mass: f64,
    step_s: f64,
    band_hz: f64,
) -> bool {
    let Some(measured) = measure(force, acceleration, None, step_s, None) else {
        return false;
    };
    if explained_share(acceleration, force, step_s) < FOLLOWS {
        return false;
    }
    let missed: Vec<bool> = measured
        .response
        .iter()
        .zip(&measured.variance)
        .zip(&measured.coherence)
        .zip(&measured.frequency_hz)
        .take_while(|(_, hz)| **hz < band_hz)
        .map(|(((by_force, variance), coherence), _)| {
            let missed = (by_force * mass - 1.0).norm();
            missed > MISSED + 2.0 * (1.0 - coherence)
                && missed > certainty::NOT_RIGID * mass.abs() * variance.sqrt()
        })
        .collect();
    missed
        .windows(RUN)
        .any(|run| run.iter().all(|missed| *missed))
}

#[cfg(test)]
mod tests {
    use super::super::state_space::{Measured, simulate};
    use super::super::transfer::{Factor, TransferFunction};
    use super::*;

    fn noise(seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        (0..2000).map(|_| next()).collect()
    }

    /// A resonance makes the one of the other; two axes have nothing to do with each other,
    /// whatever their ratio.
    #[test]
    fn another_axis_is_no_resonance() {
        let pair = |hz: f64| Factor::Pair {
            omega_rad_s: std::f64::consts::TAU * hz,
            damping: 0.1,
        };
        let axis = TransferFunction {
            gain: 0.5,
            zeros: vec![pair(12.0)],
            poles: vec![pair(18.0)],
            delay_s: 0.0,
        };
        let force = noise(1);
        let own = simulate(&axis, Measured::Direct, 0.01, &force).unwrap();
        assert!(resonates(&force, &own, 2.0, 0.01, 30.0));
        for (seed, mass) in (2..8).flat_map(|seed| [0.02, 2.0, 20.0].map(|mass| (seed, mass))) {
            assert!(!resonates(&force, &noise(seed), mass, 0.01, 30.0), "{seed}");
        }
    }
}
