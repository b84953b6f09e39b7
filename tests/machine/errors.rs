//! Every message about a machine file, once.

use insta::assert_snapshot;

use super::{edited, findings, with};

#[test]
fn missing_bracket() {
    assert_snapshot!(findings(&edited("[axes.X]", "[axes.X")), @r"
    line 8, error machine-syntax: unclosed table, expected `]`
      | [axes.X
      |        ^
    ");
}

#[test]
fn missing_value() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg =")), @r"
    line 12, error machine-syntax: string values must be quoted, expected literal string
      | mass_kg =
      |          ^
    ");
}

#[test]
fn open_string() {
    assert_snapshot!(findings(&edited("name = \"test\"", "name = \"test")), @r#"
    line 2, error machine-syntax: invalid basic string, expected `"`
      | name = "test
      |             ^
    "#);
}

#[test]
fn two_syntax_errors() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 9 00").replace("inertia_kg_m2 = 12", "inertia_kg_m2 12")), @r"
    line 12, error machine-syntax: string values must be quoted, expected literal string
      | mass_kg = 9 00
      |           ^^^^
    line 18, error machine-syntax: key with no value, expected `=`
      | inertia_kg_m2 12
      |               ^
    ");
}

#[test]
fn duplicate_key() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\nmass_kg = 800")), @r"
    line 13, error machine-twice: `mass_kg` is given twice / keep one of the two
      | mass_kg = 800
      | ^^^^^^^
    ");
}

#[test]
fn duplicate_table() {
    assert_snapshot!(findings(&with("[axes.X]\nkind = \"linear\"")), @r#"
    line 19, error machine-twice: `X` is given twice / keep one of the two
      | [axes.X]
      |       ^
    line 20, error machine-twice: `kind` is given twice / keep one of the two
      | kind = "linear"
      | ^^^^
    "#);
}

#[test]
fn unknown_key() {
    assert_snapshot!(findings(&edited("accel_mm_s2", "accel_mm_s")), @r"
    line 11, error machine-unknown-key: unknown key `accel_mm_s` / did you mean `accel_mm_s2`?
      | accel_mm_s = 6000
      | ^^^^^^^^^^
    ");
}

#[test]
fn unknown_key_that_is_like_none() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\ncolour = \"red\"")), @r#"
    line 13, error machine-unknown-key: unknown key `colour` / `gwatt machine schema` lists the keys
      | colour = "red"
      | ^^^^^^
    "#);
}

#[test]
fn key_of_another_table() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "peak_power_w = 3500\nmargin = 0.1")), @r"
    line 7, error machine-unknown-key: unknown key `margin` / `margin` belongs to `limits`
      | margin = 0.1
      | ^^^^^^
    ");
}

#[test]
fn unknown_table() {
    assert_snapshot!(findings(&with("[spindel]\nmax_rpm = 4000")), @r"
    line 19, error machine-unknown-key: unknown key `spindel` / did you mean `spindle`?
      | [spindel]
      |  ^^^^^^^
    ");
}

#[test]
fn unknown_axis_letter() {
    assert_snapshot!(findings(&edited("[axes.B]", "[axes.D]")), @r"
    line 14, error machine-axis: `D` is not an axis letter / an axis is X, Y, Z, A, B, C, U, V, W or E
      | [axes.D]
      |       ^
    ");
}

#[test]
fn lower_case_axis() {
    assert_snapshot!(findings(&edited("[axes.X]", "[axes.x]")), @r"
    line 8, error machine-axis: `x` is not an axis letter / in upper case: `X`
      | [axes.x]
      |       ^
    ");
}

#[test]
fn empty_file() {
    assert_snapshot!(findings(""), @r"
    line 0, error machine-missing: `schema` is missing in the file / Version of this format: 1
    line 0, error machine-missing: `name` is missing in the file / What reports call the machine
    line 0, error machine-missing: `controller` is missing in the file / A built-in controller profile, or a profile file relative to this file
    line 0, error machine-missing: `converter` is missing in the file / The converter; several as `[[converter]]`, each with `name` and `axes`
    line 0, error machine-missing: `axes` is missing in the file / The axes by letter; at least one
    ");
}

#[test]
fn missing_name() {
    assert_snapshot!(findings(&edited("name = \"test\"\n", "")), @"line 0, error machine-missing: `name` is missing in the file / What reports call the machine");
}

#[test]
fn empty_name() {
    assert_snapshot!(findings(&edited("name = \"test\"", "name = \" \"")), @r#"
    line 2, error machine-missing: `name` is empty
      | name = " "
      |        ^^^
    "#);
}

#[test]
fn missing_peak_power() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "base_load_w = 0")), @r"
    line 5, error machine-missing: `peak_power_w` is missing in `converter` / What the supply of the drives delivers at most, in W: see its data sheet or label
      | [converter]
      | ^^^^^^^^^^^
    ");
}

#[test]
fn missing_speed_and_acceleration() {
    assert_snapshot!(findings(&edited("rapid_mm_min = 36000\naccel_mm_s2 = 6000\n", "")), @r"
    line 8, error machine-missing: axis X needs a rapid speed / give `rapid_mm_min` or `max_speed_rpm`
      | [axes.X]
      | ^^^^^^^^
    line 8, error machine-missing: axis X needs an acceleration / give `accel_mm_s2` or `accel_time_s`
      | [axes.X]
      | ^^^^^^^^
    ");
}

#[test]
fn missing_mass() {
    assert_snapshot!(findings(&edited("mass_kg = 900\n", "")), @r"
    line 8, error machine-missing: axis X needs a mass or an inertia / give `moved_mass_kg` with `rotor_kg_m2` and `screw`, `pulley` or `pinion`; or all of it as `mass_kg` at the load or `inertia_kg_m2` at the motor
      | [axes.X]
      | ^^^^^^^^
    ");
}

#[test]
fn missing_inertia() {
    assert_snapshot!(findings(&edited("inertia_kg_m2 = 12\n", "")), @r"
    line 14, error machine-missing: axis B needs an inertia / give `moved_inertia_kg_m2` with `rotor_kg_m2` and `gear_ratio`, or all of it as `inertia_kg_m2`
      | [axes.B]
      | ^^^^^^^^
    ");
}

#[test]
fn no_axes() {
    assert_snapshot!(findings("schema = 1\nname = \"t\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 1000\n[axes]\n"), @r"
    line 6, error machine-missing: the machine has no axes
      | [axes]
      | ^^^^^^
    ");
}

#[test]
fn motor_side_without_lead() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "inertia_kg_m2 = 0.005")), @r"
    line 12, error machine-missing: `inertia_kg_m2` is at the motor, but axis X has no `lead_mm` / give the screw's `lead_mm`, or the quantity at the load
      | inertia_kg_m2 = 0.005
      |                 ^^^^^
    ");
}

#[test]
fn gear_without_lead() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\ngear_ratio = 2")), @r"
    line 13, error machine-missing: `gear_ratio` is at the motor, but axis X has no `lead_mm` / give the screw's `lead_mm`, or the quantity at the load
      | gear_ratio = 2
      |              ^
    ");
}

#[test]
fn missing_in_lists() {
    assert_snapshot!(findings(&with("[[load]]\non = \"M8\"\n\n[[preset]]\nspeed_mm_min = { X = 1000 }\n\n[spindle]\nfriction_nm = 1")), @r"
    line 19, error machine-missing: `power_w` is missing in `load` / What it draws in W
      | [[load]]
      | ^^^^^^^^
    line 19, error machine-missing: `off` is missing in `load` / Word or words that switch it off; on printers heaters and fans need none, which the value 0 switches off
      | [[load]]
      | ^^^^^^^^
    line 22, error machine-missing: `axes` is missing in `preset` / The combination
      | [[preset]]
      | ^^^^^^^^^^
    line 25, error machine-missing: `inertia_kg_m2` is missing in `spindle` / Inertia at the spindle in kg·m²
      | [spindle]
      | ^^^^^^^^^
    line 25, error machine-missing: `max_rpm` is missing in `spindle` / Largest speed in 1/min
      | [spindle]
      | ^^^^^^^^^
    line 25, error machine-missing: the spindle needs an acceleration / give `accel_time_s` or `torque_curve`
      | [spindle]
      | ^^^^^^^^^
    ");
}

#[test]
fn mass_and_inertia() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\ninertia_kg_m2 = 0.005\nlead_mm = 10")), @r"
    line 13, error machine-twice: `mass_kg` and `inertia_kg_m2` give the same quantity of axis X / keep one of the two
      | inertia_kg_m2 = 0.005
      |                 ^^^^^
    ");
}

#[test]
fn two_speeds() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\nmax_speed_rpm = 3000\nlead_mm = 12")), @r"
    line 13, error machine-twice: `rapid_mm_min` and `max_speed_rpm` give the same quantity of axis X / keep one of the two
      | max_speed_rpm = 3000
      |                 ^^^^
    ");
}

#[test]
fn two_accelerations() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\naccel_time_s = 0.1")), @r"
    line 13, error machine-twice: `accel_mm_s2` and `accel_time_s` give the same quantity of axis X / keep one of the two
      | accel_time_s = 0.1
      |                ^^^
    ");
}

#[test]
fn two_frictions() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\nlead_mm = 10\nfriction_nm = 1\ncoulomb_n = 500")), @r"
    line 14, error machine-twice: `coulomb_n` and `friction_nm` give the same quantity of axis X / keep one of the two
      | friction_nm = 1
      |               ^
    ");
}

#[test]
fn two_copper_losses() {
    assert_snapshot!(findings(&edited("inertia_kg_m2 = 12", "inertia_kg_m2 = 12\ncopper_w_n2 = 0.01\ncopper_w_nm2 = 0.01")), @r"
    line 19, error machine-twice: `copper_w_nm2` and `copper_w_n2` give the same quantity of axis B / keep one of the two
      | copper_w_n2 = 0.01
      |               ^^^^
    ");
}
