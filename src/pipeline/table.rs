//! What is known and decided about the lines of a program that has calls or
//! loops: a line gets one change, which must suit each of its runs.

use std::collections::{BTreeSet, HashMap};

use super::decision::Decision;
use super::entry::Entry;
use super::left_feed::LeftFeeds;
use super::line_key::{IN_A_FILE, LineKey};
use super::stop_before::{Stopping, StopsBefore, stops_by_word};
use super::untouched::UNDER_COMPENSATION;
use super::within::Within;
use crate::interpret::{Corner, FeedMode, KnobState, MoveKind};
use crate::limit::{Change, FirstFeed};
use crate::machine::Machine;
use crate::rewrite::{FeedAround, FeedValue, Mark};

/// The lines that move, by number.
#[derive(Debug, Default)]
pub(super) struct Table {
    lines: HashMap<LineKey, Entered>,
    /// See [`Table::new`].
    pub(super) skips: bool,
    /// Files of subprograms are written too: their lines may change.
    with_files: bool,
    /// Lines are written in the order in which they run.
    in_order: bool,
    /// How many of the texts are programs themselves; those are the first.
    programs: u16,
    /// A block before any motion word cannot have one: then none gets one.
    without_word: bool,
    /// The same of blocks that count on no F.
    without_feed: bool,
    /// The F that all of these get: the lowest that one of them needs.
    first_feed: Option<FirstFeed>,
    left_feeds: LeftFeeds,
    stops_before: StopsBefore,
    within: Within,
    /// Lines that nothing is decided about but what is in force before them.
    restored: HashMap<LineKey, Decision>,
}

mod cuts;
mod spread;

#[derive(Debug)]
struct Entered {
    sight: Sight,
    /// All runs so far were alike, the F in force aside.
    unanimous: bool,
    /// After all runs so far the same F was in force.
    one_feed: bool,
    /// The lowest that was.
    lowest_feed: Option<FeedValue>,
    /// The F that it leaves may be another than the original's.
    leaves_feed: bool,
    /// It counts on an F and cuts by it alone, so that a lower one may be written for all runs.
    cuts_by_feed: bool,
    /// Its F may be lowered, together with that of those that count on what it leaves.
    lowers: bool,
    /// Corners were taken in one way.
    one_corner: bool,
    /// One of its runs counts on no F.
    lacks_feed: bool,
    decision: Option<Box<Decision>>,
    /// What it gets where blocks before any motion word get one.
    own_word: Option<Box<Decision>>,
    /// What it gets besides an F where blocks that count on none get one.
    own_feed: Option<Box<Decision>>,
    hopeless: bool,
}

/// What an edit of a line depends on.
#[derive(Debug, Clone, PartialEq)]
struct Sight {
    /// Without corner and feed.
    after: Mark,
    feed: Option<FeedValue>,
    corner: Option<Corner>,
    knobs: Option<KnobState>,
    feed_mode: FeedMode,
    mm_per_unit: f64,
    mm_per_unit_before: f64,
    fixed: Option<&'static str>,
    no_motion_word: bool,
    /// Rapids may not be written as feeds.
    rapids_stay: bool,
}

impl Table {
    /// Nothing is known; `skips`: the program is looked at with the blocks that may be
    /// skipped and without them.
    pub(super) fn new(skips: bool) -> Self {
        Self {
            lines: HashMap::new(),
            skips,
            with_files: false,
            in_order: false,
            programs: 1,
            without_word: false,
            without_feed: false,
            first_feed: None,
            left_feeds: LeftFeeds::default(),
            stops_before: StopsBefore::default(),
            within: Within::default(),
            restored: HashMap::new(),
        }
    }

    /// The same for several programs and the files of subprograms that they call, which are
    /// written as well.
    pub(super) fn with_files(self, programs: u16) -> Self {
        Self {
            with_files: true,
            programs,
            ..self
        }
    }

    /// The same where what is decided is written while the program is read.
    pub(super) fn written_in_order(self) -> Self {
        Self {
            in_order: true,
            ..self
        }
    }

    /// Takes note of a run of a line; `before` is the state before it.
    pub(super) fn see(&mut self, machine: &Machine, line: LineKey, entry: &Entry, before: &Mark) {
        if machine.controller.may_stop_by_word() {
            self.stops_before.run(machine, line, entry, self.skips);
        }
        self.within.run(line, entry, before);
        // A line whose moves are held back counts too: they obey its words; and so does one
        // that stands where it would move to.
        let facts = &entry.facts;
        let moves = entry.moves > 0 || facts.uses_motion || facts.motion_word.is_some();
        let may_change = moves || facts.compensated;
        self.left_feeds.run(line, entry, before, may_change);
        if !may_change {
            return;
        }
        let corner = entry.mark.corner;
        let sight = Sight {
            after: Mark {
                corner: None,
                feed: None,
                ..entry.mark
            },
            feed: entry.mark.feed_value(),
            corner,
            knobs: entry.knobs.clone(),
            feed_mode: entry.feed_mode,
            mm_per_unit: entry.facts.feed_mm_per_unit,
            mm_per_unit_before: entry.mm_per_unit_before,
            fixed: entry.facts.kept(),
            no_motion_word: facts.no_motion_word,
            rapids_stay: facts.rapids_stay(),
        };
        if let Some(entered) = self.lines.get_mut(&line) {
            entered.one_corner &= entered.sight.corner == sight.corner;
            entered.lacks_feed |= entry.lacks_feed();
            entered.cuts_by_feed &= cuts::cuts_by_feed(entry, self.skips);
            entered.one_feed &= entered.sight.feed == sight.feed;
            let length = |feed: &FeedValue| feed.value * feed.mm_per_unit;
            let known = entered.lowest_feed.into_iter().chain(sight.feed);
            entered.lowest_feed = known.min_by(|a, b| length(a).total_cmp(&length(b)));
            entered.unanimous &= Sight {
                corner,
                feed: sight.feed,
                ..entered.sight.clone()
            } == sight;
            return;
        }
        let entered = Entered {
            lowest_feed: sight.feed,
            sight,
            unanimous: true,
            one_feed: true,
            leaves_feed: false,
            cuts_by_feed: cuts::cuts_by_feed(entry, self.skips),
            lowers: false,
            one_corner: true,
            lacks_feed: entry.lacks_feed(),
            decision: None,
            own_word: None,
            own_feed: None,
            hopeless: false,
        };
        self.lines.insert(line, entered);
        let keeps = entry.keeps_its_words(self.skips).is_some();
        self.without_word |= facts.no_motion_word && keeps;
        self.without_feed |= entry.lacks_feed() && keeps;
    }

    /// A path through a program has been seen to its end.
    pub(super) fn end(&mut self) {
        self.left_feeds.end();
        self.stops_before.end();
        self.within.end();
    }

    /// All runs are seen.
    pub(super) fn settle(&mut self) {
        let with_files = self.with_files;
        for (key, entered) in &mut self.lines {
            if !entered.one_feed {
                let writable = |line: LineKey| line.0 == 0 || with_files;
                entered.leaves_feed = self.left_feeds.may_differ(*key, writable);
            }
        }
        self.settle_lowered();
        for (key, entered) in &self.lines {
            let fixed = key.0 >= self.programs
                || !entered.unanimous
                || !entered.one_feed
                || entered.sight.fixed.is_some();
            self.without_word |= entered.sight.no_motion_word && fixed;
            self.without_feed |= entered.lacks_feed && fixed;
        }
    }

    /// Whether blocks that count on no F may get one.
    pub(super) fn may_get_feed(&self) -> bool {
        !self.without_feed
    }

    /// Whether a block before any motion word may get one: G1 stays in force then for all
    /// of them, in each of their runs.
    pub(super) fn may_get_word(&self) -> bool {
        !self.without_word
    }

    /// Why a line of the program may not be changed.
    pub(super) fn fixed(&self, line: LineKey) -> Option<&'static str> {
        if line.0 > 0 && !self.with_files {
            return Some(IN_A_FILE);
        }
        let entered = self.lines.get(&line);
        let alike = entered.is_none_or(|entered| {
            entered.unanimous && (entered.one_feed || entered.leaves_feed || entered.lowers)
        });
        (!alike).then_some(if self.skips {
            "with and without blocks that may be skipped, it runs under feeds or modes that differ"
        } else {
            "it runs several times, under feeds or modes that differ"
        })
    }

    /// Why a block under compensation stays: the next one cannot put right what it leaves.
    pub(super) fn fixed_under_compensation(&self, entry: &Entry) -> Option<&'static str> {
        let free = !entry.facts.compensated || self.in_order;
        let fixed = !free && self.around_within(entry.key).is_none();
        (fixed || self.within.is_mixed(entry.key)).then_some(UNDER_COMPENSATION)
    }

    fn around_within(&self, line: LineKey) -> Option<FeedAround> {
        self.within
            .around(line, |line| line.0 == 0 || self.with_files)
    }

    /// Where a line under compensation is changed, those that come next get what is in force
    /// before them as words of their own.
    pub(super) fn spread_within(&mut self) {
        let changed = |(line, entered): (&LineKey, &Entered)| {
            let decision = entered.decision.as_deref()?;
            decision.facts.compensated.then_some(*line)
        };
        let lines: Vec<_> = self.lines.iter().filter_map(changed).collect();
        let mut open = Vec::new();
        for line in lines {
            let around = self.around_within(line);
            let entered = self.lines.get_mut(&line);
            let decision = entered.and_then(|entered| entered.decision.as_deref_mut());
            if let (Some(around), Some(decision)) = (around, decision) {
                decision.around = around;
                let leaves = decision.change.as_feed || decision.change.feed.is_some();
                if leaves && !around.is_put_back() {
                    open.push(line);
                }
            }
        }
        for line in open {
            for (next, stated) in self.within.next(line) {
                let entered = self.lines.get_mut(&next);
                let decision = match entered.and_then(|entered| entered.decision.as_deref_mut()) {
                    Some(decision) => {
                        decision.before = stated.before;
                        decision
                    }
                    None => self.restored.entry(next).or_insert_with(|| stated.clone()),
                };
                decision.around = FeedAround::Within {
                    known_before: false,
                    put_back: !decision.change.is_none() && decision.around.is_put_back(),
                };
            }
        }
    }

    /// Whether corners are taken in one way each time that a line runs.
    pub(super) fn one_corner(&self, line: LineKey) -> bool {
        let entered = self.lines.get(&line);
        entered.is_none_or(|entered| entered.one_corner)
    }

    /// Whether the axes stand before a line, or a word in the block before it can make them.
    pub(super) fn may_stop_before(&self, line: LineKey) -> bool {
        let writable = |line: LineKey| {
            let entered = self.lines.get(&line);
            (line.0 == 0 || self.with_files) && entered.is_some_and(|it| it.unanimous)
        };
        self.stops_before.may_stop(line, writable)
    }

    /// Takes what was decided for a run: the lowest of all runs counts. True
    /// where it is the first time that the line turns out to be hopeless.
    pub(super) fn decide(
        &mut self,
        machine: &Machine,
        line: LineKey,
        entry: &Entry,
        change: Option<Change>,
    ) -> bool {
        let Some(entered) = self.lines.get_mut(&line) else {
            return false;
        };
        if let Some(change) = change {
            Decision::add(&mut entered.decision, machine, entry, change);
        }
        let hopeless = entry
            .decided
            .iter()
            .any(|(_, outcome)| outcome.obstacle.is_some());
        let first = hopeless && !entered.hopeless;
        entered.hopeless |= hopeless;
        first
    }

    /// Takes what a run of a line before any motion word gets where such lines get one.
    pub(super) fn offer_word(
        &mut self,
        machine: &Machine,
        line: LineKey,
        entry: &Entry,
        change: Change,
    ) {
        if let Some(entered) = self.lines.get_mut(&line) {
            Decision::add(&mut entered.own_word, machine, entry, change);
        }
    }

    /// Where one line before any motion word is written as a feed, all are: G1 is in force then.
    pub(super) fn spread_word(&mut self, machine: &Machine) {
        let feeds = |(key, entered): (&LineKey, &Entered)| {
            let decision = entered.decision.as_deref()?;
            let feeds = decision.facts.no_motion_word && decision.change.as_feed;
            feeds.then_some(key.0)
        };
        let texts: BTreeSet<u16> = self.lines.iter().filter_map(feeds).collect();
        let lines = self.lines.iter_mut();
        for (_, entered) in lines.filter(|(key, _)| texts.contains(&key.0)) {
            let Some(mut own) = entered.own_word.take() else {
                continue;
            };
            if own.after.feed.is_none() {
                // It stands in each of its runs; on the machine it may not.
                let slowest = || Change::slowest_rapid(machine, own.facts.feed_mm_per_unit);
                own.change.feed = own.change.feed.or_else(slowest);
            }
            entered.decision = Some(own);
        }
    }

    /// Takes what a run of a line that counts on no F gets besides one, and the lowest F that
    /// such lines need so far.
    pub(super) fn offer_feed(
        &mut self,
        machine: &Machine,
        line: LineKey,
        entry: &Entry,
        first_feed: Option<FirstFeed>,
    ) {
        if let Some(entered) = self.lines.get_mut(&line) {
            Decision::add(&mut entered.own_feed, machine, entry, Change::NONE);
        }
        self.first_feed = match (self.first_feed, first_feed) {
            (Some(known), Some(other)) => Some(known.lower(other)),
            (known, other) => known.or(other),
        };
    }

    /// Where one line that counts on no F gets one, all of them get it.
    pub(super) fn spread_feed(&mut self) {
        let Some(first) = self.first_feed else { return };
        for entered in self.lines.values_mut() {
            let Some(own) = entered.own_feed.take() else {
                continue;
            };
            let decision = entered.decision.get_or_insert(own);
            decision.change.feed = Some(first.in_units(decision.facts.feed_mm_per_unit));
        }
    }

    /// Lines before which a word has to let the axes stand.
    fn stopping_lines(&self, machine: &Machine) -> impl Iterator<Item = LineKey> {
        let stopping = |entered: &Entered| {
            let decision = entered.decision.as_deref().filter(|it| it.stops);
            decision.is_some_and(|it| stops_by_word(machine, &it.facts))
        };
        let lines = self.lines.iter();
        lines.filter_map(move |(line, entered)| stopping(entered).then_some(*line))
    }

    /// Where the program is stopped by words, if it runs from top to bottom.
    pub(super) fn stopping(&self, machine: &Machine) -> Stopping {
        Stopping::of(&self.stops_before, self.stopping_lines(machine))
    }

    /// Lines that move before a rapid that is written as a feed get their word.
    pub(super) fn spread_stops(&mut self, machine: &Machine) {
        let found: Vec<_> = self
            .stopping_lines(machine)
            .flat_map(|line| self.stops_before.stopped(line))
            .map(|(line, decision)| (line, decision.clone()))
            .collect();
        for (line, stopped) in found {
            let Some(entered) = self.lines.get_mut(&line) else {
                continue;
            };
            let decision = entered.decision.get_or_insert_with(|| Box::new(stopped));
            decision.change.stop = true;
        }
    }

    /// What is written for a line of the program, if anything.
    pub(super) fn written(&self, line: LineKey) -> Option<&Decision> {
        self.decision(line).or_else(|| self.restored.get(&line))
    }

    /// What a line of the program gets.
    pub(super) fn decision(&self, line: LineKey) -> Option<&Decision> {
        self.lines.get(&line)?.decision.as_deref()
    }

    /// Whether a line does not fit and cannot be helped.
    pub(super) fn hopeless(&self, line: LineKey) -> bool {
        self.lines
            .get(&line)
            .is_some_and(|entered| entered.hopeless)
    }
}

impl Decision {
    /// Takes a change for another run of the line: the lower value of each word.
    fn add(known: &mut Option<Box<Self>>, machine: &Machine, entry: &Entry, change: Change) {
        let stops = entry.needs_stops(machine, Some(&change));
        if let Some(decision) = known {
            decision.change = decision.change.lower(&change);
            decision.stops |= stops;
            return;
        }
        *known = Some(Box::new(Self::of(entry, change, stops)));
    }

    /// A change for a line; what was in force before its block is so after it.
    pub(super) fn of(entry: &Entry, change: Change, stops: bool) -> Self {
        Self {
            change,
            block: entry.block.clone(),
            facts: entry.facts,
            before: entry.mark,
            after: entry.mark,
            around: FeedAround::PutBack,
            knobs: entry.knobs.clone(),
            rapids: entry.moves_by(|kind| kind == MoveKind::Rapid),
            feeds: entry.moves_by(|kind| !matches!(kind, MoveKind::Rapid | MoveKind::Dwell)),
            stops,
        }
    }
}
