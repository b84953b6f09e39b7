//! A slice of time with the power as a polynomial.

use super::super::polynomial::Polynomial;
use arrayvec::ArrayVec;

/// Halvings that locate an instant.
const HALVINGS: u32 = 60;

/// Power over a stretch of time: exact, or an upper bound of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slice {
    /// How long it lasts in s.
    pub duration_s: f64,
    /// The polynomial's variable at both ends; it runs evenly in between.
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// Power in W.
    pub(crate) power: Polynomial,
}

impl Slice {
    /// The same power all the time.
    #[must_use]
    pub fn constant(duration_s: f64, power_w: f64) -> Self {
        Self::linear(duration_s, power_w, power_w)
    }

    /// Power that changes evenly.
    #[must_use]
    pub fn linear(duration_s: f64, from_w: f64, to_w: f64) -> Self {
        Self::even(duration_s, from_w, to_w - from_w)
    }

    /// Power that changes evenly by so much.
    #[inline]
    pub(crate) fn even(duration_s: f64, from_w: f64, change_w: f64) -> Self {
        Self {
            duration_s,
            from: 0.0,
            to: 1.0,
            power: Polynomial([from_w, change_w, 0.0, 0.0, 0.0]),
        }
    }

    /// The power at both ends, where it changes evenly.
    #[inline]
    fn ends_w(&self) -> Option<[f64; 2]> {
        let [from_w, change_w, rest @ ..] = self.power.0;
        let value = |z: f64| change_w * z + from_w;
        (rest == [0.0; 3]).then(|| [value(self.from), value(self.to)])
    }

    /// Whether it is plain that the power changes evenly.
    pub(crate) fn is_even(&self) -> bool {
        self.ends_w().is_some()
    }

    /// The same with so much more power.
    #[inline]
    pub(crate) fn raised(&self, by_w: f64) -> Self {
        let mut raised = *self;
        raised.power.0[0] += by_w;
        raised
    }

    /// What lies before an instant, s after its beginning, and what lies after it.
    pub(crate) fn cut(&self, t: f64) -> [Option<Self>; 2] {
        if t >= self.duration_s {
            return [Some(*self), None];
        }
        if t <= 0.0 {
            return [None, Some(*self)];
        }
        let at = self.at(t);
        [Some(self.part(self.from, at)), Some(self.part(at, self.to))]
    }

    /// Whether it is plain that it is nowhere above a level.
    #[inline]
    pub(crate) fn keeps_below(&self, level_w: f64) -> bool {
        self.ends_w()
            .is_some_and(|ends| ends[0] <= level_w && ends[1] <= level_w)
    }

    /// Whether it is plain that it is nowhere below a level.
    #[inline]
    pub(crate) fn keeps_above(&self, level_w: f64) -> bool {
        self.ends_w()
            .is_some_and(|ends| ends[0] >= level_w && ends[1] >= level_w)
    }

    /// Power in W, `t` seconds after the beginning.
    #[must_use]
    pub fn power_w(&self, t: f64) -> f64 {
        self.power.value(self.at(t))
    }

    /// The largest power in W.
    #[must_use]
    pub fn peak_w(&self) -> f64 {
        let inside = self.power.derivative().roots(self.from, self.to);
        let ends = [self.from, self.to];
        let values = inside.into_iter().chain(ends).map(|z| self.power.value(z));
        values.fold(f64::NEG_INFINITY, super::super::demand::larger)
    }

    /// The least power in W.
    pub(crate) fn least_w(&self) -> f64 {
        let inside = self.power.derivative().roots(self.from, self.to);
        let ends = [self.from, self.to];
        let values = inside.into_iter().chain(ends).map(|z| self.power.value(z));
        values.fold(f64::INFINITY, f64::min)
    }

    /// Its energy in J.
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        self.seconds_by_variable() * self.power.integral(self.from, self.to)
    }

    /// The variable after `t` seconds.
    pub(crate) fn at(&self, t: f64) -> f64 {
        self.from + (self.to - self.from) * (t / self.duration_s)
    }

    /// What lies between two values of the variable.
    pub(crate) fn part(&self, from: f64, to: f64) -> Self {
        Self {
            duration_s: (to - from) * self.seconds_by_variable(),
            from,
            to,
            power: self.power,
        }
    }

    fn seconds_by_variable(&self) -> f64 {
        if self.to > self.from {
            self.duration_s / (self.to - self.from)
        } else {
            0.0
        }
    }

    /// The parts on which the power keeps to one side of a level, each with
    /// whether it lies above.
    pub(crate) fn sides(&self, level_w: f64) -> ArrayVec<(Self, bool), 5> {
        let mut sides = ArrayVec::new();
        let mut above = self.power;
        above.0[0] -= level_w;
        let mut from = self.from;
        let roots = above.roots(self.from, self.to);
        for to in roots.into_iter().chain([self.to]) {
            if to > from {
                let middle = 0.5 * (from + to);
                // What is no number lies above everything.
                let below = above.value(middle) <= 0.0;
                sides.push((self.part(from, to), !below));
                from = to;
            }
        }
        sides
    }

    /// The integral of the squared power up to values of the variable, from that
    /// of another one: primitive function, in W²·s.
    pub(crate) fn squares(&self) -> Squares {
        let [a, b, rest @ ..] = self.power.0;
        let seconds = self.seconds_by_variable();
        if rest == [0.0; 3] {
            let terms = Terms::Even([a * a, a * b, b * b / 3.0]);
            return Squares { terms, seconds };
        }
        let mut square = [0.0; 9];
        for (i, a) in self.power.0.iter().enumerate() {
            for (j, b) in self.power.0.iter().enumerate() {
                square[i + j] += a * b;
            }
        }
        let mut degree = 0.0;
        let terms = Terms::Any(square.map(|c| {
            degree += 1.0;
            c / degree
        }));
        Squares { terms, seconds }
    }

    /// The instant at which `start_j` more than the energy beyond a level has
    /// been used up: of a slice that lies below the level all along. None where
    /// it lasts longer.
    pub(crate) fn emptied(&self, start_j: f64, level_w: f64) -> Option<f64> {
        let left = |z: f64| {
            let part = self.part(self.from, z);
            start_j + part.energy_j() - level_w * part.duration_s
        };
        if left(self.to) > 0.0 {
            return None;
        }
        let (mut low, mut high) = (self.from, self.to);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if left(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high)
    }
}

/// The integral of a squared power.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Squares {
    terms: Terms,
    seconds: f64,
}

/// Coefficients of the primitive function from degree 1 on.
#[derive(Debug, Clone, Copy)]
enum Terms {
    /// Of a power that changes evenly.
    Even([f64; 3]),
    Any([f64; 9]),
}

impl Squares {
    /// Between two values of the variable, W²·s.
    pub fn between(&self, from: f64, to: f64) -> f64 {
        (self.primitive(to) - self.primitive(from)).max(0.0) * self.seconds
    }

    fn primitive(&self, z: f64) -> f64 {
        match &self.terms {
            Terms::Even([a, b, c]) => ((c * z + b) * z + a) * z,
            Terms::Any(terms) => terms.iter().rev().fold(0.0, |sum, c| sum * z + c) * z,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_by_hand() {
        // 0 to 600 W in 3 s: 900 J, ∫P² = 600²·3/3.
        let slice = Slice::linear(3.0, 0.0, 600.0);
        assert_eq!(slice.energy_j(), 900.0);
        assert!((slice.squares().between(0.0, 1.0) - 360_000.0).abs() < 1e-6);
        assert_eq!(slice.peak_w(), 600.0);
        assert_eq!(slice.power_w(1.0), 200.0);
        let sides = slice.sides(200.0);
        assert_eq!(sides.len(), 2);
        assert!((sides[0].0.duration_s - 1.0).abs() < 1e-12 && !sides[0].1);
        assert!((sides[1].0.energy_j() - 800.0).abs() < 1e-9 && sides[1].1);
    }

    #[test]
    fn a_store_runs_empty() {
        // 100 J left, and 100 W more than is drawn: empty after 1 s of 4.
        let slice = Slice::constant(4.0, 200.0);
        assert!((slice.emptied(100.0, 300.0).unwrap_or(9.0) - 0.25).abs() < 1e-12);
        assert_eq!(slice.emptied(401.0, 300.0), None);
    }

    #[test]
    fn what_is_no_number_lies_above() {
        let slice = Slice::constant(1.0, f64::NAN);
        assert!(slice.sides(5.0).iter().all(|(_, above)| *above));
        assert_eq!(slice.peak_w(), f64::INFINITY);
    }
}
