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

/// "Speed limitation with constant cutting rate (LIMS)": also in a line of its own and in one that
/// moves; of the master spindle where no number says of which.
#[test]
fn limits_of_the_cutting_rate_act_at_once() {
    let program = "\
G18
LIMS=500
G96 S200 M3
G1 Z-10 F0.3
LIMS=3000
G1 Z-20
LIMS=1000 G1 Z-30
LIMS=2000 LIMS[2]=400
G1 Z-40
SETMS(2)
G1 Z-50
LIMS=600
G1 Z-60
SETMS
G1 Z-70
";
    // 0.3 mm at 500, 3000, 1000, 2000, 400, 600 and 2000 turns.
    assert_snapshot!(moves(program), @r"
    4 feed Z-10 F150
    6 feed Z-20 F900
    7 feed Z-30 F300
    9 feed Z-40 F600
    11 feed Z-50 F120
    13 feed Z-60 F180
    15 feed Z-70 F600
    ");
}

/// "Constant grinding wheel peripheral speed (GWPSON, GWPSOF)": S in m/s is no speed of the
/// spindle.
#[test]
fn the_speed_of_a_grinding_wheel() {
    let refused = ["GWPSON\nS30 M3", "GWPSON(1) S1=30", "GWPSON\nG96 S30"].map(refusal);
    assert_snapshot!(refused.join("\n"), @r"
    2 surface-speed: S is the speed of a grinding wheel at its edge here, in m/s (GWPSON)
    1 surface-speed: S is the speed of a grinding wheel at its edge here, in m/s (GWPSON)
    2 surface-speed: S is the speed of a grinding wheel at its edge here, in m/s (GWPSON)
    ");
    // 10 turns at 1000/min; 0.1 mm at 2000/min.
    let program = "S1000 M3\nGWPSON\nG25 S100\nG4 S10\nGWPSOF\nS2000\nG95 F0.1\nG1 X10\n";
    assert_snapshot!(moves(program), @r"
    4 dwell 0.6 s
    8 feed X10 F200
    ");
}
