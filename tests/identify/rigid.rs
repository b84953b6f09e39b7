//! Rigid axes: mass and friction.

use std::f64::consts::TAU;

use gwatt::identify::merge::force_per_torque;
use gwatt::identify::rigid::{self, Friction};
use gwatt::identify::{Judgement, Recording, TransferFunction, judgement};

use super::{PERIOD_S, branched, emps, noisy_recording, random, sines, spring, table};
use crate::random::Random;

/// To and fro with friction; position with noise of an encoder.
fn rigid_table(noise: f64) -> Recording {
    let mut random = Random(9);
    let (mut force, mut position) = (Vec::new(), Vec::new());
    for k in 0..20_000 {
        let t = f64::from(k) * PERIOD_S;
        let [x, v, a] = sines(t, &[(0.05, 0.5), (0.02, 1.3), (0.004, 4.1)]);
        let friction = 25.0 * v.signum() + 300.0 * v;
        force.push(80.0 * a + friction - 6.0 + 5.0 * random.normal());
        position.push(x + noise * random.normal());
    }
    table(&["force_n", "position_m"], &[&force, &position])
}

#[test]
fn a_rigid_axis_is_found_with_its_friction() {
    let found = rigid::fit(&rigid_table(1e-6), Friction::Symmetric, None).unwrap();
    for (figure, truth) in [
        (found.mass, 80.0),
        (found.viscous.unwrap(), 300.0),
        (found.coulomb.unwrap(), 25.0),
        (found.offset.unwrap(), -6.0),
    ] {
        let error = figure.value - truth;
        assert!(
            error.abs() < 4.0 * figure.std + 0.005 * truth.abs(),
            "{figure:?} {truth}"
        );
        assert!(figure.std < 0.02 * truth.abs(), "{figure:?}");
    }
    assert_eq!(judgement::rigid(&found), Judgement::Good);
}

#[test]
fn the_published_axis_comes_out_as_published() {
    let Some(recording) = emps() else {
        return;
    };
    let found = rigid::fit(&recording, Friction::Symmetric, None).unwrap();
    assert!((found.mass.value - 95.109).abs() < 0.22, "{:?}", found.mass);
    assert!((found.viscous.unwrap().value - 203.50).abs() < 2.3);
    assert!((found.coulomb.unwrap().value - 20.394).abs() < 0.2);
    assert!(found.rel_error <= 0.041, "{}", found.rel_error);
    let found = rigid::fit(&recording, Friction::Directional, None).unwrap();
    assert!(found.rel_error <= 0.029, "{}", found.rel_error);
}

/// An axis that resonates is not good as a rigid one; noise alone is.
#[test]
fn an_axis_that_resonates_is_told_from_a_noisy_one() {
    let torque = random(8000, 45.0);
    let judge = |axis: &TransferFunction, noise: f64, seed: u64| {
        let recording = noisy_recording(axis, &torque, noise, seed);
        let found = rigid::fit(&recording, Friction::Symmetric, None).unwrap();
        (judgement::rigid(&found), found.rel_error)
    };
    // At 40 Hz the zero lies beyond the band, and a tenth is left.
    for (zero_hz, seed) in [(15.0, 0), (25.0, 1), (30.0, 2), (40.0, 3)] {
        let [k, c] = spring(0.008, zero_hz, 0.03);
        let axis = branched(0.006, 0.01, spring(0.0045, 150.0, 0.05), &[[0.008, k, c]]);
        for noise in [0.0, 0.05, 0.2] {
            let (verdict, _) = judge(&axis, noise, seed);
            assert_eq!(verdict, Judgement::NotRigid, "{zero_hz} Hz, noise {noise}");
        }
    }
    for seed in 0..50 {
        // White noise at 1 kHz: what the band leaves of it is a quarter.
        let (verdict, rel_error) = judge(&TransferFunction::constant(50.0), 0.8, seed);
        assert_eq!(verdict, Judgement::Good, "seed {seed}, {rel_error}");
        assert!(rel_error > 0.15, "{rel_error}");
        // A torque that is as noisy makes the ratio of both seem another one.
        let mut noise = Random(seed);
        let mut noisy = |u: &f64| u + 0.2 * noise.normal();
        let measured: Vec<f64> = torque.iter().map(&mut noisy).collect();
        let motion: Vec<f64> = torque.iter().map(|u| 50.0 * u).collect();
        let recording = table(&["torque_nm", "accel_rad_s2"], &[&measured, &motion]);
        let found = rigid::fit(&recording, Friction::Symmetric, None).unwrap();
        assert!(!found.resonates, "seed {seed}, {}", found.rel_error);
    }
}

/// 100 kg on a screw of 10 mm, recorded at the motor: F = 2π·i·M/lead and
/// x = φ·lead/(2π·i), whatever the form of the motion.
#[test]
fn what_a_motor_does_is_referred_to_the_slide() {
    const LEAD_MM: f64 = 10.0;
    for (name, order, si_per_unit, gear) in [
        ("position_deg", 0, TAU / 360.0, 1.0),
        ("position_rad", 0, 1.0, 2.0),
        ("position_rev", 0, TAU, 1.0),
        ("velocity_rpm", 1, TAU / 60.0, 1.0),
        ("velocity_rad_s", 1, 1.0, 2.5),
        ("velocity_deg_s", 1, TAU / 360.0, 1.0),
        // The slide itself: nothing but the torque is converted.
        ("position_mm", 0, TAU / LEAD_MM, 1.0),
    ] {
        // Radians of the motor per metre of the slide.
        let per_metre = TAU * gear / (LEAD_MM * 1e-3);
        let (mut torque, mut motion) = (Vec::new(), Vec::new());
        for k in 0..8_000 {
            let t = f64::from(k) * PERIOD_S;
            let sums = sines(t, &[(0.05, 0.5), (0.02, 1.3), (0.004, 4.1)]);
            let [_, v, a] = sums;
            let force = 100.0 * a + 300.0 * v + 25.0 * v.signum();
            torque.push(force / per_metre);
            motion.push(sums[order] * per_metre / si_per_unit);
        }
        let mut recording = table(&["torque_nm", name], &[&torque, &motion]);
        recording
            .refer_to_slide(force_per_torque(LEAD_MM, gear))
            .unwrap();
        let found = rigid::fit(&recording, Friction::Symmetric, None).unwrap();
        for (figure, truth) in [
            (found.mass, 100.0),
            (found.viscous.unwrap(), 300.0),
            (found.coulomb.unwrap(), 25.0),
        ] {
            let error = (figure.value - truth).abs();
            let bound = 4.0 * figure.std + 0.01 * truth;
            assert!(error < bound, "{name} {figure:?} {truth}");
            assert!(figure.std < 0.02 * truth, "{name} {figure:?}");
        }
    }
}

/// A load that turns is not driven by a screw.
#[test]
fn an_angle_of_the_load_does_not_go_with_a_lead() {
    let wave: Vec<f64> = (0..200).map(|k| libm::sin(0.1 * f64::from(k))).collect();
    let mut recording = table(&["torque_nm", "load_position_deg"], &[&wave, &wave]);
    let trouble = recording
        .refer_to_slide(force_per_torque(10.0, 1.0))
        .unwrap_err();
    assert_eq!(
        trouble.message,
        "load_position_deg turns, but the load of a screw slides"
    );
}
