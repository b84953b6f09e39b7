//! The writing half of `limit`: blocks wait until their moves are judged and
//! decided, are written with their changes, and go to the certifier in pieces.

mod expect;
mod first_feed;
mod forced;
mod judging;
mod noted;
mod stopping;
mod waiting;
mod waits;

use std::collections::VecDeque;
use std::io::{Read, Seek, Write};

use super::analyze::refuse_planned;
use super::batch::Batch;
use super::certify::Reasons;
use super::entry::{Entry, knobs, rests};
use super::executor::Executor;
use super::judge::Flight;
use super::outcome::Pause;
use super::own_steps::Placed;
use super::preset_notes::PresetNotes;
use super::row::Detail;
use super::spindle_rows::SpindleRows;
use super::split::Unsplit;
use super::stop_before::Stopping;
use super::table::Table;
use super::totals::Totals;
use super::watching::watching;
use super::{Failure, Options, Summary};
use crate::interpret::{KnobState, MoveKind, Step};
use crate::limit::{Change, FirstFeed, Limiter, Outcome};
use crate::machine::{Machine, PathMode};
use crate::power::{Assessment, Assessor, PowerModel};
use crate::rewrite::{BlockView, Comment, Mark, Rewriter};
pub(super) use waits::Plan;
use waits::Waits;

/// Bytes of a piece that is handed to the certifier: so few that the moves of
/// two pieces stay in the processor's cache.
const BATCH_BYTES: usize = 8 * 1024;

/// What the writing half comes to.
pub(super) struct Written {
    pub(super) before: Summary,
    pub(super) edited_lines: u64,
    pub(super) reasons: Reasons,
    /// Some of its blocks may be skipped.
    pub(super) may_skip: bool,
    /// Lines before which the program may wait.
    pub(super) places: Vec<u64>,
    /// Where it waits now.
    pub(super) pauses: Vec<Pause>,
}

/// How far a program was written as it was read.
pub(super) enum Streamed<T> {
    /// To its end.
    Written(T),
    /// Its lines are executed in another order than they stand in.
    Flows,
    /// Blocks before rapids that become feeds have to stop, which a first look shows.
    WantsStops,
}

impl<T> Streamed<T> {
    /// With what a program that was written to its end has besides.
    pub(super) fn with<U>(
        self,
        more: impl FnOnce() -> Result<U, Failure>,
    ) -> Result<Streamed<(T, U)>, Failure> {
        Ok(match self {
            Self::Written(written) => Streamed::Written((written, more()?)),
            Self::Flows => Streamed::Flows,
            Self::WantsStops => Streamed::WantsStops,
        })
    }
}

/// Analyses, changes and writes.
pub(super) struct Writer<'m, R, W> {
    machine: &'m Machine,
    front: Executor<'m, R>,
    output: W,
    assessor: Assessor<'m>,
    limiter: Limiter<'m>,
    tally: Totals<'m, 'm>,
    rewriter: Rewriter<'m>,
    /// Blocks that wait; `first` is the number of the front one.
    entries: VecDeque<Box<Entry>>,
    first: u64,
    /// A block that did not have to wait.
    ready: Option<Box<Entry>>,
    #[allow(clippy::vec_box, reason = "they go back and forth between two queues")]
    spare: Vec<Box<Entry>>,
    flights: VecDeque<Flight>,
    /// How many of them are judged.
    judged: usize,
    outcomes: Vec<Outcome>,
    /// Where the steps of a block went; a buffer.
    placed: Vec<Placed>,
    /// Those of a block that does not wait; empty in between.
    decided: Vec<(Assessment, Outcome)>,
    /// Path mode of the last move that was read.
    mode: PathMode,
    /// Millimetres in a program unit after the last block that was read.
    mm_per_unit: f64,
    /// The original's state after the last block that was written.
    mark: Mark,
    knobs: Option<KnobState>,
    batch: Batch,
    reasons: Reasons,
    unsplit: Unsplit,
    presets: PresetNotes,
    detail: Detail,
    model: PowerModel,
    /// Time of the original so far, s.
    start_s: f64,
    /// The lowest F that stands where none was in force.
    first_feed: Option<FirstFeed>,
    spindle: SpindleRows,
    may_skip: bool,
    waits: Waits,
    /// Where blocks are stopped by a word before rapids that become feeds.
    stopping: Option<Stopping>,
    /// A rapid could become a feed if a block before it stopped, which is not known here.
    stop_is_wanted: bool,
    /// Marks what stands for a rapid.
    comment: Option<Comment>,
    /// Decisions by line, for a program with calls or loops: nothing is written
    /// before all its runs are known.
    table: Option<Table>,
}

impl<'m, R: Read + Seek, W: Write> Writer<'m, R, W> {
    /// `machine` has the limits that are aimed at, `model` those that rows show.
    pub(super) fn new(
        input: R,
        output: W,
        machine: &'m Machine,
        options: &Options,
        limiter: Limiter<'m>,
        model: PowerModel,
    ) -> Self {
        let front = Executor::new(input, machine, options);
        let comment = options.comment(machine);
        Self {
            machine,
            mark: Mark::of(front.interpreter().modal()),
            knobs: knobs(machine, front.interpreter().knobs()),
            // The axes stand before the first move.
            mode: PathMode::ExactStop,
            mm_per_unit: front.interpreter().modal().mm_per_unit,
            front,
            output,
            assessor: watching(machine, options),
            limiter,
            tally: Totals::new(machine, options, None),
            rewriter: Rewriter::new(machine).marking(comment.clone()),
            entries: VecDeque::new(),
            first: 0,
            ready: None,
            spare: Vec::new(),
            flights: VecDeque::new(),
            judged: 0,
            outcomes: Vec::new(),
            placed: Vec::new(),
            decided: Vec::new(),
            batch: Batch::default(),
            reasons: Reasons::default(),
            unsplit: Unsplit::default(),
            presets: PresetNotes::default(),
            detail: Detail::NoRows,
            model,
            start_s: 0.0,
            first_feed: None,
            spindle: SpindleRows::default(),
            may_skip: false,
            waits: Waits::default(),
            stopping: None,
            stop_is_wanted: false,
            comment,
            table: None,
        }
    }

    /// With what rows want of each move.
    pub(super) fn detailed(mut self, detail: Detail) -> Self {
        self.detail = detail;
        self
    }

    /// What it decides comes into a table, and nothing is written.
    pub(super) fn deciding(mut self, table: Table) -> Self {
        self.table = Some(table);
        self
    }

    /// Reads and writes the whole program; `deliver` takes the pieces.
    pub(super) fn run(
        mut self,
        deliver: &mut impl FnMut(&mut Batch) -> Result<(), Failure>,
    ) -> Result<Streamed<Written>, Failure> {
        while self.read_block()? {
            if self.front.flows() {
                return Ok(Streamed::Flows);
            }
            if self.stop_is_wanted {
                return Ok(Streamed::WantsStops);
            }
            // Not before there is another block: what is added at the end of a
            // program depends on its last one.
            if self.batch.bytes.len() >= BATCH_BYTES {
                self.deliver(deliver)?;
            }
            self.write_ready();
        }
        self.finish_moves();
        self.write_decided();
        if self.stop_is_wanted {
            return Ok(Streamed::WantsStops);
        }
        self.expect_spindle();
        if !self.front.interpreter().ended() {
            let batch = &mut self.batch;
            let last = batch.bytes.len();
            self.rewriter
                .finish(&self.mark, self.knobs.as_ref(), &mut batch.bytes);
            if batch.bytes.len() > last {
                // The first byte may be the line end that the last block lacks.
                batch.blocks.pop();
            }
        }
        self.deliver(deliver)?;
        self.output.flush().map_err(Failure::Output)?;
        self.conclude()
            .map(|(written, _)| Streamed::Written(written))
    }

    /// The figures of the original, and what was decided.
    fn conclude(mut self) -> Result<(Written, Table), Failure> {
        let lines = self.front.lines;
        let notes = self.front.finish()?;
        refuse_planned(&self.assessor, self.machine)?;
        self.tally.rate(self.assessor.ratings(), Vec::new());
        let mut before = self.tally.finish(self.detail == Detail::Figures);
        before.lines = lines;
        before.notes = notes;
        before.notes.append(&mut self.unsplit.notes);
        before.notes.extend(self.presets.notes());
        let written = Written {
            before,
            edited_lines: self.rewriter.edited_lines,
            reasons: self.reasons,
            may_skip: self.may_skip,
            places: self.waits.places,
            pauses: self.waits.pauses,
        };
        Ok((written, self.table.unwrap_or_default()))
    }

    /// Writes the piece, and hands it on.
    fn deliver(
        &mut self,
        deliver: &mut impl FnMut(&mut Batch) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.output
            .write_all(&self.batch.bytes)
            .map_err(Failure::Output)?;
        deliver(&mut self.batch)
    }

    /// Reads a block, and judges its moves or lets it wait.
    fn read_block(&mut self) -> Result<bool, Failure> {
        let Some(mut line) = self.front.next_line()? else {
            return Ok(false);
        };
        let mut judged = None;
        if line.facts.plain
            && self.entries.is_empty()
            && !self.detail.has_rows()
            && self.table.is_none()
            && self.waits.plan.is_none()
            && self.stopping.is_none()
            && let [Step::Move(mv)] = line.steps.as_slice()
            && !self.assessor.waits(mv)
        {
            let (assessor, tally) = (&mut self.assessor, &mut self.tally);
            let spindle = &mut self.spindle;
            assessor.want = tally.want();
            assessor.push(mv, line.text, &mut |mv, assessment, text| {
                tally.add(mv, assessment, text);
                if spindle.judge(mv, assessment) {
                    judged = Some(*assessment);
                }
            });
            // Nearly every block of a long program: nothing is to be done.
            if let Some(assessment) = &judged
                && self.limiter.passes(assessment)
                && self.rewriter.pass(
                    line.text,
                    &self.mark,
                    rests(self.machine, mv),
                    &mut self.batch.bytes,
                )
            {
                // Without rows: the spindle's are not looked at.
                self.spindle.pass();
                self.batch.pass(line.text.len(), mv, assessment);
                self.start_s += assessment.duration_s;
                self.mode = mv.path_mode;
                self.assessor.end_line(mv.moves_axes(), &mut |_, _, _| {});
                return Ok(true);
            }
        }
        let spare = self.spare.pop();
        let mut entry = spare.unwrap_or_else(|| Box::new(Entry::new(&line)));
        let line_files = line.files;
        entry.fill(&mut line, self.machine, self.mode, self.mm_per_unit);
        if self.limiter.splits() && self.table.is_none() {
            entry.keep_places(line.interpreter);
        }
        if let Some(comment) = &self.comment {
            entry.look_for(comment);
        }
        self.mm_per_unit = entry.mark.mm_per_unit;
        self.may_skip |=
            entry.block.delete_level > 0 && self.machine.controller.language.block_delete;
        if let Some(table) = &self.table {
            self.tally.learn_files(line_files);
            self.reasons.learn_files(line_files);
            table.inform(self.machine, &mut entry);
        }
        self.inform_of_stop(&mut entry);
        let assessor = &self.assessor;
        let waits = |step: &Step| matches!(step, Step::Move(mv) if assessor.waits(mv));
        let alone = self.entries.is_empty() && !entry.facts.compensated;
        if alone && !entry.steps.iter().any(waits) {
            self.decide_at_once(&mut entry, judged);
            let moved = entry.moves_on();
            self.assessor.end_line(moved, &mut |_, _, _| {});
            self.ready = Some(entry);
        } else {
            self.judge_waiting(entry);
        }
        Ok(true)
    }

    /// Writes what can be written after a block was read.
    fn write_ready(&mut self) {
        if let Some(entry) = self.ready.take() {
            self.write(entry);
        } else if !self.entries.is_empty() {
            self.decide();
            self.write_decided();
        }
    }

    /// Writes a block whose moves are decided, and keeps its buffers.
    fn write(&mut self, mut entry: Box<Entry>) {
        let change = self.forced(&entry, entry.change());
        if self.table.is_some() {
            self.note(&entry, change);
            return self.spare.push(entry);
        }
        let change = self.with_first_feed(&entry, change);
        let change = self.with_stop(&entry, change);
        let pieces = entry.pieces(self.machine);
        let start = self.batch.bytes.len();
        self.wait_before(&entry);
        let view = BlockView {
            text: &entry.text,
            block: &entry.block,
            facts: &entry.facts,
            before: &self.mark,
            after: &entry.mark,
            knobs: self.knobs.as_ref(),
            rapids: entry.moves_by(|kind| kind == MoveKind::Rapid),
            feeds: entry.moves_by(|kind| !matches!(kind, MoveKind::Rapid | MoveKind::Dwell)),
            change: change.as_ref().unwrap_or(&Change::NONE),
            pieces: &pieces,
            stops: self.machine.controller.planner.dwell_stops
                && !entry.facts.compensated
                && entry.needs_stops(self.machine, change.as_ref()),
            rests: entry.rests(self.machine, change.as_ref()),
        };
        if !self.rewriter.write(&view, &mut self.batch.bytes) {
            let message = "the edits of this block contradict each other".to_owned();
            self.reasons.push(
                (0, 0),
                "edit",
                message,
                "change the block by hand",
                &entry.text,
            );
            self.batch.bytes.extend_from_slice(&entry.text);
        }
        self.batch.end_block(start, &mut entry);
        self.expect(&mut entry, change.as_ref());
        std::mem::swap(&mut self.mark, &mut entry.mark);
        self.knobs = entry.knobs.take();
        self.spare.push(entry);
    }
}
