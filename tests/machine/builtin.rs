//! Every built-in file loads, and every file of `machine-configs/` is built in.

use std::collections::BTreeSet;

use gwatt::diagnostic::Diagnostic;
use gwatt::machine::builtin::{self, Builtin};
use gwatt::machine::{AxisId, Controller, Machine, builtin_controller};

fn files(folder: &str) -> BTreeSet<String> {
    let folder = format!("{}/machine-configs/{folder}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect()
}

fn names(list: &[Builtin]) -> BTreeSet<String> {
    list.iter().map(|file| file.name.to_owned()).collect()
}

#[test]
fn every_file_is_built_in() {
    assert_eq!(files(""), names(builtin::machines()));
    assert_eq!(files("controllers"), names(builtin::controllers()));
    assert_eq!(builtin::machines()[0].name, builtin::DEFAULT_MACHINE);
    assert_eq!(builtin::controllers()[0].name, builtin::DEFAULT_CONTROLLER);
}

#[test]
fn every_machine_loads_without_a_warning() {
    for file in builtin::machines() {
        let (machine, notes) = Machine::load(file.name).unwrap_or_else(|errors| {
            panic!("{}: {errors:#?}", file.name);
        });
        assert_eq!(notes, Vec::<Diagnostic>::new(), "{}", file.name);
        assert!(!file.description.is_empty(), "{}", file.name);
        assert!(!machine.axis_set.is_empty());
        // The same from the file.
        let path = format!(
            "{}/machine-configs/{}.toml",
            env!("CARGO_MANIFEST_DIR"),
            file.name
        );
        assert_eq!(Machine::load(&path).unwrap().0, machine);
    }
}

#[test]
fn every_profile_loads_without_a_warning() {
    for file in builtin::controllers() {
        let (controller, notes) = Controller::load(file.name).unwrap_or_else(|errors| {
            panic!("{}: {errors:#?}", file.name);
        });
        assert_eq!(notes, Vec::<Diagnostic>::new(), "{}", file.name);
        assert_eq!(controller.name, file.name);
        assert!(!controller.description.is_empty());
        assert_eq!(builtin_controller(file.name), Some(controller));
    }
    assert_eq!(builtin_controller("none"), None);
}

/// Coulomb friction, no viscous: a preset speed is right if all its axes fit
/// at that speed and at full acceleration, whatever the direction.
#[test]
fn every_speed_preset_fits() {
    for file in builtin::machines() {
        let (machine, _) = Machine::load(file.name).unwrap();
        let converter = &machine.converters[0];
        let switched: f64 = machine.loads.iter().map(|load| load.power_w).sum();
        let limit = converter.peak_power_w * (1.0 - machine.limits.margin)
            - converter.base_load_w
            - switched;
        for preset in &machine.presets {
            let power: f64 = preset
                .axes
                .iter()
                .map(|n| {
                    let axis = machine.axes[n].unwrap();
                    let force = axis.mass_kg * axis.accel_mm_s2 * axis.si_per_unit
                        + axis.coulomb_n
                        + axis.gravity_n.max(0.0);
                    preset.speed_mm_s[n] * axis.si_per_unit * force / axis.efficiency
                })
                .sum();
            assert!(
                power <= limit && power > 0.9 * limit,
                "{} {}: {power:.0} W of {limit:.0} W",
                file.name,
                preset.axes
            );
        }
    }
}

#[test]
fn the_default_machine_is_converted_to_the_load_side() {
    let (machine, _) = Machine::load("three-axis").unwrap();
    let x = machine.axes[AxisId::X as usize].unwrap();
    // 3000 rpm of a 12 mm screw; J·(2π/0.012)²; 1.5 N·m·2π/0.012.
    assert!((x.rapid_mm_s - 600.0).abs() < 1e-9);
    assert!((x.accel_mm_s2 - 5000.0).abs() < 1e-9);
    assert!((x.mass_kg - 1370.778).abs() < 1e-3, "{}", x.mass_kg);
    assert!((x.coulomb_n - 785.398).abs() < 1e-3, "{}", x.coulomb_n);
}
