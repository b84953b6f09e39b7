//! The spindle on the same bus as the axes.

mod lower;
mod order;
mod over_time;
mod random;
mod series;
mod siemens;
mod surface;

use std::io::Cursor;

use crate::rows::Rows;
use gwatt::interpret::{MoveKind, Reading, Start};
use gwatt::machine::Machine;
use gwatt::pipeline::{Allowed, LimitOptions, LimitSummary, Options, Row, Summary, analyze, limit};
use gwatt::plan::SpindleDrive;
use gwatt::plan::period::{Motion, Ramp};
use gwatt::power::{SpindlePower, spindle_run};

/// 3000/min in one second with 0.1 kg·m²: 31.416 N·m, 9869.604 W at the end.
const FULL_W: f64 = 9_869.604_401_089_358;

/// A machine under `controller`: X and Z of 1000 kg, 1 m/s² and 1 m/s, and a
/// spindle; `rest` stands at its end.
fn machine(controller: &str, converter: &str, spindle: &str, rest: &str) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n\
         [converter]\npeak_power_w = 1e5\nregen_power_w = 1e5\n{converter}\n{}\
         [spindle]\ninertia_kg_m2 = 0.1\nmax_rpm = 3000\naccel_time_s = 1\n{spindle}\n\
         [limits]\nmargin = 0\n{rest}\n",
        linear_axes("XYZ", [60000.0, 1000.0, 1000.0], "")
    ))
}

fn iso(spindle: &str) -> Machine {
    machine("iso", "", spindle, "")
}

fn run(machine: &Machine, program: &str, options: &Options) -> (Vec<Row>, Summary) {
    let mut rows = Rows::default();
    let program = format!("G21 G90\n{program}M2\n");
    let summary = analyze(Cursor::new(program), machine, options, Some(&mut rows));
    (
        rows.0,
        summary.unwrap_or_else(|failure| panic!("{failure:?}")),
    )
}

/// The machine with these limits: drawn and fed back.
fn with_limits(machine: &Machine, limits_w: [f64; 2]) -> Machine {
    let mut limited = machine.clone();
    for converter in &mut limited.converters {
        converter.peak_power_w = limits_w[0];
        converter.regen_power_w = Some(limits_w[1]);
    }
    limited
}

fn rows(machine: &Machine, program: &str) -> Vec<Row> {
    run(machine, program, &Options::default()).0
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert_near(found, expected, 2e-7 * expected.abs().max(1e-6));
}

#[track_caller]
fn peaks(rows: &[Row], expected: &[(MoveKind, f64)]) {
    let kinds: Vec<MoveKind> = rows.iter().map(|row| row.kind).collect();
    let wanted: Vec<MoveKind> = expected.iter().map(|(kind, _)| *kind).collect();
    assert_eq!(kinds, wanted, "{rows:#?}");
    for (row, (_, peak_w)) in rows.iter().zip(expected) {
        near(row.peak_w, *peak_w);
    }
}

use MoveKind::{Dwell, Feed, Rapid, Tap};

use crate::machines::{linear_axes, machine_from};
use crate::near::assert_near;
use crate::runs::WITH_FEEDS;

/// The run-up ends with the ramp of the rapid: 9869.6 W and 1000 W at once.
#[test]
fn a_run_up_overlaps_a_rapid() {
    let found = rows(&iso(""), "M3 S3000\nG0 X2000\nG1 X1000 F6000\n");
    peaks(&found, &[(Rapid, FULL_W + 1000.0), (Feed, 100.0)]);
    // It takes ½·J·ω² = 4934.8 J, and the rapid ½·m·v² = 500 J.
    near(found[0].energy_j, 0.5 * FULL_W + 500.0);
}

/// In half a second it ends in the middle of the ramp: 500 W more; half as fast
/// it is at its half when the ramp ends.
#[test]
fn the_peaks_do_not_add_up_where_they_do_not_meet() {
    let with = |spindle: &str, program: &str| rows(&iso(spindle), program)[0].peak_w;
    // 62.8 N·m: half a second.
    let mut quick = iso("");
    if let Some(spindle) = &mut quick.spindle {
        spindle.accel_time_s = Some(0.5);
    }
    let found = rows(&quick, "M3 S3000\nG0 X2000\n");
    near(found[0].peak_w, 2.0 * FULL_W + 500.0);
    let short = with("", "M3 S3000\nG0 X250\n");
    // v = √(1·0.25) = 0.5 m/s at 0.5 s: 500 W next to half of the run-up's power;
    // at its end, after 1 s, the run-up alone.
    near(short, FULL_W);
    let shorter = with("", "M3 S3000\nG0 X90\n");
    // 0.3 s up and 0.3 s down: 300 + 0.3·9869.6 at the top, 0.6·9869.6 at the end.
    near(shorter, 0.6 * FULL_W);
}

/// The sum of a fall and a rise has its largest value inside: with jerk the power
/// of the run-up falls off while that of the rapid still grows.
#[test]
fn a_peak_inside_is_found() {
    let spindle = "jerk_time_s = 0.5";
    let found = rows(&iso(spindle), "M3 S3000\nG0 X2000\n");
    let machine = iso(spindle);
    let drive = SpindleDrive::new(machine.spindle.as_ref().unwrap()).unwrap();
    let ramp = Ramp::new(Motion::default(), 3000.0, drive.limits());
    let power = SpindlePower::new(machine.spindle.as_ref().unwrap());
    let sum = |t: f64| power.electrical_w(ramp.at(t).0) + 1000.0 * t;
    let largest = (0..=1_000_000).map(|i| sum(f64::from(i) * 1e-6));
    near(found[0].peak_w, largest.fold(0.0, f64::max));
}

/// Feeds wait for the speed, and the wait is a row of its own.
#[test]
fn feeds_wait_where_the_machine_does() {
    let found = rows(&iso("wait = true"), "M3 S3000\nG1 X1000 F6000\nM5\nG1 X0\n");
    let spindle = MoveKind::Spindle;
    peaks(&found, &[(spindle, FULL_W), (Feed, 100.0), (Feed, 100.0)]);
    assert_eq!(found[0].duration_s, 1.0);
    near(found[0].energy_j, 0.5 * FULL_W);
    assert_eq!(found[0].line, 3);
    assert_eq!(found[1].start_s, 1.0);
    // Nothing waits for a stop.
    near(found[2].regen_w, FULL_W);

    // A rapid of 0.6 s takes part of the run: the feed waits for the rest.
    let found = rows(&iso(""), "M3 S3000\nG0 X90\nG1 X1000 F6000\n");
    assert_eq!(found[1].kind, spindle);
    near(found[1].duration_s, 0.4);
    near(found[1].energy_j, (0.5 - 0.5 * 0.36) * FULL_W);

    let found = rows(&iso("wait = false"), "M3 S3000\nG1 X1000 F6000\n");
    peaks(&found, &[(Feed, FULL_W)]);
}

/// Where it is not known what waits, the run may lie over any move that follows.
#[test]
fn where_nothing_is_known_both_count() {
    let fanuc = machine("fanuc", "", "", "");
    let found = rows(&fanuc, "M3 S3000\nG0 X90.\nX0.\nG1 X1000. F6000.\n");
    let top = FULL_W + 300.0;
    // It is over after one second of moves at the latest only if nothing waits.
    peaks(&found[..3], &[(Rapid, top), (Rapid, top), (Feed, 100.0)]);
    // The machine file may say it.
    let waits = machine("fanuc", "", "wait = true", "");
    let found = rows(&waits, "M3 S3000\nG1 X1000. F6000.\n");
    peaks(&found, &[(MoveKind::Spindle, FULL_W), (Feed, 100.0)]);
}

/// A constant friction of 10 N·m at 3000/min is 3141.6 W from the time at which
/// the speed is reached; a switched load and the base load of the drive count.
#[test]
fn a_steady_spindle_is_a_load() {
    let machine = machine(
        "iso",
        "base_load_w = 50",
        "friction_nm = 10\nefficiency = 0.8\nbase_load_w = 25",
        "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 100\n",
    );
    let held = 10.0 * 3000.0 * std::f64::consts::TAU / 60.0 / 0.8;
    let found = rows(
        &machine,
        "M3 S3000 M8\nG4 P3\nG0 X2000\nM5 M9\nG4 P3\nG0 X0\n",
    );
    assert_eq!(found[0].kind, Dwell);
    near(found[1].peak_w, 175.0 + held + 1000.0);
    near(
        found[1].energy_j,
        (175.0 + held) * found[1].duration_s + 500.0,
    );
    near(found[3].peak_w, 75.0 + 1000.0);
}

/// Facing at constant surface speed: P = J·V²·vr/r³ at the smallest radius.
#[test]
fn facing_at_constant_surface_speed() {
    let lathe = machine("linuxcnc", "", "", "");
    let program = "G18 G61.1 G8\nG0 X50\nG96 D3000 S100 M3\nG4 P5\nG1 X20 F1800\nG1 X50\n";
    let found = rows(&lathe, program);
    let v = 100.0 / 60.0;
    let peak = 0.1 * v * v * 0.03 / (0.02_f64).powi(3);
    let facing = &found[2];
    near(facing.peak_w, peak + 30.0);
    // ½·J·(ω₂² − ω₁²) and ½·m·v² of the slide.
    let kinetic = |r: f64| 0.5 * 0.1 * (v / r) * (v / r);
    near(
        facing.energy_j,
        kinetic(0.02) - kinetic(0.05) + 0.5 * 1000.0 * 0.03 * 0.03,
    );
    near(found[3].regen_w, peak + 30.0);

    // The clamp: below the radius of 31.8 mm the speed stays at 500/min.
    let found = rows(&lathe, &program.replace("D3000", "D500"));
    let clamp = v / (500.0 * std::f64::consts::TAU / 60.0);
    near(found[2].peak_w, 0.1 * v * v * 0.03 / clamp.powi(3) + 30.0);
    near(
        found[2].energy_j,
        kinetic(clamp) - kinetic(0.05) + 0.5 * 1000.0 * 0.03 * 0.03,
    );

    // What the drive cannot follow counts with full torque over all speeds on
    // the way.
    let found = rows(&lathe, &program.replace("F1800", "F12000"));
    let fastest = v / 0.02;
    near(
        found[2].peak_w,
        31.415_926_535_897_93 * fastest + 1000.0 * 0.03_f64.sqrt(),
    );
    // And so do rapids.
    let found = rows(
        &lathe,
        "G18 G61.1 G8\nG0 X50\nG96 D3000 S100 M3\nG4 P5\nG0 X20\nG4 P5\nG0 X19.9\n",
    );
    assert!(found[2].peak_w > 31.4 * fastest);
}

/// On the spindle's axis the clamp holds; where X is not known any speed may be,
/// which `limit` takes for the same when it reads its own output.
#[test]
fn surface_speed_where_the_axis_stands_or_is_not_known() {
    let lathe = machine("iso", "", "", "");
    let facing = "G96 S100 M3\nG4 P2\nG0 X-10\n";
    let (found, _) = run(&lathe, facing, &Options::default());
    assert!(found.iter().any(|row| row.peak_w > 0.9 * FULL_W));
    assert!(found.iter().all(|row| row.peak_w < 2.0 * FULL_W));
    let options = Options {
        reading: Reading {
            start: Start::Unknown,
            ..Reading::default()
        },
        ..Options::default()
    };
    let how = WITH_FEEDS;
    let (program, mut out) = (format!("G21 G90\n{facing}M2\n"), Vec::new());
    let summary = limit(Cursor::new(&program), &lathe, &options, how, &mut out, None).unwrap();
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(out, program.as_bytes());
}

/// Tapping turns the spindle round: from 3000/min to −3000/min and back.
#[test]
fn tapping_turns_the_spindle_round() {
    let found = rows(
        &machine("linuxcnc", "", "", ""),
        "G17 G61.1\nM3 S600\nG4 P2\nG33.1 Z-20 K1\nG0 X100\n",
    );
    let kinds: Vec<_> = found.iter().map(|row| row.kind).collect();
    assert_eq!(kinds, [Dwell, Tap, MoveKind::Spindle, Tap, Rapid]);
    // 600/min with full torque, next to the slide at 10 mm/s.
    let turned = 31.415_926_535_897_93 * 600.0 * std::f64::consts::TAU / 60.0;
    for index in [1, 3] {
        near(found[index].peak_w, turned + 10.0);
        near(found[index].regen_w, turned + 10.0);
    }
    // 0.4 s from 600/min to −600/min; the axis moves half of that meanwhile.
    near(found[2].duration_s, 0.2);
    near(found[4].regen_w, turned);
}

/// A tool's power, and a tool's cutting force at the speed of the feed.
#[test]
fn cutting_adds_to_feeds() {
    let machine = machine(
        "iso",
        "",
        "efficiency = 0.8\ncutting_power_w = 40",
        "[[tool]]\nnumber = 1\ncutting_power_w = 400\n\
         [[tool]]\nnumber = 2\nkc_n_mm2 = 2000\nwidth_mm = 10\ndepth_mm = 2\n",
    );
    let program = |tool: u32| format!("T{tool} M6\nM3 S1000\nG4 P2\nG0 X100\nG1 X1000 F6000\n");
    let with = |tool: u32| rows(&machine, &program(tool)).swap_remove(2);
    near(with(1).peak_w, 100.0 + 500.0);
    // 2000·10·2·100/1000 = 4000 W at the tool.
    near(with(2).peak_w, 100.0 + 5000.0);
    near(with(2).energy_j, 5.0 + 40_000.0 * 0.9 / 0.8);
    near(with(3).peak_w, 100.0 + 50.0);
    // Not in rapids, and not at rest.
    let found = rows(&machine, &program(1));
    near(
        found[1].peak_w,
        found[1].energy_j / found[1].duration_s * 0.0 + 1000.0 * 0.1_f64.sqrt(),
    );
    let found = rows(&machine, "T1 M6\nG1 X1000 F6000\n");
    near(found[0].peak_w, 100.0);
}

/// Nothing is known of a machine that begins anywhere: at any speed, at full
/// torque, until it has surely stopped or got its speed.
#[test]
fn an_unknown_start_counts_as_the_worst() {
    let options = Options {
        reading: Reading {
            start: Start::Unknown,
            ..Reading::default()
        },
        ..Options::default()
    };
    let machine = machine("iso", "", "wait = false", "");
    let (found, _) = run(&machine, "G4 P1\nM3 S1500\nG4 P1\nG4 P1\nG4 P1\n", &options);
    for row in &found[..3] {
        near(row.peak_w, FULL_W);
        near(row.regen_w, FULL_W);
    }
    // From −3000/min to 1500/min it takes 1.5 s.
    near(found[3].peak_w, 0.0);
}

fn limited(machine: &Machine, program: &str, allow_feed: bool) -> (String, LimitSummary, Vec<Row>) {
    let how = LimitOptions {
        allowed: Allowed {
            feed: allow_feed,
            ..Allowed::NOTHING
        },
        ..LimitOptions::USUAL
    };
    let program = format!("G21 G90\n{program}M2\n");
    let (mut out, mut rows) = (Vec::new(), Rows::default());
    let options = Options::default();
    let input = Cursor::new(program.as_bytes());
    let summary = limit(input, machine, &options, how, &mut out, Some(&mut rows));
    let summary = summary.unwrap_or_else(|failure| panic!("{failure:?}"));
    (String::from_utf8(out).unwrap(), summary, rows.0)
}

/// What the spindle holds comes off first, and cutting falls with the feed.
#[test]
fn limiting_leaves_to_the_spindle_what_it_takes() {
    let small = |spindle: &str, rest: &str| {
        let mut machine = machine("iso", "", spindle, rest);
        machine.converters[0].peak_power_w = 2000.0;
        if let Some(spindle) = &mut machine.spindle {
            spindle.accel_time_s = Some(30.0);
        }
        machine
    };
    let assert_feed = |text: &str, feed: f64| {
        let line = text.lines().find(|line| line.contains("X2000")).unwrap();
        let written: f64 = line.split('F').nth(1).unwrap().parse().unwrap();
        assert!((written / feed - 1.0).abs() < 1e-3, "{line}, not {feed}");
    };
    // A friction of 15 N·m at 1000/min holds 1570.8 W.
    let held = 15.0 * 1000.0 * std::f64::consts::TAU / 60.0;
    let machine = small("friction_nm = 15", "");
    let (text, summary, _) = limited(&machine, "M3 S1000\nG1 X1 F600\nG0 X2000\n", false);
    assert!(summary.certified, "{summary:#?}");
    assert_feed(&text, (2000.0 - held) * 60.0);

    // v·(1000 + 20000) W by m/s.
    let tool = "[[tool]]\nnumber = 2\nkc_n_mm2 = 2000\nwidth_mm = 10\ndepth_mm = 1\n";
    let program = "T2 M6\nM3 S1000\nG1 X2000 F12000\n";
    let (text, summary, _) = limited(&small("", tool), program, true);
    assert!(summary.certified, "{summary:#?}");
    assert_feed(&text, 2000.0 / 21_000.0 * 60_000.0);
}

/// A run that does not fit by itself is a row and a reason; nothing is written.
#[test]
fn a_run_alone_that_does_not_fit_is_told() {
    let mut machine = machine("iso", "", "", "");
    machine.converters[0].peak_power_w = 5000.0;
    let (found, summary) = run(
        &machine,
        "M3 S3000\nG4 P2\nG1 X100 F600\n",
        &Options::default(),
    );
    assert_eq!(found[0].kind, MoveKind::Spindle);
    assert_eq!((found[0].line, found[0].duration_s), (2, 0.0));
    near(found[0].peak_w, FULL_W);
    assert_eq!(summary.unfit[0].kind, MoveKind::Spindle);
    assert!(
        summary.unfit[0].help.contains("lower S"),
        "{:?}",
        summary.unfit[0].help
    );
    let (_, limited, rows) = limited(&machine, "M3 S3000\nG4 P2\nG1 X100 F600\n", true);
    assert!(!limited.certified);
    assert!(
        limited
            .reasons
            .iter()
            .any(|reason| reason.rule == "spindle-power")
    );
    assert_eq!(rows[0].action, "none possible");
    near(rows[0].peak_after_w.unwrap(), FULL_W);
}

/// Threads and taps are left as they are.
#[test]
fn taps_are_never_changed() {
    let mut machine = machine("linuxcnc", "", "", "");
    machine.converters[0].peak_power_w = 1500.0;
    let program = "G17 G61.1\nM3 S600\nG4 P2\nG33.1 Z-20 K1\n";
    let (_, summary, _) = limited(&machine, program, true);
    assert!(!summary.certified);
    let rules: Vec<_> = summary.reasons.iter().map(|reason| reason.rule).collect();
    assert!(rules.contains(&"untouchable"), "{rules:?}");
}

/// Bus energy is kinetic energy, friction, losses and cutting, to 1e-9.
#[test]
fn the_energy_balance_closes() {
    let text = "friction_nm = 4\nbase_rpm = 1200\njerk_time_s = 0.2\nbase_load_w = 30";
    let machine = machine("iso", "credit_regen = true\nbase_load_w = 10", text, "");
    let program = "M3 S2500\nG0 X700\nG0 Y400\nS600\nG0 X0 Y0\nG4 P2\nM5\nG0 X10\nG4 P5\n";
    let (found, _) = run(&machine, program, &Options::default());
    let energy: f64 = found.iter().map(|row| row.energy_j).sum();
    let duration: f64 = found.iter().map(|row| row.duration_s).sum();
    // Kinetic energy is given back: friction over the angle is left.
    let spindle = machine.spindle.as_ref().unwrap();
    let drive = SpindleDrive::new(spindle).unwrap();
    let mut motion = Motion::default();
    let mut turns = 0.0;
    let starts = [
        (0.0, 2500.0),
        (found[2].start_s, 600.0),
        (found[4].start_s, 0.0),
    ];
    for (index, (start, target)) in starts.iter().enumerate() {
        let end = starts.get(index + 1).map_or(duration, |next| next.0);
        let ramp = Ramp::new(motion, *target, drive.limits());
        let (reached, distance) = ramp.at(end - start);
        turns += distance / 60.0;
        motion = reached;
    }
    assert_eq!(motion.speed, 0.0);
    let friction = 4.0 * turns * std::f64::consts::TAU;
    let expected = friction + 40.0 * duration;
    assert!(
        (energy - expected).abs() <= 1e-9 * expected,
        "{energy}, not {expected}"
    );
    // Without credit the same run costs what it draws.
    let up = spindle_run(spindle, 0.0, 2500.0).unwrap();
    assert!(up.energy_j > 0.0);
}

/// The largest override of the spindle counts for peaks, and 100 % for times.
#[test]
fn the_largest_override_counts() {
    let machine = machine("iso", "", "", "override_max_percent = { spindle = 120 }");
    let found = rows(&machine, "M3 S2000\nG1 X1000 F6000\n");
    near(found[0].duration_s, 2.0 / 3.0);
    near(found[0].peak_w, 0.8 * FULL_W);
    near(found[0].energy_j, 0.5 * FULL_W * 4.0 / 9.0);
}

/// X brakes with 1000 kg at 1 m/s² from 1 m/s: 1000 W. The spindle's drive takes 300 W of
/// that while it is switched on, and nothing that is certain before and after.
#[test]
fn a_drive_that_is_switched_off_takes_nothing_of_what_is_fed_back() {
    let machine = machine("iso", "credit_regen = true", "base_load_w = 300", "");
    let program = "G0 X2000\nM3 S10\nG4 P5\nG0 X0\nM5\nG4 P5\nG0 X2000\n";
    let (rows, _) = run(&machine, program, &Options::default());
    let rapids = rows.iter().filter(|row| row.kind == MoveKind::Rapid);
    let back: Vec<f64> = rapids.map(|row| row.regen_w.round()).collect();
    assert_eq!(back, [1000.0, 700.0, 1000.0]);
}
