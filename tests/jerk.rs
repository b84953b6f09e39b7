//! Jerk-limited profiles end in their targets, keep every limit, and are as
//! fast as can be.

use gwatt::plan::jerk::{JerkError, JerkLimits, JerkProfile, State, position_target, speed_target};
use gwatt::plan::{Phase, PhaseKind};

use crate::random::Random;

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
    assert!((first - 1.0 - 0.5 * 6.0_f64.sqrt()).abs() < 1e-14);
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

#[test]
fn a_position_takes_seven_phases_at_most() {
    // Up to 4 mm/s² and 10 mm/s in 4.5 s and 22.5 mm, the same down, and a
    // cruise of 55 mm.
    let rest = state(0.0, 0.0, 0.0);
    let long = position_target(rest, state(100.0, 0.0, 0.0), &limits()).unwrap();
    let jerks = [2.0, 0.0, -2.0, 0.0, -2.0, 0.0, 2.0];
    let times = [2.0, 0.5, 2.0, 5.5, 2.0, 0.5, 2.0];
    let found = shape(&long);
    assert_eq!(found.len(), 7);
    for ((jerk, time), (j, t)) in found.into_iter().zip(jerks.into_iter().zip(times)) {
        assert_eq!(jerk, j);
        assert!((time - t).abs() < 1e-12);
    }
    // Short: four ramps of equal length, 2·j·t³.
    let short = position_target(rest, state(-4.0, 0.0, 0.0), &limits()).unwrap();
    assert!((short.duration_s() - 4.0).abs() < 1e-12);
    assert_eq!(short.phases.len(), 3);
    let path = long.path();
    assert!((path.length_mm() - 100.0).abs() < 1e-12);
    assert_eq!(path.top_speed_mm_s(), 10.0);
    let none = position_target(rest, rest, &limits()).unwrap();
    assert_eq!(none.duration_s(), 0.0);
}

#[test]
fn a_start_that_is_too_fast_overshoots_as_little_as_can_be() {
    // From 9 mm/s and 4 mm/s² the speed must reach 9 + 16/4 = 13.
    let profile =
        position_target(state(0.0, 9.0, 4.0), state(200.0, 10.0, 0.0), &limits()).unwrap();
    assert!(profile.brought_in > 0);
    let top = (0..4000).map(|i| profile.state_at(f64::from(i) * 1e-3).velocity_mm_s);
    assert!((top.fold(0.0, f64::max) - 13.0).abs() < 1e-5);
    let after = profile.state_at(profile.brought_in_s());
    assert!(after.velocity_mm_s <= 10.0 && after.accel_mm_s2 >= -4.0);
}

#[test]
fn positions_that_cannot_be_are_refused() {
    let rest = state(0.0, 0.0, 0.0);
    // At 10 mm/s while braking it has been faster before.
    let target = state(5.0, 10.0, -1.0);
    assert_eq!(
        position_target(rest, target, &limits()),
        Err(JerkError::Target)
    );
    let forwards = JerkLimits {
        min_speed_mm_s: 0.0,
        ..limits()
    };
    assert_eq!(
        position_target(rest, state(-1.0, 0.0, 0.0), &forwards),
        Err(JerkError::Target)
    );
    assert!(position_target(rest, state(1.0, 0.0, 0.0), &forwards).is_ok());
}

impl Random {
    /// A limit from 0.1 to 10.
    fn limit(&mut self) -> f64 {
        libm::pow(10.0, self.within(-1.0, 1.0))
    }

    fn limits(&mut self) -> JerkLimits {
        let mut limits = JerkLimits::symmetric(self.limit(), self.limit(), self.limit());
        if self.unit() < 0.5 {
            limits.min_speed_mm_s = -self.limit();
            limits.min_accel_mm_s2 = -self.limit();
        }
        limits
    }

    /// A state within the limits; now and then at rest, steady or at a limit.
    fn state(&mut self, limits: &JerkLimits) -> State {
        let mut state = state(
            self.within(-10.0, 10.0),
            self.within(limits.min_speed_mm_s, limits.max_speed_mm_s),
            self.within(limits.min_accel_mm_s2, limits.max_accel_mm_s2),
        );
        match self.within(0.0, 10.0) as u32 {
            0 => state.velocity_mm_s = 0.0,
            1 | 2 => state.accel_mm_s2 = 0.0,
            3 => (state.velocity_mm_s, state.accel_mm_s2) = (limits.max_speed_mm_s, 0.0),
            4 => state.accel_mm_s2 = limits.min_accel_mm_s2,
            _ => {}
        }
        state
    }
}

/// The speed at which the acceleration is 0 again at the earliest.
fn levelled(state: State, limits: &JerkLimits) -> f64 {
    let a = state.accel_mm_s2;
    state.velocity_mm_s + a * a.abs() / (2.0 * limits.jerk_mm_s3)
}

/// Follows the jerks of a profile, phase after phase, and checks the limits on
/// the way (but for the phases that bring a start in) and the end.
fn verify(start: State, end: State, limits: &JerkLimits, profile: &JerkProfile) {
    let fastest = limits.max_speed_mm_s.max(-limits.min_speed_mm_s);
    let steepest = limits.max_accel_mm_s2.max(-limits.min_accel_mm_s2);
    let within = |v: f64, a: f64| {
        let speed = v.clamp(limits.min_speed_mm_s, limits.max_speed_mm_s) - v;
        let accel = a.clamp(limits.min_accel_mm_s2, limits.max_accel_mm_s2) - a;
        assert!(
            speed.abs() <= 1e-9 * fastest && accel.abs() <= 1e-9 * steepest,
            "{start:?} {end:?} {limits:?}: {v} {a}"
        );
    };
    let (mut p, mut v, mut a) = (start.position_mm, start.velocity_mm_s, start.accel_mm_s2);
    let mut far = p.abs().max(end.position_mm.abs());
    let mut fast = v.abs().max(end.velocity_mm_s.abs());
    for (index, (j, t)) in shape(profile).into_iter().enumerate() {
        let phase = &profile.phases[index];
        assert!(j == 0.0 || j.abs() == limits.jerk_mm_s3);
        assert!((phase.position_mm - p).abs() <= 1e-9 * far.max(1.0));
        assert!((phase.velocity_mm_s - v).abs() <= 1e-9 * fast);
        assert!((phase.accel_mm_s2 - a).abs() <= 1e-9 * steepest.max(start.accel_mm_s2.abs()));
        if profile.brought_in > 0 {
            // A start far outside the limits may lead very far away, and what
            // was rounded there would grow in a slow cruise.
            (p, v, a) = (phase.position_mm, phase.velocity_mm_s, phase.accel_mm_s2);
        }
        if index >= profile.brought_in {
            within(v, a);
            let level = -a / j;
            if level > 0.0 && level < t {
                within(v + 0.5 * a * level, 0.0);
            }
        }
        p += (v + (0.5 * a + j / 6.0 * t) * t) * t;
        v += (a + 0.5 * j * t) * t;
        a += j * t;
        far = far.max(p.abs()).max((v * t).abs());
        fast = fast.max(v.abs()).max((j * t * t).abs());
    }
    let missed = (
        (p - end.position_mm).abs() / far.max(1.0),
        (v - end.velocity_mm_s).abs() / fast,
        (a - end.accel_mm_s2).abs() / steepest,
    );
    assert!(
        missed.0 <= 1e-9 && missed.1 <= 1e-9 && missed.2 <= 1e-9,
        "{start:?} {end:?} {limits:?}: {missed:?}"
    );
}

/// Profiles between random states; how many starts were outside the limits.
fn random_states(count: u32, seed: u64) -> u32 {
    let mut random = Random(seed);
    let mut outside = 0;
    let mut done = 0;
    while done < count {
        let limits = random.limits();
        let (start, end) = (random.state(&limits), random.state(&limits));
        let within = |v: f64| v <= limits.max_speed_mm_s && v >= limits.min_speed_mm_s;
        let back = State {
            accel_mm_s2: -end.accel_mm_s2,
            ..end
        };
        if !within(levelled(back, &limits)) {
            continue;
        }
        let profile = position_target(start, end, &limits).unwrap();
        let inside = within(levelled(start, &limits));
        assert_eq!(inside, profile.brought_in == 0, "{start:?} {limits:?}");
        verify(start, end, &limits, &profile);
        let speed = end.velocity_mm_s;
        let profile = speed_target(start, speed, end.accel_mm_s2, &limits).unwrap();
        let mut end = end;
        end.position_mm = profile.end.position_mm;
        let free = JerkLimits {
            max_speed_mm_s: 2e3,
            min_speed_mm_s: -2e3,
            ..limits
        };
        verify(start, end, &free, &profile);
        outside += u32::from(!inside);
        done += 1;
    }
    outside
}

#[test]
fn profiles_between_random_states_keep_the_limits_and_arrive() {
    assert!(random_states(20_000, 1) > 2000);
}

/// `cargo test --release --test main -- --ignored --nocapture ten_million`
#[test]
#[ignore = "takes a minute"]
fn ten_million_random_states() {
    let outside = random_states(10_000_000, 2);
    println!("10000000 states, {outside} of them outside the limits at the start");
}

#[test]
fn no_profile_is_longer_than_that_of_ruckig() {
    // Ruckig 0.19.4; `tests/jerk/sample.py` says how the sample was made.
    let sample = include_str!("jerk/sample.csv");
    let (mut compared, mut unsolved) = (0, 0);
    for line in sample.lines().skip(1) {
        let numbers: Vec<Option<f64>> = line.split(',').map(|word| word.parse().ok()).collect();
        let n = |i: usize| numbers[i].unwrap();
        let limits = JerkLimits {
            max_speed_mm_s: n(6),
            min_speed_mm_s: n(7),
            max_accel_mm_s2: n(8),
            min_accel_mm_s2: n(9),
            jerk_mm_s3: n(10),
        };
        let (start, end) = (state(n(0), n(1), n(2)), state(n(3), n(4), n(5)));
        let profile = position_target(start, end, &limits).unwrap();
        verify(start, end, &limits, &profile);
        match numbers[11] {
            Some(duration_s) => {
                assert!(
                    profile.duration_s() <= duration_s * (1.0 + 1e-9) + 1e-12,
                    "{line}: {}",
                    profile.duration_s()
                );
                compared += 1;
            }
            None => unsolved += 1,
        }
    }
    assert_eq!((compared, unsolved), (2981, 19));
}
