//! Arguments of `plan`.

use std::path::PathBuf;

use clap::Args;

use super::MachineArgs;
use super::spindle::period_ms;

const EXAMPLES: &str = "\
Examples:
  gwatt plan drives.csv -m vmc -o run.csv
  printf 'time_s,drive,position_mm,speed_rpm\\n0,spindle,,6000\\n0,X,400\\n' | gwatt plan - -m vmc

The schedule is CSV below a header. time_s and drive say when a row begins to hold
and for which axis, for the spindle, or for all of them (`all`, or blank). An axis goes
to position_mm (position_deg), with speed_mm_min (speed_deg_min) as its largest
speed, or holds speed_mm_min; the spindle holds speed_rpm. Limits of a row hold until
the drive's next one: accel_mm_s2, jerk_mm_s3 (accel_deg_s2, jerk_deg_s3; accel_rpm_s,
jerk_rpm_s2) and power_w. In rows for all, power_w is what they share from then on,
in place of what the machine's converter delivers, and period_ms the period.

All drives start at rest, axes at 0. The run ends when all is carried out. Every row of
the result is the end of a period; jerk is its mean over the period.

Exit status 1: the drives take more than there is.";

/// Arguments of `plan`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct PlanArgs {
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
}
