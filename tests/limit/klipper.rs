//! Klipper's `SET_VELOCITY_LIMIT`: limits along the path, inserted and taken back.

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{Allowed, Failure, LimitOptions, LimitSummary, Options, Strategy, analyze};
use proptest::prelude::*;

use crate::machines::{linear_axes, machine_from};
use crate::runs::{limited, made_to_fit};

/// From a place that is not known axes are held to the limit along the path, Z too: what is
/// found for one acceleration must not hold it to a lower one.
#[test]
fn accelerations_from_an_unknown_place_are_enough() {
    let text = "schema = 1\nname = \"test\"\ncontroller = \"klipper\"\n[converter]\n\
                peak_power_w = 70\nbase_load_w = 30\n\
                [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 10000\nmass_kg = 2.5\n\
                coulomb_n = 8\nefficiency = 0.6\n\
                [axes.Y]\nrapid_mm_min = 30000\naccel_mm_s2 = 10000\nmass_kg = 15\n\
                coulomb_n = 12\nefficiency = 0.6\n\
                [axes.Z]\nrapid_mm_min = 1200\naccel_mm_s2 = 500\nmass_kg = 60\n\
                coulomb_n = 30\ngravity_n = 20\nefficiency = 0.5\n";
    let machine = machine_from(text);
    let program = "G28\nG1 X50 Y50 Z5 F6000\nG28 X Y\nG1 X20 Y20 F6000\n";
    let (text, _) = fits(&machine, how(Strategy::Optimal, false), program);
    assert!(text.contains("\nG1 X50 Y50 Z5 F6000\n"), "{text}");
}

/// 10 kg with 50 N of friction: at the 200 mm/s that are asked for friction alone takes 10 W.
/// 50 mm are too short for them. Klipper cruises half of each hill, so that √(a·50/2) mm/s are
/// reached, which with a = 769 mm/s² takes 57.69 N · 0.13865 m/s = 7.999 W, with 770 8.005 W.
#[test]
fn a_block_too_short_for_its_speed_fits_by_its_acceleration() {
    let text = "schema = 1\nname = \"test\"\ncontroller = \"klipper\"\n[converter]\n\
                peak_power_w = 8\n[limits]\nmargin = 0.0\n\
                [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 1000\nmass_kg = 10\n\
                coulomb_n = 50\nreference_mm = 0\n\
                [axes.Y]\nrapid_mm_min = 30000\naccel_mm_s2 = 1000\nmass_kg = 10\n";
    let machine = machine_from(text);
    let program = "G1 X0 F600\nG1 X50 F12000\nG1 X0 F600\n";
    let (text, _) = fits(&machine, how(Strategy::Optimal, false), program);
    let expected = "G1 X0 F600\nSET_VELOCITY_LIMIT ACCEL=769\nG1 X50 F12000\n\
                    SET_VELOCITY_LIMIT ACCEL=1000\nG1 X0 F600\n";
    assert_eq!(text, expected);
    // Next to others it has less: what it draws there is looked at, not what it could.
    let program = "G28\nG1 X50 F12000\nG1 X110 F12000\nG1 X0 F600\n";
    fits(&machine, how(Strategy::Optimal, false), program);
    // Where it reaches its speed with the lowest value as well, friction is what exceeds.
    let program = "G28\nG1 X90000 F12000\n";
    let refusal = refused(&machine, how(Strategy::Optimal, false), program);
    let friction = "friction alone takes 125.0 %";
    assert!(refusal.contains(friction), "{refusal}");
}

/// Without an F a diagonal is bounded by its axes, √2 · 200 mm/s; a word for the largest speed
/// is never above that of the machine.
#[test]
fn no_word_for_the_largest_speed_is_above_that_of_the_machine() {
    let program = "G0 Z5\nG0 X100 Y100\nG1 X10 F500\n";
    for peak_w in [1.0, 2.0, 2.2, 2.5] {
        let (text, _) = fits(&machine(peak_w, ""), how(Strategy::Speed, false), program);
        let word = "SET_VELOCITY_LIMIT VELOCITY=";
        let mut values = text.lines().filter_map(|line| line.strip_prefix(word));
        let highest = values.try_fold(0.0_f64, |most, it| Some(most.max(it.parse().ok()?)));
        assert_eq!(highest, Some(200.0), "{text}");
    }
}

/// 10 kg by X and by Y, 200 mm/s and 1000 mm/s²: from rest to 200 mm/s along X takes
/// 10·1·0.2 = 2 W.
fn machine(peak_w: f64, rest: &str) -> Machine {
    let home = "reference_mm = 0";
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"klipper\"\n{rest}\n\
         [converter]\npeak_power_w = {peak_w:?}\n[limits]\nmargin = 0.0\n{}{}{}",
        linear_axes("XY", [12000.0, 1000.0, 10.0], home),
        linear_axes("Z", [600.0, 100.0, 1.0], home),
        linear_axes("E", [3000.0, 1000.0, 0.1], home)
    ))
}

fn how(strategy: Strategy, feed: bool) -> LimitOptions {
    LimitOptions {
        strategy,
        allowed: Allowed {
            feed,
            ..Allowed::NOTHING
        },
        ..LimitOptions::USUAL
    }
}

fn run(
    machine: &Machine,
    how: LimitOptions,
    program: &str,
) -> Result<(String, LimitSummary), Failure> {
    limited(machine, &Options::default(), how, program)
}

#[track_caller]
fn fits(machine: &Machine, how: LimitOptions, program: &str) -> (String, LimitSummary) {
    made_to_fit(machine, &Options::default(), how, program)
}

#[track_caller]
fn refused(machine: &Machine, how: LimitOptions, program: &str) -> String {
    let (_, summary) = run(machine, how, program).expect("a program");
    assert!(!summary.certified, "{program}");
    let reasons = summary.reasons.iter().map(|it| it.message.as_str());
    reasons.collect::<Vec<_>>().join("; ")
}

/// Half the power leaves half of the acceleration: 500 mm/s². Along the diagonal the path
/// has 1000 mm/s² at 200 mm/s too, which is 2 W.
#[test]
fn acceleration_is_lowered_along_the_path_and_put_back() {
    let machine = machine(1.001, "");
    let (text, summary) = fits(
        &machine,
        how(Strategy::Accel, false),
        "G1 X200 F12000\nG1 X320 Y160\nG1 X319 F300\nM84\n",
    );
    assert_eq!(
        text,
        "SET_VELOCITY_LIMIT ACCEL=500\nG1 X200 F12000\nG1 X320 Y160\n\
         SET_VELOCITY_LIMIT ACCEL=1000\nG1 X319 F300\nM84\n"
    );
    assert!(
        (summary.before.peak_w - 2.0).abs() < 1e-9,
        "{}",
        summary.before.peak_w
    );
    assert!(
        (summary.after.peak_w - 1.0).abs() < 1e-9,
        "{}",
        summary.after.peak_w
    );
    // What the program has set itself comes back. Half of the hill is cruised, so that with
    // 585 mm/s² √(585·100/2) = 171.03 mm/s are reached: 10·0.585·0.17103 = 1.0005 W.
    for word in ["M204 S800", "SET_VELOCITY_LIMIT ACCEL=800"] {
        let (text, _) = fits(
            &machine,
            how(Strategy::Accel, false),
            &format!("{word}\nG1 X100 F12000\nG1 X90 F300\n"),
        );
        assert_eq!(
            text,
            format!(
                "{word}\nSET_VELOCITY_LIMIT ACCEL=585\nG1 X100 F12000\n\
                 SET_VELOCITY_LIMIT ACCEL=800\nG1 X90 F300\n"
            )
        );
    }
}

/// G0 obeys F as G1 does, and cuts nothing: its F needs no permission. One of G1 does.
#[test]
fn the_feed_of_a_rapid_needs_no_permission() {
    let machine = machine(1.0, "");
    let (text, _) = fits(
        &machine,
        how(Strategy::Speed, false),
        "G0 X100 F12000\nG1 X0 F600\nM84\n",
    );
    assert_eq!(text, "G0 X100 F6000\nG1 X0 F600\nM84\n");
    let found = refused(&machine, how(Strategy::Speed, false), "G1 X100 F12000\n");
    assert_eq!(found, "cutting feeds are not changed without permission");
}

/// Homing goes at the speed of the machine file, and a first move without F counts at the
/// machine's limits: neither takes an F. The machine's own speed comes back.
#[test]
fn speed_is_capped_where_no_f_can_stand() {
    let machine = machine(1.0, "");
    let (text, _) = fits(
        &machine,
        how(Strategy::Optimal, true),
        "G28\nG1 X100 Y100\nG1 X0 F600\nM84\n",
    );
    assert!(text.starts_with("SET_VELOCITY_LIMIT "), "{text}");
    assert!(
        text.contains("\nG28\n") && text.contains("\nG1 X100 Y100\n"),
        "{text}"
    );
    let found = refused(&machine, how(Strategy::Speed, false), "G1 X100\n");
    assert_eq!(found, "cutting feeds are not changed without permission");
}

/// X and Y that differ are not one limit that could be put back.
#[test]
fn unlike_axes_keep_their_words() {
    let text = "schema = 1\nname = \"test\"\ncontroller = \"klipper\"\n\
        [converter]\npeak_power_w = 1\n[limits]\nmargin = 0.0\n\
        [axes.X]\nkind = \"linear\"\nrapid_mm_min = 12000\naccel_mm_s2 = 1000\nmass_kg = 10\n\
        [axes.Y]\nkind = \"linear\"\nrapid_mm_min = 6000\naccel_mm_s2 = 900\nmass_kg = 10\n";
    let machine = machine_from(text);
    let found = refused(&machine, how(Strategy::Accel, false), "G1 X100 F12000\n");
    assert_eq!(
        found,
        "the controller `klipper` has no word for this acceleration"
    );
    let found = refused(&machine, how(Strategy::Speed, true), "G1 X100\n");
    assert_eq!(
        found,
        "the block may not be changed: no F is in force, and the one that the control takes then \
         is not known"
    );
}

/// Lines that must stay as they are get no word before them either: one with a checksum and
/// number, one whose feed a percentage scales, one that sets limits itself, and moves that
/// only the firmware knows.
#[test]
fn lines_that_stay_as_they_are() {
    let machine = machine(1.0, "");
    let sum = "N1 G1 X100 F12000".bytes().fold(0, |sum, byte| sum ^ byte);
    for (program, reason) in [
        (
            format!("N1 G1 X100 F12000*{sum}\n"),
            "it carries a checksum",
        ),
        (
            "START_PRINT\n".to_owned(),
            "what it sets only the machine knows",
        ),
        // Macros of the machine, which may set limits of their own.
        (
            "T1\n".to_owned(),
            "the machine runs a file or a macro of its own for it",
        ),
        (
            "SET_VELOCITY_LIMIT ACCEL=100 VELOCITY=20\nPAUSE\n".to_owned(),
            "the machine runs a file or a macro of its own for it",
        ),
    ] {
        for strategy in [Strategy::Accel, Strategy::Optimal, Strategy::Split] {
            let found = refused(&machine, how(strategy, true), &program);
            assert!(found.contains(reason), "{program}: {found}");
        }
    }
}

/// Where the block itself may not be changed, words before it act all the same.
#[test]
fn words_before_lines_that_stay_as_they_are() {
    let machine = machine(1.0, "");
    for line in ["PROBE", "M220 S90\nG1 X100 F12000"] {
        let program = format!("G1 X1 F600\n{line}\nM220 S100\nG1 X2 F600\n");
        let (text, summary) = fits(&machine, how(Strategy::Optimal, false), &program);
        assert!(summary.after.peak_w <= 1.0 && summary.before.peak_w > 1.0);
        let added = |line: &&str| line.starts_with("SET_VELOCITY_LIMIT ");
        let own: Vec<&str> = text.lines().filter(|line| !added(line)).collect();
        assert_eq!(own, program.lines().collect::<Vec<_>>(), "{text}");
    }
}

/// A long block in pieces: without the share of hills that is cruised, which comes back.
#[test]
fn a_block_is_split_without_the_cruise() {
    let machine = machine(0.5, "");
    let program = "G1 X0.1 F600\nG1 X300 F12000\nG1 X300.1 F600\nM84\n";
    let (text, summary) = fits(&machine, how(Strategy::Split, false), program);
    assert!(
        text.contains("SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0\n"),
        "{text}"
    );
    assert!(
        text.contains("SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0.5\n"),
        "{text}"
    );
    assert!(text.contains("SET_VELOCITY_LIMIT ACCEL=1000\n"), "{text}");
    let (_, whole) = fits(&machine, how(Strategy::Optimal, false), program);
    assert!(
        summary.after.duration_s < 0.95 * whole.after.duration_s,
        "{} {}",
        summary.after.duration_s,
        whole.after.duration_s
    );
    // A ratio that the program has set.
    let program = format!("SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0.25\n{program}");
    let (text, _) = fits(&machine, how(Strategy::Split, false), &program);
    assert_eq!(
        text.matches("MINIMUM_CRUISE_RATIO=0.25\n").count(),
        2,
        "{text}"
    );
}

/// `v² = 5²` at a right angle by default; with 20 mm/s the second block begins faster, and
/// a hill without cruise is higher: 20 mm at 1000 mm/s² reach √(1000·20) = 141 mm/s, of
/// which half a cruise leaves 100 mm/s.
#[test]
fn corners_and_hills_are_as_the_program_sets_them() {
    let machine = machine(100.0, "");
    let peak = |program: &str| {
        let input = Cursor::new(program.as_bytes());
        analyze(input, &machine, &Options::default(), None).expect("a program")
    };
    let hill = "G1 X20 F12000\n";
    let own = peak(hill).peak_w;
    let sharp = peak(&format!(
        "SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0\n{hill}"
    ))
    .peak_w;
    assert!((own - 1.0).abs() < 1e-6, "{own}");
    assert!((sharp - 2.0_f64.sqrt()).abs() < 1e-6, "{sharp}");
    // Earlier versions name what is left to brake with.
    let braked = peak(&format!("SET_VELOCITY_LIMIT ACCEL_TO_DECEL=1000\n{hill}")).peak_w;
    assert!((braked - sharp).abs() < 1e-9, "{braked}");
    let corner = "G1 X20 F12000\nG1 Y20\n";
    let fast = format!("SET_VELOCITY_LIMIT SQUARE_CORNER_VELOCITY=20\n{corner}");
    assert!(peak(&fast).duration_s < peak(corner).duration_s - 0.005);
    let back = format!(
        "SET_VELOCITY_LIMIT SQUARE_CORNER_VELOCITY=20\n\
         SET_VELOCITY_LIMIT SQUARE_CORNER_VELOCITY=5\n{corner}"
    );
    assert_eq!(peak(&back).duration_s, peak(corner).duration_s);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Whatever is certified fits when it is read again, is no faster, and ends with the
    /// limits that it began with.
    #[test]
    fn what_is_written_fits(
        moves in prop::collection::vec((0..200, 0..200, 10..200, 0..6), 1..12),
        share in 0.3..0.9,
        strategy in prop::sample::select(vec![Strategy::Accel, Strategy::Optimal, Strategy::Split]),
    ) {
        let mut program = String::from("G28\n");
        for (x, y, speed, word) in moves {
            if word == 0 {
                let _ = writeln!(program, "SET_VELOCITY_LIMIT ACCEL={}", 300 + 3 * x);
            }
            let _ = writeln!(program, "G{} X{x} Y{y} F{}", word % 2, speed * 60);
        }
        let read = |machine: &Machine, text: &str| {
            let input = Cursor::new(text.as_bytes());
            analyze(input, machine, &Options::default(), None).expect("a program")
        };
        let own = read(&machine(1e3, ""), &program);
        let machine = machine(share * own.peak_w, "");
        let (text, summary) = run(&machine, how(strategy, true), &program).expect("a program");
        if summary.certified {
            let again = read(&machine, &text);
            prop_assert!(again.fits(), "{}", text);
            prop_assert!(again.duration_s >= own.duration_s * (1.0 - 1e-9));
        } else {
            prop_assert!(strategy == Strategy::Accel, "{:?}", summary.reasons);
        }
    }
}
