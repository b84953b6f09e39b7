//! Arguments of `report`.

use std::path::PathBuf;

use clap::Args;

use super::{Allow, MachineArgs, OverrideArg, ProgramArgs, ProgramsArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt report part.ngc -m vmc > moves.csv
  gwatt report part.ngc -m vmc --csv moves.csv --json moves.json --fail
  gwatt report part.ngc -m vmc --series series.csv --step-ms 2
  gwatt report part.ngc -m vmc --html part.html
  gwatt report programs/ -m vmc -o reports

A series has a row every --step-ms and at every instant at which an acceleration
changes; where something jumps, two rows with the same time. First the program
as it is, then as `gwatt limit` writes it: `before` and `after` in the column
`program`. It shows the motion as planned at 100 % override, without servo
factors, and the spindle where the machine has one: its drive's base load is in
spindle_power_w, cutting in cutting_power_w. Axes stand while they wait for the
spindle; stops of unknown length take no time. bus_w is what the converters
deliver, regen_w what is fed back. Where the machine file limits the voltage of the
bus, bus_low_v and bus_high_v are the lowest and the highest that it may have then.
With --limited the program in that file is shown as `after`.";

/// Arguments of `report`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct ReportArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub programs: ProgramsArgs,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// Write CSV here [default: standard output, if no file is given]; of several programs
    /// this and the next three name folders
    #[arg(short = 'o', long, visible_alias = "output", value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write JSON here
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write a page with power and bus voltage over time, the path and the worst blocks here
    #[arg(long, value_name = "PAGE", conflicts_with = "overrides")]
    pub html: Option<PathBuf>,
    /// Draw power and bus voltage over time here
    #[arg(long, value_name = "FILE", conflicts_with = "overrides")]
    pub svg: Option<PathBuf>,
    /// Write speed, acceleration, force and power of axes and spindle over time
    /// here, as CSV
    #[arg(long, value_name = "CSV")]
    pub series: Option<PathBuf>,
    /// Step of the series in ms
    #[arg(long, value_name = "MS", default_value_t = 1.0, value_parser = step_ms, requires = "series")]
    pub step_ms: f64,
    /// The program after limiting, for the series [default: it is limited now]
    #[arg(long, value_name = "FILE", requires = "series")]
    pub limited: Option<PathBuf>,
    /// What `limit` may change for the series, as its own --allow: feed, or feed,expand
    #[arg(
        long,
        value_enum,
        value_name = "WHAT",
        value_delimiter = ',',
        requires = "series"
    )]
    pub allow: Vec<Allow>,
    /// Show only programs that do not fit or are not read, and the totals
    #[arg(short, long)]
    pub quiet: bool,
    /// Exit with 1 if a move does not fit
    #[arg(long)]
    pub fail: bool,
    /// Show these overrides alone, as in `gwatt check`
    #[arg(long = "override", value_name = "PERCENT", conflicts_with = "series")]
    pub overrides: Option<OverrideArg>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}

fn step_ms(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(ms) if (1e-3..=1e6).contains(&ms) => Ok(ms),
        _ => Err("a number from 0.001 to 1000000 is needed".into()),
    }
}
