//! Rows of one program of a set.

use std::io;

use crate::pipeline::expand::Expanded;
use crate::pipeline::{LimitSummary, RestartRows, Row, RowSink};

/// Hands rows on with the names that reports show.
pub(super) struct OfProgram<'a> {
    pub(super) rows: &'a mut dyn RestartRows,
    /// The program's name.
    pub(super) own: &'a str,
    /// What its own lines are said to stand in: nothing where it is the only program.
    pub(super) shown: &'a str,
    /// Where its cycles are written in another way.
    pub(super) expanded: Option<&'a Expanded>,
}

impl RowSink for OfProgram<'_> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        if !row.file.is_empty() && row.file != self.own {
            return self.rows.row(row);
        }
        let mut row = row.clone();
        if let Some(expanded) = self.expanded {
            expanded.trace_row(&mut row);
        }
        self.shown.clone_into(&mut row.file);
        self.rows.row(&row)
    }

    fn wants_figures(&self) -> bool {
        self.rows.wants_figures()
    }
}

/// What is said of a program's own lines is said without its name, as of a program by
/// itself.
pub(super) fn as_its_own(summary: &mut LimitSummary, name: &str) {
    for reason in &mut summary.reasons {
        reason.file = reason.file.take().filter(|file| file != name);
    }
    for figures in [&mut summary.before, &mut summary.after] {
        let unfit = figures.unfit.iter_mut().chain(&mut figures.worst);
        let unfit = unfit.map(|it| &mut it.file);
        let lines = figures.by_line.iter_mut().map(|it| &mut it.file);
        let over_time = figures.over_time.iter_mut().map(|it| &mut it.file);
        for file in unfit.chain(lines).chain(over_time) {
            if file == name {
                file.clear();
            }
        }
    }
}
