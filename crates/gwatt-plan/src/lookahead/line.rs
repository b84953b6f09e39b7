//! Straight blocks as runs of lines know them.

/// A straight feed in X, Y and Z, and next to them of an extruder, whose start is
/// known.
#[derive(Debug, Clone, Copy, Default)]
pub struct Line {
    /// A unit.
    pub direction: [f64; 3],
    /// Of the extruder per unit of path.
    pub extrusion: f64,
    /// Of the path, mm.
    pub length_mm: f64,
    /// Not above the acceleration along the path, here and through the joint
    /// before it, mm/s².
    pub least_accel_mm_s2: f64,
    /// The largest share of the acceleration of all paths that it surely has, up to 1.
    pub common_share: f64,
}
