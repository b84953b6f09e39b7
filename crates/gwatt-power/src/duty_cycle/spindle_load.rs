//! What the spindle draws next to the axes, move by move.
//!
//! Input: slices of the moves, which come when a move is planned, and the levels
//! of the spindle, which come when it is through. Output: their sums.

use super::Track;
use crate::trace::{Flow, Slice};
use gwatt_motion::Move;

/// The spindle at a steady power: the most that it may draw and feed back in
/// a stretch of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Level {
    /// How long it lasts in s; the last of a move lasts as long as the move.
    pub duration_s: f64,
    /// In W; below 0 only where what is fed back is credited.
    pub drawn_w: f64,
    /// In W; below 0 only where what is fed back is credited.
    pub fed_back_w: f64,
    /// What of `drawn_w` lasts as long as the move, W.
    pub lasting_w: f64,
}

/// Levels in the order of time.
#[derive(Debug, Clone)]
pub(crate) enum Steps {
    /// One alone, as most moves have it.
    Steady(Level),
    Many(Vec<Level>),
}

impl Steps {
    pub fn as_slice(&self) -> &[Level] {
        match self {
            Self::Steady(level) => std::slice::from_ref(level),
            Self::Many(levels) => levels,
        }
    }
}

/// The spindle during one move, or by itself.
#[derive(Debug, Clone)]
pub(crate) struct SpindleLoad {
    /// In the order of time.
    pub levels: Steps,
    /// The place at which the axes wait for it; none while they move.
    pub alone: Option<Box<Move>>,
}

/// The levels of one direction of power, as time goes on.
#[derive(Debug)]
pub(super) struct Levels<'a> {
    left: &'a [Level],
    flow: Flow,
    /// What is left of the first, s.
    left_s: f64,
}

impl<'a> Levels<'a> {
    /// Nothing comes on top.
    pub fn none() -> Self {
        Self {
            left: &[],
            flow: Flow::Drawn,
            left_s: 0.0,
        }
    }

    /// Those that count for a track.
    pub fn new(levels: &'a [Level], track: &Track, converter: usize) -> Self {
        let levels = if track.converter == converter {
            levels
        } else {
            &[]
        };
        Self {
            left: levels,
            flow: track.flow,
            left_s: levels.first().map_or(0.0, |level| level.duration_s),
        }
    }

    fn power_w(&self, level: &Level) -> f64 {
        match self.flow {
            Flow::Drawn => level.drawn_w,
            Flow::FedBack => level.fed_back_w,
        }
    }

    /// What comes on top all the time, where that does not change.
    pub fn steady_w(&self) -> Option<f64> {
        match self.left {
            [] => Some(0.0),
            [level] => Some(self.power_w(level)),
            _ => None,
        }
    }

    /// What lasts however long the move does, W.
    pub fn lasting_w(&self) -> f64 {
        if self.flow == Flow::FedBack {
            return 0.0;
        }
        let powers = self.left.iter().map(|level| level.lasting_w);
        powers.reduce(f64::min).unwrap_or_default()
    }

    /// The largest of all, W.
    pub fn largest_w(&self) -> f64 {
        let powers = self.left.iter().map(|level| self.power_w(level));
        powers
            .reduce(super::super::demand::larger)
            .unwrap_or_default()
    }

    /// A slice with what comes on top, in parts.
    pub fn add(&mut self, slice: &Slice, out: &mut impl FnMut(&Slice)) {
        let mut rest = *slice;
        while let [level, more @ ..] = self.left {
            let mut part = rest;
            let ends = !more.is_empty() && self.left_s < rest.duration_s;
            if ends {
                let border = rest.at(self.left_s);
                part = rest.part(rest.from, border);
                rest = rest.part(border, rest.to);
            }
            part.power.0[0] += self.power_w(level);
            if part.duration_s > 0.0 {
                out(&part);
            }
            if !ends {
                self.left_s -= part.duration_s;
                return;
            }
            self.left = more;
            self.left_s = more.first().map_or(0.0, |next| next.duration_s);
        }
        out(&rest);
    }
}
