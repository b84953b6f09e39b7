//! The largest value of a function with bounded second derivative, by branch
//! and bound.
//!
//! Input: samples of the function and a bound over the interval between two of
//! them. Output: an upper bound of the maximum that is never too low, and
//! within [`TOLERANCE`] of it unless the budget runs out.
//!
//! If `|f''| ≤ M` then `f ≤ max(f(t₀), f(t₁)) + M·h²/8` on an interval of length
//! h: halving it makes the excess four times smaller. The same holds for a
//! maximum of such functions and for sums of these.

use arrayvec::ArrayVec;

/// How far the bound may lie above the largest value found, relative.
const TOLERANCE: f64 = 2e-7;
/// Tolerance relative to the scale of the function, where the value is tiny
/// against its terms.
const SCALE_SHARE: f64 = 1e-4;
/// Samples in one attempt; then the tolerance grows.
const BUDGET: u32 = 6000;
/// Growth of the tolerance from one attempt to the next.
const RELAX: f64 = 100.0;
/// Attempts.
const ATTEMPTS: u32 = 4;
/// Depth of halving: beyond it neighbouring instants no longer differ.
const DEPTH: usize = 64;

/// A function to be maximised over time.
pub(super) trait Bounded {
    /// The function at one instant, with whatever `bound` needs of it.
    type Sample: Clone;
    /// Evaluates the function.
    fn sample(&self, t: f64) -> Self::Sample;
    /// Instant and value of a sample.
    fn value(&self, sample: &Self::Sample) -> (f64, f64);
    /// An upper bound between two samples.
    fn bound(&self, from: &Self::Sample, to: &Self::Sample) -> f64;
}

/// The search: the largest value and the largest bound so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    /// The largest value found.
    best: f64,
    /// No value is larger.
    upper: f64,
    /// Values up to this need not be distinguished.
    floor: f64,
}

impl Search {
    /// A search that knows that the maximum is at least `best`.
    pub fn new(best: f64, floor: f64) -> Self {
        Self {
            best,
            upper: best,
            floor,
        }
    }

    /// The upper bound of all that was searched.
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// True if values up to `bound` cannot change the result noticeably; then
    /// the result takes them in.
    pub fn covers(&mut self, bound: f64) -> bool {
        let covered = bound <= self.target(TOLERANCE, 0.0);
        if covered {
            self.upper = self.upper.max(bound);
        }
        covered
    }

    /// Takes in a region of which only a bound is known.
    pub fn take_in(&mut self, bound: f64) {
        self.upper = super::demand::larger(self.upper, bound);
    }

    /// Searches an interval; `scale` is the size of the function's terms.
    pub fn run<F: Bounded>(&mut self, f: &F, from: f64, to: f64, scale: f64) {
        let ends = (f.sample(from), f.sample(to));
        let before = self.upper;
        let mut tolerance = TOLERANCE;
        for attempt in 1..=ATTEMPTS {
            self.upper = before.max(self.best);
            if self.attempt(f, ends.clone(), tolerance, scale) || attempt == ATTEMPTS {
                return;
            }
            tolerance *= RELAX;
        }
    }

    /// What a bound may reach without being looked into.
    fn target(&self, tolerance: f64, scale: f64) -> f64 {
        let size = self.best.abs().max(SCALE_SHARE * scale);
        (self.best + tolerance * size).max(self.floor)
    }

    /// One attempt: true if it finished within the budget.
    fn attempt<F: Bounded>(
        &mut self,
        f: &F,
        ends: (F::Sample, F::Sample),
        tolerance: f64,
        scale: f64,
    ) -> bool {
        let mut budget = BUDGET;
        let mut stack = ArrayVec::<(F::Sample, F::Sample), DEPTH>::new();
        self.raise(f.value(&ends.0).1);
        self.raise(f.value(&ends.1).1);
        stack.push(ends);
        while let Some((from, to)) = stack.pop() {
            let bound = f.bound(&from, &to);
            let ((t0, f0), (t1, f1)) = (f.value(&from), f.value(&to));
            let middle = 0.5 * (t0 + t1);
            let divisible = t0 < middle && middle < t1 && stack.remaining_capacity() >= 2;
            if bound <= self.target(tolerance, scale) || !divisible || budget == 0 {
                self.take_in(bound);
                continue;
            }
            budget -= 1;
            let half = f.sample(middle);
            self.raise(f.value(&half).1);
            let (first, second) = ((from, half.clone()), (half, to));
            // The better half goes last onto the stack and is seen first.
            let (worse, better) = if f0 > f1 {
                (second, first)
            } else {
                (first, second)
            };
            stack.push(worse);
            stack.push(better);
        }
        budget > 0
    }

    /// Takes in a value that is reached.
    fn raise(&mut self, value: f64) {
        self.best = self.best.max(value);
        self.take_in(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `sin t`, whose second derivative is at most 1.
    struct Sine;

    impl Bounded for Sine {
        type Sample = (f64, f64);
        fn sample(&self, t: f64) -> (f64, f64) {
            (t, libm::sin(t))
        }
        fn value(&self, sample: &(f64, f64)) -> (f64, f64) {
            *sample
        }
        fn bound(&self, from: &(f64, f64), to: &(f64, f64)) -> f64 {
            let h = to.0 - from.0;
            from.1.max(to.1) + h * h / 8.0
        }
    }

    #[test]
    fn the_peak_is_never_too_low_and_close() {
        for start in [0.0, 0.3, 1.0, 1.5] {
            let mut search = Search::new(0.0, f64::NEG_INFINITY);
            search.run(&Sine, start, 6.0, 1.0);
            assert!(search.upper() >= 1.0);
            assert!(search.upper() <= 1.0 + 1e-6);
        }
    }

    #[test]
    fn below_the_floor_nothing_is_told_apart() {
        let mut search = Search::new(0.0, 5.0);
        search.run(&Sine, 0.0, 6.0, 1.0);
        assert!(search.upper() <= 5.5);
    }
}
