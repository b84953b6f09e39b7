//! One block at a time: passed over, read, executed; most go the short way.

use crate::rules::rules_of;
use std::cell::Cell;

use super::compensation::Choice;
use super::control::{Control, Effects, Run};
use super::facts::{Facts, TWO_OF_A_GROUP};
use super::fast_path::is_direct;
use super::knob::KnobState;
use super::languages::language_of;
use super::loads::Loads;
use super::modal::Modal;
use super::parameters::Parameters;
use super::position::Position;
use super::printer;
use super::probe::Probe;
use super::program_coordinates::Programmed;
use super::reading::Reading;
use super::report::Report;
use super::special::Special;
use super::spindle_announced::Announced;
use super::spindle_speed::SpindleMode;
use super::state_words::Switches;
use super::statement::Traces;
use super::tools::Tools;
use super::turning::Turning;
use super::words::Words;
use gwatt_machine::Machine;
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
        let rules = rules_of(&machine.controller.language);
        let language = language_of(&machine.controller.language);
        let mut control = Control {
            machine,
            rules,
            language,
            modal: Modal::power_on(machine),
            position: Position::new(machine, reading),
            knobs: KnobState::new(machine),
            special: Special::new(rules, reading),
            loads: Loads::default(),
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
            goes_on: false,
            moved: false,
            has_program_number: false,
            run: 1,
            text: reading.text,
            parameters: Parameters::new(rules.macros),
            traces: Traces::default(),
            transfer: None,
            reads_state: Cell::new(false),
            own: language.own_state(),
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

    /// Whether lengths count in a unit that neither the program nor the machine file names,
    /// where the control may have another one in force.
    #[must_use]
    pub fn assumes_unit(&self) -> bool {
        self.control.machine.controller.language.units_kept && !self.control.modal.unit_is_said
    }

    /// The limits in force after the last block.
    #[must_use]
    pub fn knobs(&self) -> &KnobState {
        &self.control.knobs
    }

    /// Whether loads are on at the end of the text that no move and no stop has shown.
    #[must_use]
    pub fn leaves_loads_on(&self) -> bool {
        self.control.loads.are_unseen() && !self.control.ended
    }

    /// True once the program has ended (M2, M30, closing `%`).
    #[must_use]
    pub fn ended(&self) -> bool {
        self.control.ended
    }

    /// The same, and nothing that follows is executed: grbl goes on after M2, M30 and `%`.
    #[must_use]
    pub fn ended_for_good(&self) -> bool {
        self.control.ended && !self.control.goes_on
    }

    /// Executes one block: what it does goes into `effects`. What is not
    /// understood is reported, and the block then does nothing. Words whose
    /// values are worked out get them in `block`.
    #[inline]
    pub fn execute(&mut self, line: u64, text: &[u8], block: &mut Block, effects: Effects<'_>) {
        let Effects {
            steps,
            facts,
            diagnostics,
        } = effects;
        let noted = self.control.note_message(line, text, block, steps);
        if block.issues.is_empty()
            && let Some(()) = self.control.direct(line, text, block, steps, facts)
        {
            facts.plain &= !noted;
            self.control.check_expression();
            return;
        }
        *facts = Facts::default();
        self.execute_any(line, text, block, Effects::new(steps, facts, diagnostics));
        self.control.position.apart = self.control.apart_from_program();
        self.control.check_expression();
        // It may have gone the short way with values that were worked out.
        facts.plain = false;
    }

    /// The same for any block; `facts` are those of nothing.
    fn execute_any(&mut self, line: u64, text: &[u8], block: &mut Block, effects: Effects<'_>) {
        let Effects {
            steps,
            facts,
            diagnostics,
        } = effects;
        self.control.parameters.line = line;
        let mut report = Report {
            diagnostics,
            line,
            text,
        };
        if self.control.passes_over(block, &mut report) {
            return;
        }
        let control = &mut self.control;
        let language = control.language;
        if language.is_command(control, block, text) {
            let mut run = Run {
                line,
                block,
                words: &mut self.words,
                facts,
                steps,
                report,
            };
            return language.command(control, &mut run);
        }
        let asks = language.begin_block(control, block, text);
        let beyond = asks || !block.issues.is_empty();
        let transfers = beyond && language.read(control, block, &mut report);
        let reads_state = beyond && self.control.reads_state.take();
        if beyond {
            self.control.learn_from_probe();
        }
        let acts = language.acts_without_words(&self.control);
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
}

impl Control<'_> {
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
        // Words that a code would have used are no further mistake where it is refused.
        let errors = run.report.diagnostics.errors;
        run.words
            .fill(run.block, &self.machine.controller, &mut run.report);
        run.facts.checksum = run.words.checksum;
        if run.words.repeated.is_some() {
            run.facts.fixed = Some(TWO_OF_A_GROUP);
        }
        if self.adapts {
            self.adapt_words(run);
        }
        let language = self.language;
        language.prepare(self, run);
        if !self.pending_actions.is_empty() {
            let span = run.whole();
            self.settle_debts(span, run);
            self.tell_spindle(run);
        }
        if run.words.is_plain_motion() && language.moves_plainly(self, run.words) {
            // The same as below, without asking for what is not there.
            self.read_feed(run);
            self.beam_between_lines(run);
            self.motion_word(run);
            self.lathe_corner(run);
            self.motion(run);
            self.beam_at_empty_line(run);
            self.loads.settle(run.own_steps());
            if run.report.diagnostics.errors == errors {
                self.complain_about_rest(run);
            }
            return;
        }
        language.execute(self, run, errors);
    }
}
