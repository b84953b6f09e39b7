//! Moves that a controller may blend: the robust bound over neighbours.

use super::{RIG, Rig};
use gwatt::pipeline::{Certificate, analyze};

/// It blends under G64, by rules that are not modelled.
const BLENDS: Rig = Rig {
    controller: "iso",
    ..RIG
};

/// Peak and certificate of a program.
fn peak(rig: Rig, program: &str) -> (f64, Option<Certificate>) {
    let options = super::options(rig.options);
    let summary = analyze(
        std::io::Cursor::new(program),
        &rig.machine(),
        &options,
        None,
    )
    .expect("a program");
    (summary.peak_w, summary.certificate)
}

#[track_caller]
fn robust(program: &str, expected_w: f64) {
    let (peak_w, certificate) = peak(BLENDS, program);
    assert_eq!(certificate, Some(Certificate::Robust));
    assert!((peak_w - expected_w).abs() < 1e-6, "{peak_w}");
}

#[test]
fn the_feed_counts_though_the_move_is_short() {
    // 0.1 m/s · 500 kg · 5 m/s²
    robust("G64 G1 X0.01 F6000\n", 250.0);
}

#[test]
fn neighbours_count_axis_by_axis() {
    // X at 0.1 m/s and Y at 0.2 m/s.
    robust("G64 G1 X10 F6000\nY10 F12000\n", 250.0 + 500.0);
    // Nothing blends across a dwell or an exact stop.
    robust("G64 G1 X10 F6000\nG4 P1\nY10 F12000\n", 500.0);
    robust("G61.1 G1 X10 F6000\nG64 Y10 F12000\n", 500.0);
}

/// Controllers leave moves of no length out.
#[test]
fn blends_reach_across_moves_of_no_length() {
    robust("G64 G1 X10 F6000\nX10\nX10\nY10 F12000\n", 250.0 + 500.0);
    let rig = Rig {
        peak_w: 600.0,
        ..BLENDS
    };
    let text = rig.fits("G64 G1 X10 F6000\nX10\nY10 F12000\n");
    let again = peak(rig, &text).0;
    assert!(again <= 600.0 * (1.0 + 1e-6) && again > 599.0, "{text}");
}

#[test]
fn arcs_count_at_their_feed() {
    // F and the tangents of a half circle, whatever its radius.
    robust("G64 G2 X0.2 I0.1 F6000\n", 250.0 + 250.0);
}

#[test]
fn all_moves_of_an_exact_program_can_be_asked_for() {
    let mut rig = RIG;
    rig.options.robust = true;
    let text = rig.fits("G1 X10 F30000\nX0\n");
    assert_eq!(text, "G1 X10 F23999\nX0\nF30000\n");
}

/// `LinuxCNC` stops between G0 and G1 and blends among G1: a rapid that is
/// written as a feed gets a dwell of no time on both sides, so that no corner is
/// rounded that was not. Between them it is planned like the rapid.
#[test]
fn a_rapid_among_blended_feeds_is_written_between_stops() {
    let rig = super::Rig {
        controller: "linuxcnc",
        ..RIG
    };
    let program =
        "G21 G90 G64 P0.05\nG1 X10 F500\nG0 X400\nG0 X0\nG1 X10 F500\nG0 X-390\nG1 X-391\n";
    let (text, summary) = rig.limit(program.as_bytes()).expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    let text = String::from_utf8(text).expect("text");
    let words: Vec<&str> = text.lines().collect();
    assert_eq!(words[..3], ["G21 G90 G64 P0.05", "G1 X10 F500", "G4 P0"]);
    assert!(words[3].starts_with("G1 X400 F"), "{text}");
    assert_eq!(words[4], "G4 P0");
    assert!(words[5].starts_with("G1 X0"), "{text}");
    assert_eq!(words[6..8], ["G4 P0", "G1 X10 F500"]);
    assert_eq!(words[8], "G4 P0");
    assert!(words[9].starts_with("G1 X-390 F"), "{text}");
    assert_eq!(words[10..], ["G4 P0", "G1 X-391 F500"]);
    // No move is added, and none is lost.
    assert_eq!(summary.before.moves, summary.after.moves);
}

/// Between the dwells `LinuxCNC` accelerates by half, 2.5 m/s²: F is found for that,
/// 500 W / (500 kg · 2.5 m/s²) = 0.4 m/s, and not the 0.2 m/s of the whole.
#[test]
fn between_dwells_half_of_the_acceleration_counts() {
    let rig = super::Rig {
        controller: "linuxcnc",
        peak_w: 500.0,
        ..RIG
    };
    let program = "G21 G90 G64 P0.05\nG1 X10 F500\nG0 X400\nG1 X410\n";
    let (text, summary) = rig.limit(program.as_bytes()).expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    let text = String::from_utf8(text).expect("text");
    assert!(text.contains("\nG4 P0\nG1 X400 F24000\nG4 P0\n"), "{text}");
    assert!(
        (499.9..=500.0).contains(&summary.after.peak_w),
        "{}",
        summary.after.peak_w
    );
    // Under G61.1 nothing is blended: no dwell, and all of the acceleration.
    let exact = rig.fits("G21 G90 G61.1\nG1 X10 F500\nG0 X400\nG1 X410\n");
    assert!(exact.contains("\nG1 X400 F11999\n"), "{exact}");
}
