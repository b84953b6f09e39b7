//! Rows as columns that `NumPy`, pandas and Arrow take.
//!
//! Numbers are `array.array`s, whose memory `NumPy` uses without a copy; texts are lists.

use std::collections::HashMap;
use std::io;

use gwatt_core::pipeline::{Restart, Row, RowSink, SeriesSink};
use gwatt_core::power::Instant;
use gwatt_core::report::{COLUMNS, SeriesColumns};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyString};

use crate::worker::Stop;

/// A column of a table.
#[derive(Debug)]
enum Column {
    Whole(Vec<i64>),
    /// What is not known or does not apply is NaN.
    Number(Vec<f64>),
    Text(Texts),
}

/// Texts, of which few differ.
#[derive(Debug, Default)]
struct Texts {
    known: HashMap<String, usize>,
    cells: Vec<usize>,
}

impl Texts {
    fn push(&mut self, text: &str) {
        let next = self.known.len();
        let index = match self.known.get(text) {
            Some(index) => *index,
            None => *self.known.entry(text.to_owned()).or_insert(next),
        };
        self.cells.push(index);
    }

    fn to_list<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut known: Vec<(&String, &usize)> = self.known.iter().collect();
        known.sort_by_key(|(_, index)| **index);
        let known: Vec<Bound<'py, PyString>> = known
            .into_iter()
            .map(|(text, _)| PyString::new(py, text))
            .collect();
        PyList::new(py, self.cells.iter().filter_map(|index| known.get(*index)))
    }
}

impl Column {
    fn to_python<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (code, bytes) = match self {
            Self::Text(texts) => return Ok(texts.to_list(py)?.into_any()),
            Self::Whole(values) => ("q", bytes_of(values, i64::to_ne_bytes)),
            Self::Number(values) => ("d", bytes_of(values, f64::to_ne_bytes)),
        };
        let array = py.import("array")?.getattr("array")?;
        array.call1((code, PyBytes::new(py, &bytes)))
    }
}

fn bytes_of<T: Copy>(values: &[T], bytes: impl Fn(T) -> [u8; 8]) -> Vec<u8> {
    values.iter().copied().flat_map(bytes).collect()
}

/// The moves of a program: the columns of `report --csv`.
#[derive(Debug)]
pub struct Blocks<'a> {
    columns: [Column; COLUMNS.len()],
    stop: Stop<'a>,
}

impl<'a> Blocks<'a> {
    /// None yet.
    pub fn new(stop: Stop<'a>) -> Self {
        Self {
            columns: empty(),
            stop,
        }
    }

    /// What was taken, for Python.
    pub fn taken(self) -> Table {
        let names = COLUMNS.iter().map(|name| (*name).to_owned());
        Table(names.zip(self.columns).collect())
    }
}

/// Columns without rows, of the kinds of [`COLUMNS`].
fn empty() -> [Column; COLUMNS.len()] {
    COLUMNS.map(|name| match name {
        "line" | "run" => Column::Whole(Vec::new()),
        "move" | "axes" | "action" | "knob" | "certificate" | "converter" | "file" => {
            Column::Text(Texts::default())
        }
        _ => Column::Number(Vec::new()),
    })
}

/// A value of a row.
enum Cell<'a> {
    Whole(i64),
    Number(f64),
    Text(&'a str),
}

impl From<Option<f64>> for Cell<'_> {
    fn from(value: Option<f64>) -> Self {
        Self::Number(value.unwrap_or(f64::NAN))
    }
}

impl From<f64> for Cell<'_> {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

/// The values of a row in the order of [`COLUMNS`].
fn cells<'a>(row: &'a Row, axes: &'a str) -> [Cell<'a>; COLUMNS.len()] {
    [
        Cell::Whole(row.line as i64),
        row.n_word.into(),
        Cell::Text(row.kind.name()),
        Cell::Text(axes),
        row.start_s.into(),
        row.duration_s.into(),
        row.peak_w.into(),
        row.regen_w.into(),
        row.limit_w.into(),
        row.ratio.into(),
        row.energy_j.into(),
        Cell::Text(row.action),
        Cell::Text(&row.knob),
        row.value_before.into(),
        row.value_after.into(),
        row.peak_after_w.into(),
        row.duration_after_s.into(),
        row.regen_after_w.into(),
        row.regen_limit_w.into(),
        Cell::Text(row.certificate.name()),
        Cell::Text(&row.converter),
        Cell::Whole(row.run.into()),
        Cell::Text(&row.file),
    ]
}

impl RowSink for Blocks<'_> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        self.stop.check()?;
        let axes = row.axes.to_string();
        for (column, cell) in self.columns.iter_mut().zip(cells(row, &axes)) {
            match (column, cell) {
                (Column::Whole(column), Cell::Whole(value)) => column.push(value),
                (Column::Number(column), Cell::Number(value)) => column.push(value),
                (Column::Text(column), Cell::Text(text)) => column.push(text),
                _ => return Err(io::Error::other("a column of another kind")),
            }
        }
        Ok(())
    }
}

impl Restart for Blocks<'_> {
    fn restart(&mut self) -> io::Result<()> {
        self.columns = empty();
        Ok(())
    }
}

/// A series over time: the columns of `report --series`.
#[derive(Debug)]
pub struct Series<'a> {
    time_s: Vec<f64>,
    line: Vec<i64>,
    columns: SeriesColumns,
    values: Vec<Vec<f64>>,
    row: Vec<f64>,
    rows_max: usize,
    stop: Stop<'a>,
}

impl<'a> Series<'a> {
    /// None of at most `rows_max` rows yet.
    pub fn new(columns: SeriesColumns, rows_max: usize, stop: Stop<'a>) -> Self {
        Self {
            time_s: Vec::new(),
            line: Vec::new(),
            values: vec![Vec::new(); columns.names().len()],
            columns,
            row: Vec::new(),
            rows_max,
            stop,
        }
    }

    /// Whether the rows were more than were to be taken.
    pub fn is_full(&self) -> bool {
        self.time_s.len() >= self.rows_max
    }

    /// What was taken, for Python.
    pub fn taken(self) -> Table {
        let first = [
            ("time_s".to_owned(), Column::Number(self.time_s)),
            ("line".to_owned(), Column::Whole(self.line)),
        ];
        let values = self.values.into_iter().map(Column::Number);
        let names = self.columns.names().iter().cloned();
        Table(first.into_iter().chain(names.zip(values)).collect())
    }
}

impl SeriesSink for Series<'_> {
    fn wants_volts(&self) -> bool {
        self.columns.has_volts()
    }

    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()> {
        self.stop.check()?;
        if self.is_full() {
            return Err(io::Error::other("too many rows"));
        }
        self.time_s.push(time_s);
        self.line.push(line as i64);
        self.row.clear();
        self.columns.append(instant, &mut self.row);
        for (column, value) in self.values.iter_mut().zip(&self.row) {
            column.push(*value);
        }
        Ok(())
    }
}

/// Columns of one length, with their names.
#[derive(Debug)]
pub struct Table(Vec<(String, Column)>);

impl Table {
    /// A dict of them, in their order.
    pub fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = PyDict::new(py);
        for (name, column) in &self.0 {
            table.set_item(name, column.to_python(py)?)?;
        }
        Ok(table)
    }
}
