//! Profiles between two speeds: at most three phases of constant acceleration.

use super::super::phase::{Phase, PhaseKind};
use super::super::profile::Profile;

/// What the sums of a long path leave of rounding in a speed, as a share. A ramp
/// of that height would take no time, and still have the power of a ramp.
const ROUNDING: f64 = 1e-10;

#[inline]
fn differ(v: f64, other: f64) -> bool {
    (v - other).abs() > ROUNDING * v
}

/// How far lower overrides may go beyond a plan, under the rules of corners; 0: no further.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slack {
    /// The largest speed, squared, at which the joint before a piece may be passed.
    pub joint2: f64,
    /// The largest speed, squared, at which it may begin though what is before it is slower;
    /// 0: at none.
    pub begins2: f64,
    /// The largest acceleration along it, mm/s², as other chords may have it.
    pub accel_mm_s2: f64,
    /// The largest speed, squared, at which there are such chords.
    pub chord2: f64,
}

/// Speeds of a path element, squared, in mm²/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speeds2 {
    /// At its start.
    pub start: f64,
    /// At its end.
    pub end: f64,
    /// The one to cruise at; not below the end's. Above it at the start, the
    /// element brakes to it first.
    pub top: f64,
}

impl Speeds2 {
    /// Whether the speed is one and the same all along.
    #[must_use]
    #[inline]
    pub fn are_one(&self) -> bool {
        self.start == self.top && self.end == self.top
    }

    /// Duration of [`Profile::between`] in s, to the same bit.
    #[inline]
    pub(super) fn duration_s(&self, length: f64, accel: f64) -> f64 {
        let Self { start, end, top } = *self;
        if self.are_one() {
            return length / top.sqrt();
        }
        let (v0, v1) = (start.sqrt(), end.sqrt());
        if 0.5 * (start - end).abs() / length >= accel {
            return 2.0 * length / (v0 + v1);
        }
        let top2 = top.min(0.5 * (start + end) + accel * length);
        let v = top2.sqrt();
        let up_mm = 0.5 * (top2 - start).abs() / accel;
        let down_mm = 0.5 * (top2 - end) / accel;
        let cruise_mm = length - up_mm - down_mm;
        let mut duration_s = 0.0;
        if differ(v, v0) {
            duration_s += (v - v0).abs() / accel;
        }
        if cruise_mm > 1e-12 * length {
            duration_s += cruise_mm / v;
        }
        if v > v1 && differ(v, v1) {
            duration_s += (v - v1) / accel;
        }
        duration_s
    }
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
        let up_mm = 0.5 * (top2 - start).abs() / accel;
        let down_mm = 0.5 * (top2 - end) / accel;
        let cruise_mm = length - up_mm - down_mm;
        if differ(v, v0) {
            let a = if v > v0 { accel } else { -accel };
            profile
                .phases
                .push(phase((v - v0).abs() / accel, 0.0, v0, v, a));
        }
        // Less than rounding makes of it is no cruise.
        if cruise_mm > 1e-12 * length {
            profile.phases.push(phase(cruise_mm / v, up_mm, v, v, 0.0));
        }
        if v > v1 && differ(v, v1) {
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

#[cfg(test)]
mod tests {
    use super::{Profile, Speeds2};

    #[test]
    fn durations_are_those_of_the_profiles() {
        let squares = [0.0, 1.0, 30.0, 900.0, 2500.0];
        for (start, end) in squares.iter().flat_map(|a| squares.map(|b| (*a, b))) {
            for (top, length) in [
                (2500.0, 0.01),
                (2500.0, 3.0),
                (1e4, 3.0),
                (1e4, 700.0),
                (16.0, 20.0),
            ] {
                let top = f64::max(top, end);
                let speeds2 = Speeds2 { start, end, top };
                let profile = Profile::between(length, speeds2, 100.0);
                let duration_s = speeds2.duration_s(length, 100.0);
                assert_eq!(duration_s.to_bits(), profile.duration_s().to_bits());
            }
        }
    }
}
