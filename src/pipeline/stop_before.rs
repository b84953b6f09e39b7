//! Rapids that become feeds on controls where no dwell is known to stop the axes: the block
//! before such a rapid gets the word for an exact stop. A rapid begins at rest, so that the
//! block ended at rest as well; it may have the word if a rapid follows it in each of its runs.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::decision::Decision;
use super::entry::{Entry, rests};
use super::line_key::LineKey;
use crate::interpret::{Facts, MoveKind};
use crate::limit::Change;
use crate::machine::{Machine, PathMode};

/// Where a program that runs from top to bottom is stopped.
#[derive(Debug)]
pub(super) struct Stopping {
    /// Lines that move just before a rapid that becomes a feed.
    stopped: HashSet<LineKey>,
    /// Lines before which the axes cannot be stopped.
    not_before: HashSet<LineKey>,
    /// Lines before which they are not.
    moving_before: HashSet<LineKey>,
}

impl Stopping {
    /// `rapids` become feeds.
    pub(super) fn of(seen: &StopsBefore, rapids: impl Iterator<Item = LineKey>) -> Self {
        let stopped: HashSet<_> = rapids
            .flat_map(|line| seen.stopped(line))
            .map(|(line, _)| line)
            .collect();
        let mut not_before = HashSet::new();
        let mut moving_before = HashSet::new();
        for (line, before) in &seen.before {
            if !seen.may_stop(*line, |_| true) {
                not_before.insert(*line);
            }
            if !before.iter().all(|line| stopped.contains(line)) {
                moving_before.insert(*line);
            }
        }
        Self {
            stopped,
            not_before,
            moving_before,
        }
    }

    /// Whether a line gets the word.
    pub(super) fn stops(&self, line: LineKey) -> bool {
        self.stopped.contains(&line)
    }

    /// Whether the axes stand before a line, or can be made to.
    pub(super) fn may_stop_before(&self, line: LineKey) -> bool {
        !self.not_before.contains(&line)
    }

    /// Whether the axes stand before a line.
    pub(super) fn stands_before(&self, line: LineKey) -> bool {
        !self.moving_before.contains(&line)
    }
}

/// Whether a rapid that becomes a feed begins at rest by a word in the block before it: where
/// no dwell stops the axes, or none may stand between the blocks.
pub(super) fn stops_by_word(machine: &Machine, facts: &Facts) -> bool {
    let controller = &machine.controller;
    controller.stops_by_word() || facts.compensated && controller.may_stop_by_word()
}

/// What runs have shown about the blocks before rapids.
#[derive(Debug, Default)]
pub(super) struct StopsBefore {
    /// The line that moved last, if it does not rest by itself.
    last: Option<LineKey>,
    /// The lines that move just before a line.
    before: HashMap<LineKey, BTreeSet<LineKey>>,
    /// Lines that do not rest by themselves.
    lines: HashMap<LineKey, Moving>,
}

/// A line whose end would be blended with a feed.
#[derive(Debug)]
struct Moving {
    /// The same with the word; `None` where it cannot have it.
    stopped: Option<Box<Decision>>,
    /// A rapid followed in each run so far.
    ends_at_rest: bool,
}

impl StopsBefore {
    /// Takes note of a run of a line.
    pub(super) fn run(&mut self, machine: &Machine, line: LineKey, entry: &Entry, skips: bool) {
        let mut moving = entry.its_moves().filter(|mv| mv.moves_axes());
        let Some(first) = moving.next() else { return };
        let last_move = moving.last().unwrap_or(first);
        if let Some(last) = self.last.take() {
            if let Some(known) = self.lines.get_mut(&last) {
                known.ends_at_rest &= first.kind == MoveKind::Rapid;
            }
            self.before.entry(line).or_default().insert(last);
        }
        if rests(machine, last_move) || last_move.path_mode == PathMode::ExactStop {
            return;
        }
        self.last = Some(line);
        let may_have_word = entry.takes_stop_word(machine, skips);
        let stopped = || {
            let change = Change {
                stop: true,
                ..Change::NONE
            };
            may_have_word.then(|| Box::new(Decision::of(entry, change, false)))
        };
        let known = self.lines.entry(line).or_insert_with(|| Moving {
            stopped: stopped(),
            ends_at_rest: true,
        });
        if !may_have_word {
            known.stopped = None;
        }
    }

    /// The program has ended.
    pub(super) fn end(&mut self) {
        self.last = None;
    }

    /// Whether the axes stand before a line, or can be made to.
    pub(super) fn may_stop(&self, line: LineKey, writable: impl Fn(LineKey) -> bool) -> bool {
        let mut before = self.before.get(&line).into_iter().flatten();
        before.all(|before| {
            let known = self.lines.get(before);
            known.is_some_and(|it| it.ends_at_rest && it.stopped.is_some()) && writable(*before)
        })
    }

    /// The lines that get the word before a line, each with what it gets.
    pub(super) fn stopped(&self, line: LineKey) -> impl Iterator<Item = (LineKey, &Decision)> {
        let before = self.before.get(&line).into_iter().flatten();
        before.filter_map(|line| Some((*line, self.lines.get(line)?.stopped.as_deref()?)))
    }
}
