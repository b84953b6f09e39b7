//! What programs draw.

use gwatt_core::pipeline::{self, Failure, RowSink};
use gwatt_core::report::SeriesColumns;
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::columns::{Blocks, Series};
use crate::machine::Machine;
use crate::program::Program;
use crate::reading::Reading;
use crate::summary::Summary;
use crate::worker::{self, Reader};

/// The figures of a program and of each of its moves.
#[pyclass(frozen, module = "gwatt")]
#[derive(Debug)]
pub struct Report {
    /// Those of the whole program.
    #[pyo3(get)]
    summary: Py<Summary>,
    /// Those of each move, as columns.
    #[pyo3(get)]
    blocks: Py<PyDict>,
}

#[pymethods]
impl Report {
    fn __repr__(&self) -> String {
        let moves = self.summary.get().0.moves;
        format!("<gwatt.Report of {moves} moves>")
    }
}

/// Reads a program and says what it draws, with advice for each move that does not fit.
#[pyfunction]
#[pyo3(signature = (program, machine, **reading))]
pub fn check(
    py: Python<'_>,
    program: Program,
    machine: &Machine,
    reading: Option<&Bound<'_, PyDict>>,
) -> PyResult<Summary> {
    let Program { text, folder } = program;
    let Reading { machine, options } = Reading::of(machine, folder, reading)?;
    worker::run(py, |stop| {
        let open = || Reader::new(&text, stop);
        let mut summary = pipeline::analyze(open(), &machine, &options, None)?;
        pipeline::take_hints(open(), &machine, &options, &mut summary)?;
        Ok(Summary(summary))
    })
}

/// Reads a program and gives the figures of each of its moves as columns.
#[pyfunction]
#[pyo3(signature = (program, machine, **reading))]
pub fn report(
    py: Python<'_>,
    program: Program,
    machine: &Machine,
    reading: Option<&Bound<'_, PyDict>>,
) -> PyResult<Report> {
    let Program { text, folder } = program;
    let Reading { machine, options } = Reading::of(machine, folder, reading)?;
    let (summary, blocks) = worker::run(py, |stop| {
        let open = || Reader::new(&text, stop);
        let mut blocks = Blocks::new(stop);
        let rows: &mut dyn RowSink = &mut blocks;
        let mut summary = pipeline::analyze(open(), &machine, &options, Some(rows))?;
        pipeline::take_hints(open(), &machine, &options, &mut summary)?;
        Ok((summary, blocks.taken()))
    })?;
    Ok(Report {
        summary: Py::new(py, Summary(summary))?,
        blocks: blocks.to_dict(py)?.unbind(),
    })
}

/// The planned motion, forces and powers of a program over time, as columns.
#[pyfunction]
#[pyo3(signature = (program, machine, *, step_ms = 1.0, max_rows = 10_000_000, **reading))]
pub fn series(
    py: Python<'_>,
    program: Program,
    machine: &Machine,
    step_ms: f64,
    max_rows: usize,
    reading: Option<&Bound<'_, PyDict>>,
) -> PyResult<Py<PyDict>> {
    if !(1e-3..=1e6).contains(&step_ms) {
        let text = "step_ms: a number from 0.001 to 1000000 is needed";
        return Err(PyValueError::new_err(text));
    }
    let Program { text, folder } = program;
    let reading = Reading::of(machine, folder, reading)?;
    reading.one_way()?;
    let Reading { machine, options } = reading;
    let table = worker::run(py, |stop| {
        let columns = SeriesColumns::new(&machine);
        let mut rows = Series::new(columns, max_rows, stop);
        let text = Reader::new(&text, stop);
        match pipeline::series(text, &machine, &options, step_ms * 1e-3, &mut rows) {
            Ok(coarse) => Ok(Some((rows.taken(), coarse))),
            Err(Failure::Output(_)) if rows.is_full() => Ok(None),
            Err(failure) => Err(failure.into()),
        }
    })?;
    let Some((table, coarse)) = table else {
        let text =
            format!("there are more than {max_rows} rows: give a larger step_ms or max_rows");
        return Err(PyValueError::new_err(text));
    };
    if let Some(coarse) = coarse {
        let text = std::ffi::CString::new(coarse.message)?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Ok(table.to_dict(py)?.unbind())
}
