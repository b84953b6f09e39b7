//! The writing half of `limit`: blocks wait until their moves are judged and
//! decided, are written with their changes, and go to the certifier in pieces.

use std::collections::VecDeque;
use std::io::{Read, Write};

use arrayvec::ArrayVec;

use super::analyze::refuse_planned;
use super::certify::{Batch, Expected, ExpectedMove, Reasons};
use super::front::{Front, Line};
use super::tally::Tally;
use super::{Failure, LimitOptions, Options, Summary};
use crate::interpret::{Facts, FeedMode, KnobState, Move, MoveKind, Step};
use crate::limit::{Change, Limiter, Outcome, Permit};
use crate::machine::{Machine, PathMode, RapidJoint};
use crate::power::{Assessment, Assessor, Want};
use crate::rewrite::{BlockView, Mark, Rewriter};
use crate::syntax::Block;

/// Bytes of a piece that is handed to the certifier.
const BATCH_BYTES: usize = 64 * 1024;
/// Moves that one block can have: a dwell, and two to a reference point.
const MOVES_MAX: usize = 3;

/// What the writing half comes to.
pub(super) struct Written {
    pub(super) before: Summary,
    pub(super) edited_lines: u64,
    pub(super) reasons: Reasons,
}

/// A block that waits until all its moves are decided.
struct Entry {
    text: Vec<u8>,
    block: Block,
    facts: Facts,
    steps: Vec<Step>,
    /// The state behind it.
    mark: Mark,
    knobs: Option<KnobState>,
    feed_before: Option<f64>,
    moves: usize,
    decided: ArrayVec<(Assessment, Outcome), MOVES_MAX>,
}

/// A move that is not decided yet.
struct Flight {
    /// Number of its block.
    entry: u64,
    permit: Permit,
    assessment: Option<Assessment>,
}

/// Analyses, changes and writes.
pub(super) struct Writer<'m, R, W> {
    machine: &'m Machine,
    front: Front<'m, R>,
    output: W,
    assessor: Assessor<'m>,
    limiter: Limiter<'m>,
    tally: Tally<'m, 'm>,
    rewriter: Rewriter<'m>,
    /// Blocks that wait; `first` is the number of the front one.
    entries: VecDeque<Entry>,
    first: u64,
    spare: Vec<Entry>,
    flights: VecDeque<Flight>,
    outcomes: Vec<Outcome>,
    /// Path mode of the last move that was read.
    mode: PathMode,
    /// The original's state behind the last block that was written.
    mark: Mark,
    knobs: Option<KnobState>,
    batch: Batch,
    reasons: Reasons,
    /// Every figure is wanted exactly: there are rows.
    exact: bool,
}

impl<'m, R: Read, W: Write> Writer<'m, R, W> {
    pub(super) fn new(
        input: R,
        machine: &'m Machine,
        options: &Options,
        how: LimitOptions,
        exact: bool,
        output: W,
    ) -> Self {
        let front = Front::new(input, machine, options);
        Self {
            machine,
            mark: Mark::of(front.interpreter().modal()),
            knobs: knobs(machine, front.interpreter().knobs()),
            mode: front.interpreter().modal().path_mode,
            front,
            output,
            assessor: Assessor::new(machine, options.certificate, Want::ALL),
            limiter: Limiter::new(machine, how),
            tally: Tally::new(machine, options, None),
            rewriter: Rewriter::new(machine),
            entries: VecDeque::new(),
            first: 0,
            spare: Vec::new(),
            flights: VecDeque::new(),
            outcomes: Vec::new(),
            batch: Batch::default(),
            reasons: Reasons::default(),
            exact,
        }
    }

    /// Reads and writes the whole program; `deliver` takes the pieces.
    pub(super) fn run(
        mut self,
        deliver: &mut impl FnMut(&mut Batch) -> Result<(), Failure>,
    ) -> Result<Written, Failure> {
        while self.read_block()? {
            self.decide();
            self.write_decided()?;
            if self.batch.bytes.len() >= BATCH_BYTES {
                deliver(&mut self.batch)?;
            }
        }
        self.finish_moves();
        self.write_decided()?;
        if !self.front.interpreter().ended() {
            let start = self.batch.bytes.len();
            self.rewriter
                .finish(&self.mark, self.knobs.as_ref(), &mut self.batch.bytes);
            self.output
                .write_all(&self.batch.bytes[start..])
                .map_err(Failure::Output)?;
        }
        deliver(&mut self.batch)?;
        self.output.flush().map_err(Failure::Output)?;
        let lines = self.front.lines;
        let notes = self.front.finish()?;
        refuse_planned(&self.assessor, self.machine)?;
        let mut before = self.tally.finish();
        before.lines = lines;
        before.notes = notes;
        Ok(Written {
            before,
            edited_lines: self.rewriter.edited_lines,
            reasons: self.reasons,
        })
    }

    /// Reads a block, judges its moves, and lets it wait.
    fn read_block(&mut self) -> Result<bool, Failure> {
        let mut entry = self.spare.pop();
        let Some(line) = self.front.next_line()? else {
            return Ok(false);
        };
        let entry = match entry.take() {
            Some(mut entry) => {
                entry.fill(&line, self.machine);
                entry
            }
            None => Entry::new(&line, self.machine),
        };
        let number = self.first + self.entries.len() as u64;
        for step in &entry.steps {
            let Step::Move(mv) = step else { continue };
            let permit = permit(&line, self.machine, mv, self.mode);
            self.mode = mv.path_mode;
            self.flights.push_back(Flight {
                entry: number,
                permit,
                assessment: None,
            });
            let Self {
                assessor,
                limiter,
                tally,
                flights,
                outcomes,
                exact,
                ..
            } = self;
            assessor.want = if *exact { Want::ALL } else { tally.want() };
            assessor.push(mv, line.text, &mut |mv, assessment, text| {
                judged(mv, assessment, text, tally, limiter, flights, outcomes);
            });
        }
        self.entries.push_back(entry);
        Ok(true)
    }

    /// Judges and decides what is left at the end.
    fn finish_moves(&mut self) {
        let Self {
            assessor,
            limiter,
            tally,
            flights,
            outcomes,
            ..
        } = self;
        assessor.finish(&mut |mv, assessment, text| {
            judged(mv, assessment, text, tally, limiter, flights, outcomes);
        });
        limiter.finish(&mut |outcome| outcomes.push(outcome.clone()));
        self.decide();
    }

    /// Gives the outcomes to their blocks.
    fn decide(&mut self) {
        for outcome in self.outcomes.drain(..) {
            let Some(flight) = self.flights.pop_front() else {
                break;
            };
            let index = (flight.entry - self.first) as usize;
            if let (Some(entry), Some(assessment)) =
                (self.entries.get_mut(index), flight.assessment)
            {
                entry.decided.push((assessment, outcome));
            }
        }
    }

    /// Writes the blocks whose moves are all decided.
    fn write_decided(&mut self) -> Result<(), Failure> {
        while self
            .entries
            .front()
            .is_some_and(|entry| entry.decided.len() >= entry.moves)
        {
            let Some(mut entry) = self.entries.pop_front() else {
                break;
            };
            self.first += 1;
            self.write(&mut entry)?;
            std::mem::swap(&mut self.mark, &mut entry.mark);
            self.knobs = entry.knobs.take();
            self.spare.push(entry);
        }
        Ok(())
    }

    fn write(&mut self, entry: &mut Entry) -> Result<(), Failure> {
        let start = self.batch.bytes.len();
        let change = merge(&entry.decided);
        let view = BlockView {
            text: &entry.text,
            block: &entry.block,
            facts: &entry.facts,
            before: &self.mark,
            after: &entry.mark,
            knobs: self.knobs.as_ref(),
            rapids: entry.moves_by(|kind| kind == MoveKind::Rapid),
            feeds: entry.moves_by(|kind| matches!(kind, MoveKind::Feed | MoveKind::Arc)),
            change: &change,
        };
        if !self.rewriter.write(&view, &mut self.batch.bytes) {
            let message = "the edits of this block contradict each other".to_owned();
            self.reasons
                .push(0, "edit", message, "change the block by hand", &entry.text);
            self.batch.bytes.extend_from_slice(&entry.text);
        }
        self.output
            .write_all(&self.batch.bytes[start..])
            .map_err(Failure::Output)?;
        self.expect(entry, &change);
        Ok(())
    }

    /// Tells the certifier what the block must do.
    fn expect(&mut self, entry: &mut Entry, change: &Change) {
        let mut decided = entry.decided.drain(..);
        for step in entry.steps.drain(..) {
            let mv = match step {
                Step::Action(action) => {
                    self.batch.expected.push(Expected::Action(action));
                    continue;
                }
                Step::Move(mv) => mv,
            };
            let Some((assessment, outcome)) = decided.next() else {
                continue;
            };
            let hopeless = outcome.obstacle.is_some();
            if let Some(obstacle) = outcome.obstacle {
                self.reasons.push(
                    mv.line,
                    obstacle.rule,
                    obstacle.message,
                    &obstacle.help,
                    &entry.text,
                );
            }
            // What a block gets, all its moves get, but not its dwell.
            let change = if mv.kind == MoveKind::Dwell {
                Change::default()
            } else {
                *change
            };
            let feed_before = entry.feed_before;
            let expected = ExpectedMove {
                mv,
                assessment,
                change,
                feed_before,
                hopeless,
            };
            self.batch.expected.push(Expected::Move(expected));
        }
    }
}

impl Entry {
    fn new(line: &Line<'_, '_>, machine: &Machine) -> Self {
        let mut entry = Self {
            text: Vec::new(),
            block: Block::default(),
            facts: Facts::default(),
            steps: Vec::new(),
            mark: Mark::of(line.interpreter.modal()),
            knobs: None,
            feed_before: None,
            moves: 0,
            decided: ArrayVec::new(),
        };
        entry.fill(line, machine);
        entry
    }

    fn fill(&mut self, line: &Line<'_, '_>, machine: &Machine) {
        self.text.clear();
        self.text.extend_from_slice(line.text);
        self.block.clone_from(line.block);
        self.facts = line.facts;
        self.steps.clear();
        self.steps.extend_from_slice(line.steps);
        self.moves = line
            .steps
            .iter()
            .filter(|step| matches!(step, Step::Move(_)))
            .count();
        self.mark = Mark::of(line.interpreter.modal());
        self.knobs = knobs(machine, line.interpreter.knobs());
        self.feed_before = line
            .interpreter
            .modal()
            .feed
            .as_ref()
            .map(|feed| feed.value);
        self.decided.clear();
    }

    fn moves_by(&self, wanted: fn(MoveKind) -> bool) -> bool {
        self.moves > 0
            && self
                .steps
                .iter()
                .any(|step| matches!(step, Step::Move(mv) if wanted(mv.kind)))
    }
}

/// A move is judged: it goes to the limiter, whose decisions are collected.
fn judged(
    mv: &Move,
    assessment: &Assessment,
    text: &[u8],
    tally: &mut Tally<'_, '_>,
    limiter: &mut Limiter<'_>,
    flights: &mut VecDeque<Flight>,
    outcomes: &mut Vec<Outcome>,
) {
    tally.add(mv, assessment, text);
    if let Some(flight) = flights
        .iter_mut()
        .find(|flight| flight.assessment.is_none())
    {
        flight.assessment = Some(*assessment);
        limiter.push(
            mv,
            assessment,
            &flight.permit,
            assessment.joined,
            &mut |outcome| {
                outcomes.push(outcome.clone());
            },
        );
    }
}

fn knobs(machine: &Machine, state: &KnobState) -> Option<KnobState> {
    (!machine.controller.knobs.is_empty()).then(|| state.clone())
}

/// What may be changed about the block of a move; `mode` is the path mode of
/// the move before it.
fn permit(line: &Line<'_, '_>, machine: &Machine, mv: &Move, mode: PathMode) -> Permit {
    let facts = &line.facts;
    let modal = line.interpreter.modal();
    let stops = mv.path_mode == PathMode::ExactStop && mode == PathMode::ExactStop;
    let stays = stops || machine.controller.planner.rapid_joint == RapidJoint::All;
    let checks = [
        (facts.checksum, "it carries a checksum"),
        (
            line.block.delete_level > 0,
            "it may be skipped (block delete)",
        ),
        (
            facts.boundary,
            "it stops, changes the tool or ends the program",
        ),
        (facts.turns_knob, "it sets limits itself"),
        (
            modal.feed_mode == FeedMode::InverseTime,
            "its feed is an inverse time (G93)",
        ),
        (
            modal.feed_mode == FeedMode::PerRevolution,
            "its feed is per revolution (G95)",
        ),
        (facts.machine_coordinates, "G53 is for rapids"),
        (facts.reference, "it moves to a reference point"),
        (!stays, "without its stop the corner would be rounded"),
    ];
    let first = checks.iter().position(|(applies, _)| *applies);
    Permit {
        edit: first.is_none_or(|first| first > 3),
        feed_word: first.is_none_or(|first| first > 5),
        as_feed: first.is_none(),
        reason: first.map_or("", |first| checks[first].1),
        mm_per_unit: modal.mm_per_unit,
        feed_before: modal.feed.as_ref().map(|feed| feed.value),
        feed_accel_mm_s2: line.interpreter.knobs().feed_accel_mm_s2,
    }
}

/// One change for a block of several moves: the lower value of each word.
fn merge(decided: &[(Assessment, Outcome)]) -> Change {
    let lower = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    };
    let mut merged = Change::default();
    for (_, Outcome { change, .. }) in decided {
        merged.feed = lower(merged.feed, change.feed);
        merged.as_feed |= change.as_feed;
        merged.rapid_percent = match (merged.rapid_percent, change.rapid_percent) {
            (Some((knob, a)), Some((_, b))) => Some((knob, a.min(b))),
            (a, b) => a.or(b),
        };
        merged.accel = match (merged.accel, change.accel) {
            (Some((knob, a)), Some((_, b))) => {
                Some((knob, std::array::from_fn(|axis| a[axis].min(b[axis]))))
            }
            (a, b) => a.or(b),
        };
    }
    merged
}
