//! Time above a power within a sliding window.

use std::collections::VecDeque;

use super::super::trace::Slice;
use super::Span;
use super::rating::{Place, Worst};

/// Intervals that are kept of a window; with more, neighbours are joined, the
/// gap between them counted in.
const INTERVALS: usize = 1 << 14;
/// Gap that rounding may leave between two slices, s.
const GAP_S: f64 = 1e-12;
/// Share by which rounding may lift a power.
const ROUNDING: f64 = 1e-9;

/// Counts how long a power is exceeded.
#[derive(Debug, Clone)]
pub(super) struct Overload {
    above_w: f64,
    every_s: f64,
    /// Intervals above it, start and end, that reach into the last window.
    intervals: VecDeque<(f64, f64)>,
    /// Their sum, s.
    sum_s: f64,
    /// Time so far: the worse one, where it is not known.
    clock_s: f64,
    pub worst: Worst,
}

impl Overload {
    pub fn new(above_w: f64, every_s: f64) -> Self {
        Self {
            above_w,
            every_s,
            intervals: VecDeque::new(),
            sum_s: 0.0,
            clock_s: 0.0,
            worst: Worst::default(),
        }
    }

    /// Up to this power nothing counts, W.
    #[inline]
    pub fn calm_w(&self) -> f64 {
        self.above_w * (1.0 + ROUNDING)
    }

    /// Time passes at no more than that.
    #[inline]
    pub fn pass(&mut self, duration_s: f64) {
        self.clock_s += duration_s;
    }

    pub fn take(&mut self, slice: &Slice, time_s: f64, place: Place) {
        let start_s = self.clock_s;
        for (part, above) in slice.sides(self.calm_w()) {
            let from_s = self.clock_s;
            self.clock_s += part.duration_s;
            if above {
                let found_s = self.count(from_s, self.clock_s);
                let now_s = time_s + (self.clock_s - start_s);
                self.worst.raise(found_s, now_s, place);
            }
        }
    }

    /// Adds an interval, and gives the sum over the window that ends with it: over
    /// a window that slides it is largest where its end leaves an interval.
    fn count(&mut self, start_s: f64, end_s: f64) -> f64 {
        match self.intervals.back_mut() {
            Some(last) if start_s <= last.1 + GAP_S => {
                self.sum_s += end_s - last.1;
                last.1 = end_s;
            }
            _ => {
                self.intervals.push_back((start_s, end_s));
                self.sum_s += end_s - start_s;
            }
        }
        let window_s = end_s - self.every_s;
        while let Some(first) = self.intervals.front()
            && first.1 <= window_s
        {
            self.sum_s -= first.1 - first.0;
            self.intervals.pop_front();
        }
        if self.intervals.len() > INTERVALS {
            self.join();
        }
        let outside_s = self
            .intervals
            .front()
            .map_or(0.0, |first| (window_s - first.0).max(0.0));
        self.sum_s - outside_s
    }

    fn join(&mut self) {
        let mut joined = VecDeque::with_capacity(self.intervals.len() / 2 + 1);
        let mut intervals = self.intervals.iter();
        while let Some(&(start_s, end_s)) = intervals.next() {
            let end_s = intervals.next().map_or(end_s, |next| next.1);
            joined.push_back((start_s, end_s));
        }
        self.intervals = joined;
        self.sum_s = self.intervals.iter().map(|(from, to)| to - from).sum();
    }

    /// A power that lasts for a time that is not known.
    pub fn span(&mut self, power_w: f64, span: Span, time_s: f64, place: Place) {
        let below = power_w <= self.calm_w();
        let lasts_s = span.worse_s(!below);
        if below {
            self.clock_s += lasts_s;
        } else if lasts_s < f64::INFINITY {
            let from_s = self.clock_s;
            self.clock_s += lasts_s;
            let found_s = self.count(from_s, self.clock_s);
            self.worst.raise_lasting(found_s, time_s, place);
        } else {
            self.worst.raise_lasting(f64::INFINITY, time_s, place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worst_s(slices: &[Slice]) -> f64 {
        let mut overload = Overload::new(2000.0, 10.0);
        let mut time_s = 0.0;
        for slice in slices {
            overload.take(slice, time_s, Place::default());
            time_s += slice.duration_s;
        }
        overload.worst.value
    }

    #[test]
    fn only_the_time_above_counts() {
        // 1 to 4 kW in 0.3 s: above 2 kW for 0.2 s. At 2 kW itself it is not.
        let ramp = Slice::linear(0.3, 1000.0, 4000.0);
        let found = worst_s(&[ramp, Slice::constant(5.0, 2000.0)]);
        assert!((found - 0.2).abs() < 1e-8);
    }

    #[test]
    fn pulses_within_a_window_add_up() {
        let (pulse, pause) = (Slice::constant(0.2, 3000.0), |s| Slice::constant(s, 100.0));
        assert!((worst_s(&[pulse, pause(9.8), pulse]) - 0.2).abs() < 1e-9);
        assert!((worst_s(&[pulse, pause(9.7), pulse]) - 0.3).abs() < 1e-9);
        assert!((worst_s(&[pulse, pause(3.0), pulse, pause(3.0), pulse]) - 0.6).abs() < 1e-9);
        assert!((worst_s(&[Slice::constant(60.0, 3000.0)]) - 10.0).abs() < 1e-9);
    }

    #[test]
    fn many_pulses_are_never_counted_short() {
        let mut overload = Overload::new(2000.0, 1e6);
        let mut time_s = 0.0;
        for _ in 0..40_000 {
            overload.take(&Slice::constant(0.5, 3000.0), time_s, Place::default());
            time_s += 1.0;
        }
        assert!(overload.worst.value >= 20_000.0 - 1e-6);
        assert!(overload.intervals.len() <= INTERVALS);
    }
}
