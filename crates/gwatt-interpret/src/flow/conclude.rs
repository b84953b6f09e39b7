//! What is done after a line: the moves of cycles about contours, and where it goes on.

use super::{Flow, FlowError};
use crate::control::Effects;
use crate::execute::Interpreter;
use crate::facts::Passage;
use crate::jump::Transfer;
use gwatt_motion::Step;
use gwatt_syntax::Block;
use gwatt_syntax::diagnostic::Diagnostic;

impl Flow {
    /// Lets the program go on after the line that was just executed with these results,
    /// as the line's run number `run` from 1 ([`Self::begin_line`]).
    ///
    /// Moves of a turning cycle about a contour are added to `effects`, and what is wrong. False where the program does not go on, as errors keep it from that.
    pub fn conclude(
        &mut self,
        run: u32,
        interpreter: &mut Interpreter<'_>,
        block: &Block,
        mut effects: Effects<'_>,
    ) -> bool {
        // What is wrong in a loop is wrong in each of its runs.
        let mut stuck = effects.diagnostics.errors > 0 && run > 1;
        let mut transfer = interpreter.transfer();
        effects.facts.passage = transfer.as_ref().map_or(Passage::None, Transfer::passage);
        let mut done = Ok(());
        let cycle = match &mut transfer {
            Some(Transfer::Contour(contour)) => {
                let done = self.turn(contour, interpreter, block, &mut effects);
                effects.facts.contour = contour.lines;
                Some(done)
            }
            Some(Transfer::LatheCycle(cycle)) => {
                Some(self.lathe_cycle(cycle, interpreter, block, &mut effects))
            }
            _ => None,
        };
        if let Some(cycle) = cycle {
            done = cycle;
            stuck |= effects.diagnostics.errors > 0;
            transfer = None;
        }
        // A dwell moves nothing: a loop that waits for what never comes has no other steps.
        let moves = effects.steps.iter().filter(|step| step.moves_axes());
        if done.is_ok() {
            done = self.end_line(run, moves.count());
        }
        if done.is_ok()
            && let Some(transfer) = transfer
        {
            done = self.follow(transfer, interpreter);
        } else if done.is_ok() && effects.steps.iter().any(Step::moves_axes) {
            done = self.after_move(interpreter);
        }
        if let Err(trouble) = done {
            stuck = true;
            effects.diagnostics.push(*trouble);
        }
        !stuck
    }

    /// Counts what the line did, and stops what runs away.
    pub(super) fn end_line(&mut self, run: u32, moves: usize) -> Result<(), Box<Diagnostic>> {
        if moves == 0 {
            self.idle_lines += 1;
            if self.idle_lines > self.limits.idle_lines {
                let message = format!(
                    "{} lines in a row have been executed without a move",
                    self.limits.idle_lines
                );
                let help = "look for a loop that does not end, or that waits for what something else \
                    writes; --max-idle-lines sets this limit";
                return Err(self.trouble(FlowError::new("endless", message, help)));
            }
            return Ok(());
        }
        self.idle_lines = 0;
        if run > 1 {
            self.repeated_moves += moves as u64;
            if self.repeated_moves > self.limits.repeated_moves {
                let message = format!(
                    "more than {} moves by repetition",
                    self.limits.repeated_moves
                );
                let help = "look for a loop that does not end; --max-moves sets this limit";
                return Err(self.trouble(FlowError::new("endless", message, help)));
            }
        }
        Ok(())
    }

    /// Calls the macro that G66 has set, after a block that moved.
    fn after_move(&mut self, interpreter: &mut Interpreter<'_>) -> Result<(), Box<Diagnostic>> {
        if self.modal_named.is_some() {
            return self
                .modal_call(interpreter)
                .map_err(|trouble| self.trouble(trouble));
        }
        let Some(call) = &self.modal else {
            return Ok(());
        };
        // Moves of the macro itself do not call it.
        if !self.calls.is_empty() {
            return Ok(());
        }
        let call = call.clone();
        self.call(call, interpreter)
            .map_err(|trouble| self.trouble(trouble))
    }
}
