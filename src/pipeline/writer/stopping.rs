//! Words that stop blocks before rapids that become feeds, where no dwell does.

use std::io::{Read, Seek, Write};

use super::Writer;
use crate::interpret::{Facts, Move, MoveKind};
use crate::limit::Change;
use crate::machine::PathMode;
use crate::pipeline::entry::Entry;
use crate::pipeline::stop_before::{Stopping, stops_by_word};

impl<R: Read + Seek, W: Write> Writer<'_, R, W> {
    /// Stops blocks as a first look at the program has shown.
    pub(in crate::pipeline) fn stopping(mut self, stopping: Option<Stopping>) -> Self {
        self.stopping = stopping;
        self
    }

    /// Gives a block whether the one before it can be stopped.
    pub(super) fn inform_of_stop(&self, entry: &mut Entry) {
        if let Some(stopping) = &self.stopping {
            entry.stop_before = stopping.may_stop_before(entry.key);
        }
    }

    /// Whether a rapid that cannot be lowered might be, were the block before it known.
    pub(super) fn wants_stop(&self, mv: &Move, facts: &Facts) -> bool {
        self.stopping.is_none()
            && mv.kind == MoveKind::Rapid
            && mv.path_mode == PathMode::LookAhead
            && stops_by_word(self.machine, facts)
    }

    /// The change of a block with the word, where a rapid after it becomes a feed.
    pub(super) fn with_stop(&mut self, entry: &Entry, change: Option<Change>) -> Option<Change> {
        let Some(stopping) = &self.stopping else {
            return change;
        };
        if stops_by_word(self.machine, &entry.facts)
            && !stopping.stands_before(entry.key)
            && entry.needs_stops(self.machine, change.as_ref())
        {
            // It was no feed at the first look.
            let message = "the block before it would have to stop".to_owned();
            let help = "write the move as a feed by hand, with an exact stop before it";
            self.reasons
                .push((0, 0), "edit", message, help, &entry.text);
        }
        if !stopping.stops(entry.key) {
            return change;
        }
        Some(Change {
            stop: true,
            ..change.unwrap_or(Change::NONE)
        })
    }
}
