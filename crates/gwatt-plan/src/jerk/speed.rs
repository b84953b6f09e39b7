//! To a speed and an acceleration: two or three phases.
//!
//! Input: a state and a target. Output: the fastest profile.
//!
//! ```text
//!  a │    ____         From a₀ with the jerk ±j to a peak a_p, there for a
//!    │   /    \        while if a_p is the limit, and with ∓j to a₁. The speed
//!    │  /      \       changes by Δv = ±(2·a_p² − a₀² − a₁²)/2j, hence
//!    │ /        \
//!    └────────────→ t    a_p = ±√(±j·Δv + (a₀² + a₁²)/2).
//! ```
//!
//! The sign is decided by a comparison of signed quantities, of Δv with what
//! going from a₀ to a₁ at full jerk changes, `(a₁ + a₀)·|a₁ − a₀|/2j`: above it
//! the peak is upwards. A reversal that reaches the limit has three phases, one
//! that does not has two; a₀ and Δv of opposite signs need no case of their own.

use super::State;
use super::limits::{JerkError, JerkLimits};
use super::profile::JerkProfile;

/// Rounding of a change of speed, relative to the speeds.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The fastest profile from `start` to a speed (mm/s) and an acceleration
/// (mm/s²), at whatever position that is.
///
/// Speed stays between start and target except where the accelerations at both
/// ends make an overshoot unavoidable; then it is the smallest possible. A
/// start whose speed is outside its limits needs nothing apart; one whose
/// acceleration is outside is first brought in.
///
/// # Errors
///
/// Where a limit or the start is not finite or the target is outside the
/// limits.
#[inline]
pub fn speed_target(
    start: State,
    speed_mm_s: f64,
    accel_mm_s2: f64,
    limits: &JerkLimits,
) -> Result<JerkProfile, JerkError> {
    let j = limits.jerk_mm_s3;
    let (a_min, a_max) = (limits.min_accel_mm_s2, limits.max_accel_mm_s2);
    if !limits.drive() {
        return Err(JerkError::Limits);
    }
    let finite = start.position_mm + start.velocity_mm_s + start.accel_mm_s2;
    if !finite.is_finite() {
        return Err(JerkError::Start);
    }
    let speed_fits = speed_mm_s >= limits.min_speed_mm_s && speed_mm_s <= limits.max_speed_mm_s;
    if !(speed_fits && accel_mm_s2 >= a_min && accel_mm_s2 <= a_max && speed_mm_s.is_finite()) {
        return Err(JerkError::Target);
    }
    let mut profile = JerkProfile::new(start);
    if start.accel_mm_s2 > a_max {
        profile.ramp(a_max, -j);
    } else if start.accel_mm_s2 < a_min {
        profile.ramp(a_min, j);
    }
    profile.brought_in = profile.phases.len();
    Peak::new(profile.end, speed_mm_s, accel_mm_s2, limits).follow(&mut profile, accel_mm_s2);
    profile.arrive(profile.end.position_mm, speed_mm_s, accel_mm_s2);
    Ok(profile)
}

/// The peak of acceleration on the way to a speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Peak {
    /// Its height in mm/s², signed.
    pub accel: f64,
    /// The jerk that leads to it, signed.
    pub jerk: f64,
    /// How long it is held in s.
    pub hold_s: f64,
}

impl Peak {
    /// The peak between a state and a target, both within the limits of
    /// acceleration.
    #[inline]
    pub fn new(from: State, speed: f64, a1: f64, limits: &JerkLimits) -> Self {
        let (a0, j) = (from.accel_mm_s2, limits.jerk_mm_s3);
        let change = j * (speed - from.velocity_mm_s);
        let direct = 0.5 * (a1 + a0) * (a1 - a0).abs();
        let squares = 0.5 * (a0 * a0 + a1 * a1);
        // Just next to the direct way the fastest one may be much longer:
        // rounding must not decide for it.
        let size = j * (speed.abs() + from.velocity_mm_s.abs()) + squares;
        if (change - direct).abs() <= ROUNDING * size {
            return Self {
                accel: a0.max(a1),
                jerk: j,
                hold_s: 0.0,
            };
        }
        let upwards = change > direct;
        let (square, limit, jerk) = if upwards {
            (squares + change, limits.max_accel_mm_s2, j)
        } else {
            (squares - change, limits.min_accel_mm_s2, -j)
        };
        let beyond = square - limit * limit;
        if beyond > 0.0 {
            return Self {
                accel: limit,
                jerk,
                hold_s: beyond / (j * limit.abs()),
            };
        }
        // Rounding must not put the peak between the ends.
        let height = square.max(0.0).sqrt();
        Self {
            accel: if upwards {
                height.max(a0).max(a1)
            } else {
                (-height).min(a0).min(a1)
            },
            jerk,
            hold_s: 0.0,
        }
    }

    /// Appends the ways to the peak and from there to the acceleration `a1`.
    #[inline]
    pub fn follow(self, profile: &mut JerkProfile, a1: f64) {
        profile.ramp(self.accel, self.jerk);
        profile.hold(self.hold_s);
        profile.ramp(a1, -self.jerk);
    }
}
