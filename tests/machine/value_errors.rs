//! Every message about a value of a machine file, once.

use insta::assert_snapshot;

use super::{edited, findings, with};

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
    line 13, warning machine-unit: `lead_mm` has no effect: nothing is given at the motor
      | lead_mm = 1e-10
      |           ^^^^^
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
    line 12, error machine-type: `mass_kg` must be a number, not text / write a number alone, without quotes: its unit is that at the end of the name
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
fn list_for_a_point_of_a_curve() {
    let curve = "mass_kg = 900\nforce_curve = [[0, 100]]";
    assert_snapshot!(findings(&edited("mass_kg = 900", curve)), @r"
    line 13, error machine-type: an entry of `force_curve` must be a table, not a list / write it as { speed_mm_min = …, force_n = … }
      | force_curve = [[0, 100]]
      |                ^^^^^^^^
    ");
}

#[test]
fn number_for_table() {
    assert_snapshot!(findings("schema = 1\nname = \"t\"\ncontroller = \"iso\"\nconverter = 3\naxes = 4\n"), @r"
    line 4, error machine-type: `converter` must be a table, not a number / write it as { peak_power_w = … }
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
fn response_of_no_time() {
    assert_snapshot!(findings(&with("[path]\nresponse_time_s = 0")), @r"
    line 20, error machine-range: `response_time_s` must be at least 0.001, but is 0
      | response_time_s = 0
      |                   ^
    ");
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
fn two_names_of_the_reference_point() {
    let both = edited(
        "mass_kg = 900",
        "mass_kg = 900\nreference_mm = 0\nhome_mm = 5",
    );
    assert_snapshot!(findings(&both), @r"
    line 14, error machine-twice: `reference_mm` and `home_mm` give the same quantity of axis X / keep one of the two
      | home_mm = 5
      |           ^
    ");
    // The earlier name alone goes on meaning the same.
    let old = edited(
        "mass_kg = 900",
        "mass_kg = 900\nhome_mm = 5\nhome_mm_min = 600",
    );
    let new = old.replace("home_mm", "reference_mm");
    assert_eq!(findings(&old), "");
    let [old, new] = [old, new].map(|text| super::machine(&text).axes[0]);
    assert_eq!(old, new);
    assert_eq!(new.and_then(|axis| axis.reference_mm), Some(5.0));
}

#[test]
fn a_reference_point_in_the_unit_of_the_other_kind() {
    let rotary = edited("inertia_kg_m2 = 12", "inertia_kg_m2 = 12\nreference_mm = 1");
    assert!(
        findings(&rotary).contains(
            "`reference_mm` belongs to a linear axis, but axis B is rotary / give `reference_deg`"
        ),
        "{}",
        findings(&rotary)
    );
    let linear = edited("mass_kg = 900", "mass_kg = 900\nreference_deg_min = 1");
    assert!(
        findings(&linear)
            .contains("`reference_deg_min` belongs to a rotary axis, but axis X is linear"),
        "{}",
        findings(&linear)
    );
}

#[test]
fn offsets_of_axes_and_systems_that_are_not_there() {
    let found = findings(&with(
        "[offsets]\nG54 = { X = 1, Q = 2 }\nG55 = { Y = 3 }\nG60 = { X = 1 }",
    ));
    assert!(found.contains("the machine has no axis Y"), "{found}");
    assert!(found.contains("`Q`") && found.contains("`G60`"), "{found}");
    for name in ["P0", "P301", "1", "P01 = { X = 1 }, P1"] {
        let found = findings(&with(&format!(
            "[offsets]\nG154 = {{ {name} = {{ X = 1 }} }}"
        )));
        assert!(
            found.contains("is no number of a further work offset, or is given twice"),
            "{name}: {found}"
        );
    }
}

/// In all tables, not only in those of the axes.
#[test]
fn beyond_computing() {
    let spindle = |line: &str| {
        findings(&with(&format!(
            "[spindle]\nmax_rpm = 8000\ninertia_kg_m2 = 0.1\n{line}"
        )))
    };
    assert_snapshot!(spindle("peak_power_w = 1e308"), @r"
    line 22, error machine-range: `peak_power_w` is too large or too small to compute with
      | peak_power_w = 1e308
      |                ^^^^^
    ");
    assert_snapshot!(spindle("friction_nm = 1e-308"), @r"
    line 22, error machine-range: `friction_nm` is too large or too small to compute with
      | friction_nm = 1e-308
      |               ^^^^^^
    ");
    assert_eq!(spindle("jerk_time_s = -0.0"), spindle("jerk_time_s = 0"));
}
