//! Lines that the written program runs in pieces: together they are one move.

use super::divided::Found;
use super::{Expected, Verdict};
use crate::interpret::Move;
use crate::pipeline::expected::{ExpectedMove, different};
use crate::power::Assessment;

impl Verdict<'_, '_> {
    /// What a move is as a piece of the line that the original runs here, if it runs one
    /// that is divided.
    pub(super) fn compare_piece(&mut self, mv: &Move) -> Option<Found> {
        let Some(Expected::Move(original)) = self.originals.get(self.done) else {
            return None;
        };
        let line = original.split.as_deref()?;
        let last = self.pieces.done + 1 == line.pieces;
        self.pieces.done = if last { 0 } else { self.pieces.done + 1 };
        let on_line = line.holds(&original.end, [&mv.start, &mv.end]);
        // The last piece ends where the line does.
        let found = if last {
            different(original, mv)
        } else {
            let place = ExpectedMove {
                end: mv.end,
                ..original.without_row()
            };
            different(&place, mv)
        };
        let found = if on_line { found } else { Some("another path") };
        self.done += usize::from(last);
        Some(found.map_or(Found::Right, Found::Wrong))
    }

    /// What a judged piece adds up to with those before it; `None` before the last one.
    pub(super) fn add_piece(&mut self, after: &Assessment) -> Option<Assessment> {
        let lines = match self.originals.get(self.judged) {
            Some(Expected::Move(original)) => original.split.as_deref(),
            _ => None,
        };
        let Some(line) = lines else {
            return Some(*after);
        };
        let sum = match self.pieces.sum.take() {
            Some(mut sum) => {
                sum.add(after);
                sum
            }
            None => *after,
        };
        self.pieces.judged += 1;
        if self.pieces.judged < line.pieces {
            self.pieces.sum = Some(sum);
            return None;
        }
        self.pieces.judged = 0;
        Some(sum)
    }
}
