//! Cutter radius compensation of Fanuc and SINUMERIK, chamfers, rounded
//! corners, SINUMERIK's threads and taps: paths worked by hand.
//!
//! Sources: Fanuc B-63944EN ("Details of Cutter Compensation", "Optional
//! Chamfering and Corner R"), B-63604EN ("Details of Tool Nose Radius
//! Compensation"); SINUMERIK 840D sl "Fundamentals" ("Tool radius
//! compensation", "Chamfer, rounding", "Tapping").

mod chamfers;

use std::fmt::Write as _;
use std::io::Cursor;
use std::sync::Arc;

use gwatt::interpret::ToolTable;
use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, Options};
use insta::assert_snapshot;

use crate::limit::{EXACT_STOP, RIG, Rig};
use crate::listing::{errors_of, machine_of};

/// The moves, a line each, or the errors of a refusal.
fn moves_on(machine: &Machine, table: &str, program: &str) -> String {
    let mut options = Options::default();
    if !table.is_empty() {
        let table = ToolTable::parse(table.as_bytes()).expect("a valid table");
        options.reading.tools = Some(Arc::new(table));
    }
    let mut out = String::new();
    let result = pipeline::moves(Cursor::new(program), machine, &options, &mut |mv, _| {
        let _ = write!(out, "{} {}", mv.line, mv.kind.name());
        for axis in mv.moving.iter() {
            let letter = gwatt::machine::ALL_AXES[axis].letter() as char;
            let _ = write!(out, " {letter}{:.4}", mv.end[axis]);
        }
        if let Some(arc) = &mv.arc {
            let [first, second] = arc.center;
            let degrees = arc.sweep_rad.to_degrees();
            let _ = write!(out, " about {first:.4},{second:.4} by {degrees:.3}");
        }
        if mv.feed_mm_s.is_finite() {
            let _ = write!(out, " F{:.2}", mv.feed_mm_s * 60.0);
        }
        out.push('\n');
        Ok(())
    });
    if let Err(failure @ Failure::Refused { .. }) = result {
        out = errors_of(&failure);
    }
    out.replace("-0.0000", "0.0000")
}

fn moves(controller: &str, program: &str) -> String {
    moves_on(&machine_of(controller, "", "XYZ", ""), "", program)
}

fn type_b() -> Machine {
    let language = "[language]\ncutter_compensation = { corner = \"line\", lead = \"corner\" }\n";
    machine_of("fanuc", language, "XYZ", "")
}

/// B-63944EN, "Details of Cutter Compensation", "Tool Movement in Offset Mode".
#[test]
fn outside_corners_of_90_degrees() {
    // Radius 5, the tool to the left of a clockwise square: each corner is the
    // one of the square that is larger by 5. Type A: the first move ends next to
    // the start of the second, at (-5, 0); the last begins next to the end of the
    // one before, at (0, -5).
    let program = "G10 L12 P1 R5.\nG0 X-20. Y-20.\nG41 D1 G1 X0. Y0. F600\nY40.\nX40.\nY0.\nX0.\nG40 X-20. Y-20.\nM30\n";
    let square = moves("fanuc", program);
    assert_snapshot!(square, @r"
2 rapid X-20.0000 Y-20.0000
3 feed X-5.0000 Y0.0000 F600.00
4 feed Y45.0000 F600.00
5 feed X45.0000 F600.00
6 feed Y-5.0000 F600.00
7 feed X0.0000 F600.00
8 feed X-20.0000 Y-20.0000 F600.00
");
    // The same by a tool table (D is a diameter there), by H, by D of a block
    // before, and from the other side with a negative radius.
    let table = "T1 D10\n";
    let fanuc = machine_of("fanuc", "", "XYZ", "");
    let plain = program.replace("G10 L12 P1 R5.\n", "M8\n");
    assert_eq!(moves_on(&fanuc, table, &plain), square);
    assert_eq!(moves("fanuc", &program.replace("G41 D1", "G41 H1")), square);
    let before = program
        .replace("G41 D1", "G41")
        .replace("G0 X-20.", "D1 G0 X-20.");
    assert_eq!(moves("fanuc", &before), square);
    let negative = program.replace("R5.", "R-5.").replace("G41", "G42");
    assert_eq!(moves("fanuc", &negative), square);
    // Mirrored in X, left and right change places.
    let mirrored =
        "G10 L12 P1 R5.\nG51.1 X0.\nG0 X-20. Y-20.\nG41 D1 G1 X0. Y0. F600\nY40.\nG40 Y50.\nM30\n";
    assert!(moves("fanuc", mirrored).contains("feed X5.0000 Y0.0000 F600.00"));
}

#[test]
fn sharp_outside_corners() {
    // The path bends by 135°: on by the radius to (-5, 45), across to
    // (0, 40 + 5√2), and along the shifted line, which ends at
    // (30, 10) + 5(1, 1)/√2 next to its end.
    let program = "G10 L12 P1 R5.\nG0 X20. Y-20.\nG41 D1 G1 X0. Y0. F600\nY40.\nX30. Y10. F500\nG40 X40. Y0.\nM30\n";
    assert_snapshot!(moves("fanuc", program), @r"
2 rapid X20.0000 Y-20.0000
3 feed X-5.0000 Y0.0000 F600.00
4 feed Y45.0000 F600.00
5 feed X0.0000 Y47.0711 F500.00
5 feed X33.5355 Y13.5355 F500.00
6 feed X40.0000 Y0.0000 F500.00
");
}

#[test]
fn arcs_at_outside_corners() {
    // Tangents meet at (-5, 45); the arc about (0, 20) begins at (0, 45) with a
    // radius of 25. It goes over into the line after it.
    let program = "G10 L12 P1 R5.\nG0 X20. Y-20.\nG41 D1 G1 X0. Y0. F600\nY40.\nG2 X20. Y20. J-20.\nG1 Y0.\nX10.\nG40\nZ5.\nX0. Y9.\nM30\n";
    assert_snapshot!(moves("fanuc", program), @r"
2 rapid X20.0000 Y-20.0000
3 feed X-5.0000 Y0.0000 F600.00
4 feed Y45.0000 F600.00
5 feed X0.0000 F600.00
5 arc X25.0000 Y20.0000 about 0.0000,20.0000 by -90.000 F600.00
6 feed Y-5.0000 F600.00
7 feed X10.0000 F600.00
9 feed Z5.0000 F600.00
10 feed X0.0000 Y9.0000 F600.00
");
}

#[test]
fn inside_corners() {
    // A pocket of 40 by 50 with a corner of radius 10: smaller by 5 all round.
    let program = "G10 L12 P1 R5.\nG0 X20. Y20.\nG41 D1 G1 X0. Y20. F600\nY0.\nX40.\nZ-3.\nY40.\nG3 X30. Y50. I-10.\nG1 X0.\nY10.\nG40 X20.\nM30\n";
    assert_snapshot!(moves("fanuc", program), @r"
2 rapid X20.0000 Y20.0000
3 feed X5.0000 F600.00
4 feed Y5.0000 F600.00
5 feed X35.0000 F600.00
6 feed Z-3.0000 F600.00
7 feed Y40.0000 F600.00
8 arc X30.0000 Y45.0000 about 30.0000,40.0000 by 90.000 F600.00
9 feed X5.0000 F600.00
10 feed Y10.0000 F600.00
11 feed X20.0000 F600.00
");
}

/// B-63944EN, "Tool Movement in Start-up", type B.
#[test]
fn type_b_goes_round_the_first_and_the_last_corner() {
    // The first move comes from the lower right, the path bends by 45°: to
    // where the shifted lines meet, (-5, -5·tan 22.5°); likewise at the end.
    let obtuse = "G10 L12 P1 R5.\nG0 X20. Y-20.\nG41 D1 G1 X0. Y0. F600\nY40.\nX40.\nY0.\nX0.\nG40 X-20. Y20.\nM30\n";
    assert_snapshot!(moves_on(&type_b(), "", obtuse), @r"
2 rapid X20.0000 Y-20.0000
3 feed X-5.0000 Y-2.0711 F600.00
4 feed Y45.0000 F600.00
5 feed X45.0000 F600.00
6 feed Y-5.0000 F600.00
7 feed X-2.0711 F600.00
8 feed X-20.0000 Y20.0000 F600.00
");
    // From the upper right it bends by 135°: (0, -5√2), then (-5, -5).
    let acute = "G10 L12 P1 R5.\nG0 X20. Y20.\nG41 D1 G1 X0. Y0. F600\nY40.\nG40 Y60.\nM30\n";
    assert_snapshot!(moves_on(&type_b(), "", acute), @r"
2 rapid X20.0000 Y20.0000
3 feed X0.0000 Y-7.0711 F600.00
4 feed X-5.0000 Y-5.0000 F600.00
4 feed Y40.0000 F600.00
5 feed X0.0000 Y60.0000 F600.00
");
}

#[test]
fn the_nose_of_a_lathe_tool() {
    // Nose radius 0.8, imaginary nose 3 (towards -X and -Z): along Z and along
    // X the tip is on the contour; at the ends it stays off by the radius.
    let program = "T0303\nG98 G0 X60. Z10.\nG42 G1 X40. Z2. F100\nZ-20.\nX60.\nG40 X70.\nM30\n";
    let lathe = machine_of("fanuc-lathe", "", "XYZ", "");
    assert_snapshot!(moves_on(&lathe, "T3 D1.6 Q3\n", program), @r"
2 rapid X30.0000 Z10.0000
3 feed X20.0000 Z1.2000 F100.00
4 feed Z-20.0000 F100.00
5 feed X29.2000 F100.00
6 feed X35.0000 F100.00
");
    // G71 follows the contour as it is programmed; G70 the shifted one: in
    // from (15, 5) to next to the first move, and back to where it began.
    let contour = "T0303\nG98 G0 X30. Z5.\nG71 P10 Q20 D4. R1. F100.\nN10 G42 G0 X10.\nG1 Z-20. F100.\nX24.\nN20 G40 X28.\nG70 P10 Q20\nM30\n";
    let table = "T3 D1.6 Q3\n";
    let found = moves_on(&lathe, table, contour);
    let (rough, finish) = found.split_at(found.find("8 rapid").unwrap_or(0));
    let plain = moves(
        "fanuc-lathe",
        &contour.replace("G42", "").replace("G40", ""),
    );
    assert!(!rough.is_empty() && plain.starts_with(rough), "{found}");
    assert_snapshot!(finish, @r"
8 rapid X5.0000 Z4.2000
8 feed Z-20.0000 F100.00
8 feed X11.2000 F100.00
8 feed X14.0000 F100.00
8 rapid X15.0000 Z5.0000
");
    let open = contour.replace("N20 G40 X28.", "N20 X28.");
    assert_eq!(
        moves_on(&lathe, table, &open),
        "8 contour: a contour of a turning cycle under tool nose radius compensation, where the radius is known\n"
    );
}

#[test]
fn without_a_radius_the_path_is_the_programmed_one() {
    // No table, offset 0, a radius of 0: cycles, reference points and tool
    // changes go on as ever, but `limit` leaves the blocks as they are.
    for controller in [
        "iso",
        "fanuc",
        "haas",
        "mitsubishi",
        "mazak",
        "syntec",
        "okuma",
        "siemens",
    ] {
        let program = "G0 X20. Y20.\nG41 D1 G1 X0. F600\nY0.\nX40.\nG42\nG2 X60. Y20. I0. J20.\nG40 G1 X20.\nM30\n";
        let plain = program
            .replace("G41 D1", "")
            .replace("G42", "")
            .replace("G40", "");
        assert_eq!(
            moves(controller, program),
            moves(controller, &plain),
            "{controller}"
        );
    }
    for controller in ["fanuc-lathe", "fanuc-lathe-b"] {
        let program = "T0101\nG0 X20. Z20.\nG42 G1 X0. F.1 S100 M3\nZ0.\nG40 X20.\nM30\n";
        let plain = program.replace("G42", "").replace("G40", "");
        assert_eq!(
            moves(controller, program),
            moves(controller, &plain),
            "{controller}"
        );
    }
    let cycles = "G0 X20.\nG41 D1 G1 X0. F600\nG81 Z-3. R1.\nG80 G28 Z0.\nM6 T2\nG40 X20.\nM30\n";
    assert!(!moves("fanuc", cycles).contains("compensation"));
}

#[test]
fn limit_writes_nothing_between_such_blocks() {
    // As under LinuxCNC's compensation: the feed is put back before it begins,
    // and nothing is written between its blocks; nor into corners.
    let mill = Rig {
        controller: "fanuc",
        rest: EXACT_STOP,
        ..RIG
    };
    let compensated =
        "G1 X400. F30000\nG41 D1 G1 X410. F600\nY20.\nX430.\nG40 X440.\nX0. F30000\nM2\n";
    assert_snapshot!(mill.fits(compensated), @r"
G1 X400. F24000
F30000
G41 D1 G1 X410. F600
Y20.
X430.
G40 X440.
X0. F24000
F30000
M2
");
    let rounded = "G1 X400. F30000\nX410. F600,R2.\nY20.,C3.\nX430.\nX0. F30000\nM2\n";
    assert_snapshot!(mill.fits(rounded), @r"
G1 X400. F24000
F30000
X410. F600,R2.
Y20.,C3.
X430.
X0. F24000
F30000
M2
");
    let reasons = mill.reasons("G1 X0. F600\nX400. F30000 ,R2.\nY20. F600\nM2\n");
    let first = reasons.first().expect("a reason");
    assert_eq!(
        (first.line, first.text.as_slice()),
        (2, b"X400. F30000 ,R2.".as_slice())
    );
    assert_eq!(
        first.message,
        "the block may not be changed: a corner is cut or rounded there"
    );
}

#[test]
fn what_cannot_be_compensated() {
    let table = "T1 D10\nT2 D4\n";
    let fanuc = machine_of("fanuc", "", "XYZ", "");
    let mut all = String::new();
    for rest in [
        "G41 D3 X10.",
        "G41 D1 X10.\nG40 X0.",
        "G41 D1 G2 X10. I5.",
        "G41 D1 X10.\nY10.\nM8\nM9\nX20.\nG40 X0.",
        "G41 D1 X10.\nY10.\nD2\nX20.\nG40 X0.",
        "G41 D1 X10.\nY10.\nG42 D1\nX20.\nG40 X0.",
        "G41 D1 X10.\nY10.\nG28 Z0.\nG40 X0.",
        "G41 D1 X10.\nY10.\nG81 Z-3. R1.\nG40 X0.",
        "G41 D1 X10.\nY10.\nX6.\nY0.\nG40 X0.",
        "G41 D1 X10.\nY10.\nG3 X4. Y10. I-3.\nG1 G40 X0.",
        "G41 D1 X10.\nY10.\nZ#5021\nG40 X0.",
        "G41 D1 X10.\nY10.\nG40\nG42 D1 X0.\nY0.",
    ] {
        all.push_str(&moves_on(&fanuc, table, &format!("G1 F600\n{rest}\nM30\n")));
    }
    assert_snapshot!(all, @r"
2 tool-radius: the radius of G41 and G42, number 3, is not known
3 compensation: the compensation ends with no move in the plane after the one that began it
2 compensation: the first move under cutter compensation must be straight here
6 compensation: the control does not look this far ahead for the corner: blocks without motion in the plane of the compensation come before it
4 compensation: another radius under cutter compensation: the controller stops here
4 compensation: cutter compensation is on already
4 compensation: a reference point under cutter compensation: the controller stops here
4 compensation: this motion under cutter compensation: the controller stops here
5 compensation: the line before this inside corner is too short for the tool
4 compensation: the arc's radius is not larger than the radius of the tool inside it
4 unknown-value: #5021 depends on where the path ends under cutter compensation, which only the machine knows
5 compensation: the tool has not left the compensation before this one
");
    for (controller, said) in [
        (
            "iso",
            "2 compensation: how this controller shifts a path in corners is not known\n",
        ),
        (
            "okuma",
            "2 compensation: how this controller shifts a path in corners is not known\n",
        ),
    ] {
        let program = "G0 X0.\nG41 D1 G1 X10. F600\nY10.\nG40 X0.\nM30\n";
        assert_eq!(
            moves_on(&machine_of(controller, "", "XYZ", ""), table, program),
            said
        );
    }
    // A Mitsubishi looks beyond three blocks without motion.
    let three = "G1 F600\nG41 D1 X10.\nY10.\nM8\nM9\nM8\nX20.\nG40 X0.\nM30\n";
    assert!(
        moves_on(&machine_of("mitsubishi", "", "XYZ", ""), table, three).contains("feed X20.0000")
    );
}

#[test]
fn sinumerik_goes_round_corners_by_arcs_or_to_where_lines_meet() {
    // NORM: next to the start of the next move. G450: an arc about the corner.
    // CFC: on the outer arc the edge has F, the centre 25/20 of it. G451: on to
    // where the shifted lines meet; an arc again where the path bends by 135°.
    let program = "$TC_DP6[1,1]=4.5 $TC_DP15[1,1]=0.5\nT1 D1\nG0 X-20 Y-20\nG41 G1 X0 Y0 F600\nY40\nX40\nG2 X60 Y20 J-20\nG451\nG1 Y0\nX20\nX40 Y-20\nG40 X50 Y-30\nM30\n";
    assert_snapshot!(moves("siemens", program), @r"
3 rapid X-20.0000 Y-20.0000
4 feed X-5.0000 Y0.0000 F600.00
5 feed Y40.0000 F600.00
6 arc X0.0000 Y45.0000 about 0.0000,40.0000 by -90.000 F600.00
6 feed X40.0000 F600.00
7 arc X65.0000 Y20.0000 about 40.0000,20.0000 by -90.000 F750.00
9 feed Y-5.0000 F600.00
10 feed X32.0711 F600.00
11 feed X43.5355 Y-16.4645 F600.00
12 feed X50.0000 Y-30.0000 F600.00
");
    let center = program.replace("G41 G1", "CFTCP G41 G1");
    assert!(
        moves("siemens", &center).contains("Y20.0000 about 40.0000,20.0000 by -90.000 F600.00")
    );
    // By the table: the tool of T.
    let table = program.replace("$TC_DP6[1,1]=4.5 $TC_DP15[1,1]=0.5", "M8");
    let siemens = machine_of("siemens", "", "XYZ", "");
    assert_eq!(
        moves_on(&siemens, "T1 D10\n", &table),
        moves("siemens", program)
    );
    let mut all = String::new();
    for rest in [
        "D2 G41 X10",
        "KONT G41 X10",
        "DISC=50 G41 X10",
        "G451 G41 X-10\nY20\nG2 X10 Y0 J-20\nG1 X9\nG40 X0",
        "G41 X-10\nY20\nMIRROR X0\nG1 Y50\nG40 X0",
    ] {
        let program = format!("T1\nG1 F600\n{rest}\nM30\n");
        all.push_str(&moves_on(&siemens, "T1 D10\n", &program));
    }
    assert_snapshot!(all, @r"
3 tool-radius: the table has one edge of a tool, and D2 is another
3 compensation: an approach round the start of the contour (KONT) is not followed
3 compensation: rounded outside corners (DISC above 0) are not followed
5 compensation: an outside corner with an arc under G451
6 compensation: mirroring under cutter compensation
");
}

/// "Thread cutting (G33)", "Tapping (G331, G332)", "Tapping with compensating chuck
/// (G63)".
#[test]
fn threads_and_taps_of_sinumerik() {
    // A lead of 2 at 600/min: 1200 mm/min along Z; on a taper of 4 in 10 the
    // path is √116/10 as fast. G331 with K-1.25 at 300/min: 375. G332 takes the
    // lead of G331. M12 has a pitch of 1.75: 700 in, 1400 out.
    let program = "S600 M3 OVR=50\nG0 X40 Z2\nG33 Z-20 K2 SF=180\nX44 Z-30 K2\nG0 Z2\nG331 Z-12 K-1.25 S300\nG332 Z2\nG63 Z-10 F500\nG0 Z5\nCYCLE84(20,10,2,,15,0,3,12,,0,400,800)\nM30\n";
    assert_snapshot!(moves("siemens", program), @r"
2 rapid X40.0000 Z2.0000
3 thread Z-20.0000 F1200.00
4 thread X44.0000 Z-30.0000 F1292.44
5 rapid Z2.0000
6 tap Z-12.0000 F375.00
7 tap Z2.0000 F375.00
8 tap Z-10.0000 F500.00
9 rapid Z5.0000
10 rapid Z12.0000
10 tap Z-5.0000 F700.00
10 tap Z12.0000 F1400.00
10 rapid Z20.0000
");
    let mut all = String::new();
    for rest in [
        "S100 G33 Z-4",
        "S100 G331 Z-4 I1",
        "G33 Z-4 K1",
        "S100 G33 Z-4 K1 I2",
        "G34 Z-4 K1 F1",
    ] {
        all.push_str(&moves("siemens", &format!("{rest}\n")));
    }
    assert_snapshot!(all, @r"
1 thread-pitch: a thread needs one lead
1 thread-pitch: the lead is not one of an axis that moves
1 no-spindle-speed: a thread, but no spindle speed is in force
1 thread-pitch: a thread needs one lead
1 unsupported-code: G34 is thread cutting, which gwatt does not support
1 unused-word: nothing in this block uses the K word
");
}
