//! The command line: types only.

mod check;
mod contour;
mod dialect;
mod diff;
mod excite;
mod explain;
mod identify;
mod limit;
mod machine;
mod machine_new;
mod moves;
mod override_arg;
mod plan;
mod power_fit;
mod program;
mod programs;
mod progress_arg;
mod report;
mod size;
mod spindle;
mod tune;
mod verify;
mod watch;

use clap::{ColorChoice, Parser, Subcommand};
use clap_complete::Shell;

pub use check::{CheckArgs, Format};
pub use contour::ContourArgs;
pub use dialect::DialectArgs;
pub use diff::DiffArgs;
pub use excite::{ExciteArgs, ShapeArg, ValueName};
pub use explain::ExplainArgs;
pub use identify::{FrictionArg, IdentifyArgs, MethodArg, ModelArg};
pub use limit::{Allow, Certificate, HowArgs, Law, LimitArgs, Strategy, allowed};
pub use machine::{ImportArgs, MachineCommand};
pub use machine_new::{Kind, NewArgs};
pub use moves::MovesArgs;
pub use override_arg::OverrideArg;
pub use plan::PlanArgs;
pub use power_fit::PowerFitArgs;
pub use program::{DeleteLevels, MachineArgs, ProgramArgs, StartArg};
pub use programs::{ProgramsArgs, Shard};
pub use progress_arg::ProgressArg;
pub use report::ReportArgs;
pub use size::SizeArgs;
pub use spindle::SpindleArgs;
pub use tune::{DiscretizeArg, TuneArgs};
pub use verify::VerifyArgs;
pub use watch::WatchArgs;

const EXAMPLES: &str = "\
Examples:
  gwatt check part.ngc -m vmc             does it fit?
  gwatt limit part.ngc -m vmc -o fit.ngc  write a program that fits
  gwatt report part.ngc -m mill.toml      what each move draws, as CSV
  gwatt machine list                      machines and controllers that are built in

Exit status:
  0  fits
  1  does not fit
  2  bad input, machine file or usage, or output that cannot be written
  3  internal error

gwatt works with a model. It protects nothing: the drives' own limits stay on.";

/// Rewrites CNC part programs so that the axes never draw more than the supply that they share
/// delivers.
#[derive(Debug, Parser)]
#[command(name = "gwatt", version, after_help = EXAMPLES, arg_required_else_help = true)]
pub struct Cli {
    /// When to use colours; `NO_COLOR` is respected
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t = ColorChoice::Auto)]
    pub color: ColorChoice,
    /// How to show the progress of long work; `-q` shows none
    #[arg(long, global = true, value_enum, value_name = "HOW", default_value_t = ProgressArg::Auto)]
    pub progress: ProgressArg,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a program that fits, with as few edits as possible
    Limit(LimitArgs),
    /// Limit the programs that appear in a folder into another one
    Watch(WatchArgs),
    /// Check whether programs fit
    Check(CheckArgs),
    /// Show what each move of a program draws
    Report(ReportArgs),
    /// Show which controllers programs are for
    Dialect(DialectArgs),
    /// Compare two machines over programs
    Diff(DiffArgs),
    /// Show how large the converter must be
    Size(SizeArgs),
    /// Print every move of a program as JSON, one a line
    Moves(MovesArgs),
    /// Plan a spindle's speed period by period, and what it draws
    Spindle(SpindleArgs),
    /// Plan axes and spindle together on one supply, period by period
    Plan(PlanArgs),
    /// List, show, check and import machine descriptions
    Machine {
        /// What to do with them.
        #[command(subcommand)]
        command: MachineCommand,
    },
    /// Make a signal that excites an axis
    Excite(ExciteArgs),
    /// Find mass, friction and resonances of an axis in a recording
    Identify(IdentifyArgs),
    /// Make filters that let several axes answer alike
    Tune(TuneArgs),
    /// Show how far the load is from the programmed path
    Contour(ContourArgs),
    /// Fit the power model of an axis to a log of the drive's power
    PowerFit(PowerFitArgs),
    /// Lay a recording of the power over the prediction of a program
    Verify(VerifyArgs),
    /// Explain the rule that a message names
    Explain(ExplainArgs),
    /// Print a completion script for a shell
    #[command(
        after_help = "Example:\n  gwatt completions bash > ~/.local/share/bash-completion/completions/gwatt"
    )]
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Print the manual page
    #[command(after_help = "Example:\n  gwatt man > gwatt.1 && man ./gwatt.1")]
    Man,
}
