//! Identification: axes of which the parameters are known, and published data.

mod accuracy;
mod commanded;
mod designed;
mod effects;
mod joined;
mod layouts;
mod positions;
mod power_log;
mod readers;
mod refusals;
mod rigid;
mod rubbing;
mod signals;
mod verdicts;

use std::f64::consts::TAU;
use std::fmt::Write as _;

use gwatt::identify::excitation::{Shape, make};
use gwatt::identify::flexible::{self, Choice, Flexible, Method};
use gwatt::identify::judgement;
use gwatt::identify::{
    Factor, Given, Judgement, Measured, Recording, TransferFunction, factors_of, simulate,
};

use crate::evidence::shared;
use crate::random::Random;

pub(crate) const PERIOD_S: f64 = 1e-3;

/// Position, speed and acceleration of a sum of sines: amplitudes and Hz.
pub(crate) fn sines(t: f64, parts: &[(f64, f64)]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for (amplitude, hz) in parts {
        let w = TAU * hz;
        let (sin, cos) = libm::sincos(w * t);
        sums[0] += amplitude * sin;
        sums[1] += amplitude * w * cos;
        sums[2] -= amplitude * w * w * sin;
    }
    sums
}

fn product(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; p.len() + q.len() - 1];
    for (i, a) in p.iter().enumerate() {
        for (j, b) in q.iter().enumerate() {
            out[i + j] += a * b;
        }
    }
    out
}

fn sum(p: &[f64], factor: f64, q: &[f64]) -> Vec<f64> {
    let at = |p: &[f64], k: usize| p.get(k).copied().unwrap_or(0.0);
    (0..p.len().max(q.len()))
        .map(|k| at(p, k) + factor * at(q, k))
        .collect()
}

/// Motor, table and side masses, one after the other on springs: the motor
/// drives the table through (`k`, `c`), each side mass is connected to the table. From
/// torque to the table's acceleration.
pub(crate) fn branched(
    motor: f64,
    table: f64,
    drive: [f64; 2],
    sides: &[[f64; 3]],
) -> TransferFunction {
    // Side mass: pulls the table with m·(k + c·s)/(m·s² + c·s + k) of its a.
    let mut zeros = vec![1.0];
    for [m, k, c] in sides {
        zeros = product(&zeros, &[*k, *c, *m]);
    }
    // The table's apparent mass times the product of the sides' polynomials.
    let mut apparent: Vec<f64> = zeros.iter().map(|z| z * table).collect();
    for (index, [m, k, c]) in sides.iter().enumerate() {
        let mut others = vec![m * k, m * c];
        for (other, [m, k, c]) in sides.iter().enumerate() {
            if other != index {
                others = product(&others, &[*k, *c, *m]);
            }
        }
        apparent = sum(&apparent, 1.0, &others);
    }
    // T = m₁·a₁ + M·a₂, (k + c·s)·(a₁ − a₂) = s²·M·a₂.
    let spring = drive;
    let inertial = product(&[0.0, 0.0, motor], &apparent);
    let stiff = product(&spring, &sum(&apparent, motor, &zeros));
    let denominator = sum(&stiff, 1.0, &inertial);
    let numerator = product(&spring, &zeros);
    let total = motor + table + sides.iter().map(|[m, ..]| m).sum::<f64>();
    TransferFunction {
        gain: 1.0 / total,
        zeros: factors_of(&numerator, false).unwrap(),
        poles: factors_of(&denominator, true).unwrap(),
        delay_s: 0.0,
    }
}

/// Spring and damper of a mode of its own at `hz` with `damping`.
pub(crate) fn spring(mass: f64, hz: f64, damping: f64) -> [f64; 2] {
    let w = TAU * hz;
    [mass * w * w, 2.0 * damping * mass * w]
}

pub(crate) fn one_side() -> TransferFunction {
    let [k, c] = spring(0.008, 40.0, 0.03);
    branched(0.006, 0.01, spring(0.0045, 150.0, 0.05), &[[0.008, k, c]])
}

fn two_sides() -> TransferFunction {
    let [k1, c1] = spring(0.008, 40.0, 0.03);
    let [k2, c2] = spring(0.004, 75.0, 0.03);
    let sides = [[0.008, k1, c1], [0.004, k2, c2]];
    branched(0.006, 0.01, spring(0.0045, 180.0, 0.05), &sides)
}

pub(crate) fn m_sequence(samples: usize) -> Vec<f64> {
    held_m_sequence(samples, 1)
}

/// A flat spectrum from 1 Hz up to a frequency, and nothing above.
pub(crate) fn random(samples: usize, to_hz: f64) -> Vec<f64> {
    let shape = Shape::Random {
        from_hz: 1.0,
        to_hz,
        seconds: samples as f64 * PERIOD_S,
        seed: 1,
    };
    make(shape, 1.0, PERIOD_S).unwrap().values
}

fn held_m_sequence(samples: usize, hold: usize) -> Vec<f64> {
    let order = (3..20)
        .find(|order| (1 << order) > samples / hold + 1)
        .unwrap();
    let shape = Shape::MSequence {
        order,
        hold,
        repetitions: 1,
    };
    let mut values = make(shape, 1.0, PERIOD_S).unwrap().values;
    values.truncate(samples);
    values
}

/// A recording of torque and the load's acceleration with white noise.
pub(crate) fn recording(axis: &TransferFunction, seconds: f64, noise: f64, seed: u64) -> Recording {
    let torque = m_sequence((seconds / PERIOD_S) as usize);
    noisy_recording(axis, &torque, noise, seed)
}

pub(crate) fn noisy_recording(
    axis: &TransferFunction,
    torque: &[f64],
    noise: f64,
    seed: u64,
) -> Recording {
    let clean = simulate(axis, Measured::Direct, PERIOD_S, torque).unwrap();
    let rms = (clean.iter().map(|a| a * a).sum::<f64>() / clean.len() as f64).sqrt();
    let mut random = Random(seed.wrapping_mul(7919).wrapping_add(1));
    let noisy: Vec<f64> = clean
        .iter()
        .map(|a| a + noise * rms * random.normal())
        .collect();
    table(&["torque_nm", "accel_rad_s2"], &[torque, &noisy])
}

pub(crate) fn csv(names: &[&str], columns: &[&[f64]]) -> String {
    let mut text = format!("time_s,{}\n", names.join(","));
    for k in 0..columns[0].len() {
        write!(text, "{:.6}", k as f64 * PERIOD_S).unwrap();
        for column in columns {
            write!(text, ",{}", column[k]).unwrap();
        }
        text.push('\n');
    }
    text
}

pub(crate) fn table(names: &[&str], columns: &[&[f64]]) -> Recording {
    Recording::read(csv(names, columns).as_bytes(), None).unwrap()
}

/// A pole or zero of two.
pub(crate) fn pair(hz: f64, damping: f64) -> Factor {
    Factor::Pair {
        omega_rad_s: TAU * hz,
        damping,
    }
}

pub(crate) fn choice(method: Method) -> Choice {
    Choice {
        method,
        given: Given::default(),
        from_command: false,
    }
}

fn found(axis: &TransferFunction, seconds: f64, noise: f64, seed: u64) -> Flexible {
    flexible::identify(&recording(axis, seconds, noise, seed), &choice(Method::Iv)).unwrap()
}

/// Relative errors of ω, ζ of each anti-resonance and of J, with their standard
/// errors.
fn errors(axis: &TransferFunction, found: &Flexible) -> Vec<(f64, f64)> {
    let truth: Vec<(f64, f64)> = axis.anti_resonances().collect();
    assert_eq!(found.zeros.len(), truth.len(), "{:?}", found.transfer);
    let mut errors = Vec::new();
    for (zero, (w, zeta)) in found.zeros.iter().zip(truth) {
        let omega = zero.omega_rad_s;
        errors.push((omega.value / w - 1.0, omega.std / w));
        errors.push((zero.damping.value / zeta - 1.0, zero.damping.std / zeta));
    }
    let inertia = found.inertia.unwrap();
    errors.push((inertia.value * axis.gain - 1.0, inertia.std * axis.gain));
    errors
}

#[test]
fn samples_are_those_of_scipy() {
    let pair = |omega_rad_s, damping| Factor::Pair {
        omega_rad_s,
        damping,
    };
    let axis = TransferFunction {
        gain: 50.0,
        zeros: vec![
            pair(280.0, 0.02),
            Factor::Real {
                time_constant_s: 1.0 / 20000.0,
            },
        ],
        poles: vec![pair(310.0, 0.03), pair(800.0, 0.04)],
        delay_s: 0.0,
    };
    let step = vec![1.0; 200];
    let out = simulate(&axis, Measured::Direct, PERIOD_S, &step).unwrap();
    // tests/identify/reference.py
    let reference = [
        (0, 0.0),
        (1, 19.820_286_568),
        (2, 62.107_160_341),
        (3, 99.467_013_545),
        (10, 44.628_858_903),
        (50, 49.977_521_353),
        (199, 51.032_742_451),
    ];
    for (k, expected) in reference {
        let apart = (out[k] - expected).abs();
        assert!(
            apart < 1e-9 * expected.abs().max(1.0),
            "{k}: {} {expected}",
            out[k]
        );
    }
    // Two periods and a half later the same, between the samples.
    let late = TransferFunction {
        delay_s: 2.0 * PERIOD_S,
        ..axis
    };
    let late = simulate(&late, Measured::Direct, PERIOD_S, &step).unwrap();
    assert!((late[12] - out[10]).abs() < 1e-9);
    assert_eq!(late[1], 0.0);
}

#[test]
fn an_anti_resonance_is_found_with_honest_errors() {
    let axis = one_side();
    for seed in 0..3 {
        let found = found(&axis, 4.0, 0.05, seed);
        for (index, (error, std)) in errors(&axis, &found).into_iter().enumerate() {
            assert!(
                error.abs() < 4.0 * std,
                "seed {seed}, {index}: {error} ± {std}"
            );
        }
        assert_eq!(judgement::flexible(&found), Judgement::Good);
        assert!((found.rel_error - 0.05).abs() < 0.01);
    }
}

#[test]
fn a_chain_of_two_masses_has_no_anti_resonance() {
    for (stiff, masses) in [(120.0, [0.006, 0.01]), (60.0, [0.01, 0.003])] {
        let axis = branched(masses[0], masses[1], spring(0.004, stiff, 0.03), &[]);
        for seed in 0..5 {
            let found = found(&axis, 4.0, 0.05, seed);
            assert!(found.zeros.is_empty(), "{:?}", found.transfer);
            assert_eq!(found.poles.len(), 1);
        }
    }
}

#[test]
fn two_anti_resonances_are_told_apart() {
    let axis = two_sides();
    let found = found(&axis, 4.0, 0.05, 1);
    for (error, std) in errors(&axis, &found) {
        assert!(error.abs() < 4.0 * std, "{error} ± {std}");
    }
}

#[test]
fn delay_and_rigid_axis_are_found() {
    let late = TransferFunction {
        delay_s: 3.0 * PERIOD_S,
        ..one_side()
    };
    let result = found(&late, 4.0, 0.05, 2);
    assert!(
        (result.delay_s.value - 3e-3).abs() < 1e-4,
        "{:?}",
        result.delay_s
    );
    for (error, std) in errors(&late, &result) {
        assert!(error.abs() < 4.0 * std, "{error} ± {std}");
    }
    let rigid = found(&TransferFunction::constant(50.0), 4.0, 0.05, 3);
    assert!(rigid.zeros.is_empty() && rigid.poles.is_empty());
    assert!((rigid.inertia.unwrap().value - 0.02).abs() < 1e-4);
}

/// A speed under a torque: its differences are modelled as what they are.
#[test]
fn a_torque_with_a_speed_tells_the_axis() {
    let axis = one_side();
    let torque = random(8000, 45.0);
    let mut random = Random(11);
    let mut sum = 0.0;
    let speed: Vec<f64> = simulate(&axis, Measured::Velocity, PERIOD_S, &torque)
        .unwrap()
        .iter()
        .map(|difference| {
            sum += difference * PERIOD_S;
            sum + 1e-5 * random.normal()
        })
        .collect();
    let table = table(&["torque_nm", "velocity_rad_s"], &[&torque, &speed]);
    let found = flexible::identify(&table, &choice(Method::Iv)).unwrap();
    let errors = errors(&axis, &found);
    assert!(errors[0].0.abs() < 1e-3, "{errors:?}");
    assert!(errors[2].0.abs() < 1e-2, "{errors:?}");
}

#[test]
fn without_noise_every_method_is_exact_or_near() {
    let axis = one_side();
    let recording = recording(&axis, 4.0, 0.0, 0);
    // Whole periods, of which the first swings in.
    let one = m_sequence(1023);
    let torque: Vec<f64> = one.iter().copied().cycle().take(6 * 1023).collect();
    let accel = simulate(&axis, Measured::Direct, PERIOD_S, &torque).unwrap();
    let repeated = table(&["torque_nm", "accel_rad_s2"], &[&torque, &accel]);
    let (w, zeta) = axis.anti_resonances().next().unwrap();
    for (method, near) in [
        (Method::Iv, 1e-6),
        (Method::Arx, 1e-4),
        (Method::Subspace, 1e-2),
        (Method::Frequency, 1e-2),
    ] {
        let mut choice = choice(method);
        choice.given.order = (method != Method::Iv).then_some(4);
        let recording = match method {
            Method::Frequency => &repeated,
            _ => &recording,
        };
        let found = flexible::identify(recording, &choice).unwrap();
        let zero = found
            .zeros
            .iter()
            .min_by_key(|zero| (1e6 * (zero.omega_rad_s.value / w - 1.0).abs()) as u64)
            .unwrap();
        let error = (zero.omega_rad_s.value / w - 1.0).abs();
        assert!(error < near, "{method:?}: {error}");
        let error = (zero.damping.value / zeta - 1.0).abs();
        assert!(error < 20.0 * near, "{method:?}: {error}");
    }
}

/// Torque of a closed loop: the excitation, and a controller that sees the
/// noise.
#[test]
fn in_a_closed_loop_the_excitation_is_the_instrument() {
    // A rigid axis with one lag; speed controller on the noisy acceleration's sum.
    let excitation = m_sequence(8000);
    let mut random = Random(5);
    let (mut speed, mut measured_speed) = (0.0, 0.0);
    let (mut torques, mut accels) = (Vec::new(), Vec::new());
    for r in &excitation {
        let torque = r - 1.5 * measured_speed;
        let accel: f64 = 50.0 * torque;
        let noisy = accel + 25.0 * random.normal();
        speed += accel * PERIOD_S;
        measured_speed = speed + 0.01 * (noisy - accel);
        torques.push(torque);
        accels.push(noisy);
    }
    let table = table(
        &["excitation_nm", "torque_nm", "accel_rad_s2"],
        &[&excitation, &torques, &accels],
    );
    let found = flexible::identify(&table, &choice(Method::Iv)).unwrap();
    let inertia = found.inertia.unwrap();
    let error = inertia.value - 0.02;
    assert!(error.abs() < 4.0 * inertia.std, "{error} ± {}", inertia.std);
    assert!(inertia.std < 2e-4);
}

/// The published axis: force in N from the drive's voltage by the published constant.
pub(crate) fn emps() -> Option<Recording> {
    let path = shared("measured/emps/DATA_EMPS.csv", "the recordings of others")?;
    let mut text = "time_s,force_n,position_m\n".to_owned();
    for line in std::fs::read_to_string(path).unwrap().lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.trim().parse().unwrap()).collect();
        writeln!(text, "{},{},{}", row[0], row[3] * 35.150_651_88, row[2]).unwrap();
    }
    Some(Recording::read(text.as_bytes(), None).unwrap())
}
