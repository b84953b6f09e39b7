//! Constant torque, constant power and curves given as points.

use gwatt::plan::curve::{AccelCurve, CurveError, fastest};
use gwatt::plan::{Phase, PhaseKind, Profile};

use crate::near::assert_near;

/// Integrates `dv/dt = a(v)` by the classical Runge–Kutta rule: time and length
/// from `v0` until `v1`, with speed as the variable.
fn by_steps(accel: impl Fn(f64) -> f64, v0: f64, v1: f64) -> (f64, f64) {
    const STEPS: u32 = 20_000;
    let h = (v1 - v0) / f64::from(STEPS);
    let (mut t, mut x) = (0.0, 0.0);
    for i in 0..STEPS {
        let v = v0 + h * f64::from(i);
        let [a, b, c] = [v, v + 0.5 * h, v + h].map(|v| 1.0 / accel(v));
        t += h / 6.0 * (a + 4.0 * b + c);
        x += h / 6.0 * (v * a + 4.0 * (v + 0.5 * h) * b + (v + h) * c);
    }
    (t, x)
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert_near(found, expected, 1e-11 * expected.abs().max(1e-3));
}

/// States inside a phase fit each other and both ends.
fn is_smooth(phase: &Phase) {
    let at = |x: f64| phase.state_at(x * phase.duration_s);
    close(at(0.0).velocity_mm_s, phase.velocity_mm_s);
    close(at(1.0).velocity_mm_s, phase.end_velocity_mm_s);
    close(at(1.0).position_mm - phase.position_mm, phase.length_mm());
    close(at(1.0).accel_mm_s2, phase.end_accel_mm_s2());
    for i in 1..20 {
        let x = f64::from(i) / 20.0;
        let step = 1e-4;
        let (before, here, after) = (at(x - step), at(x), at(x + step));
        let dt = 2.0 * step * phase.duration_s;
        let speed = (after.position_mm - before.position_mm) / dt;
        let accel = (after.velocity_mm_s - before.velocity_mm_s) / dt;
        let jerk = (after.accel_mm_s2 - before.accel_mm_s2) / dt;
        assert!((speed / here.velocity_mm_s - 1.0).abs() < 1e-6);
        assert!((accel / here.accel_mm_s2 - 1.0).abs() < 1e-5);
        let expected = phase.jerk_at(here.velocity_mm_s, here.accel_mm_s2);
        assert!((jerk - expected).abs() <= 1e-5 * expected.abs() + 1e-6);
    }
}

#[test]
fn constant_power_agrees_with_integration() {
    // With much, little, no and helping drag.
    for drag in [2000.0, 300.0, 1.0, 0.0, -300.0, -1500.0] {
        let power = 1.5e6;
        let curve = AccelCurve::constant_power(5000.0, power, drag, 600.0).unwrap();
        let base = (power / (5000.0 + drag)).min(600.0);
        let phases = curve.speed_up(0.0, 600.0).unwrap();
        let last = phases.last().unwrap();
        close(last.velocity_mm_s, base);
        let (time, length) = by_steps(|v| power / v - drag, base, 600.0);
        close(last.duration_s, time);
        close(last.length_mm(), length);
        is_smooth(last);
        let braking = curve.slow_down(600.0, 0.0).unwrap();
        close(braking[0].duration_s, time);
        close(braking[0].length_mm(), length);
        is_smooth(&braking[0]);
    }
}

#[test]
fn drag_without_power_is_in_reach_of_the_base_speed_only() {
    assert_eq!(
        AccelCurve::constant_power(100.0, 1e4, 200.0, 60.0),
        Err(CurveError::Points)
    );
}

#[test]
fn the_deep_regime_has_the_constants_of_the_theory() {
    // Far more torque than power: T = c·(L²/p)^(1/3), c = (9/8)^(1/3) with free
    // braking and 1.3104 where braking has the same power.
    let (power, length) = (1e6, 400.0);
    let unit = libm::cbrt(length * length / power);
    let weak = AccelCurve::constant_power(1e9, power, 0.0, 1e4).unwrap();
    let free = AccelCurve::points(&[(1e4, 1e12)]).unwrap();
    let time = |down| fastest(length, 1e4, &weak, down).unwrap().duration_s() / unit;
    assert!((time(&free) - libm::cbrt(9.0 / 8.0)).abs() < 1e-4);
    assert!((time(&weak) - 1.3104).abs() < 1e-4);
}

/// Phases follow each other without a gap and make up the length.
fn is_whole(profile: &Profile, length: f64) {
    let (mut position, mut speed) = (0.0, 0.0);
    for phase in &profile.phases {
        close(phase.position_mm, position);
        close(phase.velocity_mm_s, speed);
        position += phase.length_mm();
        speed = phase.end_velocity_mm_s;
    }
    close(position, length);
    assert_eq!(speed, 0.0);
}

#[test]
fn a_profile_has_torque_power_cruise_power_and_torque() {
    let up = AccelCurve::constant_power(5000.0, 1e6, 200.0, 500.0).unwrap();
    let down = AccelCurve::constant_power(5000.0, 8e5, -200.0, 500.0).unwrap();
    let long = fastest(1000.0, 500.0, &up, &down).unwrap();
    let kinds: Vec<PhaseKind> = long.phases.iter().map(|phase| phase.kind).collect();
    assert_eq!(
        kinds,
        [
            PhaseKind::ConstantAcceleration,
            PhaseKind::ConstantPower { power_mm2_s3: 1e6 },
            PhaseKind::ConstantAcceleration,
            PhaseKind::ConstantPower { power_mm2_s3: -8e5 },
            PhaseKind::ConstantAcceleration,
        ]
    );
    is_whole(&long, 1000.0);
    // Between: the top is where both ramps meet.
    let middle = fastest(60.0, 500.0, &up, &down).unwrap();
    assert_eq!(middle.phases.len(), 4);
    is_whole(&middle, 60.0);
    // Short: torque alone.
    let short = fastest(2.0, 500.0, &up, &down).unwrap();
    assert_eq!(short.phases.len(), 2);
    is_whole(&short, 2.0);
    close(short.top_speed_mm_s(), 100.0);
}

#[test]
fn points_agree_with_integration() {
    let points = [
        (0.0, 4000.0),
        (100.0, 5000.0),
        (300.0, 5000.0),
        (600.0, 500.0),
    ];
    let curve = AccelCurve::points(&points).unwrap();
    assert_eq!(curve.accel_at(50.0), 4500.0);
    assert_eq!(curve.accel_at(450.0), 2750.0);
    let phases = curve.speed_up(40.0, 580.0).unwrap();
    assert_eq!(phases.len(), 3);
    for phase in &phases {
        let (v0, v1) = (phase.velocity_mm_s, phase.end_velocity_mm_s);
        let (time, length) = by_steps(|v| curve.accel_at(v), v0, v1);
        close(phase.duration_s, time);
        close(phase.length_mm(), length);
        is_smooth(phase);
    }
    for phase in &curve.slow_down(580.0, 40.0).unwrap() {
        is_smooth(phase);
    }
    is_whole(&fastest(400.0, 550.0, &curve, &curve).unwrap(), 400.0);
}

#[test]
fn what_is_no_curve_is_refused() {
    let points = |points: &[(f64, f64)]| AccelCurve::points(points).err();
    assert_eq!(points(&[]), Some(CurveError::Points));
    assert_eq!(points(&[(2.0, 1.0), (1.0, 1.0)]), Some(CurveError::Points));
    assert_eq!(points(&[(2.0, 0.0)]), Some(CurveError::Points));
    let many: Vec<(f64, f64)> = (1..20).map(|i| (f64::from(i), f64::from(i))).collect();
    let curve = AccelCurve::points(&many).unwrap();
    assert_eq!(curve.speed_up(0.0, 20.0), Err(CurveError::Range));
    is_whole(&fastest(1e3, 16.0, &curve, &curve).unwrap(), 1e3);
    assert_eq!(fastest(0.0, 16.0, &curve, &curve), Err(CurveError::Range));
}
