//! What a profile says of a printer.

use super::value::{At, Letter, NotNegative, Number, Positive};
use crate::printer::ExtruderMode;
use schemars::JsonSchema;
use serde::Deserialize;

/// What 3D printers differ in; the defaults are Marlin's.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PrinterTable {
    /// What G90 and G91 mean for the extruder; default "follows".
    pub(crate) extruder_mode: Option<ExtruderMode>,
    /// Whether a line may hold several commands; default false.
    pub(crate) several_commands: Option<bool>,
    /// Whether limits that the program sets (M201, M203, M204) may act on the move before them
    /// already, unless a line with a motion word stands in between; default false.
    pub(crate) early_limits: Option<bool>,
    /// Whether G29 with S1 to S3 loads, drops or saves the map of heights, and moves nothing;
    /// default false.
    pub(crate) height_map: Option<bool>,
    /// Unit of M203; default per-second.
    pub(crate) speed_cap: Option<SpeedCapName>,
    /// Whether some versions take M201, M203 and M204 in mm after G20 too, others in
    /// inches; default false: all take them in inches.
    pub(crate) limits_in_mm: Option<bool>,
    /// Whether M204 and `SET_VELOCITY_LIMIT` set the limits of X and Y
    /// themselves; default false.
    pub(crate) velocity_limit: Option<bool>,
    /// Axes that M204's P, T and S do not limit when no other axis moves;
    /// default the extruder.
    pub(crate) path_accel_spares: Option<Vec<At<Letter>>>,
    /// Whether moves of other axes that draw the filament back go as those that do not print (M204
    /// T); default false: as all that move the extruder.
    pub(crate) drawing_back_travels: Option<bool>,
    /// Whether M204 R takes the place of the extruder's own limit (M201) in moves of it alone;
    /// default false: both count.
    pub(crate) retract_by_path: Option<bool>,
    /// Axes whose moves alone keep their F under M220; default none.
    pub(crate) feed_factor_spares: Option<Vec<At<Letter>>>,
    /// Axes that home together, in the order of homing; default XY, then Z.
    pub(crate) home_together: Option<Vec<Vec<At<Letter>>>>,
    /// G10 and G11 until the program sets them.
    pub(crate) retract: Option<At<RetractTable>>,
    /// Letters that make a G0 or G1 end at an endstop; default none.
    pub(crate) endstop_letters: Option<Vec<At<String>>>,
    /// Commands that certainly move nothing; `*` at the end of a name stands for
    /// anything.
    pub(crate) ignored_macros: Option<Vec<At<String>>>,
    /// Commands whose moves are not known: every axis counts at its full speed
    /// and acceleration, and its place is not known afterwards. They must leave
    /// feed and modes as they are.
    pub(crate) unknown_moves: Option<Vec<At<String>>>,
    /// Those of `unknown_moves`, and tools, that may switch heaters and fans too, as a
    /// macro or a file of the machine does. `unknown_moves` of a machine file all may.
    pub(crate) may_heat: Option<Vec<At<String>>>,
    /// Commands that are macros of the machine, of which nothing is known: they may move,
    /// heat, and leave another feed and other modes and limits. A file of that name in the
    /// program's folder or one given by `--sub-path` says what one does.
    pub(crate) unknown_macros: Option<Vec<At<String>>>,
    /// Words before and after a part that the machine may leave out, as a condition of its
    /// own decides (Bambu Lab's M622 and M623); default none.
    pub(crate) optional_part: Option<Vec<At<String>>>,
    /// Commands that shift the coordinates: the next move of an axis counts at
    /// full speed and acceleration.
    pub(crate) shifts: Option<Vec<At<String>>>,
}

/// Unit of M203.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SpeedCapName {
    None,
    PerSecond,
    PerMinute,
}

/// How filament is retracted.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RetractTable {
    /// Length that is pulled back in mm; default 3.
    pub(crate) length_mm: Option<NotNegative>,
    /// Its speed in mm/s; default 45.
    pub(crate) speed_mm_s: Option<Positive>,
    /// Length that is pushed forward in addition in mm; default 0.
    pub(crate) extra_mm: Option<Number>,
    /// Speed of pushing forward in mm/s; default `speed_mm_s`.
    pub(crate) recover_mm_s: Option<Positive>,
    /// How far Z is lifted in mm; default 0.
    pub(crate) lift_mm: Option<NotNegative>,
}
