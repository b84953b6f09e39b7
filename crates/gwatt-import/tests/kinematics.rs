//! Whose motors do not move an axis each, or not as programs say.

use gwatt_import::{Nothing, Wanted, import};
use insta::assert_snapshot;

use super::{Folder, file, imported, in_force, refused, render};

const INI: &str = "[HAL]\nHALFILE = m.hal\n[TRAJ]\nCOORDINATES = X Y Z\n[AXIS_0]\nMAX_VELOCITY = 350\n\
                   MAX_ACCELERATION = 3000\n[EMC]\nMACHINE = M\n";

/// Up to LinuxCNC 2.7 the kinematics stand in the HAL file alone.
#[test]
fn kinematics_that_hal_loads() {
    let with = |hal: &str| {
        let near = Folder(vec![file("m.hal", hal)]);
        match import(&[file("m.ini", INI)], Wanted::default(), &near) {
            Ok(found) => render(&found.warnings),
            Err(errors) => render(&errors),
        }
    };
    assert_snapshot!(with("loadrt lineardeltakins\nloadrt motmod kins=lineardeltakins\n"), @r"
    m.hal:1, error: kinematics `lineardeltakins`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | loadrt lineardeltakins
      |        ^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(with("loadrt corexykins # belts\n"), @r"
    m.hal:1, warning: two motors move two axes together: they count by the robust bound / give both axes the larger mass and friction, and the rotors of both motors
      | loadrt corexykins # belts
      |        ^^^^^^^^^^
    ");
    assert_snapshot!(with("loadrt trivkins\nloadrt gantrykins coordinates=XYYZ\n#loadrt pumakins\nloadrt [KINS]KINEMATICS\n"), @"");
    // One that the INI file names as well is said once.
    let both = INI.replace("[HAL]", "[KINS]\nKINEMATICS = corexykins\n[HAL]");
    let near = Folder(vec![file("m.hal", "loadrt corexykins\n")]);
    let found = import(&[file("m.ini", &both)], Wanted::default(), &near).unwrap();
    assert_eq!(found.warnings.len(), 1);
    // A file that is missing may load any.
    let found = import(&[file("m.ini", INI)], Wanted::default(), &Nothing).unwrap();
    assert_snapshot!(render(&found.warnings), @r"
    m.ini:2, warning: `m.hal` was not found, which may load kinematics other than trivkins / each axis counts as driven by its own joint: see its `loadrt` lines, or put it where the line says
      | HALFILE = m.hal
      |           ^^^^^
    ");
}

/// V is a length for LinuxCNC whatever its joint is: 1.2 in/s = 1828.8 mm/min, 20 in/s² = 508 mm/s².
#[test]
fn a_length_that_turns() {
    let text = "[TRAJ]\nCOORDINATES = X V\nLINEAR_UNITS = inch\nANGULAR_UNITS = degree\n\
                [KINS]\nKINEMATICS = trivkins coordinates=xv\n[AXIS_V]\nMAX_VELOCITY = 1.2\nMAX_ACCELERATION = 20\n\
                [JOINT_0]\nTYPE = LINEAR\nMAX_VELOCITY = 1\nMAX_ACCELERATION = 10\n\
                [JOINT_1]\nTYPE = ANGULAR\nMAX_VELOCITY = 90\n";
    let found = imported(text);
    assert_snapshot!(render(&found.warnings), @r"
    settings:15, warning: V is a length in programs, and its joint is ANGULAR / it counts as linear, a degree as a millimetre: give its mass as its drive feels it
      | TYPE = ANGULAR
      |        ^^^^^^^
    ");
    let toml = in_force(&found.toml);
    assert!(toml.contains("rapid_mm_min = 1828.8"), "{toml}");
    assert!(toml.contains("accel_mm_s2 = 508"), "{toml}");
    assert!(!toml.contains("rotary"), "{toml}");
}

#[test]
fn carriages_that_share_steppers() {
    let with = |a: &str, b: &str| {
        format!(
            "[printer]\nkinematics: generic_cartesian\nmax_velocity: 300\nmax_accel: 3000\n\
             [carriage x]\nposition_endstop: 5\nposition_max: 300\nhoming_speed: 50\n\
             [carriage cy]\naxis: y\nposition_endstop: 0\nposition_max: 200\n\
             [stepper a]\ncarriages: {a}\nrotation_distance: 40\n[stepper b]\ncarriages: {b}\n[stepper c]\ncarriages: cy\n"
        )
    };
    assert_snapshot!(refused(&with("x + cy", "x + cy")), @r"
    settings:14, error: kinematics `carriages: x + cy`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | carriages: x + cy
      |            ^^^^^^
    ");
    assert_snapshot!(refused(&with("0.5*x-0.5*cy", "x")), @r"
    settings:14, error: kinematics `carriages: 0.5*x-0.5*cy`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | carriages: 0.5*x-0.5*cy
      |            ^^^^^^^^^^^^
    ");
    assert_snapshot!(render(&imported(&with("x-cy", "x + cy")).warnings), @r"
    settings:14, warning: two motors move two axes together: gwatt counts by axis / give both axes the larger mass and the rotors of both motors; see the head of the file
      | carriages: x-cy
      |            ^^^^
    ");
    let found = imported(&with("x", "cy"));
    assert_eq!(render(&found.warnings), "");
    let toml = in_force(&found.toml);
    assert!(toml.contains("reference_mm = 5"), "{toml}");
    assert!(toml.contains("reference_mm_min = 3000"), "{toml}");
    // Y has two steppers.
    assert!(found.toml.contains("2 motors"), "{}", found.toml);
}

#[test]
fn a_matrix_that_lets_motors_move_several_axes() {
    let rest = "M203 X6000 Y6000\nM201 X500 Y500\nM566 X600 Y600\n";
    assert_snapshot!(refused(&format!("M669 K0 X1:1:0 Y1:-1:0\n{rest}")), @r"
    settings:1, error: kinematics `M669 K0 X1:1:0 Y1:-1:0`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | M669 K0 X1:1:0 Y1:-1:0
      | ^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(refused(&format!("M669 K1 Z{{1,0,1}}\n{rest}")), @r"
    settings:1, error: kinematics `M669 K1 Z{1,0,1}`: its motors do not move X, Y and Z each / gwatt describes machines whose axes have a drive each (and CoreXY): powers of this one would be wrong
      | M669 K1 Z{1,0,1}
      | ^^^^^^^^^^^^^^^^
    ");
    // The other way round, and an axis that stands fourth.
    let plain = imported(&format!(
        "M584 U5 S0\nM669 K0 X-1:0:0 Y0:1:0 U0:0:0:1\n{rest}"
    ));
    assert_eq!(render(&plain.warnings), "");
}

/// In CNC and laser mode G0 obeys no F.
#[test]
fn modes_in_which_rapids_are_faster() {
    let rest = "M203 X2500 Y2500\nM201 X500 Y500\nM566 X900 Y900\n";
    assert_snapshot!(refused(&format!("{rest}M453 S0 C\"out1\" R1\n")), @r#"
    settings:4, error: a mode in which G0 moves as fast as M203 permits, and not at F / gwatt reads programs of RepRapFirmware in FFF mode (M451): powers of this machine would be too low
      | M453 S0 C"out1" R1
      | ^^^^^^^^^^^^^^^^^^
    "#);
    assert_snapshot!(refused(&format!("M452\n{rest}")), @r"
    settings:1, error: a mode in which G0 moves as fast as M203 permits, and not at F / gwatt reads programs of RepRapFirmware in FFF mode (M451): powers of this machine would be too low
      | M452
      | ^^^^
    ");
    assert_eq!(
        render(&imported(&format!("M453\n{rest}M451\n")).warnings),
        ""
    );
}
