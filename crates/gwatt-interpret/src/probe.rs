//! G38.2 to G38.5, and G31: feeds that end where a probe touches, or lets go
//! (`LinuxCNC` "G38.n Straight Probe").
//!
//! The move is that to the target: nothing is faster or longer. Where it ends
//! is not known, and with it the place of every axis that moved and the result
//! (#5061 to #5070); unless it is taken for granted that the probe touches nothing.

mod words;

use std::cell::Cell;

use super::reading::ProbeResult;
use gwatt_machine::AxisSet;

/// Shortest way to the target that is taken for a probing move, inches.
const SHORTEST_INCH: f64 = 0.01;

/// Values of a probe's result: nine places, and whether it has touched.
const VALUES: usize = 10;

/// What is known of the last probe.
#[derive(Debug)]
pub(super) struct Probe {
    /// What probes are taken to find; `None`: not known.
    taken: Option<ProbeResult>,
    /// Parameters 5061 to 5070, as far as they are known.
    values: [Option<f64>; VALUES],
    /// What was answered about it, where both can be.
    answer: Cell<Option<bool>>,
    /// How often that was asked of probes.
    answers: Cell<u32>,
    /// Axes whose place was known up to the last probe: where it misses, it still is.
    known_before: AxisSet,
}

impl Probe {
    /// Before the first probe, with what probes are taken to find.
    pub(super) fn new(taken: Option<ProbeResult>) -> Self {
        // Those of the probe before, in another program.
        let mut values = [None; VALUES];
        values[VALUES - 1] = match taken {
            Some(ProbeResult::Hit) => Some(1.0),
            Some(ProbeResult::Miss) => Some(0.0),
            _ => None,
        };
        Self {
            taken,
            values,
            answer: Cell::new(None),
            answers: Cell::new(0),
            known_before: AxisSet::default(),
        }
    }

    /// How often it was asked whether a probe has touched, where both can be.
    pub(super) fn answers(&self) -> u32 {
        self.answers.get()
    }

    /// A parameter, from 0 for #5061; `None`: its value is not known.
    pub(super) fn value(&self, index: usize) -> Option<f64> {
        let known = self.values.get(index).copied()?;
        match self.taken {
            Some(ProbeResult::Either(way)) if index + 1 == VALUES => known.or_else(|| {
                let touches = self.answer.get().unwrap_or_else(|| {
                    let answer = self.answers.get();
                    self.answers.set(answer.saturating_add(1));
                    !way.misses(answer)
                });
                self.answer.set(Some(touches));
                Some(f64::from(touches))
            }),
            _ => known,
        }
    }

    /// The program assigns such a parameter.
    pub(super) fn set(&mut self, index: usize, value: f64) {
        if let Some(slot) = self.values.get_mut(index) {
            *slot = Some(value);
        }
    }

    /// The result of a probe that ends at these places, as far as they are known.
    fn ends(&mut self, places: [Option<f64>; VALUES - 1], touches: Option<bool>) {
        let [.., success] = &mut self.values;
        *success = touches.map(f64::from);
        for (slot, place) in self.values.iter_mut().zip(places) {
            *slot = place;
        }
        self.answer.set(None);
    }
}
