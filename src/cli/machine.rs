//! Arguments of `machine`.

use clap::Subcommand;

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
    /// Check a machine file and say what its axes come to
    #[command(after_help = "Example:\n  gwatt machine check mill.toml")]
    Check {
        /// The file, or the name of a built-in machine.
        file: String,
    },
    /// Print the JSON Schema of machine files, for editors
    #[command(after_help = "Example:\n  gwatt machine schema > gwatt-machine.schema.json")]
    Schema,
}
