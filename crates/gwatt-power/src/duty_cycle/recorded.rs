//! A store that is recorded: what it holds during the move at hand.
//!
//! The times are those of the store, from the beginning of the move; what a move takes at
//! 100 % is not known here.

use super::super::trace::Slice;
use super::filling::{Fill, Filling, MOVE_FILLS_MAX};

/// Points within a slice, for a line that is near to its curve.
const POINTS: u32 = 4;

/// See the module.
#[derive(Debug, Clone)]
pub(super) struct Recorded {
    filling: Filling,
    /// Since the move has begun, s.
    time_s: f64,
    /// What is held comes from a power of which it is not known how long it lasts.
    lasting: bool,
}

/// What was recorded of one move.
#[derive(Debug, Clone)]
pub(super) struct Recording {
    /// How long it took, s.
    pub lasts_s: f64,
    /// By its own time.
    pub fills: Vec<Fill>,
}

impl Recorded {
    pub fn new() -> Self {
        Self {
            filling: Filling::new(MOVE_FILLS_MAX),
            time_s: 0.0,
            lasting: false,
        }
    }

    /// So much later it holds so much; as long as forever takes is not counted.
    pub fn pass(&mut self, duration_s: f64, [held_j, net_j]: [f64; 2]) {
        if duration_s.is_finite() {
            self.time_s += duration_s;
        }
        self.lasting &= held_j > 0.0;
        self.filling.add(Fill {
            from_s: self.time_s,
            to_s: self.time_s,
            held_j,
            net_j,
            lasting: self.lasting,
        });
    }

    /// What comes in now may come in later, or for longer.
    pub fn last(&mut self) {
        self.lasting = true;
    }

    /// Goes along a slice that the power `taken_w` leaves meanwhile, from what was held before
    /// it; its end is left to [`Self::pass`]. How much of the slice that is left then, s.
    pub fn follow(&mut self, slice: &Slice, taken_w: f64, [held_j, net_j]: [f64; 2]) -> f64 {
        let step_s = slice.duration_s / f64::from(POINTS);
        for point in 1..POINTS {
            let middle = slice.at(f64::from(point) * step_s);
            let part = slice.part(slice.from, middle);
            let change_j = part.energy_j() - taken_w * part.duration_s;
            self.pass(step_s, [(held_j + change_j).max(0.0), net_j + change_j]);
        }
        slice.duration_s - f64::from(POINTS - 1) * step_s
    }

    /// The move ends.
    pub fn end(&mut self) -> Recording {
        Recording {
            lasts_s: std::mem::take(&mut self.time_s),
            fills: self.filling.take(),
        }
    }
}
