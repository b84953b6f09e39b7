//! Several drives on one supply: hand-worked runs, the supply never exceeded, and `gwatt plan`
//! from outside.

mod command;

use std::fmt::Write as _;

use gwatt::machine::Machine;
use gwatt::pipeline::{DriveId, DriveSchedule, DrivesSample, DrivesSummary, Failure, run_drives};
use proptest::prelude::*;

use crate::machines::{linear_axes, machine_from, rotary_axes};

const X: DriveId = DriveId::Axis(0);

/// X and Y of 500 kg, 0.5 m/s and 5 m/s² without friction, and a spindle of 0.02 kg·m².
fn machine(peak_w: f64, axis: &str) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"any\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = {peak_w}\n\
         [limits]\nmargin = 0\n{}{}[spindle]\ninertia_kg_m2 = 0.02\nmax_rpm = 6000\n\
         accel_time_s = 1\n",
        linear_axes("XY", [30000.0, 5000.0, 500.0], axis),
        rotary_axes("A", [36000.0, 3600.0, 1.0])
    ))
}

fn run(
    machine: &Machine,
    schedule: &str,
    period_s: f64,
) -> Result<(DrivesSummary, Vec<DrivesSample>), Failure> {
    let parsed = DriveSchedule::parse(schedule.as_bytes(), machine);
    let parsed = parsed.unwrap_or_else(|found| panic!("{schedule}: {found:?}"));
    let mut samples = Vec::new();
    let summary = run_drives(machine, &parsed, period_s, true, &mut |sample| {
        samples.push(sample.clone());
        Ok(())
    })?;
    Ok((summary, samples))
}

/// When a row is carried out, in s; to a period.
#[track_caller]
fn reached(machine: &Machine, schedule: &str, times: &[f64]) -> DrivesSummary {
    const PERIOD_S: f64 = 5e-4;
    let (summary, _) = run(machine, schedule, PERIOD_S).expect("a run");
    let found = summary.done.iter().map(|done| done.reached_s);
    let found: Vec<f64> = found.map(|time| time.expect("reached")).collect();
    assert_eq!(found.len(), times.len());
    for (found, time) in found.iter().zip(times) {
        let late = found - time;
        assert!(
            (-1e-9..=2.0 * PERIOD_S).contains(&late),
            "{found}, not {time}"
        );
    }
    summary
}

/// 0.5 m/s · 500 kg · 5 m/s² = 1250 W and 0.8 s + 0.1 s over 400 mm.
#[test]
fn a_drive_with_supply_enough_takes_the_optimal_time() {
    let enough = machine(3000.0, "");
    let schedule = "time_s,drive,position_mm\n0,X,400\n0,y,-400\n";
    let summary = reached(&enough, schedule, &[0.9, 0.9]);
    assert!((summary.peak_w - 2500.0).abs() < 20.0, "{}", summary.peak_w);
    assert!(summary.fed_back_w > 2400.0);
    // A largest speed: 0.25 m/s takes 1.6 s + 0.05 s.
    let slow = "time_s,drive,position_mm,speed_mm_min\n0,X,400,15000\n";
    reached(&enough, slow, &[1.65]);
    // 360° at 600°/s and 3600°/s²: 0.6 s + 0.6/3.6 s.
    let turn = "time_s,drive,position_deg\n0,A,360\n";
    reached(&enough, turn, &[0.6 + 1.0 / 6.0]);
    let gentle = "time_s,drive,position_mm,accel_mm_s2\n0,X,400,2500\n";
    reached(&enough, gentle, &[1.0]);
}

/// 500 W: 5 m/s² to 0.2 m/s, then v·v' = 1 m²/s³ to 0.5 m/s: 0.04 s + 0.105 s over 4 mm + 39 mm;
/// 0.1 s of braking over 25 mm.
#[test]
fn a_small_supply_is_a_region_of_constant_power() {
    let summary = reached(
        &machine(500.0, ""),
        "time_s,drive,position_mm\n0,X,400\n",
        &[0.245 + 0.332 / 0.5],
    );
    assert!((summary.peak_w - 500.0).abs() < 1e-6);
    // The same by the schedule, of the drive or of all.
    let enough = machine(5000.0, "");
    for rows in ["0,X,400,500", "0,all,,500\n0,X,400,"] {
        let schedule = format!("time_s,drive,position_mm,power_w\n{rows}\n");
        reached(&enough, &schedule, &[0.245 + 0.332 / 0.5]);
    }
}

/// Each has 250 W: 0.02 s over 1 mm, v·v' = 0.5 m²/s³ to 0.5 m/s in 0.24 s over 82.67 mm.
#[test]
fn drives_that_start_together_have_equal_shares() {
    let way = 0.4 - 0.001 - (0.125 - 0.001) / 1.5 - 0.025;
    let time = 0.02 + 0.24 + 0.1 + way / 0.5;
    let summary = reached(
        &machine(500.0, ""),
        "time_s,drive,position_mm\n0,X,400\n0,Y,400\n",
        &[time, time],
    );
    assert!(summary.exceeded_s.is_none());
}

/// Y comes while X speeds up: X keeps what it cannot do without, and both together never take
/// more than there is.
#[test]
fn who_comes_later_gets_what_is_left() {
    let small = machine(500.0, "jerk_mm_s3 = 50000");
    let schedule = "time_s,drive,position_mm\n0,X,400\n0.06,Y,400\n";
    let (summary, samples) = run(&small, schedule, 1e-3).expect("a run");
    let most = samples.iter().map(|it| it.power_w).fold(0.0, f64::max);
    assert!(most <= 500.0 * (1.0 + 1e-9), "{most}");
    assert!(most > 495.0, "{most}");
    let times = summary
        .done
        .iter()
        .map(|done| done.reached_s.expect("reached"));
    let times: Vec<f64> = times.collect();
    let (alone, _) = run(&small, "time_s,drive,position_mm\n0,X,400\n", 1e-3).expect("a run");
    let alone_s = alone.done[0].reached_s.expect("reached");
    assert!(
        alone_s < times[0] && times[0] < times[1],
        "{alone_s} {times:?}"
    );
}

/// X holds its speed while the spindle has all of the supply: it goes no faster before the spindle
/// has done with it, and where it turns it keeps what it has left of its acceleration there.
#[test]
fn a_moving_drive_without_a_share_goes_on_as_it_is() {
    let header = "time_s,drive,position_mm,speed_mm_min,speed_rpm\n";
    for (axis, rows) in [
        ("", "0,X,,21000,\n0.2,spindle,,,5600\n0.3,X,280,30000,\n"),
        (
            "jerk_mm_s3 = 30000",
            "0,X,,3000,\n0.002,spindle,,,3360\n0.16,X,-362,3000,\n",
        ),
    ] {
        let small = machine(470.0, axis);
        let (_, samples) = run(&small, &format!("{header}{rows}"), 1e-3).expect("a run");
        let most = samples.iter().map(|it| it.power_w).fold(0.0, f64::max);
        assert!(most <= 470.0 * (1.0 + 1e-9), "{most}");
    }
}

/// Targets, limits and periods change in flight.
#[test]
fn everything_may_change_in_flight() {
    let enough = machine(9000.0, "jerk_mm_s3 = 50000");
    let schedule = "time_s,drive,position_mm,speed_mm_min,speed_rpm,accel_mm_s2,period_ms\n\
                    0,X,,30000,,,\n0,spindle,,,6000,,\n0.3,all,,,,,0.5\n0.5,X,100,,,,\n\
                    0.55,X,,,,2000,\n0.6,spindle,,,-3000,,\n2.5,X,,-6000,,,\n";
    let (summary, samples) = run(&enough, schedule, 2e-3).expect("a run");
    assert!(summary.done[0].reached_s.is_some_and(|time| time < 0.3));
    assert!(
        summary
            .done
            .last()
            .is_some_and(|done| done.reached_s.is_some())
    );
    let period = |at: f64| {
        let mut after = samples.windows(2).filter(|two| two[0].time_s >= at);
        after.next().map(|two| two[1].time_s - two[0].time_s)
    };
    assert!(period(0.1).is_some_and(|it| (it - 2e-3).abs() < 1e-9));
    assert!(period(0.4).is_some_and(|it| (it - 5e-4).abs() < 1e-9));
    for sample in &samples {
        let x = sample.drives.iter().find(|drive| drive.id == X).expect("X");
        assert!(x.jerk.abs() <= 50_000.0 * (1.0 + 1e-6));
        let most = if sample.time_s > 0.7 && sample.time_s < 2.5 {
            2000.0
        } else {
            5000.0
        };
        assert!(x.motion.accel.abs() <= most * (1.0 + 1e-9), "{sample:?}");
    }
    // It had passed 100 mm by then, and comes back.
    let at = |time: f64| {
        let sample = samples.iter().find(|sample| sample.time_s >= time);
        sample.map_or(f64::NAN, |sample| sample.drives[0].position)
    };
    assert!(at(0.5) > 150.0 && (at(2.49) - 100.0).abs() < 1e-6);
}

/// A supply that is lowered below what drives cannot do without is exceeded, and that is said.
#[test]
fn a_supply_that_does_not_suffice_is_named() {
    let rubs = machine(3000.0, "coulomb_n = 400");
    let schedule = "time_s,drive,speed_mm_min,power_w\n0,X,30000,\n1,all,,100\n2,X,0,\n";
    let (summary, _) = run(&rubs, schedule, 1e-3).expect("a run");
    // 0.5 m/s · 400 N = 200 W.
    assert!(
        summary
            .exceeded_s
            .is_some_and(|time| (time - 1.0).abs() < 2e-3)
    );
    let unreachable = "time_s,drive,speed_mm_min,power_w\n0,all,,100\n0,X,30000,\n";
    let Err(Failure::Refused { diagnostics, .. }) = run(&rubs, unreachable, 1e-3) else {
        panic!("100 W carry no 200 W of friction");
    };
    assert_eq!(diagnostics[0].rule, "schedule-power");
}

/// Machines and schedules of any kind.
fn any_case() -> impl Strategy<Value = (Machine, String, f64)> {
    let axis = (
        0.0..900.0_f64,
        0.0..500.0_f64,
        0.3..1.0_f64,
        0.0..1e-4_f64,
        0..3_usize,
    );
    let command = (
        0.0..0.4_f64,
        0..4_usize,
        -500.0..500.0_f64,
        0.1..1.0_f64,
        any::<bool>(),
    );
    let rows = prop::collection::vec(command, 1..8);
    (axis, rows, 0.3..3.0_f64, 1..4).prop_map(|(axis, rows, supply, period)| {
        let (coulomb, viscous, efficiency, copper, jerk) = axis;
        let jerk = ["", "jerk_mm_s3 = 30000", "jerk_mm_s3 = 200000"][jerk];
        // What all hold at their largest speeds, and what lets them start.
        let hold = 2.0 * (0.5 * (coulomb + 0.5 * viscous) / efficiency);
        let force = 2500.0 + coulomb + 0.5 * viscous;
        let reserve = 2.0 * copper * force * force;
        let peak_w = 20.0 + hold + reserve + 1500.0 * supply;
        let axis = format!(
            "coulomb_n = {coulomb:.3}\nviscous_n_s_m = {viscous:.3}\nefficiency = {efficiency:.3}\n\
             copper_w_n2 = {copper:.7}\n{jerk}"
        );
        let mut schedule = String::from("time_s,drive,position_mm,speed_mm_min,speed_rpm\n");
        let mut now_s = 0.0;
        for (after, drive, target, share, holds) in rows {
            now_s += 0.001 + after;
            let target = target.round();
            let speed = (30_000.0 * share).round();
            let row = match drive {
                0 | 1 if holds => format!("{},,{},", ["X", "Y"][drive], speed.copysign(target)),
                0 | 1 => format!("{},{target},{speed},", ["X", "Y"][drive]),
                _ => format!("spindle,,,{}", target * 12.0),
            };
            let _ = writeln!(schedule, "{now_s:.4},{row}");
        }
        (machine(peak_w, &axis), schedule, f64::from(period) * 1e-3)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// At no time do drives take more than there is, and none exceeds its own limits.
    #[test]
    fn the_supply_is_never_exceeded((machine, schedule, period_s) in any_case()) {
        let (summary, samples) = match run(&machine, &schedule, period_s) {
            Ok(found) => found,
            Err(failure) => return Err(TestCaseError::fail(format!("{schedule}: {failure:?}"))),
        };
        let limit_w = machine.converters[0].peak_power_w;
        for sample in &samples {
            prop_assert!(sample.power_w <= limit_w * (1.0 + 1e-9), "{schedule}{sample:?}");
            for drive in &sample.drives {
                if let DriveId::Axis(axis) = drive.id {
                    let own = machine.axes[axis].expect("an axis");
                    prop_assert!(drive.motion.accel.abs() <= own.accel_mm_s2 * (1.0 + 1e-9));
                    prop_assert!(drive.motion.speed.abs() <= own.rapid_mm_s * (1.0 + 1e-9));
                }
            }
        }
        prop_assert!(summary.exceeded_s.is_none());
        prop_assert!(summary.done.iter().rev().take(1).all(|done| done.reached_s.is_some()));
    }
}
