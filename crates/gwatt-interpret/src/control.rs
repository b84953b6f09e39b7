//! What holds from block to block, and the block that is being executed. What the words do is
//! in the files of their kinds, as methods of both.

use crate::rules::LanguageRules;
use std::cell::Cell;
use std::fmt;

use super::compensation::{Choice, Compensation, Corners};
use super::facts::Facts;
use super::jump::Transfer;
use super::knob::KnobState;
use super::loads::Loads;
use super::modal::Modal;
use super::own_state::OwnState;
use super::parameters::Parameters;
use super::position::Position;
use super::printer;
use super::probe::Probe;
use super::program_coordinates::{Polar, Programmed};
use super::reading::BlockDelete;
use super::report::{Diagnostics, Report};
use super::special::Special;
use super::spindle_announced::Announced;
use super::spindle_speed::SpindleMode;
use super::state_words::{Saved, Switches};
use super::statement::Traces;
use super::tools::Tools;
use super::turning::Turning;
use super::words::Words;
use gwatt_machine::Machine;
use gwatt_motion::{Action, ActionKind, Step};
use gwatt_syntax::Block;
use gwatt_syntax::source::Span;

/// What holds from block to block.
#[derive(Debug)]
pub(super) struct Control<'m> {
    pub(super) machine: &'m Machine,
    /// What its language differs in from others.
    pub(super) rules: &'static LanguageRules,
    /// How its language reads and executes blocks.
    pub(super) language: &'static dyn Language,
    pub(super) modal: Modal,
    pub(super) position: Position,
    pub(super) knobs: KnobState,
    pub(super) special: Special,
    pub(super) loads: Loads,
    pub(super) tools: Tools,
    pub(super) programmed: Programmed,
    /// G16.
    pub(super) polar: Option<Polar>,
    pub(super) spindle: SpindleMode,
    pub(super) announced: Announced,
    pub(super) switches: Switches,
    /// What M70 has saved, for each subprogram that is running.
    pub(super) saved: Vec<Option<Box<Saved>>>,
    /// What is known of the last probe; M66 has asked.
    pub(super) probe: Probe,
    pub(super) input: Option<f64>,
    /// What a restored state still has to do and to say.
    pub(super) pending_actions: Vec<(ActionKind, f64)>,
    pub(super) lost: Option<&'static str>,
    /// Targets are more than offsets: see `target_coordinates`.
    pub(super) bent: bool,
    /// Cutter compensation, while it is on or being left.
    pub(super) compensation: Option<Box<Compensation>>,
    /// What the next one depends on.
    pub(super) choice: Choice,
    /// Chamfers and rounded corners, once the program has any.
    pub(super) corners: Option<Box<Corners>>,
    pub(super) printer: printer::State,
    /// The words of a block need a second look: see `dialect`.
    pub(super) adapts: bool,
    /// Blocks may take the short way: see `fast_path`.
    pub(super) direct: bool,
    /// The program that the block names to be called.
    pub(super) callee: Option<String>,
    pub(super) turning: Turning,
    pub(super) block_delete: BlockDelete,
    pub(super) begun: bool,
    pub(super) ended: bool,
    /// The control goes on with what comes after that end (grbl).
    pub(super) goes_on: bool,
    /// Some axis has been moved.
    pub(super) moved: bool,
    pub(super) has_program_number: bool,
    /// Which run of the line this is, from 1.
    pub(super) run: u32,
    /// Which text it stands in; 0 is the program itself.
    pub(super) text: u16,
    pub(super) parameters: Parameters,
    /// Lines that run again and again.
    pub(super) traces: Traces,
    pub(super) transfer: Option<Transfer>,
    /// A value of the block shows the motion word or the F in force.
    pub(super) reads_state: Cell<bool>,
    /// What only its language keeps.
    pub(super) own: OwnState,
}

/// How a language reads and executes its blocks. What languages differ in besides are the facts
/// of [`LanguageRules`].
pub(super) trait Language: fmt::Debug + Sync {
    /// What it keeps besides what all languages keep, when a program begins.
    fn own_state(&self) -> OwnState {
        OwnState::None
    }

    /// Whether a line is a command with parameters of its own and no block of words.
    fn is_command(&self, _control: &Control<'_>, _block: &Block, _text: &[u8]) -> bool {
        false
    }

    /// Executes such a line.
    fn command(&self, _control: &mut Control<'_>, _run: &mut Run<'_, '_>) {}

    /// A block begins: whether it has to be read, though the scanner took it for plain words.
    fn begin_block(&self, _control: &mut Control<'_>, _block: &Block, _text: &[u8]) -> bool {
        false
    }

    /// Reads a block that is more than plain words: values that are worked out, assignments,
    /// flow. True when the program does not go on at the next line. What is not understood
    /// stays in the block's issues and is reported.
    fn read(
        &self,
        control: &mut Control<'_>,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool;

    /// Whether a block that has been read does something though it has no words.
    fn acts_without_words(&self, _control: &Control<'_>) -> bool {
        false
    }

    /// The words of a block are sorted, and nothing is executed yet.
    fn prepare(&self, _control: &mut Control<'_>, _run: &mut Run<'_, '_>) {}

    /// Whether words of a plain move are no more than that in the state that is reached.
    fn moves_plainly(&self, _control: &Control<'_>, _words: &Words) -> bool {
        true
    }

    /// Executes any other block; `errors` from before it.
    fn execute(&self, control: &mut Control<'_>, run: &mut Run<'_, '_>, errors: u64);

    /// The value of an expression in the state that is reached; `None` where it has none.
    fn value(&self, _control: &mut Control<'_>, _text: &[u8]) -> Option<f64> {
        None
    }

    /// A subprogram begins.
    fn enter(&self, _control: &mut Control<'_>) {}

    /// A subprogram has ended.
    fn leave(&self, _control: &mut Control<'_>) {}
}

/// What a block does goes into these.
#[derive(Debug)]
pub struct Effects<'a> {
    /// Its moves and actions are added.
    pub steps: &'a mut Vec<Step>,
    /// What it is besides its moves; filled in.
    pub facts: &'a mut Facts,
    /// What is wrong with it is added.
    pub diagnostics: &'a mut Diagnostics,
}

impl<'a> Effects<'a> {
    /// Into these.
    #[inline]
    pub fn new(
        steps: &'a mut Vec<Step>,
        facts: &'a mut Facts,
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        Self {
            steps,
            facts,
            diagnostics,
        }
    }
}

/// A block that is held with its place.
#[derive(Clone, Copy)]
pub(super) struct HeldBlock<'a> {
    pub(super) line: u64,
    pub(super) text: &'a [u8],
    pub(super) block: &'a Block,
}

/// The block that is being executed.
pub(super) struct Run<'a, 'l> {
    pub(super) line: u64,
    pub(super) block: &'a Block,
    pub(super) words: &'a mut Words,
    pub(super) facts: &'a mut Facts,
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

    /// The steps of its line.
    pub(super) fn own_steps(&self) -> impl Iterator<Item = &Step> {
        let is_own = |step: &&Step| match step {
            Step::Move(mv) => mv.line == self.line,
            Step::Action(action) => action.line == self.line,
        };
        self.steps.iter().filter(is_own)
    }

    pub(super) fn whole(&self) -> Span {
        Span {
            start: 0,
            end: self.block.text_end,
        }
    }
}
