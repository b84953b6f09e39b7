//! Arguments of `check`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{MachineArgs, OverrideArg, ProgramArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt check part.ngc -m vmc
  gwatt check programs/*.ngc -m mill.toml
  gwatt check part.ngc -m vmc --html part.html
  gwatt check programs/*.ngc -m mill.toml --format sarif > gwatt.sarif";

/// Arguments of `check`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct CheckArgs {
    /// The programs; - for standard input
    #[arg(required = true, value_name = "PROGRAM")]
    pub programs: Vec<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// How to print the results
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Write a page with the power over time, the path and the worst blocks of one program
    /// here
    #[arg(long, value_name = "PAGE", conflicts_with = "overrides")]
    pub html: Option<PathBuf>,
    /// Judge at these overrides alone: such as 70%, or feed=70%,rapid=50%; a plain
    /// value is that of feeds and, up to 100 %, of rapids
    /// [default: all from 0 to the machine's largest]
    #[arg(long = "override", value_name = "PERCENT")]
    pub overrides: Option<OverrideArg>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}

/// How results are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people
    Text,
    /// An array with one object a program
    Json,
    /// SARIF 2.1.0, for code scanning
    Sarif,
    /// XML as `JUnit` writes it, one test case a program
    Junit,
    /// Annotations of a GitHub workflow
    Github,
}
