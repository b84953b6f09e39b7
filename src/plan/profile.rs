//! Profiles: speed along a path as a list of phases.

use arrayvec::ArrayVec;

/// What a phase keeps constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhaseKind {
    /// Acceleration (0 for a cruise).
    ConstantAcceleration,
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
    /// Acceleration at its start in mm/s², signed.
    pub accel_mm_s2: f64,
}

/// The speed along one path, from rest to rest: at most seven phases.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Profile {
    /// The phases in order of time.
    pub phases: ArrayVec<Phase, 7>,
}
