//! Turning cycles, each by a case worked by hand. Positions are those of the
//! slides: X is half of what the program says.
//!
//! Sources: Fanuc B-63604EN and B-64304EN-1, "Canned Cycle", "Multiple
//! Repetitive Cycle", "Canned Cycle for Drilling"; Haas lathe operator's manual.

use insta::assert_snapshot;

use crate::fanuc::{moves, notes};

/// B-63604EN, "Absolute and Incremental Programming", "Diameter and Radius
/// Programming": U, V, W and H.
#[test]
fn words_of_system_a_are_incremental_and_x_is_a_diameter() {
    // W and H go with U; G98 is a feed per minute, G99 one per revolution.
    assert_snapshot!(moves("fanuc-lathe", "G97 S1000 M3\nG0 X40. Z5.\nU-4. W-10.\nG1 U2. H90. F0.1\nG98 G1 Z0 F120.\nG28 U0 W0\n"), @r"
2 rapid X20.0000 Z5.0000
3 rapid X18.0000 Z-5.0000
4 feed X19.0000 C90.0000 F100.0000
5 feed Z0.0000 F120.0000
6 rapid
6 rapid X0.0000
");
}

/// B-64604EN-1, "Chamfering and Corner R": the words of corners have no comma, and the next move
/// says to which side they are.
#[test]
fn corners_of_a_lathe_need_no_comma() {
    let turned = |z: &str, x: &str| {
        let program = format!("G97 S1000 M3\nG0 X40. Z5.\nG1 Z-20. {z} F0.1\nX60. {x}\nZ-40.\n");
        moves("fanuc-lathe", &program)
    };
    let commas = turned(",R3.", ",C2.");
    assert_ne!(commas, turned("", ""));
    assert_eq!(turned("R3.", "K2."), commas);
    assert_eq!(turned("R-3.", "K-2."), commas);
    assert_eq!(turned("I3.", "R2."), turned(",C3.", ",R2."));
}

/// B-63604EN, "Workpiece Coordinate System (G50, G92)".
#[test]
fn coordinates_are_preset_and_shifted() {
    // G50 calls the place X50. Z100.; U and W change that by so much.
    assert_snapshot!(moves("fanuc-lathe", "G50 X50. Z100. S2000\nG0 X48. Z100.\nG50 U10. W-5.\nG0 X58. Z95.\nX60.\n"), @r"
2 rapid X-1.0000
4 rapid
5 rapid X0.0000
");
}

/// B-63604EN, "Constant Surface Speed Control (G96, G97)": G50 S.
#[test]
fn the_clamp_of_the_spindle_holds() {
    // At a radius of 10 mm 100 m/min are 1592 1/min; G50 permits 600.
    let program = "G0 X100. Z1.\nG50 X100. Z1. S600\nG96 S100 M3\nG1 X20. F0.2\nG97 S100\nG10 P1 X0.1 Z0\nG1 X10.\n";
    assert_snapshot!(moves("fanuc-lathe", program), @r"
1 rapid X50.0000 Z1.0000
4 feed X10.0000 F120.0000
7 feed X5.0000 F20.0000
");
}

/// B-63604EN, "Canned Cycle (G90, G92, G94)".
#[test]
fn single_cycles() {
    let program = "G97 S600 M3\nG0 X60. Z2.\nG90 X50. Z-30. F0.2\nU-18. R-2.\nG94 X20. Z-1.\nZ-2. R-1.\nG92 X58. Z-20. F1.5\nG0 X80.\n";
    let expected = "\
2 rapid X30.0000 Z2.0000
3 rapid X25.0000
3 feed Z-30.0000 F120.0000
3 feed X30.0000 F120.0000
3 rapid Z2.0000
4 rapid X19.0000
4 feed X21.0000 Z-30.0000 F120.0000
4 feed X30.0000 F120.0000
4 rapid Z2.0000
5 rapid Z-1.0000
5 feed X10.0000 F120.0000
5 feed Z2.0000 F120.0000
5 rapid X30.0000
6 rapid Z-3.0000
6 feed X10.0000 Z-2.0000 F120.0000
6 feed Z2.0000 F120.0000
6 rapid X30.0000
7 rapid X29.0000
7 thread Z-20.0000 F900.0000
7 rapid X30.0000
7 rapid Z2.0000
8 rapid X40.0000
";
    assert_eq!(moves("fanuc-lathe", program), expected);
    // System B has other numbers for them, and G91 for incremental words.
    let program = program
        .replace("G90", "G77")
        .replace("G94", "G79")
        .replace("G92", "G78")
        .replace("U-18.", "G91 X-18. G90 Z-30.");
    let in_b = moves(
        "fanuc-lathe-b",
        &program.replace("G91 X-18. G90 Z-30.", "X42."),
    );
    assert_eq!(in_b, expected);
}

/// B-63604EN, "Thread Cutting (G32)".
#[test]
fn a_thread_follows_the_spindle() {
    // Along the longer axis one lead a turn: 600/min · 2 mm; √2 of it at 45°.
    assert_snapshot!(moves("fanuc-lathe", "G97 S600 M3\nG0 X20. Z5.\nG32 Z-20. F2.\nU20. W-10.\n"), @r"
2 rapid X10.0000 Z5.0000
3 thread Z-20.0000 F1200.0000
4 thread X20.0000 Z-30.0000 F1697.0563
");
}

/// Finishing, and stock removal about the same contour: 0.5 mm in X and Z are
/// left, passes are 4 mm deep, and each ends at the contour.
#[test]
fn stock_removal_along_z() {
    let program = "G97 S500 M3\nG0 X60. Z2.\nG71 U4. R1.\nG71 P10 Q20 U1. W0.5 F0.3\nN10 G0 X30.\nG1 Z-10. F0.1\nG2 X40. Z-15. R5.\nG1 Z-20.\nN20 X60. Z-30.\nG70 P10 Q20\nG0 X100. Z50.\n";
    // The third pass meets the arc about X20.5 Z-9.5 of 5 mm at X18.5:
    // Z = -9.5 - √(25 - 4) = -14.0826.
    assert_snapshot!(moves("fanuc-lathe", program), @r"
2 rapid X30.0000 Z2.0000
4 rapid X30.5000 Z2.5000
4 rapid X26.5000
4 feed Z-25.5000 F150.0000
4 rapid X27.5000 Z-24.5000
4 rapid Z2.5000
4 rapid X22.5000
4 feed Z-21.5000 F150.0000
4 rapid X23.5000 Z-20.5000
4 rapid Z2.5000
4 rapid X18.5000
4 feed Z-14.0826 F150.0000
4 rapid X19.5000 Z-13.0826
4 rapid Z2.5000
4 rapid X15.5000
4 feed Z-9.5000 F150.0000
4 arc X20.5000 Z-14.5000 center -9.5000,20.5000 turns -0.2500 F150.0000
4 feed Z-19.5000 F150.0000
4 feed X30.5000 Z-29.5000 F150.0000
4 rapid X30.0000 Z2.0000
10 rapid X15.0000
10 feed Z-10.0000 F50.0000
10 arc X20.0000 Z-15.0000 center -10.0000,20.0000 turns -0.2500 F50.0000
10 feed Z-20.0000 F50.0000
10 feed X30.0000 Z-30.0000 F50.0000
10 rapid Z2.0000
11 rapid X50.0000 Z50.0000
");
    // One block, as Series 10/11 and Haas have it: D without a point in µm.
    let one = program
        .replace("G71 U4. R1.\n", "")
        .replace("G71 P10", "G71 D4000 R1. P10");
    let [two, one] = [program, &one].map(|program| moves("fanuc-lathe", program));
    let after = |text: &str| {
        text.lines()
            .map(|line| line.split_once(' ').unwrap_or_default().1.to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(after(&two), after(&one));
}

/// Haas' lathe operator's manual, "G71 Type II Details". Passes of 4 mm from X60: at X52 to the
/// wall of 45°, which is there at Z-17, and along it to X60, Z-21; at X44 to the arc, which is
/// there at Z-14 + √(4² - 2²), and along the contour to X52; at last along all of it.
#[test]
fn passes_of_type_two_go_along_the_contour() {
    let program = "G97 S500 M3\nG0 X60. Z2.\nG71 P10 Q20 U0 W0 D4. R0.5 F0.3\nN10 G0 X40. Z2.\nG1 Z-10. F0.1\nG3 X48. Z-14. R4.\nG1 X50. Z-16.\nN20 X60. Z-21.\n";
    assert_snapshot!(moves("haas-lathe", program), @r"
2 rapid X30.0000 Z2.0000
3 rapid
3 rapid X26.0000
3 feed Z-17.0000 F150.0000
3 feed X30.0000 Z-21.0000 F150.0000
3 rapid X30.5000
3 rapid Z2.0000
3 rapid X22.0000
3 feed Z-10.5359 F150.0000
3 arc X24.0000 Z-14.0000 center -14.0000,20.0000 turns 0.1667 F150.0000
3 feed X25.0000 Z-16.0000 F150.0000
3 feed X26.0000 Z-17.0000 F150.0000
3 rapid X26.5000
3 rapid Z2.0000
3 rapid X20.0000
3 feed Z-10.0000 F150.0000
3 arc X24.0000 Z-14.0000 center -14.0000,20.0000 turns 0.2500 F150.0000
3 feed X25.0000 Z-16.0000 F150.0000
3 feed X30.0000 Z-21.0000 F150.0000
3 rapid Z2.0000
");
    // Nothing of this is a parameter that is not known.
    assert!(
        notes("haas-lathe", program)
            .iter()
            .all(|note| *note != "cycle-parameter")
    );
}

/// Type II: under the level X52 two valleys. The first, with walls of 45°, is 3 mm
/// deep and takes a second cut at X48, 2 mm further in; the second, an arc of 5 mm
/// about X58, is 2 mm deep.
#[test]
fn stock_removal_with_pockets() {
    let program = "G97 S500 M3\nG0 X60. Z2.\nG71 U2. R0.5\nG71 P10 Q20 U0 W0 F0.3\nN10 G0 X52. Z0\nG1 Z-5. F0.1\nX46. Z-8.\nZ-12.\nX52. Z-15.\nG2 X52. Z-23. R5.\nN20 G1 X60. Z-27.\n";
    assert_snapshot!(moves("fanuc-lathe", program), @r"
2 rapid X30.0000 Z2.0000
4 rapid
4 rapid
4 rapid
4 rapid X28.0000
4 feed Z-25.0000 F150.0000
4 rapid X28.5000 Z-24.5000
4 rapid
4 rapid Z-5.0000
4 feed X26.0000 F150.0000
4 feed Z-15.0000 F150.0000
4 rapid X26.5000 Z-14.5000
4 rapid
4 rapid Z-7.0000
4 feed X24.0000 F150.0000
4 feed Z-13.0000 F150.0000
4 rapid X24.5000 Z-12.5000
4 rapid X28.5000
4 rapid Z-15.0000
4 feed X26.0000 F150.0000
4 feed Z-23.0000 F150.0000
4 rapid X26.5000 Z-22.5000
4 rapid X30.0000
4 rapid Z2.0000
4 rapid X26.0000 Z0.0000
4 feed Z-5.0000 F150.0000
4 feed X23.0000 Z-8.0000 F150.0000
4 feed Z-12.0000 F150.0000
4 feed X26.0000 Z-15.0000 F150.0000
4 arc X26.0000 Z-23.0000 center -19.0000,29.0000 turns -0.2952 F150.0000
4 feed X30.0000 Z-27.0000 F150.0000
4 rapid Z2.0000
");
}

/// B-63604EN, "Stock Removal in Facing (G72)".
#[test]
fn stock_removal_along_x() {
    let program = "G97 S500 M3\nG0 X44. Z2.\nG72 W2. R0.5\nG72 P10 Q20 U0.4 W0.2 F0.3\nN10 G0 Z-6.\nG1 X40. F0.1\nX20. Z-2.\nN20 X10. Z0\n";
    assert_snapshot!(moves("fanuc-lathe", program), @r"
2 rapid X22.0000 Z2.0000
4 rapid X22.2000 Z2.2000
4 rapid Z0.2000
4 feed X5.2000 F150.0000
4 rapid X5.7000 Z0.7000
4 rapid X22.2000
4 rapid Z-1.8000
4 feed X10.2000 F150.0000
4 rapid X10.7000 Z-1.3000
4 rapid X22.2000
4 rapid Z-3.8000
4 feed X15.2000 F150.0000
4 rapid X15.7000 Z-3.3000
4 rapid X22.2000
4 rapid Z-5.8000
4 feed X20.2000 F150.0000
4 feed X10.2000 Z-1.8000 F150.0000
4 feed X5.2000 Z0.2000 F150.0000
4 rapid X22.0000 Z2.0000
");
}

/// B-63604EN, "Pattern Repeating (G73)".
#[test]
fn a_pattern_comes_nearer_in_equal_steps() {
    // 6 mm of the radius and 2 mm in Z in three divisions: 6, 3, 0 and 2, 1, 0.
    let program = "G97 S500 M3\nG0 X60. Z5.\nG73 U6. W2. R3\nG73 P10 Q20 U1. W0.2 F0.3\nN10 G0 X20. Z2.\nG1 Z-10. F0.1\nN20 X40. Z-20.\n";
    assert_snapshot!(moves("fanuc-lathe", program), @r"
2 rapid X30.0000 Z5.0000
4 rapid X36.5000 Z7.2000
4 rapid X16.5000 Z4.2000
4 feed Z-7.8000 F150.0000
4 feed X26.5000 Z-17.8000 F150.0000
4 rapid X33.5000 Z6.2000
4 rapid X13.5000 Z3.2000
4 feed Z-8.8000 F150.0000
4 feed X23.5000 Z-18.8000 F150.0000
4 rapid X30.5000 Z5.2000
4 rapid X10.5000 Z2.2000
4 feed Z-9.8000 F150.0000
4 feed X20.5000 Z-19.8000 F150.0000
4 rapid X30.0000 Z5.0000
");
}

/// B-63604EN, "End Face Peck Drilling Cycle (G74)", "Outer Diameter/Internal Diameter
/// Drilling Cycle (G75)".
#[test]
fn pecks_and_grooves() {
    let program = "G97 S500 M3\nG0 X0 Z2.\nG74 R1.\nG74 Z-10. Q5000 F0.1\nG0 X50. Z-5.\nG75 R0.5\nG75 X40. Z-9. P3000 Q2500 F0.1\n";
    assert_snapshot!(moves("fanuc-lathe", program), @r"
2 rapid Z2.0000
4 feed Z-3.0000 F50.0000
4 rapid Z-2.0000
4 feed Z-8.0000 F50.0000
4 rapid Z-7.0000
4 feed Z-10.0000 F50.0000
4 rapid Z2.0000
4 rapid
5 rapid X25.0000 Z-5.0000
7 feed X22.0000 F50.0000
7 rapid X22.5000
7 feed X20.0000 F50.0000
7 rapid X25.0000
7 rapid Z-7.5000
7 feed X22.0000 F50.0000
7 rapid X22.5000
7 feed X20.0000 F50.0000
7 rapid X25.0000
7 rapid Z-9.0000
7 feed X22.0000 F50.0000
7 rapid X22.5000
7 feed X20.0000 F50.0000
7 rapid X25.0000
7 rapid Z-5.0000
");
}

/// B-63604EN, "Multiple Thread Cutting Cycle (G76)".
#[test]
fn a_thread_in_many_passes() {
    // 1 mm high: 0.5·√n deep, at least 0.1 more each time, 0.1 left for the two
    // last passes. The start moves by depth·tan 30°; the chamfer is one lead.
    let program =
        "G97 S600 M3\nG0 X30. Z5.\nG76 P021060 Q100 R0.1\nG76 X20. Z-20. P1000 Q500 F2.\n";
    let passes = moves("fanuc-lathe", program);
    let starts: Vec<&str> = passes
        .lines()
        .filter(|line| line.starts_with("4 rapid") && line.contains("X1") && line.contains('Z'))
        .collect();
    assert_eq!(
        starts,
        [
            "4 rapid X10.5000 Z4.7113",
            "4 rapid X10.2929 Z4.5918",
            "4 rapid X10.1340 Z4.5000",
            "4 rapid X10.1000 Z4.4804",
            "4 rapid X10.0000 Z4.4226",
            "4 rapid X10.0000 Z4.4226",
        ]
    );
    assert_snapshot!(passes.lines().skip(1).take(5).collect::<Vec<_>>().join("\n"), @r"
4 rapid X10.5000 Z4.7113
4 thread Z-18.0000 F1200.0000
4 thread X12.5000 Z-20.0000 F1697.0563
4 rapid X15.0000
4 rapid Z5.0000
");
    // One block: height K, first depth D, angle A; no passes at the end.
    let one = moves(
        "fanuc-lathe",
        "G97 S600 M3\nG0 X30. Z5.\nG76 X20. Z-20. K1. D500 A60. F2.\n",
    );
    assert_eq!(
        one.lines().filter(|line| line.contains("thread")).count(),
        4
    );
    assert!(one.contains("3 thread Z-20.0000 F1200.0000\n3 rapid X15.0000\n3 rapid Z5.0000\n"));
}

#[test]
fn what_turning_cycles_refuse() {
    let cases = [
        ("G90 X20. F0.1", "cycle-word: G90 without X and Z"),
        ("G92 X20. Z0", "thread-pitch: a thread without its lead F"),
        (
            "M5 S0\nG92 X20. Z0 F1.",
            "no-spindle-speed: a thread, but no spindle speed is in force",
        ),
        ("G75 X20. Z-9.", "cycle-word: G75 without Q"),
        ("G74 X20.", "cycle-word: G74 without Z"),
        ("G76 X20. Z0 F1.", "cycle-word: G76 without Z, P and Q"),
        ("G71 P10 Q20", "cycle-word: G71 without a depth of cut"),
        (
            "G71 P10 D1000",
            "cycle-word: G71 without the block numbers P and Q",
        ),
        (
            "G73 P10 Q20",
            "cycle-word: G73 without its first block U W R",
        ),
        (
            "G73 U1. W1. R0",
            "cycle-word: G73 without its number of divisions, from 1",
        ),
        (
            "G71 P10 Q20 D1. I1.",
            "contour: I and K of a roughing cycle (a pass before the last) are not supported",
        ),
        (
            "G70 P10 Q20",
            "no-such-block: there is no block N10 in this program",
        ),
        (
            "G70 P10 Q20\nN10 G0 X5.",
            "contour: there is no block N20 after N10 to end the contour",
        ),
        (
            "G70 P10 Q20\nN10 M98 P1\nN20 X5.",
            "contour: line 3 leaves the contour of a turning cycle",
        ),
        (
            "G70 P10 Q20\nN10 G0 C5.\nN20 X5.",
            "contour: the contour of a turning cycle holds more than straight moves and arcs in X and Z",
        ),
        (
            "G71 P10 Q20 D1. F1.\nN10 G0 X5.\nN20 X5.",
            "contour: the contour of a turning cycle needs two moves at least",
        ),
        (
            "G71 P10 Q20 D1. F1.\nN10 G0 Z-5.\nN20 X5.",
            "contour: the contour begins at the depth where the cycle stands",
        ),
        (
            "G71 P10 Q30 D1. F1.\nN10 G0 X5.\nN20 G1 Z-5.\nX4. Z-6.\nN30 X9.",
            "contour: the contour rises and falls; pockets (type II) need X and Z in its first block",
        ),
        (
            "G71 P10 Q30 D1. F1.\nN10 G0 X5. Z0\nN20 G1 Z-5.\nX7. Z-4.\nN30 X9. Z-9.",
            "contour: the contour goes back on itself along the cut",
        ),
        (
            "G95",
            "unsupported-code: G95 is a feed mode that G-code system A does not have (G98, G99), which gwatt does not support",
        ),
        (
            "G53 G0 U2.",
            "incremental-in-g53: U is incremental, and G53 takes places",
        ),
        (
            "G0 X5. U2.",
            "word-twice: X and U in one block are words of the same axis",
        ),
        ("G85 R-1. F1.", "cycle-word: G85 without Z"),
        (
            "G83 Z-5. R-1. K3 F1.",
            "cycle-repeats: repeats of a drilling cycle of a lathe are not supported",
        ),
        (
            "G53 G90 X1. Z1. F1.",
            "special-in-g53: G53 goes with G0 and G1 only",
        ),
    ];
    for (block, expected) in cases {
        let program = format!("G97 S500 M3 (begin)\n{block}\n");
        let found = moves("fanuc-lathe", &program);
        assert!(found.contains(expected), "{block}: {found}");
        assert_eq!(
            found.matches(": ").count(),
            found.lines().count(),
            "{block}: {found}"
        );
    }
}
