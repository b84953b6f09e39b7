//! Arguments of `machine`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use gwatt::import::FORMATS;

use super::machine_new::{NEW, NewArgs};

/// What to do with machine descriptions.
#[derive(Debug, Subcommand)]
pub enum MachineCommand {
    /// List the machines and controller profiles that are built in
    #[command(after_help = "Example:\n  gwatt machine list")]
    List,
    /// Print a built-in machine or controller profile, to start a file of one's own from
    #[command(after_help = "Example:\n  gwatt machine show vmc > mill.toml")]
    Show {
        /// Its name.
        name: String,
    },
    /// List the motors of which a document is at hand: rotor inertia, torque and speed, for
    /// `machine new`
    #[command(after_help = "Example:\n  gwatt machine motors")]
    Motors,
    /// Check a machine file and say what its axes come to
    #[command(after_help = "Example:\n  gwatt machine check mill.toml")]
    Check {
        /// The file, or the name of a built-in machine.
        file: String,
    },
    /// Make a machine file of what you know of the machine: it asks, or takes options
    #[command(after_help = NEW)]
    New(NewArgs),
    /// Make a machine file of the settings that a control has already
    #[command(after_help = IMPORT)]
    Import(ImportArgs),
    /// Print the JSON Schema of machine files, for editors
    #[command(after_help = "Example:\n  gwatt machine schema > gwatt-machine.schema.json")]
    Schema,
}

const IMPORT: &str = "\
Reads LinuxCNC's INI file (with its HAL files), what grbl and grblHAL print for $$, FluidNC's
config.yaml, Marlin's M503 and Configuration.h, Klipper's printer.cfg (with its includes),
config.g of RepRapFirmware, parameter files of Fanuc, and machine data of SINUMERIK. Every
value has its source next to it. Masses, friction and the power of the supply, which no
control knows, are asked for in the file; `gwatt machine check` names what is missing.

Examples:
  gwatt machine import printer.cfg -o printer.toml
  gwatt machine import Configuration.h Configuration_adv.h -o printer.toml
  gwatt machine import CNCPARAM.TXT -c haas -o mill.toml";

/// Arguments of `machine import`.
#[derive(Debug, Args)]
pub struct ImportArgs {
    /// The files, read as one; `-` is standard input
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where the machine file goes; default: standard output
    #[arg(short, long, value_name = "TOML")]
    pub output: Option<PathBuf>,
    /// What the files are; default: as their lines say
    #[arg(long, value_parser = formats(), value_name = "FORMAT")]
    pub format: Option<String>,
    /// The controller profile; default: that of the format
    #[arg(short, long, value_name = "NAME")]
    pub controller: Option<String>,
}

/// Names of formats.
fn formats() -> clap::builder::PossibleValuesParser {
    FORMATS.map(|(_, name)| name).into()
}
