//! Reads the blocks of a contour for a turning cycle.

use super::place::Place;
use super::text::Search;
use super::{Flow, FlowError};
use crate::control::{Effects, HeldBlock};
use crate::execute::Interpreter;
use crate::facts::Facts;
use crate::turning::{Contour, ContourCycle};
use gwatt_syntax::diagnostic::Diagnostic;
use gwatt_syntax::{Block, scan_line};

/// Lines that a contour may have.
const LINES_MAX: usize = 10_000;

impl Flow {
    /// Executes the contour from P to Q for a cycle of the line that is being
    /// executed, and adds the cycle's moves to `effects`.
    pub(crate) fn turn(
        &mut self,
        contour: &mut Contour,
        interpreter: &mut Interpreter<'_>,
        block: &Block,
        effects: &mut Effects<'_>,
    ) -> Result<(), Box<Diagnostic>> {
        self.contour(contour, interpreter, block, effects)
            .map_err(|trouble| self.trouble(trouble))
    }

    fn contour(
        &mut self,
        contour: &mut Contour,
        interpreter: &mut Interpreter<'_>,
        block: &Block,
        effects: &mut Effects<'_>,
    ) -> Result<(), FlowError> {
        let finishes = contour.cycle == ContourCycle::Finish;
        let numbers = [contour.first, contour.last];
        let text = self.next.text;
        let is_it = |it: &([u64; 2], Place)| finishes && it.0 == numbers && it.1.text == text;
        let roughed = self.roughed.filter(is_it);
        let first = match roughed {
            Some((_, place)) => place,
            None => self.find_block(contour.first, self.next)?,
        };
        if !finishes {
            self.roughed = Some((numbers, first));
        } else if roughed.is_none() {
            self.refuse_second_contour(contour.first, first)?;
        }
        let before = interpreter.before_contour(contour);
        let errors = effects.diagnostics.errors;
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
            let into = Effects::new(&mut found, &mut facts, effects.diagnostics);
            interpreter.execute(number, text, &mut own, into);
            if effects.diagnostics.errors != errors {
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
        let held = HeldBlock {
            line: self.now.line as u64 + 1,
            text: &text,
            block,
        };
        interpreter.turn(contour, before, found, held, effects);
        Ok(())
    }

    /// A finishing cycle takes the contour of the roughing cycle before it. Without one, and where
    /// two blocks have the number of the first block, it is not known which of them a control takes.
    fn refuse_second_contour(&mut self, number: u64, found: Place) -> Result<(), FlowError> {
        let Some(text) = self.texts.get_mut(found.text) else {
            return Ok(());
        };
        let mut find = |search| text.find(&search, found.line);
        let before = find(Search::FirstBlock(number)).filter(|line| *line != found.line);
        let Some(other) = before.or_else(|| find(Search::NextBlock(number))) else {
            return Ok(());
        };
        let (low, high) = (found.line.min(other) + 1, found.line.max(other) + 1);
        let message = format!(
            "N{number} stands in line {low} and in line {high}: which contour G70 takes is not known"
        );
        let help = "give the blocks of each contour numbers of their own";
        Err(FlowError::new("contour", message, help))
    }
}
