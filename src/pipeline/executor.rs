//! Bytes to steps, line by line: what every run over a program begins with.
//!
//! Lines are read and executed one after another and forgotten. A program whose
//! lines are executed in another order, because of calls, branches or loops, is
//! held whole from the first of these on.

use std::io::{Read, Seek, SeekFrom};
use std::path::PathBuf;

use super::line_count::LineCount;
use super::line_key::LineKey;
use super::{Failure, Options};
use crate::diagnostic::{Diagnostic, Severity};
use crate::interpret::{
    ActionKind, Diagnostics, Effects, Facts, Flow, Interpreter, Move, Reading, Step,
};
use crate::machine::Machine;
use crate::source::{LineReader, SourceError};
use crate::syntax::{Block, FOREIGN_BYTES, foreign, scan_line};

/// Bytes that a program may have which must be held whole.
const WHOLE_BYTES_MAX: u64 = 1 << 30;

/// A line that has just been executed.
pub(super) struct Line<'f, 'm> {
    /// Which text it stands in, and its number there from 1.
    pub(super) key: LineKey,
    /// Its bytes, line end included.
    pub(super) text: &'f [u8],
    /// Buffers: they may be exchanged for others.
    pub(super) block: &'f mut Block,
    pub(super) steps: &'f mut Vec<Step>,
    pub(super) facts: &'f mut Facts,
    /// How many calls and repeated sections were open when it began.
    pub(super) depth: usize,
    /// Names of the files of subprograms so far.
    pub(super) files: &'f [String],
    /// The state after it.
    pub(super) interpreter: &'f Interpreter<'m>,
}

impl Line<'_, '_> {
    /// The text of the line that a move belongs to: this one, or an earlier one
    /// whose moves were held back.
    pub(super) fn text_of(&self, mv: &Move) -> &[u8] {
        if (mv.text, mv.line) == self.key {
            return self.text;
        }
        self.interpreter.held_text(mv).unwrap_or(self.text)
    }
}

/// A stream of executed lines.
pub(super) struct Executor<'m, R> {
    reader: LineReader<R>,
    reading: Reading,
    block: Block,
    interpreter: Interpreter<'m>,
    pub(super) diagnostics: Diagnostics,
    steps: Vec<Step>,
    facts: Facts,
    /// Number of lines read.
    pub(super) lines: u64,
    /// How many of them did something.
    executed: u64,
    /// How many of these did no more than end the program.
    ended: u64,
    /// The program, once it has to be held whole.
    flow: Option<Box<Flow>>,
    /// What is wrong with the flow: nothing more is executed.
    stuck: bool,
    /// Counts the lines, where anyone looks.
    count: Option<LineCount>,
}

impl<'m, R: Read + Seek> Executor<'m, R> {
    pub(super) fn new(input: R, machine: &'m Machine, options: &Options) -> Self {
        if let Some(count) = &options.count {
            // A program of a few lines is seen as well.
            count.add(1);
        }
        Self {
            reader: LineReader::new(input),
            reading: options.reading.clone(),
            block: Block::default(),
            interpreter: Interpreter::new(machine, &options.reading),
            diagnostics: Diagnostics::default(),
            steps: Vec::new(),
            facts: Facts::default(),
            lines: 0,
            executed: 0,
            ended: 0,
            flow: None,
            stuck: false,
            count: options.count.clone(),
        }
    }

    /// The state after the last line.
    pub(super) fn interpreter(&self) -> &Interpreter<'m> {
        &self.interpreter
    }

    /// Where the files of subprograms that were read lie.
    pub(super) fn paths(&self) -> &[PathBuf] {
        self.flow.as_deref().map_or(&[], Flow::paths)
    }

    /// Whether lines are executed in another order than they stand in.
    pub(super) fn flows(&self) -> bool {
        self.flow.is_some()
    }

    /// Reads and executes the next line.
    #[allow(
        clippy::inline_always,
        reason = "a line that goes through memory costs a twentieth of an analysis"
    )]
    #[inline(always)]
    pub(super) fn next_line(&mut self) -> Result<Option<Line<'_, 'm>>, Failure> {
        if self.flow.is_some() {
            return self.next_of_flow();
        }
        let next = match self.reader.next_line() {
            Ok(next) => next,
            Err(error) => {
                let failure = source_failure(error);
                return Err(self.name_foreign(failure));
            }
        };
        let Some((number, text)) = next else {
            return Ok(None);
        };
        self.lines = number;
        scan_line(text, number == 1, &mut self.block);
        self.steps.clear();
        self.interpreter.execute(
            number,
            text,
            &mut self.block,
            Effects::new(&mut self.steps, &mut self.facts, &mut self.diagnostics),
        );
        self.count_executed();
        if number.is_multiple_of(LineCount::AT_ONCE) {
            self.count(LineCount::AT_ONCE);
        }
        if self.facts.transfers {
            return self.begin_flow();
        }
        let Self {
            reader,
            block,
            steps,
            facts,
            interpreter,
            reading,
            ..
        } = self;
        Ok(Some(Line {
            key: (reading.text, number),
            text: reader.last_line(),
            block,
            steps,
            facts,
            depth: 0,
            files: &[],
            interpreter,
        }))
    }

    #[cold]
    fn count(&self, lines: u64) {
        if let Some(count) = &self.count {
            count.add(lines);
        }
    }

    /// Reads the program again, whole, since the line that was just executed
    /// does not go on at the next.
    #[cold]
    fn begin_flow(&mut self) -> Result<Option<Line<'_, 'm>>, Failure> {
        let input = self.reader.get_mut();
        let mut program = Vec::new();
        input
            .seek(SeekFrom::Start(0))
            .and_then(|_| input.take(WHOLE_BYTES_MAX + 1).read_to_end(&mut program))
            .map_err(Failure::Input)?;
        if program.len() as u64 > WHOLE_BYTES_MAX {
            return Err(too_large());
        }
        let line = self.lines as usize - 1;
        let flow = self
            .flow
            .insert(Box::new(Flow::new(program, line, &self.reading)));
        self.lines = flow.lines();
        Ok(self.conclude(1))
    }

    #[cold]
    #[inline(never)]
    #[allow(clippy::unnecessary_wraps, reason = "the same as `next_line`")]
    fn next_of_flow(&mut self) -> Result<Option<Line<'_, 'm>>, Failure> {
        let Some(flow) = &mut self.flow else {
            return Ok(None);
        };
        if self.stuck || self.interpreter.ended_for_good() {
            return Ok(None);
        }
        let place = match flow.advance() {
            Ok(Some(place)) => place,
            Ok(None) => return Ok(None),
            Err(trouble) => {
                self.stuck = true;
                self.diagnostics.push(*trouble);
                return Ok(None);
            }
        };
        if let Some(count) = &self.count {
            count.add(1);
        }
        let run = flow.begin_line();
        flow.read(&mut self.block);
        let text = flow.text();
        let number = place.line as u64 + 1;
        self.steps.clear();
        let number_of_text = flow.number(place);
        self.interpreter.begin_line(run, number_of_text);
        let said = self.diagnostics.list.len();
        self.interpreter.execute(
            number,
            text,
            &mut self.block,
            Effects::new(&mut self.steps, &mut self.facts, &mut self.diagnostics),
        );
        for found in self.diagnostics.list.iter_mut().skip(said) {
            found.file = flow.file().map(str::to_owned);
        }
        self.count_executed();
        Ok(self.conclude(run))
    }

    /// Lets the flow go on after a line, and hands the line over.
    fn conclude(&mut self, run: u32) -> Option<Line<'_, 'm>> {
        let Self {
            block,
            steps,
            facts,
            interpreter,
            diagnostics,
            flow,
            stuck,
            ..
        } = self;
        let flow = flow.as_mut()?;
        let effects = Effects::new(steps, facts, diagnostics);
        let depth = flow.depth();
        *stuck |= !flow.conclude(run, interpreter, block, effects);
        let place = flow.now();
        Some(Line {
            key: (flow.number(place), place.line as u64 + 1),
            text: flow.text(),
            block,
            steps,
            facts,
            depth,
            files: flow.files(),
            interpreter,
        })
    }

    /// Counts the line if it did something.
    #[inline]
    fn count_executed(&mut self) {
        if self.facts.executed {
            self.executed += 1;
            let ends =
                matches!(&self.steps[..], [Step::Action(action)] if action.kind == ActionKind::End);
            self.ended += u64::from(ends);
        }
    }

    /// The warnings and notes of a run without errors.
    pub(super) fn finish(mut self) -> Result<Vec<Diagnostic>, Failure> {
        let uncalled = self.interpreter.is_uncalled();
        let flow = self.flow.as_deref();
        let subs = uncalled || flow.is_some_and(Flow::holds_subprograms);
        let idle = self.executed == 0 || uncalled || subs && self.executed == self.ended;
        if idle && self.diagnostics.errors == 0 {
            self.diagnostics.push(nothing_done(subs));
        }
        if !idle && self.diagnostics.errors == 0 && self.interpreter.assumes_unit() {
            self.diagnostics.push(no_units());
        }
        if self.interpreter.leaves_loads_on() && self.diagnostics.errors == 0 {
            self.diagnostics.push(loads_at_end());
        }
        if self.interpreter.holds() && self.diagnostics.errors == 0 {
            let (rule, message, help) = if self.interpreter.holds_corner() {
                let message = "the program ends before the second move of a corner";
                ("corner-word", message, "write the move after the corner")
            } else {
                let message = "the program ends under cutter compensation: where its last move ends is not known";
                let help = "write G40 and a move, or the end of the program: M2 or M30";
                ("compensation", message, help)
            };
            self.diagnostics
                .push(Diagnostic::error(rule, message).help(help));
        }
        let diagnostics = std::mem::take(&mut self.diagnostics);
        refuse_on_errors(diagnostics).map_err(|failure| self.name_foreign(failure))
    }

    /// A refusal says what the file is where it plainly is no program of words.
    #[cold]
    fn name_foreign(&mut self, failure: Failure) -> Failure {
        if !matches!(failure, Failure::Refused { .. }) {
            return failure;
        }
        let input = self.reader.get_mut();
        let mut beginning = Vec::new();
        let read = input
            .rewind()
            .and_then(|()| input.take(FOREIGN_BYTES as u64).read_to_end(&mut beginning));
        match foreign(&beginning).filter(|_| read.is_ok()) {
            Some(found) => Failure::Refused {
                diagnostics: vec![
                    Diagnostic::error("foreign-file", format!("this is {}", found.what))
                        .help(found.help),
                ],
                more: 0,
            },
            None => failure,
        }
    }
}

/// Nobody has said what a length is.
fn no_units() -> Diagnostic {
    let message = "neither the program (G20, G21) nor the machine file says whether lengths are \
                   millimetres or inches: taken as millimetres, of which the control may make inches";
    Diagnostic::note("no-units", message).help(
        "write G21 or G20 at the beginning, or say units = \"mm\" or \"inch\" under [language] of \
         the machine file",
    )
}

/// What a load draws that is switched on last of all has been judged nowhere.
fn loads_at_end() -> Diagnostic {
    let message = "what is switched on after the last move ([[load]] of the machine file) is not \
                   counted: the program neither moves nor ends (M2, M30) after it";
    Diagnostic::warning("loads-at-end", message)
        .help("let a move follow, or the end of the program where the control knows it (M2, M30)")
}

/// The program as bytes; `None` where it is too large to be held.
pub(super) fn read_whole(mut input: impl Read + Seek) -> Result<Option<Vec<u8>>, Failure> {
    let mut program = Vec::new();
    input
        .rewind()
        .and_then(|()| {
            let limited = input.by_ref().take(WHOLE_BYTES_MAX + 1);
            { limited }.read_to_end(&mut program)
        })
        .map_err(Failure::Input)?;
    Ok((program.len() as u64 <= WHOLE_BYTES_MAX).then_some(program))
}

/// A program that would have to be held whole.
pub(super) fn too_large() -> Failure {
    let message = "a program with calls, loops or several ways of more than 1 GiB";
    let help = "call the large part from a program of its own, or write the calls out";
    Failure::Refused {
        diagnostics: vec![Diagnostic::error("program-size", message).help(help)],
        more: 0,
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

/// The rule of the error on a program that does nothing.
pub(super) const NO_PROGRAM: &str = "no-program";

/// The rule of the note on a file that holds only subprograms.
pub(super) const ONLY_SUBPROGRAMS: &str = "only-subprograms";

/// That no block of a program did anything.
fn nothing_done(holds_subprograms: bool) -> Diagnostic {
    if holds_subprograms {
        let message = "this file holds only subprograms: by itself it moves nothing, and what they \
                       draw is not looked at";
        return Diagnostic::note(ONLY_SUBPROGRAMS, message)
            .help("give the programs that call them");
    }
    let message = "there is no program in this file: no block does anything";
    Diagnostic::error(NO_PROGRAM, message).help("give a part program")
}
