//! Blocks before any motion word, where another one was written as a feed.

use std::io::{Read, Seek, Write};

use super::Writer;
use crate::interpret::MoveKind;
use crate::limit::Change;
use crate::pipeline::entry::Entry;

impl<R: Read + Seek, W: Write> Writer<'_, R, W> {
    /// The change of a block; one that runs as a feed since no motion word can be put back
    /// gets its own speed. An F that is in force is kept to: where the control starts with
    /// G1, nothing becomes faster.
    pub(super) fn forced(&self, entry: &Entry, change: Option<Change>) -> Option<Change> {
        let as_feed = change.is_some_and(|change| change.as_feed);
        if !entry.facts.no_motion_word || !(as_feed || self.rewriter.feeds_from_here()) {
            return change;
        }
        self.own_feed(entry, change)
    }

    /// A block as a feed at its own speed, or lower where `change` says so.
    pub(super) fn own_feed(&self, entry: &Entry, change: Option<Change>) -> Option<Change> {
        let rapids = entry.its_moves().enumerate().zip(&entry.decided);
        let own = rapids.filter(|((_, mv), _)| mv.kind == MoveKind::Rapid);
        let mut forced = own.fold(change, |change, ((step, mv), (assessment, _))| {
            let permit = entry.waiting(self.machine, mv, step).permit;
            let feed = if mv.moves_axes() {
                Change::as_feed_in_place(self.machine, mv, &permit, assessment)
            } else {
                Change::STANDING
            };
            Some(change.map_or(feed, |change| change.lower(&feed)))
        })?;
        if let (Some(feed), Some(in_force)) = (&mut forced.feed, entry.feed_before()) {
            *feed = feed.min(in_force);
        }
        Some(forced)
    }
}
