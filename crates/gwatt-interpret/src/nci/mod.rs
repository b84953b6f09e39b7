//! The classic dialect of `TwinCAT` NC I.
//!
//! Source: TF5100 `TwinCAT` 3 NC I, "Classic Dialect Reference Manual"; sections are named
//! at each point. Plain blocks, arcs and the commands that change accelerations are read;
//! R parameters, jumps, subprograms and auxiliary axes are refused.

pub(super) mod language;
pub(super) mod codes;
mod command;
mod dynamics;
mod words;

use super::expression::Fault;
use dynamics::Dynamics;
use gwatt_syntax::Word;

/// What a control of this language keeps besides the modal state.
#[derive(Debug, Default)]
pub(super) struct Nci {
    dynamics: Dynamics,
}

impl Nci {
    /// Whether the block must be executed though it has no words.
    pub(super) fn is_active(&self) -> bool {
        self.dynamics.due
    }
}

/// A word that is read as it stands.
fn plain_word(word: Word) -> Result<(), Fault> {
    let reason = match word.letter {
        b'F' | b'G' | b'H' | b'I' | b'J' | b'K' | b'S' | b'T' | b'X' | b'Y' | b'Z' => {
            return Ok(());
        }
        // "Subroutine techniques".
        b'M' if word.value == 17.0 => "the end of a subprogram",
        b'M' => return Ok(()),
        b'D' if word.value == 0.0 => return Ok(()),
        b'D' => "the data of a tool, whose length only the control knows",
        b'B' | b'U' => "the radius of an arc, which this block is not",
        b'L' | b'P' => "a subprogram call",
        b'Q' => "an auxiliary axis",
        b'R' => "an R parameter",
        b'@' => "a jump, a loop or a decoder stop",
        _ => "a word of this control",
    };
    let message = format!(
        "{} is {reason}, which gwatt does not follow",
        char::from(word.letter)
    );
    let help = "plain blocks of NC I's classic dialect are read: G, M, X, Y, Z, I, J, K, B, U, \
                F, S, T, H, DynOvr and #set param…Dynamics";
    Err(Fault::new("unsupported-word", message, help, word.span))
}
