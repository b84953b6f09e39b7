//! Finding machines and profiles by name and by path.

use std::fs;
use std::path::Path;

use gwatt::machine::{
    Controller, Family, KnobArgument, KnobTarget, Machine, PathMode, RapidKnob, RapidPath, builtin,
};
use insta::assert_snapshot;

use super::{BASE, edited, machine, render, with};

/// What `Machine::load` says about a path, the folder's own name left out.
fn refused(folder: &Path, name: &str) -> String {
    let path = folder.join(name);
    let errors = Machine::load(path.to_str().unwrap()).unwrap_err();
    render(&errors).replace(&folder.display().to_string(), "…")
}

#[test]
fn unknown_names() {
    let said = |name: &str| render(&Machine::load(name).unwrap_err());
    assert_snapshot!(said("three-axes"), @r#"line 0, error machine-file: no built-in machine and no file is named "three-axes" / did you mean "three-axis"? built in: three-axis, vmc, linear-gantry, five-axis, lathe, router-48v, linuxcnc-mill, printer"#);
    assert_snapshot!(said("qqq"), @r#"line 0, error machine-file: no built-in machine and no file is named "qqq" / built in: three-axis, vmc, linear-gantry, five-axis, lathe, router-48v, linuxcnc-mill, printer"#);
    assert_snapshot!(said(""), @r#"line 0, error machine-file: no built-in machine and no file is named "" / built in: three-axis, vmc, linear-gantry, five-axis, lathe, router-48v, linuxcnc-mill, printer"#);
    assert_snapshot!(render(&Controller::load("marlim").unwrap_err()), @r#"line 0, error machine-file: no built-in controller profile and no file is named "marlim" / did you mean "marlin"? built in: iso, linuxcnc, grbl, isg, twincat-nci, siemens, marlin, reprap, klipper, fanuc, haas, fanuc-lathe, fanuc-lathe-b, haas-lathe, mitsubishi, mazak, syntec, okuma, okuma-lathe"#);
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("large.toml"), vec![b'#'; (1 << 20) + 1]).unwrap();
    fs::write(at.join("latin1.toml"), b"schema = 1\nname = \"Fr\xe4se\"\n").unwrap();
    fs::create_dir(at.join("folder.toml")).unwrap();
    assert_snapshot!(refused(at, "missing.toml"), @"line 0, error machine-file: there is no machine file …/missing.toml");
    assert_snapshot!(refused(at, "large.toml"), @"line 0, error machine-file: …/large.toml is larger than 1 MiB / a machine file is a few kilobytes");
    assert_snapshot!(refused(at, "latin1.toml"), @r#"
    line 2, error machine-file: …/latin1.toml is not UTF-8 / save the file as UTF-8
      | name = "Fr�se"
      |           ^
    "#);
    assert_snapshot!(refused(at, "folder.toml"), @"line 0, error machine-file: …/folder.toml is a folder, not a machine file");
}

#[test]
fn a_file_as_large_as_permitted_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.toml");
    let mut text = BASE.to_owned();
    text += &"#".repeat((1 << 20) - text.len());
    fs::write(&path, text).unwrap();
    assert!(Machine::load(path.to_str().unwrap()).is_ok());
}

#[test]
fn byte_order_mark_and_crlf_are_read() {
    let text = format!("\u{feff}{}", BASE.replace('\n', "\r\n"));
    assert_eq!(machine(&text), machine(BASE));
}

#[test]
fn a_profile_is_found_beside_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let own = builtin::controllers()[0]
        .text
        .replace("name = \"iso\"", "name = \"own\"");
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("sub/own.toml"), &own).unwrap();
    let path = folder.path().join("m.toml");
    fs::write(&path, edited("\"iso\"", "\"sub/own.toml\"")).unwrap();
    let (machine, _) = Machine::load(path.to_str().unwrap()).unwrap();
    assert_eq!(machine.controller.name, "own");

    fs::write(
        folder.path().join("sub/own.toml"),
        own.replace("planner", "planer"),
    )
    .unwrap();
    assert_snapshot!(refused(folder.path(), "m.toml"), @r#"
    line 3, error machine-controller: the controller profile sub/own.toml has mistakes
      | controller = "sub/own.toml"
      |              ^^^^^^^^^^^^^^
    line 39, error machine-unknown-key: sub/own.toml: unknown key `planer` / did you mean `planner`?
      | [planer]
      |  ^^^^^^
    "#);
}

#[test]
fn profiles_hold_their_facts() {
    let load = |name: &str| Controller::load(name).unwrap().0;
    let iso = load("iso");
    assert_eq!(iso.language.dwell, [(b'P', 1.0), (b'X', 1.0), (b'F', 1.0)]);
    assert_eq!(iso.language.power_on_mode, PathMode::ExactStop);
    assert_eq!(iso.language.g64, PathMode::LookAhead);
    assert_eq!(iso.language.ignored_m, [48, 49]);
    assert_eq!(iso.rapid_knob, RapidKnob::G1);
    assert!(iso.knobs.is_empty());
    let linuxcnc = load("linuxcnc");
    assert_eq!(linuxcnc.language.family, Family::Rs274);
    assert_eq!(linuxcnc.language.g61, PathMode::LookAhead);
    assert_eq!(linuxcnc.language.g61_1, PathMode::ExactStop);
    let marlin = load("marlin");
    assert_eq!(marlin.language.dwell, [(b'P', 0.001), (b'S', 1.0)]);
    assert!(marlin.language.rapid_uses_feed && !marlin.language.block_delete);
    assert_eq!(
        marlin.knobs[1].argument,
        KnobArgument::Path(b"SPTR".to_vec())
    );
    let isg = load("isg");
    assert_eq!(isg.language.family, Family::Isg);
    let codes: Vec<_> = isg
        .knobs
        .iter()
        .map(|knob| (knob.code.expect("a code").1, knob.target))
        .collect();
    assert_eq!(codes[0], (1310, KnobTarget::FeedAccel));
    assert_eq!(codes[1], (2310, KnobTarget::RapidAccel));
    assert_eq!(codes[2], (1290, KnobTarget::RapidSpeed));
}

#[test]
fn defaults() {
    let machine = machine(BASE);
    assert_eq!(machine.limits.margin, 0.1);
    assert_eq!(machine.limits.feed_override_max, 1.0);
    assert_eq!(machine.limits.min_feed_mm_s, 0.0);
    assert_eq!(machine.converters[0].regen_power_w, None);
    assert!(!machine.converters[0].credit_regen);
    assert_eq!(machine.converters[0].axes, machine.axis_set);
    assert_eq!(machine.path.mode, None);
    assert_eq!(machine.path.rapid, RapidPath::Linear);
    assert!(machine.spindle.is_none() && machine.loads.is_empty() && machine.presets.is_empty());
}

#[test]
fn independent_rapids_and_clearance() {
    let machine = machine(&with(
        "[path]\nrapid = \"independent\"\nclearance = { X = 50, B = 5 }\nmax_feed_mm_min = 6000",
    ));
    assert_eq!(machine.path.rapid, RapidPath::Independent);
    // A rapid of one axis is a line anyway.
    assert_eq!(machine.controller.rapid_knob, RapidKnob::G1);
    assert_eq!(machine.path.max_feed_mm_s, 100.0);
    let clear = |x: [f64; 2], b: f64| {
        let [mut start, mut end] = [[0.0; 10]; 2];
        [start[0], end[0]] = x;
        [start[4], end[4]] = [b; 2];
        machine.path.is_clear(machine.axis_set, &start, &end)
    };
    assert!(clear([50.0, 400.0], 5.0));
    assert!(!clear([400.0, 49.9], 5.0) && !clear([50.0, 50.0], 4.9));
    assert!(!clear([f64::NAN, 60.0], 5.0));
}

#[test]
fn loads_limits_and_converters() {
    let machine = machine(
        &edited(
            "[converter]\npeak_power_w = 3500",
            "[[converter]]\nname = \"a\"\naxes = [\"X\"]\npeak_power_w = 3500\n\n\
             [[converter]]\nname = \"b\"\naxes = [\"B\"]\npeak_power_w = 1000",
        )
        .replace(
            "[axes.X]",
            "[[load]]\non = \"M08\"\noff = [\"M9\", \"M30\"]\npower_w = 750\nconverter = \"b\"\n\n\
             [limits]\nmargin = 0\noverride_max_percent = { feed = 120, rapid = 50 }\n\
             min_feed_mm_min = 60\nmin_feed_ratio = 0.5\n\n[axes.X]",
        ),
    );
    assert_eq!(machine.loads[0].on, [(b'M', 8.0)]);
    assert_eq!(machine.loads[0].off, [(b'M', 9.0), (b'M', 30.0)]);
    assert_eq!(machine.loads[0].converter, 1);
    assert_eq!(machine.converters[0].axes.to_string(), "X");
    assert_eq!(machine.limits.margin, 0.0);
    assert_eq!(machine.limits.feed_override_max, 1.2);
    assert_eq!(machine.limits.rapid_override_max, 0.5);
    assert_eq!(machine.limits.spindle_override_max, 1.0);
    assert_eq!(machine.limits.min_feed_mm_s, 1.0);
}

/// `[language]` of a machine file: words of this machine that move nothing.
#[test]
fn words_that_a_machine_ignores() {
    let with = |controller: &str, language: &str| {
        let text = format!(
            "schema = 1\nname = \"t\"\ncontroller = \"{controller}\"\n[language]\n{language}\n[converter]\npeak_power_w = 1e5\n[axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n"
        );
        gwatt::machine::Machine::from_toml("t.toml", &text)
    };
    let (machine, _) = with("iso", "ignored = [\"M101\", \"G187\"]").expect("a machine");
    let language = &machine.controller.language;
    assert_eq!(language.ignored_m, [48, 49, 101]);
    assert_eq!(language.ignored_g, [1870]);
    let refused = |controller: &str, language: &str| {
        let error = with(controller, language).expect_err("a mistake");
        error
            .iter()
            .map(|found| found.message.clone())
            .collect::<String>()
    };
    assert!(refused("iso", "ignored = [\"101\"]").contains("\"101\" is not a G or M word"));
    assert!(
        refused("linuxcnc", "ignored_macros = [\"START\"]")
            .contains("`ignored_macros` belongs to the controllers of printers")
    );
    assert!(
        refused("haas", "unknown_moves = [\"START\"]").contains("\"START\" is not a G or M word")
    );
}
