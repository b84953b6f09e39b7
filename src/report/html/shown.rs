//! What a page shows.

use super::lines::LineTexts;
use super::rows::PageRows;
use super::shares::PageSeries;
use crate::machine::Machine;
use crate::pipeline::{LimitSummary, Summary};

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
    /// That of the written program.
    pub after: Option<&'a PageSeries>,
    /// The text of its lines.
    pub texts: &'a LineTexts,
}

impl Page<'_> {
    /// Whether a written program is shown.
    pub(super) fn is_limited(&self) -> bool {
        matches!(self.found, Found::Limit { .. })
    }
}
