//! What each kind of settings becomes: values in force, each with its source.

use gwatt_import::{Format, Nothing, Wanted, import};
use insta::assert_snapshot;

use super::{Folder, fields, file, imported, in_force, render};

#[test]
fn grbl() {
    let text = "< $$\n$11=0.020 (junction deviation, mm)\n$12=0.002\n$22=1\n$23=1\n$25=1500.000\n$27=2.000\n\
                $30=24000\n$100=80.000\n$110=8000.000\n$111=7000.000\n$112=500.000\n$113=3600.000\n\
                $120=400.000\n$121=300.000\n$122=50.000\n$123=720.000\n$130=740.000\nok\n";
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
    blocks = 31                  # planner_blocks: 32 (line 2)
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
    blocks = 15                  # BLOCK_BUFFER_SIZE 16 (line 20), the highest
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
        found.toml.contains("Macros (FAN, PRINT_START)"),
        "{}",
        found.toml
    );
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "klipper"
    [converter]
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
    settings:3, warning: two motors move two axes together: gwatt counts by axis / give both axes the larger mass and the rotors of both motors; see the head of the file
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
    blocks = 59                  # M595 P60 (line 10)
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

/// 36000 mm/min in 100 ms: 6000 mm/s²; cutting 12000 mm/min in 32 ms: 6250 mm/s².
#[test]
fn fanuc() {
    let text = "%\nN00000Q1P00000000\nN01006Q1A1P00000000A2P00000000A3P00000000A4P00000001\n\
                N01020Q1A1P88A2P89A3P90A4P66\nN01240Q1A1P-1500A2P0A3P0A4P0\nN01401Q1L1P00000010\nN01420Q1A1P36000A2P36000A3P30000A4P9000\n\
                N01422Q1L1P12000\nN01430Q1A1P0A2P0A3P0A4P0\nN01620Q1A1P100A2P100A3P120A4P100\n\
                N01622Q1A1P32A2P64A3P64A4P3000\nN01783Q1A1P500A2P0A3P0A4P0\nN03401Q1L1P00000000\nN03741Q1S1P8000\n\
                N10000Q0A1P99\n%\n"
        .replace('\n', "\n\r\r");
    let found = imported(&text);
    assert_eq!(found.format, Format::Fanuc);
    assert_snapshot!(render(&found.warnings), @r"
    settings:12, warning: parameter 1783, steps of speed at corners, is not taken over / the robust bound holds for whatever it makes of speeds below the limits of the axes
      | N01783Q1A1P500A2P0A3P0A4P0
      |            ^^^
    ");
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "fanuc"
    [converter]
    [path]
    rapid = "linear"             # bit LRP of N01401 L1 P00000010 (line 6)
    max_feed_mm_min = 12000      # N01422 L1 P12000 (line 8)
    [language]
    decimal_point = "least-increment" # bit DPI of N03401 L1 P00000000 (line 13)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 36000         # N01420 A1 P36000 (line 7)
    reference_mm = -1.5          # N01240 A1 P-1500 (line 5)
    accel_mm_s2 = 6250           # 12000/min in 32 ms: N01622 A1 P32 (line 11), the highest
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 36000         # N01420 A2 P36000 (line 7)
    reference_mm = 0             # N01240 A2 P0 (line 5)
    accel_mm_s2 = 6000           # 36000/min in 100 ms: N01620 A2 P100 (line 10), the highest
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 30000         # N01420 A3 P30000 (line 7)
    reference_mm = 0             # N01240 A3 P0 (line 5)
    accel_mm_s2 = 4166.666667    # 30000/min in 120 ms: N01620 A3 P120 (line 10), the highest
    [axes.B]
    kind = "rotary"
    rapid_deg_min = 12000        # cutting may be faster than rapids: N01422 L1 P12000 (line 8)
    reference_deg = 0            # N01240 A4 P0 (line 5)
    accel_deg_s2 = 2000          # 12000/min in 100 ms: N01620 A4 P100 (line 10), the highest
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Real numbers of the 30i on an inch machine: 1000 inch/min are 25400 mm/min; whole numbers
/// of a 0i count tenths: 10000 are the same.
#[test]
fn fanuc_in_inches() {
    let real = "N01001 P00000001\nN01020 A1 P88 A2 P90\nN01420 A1 P1000.0 A2 P1000.0\nN01660 A1 P100.0 A2 P0.0\nN01620 A1 P0 A2 P200\n";
    assert_snapshot!(fields(real), @r#"
    controller = "fanuc-lathe"
    [converter]
    [axes.X]
    kind = "linear"
    rapid_mm_min = 25400         # N01420 A1 P1000.0 (line 3)
    accel_mm_s2 = 2540           # N01660 A1 P100.0 (line 4)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 25400         # N01420 A2 P1000.0 (line 3)
    accel_mm_s2 = 2116.666667    # 25400/min in 200 ms: N01620 A2 P200 (line 5)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
    let whole =
        fields("N01001P00000001\nN01020A1P88A2P90\nN01420A1P10000A2P10000\nN01620A1P100A2P200\n");
    assert!(whole.contains("rapid_mm_min = 25400 "), "{whole}");
}

#[test]
fn sinumerik() {
    let text = "CHANDATA(1)\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"X1\" '5a7e\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[1]=\"SP1\"\n\
                N10000 $MN_AXCONF_MACHAX_NAME_TAB[2]=\"C1\"\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[3]=\"ATC\"\nN20730 $MC_G0_LINEAR_MODE=0\n\
                N30300 $MA_IS_ROT_AX[AX3]=1\nN35000 $MA_SPIND_ASSIGN_TO_MACHAX[AX2]=1\nN35100 $MA_SPIND_VELO_LIMIT[AX2]=12000\n\
                N32000 $MA_MAX_AX_VELO[AX1]=30000 ; mm/min\nN32000 $MA_MAX_AX_VELO[AX2]=12000\nN32000 $MA_MAX_AX_VELO[AX3]=50\n\
                N32000 $MA_MAX_AX_VELO[ATC]=50\n\
                N32300 $MA_MAX_AX_ACCEL[0,AX1]=4 '1f\nN32300 $MA_MAX_AX_ACCEL[1,AX1]=5\nN32300 $MA_MAX_AX_ACCEL[2,AX1]=3\n\
                N32300 $MA_MAX_AX_ACCEL[3,AX1]=2.5\nN32300 $MA_MAX_AX_ACCEL[4,AX1]=2\nN32300 $MA_MAX_AX_ACCEL[0,AX3]=3\n\
                N32310 $MA_MAX_ACCEL_OVL_FACTOR[0,AX1]=1.2\nN32431 $MA_MAX_AX_JERK[0,AX1]=50\n\
                N34070 $MA_REFP_VELO_POS[AX1]=10000\nN34100 $MA_REFP_SET_POS[0,AX1]=-3\nN42110 $SC_DEFAULT_FEED=2000\n";
    let found = imported(text);
    assert!(
        found.toml.contains("# jerk_mm_s3 = 50000"),
        "{}",
        found.toml
    );
    assert!(found.toml.contains("# max_rpm = 12000"), "{}", found.toml);
    assert_snapshot!(render(&found.warnings), @r"
    settings:0, warning: axes without a letter of their own are left out: ATC / what moves with other axes (gantries) belongs to the masses of those
    settings:20, warning: MAX_ACCEL_OVL_FACTOR, steps of speed at corners, is not taken over / the robust bound holds for whatever it makes of speeds below the limits of the axes
      | N32310 $MA_MAX_ACCEL_OVL_FACTOR[0,AX1]=1.2
      |                                        ^^^
    ");
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "siemens"
    [converter]
    [path]
    rapid = "independent"        # N20730 $MC_G0_LINEAR_MODE=0 (line 6)
    [language]
    power_on_feed_mm_min = 2000  # N42110 $SC_DEFAULT_FEED=2000 (line 24)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 30000         # N32000 $MA_MAX_AX_VELO[AX1]=30000 (line 10)
    reference_mm_min = 10000     # N34070 $MA_REFP_VELO_POS[AX1]=10000 (line 22)
    reference_mm = -3            # N34100 $MA_REFP_SET_POS[0,AX1]=-3 (line 23)
    accel_mm_s2 = 5000           # N32300 $MA_MAX_AX_ACCEL[1,AX1]=5 (line 15), the highest
    [axes.C]
    kind = "rotary"
    rapid_deg_min = 18000        # N32000 $MA_MAX_AX_VELO[AX3]=50 (line 12)
    accel_deg_s2 = 1080          # N32300 $MA_MAX_AX_ACCEL[0,AX3]=3 (line 19)
    [[levels]]
    acts_on = "all"
    level = [
        { word = "DYNNORM", power_on = true, accel_mm_s2 = { X = 4000 } },
        { word = "DYNPOS", accel_mm_s2 = { X = 5000 } },
        { word = "DYNROUGH", accel_mm_s2 = { X = 3000 } },
        { word = "DYNSEMIFIN", accel_mm_s2 = { X = 2500 } },
        { word = "DYNFINISH", accel_mm_s2 = { X = 2000 } },
    ]
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Inches: 6 inch/s are 9144 mm/min, 20 inch/s² are 508 mm/s².
#[test]
fn linuxcnc() {
    let ini = file(
        "mill.ini",
        "[EMC]\nMACHINE = Mill\n[KINS]\nKINEMATICS = trivkins coordinates=XYYA\n[TRAJ]\nLINEAR_UNITS = inch\n\
         MAX_LINEAR_VELOCITY = 5\nMAX_ANGULAR_VELOCITY = 150\nARC_BLEND_OPTIMIZATION_DEPTH = 80\n[RS274NGC]\nRS274NGC_STARTUP_CODE = G20 G64 P0.001 G90\n\
         [EMCMOT]\nSERVO_PERIOD = 500000 # ns\n[HAL]\nHALFILE = main.hal\nHALFILE = LIB:basic_sim.tcl\n\
         [AXIS_X]\nMAX_VELOCITY = 6\nMAX_ACCELERATION = 20\nMIN_LIMIT = -10\nMAX_LIMIT = 10\n[JOINT_0]\nHOME = 1\nSCALE = 16000\n\
         [AXIS_Y]\nMAX_VELOCITY = 4\nMAX_ACCELERATION = 20\n[AXIS_A]\nMAX_VELOCITY = 60\nMAX_ACCELERATION = 360\n[JOINT_3]\nTYPE = ANGULAR\n",
    );
    let hal = file(
        "main.hal",
        "setp stepgen.1.maxaccel 25\nsetp stepgen.0.position-scale [JOINT_0]SCALE\nsetp hm2_7i96s.0.stepgen.02.maxvel 5\n",
    );
    let found = import(&[ini], Wanted::default(), &Folder(vec![hal])).unwrap();
    assert!(
        found.toml.contains("rotors of all 2 motors together"),
        "{}",
        found.toml
    );
    assert!(
        found.toml.contains("second squared: 25 (main.hal line 1)"),
        "{}",
        found.toml
    );
    assert!(
        found.toml.contains("per second: 5 (main.hal line 3)"),
        "{}",
        found.toml
    );
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "linuxcnc"
    [converter]
    [path]
    max_feed_mm_min = 9000       # [TRAJ] MAX_ANGULAR_VELOCITY = 150 (line 8), the highest
    [language]
    units = "inch"               # [RS274NGC] RS274NGC_STARTUP_CODE = G20 G64 P0.001 G90 (line 11)
    power_on_tolerance_mm = 0.0254 # [RS274NGC] RS274NGC_STARTUP_CODE = G20 G64 P0.001 G90 (line 11)
    [look_ahead]
    blocks = 80                  # [TRAJ] ARC_BLEND_OPTIMIZATION_DEPTH = 80 (line 9)
    [look_ahead.linuxcnc]
    servo_period_s = 0.0005      # [EMCMOT] SERVO_PERIOD = 500000 (line 13)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 7620          # [TRAJ] MAX_LINEAR_VELOCITY = 5 (line 7), below [AXIS_X] MAX_VELOCITY = 6 (line 18)
    accel_mm_s2 = 508            # [AXIS_X] MAX_ACCELERATION = 20 (line 19)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 6096          # [AXIS_Y] MAX_VELOCITY = 4 (line 26)
    accel_mm_s2 = 508            # [AXIS_Y] MAX_ACCELERATION = 20 (line 27)
    [axes.A]
    kind = "rotary"
    rapid_deg_min = 3600         # [AXIS_A] MAX_VELOCITY = 60 (line 29)
    accel_deg_s2 = 360           # [AXIS_A] MAX_ACCELERATION = 360 (line 30)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

/// Before 2.8 axes have numbers.
#[test]
fn linuxcnc_of_old() {
    let text = "[TRAJ]\nCOORDINATES = X Z\nLINEAR_UNITS = mm\nMAX_VELOCITY = 100\nMAX_LINEAR_VELOCITY = 5\n[AXIS_0]\nTYPE = LINEAR\n\
                MAX_VELOCITY = 50\nMAX_ACCELERATION = 500\n[AXIS_2]\nMAX_VELOCITY = 20\nMAX_ACCELERATION = 200\n";
    assert_snapshot!(fields(text), @r#"
    controller = "linuxcnc"
    [converter]
    [path]
    max_feed_mm_min = 6000       # [TRAJ] MAX_VELOCITY = 100 (line 4), the highest
    [axes.X]
    kind = "linear"
    rapid_mm_min = 3000          # [AXIS_0] MAX_VELOCITY = 50 (line 8)
    accel_mm_s2 = 500            # [AXIS_0] MAX_ACCELERATION = 500 (line 9)
    [axes.Z]
    kind = "linear"
    rapid_mm_min = 1200          # [AXIS_2] MAX_VELOCITY = 20 (line 11)
    accel_mm_s2 = 200            # [AXIS_2] MAX_ACCELERATION = 200 (line 12)
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

#[test]
fn the_profile_may_be_another() {
    let wanted = Wanted {
        format: Some(Format::Fanuc),
        controller: Some("haas"),
    };
    let text = "N01420A1P1000A2P1000\nN01620A1P100A2P100\n";
    let found = import(&[file("p.txt", text)], wanted, &Nothing).unwrap();
    assert!(
        found.toml.contains("controller = \"haas\""),
        "{}",
        found.toml
    );
}
