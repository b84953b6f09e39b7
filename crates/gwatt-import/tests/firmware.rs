//! What settings of firmware become: values in force, each with its source.

use gwatt_import::{Format, Wanted, import};
use insta::assert_snapshot;

use super::{Folder, fields, file, imported, in_force, render};

#[test]
fn grbl() {
    let text = "< $$\n$11=0.020 (junction deviation, mm)\n$12=0.002\n$22=1\n$23=1\n$25=1500.000\n$27=2.000\n\
                $30=24000\n$100=80.000\n$110=8000.000\n$111=7000.000\n$112=500.000\n$113=3600.000\n\
                $120=400.000\n$121=300.000\n$122=50.000\n$123=720.000\n$130=740.000\n$398=100\nok\n";
    let found = imported(text);
    assert_eq!(found.format, Format::Grbl);
    assert!(
        found.toml.contains("# reference_mm_min = 1500"),
        "{}",
        found.toml
    );
    assert!(
        found.toml.contains("# reference_mm = -738"),
        "{}",
        found.toml
    );
    assert!(found.toml.contains("# max_rpm = 24000"), "{}", found.toml);
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "grbl"
    [converter]
    [look_ahead]
    blocks = 98                  # $398=100 (line 19)
    chords = { deviation_mm = 0.002 } # $12=0.002 (line 3)
    [look_ahead.junction_deviation]
    deviation_mm = 0.02          # $11=0.020 (line 2)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 8000          # $110=8000.000 (line 10)
    accel_mm_s2 = 400            # $120=400.000 (line 14)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 7000          # $111=7000.000 (line 11)
    accel_mm_s2 = 300            # $121=300.000 (line 15)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 500           # $112=500.000 (line 12)
    accel_mm_s2 = 50             # $122=50.000 (line 16)
    [axes.A]
    kind = "rotary"
    rapid_deg_min = 3600         # $113=3600.000 (line 13)
    accel_deg_s2 = 720           # $123=720.000 (line 17)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

#[test]
fn fluidnc() {
    let text = "name: router\nplanner_blocks: 32\naxes:\n  x:\n    steps_per_mm: 80\n    max_rate_mm_per_min: 5000.000\n    \
                acceleration_mm_per_sec2: 250 # tried\n    max_travel_mm: 300\n    homing:\n      cycle: 2\n      \
                mpos_mm: 1.5\n      seek_mm_per_min: 800\n      feed_mm_per_min: 100\n    motor0:\n      \
                limit_all_pin: gpio.4\n    motor1:\n      limit_all_pin: gpio.5\n  z:\n    \
                max_rate_mm_per_min: 900\n    acceleration_mm_per_sec2: 50\njunction_deviation_mm: 0.015\n";
    let found = imported(text);
    assert!(
        found.toml.contains("rotors of all 2 motors together"),
        "{}",
        found.toml
    );
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "grbl"
    [converter]
    [look_ahead]
    blocks = 29                  # planner_blocks: 32 (line 2)
    [look_ahead.junction_deviation]
    deviation_mm = 0.015         # junction_deviation_mm: 0.015 (line 21)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 5000          # max_rate_mm_per_min: 5000.000 (line 6)
    reference_mm = 1.5           # mpos_mm: 1.5 (line 11)
    accel_mm_s2 = 250            # acceleration_mm_per_sec2: 250 (line 7)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 900           # max_rate_mm_per_min: 900 (line 19)
    accel_mm_s2 = 50             # acceleration_mm_per_sec2: 50 (line 20)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

#[test]
fn marlin_settings() {
    let text = "Recv: echo:  G21    ; Units in mm (mm)\nRecv: echo:; Steps per unit:\n\
                Recv: echo: M92 X80.00 Y80.00 Z400.00 E93.00\nRecv: echo:  M203 X300.00 Y300.00 Z5.00\n\
                Recv: echo:  M203 T0 E25.00\nRecv:   M203 T1 E30.00\nRecv: echo:  M201 X3000.00 Y3000.00 Z100.00 E5000.00\n\
                Recv: echo:; Acceleration (units/s2): P<print_accel> R<retract_accel> T<travel_accel>\n\
                Recv: echo:  M204 P500.00 R1000.00 T1500.00\nRecv: echo:  M205 B20000.00 S0.00 T0.00 J0.08\n\
                Recv: echo:  M207 S1.50 W13.00 F3000.00 Z0.00\n";
    let found = imported(text);
    assert_snapshot!(render(&found.warnings), @r"
    settings:0, warning: M503 does not say whether S_CURVE_ACCELERATION is on, which makes peaks of acceleration 1.875 times as high: counted as on / import Configuration.h instead, or delete the servo factors where it is off
    ");
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "marlin"
    [converter]
    [path]
    accel_mm_s2 = { print = 500, travel = 1500, retract = 1000 } # M204 P500.00 (line 9), M204 T1500.00 (line 9), M204 R1000.00 (line 9)
    shortest_at_feed_s = 0.02    # M205 B20000.00 (line 10)
    [language]
    retract = { length_mm = 1.5, speed_mm_s = 50 } # M207 S1.50 (line 11), M207 F3000.00 (line 11)
    [look_ahead.junction_deviation]
    deviation_mm = 0.08          # M205 J0.08 (line 10)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 18000         # M203 X300.00 (line 4)
    accel_mm_s2 = 3000           # M201 X3000.00 (line 7)
    servo_factor_motor = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    servo_factor_regen = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 18000         # M203 Y300.00 (line 4)
    accel_mm_s2 = 3000           # M201 Y3000.00 (line 7)
    servo_factor_motor = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    servo_factor_regen = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 300           # M203 Z5.00 (line 4)
    accel_mm_s2 = 100            # M201 Z100.00 (line 7)
    servo_factor_motor = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    servo_factor_regen = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    [axes.E]
    kind = "linear"
    rapid_mm_min = 1800          # M203 E30.00 (line 6), the highest
    accel_mm_s2 = 5000           # M201 E5000.00 (line 7)
    servo_factor_motor = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    servo_factor_regen = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// A dump of settings without `echo:`, as a host or a macro keeps it: M205 and the like are Marlin's,
/// and M208, M569 and M350 of both. M205 without a step of speed writes no table of them.
#[test]
fn marlin_settings_without_echo() {
    let text = "; Linear Units:\nG21\n; Temperature Units:\nM149 C\n; Maximum feedrates (units/s):\n\
                M203 X500.00 Y500.00 Z5.00\n; Maximum Acceleration (units/s2):\nM201 X500.00 Y500.00 Z100.00\n\
                ; Advanced:\nM205 B20000.00 S0.00 T0.00\nM145 S0 H185.00 B45.00 F255\nM208 S0.00 W0.00 F480.00\n\
                M569 S1 X Y\nM350 X16\nM209 S0\nM603 L0.00 U100.00\n";
    assert_snapshot!(fields(text), @r#"
    controller = "marlin"
    [converter]
    [path]
    shortest_at_feed_s = 0.02    # M205 B20000.00 (line 10)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 30000         # M203 X500.00 (line 6)
    accel_mm_s2 = 500            # M201 X500.00 (line 8)
    servo_factor_motor = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    servo_factor_regen = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 30000         # M203 Y500.00 (line 6)
    accel_mm_s2 = 500            # M201 Y500.00 (line 8)
    servo_factor_motor = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    servo_factor_regen = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 300           # M203 Z5.00 (line 6)
    accel_mm_s2 = 100            # M201 Z100.00 (line 8)
    servo_factor_motor = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    servo_factor_regen = 1.875   # delete it where Configuration.h has S_CURVE_ACCELERATION off
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Old firmware: S is the acceleration of all moves, T of retracts; X and Y have one jerk.
#[test]
fn marlin_settings_of_old() {
    let text = "echo:Maximum feedrates (mm/s):\necho:  M203 X200.00 Y200.00 Z2.50 E30.00\n\
                echo:Maximum Acceleration (mm/s2):\necho:  M201 X2000 Y2000 Z100 E10000\n\
                echo:Acceleration: S=acceleration, T=retract acceleration\necho:  M204 S500.00 T400.00\n\
                echo:  M205 S0.00 T0.00 B20000 X15.00 Z0.40 E5.00\n";
    assert_snapshot!(fields(text), @r#"
    controller = "marlin"
    [converter]
    [path]
    accel_mm_s2 = { print = 500, travel = 500, retract = 400 } # M204 S500.00 (line 6), M204 S500.00 (line 6), M204 T400.00 (line 6)
    shortest_at_feed_s = 0.02    # M205 B20000 (line 7)
    [look_ahead.classic_jerk]
    step_mm_s = { X = 15, Y = 15, Z = 0.4, E = 5 } # M205 X15.00 (line 7), M205 Z0.40 (line 7), M205 E5.00 (line 7)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 12000         # M203 X200.00 (line 2)
    accel_mm_s2 = 2000           # M201 X2000 (line 4)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 12000         # M203 Y200.00 (line 2)
    accel_mm_s2 = 2000           # M201 Y2000 (line 4)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 150           # M203 Z2.50 (line 2)
    accel_mm_s2 = 100            # M201 Z100 (line 4)
    [axes.E]
    kind = "linear"
    rapid_mm_min = 1800          # M203 E30.00 (line 2)
    accel_mm_s2 = 10000          # M201 E10000 (line 4)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

#[test]
fn marlin_configuration() {
    let text = "#define CUSTOM_MACHINE_NAME \"Bed \\\"1\\\"\"\n\
                #define DEFAULT_MAX_FEEDRATE          { 500, 500, 5, 25 } // (mm/s)\n\
                #define DEFAULT_MAX_ACCELERATION { 500, 500, 100, 5000 }\n\
                #define DEFAULT_ACCELERATION          500 // X, Y, Z\n#define DEFAULT_TRAVEL_ACCELERATION 1000\n\
                //#define CLASSIC_JERK\n#if ENABLED(CLASSIC_JERK)\n  #define DEFAULT_XJERK 10.0\n#endif\n\
                #define JUNCTION_DEVIATION_MM 0.08\n#define S_CURVE_ACCELERATION\n\
                #define X_BED_SIZE 235\n#define X_MIN_POS -5\n#define X_MAX_POS (X_BED_SIZE + 10)\n#define X_HOME_DIR -1\n\
                #define HOMING_FEEDRATE_MM_M { (20*60), (20*60), (4*60) }\n\
                #if BOTH(SDSUPPORT, DIRECT_STEPPING)\n  #define BLOCK_BUFFER_SIZE  8\n#else\n  #define BLOCK_BUFFER_SIZE 16\n#endif\n\
                //#define SLOWDOWN\n#define DEFAULT_MINSEGMENTTIME        20000\n#define MIN_CIRCLE_SEGMENTS 72\n";
    assert_snapshot!(fields(text), @r#"
    controller = "marlin"
    [converter]
    [path]
    accel_mm_s2 = { print = 500, travel = 1000 } # DEFAULT_ACCELERATION 500 (line 4), DEFAULT_TRAVEL_ACCELERATION 1000 (line 5)
    shortest_at_feed_s = 0       # SLOWDOWN is off
    [look_ahead]
    blocks = 12                  # BLOCK_BUFFER_SIZE 16 (line 20), the highest
    chords = { per_circle = 72 } # MIN_CIRCLE_SEGMENTS 72 (line 24)
    [look_ahead.junction_deviation]
    deviation_mm = 0.08          # JUNCTION_DEVIATION_MM 0.08 (line 10)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 30000         # DEFAULT_MAX_FEEDRATE { 500, 500, 5, 25 } (line 2)
    reference_mm_min = 1200      # HOMING_FEEDRATE_MM_M { (20*60), (20*60), (4*60) } (line 16)
    reference_mm = -5            # X_MIN_POS -5 (line 13)
    accel_mm_s2 = 500            # DEFAULT_MAX_ACCELERATION { 500, 500, 100, 5000 } (line 3)
    servo_factor_motor = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    servo_factor_regen = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 30000         # DEFAULT_MAX_FEEDRATE { 500, 500, 5, 25 } (line 2)
    reference_mm_min = 1200      # HOMING_FEEDRATE_MM_M { (20*60), (20*60), (4*60) } (line 16)
    accel_mm_s2 = 500            # DEFAULT_MAX_ACCELERATION { 500, 500, 100, 5000 } (line 3)
    servo_factor_motor = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    servo_factor_regen = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 300           # DEFAULT_MAX_FEEDRATE { 500, 500, 5, 25 } (line 2)
    reference_mm_min = 240       # HOMING_FEEDRATE_MM_M { (20*60), (20*60), (4*60) } (line 16)
    accel_mm_s2 = 100            # DEFAULT_MAX_ACCELERATION { 500, 500, 100, 5000 } (line 3)
    servo_factor_motor = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    servo_factor_regen = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    [axes.E]
    kind = "linear"
    rapid_mm_min = 1500          # DEFAULT_MAX_FEEDRATE { 500, 500, 5, 25 } (line 2)
    accel_mm_s2 = 5000           # DEFAULT_MAX_ACCELERATION { 500, 500, 100, 5000 } (line 3)
    servo_factor_motor = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    servo_factor_regen = 1.875   # 15/8 at the middle of its curve: S_CURVE_ACCELERATION (line 11)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

#[test]
fn klipper() {
    let main = file(
        "printer.cfg",
        "[include motion.cfg]\n[include macros/*.cfg]\n[stepper_x]\nrotation_distance: 40\nposition_endstop: 0\n\
         position_max: 235\nhoming_speed: 50\n[stepper_y]\nrotation_distance = 40\nposition_max = 235 # bed\n\
         [stepper_z]\nendstop_pin: probe:z_virtual_endstop\nposition_endstop: 0.5\n[stepper_z1]\n[extruder]\n\
         nozzle_diameter: 0.400\nfilament_diameter: 1.750\nmax_extrude_only_accel: 5000\n\
         [gcode_macro PRINT_START]\ngcode:\n    max_velocity: 1\n    G28\n\
         #*# [printer]\n#*# square_corner_velocity = 8\n",
    );
    let motion = file(
        "motion.cfg",
        "[printer]\nkinematics: cartesian\nmax_velocity: 300\nmax_accel: 3000\nmax_z_velocity: 15\nmax_accel_to_decel: 1500\n",
    );
    let near = Folder(vec![
        motion,
        file("macros/fan.cfg", "[gcode_macro FAN]\ngcode:\n  M106\n"),
    ]);
    let found = import(&[main], Wanted::default(), &near).unwrap();
    assert_eq!(render(&found.warnings), "");
    assert!(
        found
            .toml
            .contains("unknown_macros = [\"FAN\", \"PRINT_START\"]"),
        "{}",
        found.toml
    );
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "klipper"
    [converter]
    [language]
    unknown_macros = ["FAN", "PRINT_START"] # [gcode_macro]
    [look_ahead]
    min_cruise_ratio = 0.5       # max_accel_to_decel: 1500 (line 6)
    [look_ahead.square_corner]
    corner_mm_s = 8              # square_corner_velocity = 8 (line 24)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 18000         # max_velocity: 300 (line 3)
    reference_mm_min = 3000      # homing_speed: 50 (line 7)
    reference_mm = 0             # position_endstop: 0 (line 5)
    accel_mm_s2 = 3000           # max_accel: 3000 (line 4)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 18000         # max_velocity: 300 (line 3)
    reference_mm_min = 300       # homing_speed is 5 by default
    accel_mm_s2 = 3000           # max_accel: 3000 (line 4)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 900           # max_z_velocity: 15 (line 5)
    reference_mm_min = 300       # homing_speed is 5 by default
    accel_mm_s2 = 3000           # as Z has none of its own: max_accel: 3000 (line 4)
    [axes.E]
    kind = "linear"
    rapid_mm_min = 4789.459447   # by default: max_velocity: 300 (line 3) x 0.2661
    accel_mm_s2 = 5000           # max_extrude_only_accel: 5000 (line 18), the highest
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Macros are listed, those in place of words too; names that no program can call are not.
#[test]
fn macros_of_klipper() {
    let names = (1..=9).map(|number| format!("[gcode_macro LONG_NAME_{number}]\ngcode:\n G1 X1\n"));
    let text = format!(
        "[printer]\nkinematics: none\nmax_velocity: 300\nmax_accel: 3000\n[gcode_macro M109]\ngcode:\n\
         [gcode_macro T0]\ngcode:\n G1 X1\n[gcode_macro bad.name]\ngcode:\n{}",
        names.collect::<String>()
    );
    let near = Folder(Vec::new());
    let text = text.replace("kinematics: none", "kinematics: corexy");
    let found = import(&[file("printer.cfg", &text)], Wanted::default(), &near).unwrap();
    let (_, language) = found.toml.split_once("[language]\n").unwrap();
    let (language, _) = language.split_once("\n\n").unwrap();
    assert_snapshot!(language, @r#"
    unknown_macros = [
        "T0", "LONG_NAME_1", "LONG_NAME_2", "LONG_NAME_3", "LONG_NAME_4", "LONG_NAME_5",
        "LONG_NAME_6", "LONG_NAME_7", "LONG_NAME_8", "LONG_NAME_9",
    ] # [gcode_macro]
    "#);
    assert!(found.toml.contains("(M109)"), "{}", found.toml);
    assert!(
        found.toml.contains("\nkinematics = \"corexy\"\n"),
        "{}",
        found.toml
    );
}

#[test]
fn core_kinematics_and_missing_includes() {
    let text =
        "[include gone.cfg]\n[printer]\nkinematics: corexy\nmax_velocity: 300\nmax_accel: 3000\n";
    let found = imported(text);
    assert!(
        found.toml.contains("rotors of both motors, for X as for Y"),
        "{}",
        found.toml
    );
    assert_snapshot!(render(&found.warnings), @r"
    settings:1, warning: `gone.cfg` was not found: nothing of it counts / put it where the line says, or give it as another FILE
      | [include gone.cfg]
      | ^^^^^^^^^^^^^^^^^^
    settings:3, warning: two motors move two axes together: they count by the robust bound / give both axes the larger mass and friction, and the rotors of both motors
      | kinematics: corexy
      |             ^^^^^^
    ");
}

#[test]
fn reprapfirmware() {
    let text = "M550 P\"a; M203 X1\"\nM584 X0 Y1 Z2:5:6 U4 R1 E3\nM669 K0\nM208 X0 Y0 Z-0.2 S1\nM208 X290 Y290 Z600 S0\n\
                M574 X1 Y2 S1\nM566 X1000 Y1000 Z30 E300:200 P1 ; jerk\nM203 X24000 Y24000 Z900 U3600 E3600:7200\n\
                M201 X3000 Y3000 Z20 U500 E1000\nM204 P1500 T2500 M595 P60\n";
    let found = imported(text);
    assert_eq!(found.format, Format::RepRap);
    assert!(
        found.toml.contains("# reference_mm = 290"),
        "{}",
        found.toml
    );
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "reprap"
    [converter]
    [path]
    accel_mm_s2 = { print = 1500, travel = 2500 } # M204 P1500 (line 10), M204 T2500 (line 10)
    [look_ahead]
    blocks = 29                  # M595 P60 (line 10)
    blocks_at_most = 59          # M595 P60 (line 10)
    [look_ahead.speed_step]
    step_mm_s = { X = 16.66666667, Y = 16.66666667, Z = 0.5, E = 5 } # M566 X1000 (line 7), M566 Y1000 (line 7), M566 Z30 (line 7), M566 E300:200 (line 7)
    same_kind_only = false       # M566 P1 (line 7)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 24000         # M203 X24000 (line 8)
    accel_mm_s2 = 3000           # M201 X3000 (line 9)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 24000         # M203 Y24000 (line 8)
    accel_mm_s2 = 3000           # M201 Y3000 (line 9)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 900           # M203 Z900 (line 8)
    accel_mm_s2 = 20             # M201 Z20 (line 9)
    [axes.U]
    kind = "rotary"
    rapid_deg_min = 3600         # M203 U3600 (line 8)
    accel_deg_s2 = 500           # M201 U500 (line 9)
    [axes.E]
    kind = "linear"
    rapid_mm_min = 7200          # M203 E3600:7200 (line 8)
    accel_mm_s2 = 1000           # M201 E1000 (line 9)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}
