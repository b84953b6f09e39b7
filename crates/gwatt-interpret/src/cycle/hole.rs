//! What a block of a canned cycle drills.

/// One hole, in machine coordinates.
pub(super) struct Hole {
    pub(super) number: u16,
    pub(super) r_mm: f64,
    pub(super) bottom_mm: f64,
    pub(super) clear_mm: f64,
    pub(super) dwell_s: Option<f64>,
    /// Depth of a peck of a tap; 0 without pecks.
    pub(super) peck_mm: f64,
    pub(super) pecks: Pecks,
    pub(super) shift_mm: [f64; 2],
}

/// How deep the pecks are.
#[derive(Debug, Clone, Copy, Default)]
#[allow(clippy::struct_field_names, reason = "units end the names")]
pub(super) struct Pecks {
    /// The first, mm.
    pub(super) first_mm: f64,
    /// By how much each is smaller than the one before, mm.
    pub(super) less_mm: f64,
    /// The smallest, mm.
    pub(super) least_mm: f64,
    /// G73 returns to R after so much, mm.
    pub(super) out_after_mm: Option<f64>,
}

impl Pecks {
    pub(super) fn equal(depth_mm: f64) -> Self {
        Self {
            first_mm: depth_mm,
            less_mm: 0.0,
            least_mm: depth_mm,
            out_after_mm: None,
        }
    }

    /// The depth of the one after a peck.
    pub(super) fn next(&self, depth_mm: f64) -> f64 {
        (depth_mm - self.less_mm).max(self.least_mm)
    }
}
