//! A program and what became of it.

use std::error::Error;

use crate::pipeline::{Failure, Summary};

/// The verdict on a program; the worst of several is the largest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// It fits.
    Fits,
    /// It does not, or could not be made to.
    DoesNotFit,
    /// It came to no result.
    Refused,
}

impl Verdict {
    /// Fits, or does not.
    #[must_use]
    pub fn of(fits: bool) -> Self {
        if fits { Self::Fits } else { Self::DoesNotFit }
    }
}

/// A program and what its analysis came to.
#[derive(Debug)]
pub struct Checked {
    /// The program's name as it was given.
    pub program: String,
    /// What came out.
    pub outcome: Result<Summary, Failure>,
}

impl Checked {
    /// The verdict on it.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match &self.outcome {
            Ok(summary) => Verdict::of(summary.fits()),
            Err(_) => Verdict::Refused,
        }
    }
}

/// An error with its causes, in one line.
#[must_use]
pub fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(inner) = cause {
        text.push_str(": ");
        text.push_str(&inner.to_string());
        cause = inner.source();
    }
    text
}
