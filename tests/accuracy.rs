//! Errors of mass and friction: peaks are those of the worst machine within them.

use crate::rig::{any_arc, any_delta, any_feed, any_machine, arc, axis, machine, straight};
use gwatt::interpret::Move;
use gwatt::machine::{Axis, Machine};
use gwatt::pipeline::assumptions;
use gwatt::plan::{Overrides, plan};
use gwatt::power::{Demand, PowerModel, Want};
use proptest::prelude::*;

fn demand(machine: &Machine, mv: &Move) -> Demand {
    let plan = plan(machine, mv, Overrides::default());
    PowerModel::new(machine).demand(mv, &plan, Want::ALL)
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 1e-9 * expected.abs(),
        "{found}, not {expected}"
    );
}

/// 100 kg ± 10 %, 5 m/s² to 0.5 m/s, 100 N ± 30 %: 110 kg and 130 N draw most; 110 kg,
/// and 70 N of which half is left when warm, feed back most.
#[test]
fn peaks_are_those_of_the_heaviest_machine_and_its_worse_friction() {
    let mut machine = machine(&[Axis {
        coulomb_n: 100.0,
        mass_error: 0.1,
        friction_error: 0.3,
        ..axis()
    }]);
    let mv = straight(&machine, &[500.0], f64::INFINITY);
    let found = demand(&machine, &mv);
    close(found.peak_w, 0.5 * (550.0 + 130.0));
    close(found.regen_w, 0.5 * (550.0 - 70.0));
    machine.axes[0] = machine.axes[0].map(|axis| Axis {
        servo_factor_motor: 1.3,
        servo_factor_regen: 1.2,
        friction_min_ratio: 0.5,
        ..axis
    });
    let found = demand(&machine, &mv);
    close(found.peak_w, 0.5 * (550.0 * 1.3 + 130.0));
    close(found.regen_w, 0.5 * (550.0 * 1.2 - 35.0));
    // Energies are those of the description: what is fed back is not credited, so that
    // 600 N act over the 25 mm of the ramp, then 100 N over 450 mm.
    close(found.energy_j, 0.025 * 600.0 + 0.45 * 100.0);
}

/// Viscous friction, 20 N·s/m ± 50 % at 0.5 m/s: 15 N at most, 5 N at least.
#[test]
fn viscous_friction_has_the_error_too() {
    let machine = machine(&[Axis {
        viscous_n_s_m: 20.0,
        friction_error: 0.5,
        ..axis()
    }]);
    let mv = straight(&machine, &[500.0], f64::INFINITY);
    let found = demand(&machine, &mv);
    close(found.peak_w, 0.5 * (500.0 + 15.0));
    close(found.regen_w, 0.5 * (500.0 - 5.0));
}

fn file(limits: &str, x: &str) -> Machine {
    let text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 3500\n\
         [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 100\ncoulomb_n = 50\n\
         efficiency = 0.9\n{x}\n\
         [axes.Y]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 100\n[limits]\n{limits}\n"
    );
    match Machine::from_toml("test.toml", &text) {
        Ok((machine, _)) => machine,
        Err(errors) => panic!("{errors:?}"),
    }
}

#[test]
fn an_axis_keeps_its_own_errors() {
    let machine = file(
        "mass_error = 0.1\nfriction_error = 0.3",
        "mass_error = 0.25\nfriction_error = 0",
    );
    let errors = |index: usize| machine.axes[index].map(|it| (it.mass_error, it.friction_error));
    assert_eq!(errors(0), Some((0.25, 0.0)));
    assert_eq!(errors(1), Some((0.1, 0.3)));
    assert_eq!(
        assumptions(&machine),
        [
            "every machine within these errors: X mass ±25 %, friction ±0 %, \
             Y mass ±10 %, friction ±30 %; weights as the machine file has them",
            "taken as exact, with the margin alone for what differs: \
             friction (X), how servos follow (XY)",
            "counted as none, as the machine file gives none: \
             friction (Y), losses of the drive (Y)",
        ]
    );
}

#[test]
fn without_errors_it_is_said_what_counts_as_exact() {
    assert_eq!(
        assumptions(&file(
            "",
            "servo_factor_motor = 1.3\nservo_factor_regen = 1.2"
        )),
        [
            "taken as exact, with the margin alone for what differs: \
             mass (XY), friction (X), how servos follow (Y)",
            "counted as none, as the machine file gives none: \
             friction (Y), losses of the drive (Y)",
        ]
    );
}

#[test]
fn an_error_in_percent_is_refused() {
    let text = "schema = 1\nname = \"t\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 1\n\
                [axes.X]\nrapid_mm_min = 1\naccel_mm_s2 = 1\nmass_kg = 1\nmass_error = 20\n";
    let errors = Machine::from_toml("t.toml", text).expect_err("20 is no share");
    let refused = errors
        .iter()
        .find(|it| it.line == 10)
        .expect("the line is named");
    assert_eq!(
        refused.message,
        "`mass_error` must be less than 1, but is 20"
    );
    assert_eq!(refused.help.as_deref(), Some("in percent? 20 % is 0.2"));
}

/// A machine whose mass and friction differ from the description by shares of the
/// errors, and the description with the errors.
fn pair(mut machine: Machine, errors: [f64; 2], shares: [[f64; 2]; 3]) -> (Machine, Machine) {
    let mut real = machine.clone();
    for (index, [mass, friction]) in shares.into_iter().enumerate() {
        let described = machine.axes[index].map(|axis| Axis {
            mass_error: errors[0],
            friction_error: errors[1],
            ..axis
        });
        machine.axes[index] = described;
        real.axes[index] = described.map(|axis| Axis {
            mass_kg: axis.mass_kg * (1.0 + mass * errors[0]),
            coulomb_n: axis.coulomb_n * (1.0 + friction * errors[1]),
            viscous_n_s_m: axis.viscous_n_s_m * (1.0 + friction * errors[1]),
            mass_error: 0.0,
            friction_error: 0.0,
            ..axis
        });
    }
    (real, machine)
}

fn bears(described: &Demand, real: &Demand) -> Result<(), TestCaseError> {
    for (bound, real) in [
        (described.peak_w, real.peak_w),
        (described.regen_w, real.regen_w),
    ] {
        prop_assert!(real <= bound * (1.0 + 1e-6) + 1e-9, "{real} W, {bound} W");
    }
    Ok(())
}

fn share() -> impl Strategy<Value = f64> {
    prop_oneof![Just(-1.0), Just(1.0), -1.0..1.0_f64]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_machine_within_the_errors_draws_more_on_lines(
        machine in any_machine(), delta in any_delta(), feed in any_feed(),
        errors in [0.0..0.5_f64, 0.0..0.9_f64],
        shares in [[share(), share()], [share(), share()], [share(), share()]],
    ) {
        let (real, described) = pair(machine, errors, shares);
        let mv = straight(&real, &delta, feed);
        bears(&demand(&described, &mv), &demand(&real, &mv))?;
    }

    #[test]
    fn no_machine_within_the_errors_draws_more_on_arcs(
        machine in any_machine(), shape in any_arc(),
        errors in [0.0..0.5_f64, 0.0..0.9_f64],
        shares in [[share(), share()], [share(), share()], [share(), share()]],
    ) {
        let (real, described) = pair(machine, errors, shares);
        let (plane, radius, angles, lift, feed) = shape;
        let mv = arc(&real, plane, radius, angles, lift, feed);
        bears(&demand(&described, &mv), &demand(&real, &mv))?;
    }
}
