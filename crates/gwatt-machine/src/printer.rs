//! What the firmwares of 3D printers differ in; the defaults are Marlin's.

use super::axis::{AxisId, AxisSet};
use schemars::JsonSchema;
use serde::Deserialize;

/// Differences within the Marlin family of words, from `[language.printer]`.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a separate property of the firmware"
)]
pub struct Printer {
    /// What G90 and G91 mean for the extruder.
    pub extruder_mode: ExtruderMode,
    /// Whether a line may hold several commands; else the first takes the
    /// whole line.
    pub several_commands: bool,
    /// Limits that the program sets may act on the move before them already, unless a line
    /// with a motion word stands in between.
    pub early_limits: bool,
    /// G29 with S1 to S3 loads, drops or saves the map of heights, and moves nothing.
    pub height_map: bool,
    /// mm/s in one unit of M203; `None` where M203 is not known and does
    /// nothing.
    pub speed_cap_mm_s: Option<f64>,
    /// Whether some versions take M201, M203 and M204 in mm after G20 too, so that these
    /// words are clear after G21 alone.
    pub limits_in_mm: bool,
    /// Whether M204 and `SET_VELOCITY_LIMIT` set the limits of X and Y
    /// themselves (Klipper) and not only a limit along the path.
    pub velocity_limit: bool,
    /// Axes that M204's P, T and S do not limit when no other axis moves.
    pub path_accel_spares: AxisSet,
    /// Moves that draw the filament back go as those that do not print (M204 T).
    pub drawing_back_travels: bool,
    /// M204 R, where it is given, takes the place of the extruder's own limit (M201) in moves
    /// of it alone.
    pub retract_by_path: bool,
    /// Moves of these axes alone keep their F under M220.
    pub feed_factor_spares: AxisSet,
    /// Axes that home together, in the order of homing.
    pub home_together: Vec<AxisSet>,
    /// Axes that each homing moves besides those that it homes, each group together, one group
    /// after the other, at the speeds of homing; where they end is not known.
    pub home_moves: Vec<AxisSet>,
    /// G10 and G11 until the program sets them.
    pub retract: Retract,
    /// Letters that make a G0 or G1 end at an endstop (RepRapFirmware's H).
    pub endstop_letters: Vec<u8>,
    /// Extended commands that move nothing.
    pub ignored_macros: Vec<Command>,
    /// Commands whose moves are not known.
    pub unknown_moves: Vec<Command>,
    /// Those of them that may switch heaters and fans: macros and files of the machine.
    pub may_heat: Vec<Command>,
    /// Macros of the machine, of which nothing is known.
    pub unknown_macros: Vec<Command>,
    /// Words before and after a part that the machine may leave out.
    pub optional_part: Vec<Command>,
    /// Commands that shift the coordinates.
    pub shifts: Vec<Command>,
}

/// What G90 and G91 mean for the extruder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExtruderMode {
    /// They set its mode too; M82 and M83 set it alone.
    Follows,
    /// M82 and M83 alone set it.
    Own,
    /// It is relative under G91 and under M83.
    Either,
}

/// How a firmware retracts filament.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Retract {
    /// Length that is pulled back, mm.
    pub length_mm: f64,
    /// At this speed, mm/s.
    pub speed_mm_s: f64,
    /// Length that is pushed forward in addition, mm; either sign.
    pub extra_mm: f64,
    /// At this speed, mm/s.
    pub recover_mm_s: f64,
    /// How far Z is lifted, mm.
    pub lift_mm: f64,
}

/// A command by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// Letter and number × 10.
    Code(u8, u16),
    /// An extended command, in upper case.
    Macro(String),
    /// All extended commands that begin so, in upper case.
    Macros(String),
}

impl Command {
    /// Whether this is the extended command `name`, in any case.
    #[must_use]
    pub fn is_macro(&self, name: &[u8]) -> bool {
        match self {
            Self::Code(..) => false,
            Self::Macro(own) => own.as_bytes().eq_ignore_ascii_case(name),
            Self::Macros(own) => name
                .get(..own.len())
                .is_some_and(|begin| begin.eq_ignore_ascii_case(own.as_bytes())),
        }
    }

    /// Whether this is the word with this number × 10.
    #[must_use]
    pub fn is_code(&self, letter: u8, number: u16) -> bool {
        *self == Self::Code(letter, number)
    }
}

impl Printer {
    /// Millimetres in the unit in which limits are written by M201 and similar words, where
    /// this is that of the program: after G20 they are written between G21 and G20.
    #[must_use]
    pub fn limit_unit(&self, mm_per_unit: f64) -> f64 {
        if self.limits_in_mm { 1.0 } else { mm_per_unit }
    }

    /// Whether a move of these axes is limited by this acceleration along its path, mm/s², in
    /// place of those of its axes.
    #[must_use]
    #[inline]
    pub fn retracts(&self, moving: AxisSet, path_accel_mm_s2: f64) -> bool {
        self.retract_by_path && moving.0 == 1 << AxisId::E as u16 && path_accel_mm_s2.is_finite()
    }

    /// Whether moves from unknown places of these axes may be of the extruder alone, which then
    /// is not limited by its own acceleration.
    #[must_use]
    #[inline]
    pub fn may_retract(&self, unknown_start: AxisSet) -> bool {
        self.retract_by_path && unknown_start.contains(AxisId::E as usize)
    }
}

impl Default for Printer {
    fn default() -> Self {
        Self {
            extruder_mode: ExtruderMode::Follows,
            several_commands: false,
            early_limits: false,
            height_map: false,
            speed_cap_mm_s: Some(1.0),
            limits_in_mm: false,
            velocity_limit: false,
            path_accel_spares: AxisSet(1 << 9),
            drawing_back_travels: false,
            retract_by_path: false,
            feed_factor_spares: AxisSet(0),
            home_together: vec![AxisSet(0b11), AxisSet(0b100)],
            home_moves: Vec::new(),
            retract: Retract::default(),
            endstop_letters: Vec::new(),
            ignored_macros: Vec::new(),
            unknown_moves: Vec::new(),
            may_heat: Vec::new(),
            unknown_macros: Vec::new(),
            optional_part: Vec::new(),
            shifts: Vec::new(),
        }
    }
}

impl Default for Retract {
    /// Marlin's `Configuration_adv.h`.
    fn default() -> Self {
        Self {
            length_mm: 3.0,
            speed_mm_s: 45.0,
            extra_mm: 0.0,
            recover_mm_s: 45.0,
            lift_mm: 0.0,
        }
    }
}
