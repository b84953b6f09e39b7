//! What becomes of the F that changed lines leave in force: those that count on it get theirs,
//! and where that differs from run to run, the lowest of all.

use std::collections::HashSet;

use super::Table;
use crate::pipeline::line_key::LineKey;
use crate::rewrite::FeedAround;

impl Table {
    /// Finds the lines whose F may be lowered for all their runs, since all that count on what
    /// they leave can have theirs, or be lowered as well.
    pub(super) fn settle_lowered(&mut self) {
        let differ = |(key, entered): (&LineKey, &super::Entered)| {
            (!entered.one_feed && !entered.leaves_feed).then_some(*key)
        };
        let lines: Vec<LineKey> = self.lines.iter().filter_map(differ).collect();
        for line in lines {
            let lowers = self.may_lower(line, &mut HashSet::new());
            if let Some(entered) = self.lines.get_mut(&line) {
                entered.lowers = lowers;
            }
        }
    }

    fn may_lower(&self, line: LineKey, seen: &mut HashSet<LineKey>) -> bool {
        if !seen.insert(line) {
            return true;
        }
        let writable = |line: LineKey| line.0 == 0 || self.with_files;
        let own = self.lines.get(&line).is_some_and(|entered| {
            entered.cuts_by_feed
                && entered.unanimous
                && !entered.lacks_feed
                && entered.lowest_feed.is_some()
        });
        own && writable(line)
            && self.left_feeds.is_counted_on_openly(line)
            && self.left_feeds.users(line).all(|(user, _)| {
                self.left_feeds.can_have_its_feed(user) && writable(user)
                    || self.may_lower(user, seen)
            })
    }

    /// Where lines leave another F than the original's, all that count on it get theirs.
    pub(in crate::pipeline) fn spread_left_feeds(&mut self) {
        let mut open = Vec::new();
        for (line, entered) in &mut self.lines {
            let around = match (entered.leaves_feed, entered.lowers) {
                (true, _) => FeedAround::LeftAfter,
                (_, true) => FeedAround::Stated,
                _ => continue,
            };
            let Some(decision) = &mut entered.decision else {
                continue;
            };
            decision.around = around;
            // One F for all runs: none is faster for it.
            let one = !decision.change.as_feed && decision.facts.feed_word.is_none();
            let lowest = entered.lowest_feed.filter(|_| one);
            if let (Some(feed), Some(lowest)) = (&mut decision.change.feed, lowest) {
                *feed =
                    feed.min(lowest.value * lowest.mm_per_unit / decision.facts.feed_mm_per_unit);
            }
            if decision.change.feed.is_some() {
                open.push(*line);
            }
        }
        while let Some(line) = open.pop() {
            let users: Vec<_> = self.left_feeds.users(line).collect();
            for (user, restored) in users {
                if self.left_feeds.can_have_its_feed(user) {
                    self.restore(user, restored);
                } else {
                    open.extend(self.lower(user));
                }
            }
        }
    }

    /// The original's F for a line that counts on it.
    fn restore(&mut self, line: LineKey, restored: super::Decision) {
        let entered = self.lines.get_mut(&line);
        match entered.and_then(|entered| entered.decision.as_deref_mut()) {
            Some(decision) => {
                decision.before = restored.before;
                decision.around = FeedAround::NotKnownBefore;
            }
            None => {
                self.restored.entry(line).or_insert(restored);
            }
        }
    }

    /// The lowest F of all its runs for a line; gives it where those that count on it are
    /// still to be looked at.
    fn lower(&mut self, line: LineKey) -> Option<LineKey> {
        let block = self.left_feeds.block_of(line)?;
        let entered = self.lines.get_mut(&line)?;
        let lowest = entered.lowest_feed?;
        let decision = entered.decision.get_or_insert_with(|| Box::new(block));
        decision.around = FeedAround::Stated;
        if decision.change.feed.is_some() {
            return None;
        }
        let feed = lowest.value * lowest.mm_per_unit / decision.facts.feed_mm_per_unit;
        decision.change.feed = Some(feed);
        Some(line)
    }
}
