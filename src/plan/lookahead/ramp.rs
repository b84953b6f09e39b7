//! Profiles between two speeds: at most three phases of constant acceleration.

use super::super::profile::{Phase, PhaseKind, Profile};

/// Speeds of a path element, squared, in mm²/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speeds2 {
    /// At its start.
    pub start: f64,
    /// At its end.
    pub end: f64,
    /// The largest inside; not below the others.
    pub top: f64,
}

impl Profile {
    /// The fastest profile over `length` (mm, positive) between two speeds with
    /// accelerations of at most `accel` (mm/s², positive).
    ///
    /// `v_top² = min(top², (v0² + v1²)/2 + a·L)`. Where `accel` is too small to
    /// reach the end speed, the acceleration that reaches it is taken.
    #[must_use]
    #[inline]
    pub fn between(length: f64, speeds2: Speeds2, accel: f64) -> Self {
        let Speeds2 { start, end, top } = speeds2;
        let mut profile = Self::default();
        let (v0, v1) = (start.sqrt(), end.sqrt());
        let needed = 0.5 * (start - end).abs() / length;
        if needed >= accel {
            let a = if end > start { needed } else { -needed };
            let duration_s = 2.0 * length / (v0 + v1);
            profile.phases.push(phase(duration_s, 0.0, v0, v1, a));
            return profile;
        }
        let top2 = top.min(0.5 * (start + end) + accel * length);
        let v = top2.sqrt();
        let up_mm = 0.5 * (top2 - start) / accel;
        let down_mm = 0.5 * (top2 - end) / accel;
        let cruise_mm = length - up_mm - down_mm;
        if v > v0 {
            profile
                .phases
                .push(phase((v - v0) / accel, 0.0, v0, v, accel));
        }
        // Less than rounding makes of it is no cruise.
        if cruise_mm > 1e-12 * length {
            profile.phases.push(phase(cruise_mm / v, up_mm, v, v, 0.0));
        }
        if v > v1 {
            let at_mm = length - down_mm;
            profile
                .phases
                .push(phase((v - v1) / accel, at_mm, v, v1, -accel));
        }
        profile
    }
}

#[inline]
fn phase(duration_s: f64, position_mm: f64, v0: f64, v1: f64, accel: f64) -> Phase {
    Phase {
        kind: PhaseKind::ConstantAcceleration,
        duration_s,
        position_mm,
        velocity_mm_s: v0,
        end_velocity_mm_s: v1,
        accel_mm_s2: accel,
    }
}
