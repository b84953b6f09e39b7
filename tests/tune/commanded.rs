//! Axes recorded from the position command: held or run on, the zeros and how
//! late the load is come out right.

use std::f64::consts::TAU;

use gwatt::identify::flexible::Method;
use gwatt::identify::tune::of_recording;
use gwatt::identify::{Factor, Measured, TransferFunction, simulate};

use super::pair;
use crate::identify::{PERIOD_S, choice, m_sequence, table};
use crate::random::Random;

/// A command that is held between samples, and one that the drive joins by
/// straight lines a period later: both give the zero of the load.
#[test]
fn commands_may_be_held_or_run_on() {
    let truth = TransferFunction {
        gain: 1.0,
        zeros: vec![pair(40.0, 0.03)],
        poles: vec![pair(45.0, 0.4), pair(90.0, 0.5)],
        delay_s: 0.0,
    };
    let mut position = Vec::new();
    let (mut speed, mut place) = (0.0, 0.0);
    for accel in m_sequence(4000) {
        speed += accel * PERIOD_S;
        place += speed * PERIOD_S;
        position.push(place);
    }
    let held = simulate(&truth, Measured::Direct, PERIOD_S, &position).unwrap();
    let slopes: Vec<f64> = std::iter::once(0.0)
        .chain(
            position
                .windows(2)
                .map(|pair| (pair[1] - pair[0]) / PERIOD_S),
        )
        .collect();
    let speeds = simulate(&truth, Measured::Velocity, PERIOD_S, &slopes).unwrap();
    let joined: Vec<f64> = speeds
        .iter()
        .scan(position[0], |at, v| {
            *at += v * PERIOD_S;
            Some(*at)
        })
        .collect();
    let lag_s: f64 = truth.poles.iter().map(|pole| pole.lag_s()).sum();
    let mut random = Random(3);
    // Held it is half a period late on average; joined a period later, a whole one.
    for (load, late_s) in [(held, 0.5 * PERIOD_S), (joined, PERIOD_S)] {
        // A thousandth of the way: encoders.
        let load: Vec<f64> = load.iter().map(|x| x + 1e-6 * random.normal()).collect();
        let recording = table(&["position_command_m", "position_m"], &[&position, &load]);
        let found = of_recording(&recording, 'X', &choice(Method::Iv)).unwrap();
        assert_eq!(found.zeros.len(), 1);
        let zero = found.zeros[0];
        assert!(
            (zero.omega_rad_s.value / TAU - 40.0).abs() < 0.2,
            "{zero:?}"
        );
        assert!((zero.damping.value - 0.03).abs() < 0.003, "{zero:?}");
        let is_evened = |factor: &&Factor| **factor == zero.factor();
        let zeros = found.transfer().zeros;
        let early_s: f64 = zeros
            .iter()
            .filter(|factor| !is_evened(factor))
            .map(|factor| factor.lag_s())
            .sum();
        let poles_s: f64 = found.poles.iter().map(|pole| pole.lag_s()).sum();
        let late = found.delay_s + poles_s - early_s - lag_s - late_s;
        assert!(late.abs() < 5e-5, "{late}");
    }
}
