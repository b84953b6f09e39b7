//! A print whose duration was measured.

use super::{plan_program, total_s};
use gwatt::machine::{AXES, ChordRule, CornerAngle, CornerRule, LookAhead, Machine};
use std::fmt::Write as _;

use crate::machines::machine_from;

/// Smoothieware: `acceleration`, `junction_deviation` and `planner_queue_size`
/// of the printer's configuration.
const RULE: LookAhead = LookAhead {
    blocks_at_most: None,
    corner: CornerRule::JunctionDeviation {
        deviation_mm: 0.02,
        angle: CornerAngle::Linear,
        per_axis: false,
        block_accel: false,
        small_block_mm: 0.0,
    },
    blocks: Some(31),
    path_accel_mm_s2: 1000.0,
    min_cruise_ratio: 0.0,
    chords: Some(ChordRule {
        max_mm: 0.5,
        min_mm: 0.0,
        deviation_mm: f64::INFINITY,
        per_second: 0.0,
        per_circle: 0.0,
        more_from: 1.0,
        safe_exit: false,
    }),
};

fn printer() -> Machine {
    let mut text = String::from(
        "schema = 1\nname = \"printer\"\ncontroller = \"marlin\"\n[converter]\npeak_power_w = 1e9\n",
    );
    for (axis, speed, accel) in [
        ("X", 30_000, 100_000),
        ("Y", 30_000, 100_000),
        ("Z", 1200, 100_000),
        ("E", 3000, 500),
    ] {
        let _ = write!(
            text,
            "[axes.{axis}]\nkind = \"linear\"\nrapid_mm_min = {speed}\naccel_mm_s2 = {accel}\nmass_kg = 1\n"
        );
        if axis != "E" {
            text += "reference_mm_min = 3000\n";
        }
    }
    let mut machine = machine_from(&text);
    assert_eq!(machine.axes.len(), AXES);
    machine.controller.planner.look_ahead = Some(RULE);
    machine
}

#[test]
fn a_print_lasts_as_long_as_was_measured() {
    let sibling = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared");
    let shared = std::env::var("GWATT_SHARED").unwrap_or_else(|_| sibling.to_owned());
    let path = format!("{shared}/measured/print_times/31min17sec.gcode");
    let Ok(program) = std::fs::read(&path) else {
        crate::evidence::cannot_run("the print is not there");
        return;
    };
    crate::evidence::runs();
    // 1877 s were measured, heating of about 110 s included.
    let total_s = total_s(&plan_program(&printer(), &program));
    assert!((1750.0..1790.0).contains(&total_s), "{total_s}");
}

/// `PrusaSlicer` writes its own estimate of the time into a print, and the limits that it is for
/// (M201 to M205, classic jerk). Both count dwells, and neither heating nor homing.
#[test]
fn prints_last_as_long_as_the_slicer_says() {
    let sibling = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared");
    let shared = std::env::var("GWATT_SHARED").unwrap_or_else(|_| sibling.to_owned());
    let mut text = String::from(
        "schema = 1\nname = \"printer\"\ncontroller = \"marlin\"\n[converter]\npeak_power_w = 1e9\n\
         [path]\naccel_mm_s2 = { print = 500, travel = 500, retract = 1000 }\n\
         [look_ahead.classic_jerk]\nstep_mm_s = { X = 8, Y = 8, Z = 0.4, E = 5 }\n",
    );
    for (axis, speed, accel) in [
        ("X", 30_000, 500),
        ("Y", 30_000, 500),
        ("Z", 600, 100),
        ("E", 3600, 5000),
    ] {
        let _ = write!(
            text,
            "[axes.{axis}]\nkind = \"linear\"\nrapid_mm_min = {speed}\naccel_mm_s2 = {accel}\nmass_kg = 1\n"
        );
    }
    let machine = Machine::from_toml("printer.toml", &text).expect("a machine");
    for (print, minutes, seconds) in [("screw", 31, 3), ("plant-sign", 27, 14), ("vase", 66, 40)] {
        let path =
            format!("{shared}/corpus/3dprint/remcoder__gcode-preview/demo/gcodes/{print}.gcode");
        let Ok(program) = std::fs::read(&path) else {
            crate::evidence::cannot_run("the prints are not there");
            return;
        };
        let program = std::io::Cursor::new(program);
        let options = gwatt::pipeline::Options::default();
        let found = gwatt::pipeline::analyze(program, &machine.0, &options, None);
        let found_s = found.expect("it is read").duration_s;
        let slicer_s = f64::from(60 * minutes + seconds);
        let ratio = found_s / slicer_s;
        assert!((0.98..1.02).contains(&ratio), "{print}: {found_s} s");
    }
    crate::evidence::runs();
}
