//! Modal state: what a controller keeps from block to block.

use super::code::Motion;
use gwatt_machine::units::{MM_PER_INCH, SECONDS_PER_MINUTE};
use gwatt_machine::{AxisId, Lathe, Machine, PathMode, TurningPlane};
use gwatt_motion::{Corner, FeedMode};

/// In place of the G word that says what F means: none has said so, and the machine's settings,
/// which decide, are not known.
pub const FEED_MODE_UNKNOWN: u16 = 0;

/// The feed in force: value, unit and text of the F word that set it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feed {
    /// The number, in program units of that time.
    pub value: f64,
    /// Unit of length when it was set, mm.
    pub mm_per_unit: f64,
    /// The number as it was written, to be written again.
    pub text: NumberText,
    /// What stands after F where the number was worked out, as long as that has the same
    /// value; else empty.
    pub expression: NumberText,
}

/// A number as it was written, so small that it is copied with its value;
/// empty for longer ones.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NumberText {
    bytes: [u8; NumberText::MAX],
    len: u8,
}

impl NumberText {
    /// Longest text that is kept.
    pub const MAX: usize = 24;

    /// Keeps a text, unless it is too long.
    #[must_use]
    pub fn new(text: &[u8]) -> Self {
        let mut kept = Self::default();
        if let Some(bytes) = kept.bytes.get_mut(..text.len()) {
            bytes.copy_from_slice(text);
            kept.len = text.len() as u8;
        }
        kept
    }

    /// The text; empty if it was too long.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.len)).unwrap_or_default()
    }
}

impl Feed {
    /// Speed along a path of linear axes under G94, mm/s.
    #[must_use]
    pub fn linear_mm_s(&self) -> f64 {
        self.value * self.mm_per_unit / SECONDS_PER_MINUTE
    }

    /// Speed of rotary axes alone under G94, degrees/s.
    #[must_use]
    pub fn rotary_deg_s(&self) -> f64 {
        self.value / SECONDS_PER_MINUTE
    }
}

/// What holds from block to block.
#[derive(Debug, Clone, PartialEq)]
pub struct Modal {
    /// The motion word in force.
    pub motion: Motion,
    /// Axes of the plane: first, second, normal.
    pub plane: [usize; 3],
    /// G90 (true) or G91.
    pub absolute: bool,
    /// M82 (true) or M83: positions of the extruder.
    pub extruder_absolute: bool,
    /// G90.1 (true) or G91.1.
    pub arc_absolute: bool,
    /// Millimetres in one program unit.
    pub mm_per_unit: f64,
    /// A word of the program has said so.
    pub unit_is_said: bool,
    /// G93, G94 or G95.
    pub feed_mode: FeedMode,
    /// The number of the G word that says so, times ten: on lathes also G98 and G99, on
    /// SINUMERIK G96, G97 and their kin; [`FEED_MODE_UNKNOWN`] before any.
    pub feed_mode_word: u16,
    /// The F in force, if any.
    pub feed: Option<Feed>,
    /// Whether the program may run through the end of a block.
    pub path_mode: PathMode,
    /// How corners may be taken.
    pub corner: Corner,
    /// A word of the program has said so: before that it is a matter of the controller's
    /// settings.
    pub corner_known: bool,
    /// S in force, 1/min; 0 without one.
    pub spindle_rpm: f64,
    /// G7: words of X are diameters.
    pub diameter: bool,
}

impl Modal {
    /// The state at power-on.
    #[must_use]
    pub fn power_on(machine: &Machine) -> Self {
        let language = &machine.controller.language;
        let (feed_mode, feed_mode_word) = feed_at_power_on(machine);
        Self {
            motion: Motion::at_power_on(language),
            plane: if language.dialect.lathe.is_some() || turns(machine) {
                [2, 0, 1]
            } else {
                [0, 1, 2]
            },
            absolute: language.absolute,
            extruder_absolute: language.absolute,
            arc_absolute: language.arc_absolute,
            mm_per_unit: if language.metric { 1.0 } else { MM_PER_INCH },
            unit_is_said: false,
            feed_mode,
            feed_mode_word,
            feed: None,
            path_mode: machine.path.mode.unwrap_or(language.power_on_mode),
            corner: Corner::Round {
                tolerance_mm: language.power_on_tolerance_mm,
                join_mm: 0.0,
            },
            corner_known: false,
            spindle_rpm: 0.0,
            diameter: language.dialect.diameter,
        }
    }
}

/// What F means at power-on, and the G word that says so. Where the machine's settings decide and
/// nobody gave them, it is by the revolution, which is never the slower.
fn feed_at_power_on(machine: &Machine) -> (FeedMode, u16) {
    let language = &machine.controller.language;
    let unknown = language.family.facts().turns_in_unknown_feed && turns(machine);
    match (language.dialect.lathe, language.dialect.per_revolution) {
        (Some(Lathe::A), Some(true)) => (FeedMode::PerRevolution, 990),
        (Some(Lathe::A), _) => (FeedMode::PerMinute, 980),
        (_, Some(true)) => (FeedMode::PerRevolution, 950),
        (_, None) if unknown => (FeedMode::PerRevolution, FEED_MODE_UNKNOWN),
        _ => (FeedMode::PerMinute, 940),
    }
}

/// Whether the plane at power-on is ZX though the language has no G-code systems of lathes.
fn turns(machine: &Machine) -> bool {
    let has = |axis: AxisId| machine.axis_set.contains(axis as usize);
    let language = &machine.controller.language;
    let without_y = has(AxisId::X) && has(AxisId::Z) && !has(AxisId::Y);
    match language.family.facts().turning_plane {
        TurningPlane::Never => false,
        TurningPlane::Diameters => language.dialect.diameter,
        TurningPlane::Axes => language.dialect.diameter || without_y,
    }
}
