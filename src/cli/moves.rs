//! Arguments of `moves`.

use std::path::PathBuf;

use clap::Args;

use super::{MachineArgs, ProgramArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt moves part.ngc -m vmc
  gwatt moves part.ngc -m vmc | jq 'select(.kind == \"arc\")'

Positions are machine coordinates in mm or degrees. `turns` of an arc is positive
counter-clockwise, from the first letter of `plane` to the second.";

/// Arguments of `moves`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct MovesArgs {
    /// The program, or - for standard input
    pub program: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}
