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
    line 5, error machine-missing: `peak_power_w` is missing in `converter` / Peak power in W
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
    line 8, error machine-missing: axis X needs a mass or an inertia / give `mass_kg` or `inertia_kg_m2`
      | [axes.X]
      | ^^^^^^^^
    ");
}

#[test]
fn missing_inertia() {
    assert_snapshot!(findings(&edited("inertia_kg_m2 = 12\n", "")), @r"
    line 14, error machine-missing: axis B needs an inertia / give `inertia_kg_m2`
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
    line 19, error machine-missing: `off` is missing in `load` / Word or words that switch it off
      | [[load]]
      | ^^^^^^^^
    line 19, error machine-missing: `power_w` is missing in `load` / What it draws in W
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
    line 25, error machine-missing: `accel_time_s` is missing in `spindle` / Time to `max_rpm` in s
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

#[test]
fn negative_mass() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = -5")), @r"
    line 12, error machine-range: `mass_kg` must be greater than 0, but is -5
      | mass_kg = -5
      |           ^^
    ");
}

#[test]
fn zero_speed() {
    assert_snapshot!(findings(&edited("rapid_mm_min = 36000", "rapid_mm_min = 0")), @r"
    line 10, error machine-range: `rapid_mm_min` must be greater than 0, but is 0
      | rapid_mm_min = 0
      |                ^
    ");
}

#[test]
fn negative_friction() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\ncoulomb_n = -1")), @r"
    line 13, error machine-range: `coulomb_n` must be 0 or greater, but is -1
      | coulomb_n = -1
      |             ^^
    ");
}

#[test]
fn not_a_number() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = nan")), @r"
    line 12, error machine-range: `mass_kg` must be a finite number
      | mass_kg = nan
      |           ^^^
    ");
}

#[test]
fn infinite() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = inf")), @r"
    line 12, error machine-range: `mass_kg` must be a finite number
      | mass_kg = inf
      |           ^^^
    ");
}

#[test]
fn beyond_f64() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 1e999")), @r"
    line 12, error machine-range: `mass_kg` must be a finite number
      | mass_kg = 1e999
      |           ^^^^^
    ");
}

#[test]
fn too_large_to_convert() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "inertia_kg_m2 = 1e300\nlead_mm = 1e-10")), @r"
    line 12, error machine-range: `inertia_kg_m2` is too large or too small to compute with
      | inertia_kg_m2 = 1e300
      |                 ^^^^^
    ");
}

#[test]
fn time_too_small() {
    assert_snapshot!(findings(&edited("accel_mm_s2 = 6000", "accel_time_s = 1e-320")), @r"
    line 11, error machine-range: `accel_time_s` is too large or too small to compute with
      | accel_time_s = 1e-320
      |                ^^^^^^
    ");
}

#[test]
fn efficiency_in_percent() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\nefficiency = 85")), @r"
    line 13, error machine-range: `efficiency` must be at most 1, but is 85 / in percent? 85 % is 0.85
      | efficiency = 85
      |              ^^
    ");
}

#[test]
fn margin_in_percent() {
    assert_snapshot!(findings(&with("[limits]\nmargin = 10")), @r"
    line 20, error machine-range: `margin` must be less than 1, but is 10 / in percent? 10 % is 0.1
      | margin = 10
      |          ^^
    ");
}

#[test]
fn margin_of_one() {
    assert_snapshot!(findings(&with("[limits]\nmargin = 1.0")), @r"
    line 20, error machine-range: `margin` must be less than 1, but is 1 / in percent? 1 % is 0.01
      | margin = 1.0
      |          ^^^
    ");
}

#[test]
fn override_as_factor() {
    assert_snapshot!(findings(&with("[limits]\noverride_max_percent = { feed = 0.5, rapid = 0.5, spindle = 0.9 }")), @r"
    line 20, error machine-range: `feed` must be at least 1, but is 0.5 / as a factor? 0.5 is 50 %
      | override_max_percent = { feed = 0.5, rapid = 0.5, spindle = 0.9 }
      |                                 ^^^
    line 20, error machine-range: `rapid` must be at least 1, but is 0.5 / as a factor? 0.5 is 50 %
      | override_max_percent = { feed = 0.5, rapid = 0.5, spindle = 0.9 }
      |                                              ^^^
    line 20, error machine-range: `spindle` must be at least 1, but is 0.9 / as a factor? 0.9 is 90 %
      | override_max_percent = { feed = 0.5, rapid = 0.5, spindle = 0.9 }
      |                                                             ^^^
    ");
}

#[test]
fn rapid_override_above_100() {
    assert_snapshot!(findings(&with("[limits]\noverride_max_percent = { rapid = 120 }")), @r"
    line 20, error machine-range: `rapid` must be at most 100, but is 120 / the rapids' own speed is 100 %; no override exceeds it
      | override_max_percent = { rapid = 120 }
      |                                  ^^^
    ");
}

#[test]
fn servo_factor_below_one() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 900\nservo_factor_motor = 0.9")), @r"
    line 13, error machine-range: `servo_factor_motor` must be at least 1, but is 0.9 / 1 means: real acceleration is the commanded one
      | servo_factor_motor = 0.9
      |                      ^^^
    ");
}

#[test]
fn schema_out_of_range() {
    assert_snapshot!(findings(&edited("schema = 1", "schema = -1")), @r"
    line 1, error machine-range: `schema` is out of range
      | schema = -1
      |          ^^
    ");
}

#[test]
fn schema_number() {
    assert_snapshot!(findings(&edited("schema = 1", "schema = 2")), @r"
    line 1, error machine-schema: schema 2 is not known / this version of gwatt reads schema = 1
      | schema = 2
      |          ^
    ");
}

#[test]
fn number_in_quotes() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = \"900\"")), @r#"
    line 12, error machine-type: `mass_kg` must be a number, not text / write it without quotes: 900
      | mass_kg = "900"
      |           ^^^^^
    "#);
}

#[test]
fn text_for_number() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = \"heavy\"")), @r#"
    line 12, error machine-type: `mass_kg` must be a number, not text
      | mass_kg = "heavy"
      |           ^^^^^^^
    "#);
}

#[test]
fn number_for_text() {
    assert_snapshot!(findings(&edited("name = \"test\"", "name = 3")), @r"
    line 2, error machine-type: `name` must be text in quotes, not a number / write it in quotes
      | name = 3
      |        ^
    ");
}

#[test]
fn number_for_switch() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "peak_power_w = 3500\ncredit_regen = 1")), @r"
    line 7, error machine-type: `credit_regen` must be true or false, not a number
      | credit_regen = 1
      |                ^
    ");
}

#[test]
fn date() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = 1979-05-27")), @r"
    line 12, error machine-type: `mass_kg` must be a number, not a date
      | mass_kg = 1979-05-27
      |           ^^^^^^^^^^
    ");
}

#[test]
fn table_for_number() {
    assert_snapshot!(findings(&edited("mass_kg = 900", "mass_kg = { a = 1 }")), @r"
    line 12, error machine-type: `mass_kg` must be a number, not a table
      | mass_kg = { a = 1 }
      |           ^^^^^^^^^
    ");
}

#[test]
fn number_for_table() {
    assert_snapshot!(findings("schema = 1\nname = \"t\"\ncontroller = \"iso\"\nconverter = 3\naxes = 4\n"), @r"
    line 4, error machine-type: `converter` must be a table, not a number
      | converter = 3
      |             ^
    line 5, error machine-type: `axes` must be a table, not a number
      | axes = 4
      |        ^
    ");
}

#[test]
fn float_for_schema() {
    assert_snapshot!(findings(&edited("schema = 1", "schema = 1.0")), @r"
    line 1, error machine-type: `schema` must be a whole number, not one with a decimal point
      | schema = 1.0
      |          ^^^
    ");
}

#[test]
fn unknown_word() {
    assert_snapshot!(findings(&edited("kind = \"linear\"", "kind = \"linaer\"")), @r#"
    line 9, error machine-value: `kind` must be "linear" or "rotary", not "linaer" / did you mean "linear"?
      | kind = "linaer"
      |        ^^^^^^^^
    "#);
}

#[test]
fn unknown_mode() {
    assert_snapshot!(findings(&with("[path]\nmode = \"g64\"")), @r#"
    line 20, error machine-value: `mode` must be "exact-stop" or "look-ahead", not "g64"
      | mode = "g64"
      |        ^^^^^
    "#);
}

#[test]
fn table_for_list() {
    assert_snapshot!(findings(&with("[load]\non = \"M8\"\noff = \"M9\"\npower_w = 1")), @r"
    line 19, error machine-type: `load` must be a list, not a table / write its header in double brackets
      | [load]
      | ^^^^^^
    ");
}

#[test]
fn rotary_with_linear_fields() {
    assert_snapshot!(findings(&edited("accel_deg_s2 = 1150\ninertia_kg_m2 = 12", "accel_mm_s2 = 1150\nmass_kg = 12")), @r#"
    line 17, error machine-kind: `accel_mm_s2` belongs to a linear axis, but axis B is rotary / give `accel_deg_s2`, or set kind = "linear"
      | accel_mm_s2 = 1150
      |               ^^^^
    line 18, error machine-kind: `mass_kg` belongs to a linear axis, but axis B is rotary / give `inertia_kg_m2`, or set kind = "linear"
      | mass_kg = 12
      |           ^^
    "#);
}

#[test]
fn linear_with_rotary_fields() {
    assert_snapshot!(findings(&edited("rapid_mm_min = 36000", "rapid_deg_min = 36000")), @r#"
    line 10, error machine-kind: `rapid_deg_min` belongs to a rotary axis, but axis X is linear / give `rapid_mm_min`, or set kind = "rotary"
      | rapid_deg_min = 36000
      |                 ^^^^^
    "#);
}

#[test]
fn lead_on_a_rotary_axis() {
    assert_snapshot!(findings(&edited("inertia_kg_m2 = 12", "inertia_kg_m2 = 12\nlead_mm = 10")), @r#"
    line 19, error machine-kind: `lead_mm` belongs to a linear axis, but axis B is rotary / give `gear_ratio`, or set kind = "linear"
      | lead_mm = 10
      |           ^^
    "#);
}

#[test]
fn axes_fed_twice_and_not_at_all() {
    assert_snapshot!(findings(&edited("[converter]\npeak_power_w = 3500", "[[converter]]\nname = \"a\"\naxes = [\"X\"]\npeak_power_w = 3500\n\n[[converter]]\nname = \"a\"\naxes = [\"X\", \"Y\"]\npeak_power_w = 1000")), @r#"
    line 11, error machine-converter: two converters are named "a"
      | name = "a"
      |        ^^^
    line 12, error machine-converter: no converter feeds B / every axis needs a converter
      | axes = ["X", "Y"]
      |        ^^^^^^^^^^
    line 12, error machine-converter: axis X is already fed / name each axis once, at one converter
      | axes = ["X", "Y"]
      |         ^^^
    line 12, error machine-converter: the machine has no axis Y
      | axes = ["X", "Y"]
      |              ^^^
    "#);
}

#[test]
fn several_without_names() {
    assert_snapshot!(findings(&edited("[converter]\npeak_power_w = 3500", "[[converter]]\npeak_power_w = 3500\n\n[[converter]]\naxes = [\"B\"]\npeak_power_w = 1000")), @r"
    line 5, error machine-missing: each of several converters needs a `name`
      | [[converter]]
      | ^^^^^^^^^^^^^
    line 5, error machine-missing: each of several converters needs `axes`
      | [[converter]]
      | ^^^^^^^^^^^^^
    line 8, error machine-missing: each of several converters needs a `name`
      | [[converter]]
      | ^^^^^^^^^^^^^
    ");
}

#[test]
fn single_that_forgets_an_axis() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "peak_power_w = 3500\naxes = [\"X\"]")), @r#"
    line 7, error machine-converter: no converter feeds B / every axis needs a converter
      | axes = ["X"]
      |        ^^^^^
    "#);
}

#[test]
fn unknown_letter() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "peak_power_w = 3500\naxes = [\"X\", \"D\"]")), @r#"
    line 7, error machine-value: `axes` must be "X", "Y", "Z", "A", "B", "C", "U", "V", "W" or "E", not "D"
      | axes = ["X", "D"]
      |              ^^^
    "#);
}

#[test]
fn empty_list() {
    assert_snapshot!(findings(&edited("[converter]\npeak_power_w = 3500\n", "").replace("controller = \"iso\"", "controller = \"iso\"\nconverter = []")), @r"
    line 4, error machine-missing: `converter` is empty
      | converter = []
      |             ^^
    ");
}

#[test]
fn contradictions() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "peak_power_w = 3500\nbase_load_w = 3200\ncontinuous_power_w = 4000\nbus_min_v = 600\nbus_nominal_v = 560\nbus_max_v = 500\noverload = [{ power_w = 3000, seconds = 5, every_s = 1 }]")), @r"
    line 7, error machine-converter: `base_load_w` leaves nothing of 3500 W for motion / the limit is (1 − margin)·peak_power_w, margin 0.1
      | base_load_w = 3200
      |               ^^^^
    line 8, error machine-converter: `continuous_power_w` is above `peak_power_w`
      | continuous_power_w = 4000
      |                      ^^^^
    line 9, error machine-converter: `bus_min_v` is not below `bus_nominal_v`
      | bus_min_v = 600
      |             ^^^
    line 10, error machine-converter: `bus_nominal_v` is not below `bus_max_v`
      | bus_nominal_v = 560
      |                 ^^^
    line 12, error machine-converter: `every_s` is shorter than `seconds`
      | overload = [{ power_w = 3000, seconds = 5, every_s = 1 }]
      |                                                      ^
    ");
}

#[test]
fn window_alone() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "peak_power_w = 3500\nwindow_s = 10")), @r"
    line 7, error machine-converter: `window_s` without `continuous_power_w`
      | window_s = 10
      |            ^^
    ");
}

#[test]
fn of_an_axis_that_is_not_there() {
    assert_snapshot!(findings(&with("[[preset]]\naxes = [\"X\", \"Z\"]\nspeed_mm_min = { X = 1000, Z = 1000 }")), @r#"
    line 20, error machine-preset: the machine has no axis Z
      | axes = ["X", "Z"]
      |              ^^^
    "#);
}

#[test]
fn given_twice() {
    assert_snapshot!(findings(&with("[[preset]]\naxes = [\"X\", \"B\"]\nspeed_mm_min = { X = 1000 }\n\n[[preset]]\naxes = [\"B\", \"X\"]\nspeed_mm_min = { X = 2000 }")), @r#"
    line 24, error machine-preset: a second preset for the axes XB / keep one of the two
      | axes = ["B", "X"]
      |        ^^^^^^^^^^
    "#);
}

#[test]
fn letter_twice_and_other_axis() {
    assert_snapshot!(findings(&with("[[preset]]\naxes = [\"X\", \"X\"]\nspeed_mm_min = { B = 1000 }")), @r#"
    line 20, error machine-preset: axis X is named twice
      | axes = ["X", "X"]
      |              ^^^
    line 21, error machine-preset: axis B is not in this preset's `axes`
      | speed_mm_min = { B = 1000 }
      |                      ^^^^
    "#);
}

#[test]
fn that_limits_nothing() {
    assert_snapshot!(findings(&with("[[preset]]\naxes = [\"X\"]")), @r"
    line 19, error machine-preset: a preset that limits nothing / give `speed_mm_min` or `accel_mm_s2`
      | [[preset]]
      | ^^^^^^^^^^
    ");
}

#[test]
fn without_axes() {
    assert_snapshot!(findings(&with("[[preset]]\naxes = []\nspeed_mm_min = { X = 1000 }")), @r"
    line 20, error machine-preset: a preset without axes
      | axes = []
      |        ^^
    ");
}

#[test]
fn malformed_words() {
    assert_snapshot!(findings(&with("[[load]]\non = \"coolant\"\noff = [\"M9\", \"\"]\npower_w = 750")), @r#"
    line 20, error machine-load: "coolant" is not a program word / a letter and a number, such as "M8"
      | on = "coolant"
      |      ^^^^^^^^^
    line 21, error machine-load: "" is not a program word / a letter and a number, such as "M8"
      | off = ["M9", ""]
      |              ^^
    "#);
}

#[test]
fn same_word_on_and_off() {
    assert_snapshot!(findings(&with("[[load]]\non = \"M8\"\noff = \"m08\"\npower_w = 750")), @r#"
    line 21, error machine-load: the same word switches the load on and off
      | off = "m08"
      |       ^^^^^
    "#);
}

#[test]
fn unknown_converter() {
    assert_snapshot!(findings(&with("[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 750\nconverter = \"main\"")), @r#"
    line 23, error machine-load: no converter is named "main"
      | converter = "main"
      |             ^^^^^^
    "#);
}

#[test]
fn empty_off() {
    assert_snapshot!(findings(&with("[[load]]\non = \"M8\"\noff = []\npower_w = 750")), @r"
    line 21, error machine-missing: `off` is empty
      | off = []
      |       ^^
    ");
}

#[test]
fn contradictions_of_the_spindle() {
    assert_snapshot!(findings(&with("[spindle]\ninertia_kg_m2 = 0.1\nmax_rpm = 4000\nbase_rpm = 5000\naccel_time_s = 1\njerk_time_s = 2")), @r"
    line 22, error machine-spindle: `base_rpm` is above `max_rpm`
      | base_rpm = 5000
      |            ^^^^
    line 24, error machine-spindle: `jerk_time_s` is longer than `accel_time_s`
      | jerk_time_s = 2
      |               ^
    ");
}

#[test]
fn unknown_controller() {
    assert_snapshot!(findings(&edited("controller = \"iso\"", "controller = \"linuxcn\"")), @r#"
    line 3, error machine-controller: no built-in controller profile and no file is named "linuxcn" / did you mean "linuxcnc"? built in: iso, linuxcnc, grbl, isg, marlin
      | controller = "linuxcn"
      |              ^^^^^^^^^
    "#);
}

#[test]
fn controller_file_missing() {
    assert_snapshot!(findings(&edited("controller = \"iso\"", "controller = \"no/such.toml\"")), @r#"
    line 3, error machine-controller: there is no controller profile file no/such.toml
      | controller = "no/such.toml"
      |              ^^^^^^^^^^^^^^
    "#);
}

#[test]
fn many_at_once() {
    assert_snapshot!(findings("schema = 1\nname = \"t\"\ncontroller = \"isso\"\n[converter]\npeak_power_w = -1\n[axes.X]\nrapid_mm_mim = 1000\naccel_mm_s2 = \"a\"\n[limits]\nmargin = 2\n"), @r#"
    line 3, error machine-controller: no built-in controller profile and no file is named "isso" / did you mean "iso"? built in: iso, linuxcnc, grbl, isg, marlin
      | controller = "isso"
      |              ^^^^^^
    line 5, error machine-range: `peak_power_w` must be greater than 0, but is -1
      | peak_power_w = -1
      |                ^^
    line 6, error machine-missing: axis X needs a mass or an inertia / give `mass_kg` or `inertia_kg_m2`
      | [axes.X]
      | ^^^^^^^^
    line 7, error machine-unknown-key: unknown key `rapid_mm_mim` / did you mean `rapid_mm_min`?
      | rapid_mm_mim = 1000
      | ^^^^^^^^^^^^
    line 8, error machine-type: `accel_mm_s2` must be a number, not text
      | accel_mm_s2 = "a"
      |               ^^^
    line 10, error machine-range: `margin` must be less than 1, but is 2 / in percent? 2 % is 0.02
      | margin = 2
      |          ^
    "#);
}
