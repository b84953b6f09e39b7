//! What the certifier expects of the written program.

use std::io::{Read, Seek, Write};

use super::Writer;
use crate::interpret::{MoveKind, Step};
use crate::limit::Change;
use crate::pipeline::describe::{describe, describe_split, row};
use crate::pipeline::entry::Entry;
use crate::pipeline::expected::{Expected, ExpectedMove};
use crate::pipeline::split::{BLENDED, Line};

impl<R: Read + Seek, W: Write> Writer<'_, R, W> {
    /// Passes the certifier the rows of the spindle before the next move.
    pub(super) fn expect_spindle(&mut self) {
        let of = (self.machine, &self.model, self.detail.has_rows());
        let expected = &mut self.batch.expected;
        self.spindle.hand_over(of, &mut self.start_s, expected);
    }

    /// Passes the certifier what the block must do.
    pub(super) fn expect(&mut self, entry: &mut Entry, change: Option<&Change>) {
        let feed_before = entry.feed_before();
        let mut list = std::mem::take(&mut entry.decided);
        let mut decided = list.iter_mut();
        for step in &entry.steps {
            let mv = match step {
                Step::Action(_) if step.is_note() => continue,
                Step::Action(action) => {
                    self.batch.expected.push(Expected::Action(*action));
                    continue;
                }
                Step::Move(mv) => mv,
            };
            let Some((assessment, outcome)) = decided.next() else {
                continue;
            };
            self.expect_spindle();
            self.spindle.write();
            let hopeless = outcome.obstacle.is_some();
            let found = (mv, &*outcome);
            self.presets.take(&self.limiter, found, &entry.text, false);
            let split = outcome.split.as_deref();
            if self.limiter.splits() && change.is_some() && split.is_none() {
                let reason = outcome.unsplit.unwrap_or(BLENDED);
                self.unsplit.stays(mv, reason, &entry.text);
            }
            if let Some(obstacle) = outcome.obstacle.take() {
                self.stop_is_wanted |= self.wants_stop(mv, &entry.facts);
                self.reasons.refuse(mv, &obstacle, &entry.text);
            }
            // What a block gets, all its moves get, but not its dwell.
            let change = change.filter(|_| mv.kind != MoveKind::Dwell);
            let row = self.detail.has_rows().then(|| {
                let mut row = row(self.machine, &self.model, mv, assessment, self.start_s);
                describe(self.machine, mv, change, feed_before, &mut row);
                row.feed_allowed &= !entry.positions(self.machine, mv);
                if let Some(split) = split {
                    describe_split(self.machine, mv, split, &mut row);
                }
                if hopeless {
                    row.action = "none possible";
                }
                Box::new(row)
            });
            self.start_s += assessment.duration_s;
            self.batch.expected.push(Expected::Move(ExpectedMove {
                changed: change.is_some(),
                as_feed: change.is_some_and(|change| change.as_feed),
                exact_stop: change.is_some_and(|change| change.exact_stop),
                stops: change.is_some_and(|change| change.stop),
                corner: change.map_or(mv.corner, |change| change.corner(self.machine, mv)),
                hopeless,
                split: split.map(|split| Box::new(Line::of(mv, split))),
                row,
                ..ExpectedMove::of(mv, assessment)
            }));
        }
        entry.decided = list;
    }
}
