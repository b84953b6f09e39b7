//! Arguments of `identify`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

const EXAMPLES: &str = "\
Examples:
  gwatt identify x.csv --axis X
  gwatt identify x.csv --axis X --friction directional --json x.json
  gwatt identify up.csv down.csv run3.csv --axis X     several recordings at once
  gwatt identify x.csv --axis X --into mill.toml       keep mill.toml.bak
  gwatt identify x.csv --axis X --into mill.toml --force   whatever the verdict
  gwatt identify x.csv --axis X --model flexible --validate x2.csv
  gwatt identify x.csv --axis X --method frequency --order 4
  gwatt identify x.csv --axis X --html x.html          look at what was found
  gwatt identify log.txt --preset halscope --axis X --map torque=iq*0.58Nm/A

The header names quantities and units: time_s; force_n or torque_nm;
position_m, position_mm, position_um, position_rad, position_deg;
velocity_m_s, velocity_mm_s, velocity_mm_min, velocity_rad_s, velocity_rpm;
accel_m_s2, accel_mm_s2, accel_g, accel_rad_s2; position_command_mm; and
excitation_nm or excitation_n: what was added to excite a closed loop. An axis
letter may stand in front (x_position_mm), and units in brackets after it (Position
[mm]) or on a line of their own. Columns are separated by commas, semicolons or
tabs. Whatever has another name or unit, --map gives:
  --map torque=Iq*0.58Nm/A          a current times the torque constant
  --map \"torque=Trq*0.0239Nm/%\"    percent of a rated torque of 2.39 Nm
  --map position=Enc*0.000045mm     counts of an encoder
  --map time=#1*1ms                 the first column, in milliseconds

What belongs to one model only implies that model: --method, --order, --zeros,
--delay-ms, --from-command and --response the flexible one.

Exit status 1: the verdict is not good, so that --into wrote nothing.";

/// Arguments of `identify`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct IdentifyArgs {
    /// The recording, as CSV; - for standard input. Several of the same axis are
    /// joined (rigid model)
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
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
    /// What a column holds: QUANTITY=COLUMN*FACTOR and a unit, such as
    /// torque=Iq*0.58Nm/A or time=#1*1ms
    #[arg(long, value_name = "COLUMN")]
    pub map: Vec<String>,
    /// The program that wrote the recordings, in its own layout: where names, units and
    /// times are
    #[arg(long, value_enum)]
    pub preset: Option<PresetArg>,
    /// Samples a second, for recordings without times
    #[arg(long, value_name = "HZ")]
    pub rate_hz: Option<f64>,
    /// The force (or torque, or command) counts the other way than the motion
    #[arg(long)]
    pub reverse: bool,
    /// Rigid: the same friction in both directions, or of its own in each
    /// [default: what the data support]
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
    /// Write a page with the measured response, the model over it, and what it leaves
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
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

/// Programs whose layouts are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PresetArg {
    /// `LinuxCNC`: the log of Halscope
    Halscope,
    /// Beckhoff: `TwinCAT` Scope, exported as CSV
    TwincatScope,
    /// Siemens: a trace of SINUMERIK Operate, as XML
    Sinumerik,
    /// Klipper: raw data of an accelerometer
    Klipper,
}

impl PresetArg {
    /// The name in the library.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Halscope => "halscope",
            Self::TwincatScope => "twincat-scope",
            Self::Sinumerik => "sinumerik",
            Self::Klipper => "klipper",
        }
    }
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
    /// repeats itself, three times or more; else without standard errors
    Frequency,
    /// Subspaces (MOESP)
    Subspace,
}
