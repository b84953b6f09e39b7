//! The order of execution: calls, branches and loops over programs that are
//! held whole.

mod conclude;
mod contour;
mod error;
mod go;
mod landmarks;
mod lathe_cycle;
pub(crate) mod library;
pub(crate) mod limits;
mod macro_b;
mod macro_file;
mod o_word;
mod place;
mod section;
mod siemens;
mod text;

use std::collections::HashMap;

use self::error::FlowError;
use self::library::Library;
pub use self::limits::Limits;
pub use self::place::Place;
use self::section::Section;
use self::text::{Search, Text};
use super::execute::Interpreter;
use super::jump::{Call, Target, Transfer};
use super::label::Label;
use super::parameters::{LOCALS, Scope};
use super::reading::Reading;
use super::statement::keyword::Keyword;
use gwatt_syntax::Block;
use gwatt_syntax::diagnostic::Diagnostic;
use gwatt_syntax::source::{Span, split_line_end};

/// Runs through a program in the order of its execution.
#[derive(Debug)]
pub struct Flow {
    texts: Vec<Text>,
    library: Library,
    limits: Limits,
    /// The line to execute next.
    next: Place,
    /// The line that is being executed.
    now: Place,
    calls: Vec<Frame>,
    loops: Vec<Loop>,
    /// Subroutines that were passed or called: LinuxCNC looks for others in files
    /// first, and only then further down.
    subs: HashMap<Label, Place>,
    /// Labels of branches and loops, by where their subroutine begins.
    labels: HashMap<(Option<Place>, Label), (Keyword, usize)>,
    /// A `break` has left a `while` loop: LinuxCNC 2.9 remembers it until the next
    /// `while` that ends a `do` loop, and leaves that.
    broke: bool,
    /// An ELSEIF that decides by its own condition: none before was taken.
    undecided: Option<Label>,
    /// The macro that each block which moves calls (G66).
    modal: Option<Call>,
    /// The numbers of the blocks of the contour that a turning cycle roughed last, and where it
    /// begins.
    roughed: Option<([u64; 2], Place)>,
    /// The same by its name, and calls that are open where it was set (MODIN).
    modal_named: Option<(String, usize)>,
    repeated_moves: u64,
    idle_lines: u64,
    /// The program has begun again (M99 in the main program).
    again: bool,
    /// It is a program of SINUMERIK.
    is_siemens: bool,
    /// It is one of the ISG kernel, whose `%` lines are executed.
    percent_names_programs: bool,
    /// Sections that are repeated.
    sections: Vec<Section>,
    /// Texts that were loaded by the names of their subprograms.
    named: Vec<(String, usize)>,
}

/// A call that has not returned.
#[derive(Debug)]
struct Frame {
    /// The line to go on at, and where the subprogram begins.
    back: Place,
    begin: Place,
    /// Runs that are still to come.
    again: u64,
    arguments: Option<Box<[Option<f64>; LOCALS]>>,
    style: Style,
    scope: Scope,
    /// Loops of its callers.
    loops: usize,
}

/// How a subprogram was called, and so how it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Style {
    /// `o… call`, to `endsub` or `return`.
    Sub,
    /// M98, M97, G65, to M99.
    Program,
    /// A macro of a printer, to the end of its file.
    Macro,
}

/// A loop that runs.
#[derive(Debug)]
struct Loop {
    label: Label,
    kind: LoopKind,
    line: usize,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum LoopKind {
    While,
    Do,
    Repeat { left: u64 },
}

impl Flow {
    /// Takes over a program whose first lines have been executed; line `line`
    /// from 0 is the one that did not go on at the next.
    #[must_use]
    pub fn new(program: Vec<u8>, line: usize, reading: &Reading) -> Self {
        let mut main = Text::new(program);
        for run in main.runs.iter_mut().take(line + 1) {
            *run = 1;
        }
        let now = Place { text: 0, line };
        Self {
            texts: vec![main],
            library: Library::new(reading),
            limits: reading.limits,
            next: Place {
                text: 0,
                line: line + 1,
            },
            now,
            calls: Vec::new(),
            loops: Vec::new(),
            subs: HashMap::new(),
            labels: HashMap::new(),
            broke: false,
            undecided: None,
            modal: None,
            roughed: None,
            modal_named: None,
            repeated_moves: 0,
            idle_lines: 0,
            again: false,
            is_siemens: false,
            percent_names_programs: false,
            sections: Vec::new(),
            named: Vec::new(),
        }
    }

    /// Goes to the next line; `None` at the end of the program.
    ///
    /// # Errors
    ///
    /// A subprogram that does not return as it was called.
    pub fn advance(&mut self) -> Result<Option<Place>, Box<Diagnostic>> {
        self.end_section();
        loop {
            let Some(text) = self.texts.get_mut(self.next.text) else {
                return Ok(None);
            };
            if self.next.line >= text.len() {
                if self.calls.is_empty() {
                    return Ok(None);
                }
                self.end_of_text()?;
                continue;
            }
            let tape = text
                .line(self.next.line)
                .trim_ascii_start()
                .starts_with(b"%");
            if tape && self.is_siemens && !self.calls.is_empty() && self.next.line > 0 {
                // The header of the next program.
                return Err(self.without_return());
            }
            if tape && self.next.text > 0 && !self.percent_names_programs {
                self.next.line += 1;
                continue;
            }
            self.now = self.next;
            self.next.line += 1;
            return Ok(Some(self.now));
        }
    }

    /// Where the line that is being executed stands.
    #[must_use]
    pub fn now(&self) -> Place {
        self.now
    }

    /// How many calls and repeated sections are open.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.calls.len() + self.sections.len()
    }

    /// Names of the files of subprograms, by number from 1 on.
    #[must_use]
    pub fn files(&self) -> &[String] {
        self.library.names()
    }

    /// Lines of the program itself.
    #[must_use]
    pub fn lines(&self) -> u64 {
        self.texts.first().map_or(0, |text| text.len() as u64)
    }

    /// The line that is being executed.
    #[must_use]
    pub fn text(&self) -> &[u8] {
        self.texts
            .get(self.now.text)
            .map_or(&[], |text| text.line(self.now.line))
    }

    /// Reads the line that is being executed into its block.
    pub fn read(&mut self, block: &mut Block) {
        if let Some(text) = self.texts.get_mut(self.now.text) {
            text.read(self.now.line, block);
        }
    }

    /// The name of its file, unless it is the program itself.
    #[must_use]
    pub fn file(&self) -> Option<&str> {
        let index = self.now.text.checked_sub(1)?;
        self.library.loaded().get(index).map(String::as_str)
    }

    /// Counts a run of the line; gives its number from 1.
    pub fn begin_line(&mut self) -> u32 {
        let runs = self
            .texts
            .get_mut(self.now.text)
            .and_then(|text| text.runs.get_mut(self.now.line));
        runs.map_or(1, |runs| {
            *runs = runs.saturating_add(1);
            *runs
        })
    }

    /// Goes on where the last block says.
    pub(crate) fn follow(
        &mut self,
        transfer: Transfer,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), Box<Diagnostic>> {
        let done = match transfer {
            Transfer::Structure { label, verb } => self.structure(label, verb, interpreter),
            Transfer::Call(call) => self.call(call, interpreter),
            Transfer::ModalCall(Some(_)) if self.modal.is_some() => Err(FlowError::new(
                "subprogram",
                "a second G66 while one is in force: its macro would call the first one's",
                "write G67 before it, or the calls out",
            )),
            Transfer::ModalCall(call) => {
                self.modal = call;
                Ok(())
            }
            Transfer::Return { block } => self.end_of_subprogram(block, interpreter),
            Transfer::Goto(block) => self.go_to(block),
            Transfer::Loop { number, holds } => self.begin_loop(number, holds),
            Transfer::EndLoop(number) => self.end_loop(number),
            Transfer::Siemens(word) => self.siemens(word, interpreter),
            Transfer::Go(word) => self.go(word, interpreter),
            Transfer::Macro(name) => self.call_macro(&name, interpreter),
            // Its moves belong to its line: see `turn`.
            Transfer::Contour(_) | Transfer::LatheCycle(_) => Ok(()),
        };
        done.map_err(|trouble| self.trouble(trouble))
    }

    fn trouble(&self, trouble: FlowError) -> Box<Diagnostic> {
        let text = self.text();
        let span = Span::new(0, split_line_end(text).0.len());
        let mut diagnostic = Diagnostic::error(trouble.rule, trouble.message)
            .at(self.now.line as u64 + 1, span, text)
            .help(trouble.help);
        diagnostic.file = self.file().map(str::to_owned);
        Box::new(diagnostic)
    }

    fn call(&mut self, call: Call, interpreter: &mut Interpreter<'_>) -> Result<(), FlowError> {
        if call.times == 0 {
            return Ok(());
        }
        let mut times = call.times;
        let begin = match &call.target {
            Target::Program(label) => self.find_program(label)?,
            Target::Short(number) => {
                let whole = u32::try_from(*number).ok().map(Label::Number);
                let here = whole.and_then(|label| self.find_loaded(&label));
                if let Some(place) = here {
                    place
                } else {
                    times = number / 10_000;
                    self.find_program(&Label::Number((number % 10_000) as u32))?
                }
            }
            Target::Block(block) => self.find_block(*block, self.next)?,
            Target::Here => self.now,
        };
        let begin = match call.block {
            Some(block) => self.find_only_block(block, begin)?,
            None => begin,
        };
        if interpreter.rs274() && self.is_sub(begin) {
            let message = "M98 calls a subroutine that begins with `sub`";
            return Err(FlowError::new(
                "subprogram",
                message,
                "call it with `o… call`",
            ));
        }
        self.enter(begin, times, call.arguments, Style::Program, interpreter)
    }

    /// Begins a subprogram.
    fn enter(
        &mut self,
        begin: Place,
        times: u64,
        arguments: Option<Box<[Option<f64>; LOCALS]>>,
        style: Style,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        if self.calls.len() >= self.limits.depth {
            let message = format!("more than {} calls inside one another", self.limits.depth);
            let help = "look for a subprogram that calls itself; --max-depth sets this limit";
            return Err(FlowError::new("call-depth", message, help));
        }
        // LinuxCNC ("M98 and M99"): the program has its own names, and the
        // numbers of its caller.
        let scope = match &arguments {
            Some(_) => Scope::Own,
            None if interpreter.rs274() => Scope::OwnNames,
            None => Scope::Shared,
        };
        interpreter.enter(scope, arguments.as_deref());
        self.calls.push(Frame {
            back: self.next,
            begin,
            again: times - 1,
            arguments,
            style,
            scope,
            loops: self.loops.len(),
        });
        self.begin(begin, interpreter);
        Ok(())
    }

    fn begin(&mut self, begin: Place, interpreter: &mut Interpreter<'_>) {
        self.next = begin;
        let program = self
            .texts
            .get_mut(begin.text)
            .is_some_and(|text| text.is_program(begin.line));
        if program {
            interpreter.expect_program_number();
        }
    }

    /// Ends the subprogram that runs, or begins it again.
    fn leave(&mut self, interpreter: &mut Interpreter<'_>) -> Option<Place> {
        let mut frame = self.calls.pop()?;
        self.loops.truncate(frame.loops);
        interpreter.leave(frame.scope);
        let back = frame.back;
        if frame.again > 0 {
            frame.again -= 1;
            interpreter.enter(frame.scope, frame.arguments.as_deref());
            self.begin(frame.begin, interpreter);
            self.calls.push(frame);
        } else {
            self.next = back;
        }
        Some(back)
    }

    /// Where a program or subroutine begins, in the texts that are there or in
    /// a file of its own.
    fn find_program(&mut self, label: &Label) -> Result<Place, FlowError> {
        if let Some(place) = self.find_loaded(label) {
            return Ok(place);
        }
        let Some(text) = self.load(label)? else {
            return Err(Library::nothing(label));
        };
        // A file may hold its program without an O word.
        let begins = self.texts.get_mut(text).and_then(|it| it.begin(label));
        let line = begins.unwrap_or(0);
        Ok(Place { text, line })
    }

    /// Reads the file of a subprogram, if there is one; gives its text.
    fn load(&mut self, label: &Label) -> Result<Option<usize>, FlowError> {
        let Some(bytes) = self.library.load(label)? else {
            return Ok(None);
        };
        self.texts.push(Text::new(bytes));
        Ok(Some(self.texts.len() - 1))
    }

    /// Whether a subroutine begins there with `sub`.
    fn is_sub(&self, place: Place) -> bool {
        let text = self.texts.get(place.text);
        let keyword = text.and_then(|text| text.keyword(place.line));
        keyword == Some(Keyword::Sub)
    }

    /// The same in the texts that are there.
    fn find_loaded(&mut self, label: &Label) -> Option<Place> {
        // In this text first, then in the program, then in the others.
        let here = self.now.text;
        let count = self.texts.len();
        let mut order = std::iter::once(here).chain((0..count).filter(|text| *text != here));
        order.find_map(|text| {
            let line = self.texts.get_mut(text)?.begin(label)?;
            Some(Place { text, line })
        })
    }

    /// A block of the program that `from` belongs to, looked for from there on.
    fn find_block(&mut self, block: u64, from: Place) -> Result<Place, FlowError> {
        self.texts
            .get_mut(from.text)
            .and_then(|text| text.find(&Search::Block(block), from.line))
            .map(|line| Place { line, ..from })
            .ok_or_else(|| {
                let message = format!("there is no block N{block} in this program");
                FlowError::new(
                    "no-such-block",
                    message,
                    "write the number of a block that exists",
                )
            })
    }
}
