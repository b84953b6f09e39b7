//! Moves that the controller plans together: what they ask for, and programs
//! that fit under it.

use super::{RIG, Rig, Run};
use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Row, motion};
use proptest::prelude::*;
use std::fmt::Write as _;

use crate::runs::rows_with;

pub(super) const LINUXCNC: Rig = Rig {
    controller: "linuxcnc",
    ..RIG
};
pub(super) const GRBL: Rig = Rig {
    controller: "grbl",
    ..RIG
};

/// Rows of a program, dwells left aside.
fn rows(machine: &Machine, how: Run, program: &str) -> Vec<Row> {
    let mut rows = rows_with(machine, &super::options(how), program);
    rows.retain(|row| row.kind.name() != "dwell");
    rows
}

pub(super) fn report(rig: Rig, program: &str) -> Vec<Row> {
    rows(&rig.machine(), rig.options, program)
}

/// A word of which the profile says nothing.
pub(super) fn unsaid(controller: &str) -> &'static str {
    match controller {
        "linuxcnc" => "M19 R0\n",
        "marlin" => "M900 K0.05\n",
        "klipper" => "SET_PRESSURE_ADVANCE ADVANCE=0.05\n",
        "reprap" => "M572 D0 S0.05\n",
        _ => "G10 L2 P2 X0\n",
    }
}

/// 500 kg · 5 m/s² · v
#[track_caller]
fn peak(row: &Row, speed_m_s: f64) {
    let expected = 2500.0 * speed_m_s;
    let off = (row.peak_w - expected).abs();
    assert!(off < 1e-6 * expected, "{} {expected}", row.peak_w);
}

/// G61.1 after moves that are planned together: the planner holds the rapid
/// back until it knows the next move.
#[test]
fn a_stop_at_the_end_of_a_move_does_not_lose_it() {
    let rows = report(
        LINUXCNC,
        "G21 G90 G61\nG1 X100 F6000\nG61.1\nG0 X0\nG64 P0.01\nG1 X100\nM2\n",
    );
    assert_eq!(rows.len(), 3);
    peak(&rows[0], 0.1);
    peak(&rows[1], 0.5);
    assert!((rows[1].duration_s - (100.0 / 500.0 + 500.0 / 5000.0)).abs() < 1e-9);
    assert_eq!(rows[1].certificate, Certificate::Planned);
}

/// `LinuxCNC` runs splines as tangent arcs, between which it does not stop under G61 either.
#[test]
fn splines_are_bounded() {
    let curves = [
        "G5 X20 Y0 I5 J10 P-5 Q-10",
        "G5.1 X20 Y0 I10 J15",
        "G5.2 X5 Y8 P1\nX9 Y9 P1\nX20 Y0 P1\nG5.3",
    ];
    for (mode, curve) in ["G61", "G64", "G64 P0.1"]
        .iter()
        .flat_map(|mode| curves.map(|it| (mode, it)))
    {
        let rows = report(
            LINUXCNC,
            &format!("G21 G90 G17 {mode}\nF12000\n{curve}\nM2\n"),
        );
        let robust = |row: &Row| row.certificate == Certificate::Robust;
        assert!(
            !rows.is_empty() && rows.iter().all(robust),
            "{mode} {curve}"
        );
        // 0.2 m/s, as LinuxCNC reaches about half of it there.
        assert!(
            rows.iter().any(|row| row.peak_w > 0.9 * 2500.0 * 0.2),
            "{mode} {curve} {rows:?}"
        );
    }
}

/// Of an arc that bulges less than the tolerance its chords count, whatever full turns it is
/// given (`chord_deviation` of `emccanon.cc`).
#[test]
fn flat_arcs_lose_their_turns() {
    let program = "G21 G90 G17 G64 P0.2\nF12000\nG1 X20\nG3 X22 Y0.2 R20\nG1 X40 Y4\nM2\n";
    let turned = program.replace("R20", "R20 P3");
    let [once, thrice] = [program, turned.as_str()].map(|program| report(LINUXCNC, program));
    assert_eq!(once.len(), 3);
    for (once, thrice) in once.iter().zip(&thrice) {
        assert!(
            (once.peak_w - thrice.peak_w).abs() < 1e-9,
            "{once:?} {thrice:?}"
        );
    }
}

/// A move of some servo cycles may have ended before the next one comes, which then takes no part
/// in a blend, and keeps all of its acceleration.
#[test]
fn after_a_brief_move_the_next_one_keeps_its_acceleration() {
    let alone = report(LINUXCNC, "G21 G90 G64\nG0 X40\nM2\n");
    for mode in ["G64", "G61", "G64 P0.01"] {
        let program = format!("G21 G90 {mode}\nG0 Y0.0004\nG0 X40\nG0 Y40\nM2\n");
        let rows = report(LINUXCNC, &program);
        assert!(
            rows[1].peak_w >= alone[0].peak_w * (1.0 - 1e-9),
            "{mode} {rows:?}"
        );
    }
    // 1 mm takes 28 ms.
    let longer = report(LINUXCNC, "G21 G90 G64\nG0 Y1\nG0 X40\nG0 Y40\nM2\n");
    assert_eq!(longer[1].certificate, Certificate::Planned);
}

/// A block that starts from a lower speed needs more: lowering one makes the
/// next exceed the limit.
#[test]
fn blocks_that_exceed_once_others_are_lowered_are_lowered_too() {
    for rig in [LINUXCNC, GRBL] {
        let rig = Rig {
            peak_w: 240.0,
            ..rig
        };
        let mut program = String::from("G21 G90\nG1 X0.5 F7000\n");
        for i in 1..60 {
            let _ = writeln!(program, "X{:.2}", 0.5 + 0.4 * f64::from(i));
        }
        let before = report(rig, &program);
        let over = before.iter().filter(|row| row.peak_w > 240.0).count();
        assert!((1..10).contains(&over), "{over}");
        let text = rig.fits(&program);
        let after = report(rig, &text);
        assert!(after.iter().all(|row| row.peak_w <= 240.0 * (1.0 + 1e-6)));
    }
}

#[test]
fn both_certificates_can_be_asked_for() {
    let program = "G21 G90 G64 P0.05\nG1 X60 F12000\nY40\nX0 Y10\nG4 P1\nX40\nM2\n";
    for robust in [false, true] {
        let mut rig = Rig {
            peak_w: 300.0,
            ..LINUXCNC
        };
        rig.options.robust = robust;
        let text = rig.fits(program);
        let rows = report(rig, &text);
        let robust_rows = rows
            .iter()
            .filter(|row| row.certificate == Certificate::Robust);
        assert_eq!(robust_rows.count(), if robust { rows.len() } else { 0 });
        assert!(rows.iter().all(|row| row.peak_w <= 300.0 * (1.0 + 1e-6)));
    }
}

/// grbl has G0 in force at power-on: nothing is put back before the first block,
/// least of all before a `%`, where a program begins.
#[test]
fn nothing_is_written_before_the_program() {
    let rig = Rig {
        peak_w: 300.0,
        ..GRBL
    };
    let text = rig.fits("%\nG0 X60 Y8\nG0 Y3\nG1 X8 F50\n%\n");
    assert!(text.starts_with("%\nG1 X60 Y8 F"), "{text}");
}

#[test]
fn a_thread_between_feeds_and_its_neighbours_get_the_robust_bound() {
    let rows = report(
        LINUXCNC,
        "G21 G90 G64 P0.01 Q0\nM3 S600\nG1 X100 F6000\nY90\nG33 X50 K1\nG1 X0 Y0 F6000\nX50\nX90\nM2\n",
    );
    let robust: Vec<bool> = rows
        .iter()
        .map(|row| row.certificate == Certificate::Robust)
        .collect();
    assert_eq!(robust, [true, true, true, true, true, false]);
}

/// A start-up code's tolerance counts until the program gives one.
#[test]
fn corners_are_rounded_with_the_tolerance_of_power_on() {
    let durations = |tolerance_mm: f64, words: &str| -> Vec<f64> {
        let mut machine = LINUXCNC.machine();
        assert_eq!(machine.controller.language.power_on_tolerance_mm, 0.0254);
        machine.controller.language.power_on_tolerance_mm = tolerance_mm;
        let program = format!("G21 G90 {words}\nG1 X20 F6000\nG1 Y20\nG1 X0\nM2\n");
        let rows = rows(&machine, LINUXCNC.options, &program);
        rows.iter().map(|row| row.duration_s).collect()
    };
    assert_eq!(durations(0.0254, ""), durations(0.0, "G64 P0.0254 Q0"));
    assert_eq!(durations(0.0, ""), durations(0.0254, "G64"));
    assert_ne!(durations(0.0, ""), durations(0.0254, ""));
}

/// Half of a blend is the time of the lines that were put together before it,
/// however many they are.
#[test]
fn times_of_lines_that_are_put_together_add_up_to_the_motion() {
    let mut program = String::from("G21 G90 G64 P0.05\nG0 X20 Y0\nG1 F4800\n");
    for i in 1..=200 {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 200.0);
        writeln!(program, "X{:.4} Y{:.4}", 20.0 * cos, 20.0 * sin).unwrap();
    }
    program += "M2\n";
    let rows = report(LINUXCNC, &program);
    assert!(
        rows.iter()
            .all(|row| row.certificate == Certificate::Planned)
    );
    let sum: f64 = rows.iter().map(|row| row.duration_s).sum();
    let mut moving = 0.0;
    let input = std::io::Cursor::new(program.as_bytes());
    let options = super::options(LINUXCNC.options);
    motion(input, &LINUXCNC.machine(), &options, &mut |stretch| {
        moving += stretch.duration_s;
        Ok(())
    })
    .unwrap();
    assert!((sum / moving - 1.0).abs() < 1e-9, "{sum} s, {moving} s");
}

/// Feeds count at the largest override, and times at 100 %.
#[test]
fn overrides_above_one_hundred_percent_count() {
    let rig = Rig {
        rest: "override_max_percent = { feed = 150 }",
        ..LINUXCNC
    };
    let rows = report(rig, "G21 G90 G61\nG1 X100 F6000\nY100\nM2\n");
    // G61 leaves 0.9 of the acceleration next to a corner.
    let expected = 0.15 * 500.0 * 4.5;
    assert!(
        (rows[0].peak_w - expected).abs() < 1e-6 * expected,
        "{}",
        rows[0].peak_w
    );
    let seconds = 100.0 / 100.0 + 100.0 / 4500.0;
    assert!(
        (rows[0].duration_s - seconds).abs() < 1e-9,
        "{}",
        rows[0].duration_s
    );
    let rig = Rig {
        peak_w: 300.0,
        ..rig
    };
    let text = rig.fits("G21 G90 G61\nG1 X100 F6000\nY100\nM2\n");
    let peaks = report(rig, &text);
    assert!(
        peaks
            .iter()
            .all(|row| row.peak_w <= 300.0 * (1.0 + 1e-6) && row.peak_w > 265.0)
    );
}

/// One block of a random program; places in hundredths of a millimetre.
#[derive(Debug, Clone)]
enum Piece {
    Line(i32, i32, bool),
    /// Many short lines in a direction.
    Short(i32, i32, u8),
    Arc(i32, bool),
    Feed(u16),
    Word(&'static str),
}

fn piece() -> impl Strategy<Value = Piece> {
    prop_oneof![
        6 => (-9000..9000_i32, -9000..9000_i32, prop::bool::weighted(0.2))
            .prop_map(|(x, y, rapid)| Piece::Line(x, y, rapid)),
        3 => (-60..60_i32, -60..60_i32, 2..60_u8).prop_map(|(x, y, n)| Piece::Short(x, y, n)),
        1 => (10..3000_i32, any::<bool>()).prop_map(|(r, clockwise)| Piece::Arc(r, clockwise)),
        2 => (200..20_000_u16).prop_map(Piece::Feed),
        2 => prop::sample::select(vec!["M8", "M9", "M7", "G4 P0.5", "S500", "M3 S100", "M5", "G61", "G64"])
            .prop_map(Piece::Word),
    ]
}

/// The text for a controller; `doubt` takes the place of M8 and M9.
fn text(pieces: &[Piece], controller: &str, doubt: Option<&str>) -> String {
    let mut program = String::from("G21\nG91\nG1 F3000\n");
    let number = |hundredths: i32| f64::from(hundredths) / 100.0;
    for piece in pieces {
        let _ = match *piece {
            Piece::Line(x, y, rapid) => {
                let word = if rapid { "G0" } else { "G1" };
                writeln!(program, "{word} X{:.2} Y{:.2}", number(x), number(y))
            }
            Piece::Short(x, y, n) => {
                for i in 0..i32::from(n) {
                    let bend = i % 7 - 3;
                    let (x, y) = (number(x + bend), number(y - bend));
                    let _ = writeln!(program, "G1 X{x:.2} Y{y:.2}");
                }
                Ok(())
            }
            Piece::Arc(r, clockwise) => {
                let word = if clockwise { "G2" } else { "G3" };
                writeln!(
                    program,
                    "{word} X{:.2} Y0 I{:.2} J0",
                    2.0 * number(r),
                    number(r)
                )
            }
            Piece::Feed(feed) => writeln!(program, "F{feed}"),
            Piece::Word("G64") if controller == "linuxcnc" => writeln!(program, "G64 P0.02 Q0.01"),
            Piece::Word("G61" | "G64") if controller != "linuxcnc" => Ok(()),
            Piece::Word("M8" | "M9") => match doubt {
                Some(other) => write!(program, "{other}"),
                None => write!(program, "{}", unsaid(controller)),
            },
            Piece::Word(word) => writeln!(program, "{word}"),
        };
    }
    program + "M2\n"
}

fn random_rig(controller: &'static str, share: f64) -> Rig {
    Rig {
        controller,
        peak_w: 1250.0 * share,
        axis: "coulomb_n = 80\nefficiency = 0.9",
        rest: "min_feed_ratio = 0",
        ..RIG
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// What is certified fits when it is read again, keeps its path, and no
    /// feed went up.
    #[test]
    fn certified_programs_fit(
        pieces in prop::collection::vec(piece(), 1..25),
        controller in prop::sample::select(vec!["linuxcnc", "grbl", "marlin", "klipper", "reprap"]),
        share in 0.1..1.0_f64,
    ) {
        let rig = random_rig(controller, share);
        let machine = rig.machine();
        let program = text(&pieces, controller, None);
        let (limited, summary) = super::run(&machine, rig.options, program.as_bytes())
            .expect("a program");
        let faults = ["changed-sequence", "went-up", "changed-feed", "unreadable-output", "edit", "does-not-fit"];
        for reason in &summary.reasons {
            prop_assert!(!faults.contains(&reason.rule), "{reason:?}\n{program}");
        }
        prop_assert!(summary.certified, "{:?}\n{program}", summary.reasons);
        let limited = String::from_utf8(limited).expect("text");
        let after = rows(&machine, rig.options, &limited);
        for row in &after {
            prop_assert!(row.peak_w <= row.limit_w * (1.0 + 1e-9), "{row:?}\n{limited}");
        }
        // Without the words that set limits.
        let plain = |text: &String| {
            let lines = text.lines().filter(|line| !line.starts_with(['M', 'S']));
            lines.collect::<Vec<_>>().join("\n")
        };
        let [old, mut new] = [&program, &limited].map(|text| super::reader::read(&plain(text)));
        new.retain(|mv| mv.dwell != Some(0.0));
        prop_assert_eq!(old.len(), new.len());
        for (old, new) in old.iter().zip(&new) {
            prop_assert_eq!(old.path(), new.path());
            let risen = old.feed.zip(new.feed).is_some_and(|(old, new)| new > old * (1.0 + 1e-9));
            prop_assert!(!risen, "{old:?} {new:?}");
        }
        let (again, summary) = super::run(&machine, rig.options, limited.as_bytes())
            .expect("a program");
        prop_assert_eq!((again, summary.edited_lines), (limited.into_bytes(), 0));
    }

    /// Whether a word stops the motion or not, no move asks for more than is said.
    #[test]
    fn doubt_covers_both(
        pieces in prop::collection::vec(piece(), 1..25),
        controller in prop::sample::select(vec!["linuxcnc", "grbl", "marlin", "klipper", "reprap"]),
    ) {
        let rig = random_rig(controller, 1.0);
        let machine = rig.machine();
        let said = rows(&machine, rig.options, &text(&pieces, controller, None));
        for other in ["", "G4 P0\n"] {
            let real = rows(&machine, rig.options, &text(&pieces, controller, Some(other)));
            prop_assert_eq!(said.len(), real.len());
            for (said, real) in said.iter().zip(&real) {
                prop_assert!(said.peak_w >= real.peak_w * (1.0 - 1e-9) - 1e-9, "{said:?} {real:?} {other}");
                prop_assert!(said.regen_w >= real.regen_w * (1.0 - 1e-9) - 1e-9, "{said:?} {real:?} {other}");
            }
        }
    }
}
