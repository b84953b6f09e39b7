//! Blocks that are more than plain words: values that are worked out,
//! assignments, and flow.

pub(super) mod language;
mod macro_b;
pub(super) mod keyword;
mod o_word;
mod trace;
mod control;

pub(super) use o_word::{Sight, glance, glance_at};
pub(super) use trace::{Trace, Traces};

use self::trace::{For, Recorder, Target};

use super::expression::{Fault, Held, Name, Reader};
use super::jump::Transfer;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Word};

/// Most assignments in one block.
const ASSIGNMENTS_MAX: usize = 64;

/// What a block says besides its words.
#[derive(Debug, Default)]
pub(super) struct Statement<'t> {
    /// They take effect when the whole block has been read.
    pub(super) assignments: Vec<(Name<'t>, Held, Span)>,
    pub(super) transfer: Option<Transfer>,
    /// The program that a call names: `M98 <NAME>`.
    pub(super) callee: Option<String>,
    /// `,C` or `,R`.
    pub(super) corner: Option<Word>,
    /// An alarm whose condition nobody knows.
    pub(super) alarm: Option<Span>,
    /// A setting of the control decides the value of an inverse function.
    pub(super) unsure_angle: Option<Span>,
    recorder: Recorder,
    /// How it was read, if that is recorded.
    pub(super) trace: Option<Box<Trace>>,
}

/// Why a block could not be read.
pub(super) enum Unread {
    /// This is wrong with it.
    Fault(Fault),
    /// It is no statement of this language: its issues say it best.
    Foreign,
}

/// `<NAME>`: of the program itself at the beginning of a block, else of the
/// one that is called (Fanuc 30i, "Program Name").
fn program_name(
    name: String,
    start: usize,
    reader: &Reader<'_>,
    statement: &mut Statement<'_>,
    block: &mut Block,
) {
    if !block.words.is_empty() {
        statement.callee = Some(name);
        return;
    }
    statement.recorder.lost = true;
    let span = Span::new(start, reader.at);
    block.words.push(Word {
        letter: b'O',
        value: 0.0,
        span,
        number: span,
    });
}

impl From<Fault> for Unread {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}
