//! How large a converter must be: what sizing says, `limit` does.

use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::size::{
    Curve, Job, Outcome, ProgramSize, Rung, Size, Sizing, Wish, rated, size,
};
use gwatt::pipeline::{Failure, LimitOptions, Options, Strategy, limit};
use gwatt::report::{Verdict, size_chart, size_csv, size_json, size_text, size_verdict};

use crate::limit::{EXACT_STOP, RIG, Rig};
use crate::near::assert_near;
use crate::runs::WITH_FEEDS;

/// 500 kg, 0.5 m/s, 5 m/s² and 100 N of friction: 0.5 · (2500 + 100) = 1300 W at the
/// end of the ramp, 0.5 · (2500 − 100) = 1200 W fed back.
const FRICTION: Rig = Rig {
    axis: "coulomb_n = 100",
    rest: EXACT_STOP,
    ..RIG
};
/// 0.1 m at 0.5 m/s: 0.1/0.5 + 0.5/5 = 0.3 s.
const RAPID: &str = "G90 G94 G21\nG0 X100\nM30\n";
/// With a feed of 0.1 m/s, which takes 0.1 · 2600 = 260 W.
const FEED: &str = "G90 G94 G21\nG0 X100\nG1 X50 F6000\nM30\n";

fn wish() -> Wish {
    Wish {
        how: LimitOptions::USUAL,
        converter: 0,
        steps: 6,
        until: 1e6,
        losses: Vec::new(),
        regen_ratio: None,
        threads: 2,
    }
}

fn jobs<'a>(programs: &[(&str, &'a str)]) -> Vec<Job<'a, Cursor<&'a [u8]>>> {
    let jobs = programs.iter().map(|&(name, text)| Job {
        name: name.to_owned(),
        options: Options::default(),
        open: Box::new(move || Ok(Cursor::new(text.as_bytes()))),
    });
    jobs.collect()
}

fn sized(machine: &Machine, programs: &[(&str, &str)], wish: &Wish) -> Size {
    size(&jobs(programs), machine, wish).expect("a sizing")
}

fn curve(sizing: &Sizing) -> &Curve {
    let curve = sizing.curve.as_ref();
    curve.unwrap_or_else(|| panic!("{:?}", sizing.programs))
}

fn program(sizing: &Sizing, index: usize) -> &ProgramSize {
    match &sizing.programs[index].1 {
        Outcome::Sized(size) => size,
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn near(found: f64, expected: f64, share: f64) {
    assert_near(found, expected, share * expected.abs());
}

/// All steps of a curve.
fn rungs(curve: &Curve) -> Vec<&Rung> {
    let losses = curve.losses.iter().map(|(_, rung)| rung);
    let ladder = curve.ladder.iter();
    ladder.chain([&curve.own]).chain(losses).collect()
}

/// The peak of the whole program is the rating that slows nothing, and that of a feed
/// which may not be lowered the smallest.
#[test]
fn the_ends_are_those_worked_by_hand() {
    let found = sized(&FRICTION.machine(), &[("a", FEED)], &wish());
    let (size, curve) = (program(&found.rating, 0), curve(&found.rating));
    near(size.peak_w, 1300.0, 1e-9);
    near(size.regen_w, 1200.0, 1e-9);
    assert_eq!(size.enough, 1300.0);
    assert_eq!(size.unlimited.edited_lines, 0);
    assert!((260.0..=262.7).contains(&size.lowest), "{}", size.lowest);
    let (below, reasons) = size.below.as_ref().expect("a lower value");
    assert!((257.0..260.0).contains(below), "{below}");
    assert_eq!(reasons[0].rule, "feed-not-allowed");
    assert_eq!(reasons[0].line, 3);

    assert_eq!((curve.enough, curve.lowest), (size.enough, size.lowest));
    assert_eq!(curve.ladder.len(), 6);
    let values: Vec<f64> = curve.ladder.iter().map(|rung| rung.value).collect();
    assert!(values.is_sorted(), "{values:?}");
    assert_eq!(curve.ladder[5].loss, 0.0);
    let losses: Vec<f64> = curve.ladder.iter().map(|rung| rung.loss).collect();
    assert!(losses.is_sorted_by(|a, b| a > b), "{losses:?}");
    assert_eq!(size_verdict(&found), Verdict::Fits);
    assert!(found.capacitance.is_none());

    // With the permission it goes on, and less is fed back at each step.
    let how = WITH_FEEDS;
    let found = sized(&FRICTION.machine(), &[("a", FEED)], &Wish { how, ..wish() });
    assert!(program(&found.rating, 0).lowest < 100.0);
    let ladder = &found.rating.curve.expect("a curve").ladder;
    let fed_back: Vec<f64> = ladder.iter().map(|rung| rung.total.regen_w).collect();
    assert!(fed_back.is_sorted_by(|a, b| a < b), "{fed_back:?}");
}

/// At v = 0.4 m/s it lasts 0.1/0.4 + 0.4/5 = 0.33 s, a tenth longer, and takes
/// 0.4 · 2600 = 1040 W.
#[test]
fn the_rating_for_a_loss_is_that_worked_by_hand() {
    let wish = Wish {
        losses: vec![0.1, 0.0],
        ..wish()
    };
    let found = sized(&FRICTION.machine(), &[("a", RAPID)], &wish);
    let losses = &curve(&found.rating).losses;
    let (loss, rung) = &losses[0];
    assert_eq!(*loss, 0.1);
    assert!((1039.9..=1040.0 * 1.006).contains(&rung.value), "{rung:?}");
    assert!(rung.total.certified && rung.loss <= 0.1, "{rung:?}");
    // Nothing lost is everything needed.
    assert!((1293.0..=1300.0).contains(&losses[1].1.value), "{losses:?}");
    assert!(losses[1].1.loss <= 1e-9);
}

/// Twice the time, 0.6 s, is that of v = 2.5 · (0.6 − √0.28) = 0.1771 m/s: 460.5 W.
#[test]
fn what_takes_too_long_is_not_tried() {
    let wish = Wish {
        until: 1.0,
        ..wish()
    };
    let machine = FRICTION.machine();
    let found = sized(&machine, &[("a", RAPID)], &wish);
    let size = program(&found.rating, 0);
    assert!((460.5..=465.2).contains(&size.lowest), "{size:?}");
    let (below, reasons) = size.below.as_ref().expect("a lower value");
    assert!(*below < 460.6 && reasons.is_empty());
    let text = size_text(&found, &machine, "rig", 0);
    assert!(text.contains("(less takes longer than --until)"), "{text}");
}

/// 600 W fed back at most: 600/2400 = 0.25 m/s, 0.45 s, and 650 W are drawn.
#[test]
fn what_is_fed_back_may_be_the_narrower_limit() {
    let rig = Rig {
        converter: "regen_power_w = 600",
        ..FRICTION
    };
    let found = sized(&rig.machine(), &[("a", RAPID)], &wish());
    let size = program(&found.rating, 0);
    near(size.duration_s, 0.3, 1e-9);
    near(size.unlimited.duration_s, 0.45, 1e-3);
    near(size.enough, 650.0, 2e-3);
    assert_eq!(curve(&found.rating).own.regen_power_w, Some(600.0));

    // Half of the rating: 0.5 m/s feeds 1200 W back, for which it takes 2400 W.
    let wish = Wish {
        regen_ratio: Some(0.5),
        ..wish()
    };
    let found = sized(&FRICTION.machine(), &[("a", RAPID)], &wish);
    near(program(&found.rating, 0).enough, 2400.0, 2e-3);
    let own = &curve(&found.rating).own;
    assert_eq!((own.value, own.regen_power_w), (1000.0, Some(500.0)));
}

/// Above 1000 W the ramp draws 6500·(0.1² − (1/13)²) − 1000·(0.1 − 1/13) = 3.4615 J,
/// which 83.21 µF give between 560 and 480 V.
#[test]
fn the_capacitance_is_that_worked_by_hand() {
    let rig = Rig {
        converter: "capacitance_f = 0.001\nbus_nominal_v = 560\nbus_min_v = 480\n\
                    credit_capacitance = true",
        ..FRICTION
    };
    let found = sized(&rig.machine(), &[("a", RAPID)], &wish());
    let capacitance = found.capacitance.as_ref().expect("a table");
    near(program(capacitance, 0).enough, 83.21e-6, 0.01);
    let curve = curve(capacitance);
    assert_eq!(curve.own.value, 0.001);
    assert_eq!(curve.own.peak_power_w, 1000.0);
    assert!(curve.ladder[0].loss > 0.0, "{curve:?}");
    let text = size_text(&found, &rig.machine(), "rig", 0);
    assert!(text.contains("nothing is slowed from 83."), "{text}");
    assert!(text.contains(" µF"), "{text}");

    // Where peaks do not come from the capacitor it is no matter, which is a line.
    let rig = Rig {
        converter: "capacitance_f = 0.001\nbus_nominal_v = 560\nbus_min_v = 480",
        ..FRICTION
    };
    let found = sized(&rig.machine(), &[("a", RAPID)], &wish());
    let text = size_text(&found, &rig.machine(), "rig", 0);
    assert!(
        text.contains("nothing is slowed from 1 µF on (less was not tried)"),
        "{text}"
    );
    assert!(!text.contains("capacitance  time"), "{text}");
}

/// Times add up, the largest ratings count, and each has its own.
#[test]
fn several_programs_count_together() {
    let both = "G90 G94 G21\nG0 X100 Y100\nM30\n";
    let programs = [("a", RAPID), ("b", both), ("c", FEED)];
    let found = sized(&FRICTION.machine(), &programs, &wish());
    let curve = curve(&found.rating);
    let enough: Vec<f64> = (0..3)
        .map(|index| program(&found.rating, index).enough)
        .collect();
    assert_eq!(enough, [1300.0, 2600.0, 1300.0]);
    assert_eq!(curve.enough, 2600.0);
    assert_eq!(curve.lowest, program(&found.rating, 2).lowest);
    for rung in rungs(curve) {
        let sum: f64 = rung.trials.iter().map(|trial| trial.duration_s).sum();
        assert_eq!(rung.total.duration_s, sum);
        assert!(rung.total.certified);
        near(rung.loss + 1.0, sum / curve.duration_s, 1e-12);
    }
    let mut csv = Vec::new();
    size_csv(&found, &mut csv).unwrap();
    let csv = String::from_utf8(csv).unwrap();
    // Three programs and all together, at six steps and the machine's own.
    assert_eq!(csv.lines().count(), 1 + 7 * 4);
    assert_eq!(
        csv.lines().filter(|line| line.contains(",,true,")).count(),
        7
    );
}

/// Every step again, by `limit` itself, with a machine that is read from a file which
/// has that rating.
#[test]
fn limit_does_what_sizing_says() {
    const MILL: &str = "G21\nG90\nG0 X100 Y50\nG1 X50 Y20 F3000\nG2 X20 Y50 R40\n\
                        G1 X60\nG0 X0 Y0\n";
    let continuous = "continuous_power_w = 350\nwindow_s = 2";
    let rigs = [
        FRICTION,
        Rig {
            controller: "linuxcnc",
            rest: "",
            ..FRICTION
        },
        Rig {
            controller: "marlin",
            rest: "",
            ..FRICTION
        },
        Rig {
            converter: "regen_power_w = 700\nbase_load_w = 50",
            ..FRICTION
        },
        Rig {
            converter: continuous,
            ..FRICTION
        },
    ];
    let how = WITH_FEEDS;
    let wish = Wish {
        how,
        steps: 4,
        losses: vec![0.05],
        ..wish()
    };
    for rig in rigs {
        let found = sized(&rig.machine(), &[("a", MILL)], &wish);
        let curve = curve(&found.rating);
        assert!(curve.lowest < curve.enough, "{}", rig.controller);
        let mut last = 0.0;
        for rung in rungs(curve) {
            let continuous_w = (0.35e6 * rung.value).round() / 1e6;
            assert_eq!(
                rung.continuous_power_w.is_some(),
                rig.converter == continuous
            );
            let scaled = format!("continuous_power_w = {continuous_w:?}\nwindow_s = 2");
            let converter: &'static str = if rig.converter == continuous {
                scaled.leak()
            } else {
                rig.converter
            };
            let machine = Rig {
                peak_w: rung.value,
                converter,
                ..rig
            }
            .machine();
            assert_eq!(machine, rated(&rig.machine(), 0, rung.value, None));
            let mut text = Vec::new();
            let input = Cursor::new(MILL.as_bytes());
            let summary =
                limit(input, &machine, &Options::default(), how, &mut text, None).unwrap();
            let trial = &rung.total;
            assert_eq!(summary.certified, trial.certified);
            assert_eq!(summary.after.duration_s, trial.duration_s);
            assert_eq!(summary.edited_lines, trial.edited_lines);
            assert!(trial.certified && trial.peak_w <= rung.value * (1.0 + 1e-9));
            last = rung.loss;
        }
        assert!(last <= 0.05, "{last}");
    }
}

/// The same bytes with any number of threads.
#[test]
fn threads_do_not_change_the_result() {
    let programs = [("a", RAPID), ("b", FEED)];
    let written = |threads| {
        let wish = Wish {
            threads,
            losses: vec![0.02],
            ..wish()
        };
        let machine = FRICTION.machine();
        let found = sized(&machine, &programs, &wish);
        let mut bytes = size_text(&found, &machine, "rig", 0).into_bytes();
        size_csv(&found, &mut bytes).unwrap();
        size_json(&found, "rig", "", &mut bytes).unwrap();
        size_chart(&found, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    let one = written(1);
    assert_eq!(one, written(2));
    assert_eq!(one, written(5));
}

/// Programs that cannot be sized are named, and the others are.
#[test]
fn what_cannot_be_sized_is_named() {
    // Half of the acceleration under G64: 0.2 · (1250 − 100) = 230 W fed back by a feed
    // that may not be lowered.
    let rig = Rig {
        converter: "regen_power_w = 100",
        controller: "linuxcnc",
        rest: "",
        ..FRICTION
    };
    let feed = "G90 G94 G21\nG1 X100 F12000\nM30\n";
    let programs = [
        ("idle", "G90 G94\nM30\n"),
        ("unread", "G90 ( \nG1 X\n"),
        ("never", feed),
        ("rapid", RAPID),
    ];
    let machine = rig.machine();
    let found = sized(&machine, &programs, &wish());
    let outcomes = &found.rating.programs;
    assert!(matches!(outcomes[0].1, Outcome::Idle), "{outcomes:?}");
    assert!(matches!(
        outcomes[1].1,
        Outcome::Refused(Failure::Refused { .. })
    ));
    assert!(matches!(&outcomes[2].1, Outcome::Never { reasons, .. }
        if reasons[0].rule == "feed-not-allowed"));
    assert!(matches!(outcomes[3].1, Outcome::Sized(_)), "{outcomes:?}");
    assert_eq!(curve(&found.rating).own.trials.len(), 1);
    assert_eq!(size_verdict(&found), Verdict::Refused);
    let text = size_text(&found, &machine, "rig", 0);
    for line in [
        "idle: draws nothing, and is not counted",
        "unread: refused, and not counted",
        "never: fits at no peak power, and is not counted; it draws 270 W and feeds back 230 W",
    ] {
        assert!(text.contains(line), "{text}");
    }

    let none = sized(&machine, &programs[2..3], &wish());
    assert_eq!(size_verdict(&none), Verdict::DoesNotFit);
    assert!(none.rating.curve.is_none());
    let mut svg = Vec::new();
    size_chart(&none, &mut svg).unwrap();
    assert!(
        String::from_utf8(svg)
            .unwrap()
            .contains("no program can be sized")
    );

    // A strategy that the machine has no word for suits no rating.
    let how = LimitOptions {
        strategy: Strategy::Preset,
        ..LimitOptions::USUAL
    };
    let failure = size(&jobs(&programs), &machine, &Wish { how, ..wish() });
    assert!(matches!(failure, Err(Failure::Unsuitable(_))));
}
