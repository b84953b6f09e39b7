//! The limits of a path.

/// Speed in mm/s, acceleration in mm/s² and jerk in mm/s³ that a path permits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PathLimits {
    /// Along the path.
    pub speed_mm_s: f64,
    /// Along the path.
    pub accel_mm_s2: f64,
    /// Along the path; infinite: no limit.
    pub jerk_mm_s3: f64,
}
