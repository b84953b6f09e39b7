#![doc = include_str!("../README.md")]

mod expression;
mod fanuc;
mod fluidnc;
mod format;
mod found;
mod grbl;
mod ini;
mod kinematics;
mod klipper;
mod linuxcnc;
mod marlin;
mod marlin_config;
mod near;
mod reprap;
mod siemens;
mod text;
mod words;
mod write;

use gwatt_machine::builtin_controller;
use gwatt_syntax::diagnostic::{Diagnostic, Severity};

pub use format::{FORMATS, Format};
pub use near::{Near, Nothing};
pub use text::{File, MAX_BYTES};

use found::Found;
use near::Job;
use text::{Log, Text};

/// A machine file, and what is to be said about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// What the files are.
    pub format: Format,
    /// The machine file.
    pub toml: String,
    /// What was not taken over.
    pub warnings: Vec<Diagnostic>,
}

/// What is asked for.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wanted<'w> {
    /// The kind of the files; `None`: as their lines say.
    pub format: Option<Format>,
    /// The controller profile; `None`: that of the kind.
    pub controller: Option<&'w str>,
}

/// Makes a machine file of the settings in `files`, which are read as one, in their order;
/// `near` finds those that they name.
///
/// # Errors
/// Files that are no text or of no kind that is known, and every value that gwatt has a field
/// for and that cannot be read.
pub fn import(
    files: &[File],
    wanted: Wanted<'_>,
    near: &dyn Near,
) -> Result<Imported, Vec<Diagnostic>> {
    let mut log = Log::default();
    let texts: Result<Vec<Text>, Box<Diagnostic>> = files.iter().map(Text::new).collect();
    let texts = texts.map_err(|refused| vec![*refused])?;
    let Some(format) = wanted.format.or_else(|| Format::find(&texts)) else {
        return Err(vec![unknown(files)]);
    };
    let controller = wanted.controller.map(profile).transpose()?;
    let include: fn(&str) -> Option<&str> = match format {
        Format::Klipper => klipper::include,
        Format::LinuxCnc => linuxcnc::include,
        Format::RepRap => reprap::include,
        _ => |_| None,
    };
    let job = Job::new(files, near, include, &mut log).map_err(|refused| vec![*refused])?;
    let mut found = match format {
        Format::LinuxCnc => linuxcnc::read(&job, near, &mut log),
        Format::Grbl => grbl::read(&job, &mut log),
        Format::FluidNc => fluidnc::read(&job, &mut log),
        Format::Marlin => marlin::read(&job, &mut log),
        Format::MarlinConfig => marlin_config::read(&job, &mut log),
        Format::Klipper => klipper::read(&job, &mut log),
        Format::RepRap => reprap::read(&job, &mut log),
        Format::Fanuc => fanuc::read(&job, &mut log),
        Format::Siemens => siemens::read(&job, &mut log),
    };
    if let Some(controller) = controller {
        found.controller = controller;
    }
    kinematics::alike(&mut found, &mut log, job.name());
    nothing(&found, &mut log, job.name(), format);
    let is_error = |finding: &Diagnostic| finding.severity == Severity::Error;
    if log.list.iter().any(is_error) {
        return Err(log.list);
    }
    Ok(Imported {
        format,
        toml: write::machine_file(&found, &job.names()),
        warnings: log.list,
    })
}

/// A file of which nothing is known, or without an axis, makes no machine.
fn nothing(found: &Found, log: &mut Log, file: &str, format: Format) {
    let mut axes = found.axes.iter().flatten();
    if axes.any(|axis| axis.rapid.is_some() || axis.accel.is_some()) {
        return;
    }
    let errors = log
        .list
        .iter()
        .any(|finding| finding.severity == Severity::Error);
    if !errors {
        let message = format!(
            "no speed and no acceleration of an axis was found, read as {}",
            format.name()
        );
        log.whole(
            file,
            message,
            "give the file that holds them, or another --format",
        );
    }
}

fn unknown(files: &[File]) -> Diagnostic {
    let names: Vec<&str> = FORMATS.iter().map(|(_, name)| *name).collect();
    let first = files
        .first()
        .map_or(String::new(), |file| file.name.clone());
    let message = "the file does not show what kind of settings these are";
    let mut refused = Diagnostic::error("import-file", message);
    refused.file = Some(first);
    refused.help(format!("say it: --format {}", names.join(", ")))
}

/// The profile of that name.
fn profile(name: &str) -> Result<&'static str, Vec<Diagnostic>> {
    let list = gwatt_machine::builtin::controllers();
    let found = list.iter().find(|it| it.name == name);
    if let Some(found) = found.filter(|_| builtin_controller(name).is_some()) {
        return Ok(found.name);
    }
    let names: Vec<&str> = list.iter().map(|it| it.name).collect();
    let message = format!("no controller profile is named \"{name}\"");
    let refused = Diagnostic::error("import-file", message);
    Err(vec![
        refused.help(format!("there are {}", names.join(", "))),
    ])
}
