//! Every message about a controller profile, once.

use gwatt::machine::Controller;
use insta::assert_snapshot;

use super::render;

const KNOB: &str = r#"
[[knob]]
word = "G131"
target = "feed-accel"
argument = "assign"
unit = "percent"
step = 0.1
min = 1
"#;

/// A profile without a mistake; tests change one line of it.
const BASE: &str = r#"schema = 1
name = "test"
description = "a test"

[language]
family = "iso"
dwell = [
    { letter = "P", unit_s = 1.0 },
    { letter = "F", unit_s = 1.0 },
]
power_on = "exact-stop"
ignored = ["M48", "M49"]

[planner]
rapid = "linear"
rapid_joint = "stop"
arc_rule = "shared"
rapid_knob = "g1"
"#;

fn edited(old: &str, new: &str) -> String {
    assert!(BASE.contains(old), "{old:?} is not in the profile");
    BASE.replacen(old, new, 1)
}

fn with(more: &str) -> String {
    format!("{BASE}{more}")
}

fn findings(text: &str) -> String {
    match Controller::from_toml(text) {
        Ok((_, notes)) => render(&notes),
        Err(errors) => render(&errors),
    }
}

#[test]
fn a_knob_is_read() {
    assert_eq!(findings(&with(KNOB)), "");
    let (controller, _) = Controller::from_toml(&with(KNOB)).unwrap();
    assert_eq!(controller.knobs.len(), 1);
    assert_eq!(controller.knobs[0].code, Some((b'G', 1310)));
    assert!(
        !controller.knobs[0].verified,
        "only on request unless the file says otherwise"
    );
}

#[test]
fn empty_file() {
    assert_snapshot!(findings(""), @r"
    line 0, error machine-missing: `schema` is missing in the file / Version of this format: 1
    line 0, error machine-missing: `name` is missing in the file / Its name
    line 0, error machine-missing: `language` is missing in the file / How program text is read
    line 0, error machine-missing: `planner` is missing in the file / How it plans
    ");
}

#[test]
fn unknown_key() {
    assert_snapshot!(findings(&edited("arc_rule", "arc_rul")), @r#"
    line 17, error machine-unknown-key: unknown key `arc_rul` / did you mean `arc_rule`?
      | arc_rul = "shared"
      | ^^^^^^^
    "#);
}

#[test]
fn unknown_family() {
    assert_snapshot!(findings(&edited("family = \"iso\"", "family = \"fanuc\"")), @r#"
    line 6, error machine-value: `family` must be "iso", "rs274", "marlin", "isg", "siemens" or "nci", not "fanuc"
      | family = "fanuc"
      |          ^^^^^^^
    "#);
}

#[test]
fn schema_number() {
    assert_snapshot!(findings(&edited("schema = 1", "schema = 7")), @r"
    line 1, error machine-schema: schema 7 is not known / this version of gwatt reads schema = 1
      | schema = 7
      |          ^
    ");
}

#[test]
fn dwell_letters() {
    assert_snapshot!(findings(&edited("letter = \"P\"", "letter = \"PX\"").replace("letter = \"F\"", "letter = \"X\"")), @r#"
    line 8, error machine-word: "PX" is not a letter
      |     { letter = "PX", unit_s = 1.0 },
      |                ^^^^
    "#);
}

#[test]
fn dwell_unit() {
    assert_snapshot!(findings(&edited("unit_s = 1.0", "unit_s = 0")), @r#"
    line 8, error machine-range: `unit_s` must be greater than 0, but is 0
      |     { letter = "P", unit_s = 0 },
      |                              ^
    "#);
}

#[test]
fn ignored_words() {
    assert_snapshot!(findings(&edited("\"M49\"", "\"X1\", \"M\", \"M1.5\", \"G12.34\"")), @r#"
    line 12, error machine-word: "X1" is not a G or M word / such as "G187" or "M48"
      | ignored = ["M48", "X1", "M", "M1.5", "G12.34"]
      |                   ^^^^
    line 12, error machine-word: "M" is not a G or M word / such as "G187" or "M48"
      | ignored = ["M48", "X1", "M", "M1.5", "G12.34"]
      |                         ^^^
    line 12, error machine-word: "M1.5" is not a G or M word / such as "G187" or "M48"
      | ignored = ["M48", "X1", "M", "M1.5", "G12.34"]
      |                              ^^^^^^
    line 12, error machine-word: "G12.34" is not a G or M word / such as "G187" or "M48"
      | ignored = ["M48", "X1", "M", "M1.5", "G12.34"]
      |                                      ^^^^^^^^
    "#);
}

#[test]
fn independent_rapids_as_feeds() {
    assert_snapshot!(findings(&edited("rapid = \"linear\"", "rapid = \"independent\"")), @r#"
    line 18, error machine-value: `rapid_knob` = "g1" with independent rapids changes the path / a feed is straight; use "none"
      | rapid_knob = "g1"
      |              ^^^^
    "#);
}

#[test]
fn knob_word() {
    assert_snapshot!(findings(&with(KNOB).replace("G131", "131")), @r#"
    line 21, error machine-word: "131" is not a program word / a letter and a number, such as "G131"
      | word = "131"
      |        ^^^^^
    "#);
}

#[test]
fn knob_with_letters() {
    assert_snapshot!(findings(&with(KNOB).replace("step", "letters = [\"P\"]\nstep")), @r#"
    line 25, error machine-kind: `letters` belong to argument = "path"
      | letters = ["P"]
      |           ^^^^^
    "#);
}

#[test]
fn path_knob_without_letters() {
    assert_snapshot!(findings(&with(KNOB).replace("assign", "path")), @r#"
    line 23, error machine-missing: argument = "path" needs `letters` / such as letters = ["P", "T"]
      | argument = "path"
      |            ^^^^^^
    "#);
}

#[test]
fn path_knob_of_an_axis() {
    assert_snapshot!(findings(&with(KNOB).replace("argument = \"assign\"", "argument = \"path\"\nletters = [\"X\", \"PP\"]")), @r#"
    line 24, error machine-word: X is an axis / for a value per axis use argument = "axes"
      | letters = ["X", "PP"]
      |            ^^^
    line 24, error machine-word: "PP" is not a letter
      | letters = ["X", "PP"]
      |                 ^^^^
    "#);
}

#[test]
fn knob_incomplete() {
    assert_snapshot!(findings(&with("[[knob]]\nword = \"G131\"\n")), @r"
    line 19, error machine-missing: `target` is missing in `knob` / What it acts on
      | [[knob]]
      | ^^^^^^^^
    line 19, error machine-missing: `argument` is missing in `knob` / What stands after it: `= value`, a value per axis, the same with the axis in brackets (`ACC[X]=70`), the path's value after a letter, or right after the word, or the number of an analog output ([outputs] of the machine file) with its value
      | [[knob]]
      | ^^^^^^^^
    line 19, error machine-missing: `unit` is missing in `knob` / Unit of the value
      | [[knob]]
      | ^^^^^^^^
    line 19, error machine-missing: `step` is missing in `knob` / Smallest step of a value that is written
      | [[knob]]
      | ^^^^^^^^
    line 19, error machine-missing: `min` is missing in `knob` / Smallest value that is accepted
      | [[knob]]
      | ^^^^^^^^
    ");
}

#[test]
fn knob_step() {
    assert_snapshot!(findings(&with(KNOB).replace("step = 0.1", "step = 0")), @r"
    line 25, error machine-range: `step` must be greater than 0, but is 0
      | step = 0
      |        ^
    ");
}

#[test]
fn rapid_joint() {
    assert_snapshot!(findings(&edited("rapid_joint = \"stop\"", "rapid_joint = \"rapid\"")), @r#"
    line 16, error machine-value: `rapid_joint` must be "stop", "rapids" or "all", not "rapid" / did you mean "rapids"?
      | rapid_joint = "rapid"
      |               ^^^^^^^
    "#);
}

#[test]
fn dwell_letter_twice() {
    assert_snapshot!(findings(&edited("letter = \"F\"", "letter = \"p\"")), @r#"
    line 9, error machine-twice: letter P is given twice
      |     { letter = "p", unit_s = 1.0 },
      |                ^^^
    "#);
}

#[test]
fn the_word_for_exact_stop_is_a_g_word() {
    let text = edited("ignored =", "exact_stop_word = \"M9\"\nignored =");
    let Err(errors) = Controller::from_toml(&text) else {
        panic!("no error");
    };
    let errors = render(&errors);
    assert!(
        errors.contains("\"M9\" is not a G word / such as \"G9\""),
        "{errors}"
    );
}

/// What is written must be read back, in its unit.
#[test]
fn knobs_with_a_value() {
    let knob = |word: &str, target: &str, unit: &str| {
        with(&format!(
            "[[knob]]\nword = \"{word}\"\ntarget = \"{target}\"\nargument = \"value\"\n\
             unit = \"{unit}\"\nstep = 1\nmin = 1\n"
        ))
    };
    let accel = "SET_VELOCITY_LIMIT ACCEL=";
    assert_eq!(findings(&knob(accel, "accel", "per-second-squared")), "");
    let found = findings(&knob("SET_SPEED V=", "speed", "per-second"));
    assert!(
        found.contains("\"SET_SPEED V=\" with argument = \"value\" is not read back"),
        "{found}"
    );
    let found = findings(&knob(accel, "speed", "per-second"));
    assert!(found.contains("is not read back"), "{found}");
    let found = findings(&knob(accel, "accel", "per-minute"));
    assert!(
        found.contains("`unit` does not go with `target`"),
        "{found}"
    );
}

#[test]
fn knobs_with_names() {
    let knob = |word: &str, target: &str, argument: &str, unit: &str| {
        with(&format!(
            "[[knob]]\nword = \"{word}\"\ntarget = \"{target}\"\nargument = \"{argument}\"\n\
             unit = \"{unit}\"\nstep = 0.01\nmin = 0.01\n"
        ))
    };
    assert_eq!(findings(&knob("ACC", "accel", "index", "percent")), "");
    assert_eq!(findings(&knob("DynOvr", "accel", "assign", "share")), "");
    assert_eq!(
        findings(&knob("OVRRAP", "rapid-speed", "assign", "percent")),
        ""
    );
    for (word, target, argument) in [
        ("VELOLIM", "speed", "index"),
        ("JERKLIM", "jerk", "index"),
        ("#set paramAxisDynamics", "jerk", "dynamics"),
    ] {
        assert_eq!(findings(&knob(word, target, argument, "percent")), "");
    }
    for (word, target, argument, unit) in [
        ("VELOLIM", "speed", "index", "per-minute"),
        ("JERKLIM", "accel", "index", "percent"),
        ("#set paramPathDynamics", "jerk", "dynamics", "percent"),
        ("ACC", "feed-accel", "index", "percent"),
        ("ACC", "accel", "index", "per-second-squared"),
        ("DynOvr", "accel", "index", "percent"),
        ("DynOvr", "accel", "assign", "percent"),
        ("OVRRAP", "accel", "assign", "percent"),
    ] {
        let found = findings(&knob(word, target, argument, unit));
        let message = format!("\"{word}\" is not read back in this form");
        assert!(found.contains(&message), "{word} {argument}: {found}");
    }
    let found = findings(&knob("ACC", "accel", "assign", "percent"));
    assert!(found.contains("\"ACC\" is not a program word"), "{found}");
    let with_jerk = |word: &str, argument: &str, unit: &str| {
        let table = knob(word, "accel", argument, unit);
        findings(&format!("{table}with_jerk = true\n"))
    };
    assert_eq!(with_jerk("DynOvr", "assign", "share"), "");
    let found = with_jerk("G131", "assign", "per-second-squared");
    assert!(found.contains("`with_jerk` goes with"), "{found}");
}

#[test]
fn knobs_of_outputs() {
    let knob = |word: &str, target: &str, unit: &str, wait: &str| {
        with(&format!(
            "[[knob]]\nword = \"{word}\"\ntarget = \"{target}\"\nargument = \"output\"\n\
             unit = \"{unit}\"\nstep = 0.001\nmin = 0.001\nwait = \"{wait}\"\n"
        ))
    };
    let wait = "M66 P0 L0";
    assert_eq!(findings(&knob("M68", "accel", "share", wait)), "");
    for (word, wait) in [("M67", wait), ("M68", "G4 P0")] {
        let found = findings(&knob(word, "accel", "share", wait));
        let message = format!("\"{word}\" with argument = \"output\" is not read back");
        assert!(found.contains(&message), "{found}");
    }
    for (target, unit) in [("accel", "percent"), ("cruise-ratio", "share")] {
        let found = findings(&knob("M68", target, unit, wait));
        assert!(
            found.contains("`unit` does not go with `target`"),
            "{found}"
        );
    }
}
