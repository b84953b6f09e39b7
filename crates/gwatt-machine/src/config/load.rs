//! Finds machines and profiles: a built-in name, or a file.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::controller_file::ControllerFile;
use super::document::{self, SCHEMA_VERSION};
use super::findings::{self, Findings};
use super::machine_file::MachineFile;
use super::value::At;
use super::{assemble, hints, profile, schema};
use crate::builtin::{self, Builtin};
use crate::controller::Controller;
use crate::model::Machine;
use gwatt_syntax::diagnostic::{Diagnostic, Severity};

/// A description is a few kilobytes; a larger file is a mistake.
const MAX_BYTES: u64 = 1 << 20;

/// What was read, with warnings; or everything that is wrong with it.
pub type Loaded<T> = Result<(T, Vec<Diagnostic>), Vec<Diagnostic>>;

impl Machine {
    /// Reads a machine from text. `name` is the file's path: a controller
    /// profile is looked for next to it.
    ///
    /// # Errors
    ///
    /// Every mistake of the file (and of its controller profile), by line.
    pub fn from_toml(name: &str, text: &str) -> Loaded<Self> {
        let mut findings = Findings::new(text);
        let file = document::read::<MachineFile>(text, &schema::MACHINE, &mut findings);
        let machine = file.and_then(|file| {
            version(&mut findings, file.schema.as_ref());
            not_empty(&mut findings, "name", file.name.as_ref());
            let controller = controller(&mut findings, name, file.controller.as_ref());
            // The other mistakes are to be seen even if the profile is refused.
            let stand_in = || {
                Controller::load(builtin::DEFAULT_CONTROLLER)
                    .ok()
                    .map(|(c, _)| c)
            };
            let controller = controller.or_else(stand_in)?;
            assemble::machine(&mut findings, &file, controller)
        });
        finish(machine, findings)
    }

    /// Loads a machine: a built-in name, else a file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, an unknown name, or every mistake in it.
    pub fn load(name_or_path: &str) -> Loaded<Self> {
        if let Some(machine) = builtin::machines().iter().find(|m| m.name == name_or_path) {
            return Self::from_toml(machine.name, machine.text);
        }
        let text = read(
            Path::new(name_or_path),
            name_or_path,
            "machine",
            builtin::machines(),
        );
        Self::from_toml(name_or_path, &text?)
    }
}

impl Controller {
    /// Reads a controller profile from text.
    ///
    /// # Errors
    ///
    /// Every mistake of the file, by line.
    pub fn from_toml(text: &str) -> Loaded<Self> {
        let mut findings = Findings::new(text);
        let file = document::read::<ControllerFile>(text, &schema::CONTROLLER, &mut findings);
        let controller = file.and_then(|file| {
            version(&mut findings, file.schema.as_ref());
            not_empty(&mut findings, "name", file.name.as_ref());
            profile::controller(&mut findings, &file)
        });
        finish(controller, findings)
    }

    /// Loads a controller profile: a built-in name, else a file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, an unknown name, or every mistake in it.
    pub fn load(name_or_path: &str) -> Loaded<Self> {
        load_controller(Path::new(""), name_or_path)
    }
}

/// A profile by name, or by path from `folder`.
fn load_controller(folder: &Path, name: &str) -> Loaded<Controller> {
    if let Some(profile) = builtin::controllers().iter().find(|c| c.name == name) {
        return Controller::from_toml(profile.text);
    }
    let path = folder.join(name);
    let text = read(&path, name, "controller profile", builtin::controllers());
    Controller::from_toml(&text?)
}

/// The machine's controller; what is wrong with its profile is reported at the
/// line that names it, and again where it stands.
fn controller(
    findings: &mut Findings<'_>,
    machine_path: &str,
    name: Option<&At<String>>,
) -> Option<Controller> {
    let name = name?;
    let folder = Path::new(machine_path).parent().unwrap_or(Path::new(""));
    let prefix = |mut diagnostic: Diagnostic| {
        diagnostic.message = format!("{}: {}", name.value, diagnostic.message);
        diagnostic
    };
    match load_controller(folder, &name.value) {
        Ok((controller, notes)) => {
            findings.append(notes.into_iter().map(prefix).collect());
            Some(controller)
        }
        Err(errors) => {
            if let [
                Diagnostic {
                    line: 0,
                    message,
                    help,
                    ..
                },
            ] = errors.as_slice()
            {
                findings.error(
                    "machine-controller",
                    &name.span,
                    message.clone(),
                    help.clone(),
                );
                return None;
            }
            let message = format!("the controller profile {} has mistakes", name.value);
            findings.error("machine-controller", &name.span, message, None);
            findings.append(errors.into_iter().map(prefix).collect());
            None
        }
    }
}

/// Text of a file, or why there is none.
fn read(
    path: &Path,
    name: &str,
    what: &str,
    builtins: &[Builtin],
) -> Result<String, Vec<Diagnostic>> {
    let shown = path.display();
    let refuse = |message: String, help: Option<String>| {
        findings::diagnostic(Severity::Error, "machine-file", message, help)
    };
    if path.is_dir() {
        return Err(vec![refuse(
            format!("{shown} is a folder, not a {what} file"),
            None,
        )]);
    }
    let bytes = match read_bytes(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return Err(vec![not_found(path, name, what, builtins, refuse)]);
        }
        Err(error) => {
            let message = format!("cannot read {shown}: {error}");
            return Err(vec![refuse(message, None)]);
        }
    };
    if bytes.len() as u64 > MAX_BYTES {
        let help = Some(format!("a {what} file is a few kilobytes"));
        return Err(vec![refuse(format!("{shown} is larger than 1 MiB"), help)]);
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let help = Some("save the file as UTF-8".to_owned());
        let refused = refuse(format!("{shown} is not UTF-8"), help);
        vec![findings::locate(error.as_bytes(), &(at..at + 1), refused)]
    })
}

/// At most one byte more than permitted: enough to know, also for a device.
fn read_bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?
        .take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn not_found(
    path: &Path,
    name: &str,
    what: &str,
    builtins: &[Builtin],
    refuse: impl Fn(String, Option<String>) -> Diagnostic,
) -> Diagnostic {
    let name_as_path = Path::new(name);
    if name_as_path.components().count() > 1 || name_as_path.extension().is_some() {
        return refuse(format!("there is no {what} file {}", path.display()), None);
    }
    let names: Vec<&str> = builtins.iter().map(|builtin| builtin.name).collect();
    let list = format!("built in: {}", names.join(", "));
    let is_profile = what == "machine" && builtin::controllers().iter().any(|it| it.name == name);
    if is_profile {
        let help = format!(
            "{name} is a controller profile: a machine file takes it by controller = \"{name}\""
        );
        return refuse(format!("no machine is named \"{name}\""), Some(help));
    }
    let help = match hints::did_you_mean(name, names) {
        Some(suggestion) => format!("{suggestion} {list}"),
        None => list,
    };
    refuse(
        format!("no built-in {what} and no file is named \"{name}\""),
        Some(help),
    )
}

fn version(findings: &mut Findings<'_>, schema: Option<&At<u32>>) {
    if let Some(found) = schema.filter(|schema| schema.value != SCHEMA_VERSION) {
        let message = format!("schema {} is not known", found.value);
        let help = Some(format!(
            "this version of gwatt reads schema = {SCHEMA_VERSION}"
        ));
        findings.error("machine-schema", &found.span, message, help);
    }
}

fn not_empty(findings: &mut Findings<'_>, key: &str, text: Option<&At<String>>) {
    if let Some(empty) = text.filter(|text| text.value.trim().is_empty()) {
        findings.error(
            "machine-missing",
            &empty.span,
            format!("`{key}` is empty"),
            None,
        );
    }
}

fn finish<T>(value: Option<T>, mut findings: Findings<'_>) -> Loaded<T> {
    match value {
        Some(value) if !findings.has_errors() => Ok((value, findings.into_list())),
        value => {
            if value.is_none() && !findings.has_errors() {
                // Not known to occur: never refuse without a reason.
                findings.error("machine-file", &(0..0), "the file is not complete", None);
            }
            Err(findings.into_list())
        }
    }
}
