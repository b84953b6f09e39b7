//! `[planner.look_ahead]` of a controller profile.

use gwatt::machine::{Controller, CornerRule, builtin_controller};

/// A profile whose rules for corners are these.
fn profile(look_ahead: &str) -> Result<Controller, Vec<String>> {
    let text = format!(
        "schema = 1\nname = \"test\"\n[language]\nfamily = \"iso\"\npower_on = \"look-ahead\"\n\
         dwell = [{{ letter = \"P\", unit_s = 1 }}]\n[planner]\nrapid = \"linear\"\n{look_ahead}"
    );
    match Controller::from_toml(&text) {
        Ok((controller, _)) => Ok(controller),
        Err(found) => Err(found.into_iter().map(|found| found.message).collect()),
    }
}

#[test]
fn one_rule_is_needed_and_one_is_enough() {
    let found = profile("[planner.look_ahead]\nblocks = 10\n").unwrap_err();
    assert_eq!(found, ["`look_ahead` has no rule for corners"]);
    let two =
        "[planner.look_ahead.linuxcnc]\n[planner.look_ahead.square_corner]\ncorner_mm_s = 5\n";
    assert_eq!(
        profile(two).unwrap_err(),
        ["a planner has one rule for corners"]
    );
    let missing = "[planner.look_ahead.junction_deviation]\nper_axis = true\n";
    let found = profile(missing).unwrap_err();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("`deviation_mm` is missing"), "{found:?}");
    assert_eq!(profile("").unwrap().planner.look_ahead, None);
}

#[test]
fn what_is_given_arrives() {
    let text = "[planner.look_ahead]\nblocks = 7\nmin_cruise_ratio = 0.25\n\
                [planner.look_ahead.speed_step]\nstep_mm_s = { X = 9, E = 2 }\n";
    let rule = profile(text).unwrap().planner.look_ahead.unwrap();
    assert_eq!((rule.blocks, rule.min_cruise_ratio), (Some(7), 0.25));
    let CornerRule::SpeedStep {
        step_mm_s,
        same_kind_only,
    } = rule.corner
    else {
        panic!("{rule:?}");
    };
    assert_eq!(
        (step_mm_s[0], step_mm_s[9], same_kind_only),
        (9.0, 2.0, false)
    );
    assert_eq!(step_mm_s[1], f64::INFINITY);
}

#[test]
fn controllers_that_are_modelled() {
    for name in ["linuxcnc", "grbl", "marlin", "klipper", "reprap"] {
        let controller = builtin_controller(name).unwrap();
        assert!(controller.planner.look_ahead.is_some(), "{name}");
    }
}
