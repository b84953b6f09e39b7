//! One block at a time, in LinuxCNC's order of execution: feed mode, F, S, T,
//! tool change, spindle, coolant, dwell, plane, units, offsets, path mode,
//! distance mode, reference points and offsets, motion, stop.

use std::cell::Cell;

use super::compensation::Choice;
use super::control::{Control, Run};
use super::facts::Facts;
use super::fast_path::is_direct;
use super::isg::Isg;
use super::knob::KnobState;
use super::modal::Modal;
use super::nci::Nci;
use super::osp::Osp;
use super::parameters::Parameters;
use super::position::{Position, Reading};
use super::printer;
use super::probe::Probe;
use super::program_coordinates::Programmed;
use super::report::{Diagnostics, Report};
use super::siemens::{Siemens, is_beyond_words};
use super::special::Special;
use super::spindle_announced::Announced;
use super::spindle_speed::SpindleMode;
use super::state_words::Switches;
use super::statement::Traces;
use super::tools::Tools;
use super::turning::Turning;
use super::words::Words;
use gwatt_machine::{Family, Machine};
use gwatt_motion::{ActionKind, Step};
use gwatt_syntax::Block;

/// Executes the blocks of a program.
#[derive(Debug)]
pub struct Interpreter<'m> {
    pub(super) control: Control<'m>,
    pub(super) words: Words,
}

impl<'m> Interpreter<'m> {
    /// Begins a program: state at power-on.
    #[must_use]
    pub fn new(machine: &'m Machine, reading: &Reading) -> Self {
        let mut control = Control {
            machine,
            modal: Modal::power_on(machine),
            position: Position::new(machine, reading),
            knobs: KnobState::new(machine),
            special: Special::new(machine, reading),
            loads: 0,
            loads_off: 0,
            tools: Tools::new(reading.tools.clone()),
            programmed: Programmed::default(),
            polar: None,
            spindle: SpindleMode::default(),
            announced: Announced::default(),
            switches: Switches::default(),
            saved: vec![None],
            probe: Probe::new(reading.probe),
            input: None,
            pending_actions: Vec::new(),
            lost: None,
            bent: false,
            compensation: None,
            choice: Choice::default(),
            corners: None,
            printer: printer::State::new(machine, reading),
            adapts: machine.controller.language.dialect.adapts(),
            direct: is_direct(machine),
            callee: None,
            turning: Turning::default(),
            block_delete: reading.block_delete,
            begun: false,
            ended: false,
            moved: false,
            has_program_number: false,
            run: 1,
            text: reading.text,
            parameters: Parameters::new(machine.controller.language.family),
            traces: Traces::default(),
            transfer: None,
            reads_state: Cell::new(false),
            siemens: (machine.controller.language.family == Family::Siemens)
                .then(|| Box::new(Siemens::new())),
            isg: (machine.controller.language.family == Family::Isg).then(|| Box::new(Isg::new())),
            osp: (machine.controller.language.dialect.osp).then(|| Box::new(Osp::new())),
            nci: (machine.controller.language.family == Family::Nci).then(Nci::default),
        };
        if let Some(file) = &reading.parameters {
            control.parameters.keep(file);
        }
        for given in reading.given.iter() {
            control.give(given);
        }
        control.note_bent();
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

    /// Executes one block: appends what it does to `steps`. What is not
    /// understood is reported, and the block then does nothing. Words whose
    /// values are worked out get them in `block`. What the block is comes into
    /// `facts`.
    #[inline]
    pub fn execute(
        &mut self,
        line: u64,
        text: &[u8],
        block: &mut Block,
        steps: &mut Vec<Step>,
        facts: &mut Facts,
        diagnostics: &mut Diagnostics,
    ) {
        let noted = self.control.note_message(line, text, block, steps);
        if block.issues.is_empty()
            && let Some(()) = self.control.direct(line, text, block, steps, facts)
        {
            facts.plain &= !noted;
            self.control.check_expression();
            return;
        }
        *facts = Facts::default();
        self.execute_any(line, text, block, steps, facts, diagnostics);
        self.control.check_expression();
        // It may have gone the short way with values that were worked out.
        facts.plain = false;
    }

    /// The same for any block; `facts` are those of nothing.
    fn execute_any(
        &mut self,
        line: u64,
        text: &[u8],
        block: &mut Block,
        steps: &mut Vec<Step>,
        facts: &mut Facts,
        diagnostics: &mut Diagnostics,
    ) {
        self.control.parameters.line = line;
        let mut report = Report {
            diagnostics,
            line,
            text,
        };
        if self.control.passes_over(block, &mut report) {
            return;
        }
        if printer::is_command(self.control.machine, block) {
            return self.command_line(block, steps, facts, report);
        }
        if self.control.is_dollar(text) {
            let words = &mut self.words;
            let mut run = Run {
                line,
                block,
                words,
                facts,
                steps,
                report,
            };
            return self.control.dollar(&mut run);
        }
        let beyond = self.control.begin_block(block, text);
        let transfers = beyond && self.control.beyond_words(block, &mut report);
        let reads_state = beyond && self.control.reads_state.take();
        if beyond {
            self.control.learn_from_probe();
        }
        let acts = self.control.acts_without_words();
        if !block.issues.is_empty() || block.words.is_empty() && !acts {
            if block.words.is_empty() {
                self.control.abort(block, &mut report);
            }
            facts.reads_state = reads_state;
            facts.transfers = transfers;
            return;
        }
        if beyond
            && !transfers
            && self
                .control
                .direct(line, text, block, steps, facts)
                .is_some()
        {
            facts.reads_state = reads_state;
            return;
        }
        // Built once in its place: moving parts of it costs more than it seems.
        let mut run = Run {
            line,
            block,
            words: &mut self.words,
            facts,
            steps,
            report,
        };
        let before = run.steps.len();
        let errors = run.report.diagnostics.errors;
        run.facts.executed = true;
        run.facts.reads_state = reads_state;
        self.control.execute(&mut run);
        self.control.check_callee(&mut run);
        if self.control.corners.is_some() {
            self.control.insert_corners(&mut run, before, errors);
        }
        if self.control.compensation.is_some() {
            self.control.compensate(&mut run, before, errors);
        }
        self.control.let_knobs_act(&mut run, before);
        if run.report.diagnostics.errors != errors {
            run.steps.truncate(before);
            self.control.transfer = None;
        }
        run.facts.transfers = self.control.transfer.is_some();
    }

    /// A printer's command.
    fn command_line(
        &mut self,
        block: &Block,
        steps: &mut Vec<Step>,
        facts: &mut Facts,
        report: Report<'_, '_>,
    ) {
        let mut run = Run {
            line: report.line,
            block,
            words: &mut self.words,
            facts,
            steps,
            report,
        };
        self.control.begun = true;
        self.control.command_line(&mut run);
    }
}

impl Control<'_> {
    /// A block begins: whether its language has to read it, since it is more than plain words.
    fn begin_block(&mut self, block: &Block, text: &[u8]) -> bool {
        let mut beyond = !block.issues.is_empty();
        if let Some(siemens) = &mut self.siemens {
            siemens.begin_block();
            beyond |= is_beyond_words(block, text);
        } else if let Some(isg) = &self.isg {
            beyond |= isg.is_beyond_words(block);
        } else if let Some(osp) = &mut self.osp {
            osp.only_keeps = false;
            beyond |= osp.is_beyond_words(block);
        }
        beyond || self.nci.is_some()
    }

    /// Whether the block does something though it has no words.
    fn acts_without_words(&self) -> bool {
        self.siemens.as_ref().is_some_and(|it| it.is_active())
            || self.nci.as_ref().is_some_and(Nci::is_active)
    }

    /// Reports a program that is named and not called.
    fn check_callee(&mut self, run: &mut Run<'_, '_>) {
        if self.callee.take().is_some() {
            let whole = run.whole();
            let message = "nothing in this block calls the program that it names";
            let help = "write M98 <NAME> or G65 <NAME>; a program's own name stands alone in its \
                        block";
            run.report.error("program-name", message, whole).help(help);
        }
    }
}

impl Control<'_> {
    #[inline]
    fn execute(&mut self, run: &mut Run<'_, '_>) {
        self.begun = true;
        run.words
            .fill(run.block, &self.machine.controller, &mut run.report);
        run.facts.checksum = run.words.checksum;
        if self.adapts {
            self.adapt_words(run);
        }
        self.take_dynamics(run);
        let errors = run.report.diagnostics.errors;
        if !self.pending_actions.is_empty() {
            let span = run.whole();
            self.settle_debts(span, run);
            self.tell_spindle(run);
        }
        let siemens = self.siemens.as_deref();
        let special = siemens.is_some_and(|siemens| !siemens.is_plain_motion(run.words));
        if run.words.is_plain_motion() && !special {
            // The same as below, without asking for what is not there.
            self.read_feed(run);
            self.motion_word(run);
            self.motion(run);
            if run.report.diagnostics.errors == errors {
                self.complain_about_rest(run);
            }
            return;
        }
        if siemens.is_some() {
            return self.siemens_block(run);
        }
        if self.machine.controller.language.family == Family::Marlin
            && run.report.diagnostics.errors == errors
            && !run.words.is_alone()
        {
            self.command_line(run);
            return;
        }
        self.general(run, errors);
    }

    /// A block of any words, which are filled in; `errors` from before that.
    pub(super) fn general(&mut self, run: &mut Run<'_, '_>, errors: u64) {
        if self.macro_call(run) {
            return;
        }
        if self.program_number(run) {
            run.words.unused = 0;
            return;
        }
        let dwell_s = self.dwell_time(run);
        self.feed_mode(run);
        self.read_feed(run);
        self.speed_and_tool(run);
        self.m_words(run);
        if let Some(dwell_s) = dwell_s {
            self.dwell(run, dwell_s);
        }
        self.settings(run);
        self.note_queue_and_spindle(run);
        self.turn_knobs(run);
        self.motion_in_mode(run);
        if run.report.diagnostics.errors == errors {
            self.complain_about_rest(run);
        }
        self.end_of_block(run);
    }

    /// Stops and the end come after the motion.
    pub(super) fn end_of_block(&mut self, run: &mut Run<'_, '_>) {
        self.loads &= !std::mem::take(&mut self.loads_off);
        if !run.facts.boundary && run.facts.stop_word.is_none() {
            return;
        }
        if run.words.m.iter().any(|(number, _)| *number == 60) {
            self.change_tool_at_end(run);
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
