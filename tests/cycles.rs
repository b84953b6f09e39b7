//! Words that make several moves: canned cycles, threads, probing, splines.
//! The figures are worked by hand from the manuals' texts; those of LinuxCNC
//! agree with its interpreter.

mod fanuc;
mod refusals;
mod taps;

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::diagnostic::Severity;
use gwatt::interpret::Corner;
use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, Limits, Options, Reading};
use insta::assert_snapshot;

use crate::machines::{linear_axes, machine_from, rotary_axes};
use crate::runs::{WITH_FEEDS, limited, made_to_fit};

/// A machine with X Y Z and a rotary axis A; 10 kg on each linear axis.
fn machine(controller: &str, peak_power_w: f64) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = {peak_power_w:?}\n{}{}",
        linear_axes("XYZ", [60000.0, 2000.0, 100.0], ""),
        rotary_axes("A", [3600.0, 500.0, 1.0])
    ))
}

/// The moves of a program, a line each: line, kind, X Y Z at the end, feed in
/// mm/min or dwell; or the messages of a refusal.
fn moves(controller: &str, program: &str) -> String {
    moves_with(controller, program, Reading::default())
}

fn moves_with(controller: &str, program: &str, reading: Reading) -> String {
    let machine = machine(controller, 1e5);
    let mut out = String::new();
    let options = Options {
        reading,
        ..Options::default()
    };
    let result = pipeline::moves(Cursor::new(program), &machine, &options, &mut |mv, _| {
        let round = |value: f64| (value * 1e4).round() / 1e4 + 0.0;
        let [x, y, z] = [0, 1, 2].map(|axis| round(mv.end[axis]));
        let _ = write!(out, "{} {} {x} {y} {z}", mv.line, mv.kind.name());
        if mv.feed_mm_s.is_finite() {
            let _ = write!(out, " F{}", round(mv.feed_mm_s * 60.0));
        }
        if mv.kind.name() == "dwell" {
            let _ = write!(out, " {} s", mv.dwell_s);
        }
        if !mv.unknown_start.is_empty() {
            out.push_str(" from an unknown place");
        }
        out.push('\n');
        Ok(())
    });
    if let Err(Failure::Refused { diagnostics, .. }) = result {
        out.clear();
        let errors = diagnostics
            .into_iter()
            .filter(|found| found.severity == Severity::Error);
        for found in errors {
            let help = found.help.as_deref().unwrap_or("");
            let _ = writeln!(
                out,
                "{} {}: {} | {help}",
                found.line, found.rule, found.message
            );
        }
    }
    out
}

const SPINDLE: &str = "G21 G90 F100 S500 M3\n";

/// "Canned Cycles" of LinuxCNC, "Preliminary Motion", and its first example of
/// G81, in which the clearance level is above the place where it starts.
#[test]
fn linuxcnc_drills_as_its_manual_says() {
    let program = format!("{SPINDLE}G0 X1 Y2 Z3\nG98 G81 X4 Y5 Z1.5 R2.8\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 1 2 3
    3 rapid 4 5 3
    3 rapid 4 5 2.8
    3 feed 4 5 1.5 F100
    3 rapid 4 5 3
    ");
    // The second example: incremental, from below R, three times.
    let program = format!("{SPINDLE}G0 X1 Y2 Z3\nG91 G98 G81 X4 Y5 Z-0.6 R1.8 L3\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 1 2 3
    3 rapid 1 2 4.8
    3 rapid 5 7 4.8
    3 feed 5 7 4.2 F100
    3 rapid 5 7 4.8
    3 rapid 9 12 4.8
    3 feed 9 12 4.2 F100
    3 rapid 9 12 4.8
    3 rapid 13 17 4.8
    3 feed 13 17 4.2 F100
    3 rapid 13 17 4.8
    ");
}

/// "G98, G99": back to where the series began, or to R; R and Z hold.
#[test]
fn linuxcnc_keeps_values_and_the_initial_level() {
    let program = format!(
        "{SPINDLE}G0 Z10\nG99 G81 X1 Z-1 R2\nX2 R4\nG98 X3 R3\nG82 X4 Z-2 R3 P0.5\nX5\nG80 G0 X9\n"
    );
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 feed 1 0 -1 F100
    3 rapid 1 0 2
    4 rapid 2 0 4
    4 feed 2 0 -1 F100
    4 rapid 2 0 4
    5 rapid 3 0 4
    5 rapid 3 0 3
    5 feed 3 0 -1 F100
    5 rapid 3 0 10
    6 rapid 4 0 10
    6 rapid 4 0 3
    6 feed 4 0 -2 F100
    6 dwell 4 0 -2 0.5 s
    6 rapid 4 0 10
    7 rapid 5 0 10
    7 rapid 5 0 3
    7 feed 5 0 -2 F100
    7 dwell 5 0 -2 0.5 s
    7 rapid 5 0 10
    8 rapid 9 0 10
    ");
}

/// "G73", "G83": pecks; the tool stays 0.010 inch off the last depth.
#[test]
fn linuxcnc_pecks() {
    let program = format!("{SPINDLE}G0 Z10\nG98 G83 X1 Z-2 R1 Q1.5\nG73 X2 Z-2 R1 Q1.5\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 1
    3 feed 1 0 -0.5 F100
    3 rapid 1 0 1
    3 rapid 1 0 -0.246
    3 feed 1 0 -2 F100
    3 rapid 1 0 10
    4 rapid 2 0 10
    4 rapid 2 0 1
    4 feed 2 0 -0.5 F100
    4 rapid 2 0 -0.246
    4 feed 2 0 -2 F100
    4 rapid 2 0 10
    ");
}

/// "G84", "G74", "G85", "G86", "G89".
#[test]
fn linuxcnc_taps_and_bores() {
    let program = format!(
        "{SPINDLE}G99 G0 Z5\nG84 X1 Z-1 R2 P0.5\nG85 X2 Z-1 R2\nG86 X3 Z-1 R2 P1\nG89 X4 Z-1 R2 P0\nM4 G74 X5 Z-1 R2\n"
    );
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 0 0 5
    3 rapid 1 0 5
    3 rapid 1 0 2
    3 tap 1 0 -1 F100
    3 dwell 1 0 -1 0.5 s
    3 tap 1 0 2 F100
    4 rapid 2 0 2
    4 feed 2 0 -1 F100
    4 feed 2 0 2 F100
    4 rapid 2 0 2
    5 rapid 3 0 2
    5 feed 3 0 -1 F100
    5 dwell 3 0 -1 1 s
    5 rapid 3 0 2
    6 rapid 4 0 2
    6 feed 4 0 -1 F100
    6 dwell 4 0 -1 0 s
    6 feed 4 0 2 F100
    7 rapid 5 0 2
    7 tap 5 0 -1 F100
    7 dwell 5 0 -1 0 s
    7 tap 5 0 2 F100
    ");
}

/// "G87": next to the hole down, a counterbore upwards, and back. "G88": the
/// operator retracts, the next move starts at the bottom.
#[test]
fn linuxcnc_bores_back_and_by_hand() {
    let program =
        format!("{SPINDLE}G0 Z10\nG98 G87 X1 Z-2 R2 I0.5 J1 K0\nG88 X3 Z-2 R2 P0\nG0 X5\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 rapid 1.5 1 2
    3 rapid 1.5 1 -2
    3 rapid 1 0 -2
    3 feed 1 0 0 F100
    3 feed 1 0 -2 F100
    3 rapid 1.5 1 -2
    3 rapid 1.5 1 10
    3 rapid 1 0 10
    4 rapid 3 0 10
    4 rapid 3 0 2
    4 feed 3 0 -2 F100
    4 dwell 3 0 -2 0 s
    5 rapid 5 0 10
    ");
}

/// Planes: the drilling axis is the one across the plane; offsets count.
#[test]
fn cycles_in_other_planes_and_with_offsets() {
    let program = format!("{SPINDLE}G92 Y2\nG18 G99 G81 X1 Z3 Y1 R4\nG80 G19 G81 Y1 X-3 R2\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    3 rapid 0 2 0
    3 rapid 1 2 3
    3 feed 1 -1 3 F100
    3 rapid 1 2 3
    4 rapid 2 -1 3
    4 feed -3 -1 3 F100
    4 rapid 2 -1 3
    ");
}

/// "G33": K for each revolution along the path: 2 mm · 500/min. "G33.1": in and
/// out, out I times as fast.
#[test]
fn threads_follow_the_spindle() {
    let program = format!("{SPINDLE}G0 Z10\nG33 Z0 K2\nX5 Z5 K1\nG33.1 Z0 K1.5 I2\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 0 0 10
    3 thread 0 0 0 F1000
    4 thread 5 0 5 F500
    5 tap 5 0 0 F750
    5 tap 5 0 5 F1500
    ");
}

/// "G76 Threading Cycle": passes of 0.5·√n until 1, one spring pass, with the
/// compound angle 30° (0.5·tan 30° = 0.2887) and a run-out of 1 mm at the end:
/// 2 mm for each turn become 2·√2 on it.
#[test]
fn threading_cycle() {
    let program = format!("{SPINDLE}G0 X10 Z0\nG76 P2 Z-8 I-1 J0.5 K1 R2 Q30 H1 E1 L2\nG0 X20\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 rapid 10 0 0
    3 rapid 10.5 0 -0.2887
    3 rapid 8.5 0 -0.2887
    3 thread 8.5 0 -6.7113 F1000
    3 thread 9.5 0 -7.7113 F1414.2136
    3 rapid 10.5 0 -7.7113
    3 rapid 10.2929 0 -0.4082
    3 rapid 8.2929 0 -0.4082
    3 thread 8.2929 0 -6.8309 F1000
    3 thread 9.2929 0 -7.8309 F1414.2136
    3 rapid 10.2929 0 -7.8309
    3 rapid 10.134 0 -0.5
    3 rapid 8.134 0 -0.5
    3 thread 8.134 0 -6.9226 F1000
    3 thread 9.134 0 -7.9226 F1414.2136
    3 rapid 10.134 0 -7.9226
    3 rapid 10 0 -0.5774
    3 rapid 8 0 -0.5774
    3 thread 8 0 -7 F1000
    3 thread 9 0 -8 F1414.2136
    3 rapid 10 0 -8
    3 rapid 10 0 -0.5774
    3 rapid 8 0 -0.5774
    3 thread 8 0 -7 F1000
    3 thread 9 0 -8 F1414.2136
    3 rapid 10 0 -8
    3 rapid 10 0 -8
    4 rapid 20 0 -8
    ");
}

/// "G38.n": where it ends is not known, so the next absolute move of Z is not
/// either; grbl has it too.
#[test]
fn probing_forgets_the_position() {
    let program = "G21 G90\nG0 Z10\nG38.2 Z-5 F60\nG91 G0 Z1\nG90 Z10\nX1\n";
    for controller in ["linuxcnc", "grbl"] {
        let expected = "2 rapid 0 0 10\n\
            3 probe 0 0 -5 F60\n\
            4 rapid 0 0 -4\n\
            5 rapid 0 0 10 from an unknown place\n\
            6 rapid 1 0 10\n";
        assert_eq!(moves(controller, program), expected);
    }
}

/// "G38.n": towards the piece or away from it, with an error or without one; where
/// each ends only the machine knows.
#[test]
fn every_form_of_probing_forgets_the_position() {
    for word in ["G38.2", "G38.3", "G38.4", "G38.5"] {
        let program = format!("G21 F100\nG0 Z5\n{word} Z-5\nG0 X1\nG92 Z0\nM2\n");
        let machine = crate::listing::machine("linuxcnc");
        let found = crate::listing::listing(&program, &machine, None);
        let expected = "2 rapid Z5\n3 probe Z-5 F100\n4 rapid X1\n\
                        5 offset-from-unknown: G92 for an axis whose position is not known\n";
        assert_eq!(found, expected, "{word}");
    }
}

/// "G5 Cubic Spline", "G5.1", "G5.2": 15 lines for each control point; the
/// points are those of the curves' formulas.
#[test]
fn splines_become_lines() {
    // The parabola (0,0) (1,5) (4,0) at 1/3 and at its end: 45 lines.
    let found = moves("linuxcnc", "G21 G90 F100\nG5.1 I1 J5 X4 Y0\n");
    let lines: Vec<_> = found.lines().collect();
    assert_eq!(lines.len(), 45);
    assert_eq!(lines[14], "2 feed 0.8889 2.2222 0 F100");
    assert_eq!(lines[44], "2 feed 4 0 0 F100");
    // Two cubics: the second takes the end of the first over. Half way
    // (P0 + 3 P1 + 3 P2 + P3) / 8.
    let found = moves(
        "linuxcnc",
        "G21 G90 F100\nG5 I0 J3 P0 Q-3 X1 Y1\nG5 P0 Q-3 X2 Y2\n",
    );
    let lines: Vec<_> = found.lines().collect();
    assert_eq!(lines.len(), 120);
    assert_eq!(lines[29], "2 feed 0.5 0.5 0 F100");
    assert_eq!(lines[89], "3 feed 1.5 1.5 0 F100");
    // A quarter of a circle as a NURBS: weights 1, √½, 1.
    let program = "G21 G90 F100\nG0 X1\nG5.2 X1 Y1 P0.70710678\nX0 Y1 P1\nG5.3\n";
    let found = moves("linuxcnc", program);
    for line in found.lines().skip(1) {
        let numbers: Vec<f64> = line
            .split(' ')
            .filter_map(|word| word.parse().ok())
            .collect();
        assert!(
            (libm::hypot(numbers[1], numbers[2]) - 1.0).abs() < 1e-4,
            "{line}"
        );
    }
    assert_eq!(found.lines().count(), 46);
}

/// Moves that repetition makes are counted over the whole program.
#[test]
fn repetition_is_bounded() {
    let reading = Reading {
        limits: Limits {
            repeated_moves: 10,
            ..Limits::default()
        },
        ..Reading::default()
    };
    let program = format!("{SPINDLE}G99 G81 X1 Z-1 R1 L3\nX2 L3\n");
    assert_snapshot!(moves_with("linuxcnc", &program, reading), @r"
    3 too-many-moves: repetition makes more than 10 moves | if that is meant, allow more: --max-moves
    ");
    let program = format!("{SPINDLE}G81 X1 Z-1 R1 L1000000\n");
    assert_snapshot!(moves("linuxcnc", &program), @r"
    2 too-many-moves: this block makes more than 100000 moves | check Q and the number of repeats
    ");
}

/// Cycles are never changed: what was edited before is put back on a line of
/// its own, and after G80 the motion word is what it was.
#[test]
fn limit_leaves_cycles_alone() {
    let machine = machine("iso", 200.0);
    let program =
        "G90 S500 M3\nG0 X300 Y300\nZ5\nG98 G81 X310 Z-1 R4 F100\nX320\nG80\nX0 Y0\nM30\n";
    let (text, _) = made_to_fit(&machine, &Options::default(), WITH_FEEDS, program);
    assert_snapshot!(text, @r"
    G90 S500 M3
    G1 X300 Y300 F38183
    G0 Z5
    G98 G81 X310 Z-1 R4 F100
    X320
    G80
    G1 X0 Y0 F39395
    G0 F100
    M30
    ");
}

/// A thread that does not fit is named as such.
#[test]
fn limit_says_why_a_thread_stays() {
    let machine = machine("linuxcnc", 5.0);
    let program = "G61.1 G90 S3000 M3\nG33 Z50 K1\nM2\n";
    let done = limited(&machine, &Options::default(), WITH_FEEDS, program);
    let (_, summary) = done.expect("accepted");
    assert!(!summary.certified);
    assert_eq!(
        summary.reasons[0].message,
        "the block may not be changed: it moves in step with the spindle"
    );
}

/// LinuxCNC's interpreter lifts to R before it changes to G61 for the holes
/// (`interp_cycles.cc`; the canonical calls of its `rs274` show the same).
#[test]
fn holes_run_under_exact_path_and_the_lift_to_r_does_not() {
    let machine = machine("linuxcnc", 1e5);
    let program = "G21 G90 G17 G64 P0.05\nG0 X0 Y0 Z2\nG81 X10 Y10 Z-1 R5 F100\nG80\nG0 X0\nM2\n";
    let mut exact = Vec::new();
    let options = Options::default();
    pipeline::moves(Cursor::new(program), &machine, &options, &mut |mv, _| {
        if mv.length_mm > 0.0 {
            exact.push(mv.corner == Corner::Exact);
        }
        Ok(())
    })
    .unwrap();
    // To Z2, to R, across, down, up, and back under G64.
    assert_eq!(exact, [false, false, true, true, true, false]);
}
