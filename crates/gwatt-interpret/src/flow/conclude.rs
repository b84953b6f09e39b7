//! What is done after a line: the moves of cycles about contours, and where it goes on.

use super::Flow;
use crate::execute::Interpreter;
use crate::facts::Facts;
use crate::report::Diagnostics;
use crate::transfer::Transfer;
use gwatt_motion::Step;
use gwatt_syntax::Block;

impl Flow {
    /// Lets the program go on after the line that was just executed with these results,
    /// as the line's run number `run` from 1 ([`Self::begin_line`]).
    ///
    /// Moves of a turning cycle about a contour are added to `steps`, what is wrong to
    /// `diagnostics`. False where the program does not go on, as errors keep it from that.
    pub fn conclude(
        &mut self,
        run: u32,
        interpreter: &mut Interpreter<'_>,
        block: &Block,
        steps: &mut Vec<Step>,
        facts: &mut Facts,
        diagnostics: &mut Diagnostics,
    ) -> bool {
        // What is wrong in a loop is wrong in each of its runs.
        let mut stuck = diagnostics.errors > 0 && run > 1;
        let mut transfer = interpreter.transfer();
        let mut done = Ok(());
        let cycle = match &mut transfer {
            Some(Transfer::Contour(contour)) => {
                let done = self.turn(contour, interpreter, block, steps, diagnostics);
                facts.contour = contour.lines;
                facts.guessed = facts.guessed.or(contour.guessed());
                Some(done)
            }
            Some(Transfer::LatheCycle(cycle)) => {
                Some(self.lathe_cycle(cycle, interpreter, block, steps, diagnostics))
            }
            _ => None,
        };
        if let Some(cycle) = cycle {
            done = cycle;
            stuck |= diagnostics.errors > 0;
            transfer = None;
        }
        let moves = steps.iter().filter(|step| matches!(step, Step::Move(_)));
        if done.is_ok() {
            done = self.end_line(run, moves.clone().count());
        }
        if done.is_ok()
            && let Some(transfer) = transfer
        {
            done = self.follow(transfer, interpreter);
        } else if done.is_ok() && moves.count() > 0 {
            done = self.after_move(interpreter);
        }
        if let Err(trouble) = done {
            stuck = true;
            diagnostics.push(*trouble);
        }
        !stuck
    }
}
