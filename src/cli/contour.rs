//! Arguments of `contour`.

use std::path::PathBuf;

use clap::Args;

use super::{MachineArgs, ProgramArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt contour part.ngc -m mill.toml
  gwatt contour part.ngc -m mill.toml --csv errors.csv --svg errors.svg
  gwatt contour circle.ngc -m mill.toml --circles circles.svg

The machine file says how each load follows its command, [axes.X.response], and
which filter the command passes, [axes.X.correction]; gwatt identify --into and
gwatt tune --into write them.";

/// Arguments of `contour`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ContourArgs {
    /// The program, or - for standard input
    pub program: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// Write CSV here, a line for each move
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write JSON here
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Draw the path here, its errors enlarged
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Draw arcs here, their errors enlarged
    #[arg(long, value_name = "FILE")]
    pub circles: Option<PathBuf>,
    /// Period of the samples where no filter gives one
    #[arg(long, value_name = "MS", default_value_t = 1.0)]
    pub step_ms: f64,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}
