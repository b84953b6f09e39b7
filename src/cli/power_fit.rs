//! Arguments of `power-fit`.

use std::path::PathBuf;

use clap::Args;

const EXAMPLES: &str = "\
Examples:
  gwatt power-fit log.csv --axis X
  gwatt power-fit run*.csv --axis X --json x.json
  gwatt power-fit log.csv --axis X --into mill.toml    keep mill.toml.bak

Columns: velocity_mm_s (or _m_s, _mm_min, _rad_s, _rpm), accel_mm_s2 (or _m_s2,
_rad_s2) and power_w (or _kw), with or without the axis letter in front
(x_power_w); or X1_ActualVelocity, X1_ActualAcceleration, X1_OutputPower in
mm, s and kW. Rows without values are passed over.

The margin covers 95 % of the peaks with 95 % confidence: each log is predicted by
the others, parts of one log by the rest of it.

Exit status 1: the verdict is not good, so that --into wrote nothing.";

/// Arguments of `power-fit`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct PowerFitArgs {
    /// Logs of speed, acceleration and the drive's power, as CSV; all are fitted
    /// together
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// The axis
    #[arg(long, value_name = "LETTER", default_value_t = 'X')]
    pub axis: char,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Put the result and the margin into this machine file if the verdict is good,
    /// and keep it as MACHINE.bak
    #[arg(long, value_name = "MACHINE")]
    pub into: Option<PathBuf>,
    /// Put it there whatever the verdict
    #[arg(long, requires = "into")]
    pub force: bool,
}
