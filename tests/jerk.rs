//! Jerk-limited profiles end in their targets, keep every limit, and are as
//! fast as can be.

use gwatt::plan::jerk::{JerkError, JerkLimits, JerkProfile, State, speed_target};
use gwatt::plan::{Phase, PhaseKind};

/// Limits 10 mm/s, 4 mm/s², 2 mm/s³.
fn limits() -> JerkLimits {
    JerkLimits::symmetric(10.0, 4.0, 2.0)
}

fn state(position_mm: f64, velocity_mm_s: f64, accel_mm_s2: f64) -> State {
    State {
        position_mm,
        velocity_mm_s,
        accel_mm_s2,
    }
}

/// The jerks of the phases, and how long each lasts.
fn shape(profile: &JerkProfile) -> Vec<(f64, f64)> {
    let jerk = |phase: &Phase| match phase.kind {
        PhaseKind::ConstantJerk { jerk_mm_s3 } => jerk_mm_s3,
        other => panic!("{other:?}"),
    };
    let phases = profile.phases.iter();
    phases
        .map(|phase| (jerk(phase), phase.duration_s))
        .collect()
}

#[test]
fn a_small_step_of_speed_has_two_phases_and_a_large_one_three() {
    // The peak √(2·2) = 2 stays below 4.
    let small = speed_target(state(0.0, 0.0, 0.0), 2.0, 0.0, &limits()).unwrap();
    assert_eq!(shape(&small), [(2.0, 1.0), (-2.0, 1.0)]);
    // Up to 4 and back makes 8 mm/s; the rest of 2 takes half a second.
    let large = speed_target(state(0.0, 0.0, 0.0), 10.0, 0.0, &limits()).unwrap();
    assert_eq!(shape(&large), [(2.0, 2.0), (0.0, 0.5), (-2.0, 2.0)]);
    assert_eq!(large.end.velocity_mm_s, 10.0);
}

#[test]
fn a_reversal_is_decided_on_signed_quantities() {
    // At +2 mm/s² and 2 mm/s down to 0: taking the acceleration to 0 adds
    // 1 mm/s, and going down by 3 has its peak at −√6, inside the limit.
    let two = speed_target(state(0.0, 2.0, 2.0), 0.0, 0.0, &limits()).unwrap();
    let [(down, first), (up, second)] = shape(&two)[..] else {
        panic!("{two:?}");
    };
    assert_eq!((down, up), (-2.0, 2.0));
    assert!((first - (2.0 + 6.0_f64.sqrt()) / 2.0).abs() < 1e-14);
    assert!((second - 6.0_f64.sqrt() / 2.0).abs() < 1e-14);
    // From 10 mm/s the full reversal reaches −4 mm/s² and stays there.
    let three = speed_target(state(0.0, 9.0, 2.0), 0.0, 0.0, &limits()).unwrap();
    assert_eq!(shape(&three), [(-2.0, 3.0), (0.0, 0.5), (2.0, 2.0)]);
}

#[test]
fn taking_the_acceleration_away_is_one_phase() {
    let one = speed_target(state(0.0, 1.0, 2.0), 2.0, 0.0, &limits()).unwrap();
    assert_eq!(shape(&one), [(-2.0, 1.0)]);
    let none = speed_target(state(0.0, 1.0, 0.0), 1.0, 0.0, &limits()).unwrap();
    assert_eq!(none.phases.len(), 0);
    assert_eq!(none.state_at(5.0).velocity_mm_s, 1.0);
}

#[test]
fn acceleration_and_braking_may_differ() {
    let uneven = JerkLimits {
        min_accel_mm_s2: -1.0,
        ..limits()
    };
    let braking = speed_target(state(0.0, 2.0, 0.0), 0.0, 0.0, &uneven).unwrap();
    assert_eq!(shape(&braking), [(-2.0, 0.5), (0.0, 1.5), (2.0, 0.5)]);
}

#[test]
fn a_start_outside_the_limits_is_brought_in_first() {
    let profile = speed_target(state(0.0, 0.0, 6.0), 9.0, 0.0, &limits()).unwrap();
    assert_eq!(shape(&profile), [(-2.0, 1.0), (-2.0, 2.0)]);
    assert_eq!(profile.brought_in, 1);
    assert_eq!(profile.brought_in_s(), 1.0);
}

#[test]
fn what_cannot_be_is_refused() {
    let rest = state(0.0, 0.0, 0.0);
    let no_jerk = JerkLimits::symmetric(1.0, 1.0, 0.0);
    assert_eq!(
        speed_target(rest, 1.0, 0.0, &no_jerk),
        Err(JerkError::Limits)
    );
    let nowhere = state(f64::NAN, 0.0, 0.0);
    assert_eq!(
        speed_target(nowhere, 1.0, 0.0, &limits()),
        Err(JerkError::Start)
    );
    assert_eq!(
        speed_target(rest, 10.1, 0.0, &limits()),
        Err(JerkError::Target)
    );
    assert_eq!(
        speed_target(rest, 1.0, -4.1, &limits()),
        Err(JerkError::Target)
    );
}
