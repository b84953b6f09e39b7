//! G12 and G13 of a Haas: circular pockets (Haas mill operator's manual, "G12
//! Circular Pocket Milling CW / G13 Circular Pocket Milling CCW").

use insta::assert_snapshot;

use crate::listing::{listing, machine, refusals};

fn moves(program: &str) -> String {
    listing(program, &machine("haas"), None)
}

/// I alone: onto the circle of 5 mm by a half circle, once round, and back.
#[test]
fn one_circle() {
    assert_snapshot!(moves("G0 X10. Y20. Z1.\nG13 D0 I5. Z-2. F300.\n"), @r"
1 rapid X10 Y20 Z1
2 feed Z-2 F300
2 arc X15 Y20 center 12.5,20 turns 0.5 F300
2 arc X15 Y20 center 10,20 turns 1 F300
2 arc X10 Y20 center 12.5,20 turns 0.5 F300
");
}

/// I, K and Q: circles of 2, 4, 6 and 7 mm; by half circles from one to the
/// next, whose radii are the means.
#[test]
fn wider_and_wider_in_two_depths() {
    assert_snapshot!(moves("G0 X0 Y0 Z0\nG91 G12 D0 I2. K7. Q2. Z-1. L2 F300.\nG90 G0 Z5.\n"), @r"
1 rapid
2 feed Z-1 F300
2 arc X2 Y0 center 1,0 turns -0.5 F300
2 arc X2 Y0 center 0,0 turns -1 F300
2 arc X-4 Y0 center -1,0 turns -0.5 F300
2 arc X-4 Y0 center 0,0 turns -1 F300
2 arc X6 Y0 center 1,0 turns -0.5 F300
2 arc X6 Y0 center 0,0 turns -1 F300
2 arc X-7 Y0 center -0.5,0 turns -0.5 F300
2 arc X-7 Y0 center 0,0 turns -1 F300
2 arc X0 Y0 center -3.5,0 turns -0.5 F300
2 feed Z-2 F300
2 arc X2 Y0 center 1,0 turns -0.5 F300
2 arc X2 Y0 center 0,0 turns -1 F300
2 arc X-4 Y0 center -1,0 turns -0.5 F300
2 arc X-4 Y0 center 0,0 turns -1 F300
2 arc X6 Y0 center 1,0 turns -0.5 F300
2 arc X6 Y0 center 0,0 turns -1 F300
2 arc X-7 Y0 center -0.5,0 turns -0.5 F300
2 arc X-7 Y0 center 0,0 turns -1 F300
2 arc X0 Y0 center -3.5,0 turns -0.5 F300
3 rapid Z5
");
}

#[test]
fn what_is_refused() {
    let cases = [
        "G13 I5. Z-2. F300.",
        "G13 D0 Z-2. F300.",
        "G13 D1 I5. Z-2. F300.",
        "G13 D0 I5. K9. Z-2. F300.",
        "G13 D0 I5. K4. Q1. Z-2. F300.",
        "G13 D0 I0 Z-2. F300.",
        "G13 D0 I5. Z-2. L2 F300.",
        "G91 G13 D0 I5. Z-2. L1.5 F300.",
        "G18 G13 D0 I5. Z-2. F300.",
        "G13 D0 I5. Z-2.",
        "G13 D0 I1. K90000. Q1. Z-2. F300.",
        "G68 X0 Y0 R10.\nG13 D0 I5. Z-2. F300.",
        "G93 G13 D0 I5. Z-2. F3.",
    ];
    let refused = |line: &str| refusals(&format!("G0 X0 Y0 Z0\n{line}\n"), &machine("haas"));
    let found: Vec<String> = cases.into_iter().map(refused).collect();
    assert_snapshot!(found.join("\n"), @r"
2 pocket: G12 and G13: without D, the number of the tool's radius; D0 for none
2 pocket: G12 and G13: without I, the radius of the first circle
2 pocket: G12 and G13: the tool's radius is not known: give --tool-table, or D0
2 pocket: G12 and G13: K, not below I, and Q above 0 go together
2 pocket: G12 and G13: K, not below I, and Q above 0 go together
2 pocket: G12 and G13: the first circle is not wider than the tool
2 pocket: G12 and G13: L goes with G91, where Z is a step
2 pocket: G12 and G13: L is no count
2 pocket: G12 and G13: it needs G17
2 no-feed: a feed move, but no F is in force
2 pocket: G12 and G13: more than 10000 circles
3 pocket: G12 and G13: in machine, turned or polar coordinates
2 pocket: G12 and G13: under G93
");
}
