//! The limits of a jerk-limited profile, and what can be wrong with them.

use thiserror::Error;

/// Limits of speed, acceleration and jerk.
///
/// Speeds and accelerations are signed: a path that only runs forwards is
/// driven by `max_accel_mm_s2` and braked by `min_accel_mm_s2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JerkLimits {
    /// Largest speed in mm/s, not negative.
    pub max_speed_mm_s: f64,
    /// Smallest speed in mm/s, not positive: how fast it may run backwards.
    pub min_speed_mm_s: f64,
    /// Largest acceleration in mm/s², positive.
    pub max_accel_mm_s2: f64,
    /// Smallest acceleration in mm/s², negative.
    pub min_accel_mm_s2: f64,
    /// Largest rate of acceleration in mm/s³, positive.
    pub jerk_mm_s3: f64,
}

impl JerkLimits {
    /// The same limits in both directions.
    #[must_use]
    pub fn symmetric(speed_mm_s: f64, accel_mm_s2: f64, jerk_mm_s3: f64) -> Self {
        Self {
            max_speed_mm_s: speed_mm_s,
            min_speed_mm_s: -speed_mm_s,
            max_accel_mm_s2: accel_mm_s2,
            min_accel_mm_s2: -accel_mm_s2,
            jerk_mm_s3,
        }
    }

    /// Whether acceleration and jerk have the right signs and are finite.
    #[inline]
    pub(super) fn drive(&self) -> bool {
        self.max_accel_mm_s2 > 0.0
            && self.min_accel_mm_s2 < 0.0
            && self.jerk_mm_s3 > 0.0
            && self.max_accel_mm_s2 < f64::INFINITY
            && self.min_accel_mm_s2 > f64::NEG_INFINITY
            && self.jerk_mm_s3 < f64::INFINITY
    }
}

/// Why there is no profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum JerkError {
    /// A limit is missing, not finite or of the wrong sign.
    #[error("a limit of speed, acceleration or jerk is not finite or of the wrong sign")]
    Limits,
    /// A quantity of the start is not finite.
    #[error("the start is not finite")]
    Start,
    /// The target is not finite, or outside the limits, or can be reached only
    /// through states outside them.
    #[error("the target cannot be reached within the limits")]
    Target,
}
