//! Which blocks count on the F that another one leaves in force. A line that runs under feeds
//! that differ cannot put back the F that was in force before it was changed; where all
//! blocks that count on it can have theirs written, it need not. An F that differs from run to
//! run is written as what it was worked out from, where that still has the same value.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::decision::Decision;
use super::entry::Entry;
use super::line_key::LineKey;
use crate::interpret::{FeedMode, MoveKind, NumberText};
use crate::limit::Change;
use crate::rewrite::{FeedAround, Mark};

/// What runs have shown about the F that lines leave.
#[derive(Debug, Default)]
pub(super) struct LeftFeeds {
    /// Lines that have run since an F was last set or counted on.
    open: Vec<LineKey>,
    is_open: HashSet<LineKey>,
    lines: HashMap<LineKey, Left>,
    users: HashMap<LineKey, User>,
}

/// What becomes of the F that a line leaves.
#[derive(Debug, Default)]
struct Left {
    /// The lines that count on it next.
    users: BTreeSet<LineKey>,
    /// Something may count on it that cannot have its own F.
    lost: bool,
}

/// A line that counts on the F in force.
#[derive(Debug)]
struct User {
    /// The same block with its F.
    restored: Box<Decision>,
    /// It counts on the same F in each of its runs.
    one_feed: bool,
    /// What the F is worked out from is the same in each of them.
    one_expression: bool,
}

/// What a block does with the F in force.
enum Need {
    Nothing,
    /// It sets an F of its own.
    Sets,
    /// It obeys it or shows it.
    Uses,
    /// Its own F could not be written.
    Unclear,
}

impl LeftFeeds {
    /// Takes note of a run of a line; `before` is the state before it, and `may_change` says
    /// whether the line may get an F.
    pub(super) fn run(&mut self, line: LineKey, entry: &Entry, before: &Mark, may_change: bool) {
        match need(entry, before) {
            Need::Nothing => {}
            Need::Sets => self.close(|_| {}),
            Need::Unclear => self.close(|left| left.lost = true),
            Need::Uses => {
                self.close(|left| {
                    left.users.insert(line);
                });
                let feed = before.feed_value();
                let user = self.users.entry(line).or_insert_with(|| User {
                    restored: Box::new(Decision {
                        before: *before,
                        around: FeedAround::NotKnownBefore,
                        ..Decision::of(entry, Change::NONE, false)
                    }),
                    one_feed: true,
                    one_expression: true,
                });
                user.one_feed &= user.restored.before.feed_value() == feed;
                // The block itself may change what it is worked out from.
                let known = expression(before);
                let unit = if entry.facts.uses_motion {
                    entry.facts.feed_mm_per_unit
                } else {
                    before.mm_per_unit
                };
                user.one_expression &= expression(&user.restored.before) == known
                    && expression(&entry.mark) == known
                    && known.is_some_and(|(_, meant)| meant == unit.to_bits());
            }
        }
        if may_change && self.is_open.insert(line) {
            self.open.push(line);
        }
    }

    /// The program has ended.
    pub(super) fn end(&mut self) {
        self.close(|left| left.lost = true);
    }

    fn close(&mut self, mut note: impl FnMut(&mut Left)) {
        for line in self.open.drain(..) {
            note(self.lines.entry(line).or_default());
        }
        self.is_open.clear();
    }

    /// Whether a line may leave another F: all that count on it can have theirs; `writable`
    /// says of a line whether it stands in a text that is written.
    pub(super) fn may_differ(&self, line: LineKey, writable: impl Fn(LineKey) -> bool) -> bool {
        let known = |line: &LineKey| {
            let user = self.users.get(line);
            user.is_some_and(User::can_have_its_feed) && writable(*line)
        };
        let left = self.lines.get(&line);
        left.is_some_and(|left| !left.lost && left.users.iter().all(known))
    }

    /// Whether all that count on the F that a line leaves are known.
    pub(super) fn is_counted_on_openly(&self, line: LineKey) -> bool {
        self.lines.get(&line).is_some_and(|left| !left.lost)
    }

    /// Whether a line that counts on an F can have its own written.
    pub(super) fn can_have_its_feed(&self, line: LineKey) -> bool {
        self.users.get(&line).is_some_and(User::can_have_its_feed)
    }

    /// The lines that count on the F that a line leaves, each with its F.
    pub(super) fn users(&self, line: LineKey) -> impl Iterator<Item = (LineKey, Decision)> {
        let users = self.lines.get(&line).into_iter();
        let users = users.flat_map(|left| left.users.iter());
        users.filter_map(|user| Some((*user, self.users.get(user)?.with_its_feed())))
    }
}

impl User {
    fn can_have_its_feed(&self) -> bool {
        self.one_feed || self.one_expression && expression(&self.restored.before).is_some()
    }

    /// The block with its F, as a number or as what it is worked out from.
    fn with_its_feed(&self) -> Decision {
        let mut restored = (*self.restored).clone();
        if !self.one_feed {
            for mark in [&mut restored.before, &mut restored.after] {
                if let Some(feed) = &mut mark.feed {
                    feed.text = feed.expression;
                }
            }
        }
        restored
    }
}

/// What the F in force was worked out from, with the unit of length that it was meant in.
fn expression(mark: &Mark) -> Option<(NumberText, u64)> {
    let feed = mark.feed.as_ref()?;
    let known = !feed.expression.as_bytes().is_empty();
    known.then(|| (feed.expression, feed.mm_per_unit.to_bits()))
}

/// What a block does with the F in force.
fn need(entry: &Entry, before: &Mark) -> Need {
    let facts = &entry.facts;
    if !facts.executed && !facts.reads_state {
        return Need::Nothing;
    }
    if facts.feed_word.is_some() {
        // An F that is worked out from the one in force is put back by no number.
        return if facts.reads_state {
            Need::Unclear
        } else {
            Need::Sets
        };
    }
    let sealed = facts.checksum || facts.dwell_takes_feed;
    let shows = facts.looks_at_state() || entry.block.tape;
    let takes_word = facts.uses_motion && facts.uses_feed;
    // Under compensation these are moves of earlier blocks, which have had their turn.
    let obeys = !facts.compensated
        && entry.moves_by(|kind| !matches!(kind, MoveKind::Rapid | MoveKind::Dwell));
    let per_minute = before.per_minute() && entry.feed_mode == FeedMode::PerMinute;
    if !shows && !obeys && !takes_word {
        return if per_minute || facts.compensated {
            Need::Nothing
        } else {
            Need::Unclear
        };
    }
    let can_have = (shows || takes_word) && !sealed && !facts.compensated;
    if can_have && per_minute && before.feed.is_some() {
        Need::Uses
    } else {
        Need::Unclear
    }
}
