//! Words with levels: what each makes of the accelerations stands in the machine file, and
//! the limiter chooses among them.

use std::io::Cursor;

mod random;

use super::{RIG, Rig};
use gwatt::diagnostic::Severity;
use gwatt::pipeline::{Allowed, Failure, LimitOptions, Options, Strategy, analyze};

use crate::runs::{FEEDS, made_to_fit};

const HAAS: Rig = Rig {
    controller: "haas",
    rest: "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"\n[[levels]]\nacts_on = \"feeds\"\nlevel = [\
           { word = \"G187 P1\", accel_percent = 200 },\
           { word = [\"G187 P2\", \"G187\"], power_on = true },\
           { word = \"G187 P3\", accel_percent = 50 }]",
    ..RIG
};

/// X finishes with 2.5 m/s² and Y with 2 m/s².
const SINUMERIK: Rig = Rig {
    controller: "siemens",
    rest: "[path]\nmode = \"exact-stop\"\n[[levels]]\nacts_on = \"all\"\nlevel = [\
           { word = \"DYNNORM\", power_on = true },\
           { word = \"DYNROUGH\", accel_percent = 120 },\
           { word = \"DYNSEMIFIN\", accel_percent = 82 },\
           { word = \"DYNFINISH\", accel_mm_s2 = { X = 2500, Y = 2000 } }]",
    ..RIG
};

const GRBL: Rig = Rig {
    controller: "grbl",
    rest: "[[levels]]\nacts_on = \"all\"\nbetween_moves = true\nlevel = [\
           { word = [\"G187 P1\", \"G187\"], power_on = true },\
           { word = \"G187 P2\", accel_percent = 80 },\
           { word = \"G187 P3\", accel_percent = 60 },\
           { word = \"G187 P4\", accel_percent = 40 },\
           { word = \"G187 P5\", accel_percent = 20 }]",
    ..RIG
};

/// M words of a machine's builder for the speed of rapids.
const OVERRIDE: Rig = Rig {
    controller: "haas",
    rest: "[[levels]]\nacts_on = \"rapids\"\nverified = true\nlevel = [\
           { word = \"M131\", rapid_percent = 25 },\
           { word = \"M132\", rapid_percent = 50 },\
           { word = \"M133\", power_on = true }]",
    ..RIG
};

const FANUC: Rig = Rig {
    controller: "fanuc",
    rest: "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"\n[[levels]]\nacts_on = \"feeds\"\nlevel = [\
           { word = \"G5.1 Q0\", power_on = true },\
           { word = \"G5.1 Q1 R1\", accel_percent = 150 },\
           { word = \"G5.1 Q1 R10\", accel_percent = 60 }]",
    ..RIG
};

/// Largest peak and duration of a program.
fn figures(rig: Rig, program: &str) -> (f64, f64) {
    let summary = analyze(
        Cursor::new(program),
        &rig.machine(),
        &Options::default(),
        None,
    )
    .expect("a program");
    (summary.peak_w, summary.duration_s)
}

fn close(found: (f64, f64), wanted: (f64, f64)) {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b.abs();
    assert!(
        near(found.0, wanted.0) && near(found.1, wanted.1),
        "{found:?}, not {wanted:?}"
    );
}

/// 500 kg · 0.5 m/s · 2.5 m/s² = 625 W, and 400 mm take 0.8 s + 0.5/2.5 s. P1 has 10 m/s²
/// and 2500 W, P2 and G187 alone what the axes have, and the rapid always has that.
#[test]
fn a_program_s_own_levels_count() {
    let run = |word: &str| figures(HAAS, &format!("{word}\nG1 X400. F30000.\nM30\n"));
    close(run("G187 P1"), (2500.0, 0.85));
    close(run("G187 P2"), (1250.0, 0.9));
    close(run("G187 P3 E0.01"), (625.0, 1.0));
    close(run("G187 P3\nG187"), (1250.0, 0.9));
    close(run(""), (1250.0, 0.9));
    close(figures(HAAS, "G187 P3\nG0 X400.\nM30\n"), (1250.0, 0.9));
    let run = |words: &str| figures(SINUMERIK, &format!("{words} G1 X400 F30000\nM30\n"));
    // It acts in its own block.
    close(run("DYNFINISH"), (625.0, 1.0));
    close(run("DYNROUGH"), (1500.0, 0.8 + 0.5 / 6.0));
    close(run("DYNFINISH\ndynnorm"), (1250.0, 0.9));
    // ACC is a percentage of the level, whichever came first: 5, 1.25 and 2.5 m/s².
    close(run("DYNFINISH\nACC[X]=200\n"), (1250.0, 0.9));
    close(run("ACC[X]=50\nDYNFINISH"), (312.5, 1.2));
    close(run("DYNFINISH\nACC[X]=50\nDYNNORM"), (625.0, 1.0));
    close(
        figures(SINUMERIK, "DYNFINISH\nG0 Y400\nM30\n"),
        (500.0, 1.05),
    );
    let run = |word: &str| figures(GRBL, &format!("{word}\nG1 X400 F30000\nM2\n"));
    // The same words as on a Haas, with other shares.
    close(run("G187 P1"), (1250.0, 0.9));
    close(run("G187 P3"), (750.0, 0.8 + 0.5 / 3.0));
    close(run("G187 P5\nG187"), (1250.0, 0.9));
    // Half the speed with the same acceleration, on rapids alone.
    let run = |program: &str| figures(OVERRIDE, program);
    close(run("M132\nG0 X400.\nM30\n"), (625.0, 1.65));
    close(run("M131\nG0 X400.\nM133\nG0 X0.\nM30\n"), (1250.0, 4.125));
}

/// Without a level 1250 W are 1000 W with F24000, which takes 1.08 s; with P3 they are
/// 625 W and 1 s. A rapid becomes a feed by it.
#[test]
fn a_level_that_is_sooner_is_taken() {
    assert_eq!(
        HAAS.fits("G1 X400. F30000.\nX0 F100.\nM30\n"),
        "G187 P3\nG1 X400. F30000.\nG187 P2\nX0 F100.\nM30\n"
    );
    assert_eq!(
        HAAS.fits("G1 F100.\nG0 X400.\nG1 X401.\nM30\n"),
        "G1 F100.\nG187 P3\nG1 X400. F30000.\nG187 P2\nG1 X401. F100.\nM30\n"
    );
    let (_, summary) = HAAS
        .limit(b"G1 X400. F30000.\nX0 F100.\nM30\n")
        .expect("a program");
    let conditions = summary.after.conditions.join("\n");
    assert!(
        conditions.contains("G187 P2 holds when the program begins"),
        "{conditions}"
    );
}

/// 82 % of 1250 W are 1025 W: with F29268 next to it they are 1000 W, in 0.82 s + 0.119 s;
/// the next level alone takes 1 s.
#[test]
fn a_level_and_a_lower_feed_go_together() {
    let (text, summary) = SINUMERIK
        .limit(b"G1 X400 F30000\nX0 F100\nM30\n")
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(
        String::from_utf8(text).expect("text"),
        "DYNSEMIFIN\nG1 X400 F29268\nDYNNORM\nX0 F100\nM30\n"
    );
    // Rapids stay rapids, since the levels act on them.
    assert_eq!(
        SINUMERIK
            .strategy(Strategy::Accel)
            .fits("G0 X400\nG1 X401 F100\nM30\n"),
        "DYNFINISH\nG0 X400\nDYNNORM\nG1 X401 F100\nM30\n"
    );
}

/// What the program has selected comes back, and at stops and tool changes it is in force.
#[test]
fn the_level_of_the_program_comes_back() {
    assert_eq!(
        HAAS.fits("G187 P1\nG1 X400. F30000.\nX401. F100.\nG187 P3\nX0 F30000.\nM30\n"),
        "G187 P1\nG187 P3\nG1 X400. F30000.\nG187 P1\nX401. F100.\nG187 P3\nX0 F30000.\nM30\n"
    );
    let text = HAAS.fits("G1 X400. F30000.\nM0\nX0\nM30\n");
    assert_eq!(
        text,
        "G187 P3\nG1 X400. F30000.\nG187 P2\nM0\nG187 P3\nX0\nG187 P2\nM30\n"
    );
}

/// A rapid that runs at half its speed: 625 W for each axis, and both are 1250 W.
#[test]
fn rapid_overrides_are_levels_of_speed() {
    let rig = Rig {
        peak_w: 1300.0,
        ..OVERRIDE
    };
    for strategy in [Strategy::Speed, Strategy::Optimal] {
        assert_eq!(
            rig.strategy(strategy)
                .fits("G0 X400. Y400.\nG1 X401. F100.\nG0 X402.\nM30\n"),
            "M132\nG0 X400. Y400.\nG1 X401. F100.\nM133\nG0 X402.\nM30\n"
        );
    }
    let refused = rig
        .strategy(Strategy::Accel)
        .limit(b"G0 X400. Y400.\nM30\n");
    assert!(format!("{refused:?}").contains("no word for acceleration"));
    // 0.25 of the speed takes 3.225 s: as a feed of F24000 the same rapid takes 1.08 s.
    let text = OVERRIDE.fits("G1 F100.\nG0 X400.\nM30\n");
    assert!(text.contains("G1 X400. F24000"), "{text}");
}

/// Each change costs the time for which the axes stand: 2 · 0.3 s are more than the lower
/// feed, 2 · 0.01 s are less, and the plan has them.
#[test]
fn the_time_of_a_change_counts() {
    let with = |seconds: &str| {
        let rest = HAAS
            .rest
            .replace("level =", &format!("change_s = {seconds}\nlevel ="));
        Rig {
            rest: Box::leak(rest.into_boxed_str()),
            ..HAAS
        }
    };
    assert_eq!(
        with("0.3").fits("G1 X400. F30000.\nM30\n"),
        "G1 X400. F24000.\nF30000.\nM30\n"
    );
    let (text, summary) = with("0.01")
        .limit(b"G1 X400. F30000.\nX401. F100.\nM30\n")
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert!(text.starts_with(b"G187 P3\nG1 X400. F30000.\nG187 P2\n"));
    let longer_s = summary.after.duration_s - summary.before.duration_s;
    assert!((longer_s - 0.12).abs() < 1e-9, "{longer_s}");
}

/// Where the axes may run on, a word is written only where the machine file says that it
/// acts there.
#[test]
fn between_moving_blocks_only_where_that_is_said() {
    let blends = |between: bool| {
        let rest = SINUMERIK
            .rest
            .replace("[path]\nmode = \"exact-stop\"\n", "")
            .replace("level =", &format!("between_moves = {between}\nlevel ="));
        Rig {
            rest: Box::leak(rest.into_boxed_str()),
            ..SINUMERIK
        }
    };
    let program = "G64 G1 F30000\nX400\nX0\nX400\nF100\nM30\n";
    let without = blends(false).fits(program);
    assert!(!without.contains("DYN"), "{without}");
    let with = blends(true).fits(program);
    assert!(with.contains("DYN"), "{with}");
    let time_s = |rig: Rig, text: &str| figures(rig, text).1;
    assert!(time_s(blends(true), &with) < time_s(blends(true), &without));
    // grbl plans every block with the acceleration in force.
    let text = GRBL
        .strategy(Strategy::Accel)
        .fits("G1 X400 F30000\nX0\nX1 F100\nM2\n");
    assert_eq!(text, "G187 P2\nG1 X400 F30000\nX0\nG187 P1\nX1 F100\nM2\n");
}

/// What one window has given a move, the next one does not take back: here the same three
/// feeds are in four windows.
#[test]
fn windows_agree_about_levels() {
    let rest = SINUMERIK
        .rest
        .replace("[path]\nmode = \"exact-stop\"\n", "")
        .replace("level =", "between_moves = true\nlevel =");
    let rig = Rig {
        rest: Box::leak(rest.into_boxed_str()),
        ..SINUMERIK
    };
    for peak_w in [300.0, 500.0, 700.0, 900.0, 1100.0] {
        let rig = Rig { peak_w, ..rig };
        rig.fits("G64 G1 F5000\nX120 Y30\nX240 Y-60 F28000\nX120 Y0\nX0 F9000\nM30\n");
    }
}

/// Words that no document confirms are read, and written only on request.
#[test]
fn levels_without_a_document_need_a_permission() {
    let program = "G1 X400. F30000.\nX401. F100.\nM30\n";
    assert_eq!(FANUC.fits(program), "G1 X400. F24000.\nX401. F100.\nM30\n");
    close(
        figures(FANUC, "G05.1 Q1 R10\nG1 X400. F30000.\nG05.1 Q0\nM30\n"),
        (750.0, 0.8 + 0.5 / 3.0),
    );
    let how = LimitOptions {
        allowed: Allowed {
            unverified: true,
            ..FEEDS
        },
        ..LimitOptions::USUAL
    };
    let (text, _) = made_to_fit(&FANUC.machine(), &Options::default(), how, program);
    assert_eq!(
        text,
        "G5.1 Q1 R10\nG1 X400. F30000.\nG5.1 Q0\nX401. F100.\nM30\n"
    );
    let refused = FANUC.strategy(Strategy::Accel).limit(program.as_bytes());
    let Err(Failure::Unsuitable(message)) = refused else {
        panic!("{refused:?}");
    };
    assert!(
        message.contains("(--allow unverified permits G5.1 Q1 R10, G5.1 Q0, G5.1 Q1 R1, which"),
        "{message}"
    );
}

/// Lines with levels come into no thread, no cycle, no compensated contour and no block
/// that may be skipped; under G93 and G95 they change no feed.
#[test]
fn where_nothing_may_be_written_nothing_is() {
    for program in [
        "S1000 M3\nG33 X400. F5.\nM30\n",
        "G41 D1 X10. Y10. G1 F30000.\nX400.\nX0\nG40 Y0\nM30\n",
        "G0 X0\nG66 P9000\nX400.\nG67\nM30\n",
    ] {
        if let Ok((text, _)) = HAAS.limit(program.as_bytes()) {
            let text = String::from_utf8(text).expect("text");
            assert!(!text.contains("G187"), "{text}");
        }
    }
    assert_eq!(
        HAAS.fits("G93\nG1 X400. F75.\nX401. F1.\nM30\n"),
        "G93\nG187 P3\nG1 X400. F75.\nG187 P2\nX401. F1.\nM30\n"
    );
    // In a loop each run has its own pair of lines.
    let text = HAAS.fits("#1=0\nWHILE[#1LT3]DO1\nG1 X400. F30000.\nX0 F100.\n#1=#1+1\nEND1\nM30\n");
    assert_eq!(
        text.matches("G187 P3\nG1 X400. F30000.\nG187 P2\n").count(),
        1
    );
}

/// A word of the group whose level the machine file does not have is refused; one that
/// leaves open which level is meant counts as the highest, and nothing is written after it.
#[test]
fn what_is_not_known_is_refused_or_counts_higher() {
    let said = |rig: Rig, program: &str| {
        let found = rig.refusal(program);
        let mut errors = found.iter().filter(|it| it.severity == Severity::Error);
        let first = errors.next().expect("a reason");
        format!("{}: {}", first.rule, first.message)
    };
    assert_eq!(
        said(HAAS, "G187 P9\nG1 X400. F30000.\nM30\n"),
        "level-unknown: what this level makes of the accelerations is not known: the machine \
         file has G187 P3, G187 P2, G187 P1"
    );
    assert_eq!(
        said(FANUC, "G5.1 Q1\nG1 X400. F30000.\nM30\n"),
        "level-unknown: what this level makes of the accelerations is not known: the machine \
         file has G5.1 Q1 R10, G5.1 Q0, G5.1 Q1 R1"
    );
    assert_eq!(
        said(SINUMERIK, "DYNPREC\nG1 X400 F30000\nM30\n"),
        "level-unknown: what DYNPREC makes of the accelerations is not known"
    );
    assert_eq!(
        said(
            SINUMERIK,
            "T1 D1\nG41 G1 X10 Y10 F1000\nDYNFINISH\nX20\nG40 Y0\nM30\n"
        ),
        "compensation: a dynamic mode under tool radius compensation is not followed"
    );
    let open = "G187 P3\nG187 E0.01\nG1 X400. F30000.\nM30\n";
    close(figures(HAAS, open), (2500.0, 0.85));
    assert!(!HAAS.fits(open).contains("G187 P2"));
    let open = "DYNFINISH\nCYCLE832(0.01,3,1)\nG1 X400 F30000\nM30\n";
    close(figures(SINUMERIK, open), (1500.0, 0.8 + 0.5 / 6.0));
    let text = SINUMERIK.fits(open);
    assert!(text.contains("F20000"), "{text}");
}

/// "DYNPOS: positioning mode, tapping": a thread may run under any mode, so that the highest
/// acceleration counts, here 6 m/s² of DYNROUGH, and the mode is what it was afterwards.
#[test]
fn threads_count_with_the_highest_acceleration() {
    let program = |thread: &str| format!("DYNFINISH\nS600 M3\n{thread}\nG1 X800 F30000\nM30\n");
    let (plain_w, _) = figures(SINUMERIK, &program("G1 X400 F30000"));
    assert!((plain_w - 625.0).abs() < 1e-6, "{plain_w}");
    // 10 1/s with 50 mm a turn: 0.5 m/s.
    let (thread_w, _) = figures(SINUMERIK, &program("G33 X400 I50"));
    assert!((thread_w - 1500.0).abs() < 1e-6, "{thread_w}");
}

/// A subprogram with SAVE gives the mode of its caller back, another one leaves its own.
#[test]
fn saved_modes_come_back() {
    let run = |save: &str| {
        figures(
            SINUMERIK,
            &format!(
                "%_N_M_MPF\nPART\nG1 X400 F30000\nM30\n%_N_PART_SPF\nPROC PART{save}\nDYNFINISH\nM17\n"
            ),
        )
    };
    close(run(" SAVE"), (1250.0, 0.9));
    close(run(""), (625.0, 1.0));
}

/// Without levels the words are read as before, and it is said what they rest on.
#[test]
fn without_levels_the_words_are_noted() {
    let notes = |controller: &'static str, program: &str| -> Vec<&'static str> {
        let rig = Rig { controller, ..RIG };
        let summary = analyze(
            Cursor::new(program.as_bytes()),
            &rig.machine(),
            &Options::default(),
            None,
        )
        .expect("a program");
        summary.notes.iter().map(|note| note.rule).collect()
    };
    assert!(notes("haas", "G187 P1\nG1 X1. F100.\nM30\n").contains(&"smoothness"));
    assert!(notes("fanuc", "G5.1 Q1\nG1 X1. F100.\nM30\n").contains(&"control-mode"));
    assert!(notes("fanuc", "G8 P1\nG1 X1. F100.\nM30\n").contains(&"control-mode"));
    assert!(!notes("fanuc", "G5.1 Q0\nG8 P0\nG1 X1. F100.\nM30\n").contains(&"control-mode"));
    assert!(notes("siemens", "DYNROUGH\nG1 X1 F100\nM30\n").contains(&"dynamic-mode"));
    assert!(!notes("siemens", "DYNNORM\nG1 X1 F100\nM30\n").contains(&"dynamic-mode"));
}
