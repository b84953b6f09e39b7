//! A machine file as people see it, and as gwatt reads it once it is filled in.

use gwatt_machine::{AxisId, CornerRule, Machine};
use insta::assert_snapshot;

use super::{imported, render};

const GRBL: &str = "$11=0.020\n$110=8000\n$111=8000\n$112=500\n$120=400\n$121=400\n$122=50\n$100=80.000\n$130=740\n";

#[test]
fn as_it_is_written() {
    assert_snapshot!(imported(GRBL).toml, @r#"
    # Machine under grbl, from settings
    #
    # Every value has its source next to it. What that file cannot know is asked for below:
    # peak power of the supply, masses and friction. `gwatt machine check` names what is
    # still missing.
    #
    # For example an axis that moves 60 kg by a screw of 20 x 800 mm with a lead of 10 mm and
    # a rotor of 1.2 kg cm2 (data sheet of the motor; 1 kg cm2 is 0.0001 kg m2):
    #
    #     moved_mass_kg = 60
    #     rotor_kg_m2 = 0.00012
    #     screw = { diameter_mm = 20, length_mm = 800, lead_mm = 10 }
    #     coulomb_n = 100
    #     efficiency = 0.85
    #
    # That is 60 kg + 47.4 kg of the rotor + 38.9 kg of the screw: 146 kg. At 30000 mm/min
    # and 3000 mm/s2 it draws 0.5 m/s x (146.3 kg x 3 m/s2 + 100 N) / 0.85 = 317 W.
    schema = 1
    name = "Machine under grbl"
    controller = "grbl"

    [converter]
    # peak_power_w =             # what the supply of the drives delivers at most, in W
    # regen_power_w =            # what it takes back; left out: not checked
    # base_load_w =              # control, fans, pumps that always run

    [look_ahead.junction_deviation]
    deviation_mm = 0.02          # $11=0.020 (line 1)

    # Travel: $130=740 (line 9)
    [axes.X]
    kind = "linear"
    rapid_mm_min = 8000          # $110=8000 (line 2)
    accel_mm_s2 = 400            # $120=400 (line 5)
    # Steps per unit of travel: $100=80.000 (line 8); travel of a revolution is the motor's steps
    # by it.
    # moved_mass_kg =            # what slides: table, workpiece, spindle head
    # rotor_kg_m2 =              # rotor, with coupling and brake
    # screw = { diameter_mm = , length_mm = , lead_mm = } # or pulley, pinion
    # coulomb_n =                # friction; without it none counts
    # efficiency =               # mechanical by electrical power; without it 1

    [axes.Y]
    kind = "linear"
    rapid_mm_min = 8000          # $111=8000 (line 3)
    accel_mm_s2 = 400            # $121=400 (line 6)
    # moved_mass_kg =            # what slides: table, workpiece, spindle head
    # rotor_kg_m2 =              # rotor, with coupling and brake
    # screw = { diameter_mm = , length_mm = , lead_mm = } # or pulley, pinion
    # coulomb_n =                # friction; without it none counts
    # efficiency =               # mechanical by electrical power; without it 1

    [axes.Z]
    kind = "linear"
    rapid_mm_min = 500           # $112=500 (line 4)
    accel_mm_s2 = 50             # $122=50 (line 7)
    # moved_mass_kg =            # what slides: table, workpiece, spindle head
    # rotor_kg_m2 =              # rotor, with coupling and brake
    # screw = { diameter_mm = , length_mm = , lead_mm = } # or pulley, pinion
    # coulomb_n =                # friction; without it none counts
    # gravity_n =                # weight that nothing balances
    # efficiency =               # mechanical by electrical power; without it 1

    [limits]
    margin = 0.1                 # share of the peak power that is kept free
    "#);
}

const SCREW: &str = "screw = { diameter_mm = 20, length_mm = 800, lead_mm = 10 }";

/// A person fills in what is asked for.
fn filled(toml: &str) -> String {
    let answers = [
        ("# peak_power_w = ", "peak_power_w = 4000 "),
        ("# moved_mass_kg = ", "moved_mass_kg = 60 "),
        ("# rotor_kg_m2 = ", "rotor_kg_m2 = 0.00012 "),
        (
            "# screw = { diameter_mm = , length_mm = , lead_mm = }",
            SCREW,
        ),
    ];
    answers
        .into_iter()
        .fold(toml.to_owned(), |text, (asked, given)| {
            text.replace(asked, given)
        })
}

/// The head's example: 60 kg + 47.4 kg of the rotor + 38.9 kg of the screw.
#[test]
fn filled_in_it_is_a_machine() {
    let (machine, _) = Machine::from_toml("m.toml", &filled(&imported(GRBL).toml)).unwrap();
    let x = machine.axes[AxisId::X as usize].unwrap();
    assert!((x.rapid_mm_s - 8000.0 / 60.0).abs() < 1e-9);
    assert_eq!(x.accel_mm_s2, 400.0);
    assert!((x.mass_kg - 146.3).abs() < 0.05, "{}", x.mass_kg);
    let rules = machine.controller.planner.look_ahead.unwrap();
    let CornerRule::JunctionDeviation {
        deviation_mm,
        per_axis,
        ..
    } = rules.corner
    else {
        panic!("{rules:?}");
    };
    assert_eq!((deviation_mm, per_axis), (0.02, true));
}

/// Nothing is filled in: each field that is missing is named, with what to write.
#[test]
fn what_is_missing_is_named() {
    let errors = Machine::from_toml("m.toml", &imported(GRBL).toml).unwrap_err();
    let said: Vec<String> = errors
        .iter()
        .map(|it| format!("{} / {}", it.message, it.help.as_deref().unwrap_or("")))
        .collect();
    assert_snapshot!(said.join("\n"), @r"
    `peak_power_w` is missing in `converter` / What the supply of the drives delivers at most, in W: see its data sheet or label
    axis X needs a mass or an inertia / give `moved_mass_kg` with `rotor_kg_m2` and `screw`, `pulley` or `pinion`; or all of it as `mass_kg` at the load or `inertia_kg_m2` at the motor
    axis Y needs a mass or an inertia / give `moved_mass_kg` with `rotor_kg_m2` and `screw`, `pulley` or `pinion`; or all of it as `mass_kg` at the load or `inertia_kg_m2` at the motor
    axis Z needs a mass or an inertia / give `moved_mass_kg` with `rotor_kg_m2` and `screw`, `pulley` or `pinion`; or all of it as `mass_kg` at the load or `inertia_kg_m2` at the motor
    ");
}

/// Axes that share their motors count with the higher speed and acceleration of both: only so
/// `machine check` takes the file.
#[test]
fn axes_that_share_motors_are_alike_once_they_are_filled_in() {
    let text = "[printer]\nkinematics: corexz\nmax_velocity: 200\nmax_accel: 2500\nmax_z_velocity: 5\nmax_z_accel: 100\n\
                [stepper_x]\nposition_endstop: 0\n";
    let found = imported(text);
    assert_snapshot!(render(&found.warnings), @r"
    settings:2, warning: two motors move two axes together: they count by the robust bound / give both axes the larger mass and friction, and the rotors of both motors
      | kinematics: corexz
      |             ^^^^^^
    settings:0, warning: Z counts with the speed of X, which is higher: they share their motors / what motors draw is bounded only where both axes are alike; times of moves may be too short
    settings:0, warning: Z counts with the acceleration of X, which is higher: they share their motors / what motors draw is bounded only where both axes are alike; times of moves may be too short
    ");
    let lines = found
        .toml
        .lines()
        .filter(|line| line.starts_with("rapid") || line.starts_with("accel"));
    assert_snapshot!(lines.collect::<Vec<_>>().join("\n"), @r"
    rapid_mm_min = 12000         # max_velocity: 200 (line 3)
    accel_mm_s2 = 2500           # max_accel: 2500 (line 4)
    rapid_mm_min = 12000         # max_velocity: 200 (line 3)
    accel_mm_s2 = 2500           # max_accel: 2500 (line 4)
    rapid_mm_min = 12000         # that of X: max_velocity: 200 (line 3); its own: max_z_velocity: 5 (line 5)
    accel_mm_s2 = 2500           # that of X: max_accel: 2500 (line 4); its own: max_z_accel: 100 (line 6)
    ");
    let pulley =
        filled(&found.toml).replace("# pulley = { teeth = , pitch_mm = , width_mm = }", SCREW);
    let (machine, _) = Machine::from_toml("m.toml", &pulley).unwrap();
    let [x, z] = [AxisId::X, AxisId::Z].map(|id| machine.axes[id as usize].unwrap());
    assert_eq!(x.rapid_mm_s, z.rapid_mm_s);
    assert_eq!(found.toml.matches("for X as for Z").count(), 4);
    // In the other order.
    let core = "M669 K1\nM203 X30000 Y36000\nM201 X3500 Y3000\nM566 X600 Y600\n";
    let found = imported(core);
    assert_snapshot!(render(&found.warnings), @r"
    settings:1, warning: two motors move two axes together: they count by the robust bound / give both axes the larger mass and friction, and the rotors of both motors
      | M669 K1
      | ^^^^^^^
    settings:0, warning: X counts with the speed of Y, which is higher: they share their motors / what motors draw is bounded only where both axes are alike; times of moves may be too short
    settings:0, warning: Y counts with the acceleration of X, which is higher: they share their motors / what motors draw is bounded only where both axes are alike; times of moves may be too short
    ");
    assert_eq!(
        found.toml.matches("\naccel_mm_s2 = 3500 ").count(),
        2,
        "{}",
        found.toml
    );
    assert_eq!(
        found.toml.matches("\nrapid_mm_min = 36000 ").count(),
        2,
        "{}",
        found.toml
    );
}

/// What is missing of axes that share their motors is named, and nothing else: Y too, of which
/// the settings say nothing.
#[test]
fn what_is_missing_of_axes_that_share_motors_is_named() {
    let toml = imported("M669 K1\nM203 X30000\nM201 X3500\nM566 X600\n").toml;
    let errors = Machine::from_toml("m.toml", &toml).unwrap_err();
    let rules: Vec<&str> = errors.iter().map(|it| it.rule).collect();
    assert!(
        rules.iter().all(|rule| *rule == "machine-missing"),
        "{rules:?}"
    );
    assert!(
        errors.iter().any(|it| it.message.contains("axis Y")),
        "{errors:?}"
    );
}
