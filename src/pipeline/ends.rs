//! Where a move begins and ends in its program.

use crate::machine::AxisValues;

/// Where the only move of a block begins and ends, in coordinates and units of the program.
#[derive(Debug, Clone, Copy)]
pub(super) struct Places {
    pub(super) start: AxisValues,
    pub(super) end: AxisValues,
    /// G90, and M82.
    pub(super) absolute: bool,
    pub(super) extruder_absolute: bool,
    pub(super) inch: bool,
}
