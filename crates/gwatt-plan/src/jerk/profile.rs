//! The profile between two states as phases of constant jerk.

use super::super::phase::{Phase, PhaseKind, State};
use super::super::profile::Profile;
use arrayvec::ArrayVec;

/// Phases at most: three that bring a start inside the limits, and seven.
pub(super) const PHASES: usize = 10;

/// A profile of phases of constant jerk.
#[derive(Debug, Clone, PartialEq)]
pub struct JerkProfile {
    /// The phases in order of time, none of no duration. There are none where
    /// the start is the target.
    pub phases: ArrayVec<Phase, PHASES>,
    /// How many of the first phases bring a start inside the limits.
    pub brought_in: usize,
    /// The state in which it ends.
    pub end: State,
}

impl JerkProfile {
    /// A profile that does not leave its start yet.
    #[inline]
    pub(super) fn new(start: State) -> Self {
        Self {
            phases: ArrayVec::new(),
            brought_in: 0,
            end: start,
        }
    }

    /// Goes on with a jerk until the acceleration is `accel`. What takes no
    /// time is left out.
    #[inline]
    pub(super) fn ramp(&mut self, accel: f64, jerk: f64) {
        let duration_s = (accel - self.end.accel_mm_s2) / jerk;
        self.push(duration_s, jerk);
        self.end.accel_mm_s2 = accel;
    }

    /// Goes on at the present acceleration. What takes no time is left out.
    #[inline]
    pub(super) fn hold(&mut self, duration_s: f64) {
        self.push(duration_s, 0.0);
    }

    #[inline]
    fn push(&mut self, duration_s: f64, jerk_mm_s3: f64) {
        if duration_s.is_nan() || duration_s <= 0.0 {
            return;
        }
        let mut phase = Phase {
            kind: PhaseKind::ConstantJerk { jerk_mm_s3 },
            duration_s,
            position_mm: self.end.position_mm,
            velocity_mm_s: self.end.velocity_mm_s,
            end_velocity_mm_s: 0.0,
            accel_mm_s2: self.end.accel_mm_s2,
        };
        self.end = phase.state_at(duration_s);
        phase.end_velocity_mm_s = self.end.velocity_mm_s;
        // There is room for all that the solvers find.
        self.phases.try_push(phase).ok();
    }

    /// Takes the speed that has been reached for exactly `speed`.
    pub(super) fn level(&mut self, speed: f64) {
        self.end.velocity_mm_s = speed;
        if let Some(last) = self.phases.last_mut() {
            last.end_velocity_mm_s = speed;
        }
    }

    /// Makes a cruise longer by `length`, or shorter.
    pub(super) fn lengthen(&mut self, cruise: usize, length: f64) {
        let mut later = self.phases.iter_mut().skip(cruise);
        if let Some(phase) = later.next() {
            let duration_s = phase.duration_s + length / phase.velocity_mm_s;
            phase.duration_s = duration_s.max(0.0);
        }
        later.for_each(|phase| phase.position_mm += length);
        self.end.position_mm += length;
    }

    /// Ends exactly in the target: what rounding has left is taken off.
    #[inline]
    pub(super) fn arrive(&mut self, position: f64, speed: f64, accel: f64) {
        self.end = State {
            position_mm: position,
            velocity_mm_s: speed,
            accel_mm_s2: accel,
        };
        if let Some(last) = self.phases.last_mut() {
            last.end_velocity_mm_s = speed;
        }
    }

    /// How long it lasts in s.
    #[must_use]
    #[inline]
    pub fn duration_s(&self) -> f64 {
        self.phases.iter().map(|phase| phase.duration_s).sum()
    }

    /// How long it takes to bring the start inside the limits, in s.
    #[must_use]
    pub fn brought_in_s(&self) -> f64 {
        let first = self.phases.iter().take(self.brought_in);
        first.map(|phase| phase.duration_s).sum()
    }

    /// The state `t` seconds after the start; before and after the profile its
    /// first and last instant.
    #[must_use]
    pub fn state_at(&self, t: f64) -> State {
        let mut rest = t.max(0.0);
        for phase in &self.phases {
            if rest < phase.duration_s {
                return phase.state_at(rest);
            }
            rest -= phase.duration_s;
        }
        self.end
    }

    /// The same as the profile of a path.
    #[must_use]
    pub fn path(&self) -> Profile {
        Profile {
            phases: self.phases.iter().copied().collect(),
        }
    }
}
