//! Bringing a state inside the limits.
//!
//! Input: a profile that has just begun. Output: the same with at most three
//! phases that lead to a state from which the limits can be kept: acceleration
//! and speed within them, and also the speed at which the acceleration can be
//! 0. Limits that are exceeded are exceeded as little and as briefly as the
//! jerk permits.

use super::limits::JerkLimits;
use super::profile::JerkProfile;

/// Brings the end of a profile inside the limits.
pub(super) fn bring_in(profile: &mut JerkProfile, limits: &JerkLimits) {
    let j = limits.jerk_mm_s3;
    let accel = profile.end.accel_mm_s2;
    if accel > limits.max_accel_mm_s2 {
        profile.ramp(limits.max_accel_mm_s2, -j);
    } else if accel < limits.min_accel_mm_s2 {
        profile.ramp(limits.min_accel_mm_s2, j);
    }
    let (v, a) = (profile.end.velocity_mm_s, profile.end.accel_mm_s2);
    let levelled = v + a * a.abs() / (2.0 * j);
    if levelled < limits.min_speed_mm_s {
        Descent {
            sign: -1.0,
            high: -limits.min_speed_mm_s,
            low: -limits.max_speed_mm_s,
            steepest: -limits.max_accel_mm_s2,
        }
        .follow(profile, j);
    } else if levelled > limits.max_speed_mm_s || v > limits.max_speed_mm_s {
        Descent {
            sign: 1.0,
            high: limits.max_speed_mm_s,
            low: limits.min_speed_mm_s,
            steepest: limits.min_accel_mm_s2,
        }
        .follow(profile, j);
    } else if v < limits.min_speed_mm_s {
        Descent {
            sign: -1.0,
            high: -limits.min_speed_mm_s,
            low: -limits.max_speed_mm_s,
            steepest: -limits.max_accel_mm_s2,
        }
        .follow(profile, j);
    }
    profile.brought_in = profile.phases.len();
}

/// The way down to the largest speed; up to the smallest with signs changed.
struct Descent {
    sign: f64,
    /// The speed to come down to.
    high: f64,
    /// The speed below which it must not lead.
    low: f64,
    /// The smallest acceleration.
    steepest: f64,
}

impl Descent {
    fn follow(&self, profile: &mut JerkProfile, j: f64) {
        let v = self.sign * profile.end.velocity_mm_s;
        let a = self.sign * profile.end.accel_mm_s2;
        // Falling acceleration reaches the speed `high` at −√(a² + 2j·(v − high)),
        // and at −√(a²/2 + j·(v − low)) it has to rise again.
        let arrived = -(a * a + 2.0 * j * (v - self.high)).max(0.0).sqrt();
        let turned = -(0.5 * a * a + j * (v - self.low)).max(0.0).sqrt();
        let until = arrived.max(turned).min(a);
        let mut end = self.high;
        if until >= self.steepest {
            profile.ramp(self.sign * until, -self.sign * j);
            if turned > arrived {
                // Still too fast: rising along the last curve above `low`.
                let arrived = -(2.0 * j * (self.high - self.low)).sqrt();
                profile.ramp(self.sign * arrived.max(until), self.sign * j);
            }
        } else {
            profile.ramp(self.sign * self.steepest, -self.sign * j);
            let slowest = self.low + self.steepest * self.steepest / (2.0 * j);
            let v = self.sign * profile.end.velocity_mm_s;
            profile.hold((v - self.high.max(slowest)).max(0.0) / -self.steepest);
            if slowest > self.high {
                let arrived = -(2.0 * j * (self.high - self.low)).sqrt();
                profile.ramp(self.sign * arrived, self.sign * j);
            }
        }
        if profile.end.velocity_mm_s * self.sign < self.high {
            end = profile.end.velocity_mm_s * self.sign;
        }
        profile.end.velocity_mm_s = self.sign * end;
    }
}
