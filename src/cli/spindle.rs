//! Arguments of `spindle`.

use std::path::PathBuf;

use clap::Args;

use super::MachineArgs;

const EXAMPLES: &str = "\
Examples:
  gwatt spindle speeds.csv -m vmc -o run.csv --svg run.svg
  printf '0,3000\\n2,-3000\\n' | gwatt spindle - -m vmc --period-ms 4

The schedule is CSV with the columns time_s and target_rpm and, where a row has
limits of its own, accel_rpm_s, jerk_rpm_s2, power_w and period_ms. A limit holds
until the next row; a period stays.

The run starts at rest with the first row and ends at the last target. Every
row of the result is the end of a period; jerk is its mean over the period.";

/// Arguments of `spindle`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct SpindleArgs {
    /// The schedule, or - for standard input
    pub schedule: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// Interpolation period in ms
    #[arg(long, value_name = "MS", default_value_t = 1.0, value_parser = period_ms)]
    pub period_ms: f64,
    /// Write the run as CSV here [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Draw the run here
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
}

pub(super) fn period_ms(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(ms) if (1e-3..=1e5).contains(&ms) => Ok(ms),
        _ => Err("a number from 0.001 to 100000 is needed".into()),
    }
}
