//! Every message about converters, presets, loads, spindle and profile, once.

use insta::assert_snapshot;

use super::{edited, findings, with};

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
fn torque_curves_of_the_spindle() {
    let spindle = |more: &str| {
        findings(&with(&format!(
            "[spindle]\ninertia_kg_m2 = 0.1\nmax_rpm = 4000\n{more}"
        )))
    };
    assert_eq!(
        spindle("torque_curve = [{ rpm = 0, torque_nm = 20 }, { rpm = 4000, torque_nm = 8 }]"),
        ""
    );
    assert_snapshot!(spindle("base_rpm = 1000\naccel_time_s = 1\ntorque_curve = [{ rpm = 0, torque_nm = 20 }]"), @r"
    line 22, error machine-twice: `base_rpm` and `torque_curve` give the same quantity / keep one of the two
      | base_rpm = 1000
      |            ^^^^
    line 23, error machine-twice: `accel_time_s` and `torque_curve` give the same quantity / keep one of the two
      | accel_time_s = 1
      |                ^
    ");
    assert_snapshot!(spindle("torque_curve = []"), @r"
    line 19, error machine-spindle: `torque_curve` has no points
      | [spindle]
      | ^^^^^^^^^
    ");
    assert_snapshot!(spindle("friction_nm = 9\ntorque_curve = [\n{ rpm = 0, torque_nm = 20 },\n{ rpm = 4000, torque_nm = 8 }]"), @r"
    line 25, error machine-spindle: the torque does not overcome `friction_nm`
      | { rpm = 4000, torque_nm = 8 }]
      | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(spindle("torque_curve = [\n{ rpm = 10, torque_nm = 20 },\n{ rpm = 5, torque_nm = 8 }]"), @r"
    line 23, error machine-curve: `torque_curve`: the first point must be at speed 0
      | { rpm = 10, torque_nm = 20 },
      | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    line 24, error machine-curve: `torque_curve`: speeds must ascend
      | { rpm = 5, torque_nm = 8 }]
      | ^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    // 9 N·m at 4000/min are 3770 W.
    assert_snapshot!(spindle("friction_nm = 9\naccel_time_s = 1\nbase_load_w = 100\npeak_power_w = 3800"), @r"
    line 25, error machine-spindle: `peak_power_w` leaves nothing to accelerate with at `max_rpm`: friction and base load take 3870 W
      | peak_power_w = 3800
      |                ^^^^
    ");
}

#[test]
fn curves_of_axes() {
    let axis = |more: &str| findings(&edited("mass_kg = 900", &format!("mass_kg = 900\n{more}")));
    assert_snapshot!(axis("force_curve = [{ speed_mm_min = 0, force_n = 9000 }]\ntorque_curve = [{ rpm = 0, torque_nm = 9 }]"), @r"
    line 14, error machine-twice: `force_curve` and `torque_curve` give the same quantity of axis X / keep one of the two
      | torque_curve = [{ rpm = 0, torque_nm = 9 }]
      |                 ^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(axis("torque_curve = [{ rpm = 0, torque_nm = 9 }]"), @r"
    line 13, error machine-missing: `torque_curve` is at the motor, but axis X has no `lead_mm` / give the screw's `lead_mm`, or a `force_curve`
      | torque_curve = [{ rpm = 0, torque_nm = 9 }]
      |                 ^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&edited("inertia_kg_m2 = 12", "inertia_kg_m2 = 12\nforce_curve = [{ speed_mm_min = 0, force_n = 9 }]")), @r"
    line 19, error machine-kind: `force_curve` is for linear axes; axis B turns / give `torque_curve`
      | force_curve = [{ speed_mm_min = 0, force_n = 9 }]
      |                ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(axis("coulomb_n = 700\ngravity_n = -300\nforce_curve = [\n{ speed_mm_min = 0, force_n = 9000 },\n{ speed_mm_min = 40000, force_n = 100 }]"), @r"
    line 17, error machine-curve: nothing is left to accelerate with at 36000 mm/min: friction and weight take 1000.0 N of 990.0 N
      | { speed_mm_min = 40000, force_n = 100 }]
      | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(axis("force_curve = [{ speed_mm_min = 0, force_n = 9000 }, { speed_mm_min = 20000, force_n = 9000 }]"), @r"
    line 13, error machine-curve: the curve ends at 20000 mm/min, below the rapid speed of 36000 mm/min / give a point at the rapid speed or beyond
      | force_curve = [{ speed_mm_min = 0, force_n = 9000 }, { speed_mm_min = 20000, force_n = 9000 }]
      |                                                      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    let points: Vec<String> = (0..17)
        .map(|i| format!("{{ speed_mm_min = {i}, force_n = 9 }}"))
        .collect();
    let many = axis(&format!("force_curve = [{}]", points.join(",\n")));
    assert!(
        many.contains("`force_curve`: more than 16 points"),
        "{many}"
    );
}

#[test]
fn unknown_controller() {
    assert_snapshot!(findings(&edited("controller = \"iso\"", "controller = \"linuxcn\"")), @r#"
    line 3, error machine-controller: no built-in controller profile and no file is named "linuxcn" / did you mean "linuxcnc"? built in: iso, linuxcnc, grbl, isg, twincat-nci, siemens, marlin, reprap, klipper, fanuc, haas, fanuc-lathe, fanuc-lathe-b, haas-lathe, mitsubishi, mazak, syntec, okuma, okuma-lathe
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
    line 3, error machine-controller: no built-in controller profile and no file is named "isso" / did you mean "iso"? built in: iso, linuxcnc, grbl, isg, twincat-nci, siemens, marlin, reprap, klipper, fanuc, haas, fanuc-lathe, fanuc-lathe-b, haas-lathe, mitsubishi, mazak, syntec, okuma, okuma-lathe
      | controller = "isso"
      |              ^^^^^^
    line 5, error machine-range: `peak_power_w` must be greater than 0, but is -1
      | peak_power_w = -1
      |                ^^
    line 6, error machine-missing: axis X needs a mass or an inertia / give `moved_mass_kg` with `rotor_kg_m2` and `screw`, `pulley` or `pinion`; or all of it as `mass_kg` at the load or `inertia_kg_m2` at the motor
      | [axes.X]
      | ^^^^^^^^
    line 7, error machine-unknown-key: unknown key `rapid_mm_mim` / did you mean `rapid_mm_min`?
      | rapid_mm_mim = 1000
      | ^^^^^^^^^^^^
    line 8, error machine-type: `accel_mm_s2` must be a number, not text / write a number alone, without quotes: its unit is that at the end of the name
      | accel_mm_s2 = "a"
      |               ^^^
    line 10, error machine-range: `margin` must be less than 1, but is 2 / in percent? 2 % is 0.02
      | margin = 2
      |          ^
    "#);
}

#[test]
fn response_roots() {
    let with_root = |line: &str| findings(&with(&format!("[axes.X.response]\n{line}")));
    assert_snapshot!(with_root("zeros = [{ frequency_hz = 40 }]"), @r"
    line 20, error machine-response: a root is a pair or a single one / give frequency_hz and damping, or time_constant_s
      | zeros = [{ frequency_hz = 40 }]
      |          ^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(with_root("zeros = [{ time_constant_s = 0 }]"), @r"
    line 20, error machine-response: a root is a pair or a single one / give frequency_hz and damping, or time_constant_s
      | zeros = [{ time_constant_s = 0 }]
      |          ^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(with_root("poles = [{ frequency_hz = 40, damping = 0 }]"), @r"
    line 20, error machine-response: `poles`: this would swing up for ever / poles have a damping, or a time constant, above 0
      | poles = [{ frequency_hz = 40, damping = 0 }]
      |          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(with_root("force_poles = [{ time_constant_s = -0.1 }]"), @r"
    line 20, error machine-response: `force_poles`: this would swing up for ever / poles have a damping, or a time constant, above 0
      | force_poles = [{ time_constant_s = -0.1 }]
      |                ^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(with_root("delay_ms = -1"), @r"
    line 20, error machine-range: `delay_ms` must be 0 or greater, but is -1
      | delay_ms = -1
      |            ^^
    ");
    let many = "{ time_constant_s = 1 }, ".repeat(33);
    assert!(with_root(&format!("zeros = [{many}]")).contains("more than 32 roots"));
    assert_eq!(
        with_root("zeros = [{ frequency_hz = 40, damping = -0.1 }]\nposition_gain_1_s = 40"),
        ""
    );
}

#[test]
fn correction_sections() {
    let with_sections = |list: &str| {
        findings(&with(&format!(
            "[axes.X.correction]\nperiod_ms = 1\nsections = [{list}]"
        )))
    };
    assert_snapshot!(with_sections("[1, 0, 0, 0]"), @r"
    line 21, error machine-response: a section has 4 numbers / write [b0, b1, b2, a1, a2], at most 32 of them
      | sections = [[1, 0, 0, 0]]
      |             ^^^^^^^^^^^^
    ");
    assert_snapshot!(with_sections("[1, 0, 0, 0, 1]"), @r"
    line 21, error machine-response: this section is not stable / |a2| < 1 and |a1| < 1 + a2 must hold
      | sections = [[1, 0, 0, 0, 1]]
      |             ^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(with_sections("[2, 0, 0, 0, 0]"), @r"
    line 21, error machine-response: this section changes the size of the path / b0 + b1 + b2 must be 1 + a1 + a2: its gain at rest is 1
      | sections = [[2, 0, 0, 0, 0]]
      |             ^^^^^^^^^^^^^^^
    ");
    assert_eq!(with_sections("[1, 0, 0, 0, 0]"), "");
}

#[test]
fn a_capacitor_that_is_counted_on_must_be_known() {
    assert_snapshot!(findings(&edited("peak_power_w = 3500", "peak_power_w = 3500\ncredit_capacitance = true\ncapacitance_f = 0.004\nbus_nominal_v = 560")), @r"
    line 5, error machine-converter: `credit_capacitance` without the capacitance and its voltages / give `capacitance_f`, `bus_nominal_v` and `bus_min_v`
      | [converter]
      | ^^^^^^^^^^^
    ");
}
