//! The interpolation-period planner: limits kept to the last digit, times next
//! to the optimum, and reference runs (tests/period/reference.py).

use gwatt::plan::period::{
    Curve, Jerk, LimitError, Limits, Motion, PositionPlanner, Ramp, SpeedPlanner,
};
use proptest::prelude::*;

const PERIODS_S: [f64; 4] = [1e-5, 1e-4, 1e-3, 1e-2];
/// Acceleration, base speed and jerk of the reference runs.
const REFERENCE: (f64, f64, f64) = (2000.0, 1000.0, 20_000.0);

fn reference_limits() -> Limits {
    let (a, base, j) = REFERENCE;
    Limits::constant_power(a, base, j).unwrap()
}

/// Duration of the time-optimal change of speed between rests at constant limits.
fn optimum(change: f64, a: f64, j: f64) -> f64 {
    let change = change.abs();
    if change >= a * a / j {
        change / a + a / j
    } else {
        2.0 * (change / j).sqrt()
    }
}

/// Goes to a target from rest; nothing may be exceeded on the way, by nothing.
/// Gives the time that it takes.
fn go(planner: &mut SpeedPlanner, target: f64, period_s: f64, limits: &Limits) -> f64 {
    let from = planner.motion().speed;
    for count in 1..10_000_000_u32 {
        let before = planner.motion();
        let step = planner.step(target, period_s, limits).unwrap();
        let Motion { speed, accel } = step.motion;
        assert!(accel.abs() <= limits.up(speed * accel.signum()), "{step:?}");
        let jerk = (accel - before.accel) / period_s;
        assert!(jerk.abs() <= limits.jerk.largest(), "{before:?} {step:?}");
        assert!((target - speed) * (target - from) >= 0.0, "{step:?}");
        assert_eq!((step.overshoot, step.excess), (0.0, 0.0), "{before:?}");
        if step.reached {
            return f64::from(count) * period_s;
        }
    }
    panic!("{target} is never reached");
}

fn is_next_to(time: f64, best: f64, period_s: f64) -> bool {
    let rounding = 1e-9 * best;
    best - rounding <= time && time <= best + period_s + rounding
}

#[test]
fn below_base_speed_it_takes_the_optimal_time() {
    for period_s in PERIODS_S {
        for (v, a, j) in [
            (900.0, 2000.0, 20_000.0),
            (3.0, 2000.0, 20_000.0),
            (150.0, 1000.0 / 3.0, 7777.7),
        ] {
            let limits = Limits::constant_power(a, 1000.0, j).unwrap();
            let mut planner = SpeedPlanner::default();
            let time = go(&mut planner, v, period_s, &limits);
            assert!(is_next_to(time, optimum(v, a, j), period_s), "{v} {time}");
            // Reversed: through rest, with and without reaching −A.
            let time = go(&mut planner, -v, period_s, &limits);
            assert!(is_next_to(time, optimum(2.0 * v, a, j), period_s), "{time}");
        }
    }
}

#[test]
fn a_reversal_has_three_phases_if_it_reaches_the_limit() {
    let limits = reference_limits();
    let phases = |from: f64| {
        let start = Motion {
            speed: from,
            accel: 0.0,
        };
        let ramp = Ramp::new(start, -from, &limits);
        // Rest is a boundary of the limits, not of the curve.
        let mut jerks: Vec<_> = ramp.phases.iter().map(|p| p.jerk().unwrap()).collect();
        jerks.dedup();
        let least = ramp.phases.iter().map(|p| p.end.accel);
        (jerks, least.fold(0.0, f64::min))
    };
    // 2·v = A²/J = 200 is the change that just reaches A.
    assert_eq!(phases(100.5), (vec![-2e4, 0.0, 2e4], -2000.0));
    let (jerks, least) = phases(99.5);
    assert_eq!(jerks, [-2e4, 2e4]);
    assert!(least > -2000.0);
}

#[test]
fn signs_of_speed_difference_and_acceleration_may_differ() {
    let limits = Limits::constant(2000.0, 20_000.0).unwrap();
    // Braking with −1000 takes 25 to come to rest at ±J.
    let start = Motion {
        speed: 100.0,
        accel: -1000.0,
    };
    for (target, first) in [(80.0, 2e4), (74.0, -2e4), (500.0, 2e4), (-500.0, -2e4)] {
        let ramp = Ramp::new(start, target, &limits);
        assert_eq!(ramp.phases[0].jerk(), Some(first), "{target}");
        let (end, _) = ramp.at(ramp.duration_s());
        assert_eq!((end.speed, end.accel), (target, 0.0));
    }
}

/// Up to the base speed, then `v² = V_f² + 2·A·V_f·t`, then the landing: its
/// speed change is A(v)²/2J.
#[test]
fn through_base_speed_the_times_are_those_by_hand() {
    let (a, base, j) = REFERENCE;
    let ramp = Ramp::new(Motion::default(), 3000.0, &reference_limits());
    // The landing begins at v with v + (A·V_f/v)²/2J = 3000.
    let mut v = 3000.0;
    for _ in 0..50 {
        v = 3000.0 - (a * base / v).powi(2) / (2.0 * j);
    }
    let up = a / j + (base - a * a / (2.0 * j)) / a;
    let power = (v * v - base * base) / (2.0 * a * base);
    let landing = a * base / v / j;
    assert!((ramp.duration_s() - (up + power + landing)).abs() < 1e-12);
    for period_s in PERIODS_S {
        let mut planner = SpeedPlanner::default();
        let time = go(&mut planner, 3000.0, period_s, &reference_limits());
        assert!(is_next_to(time, ramp.duration_s(), period_s), "{time}");
    }
}

#[test]
fn reference_runs() {
    let text = include_str!("period/reference.csv");
    let changes: [(&str, &[(u32, f64)]); 9] = [
        ("start", &[(0, 900.0)]),
        ("short", &[(0, 100.0)]),
        ("up", &[(0, 500.0), (150, 900.0)]),
        ("down", &[(0, 900.0), (250, 300.0)]),
        ("reversal", &[(0, 900.0), (600, -900.0)]),
        ("small_reversal", &[(0, 40.0), (130, -40.0)]),
        ("through", &[(0, 3000.0)]),
        ("power_up", &[(0, 2000.0), (900, 3000.0)]),
        ("power_down", &[(0, 3000.0), (1500, 1500.0)]),
    ];
    let (a, _, j) = REFERENCE;
    let limits = reference_limits();
    for (name, changes) in changes {
        // The simulation goes in steps of 1 µs: A·1 µs is 1e-6 of J.
        let simulated = ["through", "power_up", "power_down"].contains(&name);
        let near = if simulated { 1e-4 } else { 1e-7 };
        let mut planner = SpeedPlanner::default();
        let (mut target, mut period) = (0.0, 0);
        let mut rows = 0;
        for line in text.lines() {
            let mut fields = line.split(',');
            if fields.next() != Some(name) {
                continue;
            }
            let values: Vec<f64> = fields.map(|field| field.parse().unwrap()).collect();
            let [until, speed, accel, jerk] = values[..] else {
                panic!("{line}");
            };
            let mut step = None;
            while f64::from(period) < until {
                let change = changes.iter().find(|change| change.0 == period);
                target = change.map_or(target, |change| change.1);
                step = Some(planner.step(target, 1e-3, &limits).unwrap());
                period += 1;
            }
            let step = step.unwrap();
            assert!(
                (step.motion.speed - speed).abs() <= near * 1000.0,
                "{line} {step:?}"
            );
            assert!(
                (step.motion.accel - accel).abs() <= near * a,
                "{line} {step:?}"
            );
            assert!(
                (step.jerk - jerk).abs() <= 1e-2 + 20.0 * near * j,
                "{line} {step:?}"
            );
            rows += 1;
        }
        assert!(rows >= 20, "{name}");
    }
}

#[test]
fn a_jerk_limit_that_shrinks_makes_the_smallest_overshoot() {
    let mut planner = SpeedPlanner::default();
    let wide = Limits::constant(2000.0, 20_000.0).unwrap();
    // At 0.25 s: v = 400, a = 2000.
    for _ in 0..250 {
        planner.step(500.0, 1e-3, &wide).unwrap();
    }
    let start = planner.motion();
    assert!((start.speed - 400.0).abs() < 1e-6 && (start.accel - 2000.0).abs() < 1e-6);
    // Taking 2000 to rest at 10000 needs 200: 100 too much.
    let narrow = Limits::constant(2000.0, 10_000.0).unwrap();
    let step = planner.step(500.0, 1e-3, &narrow).unwrap();
    assert!((step.overshoot - 100.0).abs() < 1e-4, "{step:?}");
    let mut top = 0.0_f64;
    while !planner.step(500.0, 1e-3, &narrow).unwrap().reached {
        top = top.max(planner.motion().speed);
    }
    assert!((top - 600.0).abs() < 1e-3, "{top}");
}

#[test]
fn an_acceleration_limit_that_shrinks_is_met_at_full_jerk() {
    let mut planner = SpeedPlanner::new(Motion {
        speed: 400.0,
        accel: 2000.0,
    })
    .unwrap();
    let limits = Limits::constant(500.0, 20_000.0).unwrap();
    let step = planner.step(5000.0, 1e-2, &limits).unwrap();
    assert_eq!(step.excess, 1500.0);
    assert!((step.jerk + 20_000.0).abs() < 1e-4);
    let mut periods = 1;
    while planner.motion().accel > 500.0 {
        planner.step(5000.0, 1e-2, &limits).unwrap();
        periods += 1;
    }
    // 1500 at 20 000 take 75 ms.
    assert_eq!(periods, 8);
}

#[test]
fn a_jerk_that_cannot_follow_begins_earlier_and_exceeds_nothing() {
    // Half of A²/V_f.
    let limits = Limits::constant_power(2000.0, 1000.0, 2000.0).unwrap();
    assert_eq!(limits.drive.jerk_to_follow(3000.0), 4000.0);
    let mut planner = SpeedPlanner::default();
    go(&mut planner, 3000.0, 1e-3, &limits);
}

#[test]
fn a_speed_without_torque_is_told() {
    // 100 − v/10 is nothing at 1000.
    let drive = Curve::torque(&[(0.0, 100.0), (2000.0, -100.0)], 0.0, 1.0).unwrap();
    let limits = Limits {
        brake: drive.clone(),
        drive,
        jerk: Jerk::constant(1000.0).unwrap(),
    };
    let mut planner = SpeedPlanner::default();
    let step = planner.step(1500.0, 1e-3, &limits).unwrap();
    let last = step.out_of_reach.unwrap();
    assert!((last - 1000.0).abs() < 1e-2, "{last}");
}

#[test]
fn axes_in_step_have_the_lowest_limits() {
    let x = Limits::constant_power(2000.0, 1000.0, 20_000.0).unwrap();
    let y = Limits::constant(900.0, 50_000.0).unwrap();
    // A direction of 0.8 and 0.6.
    let path = Limits::in_step(&[(0.8, &x), (-0.6, &y)]).unwrap();
    assert!((path.drive.at(0.0) - 1500.0).abs() < 1e-9);
    // X at 0.8·5000 = 4000: 500, on the path 625.
    assert!((path.drive.at(5000.0) - 625.0).abs() < 1e-9);
    assert!((path.jerk.at(0.0) - 25_000.0).abs() < 1e-9);
    assert!(Limits::in_step(&[(0.0, &x)]).is_none());
    let mut planner = SpeedPlanner::default();
    go(&mut planner, 4000.0, 1e-3, &path);
}

#[test]
fn bad_values_move_nothing() {
    let limits = Limits::constant(1.0, 1.0).unwrap();
    let mut planner = SpeedPlanner::default();
    for (target, period_s) in [
        (f64::NAN, 1.0),
        (f64::INFINITY, 1.0),
        (1.0, 0.0),
        (1.0, -1.0),
    ] {
        assert!(planner.step(target, period_s, &limits).is_err());
    }
    assert_eq!(planner.motion(), Motion::default());
    assert!(
        SpeedPlanner::new(Motion {
            speed: f64::NAN,
            accel: 0.0
        })
        .is_err()
    );
    assert!(
        PositionPlanner::default()
            .step(1.0, 0.0, 1.0, &limits)
            .is_err()
    );
    assert_eq!(
        LimitError::NotPositive("the period").to_string(),
        "the period must be a finite number greater than 0"
    );
}

/// Rest to rest over a way: seven phases, the optimum by hand.
#[test]
fn a_position_is_reached_in_the_optimal_time() {
    let (a, j, top) = (2000.0, 20_000.0, 300.0);
    let limits = Limits::constant(a, j).unwrap();
    // With a cruise: x/v + v/A + A/J; 0.16 is 4·cbrt(x/2J) below all limits.
    for (way, best) in [
        (100.0, 100.0 / top + top / a + a / j),
        (-0.64, 4.0 * libm::cbrt(0.64 / (2.0 * j))),
    ] {
        for period_s in [1e-4, 1e-3, 1e-2] {
            let time = travel(way, top, period_s, &limits);
            assert!(
                is_next_to(time, best, period_s),
                "{way} {period_s}: {time} {best}"
            );
        }
    }
}

#[test]
fn a_position_is_reached_under_constant_power() {
    let limits = Limits::constant_power(2000.0, 50.0, 100_000.0).unwrap();
    let time = travel(100.0, 300.0, 1e-3, &limits);
    assert!(travel(100.0, 300.0, 1e-4, &limits) <= time + 1e-9);
}

/// Without a limit of jerk the period puts out what it ends with, not the stop that may follow.
#[test]
fn without_a_limit_of_jerk_the_acceleration_is_that_of_the_period() {
    let limits = Limits::constant(6000.0, f64::INFINITY).unwrap();
    let mut planner = PositionPlanner::default();
    let step = planner.step(400.0, 500.0, 1e-3, &limits).unwrap();
    assert_eq!((step.motion.speed, step.motion.accel), (6.0, 6000.0));
}

fn travel(way: f64, top: f64, period_s: f64, limits: &Limits) -> f64 {
    let mut planner = PositionPlanner::default();
    for count in 1..1_000_000_u32 {
        let (_, before) = planner.state();
        let step = planner.step(way, top, period_s, limits).unwrap();
        let Motion { speed, accel } = step.motion;
        assert!(accel.abs() <= limits.up(speed * accel.signum()), "{step:?}");
        assert!(((accel - before.accel) / period_s).abs() <= limits.jerk.largest());
        assert!(speed.abs() <= top, "{step:?}");
        assert!((way - step.position) * way >= 0.0, "{step:?}");
        assert_eq!(step.overshoot, 0.0);
        if step.reached {
            return f64::from(count) * period_s;
        }
    }
    panic!("{way} is never reached");
}

/// Constant, constant power, a converter's power with friction, torque points,
/// and jerk in steps of the speed.
fn limits() -> impl Strategy<Value = Limits> {
    let kinds = 0..5;
    let numbers = (10.0..5000.0, 100.0..2000.0, 0.001..1.0, 0.0..0.5);
    (kinds, numbers).prop_map(|(kind, (a, base, time, friction))| {
        let j = a / time;
        let limits = Limits::constant_power(a, base, j).unwrap();
        let flat = Curve::constant(a).unwrap();
        let points = [
            (0.0, a),
            (base, a),
            (1.5 * base, 0.4 * a),
            (4000.0, 0.1 * a),
        ];
        match kind {
            0 => Limits::constant(a, j).unwrap(),
            1 => limits,
            2 => {
                let drag = friction * a * base / 3000.0;
                let power = |drag| flat.limited_by_power(a * base, drag, 1.0).unwrap();
                Limits {
                    drive: power(drag),
                    brake: power(-drag),
                    ..limits
                }
            }
            3 => {
                let drag = 0.09 * a * friction;
                let torque = |drag| Curve::torque(&points, drag, 1.0).unwrap();
                Limits {
                    drive: torque(drag),
                    brake: torque(-drag),
                    ..limits
                }
            }
            _ => {
                let steps = [(0.0, j), (0.6 * base, 0.5 * j), (1.3 * base, 2.0 * j)];
                Limits {
                    jerk: Jerk::steps(&steps).unwrap(),
                    ..limits
                }
            }
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// A ramp joins up, keeps its limits at every instant and leads to the
    /// target; planned again on the way it takes as long.
    #[test]
    fn any_ramp_holds(
        from in -3000.0..3000.0, to in -3000.0..3000.0, share in -1.0..1.0,
        part in 0.0..1.0, limits in limits(),
    ) {
        let start = Motion { speed: from, accel: 0.0 };
        let ramp = Ramp::new(start, to, &limits);
        prop_assert_eq!(ramp.end_speed, to);
        let mut last = start;
        for phase in &ramp.phases {
            prop_assert!((phase.start.speed - last.speed).abs() < 1e-9);
            prop_assert!((phase.start.accel - last.accel).abs() < 1e-6);
            for instant in 0..=20 {
                let now = phase.at(phase.duration_s * f64::from(instant) / 20.0);
                // A step of the limit may lie between two neighbouring numbers.
                let limit = |v: f64| limits.up(v * now.accel.signum());
                let most = limit(now.speed - 1e-6).max(limit(now.speed + 1e-6));
                prop_assert!(now.accel.abs() <= most * (1.0 + 1e-6), "{now:?} {most}");
            }
            last = phase.end;
        }
        prop_assert!(ramp.phases.is_empty() || last.speed == to);
        let least = limits.up(from).min(limits.up(-from));
        let moving = Ramp::new(Motion { speed: from, accel: share * least }, to, &limits);
        let time = part * moving.duration_s();
        let again = Ramp::new(moving.at(time).0, to, &limits);
        let whole = time + again.duration_s();
        prop_assert!((whole - moving.duration_s()).abs() <= 1e-5 * whole, "{whole} {moving:?}");
    }

    /// From rest to rest nothing is exceeded, and the time is that of the ramp.
    #[test]
    fn any_run_holds(
        from in -3000.0..3000.0, to in -3000.0..3000.0, period_s in 1e-3..0.02, limits in limits(),
    ) {
        let mut planner = SpeedPlanner::new(Motion { speed: from, accel: 0.0 }).unwrap();
        let best = Ramp::new(planner.motion(), to, &limits).duration_s();
        let time = go(&mut planner, to, period_s, &limits);
        prop_assert!(is_next_to(time, best, period_s), "{time} {best}");
    }

    /// Targets, periods and limits that change at any time: the jerk is kept, the
    /// acceleration is above its limit only where that is shown, and what is shown
    /// of an overshoot at first is never exceeded.
    #[test]
    fn anything_may_change(
        changes in prop::collection::vec(
            (-3000.0..3000.0, limits(), 1e-4..0.02, 1_u32..100), 1..6),
    ) {
        let mut planner = SpeedPlanner::default();
        for (target, limits, period_s, periods) in changes {
            let mut shown = f64::INFINITY;
            for _ in 0..periods {
                let before = planner.motion();
                let step = planner.step(target, period_s, &limits).unwrap();
                let Motion { speed, accel } = step.motion;
                prop_assert!(((accel - before.accel) / period_s).abs() <= limits.jerk.largest());
                let limit = limits.up(speed * accel.signum());
                prop_assert!(accel.abs() <= limit || step.excess > 0.0, "{step:?}");
                prop_assert!(step.overshoot <= shown * (1.0 + 1e-6) + 1e-6, "{shown} {step:?}");
                shown = step.overshoot;
            }
        }
    }

    /// A position command from any state, with any target, comes to rest there,
    /// and passes it by no more than what is shown at first.
    #[test]
    fn any_position_is_reached(
        speed in -250.0..250.0, share in -1.0..1.0, way in -200.0..200.0, time in 0.01..0.2,
    ) {
        let limits = Limits::constant(2000.0, 2000.0 / time).unwrap();
        let start = Motion { speed, accel: share * 2000.0 };
        let mut planner = PositionPlanner::new(0.0, start).unwrap();
        let mut shown = None;
        for _ in 0..20_000 {
            let step = planner.step(way, 300.0, 1e-3, &limits).unwrap();
            prop_assert!(step.motion.accel.abs() <= 2000.0);
            let shown = *shown.get_or_insert(step.overshoot);
            let passed = (step.position - way) * way.signum();
            prop_assert!(passed <= shown * (1.0 + 1e-6) + 1e-6, "{shown} {step:?}");
            if step.reached {
                return Ok(());
            }
        }
        prop_assert!(false, "never reached");
    }
}
