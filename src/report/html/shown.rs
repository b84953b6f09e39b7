//! What a page shows.

use super::lines::LineTexts;
use super::rows::PageRows;
use super::shares::PageSeries;
use crate::machine::Machine;
use crate::pipeline::{LimitSummary, Summary};
use crate::report::comparison::Comparison;

/// What a program came to.
#[derive(Debug, Clone, Copy)]
pub enum Found<'a> {
    /// It was looked at as it is.
    Report(&'a Summary),
    /// It was limited.
    Limit {
        /// What was done.
        summary: &'a LimitSummary,
        /// It is written though not all of it fits.
        partly: bool,
    },
    /// It was looked at on two machines.
    Diff(Compared<'a>),
}

/// A program on two machines, the first of which is that of the page.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// The second machine.
    pub other: &'a Machine,
    /// What the machines were called.
    pub names: [&'a str; 2],
    /// What it came to on each.
    pub summaries: [&'a Summary; 2],
    /// What differs.
    pub comparison: &'a Comparison,
}

/// A program in pictures.
#[derive(Debug, Clone, Copy)]
pub struct Page<'a> {
    /// Its name.
    pub program: &'a str,
    /// The machine that it runs on.
    pub machine: &'a Machine,
    /// What it came to.
    pub found: Found<'a>,
    /// Its rows.
    pub rows: &'a PageRows,
    /// Its planned power, where that is known.
    pub before: Option<&'a PageSeries>,
    /// That of the written program, or on the second machine.
    pub after: Option<&'a PageSeries>,
    /// The text of its lines.
    pub texts: &'a LineTexts,
}

impl<'a> Page<'a> {
    /// Whether there is a second program, or a second machine.
    pub(super) fn has_two(&self) -> bool {
        !matches!(self.found, Found::Report(_))
    }

    /// The machines that are compared, or the one that there is.
    pub(super) fn machines(&self) -> impl Iterator<Item = &'a Machine> {
        let other = match self.found {
            Found::Diff(compared) => Some(compared.other),
            _ => None,
        };
        [self.machine].into_iter().chain(other)
    }
}
