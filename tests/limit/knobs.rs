//! Words for acceleration and rapid speed: inserted, and taken back.

use super::{EXACT_STOP, RIG, Rig};
use gwatt::pipeline::Strategy;

const ISG: Rig = Rig {
    controller: "isg",
    rest: EXACT_STOP,
    ..RIG
};

const MARLIN: Rig = Rig {
    controller: "marlin",
    rest: EXACT_STOP,
    ..RIG
};

#[test]
fn isg_acceleration() {
    assert_eq!(
        ISG.strategy(Strategy::Accel)
            .fits("G0 X400\nG1 X0 F30000\nX1 F100\nM30\n"),
        "G231 = 79.9\nG0 X400\nG131 = 79.9\nG1 X0 F30000\nG131 = 100\nX1 F100\nG231 = 100\nM30\n"
    );
}

#[test]
fn isg_rapid_speed_and_feed() {
    assert_eq!(
        ISG.strategy(Strategy::Speed)
            .fits("G0 X400\nG1 X0 F30000\nX1 F100\nG0 X2\nM30\n"),
        "G129 = 80\nG0 X400\nG1 X0 F24000\nX1 F100\nG129 = 100\nG0 X2\nM30\n"
    );
}

/// Over 400 mm acceleration alone costs less time than speed.
#[test]
fn isg_optimum_writes_no_word_that_changes_nothing() {
    let text = ISG.fits("G0 X400\nG1 X0 F30000\nX1 F100\nM30\n");
    assert!(text.contains("G231 ="), "{text}");
    assert!(!text.contains("G129"), "{text}");
    assert!(text.contains("F30000\n"), "{text}");
}

#[test]
fn isg_values_of_the_program_come_back() {
    let rig = Rig {
        peak_w: 700.0,
        ..ISG
    };
    assert_eq!(
        rig.strategy(Strategy::Accel)
            .fits("G130 X80 Y50\nG1 X400 F30000\nG1 X0\nM30\n"),
        "G130 X80 Y50\nG130 X55.9 Y34.9\nG1 X400 F30000\nG1 X0\nG130 X80 Y50\nM30\n"
    );
}

#[test]
fn marlin_acceleration() {
    assert_eq!(
        MARLIN
            .strategy(Strategy::Accel)
            .fits("G0 X400 F30000\nG1 X0\nG1 X1 F100\n"),
        "M201 X3999 Y3999\nG0 X400 F30000\nG1 X0\nM201 X5000 Y5000\nG1 X1 F100\n"
    );
}

/// 500 mm/s² are 19.685 in/s²: what comes back must not be higher.
#[test]
fn marlin_acceleration_in_inches() {
    let rig = Rig {
        axis: "viscous_n_s_m = 1",
        ..MARLIN
    };
    let text = rig
        .strategy(Strategy::Accel)
        .fits("G20\nG1 X15 F1100\nX14.99\n");
    assert!(text.contains("M201 X196.85039370"), "{text}");
}

/// The line before a block is read in the unit before it.
#[test]
fn marlin_acceleration_beside_a_change_of_units() {
    // RepRapFirmware reads both commands of the line.
    let rig = Rig {
        controller: "reprap",
        ..MARLIN
    };
    assert_eq!(
        rig.strategy(Strategy::Accel)
            .fits("G1 F30000 X1\nG20 G1 X15\nG21\nG1 X380\n"),
        "G1 F30000 X1\nM201 X3999 Y3999\nG20 G1 X15\nG21\nM201 X5000 Y5000\nG1 X380\n"
    );
}
