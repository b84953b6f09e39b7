//! Lines under compensation, in programs whose lines are written one by one. No line may come
//! between two of them, so that what one leaves in force is put right in the next: each that
//! may come next in some run gets all that is in force before it as words of its own.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::decision::Decision;
use super::entry::Entry;
use super::line_key::LineKey;
use crate::limit::Change;
use crate::rewrite::{FeedAround, Mark};

/// What runs have shown about lines under compensation.
#[derive(Debug, Default)]
pub(super) struct Within {
    /// The last one, until another block moves or looks at the state.
    last: Option<LineKey>,
    /// The lines that come next after each.
    next: HashMap<LineKey, BTreeSet<LineKey>>,
    lines: HashMap<LineKey, Next>,
    /// Lines that are not under compensation in each of their runs.
    outside: HashSet<LineKey>,
}

/// A line under compensation that may come next.
#[derive(Debug)]
struct Next {
    /// The same block with all that is in force before it; `None` where it takes no words.
    stated: Option<Box<Decision>>,
    /// The same was in force before it in each of its runs.
    one_state: bool,
}

impl Within {
    /// Takes note of a run of a line; `before` is the state before it.
    pub(super) fn run(&mut self, line: LineKey, entry: &Entry, before: &Mark) {
        let facts = &entry.facts;
        let counts = !facts.compensated
            || facts.uses_motion
            || facts.feed_word.is_some()
            || looks_at_state(entry);
        let counts = facts.executed && counts || facts.reads_state;
        if !counts {
            return;
        }
        let last = self.last.take();
        let follows = last.is_some();
        if let Some(last) = last {
            self.next.entry(last).or_default().insert(line);
        }
        // What only works values out stands among them.
        if !facts.compensated && (facts.executed || !follows) {
            self.outside.insert(line);
            return;
        }
        self.last = Some(line);
        let stated = || {
            let takes = !takes_no_words(entry);
            takes.then(|| {
                Box::new(Decision {
                    before: *before,
                    ..Decision::of(entry, Change::NONE, false)
                })
            })
        };
        let known = self.lines.entry(line).or_insert_with(|| Next {
            stated: stated(),
            one_state: true,
        });
        let same = known.stated.as_deref().is_some_and(|stated| {
            let known = &stated.before;
            known.motion == before.motion
                && known.feed_value() == before.feed_value()
                && known.feed_mode_word == before.feed_mode_word
        });
        known.one_state &= same;
    }

    /// The program has ended.
    pub(super) fn end(&mut self) {
        self.last = None;
    }

    /// Whether a line is under compensation in some of its runs and not in others.
    pub(super) fn is_mixed(&self, line: LineKey) -> bool {
        self.lines.contains_key(&line) && self.outside.contains(&line)
    }

    /// How the words of a line may be changed; `None`: not at all. `writable` says of a line
    /// whether it stands in a text that is written.
    pub(super) fn around(
        &self,
        line: LineKey,
        writable: impl Fn(LineKey) -> bool,
    ) -> Option<FeedAround> {
        let next = || self.next.get(&line).into_iter().flatten();
        let outside = |line: &LineKey| !self.lines.contains_key(line);
        if next().all(outside) {
            return Some(FeedAround::Within {
                known_before: true,
                put_back: true,
            });
        }
        let states = |line: &LineKey| {
            let next = self.lines.get(line);
            next.is_some_and(|next| next.one_state && next.stated.is_some())
                && !self.outside.contains(line)
                && writable(*line)
        };
        next().all(states).then_some(FeedAround::Within {
            known_before: true,
            put_back: false,
        })
    }

    /// The lines that come next after a line, each with all that is in force before it.
    pub(super) fn next(&self, line: LineKey) -> impl Iterator<Item = (LineKey, &Decision)> {
        let next = self.next.get(&line).into_iter().flatten();
        next.filter_map(|line| Some((*line, self.lines.get(line)?.stated.as_deref()?)))
    }
}

/// Whether a block shows what is in force, or switches compensation: what is put back after
/// that stands outside.
fn looks_at_state(entry: &Entry) -> bool {
    let facts = &entry.facts;
    let mut words = entry.block.words.iter();
    words.any(|word| word.letter == b'G' && (40.0..43.0).contains(&word.value))
        || facts.looks_at_state()
        || facts.transfers
}

/// Whether a block takes no words that put right what is in force.
fn takes_no_words(entry: &Entry) -> bool {
    let facts = &entry.facts;
    facts.checksum
        || facts.dwell_takes_feed
        || facts.reads_state
        || facts.turns_knob
        || facts.transfers
        || entry.block.tape
        || entry.block.delete_level > 0
}
