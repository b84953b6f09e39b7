//! Arguments of `size`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use super::{Allow, Certificate, Law, MachineArgs, ProgramArgs, ProgramsArgs, Strategy};

const EXAMPLES: &str = "\
Examples:
  gwatt size part.ngc -m vmc
  gwatt size programs/*.ngc -m mill.toml --allow feed --loss 1%
  gwatt size part.ngc -m mill.toml --csv sizes.csv --svg sizes.svg

Every time is that of a program that `limit` writes with the same options for a
machine with that converter. Continuous power and overloads grow and shrink with the
peak power, as within a series of converters; all else stays as the machine file has
it. Where that limits the voltage of the DC bus, a second table has the capacitance.

Exits with 1 if a program fits with no converter.";

/// Largest number of steps.
const STEPS_MAX: usize = 1000;
/// Percent above which a loss is a slip of the pen.
const LOSS_MAX: f64 = 1e6;

/// Arguments of `size`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct SizeArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub programs: ProgramsArgs,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// Find the smallest converter with which no more time than this is lost: such as
    /// 1%, or 1%,5%
    #[arg(long = "loss", value_name = "PERCENT", value_delimiter = ',')]
    pub losses: Vec<LossArg>,
    /// Stop where a program takes this much longer: with little power left the search is slow
    /// under look-ahead
    #[arg(long, value_name = "PERCENT", default_value = "100%")]
    pub until: LossArg,
    /// Steps between the smallest converter that is enough and the smallest that slows
    /// nothing
    #[arg(long, value_name = "COUNT", default_value_t = 20, value_parser = steps)]
    pub steps: usize,
    /// Which converter, where the machine has several
    #[arg(long, value_name = "NAME")]
    pub converter: Option<String>,
    /// Share of its peak power that the converter takes back, such as 0.5
    /// [default: `regen_power_w` of the machine file]
    #[arg(long, value_name = "RATIO", value_parser = ratio)]
    pub regen_ratio: Option<f64>,
    /// Write the figures of each program as CSV
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write the same as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Draw the loss of time over the converter's peak power
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// What to lower
    #[arg(long, value_enum, default_value_t = Strategy::Optimal)]
    pub strategy: Strategy,
    /// How far to lower it
    #[arg(long, value_enum, default_value_t = Law::Exact)]
    pub law: Law,
    /// What may be changed besides rapids and their accelerations; several with commas
    #[arg(long, value_enum, value_name = "WHAT", value_delimiter = ',')]
    pub allow: Vec<Allow>,
    /// Which certificate is asked for [default: the best the controller allows]
    #[arg(long, value_enum)]
    pub certificate: Option<Certificate>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}

/// A loss of time as a share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossArg(pub f64);

impl FromStr for LossArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = text.trim().trim_end_matches('%').trim_end();
        match number.parse::<f64>() {
            Ok(percent) if (0.0..=LOSS_MAX).contains(&percent) => Ok(Self(percent / 100.0)),
            _ => Err(format!(
                "`{text}` is no loss of time; a number of percent from 0 up is needed"
            )),
        }
    }
}

fn steps(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(count) if (2..=STEPS_MAX).contains(&count) => Ok(count),
        _ => Err(format!("a number from 2 to {STEPS_MAX} is needed")),
    }
}

fn ratio(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(ratio) if ratio > 0.0 && ratio <= 10.0 => Ok(ratio),
        _ => Err("a number above 0 and up to 10 is needed".to_owned()),
    }
}
