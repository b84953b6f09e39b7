//! All profiles between two states that go as far as can be in their time.
//!
//! Input: a [`Task`]: two states and a distance, in units in which the jerk is
//! 1. Output: the fastest [`Way`] among those that rise first.
//!
//! Of all motions between two speeds and accelerations that take a given time,
//! the one that goes farthest has the jerks + − − + around at most three holds:
//!
//! ```text
//!  a │    ____             up to x ≤ A, held for h; down, with a cruise at 0
//!    │   /  x \            where the speed is at its limit; down to y ≥ −B,
//!    │  /      \__         held for k; up to a₁.
//!    │ /          \    /
//!    │             \__/ y
//!    └───────────────────→ t
//! ```
//!
//! The fastest motion over a distance either goes farthest in its time or least
//! far, which is the same with all signs changed. With `λ = v − a²/2` at both
//! ends (λ₀, λ₁) and `w` the speed where the way down crosses a = 0,
//!
//! ```text
//! w = λ₀ + x² + A·h = λ₁ + y² + B·k,     x² − y² + A·h − B·k = λ₁ − λ₀ = K
//! ```
//!
//! so one free quantity remains, over which the distance is a function whose
//! critical points have closed forms: each piece between them holds at most one
//! solution.

use super::root::{Sample, is_root, roots};

/// How far rounding may turn an interval round, relative to the limits.
const TURNED: f64 = 1e-12;

/// Rounding of a sum of speeds, relative to its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Two states and a distance; jerk 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task {
    /// Speed and acceleration at the start.
    pub start: [f64; 2],
    /// Speed and acceleration at the end.
    pub end: [f64; 2],
    /// From start to end.
    pub distance: f64,
    /// A, the largest acceleration.
    pub rise: f64,
    /// B, the largest deceleration, positive.
    pub fall: f64,
    /// The largest speed.
    pub speed: f64,
}

/// A profile: `x`, `h`, the cruise, `y` and `k`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Way {
    pub peak: f64,
    pub peak_hold: f64,
    pub cruise: f64,
    pub trough: f64,
    pub trough_hold: f64,
    /// How long it takes.
    pub total: f64,
}

/// What all families share.
struct Family<'a> {
    task: &'a Task,
    a0: f64,
    a1: f64,
    /// λ₀, λ₁ and K.
    low0: f64,
    low1: f64,
    change: f64,
    /// Rounding of these.
    rounding: f64,
    /// The distance less what does not depend on the way.
    rest: f64,
    /// The size of what was subtracted.
    size: f64,
    /// Largest x and −y at which the speed stays within its limit.
    peak_max: f64,
    trough_max: f64,
    best: Option<Way>,
    /// The way that misses by least, and by how much.
    nearest: Option<(f64, Way)>,
}

/// The fastest of the ways that rise first, with what it misses the distance
/// by, relative to its terms: 0 unless rounding hides the solution.
pub(super) fn fastest(task: &Task) -> Option<(f64, Way)> {
    let ([v0, a0], [v1, a1]) = (task.start, task.end);
    let (low0, low1) = (v0 - 0.5 * a0 * a0, v1 - 0.5 * a1 * a1);
    let fixed = [
        -low0 * a0,
        -a0 * a0 * a0 / 6.0,
        low1 * a1,
        a1 * a1 * a1 / 6.0,
    ];
    let rounding = ROUNDING * (v0.abs() + v1.abs() + a0 * a0 + a1 * a1);
    let mut family = Family {
        task,
        a0,
        a1,
        low0,
        low1,
        change: without((v1 - v0) + 0.5 * (a0 - a1) * (a0 + a1), rounding),
        rounding,
        rest: task.distance - fixed.iter().sum::<f64>(),
        size: task.distance.abs() + fixed.iter().map(|term| term.abs()).sum::<f64>(),
        // A start that is only just inside may be outside by rounding.
        peak_max: (task.speed - low0).max(0.0).sqrt().max(a0),
        trough_max: (task.speed - low1).max(0.0).sqrt().max(-a1),
        best: None,
        nearest: None,
    };
    family.without_hold();
    family.held_at_peak();
    family.held_at_trough();
    family.held_at_both();
    family.with_cruise();
    family.best.map(|way| (0.0, way)).or(family.nearest)
}

impl Family<'_> {
    /// Takes in a way whose distance is wrong by `residual`.
    fn offer(&mut self, residual: f64, peak: f64, peak_hold: f64, trough: f64, trough_hold: f64) {
        self.offer_cruise(residual, [peak, trough], [peak_hold, trough_hold], 0.0);
    }

    fn offer_cruise(&mut self, residual: f64, [x, y]: [f64; 2], holds: [f64; 2], cruise: f64) {
        let peak = x.max(self.a0).min(self.task.rise);
        let trough = y.min(self.a1).max(-self.task.fall).min(peak);
        let [peak_hold, trough_hold] = holds.map(|hold| hold.max(0.0));
        let way = Way {
            peak,
            peak_hold,
            cruise,
            trough,
            trough_hold,
            total: 2.0 * (peak - trough) - self.a0 + self.a1 + peak_hold + cruise + trough_hold,
        };
        if is_root(residual) {
            if self.best.is_none_or(|best| way.total < best.total) {
                self.best = Some(way);
            }
        } else if self.nearest.is_none_or(|(least, _)| residual < least) {
            self.nearest = Some((residual, way));
        }
    }

    /// Neither x nor y is held: `x² − y² = K`. With d = x − y and S = λ₀ + λ₁
    /// the distance is `d³/4 + S·d − K²/4d`.
    fn without_hold(&mut self) {
        let (k, sum) = (self.change, self.low0 + self.low1);
        // Critical where 3d⁴ + 4S·d² + K² = 0.
        let inner = 4.0 * sum * sum - 3.0 * k * k;
        let critical = if sum < 0.0 && inner >= 0.0 {
            let square = (inner.sqrt() - 2.0 * sum) / 3.0;
            [square.sqrt(), (k * k / (3.0 * square)).sqrt()]
        } else {
            [f64::NAN; 2]
        };
        // The side whose square is smaller is the free quantity: the other
        // one is a root of a sum.
        let upper = k >= 0.0;
        let intervals = if upper {
            let bound = Bound {
                low: -self.task.fall.min(self.trough_max),
                high: self.a1,
                inner: without(self.a0.max(0.0) * self.a0 - k, self.rounding),
                outer: self.task.rise * self.task.rise - k,
            };
            bound.intervals()
        } else {
            let bound = Bound {
                low: self.a0,
                high: self.task.rise.min(self.peak_max),
                inner: without((-self.a1).max(0.0) * -self.a1 + k, self.rounding),
                outer: self.task.fall * self.task.fall + k,
            };
            bound.intervals()
        };
        // x and y of the free quantity, and x + y and d without cancellation.
        let pair = move |free: f64| {
            let other = (free * free + k.abs()).sqrt();
            let (x, y) = if upper { (other, free) } else { (free, -other) };
            let far_apart = (x >= 0.0) != (y >= 0.0);
            let (plus, d) = if far_apart {
                (if x == y { 0.0 } else { k / (x - y) }, x - y)
            } else {
                let plus = x + y;
                (plus, if plus == 0.0 { 0.0 } else { k / plus })
            };
            (x, y, plus, d)
        };
        let (rest, size) = (self.rest, self.size);
        let distance = move |free: f64| {
            let (x, y, plus, d) = pair(free);
            let terms = [0.25 * d * d * d, sum * d, -0.25 * k * plus];
            let slope = 3.0 * terms[0] + terms[1] - terms[2];
            Sample {
                value: terms.iter().sum::<f64>() - rest,
                slope: if upper { -slope / x } else { -slope / y },
                size: size + terms.iter().map(|term| term.abs()).sum::<f64>(),
            }
        };
        let critical = critical.map(|d| {
            let half = 0.5 * k / d;
            if upper {
                half - 0.5 * d
            } else {
                half + 0.5 * d
            }
        });
        for interval in intervals.into_iter().flatten() {
            roots(interval, critical, distance, |free, residual| {
                let (x, y, ..) = pair(free);
                self.offer(residual, x, 0.0, y, 0.0);
            });
        }
    }

    /// x = A is held for `h = (K + y² − A²)/A`; y is free.
    fn held_at_peak(&mut self) {
        let (a, k, low0, low1) = (self.task.rise, self.change, self.low0, self.low1);
        let bound = Bound {
            low: -self.task.fall.min(self.trough_max),
            high: self.a1.min(a),
            inner: a * a - k,
            outer: f64::INFINITY,
        };
        let hold = move |y: f64| (k + y * y - a * a) / a;
        let (rest, size) = (self.rest, self.size);
        let distance = move |y: f64| {
            let h = hold(y);
            let terms = [
                2.0 * low0 * a,
                a * a * a,
                h * (low0 + 1.5 * a * a),
                0.5 * a * h * h,
                -2.0 * low1 * y,
                -y * y * y,
            ];
            Sample {
                value: terms.iter().sum::<f64>() - rest,
                slope: (y - a) * (2.0 * y * y - a * y + 2.0 * low1) / a,
                size: size + terms.iter().map(|term| term.abs()).sum::<f64>(),
            }
        };
        let root = (a * a - 16.0 * low1).sqrt();
        let critical = [0.25 * (a + root), 0.25 * (a - root)];
        for interval in bound.intervals().into_iter().flatten() {
            roots(interval, critical, distance, |y, residual| {
                self.offer(residual, a, hold(y), y, 0.0);
            });
        }
    }

    /// y = −B is held for `k = (x² − K − B²)/B`; x is free.
    fn held_at_trough(&mut self) {
        let (b, change, low0, low1) = (self.task.fall, self.change, self.low0, self.low1);
        let bound = Bound {
            low: self.a0.max(-b),
            high: self.task.rise.min(self.peak_max),
            inner: change + b * b,
            outer: f64::INFINITY,
        };
        let hold = move |x: f64| (x * x - change - b * b) / b;
        let (rest, size) = (self.rest, self.size);
        let distance = move |x: f64| {
            let k = hold(x);
            let terms = [
                2.0 * low1 * b,
                b * b * b,
                k * (low1 + 1.5 * b * b),
                0.5 * b * k * k,
                2.0 * low0 * x,
                x * x * x,
            ];
            Sample {
                value: terms.iter().sum::<f64>() - rest,
                slope: (x + b) * (2.0 * x * x + b * x + 2.0 * low0) / b,
                size: size + terms.iter().map(|term| term.abs()).sum::<f64>(),
            }
        };
        let root = (b * b - 16.0 * low0).sqrt();
        let critical = [0.25 * (-b + root), 0.25 * (-b - root)];
        for interval in bound.intervals().into_iter().flatten() {
            roots(interval, critical, distance, |x, residual| {
                self.offer(residual, x, 0.0, -b, hold(x));
            });
        }
    }

    /// x = A and y = −B are both held; the speed w between them is free.
    fn held_at_both(&mut self) {
        let (a, b, low0, low1) = (self.task.rise, self.task.fall, self.low0, self.low1);
        let lowest = (low0 + a * a).max(low1 + b * b);
        let highest = self.task.speed;
        if lowest > highest {
            return;
        }
        let holds = move |w: f64| [(w - low0 - a * a) / a, (w - low1 - b * b) / b];
        let (rest, size) = (self.rest, self.size);
        let distance = move |w: f64| {
            let [h, k] = holds(w);
            let terms = [
                2.0 * low0 * a + a * a * a,
                h * (low0 + 1.5 * a * a),
                0.5 * a * h * h,
                2.0 * low1 * b + b * b * b,
                k * (low1 + 1.5 * b * b),
                0.5 * b * k * k,
            ];
            Sample {
                value: terms.iter().sum::<f64>() - rest,
                slope: w / a + w / b + 0.5 * (a + b),
                size: size + terms.iter().map(|term| term.abs()).sum::<f64>(),
            }
        };
        let critical = [-0.5 * a * b, f64::NAN];
        roots((lowest, highest), critical, distance, |w, residual| {
            let [h, k] = holds(w);
            self.offer(residual, a, h, -b, k);
        });
    }

    /// The speed is at its limit for a while.
    fn with_cruise(&mut self) {
        let (a, b, w) = (self.task.rise, self.task.fall, self.task.speed);
        let (x, y) = (self.peak_max.min(a), -self.trough_max.min(b));
        let hold = |limit: f64, reached: bool, low: f64| {
            if reached {
                ((w - low - limit * limit) / limit).max(0.0)
            } else {
                0.0
            }
        };
        let h = hold(a, self.peak_max >= a, self.low0);
        let k = hold(b, self.trough_max >= b, self.low1);
        let up = 2.0 * self.low0 * x + x * x * x + h * (self.low0 + 1.5 * a * a + 0.5 * a * h);
        let down = -2.0 * self.low1 * y - y * y * y + k * (self.low1 + 1.5 * b * b + 0.5 * b * k);
        let cruise = (self.rest - up - down) / w;
        if cruise >= 0.0 && cruise.is_finite() {
            self.offer_cruise(0.0, [x, y], [h, k], cruise);
        }
    }
}

/// A difference of which only rounding is left is 0: its root, a way to go,
/// would be visible though the difference is not.
fn without(difference: f64, rounding: f64) -> f64 {
    if difference.abs() <= rounding {
        0.0
    } else {
        difference
    }
}

/// The values of a free quantity: from `low` to `high`, its square between
/// `inner` and `outer`.
struct Bound {
    low: f64,
    high: f64,
    inner: f64,
    outer: f64,
}

impl Bound {
    /// The intervals, at most two.
    fn intervals(&self) -> [Option<(f64, f64)>; 2] {
        if self.outer < 0.0 {
            return [None; 2];
        }
        let outer = self.outer.sqrt();
        let (low, high) = (self.low.max(-outer), self.high.min(outer));
        if self.inner <= 0.0 {
            return [interval(low, high), None];
        }
        let inner = self.inner.sqrt();
        [
            interval(low, high.min(-inner)),
            interval(low.max(inner), high),
        ]
    }
}

/// An interval; where rounding has turned it round, a point.
fn interval(low: f64, high: f64) -> Option<(f64, f64)> {
    (low <= high + TURNED).then_some((low, high.max(low)))
}
