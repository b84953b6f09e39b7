//! Arguments of `limit`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use gwatt::pipeline::{self, Allowed, LimitOptions, RapidMark, RapidMarkError};
use serde::Deserialize;

use super::{MachineArgs, ProgramArgs, ProgramsArgs};

const EXAMPLES: &str = "\
Examples:
  gwatt limit part.ngc -m vmc -o fit.ngc
  gwatt limit part.ngc -m vmc --allow feed --report moves.csv -o fit.ngc
  gwatt limit part.ngc -m vmc --dry-run      show the edit as a diff
  gwatt limit part.ngc -m vmc --in-place     keep part.ngc.bak
  gwatt limit part.ngc -m vmc -o fit.ngc --html part.html
  gwatt limit print.gcode -m printer --in-place --no-backup    as slicers call it
  gwatt limit - -m vmc < part.ngc > fit.ngc
  gwatt limit programs/ -m vmc -o fit        each program by itself
  gwatt limit a.nc b.nc -m vmc --with-subprograms -o fit    with O-numbers and macros

Nothing is written unless the result is certified: it is read, planned and
evaluated again, and every move fits.";

/// Arguments of `limit`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct LimitArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub programs: ProgramsArgs,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub machine: MachineArgs,
    /// Write the program here [default: standard output]; several programs, and with
    /// --with-subprograms their files, into this folder
    #[arg(short, long, value_name = "OUT", conflicts_with = "in_place")]
    pub output: Option<PathBuf>,
    /// Replace the program, and keep it as PROGRAM.bak
    #[arg(long)]
    pub in_place: bool,
    /// With --in-place: keep no copy; for programs that write the file and hand it over, such
    /// as slicers
    #[arg(long, requires = "in_place", conflicts_with = "output")]
    pub no_backup: bool,
    /// Write the files of subprograms that the programs call as well, all certified
    /// together: a subprogram of several programs gets what is right for all of them
    #[arg(long)]
    pub with_subprograms: bool,
    /// Write no program; print what would change as a unified diff
    #[arg(long)]
    pub dry_run: bool,
    /// Show only programs that cannot be made to fit or are not read, and the totals
    #[arg(short, long)]
    pub quiet: bool,
    /// Write what each move draws, before and after, as CSV; of several programs this and
    /// the next three name folders
    #[arg(long, value_name = "CSV")]
    pub report: Option<PathBuf>,
    /// Write the same, with a summary, as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write a page with power and bus voltage over time before and after, the path and the
    /// worst blocks here; with --with-subprograms one page of all programs
    #[arg(long, value_name = "PAGE")]
    pub html: Option<PathBuf>,
    /// Draw power and bus voltage over time before and after here
    #[arg(long, value_name = "FILE", conflicts_with = "with_subprograms")]
    pub svg: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub how: HowArgs,
    /// Write what can be lowered even if not all moves fit then; the exit status stays 1
    #[arg(long)]
    pub partial: bool,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub reading: ProgramArgs,
}

/// What is done about moves that do not fit.
#[derive(Debug, Clone, Args)]
pub struct HowArgs {
    /// What to lower
    #[arg(long, value_enum, default_value_t = Strategy::Optimal)]
    pub strategy: Strategy,
    /// How far to lower it
    #[arg(long, value_enum, default_value_t = Law::Exact)]
    pub law: Law,
    /// With --strategy preset or --law patent: their values count for moves that fit without
    /// them too
    #[arg(long)]
    pub always: bool,
    /// With --strategy preset: what becomes of a move that does not fit and for whose axes
    /// there is no preset [default: refuse]
    #[arg(long, value_enum, value_name = "WHAT")]
    pub preset_else: Option<PresetElse>,
    /// What may be changed besides rapids and their accelerations; several with commas
    #[arg(long, value_enum, value_name = "WHAT", value_delimiter = ',')]
    pub allow: Vec<Allow>,
    /// Write a comment into each block in which a rapid becomes a feed, and take feeds with
    /// this comment for what they stand for: their F may be lowered without --allow feed, so
    /// that a program can be limited once more [default text: RAPID]
    #[arg(
        long,
        value_name = "TEXT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = RapidMark::USUAL,
        value_parser = mark
    )]
    pub mark_rapids: Option<RapidMark>,
    /// Which certificate is asked for [default: the best the controller allows]
    #[arg(long, value_enum)]
    pub certificate: Option<Certificate>,
}

impl HowArgs {
    /// What is to be done.
    pub fn options(&self) -> LimitOptions {
        LimitOptions {
            strategy: self.strategy.into(),
            law: self.law.into(),
            allowed: allowed(&self.allow),
            always: self.always,
            preset_else: self.preset_else.map_or_else(Default::default, Into::into),
        }
    }
}

fn mark(text: &str) -> Result<RapidMark, RapidMarkError> {
    RapidMark::new(text)
}

/// What `--allow` allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Allow {
    /// Cutting feeds may be lowered
    Feed,
    /// Canned cycles may be written out as single blocks
    Expand,
    /// Rapids of axes that move each for itself may become lines where the machine file's
    /// `clearance` leaves room
    Straighten,
    /// Exact stops (the control's word for one block) may be put between feeds that it
    /// would blend; the workpiece may show them
    Stop,
    /// The program may wait (G4) between rapids and before tool changes where a limit over
    /// time is missed
    Pause,
    /// Words may be written that no document confirms (`verified = false` in the controller
    /// profile)
    Unverified,
}

/// What a list of `--allow` allows.
pub fn allowed(list: &[Allow]) -> Allowed {
    Allowed {
        feed: list.contains(&Allow::Feed),
        expand: list.contains(&Allow::Expand),
        straighten: list.contains(&Allow::Straighten),
        stop: list.contains(&Allow::Stop),
        pause: list.contains(&Allow::Pause),
        unverified: list.contains(&Allow::Unverified),
    }
}

/// See [`pipeline::Strategy`].
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Strategy {
    /// The machine's presets for combinations of axes, where a move does not fit
    Preset,
    /// Speed alone
    Speed,
    /// Acceleration alone
    Accel,
    /// The shortest time with the words that the controller has
    Optimal,
    /// The same, and long straight blocks in pieces, each with its acceleration
    Split,
}

/// See [`pipeline::PresetElse`].
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum PresetElse {
    /// It gets the speed at which it fits
    Speed,
    /// It stays, and the program does not fit
    Refuse,
}

/// See [`pipeline::Law`].
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Law {
    /// Solved for the real block
    Exact,
    /// The square of limit/peak on nominal values where a move does not fit, for comparison
    Patent,
}

/// See [`pipeline::Certificate`].
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Certificate {
    /// Under the planner that the controller profile models
    Planned,
    /// For any look-ahead and blending that keeps each axis in its limits
    Robust,
}

impl From<Strategy> for pipeline::Strategy {
    fn from(strategy: Strategy) -> Self {
        match strategy {
            Strategy::Preset => Self::Preset,
            Strategy::Speed => Self::Speed,
            Strategy::Accel => Self::Accel,
            Strategy::Optimal => Self::Optimal,
            Strategy::Split => Self::Split,
        }
    }
}

impl From<PresetElse> for pipeline::PresetElse {
    fn from(other: PresetElse) -> Self {
        match other {
            PresetElse::Speed => Self::Speed,
            PresetElse::Refuse => Self::Refuse,
        }
    }
}

impl From<Law> for pipeline::Law {
    fn from(law: Law) -> Self {
        match law {
            Law::Exact => Self::Exact,
            Law::Patent => Self::Patent,
        }
    }
}

impl From<Certificate> for pipeline::Certificate {
    fn from(certificate: Certificate) -> Self {
        match certificate {
            Certificate::Planned => Self::Planned,
            Certificate::Robust => Self::Robust,
        }
    }
}
