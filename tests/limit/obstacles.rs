//! What stands in the way: rule, message, and what would help.

use super::{EXACT_STOP, RIG, Rig};
use gwatt::pipeline::{Failure, Strategy};

#[track_caller]
fn stopped(rig: Rig, program: &str, line: u64, rule: &str, message: &str, help: &str) {
    let reasons = rig.reasons(program);
    let first = &reasons[0];
    assert_eq!((first.line, first.rule), (line, rule));
    assert_eq!(first.message, message);
    assert_eq!(first.help.as_deref(), Some(help));
}

const ISG: Rig = Rig {
    controller: "isg",
    rest: EXACT_STOP,
    ..RIG
};

const BY_HAND: &str = "change it by hand";

#[test]
fn feeds_without_permission() {
    let mut rig = RIG;
    rig.options.allow_feed = false;
    stopped(
        rig,
        "G1 X1 F100\nX400 F30000\n",
        2,
        "feed-not-allowed",
        "cutting feeds are not changed without permission",
        "it fits at F24000: --allow feed permits that",
    );
}

#[test]
fn a_floor_for_feeds() {
    stopped(
        Rig {
            peak_w: 300.0,
            rest: "min_feed_ratio = 0.5",
            ..RIG
        },
        "G1 X400 F30000\n",
        1,
        "feed-floor",
        "it would need F7199.9, below the floor of F15000 in [limits]",
        "lower min_feed_mm_min or min_feed_ratio, or use a word for acceleration",
    );
}

#[test]
fn loads_alone() {
    stopped(
        Rig {
            rest: "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 1500",
            ..RIG
        },
        "M8\nG4 P1\n",
        2,
        "base-load",
        "base load, switched loads and holding the axes alone exceed the limit",
        "no feed and no acceleration changes that: a larger converter is needed",
    );
}

#[test]
fn friction_alone() {
    for (allow_feed, help) in [
        (true, "lower the speed: --strategy optimal or speed"),
        (
            false,
            "lower the speed: --strategy optimal or speed, with --allow feed for feeds",
        ),
    ] {
        let mut rig = Rig {
            axis: "coulomb_n = 2500",
            ..ISG
        }
        .strategy(Strategy::Accel);
        rig.options.allow_feed = allow_feed;
        stopped(
            rig,
            // 0.1 % of 5 m/s² is the least: within 90 m more than 0.4 m/s.
            "G0 X90000\n",
            1,
            "friction-alone",
            "friction alone takes 125.0 % of the limit at the wanted speed",
            help,
        );
    }
}

const TAKES_NOTHING: &str = "with `regen_power_w` of 0 no axis may brake: leave it out where the \
     capacitors of the bus take what small drives feed back (`capacitance_f` and `bus_max_v` count \
     that), or give what the supply or its braking resistor takes";

/// 500 kg · 5 m/s² · 0.5 m/s are 1250 W, drawn within 5 kW and then fed back.
#[test]
fn what_is_fed_back_is_named() {
    let rig = Rig {
        peak_w: 5000.0,
        converter: "regen_power_w = 0",
        ..RIG
    };
    stopped(
        rig,
        "G0 X1000\n",
        1,
        "no-solution",
        "no value of the permitted words brings the 1250 W that are fed back down to the limit of 0 W",
        TAKES_NOTHING,
    );
    // A tenth of a percent of the acceleration is the least, and feeds 1.25 W back.
    let rig = Rig {
        peak_w: 5000.0,
        converter: "regen_power_w = 1",
        ..ISG
    };
    stopped(
        rig.strategy(Strategy::Accel),
        "G0 X90000\n",
        1,
        "no-solution",
        "no value of the permitted words brings the 1250 W that are fed back down to the limit of 1.00 W",
        "`regen_power_w` is what the supply or its braking resistor takes: a larger resistor, or \
         `credit_regen = true` where other axes on the bus take what one feeds back",
    );
}

/// Blended feeds have the bound of their neighbours as well.
#[test]
fn what_blended_feeds_feed_back_is_named() {
    let rig = Rig {
        peak_w: 5000.0,
        converter: "regen_power_w = 0",
        ..RIG
    };
    let reasons = rig.reasons("G64\nG1 X400 F30000\nX800\n");
    let said = reasons[0].message.as_str();
    assert!(
        said.contains("that are fed back down to the limit of 0 W"),
        "{said}"
    );
    assert_eq!(reasons[0].help.as_deref(), Some(TAKES_NOTHING));
}

#[test]
fn presets() {
    let rig = Rig {
        rest: "[[preset]]\naxes = [\"X\"]\nspeed_mm_min = { X = 29000 }\n\
               [[preset]]\naxes = [\"Y\"]\nspeed_mm_min = { Y = 15000 }",
        ..RIG
    }
    .strategy(Strategy::Preset);
    assert_eq!(rig.fits("G0 Y400\nG0 Y399\n"), "G1 Y400 F15000\nG0 Y399\n");
    stopped(
        rig,
        "G0 Y400\nG0 X300 Y0\n",
        2,
        "no-preset",
        "the machine has no preset for the axes XY",
        "add a [[preset]] for them, or use another strategy",
    );
    stopped(
        rig,
        "G0 X400\n",
        1,
        "not-enough",
        "the values of this strategy leave the block at 120.8 % of the limit",
        "use --strategy optimal --law exact",
    );
}

#[test]
fn blocks_that_are_not_touched() {
    let untouchable = |rig: Rig, program: &str, reason: &str| {
        stopped(
            rig,
            program,
            1,
            "untouchable",
            &format!("the block may not be changed: {reason}"),
            BY_HAND,
        );
    };
    untouchable(RIG, "/G0 X400\n", "it may be skipped (block delete)");
    untouchable(
        RIG,
        "G0 X400 M0 M30\n",
        "it stops, changes the tool or ends the program",
    );
    untouchable(ISG, "G131 = 90 G1 X400 F30000\n", "it sets limits itself");
    let marlin = Rig {
        controller: "marlin",
        ..ISG
    };
    untouchable(marlin, "N5 G1 X400 F30000*52\n", "it carries a checksum");
    // Marlin moves without an F, at a feed that no word can put back: M203 caps it.
    let text = marlin.strategy(Strategy::Speed).fits("G1 X400\n");
    assert_eq!(text, "M203 X400 Y500\nG1 X400\nM203 X500 Y500\n");
}

#[test]
fn rapids_that_are_not_written_as_feeds() {
    let no_knob = |program: &str, reason: &str, help: &str| {
        stopped(
            RIG,
            program,
            1,
            "no-knob",
            &format!("the rapid may not be written as a feed: {reason}"),
            help,
        );
    };
    let known = "the way is gone by a feed before it where the places are known: reference_mm of \
                 the axes, the work offset ([offsets] or --parameters) and the tool's length \
                 (--tool-table); or give the speed of the return, reference_mm_min";
    no_knob("G53 G0 X400\n", "G53 is for rapids", known);
    no_knob("G28 X400\n", "it moves to a reference point", known);
    no_knob(
        "G0 G4 P1 Y400\n",
        "an F in it would be its dwell",
        "write the move as a feed by hand, or lower the rapid speed of the machine",
    );
}

#[test]
fn rapids_that_another_mode_would_help() {
    let no_knob = |rig: Rig, program: &str, line: u64, reason: &str, help: &str| {
        let message = format!("the rapid may not be written as a feed: {reason}");
        stopped(rig, program, line, "no-knob", &message, help);
    };
    let rounded = "without its stop the corner would be rounded";
    no_knob(
        RIG,
        "G64 G0 X400\n",
        1,
        rounded,
        "program an exact stop (G61) before the block in front of it, or write the move as a \
         feed by hand",
    );
    let revolution = "the feed in force is per revolution";
    // Where the block itself may say so, in a word that cannot give way to another.
    let lathe = |controller| Rig {
        controller,
        rest: "[path]\nrapid = \"linear\"\n",
        ..RIG
    };
    for (controller, mode, word) in [
        ("fanuc-lathe", "G99", "G98"),
        ("fanuc-lathe-b", "G95", "G94"),
    ] {
        no_knob(
            lathe(controller),
            &format!("{mode}\nG96 S100 G0 X400.\n"),
            2,
            revolution,
            &format!("program {word} (feed per minute) and F in it before the rapid"),
        );
    }
}

#[test]
fn rapids_from_an_unknown_start() {
    let mut rig = Rig {
        rest: "[path]\nrapid = \"independent\"\n",
        ..RIG
    };
    rig.options.unknown_start = true;
    stopped(
        rig,
        "G0 X400 Y300\nX0\n",
        1,
        "no-knob",
        "the rapid may not be written as a feed: where it starts is not known",
        "give --start X…,Y…,Z…, or what its place rests on ([offsets], reference_mm, \
         --tool-table); or write the move as a feed by hand",
    );
    // One axis moves on a line, at an F that is no faster wherever it starts: 1 kW of 2.5 kW.
    assert_eq!(rig.fits("G0 X400\nX0\n"), "G1 X400 F24000\nX0\nG0\n");
    // Feeds may be lowered, and what follows starts where it is known.
    assert_eq!(
        rig.fits("G1 X400 F30000\nG0 X0\n"),
        "G1 X400 F24000\nG1 X0\nG0 F30000\n"
    );
}

#[test]
fn strategies_without_their_word() {
    let failure = RIG.strategy(Strategy::Accel).limit(b"G0 X400\n");
    assert!(matches!(failure, Err(Failure::Unsuitable(_))));
    let failure = RIG.strategy(Strategy::Preset).limit(b"G0 X400\n");
    assert!(matches!(failure, Err(Failure::Unsuitable(_))));
}

/// Of `P` and `X` next to G4 one may be meant as motion.
#[test]
fn two_times_of_one_dwell() {
    for program in ["G0 G4 P1 X400\n", "G4 F2 X1\n"] {
        assert_eq!(RIG.refusal(program)[0].rule, "dwell-time");
    }
}

/// What does not fit is shown as the program has it, and the help names what can help.
#[test]
fn what_does_not_fit_is_shown_as_the_program_has_it() {
    let rig = Rig {
        controller: "grbl",
        ..RIG
    };
    let reasons = rig.reasons("G21 G90\nG0 X5\nG0 X400\nG28\nM2\n");
    let found = reasons.iter().find(|it| it.rule == "does-not-fit").unwrap();
    assert_eq!((found.line, &*found.text), (3, &b"G0 X400"[..]));
    assert_eq!(
        found.message,
        "the block still needs 1250.0 W of 1000.0 W, written as `G1 X400`"
    );
    assert_eq!(
        found.help.as_deref(),
        Some(
            "blocks next to it may be what draws this much: mend those named for other reasons first"
        )
    );
}
