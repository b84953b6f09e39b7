//! Time above a power within a sliding window.

use std::collections::VecDeque;

use super::super::trace::{Apart, Slice};
use super::Span;
use super::rating::{Place, Worst};
use super::span::Late;
use super::terms::Terms;

/// Intervals that are kept of a window; with more, neighbours are joined, the
/// gap between them counted in.
const INTERVALS: usize = 1 << 14;
/// Intervals of further runs that are looked at one by one, at most.
const REPLAYED_MAX: f64 = 1e6;
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
    /// The intervals that begin within the first window.
    head: Vec<(f64, f64)>,
    /// Where this is a bound over all lower overrides: how much longer the move at hand
    /// may lie above the power, and whether its time below counts.
    stretch: f64,
    dropped: bool,
    /// Of its time below that which ramps take the place of, s; and whether all of it lies
    /// above.
    lost_s: f64,
    all_above: bool,
    /// Of a line how long it has lain above, and for how long it may at most, s.
    own_s: f64,
    line_s: Option<f64>,
    /// What a window may cut off a move in which it is not known where the time lies
    /// above, s.
    pub edge_s: f64,
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
            head: Vec::new(),
            stretch: 1.0,
            dropped: false,
            lost_s: 0.0,
            all_above: false,
            own_s: 0.0,
            line_s: None,
            edge_s: 0.0,
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
        if !self.dropped {
            let lost_s = self.lost_s.min(duration_s);
            self.lost_s -= lost_s;
            self.clock_s += duration_s - lost_s;
        }
    }

    pub fn take(&mut self, slice: &Slice, time_s: f64, place: Place) {
        let start_s = self.clock_s;
        for (part, above) in slice.sides(self.calm_w()) {
            let from_s = self.clock_s;
            if above || self.all_above {
                let lasts_s = if self.line_s.is_some() {
                    part.duration_s
                } else {
                    part.duration_s * self.stretch
                };
                self.clock_s += lasts_s;
                self.own_s += lasts_s;
                let found_s = self.count(from_s, self.clock_s);
                let now_s = time_s + (self.clock_s - start_s);
                self.worst.raise(found_s, now_s, place);
            } else {
                self.pass(part.duration_s);
            }
        }
    }

    /// A move begins, where this is a bound: see [`Terms`].
    pub fn begin(&mut self, terms: &Terms, time_s: f64, place: Place) {
        let Terms {
            rest_w,
            cruise_w,
            line_s,
            ..
        } = *terms;
        let longest_ratio = terms.longest_ratio();
        (self.stretch, self.own_s, self.line_s) = (1.0, 0.0, None);
        if rest_w > self.calm_w() {
            (self.stretch, self.all_above) = (longest_ratio, true);
            if longest_ratio.is_infinite() {
                (self.stretch, self.all_above) = (1.0, false);
                self.worst.raise(f64::INFINITY, time_s, place);
            }
        } else if cruise_w > self.calm_w() && rest_w < self.above_w {
            let stretch = (cruise_w - rest_w) / (self.above_w - rest_w);
            self.line_s = line_s.map(|line_s| line_s * stretch);
            self.stretch = stretch.min(longest_ratio);
        }
        let surges = terms.surge_s > 0.0 && terms.surge_w > self.calm_w();
        if surges && terms.least_share > 0.0 {
            self.lost_s = terms.surge_s;
            // Of a window that begins and one that ends inside.
            self.edge_s = self.edge_s.max(2.0 * terms.surge_s);
        } else {
            self.dropped = surges;
        }
    }

    /// It ends.
    pub fn end(&mut self, terms: &Terms, time_s: f64, place: Place) {
        if let Some(line_s) = self.line_s.take() {
            let more_s = line_s.min(self.own_s * self.stretch) - self.own_s;
            if more_s > 0.0 {
                self.prolong(more_s, time_s, place);
            }
        }
        if terms.surge_s > 0.0 && terms.surge_w > self.calm_w() {
            self.above(terms.surge_s, time_s, place);
        }
        (self.stretch, self.dropped) = (1.0, false);
        (self.lost_s, self.all_above) = (0.0, false);
    }

    /// What may come after a move.
    pub fn late(&mut self, late: &Late, time_s: f64, place: Place) {
        let stretch = if late.slower { self.stretch } else { 1.0 };
        let above = late.slice.sides(self.calm_w()).into_iter();
        let above = above.filter(|(_, above)| *above || self.all_above);
        let lasts_s: f64 = above.map(|(part, _)| part.duration_s).sum();
        if lasts_s > 0.0 {
            self.above(lasts_s * stretch, time_s, place);
        }
    }

    /// The last interval lasts longer.
    fn prolong(&mut self, more_s: f64, time_s: f64, place: Place) {
        let Some(last) = self.intervals.back_mut() else {
            return;
        };
        let to_s = last.1;
        let after_s = (self.clock_s - to_s).max(0.0);
        if let Some(head) = self.head.last_mut()
            && head.1 == to_s
        {
            head.1 += more_s;
        }
        let found_s = self.count(to_s, to_s + more_s);
        self.clock_s = to_s + more_s + after_s;
        self.worst.raise(found_s, time_s, place);
    }

    /// So much time above the power.
    fn above(&mut self, lasts_s: f64, time_s: f64, place: Place) {
        let from_s = self.clock_s;
        self.clock_s += lasts_s;
        let found_s = self.count(from_s, self.clock_s);
        self.worst.raise(found_s, time_s, place);
    }

    /// Axes that run for themselves: what they do in all cannot last longer than this
    /// above the power.
    pub fn apart(&mut self, apart: &Apart, rest_w: f64, time_s: f64, place: Place) {
        let mut below_s = apart.duration_s;
        if rest_w + apart.most_w > self.calm_w() && rest_w < self.above_w {
            let lasts_s = apart.work_j / (self.above_w - rest_w);
            self.above(lasts_s, time_s, place);
            self.edge_s = self.edge_s.max(lasts_s);
            below_s = (below_s - lasts_s).max(0.0);
        }
        self.clock_s += below_s;
    }

    /// Adds an interval, and gives the sum over the window that ends with it: over
    /// a window that slides it is largest where its end leaves an interval.
    fn count(&mut self, start_s: f64, end_s: f64) -> f64 {
        if start_s < self.every_s {
            self.lead(start_s, end_s);
        }
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

    /// Keeps an interval of the first window.
    fn lead(&mut self, start_s: f64, end_s: f64) {
        match self.head.last_mut() {
            Some(last) if start_s <= last.1 + GAP_S => last.1 = end_s,
            _ => self.head.push((start_s, end_s)),
        }
        if self.head.len() > INTERVALS {
            self.head = joined(&mut self.head.iter());
        }
    }

    /// The worst of all runs, where the program runs again and again; each run begins
    /// with `lead_s` above the power.
    pub fn repeated(&self, lead_s: f64) -> Worst {
        let run_s = self.clock_s;
        if self.worst.value == 0.0 && lead_s == 0.0 || run_s <= 0.0 || !run_s.is_finite() {
            return self.worst;
        }
        let mut after = self.clone();
        let lead = (lead_s > 0.0).then_some((0.0, lead_s.min(run_s)));
        let until_s = self.every_s + 2.0 * run_s;
        let a_run = self.head.len() + 1;
        let runs = libm::ceil(until_s / run_s);
        if runs * a_run as f64 > REPLAYED_MAX {
            // Whole runs, and one more that the window cuts.
            let above_s: f64 = self.head.iter().map(|(from, to)| to - from).sum();
            let most_s = (above_s + lead_s) * (libm::floor(self.every_s / run_s) + 2.0);
            let mut worst = self.worst;
            worst.raise(most_s.min(self.every_s), worst.time_s, worst.place);
            return worst;
        }
        let mut begin_s = run_s;
        while begin_s < run_s + until_s {
            let mut reached_s = begin_s;
            for (from_s, to_s) in lead.iter().chain(&self.head) {
                let (from_s, to_s) = (begin_s + from_s, begin_s + to_s);
                if to_s > reached_s {
                    let found_s = after.count(from_s.max(reached_s), to_s);
                    after
                        .worst
                        .raise(found_s, after.worst.time_s, after.worst.place);
                    reached_s = to_s;
                }
            }
            begin_s += run_s;
        }
        after.worst
    }

    fn join(&mut self) {
        self.intervals = joined(&mut self.intervals.iter()).into();
        self.sum_s = self.intervals.iter().map(|(from, to)| to - from).sum();
    }

    /// A power that lasts for a time that is not known.
    pub fn span(&mut self, power_w: f64, span: Span, time_s: f64, place: Place) {
        let below = power_w <= self.calm_w() && !self.all_above;
        let stretch = if below { 1.0 } else { self.stretch };
        let lasts_s = span.worse_s(!below) * stretch;
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

/// Intervals by twos, with the gap between.
fn joined(intervals: &mut dyn Iterator<Item = &(f64, f64)>) -> Vec<(f64, f64)> {
    let mut joined = Vec::new();
    while let Some(&(start_s, end_s)) = intervals.next() {
        let end_s = intervals.next().map_or(end_s, |next| next.1);
        joined.push((start_s, end_s));
    }
    joined
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
    fn a_window_reaches_into_the_next_run() {
        // 0.976 s above at the beginning, 0.487 s at the end of 20 s, 10 s a window.
        let mut overload = Overload::new(2000.0, 10.0);
        let slices = [
            Slice::constant(0.976, 3000.0),
            Slice::constant(18.537, 100.0),
            Slice::constant(0.487, 3000.0),
        ];
        for slice in &slices {
            overload.take(slice, 0.0, Place::default());
        }
        assert!((overload.worst.value - 0.976).abs() < 1e-9);
        assert!((overload.repeated(0.0).value - 1.463).abs() < 1e-9);
        // Where each run begins with 1 s at full power as well.
        assert!((overload.repeated(1.0).value - 1.487).abs() < 1e-9);
    }

    #[test]
    fn a_short_program_runs_often_in_a_window() {
        // 1 s of 3 s: 4 s of a window of 10 s.
        let mut overload = Overload::new(2000.0, 10.0);
        for slice in [Slice::constant(1.0, 3000.0), Slice::constant(2.0, 100.0)] {
            overload.take(&slice, 0.0, Place::default());
        }
        assert!((overload.repeated(0.0).value - 4.0).abs() < 1e-9);
        // With more runs than can be looked at the bound is that of whole ones.
        let mut overload = Overload::new(2000.0, 1e6);
        for slice in [Slice::constant(1e-2, 3000.0), Slice::constant(2e-2, 100.0)] {
            overload.take(&slice, 0.0, Place::default());
        }
        let found = overload.repeated(0.0).value;
        assert!((1e6 / 3.0..1e6 / 3.0 + 0.03).contains(&found), "{found}");
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
