//! Machine files and controller profiles, from the outside.

mod builtin;
mod conversion;
mod default_machine;
mod errors;
mod kinematics;
mod levels;
mod load;
mod own_rules;
mod parts;
mod profile_errors;
mod robust;
mod schema;
mod table_errors;
mod value_errors;
mod warnings;

use gwatt::diagnostic::{Diagnostic, Severity};
use gwatt::machine::Machine;

use crate::near::assert_near;

/// A small machine without a mistake; tests change one line of it.
const BASE: &str = r#"schema = 1
name = "test"
controller = "iso"

[converter]
peak_power_w = 3500

[axes.X]
kind = "linear"
rapid_mm_min = 36000
accel_mm_s2 = 6000
mass_kg = 900

[axes.B]
kind = "rotary"
rapid_deg_min = 18000
accel_deg_s2 = 1150
inertia_kg_m2 = 12
"#;

/// The base machine with a piece replaced.
fn edited(old: &str, new: &str) -> String {
    assert!(BASE.contains(old), "{old:?} is not in the base");
    BASE.replacen(old, new, 1)
}

/// The base machine with lines after it.
fn with(more: &str) -> String {
    format!("{BASE}{more}\n")
}

/// All errors and warnings of a machine file.
fn findings(text: &str) -> String {
    match Machine::from_toml("test.toml", text) {
        Ok((_, notes)) => render(&notes),
        Err(errors) => render(&errors),
    }
}

/// The machine; the file must be without errors.
fn machine(text: &str) -> Machine {
    match Machine::from_toml("test.toml", text) {
        Ok((machine, _)) => machine,
        Err(errors) => panic!("{}", render(&errors)),
    }
}

/// Diagnostics as text: what is said, and the line with the place marked.
fn render(list: &[Diagnostic]) -> String {
    list.iter().map(render_one).collect()
}

fn render_one(d: &Diagnostic) -> String {
    let kind = match d.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let help = d
        .help
        .as_ref()
        .map_or_else(String::new, |help| format!(" / {help}"));
    let said = format!("line {}, {kind} {}: {}{help}\n", d.line, d.rule, d.message);
    if d.line == 0 {
        return said;
    }
    let line = String::from_utf8_lossy(&d.text);
    let indent = " ".repeat(d.span.start as usize);
    let caret = "^".repeat((d.span.end - d.span.start).max(1) as usize);
    format!("{said}  | {line}\n  | {indent}{caret}\n")
}

/// Figures that went through conversions of units.
#[track_caller]
fn near(found: f64, expected: f64) {
    assert_near(found, expected, 1e-6 * expected.abs());
}
