//! `--always` and `--preset-else`: presets for moves that fit without them, and a speed where
//! there is none.

use gwatt::machine::Machine;
use gwatt::pipeline::{
    Allowed, Certificate, Failure, Law, LimitOptions, LimitSummary, Options, PresetElse, Strategy,
};

use super::{RIG, Rig};
use crate::runs::{FEEDS, limited};

/// X and Y together go at 0.2 m/s each: along the line 16970.5 mm/min.
const BOTH: &str = "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"\n[[preset]]\n\
                    axes = [\"X\", \"Y\"]\nspeed_mm_min = { X = 12000, Y = 12000 }";

const PRESET: LimitOptions = LimitOptions {
    strategy: Strategy::Preset,
    ..LimitOptions::USUAL
};

const ALWAYS: LimitOptions = LimitOptions {
    always: true,
    ..PRESET
};

const ELSE_SPEED: LimitOptions = LimitOptions {
    preset_else: PresetElse::Speed,
    ..PRESET
};

fn rig(peak_w: f64) -> Machine {
    let rest = BOTH;
    Rig {
        peak_w,
        rest,
        ..RIG
    }
    .machine()
}

fn run(
    machine: &Machine,
    how: LimitOptions,
    robust: bool,
    program: &str,
) -> Result<(String, LimitSummary), Failure> {
    let options = Options {
        certificate: robust.then_some(Certificate::Robust),
        ..Options::default()
    };
    limited(machine, &options, how, program)
}

/// What is written, and the notes with their lines.
#[track_caller]
fn fits(machine: &Machine, how: LimitOptions, program: &str) -> (String, Vec<String>) {
    let (text, summary) = run(machine, how, false, program).expect("a program");
    assert!(summary.certified, "{text}: {:?}", summary.reasons);
    let notes = summary.before.notes.iter();
    let notes = notes.filter(|note| note.rule.contains("preset"));
    let notes = notes.map(|note| format!("{}: {}", note.line, note.message));
    (text, notes.collect())
}

#[track_caller]
fn unsuitable(how: LimitOptions, message: &str) {
    match run(&rig(1e6), how, false, "G0 X1\n") {
        Err(Failure::Unsuitable(found)) => assert_eq!(found, message),
        other => panic!("{other:?}"),
    }
}

/// 1 MW are enough for everything: only `--always` sets the preset, and for its axes alone.
/// X with a quarter of it by Y is held by X: 200 mm/s · √17/4, 12369.3 mm/min.
#[test]
fn presets_count_where_it_fits_too() {
    let program = "G0 X400 Y400\nX0\nX1 Y401\nX401 Y301\nG1 X1 Y0 F1000\nM30\n";
    let machine = rig(1e6);
    assert_eq!(
        fits(&machine, PRESET, program),
        (program.to_owned(), vec![])
    );
    let (text, notes) = fits(&machine, ALWAYS, program);
    assert_eq!(
        text,
        "G1 X400 Y400 F16970\nG0 X0\nG1 X1 Y401\nX401 Y301 F12369\nG1 X1 Y0 F1000\nM30\n"
    );
    assert_eq!(notes, [""; 0]);
    // Written once, nothing is left to do.
    assert_eq!(fits(&machine, ALWAYS, &text).0, text);
}

/// Cutting feeds need their permission; where they are slow enough it is not asked for.
#[test]
fn feeds_above_a_preset_stay_without_permission() {
    let program = "G1 X400 Y400 F30000\nX0 Y0\nX400 Y400 F16000\nM30\n";
    let (text, notes) = fits(&rig(1e6), ALWAYS, program);
    assert_eq!(text, program);
    assert_eq!(
        notes,
        [
            "1: 2 lines fit and stay as they are, though --always asks for less: no permitted word \
          lowers the speed of this block"
        ]
    );
    let with_feeds = LimitOptions {
        allowed: FEEDS,
        ..ALWAYS
    };
    let (text, notes) = fits(&rig(1e6), with_feeds, program);
    assert_eq!(text, "G1 X400 Y400 F16970\nX0 Y0\nX400 Y400 F16000\nM30\n");
    assert_eq!(notes, [""; 0]);
    // The same where they run into each other.
    let joined = Rig {
        peak_w: 1e6,
        rest: "[path]\nmode = \"look-ahead\"\nrapid = \"linear\"\n[[preset]]\n\
               axes = [\"X\", \"Y\"]\nspeed_mm_min = { X = 12000, Y = 12000 }",
        ..RIG
    };
    let (text, summary) = run(&joined.machine(), with_feeds, true, program).expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(text, "G1 X400 Y400 F16970\nX0 Y0\nX400 Y400 F16000\nM30\n");
}

/// 2500 mm/s² are half of what the axis has.
#[test]
fn accelerations_count_too() {
    let isg = Rig {
        controller: "isg",
        peak_w: 1e6,
        rest: "[path]\nmode = \"exact-stop\"\n[[preset]]\naxes = [\"X\"]\n\
               accel_mm_s2 = { X = 2500 }",
        ..RIG
    };
    let (text, _) = fits(
        &isg.machine(),
        ALWAYS,
        "G0 X400\nX401 Y1\nG1 X1 F500\nM30\n",
    );
    assert_eq!(
        text,
        "G230 X50 Y100\nG0 X400\nG231 = 100\nX401 Y1\nG130 X50 Y100\nG1 X1 F500\nG131 = 100\nM30\n"
    );
}

/// Nominally both axes draw 2500 W, however short the way: V = 0.8, and 0.64 of 42426.4
/// mm/min along the line. X alone, 1250 W, stays.
#[test]
fn the_squared_ratio_counts_where_it_fits_too() {
    let patent = LimitOptions {
        strategy: Strategy::Speed,
        law: Law::Patent,
        ..LimitOptions::USUAL
    };
    let always = LimitOptions {
        always: true,
        ..patent
    };
    let program = "G0 X1 Y1\nX400\nM30\n";
    assert_eq!(fits(&rig(2000.0), patent, program).0, program);
    let (text, notes) = fits(&rig(2000.0), always, program);
    assert_eq!(text, "G1 X1 Y1 F27152\nG0 X400\nM30\n");
    assert_eq!(notes, [""; 0]);
}

/// X alone has no preset: at 0.4 m/s it draws 1000 W.
#[test]
fn a_speed_stands_for_a_missing_preset() {
    let program = "G0 X400\nX0 Y400\nX400\nM30\n";
    let (_, refused) = run(&rig(1000.0), PRESET, false, program).expect("a program");
    let reasons = refused.reasons.iter();
    let reasons: Vec<_> = reasons.map(|reason| (reason.line, reason.rule)).collect();
    assert_eq!(reasons, [(1, "no-preset"), (3, "no-preset")]);
    let (text, notes) = fits(&rig(1000.0), ELSE_SPEED, program);
    assert_eq!(
        text,
        "G1 X400 F24000\nX0 Y400 F16970\nX400 F24000\nG0\nM30\n"
    );
    assert_eq!(
        notes,
        [
            "0: 2 lines move axes for which there is no preset: they get the speed that fits \
          (--preset-else speed)"
        ]
    );
    // One that fits needs none, and so gets none.
    let (_, notes) = fits(&rig(1000.0), ELSE_SPEED, "G0 X1\nX400 Y400\nX0\nM30\n");
    assert_eq!(
        notes,
        [
            "0: 1 line moves axes for which there is no preset: it gets the speed that fits \
          (--preset-else speed)"
        ]
    );
}

/// Each line once, however often it runs.
#[test]
fn lines_that_run_again_count_once() {
    let fanuc = Rig {
        controller: "fanuc",
        peak_w: 1000.0,
        rest: BOTH,
        ..RIG
    };
    let program = "G0 X400. Y400.\nM98 P10 L3\nM30\nO10\nG0 X0\nG0 X400.\nM99\n";
    let (_, notes) = fits(&fanuc.machine(), ELSE_SPEED, program);
    assert_eq!(
        notes,
        [
            "0: 2 lines move axes for which there is no preset: they get the speed that fits \
          (--preset-else speed)"
        ]
    );
}

/// Feeds that run into each other: those without a preset take what is left.
#[test]
fn joined_feeds_get_a_speed_too() {
    let joined = Rig {
        peak_w: 1000.0,
        rest: "[path]\nmode = \"look-ahead\"\nrapid = \"linear\"\n[[preset]]\n\
               axes = [\"X\", \"Y\"]\nspeed_mm_min = { X = 9000, Y = 9000 }",
        ..RIG
    };
    let machine = joined.machine();
    let allowed = Allowed {
        feed: true,
        ..Allowed::NOTHING
    };
    let program = "G1 X400 F30000\nX800\nM30\n";
    let refuse = LimitOptions { allowed, ..PRESET };
    let (_, summary) = run(&machine, refuse, true, program).expect("a program");
    assert!(!summary.certified);
    assert!(summary.reasons.iter().all(|it| it.rule == "no-preset"));
    let speed = LimitOptions {
        allowed,
        ..ELSE_SPEED
    };
    let (text, summary) = run(&machine, speed, true, program).expect("a program");
    assert!(summary.certified, "{text}: {:?}", summary.reasons);
    assert_eq!(text, "G1 X400 F23999\nX800\nF30000\nM30\n");
    // Next to one that has a preset.
    let program = "G1 X400 F30000\nX800 Y400\nX1200\nM30\n";
    let (text, summary) = run(&machine, speed, true, program).expect("a program");
    assert!(summary.certified, "{text}: {:?}", summary.reasons);
    assert!(text.contains("\nX800 Y400 F12727\n"), "{text}");
}

#[test]
fn other_strategies_have_no_presets() {
    let goes = "--always goes with --strategy preset or --law patent: the others have no value for \
                a move that fits";
    unsuitable(
        LimitOptions {
            always: true,
            ..LimitOptions::USUAL
        },
        goes,
    );
    unsuitable(
        LimitOptions {
            strategy: Strategy::Speed,
            ..ELSE_SPEED
        },
        "--preset-else goes with --strategy preset",
    );
    unsuitable(
        LimitOptions {
            allowed: Allowed {
                stop: true,
                ..Allowed::NOTHING
            },
            ..ALWAYS
        },
        "--always does not go with --allow stop, which looks for what costs the least time",
    );
}
