//! Decisions that are kept by line, for a program with calls or loops.

use std::io::{Read, Seek, Write};

use super::Writer;
use crate::limit::Change;
use crate::pipeline::entry::Entry;
use crate::pipeline::split::SEVERAL_RUNS;

/// Why a block before any motion word is not changed where one of them cannot have its own.
const NO_MOTION_WORD: &str = "no motion word is in force that could be put back";

impl<R: Read + Seek, W: Write> Writer<'_, R, W> {
    /// What is known of all runs of a block's line.
    pub(super) fn take_from_table(&self, entry: &mut Entry) {
        if let Some(table) = &self.table {
            entry.skips = table.skips;
            // A line that runs again would meet another motion word.
            let without = entry.facts.no_motion_word && !table.may_get_word();
            let without = without.then_some(NO_MOTION_WORD);
            let fixed = entry.facts.fixed.or(without);
            entry.facts.fixed = fixed.or_else(|| table.fixed(entry.key));
            entry.one_corner = table.one_corner(entry.key);
            entry.without_feed = !table.may_get_feed();
        }
    }

    /// Keeps what was decided for a run of a line.
    pub(super) fn note(&mut self, entry: &Entry, change: Option<Change>) {
        self.spindle.clear();
        if self.limiter.splits() && change.is_some() {
            let moves = entry.its_moves().zip(&entry.decided);
            let lowered = moves.into_iter().find(|(_, (_, it))| it.change.is_some());
            if let Some((mv, _)) = lowered {
                self.unsplit.stays(mv, SEVERAL_RUNS, entry.text_of(mv));
            }
        }
        let own = if entry.facts.no_motion_word {
            self.own_feed(entry, change)
        } else {
            None
        };
        let lacks_feed = entry.lacks_feed();
        let first_feed = if lacks_feed {
            self.first_feed_with(entry, change)
        } else {
            None
        };
        let Some(table) = &mut self.table else { return };
        if let Some(own) = own {
            table.offer_word(self.machine, entry.key, entry, own);
        }
        if lacks_feed {
            table.offer_feed(self.machine, entry.key, entry, first_feed);
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
