//! Several spindles ("Spindle speed (S), spindle direction of rotation (M3, M4, M5)").

use insta::assert_snapshot;

use super::{moves, refusal};

/// "SETMS": feeds per revolution and threads follow the master spindle; without a number that of
/// power-on again. S in a block of G4 is no speed.
#[test]
fn feeds_follow_the_master_spindle() {
    let program = "\
S500 M3
S2=3000 M2=3
G95 F0.2
G1 X10
SETMS(2)
X20
G4 S5
S1000
X30
S1=400
X40
G33 Z10 K1
SETMS
G1 X50
";
    // 0.2 mm at 500, 3000, 1000 and 400 turns, a lead of 1 mm at 1000.
    assert_snapshot!(moves(program), @r"
    4 feed X10 F100
    6 feed X20 F600
    7 dwell 0.1 s
    9 feed X30 F200
    11 feed X40 F200
    12 thread Z10 F1000
    14 feed X50 F80
    ");
}

/// "Programmable spindle speed limitation (G25, G26)": S is a limit, which raises a speed below
/// that of G25.
#[test]
fn limits_of_the_speed_are_no_speeds() {
    let program =
        "S1000 M3\nG95 F0.1\nG25 S10\nG1 X10\nG26 S5000\nX20\nG25 S1200\nX30\nS1500\nX40\n";
    // 0.1 mm at 1000, 1000, 1200 and 1500 turns.
    assert_snapshot!(moves(program), @r"
    4 feed X10 F100
    6 feed X20 F100
    8 feed X30 F120
    10 feed X40 F150
    ");
}

#[test]
fn a_master_spindle_without_a_speed() {
    let all = ["S500 M3 G95 F0.2\nSETMS(3)\nG1 X10", "SETMS(0)"].map(refusal);
    assert_snapshot!(all.join("\n"), @r"
    3 no-spindle-speed: a feed per revolution, but no spindle speed is in force
    1 syntax: SETMS(0) names no spindle
    ");
}
