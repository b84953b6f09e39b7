//! Power agrees with hand-worked cases and with dense sampling, and is never
//! too low.

use crate::rig::{
    Sampled, any_arc, any_delta, any_feed, any_machine, arc, axis, dwell, machine, sample, straight,
};
use gwatt::interpret::Move;
use gwatt::machine::{Axis, AxisKind, AxisSet, Converter, Load, Machine, RapidPath, Ratings};
use gwatt::plan::{Caps, Overrides, plan, speed_bound};
use gwatt::power::{Assessment, Assessor, Certificate, Demand, PowerModel, Want};
use proptest::prelude::*;
use std::f64::consts::PI;

use crate::near::assert_near;

fn demand(machine: &Machine, mv: &Move) -> Demand {
    let plan = plan(machine, mv, Overrides::default());
    PowerModel::new(machine).demand(mv, &plan, Want::ALL)
}

/// Judges moves one after the other.
fn judged(
    machine: &Machine,
    moves: &[Move],
    certificate: Option<Certificate>,
    want: Want,
) -> Vec<Assessment> {
    let mut assessor = Assessor::new(machine, certificate, want);
    let mut found = Vec::new();
    let mut keep = |_: &Move, assessment: &Assessment, _: &[u8]| found.push(*assessment);
    for mv in moves {
        assessor.push(mv, b"", &mut keep);
    }
    assessor.finish(&mut keep);
    found
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert_near(found, expected, 1e-9 * expected.abs().max(1.0));
}

#[test]
fn one_axis_with_friction_and_efficiency() {
    // 100 kg at 5 m/s² to 0.5 m/s against 100 N: F = 600 N, 300 W, 375 W drawn.
    // Braking F = −400 N, 200 W, 160 W fed back.
    let machine = machine(&[Axis {
        coulomb_n: 100.0,
        efficiency: 0.8,
        ..axis()
    }]);
    for delta in [500.0, -500.0] {
        let found = demand(&machine, &straight(&machine, &[delta], f64::INFINITY));
        close(found.peak_w, 375.0);
        close(found.regen_w, 160.0);
        // Ramp 0.025 m, cruise 0.45 m: (600·0.025 + 100·0.45)/0.8.
        close(found.energy_j, 75.0);
        close(found.load_ratio, 0.375);
    }
}

#[test]
fn a_triangle_peaks_at_its_top() {
    let machine = machine(&[axis()]);
    let found = demand(&machine, &straight(&machine, &[8.0], f64::INFINITY));
    close(found.peak_w, 0.2 * 500.0);
    close(found.regen_w, 0.2 * 500.0);
}

#[test]
fn a_falling_axis_is_credited_only_where_the_converter_says_so() {
    let falling = Axis {
        gravity_n: 2000.0,
        ..axis()
    };
    let mut machine = machine(&[axis(), falling]);
    machine.converters[0].base_load_w = 50.0;
    // Each axis at 0.3 m/s and 3 m/s²: X 90 W; Z 0.3·(300 − 2000) = −510 W.
    let mut mv = straight(&machine, &[300.0, -300.0], 300.0 * 2.0_f64.sqrt());
    mv.path_accel_mm_s2 = 3000.0 * 2.0_f64.sqrt();
    let apart = demand(&machine, &mv);
    close(apart.peak_w, 50.0 + 90.0);
    // Braking: X −90 W, Y 0.3·(−300 − 2000)·… = −690 W.
    close(apart.regen_w, 90.0 + 690.0);
    machine.converters[0].credit_regen = true;
    let credited = demand(&machine, &mv);
    close(credited.peak_w, 50.0);
    close(credited.regen_w, 90.0 + 690.0 - 50.0);
    // Potential energy of 0.3 m comes back, the base load is drawn.
    close(credited.energy_j, 50.0 * (0.3 / 0.3 + 0.1) - 2000.0 * 0.3);
}

#[test]
fn a_rotary_axis_counts_in_radians() {
    // The first method's formula, ω·(ω·J/t + D): 60 °/s in 0.1 s.
    let machine = machine(&[Axis {
        kind: AxisKind::Rotary,
        rapid_mm_s: 60.0,
        accel_mm_s2: 600.0,
        mass_kg: 12.0,
        coulomb_n: 40.0,
        si_per_unit: PI / 180.0,
        ..axis()
    }]);
    let omega = PI / 3.0;
    let found = demand(&machine, &straight(&machine, &[90.0], f64::INFINITY));
    close(found.peak_w, omega * (omega * 12.0 / 0.1 + 40.0));
}

#[test]
fn independent_ramps_peak_below_the_sum_of_their_peaks() {
    // Ramps of 0.10, 0.12 and 0.15 s to 0.5 m/s, 100 kg, 200 N each: when the
    // first is done it needs 100 W only, the last one peaks alone.
    let ramp = |t: f64| Axis {
        accel_mm_s2: 500.0 / t,
        coulomb_n: 200.0,
        ..axis()
    };
    let mut machine = machine(&[ramp(0.10), ramp(0.12), ramp(0.15)]);
    machine.path.rapid = RapidPath::Independent;
    let mv = straight(&machine, &[400.0, -400.0, 400.0], f64::INFINITY);
    let found = demand(&machine, &mv);
    let at = |t: f64, ramp: f64| {
        if t <= ramp {
            0.5 * t / ramp * (100.0 * 0.5 / ramp + 200.0)
        } else {
            100.0
        }
    };
    let sum = |t: f64| at(t, 0.10) + at(t, 0.12) + at(t, 0.15);
    close(found.peak_w, sum(0.10).max(sum(0.12)).max(sum(0.15)));
    let peaks = at(0.10, 0.10) + at(0.12, 0.12) + at(0.15, 0.15);
    assert!(found.peak_w < 0.99 * peaks);
}

#[test]
fn holding_a_weight_costs_copper_in_every_move() {
    let hanging = Axis {
        gravity_n: 1000.0,
        copper_w_n2: 5e-5,
        ..axis()
    };
    let mut machine = machine(&[axis(), hanging]);
    machine.converters[0].base_load_w = 10.0;
    let found = demand(&machine, &dwell(&machine, 2.0));
    close(found.peak_w, 60.0);
    close(found.energy_j, 120.0);
    close(demand(&machine, &straight(&machine, &[], 1.0)).peak_w, 60.0);
    let found = demand(&machine, &straight(&machine, &[500.0], f64::INFINITY));
    close(found.peak_w, 60.0 + 250.0);
    machine.path.rapid = RapidPath::Independent;
    let both = straight(&machine, &[500.0, -1.0], f64::INFINITY);
    let found = demand(&machine, &both);
    // Y arrives after 0.03 s; X reaches its speed at 0.1 s while Y holds.
    close(found.peak_w, 60.0 + 250.0);
}

#[test]
fn servo_factors_and_warm_friction_change_peaks_but_not_energy() {
    let plain = machine(&[Axis {
        coulomb_n: 100.0,
        ..axis()
    }]);
    let mut real = plain.clone();
    real.axes[0] = real.axes[0].map(|axis| Axis {
        servo_factor_motor: 1.3,
        servo_factor_regen: 1.2,
        friction_min_ratio: 0.5,
        ..axis
    });
    let mv = straight(&plain, &[500.0], f64::INFINITY);
    close(demand(&real, &mv).peak_w, 0.5 * (500.0 * 1.3 + 100.0));
    close(demand(&real, &mv).regen_w, 0.5 * (500.0 * 1.2 - 50.0));
    close(demand(&real, &mv).energy_j, demand(&plain, &mv).energy_j);
}

/// 500 N to speed up and to brake, and up to 750 N while braking.
#[test]
fn braking_harder_than_commanded_costs_copper() {
    let with = |copper_w_n2: f64| {
        machine(&[Axis {
            servo_factor_regen: 1.5,
            copper_w_n2,
            ..axis()
        }])
    };
    let lossy = with(0.004);
    let mv = straight(&lossy, &[500.0], f64::INFINITY);
    // At the end of braking, where nothing is fed back any more.
    close(demand(&lossy, &mv).peak_w, 0.004 * 750.0 * 750.0);
    close(demand(&lossy, &mv).regen_w, 0.0);
    // Most is fed back at 625 N = v/(2·R): v²/(4·R).
    let good = with(0.0004);
    close(demand(&good, &mv).regen_w, 0.5 * 0.5 / (4.0 * 0.0004));
    close(
        demand(&good, &mv).peak_w,
        0.5 * 500.0 + 0.0004 * 500.0 * 500.0,
    );
}

#[test]
fn the_converter_closest_to_its_limit_is_reported() {
    let mut machine = machine(&[axis(), axis()]);
    machine.converters[0].axes = AxisSet(1);
    machine.converters.push(Converter {
        name: "second".into(),
        axes: AxisSet(2),
        peak_power_w: 200.0,
        regen_power_w: Some(100.0),
        base_load_w: 5.0,
        credit_regen: false,
        ratings: Ratings::default(),
    });
    machine.limits.margin = 0.1;
    machine.loads.push(Load {
        on: vec![(b'M', 8.0)],
        off: vec![(b'M', 9.0)],
        power_w: 30.0,
        converter: 1,
    });
    let mut mv = straight(&machine, &[8.0, 8.0], f64::INFINITY);
    mv.loads = 1;
    let model = PowerModel::new(&machine);
    let found = demand(&machine, &mv);
    // Each axis reaches √(5·0.008) = 0.2 m/s at 500 N: 100 W drawn and fed back.
    assert_eq!(found.converter, 1);
    close(found.peak_w, 135.0);
    close(found.load_ratio, 100.0 / 90.0);
    assert!(!model.fits(&found));
    close(model.limit_w(1), 180.0);
    assert_eq!(model.regen_limit_w(1), Some(90.0));
}

#[test]
fn a_circle_of_unequal_masses_swings() {
    // P = v·(v²/r)·(m_x − m_y)·sin 2θ/2 with credit, at constant feed; speeding
    // up adds at most v·m_x·a.
    let mut machine = machine(&[
        Axis {
            mass_kg: 900.0,
            ..axis()
        },
        axis(),
    ]);
    machine.converters[0].credit_regen = true;
    let mut mv = arc(&machine, [0, 1], 100.0, [0.0, 4.0 * PI], 0.0, 400.0);
    mv.path_accel_mm_s2 = 200.0;
    let found = demand(&machine, &mv);
    let swing = 800.0 * 0.4_f64.powi(3) / 0.1 / 2.0;
    let ramp = 0.4 * 900.0 * 0.2;
    assert!(
        found.peak_w >= swing && found.peak_w <= swing + ramp,
        "{found:?} {swing} {ramp}"
    );
    // All energy comes back.
    assert!(found.energy_j.abs() < 1e-6);
}

#[test]
fn an_unknown_start_is_priced_at_full_speed_and_acceleration() {
    let machine = machine(&[axis()]);
    let mut mv = straight(&machine, &[], f64::INFINITY);
    mv.unknown_start = AxisSet(1);
    close(demand(&machine, &mv).peak_w, 250.0);
}

#[test]
fn extreme_numbers_end_and_are_never_quietly_low() {
    let full = Axis {
        coulomb_n: 10.0,
        viscous_n_s_m: 10.0,
        copper_w_n2: 1e-5,
        efficiency: 0.9,
        gravity_n: -5.0,
        ..axis()
    };
    let machine = machine(&[full, full, full]);
    for length in [1e-300, 1e-9, 1e9, 1e300] {
        for feed in [1e-300, 1.0, 1e300] {
            let straight = straight(&machine, &[length, length], feed);
            let spiral = arc(&machine, [0, 1], 1.0, [0.0, length], 1.0, feed);
            let steep = arc(&machine, [0, 1], length, [0.0, 2.0], length, feed);
            for mv in [straight, spiral, steep] {
                assert!(!demand(&machine, &mv).peak_w.is_nan());
                assert!(!demand(&machine, &mv).regen_w.is_nan());
            }
        }
    }
}

#[test]
fn a_spiral_with_a_slow_start_ends() {
    let mut machine = machine(&[axis(), axis(), axis()]);
    machine.converters[0].credit_regen = true;
    let mut mv = arc(&machine, [0, 1], 5.0, [0.0, 20000.0], 3.0, 120.0);
    mv.path_accel_mm_s2 = 0.1;
    let found = demand(&machine, &mv);
    assert!(found.peak_w > 0.0 && found.peak_w < 50.0, "{found:?}");
}

/// Size of the terms that make up the power of a path: small peaks are small
/// differences of these.
fn gross_w(machine: &Machine, speed_mm_s: f64) -> f64 {
    let axes = machine.axes.iter().flatten();
    axes.map(|axis| {
        let force = axis.mass_kg * axis.accel_mm_s2 * axis.si_per_unit
            + axis.coulomb_n
            + axis.gravity_n.abs();
        speed_mm_s * axis.si_per_unit * force + axis.copper_w_n2 * force * force
    })
    .sum()
}

/// Peaks within 1e-6 above the samples and never below them.
fn peaks_agree(found: f64, sampled: f64, scale: f64) -> Result<(), TestCaseError> {
    prop_assert!(
        found >= sampled * (1.0 - 1e-12) - 1e-12 * scale,
        "{found} is too low, sampled {sampled}"
    );
    let above = found - sampled.max(0.0);
    prop_assert!(
        above <= 1e-6 * sampled.abs() + 1e-9 * scale,
        "{found} is too high, sampled {sampled}"
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn straight_moves_agree_with_sampling(
        machine in any_machine(), delta in any_delta(), feed in any_feed(),
    ) {
        let mv = straight(&machine, &delta, feed);
        let plan = plan(&machine, &mv, Overrides::default());
        let found = PowerModel::new(&machine).demand(&mv, &plan, Want::ALL);
        let scale = gross_w(&machine, plan.top_speed_mm_s);
        let agree = |sampled: &Sampled| {
            peaks_agree(found.peak_w, sampled.peak_w, scale)?;
            peaks_agree(found.regen_w, sampled.regen_w, scale)
        };
        // Few samples may miss the highest of several peaks.
        let sampled = sample(&machine, &mv, &plan, 100);
        if agree(&sampled).is_err() {
            agree(&sample(&machine, &mv, &plan, 20_000))?;
        }
        // Where weights cancel, what is left is rounding.
        let rounding_j = 1e-12 * scale * plan.duration_s;
        let scale_j = found.energy_j.abs() + found.peak_w * plan.duration_s;
        prop_assert!((found.energy_j - sampled.energy_j).abs() <= 1e-4 * scale_j + rounding_j);
    }

    #[test]
    fn arcs_agree_with_sampling(machine in any_machine(), shape in any_arc()) {
        let (plane, radius, angles, lift, feed) = shape;
        let mv = arc(&machine, plane, radius, angles, lift, feed);
        let plan = plan(&machine, &mv, Overrides::default());
        let found = PowerModel::new(&machine).demand(&mv, &plan, Want::ALL);
        let scale = gross_w(&machine, plan.top_speed_mm_s);
        let agree = |sampled: &Sampled| {
            peaks_agree(found.peak_w, sampled.peak_w, scale)?;
            peaks_agree(found.regen_w, sampled.regen_w, scale)
        };
        // Few samples may miss the highest of several peaks.
        let sampled = sample(&machine, &mv, &plan, 600);
        if agree(&sampled).is_err() {
            agree(&sample(&machine, &mv, &plan, 60_000))?;
        }
    }

    #[test]
    fn the_robust_bound_holds(
        machine in any_machine(), delta in any_delta(), feed in any_feed(),
        shape in any_arc(), independent in any::<bool>(),
    ) {
        let mut machine = machine;
        if independent {
            machine.path.rapid = RapidPath::Independent;
        }
        let (plane, radius, angles, lift, arc_feed) = shape;
        let model = PowerModel::new(&machine);
        for mv in [
            straight(&machine, &delta, feed),
            arc(&machine, plane, radius, angles, lift, arc_feed),
        ] {
            let found = demand(&machine, &mv);
            let bound = speed_bound(&machine, &mv, Overrides::default(), Caps::default());
            let robust = model.robust(&mv, &bound, &mv.accel_mm_s2);
            prop_assert!(robust.peak_w >= found.peak_w * (1.0 - 1e-6), "{robust:?} {found:?}");
            prop_assert!(robust.regen_w >= found.regen_w * (1.0 - 1e-6), "{robust:?} {found:?}");
        }
    }

    #[test]
    fn wanting_less_changes_no_peak_of_interest(
        machine in any_machine(), delta in any_delta(), feed in any_feed(),
        shape in any_arc(), floors in [0.0..2.0_f64, 0.0..2.0_f64],
        certificate in prop_oneof![Just(None), Just(Some(Certificate::Robust))],
    ) {
        let (plane, radius, angles, lift, arc_feed) = shape;
        let moves = [
            straight(&machine, &delta, feed),
            arc(&machine, plane, radius, angles, lift, arc_feed),
            straight(&machine, &delta.map(|delta| -0.5 * delta), 2.0 * feed),
        ];
        let all = judged(&machine, &moves, certificate, Want::ALL);
        let peaks = judged(&machine, &moves, certificate, Want::PEAKS);
        let largest = |value: fn(&Demand) -> f64| {
            all.iter().map(|found| value(&found.demand)).fold(0.0, f64::max)
        };
        let scale = largest(|demand| demand.peak_w);
        let want = Want {
            energy: false,
            floor_w: floors[0] * scale,
            regen_floor_w: floors[1] * largest(|demand| demand.regen_w),
            accel: true,
        };
        let pruned = judged(&machine, &moves, certificate, want);
        prop_assert_eq!([all.len(), peaks.len(), pruned.len()], [moves.len(); 3]);
        for (((all, peaks), pruned), mv) in all.iter().zip(&peaks).zip(&pruned).zip(&moves) {
            let plan = plan(&machine, mv, Overrides::default());
            for found in [all, peaks, pruned] {
                prop_assert_eq!(found.duration_s, plan.duration_s);
                prop_assert_eq!(found.top_speed_mm_s, plan.top_speed_mm_s);
                prop_assert_eq!(found.speed_mm_s, plan.speed_limit_mm_s);
            }
            prop_assert!((peaks.demand.peak_w - all.demand.peak_w).abs() <= 1e-12 * scale);
            prop_assert!((peaks.demand.regen_w - all.demand.regen_w).abs() <= 1e-12 * scale);
            for (found, exact, floor) in [
                (pruned.demand.peak_w, all.demand.peak_w, want.floor_w),
                (pruned.demand.regen_w, all.demand.regen_w, want.regen_floor_w),
            ] {
                prop_assert!(found >= exact * (1.0 - 1e-6) || exact <= floor);
                prop_assert!(found <= (exact * (1.0 + 1e-6)).max(floor) + 1e-9 * scale);
            }
        }
    }

    #[test]
    fn the_energy_balance_closes(
        machine in any_machine(), delta in any_delta(), feed in any_feed(),
        independent in any::<bool>(),
    ) {
        let mut machine = machine;
        machine.converters[0].credit_regen = true;
        if independent {
            machine.path.rapid = RapidPath::Independent;
        }
        for axis in machine.axes.iter_mut().flatten() {
            axis.efficiency = 1.0;
            axis.copper_w_n2 = 0.0;
            axis.viscous_n_s_m = 0.0;
        }
        let mv = straight(&machine, &delta, feed);
        let duration = plan(&machine, &mv, Overrides::default()).duration_s;
        let mut expected = machine.converters[0].base_load_w * duration;
        let mut scale = expected;
        for (i, axis) in machine.axes.iter().flatten().enumerate() {
            let metres = mv.end[i] * axis.si_per_unit;
            expected += axis.coulomb_n * metres.abs() + axis.gravity_n * metres;
            scale += (axis.coulomb_n + axis.gravity_n.abs()) * metres.abs();
        }
        let found = demand(&machine, &mv).energy_j;
        prop_assert!((found - expected).abs() <= 1e-9 * scale + 1e-12, "{found} {expected}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20, ..ProptestConfig::default() })]

    #[test]
    fn arc_energy_agrees_with_fine_integration(machine in any_machine(), shape in any_arc()) {
        let (plane, radius, angles, lift, feed) = shape;
        let mv = arc(&machine, plane, radius, angles, lift, feed);
        let plan = plan(&machine, &mv, Overrides::default());
        let found = PowerModel::new(&machine).demand(&mv, &plan, Want::ALL).energy_j;
        let sampled = sample(&machine, &mv, &plan, 4_000);
        let scale = found.abs() + sampled.peak_w * plan.duration_s;
        // Where weights cancel, what is left is rounding.
        let rounding_j = 1e-12 * gross_w(&machine, plan.top_speed_mm_s) * plan.duration_s;
        let off_j = (found - sampled.energy_j).abs();
        prop_assert!(off_j <= 1e-6 * scale + rounding_j, "{found} {}", sampled.energy_j);
    }

    #[test]
    fn straight_energy_agrees_with_fine_integration(
        machine in any_machine(), delta in any_delta(), feed in any_feed(),
    ) {
        let mv = straight(&machine, &delta, feed);
        let plan = plan(&machine, &mv, Overrides::default());
        let found = PowerModel::new(&machine).demand(&mv, &plan, Want::ALL).energy_j;
        let sampled = sample(&machine, &mv, &plan, 1_500);
        let scale = found.abs() + sampled.peak_w * plan.duration_s;
        // Where weights cancel, what is left is rounding.
        let rounding_j = 1e-12 * gross_w(&machine, plan.top_speed_mm_s) * plan.duration_s;
        let off_j = (found - sampled.energy_j).abs();
        prop_assert!(off_j <= 1e-6 * scale + rounding_j, "{found} {}", sampled.energy_j);
    }
}
