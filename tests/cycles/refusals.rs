//! What is refused of canned cycles, threads, probing and splines.

use insta::assert_snapshot;

use super::{SPINDLE, moves};

#[test]
fn each_refusal_once() {
    let rs274 = [
        "G81 X1 Z-1",
        "G81 X1 R1",
        "G81 X1 Z1 R0",
        "G81 X1 Z-1 R1 L0",
        "G81 X1 Z-1 R1 L1.5",
        "G81 X1 Z-1 R1 A5",
        "G81",
        "G81 X1 Z-1 R1 P1",
        "G93 G81 X1 Z-1 R1 F1",
        "G53 G81 X1 Z-1 R1",
        "G83 X1 Z-1 R1",
        "G83 X1 Z-1 R1 Q0",
        "G83 X1 Z-900 R1 Q0.001",
        "G82 X1 Z-1 R1",
        "G82 X1 Z-1 R1 P-2",
        "G87 X1 Z-1 R1 I1 J1",
        "G74 X1 Z-1 R1",
        "M5 G84 X1 Z-1 R1",
        "G88 X1 Z-1 R1 P0\nG92 X0",
        "G33 Z1",
        "G33 Z1 K0",
        "M5\nG33 Z1 K1",
        "S0\nG33 Z1 K1",
        "G76 P1 Z-1 I-1 J1 K1",
        "G76 P1 Z-1 I-1 J1",
        "G38.2 Z0.1",
        "G38.2",
        "G5 X1 Y1 P1 Q1",
        "G5 X1 Y1 P1 I1 J1",
        "G18 G5.1 X1 I1 J1",
        "G5.2 X1 P1",
        "G5.3",
    ];
    let mut all = String::new();
    for program in rs274 {
        all += &moves("linuxcnc", &format!("{SPINDLE}G0 X0\n{program}\n"));
    }
    assert_snapshot!(all, @r"
    3 cycle-word: G81 without R | write R in the first block of the cycle
    3 cycle-word: G81 without Z | write Z in the first block of the cycle
    3 cycle-word: R is below the bottom of the hole | check the number
    3 cycle-word: a canned cycle cannot be repeated 0 times | check the number
    3 cycle-repeats: the number of repeats is not a whole number from 0 to 1e9 | write how often the hole is to be made
    3 cycle-axes: another axis than X, Y and Z in the block of a canned cycle | move it in a block of its own
    3 no-axes: this motion word needs an axis word | write where it is to move
    3 unused-word: nothing in this block uses the P word | take it out, or write the word that it belongs to
    3 cycle-g93: a canned cycle under G93 | write G94 before it
    3 special-in-g53: G53 goes with G0 and G1 only | use work coordinates here
    3 cycle-word: G83 without Q | write Q in the first block of the cycle
    3 cycle-word: Q must be greater than 0 | check the number
    3 too-many-moves: this block makes more than 100000 moves | check Q and the number of repeats
    3 cycle-word: G82 without P | write P in the first block of the cycle
    3 cycle-word: the dwell is negative or beyond reason | check the number
    3 cycle-word: G87 without I, J and K | write I, J and K in the first block of the cycle
    3 cycle-spindle: the spindle does not turn as G74 needs it | write M3 before it, or M4 for G74
    3 cycle-spindle: the spindle does not turn as G84 needs it | write M3 before it, or M4 for G74
    4 after-g88: G88 leaves the axis to be retracted by hand: what follows is not known | move the axes by G0 or G1 first
    3 thread-pitch: a thread without its pitch K | write K in every block: the way in one revolution
    3 thread-pitch: the pitch must be greater than 0 | check the number
    4 thread-spindle: a thread, but the spindle does not turn | write M3 or M4 before it
    4 no-spindle-speed: a thread, but no spindle speed is in force | write S before it
    3 thread-words: G76: K must be greater than J | check the words of the block
    3 thread-words: G76 needs P, I, J and K in every block | pitch, peak, first depth and full depth
    3 probe-length: the probe stands at its target already | probing needs a way of 0.254 mm (0.01 inch) at least
    3 no-axes: this motion word needs an axis word | write where it is to move
    3 spline: G5 needs P and Q, and in the first block of a series I and J | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: a spline with only one of P and Q | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: a spline outside of the plane G17 | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: a control point needs X and Y | see G5 and G5.2 in the manual of LinuxCNC
    3 spline: G5.3 before enough points by G5.2 | see G5 and G5.2 in the manual of LinuxCNC
    ");
    let mut all = String::new();
    for program in [
        "G81 X1 R1",
        "G83 X1 Z-1 R1",
        "G76 X1 Z-1 R1",
        "G99 G87 X1 Z-1 R-2 Q1",
        "G83 X1 Z-1 R1 Q1 I1",
        "G99\nG1 X1",
        "G91 G81 X1 Z1 R1",
        "G81 X1 Z-1 R1 K1.5",
    ] {
        all += &moves("iso", &format!("{SPINDLE}G0 X0\n{program}\n"));
    }
    assert_snapshot!(all, @r"
    3 cycle-word: G81 without Z | write Z in the first block of the cycle
    3 cycle-word: G83 without Q | write Q in the first block of the cycle
    3 cycle-word: G76 without Q, or I and J | write Q, or I and J in the first block of the cycle
    3 cycle-word: G87 cannot return to R (G99) | write G98: the way back is next to the hole, to the initial level
    3 unused-word: nothing in this block uses the I word | take it out, or write the word that it belongs to
    3 unsupported-code: G99 without a canned cycle: it may mean the feed per revolution of a lathe | write it in the block of the cycle, or G95 for a feed per revolution
    3 cycle-word: R is below the bottom of the hole | check the number
    3 cycle-repeats: the number of repeats is not a whole number from 0 to 1e9 | write how often the hole is to be made
    ");
    // What these do not have stays refused.
    for controller in ["grbl", "isg"] {
        let found = moves(controller, "G21 G90 F100\nG0 X0\nG81 X1 Z-1 R1\n");
        assert!(found.contains("G81 is a canned cycle"), "{found}");
    }
}
