//! Reads the blocks of a contour for a turning cycle.

use super::{Flow, FlowError};
use crate::execute::Interpreter;
use crate::facts::Facts;
use crate::report::Diagnostics;
use crate::turning::{Contour, ContourCycle};
use gwatt_motion::Step;
use gwatt_syntax::diagnostic::Diagnostic;
use gwatt_syntax::{Block, scan_line};

/// Lines that a contour may have.
const LINES_MAX: usize = 10_000;

impl Flow {
    /// Executes the contour from P to Q for a cycle of the line that is being
    /// executed, and adds the cycle's moves to `steps`.
    pub(crate) fn turn(
        &mut self,
        contour: &mut Contour,
        interpreter: &mut Interpreter<'_>,
        block: &Block,
        steps: &mut Vec<Step>,
        diagnostics: &mut Diagnostics,
    ) -> Result<(), Box<Diagnostic>> {
        self.contour(contour, interpreter, block, steps, diagnostics)
            .map_err(|trouble| self.trouble(trouble))
    }

    fn contour(
        &mut self,
        contour: &mut Contour,
        interpreter: &mut Interpreter<'_>,
        block: &Block,
        steps: &mut Vec<Step>,
        diagnostics: &mut Diagnostics,
    ) -> Result<(), FlowError> {
        let first = self.find_block(contour.first, self.next)?;
        let before = interpreter.before_contour(contour);
        let errors = diagnostics.errors;
        let mut found = Vec::new();
        let (mut own, mut facts) = (Block::default(), Facts::default());
        let mut place = first;
        loop {
            let text = self
                .texts
                .get(place.text)
                .filter(|text| place.line < text.len() && place.line < first.line + LINES_MAX)
                .map(|text| text.line(place.line));
            let Some(text) = text else {
                let message = format!(
                    "there is no block N{} after N{} to end the contour",
                    contour.last, contour.first
                );
                let help = "give the contour's first and last block as P and Q";
                return Err(FlowError::new("contour", message, help));
            };
            scan_line(text, false, &mut own);
            let number = place.line as u64 + 1;
            interpreter.execute(number, text, &mut own, &mut found, &mut facts, diagnostics);
            if diagnostics.errors != errors {
                return Ok(());
            }
            if place == first {
                let names =
                    |letters: &[u8]| own.words.iter().any(|it| letters.contains(&it.letter));
                contour.two_axes = names(b"XU") && names(b"ZW");
            }
            if interpreter.transfer().is_some() || interpreter.ended() {
                let message = format!("line {number} leaves the contour of a turning cycle");
                let help = "write no calls, jumps, cycles or ends between the blocks of P and Q";
                return Err(FlowError::new("contour", message, help));
            }
            place.line += 1;
            if own
                .number
                .is_some_and(|word| word.value == contour.last as f64)
            {
                break;
            }
        }
        contour.lines = Some([first.line as u64 + 1, place.line as u64]);
        if contour.cycle != ContourCycle::Finish {
            self.next = place;
        }
        let text = self.text().to_vec();
        let line = self.now.line as u64 + 1;
        interpreter.turn(
            contour,
            before,
            found,
            line,
            &text,
            block,
            steps,
            diagnostics,
        );
        Ok(())
    }
}
