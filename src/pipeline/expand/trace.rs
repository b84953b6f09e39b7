//! Lines of a program with cycles written out, as those of the original.

use std::io;

use super::Expanded;
use crate::pipeline::{LimitSummary, Restart, RestartRows, Row, RowSink};

impl Expanded {
    /// Gives what is said of a limited program the lines of the original, and counts the
    /// lines that were written in another way.
    pub(in crate::pipeline) fn trace(&self, summary: &mut LimitSummary) {
        let here = |line: &mut u64| *line = self.origin(*line);
        for reason in summary.reasons.iter_mut().filter(|it| it.file.is_none()) {
            here(&mut reason.line);
        }
        let notes = summary.before.notes.iter_mut();
        for note in notes.filter(|it| it.file.is_none() && it.line > 0) {
            here(&mut note.line);
        }
        for pause in &mut summary.pauses {
            here(&mut pause.line);
        }
        summary.edited_lines += self.blocks as u64;
        let after = &mut summary.after;
        here(&mut after.peak_line);
        here(&mut after.regen_line);
        for unfit in after.unfit.iter_mut().chain(&mut after.worst) {
            if unfit.file.is_empty() {
                here(&mut unfit.line);
            }
        }
        for found in &mut after.over_time {
            if found.file.is_empty() {
                here(&mut found.rating.line);
            }
        }
        for line in &mut after.by_line {
            if line.file.is_empty() {
                here(&mut line.line);
            }
        }
    }
}

impl Expanded {
    /// Gives a row of the program itself the line of the original.
    pub(in crate::pipeline) fn trace_row(&self, row: &mut Row) {
        row.line = self.origin(row.line);
        let n_word = self.n_words.get(&row.line).copied();
        row.n_word = n_word.or(row.n_word);
    }
}

/// Hands rows on with the lines of the original.
pub(in crate::pipeline) struct Traced<'a> {
    rows: &'a mut dyn RestartRows,
    expanded: &'a Expanded,
}

impl<'a> Traced<'a> {
    pub(in crate::pipeline) fn new(
        rows: &'a mut (dyn RestartRows + 'a),
        expanded: &'a Expanded,
    ) -> Self {
        Self { rows, expanded }
    }
}

impl RowSink for Traced<'_> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        if !row.file.is_empty() {
            return self.rows.row(row);
        }
        let mut row = row.clone();
        self.expanded.trace_row(&mut row);
        self.rows.row(&row)
    }

    fn wants_figures(&self) -> bool {
        self.rows.wants_figures()
    }
}

impl Restart for Traced<'_> {
    fn restart(&mut self) -> io::Result<()> {
        self.rows.restart()
    }
}
