//! Minimal edits in the style of the program, and everything restored.

use super::{EXACT_STOP, RIG, Rig};
use gwatt::pipeline::Strategy;

/// Rapids over 400 mm need 24 000 mm/min.
#[track_caller]
fn becomes(program: &str, expected: &str) {
    assert_eq!(RIG.fits(program), expected);
}

#[test]
fn packed() {
    becomes(
        "N10G0X400\nG1Y1F1000\nN20X0\n",
        "N10G1X400F24000\nG1Y1F1000\nN20X0\n",
    );
}

#[test]
fn lower_case_and_points() {
    becomes(
        "g0 x400\ng1 y1 f1000.\ng0 x0\n",
        "g1 x400 f24000\ng1 y1 f1000.\ng1 x0 f24000.\nG0 F1000.\n",
    );
}

#[test]
fn line_ends_comments_and_the_tape() {
    becomes(
        "%\r\nN1 G00 X400 (far)\r\nN2 X0\r\nG1 X1 F100.\r\nG0 X400 ; back\r\nY1\r\nG1 Y2\r\nM30\r\n%\r\n",
        "%\r\nN1 G01 X400 F24000 (far)\r\nN2 X0\r\nG1 X1 F100.\r\nG1 X400 F24000. ; back\r\nG0 Y1\r\nG1 Y2 F100.\r\nM30\r\n%\r\n",
    );
}

#[test]
fn other_bytes_stay() {
    let (text, summary) = RIG
        .limit(b"G0 X400 (\xe4\xf6\xfc)\rG1 X1 F100\r")
        .expect("a program");
    assert!(summary.certified);
    assert_eq!(text, b"G1 X400 F24000 (\xe4\xf6\xfc)\rG1 X1 F100\r");
}

#[test]
fn feeds_keep_their_point() {
    becomes("G1 X400 F30000.\nX0\n", "G1 X400 F24000.\nX0\nF30000.\n");
}

#[test]
fn inches() {
    becomes(
        "G20\nG0 X10\nG1 Y1 F50\nG0 X0\nG21\nG1 Y0\n",
        "G20\nG1 X10 F944.88\nG1 Y1 F50\nG1 X0 F944.88\nG21\nG1 Y0 F1270\n",
    );
}

#[test]
fn restored_before_a_tool_change() {
    becomes(
        "G1 X1 F500\nG0 X400\nT1 M6\nX0\nG1 X1\n",
        "G1 X1 F500\nG1 X400 F24000\nG0 F500\nT1 M6\nG1 X0 F24000\nG1 X1 F500\n",
    );
}

#[test]
fn restored_before_the_end() {
    for end in ["M2", "M30", "M0", "%"] {
        becomes(
            &format!("%\nG1 X1 F500\nG0 X400\n{end}\n"),
            &format!("%\nG1 X1 F500\nG1 X400 F24000\nG0 F500\n{end}\n"),
        );
    }
}

#[test]
fn restored_before_blocks_that_may_be_skipped() {
    becomes(
        "G1 X1 F500\nG0 X400\n/G1 X399\nX398\nM2",
        "G1 X1 F500\nG1 X400 F24000\nG0 F500\n/G1 X399\nX398\nM2",
    );
}

#[test]
fn restored_behind_a_last_line_without_end() {
    becomes("G1 X1 F500\nG0 X400", "G1 X1 F500\nG1 X400 F24000\nG0 F500");
}

/// Programs are written and certified in pieces of 64 KiB.
#[test]
fn restored_behind_a_last_line_that_fills_a_piece() {
    let long = "x".repeat(65_500);
    becomes(
        &format!("({long})\n(a)\nG0 X400\nG0 X0 ({})", &long[..60]),
        &format!("({long})\n(a)\nG1 X400 F24000\nG1 X0 ({})\nG0", &long[..60]),
    );
}

#[test]
fn other_meanings_of_f_are_left_alone() {
    becomes(
        "G0 X400\nG4 F2\nX0\nG94 G1 X1 F100\nG93 X2 F30\nG94 F100\nX3\n",
        "G1 X400 F24000\nG0\nG4 F2\nG1 X0\nG94 G1 X1 F100\nG93 X2 F30\nG94 F100\nX3\n",
    );
}

#[test]
fn nothing_is_put_into_a_block_with_a_dwell() {
    becomes(
        "G1 F30000 Y400\nG4 P1 Y390\n",
        "G1 F24000 Y400\nF30000\nG4 P1 Y390\n",
    );
}

#[test]
fn nothing_is_put_behind_a_checksum() {
    let rig = Rig {
        controller: "marlin",
        rest: EXACT_STOP,
        ..RIG
    }
    .strategy(Strategy::Speed);
    assert_eq!(
        rig.fits("G1 X400 F30000\nN2 G1 X390*104\n"),
        "G1 X400 F24000\nG1 F30000\nN2 G1 X390*104\n"
    );
}

/// LinuxCNC reads F before a G20 or G21 in the same block.
#[test]
fn feeds_beside_a_change_of_units() {
    let rig = Rig {
        controller: "linuxcnc",
        rest: EXACT_STOP,
        ..RIG
    };
    assert_eq!(
        rig.fits("G21 F1000\nG1 X5\nG20 G0 X15\nG1 X16\nG21 G0 X0\nG1 X1\nM2\n"),
        "G21 F1000\nG1 X5\nG20 G1 X15 F24000\nG1 X16 F39.3700787401\nG21 G1 X0 F944.88\nG1 X1 F1000\nM2\n"
    );
    assert_eq!(
        RIG.fits("G21 F1000\nG1 X5\nG20 G0 X15\nG1 X16\nM2\n"),
        "G21 F1000\nG1 X5\nG20 G1 X15 F944.88\nG1 X16 F39.3700787401\nM2\n"
    );
}

/// A block that asks for the feed or the motion word in force gets those of the
/// original ("Predefined Named Parameters" of `LinuxCNC`; #4001 and #4109,
/// B-63944EN "System Variables").
#[test]
fn restored_before_it_is_read() {
    let rig = Rig {
        controller: "linuxcnc",
        rest: EXACT_STOP,
        ..RIG
    };
    assert_eq!(
        rig.fits("F600\nG0 X400\n#1=#<_feed>\n#2=#<_motion_mode>\nG1 X[#1] Y[#2]\nM2\n"),
        "F600\nG1 X400 F24000\nG0 F600\n#1=#<_feed>\n#2=#<_motion_mode>\nG1 X[#1] Y[#2]\nM2\n"
    );
    assert_eq!(
        rig.fits("F600\nG0 X400\nG1 X[#<_FEED>/2]\nM2\n"),
        "F600\nG1 X400 F24000\nG0 F600\nG1 X[#<_FEED>/2]\nM2\n"
    );
    // A parameter that shows neither needs nothing.
    assert_eq!(
        rig.fits("F600\nG0 X400\n#1=#5420\nG1 X[#1+1]\nM2\n"),
        "F600\nG1 X400 F24000\n#1=#5420\nG1 X[#1+1] F600\nM2\n"
    );
    let rig = Rig {
        controller: "iso",
        ..RIG
    };
    assert_eq!(
        rig.fits("F600.\nG0 X400.\n#1=#[4100+9]\nG1 X[#4109]\nM30\n"),
        "F600.\nG1 X400. F24000.\nG0 F600.\n#1=#[4100+9]\nG1 X[#4109]\nM30\n"
    );
}

/// grbl puts G1 in force at M2 and M30 and goes on with what follows: nothing has to be put back.
#[test]
fn the_end_of_a_program_puts_its_own_word_in_force() {
    let rig = Rig {
        controller: "grbl",
        ..RIG
    };
    for end in ["M2", "M30"] {
        let program = format!("G21 G90\nG0 X1\nG1 X10 F1000\nG0 X11\n{end}\nM9\n");
        assert_eq!(rig.fits(&program), program);
    }
    // What follows runs as the feed that the control makes of it.
    let program = "G21 G90\nG1 X1 F1000\nG0 X400\nM2\nX2\n";
    assert_eq!(
        rig.fits(program),
        "G21 G90\nG1 X1 F1000\nG1 X400 F24000\nG0 F1000\nM2\nX2\n"
    );
}
