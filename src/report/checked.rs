//! A program and what became of it.

use std::error::Error;
use std::fmt;

use super::held::Held;
use super::line_edits::LineEdit;
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
    /// What makes it fit, where that was asked for and is known.
    pub changes: Option<Changes>,
    /// What a baseline makes of its findings, where there is one.
    pub held: Option<Held>,
}

/// Changes of a program that are certified together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changes {
    /// The command that writes them.
    pub command: &'static str,
    /// What it writes, in the order of the lines.
    pub edits: Vec<LineEdit>,
}

impl Checked {
    /// The verdict on it: findings that a baseline has count as none.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match &self.outcome {
            Ok(_) if self.held.as_ref().is_some_and(Held::covers_all) => Verdict::Fits,
            Ok(summary) => Verdict::of(summary.fits()),
            Err(_) => Verdict::Refused,
        }
    }
}

impl Checked {
    /// The verdict on it; `None` where it holds only subprograms, of which nothing was
    /// looked at.
    #[must_use]
    pub fn counted(&self) -> Option<Verdict> {
        match &self.outcome {
            Ok(summary) if summary.only_subprograms() => None,
            _ => Some(self.verdict()),
        }
    }
}

/// What came of several programs, in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Totals {
    /// Programs that fit.
    pub fit: u64,
    /// Programs that do not.
    pub unfit: u64,
    /// Programs that came to no result.
    pub unread: u64,
    /// Files that hold only subprograms: nothing of them was looked at.
    pub subprograms: u64,
}

impl Totals {
    /// Counts a verdict; `None` for a file that holds only subprograms.
    pub fn count(&mut self, verdict: Option<Verdict>) {
        *match verdict {
            Some(Verdict::Fits) => &mut self.fit,
            Some(Verdict::DoesNotFit) => &mut self.unfit,
            Some(Verdict::Refused) => &mut self.unread,
            None => &mut self.subprograms,
        } += 1;
    }

    /// The worst verdict; without a program it is that all fit.
    #[must_use]
    pub fn worst(&self) -> Verdict {
        match self {
            Self { unread: 1.., .. } => Verdict::Refused,
            Self { unfit: 1.., .. } => Verdict::DoesNotFit,
            _ => Verdict::Fits,
        }
    }
}

impl fmt::Display for Totals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            fit,
            unfit,
            unread,
            subprograms,
        } = self;
        let all = fit + unfit + unread;
        let programs = if all == 1 { "program" } else { "programs" };
        let fits = if *fit == 1 { "fits" } else { "fit" };
        let does = if *unfit == 1 { "does" } else { "do" };
        let is = if *unread == 1 { "is" } else { "are" };
        write!(
            f,
            "{all} {programs}: {fit} {fits}, {unfit} {does} not, {unread} {is} not read"
        )?;
        match subprograms {
            0 => Ok(()),
            1 => write!(f, "; 1 file holds only subprograms"),
            count => write!(f, "; {count} files hold only subprograms"),
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
