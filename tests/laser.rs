//! grbl's laser mode: S in a block that moves stops nothing.

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::diagnostic::Diagnostic;
use gwatt::machine::Machine;
use gwatt::pipeline::{Options, moves};
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
