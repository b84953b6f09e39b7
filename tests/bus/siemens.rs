//! SINUMERIK: words and cycles that turn the spindle, or stop it, by themselves.

use std::f64::consts::TAU;
use std::io::Cursor;

use gwatt::interpret::MoveKind::{self, Dwell, Feed, Rapid, Tap};
use gwatt::pipeline::{Options, Row, analyze};

use super::{FULL_W, machine, near};
use crate::rows::Rows;

/// 3000/min in 1 s, with X, Y and Z of 1000 kg at 1 m/s² and 1 m/s.
fn rows(program: &str) -> Vec<Row> {
    let machine = machine("siemens", "", "", "[path]\nmode = \"exact-stop\"");
    let mut rows = Rows::default();
    let program = format!("{program}M30\n");
    let options = Options::default();
    let summary = analyze(Cursor::new(program), &machine, &options, Some(&mut rows));
    summary.unwrap_or_else(|failure| panic!("{failure:?}"));
    rows.0
}

/// 31.416 N·m at a speed, W.
fn turned(rpm: f64) -> f64 {
    FULL_W / 3000.0 * rpm
}

/// The rows of these kinds without the waits.
fn moves(rows: &[Row]) -> Vec<&Row> {
    rows.iter()
        .filter(|row| row.kind != MoveKind::Spindle)
        .collect()
}

/// "Tapping without compensating chuck (G331, G332)": from rest to S and back, the other way for
/// G332. It stands afterwards.
#[test]
fn a_tap_turns_a_spindle_that_stands() {
    for lead in ["K1.5", "K-1.5"] {
        let found = rows(&format!(
            "SPOS=0\nG0 X0 Y0 Z10\nG331 Z-20 {lead} S1200\nG332 Z10\nG0 X100\n"
        ));
        let kinds: Vec<_> = found.iter().map(|row| row.kind).collect();
        let wait = MoveKind::Spindle;
        assert_eq!(kinds, [Rapid, wait, Tap, wait, Tap, Rapid]);
        // 1.5 mm · 1200/min = 30 mm/s: 30 W of the slide.
        for index in [2, 4] {
            near(found[index].peak_w, turned(1200.0) + 30.0);
            near(found[index].regen_w, turned(1200.0) + 30.0);
            // Run-up and braking take 0.4 s each, during which the axis goes half of its way.
            near(found[index - 1].duration_s, 0.4);
            let omega = 1200.0 * TAU / 60.0;
            near(found[index - 1].energy_j, 0.5 * 0.1 * omega * omega);
        }
        // √(1 m/s² · 0.1 m) = 0.316 m/s.
        near(found[5].peak_w, 1000.0 * 0.1_f64.sqrt());
        near(found[5].regen_w, 1000.0 * 0.1_f64.sqrt());
    }
}

/// Where it turned before the tap, it may turn on by itself or wait for M3: both count.
#[test]
fn a_tap_of_a_spindle_that_turned_before() {
    let found = rows(
        "S600 M3\nG4 F3\nG331 Z-20 K1.5 S1200\nG332 Z0\nG0 X2000\nG0 X0\nM3\nG0 X2000\n\
         G0 X0\nM5\n",
    );
    let moves = moves(&found);
    near(moves[1].peak_w, turned(1200.0) + 30.0);
    near(moves[2].peak_w, turned(1200.0) + 30.0);
    for rapid in &moves[3..=5] {
        near(rapid.peak_w, turned(1200.0) + 1000.0);
    }
    // After 0.4 s of the way at most it turns.
    near(moves[6].peak_w, 1000.0);
}

/// "Rigid tapping (CYCLE84)": SST in, SST1 out, SDAC afterwards. Which speed that has is not
/// known: the largest counts until the next S.
#[test]
fn a_tapping_cycle_turns_the_spindle_at_its_own_speeds() {
    let program = |sdac: u32| {
        format!(
            "S500 M3\nG4 F3\nG0 Z10\nCYCLE84(10,0,2,-20,,0,{sdac},,1.5,0,1200,600)\nG4 F3\n\
             S600\nG4 F3\n"
        )
    };
    for (sdac, after_rpm) in [(3, 1200.0), (4, 1200.0), (5, 0.0)] {
        let found = rows(&program(sdac));
        let moves = moves(&found);
        let kinds: Vec<_> = moves.iter().map(|row| row.kind).collect();
        assert_eq!(kinds, [Dwell, Rapid, Rapid, Tap, Tap, Rapid, Dwell, Dwell]);
        near(moves[3].peak_w, turned(1200.0) + 30.0);
        near(moves[3].regen_w, turned(1200.0) + 30.0);
        near(moves[4].peak_w, turned(600.0) + 15.0);
        near(moves[6].peak_w, turned(after_rpm));
        near(moves[7].regen_w, turned(after_rpm));
    }
    // From rest, with no M3 and no S.
    let found = rows("G0 Z10\nCYCLE84(10,0,2,-20,,0,5,,1.5,0,1200)\n");
    let taps: Vec<_> = found.iter().filter(|row| row.kind == Tap).collect();
    for tap in taps {
        near(tap.peak_w, turned(1200.0) + 30.0);
    }
}

/// "Tapping with compensating chuck (CYCLE840)": it turns back after the way out, from −1200/min.
#[test]
fn a_floating_tap_is_turned_back() {
    let found = rows("S1200 M3\nG4 F3\nG0 Z10\nCYCLE840(10,0,2,-20,,0,0,3,0,,1.5)\nG4 F3\n");
    let moves = moves(&found);
    near(moves[3].peak_w, turned(1200.0) + 30.0);
    near(moves[6].regen_w, turned(1200.0));
    near(moves[6].peak_w, turned(1200.0));
    // A spindle that stands is turned by the cycle.
    let found = rows("S1200\nG0 Z10\nCYCLE840(10,0,2,-20,,0,0,3,0,,1.5)\n");
    let tap = found.iter().find(|row| row.kind == Tap);
    near(tap.map_or(0.0, |row| row.peak_w), turned(1200.0) + 30.0);
}

/// "Spindle positioning (SPOS, SPOSA)", M70: it brakes to a place, and M3 runs it up again.
#[test]
fn positioning_stops_the_spindle() {
    let with = |words: &str| {
        let found = rows(&format!(
            "M3 S3000\nG4 F3\n{words}\nG4 F3\nM3\nG0 X2000\nG0 X0\n"
        ));
        let moves = moves(&found);
        [moves[1].regen_w, moves[2].peak_w]
    };
    let stopping = [
        "M19",
        "SPOS=0",
        "SPOSA=ACP(90)",
        "SPOS[1]=0",
        "M70",
        "M1=70",
        "SETMS(2)\nSPOS[2]=0",
    ];
    for words in stopping {
        let [braking_w, rapid_w] = with(words);
        near(braking_w, FULL_W);
        near(rapid_w, FULL_W + 1000.0);
    }
    // Another spindle.
    let [braking_w, rapid_w] = with("SPOS[2]=0");
    near(braking_w, 0.0);
    near(rapid_w, 1000.0);
}

/// "Boring 2 (CYCLE86)": SDIR turns the spindle, which stands at the bottom and afterwards.
#[test]
fn boring_stops_the_spindle_in_its_place() {
    let hole = "CYCLE86(10,0,2,-20,,3,3,0,0,0,0)\n";
    let found = rows(&format!(
        "S3000 M3 F6000\nG4 F3\nG0 Z10\n{hole}G4 F3\n{hole}G4 F3\nM3\nG0 X2000\n"
    ));
    let moves = moves(&found);
    let feeds: Vec<_> = (0..moves.len())
        .filter(|index| moves[*index].kind == Feed)
        .collect();
    assert_eq!(feeds.len(), 2);
    // The feed at 100 mm/s takes 100 W, and when the run-up began is not known.
    near(moves[feeds[0]].peak_w, 100.0);
    near(moves[feeds[1]].peak_w, FULL_W + 100.0);
    near(moves[moves.len() - 1].peak_w, FULL_W + 1000.0);
}
