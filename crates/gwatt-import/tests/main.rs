//! Settings of controls to machine files, from the outside.

mod commands;
mod controls;
mod errors;
mod firmware;
mod kinematics;
mod limits;
mod linuxcnc;
mod printers;
mod robust;
mod whole;

use gwatt_import::{File, Imported, Near, Nothing, Wanted, import};
use gwatt_syntax::diagnostic::{Diagnostic, Severity};

/// A file.
fn file(name: &str, text: &str) -> File {
    File {
        name: name.to_owned(),
        bytes: text.into(),
    }
}

/// Files in a folder.
struct Folder(Vec<File>);

impl Near for Folder {
    fn files(&self, _: &str, pattern: &str) -> Vec<File> {
        let fits = |file: &&File| match pattern.split_once('*') {
            Some((start, end)) => file.name.starts_with(start) && file.name.ends_with(end),
            None => file.name == pattern,
        };
        self.0.iter().filter(fits).cloned().collect()
    }
}

/// The machine file of one text, which must be without errors.
#[track_caller]
fn imported(text: &str) -> Imported {
    match import(&[file("settings", text)], Wanted::default(), &Nothing) {
        Ok(imported) => imported,
        Err(errors) => panic!("{}", render(&errors)),
    }
}

/// The lines of a machine file that are in force, from the controller on.
#[track_caller]
fn fields(text: &str) -> String {
    in_force(&imported(text).toml)
}

fn in_force(toml: &str) -> String {
    let lines = toml
        .lines()
        .filter(|line| !line.starts_with('#') && !line.is_empty());
    lines.skip(2).collect::<Vec<_>>().join("\n")
}

/// The errors of one text.
#[track_caller]
fn refused(text: &str) -> String {
    match import(&[file("settings", text)], Wanted::default(), &Nothing) {
        Ok(imported) => panic!("{}", imported.toml),
        Err(errors) => render(&errors),
    }
}

/// Findings as text.
fn render(list: &[Diagnostic]) -> String {
    list.iter().map(one).collect()
}

fn one(d: &Diagnostic) -> String {
    let kind = match d.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let help = d
        .help
        .as_ref()
        .map_or_else(String::new, |help| format!(" / {help}"));
    let file = d.file.as_deref().unwrap_or("?");
    let said = format!("{file}:{}, {kind}: {}{help}\n", d.line, d.message);
    if d.line == 0 {
        return said;
    }
    let line = String::from_utf8_lossy(&d.text);
    let indent = " ".repeat(d.span.start as usize);
    let caret = "^".repeat((d.span.end - d.span.start).max(1) as usize);
    format!("{said}  | {line}\n  | {indent}{caret}\n")
}
