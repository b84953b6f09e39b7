//! Pieces of the paths of S-curves: how they run as planned, and how they might where
//! other speeds are asked for.

use super::profile::Profile;
use super::s_curve::{SCurve, Steepness};

/// A piece of the path of an S-curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    curve: SCurve,
    from_mm: f64,
    /// When it begins and ends.
    time_s: [f64; 2],
    /// The limits of its own path, which the curve keeps together with others.
    own: Steepness,
    /// The largest speed that its path permits, mm/s.
    cap_mm_s: f64,
}

impl Section {
    /// The piece from `from_mm` on between two instants, with the limits of its own path
    /// and the largest speed that this permits.
    #[inline]
    pub(super) fn new(
        curve: SCurve,
        [from_mm, cap_mm_s]: [f64; 2],
        time_s: [f64; 2],
        own: Steepness,
    ) -> Self {
        Self {
            curve,
            from_mm,
            time_s,
            own,
            cap_mm_s,
        }
    }

    /// The same at a share of the speed, of a curve from rest to rest.
    #[must_use]
    pub fn slowed(&self, share: f64) -> Self {
        let top = self.curve.top.min(share * self.cap_mm_s);
        let curve = SCurve { top, ..self.curve };
        Self {
            curve,
            time_s: [0.0, curve.duration_s()],
            ..*self
        }
    }

    /// The largest speed that its path permits, mm/s.
    #[must_use]
    pub fn cap_mm_s(&self) -> f64 {
        self.cap_mm_s
    }

    /// The largest acceleration on its way from rest to that speed, mm/s².
    #[must_use]
    pub fn peak_accel_mm_s2(&self) -> f64 {
        self.own.peak(self.cap_mm_s)
    }

    /// The ramp from rest towards the largest speed by the path's own limits as far as
    /// `top_mm_s`, or the one from there to rest. Whatever curve it becomes part of, no
    /// acceleration at any speed up to there is larger: to build it up took a²/2j of
    /// speed, and to take it back takes as much, so that `a² ≤ 2·j·min(v, cap − v)`.
    #[must_use]
    pub fn ramp(&self, top_mm_s: f64, to_rest: bool) -> Profile {
        let (own, cap) = (self.own, self.cap_mm_s);
        let [first_s, hold_s, last_s] = own.phases_s(cap);
        let bend = 0.5 * own.peak(cap) * first_s;
        let whole_s = first_s + hold_s + last_s;
        let until_s = if top_mm_s >= cap {
            whole_s
        } else if top_mm_s <= bend {
            (2.0 * top_mm_s / own.jerk_mm_s3).sqrt()
        } else if top_mm_s <= cap - bend {
            first_s + (top_mm_s - bend) / own.peak(cap)
        } else {
            whole_s - (2.0 * (cap - top_mm_s) / own.jerk_mm_s3).sqrt()
        };
        let curve = SCurve {
            start: cap,
            end: cap,
            top: cap,
            steepness: own,
            length: own.length(0.0, cap),
        };
        let mut profile = Profile::default();
        if to_rest {
            curve.ramp(&mut profile, [cap, 0.0], 0.0);
            profile.part(whole_s - until_s, whole_s)
        } else {
            curve.ramp(&mut profile, [0.0, cap], 0.0);
            profile.part(0.0, until_s)
        }
    }

    /// How long it takes, s.
    #[must_use]
    #[inline]
    pub fn duration_s(&self) -> f64 {
        self.time_s[1] - self.time_s[0]
    }

    /// How it runs, from position 0 on.
    #[must_use]
    pub fn profile(&self) -> Profile {
        let [from_s, to_s] = self.time_s;
        let mut part = self.curve.profile().part(from_s, to_s);
        for phase in &mut part.phases {
            phase.position_mm -= self.from_mm;
        }
        part
    }

    /// The largest speed, of those at both ends and that of the curve, and a
    /// bound of the acceleration.
    #[inline]
    pub(super) fn extremes(&self, start: f64, end: f64) -> (f64, f64) {
        let curve = &self.curve;
        let [up, down] = [curve.start, curve.end].map(|own| curve.top - own);
        let [from_s, to_s] = self.time_s;
        let up_s = curve.steepness.time(up);
        let down_s = curve.duration_s() - curve.steepness.time(down);
        let slack = 1e-9 * (to_s - from_s);
        let mut accel = 0.0_f64;
        if from_s < up_s + slack {
            accel = curve.steepness.peak(up);
        }
        if to_s > down_s - slack {
            accel = accel.max(curve.steepness.peak(down));
        }
        let cruises = to_s >= up_s - slack && from_s <= down_s + slack;
        let top = if cruises { curve.top } else { start.max(end) };
        (top.max(start).max(end), accel)
    }

    /// A speed that is reached over the piece at least from another one, with
    /// half of the limits and without acceleration at both ends, mm/s.
    #[must_use]
    pub fn reached(&self, speed_mm_s: f64, length_mm: f64) -> f64 {
        let Steepness {
            accel_mm_s2,
            jerk_mm_s3,
        } = self.curve.steepness;
        let half = Steepness {
            accel_mm_s2: 0.5 * accel_mm_s2,
            jerk_mm_s3: 0.5 * jerk_mm_s3,
        };
        half.farthest(speed_mm_s, length_mm)
    }
}
