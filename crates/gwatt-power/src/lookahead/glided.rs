//! What is known of a move at constant speed.

use gwatt_plan::lookahead::Line;

/// What a move that glides comes to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Glided {
    pub(crate) length_mm: f64,
    /// 2·a·L, at least.
    pub(crate) ramp2: f64,
}

impl Glided {
    /// A line that is run as it is.
    pub(super) fn whole(line: &Line, accel_share: f64) -> Self {
        Self {
            length_mm: line.length_mm,
            ramp2: 2.0 * accel_share * line.least_accel_mm_s2 * line.length_mm,
        }
    }
}
