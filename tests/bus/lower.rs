//! Lower overrides next to a run of the spindle: moves come later, and runs end sooner.

use std::fmt::Write as _;

use gwatt::machine::Machine;
use gwatt::pipeline::Options;
use proptest::prelude::*;

use super::{FULL_W, machine, run, with_limits};
use crate::runs::turned;

/// X goes 50 mm and back, each in 0.447 s; its peak is 223.6 W. The run takes a second.
const THERE_AND_BACK: &str = "S3000\nM3\nG1 X50 F18000\nG0 X0\nG4 P2\n";

#[test]
fn a_rapid_that_comes_later_meets_the_end_of_the_run() {
    let machine = machine("iso", "", "wait = false", "");
    let (rows, _) = run(&machine, THERE_AND_BACK, &Options::default());
    // At the largest overrides the rapid is over after 0.894 s.
    let largest_w = FULL_W * 0.8_f64.sqrt();
    assert!(
        (rows[1].peak_w - largest_w).abs() < 1.0,
        "{}",
        rows[1].peak_w
    );
    // With the feed at 23.6 % its peak comes next to the end of the run.
    let most_w = FULL_W + 1000.0 * 0.05_f64.sqrt();
    let (rows, _) = run(
        &turned(&machine, [0.2363, 1.0, 1.0]),
        THERE_AND_BACK,
        &Options::default(),
    );
    assert!(rows[1].peak_w > most_w - 10.0, "{}", rows[1].peak_w);
    let fits = |limit_w: f64| {
        run(
            &with_limits(&machine, [limit_w; 2]),
            THERE_AND_BACK,
            &Options::default(),
        )
    };
    let (rows, summary) = fits(most_w - 10.0);
    assert!(summary.unfit_count > 0);
    assert!((rows[1].peak_w - most_w).abs() < 15.0, "{}", rows[1].peak_w);
    let (rows, summary) = fits(most_w + 5.0);
    assert_eq!(summary.unfit_count, 0);
    // What fits at any override is shown at the largest.
    assert!(
        (rows[1].peak_w - largest_w).abs() < 1.0,
        "{}",
        rows[1].peak_w
    );
}

#[test]
fn the_first_rapid_after_a_command_speeds_up_when_it_always_does() {
    // It speeds up in 0.1 s, whatever the override: no lower one is worse than 987 + 100 W,
    // and the run alone draws more later.
    let machine = machine("iso", "", "wait = false", "");
    let program = "S3000\nM3\nG0 X10\nG4 P2\n";
    let (_, summary) = run(
        &with_limits(&machine, [FULL_W + 1.0; 2]),
        program,
        &Options::default(),
    );
    assert_eq!(summary.unfit_count, 0);
}

/// From 3000/min to as much in the other direction: a second of braking and one of speeding
/// up. At 30 % it speeds up from 0.3 s to 0.6 s; the rapid speeds up until 0.624 s.
#[test]
fn a_spindle_that_turns_round_does_so_sooner_when_turned_down() {
    let machine = machine("iso", "", "wait = false", "");
    let program = "S3000\nM3\nG4 P2\nM4\nG4 P0.4\nG0 X50\nG4 P3\n";
    let (rapid_w, turned_w) = (1000.0 * 0.05_f64.sqrt(), 0.3 * FULL_W);
    let rapid = |machine: &Machine| {
        let (rows, summary) = run(machine, program, &Options::default());
        (rows[2].clone(), summary)
    };
    let (row, _) = rapid(&machine);
    assert!((row.peak_w - rapid_w).abs() < 1e-6, "{row:?}");
    let (row, _) = rapid(&turned(&machine, [1.0, 1.0, 0.3]));
    assert!(row.peak_w > turned_w + 0.8 * rapid_w, "{row:?}");
    // At any override it may be anywhere on its run.
    let (row, summary) = rapid(&with_limits(&machine, [FULL_W + 1.0; 2]));
    assert!(summary.unfit_count > 0);
    assert!((row.peak_w - FULL_W - rapid_w).abs() < 1.0, "{row:?}");
    let (_, summary) = rapid(&with_limits(&machine, [FULL_W + rapid_w + 1.0; 2]));
    assert_eq!(summary.unfit_count, 0);
}

/// A line of a program.
fn any_line() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => (-300..300_i32).prop_map(|x| format!("G0 X{x}")),
        2 => (-300..300_i32, -300..300_i32).prop_map(|(x, z)| format!("G0 X{x} Z{z}")),
        3 => (-300..300_i32, 500..40000_u32).prop_map(|(x, f)| format!("G1 X{x} F{f}")),
        1 => (1..50_i32).prop_map(|r| format!("G91 G2 X{r} Y{r} I{r} F9000\nG90")),
        1 => (1..10_u32).prop_map(|t| format!("G4 P0.{t}")),
        2 => (100..3000_u32).prop_map(|s| format!("S{s}")),
        1 => prop_oneof![Just("M3"), Just("M4"), Just("M5")].prop_map(str::to_owned),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// What fits at every override fits at each.
    #[test]
    fn what_fits_at_all_overrides_fits_at_each(
        lines in prop::collection::vec(any_line(), 2..9),
        kind in 0..5_usize,
        wait in prop::sample::select(vec!["false", "true"]),
        credit in any::<bool>(),
        knobs in prop::collection::vec((0.02..1.0_f64, 0.02..1.0_f64, 0.02..1.0_f64), 6),
        tight in 0.0..1.0_f64,
    ) {
        let (controller, rest) = [
            ("iso", ""),
            ("iso", "[path]\nrapid = \"independent\""),
            ("iso", ""),
            ("linuxcnc", ""),
            ("grbl", ""),
        ][kind];
        let converter = format!("credit_regen = {credit}");
        let jerk = if kind == 2 { "jerk_time_s = 0.2\n" } else { "" };
        let spindle = format!("{jerk}friction_nm = 3\nbase_rpm = 1500\nwait = {wait}\nefficiency = 0.9");
        let machine = machine(controller, &converter, &spindle, rest);
        let mut program = String::from("S2500\nM3\n");
        for line in &lines {
            let _ = writeln!(program, "{line}");
        }
        let options = Options::default();
        let settings = knobs.iter().flat_map(|&(feed, rapid, spindle)| {
            let axes = [[feed, feed], [feed, 1.0], [1.0, rapid], [feed, rapid], [1.0, 1.0]];
            axes.map(|[feed, rapid]| [feed, rapid, spindle])
        });
        let peaks = |machine: &Machine| {
            let (rows, _) = run(machine, &program, &options);
            rows.iter().fold([0.0_f64; 2], |peaks, row| {
                [peaks[0].max(row.peak_w), peaks[1].max(row.regen_w)]
            })
        };
        let found: Vec<[f64; 2]> = settings.map(|knobs| peaks(&turned(&machine, knobs))).collect();
        let own = peaks(&machine);
        // Between what the largest overrides ask for and what others do.
        for side in [0, 1] {
            let most = found.iter().fold(own[side], |most, peaks| most.max(peaks[side]));
            let limit_w = own[side] + tight * (most - own[side]);
            if limit_w * (1.0 + 1e-6) >= most || limit_w <= 0.0 {
                continue;
            }
            let mut limited = with_limits(&machine, [1e6; 2]);
            for converter in &mut limited.converters {
                if side == 0 {
                    converter.peak_power_w = limit_w;
                } else {
                    converter.regen_power_w = Some(limit_w);
                }
            }
            let (_, summary) = run(&limited, &program, &options);
            prop_assert!(
                summary.unfit_count > 0,
                "side {side}: fits {limit_w}, but another override asks for {most}\n{program}"
            );
        }
    }
}
