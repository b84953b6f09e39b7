//! Lines of a program with cycles written out, as those of the original.

use std::collections::{BTreeMap, BTreeSet};
use std::io;

use super::expanded::Expanded;
use crate::pipeline::{LimitSummary, Restart, RestartRows, Row, RowSink};
use crate::source::{Span, lines, split_line_end};

impl Expanded {
    /// Gives what is said of a limited program the lines of the original, and counts the
    /// lines that were written in another way.
    pub(in crate::pipeline) fn trace(&self, original: &[u8], summary: &mut LimitSummary) {
        let here = |line: &mut u64| *line = self.origin(*line);
        let texts = self.rewritten(original, summary);
        for reason in summary.reasons.iter_mut().filter(|it| it.file.is_none()) {
            if let Some(text) = texts.get(&reason.line) {
                let whole = Span::new(0, text.len());
                *reason = reason.clone().at(reason.line, whole, text);
            }
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
                if let Some(text) = texts.get(&unfit.line) {
                    unfit.text = text.to_vec();
                }
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
    /// The text in the original of the lines that something is said of and that stand
    /// otherwise in this program.
    fn rewritten<'t>(&self, original: &'t [u8], summary: &LimitSummary) -> BTreeMap<u64, &'t [u8]> {
        let reasons = summary.reasons.iter().filter(|it| it.file.is_none());
        let after = &summary.after;
        let unfit = after.unfit.iter().chain(&after.worst);
        let unfit = unfit.filter(|it| it.file.is_empty());
        let named = reasons.map(|it| it.line).chain(unfit.map(|it| it.line));
        let named: BTreeSet<u64> = named.filter(|line| *line > 0).collect();
        let origins: BTreeSet<u64> = named.iter().map(|line| self.origin(*line)).collect();
        let written = numbered(&self.text, &named);
        let original = numbered(original, &origins);
        let texts = named.into_iter().filter_map(|line| {
            let text = *original.get(&self.origin(line))?;
            (written.get(&line) != Some(&text)).then_some((line, text))
        });
        texts.collect()
    }

    /// Gives a row of the program itself the line of the original.
    pub(in crate::pipeline) fn trace_row(&self, row: &mut Row) {
        row.line = self.origin(row.line);
        let n_word = self.n_word(row.line);
        row.n_word = n_word.or(row.n_word);
    }
}

/// The action of moves of a cycle that is written in another way.
pub(in crate::pipeline) const WRITTEN_OUT: &str = "written out";

/// The rows of the original, by line.
#[derive(Default)]
pub(in crate::pipeline) struct OriginalRows {
    by_line: BTreeMap<u64, Vec<Row>>,
}

impl RowSink for OriginalRows {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        if row.file.is_empty() {
            self.by_line.entry(row.line).or_default().push(row.clone());
        }
        Ok(())
    }
}

/// Hands rows on with the lines of the original, and with its figures where a line stands as
/// it was.
pub(in crate::pipeline) struct Traced<'a> {
    rows: &'a mut dyn RestartRows,
    expanded: &'a Expanded,
    original: &'a OriginalRows,
    /// Rows of each line so far.
    seen: BTreeMap<u64, usize>,
}

impl<'a> Traced<'a> {
    pub(in crate::pipeline) fn new(
        rows: &'a mut (dyn RestartRows + 'a),
        expanded: &'a Expanded,
        original: &'a OriginalRows,
    ) -> Self {
        Self {
            rows,
            expanded,
            original,
            seen: BTreeMap::new(),
        }
    }

    /// The figures before the change: other stops next to a line change what it draws.
    fn take_original(&mut self, row: &mut Row) {
        let seen = self.seen.entry(row.line).or_default();
        let own = self.original.by_line.get(&row.line);
        let before = own.and_then(|rows| rows.get(*seen));
        *seen += 1;
        let before = before.filter(|before| (before.kind, before.axes) == (row.kind, row.axes));
        let Some(before) = before else { return };
        row.duration_s = before.duration_s;
        row.peak_w = before.peak_w;
        row.regen_w = before.regen_w;
        row.limit_w = before.limit_w;
        row.regen_limit_w = before.regen_limit_w;
        row.ratio = before.ratio;
        row.energy_j = before.energy_j;
        row.converter.clone_from(&before.converter);
    }
}

impl RowSink for Traced<'_> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        if !row.file.is_empty() {
            return self.rows.row(row);
        }
        let mut row = row.clone();
        self.expanded.trace_row(&mut row);
        if self.expanded.stands(row.line) {
            self.take_original(&mut row);
        } else if row.action.is_empty() {
            row.action = WRITTEN_OUT;
        }
        self.rows.row(&row)
    }

    fn wants_figures(&self) -> bool {
        self.rows.wants_figures()
    }
}

impl Restart for Traced<'_> {
    fn restart(&mut self) -> io::Result<()> {
        self.seen.clear();
        self.rows.restart()
    }
}

/// The lines with these numbers, from 1, without their ends.
fn numbered<'t>(text: &'t [u8], numbers: &BTreeSet<u64>) -> BTreeMap<u64, &'t [u8]> {
    let numbered = (1..).zip(lines(text));
    let wanted = numbered.filter(|(number, _)| numbers.contains(number));
    wanted
        .map(|(number, line)| (number, split_line_end(line).0))
        .collect()
}
