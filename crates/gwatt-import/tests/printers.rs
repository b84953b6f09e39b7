//! Printers with more than one extruder, or more than three axes.

use insta::assert_snapshot;

use super::{imported, in_force, render};

/// 300 mm/s of extruder1 are 18000 mm/min; what no axis has is named.
#[test]
fn printers_of_several_extruders_and_carriages() {
    let text = "[printer]\nkinematics: cartesian\nmax_velocity: 300\nmax_accel: 3000\n[extruder1]\nnozzle_diameter: 0.4\n\
                filament_diameter: 1.75\nmax_extrude_only_velocity: 300\nmax_extrude_only_accel: 20000\nrotation_distance: 8\n\
                instantaneous_corner_velocity: 2\n[dual_carriage]\naxis: x\nposition_max: 300\n[extruder]\nnozzle_diameter: 0.4\n\
                filament_diameter: 1.75\nmax_extrude_only_velocity: 120\nmax_extrude_only_accel: 8000\n\
                instantaneous_corner_velocity: 0.5\n[manual_stepper feed]\nvelocity: 5\n";
    let found = imported(text);
    let (_, extruder) = found.toml.split_once("[axes.E]").unwrap();
    assert!(extruder.contains("rapid_mm_min = 18000 "), "{extruder}");
    assert!(extruder.contains("accel_mm_s2 = 20000 "), "{extruder}");
    assert!(extruder.contains("revolution: 8 mm"), "{extruder}");
    assert!(
        found.toml.contains("extruder_step_mm_s = 2 "),
        "{}",
        found.toml
    );
    // The default of one that has none is 1.
    let less = imported(&text.replace("instantaneous_corner_velocity: 2\n", ""));
    assert!(
        less.toml.contains("extruder_step_mm_s = 1 "),
        "{}",
        less.toml
    );
    assert!(
        found
            .toml
            .contains("[dual_carriage], [manual_stepper feed]"),
        "{}",
        found.toml
    );
    assert_snapshot!(render(&found.warnings), @r"
    settings:13, warning: [dual_carriage] moves, and does not count / what moves together with an axis belongs to its mass and rotors; for the rest add its power to `base_load_w`
      | axis: x
      | ^^^^^^^
    settings:22, warning: [manual_stepper feed] moves, and does not count / what moves together with an axis belongs to its mass and rotors; for the rest add its power to `base_load_w`
      | velocity: 5
      | ^^^^^^^^^^^
    ");
}

/// U and V come after C; B alone turns, and there is no extruder.
#[test]
fn marlin_of_eight_axes() {
    let drivers = "#define I_DRIVER_TYPE A\n#define J_DRIVER_TYPE A\n#define K_DRIVER_TYPE A\n#define U_DRIVER_TYPE A\n\
                   #define V_DRIVER_TYPE A\n#define AXIS4_NAME 'A'\n//#define AXIS4_ROTATES\n#define AXIS5_NAME 'B'\n#define AXIS5_ROTATES\n\
                   #define AXIS6_NAME 'C'\n#define AXIS8_NAME 'V'\n#define EXTRUDERS 0\n";
    let eight = "#define DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 }\n#define DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 }\n";
    let found = imported(&format!("{drivers}{eight}"));
    assert_eq!(render(&found.warnings), "");
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "marlin"
    [converter]
    [axes.X]
    kind = "linear"
    rapid_mm_min = 60            # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_mm_s2 = 1              # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 120           # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_mm_s2 = 2              # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 180           # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_mm_s2 = 3              # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [axes.A]
    kind = "linear"
    rapid_mm_min = 240           # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_mm_s2 = 4              # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [axes.B]
    kind = "rotary"
    rapid_deg_min = 300          # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_deg_s2 = 5             # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [axes.C]
    kind = "linear"
    rapid_mm_min = 360           # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_mm_s2 = 6              # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [axes.U]
    kind = "linear"
    rapid_mm_min = 420           # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_mm_s2 = 7              # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [axes.V]
    kind = "linear"
    rapid_mm_min = 480           # DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8 } (line 13)
    accel_mm_s2 = 8              # DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8 } (line 14)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
    let nine = imported(&format!("{drivers}{}", eight.replace("8 }", "8, 9 }")));
    assert!(!nine.toml.contains("[axes.E]"), "{}", nine.toml);
    assert_snapshot!(render(&nine.warnings), @r"
    settings:0, warning: DEFAULT_MAX_FEEDRATE { 1, 2, 3, 4, 5, 6, 7, 8, 9 } (line 13): there are more values than axes with a driver / what is driven and has no driver there belongs into the machine file by hand
    settings:0, warning: DEFAULT_MAX_ACCELERATION { 1, 2, 3, 4, 5, 6, 7, 8, 9 } (line 14): there are more values than axes with a driver / what is driven and has no driver there belongs into the machine file by hand
    ");
}
