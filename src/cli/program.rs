//! Options of every command that reads programs.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::NonEmptyStringValueParser;
use clap::{Args, ValueEnum};
use gwatt::interpret::{BlockDelete, GivenVariable, ProbeResult, ProbeWay};
use gwatt::machine::AxisId;

/// What probes find.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ProbeArg {
    Hit,
    Miss,
    Both,
}

impl From<ProbeArg> for ProbeResult {
    fn from(given: ProbeArg) -> Self {
        match given {
            ProbeArg::Hit => Self::Hit,
            ProbeArg::Miss => Self::Miss,
            ProbeArg::Both => Self::Either(ProbeWay::default()),
        }
    }
}

/// How programs are read.
#[derive(Debug, Clone, Args)]
pub struct ProgramArgs {
    /// Read programs as this controller does, instead of the machine's own; `auto`: as
    /// the one that marks in the text speak for (see `gwatt dialect`)
    #[arg(long, value_name = "CONTROLLER", help_heading = "Program")]
    pub dialect: Option<String>,
    /// Tools of the machine, as LinuxCNC writes them (T P D Z X I J Q in a line
    /// each); without it every tool length is 0
    #[arg(long, value_name = "FILE", help_heading = "Program")]
    pub tool_table: Option<PathBuf>,
    /// Parameters that the control has kept, as LinuxCNC writes them (number
    /// and value in a line each): variables, work offsets, G92, points of G28 and G30
    #[arg(long, value_name = "FILE", help_heading = "Program")]
    pub parameters: Option<PathBuf>,
    /// A variable that the control has kept, and its value: such as '#500=1.5',
    /// '#<_depth>=2', R1=3 or VC1=4; may be given many times
    #[arg(long = "set", value_name = "NAME=VALUE", help_heading = "Program")]
    pub given: Vec<GivenVariable>,
    /// What probes find: `hit`, they touch somewhere on their way, `miss`, they reach
    /// their targets, or `both`: each way is followed and the worst counts; without it, what
    /// depends on a probe is refused
    #[arg(long, value_name = "RESULT", help_heading = "Program")]
    pub probe: Option<ProbeArg>,
    /// Pass over blocks that begin with `/`; with levels only those, as in
    /// --block-delete=1,3 for `/`, `/1` and `/3`
    #[arg(
        long,
        value_name = "LEVELS",
        help_heading = "Program",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "all"
    )]
    pub block_delete: Option<DeleteLevels>,
    /// Where the axes stand at the beginning: such as X0,Y0,Z100, or `unknown`
    /// [default: 0]
    #[arg(
        long,
        value_name = "POSITION",
        help_heading = "Program",
        allow_hyphen_values = true
    )]
    pub start: Option<StartArg>,
    /// Folder where subprograms are looked for, after the program's own
    #[arg(long, value_name = "DIR", help_heading = "Program")]
    pub sub_path: Vec<PathBuf>,
    /// The program runs once; limits over time need not allow an immediate repeat
    #[arg(long, help_heading = "Program")]
    pub once: bool,
    /// Most moves that loops and calls may make
    #[arg(
        long,
        value_name = "N",
        help_heading = "Program",
        default_value_t = 10_000_000
    )]
    pub max_moves: u64,
    /// Lines in a row that may be executed without moving an axis
    #[arg(
        long,
        value_name = "N",
        help_heading = "Program",
        default_value_t = 1_000_000
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
#[derive(Debug, Clone, Args)]
pub struct MachineArgs {
    /// Machine file, or the name of a built-in machine [default: `machine` in the file
    /// gwatt.toml next to the programs]
    #[arg(
        short,
        long,
        value_name = "MACHINE",
        env = "GWATT_MACHINE",
        hide_env_values = true,
        value_parser = NonEmptyStringValueParser::new()
    )]
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

/// Levels of block delete as they are given.
#[derive(Debug, Clone, Copy)]
pub struct DeleteLevels(pub BlockDelete);

impl FromStr for DeleteLevels {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "all" {
            return Ok(Self(BlockDelete::ALL));
        }
        let mut levels = BlockDelete::NONE;
        for level in text.split(',') {
            match level.trim().parse() {
                Ok(level @ 1..=9) => levels = levels.with(level),
                _ => return Err(format!("`{level}` is no level from 1 to 9")),
            }
        }
        Ok(Self(levels))
    }
}
