//! The buses whose voltage is to be seen, move by move.
//!
//! Input: what the stores hold during each move, and then how long it lasts at 100 %. Output: the
//! same on the time axis of the report.

use super::filling::{FILLS_MAX, Fill, Filling};
use super::recorded::Recording;
use std::collections::VecDeque;

/// What a stretch of time belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stretch {
    /// A move.
    Move,
    /// The spindle, for which the axes wait.
    Spindle,
}

/// How long something lasts at 100 %: a row of the report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lasts {
    pub duration_s: f64,
    /// The axes wait for the spindle.
    pub waits: bool,
}

/// See the module.
#[derive(Debug, Default)]
pub(super) struct VoltageTrace {
    /// By bus, on the time axis of the report.
    curves: Vec<Filling>,
    /// How far they have come, s.
    time_s: f64,
    /// What is known of moves whose duration is not, by bus.
    waiting: VecDeque<(Stretch, Vec<Recording>)>,
    /// And the other way round.
    lasts: VecDeque<Lasts>,
}

impl VoltageTrace {
    /// That of so many buses, whose capacitors are at the nominal voltage.
    pub fn new(buses: usize) -> Self {
        let mut curve = Filling::new(FILLS_MAX);
        curve.add(Fill {
            from_s: 0.0,
            to_s: 0.0,
            held_j: 0.0,
            net_j: 0.0,
            lasting: false,
        });
        Self {
            curves: vec![curve; buses],
            ..Self::default()
        }
    }

    /// By bus, on the time axis of the report.
    pub fn curves(&self) -> &[Filling] {
        &self.curves
    }

    /// Takes what stores held during a move, by bus.
    pub fn push(&mut self, stretch: Stretch, recordings: Vec<Recording>) {
        self.waiting.push_back((stretch, recordings));
    }

    /// Takes how long moves last, in the order of the program.
    pub fn lasting(&mut self, lasts: impl Iterator<Item = Lasts>) {
        // What lasts for ever has no place in time.
        self.lasts.extend(lasts.map(|it| Lasts {
            duration_s: if it.duration_s.is_finite() {
                it.duration_s
            } else {
                0.0
            },
            ..it
        }));
        self.settle();
    }

    /// Puts what is known of both on the time axis.
    fn settle(&mut self) {
        while let Some((stretch, recordings)) = self.waiting.pop_front() {
            let duration_s = match stretch {
                Stretch::Spindle => self.next_wait(),
                Stretch::Move => self.next_move(),
            };
            for (curve, recording) in self.curves.iter_mut().zip(recordings) {
                let Recording { lasts_s, fills } = recording;
                for fill in fills {
                    let at = |time_s: f64| {
                        let share = if lasts_s > 0.0 { time_s / lasts_s } else { 0.0 };
                        self.time_s + share * duration_s
                    };
                    curve.add(Fill {
                        from_s: at(fill.from_s),
                        to_s: at(fill.to_s),
                        ..fill
                    });
                }
            }
            self.time_s += duration_s;
        }
        // Rows that no store knows of.
        while let Some(lasts) = self.lasts.pop_front() {
            self.time_s += lasts.duration_s;
        }
    }

    /// How long the axes wait next; no time where there is no row of it.
    fn next_wait(&mut self) -> f64 {
        while let Some(lasts) = self.lasts.front().copied().filter(|lasts| lasts.waits) {
            self.lasts.pop_front();
            if lasts.duration_s > 0.0 {
                return lasts.duration_s;
            }
        }
        0.0
    }

    /// How long the next move lasts.
    fn next_move(&mut self) -> f64 {
        while let Some(lasts) = self.lasts.pop_front() {
            if !lasts.waits {
                return lasts.duration_s;
            }
            // A wait at 100 % which is none at the largest overrides.
            self.time_s += lasts.duration_s;
        }
        0.0
    }
}
