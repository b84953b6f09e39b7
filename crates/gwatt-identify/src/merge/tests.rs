//! Machine files that get figures.

use super::*;

const MACHINE: &str = r#"# Our mill.
schema = 1
name = "mill"
controller = "iso"

[converter]
peak_power_w = 3000 # data sheet

[axes.X]
rapid_mm_min = 24000
accel_mm_s2 = 4000
mass_kg = 300   # guessed
coulomb_n = 200

[axes.Y] # motor side
max_speed_rpm = 3000
accel_time_s = 0.1
inertia_kg_m2 = 0.01
friction_nm = 1.5
lead_mm = 10
"#;

fn figures() -> AxisFigures {
    AxisFigures {
        rotary: false,
        mass: 412.345_678,
        viscous: Some(150.0),
        coulomb: Some(-0.5),
        gravity: None,
        efficiency: None,
        std: None,
    }
}

#[test]
fn comments_stay_and_values_change() {
    let merged = into_machine("m.toml", MACHINE, AxisId::X, &figures(), Some(0.2)).unwrap();
    let expected = MACHINE
        .replace(
            "mass_kg = 300   # guessed",
            "mass_kg = 412.346   # was 300: guessed",
        )
        .replace(
            "coulomb_n = 200\n",
            "coulomb_n = 0.0\nviscous_n_s_m = 150.0\n",
        )
        + "\n[limits]\nmargin = 0.2\n";
    assert_eq!(merged, expected);
    // The comment stays about that value, and about this one where it stays.
    let lighter = AxisFigures {
        mass: 400.0,
        ..figures()
    };
    let again = into_machine("m.toml", &merged, AxisId::X, &lighter, None).unwrap();
    assert!(
        again.contains("mass_kg = 400.0   # was 300: guessed\n"),
        "{again}"
    );
    let same = AxisFigures {
        mass: 300.0,
        ..figures()
    };
    let same = into_machine("m.toml", MACHINE, AxisId::X, &same, None).unwrap();
    assert!(same.contains("mass_kg = 300.0   # guessed\n"), "{same}");
    // A smaller margin than the one in force changes nothing.
    let kept = into_machine("m.toml", MACHINE, AxisId::X, &figures(), Some(0.05)).unwrap();
    assert!(!kept.contains("margin"));
}

/// What is identified is the sum: its parts go, the lead stays where torque needs it.
#[test]
fn parts_give_way_to_the_sum() {
    let parts = "moved_mass_kg = 250\nrotor_kg_m2 = 0.001\nscrew = { diameter_mm = 32, length_mm = 900, lead_mm = 10 }";
    let machine = MACHINE.replace("mass_kg = 300   # guessed", parts);
    let merged = into_machine("m.toml", &machine, AxisId::X, &figures(), None).unwrap();
    assert!(merged.contains("mass_kg = 412.346\n"), "{merged}");
    for gone in ["moved_mass_kg", "rotor_kg_m2", "screw", "lead_mm = 10.0"] {
        assert!(!merged.contains(gone), "{gone} in {merged}");
    }
    // Of torque: J·k² with k = 2π/0.01 m.
    let torque = AxisFigures {
        rotary: true,
        mass: 0.002,
        ..figures()
    };
    let merged = into_machine("m.toml", &machine, AxisId::X, &torque, None).unwrap();
    assert!(merged.contains("mass_kg = 789.568\n"), "{merged}");
}

/// Figures found without losses hold for an efficiency of 1 alone.
#[test]
fn an_efficiency_that_is_found_replaces_another() {
    let with = |text: &str, efficiency| {
        let figures = AxisFigures {
            efficiency: Some(efficiency),
            ..figures()
        };
        into_machine("m.toml", text, AxisId::X, &figures, None).unwrap()
    };
    assert!(!with(MACHINE, 1.0).contains("efficiency"));
    let lossy = with(MACHINE, 0.85);
    assert!(lossy.contains("efficiency = 0.85\n"), "{lossy}");
    assert!(with(&lossy, 1.0).contains("efficiency = 1.0\n"));
}

#[test]
fn errors_are_two_standard_errors_as_a_share() {
    let with = |text: &str, std, coulomb| {
        let figures = AxisFigures {
            mass: 400.0,
            viscous: Some(100.0),
            coulomb: Some(coulomb),
            std: Some(std),
            ..figures()
        };
        into_machine("m.toml", text, AxisId::X, &figures, None).unwrap()
    };
    // At rest 2·10/200, at 0.4 m/s 2·(10 + 0.4·15)/(200 + 0.4·100).
    let known = with(MACHINE, [10.0, 15.0, 10.0], 200.0);
    assert!(known.contains("mass_error = 0.05\n"), "{known}");
    assert!(known.contains("friction_error = 0.133333\n"), "{known}");
    let (machine, _) = Machine::from_toml("m.toml", &known).unwrap();
    let axis = machine.axes[AxisId::X as usize].unwrap();
    assert_eq!([axis.mass_error, axis.friction_error], [0.05, 0.133_333]);
    // Friction that is well known at speed only is as little known as at rest.
    let known = with(MACHINE, [10.0, 0.0, 20.0], 200.0);
    assert!(known.contains("friction_error = 0.2\n"), "{known}");
    // Of a friction that may be none nothing can be said.
    let unknown = with(MACHINE, [10.0, 15.0, 10.0], 0.0);
    assert!(!unknown.contains("friction_error"), "{unknown}");
    // Larger errors in force stay.
    let careful = format!("{MACHINE}\n[limits]\nmass_error = 0.1\nfriction_error = 0.1\n");
    let kept = with(&careful, [10.0, 15.0, 10.0], 200.0);
    assert!(!kept.contains("mass_error = 0.05"), "{kept}");
    assert!(kept.contains("friction_error = 0.133333\n"), "{kept}");
}

#[test]
fn a_weight_is_written_where_it_is_clear_or_was_there() {
    let weighing = |value, std| AxisFigures {
        gravity: Some(Figure { value, std }),
        ..figures()
    };
    let merge = |text: &str, axis, figures: AxisFigures| {
        into_machine("m.toml", text, axis, &figures, None).unwrap()
    };
    assert!(!merge(MACHINE, AxisId::X, weighing(2.0, 1.0)).contains("gravity"));
    let clear = merge(MACHINE, AxisId::X, weighing(-40.0, 1.0));
    assert!(clear.contains("gravity_n = -40.0\n"));
    let again = merge(&clear, AxisId::X, weighing(2.0, 1.0));
    assert!(again.contains("gravity_n = 2.0\n"));
    // 40 N through k = 628.318 /m, where the file has it at the motor.
    let motor = MACHINE.replace("lead_mm = 10", "lead_mm = 10\ngravity_nm = 1");
    let found = merge(&motor, AxisId::Y, weighing(40.0, 1.0));
    assert!(found.contains("gravity_nm = 0.063662\n"), "{found}");
}

#[test]
fn motor_side_files_get_motor_side_figures() {
    // k = 2π/0.01 = 628.318: 412.346 kg are 1.04448e-3 kg·m².
    let merged = into_machine("m.toml", MACHINE, AxisId::Y, &figures(), None).unwrap();
    assert!(merged.contains("inertia_kg_m2 = 0.00104448\n"), "{merged}");
    assert!(merged.contains("friction_nm = 0.0\n"));
}

#[test]
fn what_does_not_go_together_is_refused() {
    let turning = AxisFigures {
        rotary: true,
        ..figures()
    };
    let refuse = |text, axis, figures: &AxisFigures| {
        into_machine("m.toml", text, axis, figures, None)
            .unwrap_err()
            .message
    };
    let message = refuse(MACHINE, AxisId::X, &turning);
    assert!(message.contains("it slides"), "{message}");
    let message = refuse(MACHINE, AxisId::Z, &figures());
    assert!(message.contains("no axis Z"), "{message}");
    let message = refuse("schema = 1\n", AxisId::X, &figures());
    assert!(message.contains("no sound machine file"), "{message}");
}
