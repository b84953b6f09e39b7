//! Options of every command that reads programs.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use gwatt::machine::AxisId;

/// How programs are read.
#[derive(Debug, Args)]
pub struct ProgramArgs {
    /// Read programs as this controller does, instead of the machine's own
    #[arg(long, value_name = "CONTROLLER", help_heading = "Program")]
    pub dialect: Option<String>,
    /// Pass over blocks that begin with `/`
    #[arg(long, help_heading = "Program")]
    pub block_delete: bool,
    /// Where the axes stand at the beginning: such as X0,Y0,Z100, or `unknown`
    /// [default: 0]
    #[arg(
        long,
        value_name = "POSITION",
        help_heading = "Program",
        allow_hyphen_values = true
    )]
    pub start: Option<StartArg>,
    /// Folder where subprograms are looked for, behind the program's own
    #[arg(long, value_name = "DIR", help_heading = "Program")]
    pub sub_path: Vec<PathBuf>,
    /// Moves that loops and calls may repeat
    #[arg(
        long,
        value_name = "N",
        help_heading = "Program",
        default_value_t = 10_000_000
    )]
    pub max_moves: u64,
    /// Lines in a row that may be executed without a move
    #[arg(
        long,
        value_name = "N",
        help_heading = "Program",
        default_value_t = 10_000_000
    )]
    pub max_idle_lines: u64,
    /// Calls inside one another
    #[arg(
        long,
        value_name = "N",
        help_heading = "Program",
        default_value_t = 100
    )]
    pub max_depth: usize,
    /// How many threads to use [default: all cores]
    #[arg(long, value_name = "N", help_heading = "Program")]
    pub threads: Option<NonZeroUsize>,
}

/// The machine.
#[derive(Debug, Args)]
pub struct MachineArgs {
    /// Machine file, or the name of a built-in machine
    #[arg(short, long, value_name = "MACHINE")]
    pub machine: Option<String>,
}

/// A start position, as far as it is given.
#[derive(Debug, Clone, PartialEq)]
pub enum StartArg {
    /// These axes here, all others at 0.
    At(Vec<(AxisId, f64)>),
    /// Nowhere known.
    Unknown,
}

impl FromStr for StartArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("unknown") {
            return Ok(Self::Unknown);
        }
        let mut axes: Vec<(AxisId, f64)> = Vec::new();
        for item in text.split([',', ' ']).filter(|item| !item.is_empty()) {
            let (axis, value) = coordinate(item)
                .ok_or_else(|| format!("{item} is not an axis with its position, such as X0"))?;
            if axes.iter().any(|(given, _)| *given == axis) {
                return Err(format!("{} is given twice", axis.letter() as char));
            }
            axes.push((axis, value));
        }
        if axes.is_empty() {
            return Err("no axis is given".into());
        }
        Ok(Self::At(axes))
    }
}

/// A letter and a finite number.
fn coordinate(item: &str) -> Option<(AxisId, f64)> {
    let letter = item.bytes().next()?.to_ascii_uppercase();
    let axis = AxisId::from_letter(letter)?;
    let value: f64 = item.get(1..)?.trim_start_matches('=').parse().ok()?;
    value.is_finite().then_some((axis, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_is_letters_with_numbers() {
        assert_eq!(
            "X0,z-1.5".parse(),
            Ok(StartArg::At(vec![(AxisId::X, 0.0), (AxisId::Z, -1.5)]))
        );
        assert_eq!("unknown".parse(), Ok(StartArg::Unknown));
        for wrong in ["", ",", "X", "Q1", "Xnan", "Xinf", "X1X2", "X1,X2", "é1"] {
            assert!(wrong.parse::<StartArg>().is_err(), "{wrong}");
        }
    }
}
