//! Arguments of `excite`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

const EXAMPLES: &str = "\
Examples:
  gwatt excite --order 12 --amplitude 5 > torque.csv
  gwatt excite --resolution-hz 0.5 --hold 2 --amplitude 5 --repeat 3 -o torque.csv
  gwatt excite --shape random --from-hz 1 --to-hz 45 --seconds 16 --amplitude 5 > near-40-hz.csv
  gwatt excite --shape log-sweep --from-hz 1 --to-hz 200 --seconds 20 --amplitude 3 -o sweep.csv
  gwatt excite --amplitude 50 --name force_n --mass-kg 90 --stroke-mm 100 --speed-mm-min 6000 -o f.csv
  gwatt excite --for first.csv --amplitude 5 --seconds 16 -o torque.csv
  gwatt excite --for first.csv --amplitude 5 --stroke-deg 90 --speed-rpm 200 -o torque.csv
  gwatt excite --machine mill.toml --axis X --stroke-mm 100 -o force.csv

Writes two columns, time_s and the value. What the signal covers goes to
standard error, with a warning where the axis would leave its stroke or speed.

With --for or --machine the signal is designed: several are compared, each as large
as amplitude, stroke and speed allow, and the one with the smallest standard errors
is written. These are shown before anything is recorded. Record some seconds with
`gwatt excite --amplitude …` first, give that recording with --for, and record the
axis with what is written.";

/// What belongs to signals that are chosen, not designed.
const OF_SHAPES: [&str; 9] = [
    "shape",
    "order",
    "hold",
    "repeat",
    "resolution_hz",
    "from_hz",
    "to_hz",
    "seed",
    "mass_kg",
];

/// Arguments of `excite`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ExciteArgs {
    /// What to make
    ///
    /// An M-sequence shows an axis that nothing is known of. An anti-resonance
    /// that is roughly known is found most precisely by a random signal that ends
    /// a tenth above it: noise counts least where little else moves.
    #[arg(long, value_enum, default_value_t = ShapeArg::MSequence)]
    pub shape: ShapeArg,
    /// Design the signal for the axis of this recording of force or torque and motion
    #[arg(long = "for", value_name = "CSV", conflicts_with_all = OF_SHAPES)]
    pub for_recording: Option<PathBuf>,
    /// Design the signal for an axis of this machine: its file, or a built-in name
    #[arg(short, long, value_name = "MACHINE", requires = "axis")]
    #[arg(conflicts_with_all = OF_SHAPES, conflicts_with = "for_recording")]
    pub machine: Option<String>,
    /// The axis of --machine, or of columns with an axis letter in --for
    #[arg(long, value_name = "LETTER")]
    pub axis: Option<char>,
    /// --for: what a column holds, as for identify
    #[arg(long, value_name = "COLUMN", requires = "for_recording")]
    pub map: Vec<String>,
    /// --for: the force or torque counts the other way than the motion
    #[arg(long, requires = "for_recording")]
    pub reverse: bool,
    /// Largest value, in the unit of --name [with --machine: the force of its
    /// acceleration]
    #[arg(long, required_unless_present = "machine")]
    pub amplitude: Option<f64>,
    /// Samples a second [default: 1000; with --for, those of the recording; where that has
    /// no times, they are needed]
    #[arg(long, value_name = "HZ")]
    pub rate_hz: Option<f64>,
    /// M-sequence: length of the register, 3 to 20; 2^order − 1 steps
    /// [default: as --resolution-hz asks, else 12]
    #[arg(long)]
    pub order: Option<u32>,
    /// M-sequence: samples that each step is held
    ///
    /// One and a half periods of an anti-resonance that is roughly known show it
    /// and the inertia most precisely: 37 at 1 kHz for 40 Hz.
    #[arg(long, default_value_t = 1)]
    pub hold: usize,
    /// M-sequence: how often it is repeated
    #[arg(long, default_value_t = 1)]
    pub repeat: usize,
    /// What is to be distinguished, Hz: sets the length
    #[arg(long)]
    pub resolution_hz: Option<f64>,
    /// Sweeps and random: lowest frequency
    #[arg(long, default_value_t = 1.0)]
    pub from_hz: f64,
    /// Sweeps and random: highest frequency [default: 0.4 of the rate]
    #[arg(long)]
    pub to_hz: Option<f64>,
    /// Sweeps, random and designed signals: length [default: as --resolution-hz asks,
    /// else 10; designed: as the errors ask, 16 to 120]
    #[arg(long)]
    pub seconds: Option<f64>,
    /// Random: other seeds give other signals
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Name of the column of the value [default: that of a torque that excites, or as the
    /// axis needs]
    #[arg(long, value_enum)]
    pub name: Option<ValueName>,
    /// Mass that a force moves, for the warnings
    #[arg(long, value_name = "KG", conflicts_with = "inertia_kg_m2")]
    pub mass_kg: Option<f64>,
    /// Inertia that a torque turns, for the warnings
    #[arg(long, value_name = "KGM2", conflicts_with_all = ["for_recording", "machine"])]
    pub inertia_kg_m2: Option<f64>,
    /// Stroke that is free, from end to end
    #[arg(long, value_name = "MM")]
    pub stroke_mm: Option<f64>,
    /// Speed that is allowed
    #[arg(long, value_name = "MM_MIN")]
    pub speed_mm_min: Option<f64>,
    /// Angle that is free, from end to end
    #[arg(long, value_name = "DEG")]
    pub stroke_deg: Option<f64>,
    /// Speed that is allowed
    #[arg(long, value_name = "RPM")]
    pub speed_rpm: Option<f64>,
    /// Write here [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

impl ExciteArgs {
    /// Samples a second of a signal that is made for no recording.
    #[must_use]
    pub fn samples_per_s(&self) -> f64 {
        self.rate_hz.unwrap_or(1000.0)
    }
}

/// Shapes of signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ShapeArg {
    /// Maximum-length sequence: two levels, a flat spectrum
    MSequence,
    /// Sine whose frequency grows by equal factors
    LogSweep,
    /// Sine whose frequency grows by equal steps
    LinearSweep,
    /// Random phases, flat within a band and nothing outside
    Random,
}

/// Columns that an excitation can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[allow(missing_docs, reason = "the names say it")]
pub enum ValueName {
    #[value(name = "excitation_nm")]
    ExcitationNm,
    #[value(name = "excitation_n")]
    ExcitationN,
    #[value(name = "torque_nm")]
    TorqueNm,
    #[value(name = "force_n")]
    ForceN,
    #[value(name = "command_mm")]
    CommandMm,
    #[value(name = "command_deg")]
    CommandDeg,
}
