//! Words that make several moves: canned cycles, threads, probing, splines.
//! The figures are worked by hand from the manuals' texts; those of LinuxCNC
//! agree with its interpreter.

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::diagnostic::Severity;
use gwatt::limit::{Law, Strategy};
use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, LimitOptions, Limits, Options, Reading};
use insta::assert_snapshot;

/// A machine with X Y Z and a rotary axis A; 10 kg on each linear axis.
fn machine(controller: &str, peak_power_w: f64) -> Machine {
    let mut text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = {peak_power_w:?}\n"
    );
    for axis in ["X", "Y", "Z"] {
        let _ = writeln!(
            text,
            "[axes.{axis}]\nrapid_mm_min = 60000\naccel_mm_s2 = 2000\nmass_kg = 100"
        );
    }
    text += "[axes.A]\nkind = \"rotary\"\nrapid_deg_min = 3600\naccel_deg_s2 = 500\ninertia_kg_m2 = 1\n";
    Machine::from_toml("test.toml", &text)
        .expect("a valid machine")
        .0
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

const HOW: LimitOptions = LimitOptions {
    strategy: Strategy::Optimal,
    law: Law::Exact,
    allow_feed: true,
};

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

/// "G87": beside the hole down, a counterbore upwards, and back. "G88": the
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

/// Fanuc: rapid to the place, to R, the hole, back to the initial level or R;
/// P without a point is in milliseconds; K repeats.
#[test]
fn fanuc_drills() {
    let program = "G90 G21 S500 M3\nG0 Z50\nG98 G81 X10 Y5 Z-5 R2 F100\nG99 X20\nG82 X30 P500\nG80\nX0\nG91 G99 G81 X5 Z-4 R-8 K2\nG90 G80 Z60\n";
    assert_snapshot!(moves("iso", program), @r"
    2 rapid 0 0 50
    3 rapid 10 5 50
    3 rapid 10 5 2
    3 feed 10 5 -5 F100
    3 rapid 10 5 50
    4 rapid 20 5 50
    4 rapid 20 5 2
    4 feed 20 5 -5 F100
    4 rapid 20 5 2
    5 rapid 30 5 2
    5 feed 30 5 -5 F100
    5 dwell 30 5 -5 0.5 s
    5 rapid 30 5 2
    7 rapid 0 5 2
    8 rapid 5 5 2
    8 rapid 5 5 -6
    8 feed 5 5 -10 F100
    8 rapid 5 5 -6
    8 rapid 10 5 -6
    8 feed 10 5 -10 F100
    8 rapid 10 5 -6
    9 rapid 10 5 60
    ");
}

/// Fanuc: pecks stay 1 mm off (a parameter); taps; G85; fine and back boring.
#[test]
fn fanuc_pecks_taps_and_bores() {
    let program = "G90 S500 M3\nG0 Z10\nG99 G83 X1 Z-3 R2 Q3 F100\nG73 X2\nG98 G84 X3 P1.\nG85 X4 L1\nG76 X5 I0.2 J0.1 Q0 P0\nG87 X6 R-4 Z-1 Q0.3 I0.3\nG81 X7 Z-5 K0\n";
    assert_snapshot!(moves("iso", program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 feed 1 0 -1 F100
    3 rapid 1 0 2
    3 rapid 1 0 0
    3 feed 1 0 -3 F100
    3 rapid 1 0 2
    4 rapid 2 0 2
    4 feed 2 0 -1 F100
    4 rapid 2 0 0
    4 feed 2 0 -3 F100
    4 rapid 2 0 2
    5 rapid 3 0 2
    5 tap 3 0 -3 F100
    5 dwell 3 0 -3 1 s
    5 tap 3 0 2 F100
    5 rapid 3 0 10
    6 rapid 4 0 10
    6 rapid 4 0 2
    6 feed 4 0 -3 F100
    6 feed 4 0 2 F100
    6 rapid 4 0 10
    7 rapid 5 0 10
    7 rapid 5 0 2
    7 feed 5 0 -3 F100
    7 dwell 5 0 -3 0 s
    7 rapid 5.2 0.1 -3
    7 rapid 5.2 0.1 10
    7 rapid 5 0 10
    8 rapid 6 0 10
    8 rapid 6.3 0.1 10
    8 rapid 6.3 0.1 -4
    8 rapid 6 0 -4
    8 feed 6 0 -1 F100
    8 rapid 6.3 0.1 -1
    8 rapid 6.3 0.1 10
    8 rapid 6 0 10
    ");
}

/// Fanuc G88: the operator retracts to somewhere, then a rapid to the level.
#[test]
fn fanuc_retracts_from_an_unknown_place() {
    let program = "G90 S500 M3\nG0 Z10\nG98 G88 X1 Z-3 R2 F100\n";
    assert_snapshot!(moves("iso", program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 feed 1 0 -3 F100
    3 rapid 1 0 10 from an unknown place
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

/// G31 of Fanuc and Haas is not modal: the rapid comes back.
#[test]
fn skipping_is_probing() {
    assert_snapshot!(moves("iso", "G90 G0 Z10\nG31 Z-5 F60\nX1\nZ10\n"), @r"
    1 rapid 0 0 10
    2 probe 0 0 -5 F60
    3 rapid 1 0 -5
    4 rapid 1 0 10 from an unknown place
    ");
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

#[test]
#[allow(clippy::too_many_lines, reason = "a list of programs")]
fn each_refusal_once() {
    let rs274 = [
        "G81 X1 Z-1",
        "G81 X1 R1",
        "G81 X1 Z1 R0",
        "G81 X1 Z-1 R1 L0",
        "G81 X1 Z-1 R1 L1.5",
        "G81 X1 Z-1 R1 A5",
        "G81",
        "G81 X1 Z-1 R1 P1",
        "G93 G81 X1 Z-1 R1 F1",
        "G53 G81 X1 Z-1 R1",
        "G83 X1 Z-1 R1",
        "G83 X1 Z-1 R1 Q0",
        "G83 X1 Z-900 R1 Q0.001",
        "G82 X1 Z-1 R1",
        "G82 X1 Z-1 R1 P-2",
        "G87 X1 Z-1 R1 I1 J1",
        "G74 X1 Z-1 R1",
        "M5 G84 X1 Z-1 R1",
        "G88 X1 Z-1 R1 P0\nG92 X0",
        "G33 Z1",
        "G33 Z1 K0",
        "M5\nG33 Z1 K1",
        "S0\nG33 Z1 K1",
        "G76 P1 Z-1 I-1 J1 K1",
        "G76 P1 Z-1 I-1 J1",
        "G38.2 Z0.1",
        "G38.2",
        "G5 X1 Y1 P1 Q1",
        "G5 X1 Y1 P1 I1 J1",
        "G18 G5.1 X1 I1 J1",
        "G5.2 X1 P1",
        "G5.3",
    ];
    let mut all = String::new();
    for program in rs274 {
        all += &moves("linuxcnc", &format!("{SPINDLE}G0 X0\n{program}\n"));
    }
    assert_snapshot!(all, @r"
    3 cycle-word: G81 without R | write R in the first block of the cycle
    3 cycle-word: G81 without Z | write Z in the first block of the cycle
    3 cycle-word: R is below the bottom of the hole | check the number
    3 cycle-word: a canned cycle cannot be repeated 0 times | check the number
    3 cycle-repeats: the number of repeats is not a whole number from 0 to 1e9 | write how often the hole is to be made
    3 cycle-axes: another axis than X, Y and Z in the block of a canned cycle | move it in a block of its own
    3 no-axes: this motion word needs an axis word | write where it is to move
    3 unused-word: nothing in this block uses the P word | take it out, or write the word that it belongs to
    3 cycle-g93: a canned cycle under G93 | write G94 before it
    3 special-in-g53: G53 goes with G0 and G1 only | use work coordinates here
    3 cycle-word: G83 without Q | write Q in the first block of the cycle
    3 cycle-word: Q must be greater than 0 | check the number
    3 too-many-moves: this block makes more than 100000 moves | check Q and the number of repeats
    3 cycle-word: G82 without P | write P in the first block of the cycle
    3 cycle-word: the dwell is negative or beyond reason | check the number
    3 cycle-word: G87 without I, J and K | write I, J and K in the first block of the cycle
    3 cycle-spindle: the spindle does not turn as G74 needs it | write M3 before it, or M4 for G74
    3 cycle-spindle: the spindle does not turn as G84 needs it | write M3 before it, or M4 for G74
    4 after-g88: G88 leaves the axis to be retracted by hand: what follows is not known | move the axes by G0 or G1 first
    3 thread-pitch: a thread without its pitch K | write K in every block: the way in one revolution
    3 thread-pitch: the pitch must be greater than 0 | check the number
    4 thread-spindle: a thread, but the spindle does not turn | write M3 or M4 before it
    4 no-spindle-speed: a thread, but no spindle speed is in force | write S before it
    3 thread-words: G76: K must be greater than J | check the words of the block
    3 thread-words: G76 needs P, I, J and K in every block | pitch, peak, first depth and full depth
    3 probe-length: the probe stands at its target already | probing needs a way of 0.254 mm (0.01 inch) at least
    3 no-axes: this motion word needs an axis word | write where it is to move
    3 spline: G5 needs P and Q, and in the first block of a series I and J | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: a spline with only one of P and Q | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: a spline outside of the plane G17 | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: a control point needs X and Y | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: G5.3 before enough points by G5.2 | see G5 and G5.2 in the manual of LinuxCNC
    ");
    let mut all = String::new();
    for program in [
        "G81 X1 Z-1",
        "G81 X1 R1",
        "G83 X1 Z-1 R1",
        "G76 X1 Z-1 R1",
        "G99 G87 X1 Z-1 R-2 Q1",
        "G83 X1 Z-1 R1 Q1 I1",
        "G99\nG1 X1",
        "G91 G81 X1 Z1 R1",
        "G81 X1 Z-1 R1 K1.5",
    ] {
        all += &moves("iso", &format!("{SPINDLE}G0 X0\n{program}\n"));
    }
    assert_snapshot!(all, @r"
    3 cycle-word: G81 without R | write R in the first block of the cycle
    3 cycle-word: G81 without Z | write Z in the first block of the cycle
    3 cycle-word: G83 without Q | write Q in the first block of the cycle
    3 cycle-word: G76 without Q, or I and J | write Q, or I and J in the first block of the cycle
    3 cycle-word: G87 cannot return to R (G99) | write G98: the way back is beside the hole, to the initial level
    3 unused-word: nothing in this block uses the I word | take it out, or write the word that it belongs to
    3 unsupported-code: G99 without a canned cycle: it may mean the feed per revolution of a lathe | write it in the block of the cycle, or G95 for a feed per revolution
    3 cycle-word: R is below the bottom of the hole | check the number
    3 cycle-repeats: the number of repeats is not a whole number from 0 to 1e9 | write how often the hole is to be made
    ");
    // What these do not have stays refused.
    for controller in ["grbl", "isg"] {
        let found = moves(controller, "G21 G90 F100\nG0 X0\nG81 X1 Z-1 R1\n");
        assert!(found.contains("G81 is a canned cycle"), "{found}");
    }
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
        b"G90 S500 M3\nG0 X300 Y300\nZ5\nG98 G81 X310 Z-1 R4 F100\nX320\nG80\nX0 Y0\nM30\n";
    let mut out = Vec::new();
    let summary = pipeline::limit(
        Cursor::new(&program[..]),
        &machine,
        &Options::default(),
        HOW,
        &mut out,
        None,
    )
    .expect("accepted");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_snapshot!(String::from_utf8(out).unwrap(), @r"
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
    let program = b"G61.1 G90 S3000 M3\nG33 Z50 K1\nM2\n";
    let mut out = Vec::new();
    let summary = pipeline::limit(
        Cursor::new(&program[..]),
        &machine,
        &Options::default(),
        HOW,
        &mut out,
        None,
    )
    .expect("accepted");
    assert!(!summary.certified);
    assert_eq!(
        summary.reasons[0].message,
        "the block may not be changed: it moves in step with the spindle"
    );
}
