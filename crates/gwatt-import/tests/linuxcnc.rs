//! The start-up code, overrides and versions of LinuxCNC's INI files.

use insta::assert_snapshot;

use super::{fields, imported, refused, render};

const MILL: &str = "[KINS]\nKINEMATICS = trivkins\n[TRAJ]\nCOORDINATES = X\n[AXIS_X]\nMAX_VELOCITY = 400\n\
                    MAX_ACCELERATION = 3000\n";

/// The table `[language]`, and what is said.
fn with_code(code: &str) -> String {
    let found = imported(&format!(
        "{MILL}[RS274NGC]\nRS274NGC_STARTUP_CODE = {code}\n"
    ));
    let (_, rest) = found.toml.split_once("\n[language]\n").unwrap_or_default();
    let (table, _) = rest.split_once("\n\n").unwrap_or((rest, ""));
    format!("{table}\n{}", render(&found.warnings))
}

/// 0.5 inch are 12.7 mm, 10 inch/min 254 mm/min. Blanks do not matter, and neither do comments.
#[test]
fn words_of_the_start_up_code() {
    assert_snapshot!(with_code("G20G40G64P0.5"), @r#"
    units = "inch"               # [RS274NGC] RS274NGC_STARTUP_CODE = G20G40G64P0.5 (line 9)
    power_on_tolerance_mm = 12.7 # [RS274NGC] RS274NGC_STARTUP_CODE = G20G40G64P0.5 (line 9)
    "#);
    assert_snapshot!(with_code("(metric) g 21 G17G40G43H0 G54 G64P 0.005 G80 M5 M9 f10 ; G20"), @r"
    power_on_feed_mm_min = 10    # [RS274NGC] RS274NGC_STARTUP_CODE = (metric) g 21 G17G40G43H0 G54 G64P 0.005 G80 M5 M9 f10 (line 9)
    power_on_tolerance_mm = 0.005 # [RS274NGC] RS274NGC_STARTUP_CODE = (metric) g 21 G17G40G43H0 G54 G64P 0.005 G80 M5 M9 f10 (line 9)
    ");
    assert_snapshot!(with_code("F10 G20 G90.1"), @r#"
    units = "inch"               # [RS274NGC] RS274NGC_STARTUP_CODE = F10 G20 G90.1 (line 9)
    arc_centre = "absolute"      # [RS274NGC] RS274NGC_STARTUP_CODE = F10 G20 G90.1 (line 9)
    power_on_feed_mm_min = 254   # [RS274NGC] RS274NGC_STARTUP_CODE = F10 G20 G90.1 (line 9)
    "#);
}

/// F per revolution read as F per minute would be too low.
#[test]
fn feed_and_lengths_of_a_lathe() {
    assert_snapshot!(with_code("G90 G7 G18 G95 G96 D2000 S200"), @r#"
    diameter = true              # [RS274NGC] RS274NGC_STARTUP_CODE = G90 G7 G18 G95 G96 D2000 S200 (line 9)
    feed = "per-revolution"      # [RS274NGC] RS274NGC_STARTUP_CODE = G90 G7 G18 G95 G96 D2000 S200 (line 9)
    settings:9, warning: G96 of the start-up code has no field in a machine file: S counts as revolutions per minute until the program says otherwise, which may be too low / write G96 or G97 at the beginning of each program
      | RS274NGC_STARTUP_CODE = G90 G7 G18 G95 G96 D2000 S200
      |                                        ^^^
    settings:9, warning: `G18` of the start-up code has no field in a machine file, and does not count / write it at the beginning of each program where it changes what the program does
      | RS274NGC_STARTUP_CODE = G90 G7 G18 G95 G96 D2000 S200
      |                                ^^^
    "#);
    assert_snapshot!(refused(&format!("{MILL}[EMC]\nRS274NGC_STARTUP_CODE = G93 G90\n")), @r"
    settings:9, error: G93 of the start-up code has no field in a machine file: F would count too low / put G94 in its place, and write G93 into the programs that need it
      | RS274NGC_STARTUP_CODE = G93 G90
      |                         ^^^
    ");
}

#[test]
fn words_of_the_start_up_code_without_a_field() {
    assert_snapshot!(with_code("G91 M52P1 G61.1 S300 G10L2P0X19.2"), @r"
    settings:9, warning: G91 of the start-up code has no field in a machine file: coordinates count as absolute until the program says otherwise / write G90 or G91 at the beginning of each program
      | RS274NGC_STARTUP_CODE = G91 M52P1 G61.1 S300 G10L2P0X19.2
      |                         ^^^
    settings:9, warning: M52 of the start-up code has no field in a machine file: the pin motion.adaptive-feed multiplies all speeds, and counts as 1 / where it may be above 1, multiply `feed` of `override_max_percent` under [limits] by its largest value
      | RS274NGC_STARTUP_CODE = G91 M52P1 G61.1 S300 G10L2P0X19.2
      |                             ^^^
    settings:9, warning: `G61.1 S300 G10 L2 X19.2` of the start-up code has no field in a machine file, and does not count / write it at the beginning of each program where it changes what the program does
      | RS274NGC_STARTUP_CODE = G91 M52P1 G61.1 S300 G10L2P0X19.2
      |                                   ^^^^^
    ");
    assert_snapshot!(with_code("G21 o<start> call [2]"), @r"
    settings:9, warning: `o<start> call [2]` of the start-up code is not read, and does not count / only letters with numbers are: see what it sets, and write that at the beginning of each program
      | RS274NGC_STARTUP_CODE = G21 o<start> call [2]
      |                             ^^^^^^^^^^^^^^^^^
    ");
}

/// 1.5 is 150 %. Rapids never exceed 100 %.
#[test]
fn overrides_that_the_screen_permits() {
    let limits = |display: &str| {
        let toml = fields(&format!("{MILL}[DISPLAY]\n{display}"));
        let lines = toml.lines().filter(|line| line.starts_with("override"));
        lines.map(str::to_owned).collect::<Vec<_>>().join("\n")
    };
    assert_snapshot!(limits("MAX_FEED_OVERRIDE = 1.5\nMAX_SPINDLE_OVERRIDE = 1.2\nMAX_RAPID_OVERRIDE = 2\n"), @r"override_max_percent = { feed = 150, spindle = 120 } # [DISPLAY] MAX_FEED_OVERRIDE = 1.5 (line 9), [DISPLAY] MAX_SPINDLE_OVERRIDE = 1.2 (line 10)");
    // As the screen Axis has it.
    assert_snapshot!(limits("MAX_FEED_OVERRIDE = 2\n"), @r"override_max_percent = { feed = 200, spindle = 200 } # [DISPLAY] MAX_FEED_OVERRIDE = 2 (line 9)");
    assert_snapshot!(limits("MAX_FEED_OVERRIDE = 0.9\nMAX_SPINDLE_OVERRIDE = 1.0\n"), @"");
    assert_snapshot!(refused(&format!("{MILL}[DISPLAY]\nMAX_FEED_OVERRIDE = 150 %\n")), @r"
    settings:9, error: `150 %` is not a number / write the number that the control has, without a unit
      | MAX_FEED_OVERRIDE = 150 %
      |                     ^^^^^
    ");
}

/// 20 mm/s are 1200 mm/min, 30 mm/s 1800, 400 mm/s 24000.
#[test]
fn which_largest_speed_of_the_path_counts() {
    let of = |axes: &str, traj: &str| {
        let own = format!("[{axes}]\nMAX_VELOCITY = 400\nMAX_ACCELERATION = 3000\n");
        let found = imported(&format!(
            "[KINS]\nKINEMATICS = trivkins\n{own}[TRAJ]\nCOORDINATES = X\n{traj}"
        ));
        let lines = found.toml.lines();
        let rapid = lines
            .filter(|line| line.starts_with("rapid"))
            .collect::<String>();
        format!("{rapid}\n{}", render(&found.warnings))
    };
    assert_snapshot!(of("AXIS_X", "MAX_VELOCITY = 20\n"), @r"
    rapid_mm_min = 24000         # [AXIS_X] MAX_VELOCITY = 400 (line 4)
    settings:8, warning: MAX_VELOCITY of [TRAJ] does not count: LinuxCNC 2.8 and later do not read it / where the path has a limit, write MAX_LINEAR_VELOCITY
      | MAX_VELOCITY = 20
      |                ^^
    ");
    assert_snapshot!(of("AXIS_X", "MAX_VELOCITY = 20\nMAX_LINEAR_VELOCITY = 30\n"), @r"rapid_mm_min = 1800          # [TRAJ] MAX_LINEAR_VELOCITY = 30 (line 9), below [AXIS_X] MAX_VELOCITY = 400 (line 4)");
    assert_snapshot!(of("AXIS_0", "MAX_VELOCITY = 20\n"), @r"rapid_mm_min = 1200          # [TRAJ] MAX_VELOCITY = 20 (line 8), below [AXIS_0] MAX_VELOCITY = 400 (line 4)");
    assert_snapshot!(of("AXIS_0", "MAX_LINEAR_VELOCITY = 20\n"), @r"
    rapid_mm_min = 24000         # [AXIS_0] MAX_VELOCITY = 400 (line 4)
    settings:8, warning: MAX_LINEAR_VELOCITY of [TRAJ] does not count: LinuxCNC before 2.8 does not read it / where the path has a limit, write MAX_VELOCITY
      | MAX_LINEAR_VELOCITY = 20
      |                       ^^
    ");
    // A new file with sections of both kinds.
    assert_snapshot!(of("EMC]\nVERSION = 1.1\n[AXIS_0", "MAX_VELOCITY = 20\nMAX_LINEAR_VELOCITY = 30\n"), @r"rapid_mm_min = 1800          # [TRAJ] MAX_LINEAR_VELOCITY = 30 (line 11), below [AXIS_0] MAX_VELOCITY = 400 (line 6)");
    // Either may hold.
    assert_snapshot!(of("JOINT_0]\nHOME = 0\n[AXIS_0", "MAX_VELOCITY = 20\n"), @r"
    rapid_mm_min = 24000         # [AXIS_0] MAX_VELOCITY = 400 (line 6)
    settings:10, warning: MAX_VELOCITY of [TRAJ] does not count: some versions of LinuxCNC do not read it / where the path has a limit, write both MAX_LINEAR_VELOCITY and MAX_VELOCITY
      | MAX_VELOCITY = 20
      |                ^^
    ");
    assert_snapshot!(of("JOINT_0]\nHOME = 0\n[AXIS_0", "MAX_VELOCITY = 20\nMAX_LINEAR_VELOCITY = 30\n"), @r"rapid_mm_min = 1800          # [TRAJ] MAX_LINEAR_VELOCITY = 30 (line 11), the highest, below [AXIS_0] MAX_VELOCITY = 400 (line 6)");
}

/// LinuxCNC takes the first of several: 25 mm/s are 1500 mm/min.
#[test]
fn the_first_of_several_values_counts() {
    let toml = fields(
        "[KINS]\nKINEMATICS = trivkins\n[TRAJ]\nCOORDINATES = X\nMAX_LINEAR_VELOCITY = 25\nMAX_LINEAR_VELOCITY = 8\n\
         [AXIS_X]\nMAX_VELOCITY = 400\nMAX_ACCELERATION = 3000\n[AXIS_X]\nMAX_ACCELERATION = 30\n",
    );
    assert!(toml.contains("rapid_mm_min = 1500 "), "{toml}");
    assert!(toml.contains("accel_mm_s2 = 3000 "), "{toml}");
}
