//! `gwatt.toml`: what one always gives, next to the programs.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use gwatt::machine::builtin;
use serde::Deserialize;

use super::input::Program;
use super::terminal::Terminal;
use crate::cli::{Allow, DeleteLevels, MachineArgs, ProgramArgs};

/// Its name.
pub const NAME: &str = "gwatt.toml";

/// Settings of the programs of a folder, and of the folders below it. What stands on the
/// command line, or in `GWATT_MACHINE`, goes before them.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    machine: Option<String>,
    dialect: Option<String>,
    tool_table: Option<PathBuf>,
    parameters: Option<PathBuf>,
    sub_path: Vec<PathBuf>,
    set: Vec<String>,
    start: Option<String>,
    block_delete: Option<Deleted>,
    once: bool,
    /// What `limit` may change.
    allow: Vec<Allow>,
}

/// Blocks that are deleted: all with `/`, or those of some levels.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Deleted {
    All(bool),
    Levels(String),
}

impl Settings {
    /// The file that holds those of a folder.
    pub fn file_of(folder: &Path) -> Option<PathBuf> {
        nearest(folder)
    }

    /// Those of programs, which must be the same for all of them.
    pub fn of(programs: &[Program], terminal: Terminal) -> Result<Self> {
        let mut folders = BTreeMap::new();
        for program in programs {
            let folder = program.folder().unwrap_or(Path::new("."));
            if !folders.contains_key(folder) {
                folders.insert(folder.to_owned(), nearest(folder));
            }
        }
        let mut found = folders.into_iter();
        let Some((first, file)) = found.next() else {
            return Ok(Self::default());
        };
        if let Some((folder, other)) = found.find(|(_, other)| *other != file) {
            let settings = |file: &Option<PathBuf>| match file {
                Some(file) => format!("settings in {}", file.display()),
                None => format!("no {NAME}"),
            };
            bail!(
                "programs have different settings: {} has {}, {} has {}: run them one folder at \
                 a time",
                first.display(),
                settings(&file),
                folder.display(),
                settings(&other)
            );
        }
        let Some(file) = file else {
            return Ok(Self::default());
        };
        let shown = file.display();
        let text = fs::read_to_string(&file).with_context(|| format!("cannot read {shown}"))?;
        let mut settings: Self =
            toml::from_str(&text).map_err(|error| anyhow::anyhow!("{shown}: {error}"))?;
        terminal.note(format_args!("settings are taken from {shown}"));
        settings.lie_in(file.parent().unwrap_or(Path::new("")));
        Ok(settings)
    }

    /// Paths in the file begin in its folder.
    fn lie_in(&mut self, folder: &Path) {
        if let Some(machine) = self.machine.take() {
            let machines = builtin::machines();
            let built_in = machines.iter().any(|it| it.name == machine);
            let path = || folder.join(&machine).to_string_lossy().into_owned();
            self.machine = Some(if built_in { machine.clone() } else { path() });
        }
        let files = [&mut self.tool_table, &mut self.parameters];
        let files = files.into_iter().flatten();
        for path in files.chain(&mut self.sub_path) {
            *path = folder.join(&*path);
        }
    }

    /// Fills in the machine where none is given.
    pub fn fill_machine(&self, machine: &mut MachineArgs) {
        fill(&mut machine.machine, self.machine.as_ref());
    }

    /// Fills in what is not given.
    pub fn fill(&self, machine: &mut MachineArgs, reading: &mut ProgramArgs) -> Result<()> {
        self.fill_machine(machine);
        fill(&mut reading.dialect, self.dialect.as_ref());
        fill(&mut reading.tool_table, self.tool_table.as_ref());
        fill(&mut reading.parameters, self.parameters.as_ref());
        reading.sub_path.extend(self.sub_path.iter().cloned());
        if reading.given.is_empty() {
            for given in &self.set {
                reading.given.push(parsed("set", given)?);
            }
        }
        if let Some(start) = self.start.as_ref().filter(|_| reading.start.is_none()) {
            reading.start = Some(parsed("start", start)?);
        }
        let levels = match &self.block_delete {
            Some(Deleted::Levels(levels)) => Some(levels.as_str()),
            Some(Deleted::All(true)) => Some("all"),
            Some(Deleted::All(false)) | None => None,
        };
        if let Some(levels) = levels.filter(|_| reading.block_delete.is_none()) {
            reading.block_delete = Some(parsed::<DeleteLevels>("block_delete", levels)?);
        }
        reading.once |= self.once;
        Ok(())
    }

    /// What `limit` may change, where the command line does not say so.
    pub fn allow(&self, given: &mut Vec<Allow>) {
        if given.is_empty() {
            given.clone_from(&self.allow);
        }
    }
}

fn fill<T: Clone>(given: &mut Option<T>, setting: Option<&T>) {
    if given.is_none() {
        *given = setting.cloned();
    }
}

fn parsed<T: std::str::FromStr>(key: &str, text: &str) -> Result<T>
where
    T::Err: std::fmt::Display,
{
    text.parse()
        .map_err(|error| anyhow::anyhow!("{NAME}: {key} = \"{text}\": {error}"))
}

/// The file in the nearest folder from `folder` upwards.
fn nearest(folder: &Path) -> Option<PathBuf> {
    // As it was given as long as that leads to it: that is what messages show.
    let here = |it: &Path| {
        let here = it.as_os_str().is_empty();
        (if here { Path::new(".") } else { it }).join(NAME)
    };
    let given = folder.ancestors().map(here).find(|it| it.is_file());
    given.or_else(|| {
        let real = fs::canonicalize(folder).ok()?;
        let mut found = real.ancestors().map(here);
        found.find(|it| it.is_file())
    })
}
