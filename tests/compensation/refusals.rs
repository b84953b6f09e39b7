//! What is refused under cutter compensation on LinuxCNC.

use std::fmt::Write as _;

use gwatt::pipeline::Options;
use insta::assert_snapshot;

use super::{moves, shown};

/// The first message for a program whose compensation begins in line 3.
fn refused(rest: &str) -> String {
    let found = moves(&format!("F600 S100\nG0 X0 Y0\nG41.1 D4\n{rest}\nM2\n"));
    let wanted = |line: &&str| line.contains(" compensation: ") || line.contains("tool-radius");
    found.lines().find(wanted).unwrap_or(&found).to_owned()
}

#[test]
fn paths_that_a_tool_cannot_follow() {
    let all = [
        "G1 X2",
        "G1 Z5",
        "G2 X1 I0.5",
        "G1 X10\nG3 X12 Y2 J2",
        "G1 X10\nX20\nX20 Y1\nX10",
        "G1 X10\nG3 X1 Y-3 I-4 J-3",
        "G1 X10\nG3 X15 Y5 J5\nG1 X5 Y0",
        "G1 X10\nG3 X15 Y5 J5\nG3 X13 Y1 I3 J-4",
        "G1 X10\nG3 X15 Y5 J5\nG2 X10 Y0 I-5",
        "G1 X10\nG3 X13 Y1 J5\nG1 X7 Y9",
        "G3 X10 Y-2 I10 J24",
        "G40\nG18\nG41.1 D4 L2\nG2 Z10 X0 K5",
        "G1 X10\nX20\nG40\nG2 X30 I5",
    ]
    .map(refused)
    .join("\n");
    assert_snapshot!(all, @r#"
4 compensation: the first move under cutter compensation is not longer than the tool's radius | make the lead-in move in the plane longer
4 compensation: the first move under cutter compensation is not longer than the tool's radius | make the lead-in move in the plane longer
4 compensation: the first move under cutter compensation is not longer than the tool's radius | make the lead-in move in the plane longer
5 compensation: the arc's radius is not larger than the radius of the tool inside it | use a smaller tool, or a larger arc
7 compensation: the line before this inside corner is too short for the tool | use a smaller tool, or round the corner by an arc larger than the tool
5 compensation: the tool cannot reach this arc from the line before it without cutting into the part | use a smaller tool, or round the corner by an arc larger than the tool
6 compensation: the tool cannot reach this line from the arc before it without cutting into the part | use a smaller tool, or round the corner by an arc larger than the tool
6 compensation: the tool cannot reach this arc from the one before it without cutting into the part | use a smaller tool, or round the corner by an arc larger than the tool
6 compensation: two arcs with the same centre meet in an inside corner | check the centres of the arcs
6 compensation: the arc before this inside corner is too short for the tool | use a smaller tool, or round the corner by an arc larger than the tool
4 compensation: no arc leads the tool from where it is to the side of this arc's end | lead in with a straight move
7 compensation: the first move under cutter compensation must be straight here | lead in with a straight move
7 compensation: the move that leaves cutter compensation must be straight | lead out with a straight move after G40
"#);
}

/// LinuxCNC takes the time for the programmed way (tests/conformance); what other controls
/// take it for is not known.
#[test]
fn a_time_for_the_block_under_another_control_s_compensation() {
    let program = "G10 L12 P1 R5.\nG0 X-20. Y-20.\nG41 D1 G1 X0. Y0. F600\nG93 Y40. F2\nG94 G40 X-20. Y-20. F600\nM30\n";
    let found = shown("fanuc", &Options::default(), program);
    let expected = "compensation: inverse-time feed (G93) under cutter compensation is not supported | write the feed per minute: G94";
    assert!(found.contains(expected), "{found}");
}

#[test]
fn words_that_are_refused_while_it_is_on() {
    let all = [
        "G28",
        "G53 G0 X5",
        "G92 X0",
        "G92.1",
        "G55",
        "G18",
        "G20",
        "G43",
        "G49",
        "G64",
        "M6",
        "G41.1 D2",
        "G42.1 D2",
    ]
    .map(|word| refused(&format!("G1 X10\n{word}\nX20")))
    .join("\n");
    assert_snapshot!(all, @r#"
5 compensation: a reference point under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: G53 under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: an offset of the axes under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: an offset of the axes under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: another coordinate system under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: another plane under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: another unit under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: another tool length offset under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: another tool length offset under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: another path mode under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: a tool change under cutter compensation: the controller stops here | switch the compensation off before: G40
5 compensation: cutter compensation is on already | switch it off before: G40
5 compensation: cutter compensation is on already | switch it off before: G40
"#);
    // The same plane and unit again, and what happens in one block with G40.
    let fine = "G1 X10\nG17 G21\nX20 M8\nT1 M0\nG40 G43 G55 G53 G0 X0";
    assert!(!refused(fine).contains("compensation"));
}

#[test]
fn how_it_is_switched_on() {
    let all = [
        "G40\nG41\nG1 X10",
        "G40\nG42 D7\nG1 X10",
        "G40\nG41 D1.5",
        "G40\nG41.1\nG1 X10",
        "G40\nG41.1 D4 L2\nG1 X10",
        "G40\nG18\nG41.1 D4 L10\nG1 X10",
        "G40\nG19\nG41.1 D4\nG1 Y10",
        "G1 X10\nX20\nG40\nG41.1 D0\nG1 X30",
    ]
    .map(refused)
    .join("\n");
    assert_snapshot!(all, @r#"
5 tool-radius: the radius of the tool in the spindle is not known | give the tool table: --tool-table FILE, or write the diameter: G41.1 D…
5 tool-radius: the radius of tool 7 is not known | give the tool table: --tool-table FILE, or write the diameter: G41.1 D…
5 compensation: D must be the number of a tool | write a whole number; a diameter goes with G41.1 and G42.1
5 tool-radius: G41.1 and G42.1 need the diameter of the tool | write it: D…
5 compensation: an orientation without G18 | L goes with the plane of a lathe: G18
6 compensation: L must be the orientation of the tool | write a whole number from 0 to 9
6 compensation: cutter compensation works in the planes XY and ZX only | choose the plane before: G17 or G18
7 compensation: the tool has not left the compensation before this one | write a straight move in the plane after G40
"#);
    let found = shown("grbl", &Options::default(), "G41 D1 G1 X10 F100\n");
    assert!(
        found.contains(
            "1 unsupported-code: cutter compensation, which this controller does not have"
        ),
        "{found}"
    );
    let mut options = Options::default();
    options.reading.start = gwatt::pipeline::Start::Unknown;
    let program = "G41.1 D4\nG1 X10 Y10 F100\nM2\n";
    assert!(
        shown("linuxcnc", &options, program).contains("begins at a position that is not known")
    );
}

#[test]
fn waiting_has_an_end() {
    let mut program = String::from("F600\nG41.1 D4\nG1 X10\n");
    for index in 0..1100 {
        let _ = writeln!(program, "Z{}", index % 2);
    }
    program.push_str("X20\nG40\nX0\nM2\n");
    assert!(moves(&program).contains("more than a thousand steps without motion in the plane"));
}
