//! Arguments of `tune`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};

use super::MethodArg;

const EXAMPLES: &str = "\
Examples:
  gwatt tune x.csv y.csv                             axes by name of file or column
  gwatt tune X=run7.csv Y=run8.csv --into mill.toml  keep mill.toml.bak
  gwatt tune x.csv y.csv --html page.html            look, and change figures by hand
  gwatt tune --from changed.toml --csv biquads.csv   what the page has saved
  gwatt tune x.csv y.csv --position-gain X=40,Y=42   are the loops alike?

Columns are named as for identify. With force or torque the axes' loops count as
alike, but for --position-gain; from position_command_mm they are in the
recording.

Exit status 1: a verdict is not good, so that --into wrote nothing.";

/// Arguments of `tune`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct TuneArgs {
    /// A recording of each axis, as CSV: X=FILE, or a file named x.csv, or with
    /// columns such as `x_position_mm`
    #[arg(value_name = "[AXIS=]FILE", required_unless_present = "from")]
    pub recordings: Vec<String>,
    /// Take zeros, poles and inertias from this file, as --toml and the page
    /// write it; recordings next to it are shown
    #[arg(long, value_name = "TOML")]
    pub from: Option<PathBuf>,
    /// Sampling period of the filters [default: 1]
    #[arg(long, value_name = "MS")]
    pub period_ms: Option<f64>,
    /// How filters become digital [default: matched]
    #[arg(long, value_enum)]
    pub discretize: Option<DiscretizeArg>,
    /// Order of the low-pass [default: the least that is causal]
    #[arg(long, value_name = "N", conflicts_with = "no_low_pass")]
    pub low_pass_order: Option<usize>,
    /// Bandwidth of the low-pass [default: 3 times the highest zero, or as much lower as
    /// keeps the largest gain of the filters at 26 dB]
    #[arg(long, value_name = "HZ", conflicts_with = "no_low_pass")]
    pub low_pass_hz: Option<f64>,
    /// No low-pass: for commands without jumps of acceleration
    #[arg(long)]
    pub no_low_pass: bool,
    /// Band in which the axes are compared [default: 50]
    #[arg(long, value_name = "HZ")]
    pub band_hz: Option<f64>,
    /// Gains of the position loops in 1/s, such as X=40,Y=42
    #[arg(long, value_name = "GAINS", value_delimiter = ',')]
    pub position_gain: Vec<GainArg>,
    /// Refuse recordings whose acceleration (rms) is less; rotary: deg/s²
    #[arg(long, value_name = "ACCEL")]
    pub least_accel_mm_s2: Option<f64>,
    /// How the models are estimated [default: iv]
    #[arg(long, value_enum)]
    pub method: Option<MethodArg>,
    /// Number of poles of the models [default: searched for]
    #[arg(long)]
    pub order: Option<usize>,
    /// Take the position command as input, though a force is recorded
    #[arg(long)]
    pub from_command: bool,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the filters as CSV, a line for each section
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write parameters and filters as TOML
    #[arg(long, value_name = "FILE")]
    pub toml: Option<PathBuf>,
    /// Write a page that shows the responses, with sliders
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Put zeros and filters into this machine file if the verdict on each recording is
    /// good, and keep it as MACHINE.bak; refused where a filter takes more force than the
    /// file's force curve has
    #[arg(long, value_name = "MACHINE")]
    pub into: Option<PathBuf>,
    /// Put them there whatever the verdicts
    #[arg(long, requires = "into")]
    pub force: bool,
}

/// How a filter becomes digital.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DiscretizeArg {
    /// Zeros by second differences, the low-pass by Tustin's rule: axes with and
    /// without zeros stay alike
    Matched,
    /// Tustin's rule, pre-warped at each zero and at the low-pass
    Tustin,
    /// Zero-order hold
    Zoh,
}

/// The gain of an axis' loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GainArg {
    /// Its letter, upper case.
    pub letter: char,
    /// In 1/s.
    pub gain_1_s: f64,
}

impl FromStr for GainArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("{text} is not an axis with a gain above 0, such as X=40");
        let (axis, gain) = text.split_once('=').ok_or_else(wrong)?;
        let mut letters = axis.chars();
        let letter = letters.next().filter(|_| letters.next().is_none());
        let gain: f64 = gain.trim().parse().map_err(|_| wrong())?;
        match letter {
            Some(letter) if gain > 0.0 && gain.is_finite() => Ok(Self {
                letter: letter.to_ascii_uppercase(),
                gain_1_s: gain,
            }),
            _ => Err(wrong()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_has_a_letter() {
        let x = GainArg {
            letter: 'X',
            gain_1_s: 40.5,
        };
        assert_eq!("x=40.5".parse(), Ok(x));
        for wrong in ["", "X", "X=", "X=0", "XY=1", "=1", "X=nan", "X=inf"] {
            assert!(wrong.parse::<GainArg>().is_err(), "{wrong}");
        }
    }
}
