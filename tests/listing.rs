//! The moves of a program as text, and what is said about it.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;

use gwatt::diagnostic::Severity;
use gwatt::interpret::{Limits, Move};
use gwatt::machine::{ALL_AXES, Machine};
use gwatt::pipeline::{self, Failure, Options, Reading};

use crate::machines::{linear_axes, machine_from, rotary_axes};

/// A machine with linear axes X Y Z and rotary axes A C under a controller.
pub(crate) fn machine(controller: &str) -> Machine {
    machine_of(controller, "", "XYZ", "AC")
}

/// A machine with these linear and rotary axes: 100 mm/s, 1000 mm/s², 10 kg, and
/// 60 °/s, 500 °/s², 1 kg·m²; `more` stands before its tables.
pub(crate) fn machine_of(controller: &str, more: &str, linear: &str, rotary: &str) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n{more}[converter]\n\
         peak_power_w = 1e5\n{}{}",
        linear_axes(linear, [6000.0, 1000.0, 10.0], ""),
        rotary_axes(rotary, [3600.0, 500.0, 1.0])
    ))
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
    if let Err(failure) = result {
        out += &errors_of(&failure);
    }
    out
}

/// A move to 1e-4, in a line as those of [`listing`].
pub(crate) fn in_full(mv: &Move) -> String {
    let mut out = format!("{} {}", mv.line, mv.kind.name());
    for axis in mv.moving.iter() {
        let letter = ALL_AXES[axis].letter() as char;
        let _ = write!(out, " {letter}{:.4}", mv.end[axis]);
    }
    if let Some(arc) = &mv.arc {
        let [first, second] = arc.center;
        let turns = arc.sweep_rad / std::f64::consts::TAU;
        let _ = write!(out, " center {first:.4},{second:.4} turns {turns:.4}");
    }
    if mv.feed_mm_s.is_finite() {
        let _ = write!(out, " F{:.4}", mv.feed_mm_s * 60.0);
    }
    if mv.dwell_s > 0.0 {
        let _ = write!(out, " {} s", mv.dwell_s);
    }
    out + "\n"
}

/// The errors for which a program is refused, a line each.
pub(crate) fn errors_of(failure: &Failure) -> String {
    let mut out = String::new();
    if let Failure::Refused { diagnostics, .. } = failure {
        let errors = diagnostics
            .iter()
            .filter(|it| it.severity == Severity::Error);
        for found in errors {
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
