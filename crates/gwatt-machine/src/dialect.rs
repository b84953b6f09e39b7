//! What the controls of Fanuc, Haas and their relatives have besides ISO 6983.

use schemars::JsonSchema;
use serde::Deserialize;

/// What a number without a decimal point means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Point {
    /// The same as with a point after it.
    Calculator,
    /// Least increments: 0.001 mm, 0.0001 inch, 0.001 degrees.
    LeastIncrement,
}

/// The G codes of a lathe (Fanuc: G-code systems).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Lathe {
    /// G90, G92 and G94 are cycles, U and W are incremental.
    A,
    /// G77, G78 and G79 are cycles, G90 and G91 distance modes.
    B,
    /// As B, with G20, G21 and G24 as cycles and G70 and G71 as units.
    C,
}

/// What ATAN\[…\]/\[…\] and ASIN\[…\] of macros give for negative angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InverseAngles {
    /// Angles from 0 to 360 degrees.
    FromZero,
    /// Angles from -180 to 180 degrees.
    #[default]
    Signed,
}

/// What the controls of Fanuc, Haas and their relatives have besides ISO 6983.
#[derive(Debug, Clone, PartialEq, Default)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a separate property of the control"
)]
pub struct Dialect {
    /// There is any of this.
    pub active: bool,
    /// What numbers without a point mean; `None`: what they say.
    pub point: Option<Point>,
    /// The machine file says so.
    pub point_is_known: bool,
    /// Words of `G4` whose whole numbers are in another unit, with the seconds in one of it.
    pub dwell_whole: Vec<(u8, f64)>,
    /// The G codes of a lathe.
    pub lathe: Option<Lathe>,
    /// Words of X are diameters at power-on.
    pub diameter: bool,
    /// The words of Okuma's OSP.
    pub osp: bool,
    /// M words from M10 on that are not known move no axis.
    pub other_m: bool,
    /// A `;` ends a block.
    pub semicolon_ends_block: bool,
    /// Whether F is per revolution at power-on; `None`: nobody says so, or a setting decides.
    pub per_revolution: Option<bool>,
    /// What ATAN and ASIN of macros give.
    pub inverse_angles: InverseAngles,
    /// The machine file says so.
    pub inverse_angles_are_known: bool,
    /// M97 P calls a block of the same program.
    pub m97_calls: bool,
    /// M16 changes the tool as M6 does.
    pub m16_changes_tool: bool,
    /// J of G84 says how many times as fast a tap comes out.
    pub taps_return_by_j: bool,
    /// The group of G54 to G59, by which `#4000` and its number reads them; `None`: not known.
    pub work_offset_group: Option<u8>,
    /// G12 and G13 mill circular pockets.
    pub circular_pocket: bool,
    /// G81 to G89 of a lathe all drill along Z, from the place R.
    pub holes_along_z: bool,
    /// G87 of a mill bores and stops for the operator; else it bores from below.
    pub bores_by_hand: bool,
    /// G28 without axes moves all of them.
    pub g28_all: bool,
    /// The word of M98 that names the block to begin at, such as `Q`.
    pub call_block: Option<u8>,
    /// Of several G words of one modal group in a block the last counts.
    pub last_g_counts: bool,
}

impl Dialect {
    /// Whether the words of a block need a second look.
    #[must_use]
    pub fn adapts(&self) -> bool {
        self.point.is_some() || self.lathe.is_some()
    }
}
