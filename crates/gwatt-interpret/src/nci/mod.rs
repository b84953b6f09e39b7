//! The classic dialect of `TwinCAT` NC I.
//!
//! Source: TF5100 `TwinCAT` 3 NC I, "Classic Dialect Reference Manual"; sections are named
//! at each point. Plain blocks, arcs and the commands that change accelerations are read;
//! R parameters, jumps, subprograms and auxiliary axes are refused.

mod command;
mod dynamics;

use super::code::{GCode, Motion};
use super::execute::{Control, Run};
use super::expression::Fault;
use super::report::Report;
use dynamics::Dynamics;
use gwatt_machine::PathMode;
use gwatt_syntax::{Block, Word};

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

impl Control<'_> {
    /// Reads a block: what is no plain word of this language is refused.
    pub(super) fn nci_words(&mut self, block: &mut Block, report: &mut Report<'_, '_>) {
        let text = report.text.get(..block.text_end as usize);
        let text = text.unwrap_or(report.text);
        let read = if block.issues.is_empty() {
            self.nci_plain(block)
        } else {
            self.nci_command(text, block)
        };
        if let Err(fault) = read {
            report
                .error(fault.rule, fault.message, fault.span)
                .help(fault.help);
            // Nothing of it is executed.
            block.words.clear();
            block.issues.clear();
        }
    }

    /// Plain words; B and U become R, the radius of an arc.
    fn nci_plain(&mut self, block: &mut Block) -> Result<(), Fault> {
        let mut motion = self.modal.motion;
        for word in &block.words {
            if word.letter == b'G' {
                motion = match word.value {
                    0.0 => Motion::Rapid,
                    1.0 => Motion::Linear,
                    2.0 => Motion::ArcCw,
                    3.0 => Motion::ArcCcw,
                    _ => motion,
                };
            }
        }
        let arc = matches!(motion, Motion::ArcCw | Motion::ArcCcw);
        for word in &mut block.words {
            match word.letter {
                // "Circular Interpolation", "Radius programming".
                b'B' | b'U' if arc => word.letter = b'R',
                _ => plain_word(*word)?,
            }
        }
        let moves = |word: &Word| matches!(word.letter, b'X' | b'Y' | b'Z');
        let rapid_word = |word: &Word| word.letter == b'G' && word.value == 0.0;
        let rapid = block.words.iter().any(rapid_word)
            || motion == Motion::Rapid && block.words.iter().any(moves);
        // "Rapid Traverse": G0 cancels G60.
        if rapid && self.machine.path.mode != Some(PathMode::ExactStop) {
            self.modal.path_mode = PathMode::LookAhead;
        }
        Ok(())
    }

    /// Before a block is executed: what commands for accelerations have changed.
    pub(super) fn take_dynamics(&mut self, run: &mut Run<'_, '_>) {
        let Some(nci) = self.nci.as_mut().filter(|nci| nci.is_active()) else {
            return;
        };
        run.facts.turns_knob = true;
        nci.dynamics.act(self.machine, &mut self.knobs);
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

/// The G words (number × 10) of this language ("Command overview").
pub(super) fn nci_g_code(number: u16, common: impl Fn(u16) -> Option<GCode>) -> Option<GCode> {
    match number {
        0 | 10 | 20 | 30 | 40 | 170 | 180 | 190 | 400 | 900 | 910 => common(number),
        // "Accurate Stop": G60 holds until G0.
        600 => Some(GCode::PathMode),
        // "Inch/metric dimensions": G71 is in force at the start. Feeds stay in the units of
        // the machine under G70, which its parameters say.
        710 => common(210),
        // "Zero Offset Shifts": G53 takes them away until further notice.
        530 => Some(GCode::WorkOffset(0)),
        540..=570 if number.is_multiple_of(10) => Some(GCode::WorkOffset((number / 10 - 53) as u8)),
        _ => None,
    }
}
