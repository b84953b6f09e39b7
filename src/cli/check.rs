//! Arguments of `check`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{MachineArgs, OverrideArg, ProgramArgs, ProgramsArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt check part.ngc -m vmc
  gwatt check programs/ -m mill.toml -q      all below a folder, what does not fit
  gwatt check part.ngc -m vmc --html part.html
  gwatt check programs/ -m mill.toml --format sarif > gwatt.sarif
  git diff -z --name-only main | gwatt check -m mill.toml --files-from -";

/// Arguments of `check`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct CheckArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub programs: ProgramsArgs,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// How to print the results
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// Show only programs that do not fit or are not read, and the totals
    #[arg(short, long)]
    pub quiet: bool,
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
    /// One object a program, each in its line as soon as it is known, with the energy
    Jsonl,
    /// SARIF 2.1.0, for code scanning
    Sarif,
    /// XML as `JUnit` writes it, one test case a program
    Junit,
    /// Annotations of a GitHub workflow
    Github,
}
