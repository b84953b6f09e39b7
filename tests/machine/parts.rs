//! Masses as sums of parts, worked by hand.

use gwatt::machine::{Axis, AxisId, Machine};
use insta::assert_snapshot;

use super::{edited, findings, machine, near};

const X: &str = "rapid_mm_min = 36000\naccel_mm_s2 = 6000\nmass_kg = 900\n";
const B: &str = "rapid_deg_min = 18000\naccel_deg_s2 = 1150\ninertia_kg_m2 = 12\n";

/// The base machine with these lines in place of the mass of X.
fn with_x(lines: &str) -> String {
    edited(
        X,
        &format!("rapid_mm_min = 36000\naccel_mm_s2 = 6000\n{lines}\n"),
    )
}

fn axis(machine: &Machine, id: AxisId) -> Axis {
    machine.axes[id as usize].expect("the axis")
}

/// Lead 10 mm: k = 2π/0.01 m, k² = 394784.18. Rotor: 0.0002·k² = 78.956835 kg. Screw:
/// π/32·7850·1·0.032⁴ = 8.0810811e-4 kg·m², times k² = 319.02830 kg.
#[test]
fn a_screw_with_its_rotor() {
    let text = with_x(
        "moved_mass_kg = 300\nrotor_kg_m2 = 0.0002\nscrew = { diameter_mm = 32, length_mm = 1000, lead_mm = 10 }",
    );
    let made = machine(&text);
    near(
        axis(&made, AxisId::X).mass_kg,
        300.0 + 78.956_835 + 319.028_30,
    );
    let [(AxisId::X, parts)] = made.mass_parts.as_slice() else {
        panic!("{:?}", made.mass_parts);
    };
    let named: Vec<&str> = parts.iter().map(|part| part.name).collect();
    assert_eq!(named, ["moved mass", "rotor", "screw"]);
    near(parts[0].mass_kg, 300.0);
    near(parts[1].mass_kg, 78.956_835);
    near(parts[2].mass_kg, 319.028_30);
    near(parts[2].inertia_kg_m2.unwrap(), 8.081_081_1e-4);
}

/// After a gear of 2 the rotor counts four times, the screw once.
#[test]
fn a_gear_acts_on_the_rotor() {
    let text = with_x(
        "moved_mass_kg = 300\nrotor_kg_m2 = 0.0002\ngear_ratio = 2\nlead_mm = 10\nscrew = { diameter_mm = 32, length_mm = 1000 }",
    );
    let x = axis(&machine(&text), AxisId::X);
    near(x.mass_kg, 300.0 + 4.0 * 78.956_835 + 319.028_30);
}

/// 20 teeth of 2 mm: 40 mm a revolution, k = 157.07963, d = 12.732395 mm. Rotor: 5.4e-6·k² =
/// 0.13323966 kg. Two pulleys of π/32·7850·0.016·d⁴ = 3.2406e-7 kg·m²: 0.0159916 kg.
#[test]
fn a_belt() {
    let text = with_x(
        "moved_mass_kg = 0.5\nrotor_kg_m2 = 0.0000054\npulley = { teeth = 20, pitch_mm = 2, width_mm = 16 }",
    );
    let x = axis(&machine(&text), AxisId::X);
    assert!((x.mass_kg - 0.649_231).abs() < 1e-5, "{}", x.mass_kg);
    // One of known inertia: 1e-6·k² = 0.024674011 kg.
    let text = with_x(
        "moved_mass_kg = 0.5\nrotor_kg_m2 = 0\npulley = { teeth = 20, pitch_mm = 2, inertia_kg_m2 = 1e-6, count = 1 }",
    );
    near(axis(&machine(&text), AxisId::X).mass_kg, 0.524_674_011);
}

/// Pitch circle 60 mm: k = 1/0.03 m. Rotor with a gear of 5: 0.003·(5·k)² = 83.333333 kg. Pinion:
/// π/32·7850·0.03·0.06⁴ = 2.9963725e-4 kg·m², 0.33293028 kg. 3000 rpm are 600/min of it.
#[test]
fn a_rack() {
    let text = edited(
        X,
        "max_speed_rpm = 3000\naccel_mm_s2 = 6000\nmoved_mass_kg = 40\nrotor_kg_m2 = 0.003\ngear_ratio = 5\npinion = { diameter_mm = 60, width_mm = 30 }\n",
    );
    let x = axis(&machine(&text), AxisId::X);
    near(x.mass_kg, 40.0 + 83.333_333 + 0.332_930_28);
    near(x.rapid_mm_s, 10.0 * std::f64::consts::PI * 60.0);
}

/// At the table: 0.001·90² = 8.1 kg·m² and 0.5.
#[test]
fn a_table() {
    let text = edited(
        B,
        "rapid_deg_min = 18000\naccel_deg_s2 = 1150\nmoved_inertia_kg_m2 = 0.5\nrotor_kg_m2 = 0.001\ngear_ratio = 90\n",
    );
    near(axis(&machine(&text), AxisId::B).mass_kg, 8.6);
}

/// Load side and rotor are a sum, and so are all at the motor and a screw.
#[test]
fn other_forms_add_up_too() {
    let text = with_x("mass_kg = 900\nrotor_kg_m2 = 0.0002\nlead_mm = 10");
    near(axis(&machine(&text), AxisId::X).mass_kg, 978.956_835);
    let text = with_x(
        "inertia_kg_m2 = 0.0002\nscrew = { diameter_mm = 32, length_mm = 1000, lead_mm = 10 }",
    );
    near(
        axis(&machine(&text), AxisId::X).mass_kg,
        78.956_835 + 319.028_30,
    );
    // Without parts nothing changes, and there is no sum to show.
    assert!(machine(&with_x("mass_kg = 900")).mass_parts.is_empty());
}

/// What moves in an extruder are gears and wheels: nobody asks for a screw.
#[test]
fn an_extruder_has_no_screw() {
    let extruder = "[axes.E]\nkind = \"linear\"\nrapid_mm_min = 3000\naccel_mm_s2 = 5000\n\
                    moved_mass_kg = 0.1\nrotor_kg_m2 = 0.0000054\nlead_mm = 22.7\n";
    let text = edited(B, &format!("{B}{extruder}"));
    assert_eq!(findings(&text), "");
    // 0.0000054 kg·m² · (2π/0.0227 m)² = 0.41371549 kg.
    near(axis(&machine(&text), AxisId::E).mass_kg, 0.1 + 0.413_715_49);
}

#[test]
fn parts_that_do_not_go_together() {
    assert_snapshot!(findings(&with_x("moved_mass_kg = 300\nlead_mm = 10")), @r"
    line 12, error machine-missing: `moved_mass_kg` is without the drive: `rotor_kg_m2` is missing / the rotor's inertia, from the motor's data sheet, with coupling and brake; 0 for a linear motor. 1 kg·cm² is 1e-4 kg·m²
      | moved_mass_kg = 300
      |                 ^^^
    line 13, warning machine-missing: the inertia of what turns besides the rotor counts as none / give `screw`, such as screw = { diameter_mm = 32, length_mm = 900 }, or add it to `rotor_kg_m2`
      | lead_mm = 10
      |           ^^
    line 13, warning machine-unit: `lead_mm` has no effect: nothing is given at the motor
      | lead_mm = 10
      |           ^^
    ");
    assert_snapshot!(findings(&with_x("moved_mass_kg = 300\nmass_kg = 400\nrotor_kg_m2 = 0")), @r"
    line 12, error machine-twice: `mass_kg` and `moved_mass_kg` give the same quantity of axis X / keep one of the two
      | moved_mass_kg = 300
      |                 ^^^
    ");
    assert_snapshot!(findings(&with_x("moved_mass_kg = 300\nrotor_kg_m2 = 0.001")), @r"
    line 13, error machine-missing: `rotor_kg_m2` is at the motor, but axis X has no `lead_mm` / give the screw's `lead_mm`, or the quantity at the load
      | rotor_kg_m2 = 0.001
      |               ^^^^^
    ");
    assert_snapshot!(findings(&with_x("moved_mass_kg = 300\nrotor_kg_m2 = 0\nscrew = { diameter_mm = 32, length_mm = 1000 }")), @r"
    line 14, error machine-missing: the screw of axis X has no lead / give its `lead_mm`: travel per revolution
      | screw = { diameter_mm = 32, length_mm = 1000 }
      |         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&with_x("mass_kg = 300\nlead_mm = 10\npinion = { diameter_mm = 60, width_mm = 30 }")), @r"
    line 13, warning machine-unit: `lead_mm` has no effect: nothing is given at the motor
      | lead_mm = 10
      |           ^^
    line 14, error machine-twice: `lead_mm` and `pinion` both say how far axis X goes in a revolution / keep one of the two
      | pinion = { diameter_mm = 60, width_mm = 30 }
      |          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&with_x("mass_kg = 300\npulley = { teeth = 20, width_mm = 9 }")), @r"
    line 13, error machine-missing: `pulley` of axis X needs the diameter of its pitch circle / give `diameter_mm`, or `teeth` and `pitch_mm`
      | pulley = { teeth = 20, width_mm = 9 }
      |          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&with_x("mass_kg = 300\npulley = { diameter_mm = 20, teeth = 20, pitch_mm = 2 }")), @r"
    line 13, error machine-twice: `pulley` has its diameter twice / keep `diameter_mm`, or `teeth` and `pitch_mm`
      | pulley = { diameter_mm = 20, teeth = 20, pitch_mm = 2 }
      |          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    line 13, error machine-missing: `pulley` of axis X needs an inertia / give `width_mm` (it counts as solid steel), or `inertia_kg_m2` of each one
      | pulley = { diameter_mm = 20, teeth = 20, pitch_mm = 2 }
      |          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&with_x("mass_kg = 300\npinion = { diameter_mm = 60, width_mm = 30, inertia_kg_m2 = 1e-4 }")), @r"
    line 13, error machine-twice: `pinion` has its inertia twice / keep `width_mm` or `inertia_kg_m2`
      | pinion = { diameter_mm = 60, width_mm = 30, inertia_kg_m2 = 1e-4 }
      |          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&with_x("moved_inertia_kg_m2 = 3")), @r#"
    line 12, error machine-kind: `moved_inertia_kg_m2` belongs to a rotary axis, but axis X is linear / give `moved_mass_kg`, or set kind = "rotary"
      | moved_inertia_kg_m2 = 3
      |                       ^
    "#);
    assert_snapshot!(findings(&edited(B, &format!("{B}moved_mass_kg = 5\nscrew = {{ diameter_mm = 32, length_mm = 1000, lead_mm = 10 }}\n"))), @r#"
    line 19, error machine-kind: `moved_mass_kg` belongs to a linear axis, but axis B is rotary / give `moved_inertia_kg_m2`, or set kind = "linear"
      | moved_mass_kg = 5
      |                 ^
    line 20, error machine-kind: `screw` belongs to a linear axis, but axis B is rotary / give `gear_ratio`, or set kind = "linear"
      | screw = { diameter_mm = 32, length_mm = 1000, lead_mm = 10 }
      |         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
    "#);
    assert_snapshot!(findings(&edited(B, "rapid_deg_min = 18000\naccel_deg_s2 = 1150\nmoved_inertia_kg_m2 = 0.5\n")), @r"
    line 18, error machine-missing: `moved_inertia_kg_m2` is without the drive: `rotor_kg_m2` is missing / the rotor's inertia, from the motor's data sheet, with coupling and brake; 0 for a linear motor. 1 kg·cm² is 1e-4 kg·m²
      | moved_inertia_kg_m2 = 0.5
      |                       ^^^
    ");
    assert_snapshot!(findings(&with_x("")), @r"
    line 8, error machine-missing: axis X needs a mass or an inertia / give `moved_mass_kg` with `rotor_kg_m2` and `screw`, `pulley` or `pinion`; or all of it as `mass_kg` at the load or `inertia_kg_m2` at the motor
      | [axes.X]
      | ^^^^^^^^
    ");
}

/// What is absurd once all is known.
#[test]
fn absurd_values_are_named() {
    assert_snapshot!(findings(&with_x("mass_kg = 900\njerk_mm_s3 = 10")), @r"
    line 13, warning machine-unit: a jerk of 10 mm/s³ takes 600 s to the full acceleration / m/s³ given? 1 m/s³ is 1000 mm/s³; powers would be too low
      | jerk_mm_s3 = 10
      |              ^^
    ");
    assert_snapshot!(findings(&with_x("mass_kg = 900\ncoulomb_n = 7000")), @r"
    line 13, warning machine-unit: friction alone takes 4200 W of axis X at its rapid speed, more than the converter's 3500 W / friction in N is meant, speed in mm/min, power in W
      | coulomb_n = 7000
      |             ^^^^
    ");
    let curve = "mass_kg = 900\nforce_curve = [{ speed_mm_min = 0, force_n = 3000 }, { speed_mm_min = 36000, force_n = 1000 }]";
    assert_snapshot!(findings(&with_x(curve)), @r"
    line 11, warning machine-unit: the acceleration of axis X needs 5400 N, and its drive gives 3000 N at rest: it accelerates as that permits / check mass, acceleration and the curve
      | accel_mm_s2 = 6000
      |               ^^^^
    ");
    assert_snapshot!(findings(&edited(X, "rapid_mm_min = 1\naccel_mm_s2 = 6000\nmass_kg = 900\n")), @r"
    line 10, warning machine-unit: `rapid_mm_min`: 1 mm/min is unusually small / mm/s or m/min given?
      | rapid_mm_min = 1
      |                ^
    ");
}
