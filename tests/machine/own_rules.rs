//! Rules of one machine where they are not as in its controller profile.

use gwatt::machine::{CornerAngle, CornerRule, Machine};
use insta::assert_snapshot;

use super::{BASE, findings, machine};

/// The base machine under another control, with lines after it.
fn under(controller: &str, more: &str) -> String {
    let base = BASE.replace(
        "controller = \"iso\"",
        &format!("controller = \"{controller}\""),
    );
    format!("{base}{more}\n")
}

fn rules(machine: &Machine) -> gwatt::machine::LookAhead {
    machine.controller.planner.look_ahead.expect("rules")
}

/// What is not given stays as it is in the profile.
#[test]
fn what_is_given_takes_its_place() {
    let plain = machine(&under("marlin", ""));
    let own = machine(&under(
        "marlin",
        "[look_ahead]\nblocks = 31\nchords = { max_mm = 0.5 }\n[look_ahead.junction_deviation]\ndeviation_mm = 0.05",
    ));
    let (before, after) = (rules(&plain), rules(&own));
    assert_eq!((before.blocks, after.blocks), (Some(12), Some(31)));
    let [before, after] = [before.chords.unwrap(), after.chords.unwrap()];
    assert_eq!((after.max_mm, after.per_circle), (0.5, before.per_circle));
    let expected = CornerRule::JunctionDeviation {
        deviation_mm: 0.05,
        angle: CornerAngle::AllAxes,
        per_axis: true,
        block_accel: true,
        small_block_mm: 1.0,
    };
    assert_eq!(rules(&own).corner, expected);
    // grbl's corners obey the axes alone, Marlin's the block's acceleration as well.
    let expected = CornerRule::JunctionDeviation {
        deviation_mm: 0.01,
        angle: CornerAngle::AllAxes,
        per_axis: true,
        block_accel: false,
        small_block_mm: 0.0,
    };
    assert_eq!(rules(&machine(&under("grbl", ""))).corner, expected);
}

/// Another kind of rule takes the place of the profile's; steps of axes that are not named
/// have no limit there, and are the profile's where it has such.
#[test]
fn another_rule() {
    let own = machine(&under(
        "marlin",
        "[look_ahead.classic_jerk]\nstep_mm_s = { X = 10 }",
    ));
    let CornerRule::ClassicJerk { step_mm_s } = rules(&own).corner else {
        panic!("{:?}", rules(&own));
    };
    assert_eq!(step_mm_s[..2], [10.0, f64::INFINITY]);
    let own = machine(&under(
        "reprap",
        "[look_ahead.speed_step]\nstep_mm_s = { X = 10 }",
    ));
    let CornerRule::SpeedStep {
        step_mm_s,
        same_kind_only,
    } = rules(&own).corner
    else {
        panic!("{:?}", rules(&own));
    };
    assert_eq!(
        (step_mm_s[0], step_mm_s[1], same_kind_only),
        (10.0, 15.0, true)
    );
}

#[test]
fn language_and_times() {
    let own = machine(&under(
        "marlin",
        "[path]\naccel_mm_s2 = { print = 500, travel = 800 }\nshortest_at_feed_s = 0.05\n[language]\nunits = \"inch\"\npower_on_tolerance_mm = 0.1\nretract = { length_mm = 1.5 }",
    ));
    assert_eq!(own.path.accel_mm_s2, [500.0, 800.0, f64::INFINITY]);
    assert_eq!(own.controller.planner.shortest_at_feed_s, 0.05);
    let language = &own.controller.language;
    assert_eq!(
        (language.metric, language.power_on_tolerance_mm),
        (false, 0.1)
    );
    assert_eq!(language.printer.retract.length_mm, 1.5);
}

/// Accelerations of the file are those that M204 sets: a program runs alike under both.
#[test]
fn accelerations_along_the_path_act_as_m204() {
    let program = "G1 X200 F12000\nG1 X0\n";
    let plain = machine(&under("marlin", ""));
    let own = machine(&under(
        "marlin",
        "[path]\naccel_mm_s2 = { print = 400, travel = 800 }",
    ));
    let asked = format!("M204 P400 T800\n{program}");
    let [without, by_word, by_file] = [
        gwatt::check(program, &plain),
        gwatt::check(&*asked, &plain),
        gwatt::check(program, &own),
    ]
    .map(|result| result.expect("a result").peak_w);
    assert_eq!(by_word, by_file);
    assert!(by_file < without, "{by_file} {without}");
    // What the program sets holds, up to the limits of the axes.
    let higher = format!("M204 T6000\n{program}");
    let higher = gwatt::check(&*higher, &own).expect("a result").peak_w;
    assert_eq!(higher, without);
}

#[test]
fn rules_that_do_not_belong() {
    assert_snapshot!(findings(&under("iso", "[look_ahead]\nblocks = 20")), @r"
    line 19, error machine-kind: how corners are run through is not modelled for this controller / leave [look_ahead] out: the robust bound counts
      | [look_ahead]
      | ^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&under("linuxcnc", "[look_ahead]\nblocks_at_most = 20")), @r"
    line 19, error machine-kind: `blocks_at_most` goes with `blocks`, with rules for corners other than those of LinuxCNC, and without a cruise ratio
      | [look_ahead]
      | ^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&under("grbl", "[look_ahead.junction_deviation]\ndeviation_mm = 0.1\n[look_ahead.classic_jerk]\nstep_mm_s = { X = 1 }")), @r"
    line 21, error machine-twice: a planner has one rule for corners
      | [look_ahead.classic_jerk]
      | ^^^^^^^^^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&under("grbl", "[path]\naccel_mm_s2 = { print = 500 }")), @r"
    line 20, error machine-kind: accelerations along the path belong to printers with M204, not to `grbl` / give those of the axes
      | accel_mm_s2 = { print = 500 }
      |               ^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&under("reprap", "[path]\naccel_mm_s2 = { retract = 500 }")), @r"
    line 20, error machine-kind: M204 of `reprap` has no R: `retract` acts on nothing
      | accel_mm_s2 = { retract = 500 }
      |               ^^^^^^^^^^^^^^^^^
    ");
    assert_snapshot!(findings(&under("grbl", "[language]\nretract = { length_mm = 1.5 }")), @r"
    line 20, error machine-kind: `retract` belongs to the controllers of printers
      | retract = { length_mm = 1.5 }
      |           ^^^^^^^^^^^^^^^^^^^
    ");
}
