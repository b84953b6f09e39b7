//! Standard error, for people. What cannot be written there is lost: there is
//! no other place to say so.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write as _};

use clap::ColorChoice;
use gwatt::diagnostic::Diagnostic;
use gwatt::pipeline::Failure;
use gwatt::report::{Style, chain};
use terminal_size::{Height, Width, terminal_size_of};

use super::progress::{Shape, around};
use crate::cli::ProgressArg;

/// Where messages go.
#[derive(Debug, Clone, Copy)]
pub struct Terminal {
    colour: bool,
    /// The same for standard output.
    out_colour: bool,
    progress: Shape,
}

/// An error that has been reported already.
#[derive(Debug, thiserror::Error)]
#[error("refused")]
pub struct Shown;

impl Terminal {
    /// Colours when asked for, or when someone looks and does not mind.
    pub fn new(choice: ColorChoice, progress: ProgressArg) -> Self {
        let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        let colour = |is_terminal: bool| match choice {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => is_terminal && !set("NO_COLOR") && !dumb,
        };
        Self {
            colour: colour(io::stderr().is_terminal()),
            out_colour: colour(io::stdout().is_terminal()),
            progress: Shape::of(progress),
        }
    }

    /// How the progress of long work is shown, in a run that may be quiet.
    pub fn progress(self, quiet: bool) -> Shape {
        self.progress.quiet(quiet)
    }

    /// How text is set on standard output.
    pub fn out_style(self) -> Style {
        Style {
            colour: self.out_colour,
            columns: columns(terminal_size_of(io::stdout())),
        }
    }

    /// How text is set on standard error.
    pub fn style(self) -> Style {
        Style {
            colour: self.colour,
            columns: columns(terminal_size_of(io::stderr())),
        }
    }

    /// Messages that are not shown yet, in its colours.
    pub fn messages(self) -> Messages {
        Messages {
            style: self.style(),
            out_style: self.out_style(),
            shown: None,
            text: String::new(),
        }
    }

    /// Messages that are shown at once.
    pub fn direct(self) -> Messages {
        Messages {
            shown: Some(self),
            ..self.messages()
        }
    }

    /// Shows messages.
    pub fn show(self, messages: &Messages) {
        // In one piece, so that lines of several programs do not mix.
        self.text(&messages.text);
    }

    /// A remark.
    pub fn note(self, message: impl Display) {
        self.say(|messages| messages.note(message));
    }

    /// What went wrong.
    pub fn error(self, message: impl Display) {
        self.say(|messages| messages.error(message));
    }

    /// Text that has its line end.
    #[allow(clippy::unused_self, reason = "the terminal is what writes")]
    pub fn text(self, text: &str) {
        let _ = around(|| io::stderr().write_all(text.as_bytes()));
    }

    /// Findings in `file`, with the lines under them.
    pub fn diagnostics(self, file: &str, diagnostics: &[Diagnostic]) {
        self.say(|messages| messages.diagnostics(file, diagnostics));
    }

    /// Why a program came to no result.
    pub fn failure(self, program: &str, failure: &Failure) {
        self.say(|messages| messages.failure(program, failure));
    }

    /// Says what `say` says.
    pub fn say(self, say: impl FnOnce(&mut Messages)) {
        let mut messages = self.messages();
        say(&mut messages);
        self.show(&messages);
    }
}

/// Messages that are kept until it is their turn, unless they are shown at once.
#[derive(Debug)]
pub struct Messages {
    style: Style,
    /// That of standard output.
    out_style: Style,
    /// Where they are shown.
    shown: Option<Terminal>,
    text: String,
}

impl Messages {
    /// Messages without colours that are not shown.
    pub fn plain() -> Self {
        Self {
            style: Style::PLAIN,
            out_style: Style::PLAIN,
            shown: None,
            text: String::new(),
        }
    }

    /// How its text is set.
    pub fn style(&self) -> Style {
        self.style
    }

    /// How text is set on standard output.
    pub fn out_style(&self) -> Style {
        self.out_style
    }

    /// What was said so far, unless it was shown at once.
    pub fn said(&self) -> &str {
        &self.text
    }

    /// A remark.
    pub fn note(&mut self, message: impl Display) {
        self.line(format_args!("gwatt: note: {message}"));
    }

    /// What went wrong.
    pub fn error(&mut self, message: impl Display) {
        self.line(format_args!("gwatt: {message}"));
    }

    /// Text that has its line end.
    pub fn text(&mut self, text: &str) {
        match self.shown {
            Some(terminal) => terminal.text(text),
            None => self.text.push_str(text),
        }
    }

    /// Findings in `file`, with the lines under them. What is found again and again is shown
    /// a few times, and then the lines are named.
    pub fn diagnostics(&mut self, file: &str, diagnostics: &[Diagnostic]) {
        let mut kinds: Vec<Alike<'_>> = Vec::new();
        for diagnostic in diagnostics {
            let kind = diagnostic.kind();
            match kinds.iter_mut().find(|it| it.kind == kind) {
                Some(known) => known.found.push(diagnostic),
                None => kinds.push(Alike {
                    kind,
                    found: vec![diagnostic],
                }),
            }
        }
        let shown = |diagnostic: &Diagnostic| {
            let mut first = kinds.iter().flat_map(Alike::shown);
            first.any(|it| std::ptr::eq(*it, diagnostic))
        };
        for diagnostic in diagnostics.iter().filter(|it| shown(it)) {
            let text = diagnostic.render(file, self.style.colour);
            self.line(text);
        }
        for alike in &kinds {
            let count = alike.count() - alike.shown().len() as u64;
            if count > 0 {
                let (lines, kind) = (alike.lines(), &alike.kind);
                self.line(format_args!(
                    "{file}: and {count} more like it in {lines}: {kind}"
                ));
            }
        }
    }

    /// Why a program came to no result.
    pub fn failure(&mut self, program: &str, failure: &Failure) {
        let Failure::Refused { diagnostics, more } = failure else {
            return self.error(format_args!("{program}: {}", chain(failure)));
        };
        self.diagnostics(program, diagnostics);
        let alike: u64 = diagnostics.iter().map(|it| it.alike).sum();
        match more.saturating_sub(alike) {
            0 => {}
            1 => self.error(format_args!("{program}: and 1 more error")),
            more => self.error(format_args!("{program}: and {more} more errors")),
        }
    }

    fn line(&mut self, text: impl Display) {
        self.text(&format!("{text}\n"));
    }
}

/// Findings of one kind that are all shown; of more the first one stands for all.
const SHOWN: usize = 3;

/// Findings of one kind.
struct Alike<'a> {
    kind: String,
    found: Vec<&'a Diagnostic>,
}

impl<'a> Alike<'a> {
    /// How many there are, listed or not.
    fn count(&self) -> u64 {
        let more = self.found.iter().map(|it| it.alike).sum::<u64>();
        self.found.len() as u64 + more
    }

    /// Those that are shown.
    fn shown(&self) -> &[&'a Diagnostic] {
        let shown = if self.count() > SHOWN as u64 {
            1
        } else {
            SHOWN
        };
        self.found.get(..shown).unwrap_or(&self.found)
    }

    /// Where the others are; of those that are not listed the last line is known.
    fn lines(&self) -> String {
        let last = self.found.iter().map(|it| it.alike_to).max().unwrap_or(0);
        let others = self.found.get(self.shown().len()..).unwrap_or_default();
        match (others, last) {
            (others, 0) => lines(others),
            ([], last) => format!("lines up to {last}"),
            (others, last) if others.iter().any(|it| it.line == last) => lines(others),
            (others, last) => format!("{}, and up to {last}", lines(others)),
        }
    }
}

/// Where findings are: `line 3`, or `lines 3-5, 9`.
fn lines(found: &[&Diagnostic]) -> String {
    let mut numbers: Vec<u64> = found.iter().map(|it| it.line).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let mut ranges: Vec<[u64; 2]> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => ranges.push([number; 2]),
        }
    }
    let noun = match ranges.as_slice() {
        [[first, last]] if first == last => "line",
        _ => "lines",
    };
    let ranges = ranges.iter().map(|[first, last]| match last - first {
        0 => first.to_string(),
        1 => format!("{first}, {last}"),
        _ => format!("{first}-{last}"),
    });
    format!("{noun} {}", ranges.collect::<Vec<_>>().join(", "))
}

/// The columns of a terminal, if it is one.
fn columns(size: Option<(Width, Height)>) -> Option<usize> {
    size.map(|(Width(columns), _)| usize::from(columns))
        .filter(|columns| *columns > 0)
}
