//! Runs through the subroutine of a contour for a turning cycle of `LinuxCNC`.

use super::{Flow, FlowError};
use crate::control::{Effects, HeldBlock};
use crate::execute::Interpreter;
use crate::jump::{Transfer, Verb};
use crate::lathe_cycle::LatheCycle;
use crate::lathe_cycle::contour::Reader;
use crate::parameters::LOCALS;
use crate::report::Diagnostics;
use gwatt_syntax::Block;
use gwatt_syntax::diagnostic::Diagnostic;

impl Flow {
    /// Reads the contour for a cycle of the line that is being executed, and
    /// adds the cycle's moves to `effects`.
    pub(crate) fn lathe_cycle(
        &mut self,
        cycle: &LatheCycle,
        interpreter: &mut Interpreter<'_>,
        block: &Block,
        effects: &mut Effects<'_>,
    ) -> Result<(), Box<Diagnostic>> {
        let here = self.now;
        let errors = effects.diagnostics.errors;
        let mut reader = interpreter.begin_contour(cycle);
        let done = self.contour_sub(cycle, &mut reader, interpreter, effects.diagnostics);
        interpreter.end_contour(&reader);
        done?;
        self.now = here;
        if effects.diagnostics.errors != errors {
            return Ok(());
        }
        let text = self.text().to_vec();
        let held = HeldBlock {
            line: here.line as u64 + 1,
            text: &text,
            block,
        };
        interpreter.run_lathe_cycle(cycle, reader, held, effects);
        Ok(())
    }

    fn contour_sub(
        &mut self,
        cycle: &LatheCycle,
        reader: &mut Reader,
        interpreter: &mut Interpreter<'_>,
        diagnostics: &mut Diagnostics,
    ) -> Result<(), Box<Diagnostic>> {
        let depth = self.calls.len();
        let arguments = Box::new([Some(0.0); LOCALS]);
        self.structure(cycle.contour.clone(), Verb::Call(arguments), interpreter)
            .map_err(|trouble| self.trouble(trouble))?;
        let mut own = Block::default();
        while self.calls.len() > depth {
            let Some(place) = self.advance()? else { break };
            self.read(&mut own);
            let run = self.begin_line();
            interpreter.begin_line(run, self.number(place));
            let line = place.line as u64 + 1;
            let said = diagnostics.list.len();
            let errors = diagnostics.errors;
            let transfer =
                interpreter.contour_line(reader, line, self.text(), &mut own, diagnostics);
            for found in diagnostics.list.iter_mut().skip(said) {
                found.file = self.file().map(str::to_owned);
            }
            if diagnostics.errors != errors {
                return Ok(());
            }
            self.end_line(run, 0)?;
            match transfer {
                Some(transfer @ Transfer::Structure { .. }) => {
                    self.follow(transfer, interpreter)?;
                }
                Some(_) => {
                    let message = "the contour of a turning cycle calls or ends a program";
                    let help = "write only O words and moves into its subroutine";
                    let trouble = FlowError::new("lathe-cycle", message, help);
                    return Err(self.trouble(trouble));
                }
                None => {}
            }
        }
        Ok(())
    }
}
