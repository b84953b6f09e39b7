//! Decisions that are kept by line, for a program with calls or loops.

use std::io::{Read, Seek, Write};

use super::{Writer, Written};
use crate::limit::Change;
use crate::machine::Machine;
use crate::pipeline::Failure;
use crate::pipeline::entry::Entry;
use crate::pipeline::split::SEVERAL_RUNS;
use crate::pipeline::stop_before::stops_by_word;
use crate::pipeline::table::Table;

/// Why a block before any motion word is not changed where one of them cannot have its own.
const NO_MOTION_WORD: &str = "no motion word is in force that could be put back";

impl Table {
    /// Gives a block what all runs of its line are known to meet.
    pub(super) fn inform(&self, machine: &Machine, entry: &mut Entry) {
        entry.skips = self.skips;
        entry.apart = true;
        // A line that runs again would meet another motion word.
        let without = entry.facts.no_motion_word && !self.may_get_word();
        let without = without.then_some(NO_MOTION_WORD);
        let fixed = entry.facts.fixed.or(without);
        let fixed = fixed.or_else(|| self.fixed(entry.key));
        entry.facts.fixed = fixed.or_else(|| self.fixed_under_compensation(entry));
        entry.one_corner = self.one_corner(entry.key);
        entry.stop_before = stops_by_word(machine, &entry.facts) && self.may_stop_before(entry.key);
        entry.without_feed = !self.may_get_feed();
    }
}

impl<R: Read + Seek, W: Write> Writer<'_, R, W> {
    /// Reads the whole program and decides for its lines, without writing.
    pub(in crate::pipeline) fn decide_all(mut self) -> Result<(Written, Table), Failure> {
        if self.detail.has_rows() {
            self.tally.keep_lines();
        }
        while self.read_block()? {
            self.write_ready();
        }
        self.finish_moves();
        self.write_decided();
        self.conclude()
    }

    /// Writes the blocks whose moves are all decided.
    pub(super) fn write_decided(&mut self) {
        while self
            .entries
            .front()
            .is_some_and(|entry| !entry.awaits && entry.decided.len() >= entry.moves)
        {
            let Some(entry) = self.entries.pop_front() else {
                break;
            };
            self.first += 1;
            self.write(entry);
        }
    }

    /// Keeps what was decided for a run of a line.
    pub(super) fn note(&mut self, entry: &Entry, change: Option<Change>) {
        self.spindle.clear();
        if self.limiter.splits() && change.is_some() {
            let moves = entry.its_moves().zip(&entry.decided);
            let lowered = moves.into_iter().find(|(_, (_, it))| it.change.is_some());
            if let Some((mv, _)) = lowered {
                self.unsplit.stays(mv, SEVERAL_RUNS, &entry.text);
            }
        }
        for (mv, (_, outcome)) in entry.its_moves().zip(&entry.decided) {
            let text = &entry.text;
            self.presets.take(&self.limiter, (mv, outcome), text, true);
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
                self.reasons.refuse(mv, obstacle, &entry.text);
            }
        }
    }
}
