//! Blocks to moves: what each word means, by hand-worked programs.

use std::fmt::Write as _;

use gwatt::interpret::BlockDelete;
use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, Options, Reading};
use insta::assert_snapshot;

use crate::listing::{in_full, machine_of};
use crate::runs::moves_of;

/// A machine with linear axes X Y Z U and rotary axes A C.
pub(crate) fn machine(controller: &str) -> Machine {
    machine_of(controller, "", "XYZU", "AC")
}

/// The moves of a program, a line each: line, kind, the axes that differ from
/// the start, and feed in mm/min; or the messages of a refusal.
fn moves(controller: &str, program: &str) -> String {
    moves_with(controller, program, &Options::default())
}

/// The same with these options.
pub(crate) fn moves_with(controller: &str, program: &str, options: &Options) -> String {
    let (moves, failure) = moves_of(&machine(controller), options, program);
    let mut out: String = moves.iter().map(in_full).collect();
    if let Some(Failure::Refused { diagnostics, .. }) = failure {
        for found in diagnostics {
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

/// LinuxCNC, "G90, G91", "G20, G21", "G54-G59.3", "G92": the program's numbers in the
/// machine's millimetres.
#[test]
fn distance_modes_units_and_offsets() {
    let program = "G21 G90 G0 X10 Y5\nG91 X1 Y-1\nG90 G20 X1\nG21 G92 X0\nG1 X10 F100\nG92.2\nX40\nG92.3\nX0\nG92.1\nX0\nG53 G0 X7\n";
    assert_snapshot!(moves("iso", program), @r#"
1 rapid X10.0000 Y5.0000
2 rapid X11.0000 Y4.0000
3 rapid X25.4000
5 feed X35.4000 F100.0000
7 feed X40.0000 F100.0000
9 feed X25.4000 F100.0000
11 feed X0.0000 F100.0000
12 rapid X7.0000
"#);
}

/// LinuxCNC, "G2, G3 Arc Move", "Center Format Arcs", "Radius Format Arcs".
#[test]
fn arcs_in_three_planes() {
    let program = "F600\nG17 G2 X10 I5 J0\nG3 X0 R5\nG18 G2 Z10 X0 K5 I0\nG19 G3 Y0 Z20 J0 K5\nG17 G90.1 G2 X0 Y0 I5 J0\nG91.1 G3 I1 Z30 P2\n";
    assert_snapshot!(moves("linuxcnc", program), @r#"
2 arc X10.0000 Y0.0000 center 5.0000,0.0000 turns -0.5000 F600.0000
3 arc X0.0000 Y0.0000 center 5.0000,0.0000 turns 0.5000 F600.0000
4 arc X0.0000 Z10.0000 center 5.0000,0.0000 turns -0.5000 F600.0000
5 arc Y0.0000 Z20.0000 center 0.0000,15.0000 turns 0.5000 F600.0000
6 arc X0.0000 Y0.0000 center 5.0000,0.0000 turns -1.0000 F600.0000
7 arc X0.0000 Y0.0000 Z30.0000 center 1.0000,0.0000 turns 2.0000 F600.0000
"#);
}

/// LinuxCNC, "G93, G94, G95"; F speaks for the linear axes where any moves, else for
/// the rotary ones ("Feed Rate").
#[test]
fn feeds_of_each_mode() {
    let program = "G1 X10 A90 F100\nA0\nC90 A45\nG93 X20 F2\nG94 X0 F50\nS300 M3\nG95 X10 F0.2\n";
    assert_snapshot!(moves("iso", program), @r#"
1 feed X10.0000 A90.0000 F100.0000
2 feed A0.0000 F100.0000
3 feed A45.0000 C90.0000 F100.0000
4 feed X20.0000 F20.0000
5 feed X0.0000 F50.0000
7 feed X10.0000 F60.0000
"#);
}

/// LinuxCNC, "G20, G21 Units": F stays what it was in millimetres.
#[test]
fn a_unit_change_keeps_the_feed() {
    assert_snapshot!(moves("linuxcnc", "G21 G1 X1 F100\nG20 X1\nX2 F10\nG21 X0 F60\n"), @r#"
1 feed X1.0000 F100.0000
2 feed X25.4000 F100.0000
3 feed X50.8000 F254.0000
4 feed X0.0000 F1524.0000
"#);
    assert_snapshot!(moves("iso", "G20 G1 X1 F10\n"), @r#"
1 feed X25.4000 F254.0000
"#);
    assert_snapshot!(moves("linuxcnc", "G20 G1 X1 F10\n"), @r#"
1 feed X25.4000 F10.0000
"#);
}

/// LinuxCNC "G4 Dwell" (P in seconds), Marlin G4 (P in milliseconds, S in seconds),
/// Fanuc B-63944EN "Dwell (G04)" (X in seconds, P in milliseconds).
#[test]
fn dwells_of_each_dialect() {
    assert_snapshot!(moves("iso", "G4 P1\nG04 F2\nG4 X0.5\nG0 X1\n"), @r#"
1 dwell 1 s
2 dwell 2 s
3 dwell 0.5 s
4 rapid X1.0000
"#);
    assert_snapshot!(moves("linuxcnc", "G4 P1.5\n"), @r#"
1 dwell 1.5 s
"#);
    assert_snapshot!(moves("marlin", "G4 P1500\nG4 S2\nG4 S1 P5\n"), @r#"
1 dwell 1.5 s
2 dwell 2 s
3 dwell 1 s
"#);
}

/// LinuxCNC, "G28, G28.1", "G30, G30.1", "M2, M30".
#[test]
fn reference_points_and_the_end() {
    let program = "%\nO1\nG0 X5 Z5\nG28 G91 Z1\nG90 G30 X6\nM30\nX99\n%\n";
    assert_snapshot!(moves("iso", program), @r#"
3 rapid X5.0000 Z5.0000
4 rapid Z6.0000
4 rapid Z0.0000
5 rapid X6.0000
5 rapid X0.0000
"#);
}

/// B-63944EN, "Optional Block Skip": `/` is `/1`, and each level has its switch.
#[test]
fn block_delete_and_tape_marks() {
    let machine = machine("iso");
    let lines = |block_delete: BlockDelete| {
        let options = Options {
            reading: Reading {
                block_delete,
                ..Reading::default()
            },
            ..Options::default()
        };
        let mut lines = Vec::new();
        let program = b"%\nG0 X1\n/X2\n/2 X3\nX4\n/1 X5\n%\nX6\n";
        pipeline::moves(
            std::io::Cursor::new(program),
            &machine,
            &options,
            &mut |mv, _| {
                lines.push(mv.line);
                Ok(())
            },
        )
        .expect("accepted");
        lines
    };
    assert_eq!(lines(BlockDelete::ALL), [2, 5]);
    assert_eq!(lines(BlockDelete::NONE), [2, 3, 4, 5, 6]);
    assert_eq!(lines(BlockDelete::NONE.with(1)), [2, 4, 5]);
    assert_eq!(lines(BlockDelete::NONE.with(2).with(9)), [2, 3, 5, 6]);
}

/// Marlin, "G0-G1 Linear Move": both at F.
#[test]
fn marlin_moves_g0_at_the_feed() {
    assert_snapshot!(moves("marlin", "G0 X10\nG1 F600 X0\nG0 X10\nM201 X500\nG92 X0\nG0 X1\n"), @r#"
1 feed X10.0000
2 feed X0.0000 F600.0000
3 feed X10.0000 F600.0000
6 feed X11.0000 F600.0000
"#);
}

/// Each profile's plain words against the same block with more in it.
#[test]
fn plain_blocks_mean_what_all_blocks_mean() {
    // G40 sends a block the long way round.
    for blocks in [
        "X1",
        "G0 X1 Y2",
        "G1 X3 F50",
        "G2 X10 I3.5 J0 F70",
        "G3 X0 R5 F10",
        "Y7",
        "G1 A3",
    ] {
        let head = "F100 G40\nG1 X0.5 G40\n";
        let plain = moves("iso", &format!("{head}{blocks}\n"));
        let long = moves("iso", &format!("{head}{blocks} G40\n"));
        assert_eq!(plain, long);
    }
}

#[test]
fn each_refusal_once() {
    for program in [
        "G1 X1",
        "G1 X1 F0",
        "G1 X1 F-5",
        "G93 G1 X1",
        "F1 G95 G1 X1",
        "G1 B5 F1",
        "G0 G1 X1",
        "G0 X1 X2",
        "G34 X1",
        "M98 P1",
        "M123",
        "G123",
        "G1 X1 Q5 F1",
        "G2 X1 F1",
        "F1 G2 X1 I1 J0 R2",
        "F1 G2 X9 I1 J0",
        "F1 G2 X9 R1",
        "F1 G2 R1 X0",
        "F1 G2 X0 I0 J0",
        "F1 G17 G2 X2 I1 J0 K1",
        "F1 G90.1 G2 X2 I1",
        "F1 G2 X2 I1 J0 P0.5",
        "F1 G53 G2 X2 I1",
        "G4",
        "G4 P-1",
        "G0 X1e",
        "G0 X2000000000",
        "G92",
        "o100 sub",
        "G28",
        "@5",
    ] {
        let found = moves("iso", &format!("{program}\n"));
        assert!(
            found
                .lines()
                .any(|line| line.contains(": ") && line.contains(" | ")),
            "{program}: {found}"
        );
    }
    let all: String = [
        "G1 X1",
        "G0 G1 X1",
        "G34",
        "G1 B5 F1",
        "F1 G2 X9 I1 J0",
        "G4",
        "G28",
        "M123",
    ]
    .map(|program| moves("iso", &format!("{program}\n")))
    .into_iter()
    .chain(["X1", "F1 G2"].map(|program| moves("linuxcnc", &format!("{program}\n"))))
    .collect();
    assert_snapshot!(all, @r#"
1 no-feed: a feed move, but no F is in force | write F in this block or before; after G93, G94 or G95 it must be written again
1 modal-group-twice: two G words of one modal group in a block | keep the one that is meant, or write two blocks
1 unsupported-code: G34 is thread cutting or tapping, which gwatt does not support | nothing is estimated for a program with motion that is not understood
1 no-such-axis: the machine has no B axis | choose a machine with it, or describe it in the machine file: [axes.B]
1 arc-radius: the arc's end is not on its circle: radius 1.0000 mm at the start, 8.0000 mm at the end | check the end point and the centre; a G90.1/G91.1 mix-up looks like this: arc_centre under [language] in the machine file says how I, J and K are meant
1 dwell-time: G4 without a time | this controller takes the time from P or X or F
1 reference-axes: a reference point without axes | name the axes, as in G28 G91 Z0
1 unsupported-code: M123 is a user-defined word, which gwatt does not support | if it moves no axis, say so in the machine file: ignored = ["M123"] under [language]; what it switches on is a [[load]]
1 no-motion-word: axis words without a motion word in force | write G0, G1, G2 or G3 in this block or before
1 arc-center: G2 without an end or a centre | write it in the block that moves; the control refuses it alone
"#);
}

/// What plainly is another kind of file is called by its name, and nothing else
/// is said of it.
#[test]
fn other_kinds_of_files_are_named() {
    let found = moves(
        "iso",
        "0 BEGIN PGM PART MM\n1 L X+10 Y+20 R0 FMAX\n2 END PGM PART MM\n",
    );
    assert_eq!(
        found,
        "0 foreign-file: this is a Heidenhain conversational program (Klartext) | \
         only programs of G-code words are read: have it posted as DIN/ISO\n"
    );
    let found = moves("marlin", "GCDE\u{1}\u{0}\u{0}");
    assert!(found.contains("this is binary G-code"), "{found}");
}

/// grbl, `protocol.c` and `serial.c`: a comment ends with its line at the latest, `?` is taken
/// out of it, and `!`, `~` and 0x18 act when they arrive.
#[test]
fn comments_and_real_time_bytes_of_grbl() {
    let twin = moves("grbl", "G0 X10\nG1 X0 F1000\n");
    let found = moves("grbl", "?G0 X10 ( BURN ? (\nG1 X0 F1000 ?\n");
    assert_eq!(found, twin);
    assert_eq!(moves("grbl", "G0 X[1+2] ( a\n"), moves("grbl", "G0 X3\n"));
    for (program, expected) in [
        ("!\n", "`!` is grbl's feed hold"),
        ("G0 X1 ~\n", "`~` is grbl's cycle start"),
        ("G0 X1\x18\n", "the byte 0x18 is grbl's reset"),
    ] {
        let said = moves("grbl", program);
        let expected = format!(
            "1 real-time: {expected}, which acts when it arrives, not where it stands | take it out \
             of the program\n"
        );
        assert_eq!(said, expected);
    }
    // `X1?0` is X10 there.
    assert!(moves("grbl", "G0 X1?0\n").contains("unknown-text"));
    assert!(moves("linuxcnc", "G0 X1 ( a\n").contains("unclosed-comment"));
    assert!(moves("linuxcnc", "?\n").contains("unknown-text"));
}

/// LinuxCNC knows no comment inside another.
#[test]
fn nested_comments_are_refused_as_such() {
    let said = "1 nested-comment: nested comment: the first `)` ends it, and what comes after it is \
                read | take the inner parentheses out, or begin the comment with `;`\n";
    assert_eq!(moves("linuxcnc", "( (text) more.\n"), said);
    assert_eq!(moves("fanuc", "(a) ( (text) more )\n"), said);
    assert!(moves("linuxcnc", "(text) more\n").contains("unknown-text"));
}

/// grbl converts F by the unit of its own block; `LinuxCNC` by the one in force before
/// ("Order of execution").
#[test]
fn a_feed_next_to_a_unit() {
    let speeds = |controller: &str| -> Vec<f64> {
        let machine = crate::listing::machine(controller);
        let mut found = Vec::new();
        let program = "G21 G94\nG20 G1 X1 F200\nG21 G1 X0 F500\nM2\n";
        let options = gwatt::pipeline::Options::default();
        let input = std::io::Cursor::new(program);
        gwatt::pipeline::moves(input, &machine, &options, &mut |mv, _| {
            found.push((mv.feed_mm_s * 60.0).round());
            Ok(())
        })
        .expect("a program");
        found
    };
    assert_eq!(speeds("grbl"), [5080.0, 500.0]);
    assert_eq!(speeds("linuxcnc"), [200.0, 12700.0]);
}
