//! Words as other controllers have them, and which mode E is in.

use super::line::{Parameters, value};
use super::position::Mover;
use crate::control::{Control, Run};
use crate::report::Report;
use gwatt_machine::ExtruderMode;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Word};

impl Control<'_> {
    /// A word as other controllers have it.
    pub(super) fn ordinary(
        &mut self,
        run: &mut Run<'_, '_>,
        (letter, number, span): (u8, u16, Span),
        parameters: &Parameters,
    ) {
        let printer = &self.machine.controller.language.printer;
        let moves = letter == b'G' && number <= 30;
        let to_endstop = moves
            && printer
                .endstop_letters
                .iter()
                .any(|letter| value(parameters, *letter).is_some_and(|value| value != 0.0));
        if letter == b'G' && number == 920 && !(parameters.is_empty() && self.names_parameters()) {
            // `G92 E` without a number sets nothing, nor does `G92` alone but on Klipper.
            let valued = parameters.iter().any(|parameter| parameter.value.is_some());
            if !valued {
                return;
            }
        }
        let head = Word {
            letter,
            value: f64::from(number) / 10.0,
            span,
            number: span,
        };
        let mut words = vec![head];
        for parameter in parameters {
            let endstop = printer.endstop_letters.contains(&parameter.letter);
            let passed = moves && endstop || to_endstop && parameter.letter != b'F';
            let Some(value) = parameter.value.filter(|_| !passed) else {
                continue;
            };
            words.push(Word {
                letter: parameter.letter,
                value,
                span: parameter.span,
                number: parameter.number,
            });
        }
        if moves {
            flags_of_a_move(run, parameters);
        }
        let block = Block {
            words,
            number: run.block.number,
            delete_level: run.block.delete_level,
            tape: false,
            words_end: run.block.words_end,
            text_end: run.block.text_end,
            issues: Vec::new(),
        };
        self.words(run, &block);
        if to_endstop {
            self.unknown_moves(run, span, Mover::Firmware);
        }
    }

    /// Executes the words of a block in the order of other controllers.
    pub(super) fn words(&mut self, run: &mut Run<'_, '_>, block: &Block) {
        let errors = run.report.diagnostics.errors;
        let mut inner = Run {
            line: run.line,
            block,
            words: &mut *run.words,
            facts: &mut *run.facts,
            steps: &mut *run.steps,
            report: Report {
                diagnostics: &mut *run.report.diagnostics,
                line: run.line,
                text: run.report.text,
            },
        };
        let controller = &self.machine.controller;
        inner.words.fill(block, controller, &mut inner.report);
        if inner.report.diagnostics.errors == errors {
            self.general(&mut inner, errors);
        }
    }

    /// M82 and M83 (`Some`), or a change of G90 and G91.
    pub(crate) fn extruder_mode(&mut self, set: Option<bool>) {
        if let Some(absolute) = set {
            self.printer.extruder_absolute = absolute;
        }
        let own = self.printer.extruder_absolute;
        self.modal.extruder_absolute = match self.machine.controller.language.printer.extruder_mode
        {
            ExtruderMode::Follows => set.unwrap_or(self.modal.absolute),
            ExtruderMode::Own => own,
            ExtruderMode::Either => own && self.modal.absolute,
        };
    }
}

/// An axis without a number in a move: firmwares differ in what it means.
fn flags_of_a_move(run: &mut Run<'_, '_>, parameters: &Parameters) {
    for parameter in parameters.iter().filter(|one| one.value.is_none()) {
        let letter = parameter.letter as char;
        let message = format!("`{letter}` has no number after it");
        run.report
            .error("missing-number", message, parameter.span)
            .help("write the number right after the letter, as in `X12.5`");
    }
}
