//! Lines of printers' programs: checksums, free text, several commands, names.

use insta::assert_snapshot;

use super::*;

/// `RepRap` wiki, "G-code", "Checking": XOR of the bytes before the star, 96 for
/// `N10 G1 X10`; ` F600` turns it into 96 ^ 0x20 ^ 0x46 ^ 0x36 ^ 0x30 ^ 0x30 = 48.
#[test]
fn checksums_are_verified() {
    assert_snapshot!(marlin("N10 G1 X10*96\n"), @r"
    1 feed X0.000>10.000
    note no-feed-yet
    ");
    assert_snapshot!(marlin("N10 G1 X10*97 ; wrong\n"), @"checksum: the checksum is wrong: the line's own is 96");
    assert_snapshot!(marlin("N10 G1 X10 F600*12345\n"), @"checksum: the checksum is wrong: the line's own is 48");
    let text = "N3 M117 Hi";
    let sum = text.bytes().fold(0, |sum, byte| sum ^ byte);
    assert_eq!(
        marlin(&format!("{text}*{sum}\nG0 X1 F60\n")),
        "2 feed X0.000>1.000 v1.000\n"
    );
    assert_snapshot!(marlin("N3 M117 Hi*1\n"), @"checksum: the checksum is wrong: the line's own is 38");
    assert_snapshot!(marlin("N4 M110 N0\nG0 X1 F60\n"), @"2 feed X0.000>1.000 v1.000");
}

/// Marlin M117, M118, M23, M862.3, M486: text and flags, read to the comment.
#[test]
fn free_text_is_no_fault() {
    assert_snapshot!(marlin(
        "M117 Layer 5/10 (25%) \"up\" X9 G1\nM118 E1 hello, world #3\nM23 a~1.gco\n\
         M862.3 P \"MK3S\"\nM486 A\"Körper\"\nM84 X Y E\nM73 P5 R10 ; five\nM115 U3.9.0\n\
         M155 S1\nM900 K0.05\nM420 S1 Z10\nM0 Click to go on\nG0 X1 F60\n"
    ), @r"
    13 feed X0.000>1.000 v1.000
    note pressure-advance
    note bed-levelling
    ");
    assert_snapshot!(marlin("M106 S{x}\n"), @"expression: expressions in `{ }` are not supported");
    assert_snapshot!(marlin("M999.3 ?\nM106 hello\n"), @"unknown-text: this is no parameter of the command");
    assert_snapshot!(marlin("G1 X20 F60 (over there)\n"), @"1 feed X0.000>20.000 v1.000");
    assert_snapshot!(marlin("G1 X20 F60 (Y500)\n"), @"unknown-text: not all firmware takes words in parentheses for a comment");
    assert_snapshot!(marlin("M1234\n"), @"unknown-code: M1234 is not known to this controller profile");
    assert_snapshot!(marlin("M103\n"), @"unknown-code: M103 is not known to this controller profile");
    assert_snapshot!(marlin("G5\nG1 X1 F60\n"), @"2 feed X0.000>1.000 v1.000");
    let spline = marlin("G5 X1 Y1 I1 J1 P1 Q1\n");
    assert!(
        spline.starts_with("unsupported-code: G5 is a spline"),
        "{spline}"
    );
    assert_snapshot!(marlin("G1 X10 Y\n"), @"missing-number: `Y` has no number after it");
}

/// Marlin and Klipper read one command a line; RepRapFirmware reads all.
#[test]
fn several_commands_on_a_line() {
    assert_snapshot!(marlin("G21 G90\nM5 M400\nG1 X1 F60\n"), @r"
    3 feed X0.000>1.000 v1.000
    note no-spindle
    ");
    assert_snapshot!(marlin("G90 G91\n"), @"two-commands: this controller reads one command a line");
    assert_snapshot!(marlin("M106 S9 G1 X5\n"), @"two-commands: this controller reads one command a line");
    assert_snapshot!(reprap("G91 M83 G1 X1 E1 F60 M400 G1 X1 E1\n"), @r"
    1 feed X0.000>1.000 E0.000>1.000 v1.000
    1 feed X1.000>2.000 E1.000>2.000 v1.000
    ");
}

/// Marlin and RepRapFirmware look for each letter; Klipper reads one parameter `XY`.
#[test]
fn letters_without_a_blank_between_them() {
    for run in [marlin, reprap] {
        assert_eq!(run("G28 XY\nG1 X1 F600\n"), run("G28 X Y\nG1 X1 F600\n"));
        assert!(run("G28 XW\n").contains("unknown-text"));
    }
    assert!(klipper("G28 XY\n").contains("unknown-text"));
}

/// What a printer of Prusa and a macro of RepRapFirmware hold that moves nothing.
#[test]
fn words_of_one_firmware_that_move_nothing() {
    let moved = "G1 X30 F600\n";
    let plain = marlin(moved).replacen('1', "3", 1);
    assert_eq!(
        marlin(&format!("M555 X163 Y161 W36 H36\nM142 S36\n{moved}")),
        plain
    );
    let plain = reprap(moved).replacen('1', "2", 1);
    assert_eq!(
        reprap(&format!("echo \"G1 X9: \"^move.axes[0].max\n{moved}")),
        plain
    );
}

/// Klipper knows no command `#`; older versions take a word after it for the command.
#[test]
fn lines_that_begin_with_a_hash_are_comments_on_klipper() {
    assert_snapshot!(klipper("# fourth nudge\nG1 X1 F60\n"), @"2 feed X0.000>1.000 v1.000 a1000");
    for line in [
        "# G1 X30 F60",
        "#G1 X30",
        "# PAUSE",
        "#SET_VELOCITY_LIMIT ACCEL=5",
    ] {
        let found = klipper(&format!("{line}\nG1 X1 F60\n"));
        assert!(found.contains(": "), "{line}: {found}");
    }
}

/// What stands where a parameter should hides no command after it.
#[test]
fn quotes_at_the_end_of_a_line_hide_no_command() {
    for line in [
        "M42 P{x} G1 X200 F120 M118 S\"b\"",
        "M575 P1 S={a} G1 X200 M117 \"done\"",
    ] {
        let found = reprap(&format!("{line}\n"));
        assert!(found.contains(": "), "{line}: {found}");
    }
}

/// Klipper, "G-Codes": names without motion pass; macros of the machine and
/// RepRapFirmware's meta commands are refused by name.
#[test]
fn extended_commands() {
    assert_snapshot!(klipper(
        "SET_PRESSURE_ADVANCE EXTRUDER=extruder ADVANCE=.001\nEXCLUDE_OBJECT_START NAME=part_1\n\
         TIMELAPSE_TAKE_FRAME\nRESPOND TYPE=echo MSG=\"hi; there\"\nSET_GCODE_OFFSET Z=.1\n\
         G1 Z1 F60\nset_gcode_offset Z=0 MOVE=1\nBED_MESH_CALIBRATE\n"
    ), @r"
    6 feed from anywhere Z v1.000 a1000
    7 feed from anywhere XYZE a1000
    8 feed from anywhere XYZE a1000
    note pressure-advance
    note unknown-moves
    note bed-levelling
    ");
    assert_snapshot!(klipper("PARK_BED BED=60 EXTRUDER=200\n"), @"unknown-macro: `PARK_BED` is a macro or a command that this profile does not know");
    assert_snapshot!(marlin("SET_VELOCITY_LIMIT ACCEL=5\n"), @"unknown-macro: `SET_VELOCITY_LIMIT` is a macro or a command that this profile does not know");
    assert_snapshot!(reprap("if x > 1\n"), @"meta-command: `if`: branches, loops and variables are not supported");
    assert_snapshot!(reprap("M98 P\"a.g\"\n"), @"unsupported-code: M98 runs a macro file, which is not read");
    assert_snapshot!(reprap("M99\n"), @"unsupported-code: M99 belongs to a macro file");
    assert_snapshot!(reprap("G1 X{global.x}\n"), @"expression: expressions in `{ }` are not supported");
    assert_snapshot!(marlin("M502\n"), @"unsupported-code: M502 loads settings that the machine file does not describe");
    assert_snapshot!(marlin("M209 S1\n"), @"unsupported-code: M209 turns moves of the extruder into retracts");
}
