//! Loads that follow a position command that runs on between samples: how late they
//! are, and how far the dead time is known.

use std::f64::consts::TAU;

use gwatt::identify::flexible::{self, Flexible, Method};
use gwatt::identify::{Factor, Judgement, Measured, TransferFunction, judgement, simulate};

use super::{PERIOD_S, choice, pair, table};
use crate::random::Random;

/// Steps of the simulation in a sampling period.
const FINE: usize = 10;

/// A load with an anti-resonance at 40 Hz in a loop of 20 Hz; a mode of the drive at
/// 130 Hz lies beyond what is excited.
fn loops(delay_s: f64) -> TransferFunction {
    TransferFunction {
        gain: 1.0,
        zeros: vec![pair(40.0, 0.03)],
        poles: vec![pair(22.0, 1.5), pair(41.0, 0.22), pair(130.0, 0.34)],
        delay_s,
    }
}

/// Acceleration of a command over `seconds`: sines of 1 to 80 Hz.
fn sines(seconds: f64, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    let step_s = PERIOD_S / FINE as f64;
    let mut out = vec![0.0; (seconds / step_s) as usize];
    let mut hz = 1.0;
    while hz < 80.0 {
        let phase = TAU * random.unit();
        for (k, slot) in out.iter_mut().enumerate() {
            *slot += libm::sin(TAU * hz * step_s * k as f64 + phase);
        }
        hz += 0.4;
    }
    out
}

/// The integral by the trapezoidal rule.
fn integral(x: &[f64]) -> Vec<f64> {
    let half_s = 0.5 * PERIOD_S / FINE as f64;
    let mut sum = 0.0;
    let mut out = vec![0.0];
    for pair in x.windows(2) {
        sum += half_s * (pair[0] + pair[1]);
        out.push(sum);
    }
    out
}

fn sampled(x: &[f64]) -> Vec<f64> {
    x.iter().step_by(FINE).copied().collect()
}

/// What is found from a noisy recording of the command and this of the load.
fn found(axis: &TransferFunction, measured: &str, noise: f64, seed: u64) -> Flexible {
    let command = sines(8.0, seed);
    let mut load = simulate(axis, Measured::Direct, PERIOD_S / FINE as f64, &command).unwrap();
    if measured == "velocity_m_s" {
        load = integral(&load);
    }
    let position = sampled(&integral(&integral(&command)));
    let load = sampled(&load);
    let rms = (load.iter().map(|x| x * x).sum::<f64>() / load.len() as f64).sqrt();
    let mut random = Random(seed + 100);
    let noisy: Vec<f64> = load
        .iter()
        .map(|x| x + noise * rms * random.normal())
        .collect();
    let recording = table(&["position_command_m", measured], &[&position, &noisy]);
    flexible::identify(&recording, &choice(Method::Iv)).unwrap()
}

fn lateness_s(model: &TransferFunction) -> f64 {
    let sum = |list: &[Factor]| -> f64 { list.iter().map(|factor| factor.lag_s()).sum() };
    model.delay_s + sum(&model.poles) - sum(&model.zeros)
}

/// Whatever is measured of the load, it is as late as it is, and its zero is right.
/// The dead time may as well be that of modes that do not show: it says so.
#[test]
fn loads_are_as_late_as_they_are_and_dead_time_says_how_far_it_is_known() {
    for (measured, delay_s, noise, seed) in [
        ("accel_m_s2", 0.0, 0.05, 1),
        ("accel_m_s2", 1.4e-3, 0.01, 2),
        ("velocity_m_s", 1.4e-3, 0.05, 5),
        ("velocity_m_s", 3e-3, 0.02, 6),
    ] {
        let axis = loops(delay_s);
        let found = found(&axis, measured, noise, seed);
        let shown = format!(
            "{measured} {delay_s} {:?} {:?}",
            found.delay_s, found.transfer
        );
        let late_s = lateness_s(&found.transfer) - lateness_s(&axis);
        assert!(late_s.abs() < 1e-4, "{late_s} {shown}");
        assert_eq!(found.zeros.len(), 1, "{shown}");
        let zero = found.zeros[0].omega_rad_s;
        assert!((zero.value - TAU * 40.0).abs() < 4.0 * zero.std, "{shown}");
        let off_s = (found.delay_s.value - delay_s).abs();
        assert!(off_s < 2.0 * found.delay_s.std, "{shown}");
        assert!(found.delay_s.std < 2.5 * PERIOD_S, "{shown}");
    }
}

/// What a loop does beyond the band may look like a zero: one of which the recording
/// does not show whether it is there is no anti-resonance, and the verdict says that
/// something is not known.
#[test]
fn a_zero_that_is_not_known_does_not_count() {
    let axis = TransferFunction {
        gain: 1.0,
        zeros: Vec::new(),
        poles: vec![pair(20.0, 1.2), pair(110.0, 0.35)],
        delay_s: 1.4e-3,
    };
    let found = found(&axis, "accel_m_s2", 0.02, 13);
    assert!(found.zeros.is_empty(), "{:?}", found.zeros);
    let [unclear] = found.unclear_zeros[..] else {
        panic!("{:?}", found.transfer);
    };
    assert!(unclear.omega_rad_s.std > 0.1 * unclear.omega_rad_s.value);
    let judged = judgement::flexible(&found);
    assert!(
        matches!(judged, Judgement::ExciteLonger { .. }),
        "{judged:?}"
    );
}
