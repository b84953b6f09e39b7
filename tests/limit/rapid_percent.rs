//! Words for a percentage of the rapid speed: the ISG kernel's G129 and SINUMERIK's OVRRAP.

use std::io::Cursor;

use super::{EXACT_STOP, RIG, Rig, options};
use gwatt::machine::Machine;
use gwatt::pipeline::{Allowed, LimitOptions, LimitSummary, Strategy, analyze};

use crate::runs::{self, FEEDS};

const SINUMERIK: Rig = Rig {
    controller: "siemens",
    rest: EXACT_STOP,
    ..RIG
};

fn limited(machine: &Machine, unverified: bool, program: &str) -> (String, LimitSummary) {
    let how = LimitOptions {
        strategy: Strategy::Speed,
        allowed: Allowed {
            unverified,
            ..FEEDS
        },
        ..LimitOptions::USUAL
    };
    runs::limited(machine, &options(RIG.options), how, program).expect("a program")
}

/// The text of a program that was made to fit with the word.
fn fits(rig: &Rig, program: &str) -> String {
    let (text, summary) = limited(&rig.machine(), true, program);
    assert!(summary.certified, "{:?}", summary.reasons);
    text
}

/// 1250 W of 1000 W: 80 % of the speed. What the program has set comes back; from there the
/// search ends a hair below 80 %.
#[test]
fn rapids_stay_rapids() {
    assert_eq!(
        fits(&SINUMERIK, "G0 X400\nG1 X0 F30000\nX1 F100\nG0 X2\nM30\n"),
        "OVRRAP=80\nG0 X400\nG1 X0 F24000\nX1 F100\nOVRRAP=100\nG0 X2\nM30\n"
    );
    assert_eq!(
        fits(&SINUMERIK, "OVRRAP=150\nG0 X400\nG0 X401\nM30\n"),
        "OVRRAP=150\nOVRRAP=79\nG0 X400\nOVRRAP=150\nG0 X401\nM30\n"
    );
}

/// Rapids that are not straight have no other word.
#[test]
fn rapids_of_independent_axes_are_lowered() {
    let rig = Rig {
        rest: "[path]\nmode = \"exact-stop\"\nrapid = \"independent\"",
        ..SINUMERIK
    };
    let program = "G0 X400 Y400\nM30\n";
    // 2 · 0.5 m/s · 500 kg · 5 m/s² = 2500 W.
    assert_eq!(
        fits(&rig, program),
        "OVRRAP=40\nG0 X400 Y400\nOVRRAP=100\nM30\n"
    );
    let (_, summary) = limited(&rig.machine(), false, program);
    assert!(!summary.certified);
}

/// In path mode a rapid is bounded with its neighbours: X and Y share 1000 W, and each has
/// 0.2 m/s · 500 kg · 5 m/s² = 500 W at 40 %.
#[test]
fn where_blocks_run_into_each_other_the_bound_holds() {
    let isg = Rig {
        controller: "isg",
        rest: "",
        ..RIG
    };
    let (text, summary) = limited(&isg.machine(), false, "G261\nG0 X400\nG0 Y300\nM30\n");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(text, "G261\nG129 = 40\nG0 X400\nG0 Y300\nG129 = 100\nM30\n");
    let rig = Rig {
        rest: "",
        ..SINUMERIK
    };
    assert_eq!(
        fits(&rig, "G64\nG0 X400\nG0 X400 Y300\nM30\n"),
        "G64\nOVRRAP=40\nG0 X400\nG0 X400 Y300\nOVRRAP=100\nM30\n"
    );
}

/// A percentage of what a level gives is another speed: there the level is the word.
#[test]
fn where_levels_set_the_rapid_speed_no_percentage_is_written() {
    let rig = Rig {
        rest: "[path]\nmode = \"exact-stop\"\n[[levels]]\nacts_on = \"rapids\"\nverified = true\n\
               level = [\n{ word = \"M131\", rapid_percent = 50 },\n\
               { word = \"M133\", rapid_percent = 100, power_on = true },\n]",
        ..SINUMERIK
    };
    let text = fits(&rig, "G0 X400\nG0 X401\nM30\n");
    assert!(!text.contains("OVRRAP"), "{text}");
    let after = analyze(
        Cursor::new(&text),
        &rig.machine(),
        &options(rig.options),
        None,
    );
    assert!(after.expect("a program").fits());
}

/// What it lowers counts where the profile vouches for the word: `check` without that
/// takes rapids as they would be without it.
#[test]
fn what_it_lowers_counts_where_it_is_confirmed() {
    let program = "OVRRAP=50\nG0 X400\nM30\n";
    let peak_w = |machine: &Machine| {
        let found = analyze(Cursor::new(program), machine, &options(RIG.options), None);
        found.expect("a program").peak_w
    };
    let mut machine = SINUMERIK.machine();
    assert!((peak_w(&machine) - 1250.0).abs() < 1e-6);
    for knob in &mut machine.controller.knobs {
        knob.verified = true;
    }
    assert!((peak_w(&machine) - 625.0).abs() < 1e-6);
}
