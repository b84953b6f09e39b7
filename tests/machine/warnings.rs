//! Values that are possible, but look like another unit: the file is read.

use insta::assert_snapshot;

use super::{BASE, edited, findings, machine, with};

#[test]
fn acceleration_in_m_s2() {
    let text = edited("accel_mm_s2 = 6000", "accel_mm_s2 = 6");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 11, warning machine-unit: `accel_mm_s2`: 6 mm/s² is unusually small / m/s² given?
      | accel_mm_s2 = 6
      |               ^
    ");
}

#[test]
fn huge_acceleration() {
    let text = edited("accel_mm_s2 = 6000", "accel_mm_s2 = 6e6");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 11, warning machine-unit: `accel_mm_s2`: 6000000 mm/s² is unusually large / mm/min² or µm/s² given?
      | accel_mm_s2 = 6e6
      |               ^^^
    ");
}

#[test]
fn speed_in_m_min() {
    let text = edited("rapid_mm_min = 36000", "rapid_mm_min = 36");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 10, warning machine-unit: `rapid_mm_min`: 36 mm/min is unusually small / mm/s or m/min given?
      | rapid_mm_min = 36
      |                ^^
    ");
}

#[test]
fn mass_in_grams() {
    let text = edited("mass_kg = 900", "mass_kg = 900000");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 12, warning machine-unit: `mass_kg`: 900000 kg is unusually large / grams given, or an inertia in kg·cm²?
      | mass_kg = 900000
      |           ^^^^^^
    ");
}

#[test]
fn mass_in_tonnes() {
    let text = edited("mass_kg = 900", "mass_kg = 0.009");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 12, warning machine-unit: `mass_kg`: 0.009 kg is unusually small / tonnes given, or an inertia in kg·cm²?
      | mass_kg = 0.009
      |           ^^^^^
    ");
}

#[test]
fn inertia_in_kg_cm2() {
    let text = edited("mass_kg = 900", "inertia_kg_m2 = 50\nlead_mm = 10");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 12, warning machine-unit: `inertia_kg_m2`: a mass of 19740000 kg is unusually large / grams given, or an inertia in kg·cm²?
      | inertia_kg_m2 = 50
      |                 ^^
    ");
}

#[test]
fn time_in_ms() {
    let text = edited("accel_mm_s2 = 6000", "accel_time_s = 120");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 11, warning machine-unit: `accel_time_s`: 120 s is unusually large / milliseconds given?
      | accel_time_s = 120
      |                ^^^
    line 11, warning machine-unit: `accel_time_s`: an acceleration of 5 mm/s² is unusually small / m/s² given?
      | accel_time_s = 120
      |                ^^^
    ");
}

#[test]
fn power_in_kw() {
    let text = edited("peak_power_w = 3500", "peak_power_w = 3.5");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 6, warning machine-unit: `peak_power_w`: 3.5 W is unusually small / kW given?
      | peak_power_w = 3.5
      |                ^^^
    ");
}

#[test]
fn lead_in_um() {
    let text = edited("mass_kg = 900", "inertia_kg_m2 = 5000\nlead_mm = 10000");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 13, warning machine-unit: `lead_mm`: 10000 mm is unusually large / µm given?
      | lead_mm = 10000
      |           ^^^^^
    ");
}

#[test]
fn lead_without_use() {
    let text = edited("mass_kg = 900", "mass_kg = 900\nlead_mm = 10");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 13, warning machine-unit: `lead_mm` has no effect: nothing is given at the motor
      | lead_mm = 10
      |           ^^
    ");
}

#[test]
fn override_as_factor() {
    let text = with("[limits]\noverride_max_percent = { feed = 1.2, rapid = 1 }");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 20, warning machine-unit: override `feed` of 1.2 % is unusually low / as a factor? 1.2 is 120 %
      | override_max_percent = { feed = 1.2, rapid = 1 }
      |                                 ^^^
    line 20, warning machine-unit: override `rapid` of 1 % is unusually low / as a factor? 1 is 100 %
      | override_max_percent = { feed = 1.2, rapid = 1 }
      |                                              ^
    ");
}

#[test]
fn efficiency_too_low() {
    let text = edited("mass_kg = 900", "mass_kg = 900\nefficiency = 0.0085");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 13, warning machine-unit: `efficiency`: 0.0085 is unusually small / a share is meant: 85 % is 0.85
      | efficiency = 0.0085
      |              ^^^^^^
    ");
}

#[test]
fn servo_factor_in_percent() {
    let text = edited("mass_kg = 900", "mass_kg = 900\nservo_factor_motor = 120");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 13, warning machine-unit: `servo_factor_motor`: 120 is unusually large / a factor is meant, not percent
      | servo_factor_motor = 120
      |                      ^^^
    ");
}

#[test]
fn rotary_values() {
    let text = edited(
        "rapid_deg_min = 18000\naccel_deg_s2 = 1150\ninertia_kg_m2 = 12",
        "rapid_deg_min = 50\naccel_deg_s2 = 3\ninertia_kg_m2 = 1e6",
    );
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 16, warning machine-unit: `rapid_deg_min`: 50 degrees/min is unusually small / revolutions/min or degrees/s given?
      | rapid_deg_min = 50
      |                 ^^
    line 17, warning machine-unit: `accel_deg_s2`: 3 degrees/s² is unusually small / rad/s² or revolutions/s² given?
      | accel_deg_s2 = 3
      |                ^
    line 18, warning machine-unit: `inertia_kg_m2`: 1000000 kg·m² is unusually large / kg·cm² or kg·mm² given?
      | inertia_kg_m2 = 1e6
      |                 ^^^
    ");
}

#[test]
fn preset_above_the_limit() {
    let text = with("[[preset]]\naxes = [\"X\"]\nspeed_mm_min = { X = 50000 }");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 21, warning machine-preset: above the limit of axis X, 36000: it has no effect
      | speed_mm_min = { X = 50000 }
      |                      ^^^^^
    ");
}

#[test]
fn overload_above_the_peak() {
    let text = edited(
        "peak_power_w = 3500",
        "peak_power_w = 3500\ncontinuous_power_w = 2000\noverload = [{ power_w = 5000, seconds = 0.2, every_s = 10 }]",
    );
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 8, warning machine-converter: an overload above `peak_power_w` is never used
      | overload = [{ power_w = 5000, seconds = 0.2, every_s = 10 }]
      |                         ^^^^
    ");
}

#[test]
fn the_base_is_without_a_warning() {
    assert_eq!(findings(BASE), "");
}

#[test]
fn overload_with_nothing_below_it() {
    let text = edited(
        "peak_power_w = 3500",
        "peak_power_w = 3500\noverload = [{ power_w = 3000, seconds = 0.2, every_s = 10 }]",
    );
    let machine = machine(&text);
    assert_eq!(machine.converters[0].ratings.overload.len(), 1);
    assert_snapshot!(findings(&text), @r"
    line 7, warning machine-converter: `overload` without `continuous_power_w`: all power counts as overload / give the power that the converter delivers continuously
      | overload = [{ power_w = 3000, seconds = 0.2, every_s = 10 }]
      |             ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
}

#[test]
fn voltages_that_cannot_be_checked() {
    let text = edited(
        "peak_power_w = 3500",
        "peak_power_w = 3500\nbus_min_v = 480",
    );
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 7, warning machine-converter: `bus_min_v` is not checked: it takes the capacitance of the bus / give `capacitance_f` and `bus_nominal_v`
      | bus_min_v = 480
      |             ^^^
    ");
    let text = edited(
        "peak_power_w = 3500",
        "peak_power_w = 3500\ncapacitance_f = 0.004\nbus_nominal_v = 560\nbus_max_v = 760",
    );
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 9, warning machine-converter: `bus_max_v` is not checked: without `regen_power_w` any power can be fed back / give the largest power that converter or braking resistor take
      | bus_max_v = 760
      |             ^^^
    ");
}

/// A supply that takes nothing back: read as it stands, since it may be meant.
#[test]
fn nothing_may_be_fed_back() {
    let with = |more: &str| {
        let peak = "peak_power_w = 3500";
        edited(peak, &format!("{peak}\n{more}"))
    };
    let text = with("regen_power_w = 0");
    machine(&text);
    assert_snapshot!(findings(&text), @r"
    line 7, warning machine-braking: with `regen_power_w` of 0 no axis may brake: braking feeds power back / leave it out where the capacitors of the bus take what small drives feed back (`capacitance_f` and `bus_max_v` count that); else give what the supply or its braking resistor takes
      | regen_power_w = 0
      |                 ^
    ");
    for fine in [
        "regen_power_w = 1",
        "regen_power_w = 0\ncredit_regen = true",
    ] {
        assert_eq!(findings(&with(fine)), "");
    }
}

/// M203 of Marlin is in mm/s, of RepRapFirmware in mm/min: 500 mm/s read as mm/min is 60 times too
/// slow, and so are powers.
#[test]
fn speed_of_a_printer_in_mm_s() {
    let text = |controller: &str| {
        format!(
            "schema = 1\nname = \"t\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = 300\n\
             [axes.X]\nrapid_mm_min = 500\naccel_mm_s2 = 1000\nmass_kg = 1\n\
             [axes.Z]\nrapid_mm_min = 300\naccel_mm_s2 = 100\nmass_kg = 1\n"
        )
    };
    assert_snapshot!(findings(&text("marlin")), @r"
    line 7, warning machine-unit: `rapid_mm_min`: 500 mm/min is unusually small for a printer / mm/s given? 1 mm/s is 60 mm/min; powers would be too low
      | rapid_mm_min = 500
      |                ^^^
    ");
    assert_eq!(findings(&text("grbl")), "");
}
