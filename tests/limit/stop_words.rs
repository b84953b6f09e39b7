//! Words at which the motion stops, goes on, or may do either.

use super::ahead::{GRBL, LINUXCNC, report, unsaid};
use super::{RIG, Rig};
use gwatt::pipeline::{Certificate, Row};
use std::fmt::Write as _;

/// A row of short lines, with a word between them.
fn short_lines(word: &str) -> String {
    let mut program = String::from("G21 G90\nG1 F9000\n");
    for i in 1..=200 {
        let _ = writeln!(program, "X{:.2}", 0.2 * f64::from(i));
        if i == 100 {
            program += word;
        }
    }
    program + "M2\n"
}

/// It may stop the motion or not: nothing is asked for that is more in either
/// case, however short the lines are.
#[test]
fn what_may_stop_the_motion_counts_as_far_as_it_reaches() {
    for rig in [LINUXCNC, GRBL] {
        let [through, stopped, doubt] =
            ["", "G4 P0\n", unsaid(rig.controller)].map(|word| report(rig, &short_lines(word)));
        // 0.15 m/s takes 2.25 mm: 12 lines brake and 12 speed up.
        assert!(
            through[80..120].iter().all(|row| row.peak_w < 1.0),
            "{through:?}"
        );
        assert!(
            stopped[100..111].iter().all(|row| row.peak_w > 50.0),
            "{stopped:?}"
        );
        for i in 0..200 {
            let least = through[i].peak_w.max(stopped[i].peak_w);
            let least_regen = through[i].regen_w.max(stopped[i].regen_w);
            assert!(doubt[i].peak_w >= least * (1.0 - 1e-9), "{i}");
            assert!(doubt[i].regen_w >= least_regen * (1.0 - 1e-9), "{i}");
        }
        // And further away nothing more.
        let robust = |row: &Row| row.certificate == Certificate::Robust;
        assert!(doubt[..70].iter().all(|row| !robust(row)));
        assert!(doubt[90..111].iter().all(robust));
        assert!(doubt[150..].iter().all(|row| !robust(row)));
    }
}

/// Where the profile says that a word stops the motion, it is a stop like any
/// other, and where it says that it does not, there is none.
#[test]
fn words_stop_the_motion_as_the_profile_says() {
    let same = |rig: Rig, word: &str, like: &str| {
        let rig = Rig {
            rest: "[offsets]\nG54 = { X = 0 }\nG55 = { X = 0 }\n",
            ..rig
        };
        let [rows, expected] = [word, like].map(|word| report(rig, &short_lines(word)));
        assert_eq!(rows, expected, "{word}");
    };
    for word in [
        "M8",
        "S100",
        "G55",
        "G92.1",
        "(MSG, a)",
        "M68 E0 Q1",
        "G4 P0 (b)",
    ] {
        same(LINUXCNC, &format!("{word}\n"), "G4 P0\n");
    }
    for word in [
        "T2",
        "M67 E0 Q1",
        "(PRINT, a)",
        "(MSG, a) (b)",
        // Without a comma it is a comment like others.
        "(MSG)",
        "(debug x)",
        "M48",
        "G54",
    ] {
        same(LINUXCNC, &format!("{word}\n"), "(c)\n");
    }
    same(GRBL, "M8\n", "G4 P0\n");
    same(GRBL, "M3 S100\n", "G4 P0\n");
    // What is in force already stops nothing.
    same(GRBL, "M9\n", "(c)\n");
    same(GRBL, "M5 S100\n", "(c)\n");
}

/// Firmwares of printers wait for the moves before they set some things, and go on at others: what
/// the profile does not name counts as both.
#[test]
fn commands_of_printers_stop_the_motion_as_the_profile_says() {
    let rig = |controller| Rig { controller, ..RIG };
    let same = |controller, word: &str, like: &str| {
        let [rows, expected] = [word, like].map(|word| report(rig(controller), &short_lines(word)));
        assert_eq!(rows, expected, "{controller} {word}");
    };
    for controller in ["marlin", "klipper", "reprap"] {
        for word in ["M400\n", "M84\n"] {
            same(controller, word, "G4 P0\n");
        }
        for word in [
            "M73 P5\n",
            "M106 S255\n",
            "M104 S0\n",
            "M117 half\n",
            "M220 S100\n",
        ] {
            same(controller, word, "; nothing\n");
        }
        let doubtful = [
            "M7\n",
            "M569 P0\n",
            "M913 X50\n",
            "M190 S60\n",
            unsaid(controller),
        ];
        let known = |word: &&str| controller == "reprap" && word.starts_with("M190");
        for word in doubtful.into_iter().filter(|word| !known(word)) {
            let rows = report(rig(controller), &short_lines(word));
            assert_eq!(
                rows[99].certificate,
                Certificate::Robust,
                "{controller} {word}"
            );
        }
    }
    same("reprap", "M190 S60\n", "G4 P0\n");
    same("klipper", "SET_LED LED=a RED=1\n", "; nothing\n");
    same("klipper", "SAVE_GCODE_STATE\n", "; nothing\n");
    for word in [
        "SET_TMC_CURRENT STEPPER=stepper_x CURRENT=1\n",
        "TEMPERATURE_WAIT SENSOR=a\n",
    ] {
        let rows = report(rig("klipper"), &short_lines(word));
        assert_eq!(rows[99].certificate, Certificate::Robust, "{word}");
    }
}

/// What grbl gets after M2 and M30 it executes, under the modes that these leave.
#[test]
fn grbl_goes_on_after_the_end() {
    let program = "%\nG21 G91 G18\nG0 X10\nM30\n%\nY10 F600\nG0 X300\nM2\n";
    let rows = report(GRBL, program);
    let found: Vec<_> = rows.iter().map(|row| (row.line, row.kind.name())).collect();
    assert_eq!(found, [(3, "rapid"), (6, "feed"), (7, "rapid")]);
    // A rapid of 290 mm: 500 kg · 5 m/s² · 0.5 m/s at least.
    assert!(rows[2].peak_w >= 1250.0 * (1.0 - 1e-9), "{rows:?}");
}

/// The same where the program has O-words, and is read by its flow.
#[test]
fn grbl_goes_on_after_the_end_of_a_program_with_flow() {
    let program = "G21 G90\no100 if [1 EQ 1]\nG1 X10 F600\no100 endif\nM30\nG0 X300\n";
    let rows = report(GRBL, program);
    let found: Vec<_> = rows.iter().map(|row| (row.line, row.kind.name())).collect();
    assert_eq!(found, [(3, "feed"), (6, "rapid")]);
}

/// Nothing is in doubt between two stops.
#[test]
fn words_at_rest_leave_no_doubt() {
    for words in ["S900 M3\n", "M3 S900\nM8\n", "M8\nM5\n"] {
        let rows = report(
            LINUXCNC,
            &format!("G21 G90 G64 P0.01\nG1 X100 F6000\nM5\n{words}X0 F3000\nM2\n"),
        );
        assert_eq!(rows[1].certificate, Certificate::Planned, "{words}");
    }
    let rig = Rig {
        peak_w: 700.0,
        ..LINUXCNC
    };
    rig.fits("G21 G90 G64 P0.01\nS900 M3\nG0 X100 Y50\nG1 X90 F600\nM2\n");
}
