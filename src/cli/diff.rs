//! Arguments of `diff`.

use std::path::PathBuf;

use clap::Args;

use super::{ProgramArgs, ProgramsArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt diff programs/*.ngc --from mill.toml --to mill-new.toml
  gwatt diff part.ngc --from three-axis --to vmc --csv diff.csv
  gwatt diff part.ngc --from mill.toml --to mill-new.toml --html diff.html

Exits with 1 if a move that fits on --from does not fit on --to.";

/// Arguments of `diff`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct DiffArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub programs: ProgramsArgs,
    /// The machine to compare with: a file, or the name of a built-in one
    #[arg(long, value_name = "MACHINE")]
    pub from: String,
    /// The machine to compare
    #[arg(long, value_name = "MACHINE")]
    pub to: String,
    /// Write the comparison as CSV
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write a page that lays both machines over each other here: the power over time, the path,
    /// and what begins or ceases to fit
    #[arg(long, value_name = "PAGE")]
    pub html: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}
