//! How a controller runs through the joints of blocks: rules as data.

use super::axis::AxisValues;
use schemars::JsonSchema;
use serde::Deserialize;

/// The rules of a look-ahead planner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LookAhead {
    /// How fast a corner is taken.
    pub corner: CornerRule,
    /// How many blocks the controller sees ahead; `None`: as many as matter.
    pub blocks: Option<u32>,
    /// How many it may see, where that is more than `blocks` and a matter of timing: what depends
    /// on it counts with all that it may be.
    pub blocks_at_most: Option<u32>,
    /// Acceleration along the path in mm/s², whatever the direction; infinite
    /// where only the axes have limits.
    pub path_accel_mm_s2: f64,
    /// Share of each hill of speed that is cruised at least, [0, 1) (Klipper's
    /// minimum cruise ratio), at the acceleration of all paths; 0: none.
    pub min_cruise_ratio: f64,
    /// How arcs are rounded into chords; `None`: they are run as arcs.
    pub chords: Option<ChordRule>,
}

/// How fast a corner is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CornerRule {
    /// `LinuxCNC` 2.9: small kinks are passed, corners rounded by blend arcs.
    LinuxCnc {
        /// Period of the servo thread in s.
        cycle_s: f64,
        /// Share of the acceleration that a kink may take.
        kink_ratio: f64,
        /// A line that is left with fewer cycles than this between two blends
        /// becomes part of the second.
        gap_cycles: f64,
    },
    /// Speed of a circle that touches both sides and passes the corner at a
    /// distance: `v² = a·d·s/(1 − s)`, `s` the sine of half the inside angle.
    JunctionDeviation {
        /// The distance d in mm.
        deviation_mm: f64,
        /// Which directions make the angle.
        angle: CornerAngle,
        /// `a` is what the axes permit in the direction of the change of
        /// speed, not the block's own acceleration.
        per_axis: bool,
        /// With `per_axis`, `a` is not above the block's acceleration either.
        block_accel: bool,
        /// In turns of more than 135 degrees inside, blocks shorter than this
        /// in mm also keep to the circle that they are chords of; 0: not.
        small_block_mm: f64,
    },
    /// Largest step of speed of each axis, of which a reversal counts as the
    /// larger part alone; motion begins and ends at a speed where no axis is
    /// faster than its step (Marlin's classic jerk).
    ClassicJerk {
        /// The steps in mm/s; infinite where not given.
        step_mm_s: AxisValues,
    },
    /// Speed at a corner of 90 degrees (Klipper):
    /// `v² = v90²·(√2 − 1)·s/(1 − s)·a/a_max`, a the lower acceleration of both
    /// blocks and `a_max` that of all paths, and at most what the block's length bends
    /// through.
    SquareCorner {
        /// Speed at 90 degrees in mm/s.
        velocity_mm_s: f64,
        /// Largest step of speed of the extruder in mm/s.
        extruder_step_mm_s: f64,
    },
    /// Largest step of speed of each axis (`RepRapFirmware`, CNCs).
    SpeedStep {
        /// The steps in mm/s; infinite where not given.
        step_mm_s: AxisValues,
        /// Only between two moves that extrude or two that do not; others meet
        /// at rest.
        same_kind_only: bool,
    },
}

/// Which directions make the angle of a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CornerAngle {
    /// Those of all axes, the extruder too.
    AllAxes,
    /// Those of X, Y and Z; a move of other axes alone begins and ends at rest.
    Linear,
}

/// How arcs are rounded into chords of equal length, nearest below a length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChordRule {
    /// Longest chord in mm; infinite without one.
    pub max_mm: f64,
    /// Shortest chord in mm, where the others ask for less.
    pub min_mm: f64,
    /// Largest distance between arc and chord in mm; infinite without one.
    pub deviation_mm: f64,
    /// Chords per second at the feed; 0: does not matter.
    pub per_second: f64,
    /// Chords of a full circle at least.
    pub per_circle: f64,
    /// The part of a chord from which on it counts as one more, 1: never; 0 for any part.
    pub more_from: f64,
    /// While nothing waits after a chord it may be left at the speed from which the rest
    /// of the arc is enough to stop; otherwise at none.
    pub safe_exit: bool,
}
