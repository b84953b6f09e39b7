//! Plans keep every limit, cover the path, and agree with hand-worked cases.

use crate::rig::{any_arc, any_delta, any_feed, any_machine, arc, axis, dwell, machine, straight};
use gwatt::interpret::Move;
use gwatt::machine::{ArcRule, Axis, AxisKind, AxisSet, Machine, RapidPath};
use gwatt::plan::jerk::{JerkLimits, State, position_target};
use gwatt::plan::{Caps, Overrides, Plan, Profile, Trajectory, plan, plan_with, speed_bound};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::near::assert_near;

fn planned(machine: &Machine, mv: &Move) -> Plan {
    plan(machine, mv, Overrides::default())
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert_near(found, expected, 1e-12 * expected.abs().max(1.0));
}

#[test]
fn a_trapezoid_takes_length_over_speed_plus_a_ramp() {
    let machine = machine(&[axis()]);
    let plan = planned(&machine, &straight(&machine, &[500.0], f64::INFINITY));
    close(plan.duration_s, 500.0 / 500.0 + 500.0 / 5000.0);
    close(plan.top_speed_mm_s, 500.0);
    close(plan.accel_mm_s2, 5000.0);
}

#[test]
fn a_triangle_never_reaches_the_speed() {
    let machine = machine(&[axis()]);
    let plan = planned(&machine, &straight(&machine, &[-8.0], f64::INFINITY));
    close(plan.top_speed_mm_s, 200.0);
    close(plan.duration_s, 0.08);
    close(plan.speed_limit_mm_s, 500.0);
}

#[test]
fn the_slowest_axis_limits_a_diagonal() {
    let slow = Axis {
        rapid_mm_s: 100.0,
        accel_mm_s2: 800.0,
        ..axis()
    };
    let machine = machine(&[axis(), slow]);
    let plan = planned(
        &machine,
        &straight(&machine, &[300.0, 400.0], f64::INFINITY),
    );
    close(plan.speed_limit_mm_s, 125.0);
    close(plan.accel_mm_s2, 1000.0);
}

#[test]
fn a_rotary_axis_that_follows_limits_the_path() {
    let rotary = Axis {
        kind: AxisKind::Rotary,
        rapid_mm_s: 300.0,
        accel_mm_s2: 1150.0,
        si_per_unit: PI / 180.0,
        ..axis()
    };
    let machine = machine(&[axis(), rotary]);
    let mut mv = straight(&machine, &[10.0, 90.0], 100.0);
    mv.length_mm = 10.0; // F speaks for the linear axis
    let plan = planned(&machine, &mv);
    close(plan.speed_limit_mm_s, 300.0 / 9.0);
    close(plan.accel_mm_s2, 1150.0 / 9.0);
}

#[test]
fn overrides_and_caps() {
    let machine = machine(&[axis()]);
    let half = Overrides {
        feed: 0.5,
        rapid: 0.25,
        spindle: 1.0,
    };
    let feed = straight(&machine, &[500.0], 100.0);
    close(plan(&machine, &feed, half).speed_limit_mm_s, 50.0);
    let rapid = straight(&machine, &[500.0], f64::INFINITY);
    close(plan(&machine, &rapid, half).speed_limit_mm_s, 125.0);
    let caps = Caps {
        speed_mm_s: 30.0,
        accel_factor: 0.1,
        ..Caps::default()
    };
    let plan = plan_with(&machine, &rapid, half, caps);
    close(plan.speed_limit_mm_s, 30.0);
    close(plan.accel_mm_s2, 500.0);
}

#[test]
fn nothing_moves_in_a_dwell_and_over_no_length() {
    let machine = machine(&[axis()]);
    let plan = planned(&machine, &dwell(&machine, 1.5));
    assert_eq!(plan.trajectory, Trajectory::Rest);
    assert_eq!(plan.duration_s, 1.5);
    assert_eq!(
        planned(&machine, &straight(&machine, &[], 10.0)).duration_s,
        0.0
    );
}

#[test]
fn an_override_of_zero_never_arrives() {
    let machine = machine(&[axis()]);
    let stop = Overrides {
        feed: 0.0,
        rapid: 0.0,
        spindle: 1.0,
    };
    let plan = plan(&machine, &straight(&machine, &[5.0], 10.0), stop);
    assert_eq!(plan.duration_s, f64::INFINITY);
}

#[test]
fn independent_axes_arrive_one_after_the_other() {
    let mut machine = machine(&[axis(), axis()]);
    machine.path.rapid = RapidPath::Independent;
    let plan = planned(&machine, &straight(&machine, &[500.0, -8.0], f64::INFINITY));
    let Trajectory::Axes(axes) = &plan.trajectory else {
        panic!("each axis has its own profile");
    };
    close(axes[0].1.duration_s(), 1.1);
    close(axes[1].1.duration_s(), 0.08);
    close(plan.duration_s, 1.1);
}

#[test]
fn the_shared_rule_gives_each_part_its_share() {
    let machine = machine(&[axis(), axis()]);
    let half_turn = arc(&machine, [0, 1], 10.0, [0.0, PI], 0.0, 1e6);
    let plan = planned(&machine, &half_turn);
    let share = 5000.0 / 2.0_f64.sqrt();
    close(plan.accel_mm_s2, share);
    close(plan.speed_limit_mm_s, (share * 10.0).sqrt());
}

#[test]
fn a_helix_sees_only_its_share_of_the_plane() {
    let machine = machine(&[axis(), axis(), axis()]);
    let helix = arc(&machine, [0, 1], 10.0, [0.0, 2.0 * PI], 20.0 * PI, 1e6);
    let plan = planned(&machine, &helix);
    let share = 5000.0 / 2.0_f64.sqrt();
    close(plan.speed_limit_mm_s, (2.0 * share * 10.0).sqrt());
}

#[test]
fn linuxcnc_turns_with_most_of_the_acceleration() {
    let mut machine = machine(&[axis(), axis()]);
    machine.controller.planner.arc_rule = ArcRule::LinuxCnc;
    let plan = planned(
        &machine,
        &arc(&machine, [0, 1], 10.0, [0.0, 6.0], 0.0, 50.0),
    );
    close(plan.speed_limit_mm_s, 50.0);
    close(plan.accel_mm_s2, 2500.0); // whatever F asks for
    let plan = planned(&machine, &arc(&machine, [0, 1], 10.0, [0.0, 6.0], 0.0, 1e6));
    close(
        plan.speed_limit_mm_s,
        (0.75_f64.sqrt() * 5000.0 * 10.0).sqrt(),
    );
}

#[test]
fn an_arc_is_limited_by_the_directions_that_it_meets() {
    let slow = Axis {
        rapid_mm_s: 20.0,
        ..axis()
    };
    let machine = machine(&[slow, axis()]);
    // Around θ = 0 the path runs along Y; X sees at most sin 0.1 of it.
    let short = arc(&machine, [0, 1], 1000.0, [-0.1, 0.2], 0.0, 1e6);
    close(
        planned(&machine, &short).speed_limit_mm_s,
        20.0 / libm::sin(0.1),
    );
    let across = arc(&machine, [0, 1], 1000.0, [FRAC_PI_2 - 0.1, 0.2], 0.0, 1e6);
    close(planned(&machine, &across).speed_limit_mm_s, 20.0);
}

#[test]
fn an_unknown_start_is_bounded_in_both_directions() {
    let machine = machine(&[axis(), axis()]);
    let mut mv = straight(&machine, &[10.0], 100.0);
    mv.unknown_start = AxisSet(2);
    let bound = speed_bound(&machine, &mv, Overrides::default(), Caps::default());
    assert_eq!(bound.positive[..2], [100.0, 100.0]);
    assert_eq!(bound.negative[..2], [100.0, 100.0]);
    assert!(matches!(
        planned(&machine, &mv).trajectory,
        Trajectory::Unknown(_)
    ));
}

#[test]
fn extreme_numbers_end() {
    let jerky = |jerk_mm_s3| Axis {
        jerk_mm_s3,
        ..axis()
    };
    let axes = [0.0, 1e-300, 5e4, 1e300].map(jerky);
    for machine in axes.map(|axis| machine(&[axis, axis, axis])) {
        for length in [1e-300, 1e-160, 1e-9, 1e9, 1e160, 1e300] {
            for feed in [1e-300, 1.0, 1e300, f64::INFINITY] {
                let plan = planned(&machine, &straight(&machine, &[length], feed));
                assert!(plan.duration_s >= 0.0);
                let turn = arc(&machine, [0, 1], length, [0.0, 3.0], 1.0, feed.min(1e300));
                assert!(planned(&machine, &turn).duration_s >= 0.0);
            }
        }
    }
}

/// The jerk of a profile at an instant.
fn jerk_at(profile: &Profile, t: f64) -> f64 {
    let mut end = 0.0;
    let phase = profile.phases.iter().find(|phase| {
        end += phase.duration_s;
        t < end
    });
    phase.map_or(0.0, |phase| phase.jerk_at(1.0, 0.0))
}

/// Speed and acceleration do not jump, begin and end at 0, and keep a limit.
fn runs_smoothly(profile: &Profile, accel: f64) -> Result<(), TestCaseError> {
    let (mut v, mut a) = (0.0, 0.0);
    let slack = 1e-9 * profile.top_speed_mm_s();
    for phase in &profile.phases {
        prop_assert!((phase.velocity_mm_s - v).abs() <= slack);
        prop_assert!((phase.accel_mm_s2 - a).abs() <= 1e-9 * accel);
        prop_assert!(phase.accel_mm_s2.abs() <= accel * (1.0 + 1e-12));
        let end = phase.state_at(phase.duration_s);
        (v, a) = (phase.end_velocity_mm_s, phase.end_accel_mm_s2());
        prop_assert!((end.velocity_mm_s - v).abs() <= slack);
    }
    prop_assert!(v == 0.0 && a.abs() <= 1e-9 * accel);
    Ok(())
}

/// 100 mm with 200 mm/s, 2 m/s² and 40 m/s³: ramps of 0.15 s over
/// 15 mm, 70 mm of cruise.
#[test]
fn a_jerk_limit_makes_an_s_curve() {
    let slow = Axis {
        rapid_mm_s: 200.0,
        accel_mm_s2: 2000.0,
        jerk_mm_s3: 40e3,
        ..axis()
    };
    let machine = machine(&[
        slow,
        Axis {
            jerk_mm_s3: 50e3,
            ..slow
        },
    ]);
    let plan = planned(&machine, &straight(&machine, &[100.0], f64::INFINITY));
    close(plan.duration_s, 0.65);
    close(plan.top_speed_mm_s, 200.0);
    // 3-4-5: X permits 40/0.6, Y 50/0.8, speeds and accelerations 1/0.8.
    let mv = straight(&machine, &[60.0, 80.0], f64::INFINITY);
    let Trajectory::Path(profile) = planned(&machine, &mv).trajectory else {
        panic!("a path")
    };
    close(profile.phases[0].jerk_at(1.0, 0.0), 62.5e3);
    close(profile.phases[1].accel_mm_s2, 2500.0);
    // Independent: each for itself.
    let mut machine = machine;
    machine.path.rapid = RapidPath::Independent;
    let Trajectory::Axes(axes) = planned(&machine, &mv).trajectory else {
        panic!("axes")
    };
    close(axes[0].1.duration_s(), 60.0 / 200.0 + 0.15);
    close(axes[1].1.duration_s(), 80.0 / 200.0 + 0.1 + 0.04);
}

/// Of J = 50 m/s³ J/√2 is along the tangent; turning takes half of it at
/// v³ = J·r²/(2·√2), and J/√2 = 3·a·v/r is left for the acceleration.
#[test]
fn an_arc_shares_the_jerk() {
    let jerky = Axis {
        jerk_mm_s3: 50e3,
        ..axis()
    };
    let machine = machine(&[jerky, axis()]);
    let plan = planned(&machine, &arc(&machine, [0, 1], 5.0, [0.0, 3.0], 0.0, 1e6));
    let part = 50e3 / 2.0_f64.sqrt();
    let v = libm::cbrt(0.5 * part * 25.0);
    close(plan.speed_limit_mm_s, v);
    close(plan.accel_mm_s2, part * 5.0 / (3.0 * v));
    let Trajectory::Path(profile) = &plan.trajectory else {
        panic!("a path")
    };
    close(profile.phases[0].jerk_at(1.0, 0.0), 0.5 * part);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn straight_plans_keep_all_limits(
        machine in any_machine(), delta in any_delta(), feed in any_feed(),
    ) {
        let mv = straight(&machine, &delta, feed);
        let plan = planned(&machine, &mv);
        let Trajectory::Path(profile) = &plan.trajectory else { panic!("a path") };
        prop_assert!((profile.length_mm() / mv.length_mm - 1.0).abs() < 1e-12);
        prop_assert!(plan.top_speed_mm_s <= feed);
        let (v, a, l) = (plan.speed_limit_mm_s, plan.accel_mm_s2, mv.length_mm);
        let trapezoid = if v * v < a * l { l / v + v / a } else { 2.0 * (l / a).sqrt() };
        prop_assert!(plan.duration_s >= trapezoid * (1.0 - 1e-12));
        let mut limited = false;
        for (i, axis) in machine.axes.iter().flatten().enumerate() {
            let u = (mv.end[i] / mv.length_mm).abs();
            prop_assert!(plan.top_speed_mm_s * u <= axis.rapid_mm_s * (1.0 + 1e-12));
            prop_assert!(plan.accel_mm_s2 * u <= axis.accel_mm_s2 * (1.0 + 1e-12));
            if axis.jerk_mm_s3 > 0.0 && u > 0.0 {
                limited = true;
                let jerks = profile.phases.iter().map(|phase| phase.jerk_at(1.0, 0.0).abs());
                let jerk = u * jerks.fold(0.0, f64::max);
                prop_assert!(jerk <= axis.jerk_mm_s3 * (1.0 + 1e-12));
            }
        }
        prop_assert!(limited || plan.duration_s <= trapezoid * (1.0 + 1e-12));
        if limited {
            runs_smoothly(profile, plan.accel_mm_s2)?;
            // No other profile under the same limits is faster.
            let jerk = profile.phases[0].jerk_at(1.0, 0.0);
            let limits = JerkLimits::symmetric(v, a, jerk);
            let end = State { position_mm: l, ..State::default() };
            let best = position_target(State::default(), end, &limits).expect("a profile");
            prop_assert!((plan.duration_s / best.duration_s() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn independent_plans_keep_all_limits(machine in any_machine(), delta in any_delta()) {
        let mut machine = machine;
        machine.path.rapid = RapidPath::Independent;
        let plan = planned(&machine, &straight(&machine, &delta, f64::INFINITY));
        let Trajectory::Axes(axes) = &plan.trajectory else { panic!("axes") };
        for (index, profile) in axes {
            let Some(axis) = machine.axes[*index] else { panic!("an axis") };
            prop_assert!((profile.length_mm() / delta[*index].abs() - 1.0).abs() < 1e-9);
            prop_assert!(profile.top_speed_mm_s() <= axis.rapid_mm_s);
            if axis.jerk_mm_s3 > 0.0 {
                runs_smoothly(profile, axis.accel_mm_s2)?;
                let jerks = profile.phases.iter().map(|phase| phase.jerk_at(1.0, 0.0).abs());
                prop_assert_eq!(jerks.fold(0.0, f64::max), axis.jerk_mm_s3);
            }
        }
    }

    #[test]
    fn arc_plans_keep_all_limits(machine in any_machine(), shape in any_arc()) {
        let (plane, radius, angles, lift, feed) = shape;
        let mv = arc(&machine, plane, radius, angles, lift, feed);
        let plan = planned(&machine, &mv);
        let Trajectory::Path(profile) = &plan.trajectory else { panic!("a path") };
        prop_assert!((profile.length_mm() / mv.length_mm - 1.0).abs() < 1e-9);
        let bound = speed_bound(&machine, &mv, Overrides::default(), Caps::default());
        let turn = angles[1] / mv.length_mm;
        for i in 0..400 {
            let t = plan.duration_s * f64::from(i) / 400.0;
            let Some(state) = profile.state_at(t) else { panic!("phases") };
            let (sin, cos) = libm::sincos(angles[0] + turn * state.position_mm);
            let w = turn * state.velocity_mm_s;
            let alpha = turn * state.accel_mm_s2;
            let rate = turn * jerk_at(profile, t);
            let (along, across) = (rate - w * w * w, 3.0 * w * alpha);
            let motion = [
                (-sin * w, -sin * alpha - cos * w * w, -sin * along - cos * across),
                (cos * w, cos * alpha - sin * w * w, cos * along - sin * across),
            ];
            for (n, (v, a, jerk)) in plane.into_iter().zip(motion) {
                let (v, a) = (v * radius, a * radius);
                let Some(axis) = machine.axes[n] else { panic!("an axis") };
                prop_assert!(v.abs() <= axis.rapid_mm_s * (1.0 + 1e-9));
                prop_assert!(a.abs() <= axis.accel_mm_s2 * (1.0 + bound.excess + 1e-9));
                if axis.jerk_mm_s3 > 0.0 {
                    let jerk = jerk * radius;
                    prop_assert!(jerk.abs() <= axis.jerk_mm_s3 * (1.0 + 1e-9), "{jerk}");
                }
                prop_assert!(v <= bound.positive[n] * (1.0 + 1e-9) + 1e-9);
                prop_assert!(-v <= bound.negative[n] * (1.0 + 1e-9) + 1e-9);
            }
        }
    }
}
