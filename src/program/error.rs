//! What keeps a call from its result.

use std::fmt;
use std::io;

use crate::diagnostic::{Diagnostic, Severity};
use crate::pipeline::{Failure, LimitSummary};

/// What keeps a call from its result; its text says all that is known, line by line.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The machine file, or its controller profile, is wrong.
    Machine(Vec<Diagnostic>),
    /// The program is refused: it cannot be read with certainty.
    Refused {
        /// What was found, in program order; warnings and notes are among it.
        diagnostics: Vec<Diagnostic>,
        /// Errors beyond those listed.
        more: u64,
    },
    /// No program that fits can be written with what is allowed.
    DoesNotFit(Box<LimitSummary>),
    /// What is asked for cannot be done with this machine.
    Unsuitable(String),
    /// The program cannot be read.
    Input(io::Error),
    /// The result cannot be written.
    Output(io::Error),
}

impl Error {
    /// The findings with their lines; none where it is not about lines.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Machine(diagnostics) | Self::Refused { diagnostics, .. } => diagnostics,
            Self::DoesNotFit(summary) => &summary.reasons,
            Self::Unsuitable(_) | Self::Input(_) | Self::Output(_) => &[],
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let more = match self {
            Self::Unsuitable(message) => return f.write_str(message),
            Self::Input(_) => return f.write_str("cannot read the program"),
            Self::Output(_) => return f.write_str("cannot write the result"),
            Self::Machine(_) => {
                f.write_str("the machine file is wrong")?;
                0
            }
            Self::Refused { more, .. } => {
                f.write_str("the program is refused")?;
                *more
            }
            Self::DoesNotFit(_) => {
                f.write_str("the program cannot be made to fit")?;
                0
            }
        };
        let errors = self.diagnostics().iter();
        for error in errors.filter(|it| it.severity == Severity::Error) {
            f.write_str("\n")?;
            if let Some(file) = &error.file {
                write!(f, "{file}: ")?;
            }
            if error.line > 0 {
                write!(f, "line {}: ", error.line)?;
            }
            f.write_str(&error.message)?;
            if let Some(help) = error.help.as_ref().filter(|help| !help.is_empty()) {
                write!(f, ": {help}")?;
            }
        }
        if more > 0 {
            write!(f, "\nand {more} more errors")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Input(error) | Self::Output(error) => Some(error),
            _ => None,
        }
    }
}

impl From<Vec<Diagnostic>> for Error {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self::Machine(diagnostics)
    }
}

impl From<Failure> for Error {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Refused { diagnostics, more } => Self::Refused { diagnostics, more },
            Failure::Input(error) => Self::Input(error),
            Failure::Output(error) => Self::Output(error),
            Failure::Unsuitable(message) => Self::Unsuitable(message),
        }
    }
}
