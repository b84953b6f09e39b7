//! Commands of the configuration that programs run without knowing: macros in place of words,
//! what homing and tool changes move besides, remaps.

use gwatt_import::Format;
use insta::assert_snapshot;

use super::{imported, render};

/// The table `[language]` of a machine file.
fn language(toml: &str) -> String {
    let (_, rest) = toml.split_once("\n[language]\n").unwrap_or_default();
    let (table, _) = rest.split_once("\n\n").unwrap_or((rest, ""));
    table.to_owned()
}

const PRINTER: &str = "[printer]\nkinematics: cartesian\nmax_velocity: 300\nmax_accel: 3000\n\
                       [stepper_x]\nposition_endstop: 0\nhoming_speed: 50\n";

/// What is read from the body decides.
#[test]
fn macros_in_place_of_words() {
    let text = format!(
        "{PRINTER}[gcode_macro T0]\ngcode:\n  G1 X0 Y0 F18000\n  ACTIVATE_EXTRUDER EXTRUDER=extruder\n\
         [gcode_macro t1]\ngcode:\n  SET_GCODE_VARIABLE MACRO=T0 VARIABLE=on VALUE=1\n\
         [gcode_macro M900]\ngcode: # none\n  {{% set k = params.K|default(0)|float %}}\n  SET_PRESSURE_ADVANCE ADVANCE={{k}}\n\
         [gcode_macro M73]\nrename_existing: M73.1\ngcode:\n  M73.1 {{rawparams}} ; as it was\n  {{action_respond_info(\"73\")}}\n\
         [gcode_macro M600]\ngcode:\n    G4 P100\n\n    M117 change\n\
         [gcode_macro M106]\nrename_existing: M106.1\ngcode:\n  {{% if params.S %}}M106.1 S{{params.S}}{{% else %}}M106.1{{% endif %}}\n\
         [gcode_macro M109]\nrename_existing: M99109\ngcode:\n  M104 S{{params.S}}\n  TEMPERATURE_WAIT SENSOR=extruder\n\
         [gcode_macro M190]\nrename_existing: M99190\ngcode:\n  M99190 S60\n  M104 S150\n\
         [gcode_macro G28]\nrename_existing: G28.1\ngcode:\n  {{% if not printer.idle %}}\n  G28.1 {{rawparams}}\n  {{% endif %}}\n\
         [gcode_macro G29]\ngcode:\n  BED_MESH_CALIBRATE\n\
         [gcode_macro M701]\ngcode:\n  {{renderer}} X1\n\
         [gcode_macro M702]\ngcode:\n  {{% for i in [1] %\n  RESPOND MSG=a\n"
    );
    let found = imported(&text);
    assert_snapshot!(language(&found.toml), @r#"
    unknown_macros = ["T0", "M900", "M190", "M701", "M702"] # [gcode_macro]
    unknown_moves = ["M600", "G28", "G29"] # [gcode_macro] that leave feed and modes as they are
    ignored_macros = ["T1", "M73"] # [gcode_macro] that move nothing and set nothing
    "#);
    assert!(found.toml.contains("(M106, M109)"), "{}", found.toml);
}

/// A macro does what those do that it calls, in any order, in circles too.
#[test]
fn macros_that_call_macros() {
    let text = format!(
        "{PRINTER}[gcode_macro ONE]\ngcode:\n  TWO\n[gcode_macro TWO]\ngcode:\n  THREE\n  ONE\n\
         [gcode_macro THREE]\ngcode:\n  G0 X1\n[gcode_macro LIGHT]\ngcode:\n  SET_PIN PIN=light VALUE=1\n  LIGHT\n\
         [gcode_macro NONE]\nvariable_a: 1\n[gcode_macro TIMELAPSE_TAKE_FRAME]\ngcode:\n  G0 X1\n\
         [gcode_macro G28_FAST]\ngcode:\n  G28X0\n[gcode_macro M620.11]\ngcode:\n  G1 E1\n"
    );
    let found = imported(&text);
    assert_snapshot!(language(&found.toml), @r#"
    unknown_macros = ["ONE", "TWO", "THREE", "NONE", "M620.11"] # [gcode_macro]
    unknown_moves = ["G28_FAST"] # [gcode_macro] that leave feed and modes as they are
    ignored_macros = ["LIGHT"]   # [gcode_macro] that move nothing and set nothing
    "#);
    assert!(found.toml.contains("Where parking is on"), "{}", found.toml);
}

/// 300 mm/s are 18000 mm/min, 7 mm/s 420.
#[test]
fn homing_over_a_safe_place() {
    let own = "[safe_z_home]\nhome_xy_position: 117, 117\nspeed: 300\nz_hop: 10\nz_hop_speed: 7\n";
    let found = imported(&format!("{PRINTER}{own}"));
    assert_snapshot!(language(&found.toml), @r#"home_moves = [["Z"], ["X", "Y"]] # [safe_z_home]"#);
    let speeds = |toml: &str| {
        let lines = toml
            .lines()
            .filter(|line| line.starts_with("reference_mm_min"));
        lines.collect::<Vec<_>>().join("\n")
    };
    assert_snapshot!(speeds(&found.toml), @r"
    reference_mm_min = 18000     # [safe_z_home] speed: 300 (line 10), the highest
    reference_mm_min = 18000     # [safe_z_home] speed: 300 (line 10), the highest
    reference_mm_min = 420       # [safe_z_home] z_hop_speed: 7 (line 12), the highest
    ");
    let bare = imported(&format!("{PRINTER}[safe_z_home]\nhome_xy_position: 1, 1\n"));
    assert_snapshot!(language(&bare.toml), @r#"home_moves = [["X", "Y"]]    # [safe_z_home]"#);
    assert_snapshot!(speeds(&bare.toml), @r"
    reference_mm_min = 3000      # homing_speed: 50 (line 7)
    reference_mm_min = 3000      # speed of [safe_z_home] is 50 by default, the highest
    reference_mm_min = 300       # homing_speed is 5 by default
    ");
    assert_eq!(render(&bare.warnings), "");
}

#[test]
fn homing_by_commands_of_the_machine() {
    let own = |body: &str| {
        let text = format!("{PRINTER}[homing_override]\naxes: z\ngcode:\n{body}");
        let found = imported(&text);
        format!("{}\n{}", language(&found.toml), render(&found.warnings))
    };
    assert_snapshot!(own("  G90\n  G1 X100 F18000\n  G28 Z\n"), @r#"
    unknown_macros = ["G28"]     # [homing_override]
    settings:8, warning: commands in place of G28: it counts with every axis at its full speed, and may leave another feed and other modes / G28 stands in `unknown_macros` under [language]
      | [homing_override]
      | ^^^^^^^^^^^^^^^^^
    "#);
    assert_snapshot!(own("  G28 X0\n  G28 Y0\n"), @r#"
    unknown_moves = ["G28"]      # [homing_override]
    settings:8, warning: commands in place of G28: it counts with every axis at its full speed, and leaves feed and modes as they are / G28 stands in `unknown_moves` under [language]
      | [homing_override]
      | ^^^^^^^^^^^^^^^^^
    "#);
    // A macro in place of G28 that calls it.
    assert_snapshot!(own("  G1 X1\n[gcode_macro G28]\nrename_existing: G28.1\ngcode:\n  G28.1\n"), @r#"unknown_macros = ["G28"]     # [gcode_macro]"#);
}

const MILL: &str = "[TRAJ]\nCOORDINATES = X Y Z A\n[KINS]\nKINEMATICS = trivkins\n[AXIS_X]\nMAX_VELOCITY = 30\n\
                    MAX_ACCELERATION = 100\n";

#[test]
fn what_a_tool_change_moves_under_linuxcnc() {
    let own = |more: &str| language(&imported(&format!("{MILL}[EMCIO]\n{more}")).toml);
    assert_snapshot!(own("TOOL_CHANGE_QUILL_UP = 1\n"), @r#"tool_change_moves = ["Z"]    # [EMCIO] TOOL_CHANGE_QUILL_UP = 1 (line 9)"#);
    assert_snapshot!(own("TOOL_CHANGE_POSITION = 0 0 0\nTOOL_CHANGE_QUILL_UP = 1\n"), @r#"tool_change_moves = ["X", "Y", "Z"] # [EMCIO] TOOL_CHANGE_POSITION = 0 0 0 (line 9), [EMCIO] TOOL_CHANGE_QUILL_UP = 1 (line 10)"#);
    assert_snapshot!(own("TOOL_CHANGE_POSITION = 0 0 0 0 0 0\n"), @r#"tool_change_moves = ["X", "Y", "Z", "A"] # [EMCIO] TOOL_CHANGE_POSITION = 0 0 0 0 0 0 (line 9)"#);
    assert_snapshot!(own("TOOL_CHANGE_AT_G30 = 1\n"), @r#"tool_change_moves = ["X", "Y", "Z", "A"] # [EMCIO] TOOL_CHANGE_AT_G30 = 1 (line 9)"#);
    assert_eq!(
        own("TOOL_CHANGE_QUILL_UP = 0\nTOOL_CHANGE_AT_G30 = 0\n"),
        ""
    );
}

#[test]
fn remaps_of_linuxcnc() {
    let text = format!(
        "{MILL}[RS274NGC]\nREMAP=M6 modalgroup=6 prolog=change_prolog ngc=toolchange\n\
         REMAP=m400 modalgroup=10 argspec=P ngc=foo # own\nREMAP = G88.8 modalgroup=1 ngc=g888\nREMAP=T prolog=p ngc=prepare\n"
    );
    let found = imported(&text);
    assert_snapshot!(language(&found.toml), @r#"unknown_moves = ["M6", "M400", "G88.8"] # [RS274NGC] REMAP=M6 modalgroup=6 prolog=change_prolog ngc=toolchange (line 9) to [RS274NGC] REMAP = G88.8 modalgroup=1 ngc=g888 (line 11)"#);
    assert_snapshot!(render(&found.warnings), @r"
    settings:9, warning: M6 is remapped: it counts as moving every axis at its full speed / it stands in `unknown_moves` under [language]; a word that moves no axis and raises no limit goes into `ignored` instead
      | REMAP=M6 modalgroup=6 prolog=change_prolog ngc=toolchange
      |       ^^
    settings:10, warning: M400 is remapped: it counts as moving every axis at its full speed / it stands in `unknown_moves` under [language]; a word that moves no axis and raises no limit goes into `ignored` instead
      | REMAP=m400 modalgroup=10 argspec=P ngc=foo # own
      |       ^^^^
    settings:11, warning: G88.8 is remapped: it counts as moving every axis at its full speed / it stands in `unknown_moves` under [language]; a word that moves no axis and raises no limit goes into `ignored` instead
      | REMAP = G88.8 modalgroup=1 ngc=g888
      |         ^^^^^
    settings:12, warning: `T` is remapped, and what its remap moves does not count / powers may be too low where it moves axes: write these moves into the programs, or list a word that stands next to it, such as M6, in `unknown_moves` under [language]
      | REMAP=T prolog=p ngc=prepare
      |       ^
    ");
}

/// Klipper's samples quote `Configuration.h` in comments.
#[test]
fn sections_say_more_than_defines_in_comments() {
    let defines =
        "#define DEFAULT_A 1\n#define X_A 1\n#define Y_A 1\n#define Z_A 1\n#define HOMING_A 1\n";
    assert_eq!(
        imported(&format!("{defines}{PRINTER}")).format,
        Format::Klipper
    );
}
