//! The spindle: what its runs take and draw, and `gwatt spindle` from outside.

mod command;

use gwatt::machine::{Spindle, SpindleWait, TorquePoint};
use gwatt::plan::SpindleDrive;
use gwatt::plan::period::{Motion, Ramp};
use gwatt::power::{SpindlePower, spindle_run};
use proptest::prelude::*;

use crate::near::assert_near;

const RAD_S_PER_RPM: f64 = std::f64::consts::TAU / 60.0;

/// 0.1 kg·m², 3000/min in one second, without friction, jerk limit and losses.
fn plain() -> Spindle {
    Spindle {
        inertia_kg_m2: 0.1,
        friction_nm: 0.0,
        max_rpm: 3000.0,
        base_rpm: 0.0,
        accel_time_s: Some(1.0),
        torque_curve: Vec::new(),
        jerk_time_s: 0.0,
        efficiency: 1.0,
        base_load_w: 0.0,
        peak_power_w: None,
        regen_power_w: None,
        wait: SpindleWait::Feeds,
        converter: 0,
        cutting_power_w: 0.0,
    }
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert_near(found, expected, 1e-6 * expected.abs().max(1e-6));
}

/// 314.159 rad/s² and 0.1 kg·m² are 31.4159 N·m, at 314.159 rad/s 9869.6 W;
/// ½·0.1·314.159² = 4934.8 J.
#[test]
fn constant_torque() {
    let run = spindle_run(&plain(), 0.0, 3000.0).unwrap();
    near(run.duration_s, 1.0);
    near(run.peak_w, 9869.604);
    near(run.energy_j, 4934.802);
    assert_eq!(run.regen_w, 0.0);
    let back = spindle_run(&plain(), 3000.0, 0.0).unwrap();
    near(back.regen_w, 9869.604);
    near(back.energy_j, -4934.802);
}

/// `V_f/A + (V_max² − V_f²)/(2·A·V_f)` = (1000 + 4000)/A = 1 s: A = 5000/min per s,
/// 52.36 N·m, and 5483.11 W from 1000/min on.
#[test]
fn constant_power() {
    let spindle = Spindle {
        base_rpm: 1000.0,
        ..plain()
    };
    let run = spindle_run(&spindle, 0.0, 3000.0).unwrap();
    near(run.duration_s, 1.0);
    near(run.peak_w, 5483.114);
    let [torque, power] = &run.phases[..] else {
        panic!("{run:?}");
    };
    near(torque.duration_s, 0.2);
    near(torque.start.accel, 5000.0);
    near(power.least_w, power.peak_w);
    near(run.energy_j, 4934.802);
}

/// 80 % efficiency and 100 W of base load; 3 N·m of friction over
/// 314.159/2 rad are 471.24 J.
#[test]
fn losses() {
    let spindle = Spindle {
        friction_nm: 3.0,
        efficiency: 0.8,
        base_load_w: 100.0,
        ..plain()
    };
    let run = spindle_run(&spindle, 0.0, 3000.0).unwrap();
    near(run.peak_w, 100.0 + (31.415_93 + 3.0) * 314.159_27 / 0.8);
    near(run.energy_j, 100.0 + (4934.802 + 471.238_9) / 0.8);
    let back = spindle_run(&spindle, 3000.0, 0.0).unwrap();
    near(back.regen_w, (31.415_93 - 3.0) * 314.159_27 * 0.8 - 100.0);
    near(back.energy_j, 100.0 - (4934.802 - 471.238_9) * 0.8);
}

/// A reversal brakes first and drives then.
#[test]
fn a_reversal_feeds_back_and_draws() {
    let run = spindle_run(&plain(), 3000.0, -3000.0).unwrap();
    near(run.duration_s, 2.0);
    near(run.peak_w, 9869.604);
    near(run.regen_w, 9869.604);
    assert!(run.energy_j.abs() < 1e-6);
}

#[test]
fn a_torque_curve_drives_less_and_brakes_more_by_the_friction() {
    let torque_curve = [(0.0, 20.0), (1000.0, 20.0), (3000.0, 8.0)];
    let point = |(rpm, torque_nm)| TorquePoint { rpm, torque_nm };
    let spindle = Spindle {
        accel_time_s: None,
        torque_curve: torque_curve.map(point).to_vec(),
        friction_nm: 2.0,
        ..plain()
    };
    let drive = SpindleDrive::new(&spindle).unwrap();
    near(drive.limits().drive.at(0.0) * RAD_S_PER_RPM, 180.0);
    near(drive.limits().brake.at(2000.0) * RAD_S_PER_RPM, 160.0);
    let up = spindle_run(&spindle, 0.0, 3000.0).unwrap();
    let down = spindle_run(&spindle, 3000.0, 0.0).unwrap();
    assert!(down.duration_s < up.duration_s);
    // (14 − 0.006·(n − 2000))·ω has its largest value at n = 2166.7: 13 N·m.
    near(up.peak_w, 13.0 * 6500.0 / 3.0 * RAD_S_PER_RPM);
}

#[test]
fn largest_powers_are_kept() {
    let spindle = Spindle {
        friction_nm: 2.0,
        efficiency: 0.9,
        base_load_w: 50.0,
        jerk_time_s: 0.05,
        peak_power_w: Some(4000.0),
        regen_power_w: Some(2000.0),
        ..plain()
    };
    let up = spindle_run(&spindle, 0.0, 3000.0).unwrap();
    near(up.peak_w, 4000.0);
    let down = spindle_run(&spindle, 3000.0, 0.0).unwrap();
    assert!(down.regen_w <= 2000.0 - 50.0 + 1e-6, "{}", down.regen_w);
    assert!(down.regen_w >= 0.95 * 1950.0, "{}", down.regen_w);
}

fn spindles() -> impl Strategy<Value = Spindle> {
    let numbers = (
        0.01..1.0,
        0.0..3.0,
        prop_oneof![Just(0.0), 200.0..3000.0],
        0.3..5.0,
        0.0..0.3,
        0.6..1.0,
    );
    let powers = prop::option::of(2000.0..9000.0);
    (numbers, powers).prop_map(
        |((inertia, friction, base, time, jerk, efficiency), power)| Spindle {
            inertia_kg_m2: inertia,
            friction_nm: friction,
            base_rpm: base,
            accel_time_s: Some(time),
            jerk_time_s: jerk,
            efficiency,
            base_load_w: 80.0,
            peak_power_w: power,
            ..plain()
        },
    )
}

proptest! {
    /// Without a power limit, the time to the largest speed is the one given.
    #[test]
    fn the_acceleration_fits_its_time(spindle in spindles()) {
        let spindle = Spindle { peak_power_w: None, ..spindle };
        let run = spindle_run(&spindle, 0.0, spindle.max_rpm).unwrap();
        let time = spindle.accel_time_s.unwrap();
        prop_assert!((run.duration_s - time).abs() <= 1e-9 * time, "{}", run.duration_s);
    }

    /// Peaks are those of a fine comb, and the energy is its integral; without
    /// losses the balance closes: kinetic change, friction, base load.
    #[test]
    fn figures_are_exact(spindle in spindles(), from in -3000.0..3000.0, to in -3000.0..3000.0) {
        let drive = SpindleDrive::new(&spindle).unwrap();
        let start = Motion { speed: from, accel: 0.0 };
        let ramp = Ramp::new(start, to, drive.limits());
        let power = SpindlePower::new(&spindle);
        let run = power.run(&ramp);
        let (mut most, mut least, mut energy) = (80.0_f64, f64::INFINITY, 0.0);
        for phase in &ramp.phases {
            let steps = 2000;
            let dt = phase.duration_s / f64::from(steps);
            for step in 0..=steps {
                let w = power.electrical_w(phase.at(f64::from(step) * dt));
                most = most.max(w);
                least = least.min(w);
                let weight = if step == 0 || step == steps { 0.5 } else { 1.0 };
                energy += w * dt * weight;
            }
        }
        let size = most.max(-least);
        prop_assert!(run.peak_w >= most - 1e-6 * size && run.peak_w <= most + 1e-4 * size);
        prop_assert!(run.regen_w >= -least - 1e-6 * size && run.regen_w <= (-least).max(0.0) + 1e-4 * size);
        let scale = size * run.duration_s;
        prop_assert!((run.energy_j - energy).abs() <= 1e-4 * scale, "{} {energy}", run.energy_j);

        let lossless = Spindle { efficiency: 1.0, ..spindle.clone() };
        let energy = SpindlePower::new(&lossless).run(&ramp).energy_j;
        let kinetic = 0.5 * spindle.inertia_kg_m2 * (to * to - from * from) * RAD_S_PER_RPM.powi(2);
        let turned: f64 = ramp.phases.iter().map(|phase| {
            // Through rest the angle turns back.
            let parts = 4000;
            let dt = phase.duration_s / f64::from(parts);
            (0..parts).map(|i| phase.at((f64::from(i) + 0.5) * dt).speed.abs() * dt).sum::<f64>()
        }).sum();
        let friction = spindle.friction_nm * turned * RAD_S_PER_RPM;
        let balance = kinetic + friction + 80.0 * run.duration_s;
        prop_assert!((energy - balance).abs() <= 1e-5 * scale, "{energy} {balance}");
    }
}

#[test]
fn without_friction_the_balance_closes_to_the_last_digits() {
    let spindle = Spindle {
        base_rpm: 700.0,
        jerk_time_s: 0.13,
        ..plain()
    };
    for (from, to) in [(0.0, 3000.0), (2500.0, -1800.0), (-3000.0, 10.0)] {
        let run = spindle_run(&spindle, from, to).unwrap();
        let kinetic = 0.05 * (to * to - from * from) * RAD_S_PER_RPM.powi(2);
        assert!((run.energy_j - kinetic).abs() <= 1e-9 * 4934.8);
    }
}
