//! The text of the lines that a page names.

use std::collections::BTreeMap;
use std::io::Read;

use super::rows::PageRows;
use crate::diagnostic::excerpt;
use crate::pipeline::{Failure, Row, Summary};
use crate::source::{LineReader, SourceError, split_line_end};

/// Characters of a line that are shown.
const CHARS: usize = 80;

/// Lines of a program by their number; of files of subprograms there are none.
#[derive(Debug, Default)]
pub struct LineTexts {
    pub(super) texts: BTreeMap<u64, String>,
}

impl LineTexts {
    /// Reads the lines of a program that a page of these rows names.
    ///
    /// # Errors
    /// Where the program cannot be read.
    pub fn read(
        program: impl Read,
        rows: &PageRows,
        summaries: &[&Summary],
    ) -> Result<Self, Failure> {
        let mut texts = BTreeMap::new();
        let mut want = |row: &Row| {
            if row.file.is_empty() {
                texts.insert(row.line, String::new());
            }
        };
        rows.bars.list.iter().for_each(|bar| want(&bar.lead.row));
        rows.path.list.iter().for_each(|line| want(&line.lead.row));
        let peaks = rows.peaks().into_iter().flat_map(|peaks| &peaks.list);
        peaks.for_each(|block| want(&block.row));
        let over_time = summaries.iter().flat_map(|summary| &summary.over_time);
        let over_time = over_time.filter(|it| it.file.is_empty() && it.rating.line > 0);
        texts.extend(over_time.map(|found| (found.rating.line, String::new())));
        let mut lines = LineReader::new(program);
        let mut wanted = texts.iter_mut().peekable();
        while wanted.peek().is_some()
            && let Some((number, line)) = lines.next_line().map_err(unreadable)?
        {
            while let Some((_, text)) = wanted.next_if(|(place, _)| **place <= number) {
                *text = excerpt(split_line_end(line).0.trim_ascii(), CHARS);
            }
        }
        Ok(Self { texts })
    }
}

/// A program that was read a moment ago.
fn unreadable(error: SourceError) -> Failure {
    Failure::Input(std::io::Error::other(error))
}
