//! Arguments of `identify`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

const EXAMPLES: &str = "\
Examples:
  gwatt identify x.csv --axis X
  gwatt identify x.csv --axis X --friction directional --json x.json
  gwatt identify x.csv --axis X --into mill.toml       keep mill.toml.bak
  gwatt identify x.csv --axis X --into mill.toml --force   whatever the verdict
  gwatt identify x.csv --axis X --model flexible --validate x2.csv
  gwatt identify x.csv --axis X --method frequency --order 4

The header names quantities and units: time_s; force_n or torque_nm;
position_m, position_mm, position_um, position_rad, position_deg;
velocity_m_s, velocity_mm_s, velocity_mm_min, velocity_rad_s, velocity_rpm;
accel_m_s2, accel_mm_s2, accel_g, accel_rad_s2; position_command_mm; and
excitation_nm or excitation_n: what was added to excite a closed loop. An axis
letter may stand in front (x_position_mm).

What belongs to one model only implies that model: --method, --order, --zeros,
--delay-ms, --from-command and --response the flexible one.

Exit status 1: the verdict is not good, so that --into wrote nothing.";

/// Arguments of `identify`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct IdentifyArgs {
    /// The recording, as CSV; - for standard input
    pub recording: PathBuf,
    /// The axis
    #[arg(long, value_name = "LETTER")]
    pub axis: char,
    /// What the axis is taken for [default: rigid, or flexible where an option needs it]
    #[arg(long, value_enum)]
    pub model: Option<ModelArg>,
    /// Flexible: how to estimate [default: iv]
    #[arg(long, value_enum)]
    pub method: Option<MethodArg>,
    /// Flexible: number of poles [default: searched for]
    #[arg(long)]
    pub order: Option<usize>,
    /// Flexible: number of zeros [default: searched for]
    #[arg(long)]
    pub zeros: Option<usize>,
    /// Flexible: delay of the drive and the recording [default: searched for]
    #[arg(long, value_name = "MS")]
    pub delay_ms: Option<f64>,
    /// Flexible: take the position command as input, though a force is recorded
    #[arg(long)]
    pub from_command: bool,
    /// The force (or torque, or command) counts the other way than the motion
    #[arg(long)]
    pub reverse: bool,
    /// Rigid: the same friction in both directions, or of its own in each
    /// [default: symmetric]
    #[arg(long, value_enum)]
    pub friction: Option<FrictionArg>,
    /// Rigid: band of the filter [default: 30, or a tenth of the rate]
    #[arg(long, value_name = "HZ")]
    pub bandwidth_hz: Option<f64>,
    /// Lead of the screw: torque, angle or speed of the motor are referred to the slide
    #[arg(long, value_name = "MM")]
    pub lead_mm: Option<f64>,
    /// Motor revolutions per revolution of the screw
    #[arg(long, default_value_t = 1.0, requires = "lead_mm")]
    pub gear_ratio: f64,
    /// Check the result on a second recording
    #[arg(long, value_name = "CSV")]
    pub validate: Option<PathBuf>,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the result as TOML, to be put into a machine file
    #[arg(long, value_name = "FILE")]
    pub toml: Option<PathBuf>,
    /// Put the result into this machine file if the verdict is good, and keep it as
    /// MACHINE.bak
    #[arg(long, value_name = "MACHINE")]
    pub into: Option<PathBuf>,
    /// Put it there whatever the verdict
    #[arg(long, requires = "into")]
    pub force: bool,
    /// Flexible: write measured and modelled frequency response as CSV
    #[arg(long, value_name = "FILE")]
    pub response: Option<PathBuf>,
}

/// What an axis is taken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModelArg {
    /// Mass and friction
    Rigid,
    /// Resonances and anti-resonances
    Flexible,
}

/// Friction of a rigid axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FrictionArg {
    /// The same in both directions
    Symmetric,
    /// Of its own in each direction
    Directional,
}

/// How a flexible axis is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MethodArg {
    /// Instrumental variables: noise does not bend the result
    Iv,
    /// Plain least squares: for recordings without noise
    Arx,
    /// Least squares through the averaged frequency response: for excitation that
    /// repeats itself, three times or more
    Frequency,
    /// Subspaces (MOESP)
    Subspace,
}
