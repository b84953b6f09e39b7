//! The certificate: what was written is read, interpreted, planned and
//! evaluated again, and held against the original.
//!
//! It holds only if (a) every move fits, (b) end points, arcs, dwells and
//! actions are the original's, (c) no effective path speed or acceleration
//! went up, (d) the effective feed of each untouched move is what it was.

use std::collections::VecDeque;

use super::tally::{Tally, row};
use super::{Failure, Options, Row, RowSink, Summary};
use crate::diagnostic::Diagnostic;
use crate::interpret::{Action, Diagnostics, Interpreter, Move, MoveKind, Step};
use crate::limit::Change;
use crate::machine::Machine;
use crate::power::{Assessment, Assessor, PowerModel, Want};
use crate::source::{Span, lines};
use crate::syntax::{Block, scan_line};

/// Rounding that speeds and accelerations may differ by, as a share.
const ROUNDING: f64 = 1e-9;

/// What the original does, in order.
#[derive(Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "moves are the common case and live in reused buffers"
)]
pub(super) enum Expected {
    Move(ExpectedMove),
    Action(Action),
}

/// A move of the original with what was decided for it.
#[derive(Debug, Clone)]
pub(super) struct ExpectedMove {
    pub(super) mv: Move,
    pub(super) assessment: Assessment,
    pub(super) change: Change,
    /// The F in force in program units.
    pub(super) feed_before: Option<f64>,
    /// It does not fit and could not be helped; the reason has been given.
    pub(super) hopeless: bool,
}

/// A piece of the written program with what it must do.
#[derive(Debug, Default)]
pub(super) struct Batch {
    /// Whole lines.
    pub(super) bytes: Vec<u8>,
    pub(super) expected: Vec<Expected>,
}

/// Reads the written program.
pub(super) struct Certifier<'m, 'r> {
    machine: &'m Machine,
    model: PowerModel,
    interpreter: Interpreter<'m>,
    diagnostics: Diagnostics,
    assessor: Assessor<'m>,
    tally: Tally<'m, 'r>,
    block: Block,
    steps: Vec<Step>,
    line: u64,
    /// Original moves whose written twins have not been judged yet.
    pending: VecDeque<ExpectedMove>,
    reasons: Reasons,
    /// Time of the original so far, s.
    start_s: f64,
}

/// Why the certificate does not hold: the first reasons in full.
#[derive(Debug, Default)]
pub(super) struct Reasons {
    pub(super) list: Vec<Diagnostic>,
    pub(super) count: u64,
}

impl Reasons {
    pub(super) fn push(
        &mut self,
        line: u64,
        rule: &'static str,
        message: String,
        help: &str,
        text: &[u8],
    ) {
        self.count += 1;
        if self.list.len() < Summary::KEPT {
            let span = Span::new(0, crate::source::split_line_end(text).0.len());
            self.list.push(
                Diagnostic::error(rule, message)
                    .at(line, span, text)
                    .help(help),
            );
        }
    }
}

/// What the certifier found.
pub(super) struct Certified {
    pub(super) summary: Summary,
    pub(super) reasons: Reasons,
}

impl<'m, 'r> Certifier<'m, 'r> {
    pub(super) fn new(
        machine: &'m Machine,
        options: &Options,
        rows: Option<&'r mut (dyn RowSink + 'r)>,
    ) -> Self {
        Self {
            machine,
            model: PowerModel::new(machine),
            interpreter: Interpreter::new(machine, options.start, options.block_delete),
            diagnostics: Diagnostics::default(),
            assessor: Assessor::new(machine, options.certificate, Want::ALL),
            tally: Tally::new(machine, options, rows),
            block: Block::default(),
            steps: Vec::new(),
            line: 0,
            pending: VecDeque::new(),
            reasons: Reasons::default(),
            start_s: 0.0,
        }
    }

    /// Takes the next piece.
    pub(super) fn take(&mut self, batch: &mut Batch) -> Result<(), Failure> {
        let mut expected = batch.expected.drain(..);
        for text in lines(&batch.bytes) {
            self.line += 1;
            scan_line(text, self.line == 1, &mut self.block);
            self.steps.clear();
            self.interpreter.execute(
                self.line,
                text,
                &self.block,
                &mut self.steps,
                &mut self.diagnostics,
            );
            for step in &self.steps {
                let Self {
                    assessor,
                    tally,
                    pending,
                    reasons,
                    model,
                    machine,
                    start_s,
                    ..
                } = self;
                match (step, expected.next()) {
                    (Step::Move(mv), Some(Expected::Move(original))) => {
                        if let Some(message) = different(&original, mv) {
                            reasons.push(original.mv.line, "changed-motion", message, BUG, text);
                        }
                        pending.push_back(original);
                        assessor.want = tally.want();
                        assessor.push(mv, text, &mut |mv, assessment, text| {
                            if let Some(original) = pending.pop_front() {
                                compare(model, &original, mv, assessment, text, reasons);
                                let row =
                                    after_row(machine, model, &original, assessment, *start_s);
                                tally.write(&row);
                                *start_s += original.assessment.duration_s;
                            }
                            tally.add(mv, assessment, text);
                        });
                    }
                    (Step::Action(action), Some(Expected::Action(original)))
                        if action.kind == original.kind && action.value == original.value => {}
                    (_, original) => {
                        let line = match original {
                            Some(Expected::Move(original)) => original.mv.line,
                            Some(Expected::Action(original)) => original.line,
                            None => 0,
                        };
                        let message =
                            "the written program does something else than the original".to_owned();
                        reasons.push(line, "changed-sequence", message, BUG, text);
                    }
                }
            }
        }
        if expected.next().is_some() {
            let message = "the written program leaves something out".to_owned();
            self.reasons.push(0, "changed-sequence", message, BUG, b"");
        }
        self.tally.check()
    }

    /// Judges what is left and gives the figures.
    pub(super) fn finish(mut self) -> Result<Certified, Failure> {
        let Self {
            assessor,
            tally,
            pending,
            reasons,
            model,
            machine,
            start_s,
            ..
        } = &mut self;
        assessor.finish(&mut |mv, assessment, text| {
            if let Some(original) = pending.pop_front() {
                compare(model, &original, mv, assessment, text, reasons);
                tally.write(&after_row(machine, model, &original, assessment, *start_s));
                *start_s += original.assessment.duration_s;
            }
            tally.add(mv, assessment, text);
        });
        self.tally.check()?;
        for diagnostic in self
            .diagnostics
            .list
            .iter()
            .filter(|it| it.severity == crate::diagnostic::Severity::Error)
        {
            let message = format!("the written program cannot be read: {}", diagnostic.message);
            self.reasons.push(
                diagnostic.line,
                "unreadable-output",
                message,
                BUG,
                &diagnostic.text,
            );
        }
        let mut summary = self.tally.finish();
        summary.lines = self.line;
        Ok(Certified {
            summary,
            reasons: self.reasons,
        })
    }
}

const BUG: &str = "nothing was written; this is a fault of gwatt, please report it";

/// (b): what differs in the geometry of two moves, if anything.
fn different(original: &ExpectedMove, mv: &Move) -> Option<String> {
    let before = &original.mv;
    let same_kind = before.kind == mv.kind
        || original.change.as_feed && before.kind == MoveKind::Rapid && mv.kind == MoveKind::Feed;
    let message = if !same_kind {
        "another kind of move"
    } else if before.start != mv.start
        || before.end != mv.end
        || before.unknown_start != mv.unknown_start
    {
        "another start or end point"
    } else if before.arc != mv.arc {
        "another arc"
    } else if before.dwell_s != mv.dwell_s {
        "another dwell"
    } else if before.path_mode != mv.path_mode {
        "another path mode"
    } else if before.loads != mv.loads {
        "other switched loads"
    } else {
        return None;
    };
    Some(format!("the written program has {message} here"))
}

/// (a), (c) and (d) for one move.
fn compare(
    model: &PowerModel,
    original: &ExpectedMove,
    mv: &Move,
    after: &Assessment,
    text: &[u8],
    reasons: &mut Reasons,
) {
    let before = &original.assessment;
    let line = original.mv.line;
    if !model.fits(&after.demand) && !original.hopeless {
        let message = format!(
            "the block still needs {:.1} W of {:.1} W",
            after.demand.peak_w,
            model.limit_w(after.demand.converter)
        );
        reasons.push(
            line,
            "does-not-fit",
            message,
            "another strategy, or --allow feed, may help",
            text,
        );
    }
    let rises = |before: f64, after: f64| after > before * (1.0 + ROUNDING);
    let axes_rise = mv.moving.iter().any(|axis| {
        !original.change.as_feed && rises(original.mv.accel_mm_s2[axis], mv.accel_mm_s2[axis])
    });
    if rises(before.speed_mm_s, after.speed_mm_s)
        || rises(before.accel_mm_s2, after.accel_mm_s2)
        || axes_rise
    {
        reasons.push(
            line,
            "went-up",
            "a speed or an acceleration went up".to_owned(),
            BUG,
            text,
        );
    }
    let untouched = original.change.is_none();
    if untouched && (before.speed_mm_s - after.speed_mm_s).abs() > ROUNDING * before.speed_mm_s
        || untouched
            && (before.accel_mm_s2 - after.accel_mm_s2).abs() > ROUNDING * before.accel_mm_s2
    {
        let message = "the feed of a block that was not to be changed differs".to_owned();
        reasons.push(line, "changed-feed", message, BUG, text);
    }
}

/// The row of an original move, with what became of it.
fn after_row(
    machine: &Machine,
    model: &PowerModel,
    original: &ExpectedMove,
    after: &Assessment,
    start_s: f64,
) -> Row {
    let mut row = row(machine, model, &original.mv, &original.assessment, start_s);
    row.peak_after_w = Some(after.demand.peak_w);
    row.regen_after_w = Some(after.demand.regen_w);
    row.duration_after_s = Some(after.duration_s);
    describe(machine, original, &mut row);
    row
}

/// What was done: action, word, and its value before and after.
fn describe(machine: &Machine, original: &ExpectedMove, row: &mut Row) {
    let change = &original.change;
    let knob_name = |index: usize| {
        machine
            .controller
            .knobs
            .get(index)
            .map_or_else(String::new, |knob| {
                format!("{}{}", knob.code.0 as char, f64::from(knob.code.1) / 10.0)
            })
    };
    let speed = change.feed.is_some() || change.rapid_percent.is_some();
    row.action = match (speed, change.accel.is_some()) {
        (true, true) => "lower speed and acceleration",
        (true, false) if change.as_feed => "rapid as feed",
        (true, false) if change.rapid_percent.is_some() => "lower rapid speed",
        (true, false) => "lower feed",
        (false, true) => "lower acceleration",
        (false, false) if original.hopeless => "none possible",
        (false, false) => "",
    };
    let mut names = Vec::new();
    if let Some((index, values)) = &change.accel {
        names.push(knob_name(*index));
        let least = original
            .mv
            .moving
            .iter()
            .map(|axis| values[axis])
            .fold(f64::INFINITY, f64::min);
        row.value_after = least.is_finite().then_some(least);
        row.value_before = original
            .mv
            .moving
            .iter()
            .find(|axis| values[*axis] == least)
            .map(|axis| {
                let share = original.mv.accel_mm_s2[axis]
                    / machine.axes[axis].map_or(1.0, |data| data.accel_mm_s2);
                match machine.controller.knobs.get(*index).map(|knob| knob.unit) {
                    Some(crate::machine::KnobUnit::Percent) => share * 100.0,
                    _ => original.mv.accel_mm_s2[axis],
                }
            });
    }
    if let Some((index, percent)) = change.rapid_percent {
        names.insert(0, knob_name(index));
        row.value_before = Some(original.mv.rapid_factor * 100.0);
        row.value_after = Some(percent);
    }
    if let Some(feed) = change.feed {
        names.insert(0, "F".to_owned());
        row.value_before = original.feed_before.filter(|_| !change.as_feed);
        row.value_after = Some(feed);
    }
    row.knob = names.join(" ");
}
