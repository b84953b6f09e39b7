//! Arguments of `machine new`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use gwatt::draft;

/// What is said below the options.
pub const NEW: &str = "\
An axis is its letter, a colon, and what is known of it, with commas between:

  rapid_mm_min      rapid speed                       accel_mm_s2   acceleration
  table_kg          what slides: table, slide, head   workpiece_kg  the heaviest on it
  screw=20x800x10   diameter, length and lead in mm   pinion=40x20  pitch diameter, width in mm
  belt=20x2x9       teeth of its pulleys, pitch and width in mm     drive=linear-motor
  motor=sgm7j-04a   one of `gwatt machine motors`     gear_ratio    motor by screw or wheel
  rotor_kg_m2       its rotor, with coupling and brake
  coulomb_n         friction; or guide_friction, the coefficient of its guides
  counterweight_kg  balances Z and moves with it     efficiency    mechanical by electrical power
  jerk_mm_s3        jerk

Speed, acceleration, table_kg and one drive are needed. Axes that turn (A, B, C) have rapid_deg_min,
accel_deg_s2, table_kg_m2, workpiece_kg_m2, friction_nm and jerk_deg_s3, and no drive but motor and
gear_ratio; a printer's extruder (E) has filament=33.7, the mm that a revolution of its wheels
pushes. What else is left out is said once, with how it counts. On a terminal, without --axis, all
is asked for.

A spindle has max_rpm, inertia_kg_m2 (rotor, chuck and tool) and accel_time_s, and if known base_rpm
(up to which its torque is constant), friction_nm, peak_power_w, efficiency and base_load_w.

Examples:
  gwatt machine new -o mine.toml
  gwatt machine new --kind mill --supply 3500 --motor sgmsh-20aa -o mill.toml \\
    --axis X:rapid_mm_min=24000,accel_mm_s2=3000,table_kg=300,screw=32x1000x10
  gwatt machine new --kind router --supply 400 -o router.toml \\
    --axis X:rapid_mm_min=12000,accel_mm_s2=1500,table_kg=20,screw=16x900x10,rotor_kg_m2=0.00003 \\
    --axis Y:rapid_mm_min=12000,accel_mm_s2=1500,table_kg=35,screw=16x900x10,rotor_kg_m2=0.00003 \\
    --axis Z:rapid_mm_min=4000,accel_mm_s2=800,table_kg=6,screw=16x250x5,rotor_kg_m2=0.00002 \\
    --spindle max_rpm=24000,inertia_kg_m2=0.0004,accel_time_s=2 --load M8/M9=60";

/// Arguments of `machine new`.
#[derive(Debug, Clone, Args)]
pub struct NewArgs {
    /// What kind of machine
    #[arg(long, value_enum)]
    pub kind: Option<Kind>,
    /// The controller profile [default: iso for a mill, fanuc-lathe, grbl for a router, marlin
    /// for a printer]
    #[arg(short, long, value_name = "NAME")]
    pub controller: Option<String>,
    /// Its name
    #[arg(long)]
    pub name: Option<String>,
    /// The motor of all axes that name none of their own: one of `gwatt machine motors`
    #[arg(long, value_name = "NAME")]
    pub motor: Option<String>,
    /// What the supply of the drives delivers at most, in W
    #[arg(long, value_name = "W")]
    pub supply: Option<f64>,
    /// What it takes back, in W [default: not checked]
    #[arg(long, value_name = "W")]
    pub feeds_back: Option<f64>,
    /// What always runs on it, in W [default: 0]
    #[arg(long, value_name = "W")]
    pub base_load: Option<f64>,
    /// An axis; may be given several times
    #[arg(long = "axis", value_name = "AXIS")]
    pub axes: Vec<String>,
    /// The spindle
    #[arg(long, value_name = "SPINDLE")]
    pub spindle: Option<String>,
    /// What words of a program switch on and off, with its power in W: M8/M9=750, on printers
    /// M104=40 for the nozzle, M140=220 for the bed; may be given several times
    #[arg(long = "load", value_name = "ON/OFF=W")]
    pub loads: Vec<String>,
    /// Where the machine file goes [default: standard output]
    #[arg(short, long, value_name = "TOML")]
    pub output: Option<PathBuf>,
}

/// Kinds of machines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// Its Z is vertical
    Mill,
    /// X and Z
    Lathe,
    /// Its Z is vertical
    Router,
    /// Its Z is vertical
    Printer,
}

impl From<Kind> for draft::MachineKind {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Mill => Self::Mill,
            Kind::Lathe => Self::Lathe,
            Kind::Router => Self::Router,
            Kind::Printer => Self::Printer,
        }
    }
}
