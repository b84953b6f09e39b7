//! A table that was taken out of a maker's layout, and files that have another one.

use std::fmt::Write as _;

use super::super::error::IdentifyError;

/// Characters of a line that are shown.
const SHOWN: usize = 60;

/// A table: names, and lines of numbers with tabs between them, each in the line that it has
/// in the file.
#[derive(Debug, Default)]
pub(crate) struct Written {
    /// Names; the first one is `time_s`.
    pub(crate) names: Vec<String>,
    /// The numbers.
    pub(crate) text: String,
    /// Lines before them.
    pub(crate) before: u64,
    /// Signals that are passed over, as they have other times.
    pub(crate) ignored: Vec<String>,
    line: u64,
}

impl Written {
    /// With times and these signals.
    pub(crate) fn new(signals: impl IntoIterator<Item = String>) -> Self {
        let time = std::iter::once("time_s".to_owned());
        Self {
            names: time.chain(signals).collect(),
            ..Self::default()
        }
    }

    /// Adds a row that stands in this line.
    pub(crate) fn add<'a>(
        &mut self,
        line: u64,
        time_s: f64,
        values: impl Iterator<Item = &'a str>,
    ) {
        if self.text.is_empty() {
            self.before = line.saturating_sub(1);
            self.line = line;
        }
        while self.line < line {
            self.text.push('\n');
            self.line += 1;
        }
        // A text takes all that is written.
        let _ = write!(self.text, "{time_s}");
        for value in values {
            self.text.push('\t');
            self.text.push_str(value);
        }
        self.text.push('\n');
        self.line += 1;
    }
}

/// A line that is not as the layout has it.
#[derive(Debug)]
pub(crate) struct Foreign {
    line: usize,
    text: String,
    /// Characters before what is wrong.
    column: usize,
    /// What is to stand there.
    wanted: String,
}

/// A table, or the line where a file is another one.
pub(crate) type Read = Result<Written, Foreign>;

impl Foreign {
    /// A line, by its index, in which this should stand after so many bytes.
    pub(crate) fn new(line: usize, text: &str, byte: usize, wanted: impl Into<String>) -> Self {
        let front = text.get(..byte).unwrap_or(text);
        Self {
            line: line + 1,
            text: text.trim_end().to_owned(),
            column: front.chars().count(),
            wanted: wanted.into(),
        }
    }

    /// As an error of a layout.
    pub(crate) fn of(self, title: &str) -> IdentifyError {
        let number = self.line.to_string();
        let margin = " ".repeat(number.len());
        // What stands far to the right is shown from a little before it on.
        let from = self.column.saturating_sub(SHOWN / 2);
        let shown: String = self.text.chars().skip(from).take(SHOWN).collect();
        let shown = shown.replace(|c: char| c.is_control(), " ");
        let caret = " ".repeat(self.column - from);
        IdentifyError::new(
            format!(
                "the file is not of {title}: line {number} should have {}\n{margin} |\n{number} | {shown}\n{margin} | {caret}^",
                self.wanted
            ),
            "leave --preset out, or give that of the program that wrote the file",
        )
    }
}

/// A number of a file, with a decimal point or comma.
pub(crate) fn figure(cell: &str) -> Option<f64> {
    let value: Option<f64> = cell.parse().ok();
    let value = value.or_else(|| cell.replacen(',', ".", 1).parse().ok());
    value.filter(|value| value.is_finite())
}

/// Whether there are rows at all.
pub(crate) fn with_rows(table: Written, last: usize, wanted: &str) -> Read {
    if table.text.is_empty() {
        return Err(Foreign::new(last, "", 0, wanted));
    }
    Ok(table)
}
