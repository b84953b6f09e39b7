//! What words mean on one firmware and not on another, by its source.

use super::*;

/// Klipper (`gcode_move.py`): M220 and M221 without S are 100 %; the others report.
#[test]
fn percentages_without_a_value() {
    let program = "M220 S50\nM220\nG1 X10 F600\n";
    assert_snapshot!(klipper(program), @"3 feed X0.000>10.000 v10.000 a1000");
    assert_snapshot!(marlin(program), @"3 feed X0.000>10.000 v5.000");
    let program = "M83\nM221 S50\nM221\nG1 X10 E2 F600\n";
    assert_snapshot!(klipper(program), @"4 feed X0.000>10.000 E0.000>2.000 v10.000 a1000");
    assert_snapshot!(marlin(program), @"4 feed X0.000>10.000 E0.000>1.000 v10.000");
}

/// G92 alone: zero for all axes on Klipper, nothing on Marlin and RepRapFirmware.
#[test]
fn g92_without_axes() {
    let program = "G1 X10 F600\nG92\nG1 X10\n";
    assert_snapshot!(klipper(program), @r"
    1 feed X0.000>10.000 v10.000 a1000
    3 feed X10.000>20.000 v10.000 a1000
    ");
    for run in [marlin(program), reprap(program)] {
        assert_eq!(run, "1 feed X0.000>10.000 v10.000\n3 feed v10.000\n");
    }
}

/// Marlin G61 (`G61.cpp`): axes that are named go as far from the kept place as they say; of all,
/// Z goes first where it rises and last where it falls.
#[test]
fn back_to_a_kept_position() {
    let program = "G1 X10 Y10 Z5 F600\nG60\nG1 X50 Y20 Z2\nG61 X5 F1200\nG61\nG1 Z9\nG61\n";
    assert_snapshot!(marlin(program), @r"
    1 feed X0.000>10.000 Y0.000>10.000 Z0.000>5.000 v10.000
    3 feed X10.000>50.000 Y10.000>20.000 Z5.000>2.000 v10.000
    4 feed X50.000>15.000 v20.000
    5 feed Z2.000>5.000 v10.000
    5 feed X15.000>10.000 Y20.000>10.000 v10.000
    6 feed Z5.000>9.000 v10.000
    7 feed Z9.000>5.000 v10.000
    ");
    for run in [klipper(program), reprap("G60\nG61 X\n")] {
        assert!(
            run.starts_with("unsupported-code") || run.starts_with("unknown-code"),
            "{run}"
        );
    }
}

/// Marlin: T of M203 names the extruder whose limit is set; another tool's may hold later, so
/// that the higher one counts.
#[test]
fn limits_of_another_tool() {
    assert_snapshot!(marlin("M203 E5\nG1 E10 F6000\n"), @"2 feed E0.000>10.000 v5.000");
    assert_snapshot!(marlin("M203 T1 E5\nG1 E10 F6000\n"), @"2 feed E0.000>10.000 v100.000");
    assert_snapshot!(marlin("M203 T0 E5\nG1 E10 F6000\n"), @"2 feed E0.000>10.000 v5.000");
}

/// Klipper: `SET_RETRACTION` ends the retracted state; G10 retracts whatever else is given, as on
/// Marlin, while RepRapFirmware sets a tool then.
#[test]
fn retracts() {
    let program = "SET_RETRACTION RETRACT_LENGTH=2 RETRACT_SPEED=10\nG10\n\
                   SET_RETRACTION RETRACT_LENGTH=5\nG10\n";
    assert_snapshot!(klipper(program), @r"
    2 feed E0.000>-2.000 v10.000
    4 feed E-2.000>-7.000 v10.000
    ");
    assert_snapshot!(marlin("M207 S2 F600\nG10 P0\n"), @"2 feed E0.000>-2.000 v10.000");
    assert_snapshot!(reprap("M207 S2 F600\nG10 P0\n"), @"");
}

/// How far the program's coordinates are from the machine's stays unknown over a homing.
#[test]
fn homing_under_a_shift() {
    assert_snapshot!(klipper("SET_GCODE_OFFSET X=50\nG28 X\nG1 X10 F600\nG1 X20\n"), @r"
    2 feed from anywhere X v10.000 a1000
    3 feed from anywhere X v10.000 a1000
    4 feed X10.000>20.000 v10.000 a1000
    ");
    assert_snapshot!(marlin("M206 X-50\nG28 X\nG1 X10 F600\n"), @r"
    2 feed from anywhere X v10.000
    3 feed from anywhere X v10.000
    ");
}

/// RepRapFirmware runs stop.g at M0, unless the machine file says that it moves nothing.
#[test]
fn m0_runs_a_file() {
    assert_snapshot!(reprap("G1 X10 F600\nM0\n"), @r"
    1 feed X0.000>10.000 v10.000
    2 feed from anywhere XYZE loads 111
    note macro-heaters
    note unknown-moves
    note macro-settings
    ");
    let quiet = machine_with("reprap", "[language]\nignored_macros = [\"M0\"]\n");
    assert_snapshot!(super::run(&quiet, "G1 X10 F600\nM0\n"), @"1 feed X0.000>10.000 v10.000");
    assert_snapshot!(marlin("G1 X10 F600\nM0\n"), @"1 feed X0.000>10.000 v10.000");
}

/// Words that Klipper does not know: it goes on without them.
#[test]
fn words_that_klipper_does_not_know() {
    assert_snapshot!(klipper("M200 D1.75\nM83\nG1 E5 F60\n"), @r"
    3 feed E0.000>5.000 v1.000
    note volumetric
    ");
    for word in ["G54", "G30", "G60"] {
        let run = klipper(&format!("{word}\nG1 X10 F600\n"));
        assert!(run.contains("Klipper does not know this word"), "{run}");
    }
}
