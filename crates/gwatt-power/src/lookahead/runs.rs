//! Elements that wait, put together where the same speed is asked for.
//!
//! Input: elements in order. Output: from which speed one of them may have to brake
//! at lower overrides; see `pace`.

use std::collections::VecDeque;

use super::pace::{Course, Pace, SUM_ROUNDING, Slow};

/// Runs that are looked at; after them anything may be.
const RUNS_MAX: usize = 64;
/// Elements in a row with one knob and one speed.
#[derive(Debug)]
struct Run {
    first: u64,
    slow: Slow,
}

/// The runs of all that waits.
#[derive(Debug, Default)]
pub(super) struct Runs {
    runs: VecDeque<Run>,
    /// Σ 2·a·L so far.
    sum2: f64,
}

impl Runs {
    /// Adds an element; it learns what is before it.
    #[inline]
    pub fn push(&mut self, number: u64, pace: &mut Pace) {
        pace.before2 = self.sum2;
        let last = self.runs.back().map(|run| &run.slow);
        if last.is_none_or(|last| last.rapid != pace.rapid || last.asked2 != pace.asked2) {
            let slow = Slow {
                rapid: pace.rapid,
                asked2: pace.asked2,
                least2: pace.least2,
                at2: self.sum2,
            };
            self.runs.push_back(Run {
                first: number,
                slow,
            });
        }
        self.sum2 += pace.own2;
    }

    /// The last element comes to more Σ 2·a·L than was known.
    pub fn lengthen(&mut self, more2: f64) {
        self.sum2 += more2;
    }

    /// Forgets what is before an element.
    #[inline]
    pub fn forget(&mut self, first: u64) {
        while self.runs.get(1).is_some_and(|next| next.first <= first) {
            self.runs.pop_front();
        }
    }

    /// Nothing waits, and nothing moves.
    pub fn clear(&mut self) {
        self.runs.clear();
        self.sum2 = 0.0;
    }

    /// Whether one speed is asked for all along, with that knob.
    pub fn are_one(&self, rapid: bool) -> bool {
        self.runs.len() == 1 && self.runs.iter().all(|run| run.slow.rapid == rapid)
    }

    /// The speed, squared, from which a piece of an element, which ends at `on2` (Σ 2·a·L
    /// from the element's start), may have to brake for the elements after it, where it
    /// need not at the largest overrides.
    #[inline]
    pub fn falls2(&self, number: u64, pace: &Pace, course: &Course, on2: f64) -> Option<f64> {
        let last = self.runs.back()?;
        let [_, falls] = course.ramps();
        if falls || last.first <= number {
            return None;
        }
        self.after(number, pace, course, on2)
    }

    fn after(&self, number: u64, pace: &Pace, course: &Course, on2: f64) -> Option<f64> {
        let (end2, kept) = (course.end2, pace.keeps(course.end2));
        let behind2 = pace.before2 + on2;
        let mut found: Option<f64> = None;
        let after = self.runs.iter().filter(|run| run.first > number);
        for (looked, run) in after.enumerate() {
            let distance2 = run.slow.at2 - behind2 - SUM_ROUNDING * run.slow.at2;
            if distance2 >= end2 {
                break;
            }
            if looked >= RUNS_MAX {
                return Some(course.top2);
            }
            let reached = pace.reached_from(&run.slow, distance2, end2, kept);
            found = match (reached, found) {
                (Some(reached), Some(found)) => Some(reached.max(found)),
                (reached, found) => reached.or(found),
            };
        }
        Some(course.top2.min(found? + course.ramp2))
    }
}
