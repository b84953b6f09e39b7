//! LinuxCNC: the adaptive feed, where the machine file says which output it is wired to.

use super::{RIG, Rig, Run, run};
use gwatt::machine::{Machine, OverrideAt};
use gwatt::pipeline::{Options, Summary, analyze};
use proptest::prelude::*;
use std::fmt::Write as _;
use std::io::Cursor;

use crate::machines::machine_from;

const WIRED: &str = "[outputs]\nspeed = 1\nchange_s = 0.01";

const HAL: Rig = Rig {
    controller: "linuxcnc",
    rest: WIRED,
    ..RIG
};

/// Duration and peak of a program that is only read.
fn figures(rig: Rig, program: &str) -> (f64, f64) {
    let machine = rig.machine();
    let read = analyze(Cursor::new(program), &machine, &Options::default(), None).expect("figures");
    (read.duration_s, read.peak_w)
}

/// 1250 W of 1000 W: 0.8 of the speed. 400 mm take 0.8 s + 0.1 s before, and 1 s + 0.08 s
/// after; the axes stand for M52, M68 and M52 once each.
#[test]
fn a_rapid_stays_one() {
    let (text, summary) = HAL
        .limit(b"G64\nG0 X400\nG1 X401 F100\nM2\n")
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(
        String::from_utf8(text).expect("text"),
        "G64\nM52 P1\nM67 E1 Q0.8\nG0 X400\nM67 E1 Q1\nG1 X401 F100\nM68 E1 Q1\nM52 P0\nM2\n"
    );
    let longer_s = summary.after.duration_s - summary.before.duration_s;
    assert!((longer_s - 0.18 - 0.03).abs() < 1e-6, "{longer_s}");
    let conditions = summary.after.conditions.join("\n");
    assert!(
        conditions.contains("analog output 1 sets the share of the speed of all moves"),
        "{conditions}"
    );
}

/// Between rapids that run into each other nothing stops: each has its own share, and the
/// words stand once.
#[test]
fn each_rapid_has_its_own_share() {
    let rig = Rig {
        peak_w: 1500.0,
        ..HAL
    };
    let text = rig.fits("G64 P0.01\nG0 X400\nX500 Y100\nX100\nG1 X101 F100\nM2\n");
    assert_eq!(
        text,
        "G64 P0.01\nG0 X400\nM52 P1\nM67 E1 Q0.599\nX500 Y100\nM67 E1 Q1\nX100\nG1 X101 F100\n\
         M68 E1 Q1\nM52 P0\nM2\n"
    );
}

/// What the program has set itself comes back, and stays switched on.
#[test]
fn a_share_of_the_program_comes_back() {
    let text = HAL.fits("M52 P1\nM67 E1 Q0.9\nG0 X400\nG1 X401 F100\nG0 X401.5\nM2\n");
    assert_eq!(
        text,
        "M52 P1\nM67 E1 Q0.9\nM67 E1 Q0.8\nG0 X400\nM67 E1 Q0.9\nG1 X401 F100\nG0 X401.5\nM2\n"
    );
}

/// A share that the program has set and not switched on does nothing, and comes back only once
/// it is switched off again.
#[test]
fn a_share_that_is_not_switched_on_stays_without_effect() {
    let text = HAL.fits("G64\nM67 E1 Q0.9\nG0 X400\nG1 X401 F100\nM2\n");
    assert_eq!(
        text,
        "G64\nM67 E1 Q0.9\nM52 P1\nM67 E1 Q0.8\nG0 X400\nM67 E1 Q1\nG1 X401 F100\n\
         M68 E1 Q0.9\nM52 P0\nM2\n"
    );
}

/// Where lines run again and again a feed costs less than words for each run.
#[test]
fn a_line_that_runs_again_becomes_a_feed() {
    let text =
        HAL.fits("G64\nF100\no1 repeat [3]\nG0 X400\nG1 X401\nG0 X0\nG1 X1\no1 endrepeat\nM2\n");
    assert!(
        !text.contains("M67") && text.contains("G1 X400 F"),
        "{text}"
    );
    // G28 cannot become one.
    let known = Rig {
        rest: "[outputs]\nspeed = 1\nchange_s = 0.01\n[offsets]\nG54 = { X = 0 }",
        axis: "reference_mm = 0",
        ..HAL
    };
    let text = known.fits("G1 F100 X1\no1 repeat [2]\nG0 G28\nG1 X400\no1 endrepeat\nM2\n");
    let words = "M52 P1\nM67 E1 Q0.8\nG0 G28\nM68 E1 Q1\nM52 P0\n";
    assert!(text.contains(words), "{text}");
}

#[test]
fn under_compensation_a_rapid_is_no_other_way_lowered() {
    let program = "G64\nG1 F1000 X0 Y0\nG41.1 D6\nG1 X10 Y10\nG0 X400\nG1 X400 Y50\nG40\nM2\n";
    let (text, _) = HAL.limit(program.as_bytes()).expect("a program");
    let text = String::from_utf8(text).expect("text");
    assert!(!text.contains("M67"), "{text}");
}

/// 0.25 m/s: 1.6 s + 0.05 s, 0.25 m/s · 500 kg · 5 m/s²; the axes stand 0.01 s for M52.
#[test]
fn a_share_is_followed() {
    let free = Rig { peak_w: 1e6, ..HAL };
    for (program, duration_s, peak_w) in [
        ("G61.1\nM52 P1\nM67 E1 Q0.5\nG0 X400\nM2\n", 1.66, 625.0),
        // M68 sets it too, and stops the axes once more.
        ("G61.1\nM52 P1\nM68 E1 Q0.5\nG0 X400\nM2\n", 1.67, 625.0),
        // Another output, or none that is switched on, changes nothing.
        ("G61.1\nM52 P1\nM67 E0 Q0.5\nG0 X400\nM2\n", 0.91, 1250.0),
        ("G61.1\nM67 E1 Q0.5\nG0 X400\nM2\n", 0.9, 1250.0),
        (
            "G61.1\nM52 P1\nM67 E1 Q0.5\nM52 P0\nG0 X400\nM2\n",
            0.92,
            1250.0,
        ),
        // It waits for a move that moves.
        (
            "G61.1\nM52 P1\nM67 E1 Q0.5\nG0 X0\nG4 P1\nG0 X400\nM2\n",
            2.66,
            625.0,
        ),
        // Of a feed the axes' limit counts: 0.5 m/s of 1 m/s, and half of that.
        (
            "G61.1\nM52 P1\nM67 E1 Q0.5\nG1 X400 F60000\nM2\n",
            1.66,
            625.0,
        ),
        (
            "G61.1\nM52 P1\nM67 E1 Q0.5\nG1 X400 F12000\nM2\n",
            4.03,
            250.0,
        ),
    ] {
        let (found_s, found_w) = figures(free, program);
        assert!((found_s - duration_s).abs() < 1e-6, "{program}: {found_s}");
        assert!((found_w - peak_w).abs() < 1e-6, "{program}: {found_w}");
    }
}

/// Between lines that run into each other the axes brake after the joint: 0.4 m/s up to
/// there, 16 mm for speeding up and 184 mm at 0.4 m/s; then 15 mm from 0.4 to 0.1 m/s, and
/// back to rest, with half of the acceleration since nothing waits after it. How late the
/// change comes is not known, so that the bound counts.
#[test]
fn a_share_changes_after_the_joint() {
    let free = Rig { peak_w: 1e6, ..HAL };
    let program = "G64\nM52 P1\nG1 X200 F24000\nM67 E1 Q0.25\nX400\nM2\n";
    let (found_s, found_w) = figures(free, program);
    let first_s = 0.08 + 0.184 / 0.4;
    let (braking_mm, end_mm) = ((0.16 - 0.01) / 5.0, 0.01 / 5.0);
    let second_s = 0.3 / 2.5 + (0.2 - braking_mm - end_mm) / 0.1 + 0.1 / 2.5;
    assert!(
        (found_s - 0.01 - first_s - second_s).abs() < 1e-6,
        "{found_s}"
    );
    assert!((found_w - 1000.0).abs() < 1e-6, "{found_w}");
    // With F in its place it brakes before the joint.
    let (by_feed_s, _) = figures(free, "G64\nG1 X200 F24000\nX400 F6000\nM2\n");
    assert!(by_feed_s > found_s - 0.01, "{by_feed_s}");
}

/// A share that comes into force some cycles late: at 0.001 m/s an axis may have 0.01 m/s
/// for a moment.
#[test]
fn a_share_acts_late() {
    let free = Rig { peak_w: 1e6, ..HAL };
    let (_, found_w) = figures(free, "M52 P1\nM67 E1 Q0.002\nG0 X1\nM2\n");
    assert!((found_w - 0.01 * 2500.0).abs() < 1e-6, "{found_w}");
}

#[test]
fn words_that_leave_the_speed_open_are_refused() {
    let free = Rig { peak_w: 1e6, ..HAL };
    let share = "knob-value: the share of the speed is not from above 0 to 1";
    let held = "knob-value: the share of the speed changes under cutter compensation";
    let under =
        |words: &str| format!("G1 F1000 X0 Y0\nG41.1 D6\nG1 X10 Y10\n{words}\nG1 X20\nG40\nM2\n");
    for (program, reason) in [
        ("M67 E1 Q0\nG0 X400\nM2\n".to_owned(), share),
        ("M67 E1 Q1.5\nG0 X400\nM2\n".to_owned(), share),
        ("M68 E1\nG0 X400\nM2\n".to_owned(), share),
        (under("M67 E1 Q0.5"), held),
        (under("M52 P1"), held),
    ] {
        assert_eq!(free.first_refusal(&program), reason, "{program}");
    }
    let bare = Rig { rest: "", ..free };
    assert_eq!(
        bare.first_refusal("M52 P1\nG0 X1\nM2\n"),
        "adaptive-feed: under M52 a signal from outside sets the speed"
    );
}

#[test]
fn the_machine_file_says_what_is_wired() {
    for (outputs, reason) in [
        ("[outputs]\n", "no output is named"),
        (
            "[outputs]\nspeed = 1\nacceleration = 1\n",
            "analog output 1 has two meanings",
        ),
    ] {
        let text = format!(
            "schema = 1\nname = \"m\"\ncontroller = \"linuxcnc\"\n[converter]\npeak_power_w = 1000\n{outputs}\
             [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n"
        );
        let found = format!(
            "{:?}",
            Machine::from_toml("m.toml", &text).expect_err("a mistake")
        );
        assert!(found.contains(reason), "{found}");
    }
    let text = "schema = 1\nname = \"m\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 1000\n[outputs]\n\
                speed = 1\n[axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n";
    let found = format!(
        "{:?}",
        Machine::from_toml("m.toml", text).expect_err("a mistake")
    );
    assert!(
        found.contains("the controller `iso` has no word for an output that acts on the speed"),
        "{found}"
    );
}

/// A bench whose Z is slower than X and Y.
fn bench(peak_w: f64) -> Machine {
    let mut text = format!(
        "schema = 1\nname = \"bench\"\ncontroller = \"linuxcnc\"\n[converter]\n\
         peak_power_w = {peak_w:?}\nbase_load_w = 10\n{WIRED}\n"
    );
    for (axis, rapid, accel, mass) in [
        ("X", 9000, 2000, 250),
        ("Y", 9000, 2000, 280),
        ("Z", 6000, 1500, 220),
    ] {
        let _ = write!(
            text,
            "[axes.{axis}]\nrapid_mm_min = {rapid}\naccel_mm_s2 = {accel}\nmass_kg = {mass}\n\
             coulomb_n = 200\nefficiency = 0.8\n"
        );
    }
    machine_from(&text)
}

/// The axes of a helix keep up with less than its whole speed in its plane: at half of the
/// share it has half of the speed that F and all of them leave, and no less.
#[test]
fn a_helix_has_its_share_of_what_the_axes_leave() {
    let time_s = |program: &str| {
        let read = analyze(Cursor::new(program), &bench(1e4), &Options::default(), None);
        read.expect("figures").duration_s
    };
    let helix = "G18 G2 X0 Z0 Y100 I-20 K0";
    // 125.7 mm in the plane, 160.6 mm along the path, of which Z permits 127.8 mm/s.
    let length_mm = (125.663_706_f64.powi(2) + 1e4).sqrt();
    let half_mm_min = 0.5 * 60.0 * 100.0 * length_mm / 125.663_706;
    let shared_s = time_s(&format!("G64\nM52 P1\nM67 E1 Q0.5\n{helix} F20000\nM2\n"));
    let slow_s = time_s(&format!("G64\n{helix} F{half_mm_min:.4}\nM2\n"));
    assert!((shared_s - slow_s).abs() < 0.02, "{shared_s} {slow_s}");
}

/// An arc after a lowered rapid asks for what it did, next to the words for the share too.
#[test]
fn a_helix_after_a_lowered_rapid_is_no_slower() {
    let program = b"G64\nF8177\nG1 X0.2231 Y0\nG1 Y-71.8456 Z-3.3356 X-10.1277\n\
                    G1 X-11.4578 Y-71.6025\nG18\nG0 Y31.0809 X-25.1672\n\
                    G2 K3.9374 I-13.4159 Y17.7194\nM2\n";
    let mut paced = 0;
    for peak_w in (80..132).step_by(4) {
        for allow_feed in [false, true] {
            let options = Run {
                allow_feed,
                ..RIG.options
            };
            let (text, summary) =
                run(&bench(f64::from(peak_w)), options, program).expect("a program");
            let mut reasons = summary.reasons.iter();
            let only_power =
                reasons.all(|it| ["feed-not-allowed", "no-solution"].contains(&it.rule));
            assert!(only_power, "{peak_w} W: {:?}", summary.reasons);
            let text = String::from_utf8(text).expect("text");
            paced += usize::from(summary.certified && text.contains("M67 E1 Q0."));
        }
    }
    assert!(paced > 6, "{paced}");
}

/// A block of a random program: a rapid or a feed in either axis, or a share.
fn block() -> impl Strategy<Value = String> {
    let place = || -400..400_i32;
    prop_oneof![
        3 => (place(), place()).prop_map(|(x, y)| format!("G0 X{x} Y{y}")),
        2 => place().prop_map(|x| format!("G0 X{x}")),
        2 => (place(), place(), 1..30_u32).prop_map(|(x, y, f)| format!("G1 X{x} Y{y} F{}", f * 1000)),
        1 => (1..20_u32).prop_map(|share| format!("M67 E1 Q{}", f64::from(share) / 20.0)),
        1 => Just("M52 P1".to_owned()),
        1 => Just("G4 P0.1".to_owned()),
    ]
}

/// A rapid that speeds up in the blend after a slower one: at a lower override there is no room
/// for the blend, and it speeds up with all of its acceleration after the corner.
#[test]
fn a_higher_share_after_a_blend_counts_without_it() {
    let rig = Rig {
        peak_w: 595.0,
        ..HAL
    };
    let program =
        "G64\nG0 X93\nM67 E1 Q0.05\nG0 X-31 Y108\nG0 X-116 Y-96\nG0 X184 Y0\nG0 X221\nG0 X0\nM2\n";
    assert_fits_at_lower_overrides(rig, program);
}

/// A short rapid with a lower share after a blend: at 100 % it keeps up with the blend, at 95 %
/// it is entered faster than it runs, and too short to come down.
#[test]
fn a_lower_share_after_a_blend_counts_where_it_no_longer_keeps_up() {
    let program = "G64\nG1 X0 Y-237 F1000\nM52 P1\nG0 X347\nM67 E1 Q0.727\nG0 X371 Y-255\nM67 E1 Q1\n\
                   G1 X0 Y0 F1000\nM2\n";
    let (_, peak_w) = figures(HAL, program);
    for percent in (30..=100).step_by(5) {
        let share = f64::from(percent) / 100.0;
        let read = at_override(HAL, program.as_bytes(), share);
        assert!(
            read.peak_w <= peak_w * (1.0 + 1e-9),
            "{share}: {} {peak_w}",
            read.peak_w
        );
    }
}

/// The output fits at each override of its own.
fn assert_fits_at_lower_overrides(rig: Rig, program: &str) {
    let text = rig.fits(program);
    for percent in (30..=100).step_by(5) {
        let share = f64::from(percent) / 100.0;
        let read = at_override(rig, text.as_ref(), share);
        let largest_w = rig.peak_w * (1.0 + 1e-9);
        assert!(read.peak_w <= largest_w, "{share}: {}", read.peak_w);
    }
}

/// A program that is read at one override alone.
fn at_override(rig: Rig, text: &[u8], share: f64) -> Summary {
    let mut machine = rig.machine();
    machine.limits.override_at = Some(OverrideAt {
        feed: share,
        rapid: share,
        spindle: 1.0,
    });
    analyze(Cursor::new(text), &machine, &Options::default(), None).expect("figures")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// What is certified fits at lower overrides as well, by plans of their own.
    #[test]
    fn lower_overrides_fit(
        blocks in prop::collection::vec(block(), 1..12),
        corner in prop_oneof![Just("G64"), Just("G64 P0.1"), Just("G61"), Just("G61.1")],
        peak_w in 300..2500_u32,
    ) {
        let rig = Rig { peak_w: f64::from(peak_w), ..HAL };
        let mut program = format!("{corner}\n");
        for block in &blocks {
            let _ = writeln!(program, "{block}");
        }
        program.push_str("M2\n");
        let (text, summary) = run(&rig.machine(), rig.options, program.as_bytes()).expect("a program");
        if summary.certified {
            for share in [1.0, 0.95, 0.85, 0.7, 0.4] {
                let read = at_override(rig, text.as_ref(), share);
                prop_assert!(read.peak_w <= f64::from(peak_w) * (1.0 + 1e-9), "{share}: {} {program}", read.peak_w);
            }
        }
    }
}
