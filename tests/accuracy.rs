//! Errors of mass and friction: peaks are those of the worst machine within them.

use crate::rig::{any_arc, any_delta, any_feed, any_machine, arc, axis, machine, straight};
use gwatt::diagnostic::Severity;
use gwatt::interpret::Move;
use gwatt::machine::{Axis, Machine};
use gwatt::pipeline::assumptions;
use gwatt::plan::{Overrides, plan};
use gwatt::power::{Demand, PowerModel, Want};
use proptest::prelude::*;

use crate::machines::machine_from;
use crate::near::assert_near;

fn demand(machine: &Machine, mv: &Move) -> Demand {
    let plan = plan(machine, mv, Overrides::default());
    PowerModel::new(machine).demand(mv, &plan, Want::ALL)
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert_near(found, expected, 1e-9 * expected.abs());
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
    machine_from(&text)
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
            "taken as exact; only the margin covers errors in: \
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
            "taken as exact; only the margin covers errors in: \
             mass (XY), friction (X), how servos follow (Y)",
            "counted as none, as the machine file gives none: \
             friction (Y), losses of the drive (Y)",
        ]
    );
}

/// Two poles at 2·Kv and the speed fed forward: full braking, then full acceleration,
/// overshoots by 2·e⁻² = 0.2707 (see `machine::servo`).
#[test]
fn a_servo_that_is_described_sets_its_factors() {
    let bandwidth = 200.0 / std::f64::consts::TAU;
    let servo = format!(
        "position_gain_1_s = 50\nvelocity_bandwidth_hz = {bandwidth}\nvelocity_feedforward = 1"
    );
    let mut machine = file("", &servo);
    let factors = machine.axes[0].map(|it| [it.servo_factor_motor, it.servo_factor_regen]);
    assert_eq!(factors, Some([1.271; 2]));
    assert_eq!(
        assumptions(&machine),
        [
            "servos as described (X): the power of acceleration exceeds that of the \
             command by a factor of at most 1.271",
            "taken as exact; only the margin covers errors in: \
             mass (XY), friction (X), how servos follow (Y)",
            "counted as none, as the machine file gives none: \
             friction (Y), losses of the drive (Y)",
        ]
    );
    // Y, of which nothing is known, takes 10 ms for a step of speed.
    assert_eq!(machine.path.response_time_s, 0.005);
    // 100 kg at 5 m/s² to 0.5 m/s, 50 N of friction, 90 %.
    machine.axes[1] = None;
    let mv = straight(&machine, &[500.0], f64::INFINITY);
    let found = demand(&machine, &mv);
    close(found.peak_w, 0.5 * (500.0 * 1.271 + 50.0) / 0.9);
    close(found.regen_w, 0.5 * (500.0 * 1.271 - 50.0) * 0.9);
}

/// Only axes that share a converter draw from it one after the other.
#[test]
fn servos_of_a_converter_count_together() {
    let text = |converters: &str| {
        let axis = |(letter, gain)| {
            format!(
                "[axes.{letter}]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 100\n\
                 position_gain_1_s = {gain}\nvelocity_bandwidth_hz = 60\n"
            )
        };
        let axes = [("X", 20), ("Y", 40)].map(axis).concat();
        format!("schema = 1\nname = \"t\"\ncontroller = \"iso\"\n{converters}{axes}")
    };
    let factors = |converters: &str| {
        let (machine, _) = Machine::from_toml("t.toml", &text(converters)).expect("it is valid");
        [0, 1].map(|axis| machine.axes[axis].map_or(0.0, |axis| axis.servo_factor_motor))
    };
    let shared = factors("[converter]\npeak_power_w = 3500\n");
    assert!(
        shared[0] > 1.2 && shared[0] < 2.0 && shared[0] == shared[1],
        "{shared:?}"
    );
    let own = |name: &str, axis: &str| {
        format!("[[converter]]\nname = \"{name}\"\naxes = [\"{axis}\"]\npeak_power_w = 3500\n")
    };
    assert_eq!(factors(&(own("A", "X") + &own("B", "Y"))), [1.0; 2]);
}

/// The message and the help of the error in the last line of an axis.
fn refused(x: &str) -> (String, String) {
    let text = "schema = 1\nname = \"t\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 9\n\
                [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 100\n";
    let errors = Machine::from_toml("t.toml", &format!("{text}{x}\n")).expect_err(x);
    let line = 9 + x.lines().count();
    let found = errors
        .iter()
        .find(|it| it.line as usize == line && it.severity == Severity::Error);
    let found = found.unwrap_or_else(|| panic!("{errors:?}"));
    (
        found.message.clone(),
        found.help.clone().unwrap_or_default(),
    )
}

#[test]
fn half_a_servo_and_two_of_them_are_refused() {
    let (message, help) = refused("position_gain_1_s = 50");
    assert_eq!(message, "`position_gain_1_s` needs `velocity_bandwidth_hz`");
    assert_eq!(
        help,
        "give both, or set servo_factor_motor and _regen of axis X"
    );
    for key in [
        "velocity_bandwidth_hz",
        "velocity_integral_time_s",
        "velocity_feedforward",
        "acceleration_feedforward",
    ] {
        let (message, _) = refused(&format!("{key} = 1"));
        assert_eq!(message, format!("`{key}` needs `position_gain_1_s`"));
    }
    for key in ["servo_factor_motor", "servo_factor_regen"] {
        let (message, help) = refused(&format!(
            "position_gain_1_s = 50\nvelocity_bandwidth_hz = 60\n{key} = 1.2"
        ));
        assert_eq!(
            message,
            format!("`{key}` and `position_gain_1_s` say the same twice")
        );
        assert_eq!(
            help,
            "keep the factors, or the servo from which they would follow"
        );
    }
    let (message, help) = refused(
        "velocity_bandwidth_hz = 5\nvelocity_integral_time_s = 0.01\nposition_gain_1_s = 100",
    );
    assert_eq!(
        message,
        "the servo of axis X oscillates and does not settle"
    );
    assert_eq!(
        help,
        "give a lower gain, a larger bandwidth or a longer integral time"
    );
    let (_, help) = refused("velocity_feedforward = 100");
    assert_eq!(help, "in percent? 100 % is 1");
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
