//! Values that cannot be read are errors with their line.

use gwatt_import::{Nothing, Wanted, import};
use insta::assert_snapshot;

use super::{file, imported, refused, render};

#[test]
fn numbers_that_are_none() {
    assert_snapshot!(refused("$110=8OO0\n$120=-5\n$121=nan\n"), @r"
    settings:1, error: `8OO0` is not a number / write the number that the control has, without a unit
      | $110=8OO0
      |      ^^^^
    settings:2, error: -5 is not valid for an acceleration of axis X / a value above 0 is needed: look at the control
      | $120=-5
      |      ^^
    settings:3, error: `nan` is not a number / write the number that the control has, without a unit
      | $121=nan
      |      ^^^
    ");
    assert_snapshot!(refused("M584 X0\nM203 X{global.speed} Y6000\nM201 X1000:abc\nM566 X0\n"), @r"
    settings:2, error: `{global.speed}` is not a number / write the number that the control has, without a unit
      | M203 X{global.speed} Y6000
      |       ^^^^^^^^^^^^^^
    settings:3, error: `abc` is not a number / write the number that the control has, without a unit
      | M201 X1000:abc
      |            ^^^
    ");
    assert_snapshot!(refused("echo:  M203 Xfast\necho:  M201 X0\n"), @r"
    settings:1, error: `fast` is not a number / write the number that the control has, without a unit
      | echo:  M203 Xfast
      |              ^^^^
    settings:2, error: 0 is not valid for M201 of X / a value above 0 is needed: look at the control
      | echo:  M201 X0
      |              ^
    settings:0, warning: M503 does not say whether S_CURVE_ACCELERATION is on, which makes peaks of acceleration 1.875 times as high: counted as on / import Configuration.h instead, or delete the servo factors where it is off
    ");
    assert_snapshot!(refused("N01420A1P36000AXP1\nN01620A1P1e999\n"), @r"
    settings:1, error: `A` names no axis, path or spindle / write it as A1 P…
      | N01420A1P36000AXP1
      |               ^
    settings:1, warning: parameter 1020 has no name for axis 1: taken for X / add parameter 1020 to the file if it is another one
      | N01420A1P36000AXP1
      |          ^^^^^
    ");
    assert_snapshot!(refused("N32000 $MA_MAX_AX_VELO[AX1]=R1\n"), @r"
    settings:1, error: `R1` is not a number / write the number that the control has, without a unit
      | N32000 $MA_MAX_AX_VELO[AX1]=R1
      |                             ^^
    ");
    assert_snapshot!(refused("[printer]\nkinematics: cartesian\nmax_velocity: 300 mm\nminimum_cruise_ratio: 2\n"), @r"
    settings:3, error: `300 mm` is not a number / write the number that the control has, without a unit
      | max_velocity: 300 mm
      |               ^^^^^^
    settings:4, error: 2 is not valid for a cruise ratio / it is a share from 0 to below 1
      | minimum_cruise_ratio: 2
      |                       ^
    ");
    assert_snapshot!(refused("[TRAJ]\nLINEAR_UNITS = furlong\n[AXIS_X]\nMAX_VELOCITY = ten\n"), @r"
    settings:2, error: `furlong` is no unit / write mm or inch, degree or rad
      | LINEAR_UNITS = furlong
      |                ^^^^^^^
    settings:4, error: `ten` is not a number / write the number that the control has, without a unit
      | MAX_VELOCITY = ten
      |                ^^^
    ");
    assert_snapshot!(refused("#define DEFAULT_MAX_FEEDRATE { FAST, 2 }\n#define DEFAULT_MAX_ACCELERATION 500\n"), @r"
    settings:1, error: `{ FAST, 2 }` cannot be read / write it as a number, or a sum of numbers, and import again
      | #define DEFAULT_MAX_FEEDRATE { FAST, 2 }
      |                              ^^^^^^^^^^^
    settings:2, error: `500` cannot be read / write it as a number, or a sum of numbers, and import again
      | #define DEFAULT_MAX_ACCELERATION 500
      |                                  ^^^
    ");
    assert_snapshot!(refused("axes:\n  x:\n    max_rate_mm_per_min: 0\n    acceleration_mm_per_sec2: quick\n"), @r"
    settings:4, error: `quick` is not a number / write the number that the control has, without a unit
      |     acceleration_mm_per_sec2: quick
      |                               ^^^^^
    settings:0, error: axis x has no rate: max_rate_mm_per_min: 0 (line 3) / a value above 0 is needed: look at the configuration
    ");
}

#[test]
fn machines_that_gwatt_does_not_describe() {
    assert_snapshot!(refused("[printer]\nkinematics: delta\nmax_velocity: 300\nmax_accel: 3000\n"), @r"
    settings:2, error: kinematics `delta`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | kinematics: delta
      |             ^^^^^
    ");
    assert_snapshot!(refused("M584 X0\nM669 K3\nM203 X1\n"), @r"
    settings:2, error: kinematics `M669 K3`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | M669 K3
      | ^^^^^^^
    ");
    assert_snapshot!(refused("#define DELTA\n#define DEFAULT_MAX_FEEDRATE { 1, 1, 1, 1 }\n"), @r"
    settings:1, error: kinematics `DELTA`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | #define DELTA
      |         ^^^^^
    ");
    assert_snapshot!(refused("[KINS]\nKINEMATICS = genserkins\n[AXIS_X]\nMAX_VELOCITY = 1\n"), @r"
    settings:2, error: kinematics `genserkins`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | KINEMATICS = genserkins
      |              ^^^^^^^^^^
    ");
    assert_snapshot!(refused("kinematics:\n  parallel_delta:\naxes:\n  x:\n    max_rate_mm_per_min: 100\n"), @r"
    settings:2, error: kinematics `parallel_delta`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      |   parallel_delta:
      |   ^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(refused("N10240 $MN_SCALING_SYSTEM_IS_METRIC=0\nN10220 $MN_SCALING_USER_DEF_MASK='H1'\nN32000 $MA_MAX_AX_VELO[AX1]=1\n"), @r"
    settings:1, error: the basic system is inch, whose units are not read / write the archive with the basic system metric (MD10240 = 1)
      | N10240 $MN_SCALING_SYSTEM_IS_METRIC=0
      |                                     ^
    settings:2, error: the units of machine data are the user's own / write the archive with MD10220 = 0
      | N10220 $MN_SCALING_USER_DEF_MASK='H1'
      |                                  ^^^^
    ");
    assert_snapshot!(refused("N01420A1I100\nN01620A1P100\n"), @r"
    settings:1, error: values in inches (I) are not read / write the parameters in metric units
      | N01420A1I100
      |         ^^^^
    ");
}

#[test]
fn files_of_no_kind() {
    assert_snapshot!(refused("G1 X10 F100\n"), @"settings:0, error: the file does not show what kind of settings these are / say it: --format linuxcnc, grbl, fluidnc, marlin, marlin-config, klipper, reprap, fanuc, siemens");
    assert_snapshot!(refused("$0=10\n$1=25\n"), @r"
    settings:0, error: no speed and no acceleration of an axis was found, read as grbl / give the file that holds them, or another --format
    ");
    // Marlin's units are mm/s and RepRapFirmware's mm/min: nothing is guessed.
    assert_snapshot!(refused("M203 X500 Y500\nM201 X500 Y500\nM208 X200\nM569 P0 S1\n"), @"settings:0, error: the file does not show what kind of settings these are / say it: --format linuxcnc, grbl, fluidnc, marlin, marlin-config, klipper, reprap, fanuc, siemens");
    assert_snapshot!(refused("a\0b"), @r"
    settings:0, error: settings is a binary file, or text in UTF-16 / save it as plain text (ASCII or UTF-8)
    ");
    let wanted = Wanted {
        format: None,
        controller: Some("grbel"),
    };
    let errors = import(&[file("a", "$110=1\n")], wanted, &Nothing).unwrap_err();
    assert!(render(&errors).contains("no controller profile is named \"grbel\""));
}

#[test]
fn a_circle_of_includes_ends() {
    struct Circle;
    impl gwatt_import::Near for Circle {
        fn files(&self, _: &str, pattern: &str) -> Vec<gwatt_import::File> {
            vec![file(pattern, "[include a.cfg]\n[printer]\n")]
        }
    }
    let text = "[include a.cfg]\n[printer]\nmax_velocity: 100\n";
    let errors = import(&[file("p.cfg", text)], Wanted::default(), &Circle).unwrap_err();
    assert!(render(&errors).contains("too many files include each other"));
}

/// What is there, and what is not: axes of Fanuc without a name, and of no letter.
#[test]
fn what_is_left_out_is_said() {
    let found = imported("N01020A2P200\nN01420A1P100A2P100A4P100\nN01620A1P100\nN01737A1P5\n");
    assert_snapshot!(render(&found.warnings), @r"
    settings:2, warning: parameter 1020 has no name for axis 1: taken for X / add parameter 1020 to the file if it is another one
      | N01420A1P100A2P100A4P100
      |          ^^^
    settings:1, warning: the name of axis 2 (200) is no axis that gwatt knows / it is left out: gwatt knows X Y Z A B C U V W
      | N01020A2P200
      |          ^^^
    settings:2, warning: parameter 1020 has no name for axis 4: it is left out / add parameter 1020 to the file, or the axis by hand
      | N01420A1P100A2P100A4P100
      |                      ^^^
    settings:4, warning: parameter 1737, acceleration on arcs, is not taken over / the robust bound holds for whatever it makes of speeds below the limits of the axes
      | N01737A1P5
      |          ^
    ");
}

/// A file of notes about several machines, as people keep them, and a file in which settings are
/// commented out.
#[test]
fn settings_of_grbl_that_stand_twice_or_in_comments() {
    let notes = "Small mill:\n$10=3\n$110=400.000 (x max rate)\n$120=100.000\n\
                 Router:\n$10=1\n$110=1500.000\n$120=90.000\n";
    let found = imported(notes);
    assert_snapshot!(render(&found.warnings), @r"
    settings:7, warning: $110=400.000 (line 3) says otherwise: of each setting the last one counts / give the settings of one machine, as `$$` prints them
      | $110=1500.000
      |      ^^^^^^^^
    ");
    let toml = found.toml;
    assert!(toml.contains("rapid_mm_min = 1500          # $110=1500.000 (line 7)"));
    let twice = "$110=800\n$110=800\n$120=50\n";
    assert_eq!(render(&imported(twice).warnings), "");
    let comments = "$110=800\n$120=50\n; $110=900\n(was $120=70)\n(12:30) $121=60\n$111=700\n";
    let found = imported(comments);
    assert_eq!(render(&found.warnings), "");
    assert!(
        found.toml.contains("# $110=800 (line 1)") && found.toml.contains("# $120=50 (line 2)")
    );
    assert!(found.toml.contains("# $121=60 (line 5)"));
}
