//! Curves of force over speed in part programs: hand-worked, and never exceeded.

mod ahead;
mod smooth;

use crate::rig::{any_arc, any_delta, any_machine, arc, axis, machine, sample, straight};
use gwatt::interpret::Move;
use gwatt::machine::{ALL_AXES, ArcRule, Axis, ForcePoint, Machine, RapidPath};
use gwatt::plan::lookahead::{Element, Joint};
use gwatt::plan::{Overrides, Plan, Profile, Trajectory, plan};
use gwatt::power::{PowerModel, Want};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

use crate::near::assert_near;

#[track_caller]
fn close(found: f64, expected: f64) {
    assert_near(found, expected, 1e-9 * expected.abs().max(1e-3));
}

fn curve(points: &[(f64, f64)]) -> Vec<ForcePoint> {
    let point = |&(speed_mm_s, force_n): &(f64, f64)| ForcePoint {
        speed_mm_s,
        force_n,
    };
    points.iter().map(point).collect()
}

fn profile(plan: &Plan) -> &Profile {
    match &plan.trajectory {
        Trajectory::Path(profile) => profile,
        _ => panic!("a path"),
    }
}

/// 100 kg and 100 N of friction; 500 N up to 300 mm/s, 300 N at 500 mm/s.
fn driven() -> Machine {
    let mut machine = machine(&[Axis {
        coulomb_n: 100.0,
        ..axis()
    }]);
    let points = curve(&[(0.0, 500.0), (300.0, 500.0), (500.0, 300.0)]);
    machine.force_curves = vec![(ALL_AXES[0], points)];
    machine
}

/// Up: 4 m/s² to 300 mm/s, from there a = 7000 − 10·v, that is ln 2/10 s and
/// 70·ln 2 − 20 mm. Down: a = 9000 − 10·v to 400 mm/s, that is ln 1.25/10 s and
/// 90·ln 1.25 − 10 mm, then the axis' own 5 m/s².
#[test]
fn a_straight_move_follows_the_curve() {
    let machine = driven();
    let mv = straight(&machine, &[500.0], f64::INFINITY);
    let plan = plan(&machine, &mv, Overrides::default());
    let (ln2, ln125) = (libm::log(2.0), libm::log(1.25));
    let ramps_mm = 11.25 + 70.0 * ln2 - 20.0 + 90.0 * ln125 - 10.0 + 16.0;
    let ramps_s = 0.075 + 0.1 * ln2 + 0.1 * ln125 + 0.08;
    close(plan.duration_s, ramps_s + (500.0 - ramps_mm) / 500.0);
    assert_eq!(profile(&plan).phases.len(), 5);
    // What the limits say, not the curve: it does not depend on the speed.
    close(plan.accel_mm_s2, 5000.0);
    // Driving at all of its force: the largest power is at 400 N·0.4 m/s or so,
    // v·(800 − v) for v from 300 to 500.
    let found = PowerModel::new(&machine).demand(&mv, &plan, Want::PEAKS);
    close(found.peak_w, 160.0);
}

#[test]
fn an_axis_alone_follows_its_own_curve() {
    let mut machine = driven();
    let along = plan(
        &machine,
        &straight(&machine, &[-500.0], f64::INFINITY),
        Overrides::default(),
    );
    machine.path.rapid = RapidPath::Independent;
    let alone = plan(
        &machine,
        &straight(&machine, &[-500.0], f64::INFINITY),
        Overrides::default(),
    );
    close(alone.duration_s, along.duration_s);
}

/// Under look-ahead times are those of the lowest acceleration up to the speed: at
/// 400 mm/s 400 N, of which 300 N are left.
#[test]
fn the_lowest_acceleration_is_certain() {
    let machine = driven();
    let mv = straight(&machine, &[500.0], 400.0);
    let element = Element::of(&machine, &mv, Overrides::default(), Joint::Exact, ());
    close(element.unwrap().drive_accel_mm_s2, 3000.0);
}

/// X has 400 N for 100 kg up to 300 mm/s, less than the axis' own 5 m/s². An arc at
/// 200 mm/s gets 1/√2 of that for speeding up, and one that may turn at 400 mm/s in
/// spite of the 300 N that are left there is held below that.
#[test]
fn arcs_follow_the_curves_of_their_speed() {
    let mut two = machine(&[
        Axis {
            coulomb_n: 100.0,
            ..axis()
        },
        axis(),
    ]);
    two.force_curves = driven().force_curves;
    let slow = arc(&two, [0, 1], 50.0, [0.0, 3.0], 0.0, 100.0);
    let found = plan(&two, &slow, Overrides::default());
    close(found.accel_mm_s2, 5000.0 / 2.0_f64.sqrt());
    close(
        profile(&found).phases[0].accel_mm_s2,
        4000.0 / 2.0_f64.sqrt(),
    );
    // (v/1 m/s)² = 0.05 m·(7000 − 10·v) mm/s²/√2 beyond 300 mm/s.
    let fast = arc(&two, [0, 1], 50.0, [0.0, 3.0], 0.0, 1e4);
    let found = plan(&two, &fast, Overrides::default());
    let part = 50.0 / 2.0_f64.sqrt();
    let v = -5.0 * part + (25.0 * part * part + 7000.0 * part).sqrt();
    assert!(v > 300.0);
    close(found.speed_limit_mm_s, v);
}

/// Random curves over three axes, of which something is always left.
fn any_driven() -> impl Strategy<Value = Machine> {
    let points = prop::collection::vec((0.05..1.0_f64, 0.05..3.0_f64), 1..7);
    (any_machine(), [points.clone(), points.clone(), points]).prop_map(|(mut machine, curves)| {
        for (i, points) in curves.into_iter().enumerate() {
            let Some(axis) = machine.axes[i] else {
                continue;
            };
            let mut speed = 0.0;
            let mut list = Vec::new();
            for (step, share) in points {
                let friction = axis.coulomb_n + axis.viscous_n_s_m * speed * 1e-3;
                let accelerating = share * axis.mass_kg * axis.accel_mm_s2 * 1e-3;
                list.push((speed, friction + axis.gravity_n.abs() + accelerating));
                speed += step * axis.rapid_mm_s;
            }
            let last = axis.coulomb_n + axis.viscous_n_s_m * axis.rapid_mm_s * 9e-3;
            let some = 0.1 * axis.mass_kg * axis.accel_mm_s2 * 1e-3;
            list.push((
                speed.max(axis.rapid_mm_s),
                last + axis.gravity_n.abs() + some,
            ));
            machine.force_curves.push((ALL_AXES[i], curve(&list)));
        }
        machine
    })
}

fn force_at(points: &[ForcePoint], speed: f64) -> f64 {
    for pair in points.windows(2) {
        if speed <= pair[1].speed_mm_s {
            let share = (speed - pair[0].speed_mm_s) / (pair[1].speed_mm_s - pair[0].speed_mm_s);
            return pair[0].force_n + share * (pair[1].force_n - pair[0].force_n);
        }
    }
    points[points.len() - 1].force_n
}

/// No drive gives more force than it has, and no axis exceeds its acceleration.
fn holds(machine: &Machine, mv: &Move, plan: &Plan) -> Result<(), TestCaseError> {
    let profile = profile(plan);
    for phase in &profile.phases {
        for i in 0..=40 {
            let t = phase.duration_s * f64::from(i) / 40.0;
            let state = phase.state_at(t);
            for (n, points) in &machine.force_curves {
                let Some(axis) = machine.axes[*n as usize] else {
                    panic!("an axis")
                };
                let u = mv.end[*n as usize] / mv.length_mm;
                let (v, a) = (u * state.velocity_mm_s, u * state.accel_mm_s2);
                prop_assert!(a.abs() <= axis.accel_mm_s2 * (1.0 + 1e-9));
                let force = axis.mass_kg * a * 1e-3
                    + (axis.coulomb_n + axis.viscous_n_s_m * v.abs() * 1e-3) * u.signum()
                    + axis.gravity_n;
                let most = force_at(points, v.abs());
                prop_assert!(
                    u == 0.0 || force.abs() <= most * (1.0 + 1e-9),
                    "{force} {most}"
                );
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_drive_gives_more_than_it_has(machine in any_driven(), delta in any_delta()) {
        let mv = straight(&machine, &delta, f64::INFINITY);
        let plan = plan(&machine, &mv, Overrides::default());
        holds(&machine, &mv, &plan)?;
        let profile = profile(&plan);
        prop_assert!((profile.length_mm() / mv.length_mm - 1.0).abs() < 1e-9);
        let found = PowerModel::new(&machine).demand(&mv, &plan, Want::ALL);
        // Few samples miss where power begins to be fed back.
        let sampled = sample(&machine, &mv, &plan, 2000);
        let scale = sampled.peak_w.max(sampled.regen_w);
        prop_assert!(found.peak_w >= sampled.peak_w - 1e-9 * scale);
        prop_assert!(found.regen_w >= sampled.regen_w - 1e-9 * scale);
        let size = found.energy_j.abs() + sampled.peak_w * plan.duration_s;
        prop_assert!((found.energy_j - sampled.energy_j).abs() <= 1e-6 * size);
    }

    /// Following the curve is no slower than its lowest acceleration.
    #[test]
    fn following_is_faster_than_the_lowest(machine in any_driven(), delta in any_delta()) {
        let mv = straight(&machine, &delta, f64::INFINITY);
        let plan = plan(&machine, &mv, Overrides::default());
        let v = plan.speed_limit_mm_s;
        let lowest = gwatt::plan::driven_accel(&machine, &mv, v).min(plan.accel_mm_s2);
        let trapezoid = Profile::trapezoid(mv.length_mm, v, lowest);
        let jerky = mv.moving.iter().any(|n| {
            machine.axes[n].is_some_and(|axis| axis.jerk_mm_s3 > 0.0)
        });
        prop_assert!(jerky || plan.duration_s <= trapezoid.duration_s() * (1.0 + 1e-9));
    }

    #[test]
    fn arcs_stay_within_the_curves_too(machine in any_driven(), shape in any_arc()) {
        let (plane, radius, angles, lift, feed) = shape;
        // LinuxCNC asks more of steep helices, whatever the drives have.
        let flat = machine.controller.planner.arc_rule == ArcRule::LinuxCnc;
        let lift = if flat { 0.0 } else { lift };
        let mv = arc(&machine, plane, radius, angles, lift, feed);
        let plan = plan(&machine, &mv, Overrides::default());
        let turn = angles[1] / mv.length_mm;
        for i in 0..200 {
            let t = plan.duration_s * f64::from(i) / 200.0;
            let Some(state) = profile(&plan).state_at(t) else { panic!("phases") };
            let (sin, cos) = libm::sincos(angles[0] + turn * state.position_mm);
            let (w, alpha) = (turn * state.velocity_mm_s, turn * state.accel_mm_s2);
            let motion = [
                (-sin * w, -sin * alpha - cos * w * w),
                (cos * w, cos * alpha - sin * w * w),
            ];
            for (n, (v, a)) in plane.into_iter().zip(motion) {
                let (v, a) = (v * radius, a * radius);
                let Some(axis) = machine.axes[n] else { panic!("an axis") };
                let friction = axis.coulomb_n + axis.viscous_n_s_m * v.abs() * 1e-3;
                let force = axis.mass_kg * a * 1e-3 + friction * v.signum() + axis.gravity_n;
                let most = force_at(&machine.force_curves[n].1, v.abs());
                prop_assert!(force.abs() <= most * (1.0 + 1e-9), "{force} {most}");
            }
        }
    }
}
