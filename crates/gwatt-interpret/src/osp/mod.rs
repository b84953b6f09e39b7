//! What Okuma's OSP has besides ISO 6983.
//!
//! Sources: OSP programming manuals 4292-E (OSP-E100M) and 5228-E (OSP-P200M),
//! "Tables of Command Codes" of 4203-E (OSP7030M); sections are named at each
//! point. Blocks that are more than plain words are read here, word by word.

pub(super) mod language;
mod block;
pub(super) mod code;
pub(super) mod codes;
mod statement;
mod terms;
mod variable;

pub(super) use codes::osp_code;

use super::expression::Kept;
use gwatt_syntax::Block;

/// What a control of this language keeps besides the modal state.
#[derive(Debug, Default)]
pub(super) struct Osp {
    /// V1, VC1 and so on: common variables.
    common: Kept,
    /// Local variables of the programs that run.
    levels: Vec<Kept>,
    /// Those of the program that is called next.
    pending: Kept,
    /// SB: the speed of the tool's own spindle, 1/min.
    tool_rpm: f64,
    /// A program's name was read.
    begun: bool,
    /// Between DEF WORK and END: a drawing.
    draws: bool,
    /// G71: the level of M53, mm in program coordinates.
    pub(super) return_mm: Option<f64>,
    pub(super) returns: Option<Return>,
    /// NCYL: the block only keeps the values of its cycle.
    pub(super) only_keeps: bool,
}

/// Where a canned cycle returns to ("Fixed Cycle Functions").
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Return {
    /// M52: the upper limit of the axis.
    Limit,
    /// M53: the level of G71.
    Level,
    /// M54: the level R.
    Point,
}

impl Osp {
    pub(super) fn new() -> Self {
        Self {
            levels: vec![Kept::new()],
            ..Self::default()
        }
    }

    /// Gives a common variable the value that the control has kept.
    pub(super) fn keep(&mut self, name: &str, value: f64) {
        self.common
            .insert(super::expression::Ident::of(format_args!("{name}")), value);
    }

    /// Whether a line must be read here, though the scanner took it for plain
    /// words.
    pub(super) fn is_beyond_words(&self, block: &Block) -> bool {
        self.draws
            || block
                .words
                .iter()
                .any(|word| matches!(word.letter, b'=' | b'O' | b'V'))
    }

    /// A subprogram begins.
    pub(super) fn enter(&mut self) {
        let arguments = std::mem::take(&mut self.pending);
        self.levels.push(arguments);
    }

    /// A subprogram has ended.
    pub(super) fn leave(&mut self) {
        if self.levels.len() > 1 {
            self.levels.pop();
            self.pending.clear();
        }
    }

    fn is_called(&self) -> bool {
        self.levels.len() > 1
    }
}
