//! Programs of Fanuc, Haas and their relatives.
//!
//! Sources: Fanuc B-63944EN ("Decimal Point Programming", "Skip Function",
//! "Custom Macro"), Haas mill operator's manual.

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, Options};
use insta::assert_snapshot;

use crate::listing::{errors_of, in_full, machine_of, without_lines};
use crate::runs::moves_of;

/// A machine with linear axes X Y Z and rotary axes B C; `more` goes into its
/// file.
fn machine(controller: &str, more: &str) -> Machine {
    machine_of(controller, more, "XYZ", "BC")
}

/// The moves of a program, a line each, or the messages of a refusal.
pub(crate) fn moves(controller: &str, program: &str) -> String {
    moves_on(&machine(controller, ""), program)
}

fn moves_on(machine: &Machine, program: &str) -> String {
    let (moves, failure) = moves_of(machine, &Options::default(), program);
    if let Some(failure @ Failure::Refused { .. }) = failure {
        return errors_of(&failure);
    }
    moves
        .iter()
        .map(in_full)
        .collect::<String>()
        .replace("-0.0000", "0.0000")
}

/// Rules of the notes on a program.
pub fn notes(controller: &str, program: &str) -> Vec<&'static str> {
    let all = noted(controller, program);
    all.into_iter().map(|note| note.rule).collect()
}

/// The notes on a program that a parameter of the control is not known.
pub fn messages(controller: &str, program: &str) -> Vec<String> {
    let all = noted(controller, program).into_iter();
    let parameters = all.filter(|note| {
        note.message.contains("tap_feed") || note.message.contains("pecks_return_to_r")
    });
    parameters.map(|note| note.message).collect()
}

fn noted(controller: &str, program: &str) -> Vec<gwatt::diagnostic::Diagnostic> {
    let machine = machine(controller, "");
    pipeline::moves(
        Cursor::new(program),
        &machine,
        &Options::default(),
        &mut |_, _| Ok(()),
    )
    .unwrap_or_default()
}

/// B-64304EN, "Preparatory Function": of several G codes of one group in a block the last is
/// valid. G28 goes over a place here, not over an increment.
#[test]
fn the_last_g_word_of_a_group_counts() {
    let found = moves("fanuc", "G90 G21 G0 X0 Y0 Z50.\nG91 G28 Z60. G90\nG0 X5.\n");
    let twin = moves("fanuc", "G90 G21 G0 X0 Y0 Z50.\nG90 G28 Z60.\nG0 X5.\n");
    assert_eq!(found, twin);
    let found = moves(
        "fanuc",
        "G0 G1 G0 X5.\nG54 G55 G20 G21 G17 G19 G17 G40 G41 G40 G94\nX6.\n",
    );
    assert_eq!(found, moves("fanuc", "G0 X5.\nG55 G21 G17 G40 G94\nX6.\n"));
    assert!(notes("fanuc", "G1 G0 X5.\n").contains(&"last-g-counts"));
    let refused = |program: &str, expected: &str| {
        let said = format!("1 modal-group-twice: {expected}\n");
        assert!(moves("fanuc", program).starts_with(&said), "{program}");
    };
    let plain = "two G words of one modal group in a block";
    refused("G0 G81 X5. Z-5. R2. F100.\n", plain);
    refused("G28 G52 X5.\n", plain);
    refused(
        "G0 G90 X5. G91 Y5.\n",
        "two G words of one modal group, with words before and after the last of them",
    );
    assert_eq!(
        moves("haas", "G0 G1 X5.\n"),
        format!("1 modal-group-twice: {plain}\n")
    );
}

/// B-64310EN, parameter 3403 bit CIR: an arc without a centre is a straight line at F.
#[test]
fn an_arc_without_a_centre_may_be_a_line() {
    let program = "G2 X10. Y10. R10. F100.\nX30.\nY0 I0 J-5.\n";
    let line = machine("fanuc", "[language]\narc_without_center = \"line\"\n");
    let found = moves_on(&line, program);
    assert_snapshot!(found, @r"
    1 arc X10.0000 Y10.0000 center 10.0000,0.0000 turns -0.2500 F100.0000
    2 feed X30.0000 F100.0000
    3 arc X30.0000 Y0.0000 center 30.0000,5.0000 turns -0.5000 F100.0000
    ");
    let said = "2 arc-center: an arc without a centre (I J) or R\n";
    // By default it is one too, as a control that does not do so stops with an alarm.
    assert_eq!(moves("fanuc", program), found);
    assert!(notes("fanuc", program).contains(&"arc-as-line"));
    assert!(moves("haas", program).contains(said));
    let refused = machine("fanuc", "[language]\narc_without_center = \"refused\"\n");
    assert!(moves_on(&refused, program).contains(said));
}

/// B-64484EN, "Machine coordinate system": G53 moves by rapid traverse, whatever the motion word.
#[test]
fn moves_in_machine_coordinates_are_rapids() {
    let program = "G1 X10. F100.\nG53 Z-10.\nX20.\n";
    assert_snapshot!(moves("fanuc", program), @r"
    1 feed X10.0000 F100.0000
    2 rapid Z-10.0000
    3 feed X20.0000 F100.0000
    ");
    assert!(notes("fanuc", program).contains(&"rapid-in-g53"));
    // Under G91 Fanuc ignores G53, and Mitsubishi takes it as an increment (M700V, 14.4).
    assert_eq!(
        moves("fanuc", "G91 G0 X10.\nG53 X-200.\n"),
        "2 incremental-in-g53: G53 under G91: controls ignore it, or take it as an increment\n"
    );
    assert_snapshot!(moves("fanuc", "G91 G0 X10.\nG90 G53 X-200.\n"), @r"
    1 rapid X10.0000
    2 rapid X-200.0000
    ");
    // Mitsubishi: "cutting feedrate or rapid traverse following command modal".
    assert_snapshot!(moves("mitsubishi", program), @r"
    1 feed X10.0000 F100.0000
    2 feed Z-10.0000 F100.0000
    3 feed X20.0000 F100.0000
    ");
}

/// The way out of a tap is as fast as the machine file says, and so is the spindle. In pecks it
/// counts as coming back to R, which takes the longest.
#[test]
fn taps_return_faster_and_peck() {
    let program = "S500 M3\nG0 Z10.\nG99 G84 X5. Z-5. R2. F500.\nX10. Q3.\nG80\n";
    let faster = machine("fanuc", "[language]\ntap_return_factor = 2\n");
    assert_snapshot!(moves_on(&faster, program), @r"
    2 rapid Z10.0000
    3 rapid X5.0000
    3 rapid Z2.0000
    3 tap Z-5.0000 F500.0000
    3 tap Z2.0000 F1000.0000
    4 rapid X10.0000
    4 tap Z-1.0000 F500.0000
    4 tap Z2.0000 F1000.0000
    4 tap Z-4.0000 F1000.0000
    4 tap Z2.0000 F1000.0000
    4 tap Z-5.0000 F1000.0000
    4 tap Z2.0000 F1000.0000
    ");
    assert!(notes("fanuc", program).contains(&"tap-return"));
    assert!(notes("fanuc", program).contains(&"tap-pecks"));
}

/// Lengths without a point are noted wherever they stand; a level of G05.1 is none.
#[test]
fn numbers_without_a_point_are_noted_in_corners_and_arguments() {
    let noted = |program: &str| notes("fanuc", program).contains(&"no-point");
    assert!(noted("G0 X0. Y0.\nG1 X100. ,C5 F1000.\nY50.\n"));
    assert!(!noted("G0 X0. Y0.\nG1 X100. ,C5. F1000.\nY50.\n"));
    let call = "G0 X0.\nG65 P100 A100\nM30\nO100\nG0 X#1\nM99\n";
    assert!(noted(call));
    assert!(!noted(&call.replace("A100", "A100.")));
    assert!(!noted("G05.1 Q1 R5\nG0 X1.\nG05.1 Q0\n"));
}

/// B-63944EN, "Decimal Point Programming".
#[test]
fn numbers_without_a_point() {
    let program = "G21 G0 X100 Y1.5\nB90\n#1=20\nX#1\nX[#1+1]\nG20 X1000\nG21 G1 X5000 F600\n";
    assert_snapshot!(moves("fanuc", program), @r"
1 rapid X100.0000 Y1.5000
2 rapid B90.0000
4 rapid X20.0000
5 rapid X21.0000
6 rapid X25400.0000
7 feed X5000.0000 F600.0000
");
    assert!(notes("fanuc", program).contains(&"no-point"));
    assert!(!notes("fanuc", "G0 X1. Y0\n").contains(&"no-point"));
    // What is worked out is meant as with a point; inches have 0.0001.
    let least = machine("fanuc", "[language]\ndecimal_point = \"least-increment\"\n");
    assert_snapshot!(moves_on(&least, program), @r"
1 rapid X0.1000 Y1.5000
2 rapid B0.0900
4 rapid X20.0000
5 rapid X21.0000
6 rapid X2.5400
7 feed X5.0000 F600.0000
");
}

/// B-63604EN, "Diameter and Radius Programming".
#[test]
fn diameters_may_be_off() {
    let radius = machine("fanuc-lathe", "[language]\ndiameter = false\n");
    assert_eq!(
        moves_on(&radius, "G0 X40. Z1.\n"),
        "1 rapid X40.0000 Z1.0000\n"
    );
}

/// B-63944EN, "Dwell (G04)".
#[test]
fn dwells_in_seconds_and_milliseconds() {
    let program = "G0 X1.\nG04 P500\nG04 P1.5\nG04 X2.\n";
    assert_snapshot!(moves("haas", program), @r"
1 rapid X1.0000
2 dwell 0.5 s
3 dwell 1.5 s
4 dwell 2 s
");
    assert_eq!(moves("fanuc-lathe", "G04 U1.5\n"), "1 dwell 1.5 s\n");
}

/// B-63944EN, "Program Number", "Subprogram (M98, M99)".
#[test]
fn programs_by_number_and_by_name() {
    let program = "%\n<MAIN>\nG0 X10.\nM98 <SUB> L2\nM98 P20012\nM98 P12345\nM198 P12\nG65 <SUB>\nM30\n<SUB>\nG91 X1.\nG90\nM99\n:0012\nX5.\nX0\nM99\nO12345\nX77.\nM99\n%\n";
    assert_snapshot!(moves("haas", program), @r"
3 rapid X10.0000
11 rapid X11.0000
11 rapid X12.0000
15 rapid X5.0000
16 rapid X0.0000
15 rapid X5.0000
16 rapid X0.0000
19 rapid X77.0000
15 rapid X5.0000
16 rapid X0.0000
11 rapid X1.0000
");
    assert_snapshot!(moves("fanuc", "G0 X1. <SUB>\nM98 <SUB>\n"), @r"
1 program-name: nothing in this block calls the program that it names
2 no-such-subprogram: there is no subprogram o<sub>
");
}

/// A bolt circle by a macro, and the same written out.
#[test]
fn a_macro_and_its_twin() {
    let by_macro = "O1000 (BOLT CIRCLE)\nG21 G17 G90 G0 X0 Y0 Z50.\nS800 M3\nG65 P9100 R40. H6. A30. Z-12. F150.\nG0 Z50. M5\nM30\nO9100\n#30=#4003\n#1=#1\n#2=0\nWHILE[#2LT#11]DO1\n#3=#1+#2*360/#11\nG90 G0 X[#18*COS[#3]] Y[#18*SIN[#3]]\nZ2.\nG1 Z#26 F#9\nG0 Z2.\n#2=#2+1\nEND1\nIF[#2NE6]THEN #3000=1(HOLES)\nG#30\nM99\n";
    let mut expanded = "G21 G17 G90 G0 X0 Y0 Z50.\nS800 M3\n".to_owned();
    for hole in 0..6 {
        let angle = f64::from(30 + 60 * hole).to_radians();
        let _ = writeln!(
            expanded,
            "G0 X{:.9} Y{:.9}\nZ2.\nG1 Z-12. F150.\nG0 Z2.",
            40.0 * libm::cos(angle),
            40.0 * libm::sin(angle)
        );
    }
    expanded.push_str("G0 Z50. M5\nM30\n");
    for controller in ["fanuc", "haas", "mazak", "mitsubishi", "syntec"] {
        let [twin, by_macro] = [&expanded, by_macro].map(|program| moves(controller, program));
        let twin = without_lines(&twin);
        assert_eq!(twin.len(), 26);
        assert_eq!(without_lines(&by_macro), twin, "{controller}");
    }
}

#[test]
fn words_that_move_nothing() {
    let program = "G5.1 Q1 R5\nG05 P10000\nG08 P1\nG0 X5. M88\nM62 P1\nM29 S500\nG2 X0 I-2.5 J0 F500. M127\nG31 Z-5. F100.\nG1 Z1.\n";
    assert_snapshot!(moves("fanuc", program), @r"
4 rapid X5.0000
7 arc X0.0000 Y0.0000 center 2.5000,0.0000 turns -0.5000 F500.0000
8 probe Z-5.0000 F100.0000
9 feed F100.0000
");
    let found = notes("fanuc", program);
    for note in ["builder-m", "probed"] {
        assert!(found.contains(&note), "{found:?}");
    }
    assert!(notes("haas", "G187 P1 E0.1\nG103 P1\nG0 X1.\nG28\n").contains(&"smoothness"));
    assert_eq!(moves("haas", "G0 X1. Y2.\nG28\n").lines().count(), 2);
}

/// B-63944EN, "System Variables": #3000, #4001 to #4021.
#[test]
fn alarms_and_state() {
    let program = "IF[#5405GE6000]THEN#3000=15(TOOL LIFE)\nG91 G18 G20\n#1=#4003\n#2=#4002\n#3=#4006\nG0 G90 G21 X#1 Y#2 Z#3\n#3006=1(CHECK)\n#3000=1(STOP)\nG0 X500.\n";
    assert_snapshot!(moves("fanuc", program), @"6 rapid X91.0000 Y18.0000 Z20.0000");
    let found = notes("fanuc", program);
    for note in ["alarm-not-raised", "alarm", "after-the-end"] {
        assert!(found.contains(&note), "{found:?}");
    }
    let time = moves("fanuc", "#3001=0\n#1=#3001\nG0 X#1\n");
    assert!(
        time.contains("unknown-value: #1 depends on the time"),
        "{time}"
    );
}

/// Mitsubishi M700V: an `,F` on G0 is not documented well enough to be followed.
#[test]
fn a_feed_behind_a_comma_is_refused() {
    let found = moves_on(&machine("mitsubishi", ""), "G0 X10. ,F500\nM30\n");
    assert_snapshot!(found, @"1 corner-word: a word after a comma is not supported");
}

#[test]
fn arc_centres_as_the_machine_file_says() {
    // Half a circle about (10, 0); as a distance from the start it is none.
    let program = "G0 X10. Y5.\nG2 X10. Y-5. I10. J0. F600\nM30\n";
    let absolute = machine("fanuc", "[language]\narc_centre = \"absolute\"\n");
    assert_snapshot!(moves_on(&absolute, program), @r"
1 rapid X10.0000 Y5.0000
2 arc X10.0000 Y-5.0000 center 10.0000,0.0000 turns -0.5000 F600.0000
");
    let found = moves("fanuc", program);
    assert!(
        found.contains("2 arc-radius: the arc's end is not on its circle"),
        "{found}"
    );
}

#[test]
fn what_is_refused_by_name() {
    let cases = [
        (
            "G1 X1. ,A30. F1.",
            "an angle of a drawing (,A) is not supported",
        ),
        ("G12.1", "G12.1 is polar interpolation"),
        ("G107 C10.", "G107 is cylindrical interpolation"),
        ("G150", "G150 is a pocket"),
        ("G13 F1.", "G12 and G13: without I"),
        ("G47", "G47 is engraving of text"),
        ("G51.2", "G51.2 is turning of polygons"),
        (
            "G29",
            "G29 is a return from or a check of the reference point",
        ),
        ("G60", "G60 is positioning from one side"),
        (
            "G5 P10001 L2",
            "G5 with this P runs a high-speed cycle that the control keeps, which moves axes in ways that the program does not say",
        ),
        ("M96", "M96 is a jump or an interrupt by an input"),
        ("M109", "M109 is a value that the operator types"),
    ];
    for (block, expected) in cases {
        let found = moves("haas", &format!("G0 X0\n{block}\n"));
        assert!(found.contains(expected), "{block}: {found}");
    }
}

/// Fanuc shows the end of a block as `;`: what follows is another block, and no comment.
#[test]
fn a_second_block_on_a_line() {
    let refused = "2 second-block: `;` ends a block on this control, and another one follows on \
                   the same line\n";
    for controller in [
        "fanuc",
        "haas",
        "mitsubishi",
        "mazak",
        "syntec",
        "fanuc-lathe",
    ] {
        assert_eq!(moves(controller, "G21\nG0 X1.; G0 X500.;\nM30\n"), refused);
    }
    let plain = "G21\nG0 X1. ; over there\n(A;X2.)\nG0 X2.;\nM30\nG0;X5.\n";
    assert_eq!(moves("fanuc", plain), "2 rapid X1.0000\n4 rapid X2.0000\n");
    assert_eq!(
        moves("linuxcnc", "G21\nG0 X1.; G0 X500.\nM2\n"),
        "2 rapid X1.0000\n"
    );
}

/// Q of milling cycles without a point: as the other lengths where the machine file says what
/// they mean, else as whole millimetres, unless the hole is not so deep.
#[test]
fn pecks_without_a_point() {
    let pecks = |language: &str, q: &str| {
        let program = format!("G21 G90 G0 X0 Y0 Z30.\nG99 G83 Z-20. R2. Q{q} F100.\nG80\nM30\n");
        let machine = machine("fanuc", &format!("[language]\n{language}\n"));
        moves_on(&machine, &program).matches(" feed ").count()
    };
    let fine = "decimal_point = \"least-increment\"";
    let whole = "decimal_point = \"calculator\"";
    assert_eq!(pecks(fine, "5500"), 4);
    assert_eq!(pecks(fine, "5.5"), 4);
    assert_eq!(pecks(whole, "5500"), 1);
    assert_eq!(pecks("", "5500"), 4);
    assert_eq!(pecks("", "11"), 2);
    // K says how often, whatever numbers mean.
    let program = "G21 G90 G0 X0 Y0 Z30.\nG99 G81 Z-20. R2. F100.\nG91 X7.5 K3\nG80\nM30\n";
    let machine = machine("fanuc", &format!("[language]\n{fine}\n"));
    assert_eq!(moves_on(&machine, program).matches(" feed ").count(), 4);
    assert!(!notes("fanuc", program).contains(&"no-point"));
}

/// Units are those of the program before, or a setting, where the program says nothing.
#[test]
fn units_that_nobody_gave() {
    let program = "G0 X10. Y10.\nM30\n";
    for controller in ["fanuc", "haas", "haas-lathe", "mazak", "okuma", "linuxcnc"] {
        let program = if controller == "haas-lathe" {
            "G0 X10. Z10.\nM30\n"
        } else {
            program
        };
        assert!(
            notes(controller, program).contains(&"no-units"),
            "{controller}"
        );
        assert!(!notes(controller, &format!("G21 {program}")).contains(&"no-units"));
    }
    assert!(!notes("grbl", program).contains(&"no-units"));
    let said = machine("fanuc", "[language]\nunits = \"mm\"\n");
    let mut summary = pipeline::analyze(Cursor::new(program), &said, &Options::default(), None);
    let notes = summary
        .as_mut()
        .map(|it| std::mem::take(&mut it.notes))
        .unwrap();
    assert!(notes.iter().all(|note| note.rule != "no-units"));
}

/// With a point places would be others than those of the program.
#[test]
fn nothing_is_written_in_another_way_without_points() {
    let shop = |language: &str| {
        let rest = format!("[path]\nrapid = \"linear\"\n[language]\n{language}\n");
        crate::shop::Shop::mill("fanuc", "peak_power_w = 400", &rest, "")
    };
    let program = "G21 G90 G0 Z30.\nG99 G81 X200 Y80. Z-20. R2. F100.\nG80\nM30\n";
    let run = |language: &str| {
        let shop = shop(language);
        shop.put("a.nc", program);
        shop.run("limit a.nc --allow feed,expand")
    };
    let (code, _, errors) = run("");
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("numbers of the program have no decimal point"),
        "{errors}"
    );
    let (code, text, errors) = run("decimal_point = \"calculator\"");
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("X200"), "{text}");
}

/// Where the offset moves the axis, a length by itself moves it.
#[test]
fn lengths_without_a_place() {
    let noted = |program: &str| {
        let notes = notes(
            "fanuc",
            &format!("G21 G90 G54\nG0 X0. Y0.\n{program}\nM30\n"),
        );
        notes.contains(&"length-alone")
    };
    for alone in ["G43 H1", "G91 G43 Z5. H1", "G43 Z50. H1\nG49", "G43 X5. H1"] {
        assert!(noted(alone), "{alone}");
    }
    for placed in [
        "G43 Z50. H1",
        "G43 G90 Z5. H1",
        "G40 G49 G80",
        "G43 Z50. H1\nG91 G28 Z0. G49",
    ] {
        assert!(!noted(placed), "{placed}");
    }
}
