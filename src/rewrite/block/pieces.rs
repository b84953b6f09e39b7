//! A block in several pieces: those before its own text.

use std::fmt::Write as _;

use super::{BlockView, Rewriter};
use crate::limit::Change;
use crate::rewrite::number::{decimal, feed_again, has_point};
use crate::rewrite::state::FeedValue;
use crate::rewrite::turned::{Acted, InForce};

impl Rewriter<'_> {
    /// Writes the pieces before the block, each with its acceleration; motion word and F
    /// are those of the block.
    pub(super) fn write_pieces(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) {
        for piece in view.pieces {
            let change = Change {
                accel: piece.accel,
                ..*view.change
            };
            self.turn_knobs(&change, view, out);
            let mut words = String::new();
            if let Some(digit) = view.after.motion.digit() {
                let _ = write!(words, "G{} ", char::from(digit));
            }
            words.push_str(&piece.place);
            let wanted = self.piece_feed(view);
            if let Some((feed, number)) = wanted {
                let _ = write!(words, " F{number}");
                self.written.feed = Some(feed);
            }
            // A piece of what stands for a rapid does so too.
            let comment = self.comment.as_ref();
            if let Some(comment) = comment.filter(|comment| comment.is_in(view.text)) {
                let _ = write!(words, " {}", comment.text());
            }
            self.written.motion = view.after.motion;
            self.insert_line(&words, out);
            self.stopped = false;
        }
    }

    /// Lines that knobs need before a block that moves.
    pub(super) fn turn_knobs(&mut self, change: &Change, view: &BlockView<'_>, out: &mut Vec<u8>) {
        let acted = Acted {
            rapids: view.rapids,
            feeds: view.feeds || change.as_feed,
        };
        let in_force = InForce {
            knobs: view.knobs,
            mm_per_unit: view.before.mm_per_unit,
        };
        for line in self.turned.turn(change, acted, in_force) {
            self.insert_line(&line, out);
            let knobs = &self.machine.controller.knobs;
            self.stopped |= knobs.iter().any(|knob| knob.wait.as_ref() == Some(&line));
        }
    }

    /// The F of the block as it is written, where it is not in force yet.
    fn piece_feed(&self, view: &BlockView<'_>) -> Option<(FeedValue, String)> {
        let feed = view.after.feed.as_ref().filter(|_| view.facts.uses_feed)?;
        let mm_per_unit = view.facts.feed_mm_per_unit;
        let wanted = match view.change.feed {
            Some(value) => FeedValue { value, mm_per_unit },
            None => view.after.feed_value()?,
        };
        let number = match view.change.feed {
            Some(value) => decimal(value, has_point(feed.text.as_bytes())),
            None => feed_again(feed, mm_per_unit),
        };
        (self.written.feed != Some(wanted)).then_some((wanted, number))
    }
}
