//! Positions and speeds under a torque: their noise is that of what was measured, and
//! what disturbs the axis slowly does not run off with them.

use std::f64::consts::TAU;

use gwatt::identify::flexible::{self, Flexible, Method};
use gwatt::identify::{Factor, Measured, TransferFunction, simulate};

use super::{PERIOD_S, choice, errors, one_side, random, table, two_sides};
use crate::random::Random;

/// What each sample adds up to.
fn sums(x: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    x.iter()
        .map(|x| {
            sum += x * PERIOD_S;
            sum
        })
        .collect()
}

/// What is found from a torque and a position or speed with white noise of a size; a
/// slow torque that is not recorded is a share of what is.
fn found(
    axis: &TransferFunction,
    measured: Measured,
    noise: f64,
    disturbed: f64,
    seed: u64,
) -> Flexible {
    let torque = random(4000, 120.0);
    let mut noise_of = Random(seed);
    let mut slow = 0.0;
    let sum: Vec<f64> = torque
        .iter()
        .map(|torque| {
            // A corner at 3 Hz, and the rms of white noise that it lets pass.
            slow += 0.019 * (noise_of.normal() - slow);
            torque + disturbed * slow / 0.098
        })
        .collect();
    // Differences of what is measured: sums of them are exact.
    let differences = simulate(axis, measured, PERIOD_S, &sum).unwrap();
    let (name, clean) = match measured {
        Measured::Position => ("position_rad", sums(&sums(&differences))),
        _ => ("speed_rad_s", sums(&differences)),
    };
    let noisy: Vec<f64> = clean
        .iter()
        .map(|x| x + noise * noise_of.normal())
        .collect();
    let recording = table(&["torque_nm", name], &[&torque, &noisy]);
    flexible::identify(&recording, &choice(Method::Iv)).unwrap()
}

/// White noise of a position or a speed is called white, and standard errors say how
/// far off the figures are.
#[test]
fn noise_of_positions_and_speeds_is_white() {
    for (axis, measured, noise) in [
        (one_side(), Measured::Position, 1e-5),
        (two_sides(), Measured::Position, 3e-6),
        (one_side(), Measured::Velocity, 3e-3),
    ] {
        let (mut sum, mut count) = (0.0, 0.0);
        for seed in 0..4 {
            let found = found(&axis, measured, noise, 0.0, seed);
            assert!(found.whiteness.is_white(), "{seed} {:?}", found.whiteness);
            assert_eq!(found.noise_order, 0, "{seed}");
            for (error, std) in errors(&axis, &found) {
                sum += (error / std) * (error / std);
                count += 1.0;
            }
        }
        // χ² by its degrees of freedom; figures of one seed are correlated a little.
        let mean = sum / count;
        assert!((0.3..2.2).contains(&mean), "{measured:?} {mean}");
    }
}

/// A torque of which nothing is recorded moves the axis slowly, and far: integrators
/// leak as much as that needs, and the figures stay as good as they say.
#[test]
fn slow_disturbances_do_not_run_off() {
    for measured in [Measured::Position, Measured::Velocity] {
        let axis = one_side();
        let found = found(&axis, measured, 1e-6, 0.05, 7);
        assert!(found.noise_order > 0 || found.leak > 0.05, "{}", found.leak);
        let errors = errors(&axis, &found);
        for (error, std) in &errors {
            assert!(error.abs() < 4.0 * std, "{errors:?}, {:?}", found.transfer);
        }
        assert!(errors[0].1 < 1e-3 && errors[1].1 < 0.05, "{errors:?}");
    }
}

/// What disturbs the axis swings a few times while a recording lasts: no mode stands for
/// that, which would spoil the inertia.
#[test]
fn no_mode_stands_for_a_slow_disturbance() {
    let axis = one_side();
    for seed in 0..4 {
        let found = found(&axis, Measured::Position, 1e-6, 0.05, seed);
        assert_eq!(found.transfer.order(), axis.order(), "{seed}");
        let inertia = found.inertia.unwrap();
        let error = inertia.value * axis.gain - 1.0;
        assert!(error.abs() < 4.0 * inertia.std * axis.gain, "{error}");
        assert!(inertia.std * axis.gain < 0.005, "{inertia:?}");
    }
}

/// A part of a period of delay is found as that, not by lags that do nearly the same.
#[test]
fn a_part_of_a_period_of_delay_is_found_behind_coloured_noise() {
    let pair = |hz: f64, damping| Factor::Pair {
        omega_rad_s: TAU * hz,
        damping,
    };
    let axis = TransferFunction {
        gain: 42.0,
        zeros: vec![pair(40.0, 0.03)],
        poles: vec![pair(55.0, 0.04), pair(150.0, 0.05)],
        delay_s: 0.35 * PERIOD_S,
    };
    for seed in 0..2 {
        let found = found(&axis, Measured::Position, 1e-6, 0.02, seed);
        assert_eq!(found.transfer.order(), axis.order(), "{seed}");
        let error_s = found.delay_s.value - axis.delay_s;
        assert!(error_s.abs() < 2e-6, "{error_s}");
    }
}
