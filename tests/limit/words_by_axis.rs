//! SINUMERIK's ACC[…]: a word for acceleration by axis that no document confirms in all that
//! it does.

use std::fmt::Write as _;
use std::io::Cursor;

use super::{EXACT_STOP, RIG, Rig, options};
use gwatt::machine::Machine;
use gwatt::pipeline::{Allowed, Failure, LimitOptions, LimitSummary, Strategy as How, analyze};
use proptest::prelude::*;

use crate::machines::{linear_axes, machine_from};
use crate::runs;

const SINUMERIK: Rig = Rig {
    controller: "siemens",
    rest: EXACT_STOP,
    ..RIG
};

const TRUSTED: Allowed = Allowed {
    feed: true,
    unverified: true,
    ..Allowed::NOTHING
};

fn limited(
    machine: &Machine,
    allowed: Allowed,
    strategy: How,
    program: &str,
) -> Result<(String, LimitSummary), Failure> {
    let how = LimitOptions {
        strategy,
        allowed,
        ..LimitOptions::USUAL
    };
    runs::limited(machine, &options(RIG.options), how, program)
}

/// The text of a program that was made to fit with the word.
fn fits(rig: &Rig, strategy: How, program: &str) -> String {
    let (text, summary) = limited(&rig.machine(), TRUSTED, strategy, program).expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    text
}

/// 1250 W of 1000 W: 80 % of the acceleration.
#[test]
fn acceleration_in_percent_of_each_axis() {
    assert_eq!(
        fits(
            &SINUMERIK,
            How::Accel,
            "G0 X400\nG1 X0 F30000\nX1 F100\nM30\n"
        ),
        "ACC[X]=80 ACC[Y]=80\nG0 X400\nG1 X0 F30000\nACC[X]=100 ACC[Y]=100\nX1 F100\nM30\n"
    );
}

/// Over 400 mm that costs 25 ms, and a lower speed 180 ms.
#[test]
fn a_rapid_keeps_its_speed() {
    let (text, summary) = limited(
        &SINUMERIK.machine(),
        TRUSTED,
        How::Optimal,
        "G0 X400\nM30\n",
    )
    .expect("a program");
    assert_eq!(
        text,
        "ACC[X]=80 ACC[Y]=80\nG0 X400\nACC[X]=100 ACC[Y]=100\nM30\n"
    );
    let longer_s = summary.after.duration_s - summary.before.duration_s;
    assert!(
        (longer_s - 0.1 * (1.0 / 0.8 - 1.0)).abs() < 1e-9,
        "{longer_s}"
    );
    let note = summary
        .before
        .notes
        .iter()
        .find(|note| note.rule == "unverified");
    let note = note.expect("a note");
    assert!(
        note.message.contains("no document confirms ACC"),
        "{}",
        note.message
    );
}

/// Without the permission the word is not written, and a strategy that needs it names it.
#[test]
fn it_needs_a_permission() {
    let feed = Allowed {
        feed: true,
        ..Allowed::NOTHING
    };
    let machine = SINUMERIK.machine();
    let (text, summary) =
        limited(&machine, feed, How::Optimal, "G0 X400\nM30\n").expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert!(!text.contains("ACC"), "{text}");
    let refused = limited(&machine, feed, How::Accel, "G0 X400\nM30\n");
    let Err(Failure::Unsuitable(message)) = refused else {
        panic!("not refused");
    };
    assert!(
        message.contains("--allow unverified permits ACC"),
        "{message}"
    );
}

/// What the program itself has set comes back, by axis, and in the block that needs it.
#[test]
fn percentages_of_the_program_come_back() {
    assert_eq!(
        fits(
            &SINUMERIK,
            How::Accel,
            "ACC[X]=90 ACC[Y]=120\nG0 X400\nG0 X401\nM30\n"
        ),
        "ACC[X]=90 ACC[Y]=120\nACC[X]=80 ACC[Y]=106\nG0 X400\nACC[X]=90 ACC[Y]=120\nG0 X401\nM30\n"
    );
    // A raised one is lowered: 1.5 · 1250 W.
    assert_eq!(
        fits(&SINUMERIK, How::Accel, "ACC[X]=150\nG0 X400\nM30\n"),
        "ACC[X]=150\nACC[X]=80 ACC[Y]=53\nG0 X400\nACC[X]=150 ACC[Y]=100\nM30\n"
    );
}

/// The axes of a rapid that are not straight arrive together: 9.88 % for Y.
#[test]
fn independent_axes_get_their_own() {
    let rig = Rig {
        peak_w: 1400.0,
        rest: "[path]\nmode = \"exact-stop\"\nrapid = \"independent\"",
        ..SINUMERIK
    };
    assert_eq!(
        fits(&rig, How::Optimal, "G0 X400 Y100\nM30\n"),
        "ACC[X]=100 ACC[Y]=10\nG0 X400 Y100\nACC[X]=100 ACC[Y]=100\nM30\n"
    );
}

/// In G64 each block is bounded together with its neighbours, whether the control stops for
/// the word or not.
#[test]
fn where_blocks_run_into_each_other_the_bound_holds() {
    let rig = Rig {
        rest: "",
        ..SINUMERIK
    };
    let program = "G64\nG0 X400\nG0 X400 Y300\nG1 X0 F30000\nX1 F100\nM30\n";
    let text = fits(&rig, How::Optimal, program);
    assert_eq!(
        text,
        "G64\nACC[X]=40 ACC[Y]=40\nG0 X400\nG0 X400 Y300\nG1 X0 F30000\nX1 F100\n\
         ACC[X]=100 ACC[Y]=100\nM30\n"
    );
    let machine = rig.machine();
    let after =
        analyze(Cursor::new(&text), &machine, &options(rig.options), None).expect("a program");
    assert!(after.fits() && after.peak_w <= 1000.0 * (1.0 + 1e-9));
}

/// No word for acceleration reaches into compensation, threads and lines that run under
/// percentages that differ.
#[test]
fn where_no_word_can_stand_none_is_written() {
    let cases = [
        (
            "M3 S3000\nG0 X0\nG33 X200 I10\nM30\n",
            "the block may not be changed: it moves in step with the spindle",
        ),
        (
            "FOR R1=1 TO 3\nACC[X]=R1*30\nG0 X400\nG0 X0\nENDFOR\nM30\n",
            "the block may not be changed: it runs several times, under feeds or modes that differ",
        ),
        (
            "G0 X400 ACC[X]=90\nM30\n",
            "the block may not be changed: it sets limits itself",
        ),
    ];
    for (program, reason) in cases {
        let found = limited(&SINUMERIK.machine(), TRUSTED, How::Optimal, program);
        let (_, summary) = found.expect("a program");
        assert!(!summary.certified, "{program}");
        assert_eq!(summary.reasons[0].message, reason, "{program}");
    }
    // Under compensation F alone can.
    let program =
        "$TC_DP6[1,1]=5\nT1 D1\nG1 G41 X10 Y10 F1000\nX400 F30000\nY20\nG40 X410 Y30\nM30\n";
    let text = fits(&SINUMERIK, How::Optimal, program);
    assert!(text.contains("\nX400 F") && !text.contains("ACC"), "{text}");
}

/// Feeds by time and by the revolution keep their F: a lower acceleration is no other feed.
#[test]
fn feeds_of_another_kind_keep_their_numbers() {
    for (modes, feed) in [("G93\n", "F75"), ("M3 S3000\nG95\n", "F10")] {
        let program = format!("{modes}G1 X400 {feed}\nM30\n");
        assert_eq!(
            fits(&SINUMERIK, How::Optimal, &program),
            format!("{modes}ACC[X]=80 ACC[Y]=80\nG1 X400 {feed}\nACC[X]=100 ACC[Y]=100\nM30\n")
        );
    }
    // A line that runs again gets it each time.
    let program = "FOR R1=1 TO 3\nG0 X400\nG0 X0\nENDFOR\nM30\n";
    assert_eq!(
        fits(&SINUMERIK, How::Optimal, program),
        "FOR R1=1 TO 3\nACC[X]=80 ACC[Y]=80\nG0 X400\nACC[X]=100 ACC[Y]=100\n\
         ACC[X]=80 ACC[Y]=80\nG0 X0\nACC[X]=100 ACC[Y]=100\nENDFOR\nM30\n"
    );
}

#[derive(Debug, Clone, Copy)]
struct Drives {
    mass: [f64; 2],
    coulomb: [f64; 2],
    speed: [f64; 2],
    accel: [f64; 2],
    peak_w: f64,
    exact: bool,
}

prop_compose! {
    fn drives()(
        mass in prop::array::uniform2(20.0..900.0),
        coulomb in prop::array::uniform2(0.0..300.0),
        speed in prop::array::uniform2(6_000..48_000),
        accel in prop::array::uniform2(500..9_800),
        share in 0.3..1.2_f64,
        exact in any::<bool>(),
    ) -> Drives {
        let speed = speed.map(|speed| f64::from(speed) / 6e4);
        let accel = accel.map(|accel| f64::from(accel) / 1e3);
        let most = |n: usize| speed[n] * (mass[n] * accel[n] + coulomb[n]);
        Drives { mass, coulomb, speed, accel, peak_w: (most(0) + most(1)) * share, exact }
    }
}

impl Drives {
    fn machine(&self) -> Machine {
        let mode = if self.exact { EXACT_STOP } else { "" };
        let axis = |n: usize, letter| {
            linear_axes(
                letter,
                [self.speed[n] * 6e4, self.accel[n] * 1e3, self.mass[n]],
                &format!("coulomb_n = {:?}", self.coulomb[n]),
            )
        };
        machine_from(&format!(
            "schema = 1\nname = \"random\"\ncontroller = \"siemens\"\n[converter]\n\
             peak_power_w = {:?}\n{mode}\n[limits]\nmargin = 0\n{}{}",
            self.peak_w,
            axis(0, "X"),
            axis(1, "Y")
        ))
    }
}

/// A straight move as an own reader finds it.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    start: [f64; 2],
    end: [f64; 2],
    /// m/s; infinite for a rapid.
    feed: f64,
    /// Of the axes' speeds.
    rapid_share: f64,
    acc: [f64; 2],
}

/// Reads G0, G1, G9, X, Y, F, ACC and OVRRAP; gives the moves and ACC at the end.
fn read(program: &str) -> (Vec<Line>, [f64; 2]) {
    let (mut at, mut feed, mut rapid, mut acc) = ([0.0; 2], 0.0, true, [100.0; 2]);
    let mut percent = 100.0;
    let mut lines = Vec::new();
    for line in program.lines() {
        let mut end = at;
        for word in line.split(' ').filter(|word| !word.is_empty()) {
            let value = |from: usize| word[from..].parse::<f64>().expect("a number");
            match word.as_bytes() {
                [b'A', b'C', b'C', b'[', axis, ..] => acc[usize::from(axis - b'X')] = value(7),
                [b'O', ..] => percent = value(7),
                [b'G', ..] if value(1) < 2.0 => rapid = word == "G0",
                [axis @ b'X'..=b'Y', ..] => end[usize::from(axis - b'X')] = value(1),
                [b'F', ..] => feed = value(1) / 6e4,
                _ => {}
            }
        }
        if end != at {
            lines.push(Line {
                start: at,
                end,
                feed: if rapid { f64::INFINITY } else { feed },
                rapid_share: if rapid { percent / 100.0 } else { 1.0 },
                acc,
            });
        }
        at = end;
    }
    (lines, acc)
}

impl Drives {
    /// Speed and acceleration along a move, m/s and m/s², and its peak from rest to rest, W.
    fn judge(&self, line: &Line) -> [f64; 3] {
        let way = [0, 1].map(|n| line.end[n] - line.start[n]);
        let length = libm::hypot(way[0], way[1]);
        let share = way.map(|way| way.abs() / length);
        let (mut v, mut a) = (line.feed, f64::INFINITY);
        for (n, share) in share.iter().enumerate() {
            v = v.min(self.speed[n] * line.rapid_share / share);
            a = a.min(self.accel[n] * line.acc[n] / 100.0 / share);
        }
        let top = v.min((a * length / 1e3).sqrt());
        let axis = |n: usize| top * share[n] * (self.mass[n] * a * share[n] + self.coulomb[n]);
        [v, a, axis(0) + axis(1)]
    }
}

/// Two rapids in one line: the first one only speeds up, the second one only brakes. Where the
/// first is lowered the motion may stop between them, and the second counts by itself too.
#[test]
fn rapids_that_go_straight_on_are_both_lowered() {
    let drives = Drives {
        mass: [860.0, 170.0],
        coulomb: [139.0, 0.0],
        speed: [0.1; 2],
        accel: [0.5, 1.9],
        peak_w: 32.4,
        exact: false,
    };
    let machine = drives.machine();
    for strategy in [How::Optimal, How::Accel] {
        let (text, summary) =
            limited(&machine, TRUSTED, strategy, "G0 X-18\nG0 X-25.8\nM30\n").expect("a program");
        assert!(summary.certified, "{:?}", summary.reasons);
        for line in read(&text).0 {
            let [.., peak_w] = drives.judge(&line);
            assert!(peak_w <= drives.peak_w, "{peak_w} {text}");
        }
    }
}

fn program() -> impl Strategy<Value = String> {
    let place = || prop::option::of(-40_000..40_000_i32);
    let block = (0..4_u8, place(), place(), 100..30_000_u32, 20..180_u32).prop_map(
        |(kind, x, y, feed, acc)| {
            let mut line = match kind {
                0 => return format!("ACC[X]={acc}\n"),
                1 => "G0".to_owned(),
                _ => format!("G1 F{feed}"),
            };
            for (letter, place) in [('X', x), ('Y', y)] {
                if let Some(place) = place {
                    let _ = write!(line, " {letter}{}", f64::from(place) / 100.0);
                }
            }
            line + "\n"
        },
    );
    prop::collection::vec(block, 1..20).prop_map(|blocks| blocks.concat() + "M30\n")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// What is written fits, on the same path, with no block faster and ACC as the program
    /// left it; every percentage is whole and within what the word takes.
    #[test]
    fn what_is_written_fits(
        program in program(),
        drives in drives(),
        strategy in prop::sample::select(vec![How::Optimal, How::Accel]),
    ) {
        let machine = drives.machine();
        let (text, summary) = limited(&machine, TRUSTED, strategy, &program).expect("a program");
        for reason in &summary.reasons {
            let faults = ["changed-motion", "changed-sequence", "went-up", "changed-feed", "unreadable-output", "edit"];
            prop_assert!(!faults.contains(&reason.rule), "{reason:?}\n{program}");
        }
        prop_assert!(summary.certified || strategy == How::Accel, "{:?}\n{program}", summary.reasons);
        if summary.certified {
            let (old, new) = (read(&program), read(&text));
            prop_assert_eq!(old.1, new.1, "{}", &text);
            prop_assert_eq!(old.0.len(), new.0.len());
            for (old, new) in old.0.iter().zip(&new.0) {
                prop_assert_eq!((old.start, old.end), (new.start, new.end));
                prop_assert!(new.acc.iter().all(|acc| (1.0..=200.0).contains(acc)));
                let ([v, a, _], [v_after, a_after, peak_w]) = (drives.judge(old), drives.judge(new));
                prop_assert!(v_after <= v * (1.0 + 1e-9) && a_after <= a * (1.0 + 1e-9), "{old:?} {new:?}");
                prop_assert!(peak_w <= drives.peak_w * (1.0 + 1e-6), "{peak_w} {new:?}\n{text}");
            }
            let mut trusting = machine;
            for knob in &mut trusting.controller.knobs {
                knob.verified = true;
            }
            let again = analyze(Cursor::new(&text), &trusting, &options(RIG.options), None);
            prop_assert!(again.expect("a program").fits());
        }
    }
}
