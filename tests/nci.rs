//! `TwinCAT` NC I, classic dialect: what each word means, by hand-worked programs. The
//! sections named are those of Beckhoff's TF5100 manual.

use std::io::Cursor;

use gwatt::pipeline::{Strategy, Summary, analyze};

use crate::limit::{EXACT_STOP, RIG, Rig, assert_figures, options};
use crate::listing::{listing, machine, refusals};

/// X and Y of 500 kg, 0.5 m/s and 5 m/s²: 1250 W and, over 400 mm, 0.8 s + 0.1 s.
const NCI: Rig = Rig {
    controller: "twincat-nci",
    rest: EXACT_STOP,
    ..RIG
};

fn moves(program: &str) -> String {
    listing(program, &machine("twincat-nci"), None)
}

fn summary(rig: &Rig, program: &str) -> Summary {
    let program = Cursor::new(format!("{program}\nM30\n"));
    analyze(program, &rig.machine(), &options(rig.options), None).expect("a program")
}

/// "Structure of an NC Program", "Rapid Traverse", "Circular Interpolation" with I, J and
/// with the radius as B or U, "Dwell Time", "Zero Offset Shifts", "M-Functions".
#[test]
fn plain_blocks_are_read() {
    let program = "\
% Test1 (program start)
N10 G0 X100 Y100 Z0
N20 G01 G17 X110 F6000 (a line)
N30 G02 X130 Y100 B10
N40 X150 U10
N50 G03 X150 Y100 I-10 J0
N60 G04 X0.5
N70 G54
N80 G01 X0 Y0
N90 G91 X5 M8 M123
N100 G53 G90 X1 S1000 T1 H5
N110 G71 G40 X2
M30
";
    assert_eq!(
        moves(program),
        "\
2 rapid X100 Y100
3 feed X110 F6000
4 arc X130 Y100 center 120,100 turns -0.5 F6000
5 arc X150 Y100 center 140,100 turns -0.5 F6000
6 arc X150 Y100 center 140,100 turns 1 F6000
7 dwell 0.5 s
9 feed X0 Y0 F6000
10 feed X5 F6000
11 feed X1 F6000
12 feed X2 F6000
"
    );
}

/// "Accurate Stop": G9 in its block, G60 until G0, by itself or in force.
#[test]
fn accurate_stop_ends_with_a_rapid() {
    let rig = Rig { rest: "", ..NCI };
    let fits = |program: &str| {
        let found = summary(&rig, program);
        format!("{:?}", found.certificate)
    };
    assert_eq!(fits("G1 G60 X400 F30000\nX0"), "Some(Planned)");
    assert_eq!(fits("G1 X400 F30000\nX0"), "Some(Robust)");
    assert_eq!(fits("G1 G9 X400 F30000\nG9 X0"), "Some(Planned)");
    assert_eq!(
        fits("G60\nG1 X400 F30000\nG0 X0\nG1 X400\nX0"),
        "Some(Robust)"
    );
    assert_eq!(fits("G0 X400\nG60\nX0\nG1 X400 F30000\nX0"), "Some(Robust)");
}

/// "Dynamic Override": all axes, from the next block on. 0.5 m/s · 500 kg · 2 m/s² = 500 W.
#[test]
fn the_dynamic_override_is_followed() {
    let cases = [
        ("G0 X400", 1250.0, 0.9),
        ("DynOvr=0.4\nG0 X400", 500.0, 1.05),
        ("dynovr=0.4\nG1 X400 F30000", 500.0, 1.05),
        ("N10 DynOvr = 0.4 (slow)\nG0 X400", 500.0, 1.05),
        ("/N10 DynOvr=0.4\nG0 X400", 500.0, 1.05),
        ("G0 X0\nDynOvr=0.4\nX400", 500.0, 1.05),
        ("DynOvr=0.4\nDynOvr=1\nG0 X400", 1250.0, 0.9),
        ("DynOvr=0.4\nDynOvr=0.8\nG0 X400", 1000.0, 0.925),
        (
            "#set paramPathDynamics( 700; 700; 3000 )#\nG0 X400",
            175.0,
            0.8 + 0.5 / 0.7,
        ),
        (
            "#set paramGroupDynamics( 1, 700, 700, 3000 )#\nG0 X400",
            175.0,
            0.8 + 0.5 / 0.7,
        ),
        // The higher of both counts.
        (
            "#set paramAxisDynamics( 0; 1500; 1400; 30000 )#\nG0 X400",
            375.0,
            0.8 + 0.5 / 1.5,
        ),
        (
            "#set paramAxisDynamics( 1; 1500; 1400; 30000 )#\nG0 X400",
            1250.0,
            0.9,
        ),
        // Together: the machine's own values, or what was set last.
        (
            "#set paramPathDynamics( 700; 700; 3000 )#\nDynOvr=0.4\nG0 X400",
            500.0,
            1.05,
        ),
        (
            "DynOvr=0.4\n#set paramPathDynamics( 4000; 4000; 3000 )#\nG0 X400",
            1000.0,
            0.925,
        ),
        (
            "#set paramAxisDynamics( 4; 90000; 90000; 1 )#\nG0 X400",
            1250.0,
            0.9,
        ),
    ];
    for (program, peak_w, duration_s) in cases {
        let found = summary(&NCI, program);
        assert_figures(&found, peak_w, duration_s, program);
    }
}

/// Jerk of 50 m/s³, lowered with the acceleration or by itself: the acceleration begins to fall
/// at 0.375 m/s, or is below 5 m/s² and has its most power at a third of a metre per second.
#[test]
fn the_jerk_is_lowered_too() {
    let rig = Rig {
        axis: "jerk_mm_s3 = 50000",
        ..NCI
    };
    let own_w = 500.0 / 3.0 * f64::sqrt(50.0 / 3.0);
    let half_w = 500.0 / 3.0 * f64::sqrt(25.0 / 3.0);
    let half_s = 0.8 + 2.0 * f64::sqrt(0.5 / 25.0);
    let set = |values: &str| format!("#set paramAxisDynamics( {values} )#\nG0 X400");
    let cases = [
        ("G0 X400".to_owned(), own_w, 1.0),
        ("DynOvr=0.5\nG0 X400".to_owned(), 468.75, 1.1),
        (set("0; 2500; 2500; 25000"), 468.75, 1.1),
        (set("0; 5000; 5000; 25000"), half_w, half_s),
        (set("1; 5000; 5000; 25000"), own_w, 1.0),
    ];
    for (program, peak_w, duration_s) in cases {
        let found = summary(&rig, &program);
        assert_figures(&found, peak_w, duration_s, program);
    }
}

#[test]
fn what_is_not_followed_is_refused() {
    let cases = [
        (
            "R4=3000",
            "R is an R parameter, which gwatt does not follow",
        ),
        ("X10 R4", "R is an R parameter, which gwatt does not follow"),
        (
            "G0 X=R1",
            "`G0 X=R1` is more than plain words, which gwatt does not follow",
        ),
        (
            "L2000 P5",
            "L is a subprogram call, which gwatt does not follow",
        ),
        (
            "@714",
            "@ is a jump, a loop or a decoder stop, which gwatt does not follow",
        ),
        (
            "Q1=50",
            "Q is an auxiliary axis, which gwatt does not follow",
        ),
        ("G70", "G70 is a canned cycle, which gwatt does not support"),
        ("G58 X10", "G58 is not known to this controller profile"),
        (
            "D1",
            "D is the data of a tool, whose length only the control knows, which gwatt does not follow",
        ),
        (
            "A10",
            "A is a word of this control, which gwatt does not follow",
        ),
        (
            "X10 B5",
            "B is the radius of an arc, which this block is not, which gwatt does not follow",
        ),
        (
            "M17",
            "M is the end of a subprogram, which gwatt does not follow",
        ),
        (
            "!R1:=5;",
            "`!R1:=5;` is more than plain words, which gwatt does not follow",
        ),
    ];
    for (line, message) in cases {
        assert_refused(line, message);
    }
}

#[track_caller]
fn assert_refused(line: &str, message: &str) {
    let found = refusals(&format!("G1 F100\n{line}\n"), &machine("twincat-nci"));
    assert!(found.ends_with(&format!(": {message}")), "{line}: {found}");
}

#[test]
fn accelerations_that_are_not_followed_are_refused() {
    let cases = [
        (
            "DynOvr=1.5",
            "DynOvr is a number from above 0 to 1, alone in its block",
        ),
        (
            "DynOvr=0",
            "DynOvr is a number from above 0 to 1, alone in its block",
        ),
        (
            "DynOvr=R5",
            "DynOvr is a number from above 0 to 1, alone in its block",
        ),
        (
            "DynOvr=0.5 X10",
            "DynOvr is a number from above 0 to 1, alone in its block",
        ),
        (
            "#set paramPathDynamics( 700; 700; R4 )#",
            "the values of this command are not plain numbers",
        ),
        (
            "#set paramPathDynamics( 700; 700 )#",
            "this command has another number of values",
        ),
        (
            "#set paramPathDynamics( 99000; 700; 3000 )#",
            "accelerations or a jerk above those of the machine file",
        ),
        (
            "#set paramAxisDynamics( 0; 700; 99000; 3000 )#",
            "accelerations or a jerk above those of the machine file",
        ),
        (
            "#set paramPathDynamics( 0; 700; 3000 )#",
            "a limit of motion that is not above 0",
        ),
        (
            "#set paramAxisDynamics( 0.5; 700; 700; 3000 )#",
            "the number of an axis is a whole number from 0 to 7",
        ),
        (
            "#set paramAxisDynamics( -1; 700; 700; 3000 )#",
            "the number of an axis is a whole number from 0 to 7",
        ),
        (
            "#set paramGroupDynamics( 2, 700, 700, 3000 )#",
            "the group of NC I's path axes is 1",
        ),
        (
            "#set paramVeloJump( 1.45; 1; 1 )#",
            "a parameter of the control that gwatt does not follow",
        ),
    ];
    for (line, message) in cases {
        assert_refused(line, message);
    }
}

/// One word for all axes: before the block, and back.
#[test]
fn limit_writes_the_dynamic_override() {
    assert_eq!(
        NCI.strategy(Strategy::Accel)
            .fits("G0 X400\nG1 X0 F30000\nX1 F100\nM30\n"),
        "DynOvr=0.799\nG0 X400\nG1 X0 F30000\nDynOvr=1\nX1 F100\nM30\n"
    );
    // What the program itself has set comes back.
    assert_eq!(
        NCI.strategy(Strategy::Accel)
            .fits("DynOvr=0.9\nG0 X400\nG0 X401\nM30\n"),
        "DynOvr=0.9\nDynOvr=0.799\nG0 X400\nDynOvr=0.9\nG0 X401\nM30\n"
    );
    // Over 400 mm that is sooner than a lower speed.
    assert_eq!(
        NCI.fits("G0 X400\nM30\n"),
        "DynOvr=0.799\nG0 X400\nDynOvr=1\nM30\n"
    );
}

/// It acts between moving blocks: a long block comes in pieces.
#[test]
fn a_long_block_is_split() {
    let rig = Rig {
        peak_w: 500.0,
        rest: "",
        ..NCI
    };
    let text = rig.strategy(Strategy::Split).fits("G0 X2000\nM30\n");
    assert!(text.matches("DynOvr=").count() > 2, "{text}");
    assert!(text.ends_with("DynOvr=1\nG0 X2000\nM30\n"), "{text}");
}
