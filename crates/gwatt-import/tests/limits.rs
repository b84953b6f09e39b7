//! Limits and places: which of several counts, and in which unit.

use gwatt_import::{Format, Wanted, import};
use insta::assert_snapshot;

use super::{Folder, fields, file, imported, in_force, refused, render};

/// M203 S1: 100 mm/s are 6000 mm/min.
#[test]
fn speeds_in_mm_per_second() {
    let toml = fields("M203 S1 X100 Y100\nM201 X500 Y500\nM566 X600 Y600\n");
    assert!(toml.contains("rapid_mm_min = 6000"), "{toml}");
    let toml = fields("M203 S0 X100 Y100\nM201 X500 Y500\nM566 X600 Y600\n");
    assert!(toml.contains("rapid_mm_min = 100 "), "{toml}");
}

/// 20 in/s² are 508 mm/s²; newer versions take 20 mm/s².
#[test]
fn limits_of_reprapfirmware_after_g20() {
    let found = imported("G20\nM201 X20 Y20\nG21\nM203 X600 Y600\nM566 X60 Y60\n");
    assert!(found.toml.contains("accel_mm_s2 = 508"), "{}", found.toml);
    assert_snapshot!(render(&found.warnings), @r"
    settings:2, warning: M201 after G20: some versions take it in inches, others in mm; inches count / write it in mm after G21, and import again
      | M201 X20 Y20
      | ^^^^^^^^^^^^
    ");
}

/// 400 · 60 = 24000; what names a variable is none.
#[test]
fn expressions_of_numbers() {
    let toml =
        fields("M203 X{400 * 60} Y{100*60}:{200 * 60}\nM201 X{3000} Y3000\nM566 X{10*60} Y600\n");
    assert!(toml.contains("rapid_mm_min = 24000"), "{toml}");
    assert!(toml.contains("rapid_mm_min = 12000"), "{toml}");
    assert!(toml.contains("accel_mm_s2 = 3000"), "{toml}");
    assert_snapshot!(refused("M203 X{0 - 5}\nM201 X{var.a*2}\nM566 X1\n"), @r"
    settings:1, error: -5 is not valid for M203 of X / a value above 0 is needed: look at the control
      | M203 X{0 - 5}
      |       ^^^^^^^
    settings:2, error: `{var.a*2}` is not a number / write the number that the control has, without a unit
      | M201 X{var.a*2}
      |       ^^^^^^^^^
    ");
}

#[test]
fn a_configuration_that_only_calls_others() {
    let near = Folder(vec![file("drives.g", "M203 X6000\nM201 X500\n")]);
    let main = file("config.g", "; main\nM98 P\"/sys/drives.g\"\n");
    let found = import(&[main], Wanted::default(), &near).unwrap();
    assert_eq!(found.format, Format::RepRap);
    assert!(found.toml.contains("rapid_mm_min = 6000"), "{}", found.toml);
}

const MARLIN: &str = "#define DEFAULT_MAX_FEEDRATE { 300, 300, 5, 25 } /* was 500 */\n\
                      #define DEFAULT_MAX_ACCELERATION { 3000, 3000, 100, 10000 }\n";

#[test]
fn comments_over_several_lines() {
    let text = format!(
        "#define HOST \"http://*/*\"\n/*\n#define DEFAULT_MAX_FEEDRATE {{ 900, 900, 50, 250 }}\n*/ {MARLIN}\
         /* 1 */ /* 2 \n//#define DEFAULT_ACCELERATION 200*/\n#define DEFAULT_ACCELERATION 1500 /* from\n\
         #define DEFAULT_TRAVEL_ACCELERATION 9000 */\n//#define X_HOME_DIR 1 /*\n\
         #define X_HOME_DIR -1\n#define X_MIN_POS -8\n"
    );
    let toml = fields(&text);
    assert!(toml.contains("rapid_mm_min = 18000"), "{toml}");
    assert!(toml.contains("accel_mm_s2 = { print = 1500 }"), "{toml}");
    assert!(toml.contains("reference_mm = -8"), "{toml}");
}

/// Where homing ends: of two places neither is the safe one.
#[test]
fn places_that_depend_on_a_branch() {
    let place = |more: &str| {
        let toml = imported(&format!("{MARLIN}{more}")).toml;
        let lines = toml.lines().filter(|line| line.contains("reference_mm ="));
        lines.map(str::to_owned).collect::<Vec<_>>().join("\n")
    };
    let two =
        "#define X_HOME_DIR -1\n#if A\n#define X_MIN_POS 0\n#else\n#define X_MIN_POS -8\n#endif\n";
    assert_snapshot!(place(two), @r"# reference_mm = 0           # X_MIN_POS depends on `#if`: put what holds in its place");
    let size = "#define X_HOME_DIR 1\n#if A\n#define SIZE 200\n#else\n#define SIZE 300\n#endif\n#define X_MAX_POS SIZE\n";
    assert_snapshot!(place(size), @r"# reference_mm = 300         # X_MAX_POS depends on `#if`: put what holds in its place");
    let way = "#if A\n#define X_HOME_DIR 1\n#else\n#define X_HOME_DIR -1\n#endif\n#define X_MAX_POS 200\n#define X_MIN_POS 0\n";
    assert_snapshot!(place(way), @r"# reference_mm = 200         # X_MAX_POS depends on `#if`: put what holds in its place");
    let manual =
        "#define X_HOME_DIR -1\n#define X_MIN_POS 0\n#if A\n#define MANUAL_X_HOME_POS 5\n#endif\n";
    assert_snapshot!(place(manual), @r"# reference_mm = 5           # MANUAL_X_HOME_POS depends on `#if`: put what holds in its place");
    // The same twice is one.
    let same = "#ifndef H\n#define H\n#define X_HOME_DIR -1\n#define X_MIN_POS 0\n#define X_MIN_POS 0\n#endif\n";
    assert_snapshot!(place(same), @r"reference_mm = 0             # X_MIN_POS 0 (line 6)");
}

/// The slower of two homing speeds is no safe choice.
#[test]
fn the_highest_homing_speed_counts() {
    let toml = fields(&format!(
        "{MARLIN}#if A\n#define HOMING_FEEDRATE_MM_M {{ 1200, 1200, 240 }}\n#else\n#define HOMING_FEEDRATE_MM_M {{ 3000, 1000, 240 }}\n#endif\n"
    ));
    assert!(toml.contains("reference_mm_min = 3000"), "{toml}");
    assert!(toml.contains("reference_mm_min = 1200"), "{toml}");
}

/// 600 mm/s are 36000 mm/min.
#[test]
fn limits_that_klipper_sets_by_itself() {
    let text = "[printer]\nkinematics: cartesian\nmax_velocity: 300\nmax_accel: 3000\n[delayed_gcode start]\n\
                initial_duration: 1\ngcode:\n  SET_VELOCITY_LIMIT ACCEL=20000 VELOCITY=600\n  M204 S{accel} ; own\n\
                [gcode_macro FAST]\ngcode:\n  SET_VELOCITY_LIMIT ACCEL=50000\n";
    let found = imported(text);
    assert!(
        found.toml.contains("rapid_mm_min = 36000"),
        "{}",
        found.toml
    );
    assert!(found.toml.contains("accel_mm_s2 = 20000"), "{}", found.toml);
    assert!(
        found.toml.contains("([delayed_gcode] START)"),
        "{}",
        found.toml
    );
    assert_snapshot!(render(&found.warnings), @r"
    settings:9, warning: `S{accel}` runs by itself and sets a limit that is not taken over / compare it with max_velocity and max_accel, and put the highest into the machine file
      |   M204 S{accel} ; own
      |        ^^^^^^^^
    ");
}

/// The largest feed of three axes, 10000 mm/min each: √3 · 10000 together. The fourth is none.
#[test]
fn axes_of_fanuc_that_are_not_there() {
    let text = "N01006Q1A1P00000000A2P00000000A3P00000000A4P00000000\nN01020Q1A1P88A2P89A3P90A4P0\n\
                N01420Q1A1P24000.0A2P24000.0A3P24000.0A4P0.0\nN01430Q1A1P10000.0A2P10000.0A3P10000.0A4P0.0\n\
                N01620Q1A1P170A2P170A3P170A4P0\n";
    let found = imported(text);
    assert_eq!(render(&found.warnings), "");
    assert!(
        found.toml.contains("max_feed_mm_min = 17320.50808"),
        "{}",
        found.toml
    );
}

#[test]
fn the_highest_is_said_once() {
    let text = "[TRAJ]\nMAX_VELOCITY = 25\nMAX_LINEAR_VELOCITY = 20\nMAX_ANGULAR_VELOCITY = 10\nCOORDINATES = X A\n\
                [KINS]\nKINEMATICS = trivkins\n[AXIS_X]\nMAX_VELOCITY = 30\nMAX_ACCELERATION = 100\n[AXIS_A]\nMAX_VELOCITY = 9\n";
    let toml = fields(text);
    assert!(
        toml.contains("the highest") && !toml.contains("the highest, the highest"),
        "{toml}"
    );
}

/// 24000 is the highest of three; the block ends where a line is indented as its `if` is, and a
/// file that it calls is part of it.
#[test]
fn limits_of_reprapfirmware_in_blocks_that_may_not_run() {
    let own = "M203 X6000 Y24000\nM201 X500 Y5000\nM566 X600 Y600\nM204 P2000 T3000\n\
               if {sensors.gpIn[0].value == 1}\n  M203 Y6000\n\n  M201 Y300\n  if true\n    M566 Y300\n  else\n\
               \t; slow\n    M98 P\"slow.g\"\nM201 X400\n";
    let near = Folder(vec![file("slow.g", "M204 P1000 T5000\nG21\n")]);
    let found = import(&[file("config.g", own)], Wanted::default(), &near).unwrap();
    assert_snapshot!(in_force(&found.toml), @r#"
    controller = "reprap"
    [converter]
    [path]
    accel_mm_s2 = { print = 2000, travel = 5000 } # M204 P2000 (line 4), the highest, M204 T5000 (line 1), the highest
    [look_ahead.speed_step]
    step_mm_s = { X = 10, Y = 10 } # M566 X600 (line 3), M566 Y600 (line 3), the highest
    [axes.X]
    kind = "linear"
    rapid_mm_min = 6000          # M203 X6000 (line 1)
    accel_mm_s2 = 400            # M201 X400 (line 14)
    [axes.Y]
    kind = "linear"
    rapid_mm_min = 24000         # M203 Y24000 (line 1), the highest
    accel_mm_s2 = 5000           # M201 Y5000 (line 2), the highest
    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
    assert_snapshot!(render(&found.warnings), @r"
    config.g:6, warning: M203 in a block that may not run: the highest of all values counts / where that is too high, import a copy of the file without the blocks that do not run
      |   M203 Y6000
      |   ^^^^^^^^^^
    config.g:8, warning: M201 in a block that may not run: the highest of all values counts / where that is too high, import a copy of the file without the blocks that do not run
      |   M201 Y300
      |   ^^^^^^^^^
    config.g:10, warning: M566 in a block that may not run: the highest of all values counts / where that is too high, import a copy of the file without the blocks that do not run
      |     M566 Y300
      |     ^^^^^^^^^
    slow.g:1, warning: M204 in a block that may not run: the highest of all values counts / where that is too high, import a copy of the file without the blocks that do not run
      | M204 P1000 T5000
      | ^^^^^^^^^^^^^^^^
    ");
}

/// Of a queue the last counts: half of 60 less one, and 59.
#[test]
fn a_queue_that_is_set_twice() {
    let toml = fields("M595 P40\nM595 P60\nM203 X6000\nM201 X500\nM566 X600\n");
    assert!(toml.contains("blocks = 29 "), "{toml}");
    assert!(toml.contains("blocks_at_most = 59 "), "{toml}");
    assert!(!toml.contains("39"), "{toml}");
}
