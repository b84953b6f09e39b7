//! What rounding may make of directions.

use gwatt_machine::AxisId;

pub(super) const EXTRUDER: usize = AxisId::E as usize;

/// How far from 1 the square of a direction may be that counts as a unit.
pub(super) const UNIT: f64 = 1e-9;

/// What rounding may make of the figures of a corner, as a share.
pub(super) const ROUNDING: f64 = 1e-6;
