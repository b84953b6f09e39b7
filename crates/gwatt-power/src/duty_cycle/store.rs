//! A store of energy that fills above a power and empties below it: what a
//! capacitor lacks or holds in excess, or the heat in a resistor.

use super::super::trace::{Apart, Slice};
use super::Span;
use super::rating::{Place, Worst};
use super::recorded::Recorded;
use super::terms::Terms;
use arrayvec::ArrayVec;

/// Energies that are noted, and by what factor they differ.
const NOTED_MAX: usize = 64;
const NOTED_RATIO: f64 = 1.5;
const NOTED_MIN_J: f64 = 1e-3;
/// What rounding may leave of a balance, as a share.
const ROUNDING: f64 = 1e-9;

/// `E' = P − L`, `E ≥ 0`, L the power that leaves it.
#[derive(Debug, Clone)]
pub(super) struct Store {
    /// The power that leaves it, W.
    taken_w: f64,
    /// What it holds, J.
    held_j: f64,
    /// What has come in less what has left or could have left, J, and its largest
    /// value.
    net_j: f64,
    most_j: f64,
    /// Time so far, s, and when it had given off certain energies first.
    clock_s: f64,
    given_off: ArrayVec<(f64, f64), NOTED_MAX>,
    /// Where this is a bound over all lower overrides: the move at hand gives nothing off.
    dropped: bool,
    /// What it has given off, and the most power that it did so with; what was held before
    /// it, with what has come in since.
    drained_j: f64,
    drain_w: f64,
    undrained_j: f64,
    /// By how much longer it may last where it fills next to rest, and with what power at
    /// least, W.
    stretch: f64,
    rest_w: f64,
    /// What may come in at the end of a move of which it is not known when, J.
    pub edge_j: f64,
    pub worst: Worst,
    /// What it holds over time, where that is to be seen.
    pub recorded: Option<Box<Recorded>>,
}

impl Store {
    pub fn new(taken_w: f64) -> Self {
        Self {
            taken_w,
            held_j: 0.0,
            net_j: 0.0,
            most_j: 0.0,
            clock_s: 0.0,
            given_off: ArrayVec::new(),
            dropped: false,
            drained_j: 0.0,
            drain_w: 0.0,
            undrained_j: 0.0,
            stretch: 1.0,
            rest_w: f64::NEG_INFINITY,
            edge_j: 0.0,
            worst: Worst::default(),
            recorded: None,
        }
    }

    /// Whether it holds anything.
    pub fn is_empty(&self) -> bool {
        self.held_j <= 0.0
    }

    /// What it holds, J.
    pub fn held_j(&self) -> f64 {
        self.held_j
    }

    /// The power that leaves it, W.
    pub fn taken_w(&self) -> f64 {
        self.taken_w
    }

    /// Up to this power nothing changes, W.
    #[inline]
    pub fn calm_w(&self) -> f64 {
        if self.is_empty() {
            self.taken_w
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Takes a slice that begins at `time_s`. `passed` is given the power that
    /// another one must deliver: that of the slice, or L while the store fills or
    /// is not empty.
    pub fn take(
        &mut self,
        slice: &Slice,
        time_s: f64,
        place: Place,
        passed: &mut impl FnMut(&Slice, f64),
    ) {
        let mut now_s = time_s;
        for (mut part, mut above) in slice.sides(self.taken_w) {
            if self.dropped && !above {
                passed(&part, now_s);
                now_s += part.duration_s;
                continue;
            }
            if !above && self.rest_w > self.taken_w {
                (part, above) = (Slice::constant(part.duration_s, self.rest_w), true);
            }
            let mut change_j = part.energy_j() - self.taken_w * part.duration_s;
            if above {
                change_j *= self.stretch;
                self.undrained_j += change_j;
            } else {
                self.drained_j -= change_j;
                self.drain_w = self.drain_w.max(self.taken_w - part.least_w());
            }
            let before = [self.held_j, self.net_j];
            self.net_j += change_j;
            self.most_j = self.most_j.max(self.net_j);
            self.note(part.duration_s);
            if above {
                self.held_j += change_j;
                self.worst
                    .raise(self.held_j, now_s + part.duration_s, place);
                passed(&Slice::constant(part.duration_s, self.taken_w), now_s);
            } else if self.is_empty() {
                passed(&part, now_s);
            } else if let Some(z) = part.emptied(self.held_j, self.taken_w) {
                let (filled, rest) = (part.part(part.from, z), part.part(z, part.to));
                passed(&Slice::constant(filled.duration_s, self.taken_w), now_s);
                if rest.duration_s > 0.0 {
                    passed(&rest, now_s + filled.duration_s);
                }
                self.held_j = 0.0;
            } else {
                passed(&Slice::constant(part.duration_s, self.taken_w), now_s);
                self.held_j = (self.held_j + change_j).max(0.0);
            }
            if self.recorded.is_some() {
                self.record(&part, before);
            }
            now_s += part.duration_s;
        }
    }

    /// Records a part of a slice that has been taken.
    #[cold]
    fn record(&mut self, part: &Slice, before: [f64; 2]) {
        let Some(recorded) = &mut self.recorded else {
            return;
        };
        let ([held_j, net_j], mut rest) = (before, *part);
        if held_j > 0.0
            && self.held_j <= 0.0
            && let Some(z) = part.emptied(held_j, self.taken_w)
        {
            let filled = part.part(part.from, z);
            rest = part.part(z, part.to);
            let left_s = recorded.follow(&filled, self.taken_w, before);
            recorded.pass(left_s, [0.0, net_j - held_j]);
        } else if held_j > 0.0 || self.held_j > 0.0 {
            let left_s = recorded.follow(part, self.taken_w, before);
            rest.duration_s = left_s;
        }
        recorded.pass(rest.duration_s, [self.held_j, self.net_j]);
    }

    /// Time passes with an energy that fills nothing.
    #[inline]
    pub fn pass(&mut self, energy_j: f64, duration_s: f64) {
        if self.dropped {
            return;
        }
        let change_j = energy_j - self.taken_w * duration_s;
        if duration_s > 0.0 {
            self.drained_j -= change_j;
            // A mean only, but nothing is held that could be drained.
            self.drain_w = self.drain_w.max(-change_j / duration_s);
        }
        self.net_j += change_j;
        self.note(duration_s);
        if let Some(recorded) = &mut self.recorded {
            recorded.pass(duration_s, [self.held_j, self.net_j]);
        }
    }

    /// A move begins, where this is a bound: see [`Terms`].
    pub fn begin(&mut self, terms: &Terms, time_s: f64, place: Place) {
        let ratio = terms.longest_ratio();
        if terms.rest_w > self.taken_w * (1.0 + ROUNDING) {
            if ratio.is_infinite() {
                self.worst.raise(f64::INFINITY, time_s, place);
            } else {
                (self.stretch, self.rest_w) = (ratio, terms.rest_w);
            }
        }
        self.dropped = terms.surge_s > 0.0 && ratio.is_infinite();
        (self.drained_j, self.drain_w) = (0.0, 0.0);
        self.undrained_j = self.held_j;
    }

    /// It ends.
    pub fn end(&mut self, terms: &Terms, time_s: f64, place: Place) {
        self.dropped = false;
        (self.stretch, self.rest_w) = (1.0, f64::NEG_INFINITY);
        if terms.surge_s <= 0.0 {
            return;
        }
        let surge_j = (terms.surge_w - self.taken_w).max(0.0) * terms.surge_s;
        if terms.least_share > 0.0 {
            // Ramps take the place of what gives off; where in the move is not known.
            let kept_j = self.drained_j.min(self.drain_w * terms.surge_s);
            let room_j = (self.undrained_j - self.held_j).max(0.0);
            self.edge_j = self.edge_j.max(surge_j + kept_j.min(room_j));
            self.net_j += kept_j - kept_j.min(room_j);
            self.fill(surge_j + kept_j.min(room_j), time_s, place);
        } else if surge_j > 0.0 {
            self.fill(surge_j, time_s, place);
        }
    }

    /// What may come after a move.
    pub fn late(&mut self, slice: &Slice, time_s: f64, place: Place) {
        let more_w = slice.peak_w() - self.taken_w;
        if more_w > 0.0 {
            self.fill(more_w * slice.duration_s * self.stretch, time_s, place);
        }
    }

    fn fill(&mut self, energy_j: f64, time_s: f64, place: Place) {
        self.net_j += energy_j;
        self.most_j = self.most_j.max(self.net_j);
        self.held_j += energy_j;
        self.worst.raise(self.held_j, time_s, place);
    }

    /// Axes that run for themselves: what comes in at once at most, and the rest evenly.
    pub fn apart(&mut self, apart: &Apart, rest_w: f64, time_s: f64, place: Place) {
        let Apart {
            most_w,
            work_j,
            duration_s,
        } = *apart;
        let mut burst_j = 0.0;
        if rest_w + most_w > self.taken_w && most_w > 0.0 {
            burst_j = work_j * ((rest_w + most_w - self.taken_w) / most_w).min(1.0);
            self.fill(burst_j, time_s, place);
            self.edge_j = self.edge_j.max(burst_j);
        }
        let even_w = rest_w + (work_j - burst_j) / duration_s;
        if duration_s > 0.0 && burst_j > 0.0 {
            let slice = Slice::constant(duration_s, even_w);
            self.take(&slice, time_s, place, &mut |_, _| {});
        } else if duration_s > 0.0 {
            // Nothing comes in.
            let slice = Slice::constant(duration_s, even_w.min(self.taken_w));
            self.take(&slice, time_s, place, &mut |_, _| {});
        }
    }

    /// The worst of all runs, where the program runs again and again: each begins with
    /// what the one before has left.
    ///
    /// From E₀ the store holds the larger of E₀ + net and of what it holds from 0, so
    /// that from the second run on all are alike if a run takes no more than it gives.
    pub fn repeated(&self) -> Worst {
        let mut worst = self.worst;
        if self.net_j > ROUNDING * self.most_j {
            worst.raise(f64::INFINITY, worst.time_s, worst.place);
        } else if self.held_j > 0.0 {
            worst.raise(self.held_j + self.most_j, worst.time_s, worst.place);
        }
        worst
    }

    /// How long from the beginning of a run it takes at most until it has given off what
    /// the run before has left, s.
    pub fn refilled_s(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let reached = self
            .given_off
            .iter()
            .find(|(given_j, _)| *given_j >= self.held_j);
        reached.map_or(self.clock_s, |(_, time_s)| *time_s)
    }

    /// Time has passed, and the balance is another.
    #[inline]
    fn note(&mut self, duration_s: f64) {
        self.clock_s += duration_s;
        let last_j = self.given_off.last().map_or(0.0, |last| last.0);
        if -self.net_j > (NOTED_RATIO * last_j).max(NOTED_MIN_J) && !self.given_off.is_full() {
            self.given_off.push((-self.net_j, self.clock_s));
        }
    }

    /// A power that lasts for a time that is not known.
    pub fn span(&mut self, power_w: f64, span: Span, time_s: f64, place: Place) {
        let below = power_w <= self.taken_w * (1.0 + 1e-9);
        let more_w = power_w - self.taken_w;
        if let Some(recorded) = self.recorded.as_mut().filter(|_| !below) {
            recorded.last();
        }
        if below {
            let change_j = more_w.min(0.0) * span.worse_s(false);
            self.net_j += change_j;
            self.note(span.worse_s(false));
            self.held_j = (self.held_j + change_j).max(0.0);
        } else {
            let change_j = more_w * span.worse_s(true);
            self.net_j += change_j;
            self.most_j = self.most_j.max(self.net_j);
            self.note(span.worse_s(true));
            self.held_j += change_j;
            self.worst.raise_lasting(self.held_j, time_s, place);
        }
        if let Some(recorded) = &mut self.recorded {
            recorded.pass(span.worse_s(!below), [self.held_j, self.net_j]);
        }
    }

    /// What it holds at the beginning of a run because of the one before, J, where the program
    /// runs again and again; infinite where each leaves more.
    pub fn carried_j(&self) -> f64 {
        if self.net_j > ROUNDING * self.most_j {
            f64::INFINITY
        } else {
            self.held_j
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(taken_w: f64, slices: &[Slice]) -> (f64, Vec<(f64, f64)>) {
        let mut store = Store::new(taken_w);
        let mut passed = Vec::new();
        let mut time_s = 0.0;
        for slice in slices {
            store.take(slice, time_s, Place::default(), &mut |slice, _| {
                passed.push((slice.duration_s, slice.power_w(0.0)));
            });
            time_s += slice.duration_s;
        }
        (store.worst.value, passed)
    }

    #[test]
    fn a_run_begins_with_what_the_last_one_left() {
        // 200 J at the beginning and 100 J at the end, of which 1 s takes all.
        let slices = [
            Slice::constant(0.1, 5000.0),
            Slice::constant(1.0, 1000.0),
            Slice::constant(0.05, 5000.0),
        ];
        let mut store = Store::new(3000.0);
        for slice in &slices {
            store.take(slice, 0.0, Place::default(), &mut |_, _| {});
        }
        assert!((store.worst.value - 200.0).abs() < 1e-9);
        assert!((store.repeated().value - 300.0).abs() < 1e-9);
        assert!(store.refilled_s() <= 1.1);
        // Where a run takes more than it gives off there is no end to it.
        let mut store = Store::new(1200.0);
        for slice in &slices {
            store.take(slice, 0.0, Place::default(), &mut |_, _| {});
        }
        assert_eq!(store.repeated().value, f64::INFINITY);
    }

    #[test]
    fn a_short_peak_comes_from_the_capacitor() {
        // 50 ms at 5 kW from 3 kW: 100 J. At 1 kW it takes 50 ms to come back.
        let slices = [
            Slice::constant(1.0, 1000.0),
            Slice::constant(0.05, 5000.0),
            Slice::constant(1.0, 1000.0),
        ];
        let (worst, passed) = run(3000.0, &slices);
        assert!((worst - 100.0).abs() < 1e-9);
        let expected = [
            (1.0, 1000.0),
            (0.05, 3000.0),
            (0.05, 3000.0),
            (0.95, 1000.0),
        ];
        assert_eq!(passed.len(), expected.len());
        for (passed, expected) in passed.iter().zip(expected) {
            assert!((passed.0 - expected.0).abs() < 1e-9, "{passed:?}");
            assert_eq!(passed.1, expected.1);
        }
    }

    #[test]
    fn peaks_add_up_until_there_is_time() {
        // Twice 100 J, with 0.01 s · 2 kW = 20 J in between.
        let peak = Slice::constant(0.05, 5000.0);
        let (worst, _) = run(3000.0, &[peak, Slice::constant(0.01, 1000.0), peak]);
        assert!((worst - 180.0).abs() < 1e-9);
    }

    #[test]
    fn a_ramp_counts_from_where_it_passes_the_limit() {
        // 0 to 6 kW in 0.6 s: above 3 kW for 0.3 s, 450 J.
        let (worst, _) = run(3000.0, &[Slice::linear(0.6, 0.0, 6000.0)]);
        assert!((worst - 450.0).abs() < 1e-9);
    }
}
