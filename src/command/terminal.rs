//! Standard error, for people. What cannot be written there is lost: there is
//! no other place to say so.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};

use clap::ColorChoice;
use gwatt::diagnostic::Diagnostic;
use gwatt::pipeline::Failure;
use gwatt::report::chain;

/// Where messages go.
#[derive(Debug, Clone, Copy)]
pub struct Terminal {
    colour: bool,
}

/// An error that has been told already.
#[derive(Debug, thiserror::Error)]
#[error("refused")]
pub struct Shown;

impl Terminal {
    /// Colours when asked for, or when someone looks and does not mind.
    pub fn new(choice: ColorChoice) -> Self {
        let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        let colour = match choice {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => io::stderr().is_terminal() && !set("NO_COLOR") && !dumb,
        };
        Self { colour }
    }

    /// A remark.
    pub fn note(self, message: impl Display) {
        self.line(format_args!("gwatt: note: {message}"));
    }

    /// What went wrong.
    pub fn error(self, message: impl Display) {
        self.line(format_args!("gwatt: {message}"));
    }

    /// Text that has its line end.
    #[allow(clippy::unused_self, reason = "the terminal is what writes")]
    pub fn text(self, text: &str) {
        let _ = io::stderr().write_all(text.as_bytes());
    }

    /// Findings in `file`, with the lines under them.
    pub fn diagnostics(self, file: &str, diagnostics: &[Diagnostic]) {
        for diagnostic in diagnostics {
            self.line(diagnostic.render(file, self.colour));
        }
    }

    /// Why a program came to no result.
    pub fn failure(self, program: &str, failure: &Failure) {
        let Failure::Refused { diagnostics, more } = failure else {
            return self.error(format_args!("{program}: {}", chain(failure)));
        };
        self.diagnostics(program, diagnostics);
        if *more > 0 {
            self.error(format_args!("{program}: and {more} more errors"));
        }
    }

    fn line(self, text: impl Display) {
        // In one piece, so that lines of several programs do not mix.
        self.text(&format!("{text}\n"));
    }
}
