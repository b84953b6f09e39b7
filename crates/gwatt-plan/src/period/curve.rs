//! The largest acceleration at each speed: constant torque, constant power,
//! points of a torque curve, or the lowest of several.
//!
//! A curve is a list of pieces `h/v + c + k·v` over the magnitude of the speed:
//!
//! ```text
//! constant torque       c
//! constant power        A·V_f/v                                   = h/v
//! torque points         (T(v) ∓ C)/M, T straight between points   = c + k·v
//! converter's power     (P/v ∓ C)/M                               = h/v + c
//! ```
//!
//! Speeds and accelerations are in any unit, as long as it is one.

use thiserror::Error;

/// Pieces that a curve may have.
pub const MAX_PIECES: usize = 64;

/// Why a limit cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LimitError {
    /// A quantity that must be finite and greater than zero.
    #[error("{0} must be a finite number greater than 0")]
    NotPositive(&'static str),
    /// A quantity that must be finite.
    #[error("{0} must be a finite number")]
    NotFinite(&'static str),
    /// Points are missing, too many, or not in ascending order.
    #[error(
        "a limit needs 1 to {MAX_PIECES} points, the first at speed 0, each faster than the last"
    )]
    Points,
}

/// A part of a curve: `hyperbola/v + constant + slope·v` from a speed on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    /// The speed at which it begins, not negative.
    pub from: f64,
    /// h, not negative.
    pub hyperbola: f64,
    /// c.
    pub constant: f64,
    /// k.
    pub slope: f64,
}

impl Piece {
    /// Its value at speed `v`; may be negative.
    pub fn at(&self, v: f64) -> f64 {
        let mut value = self.constant;
        // 0/0 at rest is no value.
        if self.hyperbola != 0.0 {
            value += self.hyperbola / v;
        }
        if self.slope != 0.0 {
            value += self.slope * v;
        }
        value
    }

    /// The same law from another speed on.
    fn starting(mut self, from: f64) -> Self {
        self.from = from;
        self
    }

    fn same_law(&self, other: &Self) -> bool {
        self.starting(0.0) == other.starting(0.0)
    }
}

/// The largest acceleration at each speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pieces: Vec<Piece>,
}

/// `value` if it is finite and greater than zero.
pub(super) fn positive(value: f64, name: &'static str) -> Result<f64, LimitError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(LimitError::NotPositive(name))
    }
}

impl Curve {
    /// The same acceleration at every speed.
    ///
    /// # Errors
    /// It is not finite or not positive.
    pub fn constant(accel: f64) -> Result<Self, LimitError> {
        positive(accel, "the acceleration")?;
        Ok(Self::of(Piece {
            from: 0.0,
            hyperbola: 0.0,
            constant: accel,
            slope: 0.0,
        }))
    }

    /// Constant torque up to `base_speed`, constant power above:
    /// `accel·base_speed/v`.
    ///
    /// # Errors
    /// A value is not finite or not positive.
    pub fn constant_power(accel: f64, base_speed: f64) -> Result<Self, LimitError> {
        let mut curve = Self::constant(accel)?;
        curve.pieces.push(Piece {
            from: positive(base_speed, "the base speed")?,
            hyperbola: positive(accel * base_speed, "acceleration times base speed")?,
            constant: 0.0,
            slope: 0.0,
        });
        Ok(curve)
    }

    /// Points (speed, torque), straight between them, the last torque beyond:
    /// `(torque − friction)/inertia`. A negative `friction` helps, as in braking.
    ///
    /// # Errors
    /// A value is not finite, the inertia not positive, or the speeds do not
    /// ascend from 0.
    pub fn torque(points: &[(f64, f64)], friction: f64, inertia: f64) -> Result<Self, LimitError> {
        positive(inertia, "the inertia")?;
        if !friction.is_finite() {
            return Err(LimitError::NotFinite("the friction"));
        }
        if points.is_empty() || points.len() > MAX_PIECES {
            return Err(LimitError::Points);
        }
        let mut pieces = Vec::with_capacity(points.len());
        let mut next = points.iter().skip(1);
        for &(speed, torque) in points {
            let accel = (torque - friction) / inertia;
            let (slope, constant) = match next.next() {
                Some(&(next_speed, next_torque)) if next_speed > speed => {
                    let slope = (next_torque - torque) / (inertia * (next_speed - speed));
                    (slope, accel - slope * speed)
                }
                Some(_) => return Err(LimitError::Points),
                None => (0.0, accel),
            };
            if !(slope.is_finite() && constant.is_finite() && speed.is_finite()) {
                return Err(LimitError::NotFinite("a point"));
            }
            pieces.push(Piece {
                from: speed,
                hyperbola: 0.0,
                constant,
                slope,
            });
        }
        if pieces.first().is_none_or(|first| first.from != 0.0) {
            return Err(LimitError::Points);
        }
        Ok(Self { pieces })
    }

    /// No more than a power allows: the lower of this curve and
    /// `(power/v − friction)/inertia`. A negative `friction` helps.
    ///
    /// # Errors
    /// A value is not finite, or power or inertia is not positive.
    pub fn limited_by_power(
        &self,
        power: f64,
        friction: f64,
        inertia: f64,
    ) -> Result<Self, LimitError> {
        self.limited_by_power_and_drag(power, [friction, 0.0], inertia)
    }

    /// The same with a friction that grows with the speed: the lower of this curve and
    /// `(power/v − friction − drag·v)/inertia`.
    ///
    /// # Errors
    /// A value is not finite, the drag negative, or power or inertia is not positive.
    pub fn limited_by_power_and_drag(
        &self,
        power: f64,
        [friction, drag]: [f64; 2],
        inertia: f64,
    ) -> Result<Self, LimitError> {
        positive(power, "the power")?;
        positive(inertia, "the inertia")?;
        if !friction.is_finite() || !drag.is_finite() || drag < 0.0 {
            return Err(LimitError::NotFinite("the friction"));
        }
        Ok(self.lowest(&Self::of(Piece {
            from: 0.0,
            hyperbola: positive(power / inertia, "power by inertia")?,
            constant: -friction / inertia,
            slope: -drag / inertia,
        })))
    }

    /// The lower of the two curves at each speed.
    #[must_use]
    pub fn lowest(&self, other: &Self) -> Self {
        let mut borders: Vec<f64> = self.pieces.iter().map(|piece| piece.from).collect();
        borders.extend(other.pieces.iter().map(|piece| piece.from));
        borders.sort_by(f64::total_cmp);
        borders.dedup();
        let mut pieces: Vec<Piece> = Vec::new();
        let mut ends = borders.iter().skip(1).copied();
        for &from in &borders {
            let to = ends.next().unwrap_or(f64::INFINITY);
            let (p, q) = (self.piece(from), other.piece(from));
            let mut start = from;
            for end in crossings(&p, &q, from, to).into_iter().chain([to]) {
                if start >= end {
                    continue;
                }
                let middle = if end.is_finite() {
                    0.5 * (start + end)
                } else {
                    2.0 * start + 1.0
                };
                let lower = if q.at(middle) < p.at(middle) { q } else { p };
                if pieces.last().is_none_or(|last| !last.same_law(&lower)) {
                    pieces.push(lower.starting(start));
                }
                start = end;
            }
        }
        Self { pieces }
    }

    /// This curve in another unit of speed: `speed` new units are one old unit.
    #[must_use]
    pub fn scaled(&self, speed: f64) -> Self {
        let scale = |piece: &Piece| Piece {
            from: piece.from * speed,
            hyperbola: piece.hyperbola * speed * speed,
            constant: piece.constant * speed,
            slope: piece.slope,
        };
        Self {
            pieces: self.pieces.iter().map(scale).collect(),
        }
    }

    /// The largest acceleration at speed `v` of either sign; 0 where the
    /// torque is used up.
    #[must_use]
    pub fn at(&self, v: f64) -> f64 {
        let u = v.abs();
        self.piece(u).at(u).max(0.0)
    }

    /// The jerk that following the curve asks for up to `max_speed`: the
    /// largest `A·|dA/dv|`. Constant power above a base speed `V_f`: `A²/V_f`.
    #[must_use]
    pub fn jerk_to_follow(&self, max_speed: f64) -> f64 {
        let mut ends = self.pieces.iter().skip(1).map(|piece| piece.from);
        let mut largest = 0.0_f64;
        for piece in &self.pieces {
            let end = ends.next().unwrap_or(f64::INFINITY).min(max_speed);
            if piece.from > end {
                break;
            }
            // A² is convex over each piece, so it is steepest at an end.
            for v in [piece.from, end] {
                let slope = if piece.hyperbola == 0.0 {
                    piece.slope
                } else {
                    piece.slope - piece.hyperbola / (v * v)
                };
                largest = largest.max((piece.at(v).max(0.0) * slope).abs());
            }
        }
        largest
    }

    /// The piece at speed `u`, not negative; where two meet, the faster one.
    pub(super) fn piece(&self, u: f64) -> Piece {
        let at = self.pieces.partition_point(|piece| piece.from <= u);
        let found = self.pieces.get(at.saturating_sub(1)).copied();
        found.unwrap_or(Piece {
            from: 0.0,
            hyperbola: 0.0,
            constant: 0.0,
            slope: 0.0,
        })
    }

    /// The speeds at which pieces begin, besides 0.
    pub(super) fn borders(&self) -> impl Iterator<Item = f64> {
        self.pieces.iter().skip(1).map(|piece| piece.from)
    }

    fn of(piece: Piece) -> Self {
        Self {
            pieces: vec![piece],
        }
    }
}

/// Speeds inside `from..to` where two laws cross, ascending: roots of
/// `Δk·v² + Δc·v + Δh`.
fn crossings(p: &Piece, q: &Piece, from: f64, to: f64) -> Vec<f64> {
    let (a, b, c) = (
        p.slope - q.slope,
        p.constant - q.constant,
        p.hyperbola - q.hyperbola,
    );
    let mut roots = Vec::new();
    if a == 0.0 {
        if b != 0.0 {
            roots.push(-c / b);
        }
    } else {
        let discriminant = b * b - 4.0 * a * c;
        if discriminant >= 0.0 {
            // Without the difference of numbers that are nearly equal.
            let t = -0.5 * (b + discriminant.sqrt().copysign(b));
            roots.push(t / a);
            if t != 0.0 {
                roots.push(c / t);
            }
        }
    }
    roots.retain(|root| root.is_finite() && *root > from && *root < to);
    roots.sort_by(f64::total_cmp);
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn above_base_speed_the_acceleration_falls() -> Result<(), LimitError> {
        let curve = Curve::constant_power(100.0, 50.0)?;
        assert_eq!([curve.at(-50.0), curve.at(200.0)], [100.0, 25.0]);
        assert_eq!(curve.jerk_to_follow(200.0), 200.0);
        Ok(())
    }

    #[test]
    fn torque_points_are_joined_by_straight_lines() -> Result<(), LimitError> {
        let curve = Curve::torque(&[(0.0, 10.0), (100.0, 10.0), (200.0, 4.0)], 1.0, 0.5)?;
        assert_eq!(
            [curve.at(0.0), curve.at(150.0), curve.at(900.0)],
            [18.0, 12.0, 6.0]
        );
        Ok(())
    }

    /// (P/v − C)/M with P = 300, C = 1, M = 0.5 crosses 18 at 300/(0.5·18 + 1) = 30.
    #[test]
    fn a_power_cuts_a_curve() -> Result<(), LimitError> {
        let curve = Curve::constant(18.0)?.limited_by_power(300.0, 1.0, 0.5)?;
        assert_eq!([curve.at(30.0), curve.at(0.0)], [18.0, 18.0]);
        assert!((curve.at(60.0) - 8.0).abs() < 1e-12);
        // 300 W hold 300 N·m/s: nothing is left to accelerate with.
        assert_eq!(curve.at(400.0), 0.0);
        Ok(())
    }

    #[test]
    fn bad_values_are_named() {
        assert_eq!(
            Curve::constant(f64::NAN),
            Err(LimitError::NotPositive("the acceleration"))
        );
        assert_eq!(
            Curve::torque(&[(0.0, 1.0), (0.0, 2.0)], 0.0, 1.0),
            Err(LimitError::Points)
        );
        assert_eq!(
            Curve::torque(&[(1.0, 1.0)], 0.0, 1.0),
            Err(LimitError::Points)
        );
    }
}
