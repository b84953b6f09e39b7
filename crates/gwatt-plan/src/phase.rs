//! Phases of a profile, and its state at one instant.

/// What a phase keeps constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PhaseKind {
    /// Acceleration (0 for a cruise); forwards only.
    ConstantAcceleration,
    /// The rate of acceleration; the path may also run backwards.
    ConstantJerk {
        /// Rate of acceleration in mm/s³, signed.
        jerk_mm_s3: f64,
    },
    /// The power of inertia and a drag, `a = p/v − d`: what a drive at its
    /// limit of power can do, or a converter at its own. Forwards only, and
    /// never from or to rest.
    ConstantPower {
        /// p, power by mass in mm²/s³; negative while braking.
        power_mm2_s3: f64,
    },
    /// How acceleration changes with speed: along a straight piece of a curve
    /// of torque over speed. Forwards only.
    ConstantSlope {
        /// Change of acceleration by change of speed in 1/s.
        slope_per_s: f64,
    },
}

/// A piece of a profile. Along the path, mm (or degrees) and s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// What it keeps constant.
    pub kind: PhaseKind,
    /// How long it lasts in s.
    pub duration_s: f64,
    /// Path position at its start in mm.
    pub position_mm: f64,
    /// Speed at its start in mm/s.
    pub velocity_mm_s: f64,
    /// Speed at its end in mm/s: stored, so that a stop is exactly 0.
    pub end_velocity_mm_s: f64,
    /// Acceleration at its start in mm/s², signed.
    pub accel_mm_s2: f64,
}

/// Where a profile is at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State {
    /// Path position in mm.
    pub position_mm: f64,
    /// Speed in mm/s.
    pub velocity_mm_s: f64,
    /// Acceleration in mm/s².
    pub accel_mm_s2: f64,
}
