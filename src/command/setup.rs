//! Machine and options of a run, from its arguments.

use std::fs::File;
use std::io::Read;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;

use anyhow::{Context, Result, bail, ensure};
use gwatt::diagnostic::Diagnostic;
use gwatt::interpret::{BlockDelete, ParameterFile, ProbeResult, ToolTable};
use gwatt::machine::{self, AXES, Machine, builtin};
use gwatt::pipeline::{Limits, Options, Reading, Start};

use super::input::Program;
use super::terminal::{Shown, Terminal};
use crate::cli::{MachineArgs, ProgramArgs, StartArg};

/// Largest tool table or parameter file that is read.
const DATA_BYTES_MAX: u64 = 16 << 20;

/// The dialect that is chosen by the program.
const AUTO: &str = "auto";

/// What a program is judged with.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The machine.
    pub machine: Machine,
    /// How programs are read.
    pub options: Options,
    /// `--dialect auto`: the language is still to be chosen.
    pub auto: bool,
}

impl Setup {
    /// The machine that is asked for, or the default one.
    pub fn new(args: &MachineArgs, reading: &ProgramArgs, terminal: Terminal) -> Result<Self> {
        if let Some(name) = args.machine.as_deref() {
            return Self::of(name, reading, terminal);
        }
        let name = builtin::DEFAULT_MACHINE;
        let setup = Self::of(name, reading, terminal)?;
        let language = &setup.machine.controller.language.name;
        terminal.note(format_args!(
            "no machine is given: this is for the built-in {name}, \
             with programs read as {language} (see `gwatt machine list`)"
        ));
        Ok(setup)
    }

    /// The machine of that name.
    pub fn of(name: &str, reading: &ProgramArgs, terminal: Terminal) -> Result<Self> {
        let mut machine = load_machine(name, terminal)?;
        let auto = reading.dialect.as_deref() == Some(AUTO);
        // The machine's own dialect is kept as its file says it.
        let own = machine.controller.language.name.as_str();
        let asked = reading.dialect.as_deref();
        if let Some(dialect) = asked.filter(|dialect| !auto && *dialect != own) {
            machine.controller.language = language(dialect)?;
        }
        for folder in &reading.sub_path {
            let shown = folder.display();
            ensure!(
                folder.is_dir(),
                "--sub-path {shown}: there is no such folder"
            );
        }
        let language_of = &machine.controller.language;
        for given in &reading.given {
            let controller = &language_of.name;
            ensure!(
                auto || given.suits(language_of),
                "--set {given}: `{controller}` has no such variable"
            );
        }
        let options = Options {
            reading: Reading {
                start: start(reading.start.as_ref(), &machine)?,
                block_delete: reading
                    .block_delete
                    .map_or(BlockDelete::NONE, |given| given.0),
                tools: data_file(reading.tool_table.as_deref(), ToolTable::parse, terminal)?,
                parameters: data_file(
                    reading.parameters.as_deref(),
                    ParameterFile::parse,
                    terminal,
                )?,
                given: reading.given.clone().into(),
                probe: reading.probe.map(Into::into),
                sub_paths: reading.sub_path.clone().into(),
                limits: Limits {
                    depth: reading.max_depth,
                    repeated_moves: reading.max_moves,
                    idle_lines: reading.max_idle_lines,
                },
                shelf: None,
                text: 0,
            },
            certificate: None,
            once: reading.once,
            rapid_mark: None,
            threads: threads(reading),
            count: None,
        };
        Ok(Self {
            machine,
            options,
            auto,
        })
    }

    /// Refuses what follows several ways through a program where `what` shows one.
    pub fn one_way(&self, what: &str) -> Result<()> {
        let both = matches!(self.options.reading.probe, Some(ProbeResult::Either(_)));
        ensure!(
            !both,
            "{what} one way through a program: use --probe hit or --probe miss"
        );
        Ok(())
    }

    /// The options for a program: its own folder is the first where subprograms
    /// are looked for.
    pub fn options_for(&self, program: &Program) -> Options {
        let mut options = self.options.clone();
        let folders = program.folder().into_iter();
        let given = options.reading.sub_paths.iter().map(PathBuf::as_path);
        options.reading.sub_paths = folders.chain(given).map(Path::to_owned).collect();
        options
    }
}

/// The machine that is asked for, or the default one with a note.
pub fn machine_name(args: &MachineArgs, terminal: Terminal) -> &str {
    args.machine.as_deref().unwrap_or_else(|| {
        let name = builtin::DEFAULT_MACHINE;
        terminal.note(format_args!(
            "no machine is given: this is for the built-in {name} (see `gwatt machine list`)"
        ));
        name
    })
}

/// Loads a machine and shows what was found in its file.
pub fn load_machine(name: &str, terminal: Terminal) -> Result<Machine> {
    match Machine::load(name) {
        Ok((machine, notes)) => {
            terminal.diagnostics(name, &notes);
            Ok(machine)
        }
        Err(errors) => {
            terminal.diagnostics(name, &errors);
            bail!(Shown)
        }
    }
}

/// The machine's file, if it is not a built-in one.
pub fn machine_file(name: Option<&str>) -> Option<&Path> {
    let name = name?;
    let built_in = builtin::machines()
        .iter()
        .any(|machine| machine.name == name);
    (!built_in).then(|| Path::new(name))
}

fn language(dialect: &str) -> Result<machine::Language> {
    let controller = machine::builtin_controller(dialect).with_context(|| {
        let names: Vec<_> = builtin::controllers()
            .iter()
            .map(|controller| controller.name)
            .collect();
        format!(
            "there is no dialect {dialect}; there are {AUTO}, {}",
            names.join(", ")
        )
    })?;
    Ok(controller.language)
}

/// Reads a file of the control's data.
fn data_file<T>(
    path: Option<&Path>,
    parse: fn(&[u8]) -> Result<T, Vec<Diagnostic>>,
    terminal: Terminal,
) -> Result<Option<Arc<T>>> {
    let Some(path) = path else {
        return Ok(None);
    };
    let name = path.display();
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(DATA_BYTES_MAX + 1).read_to_end(&mut bytes))
        .with_context(|| format!("cannot read {name}"))?;
    if bytes.len() as u64 > DATA_BYTES_MAX {
        bail!("{name} is larger than a tool table or a parameter file can be");
    }
    match parse(&bytes) {
        Ok(data) => Ok(Some(Arc::new(data))),
        Err(errors) => {
            terminal.diagnostics(&name.to_string(), &errors);
            bail!(Shown)
        }
    }
}

fn start(start: Option<&StartArg>, machine: &Machine) -> Result<Start> {
    let mut at = [0.0; AXES];
    match start {
        None => {}
        Some(StartArg::Unknown) => return Ok(Start::Unknown),
        Some(StartArg::At(axes)) => {
            for &(axis, value) in axes {
                if !machine.axis_set.contains(axis as usize) {
                    let letter = axis.letter() as char;
                    bail!("--start: the machine has no axis {letter}");
                }
                at[axis as usize] = value;
            }
        }
    }
    Ok(Start::At(at))
}

/// Threads to use: as asked for, else all cores.
fn threads(reading: &ProgramArgs) -> usize {
    let cores = || thread::available_parallelism().ok();
    let threads = reading.threads.or_else(cores);
    threads.map_or(1, NonZeroUsize::get)
}

/// Shares threads among programs: how many run at once, and how many each has.
pub fn share_threads(threads: usize, programs: usize) -> (usize, usize) {
    let at_once = threads.min(programs).max(1);
    (at_once, (threads / at_once).max(1))
}
