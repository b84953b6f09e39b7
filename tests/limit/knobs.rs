//! Words for acceleration and rapid speed: inserted, and taken back.

use super::{EXACT_STOP, RIG, Rig};
use gwatt::pipeline::{Allowed, Failure, Law, LimitOptions, Options, Strategy, limit};

const ISG: Rig = Rig {
    controller: "isg",
    rest: EXACT_STOP,
    ..RIG
};

const MARLIN: Rig = Rig {
    controller: "marlin",
    rest: EXACT_STOP,
    ..RIG
};

#[test]
fn isg_acceleration() {
    assert_eq!(
        ISG.strategy(Strategy::Accel)
            .fits("G0 X400\nG1 X0 F30000\nX1 F100\nM30\n"),
        "G231 = 79.9\nG0 X400\nG131 = 79.9\nG1 X0 F30000\nG131 = 100\nX1 F100\nG231 = 100\nM30\n"
    );
}

/// After G20 some versions of RepRapFirmware take M201 in mm, others in inches: it stands
/// after G21. 1181 in/min are 0.49996 m/s, of 500 kg with 4 m/s² 1000 W.
#[test]
fn limits_of_reprapfirmware_in_inch_programs() {
    const REPRAP: Rig = Rig {
        controller: "reprap",
        rest: EXACT_STOP,
        ..RIG
    };
    let program = "G20\nG1 X16 F1181\nG1 X15 F40\nG1 X0 F40\nM400\n";
    let accel = REPRAP.strategy(Strategy::Accel);
    let text = accel.fits(program);
    assert!(text.starts_with("G20\nG21\nG1\nM201 X4000 Y"), "{text}");
    assert!(
        text.contains("\nG21\nG1\nM201 X5000 Y5000\nG20\n"),
        "{text}"
    );
    assert_eq!(
        text.matches("M201").count(),
        text.matches("G21\nG1\nM201").count()
    );
    assert_eq!(accel.fits(&text), text);
    // What the program sets in inches could not be put back.
    let own = format!("G20\nM201 X196 Y196\n{}", &program[4..]);
    assert!(!accel.reasons(&own).is_empty());
    let text = REPRAP.fits(&own);
    assert_eq!(text.matches("M201").count(), 1, "{text}");
    assert!(!text.contains("G21"), "{text}");
}

#[test]
fn isg_rapid_speed_and_feed() {
    assert_eq!(
        ISG.strategy(Strategy::Speed)
            .fits("G0 X400\nG1 X0 F30000\nX1 F100\nG0 X2\nM30\n"),
        "G129 = 80\nG0 X400\nG1 X0 F24000\nX1 F100\nG129 = 100\nG0 X2\nM30\n"
    );
}

/// X takes 0.8 s + 0.1 s, and Y alone would take 0.3 s: with 4·100 mm/(0.9 s)² =
/// 493.8 mm/s², 9.88 %, it arrives with X. At the end of X' ramp both draw 1250 W +
/// 12 W where they drew 2500 W, and no time is lost; by one word for both it would be
/// 56 % and 0.98 s.
#[test]
fn independent_axes_arrive_together() {
    let rig = Rig {
        peak_w: 1400.0,
        rest: "[path]\nmode = \"exact-stop\"\nrapid = \"independent\"",
        ..ISG
    };
    for strategy in [Strategy::Accel, Strategy::Optimal] {
        let (text, summary) = rig
            .strategy(strategy)
            .limit(b"G0 X400 Y100\nG1 X0 F100\nG0 X10\nM30\n")
            .expect("a program");
        assert!(summary.certified, "{:?}", summary.reasons);
        assert_eq!(
            String::from_utf8(text).expect("text"),
            "G230 X100 Y9.9\nG0 X400 Y100\nG1 X0 F100\nG231 = 100\nG0 X10\nM30\n"
        );
        assert_eq!(summary.after.duration_s, summary.before.duration_s);
    }
    // What the program itself has set by axis comes back by axis.
    let text = rig
        .strategy(Strategy::Accel)
        .fits("G230 X90 Y80\nG0 X400 Y100\nG0 X410\nM30\n");
    assert!(text.starts_with("G230 X90 Y80\nG230 X90 Y"), "{text}");
    assert!(
        text.ends_with("\nG0 X400 Y100\nG230 X90 Y80\nG0 X410\nM30\n"),
        "{text}"
    );
}

/// Where arriving together is not enough all arrive later: 1250 W of X are 950 W with
/// 76 % of its acceleration, and Y draws a little next to it.
#[test]
fn independent_axes_arrive_together_a_little_later() {
    let rig = Rig {
        peak_w: 950.0,
        rest: "[path]\nmode = \"exact-stop\"\nrapid = \"independent\"",
        ..ISG
    };
    let (text, summary) = rig
        .strategy(Strategy::Accel)
        .limit(b"G0 X400 Y100\nM30\n")
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    let text = String::from_utf8(text).expect("text");
    assert!(text.starts_with("G230 X7"), "{text}");
    // 0.8 s + 0.1 s/0.75; one word for both makes it 0.8 s + 0.1 s/0.38.
    let rise = summary.after.duration_s / summary.before.duration_s;
    assert!((1.03..1.045).contains(&rise), "{rise}: {text}");
    assert!(
        summary.after.peak_w > 0.99 * 950.0,
        "{}",
        summary.after.peak_w
    );
}

/// 2500 N at 500 mm/s are 1250 W of 1000 W, but a block that accelerates slowly does
/// not get there: `√(a·1 m)·(500 kg·a + 2500 N) = 1000 W`, a = 0.1508 m/s²,
/// 3.015 %.
#[test]
fn slow_enough_a_block_does_not_reach_its_friction() {
    let rig = Rig {
        axis: "coulomb_n = 2500",
        ..ISG
    };
    let (text, summary) = rig
        .strategy(Strategy::Accel)
        .limit(b"G0 X1000\nM30\n")
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(
        String::from_utf8(text).expect("text"),
        "G231 = 3\nG0 X1000\nG231 = 100\nM30\n"
    );
    // 2·√(1 m/0.15 m/s²) for 1 m/0.5 m/s + 0.5 m/s/5 m/s².
    assert!((summary.after.duration_s - 5.1640).abs() < 1e-4);
    assert!((summary.before.duration_s - 2.1).abs() < 1e-9);
}

/// Over 400 mm acceleration alone costs less time than speed.
#[test]
fn isg_optimum_writes_no_word_that_changes_nothing() {
    let text = ISG.fits("G0 X400\nG1 X0 F30000\nX1 F100\nM30\n");
    assert!(text.contains("G231 ="), "{text}");
    assert!(!text.contains("G129"), "{text}");
    assert!(text.contains("F30000\n"), "{text}");
}

#[test]
fn isg_values_of_the_program_come_back() {
    let rig = Rig {
        peak_w: 700.0,
        ..ISG
    };
    assert_eq!(
        rig.strategy(Strategy::Accel)
            .fits("G130 X80 Y50\nG1 X400 F30000\nG1 X0\nM30\n"),
        "G130 X80 Y50\nG130 X55.9 Y34.9\nG1 X400 F30000\nG1 X0\nG130 X80 Y50\nM30\n"
    );
}

#[test]
fn marlin_acceleration() {
    assert_eq!(
        MARLIN
            .strategy(Strategy::Accel)
            .fits("G0 X400 F30000\nG1 X0\nG1 X1 F100\n"),
        "M201 X3999 Y3999\nG0 X400 F30000\nG1 X0\nM201 X5000 Y5000\nG1 X1 F100\n"
    );
}

/// 500 mm/s² are 19.685 in/s²: what comes back must not be higher.
#[test]
fn marlin_acceleration_in_inches() {
    let rig = Rig {
        axis: "viscous_n_s_m = 1",
        ..MARLIN
    };
    let text = rig
        .strategy(Strategy::Accel)
        .fits("G20\nG1 X15 F1100\nX14.99\n");
    assert!(text.contains("M201 X196.85039370"), "{text}");
}

/// The line before a block is read in the unit before it.
#[test]
fn marlin_acceleration_beside_a_change_of_units() {
    // RepRapFirmware reads both commands of the line.
    let rig = Rig {
        controller: "reprap",
        ..MARLIN
    };
    assert_eq!(
        rig.strategy(Strategy::Accel)
            .fits("G1 F30000 X1\nG20 G1 X15\nG21\nG1 X380\n"),
        "G1 F30000 X1\nG1\nM201 X3999 Y3999\nG20 G1 X15\nG21\nG1\nM201 X5000 Y5000\nG1 X380\n"
    );
}

/// A word that no document confirms is written on request alone, and the summary says so.
#[test]
fn unconfirmed_words_are_written_on_request() {
    let mut machine = ISG.machine();
    for knob in &mut machine.controller.knobs {
        knob.verified = false;
    }
    let run = |strategy, unverified| {
        let how = LimitOptions {
            strategy,
            law: Law::Exact,
            allowed: Allowed {
                unverified,
                ..Allowed::NOTHING
            },
            ..LimitOptions::USUAL
        };
        let mut text = Vec::new();
        let program = std::io::Cursor::new(b"G0 X400\nM30\n");
        let summary = limit(program, &machine, &Options::default(), how, &mut text, None)?;
        Ok::<_, Failure>((String::from_utf8(text).expect("text"), summary))
    };
    let Err(Failure::Unsuitable(message)) = run(Strategy::Accel, false) else {
        panic!("no word");
    };
    assert!(
        message.contains("--allow unverified permits G131, "),
        "{message}"
    );
    let (text, summary) = run(Strategy::Speed, false).expect("a program");
    assert!(!text.contains("G129"), "{text}");
    assert!(
        summary
            .before
            .notes
            .iter()
            .all(|note| note.rule != "unverified")
    );
    let (text, summary) = run(Strategy::Accel, true).expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(text, "G231 = 79.9\nG0 X400\nG231 = 100\nM30\n");
    let notes = summary
        .before
        .notes
        .iter()
        .filter(|note| note.rule == "unverified");
    assert_eq!(notes.count(), 1);
}

/// Homing, and moves before any F, take no F: M203 caps them by axis, in mm/s with Marlin
/// and mm/min with RepRapFirmware, and what the program or the machine had comes back.
#[test]
fn largest_feeds_by_axis() {
    for (controller, unit) in [("marlin", 1.0), ("reprap", 60.0)] {
        let rig = Rig {
            controller,
            rest: "",
            ..RIG
        }
        .strategy(Strategy::Speed);
        let words = |axes: [f64; 2]| {
            let [x, y] = axes.map(|speed| speed * unit);
            format!("M203 X{x} Y{y}")
        };
        let machine = rig.machine();
        let own = [0, 1].map(|axis| machine.axes[axis].expect("an axis").rapid_mm_s);
        // RepRapFirmware: `G1` keeps the word off the move before.
        let text = rig
            .fits("G28 X\nG1 Y1 F60\nM84\n")
            .replace("G1\nM203", "M203");
        let (first, rest) = text.split_once('\n').expect("lines");
        assert!(first.starts_with("M203 X"), "{text}");
        assert_eq!(rest, format!("G28 X\n{}\nG1 Y1 F60\nM84\n", words(own)));
        // Its own limit is no reason to write another one, nor does homing go faster.
        let own = format!("{}\n", words([100.0, 100.0]));
        let text = rig.fits(&format!("{own}G28 X\nG1 Y1 F60\nM84\n"));
        assert_eq!(text, format!("{own}G28 X\nG1 Y1 F60\nM84\n"));
    }
}
