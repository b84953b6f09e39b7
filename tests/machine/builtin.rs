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
