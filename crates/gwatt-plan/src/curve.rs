//! Curves of acceleration over speed: what a drive can do where torque is
//! constant up to a base speed and power beyond it, or as points.
//!
//! Input: an [`AccelCurve`] for speeding up and one for braking. Output: phases
//! that follow them, or the fastest [`Profile`] over a length.
//!
//! The largest possible speed at each place is also the fastest motion: along
//! the curve to the top, a cruise if the top is the limit, and down the other
//! curve.

use super::phase::{Phase, PhaseKind};
use super::power_law::PowerLaw;
use super::profile::{Phases, Profile};
use super::slope;
use smallvec::SmallVec;
use thiserror::Error;

/// Steps at most in the search for a top speed.
const STEPS: u32 = 100;

/// Why there is no curve or no profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CurveError {
    /// Speeds do not grow, or an acceleration is not positive and finite.
    #[error("speeds must grow from point to point, and accelerations be positive")]
    Points,
    /// A speed is beyond the curve or not finite, or a length not positive.
    #[error("the speed is beyond the curve, or the length is not positive")]
    Range,
}

/// One law of acceleration between two speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    from: f64,
    to: f64,
    law: Law,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    /// Constant acceleration.
    Torque(f64),
    /// `p/v − d`.
    Power(PowerLaw),
    /// Acceleration at the lower speed, and its change by speed.
    Slope(f64, f64),
}

/// The largest acceleration, or braking, at each speed; both positive.
#[derive(Debug, Clone, PartialEq)]
pub struct AccelCurve {
    pieces: SmallVec<[Piece; 4]>,
}

impl AccelCurve {
    /// Constant torque, `accel_mm_s2`, up to the base speed `p/(accel + d)` and
    /// constant power beyond it, `a = p/v − d`, up to `max_mm_s`.
    ///
    /// `power_mm2_s3` is the power by mass; 1 W/kg is 10⁶ mm²/s³. `drag_mm_s2`
    /// is the friction by mass (1 N/kg is 10³ mm/s²): positive while speeding
    /// up, and negative in a curve of braking, which friction helps.
    ///
    /// # Errors
    ///
    /// Where acceleration, power or speed is not positive and finite, or nothing
    /// is left to accelerate with at `max_mm_s`.
    pub fn constant_power(
        accel_mm_s2: f64,
        power_mm2_s3: f64,
        drag_mm_s2: f64,
        max_mm_s: f64,
    ) -> Result<Self, CurveError> {
        let law = PowerLaw {
            power: power_mm2_s3,
            drag: drag_mm_s2,
        };
        let positive = |x: f64| x > 0.0 && x < f64::INFINITY;
        let left = law.accel(max_mm_s);
        let given = [accel_mm_s2, power_mm2_s3, max_mm_s, left];
        if !given.into_iter().all(positive) {
            return Err(CurveError::Points);
        }
        let mut pieces = SmallVec::new();
        // Where friction brakes harder than the limit, power never matters.
        let base = if accel_mm_s2 + drag_mm_s2 > 0.0 {
            (power_mm2_s3 / (accel_mm_s2 + drag_mm_s2)).min(max_mm_s)
        } else {
            max_mm_s
        };
        pieces.push(Piece {
            from: 0.0,
            to: base,
            law: Law::Torque(accel_mm_s2),
        });
        if base < max_mm_s {
            pieces.push(Piece {
                from: base,
                to: max_mm_s,
                law: Law::Power(law),
            });
        }
        Ok(Self { pieces })
    }

    /// Through points of speed (mm/s) and acceleration (mm/s²), straight
    /// between them and constant below the first.
    ///
    /// # Errors
    ///
    /// Where speeds do not grow, accelerations are not positive and finite, or
    /// there are none.
    pub fn points(points: &[(f64, f64)]) -> Result<Self, CurveError> {
        let mut pieces = SmallVec::new();
        let mut last: Option<(f64, f64)> = None;
        for &(speed, accel) in points {
            let (from, start) = last.unwrap_or((0.0, accel));
            let grows = speed > from || (last.is_none() && speed == 0.0);
            let fits = accel > 0.0 && accel < f64::INFINITY && speed < f64::INFINITY;
            if !(grows && fits) {
                return Err(CurveError::Points);
            }
            last = Some((speed, accel));
            if speed == from {
                continue;
            }
            let law = if start == accel {
                Law::Torque(accel)
            } else {
                Law::Slope(start, (accel - start) / (speed - from))
            };
            let piece = Piece {
                from,
                to: speed,
                law,
            };
            pieces.push(piece);
        }
        if pieces.is_empty() {
            return Err(CurveError::Points);
        }
        Ok(Self { pieces })
    }

    /// The largest speed of the curve in mm/s.
    #[must_use]
    pub fn max_mm_s(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.to)
    }

    /// The acceleration at a speed in mm/s²; beyond the curve that of its end.
    #[must_use]
    pub fn accel_at(&self, speed_mm_s: f64) -> f64 {
        let piece = self
            .pieces
            .iter()
            .find(|piece| speed_mm_s <= piece.to)
            .or(self.pieces.last());
        piece.map_or(0.0, |piece| piece.accel(speed_mm_s.min(piece.to)))
    }

    /// How far it takes to speed up from rest to `speed` mm/s, in mm.
    pub(super) fn length_to(&self, speed: f64) -> f64 {
        let pieces = self.pieces.iter().filter(|piece| piece.from < speed);
        pieces
            .map(|piece| piece.length(piece.from, piece.to.min(speed)))
            .sum()
    }

    /// The phases that speed up from `from_mm_s` to `to_mm_s`, beginning at the
    /// position 0.
    ///
    /// # Errors
    ///
    /// Where the speeds are not in order or beyond the curve.
    pub fn speed_up(&self, from_mm_s: f64, to_mm_s: f64) -> Result<Phases, CurveError> {
        if !(from_mm_s >= 0.0 && to_mm_s >= from_mm_s && to_mm_s <= self.max_mm_s()) {
            return Err(CurveError::Range);
        }
        let mut phases = Phases::new();
        let mut position = 0.0;
        for piece in &self.pieces {
            let (low, high) = (piece.from.max(from_mm_s), piece.to.min(to_mm_s));
            if low < high {
                phases.push(piece.up(position, low, high));
                position += piece.length(low, high);
            }
        }
        Ok(phases)
    }

    /// The phases that brake from `from_mm_s` to `to_mm_s`, beginning at the
    /// position 0.
    ///
    /// # Errors
    ///
    /// Where the speeds are not in order or beyond the curve.
    pub fn slow_down(&self, from_mm_s: f64, to_mm_s: f64) -> Result<Phases, CurveError> {
        if !(to_mm_s >= 0.0 && from_mm_s >= to_mm_s && from_mm_s <= self.max_mm_s()) {
            return Err(CurveError::Range);
        }
        let mut phases = Phases::new();
        let mut position = 0.0;
        for piece in self.pieces.iter().rev() {
            let (low, high) = (piece.from.max(to_mm_s), piece.to.min(from_mm_s));
            if low < high {
                phases.push(piece.down(position, low, high));
                position += piece.length(low, high);
            }
        }
        Ok(phases)
    }
}

impl Piece {
    fn accel(&self, v: f64) -> f64 {
        match self.law {
            Law::Torque(a) => a,
            Law::Power(law) => law.accel(v),
            Law::Slope(start, slope) => start + slope * (v - self.from),
        }
    }

    fn time(&self, low: f64, high: f64) -> f64 {
        match self.law {
            Law::Torque(a) => (high - low) / a,
            Law::Power(law) => law.time(low, high),
            Law::Slope(_, slope) => slope::time(self.accel(low), slope, high - low),
        }
    }

    fn length(&self, low: f64, high: f64) -> f64 {
        match self.law {
            Law::Torque(a) => 0.5 * (high - low) * (high + low) / a,
            Law::Power(law) => law.length(low, high),
            Law::Slope(..) => self.up(0.0, low, high).length_mm(),
        }
    }

    /// The phase from a lower to a higher speed.
    fn up(&self, position: f64, low: f64, high: f64) -> Phase {
        Phase {
            kind: match self.law {
                Law::Torque(_) => PhaseKind::ConstantAcceleration,
                Law::Power(law) => PhaseKind::ConstantPower {
                    power_mm2_s3: law.power,
                },
                Law::Slope(_, slope_per_s) => PhaseKind::ConstantSlope { slope_per_s },
            },
            duration_s: self.time(low, high),
            position_mm: position,
            velocity_mm_s: low,
            end_velocity_mm_s: high,
            accel_mm_s2: self.accel(low),
        }
    }

    /// The same in reverse: from the higher to the lower speed.
    fn down(&self, position: f64, low: f64, high: f64) -> Phase {
        let up = self.up(position, low, high);
        Phase {
            kind: match up.kind {
                PhaseKind::ConstantPower { power_mm2_s3 } => PhaseKind::ConstantPower {
                    power_mm2_s3: -power_mm2_s3,
                },
                PhaseKind::ConstantSlope { slope_per_s } => PhaseKind::ConstantSlope {
                    slope_per_s: -slope_per_s,
                },
                kind => kind,
            },
            velocity_mm_s: high,
            end_velocity_mm_s: low,
            accel_mm_s2: -self.accel(high),
            ..up
        }
    }
}

/// The fastest profile from rest to rest over `length_mm` with speeds up to
/// `speed_mm_s`, `up` speeding up and `down` braking.
///
/// # Errors
///
/// Where length or speed is not positive.
pub fn fastest(
    length_mm: f64,
    speed_mm_s: f64,
    up: &AccelCurve,
    down: &AccelCurve,
) -> Result<Profile, CurveError> {
    let limit = speed_mm_s.min(up.max_mm_s()).min(down.max_mm_s());
    if !(length_mm > 0.0 && length_mm < f64::INFINITY && limit > 0.0) {
        return Err(CurveError::Range);
    }
    let ramps = |v: f64| up.length_to(v) + down.length_to(v);
    let top = if ramps(limit) <= length_mm {
        limit
    } else {
        top_speed(length_mm, limit, ramps, |v| {
            v / up.accel_at(v) + v / down.accel_at(v)
        })
    };
    let mut profile = Profile::default();
    let mut position = 0.0;
    let mut push = |phase: Phase| {
        let phase = Phase {
            position_mm: position,
            ..phase
        };
        position += phase.length_mm();
        profile.phases.push(phase);
    };
    for phase in up.speed_up(0.0, top)? {
        push(phase);
    }
    let cruise = (length_mm - ramps(top)) / top;
    if top == limit && cruise > 0.0 {
        push(Phase {
            kind: PhaseKind::ConstantAcceleration,
            duration_s: cruise,
            position_mm: 0.0,
            velocity_mm_s: top,
            end_velocity_mm_s: top,
            accel_mm_s2: 0.0,
        });
    }
    for phase in down.slow_down(top, 0.0)? {
        push(phase);
    }
    Ok(profile)
}

/// The speed below `limit` at which both ramps make up the length.
fn top_speed(
    length: f64,
    limit: f64,
    ramps: impl Fn(f64) -> f64,
    slope: impl Fn(f64) -> f64,
) -> f64 {
    let (mut low, mut high) = (0.0, limit);
    let mut v = 0.5 * limit;
    for _ in 0..STEPS {
        let beyond = ramps(v) - length;
        if beyond > 0.0 {
            high = v;
        } else {
            low = v;
        }
        let step = beyond / slope(v);
        if step.abs() <= f64::EPSILON * v {
            break;
        }
        let newton = v - step;
        v = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
    }
    v
}
