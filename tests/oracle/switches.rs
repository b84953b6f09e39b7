//! What of the second implementation is compared, at one place.
//!
//! Each switch is a rule that follows from the physics and that gwatt is held to
//! as soon as the switch is on. The rule itself stands in the code either way.

/// Accelerations between the command and the servo factors count, and friction
/// between cold and warm: with copper loss the braking of a drive may draw more
/// than its command, `v·F + R·F²`, by `servo_factor_regen`.
pub const ALL_CORNERS: bool = true;

/// The peaks hold at every override from 0 to the largest, not at the largest
/// alone: each axis of an independent rapid then has other ramps.
pub const LOWER_OVERRIDES: bool = true;

/// Axes may have jerk limits and force curves at once: an S-curve of which the
/// acceleration stays below what the curve leaves.
pub const CURVES_WITH_JERK: bool = true;

/// Force curves may have any number of kinks (off: two or three points).
pub const CURVES_WITH_MANY_POINTS: bool = true;

/// A drive's base load is never credited against what is fed back before the
/// spindle is switched on.
pub const SPINDLE_BASE_LOAD: bool = true;

/// Figures are exact where nothing is uncertain: not only never too low, but
/// never higher either by more than sampling explains. To be switched off where
/// errors of mass or friction count by default.
pub const NEVER_TOO_HIGH: bool = true;

/// The reported peak at one override is the largest power of the series, not a bound
/// of it; but for steps of speed at corners, which a series does not show.
pub const PEAKS_OF_SERIES: bool = true;

/// The reported energies are the integral of the series, and what steps of speed add.
pub const ENERGY_OF_SERIES: bool = true;
