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
  gwatt check programs/ -m mill.toml --write-baseline known.json
  gwatt check programs/ -m mill.toml --baseline known.json   new findings alone fail
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
    /// Where the pages of docs/rules can be read, for the links of --format sarif: such as
    /// <https://example.org/gwatt/rules>
    #[arg(long, value_name = "URL")]
    pub rules_url: Option<String>,
    /// Show only programs that do not fit or are not read, and the totals
    #[arg(short, long)]
    pub quiet: bool,
    /// Findings that are known, of an earlier --write-baseline: they do not fail the run; new
    /// ones, and those that have grown, do
    #[arg(long, value_name = "FILE", help_heading = "Known findings")]
    pub baseline: Option<PathBuf>,
    /// Findings are known too whose own line has a comment such as (gwatt: known peak-power
    /// 6002 W of 3600 W), until they grow
    #[arg(
        long,
        conflicts_with = "write_baseline",
        help_heading = "Known findings"
    )]
    pub known_comments: bool,
    /// Write what does not fit here, as a baseline for later runs, and exit with 0
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "baseline",
        help_heading = "Known findings"
    )]
    pub write_baseline: Option<PathBuf>,
    /// Write a page with power and bus voltage over time, the path and the worst blocks of
    /// one program here
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
    /// SARIF 2.1.0, for code scanning, with what makes a program fit
    Sarif,
    /// XML as `JUnit` writes it, one test case a program with the time that it runs
    Junit,
    /// Annotations of a GitHub workflow
    Github,
}
