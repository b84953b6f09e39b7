//! Rows of a CSV file with their lines, and what is wrong with them in plain
//! words: recordings come from many programs.

use std::borrow::Cow;
use std::io::{Chain, Cursor, Read};

use super::error::{IdentifyError, Outcome};
use super::layout::{Layout, number, text_of};

/// Bytes at the beginning that show what a file is.
const BEGINNING: u64 = 1 << 16;
/// Characters of a cell that are shown.
const SHOWN: usize = 24;

/// A table of numbers that is read row by row.
pub struct Rows<R> {
    text: csv::Reader<Chain<Cursor<Vec<u8>>, R>>,
    /// The names in the header.
    pub names: Vec<String>,
    record: csv::ByteRecord,
    separator: u8,
    /// Lines before those that the reader counts.
    lines_before: u64,
}

impl Rows<std::io::Empty> {
    /// Rows that were taken out of another layout: numbers with tabs between them, after so
    /// many lines.
    #[must_use]
    pub fn named(names: Vec<String>, numbers: String, lines_before: u64) -> Self {
        let text = csv::ReaderBuilder::new()
            .delimiter(b'\t')
            .trim(csv::Trim::All)
            .flexible(true)
            .has_headers(false)
            .from_reader(Cursor::new(numbers.into_bytes()).chain(std::io::empty()));
        Self {
            text,
            names,
            record: csv::ByteRecord::new(),
            separator: b'\t',
            lines_before,
        }
    }
}

impl<R: Read> Rows<R> {
    /// Opens a file and reads its names: the last line before the numbers, with units
    /// where they have a line of their own. Columns are separated by commas, semicolons
    /// or tabs.
    ///
    /// # Errors
    ///
    /// When it is no such table.
    pub fn open(mut input: R) -> Outcome<Self> {
        let mut beginning = Vec::new();
        input
            .by_ref()
            .take(BEGINNING)
            .read_to_end(&mut beginning)
            .map_err(|error| unreadable(&error))?;
        let is_wide = beginning.starts_with(&[0xFF, 0xFE]) || beginning.starts_with(&[0xFE, 0xFF]);
        if is_wide || beginning.contains(&0) {
            return Err(IdentifyError::new(
                if is_wide {
                    "the file is UTF-16"
                } else {
                    "the file is not text: it contains NUL bytes"
                },
                "export it as CSV in UTF-8; the first line names the columns, such as time_s,torque_nm,position_mm",
            ));
        }
        if beginning.starts_with("\u{feff}".as_bytes()) {
            beginning.drain(.."\u{feff}".len());
        }
        // The line that the beginning ends in may be cut in two.
        let whole = match beginning.iter().rposition(|byte| *byte == b'\n') {
            Some(end) if beginning.len() as u64 + 3 >= BEGINNING => end + 1,
            _ => beginning.len(),
        };
        let layout = beginning.get(..whole).and_then(Layout::of);
        let separator = layout.as_ref().map_or(b',', |layout| layout.separator);
        if let Some(layout) = &layout {
            beginning.drain(..layout.start);
        }
        let mut text = csv::ReaderBuilder::new()
            .delimiter(separator)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .flexible(true)
            .has_headers(layout.is_none())
            .from_reader(Cursor::new(beginning).chain(input));
        let (names, lines_before) = if let Some(layout) = layout {
            (layout.names, layout.lines)
        } else {
            let header = text.byte_headers().map_err(|error| broken(&error, 0))?;
            let names = header.iter().map(|name| text_of(name).into_owned());
            (names.collect(), 0)
        };
        if names.len() < 2 {
            return Err(one_column(names.first().map_or("", String::as_str)));
        }
        Ok(Self {
            text,
            names,
            record: csv::ByteRecord::new(),
            separator,
            lines_before,
        })
    }

    /// Goes to the next row; its line, or nothing at the end.
    ///
    /// # Errors
    ///
    /// When the row cannot be read, or has not as many values as there are names.
    pub fn next_line(&mut self) -> Outcome<Option<u64>> {
        let before = self.lines_before;
        let read = self.text.read_byte_record(&mut self.record);
        if !read.map_err(|error| broken(&error, before))? {
            return Ok(None);
        }
        let line = before + self.record.position().map_or(0, csv::Position::line);
        let (found, named) = (self.record.len(), self.names.len());
        // A separator at the end of the line makes an empty cell.
        let ends_empty = found == named + 1 && self.record.get(named).is_some_and(<[u8]>::is_empty);
        if found == named || ends_empty {
            return Ok(Some(line));
        }
        let (help, what) = if found > named {
            (
                "numbers need decimal points where commas separate columns",
                "more",
            )
        } else {
            (
                "cut the recording there, or export it again: every line needs as many values as the header has names",
                "fewer",
            )
        };
        Err(IdentifyError::new(
            format!("line {line} has {found} values, {what} than the {named} names of the header"),
            help,
        ))
    }

    /// A cell of the row; empty where there is none.
    #[must_use]
    pub fn cell(&self, index: usize) -> Cow<'_, str> {
        text_of(self.record.get(index).unwrap_or_default())
    }

    /// The number of a cell, which may be none that is finite; `None` for a cell that is
    /// no number.
    #[must_use]
    pub fn number(&self, index: usize) -> Option<f64> {
        number(self.record.get(index).unwrap_or_default(), self.separator)
    }
}

/// A cell that is no number, in a line.
#[must_use]
pub fn no_number(line: u64, name: &str, cell: &str) -> IdentifyError {
    let shown: String = cell
        .chars()
        .take(SHOWN)
        .flat_map(char::escape_debug)
        .collect();
    let more = if cell.chars().count() > SHOWN {
        "…"
    } else {
        ""
    };
    let is_german = cell.contains(',') && cell.replacen(',', ".", 1).parse::<f64>().is_ok();
    IdentifyError::new(
        format!("line {line}: {name} is \"{shown}{more}\", not a number"),
        if is_german {
            "export it with decimal points instead of decimal commas"
        } else {
            "cut the recording there, or record again: samples must not be missing"
        },
    )
}

/// What is wrong with a header of one column, or none.
fn one_column(name: &str) -> IdentifyError {
    if name.is_empty() {
        return IdentifyError::new(
            "the recording is empty",
            "record again; the first line names the columns, such as time_s,torque_nm,position_mm",
        );
    }
    if name.contains(';') || name.contains('\t') {
        return IdentifyError::new(
            "there are names of columns, but no numbers below them",
            "export it as a table: one line of names, below it lines of numbers; commas, semicolons or tabs between columns",
        );
    }
    IdentifyError::new(
        "the recording has fewer than two columns",
        "separate columns with commas; the first line names them, such as time_s,torque_nm,position_mm",
    )
}

fn unreadable(error: &std::io::Error) -> IdentifyError {
    IdentifyError::new(
        format!("the file cannot be read: {error}"),
        "check that it is a file, and that it may be read",
    )
}

/// Why the reader stopped, without its own words; `before` are lines that it does not
/// count.
fn broken(error: &csv::Error, before: u64) -> IdentifyError {
    let line = error.position().map(csv::Position::line);
    match error.kind() {
        csv::ErrorKind::Io(error) => unreadable(error),
        _ => IdentifyError::new(
            match line {
                Some(line) => format!("line {} cannot be read", before + line),
                None => "the file cannot be read".to_owned(),
            },
            "it must be a table, every line with as many values as there are names",
        ),
    }
}

/// The lines of samples, kept where they do not follow one another.
#[derive(Debug, Default)]
pub struct Lines {
    runs: Vec<(usize, u64)>,
    count: usize,
}

impl Lines {
    /// Adds the line of the next sample.
    pub fn add(&mut self, line: u64) {
        if self.of(self.count) != line {
            self.runs.push((self.count, line));
        }
        self.count += 1;
    }

    /// The line of a sample.
    #[must_use]
    pub fn of(&self, sample: usize) -> u64 {
        let at = self.runs.partition_point(|(first, _)| *first <= sample);
        let run = at.checked_sub(1).and_then(|at| self.runs.get(at));
        run.map_or(0, |(first, line)| line + (sample - first) as u64)
    }
}
