//! How a table of numbers is written: what separates its columns, which line names
//! them, and where the numbers begin.
//!
//! Drives export commas, semicolons or tabs, decimal points or commas, lines about the
//! recording before the names, and units on a line of their own.

use std::borrow::Cow;

/// What may separate columns; where several would do, that which makes most of them, and
/// of such the first.
const SEPARATORS: [u8; 3] = [b'\t', b';', b','];

/// How a table is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Between columns.
    pub separator: u8,
    /// Names, with units of a line of their own in brackets.
    pub names: Vec<String>,
    /// Where the numbers begin, in bytes and in lines before them.
    pub start: usize,
    /// Lines before the numbers.
    pub lines: u64,
}

/// Text of bytes: UTF-8, else Latin-1, as older programs write it.
#[must_use]
pub fn text_of(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
    }
}

/// The cells of a line, quotes taken off.
pub fn cells(line: &[u8], separator: u8) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(line);
    let mut record = csv::ByteRecord::new();
    match reader.read_byte_record(&mut record) {
        Ok(true) => record
            .iter()
            .map(|cell| text_of(cell).into_owned())
            .collect(),
        _ => Vec::new(),
    }
}

/// A number, with a decimal comma where commas do not separate columns.
#[must_use]
pub fn number(cell: &[u8], separator: u8) -> Option<f64> {
    let cell = std::str::from_utf8(cell).ok()?;
    if let Ok(value) = cell.parse() {
        return Some(value);
    }
    let is_decimal_comma = separator != b',' && !cell.contains('.');
    is_decimal_comma
        .then(|| cell.replacen(',', ".", 1).parse().ok())
        .flatten()
}

/// Whether a line is one of numbers: two or more, and more than half of its cells but
/// empty ones; some may be words, such as the state of a program.
fn is_numeric(cells: &[String], separator: u8) -> bool {
    let filled = || cells.iter().filter(|cell| !cell.is_empty());
    let numbers = filled()
        .filter(|cell| number(cell.as_bytes(), separator).is_some())
        .count();
    numbers >= 2 && 2 * numbers > filled().count()
}

/// Cells without empty ones at the end, which a separator at the end of the line makes.
fn without_tail(mut cells: Vec<String>) -> Vec<String> {
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}

impl Layout {
    /// That of a table of which this is the beginning; `None` where no names with
    /// numbers below them are found in it.
    #[must_use]
    pub fn of(beginning: &[u8]) -> Option<Self> {
        let found = SEPARATORS
            .into_iter()
            .filter_map(|s| Self::with(beginning, s));
        // Of equal ones the first: `max_by_key` would take the last.
        found.fold(None, |best: Option<Self>, next| match best {
            Some(best) if best.names.len() >= next.names.len() => Some(best),
            _ => Some(next),
        })
    }

    fn with(beginning: &[u8], separator: u8) -> Option<Self> {
        let mut start = 0;
        // Names and perhaps units: the last two lines that were not numbers.
        let mut before: [Vec<String>; 2] = [Vec::new(), Vec::new()];
        for (index, line) in beginning.split_inclusive(|byte| *byte == b'\n').enumerate() {
            let plain = line.trim_ascii();
            let bare = plain.strip_prefix(b"#").unwrap_or(plain);
            let cells = without_tail(cells(bare, separator));
            let [names, units] = &before;
            let is_numbers = bare.len() == plain.len() && is_numeric(&cells, separator);
            // One row may have empty cells at its end.
            let goes_with = |names: &[String]| names.len() >= 2 && cells.len() <= names.len();
            if is_numbers && goes_with(units) && cells.len() >= 2 {
                let has_units = names.len() == units.len()
                    && units.iter().all(|unit| is_unit(unit))
                    && !names.iter().any(|name| is_figure(name));
                let names = if has_units {
                    named_with_units(names, units)
                } else {
                    units.clone()
                };
                return Some(Self {
                    separator,
                    names,
                    start,
                    lines: index as u64,
                });
            }
            start += line.len();
            if !cells.is_empty() && !is_numbers {
                let [names, units] = &mut before;
                *names = std::mem::replace(units, cells);
            }
        }
        None
    }
}

/// Whether a cell of a line below the names may be a unit.
fn is_unit(cell: &str) -> bool {
    let bare = cell.trim_matches(['[', ']', '(', ')']);
    bare.chars().count() <= 8 && !bare.contains('_')
}

/// Whether a cell is a figure with its unit, as lines about a recording have and names are not.
fn is_figure(cell: &str) -> bool {
    let (figure, unit) = cell.split_once(' ').unwrap_or((cell, ""));
    !unit.is_empty() && number(figure.as_bytes(), b';').is_some()
}

fn named_with_units(names: &[String], units: &[String]) -> Vec<String> {
    let pairs = names.iter().zip(units);
    pairs
        .map(|(name, unit)| {
            let unit = unit.trim_matches(['[', ']', '(', ')']);
            if unit.is_empty() || unit == "-" {
                name.clone()
            } else {
                format!("{name} [{unit}]")
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(text: &str) -> (u8, Vec<String>, u64, String) {
        let found = Layout::of(text.as_bytes()).unwrap();
        let rest = text[found.start..].lines().next().unwrap_or_default();
        (found.separator, found.names, found.lines, rest.to_owned())
    }

    #[test]
    fn names_and_numbers_are_found_however_they_are_written() {
        let names = |list: &[&str]| list.iter().map(ToString::to_string).collect::<Vec<_>>();
        for (text, separator, list, lines, first) in [
            ("t_s,x_mm\n0,1\n", b',', &["t_s", "x_mm"][..], 1, "0,1"),
            // Decimal commas, and a separator at the end of each line.
            ("t;x;\r\n0,1;2,5;\r\n", b';', &["t", "x"], 1, "0,1;2,5;"),
            (
                "Trace of 3 May\nAxis: X, Y\n\nTime\tIq\nms\t[A]\n0\t1.5\n",
                b'\t',
                &["Time [ms]", "Iq [A]"],
                5,
                "0\t1.5",
            ),
            (
                "# rate 1000\n#time,accel_x\n1,2\n",
                b',',
                &["time", "accel_x"],
                2,
                "1,2",
            ),
            ("\"a, b\";c\n1;2\n", b';', &["a, b", "c"], 1, "1;2"),
            // Short names below a line about the recording are no units of it.
            (
                "Trace; 500 Hz\nIq;Enc\n1,5;2\n",
                b';',
                &["Iq", "Enc"],
                2,
                "1,5;2",
            ),
        ] {
            let expected = (separator, names(list), lines, first.to_owned());
            assert_eq!(layout(text), expected, "{text}");
        }
        for none in ["", "a,b\n", "1,2\n3,4\n", "a\n1\n", "a,b\nx,y\n"] {
            assert_eq!(Layout::of(none.as_bytes()), None, "{none}");
        }
    }

    #[test]
    fn a_decimal_comma_is_one_where_commas_do_not_separate() {
        assert_eq!(number(b"1,5", b';'), Some(1.5));
        assert_eq!(number(b"-1.5e3", b';'), Some(-1500.0));
        for (cell, separator) in [
            ("1,5", b','),
            ("1.000,5", b';'),
            ("1,000,5", b';'),
            ("", b';'),
        ] {
            assert_eq!(number(cell.as_bytes(), separator), None, "{cell}");
        }
    }
}
