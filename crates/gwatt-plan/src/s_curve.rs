//! S-curves: ramps of limited jerk between two speeds, without acceleration at
//! both, and the profiles that they make up.
//!
//! ```text
//!  a │   ______          With Δ the change of speed the largest acceleration is
//!    │  /      \         α = min(a, √(j·Δ)), the time T = Δ/α + α/j, and since
//!    │ /        \        the ramp is symmetrical the length (v₀ + v₁)/2·T.
//!    └─────────────→ t
//! ```
//!
//! The jerk may be infinite: then the ramps are those of a trapezoid.

use super::phase::{Phase, PhaseKind};
use super::profile::Profile;

/// Steps of a search at most.
const STEPS: u32 = 100;
/// Parts of a length that are no cruise of their own.
const NOTHING: f64 = 1e-12;

/// The limits of a ramp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Steepness {
    /// In mm/s², positive.
    pub accel_mm_s2: f64,
    /// In mm/s³, positive; infinite: no limit.
    pub jerk_mm_s3: f64,
}

impl Steepness {
    /// No limit.
    pub const NONE: Self = Self {
        accel_mm_s2: f64::INFINITY,
        jerk_mm_s3: f64::INFINITY,
    };

    /// The lower limits of two.
    #[inline]
    pub fn lowest(self, other: Self) -> Self {
        let lower = |a: f64, b: f64| if b < a { b } else { a };
        Self {
            accel_mm_s2: lower(self.accel_mm_s2, other.accel_mm_s2),
            jerk_mm_s3: lower(self.jerk_mm_s3, other.jerk_mm_s3),
        }
    }

    /// Change of speed from which on the acceleration is reached, mm/s.
    #[inline]
    fn knee(self) -> f64 {
        self.accel_mm_s2 * self.accel_mm_s2 / self.jerk_mm_s3
    }

    /// Largest acceleration in a change of speed, mm/s².
    #[inline]
    pub fn peak(self, change: f64) -> f64 {
        if change >= self.knee() {
            self.accel_mm_s2
        } else {
            (self.jerk_mm_s3 * change).sqrt()
        }
    }

    /// How long a change of speed takes, s.
    #[inline]
    pub fn time(self, change: f64) -> f64 {
        if change <= 0.0 {
            0.0
        } else if change >= self.knee() {
            change / self.accel_mm_s2 + self.accel_mm_s2 / self.jerk_mm_s3
        } else {
            2.0 * (change / self.jerk_mm_s3).sqrt()
        }
    }

    /// How long the phases of a change of speed last, s: jerk, acceleration,
    /// jerk.
    #[inline]
    pub(super) fn phases_s(self, change: f64) -> [f64; 3] {
        if change <= 0.0 {
            return [0.0; 3];
        }
        let a = self.peak(change);
        let jerk_s = a / self.jerk_mm_s3;
        [jerk_s, (change / a - jerk_s).max(0.0), jerk_s]
    }

    /// How far it takes to change between a lower and a higher speed, mm.
    #[inline]
    pub fn length(self, low: f64, high: f64) -> f64 {
        0.5 * (low + high) * self.time(high - low)
    }

    /// A length within which `high` is reached from any lower speed, mm; see
    /// [`Self::farthest`].
    #[inline]
    pub fn longest(self, high: f64) -> f64 {
        let c = self.knee();
        let worst = if high >= 1.5 * c { 0.5 * c } else { high / 3.0 };
        self.length(worst, high) * (1.0 + 1e-9)
    }

    /// A speed that can be reached from the speed `low` over a length, and from
    /// which `low` can be reached, mm/s. It grows with `low`.
    ///
    /// At full acceleration a ramp from v₀ to v₁ with `c = a²/j` is
    /// `(v₀ + v₁)/2·((v₁ − v₀)/a + a/j)` long, without it
    /// `(v₀ + v₁)·√((v₁ − v₀)/j)`. Neither falls with a higher v₀ below v₁/3, or
    /// below c/2: to a slow speed it is farther than to rest. Up to there the
    /// longest one counts, so that the result always grows.
    #[inline]
    pub fn farthest(self, low: f64, length: f64) -> f64 {
        let (a, j, c) = (self.accel_mm_s2, self.jerk_mm_s3, self.knee());
        // From the speed to which it is farthest.
        let braked = (2.0 * a * length).sqrt();
        let (free, worst) = if braked >= 2.0 * c {
            (braked - 0.5 * c, 0.5 * c)
        } else {
            // (4/3)·v·√(2·v/(3·j)) = L
            let free = cbrt_of_square(0.84375_f64.sqrt() * length * j.sqrt());
            (free, free / 3.0)
        };
        let free = free * (1.0 - 1e-13);
        if low <= worst {
            return free;
        }
        let at_knee = (2.0 * low + c) * (a / j);
        let change = if length >= at_knee {
            // Δ² + Δ·(2·v + c) + 2·v·c − 2·a·L = 0 without cancellation.
            let b = 2.0 * low - c;
            let root = (b * b + 8.0 * a * length).sqrt();
            4.0 * (a * length - low * c) / (root + 2.0 * low + c)
        } else {
            // x³ + 2·v·x = L·√j with x = √Δ, from above.
            let (p, q) = (2.0 * low, length * j.sqrt());
            let mut x = q / p;
            for _ in 0..STEPS {
                let step = (x * (x * x + p) - q) / (3.0 * x * x + p);
                x -= step;
                if step <= 1e-15 * x {
                    break;
                }
            }
            x * x
        };
        // No further than the length, whatever rounding does.
        let change = change * (1.0 - 1e-13);
        free.max(low + (change - f64::EPSILON * (low + change)).max(0.0))
    }

    /// The speed that is reached from rest in half a length, if none other
    /// limits it, mm/s: the top of a path from rest to rest.
    #[inline]
    pub fn top_from_rest(self, length: f64) -> f64 {
        let (a, j) = (self.accel_mm_s2, self.jerk_mm_s3);
        // v²/a + v·a/j = L, solved without cancellation.
        let delay = a / j;
        let v = 2.0 * length / (delay + (delay * delay + 4.0 * length / a).sqrt());
        if v >= self.knee() {
            v
        } else {
            // 2·v·√(v/j) = L
            cbrt_of_square(0.5 * length * j.sqrt())
        }
    }

    /// The top speed of a path of `length` between the speeds `v0` and `v1`,
    /// of which each can be reached from the other; at most `cap`.
    pub fn top(self, [v0, v1]: [f64; 2], cap: f64, length: f64) -> f64 {
        let ramps = |v: f64| self.length(v0, v) + self.length(v1, v);
        if ramps(cap) <= length {
            return cap;
        }
        let (mut low, mut high) = (v0.max(v1), cap);
        let mut v = 0.5 * (low + high);
        for _ in 0..STEPS {
            let beyond = ramps(v) - length;
            if beyond > 0.0 {
                high = v;
            } else {
                low = v;
            }
            if high - low <= 4.0 * f64::EPSILON * high {
                break;
            }
            let newton = v - beyond / (self.slope(v0, v) + self.slope(v1, v));
            // On the lower side: what is missing becomes a cruise.
            let newton = newton * (1.0 - f64::EPSILON);
            v = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
        }
        low
    }

    /// Change of [`Self::length`] by the higher speed, s.
    fn slope(self, low: f64, high: f64) -> f64 {
        let change = high - low;
        if change <= 0.0 {
            // Infinitely steep where jerk is limited.
            return 0.0;
        }
        let by_change = if change >= self.knee() {
            1.0 / self.accel_mm_s2
        } else {
            1.0 / (self.jerk_mm_s3 * change).sqrt()
        };
        0.5 * self.time(change) + 0.5 * (low + high) * by_change
    }
}

/// The cube root of x², which itself may be too large or too small.
#[inline]
pub(super) fn cbrt_of_square(x: f64) -> f64 {
    let root = libm::cbrt(x);
    root * root
}

/// A path between two speeds without acceleration at both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SCurve {
    /// Speed at its start, mm/s.
    pub start: f64,
    /// Speed at its end, mm/s.
    pub end: f64,
    /// The largest speed, mm/s.
    pub top: f64,
    /// The limits of its ramps.
    pub steepness: Steepness,
    /// How far it goes, mm.
    pub length: f64,
}

impl SCurve {
    /// The fastest from rest to rest over `length` mm with speeds up to `speed`
    /// mm/s; all positive.
    #[inline]
    pub fn from_rest(length: f64, speed: f64, steepness: Steepness) -> Self {
        Self {
            start: 0.0,
            end: 0.0,
            top: speed.min(steepness.top_from_rest(length)),
            steepness,
            length,
        }
    }

    /// Length of the cruise, mm.
    #[inline]
    fn cruise_mm(&self) -> f64 {
        let ramps =
            self.steepness.length(self.start, self.top) + self.steepness.length(self.end, self.top);
        let cruise = self.length - ramps;
        if cruise > NOTHING * self.length {
            cruise
        } else {
            0.0
        }
    }

    /// How long it lasts, s.
    #[inline]
    pub fn duration_s(&self) -> f64 {
        let cruise_mm = self.cruise_mm();
        let cruise_s = if cruise_mm > 0.0 {
            cruise_mm / self.top
        } else {
            0.0
        };
        // In the order of the profile, so that no bit differs.
        let [a, b, c] = self.steepness.phases_s(self.top - self.start);
        let [d, e, f] = self.steepness.phases_s(self.top - self.end);
        a + b + c + cruise_s + d + e + f
    }

    /// How it runs: seven phases at most.
    pub fn profile(&self) -> Profile {
        let mut profile = Profile::default();
        self.ramp(&mut profile, [self.start, self.top], 0.0);
        let cruise_mm = self.cruise_mm();
        if cruise_mm > 0.0 {
            let (up_mm, v) = (self.steepness.length(self.start, self.top), self.top);
            push(&mut profile, 0.0, cruise_mm / v, up_mm, [v, v], 0.0);
        }
        let down_mm = self.steepness.length(self.end, self.top);
        self.ramp(&mut profile, [self.top, self.end], self.length - down_mm);
        profile
    }

    /// Appends the phases from one speed to another, beginning at a position.
    pub(super) fn ramp(&self, profile: &mut Profile, [v0, v1]: [f64; 2], position: f64) {
        let change = (v1 - v0).abs();
        if change <= 0.0 {
            return;
        }
        let sign = if v1 > v0 { 1.0 } else { -1.0 };
        let j = self.steepness.jerk_mm_s3;
        let a = self.steepness.peak(change);
        let [jerk_s, hold_s, _] = self.steepness.phases_s(change);
        let [mut position, mut v] = [position, v0];
        // Speed that each phase of jerk makes, and the length of that bend.
        let step = sign * 0.5 * a * jerk_s;
        let bend = sign * a * jerk_s * jerk_s / 6.0;
        if jerk_s > 0.0 {
            push(profile, sign * j, jerk_s, position, [v, v + step], 0.0);
            position += v * jerk_s + bend;
            v += step;
        }
        if hold_s > 0.0 {
            let end = if jerk_s > 0.0 { v1 - step } else { v1 };
            push(profile, 0.0, hold_s, position, [v, end], sign * a);
            position += 0.5 * (v + end) * hold_s;
            v = end;
        }
        if jerk_s > 0.0 {
            push(profile, -sign * j, jerk_s, position, [v, v1], sign * a);
        }
    }
}

/// Appends a phase.
fn push(
    profile: &mut Profile,
    jerk_mm_s3: f64,
    duration_s: f64,
    position_mm: f64,
    [velocity_mm_s, end_velocity_mm_s]: [f64; 2],
    accel_mm_s2: f64,
) {
    let kind = if jerk_mm_s3 == 0.0 {
        PhaseKind::ConstantAcceleration
    } else {
        PhaseKind::ConstantJerk { jerk_mm_s3 }
    };
    let phase = Phase {
        kind,
        duration_s,
        position_mm,
        velocity_mm_s,
        end_velocity_mm_s,
        accel_mm_s2,
    };
    // Two ramps of three phases, and a cruise.
    profile.phases.push(phase);
}

#[cfg(test)]
mod tests {
    use super::{SCurve, Steepness};

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} is not {b}");
    }

    const USUAL: Steepness = Steepness {
        accel_mm_s2: 2000.0,
        jerk_mm_s3: 40_000.0,
    };

    #[test]
    fn a_long_path_has_seven_phases() {
        // α = 2000 after 50 ms, 200 mm/s after 150 ms and 15 mm.
        let curve = SCurve::from_rest(100.0, 200.0, USUAL);
        let profile = curve.profile();
        assert_eq!(profile.phases.len(), 7);
        close(curve.duration_s(), 0.65);
        close(profile.duration_s(), 0.65);
        close(profile.length_mm(), 100.0);
        let speeds = [0.0, 50.0, 150.0, 200.0, 200.0, 150.0, 50.0];
        for (phase, speed) in profile.phases.iter().zip(speeds) {
            close(phase.velocity_mm_s, speed);
        }
    }

    #[test]
    fn a_shorter_path_has_no_cruise_and_a_short_one_no_hold() {
        // v²/2000 + v/20 = 20: v = 50·(−1 + √17) is above the knee of 100.
        let curve = SCurve::from_rest(20.0, 1000.0, USUAL);
        assert_eq!(curve.profile().phases.len(), 6);
        close(curve.top, 50.0 * (17.0_f64.sqrt() - 1.0));
        close(curve.profile().length_mm(), 20.0);
        // 2·v·√(v/j) = L: of 2.5 mm v = 40, with 40 ms and 1600 mm/s² − less
        // than 2000: four phases of √(v/j).
        let length = 2.0 * 40.0 * (40.0_f64 / 40e3).sqrt();
        let curve = SCurve::from_rest(length, 1000.0, USUAL);
        assert_eq!(curve.profile().phases.len(), 4);
        close(curve.top, 40.0);
        close(curve.duration_s(), 4.0 * (40.0_f64 / 40e3).sqrt());
    }

    #[test]
    fn without_a_limit_of_jerk_it_is_a_trapezoid() {
        let steep = Steepness {
            jerk_mm_s3: f64::INFINITY,
            ..USUAL
        };
        let curve = SCurve::from_rest(100.0, 200.0, steep);
        let profile = curve.profile();
        assert_eq!(profile.phases.len(), 3);
        close(profile.duration_s(), 0.6);
        close(profile.length_mm(), 100.0);
        close(SCurve::from_rest(5.0, 200.0, steep).top, 100.0);
    }
}
