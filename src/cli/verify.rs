//! Arguments of `verify`.

use std::path::PathBuf;

use clap::Args;

use super::{MachineArgs, ProgramArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt verify part.ngc power.csv -m mill.toml
  gwatt verify part.ngc power.csv -m mill.toml --html overlay.html --csv blocks.csv
  gwatt verify part.ngc power.csv -m mill.toml --into mill.toml    keep mill.toml.bak
  gwatt verify part.ngc meter.txt -m mill.toml --map power=P*1kW --map time=#1*1ms

Columns: time_s (or _ms) and power_w (or _kw); several by axis (x_power_w) are
added up where there is none of all. What is fed back counts negative, where the meter shows it. Record at
100 % override, from before the program begins until it has ended.

The margin that --into writes covers the largest peak by which the log exceeds the
prediction; how much others may need is said too. With powers by axis it writes
servo_factor_motor of each axis, and the margin that is missing beyond these.

Exit status 1: the verdict is not good, or peaks exceed their prediction by more
than the machine file covers.";

/// Arguments of `verify`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct VerifyArgs {
    /// The program
    #[arg(value_name = "PROGRAM")]
    pub program: PathBuf,
    /// The power that the machine drew while this program ran, as CSV; - for standard input
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// What a column of another name or unit holds: QUANTITY=COLUMN*FACTOR and a unit; may be
    /// given many times
    #[arg(long, value_name = "COLUMN")]
    pub map: Vec<String>,
    /// Write the largest powers of each block as CSV
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Draw both curves over each other here
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write a page with both curves, the verdict and the blocks; one file, no network
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Raise the margin, and servo factors of axes, in this machine file to what was found if the verdict is good, and
    /// keep it as MACHINE.bak
    #[arg(long, value_name = "MACHINE")]
    pub into: Option<PathBuf>,
    /// Do so whatever the verdict
    #[arg(long, requires = "into")]
    pub force: bool,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}
