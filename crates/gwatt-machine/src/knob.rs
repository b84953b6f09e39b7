//! Knobs: words that limit speed or acceleration, as the controller profile describes them.

use super::axis::{Axis, AxisKind};
use super::levels::Levels;
use crate::units::SECONDS_PER_MINUTE;
use schemars::JsonSchema;
use serde::Deserialize;

/// A word that limits speed or acceleration until it is taken back.
#[derive(Debug, Clone, PartialEq)]
pub struct Knob {
    /// Letter and number × 10 of the word, such as `(b'G', 1310)`; `None` where it is none
    /// of a letter and a number.
    pub code: Option<(u8, u16)>,
    /// The word as it is written, such as `G131` or `SET_VELOCITY_LIMIT ACCEL=`.
    pub name: String,
    /// What it acts on.
    pub target: KnobTarget,
    /// What stands after the word.
    pub argument: KnobArgument,
    /// Unit of the value.
    pub unit: KnobUnit,
    /// Smallest step of a value that is written.
    pub step: f64,
    /// Smallest value that is accepted.
    pub min: f64,
    /// True when a document confirms it.
    pub verified: bool,
    /// It acts between two moves that run into each other, without a stop.
    pub between_moves: bool,
    /// It acts on the limits of jerk too, in the same share.
    pub with_jerk: bool,
    /// The line before it that keeps it off the move before: one that is read only once that
    /// is in the queue.
    pub barrier: Option<String>,
    /// The line after it, for which the axes stand; before that it does not act.
    pub wait: Option<String>,
    /// How long the axes stand for a change of it, s.
    pub change_s: f64,
    /// The levels that its words select, for `KnobArgument::Level`.
    pub levels: Option<Levels>,
}

impl Knob {
    /// Whether the axes stand while it is turned.
    #[must_use]
    pub fn stands(&self) -> bool {
        self.wait.is_some()
    }

    /// The analog output that it sets.
    #[must_use]
    pub fn output(&self) -> Option<u16> {
        match self.argument {
            KnobArgument::Output(number) => Some(number),
            _ => None,
        }
    }

    /// Whether it acts on accelerations.
    #[must_use]
    pub fn sets_accel(&self) -> bool {
        matches!(
            self.target,
            KnobTarget::Accel | KnobTarget::FeedAccel | KnobTarget::RapidAccel
        )
    }

    /// Smallest step of a share of the rapid speed, %.
    #[must_use]
    pub fn percent_step(&self) -> f64 {
        match self.unit {
            KnobUnit::Share => self.step * 100.0,
            _ => self.step,
        }
    }

    /// The value that leaves a share of the rapid speed, given in %.
    #[must_use]
    pub fn of_percent(&self, percent: f64) -> f64 {
        match self.unit {
            // The quotient of two whole numbers is the decimal number that is written.
            KnobUnit::Share => (percent * 10.0).round() / 1000.0,
            _ => percent,
        }
    }

    /// Whether it takes a value for each axis.
    #[must_use]
    pub fn is_by_axis(&self) -> bool {
        matches!(self.argument, KnobArgument::Axes | KnobArgument::Index)
    }

    /// Whether it is a name with one value for all axes (`DynOvr=0.5`).
    #[must_use]
    pub fn is_named_for_all(&self) -> bool {
        self.code.is_none() && self.argument == KnobArgument::Assign
    }

    /// Whether it may be written to lower an acceleration.
    #[must_use]
    pub fn lowers_accel(&self) -> bool {
        self.verified && self.sets_accel() && !matches!(self.argument, KnobArgument::Path(_))
    }
}

/// What a knob acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum KnobTarget {
    /// Acceleration of feed moves.
    FeedAccel,
    /// Acceleration of rapids.
    RapidAccel,
    /// Acceleration of all moves.
    Accel,
    /// Jerk of all moves.
    Jerk,
    /// Speed of rapids.
    RapidSpeed,
    /// Speed of all moves.
    Speed,
    /// Share of the speed of all moves, as an override sets it while they run.
    SpeedShare,
    /// Share of each hill of speed that is cruised at least.
    CruiseRatio,
}

/// What stands after a knob's word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum KnobArgument {
    /// `= value` for all axes (`G131 = 50`, `DynOvr=0.5`).
    Assign,
    /// A value for each axis letter (`G130 X70 Y60`).
    Axes,
    /// One value after any of these letters, the path's limit (`M204 P500 T500`).
    Path(Vec<u8>),
    /// The number of an analog output, and a value for all axes (`M68 E0 Q0.5`).
    Output(u16),
    /// A value for each axis, with the axis in brackets after the word (`ACC[X]=70`).
    Index,
    /// Acceleration, braking and jerk of an axis, with the number of the axis before them
    /// (`#set paramAxisDynamics( 0; 5000; 5000; 25000 )#`).
    Dynamics,
    /// One value right after the word, the limit along the path of all moves that the
    /// extruder does not make alone (`SET_VELOCITY_LIMIT ACCEL=500`).
    Value,
    /// Nothing: each word selects a level (`DYNFINISH`, `G187 P3`). Values are the indices of
    /// these.
    Level,
}

/// Unit of a knob's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum KnobUnit {
    /// Percent of the machine's limit; 100 takes it back.
    Percent,
    /// Program units per s² (mm/s², or inch/s² after G20); the machine's own
    /// limit takes it back.
    PerSecondSquared,
    /// Program units per s, of a speed.
    PerSecond,
    /// Program units per minute, of a speed.
    PerMinute,
    /// A share, 0 to 1; of an acceleration that of the machine's limit, which 1 takes back.
    Share,
}

impl KnobUnit {
    /// The acceleration limit of an axis, mm/s² (degrees/s²), that a value
    /// means; `mm_per_unit` is the program's unit of length.
    #[must_use]
    pub fn accel_mm_s2(self, axis: &Axis, value: f64, mm_per_unit: f64) -> f64 {
        match self {
            Self::Percent => axis.accel_mm_s2 * value / 100.0,
            Self::Share => axis.accel_mm_s2 * value,
            _ => value * unit_of(axis, mm_per_unit),
        }
    }

    /// The speed of an axis, mm/s (degrees/s), that a value means.
    #[must_use]
    pub fn speed_mm_s(self, axis: &Axis, value: f64, mm_per_unit: f64) -> f64 {
        match self {
            Self::Percent => axis.rapid_mm_s * value / 100.0,
            Self::PerMinute => value * unit_of(axis, mm_per_unit) / SECONDS_PER_MINUTE,
            _ => value * unit_of(axis, mm_per_unit),
        }
    }

    /// The value that means a speed of an axis.
    #[must_use]
    pub fn speed_value(self, axis: &Axis, speed_mm_s: f64, mm_per_unit: f64) -> f64 {
        match self {
            Self::Percent => speed_mm_s / axis.rapid_mm_s * 100.0,
            Self::PerMinute => speed_mm_s * SECONDS_PER_MINUTE / unit_of(axis, mm_per_unit),
            _ => speed_mm_s / unit_of(axis, mm_per_unit),
        }
    }

    /// The value that means an acceleration limit of an axis.
    #[must_use]
    pub fn value(self, axis: &Axis, accel_mm_s2: f64, mm_per_unit: f64) -> f64 {
        match self {
            Self::Percent => accel_mm_s2 / axis.accel_mm_s2 * 100.0,
            Self::Share => accel_mm_s2 / axis.accel_mm_s2,
            _ => accel_mm_s2 / unit_of(axis, mm_per_unit),
        }
    }
}

/// Millimetres in the unit that positions of an axis are written in; degrees
/// are degrees.
fn unit_of(axis: &Axis, mm_per_unit: f64) -> f64 {
    match axis.kind {
        AxisKind::Linear => mm_per_unit,
        AxisKind::Rotary => 1.0,
    }
}
