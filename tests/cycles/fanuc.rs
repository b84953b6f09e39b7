//! Canned cycles of Fanuc and Haas mills.

use insta::assert_snapshot;

use super::moves;

/// Fanuc: rapid to the place, to R, the hole, back to the initial level or R;
/// P without a point is in milliseconds; K repeats.
#[test]
fn fanuc_drills() {
    let program = "G90 G21 S500 M3\nG0 Z50\nG98 G81 X10 Y5 Z-5 R2 F100\nG99 X20\nG82 X30 P500\nG80\nX0\nG91 G99 G81 X5 Z-4 R-8 K2\nG90 G80 Z60\n";
    assert_snapshot!(moves("iso", program), @r"
    2 rapid 0 0 50
    3 rapid 10 5 50
    3 rapid 10 5 2
    3 feed 10 5 -5 F100
    3 rapid 10 5 50
    4 rapid 20 5 50
    4 rapid 20 5 2
    4 feed 20 5 -5 F100
    4 rapid 20 5 2
    5 rapid 30 5 2
    5 feed 30 5 -5 F100
    5 dwell 30 5 -5 0.5 s
    5 rapid 30 5 2
    7 rapid 0 5 2
    8 rapid 5 5 2
    8 rapid 5 5 -6
    8 feed 5 5 -10 F100
    8 rapid 5 5 -6
    8 rapid 10 5 -6
    8 feed 10 5 -10 F100
    8 rapid 10 5 -6
    9 rapid 10 5 60
    ");
}

/// Fanuc: pecks stay 1 mm off (a parameter); taps; G85; fine and back boring.
#[test]
fn fanuc_pecks_taps_and_bores() {
    let program = "G90 S500 M3\nG0 Z10\nG99 G83 X1 Z-3 R2 Q3 F100\nG73 X2\nG98 G84 X3 P1.\nG85 X4 L1\nG76 X5 I0.2 J0.1 Q0 P0\nG87 X6 R-4 Z-1 Q0.3 I0.3\nG81 X7 Z-5 K0\n";
    assert_snapshot!(moves("iso", program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 feed 1 0 -1 F100
    3 rapid 1 0 2
    3 rapid 1 0 0
    3 feed 1 0 -3 F100
    3 rapid 1 0 2
    4 rapid 2 0 2
    4 feed 2 0 -1 F100
    4 rapid 2 0 0
    4 feed 2 0 -3 F100
    4 rapid 2 0 2
    5 rapid 3 0 2
    5 tap 3 0 -3 F100
    5 dwell 3 0 -3 1 s
    5 tap 3 0 2 F100
    5 rapid 3 0 10
    6 rapid 4 0 10
    6 rapid 4 0 2
    6 feed 4 0 -3 F100
    6 feed 4 0 2 F100
    6 rapid 4 0 10
    7 rapid 5 0 10
    7 rapid 5 0 2
    7 feed 5 0 -3 F100
    7 dwell 5 0 -3 0 s
    7 rapid 5.2 0.1 -3
    7 rapid 5.2 0.1 10
    7 rapid 5 0 10
    8 rapid 6 0 10
    8 rapid 6.3 0.1 10
    8 rapid 6.3 0.1 -4
    8 rapid 6 0 -4
    8 feed 6 0 -1 F100
    8 rapid 6.3 0.1 -1
    8 rapid 6.3 0.1 10
    8 rapid 6 0 10
    ");
}

/// Haas mill operator's manual (96-8000), "G73" and "G83": I, J and K are a first peck, by how
/// much each is smaller, and the smallest; K next to Q is after how much G73 returns to R. L
/// repeats, K does not. 1.27 mm is Setting 22.
#[test]
fn pecks_of_a_haas_become_smaller() {
    let program = "G21 G90 S500 M3\nG0 X0 Z10\nG99 G83 X1 Z-8 R2 I4 J1 K2.5 F100\nX2\nG80\nG73 X3 Z-6 R2 Q2 K4\nG80\n";
    assert_snapshot!(moves("haas", program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 feed 1 0 -2 F100
    3 rapid 1 0 2
    3 rapid 1 0 -0.73
    3 feed 1 0 -5 F100
    3 rapid 1 0 2
    3 rapid 1 0 -3.73
    3 feed 1 0 -7.5 F100
    3 rapid 1 0 2
    3 rapid 1 0 -6.23
    3 feed 1 0 -8 F100
    3 rapid 1 0 2
    4 rapid 2 0 2
    4 feed 2 0 -2 F100
    4 rapid 2 0 2
    4 rapid 2 0 -0.73
    4 feed 2 0 -5 F100
    4 rapid 2 0 2
    4 rapid 2 0 -3.73
    4 feed 2 0 -7.5 F100
    4 rapid 2 0 2
    4 rapid 2 0 -6.23
    4 feed 2 0 -8 F100
    4 rapid 2 0 2
    6 rapid 3 0 2
    6 feed 3 0 0 F100
    6 rapid 3 0 1.27
    6 feed 3 0 -2 F100
    6 rapid 3 0 2
    6 rapid 3 0 -0.73
    6 feed 3 0 -4 F100
    6 rapid 3 0 -2.73
    6 feed 3 0 -6 F100
    6 rapid 3 0 2
    ");
    assert_snapshot!(moves("haas", "S500 M3\nG99 G83 X1 Z-8 R2 Q3 K6 F100\n"), @"2 cycle-word: I, J and K go together, without Q; K alone goes with Q in G73 | check the number");
    // A shift is another thing: G76 has that of Q.
    let program = "S500 M3\nG99 G83 X1 Z-3 R2 I5 J1 K1 F100\nG76 X9 Z-1 R2 Q0.5\n";
    assert!(moves("haas", program).contains("\n3 rapid 9.5 0 -1\n"));
    assert_snapshot!(moves("haas", "S500 M3\nG99 G81 X1 Z-8 R2 K2 F100\n"), @"2 unused-word: nothing in this block uses the K word | take it out, or write the word that it belongs to");
    assert_snapshot!(moves("mazak", "S500 M3\nG99 G83 X1 Z-8 R2 Q3 K2 F100\n"), @"2 unused-word: nothing in this block uses the K word | take it out, or write the word that it belongs to");
}

/// R that was never given is an increment of nothing: the hole begins at the initial level.
#[test]
fn without_r_a_hole_begins_where_it_is_called() {
    let program = "G90 G0 Z10\nG99 G81 X1 Z-3 F100\nX2 R2\nG80\nG81 X3 Z-3\n";
    assert_snapshot!(moves("iso", program), @r"
    1 rapid 0 0 10
    2 rapid 1 0 10
    2 feed 1 0 -3 F100
    2 rapid 1 0 10
    3 rapid 2 0 10
    3 rapid 2 0 2
    3 feed 2 0 -3 F100
    3 rapid 2 0 2
    5 rapid 3 0 2
    5 feed 3 0 -3 F100
    5 rapid 3 0 2
    ");
}

/// Fanuc G88: the operator retracts to somewhere, then a rapid to the level.
#[test]
fn fanuc_retracts_from_an_unknown_place() {
    let program = "G90 S500 M3\nG0 Z10\nG98 G88 X1 Z-3 R2 F100\n";
    assert_snapshot!(moves("iso", program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 feed 1 0 -3 F100
    3 rapid 1 0 10 from an unknown place
    ");
}

/// G31 of Fanuc and Haas is not modal: the rapid comes back.
#[test]
fn skipping_is_probing() {
    assert_snapshot!(moves("iso", "G90 G0 Z10\nG31 Z-5 F60\nX1\nZ10\n"), @r"
    1 rapid 0 0 10
    2 probe 0 0 -5 F60
    3 rapid 1 0 -5
    4 rapid 1 0 10 from an unknown place
    ");
}
