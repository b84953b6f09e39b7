//! Arguments of `report`.

use std::path::PathBuf;

use clap::Args;

use super::{MachineArgs, ProgramArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt report part.ngc -m vmc > moves.csv
  gwatt report part.ngc -m vmc --csv moves.csv --json moves.json --fail";

/// Arguments of `report`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ReportArgs {
    /// The program, or - for standard input
    pub program: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// Write CSV here [default: standard output, if no file is given]
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write JSON here
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Exit with 1 if a move does not fit
    #[arg(long)]
    pub fail: bool,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}
