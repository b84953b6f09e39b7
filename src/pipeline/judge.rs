//! The moves that are not decided yet, on their way through the limiter.

use std::collections::VecDeque;

use super::entry::Entry;
use crate::interpret::{Move, Step};
use crate::limit::{Limiter, Outcome, Waiting};
use crate::machine::Machine;
use crate::power::Assessment;

/// A move that is not decided yet.
pub(super) struct Flight {
    /// Number of its block, and which of its steps it is.
    pub(super) entry: u64,
    pub(super) step: usize,
    pub(super) assessment: Option<Assessment>,
}

/// Hands judged moves to the limiter and collects its decisions.
pub(super) struct Judge<'a, 'm> {
    pub(super) limiter: &'a mut Limiter<'m>,
    pub(super) queue: Queue<'a, 'm>,
    pub(super) judged: &'a mut usize,
    pub(super) outcomes: &'a mut Vec<Outcome>,
}

/// The moves that are not decided, and their blocks.
pub(super) struct Queue<'a, 'm> {
    pub(super) machine: &'m Machine,
    pub(super) entries: &'a VecDeque<Box<Entry>>,
    pub(super) first: u64,
    pub(super) flights: &'a mut VecDeque<Flight>,
}

impl Queue<'_, '_> {
    /// A move with what may be changed about its block.
    fn find(&self, flight: usize) -> Option<Waiting<'_>> {
        let flight = self.flights.get(flight)?;
        let entry = self.entries.get((flight.entry - self.first) as usize)?;
        let Step::Move(mv) = entry.steps.get(flight.step)? else {
            return None;
        };
        Some(entry.waiting(self.machine, mv, flight.step))
    }
}

impl Judge<'_, '_> {
    pub(super) fn take(&mut self, mv: &Move, assessment: &Assessment) {
        let Some(flight) = self.queue.flights.get_mut(*self.judged) else {
            return;
        };
        flight.assessment = Some(*assessment);
        *self.judged += 1;
        let (queue, decided) = (&self.queue, self.outcomes.len());
        let find = |place| queue.find(decided + place);
        let mut keep = |outcome| self.outcomes.push(outcome);
        self.limiter.push(mv, assessment, &find, &mut keep);
    }

    /// Decides what waits, at the end.
    pub(super) fn finish(&mut self) {
        let (queue, decided) = (&self.queue, self.outcomes.len());
        let find = |place| queue.find(decided + place);
        let mut keep = |outcome| self.outcomes.push(outcome);
        self.limiter.finish(&find, &mut keep);
    }
}
