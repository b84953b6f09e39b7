//! Arguments of `dialect`.

use clap::Args;

use super::{ProgramArgs, ProgramsArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt dialect part.nc
  gwatt dialect programs/ -m vmc
  gwatt check part.nc -m vmc --dialect auto

Exit status: 2 where a file is known to be in a language that no profile reads, is no text, has
no program in it or cannot be read; else 0, also where no mark of a controller is seen.";

/// Arguments of `dialect`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct DialectArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub programs: ProgramsArgs,
    /// Try to read each program on this machine too, as the profiles that are found
    #[arg(short, long, value_name = "MACHINE")]
    pub machine: Option<String>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}
