//! Coordinate systems, tools, turned and polar coordinates, spindle speed by
//! surface, saved state: by hand-worked programs.
//!
//! The figures for LinuxCNC were also compared with its own interpreter.

use std::sync::Arc;

use gwatt::interpret::{ParameterFile, ToolTable};
use gwatt::pipeline::{Options, Reading, Start};
use insta::assert_snapshot;

use crate::interpret::moves_with;

const TOOLS: &str = "T1 P1 Z10 D3 ;mill\nT2 P5 X1 Z20 D8 Q2\n";

fn options(tools: Option<&str>, parameters: Option<&str>) -> Options {
    let tools = tools.map(|text| Arc::new(ToolTable::parse(text.as_bytes()).expect("tools")));
    let parameters =
        parameters.map(|text| Arc::new(ParameterFile::parse(text.as_bytes()).expect("parameters")));
    Options {
        reading: Reading {
            tools,
            parameters,
            ..Reading::default()
        },
        ..Options::default()
    }
}

fn linuxcnc(program: &str) -> String {
    moves_with("linuxcnc", program, &options(Some(TOOLS), None))
}

fn iso(program: &str) -> String {
    moves_with("iso", program, &options(None, None))
}

/// Rule names of a refusal, with their lines.
fn rules(controller: &str, program: &str) -> Vec<String> {
    let shown = moves_with(controller, program, &options(Some(TOOLS), None));
    // Notes have nothing to help with.
    let lines = shown.lines().filter(|line| {
        line.split_once(" | ")
            .is_some_and(|(_, help)| !help.is_empty())
    });
    lines
        .map(|line| line.split(':').next().unwrap_or_default().to_owned())
        .collect()
}

/// "G10 L2", "G92", "G53": the origin lies outside of the turn, G92 within.
#[test]
fn a_turned_system_with_g92() {
    let program = "G10 L2 P1 X10 Y20 R90\nG0 X1 Y2\nG91 X1\nG90 G92 X0 Y0\nG0 X1\nG92.2\nG0 Y0\nG92.3\nG0 X0 Y0\nG53 G0 X0\nG92.1\nX0 Y0\n";
    assert_snapshot!(linuxcnc(program), @r"
2 rapid X8.0000 Y21.0000
3 rapid Y22.0000
5 rapid Y23.0000
7 rapid X10.0000
9 rapid X8.0000 Y22.0000
10 rapid X0.0000
12 rapid X10.0000 Y20.0000
");
}

#[test]
fn arcs_in_a_turned_system() {
    let program = "G10 L2 P1 R90\nG2 X10 Y0 I5 F600\nG3 X0 Y0 R5\nG90.1 G3 X0 Y0 I5 J0\n";
    assert_snapshot!(linuxcnc(program), @r"
2 arc X0.0000 Y10.0000 center 0.0000,5.0000 turns -0.5000 F600.0000
3 arc X0.0000 Y0.0000 center 0.0000,5.0000 turns 0.5000 F600.0000
4 arc X0.0000 Y0.0000 center 0.0000,5.0000 turns 1.0000 F600.0000
");
}

/// How fast a spiral climbs is not followed.
#[test]
fn a_helix_that_only_linuxcnc_bears_is_refused() {
    let helix = "G0 X20\nG2 X-20.028 Y0 Z1 I-20 F100\n";
    assert_eq!(rules("linuxcnc", helix), ["2 arc-radius"]);
    let close = "G0 X20\nG2 X-20.004 Y0 Z1 I-20 F100\n";
    assert_eq!(rules("linuxcnc", close), [""; 0]);
}

/// In G18 the plane turns along with X: a circle as chords, which ends where rs274 has it.
/// A helix there is refused: the planner handles each axis of a circle only.
#[test]
fn arcs_in_another_plane_of_a_turned_system() {
    let other_plane = "G10 L2 P1 R90\nG18 G2 X10 Z0 I5 F600\n";
    let shown = linuxcnc(other_plane);
    assert_eq!(shown.lines().count(), 24, "{shown}");
    assert_eq!(
        shown.lines().nth(11),
        Some("2 feed Y5.0000 Z-5.0000 F600.0000")
    );
    assert_eq!(
        shown.lines().last(),
        Some("2 feed Y10.0000 Z0.0000 F600.0000")
    );
    for refused in [
        "G18 G2 X10 Y1 Z0 I5 F600",
        "G18 G93 G2 X10 Z0 I5 F60",
        "G19 G41.1 D1\nG2 Y10 Z0 J5 F600",
    ] {
        let program = format!("G10 L2 P1 R30\n{refused}\n");
        let found = rules("linuxcnc", &program);
        assert!(
            found
                .iter()
                .any(|rule| rule.ends_with("arc-turned") || rule.ends_with("compensation")),
            "{refused}: {found:?}"
        );
    }
}

/// "G10 L20": the place gets these coordinates, along the turned axes.
#[test]
fn systems_set_from_the_place() {
    // At (10, 0), turned by 90: X 5 there puts the origin 5 below.
    let program = "G0 X10 Y0\nG10 L2 P2 R90\nG10 L20 P2 X5\nG55 G0 X0\nG10 L20 P0 Y-3\nG0 Y0\nG59.3 G0 X1\nG54 X1\n";
    assert_snapshot!(linuxcnc(program), @r"
1 rapid X10.0000
4 rapid Y-5.0000
6 rapid X7.0000
7 rapid X1.0000
8 rapid
");
    let refused = "G10 L2 P10 X1\nG10 L20 P1 R5\nG10 L3 P1 X1\nG10 L1 P1\nG10 L1 P1 Q10\n";
    let each: Vec<_> = (1..=5).map(|line| format!("{line} data-setting")).collect();
    assert_eq!(rules("linuxcnc", refused), each);
}

/// "G43", "G43.1", "G43.2", "G49", "M61".
#[test]
fn tool_lengths() {
    let program = "T1 M6\nG43 G0 Z0\nG43 H2 X0 Z0\nG43.2 H1\nG0 Z0\nG43.1 Z5\nG0 Z0\nG49 G0 X0 Z0\nM61 Q2\nG43\nG0 Z1\nG43 H0 Z2\n";
    assert_snapshot!(linuxcnc(program), @r"
2 rapid Z10.0000
3 rapid X1.0000 Z20.0000
5 rapid Z30.0000
7 rapid Z5.0000
8 rapid X0.0000 Z0.0000
11 rapid Z21.0000
12 rapid Z22.0000
");
    let refused = "T3\nG43 H4\nG43.2\nG0 G43.1 Z1\nM61\nM61 Q9\nG43 H1.5\n";
    assert_eq!(
        rules("linuxcnc", refused),
        [
            "1 unknown-tool",
            "2 unknown-tool",
            "3 tool-number",
            "4 tool-length",
            "5 tool-number",
            "6 unknown-tool",
            "7 tool-number"
        ]
    );
}

/// "G10 L1", "G10 L10", "G10 L11": what the program sets of a tool counts.
#[test]
fn tools_that_the_program_sets() {
    let program = "G10 L1 P1 Z-1\nG43 H1 G0 Z0\nG49 Z50\nG10 L2 P1 Z10\nG10 L10 P1 Z3\nG43 H1\nG0 Z0\nG10 L2 P9 Z40\nG49\nG0 Z20\nG10 L11 P2 Z0 X2\nG43 H2\nG0 Z0\n";
    // L10 at Z50: 50 - 10 - 3 = 37, so Z0 is 47. L11 at Z30 in G59.3: -10.
    assert_snapshot!(linuxcnc(program), @r"
2 rapid Z-1.0000
3 rapid Z50.0000
7 rapid Z47.0000
10 rapid Z30.0000
13 rapid Z0.0000
");
    // Without a table the lengths that the program sets are all there is.
    let program = "G10 L1 P4 Z7\nG43 H4 G0 Z0\nG43 H5 Z0\n";
    let shown = moves_with("linuxcnc", program, &options(None, None));
    assert_eq!(shown, "2 rapid Z7.0000\n3 rapid Z0.0000\n");
}

/// "Parameters" 5161, 5210, 5220: what the control has kept.
#[test]
fn a_parameter_file() {
    let file = "5161 1\n5163 -2\n5210 1\n5211 3\n5220 2\n5241 10\n5250 0\n100 4\n";
    let program = "G0 X0\nG28 X5\nG28.1\nX#100\nG28\nG54 X#5241\nX#5220\n";
    let shown = moves_with("linuxcnc", program, &options(None, Some(file)));
    assert_snapshot!(shown, @r"
1 rapid X13.0000
2 rapid X18.0000
2 rapid X1.0000
4 rapid X17.0000
5 rapid X1.0000
6 rapid X13.0000
7 rapid X4.0000
");
}

/// "Parameters" 5400 to 5428 and "Predefined Named Parameters": read before
/// anything of their block is executed.
#[test]
fn parameters_show_the_state() {
    let program = "T2 M6\nG0 X[#5400 + #5403 + #5410 + #5413]\nG20 X[#5420 + 1]\nG21 Y[#<_x>] Z[#<_abs_x> * #<_metric>]\nG55 G0 X[#<_coord_system> / 10]\nG52 X5\nG0 X[#5211 + #5420]\n#5221 = 7\nG0 X#5221\nG54 X0\n";
    assert_snapshot!(linuxcnc(program), @r"
2 rapid X32.0000
3 rapid X838.2000
4 rapid Y33.0000
5 rapid X54.0000
7 rapid X59.0000
9 rapid X12.0000
10 rapid
");
    let refused = "#5420 = 1\n#<_x> = 1\nM66 P0 L3 Q1\nG0 X#5399\n";
    assert_eq!(rules("linuxcnc", refused).len(), 3);
}

/// "Polar Coordinates".
#[test]
fn polar_words() {
    let program = "G0 @10 ^90\n^0\n@5\nG91 @5 ^90\n^-90\nG90 G52 X1 Y1\nG0 @2 ^180 Z3\n";
    assert_snapshot!(linuxcnc(program), @r"
1 rapid Y10.0000
2 rapid X10.0000 Y0.0000
3 rapid X5.0000
4 rapid X0.0000 Y10.0000
5 rapid X10.0000 Y0.0000
7 rapid X-1.0000 Y1.0000 Z3.0000
");
    let refused = "G0 @5\nG91 ^5\nG90 @5 ^0 X1\nG53 G0 @5 ^0\n";
    assert_eq!(
        rules("linuxcnc", refused),
        [
            "1 polar-origin",
            "2 polar-origin",
            "3 polar-mixed",
            "4 polar-in-g53"
        ]
    );
    assert!(iso("G0 @5 ^3\n").contains("`@` has no meaning here"));
}

/// "G7 Lathe Diameter Mode": X words, also of G92, incremental and in the
/// block itself; not I.
#[test]
fn diameters() {
    let program = "G7 G0 X10\nG91 X4\nG90 G92 X20\nG0 X0\nG8 X2\nG92.1\nG18 G7 G0 X0 Z0\nG2 X20 Z10 I10 K0 F100\n";
    assert_snapshot!(linuxcnc(program), @r"
1 rapid X5.0000
2 rapid X7.0000
4 rapid X-3.0000
5 rapid X-1.0000
7 rapid X0.0000
8 arc X10.0000 Z10.0000 center 0.0000,10.0000 turns -0.7500 F100.0000
");
}

/// "G96": 100 m/min at 10 mm are 1591.5 1/min, here clamped; at 40 mm 397.9.
/// A feed per revolution counts at the smallest radius of its block.
#[test]
fn surface_speed() {
    let program = "G0 X20\nG96 S100 D1000 M3\nG95 F0.1 G1 X10\nG0 X40\nG1 X50\nX-50\nG97 S300\nX0\nG20\nG96 S100\nG21\nG1 X40 F0.1\nX50\n";
    assert_snapshot!(linuxcnc(program), @r"
1 rapid X20.0000
3 feed X10.0000 F100.0000
4 rapid X40.0000
5 feed X50.0000 F39.7887
6 feed X-50.0000 F100.0000
8 feed X0.0000 F30.0000
12 feed X40.0000
13 feed X50.0000 F12.1276
");
    assert_eq!(rules("linuxcnc", "G96 D100\n"), ["1 surface-speed"]);
    // Fanuc: the clamp by G92 S or G50 S, and G97 that keeps the speed.
    let program =
        "G92 S500\nG0 X40\nG96 S100 M3\nG95 F0.1 G1 X20\nG97\nX10\nG50 S200\nG96 S100\nX5\n";
    assert_snapshot!(iso(program), @r"
2 rapid X40.0000
4 feed X20.0000 F50.0000
6 feed X10.0000 F50.0000
9 feed X5.0000 F20.0000
");
    assert_eq!(rules("iso", "G96 S100 P3\n"), ["1 surface-speed"]);
}

/// "M70 Save Modal State": F comes back with one decimal, motion does not.
#[test]
fn saved_state() {
    let program = "G90 F123.456 S555.7\nM70\nG20 G91 G55 G7 F1\nM72\nG1 X10\no1 sub\nM73\nG91 F50\nG1 X1\no1 endsub\no1 call\nX20\nM71\n";
    assert_snapshot!(linuxcnc(program), @r"
5 feed X10.0000 F123.5000
9 feed X11.0000 F50.0000
12 feed X20.0000 F123.5000
");
    assert_eq!(rules("linuxcnc", "M70\nM71\nM72\n"), ["3 saved-state"]);
    assert_eq!(
        rules("linuxcnc", "G96 S10\nM70\nG97\nM72\n"),
        ["4 saved-state"]
    );
}

/// "M19", "M48" to "M53", "M62" to "M68": no motion, and errors as there.
#[test]
fn words_that_move_nothing() {
    let program = "M19 R45 Q2\nM48\nM49\nM50 P0\nM51 P1\nM52 P0\nM53 P1\nM62 P1\nM63 P1\nM64 P0\nM65 P0\nM66 P0 L3 Q5\nM66 E1 L0\nM67 E0 Q0.5\nM68 E1 Q3\nG0 X1\nM60\n";
    assert_eq!(linuxcnc(program), "16 rapid X1.0000\n");
    let refused = "M52 P1\nM62\nM66 P0 E0\nM67 Q1\nM101\n";
    assert_eq!(
        rules("linuxcnc", refused),
        [
            "1 adaptive-feed",
            "2 input-output",
            "3 input-output",
            "4 input-output",
            "5 unsupported-code"
        ]
    );
}

/// Fanuc "Coordinate System Rotation (G68, G69)".
#[test]
fn rotation() {
    let program = "G68 X10 Y0 R90\nG0 X10 Y10\nG91 X5\nG90 G2 X10 Y0 R10 F100\nG69\nG0 X0 Y0 Z1\nG17 G68 R-90\nX5\n";
    // Turned about (10, 0): (10, 10) is (0, 0), and (15, 10) is (0, 5). The
    // arc's centre is (5.0838, 8.7081) in the program.
    assert_snapshot!(iso(program), @r"
2 rapid
3 rapid Y5.0000
4 arc X10.0000 Y0.0000 center 1.2919,-4.9162 turns -0.1888 F100.0000
6 rapid X0.0000 Z1.0000
8 rapid Y-5.0000
");
    let refused = [
        ("G68 X0 Y0\n", "1 rotation"),
        ("G68 X0 Y0 Z0 R5\n", "1 rotation"),
        ("G68 X0 Y0 I1 R5\n", "1 rotation"),
        ("G91 G68 X0 Y0 R5\n", "1 rotation"),
        ("G68 A0 R5\n", "1 rotation"),
        ("G68 X0 Y0 R5\nG68 X0 Y0 R5\n", "2 rotation"),
        ("G51.1 X1\nG68 X0 Y0 R5\n", "2 rotation"),
        ("G68 X1 Y0 R5\nG0 X1\n", "2 turned-axes"),
        ("G68 X0 Y0 R5\nG53 G0 X1\n", "2 turned-machine"),
        ("G68 X0 Y0 R5\nG28 X1 Y0\n", "2 turned-machine"),
        ("G68 X0 Y0 R5\nG55\n", "2 turned-system"),
        ("G68 X0 Y0 R5\nG52 X1\n", "2 turned-system"),
        ("G68 X0 Y0 R5\nG92 X1\n", "2 turned-system"),
    ];
    for (program, rule) in refused {
        assert_eq!(rules("iso", program), [rule], "{program}");
    }
}

/// Fanuc "Scaling (G50, G51)" and "Programmable Mirror Image".
#[test]
fn scaling_and_mirroring() {
    let program = "G51 X10 Y0 Z0 P2.0\nG0 X20 Y5\nG2 X20 Y-5 J-5 F100\nG50\nG0 X0 Y0\nG51.1 X5\nG0 X1 Y0\nG2 X3 Y2 R2 F100\nG50.1\nG0 X0 Y0\nG51 X0 Y0 Z0 I2. J-1. K1.\nG0 X5 Y5 Z5\n";
    assert_snapshot!(iso(program), @r"
2 rapid X30.0000 Y10.0000
3 arc X30.0000 Y-10.0000 center 30.0000,0.0000 turns -0.5000 F100.0000
5 rapid X0.0000 Y0.0000
7 rapid X9.0000
8 arc X7.0000 Y2.0000 center 7.0000,0.0000 turns 0.2500 F100.0000
10 rapid X0.0000 Y0.0000
12 rapid X10.0000 Y-5.0000 Z5.0000
");
    let refused = [
        ("G51 X0 Y0 Z0 P2\n", ["1 scaling", "1 scaling"].as_slice()),
        ("G51 X0 Y0 Z0 I2. J2.\n", &["1 scaling"]),
        ("G51 X0 Y0 Z0 P0.0\n", &["1 scaling"]),
        ("G51.1 X1\nG51 X0 Y0 Z0 P2.\n", &["2 scaling"]),
        ("G51.1\n", &["1 mirror"]),
        ("G68 X0 Y0 R5\nG51.1 X1\n", &["2 mirror"]),
        (
            "G51 X0 Y0 Z0 I2. J1. K1.\nG2 X4 Y0 I2 F1\n",
            &["2 arc-turned"],
        ),
    ];
    for (program, expected) in refused {
        assert_eq!(rules("iso", program), expected, "{program}");
    }
}

/// Fanuc "Polar Coordinate Command (G15, G16)", after the manual's example.
#[test]
fn polar_mode() {
    let program =
        "G17 G90 G16\nG0 X100 Y30 Z1\nY150\nG91 Y120\nG90 G15\nG0 X0 Y0\nG16 G91 X10 Y90\nX10\n";
    assert_snapshot!(iso(program), @r"
2 rapid X86.6025 Y50.0000 Z1.0000
3 rapid X-86.6025
4 rapid X0.0000 Y-100.0000
6 rapid Y0.0000
7 rapid Y10.0000
8 rapid Y20.0000
");
    assert_eq!(rules("iso", "G16\nG2 X10 Y0 I5 F1\n"), ["2 polar"]);
}

/// Fanuc: G52, G54.1 P, G10 L2 and L20, G43 and G44 H, G50 of a lathe.
#[test]
fn fanuc_offsets() {
    let program = "G10 L2 P1 X10\nG10 L2 P0 X1\nG52 X100\nG0 X0\nG91 G10 L2 P1 X5\nG90 X0\nG52 X0\nX0\nG10 L20 P7 X50\nG54.1 P7 X0\nG154 P8 X0\nG55 X0\nG10 L10 P3 R12\nG43 H3 Z0\nG44 H3 Z0\nG49 Z0\nG50 X20\nX0\n";
    assert_snapshot!(iso(program), @r"
4 rapid X111.0000
6 rapid X116.0000
8 rapid X16.0000
10 rapid X51.0000
11 rapid X1.0000
12 rapid
14 rapid Z12.0000
15 rapid Z-12.0000
16 rapid Z0.0000
18 rapid X-19.0000
");
    let refused = [
        ("G54.1 X1\n", "1 work-offset"),
        ("G10 L2 P7 X1\n", "1 data-setting"),
        ("G10 L50\n", "1 data-setting"),
        ("G10 L10 P1\n", "1 data-setting"),
        ("G10 L11 P1 R0.5\n", "1 data-setting"),
    ];
    for (program, rule) in refused {
        assert_eq!(rules("iso", program)[..1], [rule], "{program}");
    }
}

/// A position that is not known must not be turned into another axis.
#[test]
fn unknown_positions() {
    let mut options = options(None, None);
    options.reading.start = Start::Unknown;
    let rule = |controller: &str, program: &str| {
        let shown = moves_with(controller, program, &options);
        let refusal = shown.lines().find(|line| {
            line.split_once(" | ")
                .is_some_and(|(_, help)| !help.is_empty())
        });
        refusal.map(|line| line.split(':').next().unwrap_or_default().to_owned())
    };
    let turned = "G10 L2 P1 R30\n";
    let is = |rule: Option<String>, expected: &str| assert_eq!(rule.as_deref(), Some(expected));
    is(
        rule("linuxcnc", &format!("{turned}G0 X1\n")),
        "2 turned-from-unknown",
    );
    assert_eq!(rule("linuxcnc", &format!("{turned}G0 X1 Y1\nX2\n")), None);
    is(rule("linuxcnc", "G10 L20 P1 X1\n"), "1 offset-from-unknown");
    is(rule("linuxcnc", "G28.1\n"), "1 offset-from-unknown");
    is(rule("linuxcnc", "G0 @5\n"), "1 polar-from-unknown");
    assert_eq!(rule("linuxcnc", "G0 @5 ^1\n"), None);
    is(rule("iso", "G68 R5\n"), "1 turned-from-unknown");
    is(rule("iso", "G16\nG91 X5 Y5 G0\n"), "2 polar");
}
