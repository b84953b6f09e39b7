//! The moves of a program as text, and what is said about it.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;

use gwatt::interpret::Limits;
use gwatt::machine::{ALL_AXES, Machine};
use gwatt::pipeline::{self, Failure, Options, Reading};

/// A machine with linear axes X Y Z and rotary axes A C under a controller.
pub(crate) fn machine(controller: &str) -> Machine {
    machine_of(controller, "", "XYZ", "AC")
}

/// A machine with these linear and rotary axes: 100 mm/s, 1000 mm/s², 10 kg, and
/// 60 °/s, 500 °/s², 1 kg·m²; `more` stands before its tables.
pub(crate) fn machine_of(controller: &str, more: &str, linear: &str, rotary: &str) -> Machine {
    let mut text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n{more}[converter]\npeak_power_w = 1e5\n",
    );
    for axis in linear.chars() {
        let _ = writeln!(
            text,
            "[axes.{axis}]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10"
        );
    }
    for axis in rotary.chars() {
        let _ = writeln!(
            text,
            "[axes.{axis}]\nkind = \"rotary\"\nrapid_deg_min = 3600\naccel_deg_s2 = 500\ninertia_kg_m2 = 1"
        );
    }
    Machine::from_toml("test.toml", &text)
        .expect("a valid machine")
        .0
}

/// The moves of a program, a line each: line, kind, the axes that differ from
/// the start, arc, feed in mm/min; and its errors.
pub(crate) fn listing(program: &str, machine: &Machine, folder: Option<&Path>) -> String {
    let options = Options {
        reading: Reading {
            sub_paths: folder.iter().map(|folder| folder.to_path_buf()).collect(),
            limits: Limits {
                idle_lines: 10_000,
                repeated_moves: 10_000,
                ..Limits::default()
            },
            ..Reading::default()
        },
        ..Options::default()
    };
    let mut out = String::new();
    let round = |value: f64| (value * 1e4).round() / 1e4 + 0.0;
    let result = pipeline::moves(Cursor::new(program), machine, &options, &mut |mv, _| {
        let _ = write!(out, "{} {}", mv.line, mv.kind.name());
        for axis in mv.moving.iter() {
            let letter = ALL_AXES[axis].letter() as char;
            let _ = write!(out, " {letter}{}", round(mv.end[axis]));
        }
        if let Some(arc) = &mv.arc {
            let turns = round(arc.sweep_rad / std::f64::consts::TAU);
            let center = arc.center.map(round);
            let _ = write!(out, " center {},{} turns {turns}", center[0], center[1]);
        }
        if mv.feed_mm_s.is_finite() {
            let _ = write!(out, " F{}", round(mv.feed_mm_s * 60.0));
        }
        if mv.dwell_s > 0.0 {
            let _ = write!(out, " {} s", mv.dwell_s);
        }
        out.push('\n');
        Ok(())
    });
    if let Err(Failure::Refused { diagnostics, .. }) = result {
        for found in diagnostics
            .iter()
            .filter(|found| found.severity == gwatt::diagnostic::Severity::Error)
        {
            let _ = writeln!(out, "{} {}: {}", found.line, found.rule, found.message);
        }
    }
    out
}

/// The errors of a program, each with its line.
pub(crate) fn refusals(program: &str, machine: &Machine) -> String {
    let said = listing(program, machine, None);
    let found: Vec<&str> = said.lines().filter(|line| line.contains(": ")).collect();
    if found.is_empty() {
        return format!("accepted: {said}");
    }
    found.join("\n")
}

/// A listing without the numbers of its lines, for twins.
pub(crate) fn without_lines(listing: &str) -> Vec<&str> {
    let after_number = |line| str::split_once(line, ' ').map_or(line, |(_, rest)| rest);
    listing.lines().map(after_number).collect()
}

/// The programs whose last move does not end at the X that is expected of their
/// values.
pub(crate) fn wrong_values(cases: &[(&str, f64)], moves: fn(&str) -> String) -> String {
    let mut wrong = String::new();
    for (program, expected) in cases {
        let found = moves(&format!("G0\n{program}\n"));
        let ends = format!(" X{}", (expected * 1e4).round() / 1e4);
        if !(found.trim_end().ends_with(&ends) && found.lines().count() == 1) {
            let _ = writeln!(wrong, "{program}: {found}");
        }
    }
    wrong
}
