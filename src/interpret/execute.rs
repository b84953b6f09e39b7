//! One block at a time, in LinuxCNC's order of execution: feed mode, F, S, T,
//! tool change, spindle, coolant, dwell, plane, units, offsets, path mode,
//! distance mode, reference points and offsets, motion, stop.

use super::compensation::Compensation;
use super::facts::Facts;
use super::knob::KnobState;
use super::modal::Modal;
use super::moves::{Action, ActionKind, Step};
use super::position::{Position, Reading};
use super::report::{Diagnostics, Report};
use super::words::Words;
use crate::machine::{Family, Machine};
use crate::source::Span;
use crate::syntax::Block;

/// Executes the blocks of a program.
#[derive(Debug)]
pub struct Interpreter<'m> {
    control: Control<'m>,
    words: Words,
}

/// What holds from block to block.
#[derive(Debug)]
pub(super) struct Control<'m> {
    pub(super) machine: &'m Machine,
    pub(super) modal: Modal,
    pub(super) position: Position,
    pub(super) knobs: KnobState,
    pub(super) loads: u32,
    pub(super) loads_off: u32,
    /// Cutter compensation, while it is on or being left.
    pub(super) compensation: Option<Box<Compensation>>,
    block_delete: bool,
    begun: bool,
    pub(super) ended: bool,
    has_program_number: bool,
}

/// The block that is being executed.
pub(super) struct Run<'a, 'l> {
    pub(super) line: u64,
    pub(super) block: &'a Block,
    pub(super) words: &'a mut Words,
    pub(super) facts: Facts,
    pub(super) steps: &'a mut Vec<Step>,
    pub(super) report: Report<'a, 'l>,
}

impl Run<'_, '_> {
    pub(super) fn act(&mut self, kind: ActionKind, value: f64) {
        self.steps.push(Step::Action(Action {
            line: self.line,
            kind,
            value,
        }));
    }

    pub(super) fn whole(&self) -> Span {
        Span {
            start: 0,
            end: self.block.text_end,
        }
    }
}

impl<'m> Interpreter<'m> {
    /// Begins a program: state at power-on.
    #[must_use]
    pub fn new(machine: &'m Machine, reading: &Reading) -> Self {
        let control = Control {
            machine,
            modal: Modal::power_on(machine),
            position: Position::new(reading.start),
            knobs: KnobState::new(machine),
            loads: 0,
            loads_off: 0,
            compensation: None,
            block_delete: reading.block_delete,
            begun: false,
            ended: false,
            has_program_number: false,
        };
        Self {
            control,
            words: Words::new(),
        }
    }

    /// The modal state after the last block.
    #[must_use]
    pub fn modal(&self) -> &Modal {
        &self.control.modal
    }

    /// The limits in force after the last block.
    #[must_use]
    pub fn knobs(&self) -> &KnobState {
        &self.control.knobs
    }

    /// True once the program has ended (M2, M30, closing `%`).
    #[must_use]
    pub fn ended(&self) -> bool {
        self.control.ended
    }

    /// The text of an earlier line whose moves were given with the last block
    /// or are held back still; cut if it is long.
    #[must_use]
    pub fn held_text(&self, line: u64) -> Option<&[u8]> {
        self.control.compensation.as_ref()?.text_of(line)
    }

    /// True while cutter compensation is on, and for the block that ends it.
    #[must_use]
    pub fn compensates(&self) -> bool {
        self.control.compensation.is_some()
    }

    /// True while moves are held back: cutter compensation needs the next one
    /// to know where they end.
    #[must_use]
    pub fn holds(&self) -> bool {
        let compensation = self.control.compensation.as_ref();
        compensation.is_some_and(|compensation| compensation.holds())
    }

    /// Executes one block: appends what it does to `steps`. What is not
    /// understood is reported, and the block then does nothing.
    pub fn execute(
        &mut self,
        line: u64,
        text: &[u8],
        block: &Block,
        steps: &mut Vec<Step>,
        diagnostics: &mut Diagnostics,
    ) -> Facts {
        // Built once in its place: moving parts of it costs more than it seems.
        let mut run = Run {
            line,
            block,
            words: &mut self.words,
            facts: Facts::default(),
            steps,
            report: Report {
                diagnostics,
                line,
                text,
            },
        };
        if self.control.passes_over(block, &mut run.report) {
            return run.facts;
        }
        for issue in &block.issues {
            let found = issue.diagnostic(line, text);
            run.report.diagnostics.push(found);
        }
        if !block.issues.is_empty() || block.words.is_empty() {
            return run.facts;
        }
        let before = run.steps.len();
        let errors = run.report.diagnostics.errors;
        run.facts.executed = true;
        self.control.run(&mut run);
        if self.control.compensation.is_some() {
            self.control.compensate(&mut run, before, errors);
        }
        if run.report.diagnostics.errors != errors {
            run.steps.truncate(before);
        }
        run.facts
    }
}

impl Control<'_> {
    /// Whether the block is deleted, a tape mark, or behind the end.
    fn passes_over(&mut self, block: &Block, report: &mut Report<'_, '_>) -> bool {
        let all = Span {
            start: 0,
            end: block.text_end,
        };
        if self.ended {
            if !(block.tape || block.words.is_empty() && block.issues.is_empty()) {
                report.note_once(
                    "behind-the-end",
                    "what follows the end of the program is not executed",
                    all,
                );
            }
            return true;
        }
        if block.tape {
            // The first `%` opens the tape; one behind any block ends it.
            self.ended = self.begun;
            return true;
        }
        if block.delete_level == 0 {
            return false;
        }
        if !self.machine.controller.language.block_delete {
            report.note_once(
                "no-block-delete",
                "this controller executes blocks that begin with `/`",
                all,
            );
            return false;
        }
        self.block_delete
    }

    #[inline]
    fn run(&mut self, run: &mut Run<'_, '_>) {
        self.begun = true;
        run.words
            .fill(run.block, &self.machine.controller, &mut run.report);
        run.facts.checksum = run.words.checksum;
        let errors = run.report.diagnostics.errors;
        if run.words.is_plain_motion() {
            // The same as below, without asking for what is not there.
            self.read_feed(run);
            self.motion_word(run);
            self.motion(run);
            if run.report.diagnostics.errors == errors {
                self.complain_about_rest(run);
            }
            return;
        }
        self.program_number(run);
        let dwell_s = self.dwell_time(run);
        self.feed_mode(run);
        self.read_feed(run);
        self.speed_and_tool(run);
        self.m_words(run);
        if let Some(dwell_s) = dwell_s {
            self.dwell(run, dwell_s);
        }
        self.settings(run);
        self.turn_knobs(run);
        self.motion(run);
        if run.report.diagnostics.errors == errors {
            self.complain_about_rest(run);
        }
        self.end_of_block(run);
    }

    fn program_number(&mut self, run: &mut Run<'_, '_>) {
        if run.words.take(b'O').is_none() {
            return;
        }
        let span = run.words.span(b'O', run.block);
        if self.has_program_number {
            run.report
                .error(
                    "several-programs",
                    "a second program number: several programs in one file",
                    span,
                )
                .help("give one program at a time; subprograms are not supported");
        }
        self.has_program_number = true;
    }

    /// Words that no code has used: they might mean motion.
    fn complain_about_rest(&self, run: &mut Run<'_, '_>) {
        if self.machine.controller.language.family != Family::Rs274 {
            // Numbers of tool offsets without a code that uses them.
            run.words.take(b'D');
            run.words.take(b'H');
        }
        while run.words.unused != 0 {
            let letter = b'A' + run.words.unused.trailing_zeros() as u8;
            run.words.take(letter);
            let span = run.words.span(letter, run.block);
            let message = format!("nothing in this block uses the {} word", letter as char);
            run.report
                .error("unused-word", message, span)
                .help("take it out, or write the word that it belongs to");
        }
    }

    /// Stops and the end come after the motion.
    fn end_of_block(&mut self, run: &mut Run<'_, '_>) {
        self.loads &= !std::mem::take(&mut self.loads_off);
        if !run.facts.boundary {
            return;
        }
        for index in 0..run.words.m.len() {
            let number = run.words.m[index].0;
            let Some(kind @ (ActionKind::Stop | ActionKind::End)) = self.m_kind(number) else {
                continue;
            };
            self.ended |= kind == ActionKind::End;
            run.act(kind, f64::from(number) / 10.0);
        }
    }
}
