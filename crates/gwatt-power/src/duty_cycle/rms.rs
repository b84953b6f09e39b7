//! Root of the mean square of the power over a sliding window.
//!
//! Time is divided into cells, `N` to a window. A window lies within `N + 1`
//! cells in a row, so the largest sum of these is an upper bound: too high by one
//! cell of `N` at most, 1/4096 of the square of the largest power for windows of
//! 0.41 s and more. Of a program that is shorter than the window its own mean counts,
//! which is exact for one run. Where it runs again and again its first window follows
//! once more, or as often as it fits; what is left of its last cell comes on top of the
//! first.

use super::super::trace::Slice;
use super::Span;
use super::rating::{Place, Worst};

/// Cells of a window.
const CELLS: f64 = 4096.0;
/// With windows so short that cells would be shorter than this, fewer.
const CELL_MIN_S: f64 = 1e-4;
const CELLS_MIN: f64 = 16.0;
/// Of shorter windows than this the largest power counts, which no mean exceeds.
const WINDOW_MIN_S: f64 = 1e-3;
/// A slice in which the power does not change evenly is long from so many windows
/// on, and then counts as so many steps.
const LONG: f64 = 48.0;
const STEPS: f64 = 16.0;

/// Means over windows.
#[derive(Debug, Clone)]
pub(super) struct Rms {
    window_s: f64,
    cell_s: f64,
    /// The integrals of P² over the last full cells, N at most, W²·s.
    ring: Vec<f64>,
    cells: usize,
    next: usize,
    sum: f64,
    /// The cell that is being filled, and how far it is.
    cell: f64,
    filled_s: f64,
    /// All of the program so far.
    total: f64,
    elapsed_s: f64,
    /// What all slices count at least, W: a move that may last for ever.
    floor_w: f64,
    /// Whether there was a move whose timing is not known.
    bursts: bool,
    /// The largest integral over a window.
    worst: Worst,
    last: (f64, Place),
    /// The first full cells, N at most, and what the others of the program come to.
    head: Vec<f64>,
    /// What a window may hold more of, of a move of which it is not known when it draws,
    /// W²·s.
    edge: f64,
    /// What the slices of the move at hand count at least, W, and what comes on top of their
    /// squares since it may last longer, W².
    own_floor_w: f64,
    own_more: f64,
}

impl Rms {
    pub fn new(window_s: f64) -> Self {
        let cells = (window_s / CELL_MIN_S).clamp(CELLS_MIN, CELLS);
        let cells = libm::floor(cells);
        Self {
            window_s,
            cell_s: window_s / cells,
            ring: Vec::new(),
            cells: cells as usize,
            next: 0,
            sum: 0.0,
            cell: 0.0,
            filled_s: 0.0,
            total: 0.0,
            elapsed_s: 0.0,
            floor_w: 0.0,
            bursts: false,
            worst: Worst::default(),
            last: (0.0, Place::default()),
            head: Vec::new(),
            edge: 0.0,
            own_floor_w: 0.0,
            own_more: 0.0,
        }
    }

    /// How far the square of a power lies above that of what all slices count at least.
    pub fn beyond(&self, power_w: f64) -> f64 {
        (power_w * power_w - self.floor_w * self.floor_w).max(0.0)
    }

    /// A move begins: what its slices count at least, W, and by how much longer it may last.
    pub fn begin(&mut self, rest_w: f64, longest_ratio: f64) {
        self.own_floor_w = rest_w;
        self.own_more = rest_w * rest_w * (longest_ratio - 1.0);
    }

    /// It ends.
    pub fn end(&mut self) {
        (self.own_floor_w, self.own_more) = (0.0, 0.0);
    }

    /// What comes on top of the squares of the move at hand, W².
    pub fn own_more(&self) -> f64 {
        self.own_more
    }

    /// What all slices count at least, W.
    pub fn floor_w(&self) -> f64 {
        self.floor_w
    }

    /// With what a window may hold more of than was found.
    pub fn with_edge(&self, mut worst: Worst) -> Worst {
        if self.edge > 0.0 {
            let over_s = self.window_s.min(self.elapsed_s);
            worst.value = (worst.value * worst.value + self.edge / over_s).sqrt();
        }
        worst
    }

    /// It is not known when so much of what is taken comes.
    pub fn blur(&mut self, square: f64) {
        self.edge = self.edge.max(square);
    }

    /// So much comes in addition, anywhere in the move at hand.
    pub fn come(&mut self, square: f64, time_s: f64, place: Place) {
        self.blur(square);
        self.cell += square;
        self.total += square;
        self.last = (time_s, place);
    }

    /// A power that may last as long as it will at low overrides.
    pub fn rest(&mut self, power_w: f64, time_s: f64, place: Place) {
        if power_w > self.floor_w {
            self.lift(power_w);
            let square = power_w * power_w * self.window_s;
            self.worst.raise(square, time_s, place);
        }
    }

    /// See [`Continuous::repeated`](super::continuous::Continuous::repeated).
    pub fn repeated(&self, more: f64) -> Worst {
        if self.window_s < WINDOW_MIN_S || self.elapsed_s <= 0.0 {
            return self.result();
        }
        let once = self.result();
        let runs = self.window_s / self.elapsed_s;
        let mut found = self.replayed(more);
        if runs >= 1.0 {
            // Whole runs, and one more that the window cuts.
            let whole = ((self.total + more) * (runs + 1.0) / self.window_s).sqrt();
            found = found.map_or(Some(whole), |found| Some(found.min(whole)));
        }
        let mut worst = once;
        if let Some(found) = found {
            worst.raise(found, once.time_s, once.place);
            worst.lasting = once.lasting;
        }
        worst
    }

    /// The worst mean as its root over windows that reach into further runs, in W.
    fn replayed(&self, more: f64) -> Option<f64> {
        let mut after = self.clone();
        // What is left of the last cell is moved into the next one: a shorter run.
        let left = std::mem::take(&mut after.cell);
        after.filled_s = 0.0;
        (after.worst, after.elapsed_s) = (Worst::default(), f64::INFINITY);
        let first = self.head.first()?;
        let head = std::iter::once(first + left + more).chain(self.head.iter().skip(1).copied());
        let head: Vec<f64> = head.collect();
        for full in head.iter().cycle().take(2 * self.cells + head.len()) {
            after.cell = *full;
            after.close();
        }
        Some((after.worst.value / self.window_s).sqrt())
    }

    pub fn take(&mut self, slice: &Slice, time_s: f64, place: Place) {
        let floor_w = self.floor_w.max(self.own_floor_w);
        if slice.keeps_above(floor_w) {
            return self.add(slice, time_s, place);
        }
        let mut now_s = time_s;
        for (part, above) in slice.sides(floor_w) {
            if above {
                self.add(&part, now_s, place);
            } else {
                let floor = Slice::constant(part.duration_s, floor_w);
                self.add(&floor, now_s, place);
            }
            now_s += part.duration_s;
        }
    }

    fn add(&mut self, slice: &Slice, time_s: f64, place: Place) {
        if self.window_s < WINDOW_MIN_S {
            let peak_w = slice.peak_w();
            let square = peak_w * peak_w;
            self.elapsed_s += slice.duration_s.max(self.window_s);
            self.worst.raise(square * self.window_s, time_s, place);
            return;
        }
        let squares = slice.squares();
        if slice.duration_s > 0.0 && slice.duration_s < self.cell_s - self.filled_s {
            self.count(squares.between(slice.from, slice.to), slice.duration_s);
            self.last = (time_s + slice.duration_s, place);
            return;
        }
        if self.is_long(slice) {
            return self.add_long(slice, time_s, place);
        }
        let mut done_s = 0.0;
        let mut from = slice.from;
        while done_s < slice.duration_s {
            let room_s = self.cell_s - self.filled_s;
            let left_s = slice.duration_s - done_s;
            let fills = left_s >= room_s;
            let step_s = if fills { room_s } else { left_s };
            let to = if fills {
                slice.at(done_s + step_s).min(slice.to)
            } else {
                slice.to
            };
            self.count(squares.between(from, to), step_s);
            done_s += step_s;
            from = to;
            self.last = (time_s + done_s, place);
            if fills {
                self.close();
            } else {
                break;
            }
        }
    }

    /// Whether only the ends of a slice matter: all else would be cells without
    /// number in a slice that lasts for days.
    fn is_long(&self, slice: &Slice) -> bool {
        let windows = if slice.is_even() { 2.0 } else { LONG };
        slice.duration_s > windows * self.edge_s() + self.cell_s
    }

    /// A window, and so much more that it fits in wherever the cells lie.
    fn edge_s(&self) -> f64 {
        self.window_s + 2.0 * self.cell_s
    }

    /// A slice that is long. Where the power changes evenly its square is convex:
    /// no window inside is worse than that at one of both ends, nor is one that is
    /// put together of both. Any other power counts as steps that are nowhere lower.
    fn add_long(&mut self, slice: &Slice, time_s: f64, place: Place) {
        if !slice.is_even() {
            let part_s = slice.duration_s / STEPS;
            let mut from = slice.from;
            for step in 1..=STEPS as u32 {
                let to = slice.at(f64::from(step) * part_s).min(slice.to);
                let most_w = slice.part(from, to).peak_w();
                let now_s = time_s + f64::from(step - 1) * part_s;
                self.add(&Slice::constant(part_s, most_w), now_s, place);
                from = to;
            }
            return;
        }
        let edge_s = self.edge_s();
        // What lasts for ever ends with its last power.
        let at_w = |t: f64| {
            let inside = t.is_finite().then(|| slice.power_w(t));
            inside.unwrap_or_else(|| slice.power.value(slice.to))
        };
        let end_s = slice.duration_s;
        let lead = Slice::linear(edge_s, at_w(0.0), at_w(edge_s));
        self.add(&lead, time_s, place);
        let between_s = end_s - 2.0 * edge_s;
        let squares = slice.squares();
        self.total += squares.between(slice.at(edge_s), slice.at(end_s - edge_s));
        if self.own_more > 0.0 {
            self.total += self.own_more * between_s;
        }
        self.elapsed_s += between_s;
        let tail = Slice::linear(edge_s, at_w(end_s - edge_s), at_w(end_s));
        self.add(&tail, time_s + edge_s + between_s, place);
    }

    /// Counts something in the cell that is being filled.
    #[inline]
    fn count(&mut self, square: f64, duration_s: f64) {
        let square = square + self.own_more * duration_s;
        self.cell += square;
        self.total += square;
        self.elapsed_s += duration_s;
        self.filled_s += duration_s;
    }

    /// The cell is full.
    fn close(&mut self) {
        let full = std::mem::take(&mut self.cell);
        self.filled_s = 0.0;
        let (time_s, place) = self.last;
        self.worst.raise(self.sum + full, time_s, place);
        if self.head.len() < self.cells {
            self.head.push(full);
        }
        if self.ring.len() < self.cells {
            self.ring.push(full);
            self.sum += full;
            return;
        }
        if let Some(oldest) = self.ring.get_mut(self.next) {
            self.sum += full - *oldest;
            *oldest = full;
        }
        self.next += 1;
        if self.next >= self.cells {
            self.next = 0;
            // Rounding must not grow with the program.
            self.sum = self.ring.iter().sum();
        }
    }

    /// A power that lasts for a time that is not known: all of its longest time in
    /// its shortest.
    pub fn burst(&mut self, power_w: f64, span: Span, time_s: f64, place: Place) {
        self.bursts = true;
        let Span {
            shortest_s,
            longest_s,
        } = span;
        if self.window_s < WINDOW_MIN_S {
            self.elapsed_s += shortest_s;
            let square = power_w * power_w * self.window_s;
            return self.worst.raise(square, time_s, place);
        }
        let square = power_w * power_w * longest_s;
        if square.is_finite() && shortest_s > 0.0 {
            let dense = (square / shortest_s).sqrt();
            self.add(&Slice::constant(shortest_s, dense), time_s, place);
        } else {
            self.cell += square;
            self.total += square;
            self.last = (time_s, place);
        }
    }

    /// A power that may last. However long it does, a window that holds it has
    /// no larger mean than one in which it takes the place of all that is less.
    pub fn last(&mut self, power_w: f64, time_s: f64, place: Place) {
        let covered = power_w <= self.floor_w;
        if covered {
            return;
        }
        self.lift(power_w);
        self.worst
            .raise_lasting(power_w * power_w * self.window_s, time_s, place);
    }

    /// All slices count more at least.
    fn lift(&mut self, power_w: f64) {
        // max(P², F'²) ≤ max(P², F²) + F'² − F² for what has been counted.
        let more = power_w * power_w - self.floor_w * self.floor_w;
        for cell in self.ring.iter_mut().chain(&mut self.head) {
            *cell += more * self.cell_s;
        }
        self.sum += more * self.cell_s * self.ring.len() as f64;
        self.cell += more * self.filled_s;
        self.total += more * self.elapsed_s;
        self.floor_w = power_w;
    }

    /// The worst mean as its root, in W.
    pub fn result(&self) -> Worst {
        let (time_s, place) = self.last;
        let mut worst = self.worst;
        if self.elapsed_s <= self.window_s && self.window_s >= WINDOW_MIN_S {
            worst = Worst::default();
            if self.elapsed_s > 0.0 || self.total > 0.0 {
                worst.raise(self.total / self.elapsed_s, time_s, place);
            }
            let floor = self.floor_w * self.floor_w;
            let lasting = self.worst;
            if lasting.lasting && floor >= worst.value {
                worst = Worst {
                    value: floor,
                    ..lasting
                };
            }
        } else {
            worst.raise(self.sum + self.cell, time_s, place);
            worst.value /= self.window_s;
        }
        worst.value = worst.value.sqrt();
        worst.lasting |= self.bursts;
        worst
    }
}

#[cfg(test)]
mod tests;
