//! Bytes to steps, line by line: what every run over a program begins with.

use std::io::Read;

use super::{Failure, Options};
use crate::diagnostic::{Diagnostic, Severity};
use crate::interpret::{Diagnostics, Facts, Interpreter, Step};
use crate::machine::Machine;
use crate::source::{LineReader, SourceError};
use crate::syntax::{Block, scan_line};

/// A line that has just been executed.
pub(super) struct Line<'f, 'm> {
    pub(super) number: u64,
    /// Its bytes, line end included.
    pub(super) text: &'f [u8],
    /// Buffers: they may be exchanged for others.
    pub(super) block: &'f mut Block,
    pub(super) steps: &'f mut Vec<Step>,
    pub(super) facts: Facts,
    /// The state behind it.
    pub(super) interpreter: &'f Interpreter<'m>,
}

impl Line<'_, '_> {
    /// The text of the line that a move belongs to: this one, or an earlier one
    /// whose moves were held back.
    pub(super) fn text_of(&self, line: u64) -> &[u8] {
        if line == self.number {
            return self.text;
        }
        self.interpreter.held_text(line).unwrap_or(self.text)
    }
}

/// A stream of executed lines.
pub(super) struct Front<'m, R> {
    reader: LineReader<R>,
    block: Block,
    interpreter: Interpreter<'m>,
    pub(super) diagnostics: Diagnostics,
    steps: Vec<Step>,
    /// Number of lines read.
    pub(super) lines: u64,
    /// How many of them did something.
    executed: u64,
}

impl<'m, R: Read> Front<'m, R> {
    pub(super) fn new(input: R, machine: &'m Machine, options: &Options) -> Self {
        Self {
            reader: LineReader::new(input),
            block: Block::default(),
            interpreter: Interpreter::new(machine, &options.reading),
            diagnostics: Diagnostics::default(),
            steps: Vec::new(),
            lines: 0,
            executed: 0,
        }
    }

    /// The state behind the last line.
    pub(super) fn interpreter(&self) -> &Interpreter<'m> {
        &self.interpreter
    }

    /// Reads and executes the next line.
    #[allow(
        clippy::inline_always,
        reason = "a line that goes through memory costs a twentieth of an analysis"
    )]
    #[inline(always)]
    pub(super) fn next_line(&mut self) -> Result<Option<Line<'_, 'm>>, Failure> {
        let Some((number, text)) = self.reader.next_line().map_err(source_failure)? else {
            return Ok(None);
        };
        self.lines = number;
        scan_line(text, number == 1, &mut self.block);
        self.steps.clear();
        let facts = self.interpreter.execute(
            number,
            text,
            &self.block,
            &mut self.steps,
            &mut self.diagnostics,
        );
        self.executed += u64::from(facts.executed);
        let Self {
            block,
            steps,
            interpreter,
            ..
        } = self;
        Ok(Some(Line {
            number,
            text,
            block,
            steps,
            facts,
            interpreter,
        }))
    }

    /// The warnings and notes of a run without errors.
    pub(super) fn finish(mut self) -> Result<Vec<Diagnostic>, Failure> {
        if self.executed == 0 && self.diagnostics.errors == 0 {
            let message = "there is no program in this file: no block does anything";
            self.diagnostics
                .push(Diagnostic::error("no-program", message).help("give a part program"));
        }
        if self.interpreter.holds() && self.diagnostics.errors == 0 {
            let message =
                "the program ends under cutter compensation: where its last move ends is not known";
            self.diagnostics.push(
                Diagnostic::error("compensation", message)
                    .help("write G40 and a move, or the end of the program: M2 or M30"),
            );
        }
        refuse_on_errors(self.diagnostics)
    }
}

/// The warnings and notes, or a refusal when there are errors.
fn refuse_on_errors(diagnostics: Diagnostics) -> Result<Vec<Diagnostic>, Failure> {
    let more = diagnostics.more();
    if diagnostics.errors > 0 {
        return Err(Failure::Refused {
            diagnostics: diagnostics.list,
            more,
        });
    }
    debug_assert!(
        diagnostics
            .list
            .iter()
            .all(|diagnostic| diagnostic.severity != Severity::Error)
    );
    Ok(diagnostics.list)
}

fn source_failure(error: SourceError) -> Failure {
    match error {
        SourceError::Io(error) => Failure::Input(error),
        other => Failure::Refused {
            diagnostics: vec![Diagnostic::error("not-a-program", other.to_string())],
            more: 0,
        },
    }
}
