//! The spindle in series over time.

use std::io::{self, Cursor};

use super::{FULL_W, machine, near, run};
use gwatt::interpret::{MoveKind, Start};
use gwatt::machine::Machine;
use gwatt::pipeline::{Options, Row as ReportRow, SeriesSink, series};
use gwatt::power::Instant;

/// A row: time, line and state.
type Row = (f64, u64, Instant);

#[derive(Default)]
struct Kept(Vec<Row>);

impl SeriesSink for Kept {
    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()> {
        self.0.push((time_s, line, instant.clone()));
        Ok(())
    }
}

fn shown(machine: &Machine, program: &str, step_s: f64) -> Vec<Row> {
    shown_as(machine, program, step_s, &Options::default())
}

fn shown_as(machine: &Machine, program: &str, step_s: f64, options: &Options) -> Vec<Row> {
    let mut kept = Kept::default();
    let program = format!("G21 G90\n{program}M2\n");
    series(Cursor::new(program), machine, options, step_s, &mut kept).unwrap();
    kept.0
}

/// The rows at an instant: one, or both sides of a jump.
fn at(rows: &[Row], time_s: f64) -> Vec<&Row> {
    let found = rows.iter().filter(|row| (row.0 - time_s).abs() < 1e-9);
    found.collect()
}

/// Half way up X runs at 500 mm/s with 1000 N, and the spindle at 1500/min with
/// ½·9869.6 W; at the end of both ramps all falls to nothing.
#[test]
fn a_run_up_beside_a_rapid() {
    let iso = machine("iso", "", "base_load_w = 7", "");
    let rows = shown(&iso, "M3 S3000\nG0 X2000\n", 0.01);
    near(rows.last().unwrap().0, 3.0);
    let torque_nm = 0.1 * 3000.0 * std::f64::consts::TAU / 60.0;
    let [(_, line, half)] = at(&rows, 0.5)[..] else {
        panic!("one row");
    };
    assert_eq!(*line, 3);
    near(half.axes[0].velocity_mm_s, 500.0);
    near(half.axes[0].force_n, 1000.0);
    near(half.spindle.speed_rpm, 1500.0);
    near(half.spindle.accel_rpm_s, 3000.0);
    near(half.spindle.torque_nm, torque_nm);
    near(half.spindle.power_w, 0.5 * FULL_W + 7.0);
    near(half.bus_w[0], 0.5 * FULL_W + 507.0);
    let jump = at(&rows, 1.0);
    let (before, after) = (&jump[0].2, &jump[jump.len() - 1].2);
    near(before.bus_w[0], FULL_W + 1007.0);
    near(before.spindle.torque_nm, torque_nm);
    assert_eq!(after.spindle.torque_nm, 0.0);
    assert_eq!(after.spindle.speed_rpm, 3000.0);
    near(after.bus_w[0], 7.0);
    // X brakes in the last second.
    near(at(&rows, 2.5)[0].2.regen_w[0], 500.0);
}

/// The axes stand for the second of the run-up, in the line that waits; then the
/// tool takes 2000 N/mm²·10 mm·2 mm at 100 mm/s.
#[test]
fn axes_stand_while_they_wait() {
    let tool = "[[tool]]\nnumber = 2\nkc_n_mm2 = 2000\nwidth_mm = 10\ndepth_mm = 2\n";
    let iso = machine("iso", "", "wait = true\nefficiency = 0.8", tool);
    let program = "T2 M6\nM3 S3000\nG1 X1000 F6000\nG4 P0.5\nM5\nG0 X0\n";
    let rows = shown(&iso, program, 0.005);
    for (time_s, line, state) in rows.iter().filter(|row| row.0 < 0.999) {
        assert_eq!((*line, state.axes[0].velocity_mm_s), (4, 0.0));
        near(state.spindle.power_w, FULL_W / 0.8 * time_s);
        near(state.bus_w[0], state.spindle.power_w);
    }
    // 0.1 s up, 9.9 s at 100 mm/s, 0.1 s down.
    let cutting = &at(&rows, 5.0)[0].2;
    near(cutting.axes[0].velocity_mm_s, 100.0);
    near(cutting.spindle.cutting_w, 5000.0);
    near(cutting.bus_w[0], 5000.0);
    let dwell = &at(&rows, 11.4)[0].2;
    assert_eq!((dwell.bus_w[0], dwell.spindle.cutting_w), (0.0, 0.0));
    // Braking from 3000/min, which nobody waits for.
    let braking = &at(&rows, 12.1)[0].2;
    near(braking.spindle.speed_rpm, 1500.0);
    near(braking.regen_w[0], 0.5 * FULL_W * 0.8);
    near(braking.bus_w[0], 500.0);
}

/// Facing at V = 100 m/min: n = V/r, dn/dt = n·vr/r; the clamp holds below
/// 31.8 mm, where n reaches 500/min.
#[test]
fn the_spindle_follows_the_surface() {
    let lathe = machine("linuxcnc", "", "", "");
    let program = "G18 G61.1 G8\nG0 X50\nG96 D500 S100 M3\nG4 P5\nG1 X20 F1800\nG0 Z1\n";
    let rows = shown(&lathe, program, 0.001);
    let rpm = 100_000.0 / std::f64::consts::TAU;
    let facing: Vec<&Row> = rows.iter().filter(|row| row.1 == 6).collect();
    let mut jumps = 0;
    for pair in facing.windows(2) {
        let [(from_s, _, first), (to_s, _, then)] = pair else {
            panic!("two");
        };
        let change = 0.5 * (first.spindle.accel_rpm_s + then.spindle.accel_rpm_s);
        let speed = first.spindle.speed_rpm + change * (to_s - from_s);
        assert!((then.spindle.speed_rpm - speed).abs() < 0.01, "{pair:?}");
        jumps += u32::from(from_s == to_s && first.spindle.accel_rpm_s != then.spindle.accel_rpm_s);
    }
    near(facing[0].2.spindle.speed_rpm, rpm / 50.0);
    let last = &facing[facing.len() - 1].2.spindle;
    assert_eq!((last.speed_rpm, last.accel_rpm_s), (500.0, 0.0));
    // Where the clamp begins, n·v/r falls to nothing.
    assert_eq!(jumps, 1);
}

/// A tap's reversal takes 0.4 s from 600/min to −600/min; the axes stand for half
/// of it and go back meanwhile.
#[test]
fn a_tap_turns_the_spindle_round() {
    let tap = machine("linuxcnc", "", "", "");
    let program = "G17 G61.1\nM3 S600\nG4 P2\nG33.1 Z-20 K1\nG0 X100\n";
    let rows = shown(&tap, program, 0.001);
    for pair in rows.windows(2) {
        let change = pair[1].2.spindle.speed_rpm - pair[0].2.spindle.speed_rpm;
        let most = 3000.0 * (pair[1].0 - pair[0].0);
        assert!(change.abs() <= most + 1e-6, "{pair:?}");
    }
    let turns = |row: &&Row| row.2.spindle.accel_rpm_s < 0.0;
    let reversal: Vec<&Row> = rows.iter().filter(turns).collect();
    let [first, .., last] = reversal[..] else {
        panic!("a reversal");
    };
    near(last.0 - first.0, 0.4);
    assert_eq!(first.2.spindle.speed_rpm, 600.0);
    near(last.2.spindle.speed_rpm, -600.0);
    let stands = |row: &&&Row| row.2.axes[2].velocity_mm_s == 0.0;
    let standing: Vec<f64> = reversal.iter().filter(stands).map(|row| row.0).collect();
    near(standing[standing.len() - 1] - standing[0], 0.2);
}

/// Nothing is known of Z, and so not when X moves, which the spindle follows: such moves have
/// their time and no more than bounds, the peak of the report at least.
#[test]
fn what_follows_an_unknown_motion_has_bounds() {
    let program =
        "G18 G61.1 G8 F1800\nG96 D3000 S100 M3\nG0 X50\nG4 P5\nG1 X20 Z5\nG1 X50\nM5\nG4 P1\n";
    let mut options = Options::default();
    options.reading.start = Start::Unknown;
    for credit in ["credit_regen = true", "credit_regen = false"] {
        let lathe = machine("linuxcnc", credit, "base_load_w = 30", "");
        let (output, summary) = run(&lathe, program, &options);
        let rows = shown_as(&lathe, program, 1e-3, &options);
        near(rows.last().unwrap().0, summary.duration_s);
        let judged = |row: &&ReportRow| row.line == 6 && row.kind == MoveKind::Feed;
        let judged = output.iter().find(judged).unwrap();
        let unknown: Vec<&Row> = rows
            .iter()
            .filter(|row| row.1 == 6 && row.0 > judged.start_s)
            .collect();
        assert!(unknown.len() > 100, "{}", unknown.len());
        for (_, _, now) in unknown {
            assert!(now.unknown_axes.contains(0) && now.unknown_axes.contains(2));
            assert!(now.axes[0].power_w.is_nan() && now.spindle.speed_rpm.is_nan());
            assert_eq!(now.axes[1].power_w, 0.0);
            near(now.bus_w[0], judged.peak_w);
            near(now.regen_w[0], judged.regen_w);
        }
        // From there on all is known, but for the speed of the spindle at the beginning.
        let known = rows.iter().filter(|row| row.1 == 7);
        assert!(known.clone().count() > 100);
        assert!(known.clone().all(|row| row.2.unknown_axes.is_empty()));
        assert!(known.clone().all(|row| row.2.bus_w[0].is_finite()));
    }
}

/// The integral of the bus power is the report's energy, its largest value the
/// reported peak, and the time is the same: run-ups next to rapids and in waits,
/// cutting, brakings, reversals and G96 in one program each.
#[test]
fn a_series_adds_up_to_the_report() {
    let tools = "[[tool]]\nnumber = 1\ncutting_power_w = 400\n\
                 [[tool]]\nnumber = 2\nkc_n_mm2 = 2000\nwidth_mm = 5\ndepth_mm = 1\n\
                 [[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 300\n";
    let mill = "T1 M6\nM3 S2000\nG0 X300 Y100\nG1 X600 F6000\nS2900 M8\nG0 Y300\nG2 X700 Y400 I100\n\
                M5\nG4 P4\nT2 M6\nM4 S1000\nG0 X100\nG1 X0 Y0 F3000\nG4 P0.7\nM5\nG1 X50\nG0 X800 M9\nG4 P1\n";
    let lathe = "G18 G61.1 G8\nG0 X50\nG96 D3000 S100 M3\nG4 P5\nG1 X20 F1800\nG1 X50\nM5\nG4 P1\n";
    let taps = "G17 G61.1\nM3 S600\nG4 P2\nG33.1 Z-20 K1\nG0 X100\nM5\nG1 X0 F9000\n";
    let rounded = "G17\nM3 S2500\nG0 X200\nG1 X300 F6000\nG1 X400 F9000\nG1 X500 Y1 F6000\nG4 P2\nM5\nG0 X0\nG4 P2\n";
    let spindle = "friction_nm = 4\nbase_rpm = 1200\nbase_load_w = 30\nefficiency = 0.9";
    let mut compared = 0;
    for jerk_time_s in ["0.0", "0.2"] {
        for credit in [
            "credit_regen = true",
            "credit_regen = false\nbase_load_w = 50",
        ] {
            for (controller, program) in [
                ("iso", mill),
                ("linuxcnc", lathe),
                ("linuxcnc", taps),
                ("grbl", rounded),
            ] {
                let spindle = format!("{spindle}\njerk_time_s = {jerk_time_s}");
                let machine = machine(controller, credit, &spindle, tools);
                let (output, summary) = run(&machine, program, &Options::default());
                let rows = shown(&machine, program, 2e-4);
                let name = format!("{controller} {credit} {jerk_time_s} {program}");
                let last_s = rows[rows.len() - 1].0;
                let off_s = (last_s - summary.duration_s).abs();
                assert!(off_s < 1e-9, "{name}: {off_s}");
                let mut energy = 0.0;
                for pair in rows.windows(2) {
                    let dt = pair[1].0 - pair[0].0;
                    assert!((0.0..=2e-4 + 1e-12).contains(&dt), "{name}: {dt}");
                    energy += 0.5 * dt * (pair[0].2.bus_w[0] + pair[1].2.bus_w[0]);
                }
                let expected: f64 = output.iter().map(|row| row.energy_j).sum();
                let off = (energy - expected).abs();
                assert!(off <= 1e-6 * expected, "{name}: {energy}, not {expected}");
                for (peak_w, of) in [
                    (summary.peak_w, (|row| row.2.bus_w[0]) as fn(&Row) -> f64),
                    (summary.regen_w, |row| row.2.regen_w[0]),
                ] {
                    let largest = rows.iter().map(of).fold(0.0, f64::max);
                    assert!(
                        largest <= peak_w * (1.0 + 1e-9),
                        "{name}: {largest} {peak_w}"
                    );
                    // With jerk, runs that are in step with an axis count with
                    // the drive's largest torque; look-ahead adds the peaks.
                    let share = match program {
                        _ if program == mill => 1e-6,
                        _ if program != rounded && jerk_time_s == "0.0" => 1e-2,
                        _ => continue,
                    };
                    let least = peak_w * (1.0 - share);
                    assert!(largest >= least, "{name}: {largest} {peak_w}");
                    compared += 1;
                }
            }
        }
    }
    assert_eq!(compared, 16);
}

/// A line and arcs of two planes under `LinuxCNC`'s G64, whose ramps overlap at the
/// joints: speeds neither jump nor fall to 0 there, and the path ends where it is
/// to end, as early as the report says.
#[test]
fn overlapping_moves_are_shown_at_once() {
    let mill = machine("linuxcnc", "", "", "");
    let program = "G17 G64\nG1 X20 F3000\nG3 X24 Y4 I0 J4\nG18 G2 X34 Z10 I10 K0\nG1 X50 Z14\n";
    let (_, summary) = run(&mill, program, &Options::default());
    let rows = shown(&mill, program, 1e-4);
    let last_s = rows[rows.len() - 1].0;
    assert!((last_s - summary.duration_s).abs() < 1e-9, "{last_s}");
    let mut moved_mm = [0.0; 3];
    for pair in rows.windows(2) {
        let [(from_s, line, first), (to_s, _, then)] = pair else {
            panic!("two");
        };
        let dt = to_s - from_s;
        let mut speed2 = 0.0;
        for (axis, moved_mm) in moved_mm.iter_mut().enumerate() {
            let (a, b) = (&first.axes[axis], &then.axes[axis]);
            let change = 0.5 * dt * (a.accel_mm_s2 + b.accel_mm_s2);
            let jump = b.velocity_mm_s - a.velocity_mm_s - change;
            assert!(jump.abs() < 1e-3, "{jump} mm/s at {from_s} s, line {line}");
            *moved_mm += 0.5 * dt * (a.velocity_mm_s + b.velocity_mm_s);
            speed2 += a.velocity_mm_s * a.velocity_mm_s;
        }
        near(first.path_mm_s, speed2.sqrt());
        let stands = first.path_mm_s < 1.0;
        assert!(
            !stands || *from_s < 0.01 || *from_s > last_s - 0.01,
            "{pair:?}"
        );
        assert!(first.bus_w[0] <= summary.peak_w);
    }
    for (moved_mm, to_mm) in moved_mm.into_iter().zip([50.0, 4.0, 14.0]) {
        assert!((moved_mm - to_mm).abs() < 1e-3, "{moved_mm} {to_mm}");
    }
    // Two chords of one arc, with a blend between them.
    let program = "G17 G64 P0.5\nG1 X-1.892 Y7.1653 F9000\nG1 X12.8504 Y7.3865\n\
                   G3 X13.2335 Y7.6038 Z-1 I0.0305 J0.3925\nG1 X30\n";
    let (_, summary) = run(&mill, program, &Options::default());
    let rows = shown(&mill, program, 1e-3);
    let last_s = rows[rows.len() - 1].0;
    assert!((last_s - summary.duration_s).abs() < 1e-9, "{last_s}");
}

/// How many rows there are, and the times of the last ones.
#[derive(Default)]
struct Counted {
    rows: u64,
    last_s: std::collections::VecDeque<f64>,
}

impl SeriesSink for Counted {
    fn row(&mut self, time_s: f64, _: u64, _: &Instant) -> io::Result<()> {
        self.rows += 1;
        self.last_s.push_back(time_s);
        if self.last_s.len() > 300 {
            self.last_s.pop_front();
        }
        Ok(())
    }
}

/// A dwell of a month at 1 ms would be 2.6e9 rows: they are farther apart, which is
/// said, and after it they are a step apart as before.
#[test]
fn a_month_costs_no_more_rows_than_an_hour() {
    let iso = machine("iso", "", "", "");
    let mut counted = Counted::default();
    let program = "G21 G90\nG4 X2592000\nG0 X200\nM2\n";
    let options = Options::default();
    let note = series(Cursor::new(program), &iso, &options, 1e-3, &mut counted).unwrap();
    let note = note.expect("a note");
    assert_eq!(note.rule, "coarse-series");
    assert_eq!(
        note.message,
        "line 2 lasts 2592000 s: from here on some rows are farther apart, 10.266 s in this line"
    );
    assert!(
        (250_000..260_000).contains(&counted.rows),
        "{}",
        counted.rows
    );
    let last: Vec<f64> = counted.last_s.into_iter().collect();
    assert!(last.iter().all(|time_s| *time_s > 2_592_000.0));
    let apart = last.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(apart.clone().all(|apart_s| apart_s < 1.001e-3));
    let whole = last
        .iter()
        .filter(|time_s| (*time_s * 1e3).fract().min(1.0 - (*time_s * 1e3).fract()) < 1e-3);
    assert!(whole.count() > 290);
}
