//! A stretch of time with one law of motion: constant jerk, or along a limit.

use super::curve::Piece;
use super::panels::integral;

/// Steps of Newton's method, which needs about five.
const STEPS: u32 = 60;

/// Speed and acceleration at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// The speed, signed.
    pub speed: f64,
    /// Its change in one second.
    pub accel: f64,
}

/// What a phase keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Law {
    /// This jerk.
    Jerk(f64),
    /// The acceleration of a curve, in this direction (±1).
    Curve(Piece, f64),
}

/// A stretch of time with one law of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RampPhase {
    pub(super) law: Law,
    /// How long it lasts in s.
    pub duration_s: f64,
    /// Speed and acceleration at its start.
    pub start: Motion,
    /// The same at its end.
    pub end: Motion,
}

impl RampPhase {
    /// Speed and acceleration `t` seconds after its start; `t` within the phase.
    #[must_use]
    pub fn at(&self, t: f64) -> Motion {
        if t >= self.duration_s {
            return self.end;
        }
        let Motion { speed, accel } = self.start;
        match self.law {
            Law::Jerk(jerk) => Motion {
                speed: speed + (accel + 0.5 * jerk * t) * t,
                accel: accel + jerk * t,
            },
            Law::Curve(piece, direction) => {
                let u = self.ridden(&piece, t);
                let side = if self.start.speed + self.end.speed < 0.0 {
                    -1.0
                } else {
                    1.0
                };
                Motion {
                    speed: side * u,
                    accel: direction * piece.at(u),
                }
            }
        }
    }

    /// What it does between two instants, s after its start.
    #[must_use]
    pub fn between(&self, from_s: f64, to_s: f64) -> Self {
        Self {
            law: self.law,
            duration_s: to_s - from_s,
            start: if from_s > 0.0 {
                self.at(from_s)
            } else {
                self.start
            },
            end: self.at(to_s),
        }
    }

    /// How far it has gone `t` seconds after its start.
    #[must_use]
    pub fn distance(&self, t: f64) -> f64 {
        let t = t.min(self.duration_s);
        let Motion { speed, accel } = self.start;
        match self.law {
            Law::Jerk(jerk) => (speed + (0.5 * accel + jerk * t / 6.0) * t) * t,
            Law::Curve(piece, direction) => {
                let (from, to) = (speed.abs(), self.at(t).speed.abs());
                // ∫ v dt = ∫ v/a dv, where v/a has the sign of the direction
                // as the bounds are magnitudes.
                let way = if piece.constant == 0.0 && piece.slope == 0.0 {
                    (to - from) * (to * to + to * from + from * from) / (3.0 * piece.hyperbola)
                } else {
                    integral(|u| u / piece.at(u), from, to)
                };
                way * direction
            }
        }
    }

    /// The jerk, if it is constant; `None` along a curve.
    #[must_use]
    pub fn jerk(&self) -> Option<f64> {
        match self.law {
            Law::Jerk(jerk) => Some(jerk),
            Law::Curve(..) => None,
        }
    }

    /// Along a curve: `h`, `c`, `k` of `h/v + c + k·v` over the magnitude of the
    /// speed; `None` at constant jerk.
    #[must_use]
    pub fn curve(&self) -> Option<[f64; 3]> {
        match self.law {
            Law::Jerk(_) => None,
            Law::Curve(piece, _) => Some([piece.hyperbola, piece.constant, piece.slope]),
        }
    }

    /// Along a curve: the time at which `speed` is passed; `None` at constant
    /// jerk, or where it is not.
    #[must_use]
    pub fn time_at(&self, speed: f64) -> Option<f64> {
        let Law::Curve(piece, _) = self.law else {
            return None;
        };
        let (from, to) = (self.start.speed, self.end.speed);
        let inside = from.min(to) < speed && speed < from.max(to);
        inside.then(|| ride_time(&piece, from.abs(), speed.abs()))
    }

    /// The magnitude of the speed `t` seconds into a ride along `piece`.
    fn ridden(&self, piece: &Piece, t: f64) -> f64 {
        let (from, to) = (self.start.speed.abs(), self.end.speed.abs());
        let rising = if to > from { 1.0 } else { -1.0 };
        if piece.constant == 0.0 && piece.slope == 0.0 {
            return (from * from + rising * 2.0 * piece.hyperbola * t).sqrt();
        }
        let (low, high) = (from.min(to), from.max(to));
        let mut u = (from + rising * piece.at(from) * t).clamp(low, high);
        for _ in 0..STEPS {
            let error = t - ride_time(piece, from, u);
            let next = (u + rising * error * piece.at(u)).clamp(low, high);
            if (next - u).abs() <= 1e-15 * high {
                return next;
            }
            u = next;
        }
        u
    }
}

/// Time along a piece of a curve between two magnitudes of the speed.
pub(super) fn ride_time(piece: &Piece, from: f64, to: f64) -> f64 {
    if piece.constant == 0.0 && piece.slope == 0.0 {
        return ((to - from) * (to + from) / (2.0 * piece.hyperbola)).abs();
    }
    integral(|u| 1.0 / piece.at(u), from, to).abs()
}
