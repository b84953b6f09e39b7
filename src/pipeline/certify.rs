//! The certificate: what was written is read, interpreted, planned and
//! evaluated again, and compared with the original. A plain block that stands in
//! both programs byte for byte is not read again while both are in the same
//! state: it could only give the same move.
//!
//! It holds only if (a) every move fits, (b) end points, arcs, dwells and
//! actions are the original's, (c) no effective path speed or acceleration
//! went up, (d) the effective feed of each untouched move is what it was.

mod compare;
mod divided;
mod pieces;
mod reasons;
mod spindle;
mod stands;

use reasons::BUG;
use std::collections::VecDeque;

pub(super) use compare::DOES_NOT_FIT;
use compare::{compare, refuse_unfit};
use divided::{Found, Pieces};
pub(super) use reasons::Reasons;
use stands::Stands;

use super::batch::Batch;
use super::drive::{MoveSink, drive_end, drive_line_end, drive_step};
use super::expected::{Expected, Originals, Stops, added_mode, added_stop, different};
use super::totals::Totals;
use super::watching::watching_at;
use super::{Failure, Options, RowSink, Summary};
use crate::diagnostic::{Diagnostic, Severity};
use crate::interpret::{
    Diagnostics, Effects, Facts, FastPathState, Interpreter, Move, MoveKind, Step,
};
use crate::limit::{Deeper, Depths, Paced, Place};
use crate::machine::Machine;
use crate::power::{Assessment, Assessor, Certificate, Lower, PowerModel, Rating, Want};
use crate::source::lines;
use crate::syntax::{Block, scan_line};

/// Reads the written program.
pub(super) struct Certifier<'m, 'r> {
    interpreter: Interpreter<'m>,
    diagnostics: Diagnostics,
    assessor: Assessor<'m>,
    block: Block,
    steps: Vec<Step>,
    facts: Facts,
    line: u64,
    /// The original's state after the last block.
    original: FastPathState,
    /// The written program is in the same one.
    in_step: bool,
    /// Its interpreter does not yet know where plain blocks have moved to.
    stale: bool,
    verdict: Verdict<'m, 'r>,
}

/// Holds the written program against the original.
pub(super) struct Verdict<'m, 'r> {
    model: PowerModel,
    tally: Totals<'m, 'r>,
    /// What the original does, from the first move that is not judged.
    originals: Originals,
    pieces: Pieces,
    /// How much of it the written program has done, and how much is judged.
    done: usize,
    judged: usize,
    reasons: Reasons,
    /// Lines that do not fit since their neighbours were changed.
    deeper: Vec<Deeper>,
    /// What the plan says of lines that were lowered.
    paced: Vec<Paced>,
    /// The line of the move before, and whether that of the next one is to be
    /// lowered with it.
    before: Option<Place>,
    deepen_next: bool,
    /// The dwells that may be put in.
    stops: Stops,
    machine: &'m Machine,
    /// Where the axes stand in the written program.
    stands: Stands,
    /// Rows of the spindle in the written program that no row of the original
    /// has met yet.
    /// Each with its start, s.
    spindle: VecDeque<(f64, Assessment)>,
}

/// What the certifier found.
pub(super) struct Certified {
    pub(super) summary: Summary,
    pub(super) reasons: Reasons,
    /// Lines that would have to be lowered deeper, in the order of the program.
    pub(super) deeper: Vec<Deeper>,
    /// What the plan says of lines that were lowered.
    pub(super) paced: Vec<Paced>,
}

impl Certified {
    /// With what was found on another way through the program.
    pub(super) fn join(mut self, other: Self) -> Self {
        self.summary.worsen(&other.summary);
        self.reasons.join(other.reasons);
        self.deeper.extend(other.deeper);
        self.paced.extend(other.paced);
        self
    }
}

impl<'m, 'r> Certifier<'m, 'r> {
    pub(super) fn new(
        machine: &'m Machine,
        rungs: &'m Lower,
        options: &Options,
        rows: Option<&'r mut (dyn RowSink + 'r)>,
    ) -> Self {
        let interpreter = Interpreter::new(machine, &options.reading);
        Self {
            original: interpreter.fast_path_state(),
            in_step: true,
            stale: false,
            interpreter,
            diagnostics: Diagnostics::default(),
            assessor: watching_at(machine, rungs, options),
            block: Block::default(),
            steps: Vec::new(),
            facts: Facts::default(),
            line: 0,
            verdict: Verdict::new(machine, options, rows),
        }
    }

    /// Takes the next piece and leaves its buffers empty.
    pub(super) fn take(&mut self, batch: &mut Batch) -> Result<(), Failure> {
        self.verdict.refill(&mut batch.expected);
        let mut rest = batch.bytes.as_slice();
        let mut moves = batch.moves.iter();
        let mut fast_path_states = batch.fast_path_states.drain(..);
        for block in &batch.blocks {
            let Some((text, after)) = rest.split_at_checked(block.length) else {
                break;
            };
            rest = after;
            let mv = if block.plain { moves.next() } else { None };
            if let Some(mv) = mv {
                if self.in_step && block.unchanged {
                    self.original.move_to(&mv.end);
                    self.repeat(mv, text);
                    continue;
                }
                self.execute(text);
                self.original.move_to(&mv.end);
            } else {
                self.execute(text);
                if let Some(fast_path_state) = fast_path_states.next() {
                    self.original = fast_path_state;
                }
            }
            self.in_step = self.interpreter.stands_as(&self.original);
        }
        self.execute(rest);
        drop(fast_path_states);
        batch.clear();
        self.verdict.expect_nothing();
        self.verdict.tally.check()
    }

    /// Executes lines of the written program, and judges what they do.
    fn execute(&mut self, text: &[u8]) {
        if std::mem::take(&mut self.stale) {
            self.interpreter.follow(&self.original);
        }
        for text in lines(text) {
            self.line += 1;
            scan_line(text, self.line == 1, &mut self.block);
            self.steps.clear();
            let Self {
                interpreter,
                diagnostics,
                assessor,
                block,
                steps,
                facts,
                verdict,
                line,
                ..
            } = self;
            interpreter.execute(*line, text, block, Effects::new(steps, facts, diagnostics));
            let text_of = |step: &Step| match step {
                Step::Move(mv) if mv.line != *line => interpreter.held_text(mv).unwrap_or(text),
                _ => text,
            };
            verdict.certify_line(assessor, steps, facts.turns_knob, text_of);
        }
    }

    /// Judges the move of a plain block that stands in both programs, in the
    /// same state: read again, it would be the same move.
    fn repeat(&mut self, mv: &Move, text: &[u8]) {
        let Self {
            assessor, verdict, ..
        } = self;
        self.line += 1;
        self.stale = true;
        verdict.pass_spindle();
        verdict.done += 1;
        if !verdict.stands.take(verdict.machine, None, mv) {
            let message = format!("the written program has {NO_STOP} here");
            let place = (mv.text, mv.line);
            verdict
                .reasons
                .push(place, "changed-sequence", message, BUG, text);
        }
        assessor.want = verdict.want();
        let mut sink = |mv: &Move, after: &Assessment, text: &[u8]| verdict.take(mv, after, text);
        assessor.push(mv, text, &mut sink);
        assessor.end_line(mv.moves_axes(), &mut sink);
    }

    /// Judges what is left and gives the figures.
    pub(super) fn finish(mut self) -> Result<Certified, Failure> {
        let Self {
            assessor, verdict, ..
        } = &mut self;
        drive_end(assessor, verdict);
        verdict.rate(assessor.ratings(), assessor.lower_ratings());
        self.verdict.finish(&self.diagnostics.list, self.line)
    }
}

impl MoveSink for Verdict<'_, '_> {
    fn want(&self) -> Want {
        self.tally.want()
    }

    fn take(&mut self, mv: &Move, judged: &Assessment, text: &[u8]) {
        self.judge(mv, judged, text);
    }
}

impl<'m, 'r> Verdict<'m, 'r> {
    pub(super) fn new(
        machine: &'m Machine,
        options: &Options,
        rows: Option<&'r mut (dyn RowSink + 'r)>,
    ) -> Self {
        Self {
            model: PowerModel::new(machine),
            tally: Totals::new(machine, options, rows),
            stops: Stops::of(machine),
            machine,
            stands: Stands::new(),
            originals: Originals::default(),
            pieces: Pieces::default(),
            done: 0,
            judged: 0,
            reasons: Reasons::default(),
            deeper: Vec::new(),
            paced: Vec::new(),
            before: None,
            deepen_next: false,
            spindle: VecDeque::new(),
        }
    }

    /// Learns the names of files of subprograms.
    pub(super) fn learn_files(&mut self, names: &[String]) {
        self.tally.learn_files(names);
        self.reasons.learn_files(names);
    }

    /// Compares the steps of a line of the written program with the original's, and judges
    /// them; `text_of` gives the text that a step belongs to.
    pub(super) fn certify_line<'t>(
        &mut self,
        assessor: &mut Assessor<'_>,
        steps: &mut [Step],
        turns_knob: bool,
        text_of: impl Fn(&Step) -> &'t [u8],
    ) {
        for step in &mut *steps {
            let text = text_of(step);
            self.take_step(step, text);
            drive_step(assessor, step, text, self);
        }
        let moved = turns_knob || steps.iter().any(Step::moves_axes);
        drive_line_end(assessor, moved, self);
    }

    /// The error of the rows, if there was one.
    pub(super) fn check(&mut self) -> Result<(), Failure> {
        self.tally.check()
    }

    /// Whether the written program must still do something.
    pub(super) fn expects(&mut self) -> bool {
        self.pass_spindle();
        self.originals.get(self.done).is_some()
    }

    /// All that was expected must have been done.
    pub(super) fn expect_nothing(&mut self) {
        if self.expects() {
            let message = "the written program leaves something out".to_owned();
            self.reasons
                .push((0, 0), "changed-sequence", message, BUG, b"");
        }
    }

    /// Takes what was found about limits over time.
    pub(super) fn rate(&mut self, ratings: Vec<Rating>, lower: Vec<Vec<Rating>>) {
        self.tally.rate(ratings, lower);
    }

    /// The figures of the written program, and why the certificate does not
    /// hold.
    pub(super) fn finish(mut self, found: &[Diagnostic], lines: u64) -> Result<Certified, Failure> {
        self.pass_to_move();
        self.tally.check()?;
        let mut reasons = self.reasons;
        for found in found {
            if found.severity == Severity::Error {
                let message = format!("the written program cannot be read: {}", found.message);
                let place = (0, found.line);
                reasons.push(place, "unreadable-output", message, BUG, &found.text);
                reasons.in_file(found.file.as_ref());
            }
        }
        let energy = self.tally.want().energy;
        let mut summary = self.tally.finish(energy);
        summary.lines = lines;
        Ok(Certified {
            summary,
            reasons,
            deeper: self.deeper,
            paced: self.paced,
        })
    }

    /// Forgets what is judged and takes more.
    pub(super) fn refill(&mut self, more: &mut Vec<Expected>) {
        // Actions need no judgement: that they were done is enough.
        let done = self.done;
        while self.judged < done
            && matches!(self.originals.get(self.judged), Some(Expected::Action(_)))
        {
            self.judged += 1;
        }
        self.done = self.originals.refill(self.judged, more);
        self.judged = 0;
    }

    /// Compares a step with the original's next one, and gives it that one's line: what is
    /// found counts for the program that was read.
    pub(super) fn take_step(&mut self, step: &mut Step, text: &[u8]) {
        self.pass_spindle();
        let line = match self.originals.get(self.done) {
            Some(Expected::Move(original)) => Some(original.line),
            Some(Expected::Action(original)) => Some(original.line),
            Some(Expected::Spindle(..)) | None => None,
        };
        self.compare_step(step, text);
        match (step, line) {
            (Step::Move(mv), Some(line)) => mv.line = line,
            (Step::Action(action), Some(line)) => action.line = line,
            (_, None) => {}
        }
    }

    /// (b): the step must be the original's next one.
    fn compare_step(&mut self, step: &Step, text: &[u8]) {
        self.pass_spindle();
        if step.is_note() {
            return;
        }
        let original = self.originals.get(self.done).map(|original| &*original);
        if matches!(step, Step::Move(mv) if added_stop(mv, original, &self.stops)) {
            return self.stands.stop();
        }
        if matches!(step, Step::Action(action) if added_mode(action, original)) {
            return;
        }
        let place = self.done;
        let piece = match step {
            Step::Move(mv) => self.compare_piece(mv),
            Step::Action(_) => None,
        };
        let original = self.originals.get(place).map(|original| &*original);
        self.done += usize::from(piece.is_none());
        let message = match (step, original) {
            (Step::Move(mv), _) if piece.is_some() && !self.stands.take(self.machine, None, mv) => {
                Some(NO_STOP)
            }
            _ if piece.is_some() => match piece {
                Some(Found::Wrong(what)) => Some(what),
                Some(Found::Right) | None => None,
            },
            (Step::Move(mv), Some(Expected::Move(original))) => {
                let stands = self.stands.take(self.machine, Some(original), mv);
                different(original, mv).or((!stands).then_some(NO_STOP))
            }
            (Step::Action(action), Some(Expected::Action(original)))
                if action.kind == original.kind && same(action.value, original.value) =>
            {
                None
            }
            _ => Some("something else than the original"),
        };
        let Some(message) = message else { return };
        let place = match original {
            Some(Expected::Move(original)) => (original.text, original.line),
            Some(Expected::Action(original)) => (0, original.line),
            Some(Expected::Spindle(..)) | None => (0, 0),
        };
        let message = format!("the written program has {message} here");
        self.reasons
            .push(place, "changed-sequence", message, BUG, text);
    }

    /// (a), (c) and (d): the written move is judged.
    fn judge(&mut self, mv: &Move, after: &Assessment, text: &[u8]) {
        if mv.kind == MoveKind::Spindle {
            return self.judge_spindle(mv, after, text);
        }
        self.pass_to_move();
        let original = self.originals.get(self.judged).map(|original| &*original);
        if added_stop(mv, original, &self.stops) {
            refuse_unfit(
                &self.model,
                (mv.text, mv.line),
                after,
                text,
                &mut self.reasons,
            );
            return self.tally.wait(mv, after, text);
        }
        if let Some(Expected::Move(original)) = self.originals.get(self.judged) {
            let place = (original.text, original.line);
            // Under the robust bound the neighbours count as well.
            let robust = after.certificate == Certificate::Robust;
            let by_neighbours = after.ahead || robust || original.split.is_some();
            if by_neighbours && !original.hopeless && !self.model.fits(&after.demand) {
                let next_to = |place| Deeper { place, paced: None };
                let before = self.before.filter(|_| robust);
                self.deeper.extend(before.map(next_to));
                let by_itself = !robust && original.split.is_none();
                let paced = by_itself.then(|| Paced::of(&self.model, place, mv, after));
                self.deeper.push(Deeper { place, paced });
                self.deepen_next = robust;
            } else if std::mem::take(&mut self.deepen_next) {
                self.deeper.push(Deeper { place, paced: None });
            }
            self.deeper.truncate(Depths::wanted() + 1);
            if original.changed && after.ahead && self.paced.len() <= Depths::wanted() {
                self.paced.push(Paced::of(&self.model, place, mv, after));
            }
            self.before = Some(place);
            let model = (self.machine, &self.model);
            compare(model, original, mv, after, text, &mut self.reasons);
        }
        let Some(after) = &self.add_piece(after) else {
            return;
        };
        if let Some(Expected::Move(original)) = self.originals.get(self.judged)
            && let Some(row) = &mut original.row
        {
            row.peak_after_w = Some(after.demand.peak_w);
            row.regen_after_w = Some(after.demand.regen_w);
            row.start_after_s = Some(self.tally.duration_s());
            row.duration_after_s = Some(after.duration_s);
            self.tally.write(row);
        }
        self.judged += 1;
        self.tally.add(mv, after, text);
    }
}

/// What is missing before a move.
const NO_STOP: &str = "no stop before it, where a rapid stopped,";

/// Whether two values are one; a place that is not known is not a number.
fn same(a: f64, b: f64) -> bool {
    a == b || a.is_nan() && b.is_nan()
}
