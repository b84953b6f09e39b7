//! grbl's laser mode: S in a block that moves stops nothing.

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::diagnostic::Diagnostic;
use gwatt::machine::Machine;
use gwatt::pipeline::{LimitOptions, Options, limit, moves};
use gwatt::power::Certificate;

use crate::machines::{linear_axes, machine_from};
use crate::runs::{rows_of, summary_of};

fn router(laser_mode: &str) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"grbl\"\n[path]\n{laser_mode}\n\
         [converter]\npeak_power_w = 1e6\n{}",
        linear_axes("XYZ", [12000.0, 500.0, 10.0], "")
    ))
}

/// A row of short lines, of which each names another power.
fn row(with_power: bool) -> String {
    let mut text = "G21 G90\nM4 S0\nG0 X0 Y0\n".to_owned();
    for number in 1..60_u32 {
        let power = if with_power {
            format!(" S{}", number * 7 % 255)
        } else {
            String::new()
        };
        let _ = writeln!(text, "G1 X{} F12000{power}", f64::from(number) / 2.0);
    }
    text
}

#[test]
fn s_in_a_block_that_moves() {
    let figures = |machine: &Machine, program: &str| {
        let found = summary_of(machine, program);
        (found.duration_s, found.peak_w)
    };
    let (with, without) = (row(true), row(false));
    let [on, off, unknown] = ["laser_mode = true", "laser_mode = false", ""].map(router);
    let plain = figures(&on, &without);
    assert_eq!(figures(&off, &without), plain);
    // As if it stood nowhere, or a stop in each line.
    assert_eq!(figures(&on, &with), plain);
    let stopped = figures(&off, &with);
    assert!(
        stopped.0 > 2.0 * plain.0 && stopped.1 < 0.5 * plain.1,
        "{stopped:?} {plain:?}"
    );
    // Not known: neither is more.
    let either = summary_of(&unknown, &with).peak_w;
    assert!(either >= plain.1 && either >= stopped.1, "{either}");
    // By itself it waits in either mode.
    let alone = with.replace(" S", "\nS");
    assert!(figures(&on, &alone).0 > 2.0 * plain.0);
}

/// With a beam of constant power (M3) the axes may stop at a line without a way, and where a line
/// that moves by no motion word changes between G0 and G1 (grbl: `mc_line`; gcode.c, step 3b).
#[test]
fn a_beam_of_constant_power_waits() {
    let peak = |laser_mode: &str, beam: &str, line: &str| {
        let program =
            format!("G21 G90\nG92 Y0\n{beam} S100\nG1 X1 F12000\nG1 X20\n{line}\nG1 X40\n");
        let rows = rows_of(&router(laser_mode), &program);
        let last = rows.last().expect("a row");
        (last.peak_w, last.certificate)
    };
    for line in ["G1 X20", "G1 X20.01", "G0\nG1"] {
        for mode in ["laser_mode = true", ""] {
            let waits = peak(mode, "M3", line);
            assert_eq!(waits.1, Certificate::Robust, "{line}");
            assert!(waits.0 >= peak(mode, "M4", line).0, "{line}");
        }
        assert_eq!(
            peak("laser_mode = false", "M3", line).1,
            Certificate::Planned
        );
    }
    assert_eq!(
        peak("laser_mode = true", "M3", "G1 X21").1,
        Certificate::Planned
    );
}

#[test]
fn what_is_said_of_it() {
    let notes = |machine: &Machine, program: &str| {
        let found = moves(
            Cursor::new(program.as_bytes()),
            machine,
            &Options::default(),
            &mut |_, _| Ok(()),
        );
        let notes = found.expect("a program");
        notes
            .iter()
            .filter(|note| note.rule == "laser-mode")
            .count()
    };
    assert_eq!(notes(&router(""), &row(true)), 1);
    assert_eq!(notes(&router(""), &row(false)), 0);
    assert_eq!(notes(&router("laser_mode = true"), &row(true)), 0);
    // A program's own setting has to agree.
    let read = |machine: &str, value: &str| {
        let program = format!("$32={value}\nG21 G90\nG1 X1 F100\n");
        moves(
            Cursor::new(program.as_bytes()),
            &router(machine),
            &Options::default(),
            &mut |_, _| Ok(()),
        )
        .is_ok()
    };
    assert!(read("laser_mode = true", "1") && !read("laser_mode = true", "0"));
    assert!(read("laser_mode = false", "0") && !read("laser_mode = false", "1"));
    assert!(read("", "0") && read("", "1") && !read("", "2"));
}

#[test]
fn only_controls_that_have_it() {
    let text = "schema = 1\nname = \"test\"\ncontroller = \"fanuc\"\n[path]\nlaser_mode = true\n\
                [converter]\npeak_power_w = 1e6\n[axes.X]\nrapid_mm_min = 100\naccel_mm_s2 = 100\nmass_kg = 1\n";
    let found = Machine::from_toml("test.toml", text).expect_err("no laser mode");
    let says = |it: &Diagnostic| it.message == "controller \"fanuc\" has no laser mode";
    assert!(found.iter().any(says), "{found:?}");
}

/// grbl's beam is off in G0 and burns along a feed: a rapid stays one while it is lit.
#[test]
fn rapids_stay_rapids_while_a_laser_is_lit() {
    let limited = |laser_mode: &str, program: &str| {
        let machine = machine_from(&format!(
            "schema = 1\nname = \"test\"\ncontroller = \"grbl\"\n[path]\n{laser_mode}\n\
             [converter]\npeak_power_w = 1\n{}",
            linear_axes("XYZ", [12000.0, 500.0, 10.0], "")
        ));
        let input = Cursor::new(program.as_bytes());
        let how = LimitOptions::default();
        let mut text = Vec::new();
        let found = limit(input, &machine, &Options::default(), how, &mut text, None);
        let found = found.expect("read");
        let reasons = found.reasons.iter().map(|reason| reason.message.clone());
        (found.certified, reasons.collect::<String>())
    };
    let lit = "G21 G90\nM4 S1000\nG1 X5 F500\nG0 X80 Y60\nG1 X81\nM5\nM30\n";
    let dark = lit.replace("G0 X80 Y60", "G0 X80 Y60 S0");
    let constant = lit.replace("M4 S1000\nG1 X5", "M3\nG1 S1000 X5");
    let spindle = lit.replace("M4", "M3");
    // It stays a laser; an S with a rapid shows none.
    let later = lit
        .replace("M4 S1000\nG1 X5", "M3 S0\nG1 S1000 X5")
        .replace("\nG0", "\nS900\nG0");
    let first = lit.replace("M4 S1000\nG1 X5", "G0 X1 S1000 M3\nG1 X5");
    let [on, off, unknown] = ["laser_mode = true", "laser_mode = false", ""];
    for (mode, program, is_refused) in [
        (unknown, later.as_str(), true),
        (unknown, &first, false),
        (on, lit, true),
        (unknown, lit, true),
        (unknown, &constant, true),
        (on, &spindle, true),
        (on, &dark, false),
        (off, lit, false),
        (unknown, &spindle, false),
    ] {
        let (certified, reasons) = limited(mode, program);
        assert_eq!(certified, !is_refused, "{mode} {program} {reasons}");
        assert_eq!(reasons.contains("the laser is on"), is_refused, "{reasons}");
    }
    // A line that runs again while the beam is lit: it is dark only the first time.
    let again = "G21 G90 F500\no1 repeat [2]\nG0 X80 Y60\nG1 X81\nM4 S1000\no1 endrepeat\nM30\n";
    let (certified, reasons) = limited(on, again);
    assert!(!certified, "{reasons}");
    assert!(reasons.contains("feeds or modes that differ"), "{reasons}");
}

/// Where a beam of constant power may wait, a rapid that becomes a feed changes nothing else.
#[test]
fn a_rapid_before_the_end_becomes_a_feed() {
    let machine = machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"grbl\"\n[converter]\npeak_power_w = 1\n{}",
        linear_axes("XYZ", [12000.0, 500.0, 10.0], "")
    ));
    for end in ["M2\n", "M0\nG1 X9 F100\n", ""] {
        let program = format!("G21 G90\nM3 S100\nG1 X5 F500\nG0 X80 Y60\n{end}");
        let input = Cursor::new(program.as_bytes());
        let how = LimitOptions::default();
        let mut text = Vec::new();
        let found = limit(input, &machine, &Options::default(), how, &mut text, None);
        let found = found.expect("read");
        assert!(found.certified, "{program}{:?}", found.reasons);
        let text = String::from_utf8(text).expect("text");
        assert!(text.contains("\nG1 X80 Y60 F"), "{text}");
    }
}
