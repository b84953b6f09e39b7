//! What the words of NC I do.

use super::plain_word;
use crate::code::Motion;
use crate::control::{Control, Run};
use crate::expression::Fault;
use crate::own_state::OwnState;
use crate::report::Report;
use gwatt_machine::PathMode;
use gwatt_syntax::{Block, Word};

impl Control<'_> {
    /// Reads a block: what is no plain word of this language is refused.
    pub(crate) fn nci_words(&mut self, block: &mut Block, report: &mut Report<'_, '_>) {
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
    pub(crate) fn take_dynamics(&mut self, run: &mut Run<'_, '_>) {
        let OwnState::Nci(nci) = &mut self.own else {
            return;
        };
        if !nci.is_active() {
            return;
        }
        run.facts.turns_knob = true;
        nci.dynamics.act(self.machine, &mut self.knobs);
    }
}
