//! Profiles: speed along a path as a list of phases.
//!
//! Input: a length and the limits of speed and acceleration. Output: phases,
//! each with one law of motion, that run the length from rest to rest.
//!
//! ```text
//!  v │   ┌────────┐        Fast enough a path is a trapezoid, T = L/v + v/a;
//!    │  /          \       a short one is a triangle, T = 2·√(L/a), whose
//!    │ /            \      top speed is √(a·L).
//!    └─────────────────→ t
//! ```

use super::phase::{Phase, PhaseKind, State};
use super::power_law::PowerLaw;
use super::slope;
use arrayvec::ArrayVec;
use smallvec::SmallVec;

/// Steps at most in the search for an instant.
const STEPS: u32 = 100;
/// Share of a phase or of a speed that is rounding of where it ends.
const TURN_ROUNDING: f64 = 1e-9;

impl Phase {
    /// The state `t` seconds after the phase began; `t` within the phase.
    #[must_use]
    pub fn state_at(&self, t: f64) -> State {
        let (v, a) = (self.velocity_mm_s, self.accel_mm_s2);
        match self.kind {
            PhaseKind::ConstantAcceleration => State {
                position_mm: self.position_mm + (v + 0.5 * a * t) * t,
                velocity_mm_s: (v + a * t).max(0.0),
                accel_mm_s2: a,
            },
            PhaseKind::ConstantJerk { jerk_mm_s3: j } => State {
                position_mm: self.position_mm + (v + (0.5 * a + j / 6.0 * t) * t) * t,
                velocity_mm_s: v + (a + 0.5 * j * t) * t,
                accel_mm_s2: a + j * t,
            },
            PhaseKind::ConstantPower { power_mm2_s3 } => {
                PowerLaw::through(power_mm2_s3, v, a).state(self, t)
            }
            PhaseKind::ConstantSlope { slope_per_s } => slope::state(self, slope_per_s, t),
        }
    }

    /// When the phase is at a path position, s after its beginning; the path must
    /// run forwards all along.
    #[must_use]
    pub fn time_at(&self, position_mm: f64) -> f64 {
        let (v, a, distance) = (
            self.velocity_mm_s,
            self.accel_mm_s2,
            position_mm - self.position_mm,
        );
        if distance <= 0.0 {
            return 0.0;
        }
        // x = v·t + a·t²/2 without cancellation.
        let square = v * v + 2.0 * a * distance;
        let steady = 2.0 * distance / (v + square.max(0.0).sqrt());
        if self.kind == PhaseKind::ConstantAcceleration {
            return steady.min(self.duration_s);
        }
        let (mut low, mut high) = (0.0, self.duration_s);
        let mut t = if steady < high { steady } else { 0.5 * high };
        for _ in 0..STEPS {
            let state = self.state_at(t);
            let beyond = state.position_mm - position_mm;
            if beyond > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let step = beyond / state.velocity_mm_s;
            if step.abs() <= f64::EPSILON * t || high - low <= f64::EPSILON * high {
                break;
            }
            let newton = t - step;
            t = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
        }
        t
    }

    /// What the phase does between two instants, s after its beginning.
    #[must_use]
    pub fn between(&self, from_s: f64, to_s: f64) -> Self {
        let (start, end) = (self.state_at(from_s), self.state_at(to_s));
        Self {
            kind: self.kind,
            duration_s: to_s - from_s,
            position_mm: start.position_mm,
            velocity_mm_s: start.velocity_mm_s,
            end_velocity_mm_s: if to_s >= self.duration_s {
                self.end_velocity_mm_s
            } else {
                end.velocity_mm_s
            },
            accel_mm_s2: start.accel_mm_s2,
        }
    }

    /// The phase in parts on which neither speed nor acceleration changes its
    /// sign.
    #[must_use]
    pub fn parts(&self) -> ArrayVec<Self, 4> {
        let mut parts = ArrayVec::new();
        let PhaseKind::ConstantJerk { jerk_mm_s3: j } = self.kind else {
            parts.push(*self);
            return parts;
        };
        let (v, a, end) = (self.velocity_mm_s, self.accel_mm_s2, self.duration_s);
        // v + a·t + j·t²/2 = 0 without cancellation.
        let root = -a - (a * a - 2.0 * j * v).sqrt().copysign(a);
        let stops = [root / j, 2.0 * v / root];
        let mut from = 0.0;
        let mut speed = v;
        let top = -a / j;
        // An acceleration that ends at 0 does not turn by rounding.
        let turns = top > 0.0 && top < end * (1.0 - TURN_ROUNDING);
        for to in [if turns { top } else { end }, end] {
            let last = to >= end;
            // A phase that ends at rest does not turn back by rounding.
            let reached = if last {
                self.end_velocity_mm_s
            } else {
                self.state_at(to).velocity_mm_s
            };
            let least = TURN_ROUNDING * speed.abs().max(reached.abs());
            if speed * reached < 0.0
                && speed.abs().min(reached.abs()) > least
                && let Some(stop) = stops.into_iter().find(|stop| *stop > from && *stop < to)
            {
                parts.push(self.between(from, stop));
                from = stop;
            }
            parts.push(self.between(from, to));
            if last {
                break;
            }
            (from, speed) = (to, reached);
        }
        parts
    }

    /// The same motion of a path that is counted the other way.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            kind: match self.kind {
                PhaseKind::ConstantJerk { jerk_mm_s3 } => PhaseKind::ConstantJerk {
                    jerk_mm_s3: -jerk_mm_s3,
                },
                PhaseKind::ConstantPower { power_mm2_s3 } => PhaseKind::ConstantPower {
                    power_mm2_s3: -power_mm2_s3,
                },
                kind => kind,
            },
            duration_s: self.duration_s,
            position_mm: -self.position_mm,
            velocity_mm_s: -self.velocity_mm_s,
            end_velocity_mm_s: -self.end_velocity_mm_s,
            accel_mm_s2: -self.accel_mm_s2,
        }
    }

    /// Rate of acceleration where the phase has the speed `v` and the
    /// acceleration `a`, mm/s³.
    #[must_use]
    pub fn jerk_at(&self, v: f64, a: f64) -> f64 {
        match self.kind {
            PhaseKind::ConstantAcceleration => 0.0,
            PhaseKind::ConstantJerk { jerk_mm_s3 } => jerk_mm_s3,
            PhaseKind::ConstantPower { power_mm2_s3 } => -power_mm2_s3 * a / (v * v),
            PhaseKind::ConstantSlope { slope_per_s } => slope_per_s * a,
        }
    }

    /// Bounds of the rate of acceleration (mm/s³) and of its own rate (mm/s⁴)
    /// while the speed is at least `v` and the acceleration of size `a` at
    /// most.
    #[must_use]
    pub fn rates(&self, v: f64, a: f64) -> [f64; 2] {
        let jerk = self.jerk_at(v, a).abs();
        let snap = match self.kind {
            PhaseKind::ConstantAcceleration | PhaseKind::ConstantJerk { .. } => 0.0,
            // The rate of −p·a/v² is p²·a/v⁴ + 2p·a²/v³.
            PhaseKind::ConstantPower { power_mm2_s3 } => {
                jerk * (power_mm2_s3.abs() / (v * v) + 2.0 * a / v)
            }
            PhaseKind::ConstantSlope { slope_per_s } => jerk * slope_per_s.abs(),
        };
        [jerk, snap]
    }

    /// Acceleration at the end of the phase in mm/s².
    #[must_use]
    pub fn end_accel_mm_s2(&self) -> f64 {
        let (v, a) = (self.velocity_mm_s, self.accel_mm_s2);
        match self.kind {
            PhaseKind::ConstantAcceleration => a,
            PhaseKind::ConstantJerk { jerk_mm_s3 } => a + jerk_mm_s3 * self.duration_s,
            PhaseKind::ConstantPower { power_mm2_s3 } => {
                PowerLaw::through(power_mm2_s3, v, a).accel(self.end_velocity_mm_s)
            }
            PhaseKind::ConstantSlope { slope_per_s } => {
                a + slope_per_s * (self.end_velocity_mm_s - v)
            }
        }
    }

    /// True where nothing changes but the position.
    #[must_use]
    #[inline]
    pub fn is_cruise(&self) -> bool {
        let changes = match self.kind {
            PhaseKind::ConstantJerk { jerk_mm_s3 } => jerk_mm_s3 != 0.0,
            _ => false,
        };
        self.accel_mm_s2 == 0.0 && !changes
    }

    /// Path length of the phase in mm.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        match self.kind {
            PhaseKind::ConstantAcceleration => {
                0.5 * (self.velocity_mm_s + self.end_velocity_mm_s) * self.duration_s
            }
            // The mean of the speeds at both ends, less j·t²/12 for the bend.
            PhaseKind::ConstantJerk { jerk_mm_s3: j } => {
                let (v0, v1, t) = (self.velocity_mm_s, self.end_velocity_mm_s, self.duration_s);
                (0.5 * (v0 + v1) - j * t * t / 12.0) * t
            }
            PhaseKind::ConstantPower { power_mm2_s3 } => {
                let law = PowerLaw::through(power_mm2_s3, self.velocity_mm_s, self.accel_mm_s2);
                law.length(self.velocity_mm_s, self.end_velocity_mm_s)
            }
            PhaseKind::ConstantSlope { slope_per_s } => {
                let end = slope::state(self, slope_per_s, self.duration_s);
                end.position_mm - self.position_mm
            }
        }
    }
}

/// The times and the top speed of a trapezoid or triangle from rest to rest.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_field_names, reason = "the postfixes are units")]
pub(super) struct Outline {
    /// Duration of each ramp in s.
    ramp_s: f64,
    /// Duration of the cruise in s; a triangle has none.
    cruise_s: Option<f64>,
    /// The largest speed in mm/s.
    pub top_speed: f64,
}

impl Outline {
    /// The outline of [`Profile::trapezoid`].
    #[inline]
    pub fn new(length: f64, speed: f64, accel: f64) -> Self {
        let (v, a) = (speed, accel);
        let triangle_top = (a * length).sqrt();
        if v < triangle_top {
            let ramp_s = v / a;
            Self {
                ramp_s,
                cruise_s: Some((length / v - ramp_s).max(0.0)),
                top_speed: v,
            }
        } else {
            Self {
                ramp_s: (length / a).sqrt(),
                cruise_s: None,
                top_speed: triangle_top,
            }
        }
    }

    /// How long it lasts in s.
    #[inline]
    pub fn duration_s(&self) -> f64 {
        self.ramp_s + self.cruise_s.unwrap_or(0.0) + self.ramp_s
    }
}

/// The phases of a profile: seven without allocation, more where a drive's curve
/// of force has many kinks.
pub type Phases = SmallVec<[Phase; 7]>;

/// The speed along one path, from rest to rest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Profile {
    /// The phases in order of time.
    pub phases: Phases,
}

impl Profile {
    /// The fastest profile from rest to rest over `length` (mm) with a speed
    /// of at most `speed` (mm/s) and accelerations of at most `accel` (mm/s²).
    /// All three must be positive.
    #[must_use]
    #[inline]
    pub fn trapezoid(length: f64, speed: f64, accel: f64) -> Self {
        let Outline {
            ramp_s,
            cruise_s,
            top_speed: v,
        } = Outline::new(length, speed, accel);
        let a = accel;
        let mut phases = Phases::new();
        phases.push(Phase::constant(ramp_s, 0.0, 0.0, v, a));
        if let Some(cruise_s) = cruise_s {
            let ramp_mm = 0.5 * v * ramp_s;
            phases.push(Phase::constant(cruise_s, ramp_mm, v, v, 0.0));
            phases.push(Phase::constant(ramp_s, length - ramp_mm, v, 0.0, -a));
        } else {
            phases.push(Phase::constant(ramp_s, 0.5 * length, v, 0.0, -a));
        }
        Self { phases }
    }

    /// How long it lasts in s.
    #[must_use]
    #[inline]
    pub fn duration_s(&self) -> f64 {
        self.phases.iter().map(|phase| phase.duration_s).sum()
    }

    /// How far it goes in mm.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        self.phases.iter().map(Phase::length_mm).sum()
    }

    /// The largest speed in mm/s.
    #[must_use]
    #[inline]
    pub fn top_speed_mm_s(&self) -> f64 {
        self.phases.iter().fold(0.0, |top, phase| {
            f64::max(top, phase.velocity_mm_s.max(phase.end_velocity_mm_s))
        })
    }

    /// What the profile does between two instants, s after its start. The parts
    /// of the phases that it has there, at least one.
    #[must_use]
    pub fn part(&self, from_s: f64, to_s: f64) -> Self {
        let mut part = Self::default();
        let mut start = 0.0;
        let last = self.phases.len().saturating_sub(1);
        for (index, phase) in self.phases.iter().enumerate() {
            let end = start + phase.duration_s;
            let [from, to] = [from_s, to_s].map(|t| (t - start).clamp(0.0, phase.duration_s));
            // Of a span so short that nothing is left of it, the phase that it lies in.
            let holds = to_s <= end || index == last;
            if to > from || (holds && part.phases.is_empty()) {
                part.phases.push(if to - from < phase.duration_s {
                    phase.between(from, to)
                } else {
                    *phase
                });
            }
            start = end;
        }
        part
    }

    /// The state `t` seconds after the start; before and after the profile,
    /// its first and last instant. `None` without phases.
    #[must_use]
    pub fn state_at(&self, t: f64) -> Option<State> {
        let mut rest = t.max(0.0);
        let last = self.phases.len().checked_sub(1)?;
        for (i, phase) in self.phases.iter().enumerate() {
            if rest <= phase.duration_s || i == last {
                return Some(phase.state_at(rest.min(phase.duration_s)));
            }
            rest -= phase.duration_s;
        }
        None
    }
}

impl Phase {
    /// A phase of constant acceleration `a` from speed `v0` to `v1`.
    #[inline]
    fn constant(duration_s: f64, position_mm: f64, v0: f64, v1: f64, a: f64) -> Self {
        Self {
            kind: PhaseKind::ConstantAcceleration,
            duration_s,
            position_mm,
            velocity_mm_s: v0,
            end_velocity_mm_s: v1,
            accel_mm_s2: a,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_path_is_a_trapezoid() {
        let profile = Profile::trapezoid(100.0, 50.0, 500.0);
        assert_eq!(profile.phases.len(), 3);
        assert!((profile.duration_s() - 2.1).abs() < 1e-12);
        assert!((profile.length_mm() - 100.0).abs() < 1e-12);
    }

    #[test]
    fn a_short_path_is_a_triangle() {
        let profile = Profile::trapezoid(5.0, 100.0, 500.0);
        assert_eq!(profile.top_speed_mm_s(), 50.0);
        assert!((profile.duration_s() - 0.2).abs() < 1e-15);
    }

    #[test]
    fn an_instant_is_part_of_the_phase_that_it_lies_in() {
        let profile = Profile::trapezoid(100.0, 50.0, 500.0);
        for (instant_s, accel_mm_s2) in [(0.05, 500.0), (1.0, 0.0), (2.05, -500.0)] {
            let part = profile.part(instant_s, instant_s);
            assert_eq!(part.phases.len(), 1);
            assert_eq!(part.phases[0].accel_mm_s2, accel_mm_s2);
        }
    }

    #[test]
    fn the_state_runs_from_rest_to_rest() {
        let profile = Profile::trapezoid(100.0, 50.0, 500.0);
        let state = |t| profile.state_at(t).unwrap_or_default();
        assert_eq!(state(-1.0).position_mm, 0.0);
        assert!((state(1.05).position_mm - 50.0).abs() < 1e-9);
        assert_eq!(state(1.05).velocity_mm_s, 50.0);
        assert!((state(9.0).position_mm - 100.0).abs() < 1e-9);
        assert!(state(9.0).velocity_mm_s.abs() < 1e-9);
    }
}
