//! Blocks before any motion word, where another one was written as a feed; and what is
//! kept of a line that runs several times.

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
    fn own_feed(&self, entry: &Entry, change: Option<Change>) -> Option<Change> {
        let rapids = entry.its_moves().enumerate().zip(&entry.decided);
        let own = rapids.filter(|((_, mv), _)| mv.kind == MoveKind::Rapid);
        let mut forced = own.fold(change, |change, ((step, mv), (assessment, _))| {
            let permit = entry.waiting(self.machine, mv, step).permit;
            let feed = if mv.moves_axes() {
                Change::as_feed_at(self.machine, mv, &permit, assessment.speed_mm_s)
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

    /// Keeps what was decided for a run of a line.
    pub(super) fn note(&mut self, entry: &Entry, change: Option<Change>) {
        self.spindle.clear();
        let own = if entry.facts.no_motion_word {
            self.own_feed(entry, change)
        } else {
            None
        };
        let Some(table) = &mut self.table else { return };
        if let Some(own) = own {
            table.offer_word(self.machine, entry.key, entry, own);
        }
        if !table.decide(self.machine, entry.key, entry, change) {
            return;
        }
        for (mv, (_, outcome)) in entry.its_moves().zip(&entry.decided) {
            if let Some(obstacle) = outcome.obstacle.as_deref() {
                self.reasons.refuse(mv, obstacle, entry.text_of(mv));
            }
        }
    }
}
