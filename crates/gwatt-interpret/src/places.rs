//! Figures of places and axes.

/// Differences of position below this are rounding, not motion (mm, degrees).
pub(super) const STANDSTILL_MM: f64 = 1e-9;
/// Positions beyond this are refused (mm, degrees): no machine is that large.
pub(super) const POSITION_MAX_MM: f64 = 1e9;
/// Index of the Z axis.
pub(super) const Z: usize = 2;
/// Index of the extruder axis.
pub(super) const EXTRUDER: usize = 9;
