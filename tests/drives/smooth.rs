//! Ramps under curves of force and limits of jerk.

use super::{close, curve, driven, holds, profile};
use crate::rig::{axis, machine, straight};
use gwatt::machine::{ALL_AXES, Axis, Machine};
use gwatt::plan::{Overrides, PhaseKind, Plan, plan};
use gwatt::power::{PowerModel, Want};
use proptest::prelude::*;

/// 100 kg without friction, 10 m/s² and 1 m/s, with a curve in N over mm/s.
fn free(points: &[(f64, f64)], jerk_mm_s3: f64) -> Machine {
    let mut machine = machine(&[Axis {
        accel_mm_s2: 1e4,
        rapid_mm_s: 1000.0,
        mass_kg: 100.0,
        jerk_mm_s3,
        ..axis()
    }]);
    machine.force_curves = vec![(ALL_AXES[0], curve(points))];
    machine
}

fn rapid(machine: &Machine) -> (Plan, f64) {
    let mv = straight(machine, &[2000.0], f64::INFINITY);
    let plan = plan(machine, &mv, Overrides::default());
    let found = PowerModel::new(machine).demand(&mv, &plan, Want::PEAKS);
    (plan, found.peak_w)
}

/// 1000 N to 0.5 m/s, falling to 100 N at 1 m/s: v·(1900 − 1800·v) is largest at
/// 0.5278 m/s, 1900²/7200 W.
#[test]
fn a_high_jerk_changes_nothing() {
    let points = [(0.0, 1000.0), (500.0, 1000.0), (1000.0, 100.0)];
    let (sharp, sharp_w) = rapid(&free(&points, 0.0));
    close(sharp_w, 1900.0 * 1900.0 / 7200.0);
    let (smooth, smooth_w) = rapid(&free(&points, 1e12));
    assert!(smooth_w <= sharp_w * (1.0 + 1e-9) && smooth_w > sharp_w * 0.9999);
    assert!(smooth.duration_s > sharp.duration_s);
    assert!(smooth.duration_s < sharp.duration_s * 1.0001);
}

/// 1000 N to 20000 mm/min, 600 N from 21000 to 40000, 300 N from 41000 to 60000: five
/// pieces on each side, and 600 N at 40000 mm/min are 400 W.
#[test]
fn a_curve_has_as_many_kinks_as_it_has() {
    let points = [
        (0.0, 1000.0),
        (20.0, 1000.0),
        (21.0, 600.0),
        (40.0, 600.0),
        (41.0, 300.0),
        (60.0, 300.0),
    ];
    let points = points.map(|(speed, force)| (speed * 1000.0 / 60.0, force));
    let (plan, peak_w) = rapid(&free(&points, 0.0));
    close(peak_w, 400.0);
    assert_eq!(profile(&plan).phases.len(), 11);
}

/// Constant power in thirty chords: 1000 N to 0.2 m/s, 200 W beyond it. A chord lies
/// above the power, nowhere by more than a half percent.
#[test]
fn constant_power_stays_constant() {
    let mut points = vec![(0.0, 1000.0)];
    points.extend((0..=30).map(|i| {
        let speed = 200.0 * libm::pow(5.0, f64::from(i) / 30.0);
        (speed, 2e5 / speed)
    }));
    for jerk_mm_s3 in [0.0, 1e9] {
        let (_, peak_w) = rapid(&free(&points, jerk_mm_s3));
        assert!((199.9..201.0).contains(&peak_w), "{peak_w}");
    }
}

/// 400 N for 100 kg and 100 N of friction up to 300 mm/s with 40 m/s³: up to 4 m/s² in
/// 0.1 s and 200 mm/s; then along the 4 m/s² to a place from where 40 m/s³ lead to 0 at
/// 400 mm/s, 200 mm/s below it: at once.
#[test]
fn a_ramp_may_end_before_it_meets_the_curve() {
    let mut machine = driven();
    if let Some(axis) = &mut machine.axes[0] {
        axis.jerk_mm_s3 = 40e3;
    }
    let mv = straight(&machine, &[500.0], 400.0);
    let plan = plan(&machine, &mv, Overrides::default());
    let up = &profile(&plan).phases[..2];
    assert!(
        up.iter()
            .all(|phase| matches!(phase.kind, PhaseKind::ConstantJerk { .. }))
    );
    close(up[0].duration_s, 0.1);
    close(up[1].duration_s, 0.1);
    close(up[1].accel_mm_s2, 4000.0);
}

/// The hardest acceleration at a speed: the minimum over all others, by brute force.
fn hardest(machine: &Machine, top: f64, jerk: f64, side: f64) -> Vec<f64> {
    let points = &machine.force_curves[0].1;
    // Kinks lie on steps.
    let pieces = points.len() - 1;
    let steps = pieces * (4000 / pieces);
    let axis = machine.axes[0].unwrap();
    let width = top / steps as f64;
    let square = |i: usize| {
        let v = width * i as f64;
        if i == 0 || i == steps {
            return 0.0;
        }
        let force = super::force_at(points, v) - side * (axis.coulomb_n + axis.gravity_n);
        let own = (force / axis.mass_kg * 1e3).min(axis.accel_mm_s2);
        own * own
    };
    let mut q: Vec<f64> = (0..=steps).map(square).collect();
    for i in 1..=steps {
        q[i] = q[i].min(q[i - 1] + 2.0 * jerk * width);
    }
    for i in (0..steps).rev() {
        q[i] = q[i].min(q[i + 1] + 2.0 * jerk * width);
    }
    q
}

/// ∫ dv/√q, q straight over a step: 2·Δv/(√q₀ + √q₁).
fn time(q: &[f64], top: f64) -> f64 {
    let width = top / (q.len() - 1) as f64;
    q.windows(2)
        .map(|pair| 2.0 * width / (pair[0].sqrt() + pair[1].sqrt()))
        .sum()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// As fast as any motion under the curve and the jerk, and nowhere beyond them.
    #[test]
    fn ramps_are_the_fastest(
        forces in prop::collection::vec(150.0..1500.0_f64, 2..30),
        jerk in 4.0..7.0_f64,
        coulomb_n in 0.0..50.0_f64,
        gravity_n in -50.0..50.0_f64,
    ) {
        let jerk = libm::pow(10.0, jerk);
        let last = forces.len() as f64 - 1.0;
        let points: Vec<(f64, f64)> = forces
            .iter()
            .enumerate()
            .map(|(i, force)| (1000.0 * i as f64 / last, *force))
            .collect();
        let mut machine = free(&points, jerk);
        if let Some(axis) = &mut machine.axes[0] {
            (axis.coulomb_n, axis.gravity_n) = (coulomb_n, gravity_n);
        }
        let mv = straight(&machine, &[2e5], f64::INFINITY);
        let plan = plan(&machine, &mv, Overrides::default());
        holds(&machine, &mv, &plan)?;
        let phases = &profile(&plan).phases;
        let cruise = phases.iter().position(gwatt::plan::Phase::is_cruise).unwrap();
        for (range, side) in [(0..cruise, 1.0), (cruise + 1..phases.len(), -1.0)] {
            let found: f64 = phases[range].iter().map(|phase| phase.duration_s).sum();
            let reference = time(&hardest(&machine, 1000.0, jerk, side), 1000.0);
            prop_assert!((found / reference - 1.0).abs() < 5e-3, "{found} {reference}");
        }
        let (mut v, mut a, mut x) = (0.0, 0.0_f64, 0.0);
        for phase in phases {
            prop_assert!((phase.velocity_mm_s - v).abs() < 1e-6);
            prop_assert!((phase.accel_mm_s2 - a).abs() < 1e-6 * a.abs().max(1e3), "{a} {phase:?}");
            prop_assert!((phase.position_mm - x).abs() < 1e-6 * mv.length_mm);
            let rate = phase.jerk_at(phase.velocity_mm_s, phase.accel_mm_s2).abs();
            prop_assert!(rate <= jerk * (1.0 + 1e-9), "{rate} {jerk}");
            let end = phase.state_at(phase.duration_s);
            (v, a, x) = (end.velocity_mm_s, end.accel_mm_s2, end.position_mm);
        }
        prop_assert!(v.abs() < 1e-6 && a.abs() < 1.0);
    }
}
