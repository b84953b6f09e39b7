//! A program that fits.

use std::io::{self, Write};

use gwatt_core::Error;
use gwatt_core::pipeline::{self, Allowed, Law, LimitOptions, Restart, RestartRows, Strategy};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::columns::Blocks;
use crate::machine::Machine;
use crate::program::Program;
use crate::reading::Reading;
use crate::summary::{Summary, as_data};
use crate::worker::{self, Reader, Stop};

/// A program that fits, and what was done to it.
#[pyclass(frozen, module = "gwatt")]
#[derive(Debug)]
pub struct Limited {
    /// The program as it is to be run.
    #[pyo3(get)]
    program: Py<PyBytes>,
    /// The figures of the program as it came.
    #[pyo3(get)]
    before: Py<Summary>,
    /// Those of the program as written.
    #[pyo3(get)]
    after: Py<Summary>,
    /// Number of lines that were changed or inserted.
    #[pyo3(get)]
    edited_lines: u64,
    /// Each move before and after, as columns.
    #[pyo3(get)]
    blocks: Py<PyDict>,
    /// All of it but the program and the moves, as dicts and lists.
    data: Py<PyAny>,
}

#[pymethods]
impl Limited {
    /// All of it but the program and the moves, as dicts and lists.
    fn to_dict(&self, py: Python<'_>) -> Py<PyAny> {
        self.data.clone_ref(py)
    }

    fn __repr__(&self) -> String {
        format!("<gwatt.Limited: {} lines changed>", self.edited_lines)
    }
}

/// Writes a program that fits, with lower rapids alone unless more is allowed; nothing but what
/// is changed differs by a byte.
#[pyfunction]
#[pyo3(signature = (program, machine, *, allow = vec![], strategy = "optimal", **reading))]
pub fn limit(
    py: Python<'_>,
    program: Program,
    machine: &Machine,
    allow: Vec<String>,
    strategy: &str,
    reading: Option<&Bound<'_, PyDict>>,
) -> PyResult<Limited> {
    let how = LimitOptions {
        strategy: strategy_of(strategy)?,
        law: Law::Exact,
        allowed: allowed(&allow)?,
        ..LimitOptions::USUAL
    };
    let Program { text, folder } = program;
    let Reading { machine, options } = Reading::of(machine, folder, reading)?;
    let (summary, written, blocks) = worker::run(py, |stop| {
        let mut written = Written(Vec::new(), stop);
        let mut blocks = Blocks::new(stop);
        let rows: &mut dyn RestartRows = &mut blocks;
        let input = Reader::new(&text, stop);
        let summary = pipeline::limit(input, &machine, &options, how, &mut written, Some(rows))?;
        if !summary.certified {
            return Err(Error::DoesNotFit(Box::new(summary)));
        }
        Ok((summary, written.0, blocks.taken()))
    })?;
    Ok(Limited {
        program: PyBytes::new(py, &written).unbind(),
        edited_lines: summary.edited_lines,
        blocks: blocks.to_dict(py)?.unbind(),
        data: as_data(py, &summary)?.unbind(),
        before: Py::new(py, Summary(summary.before))?,
        after: Py::new(py, Summary(summary.after))?,
    })
}

fn strategy_of(name: &str) -> PyResult<Strategy> {
    match name {
        "preset" => Ok(Strategy::Preset),
        "speed" => Ok(Strategy::Speed),
        "accel" => Ok(Strategy::Accel),
        "optimal" => Ok(Strategy::Optimal),
        "split" => Ok(Strategy::Split),
        _ => Err(PyValueError::new_err(format!(
            "there is no strategy `{name}`; there are preset, speed, accel, optimal and split"
        ))),
    }
}

fn allowed(names: &[String]) -> PyResult<Allowed> {
    let mut allowed = Allowed::NOTHING;
    for name in names {
        let one = match name.as_str() {
            "feed" => &mut allowed.feed,
            "expand" => &mut allowed.expand,
            "straighten" => &mut allowed.straighten,
            "stop" => &mut allowed.stop,
            "pause" => &mut allowed.pause,
            "unverified" => &mut allowed.unverified,
            _ => {
                return Err(PyValueError::new_err(format!(
                    "`{name}` cannot be allowed; there are feed, expand, straighten, stop, pause \
                     and unverified"
                )));
            }
        };
        *one = true;
    }
    Ok(allowed)
}

/// The program as far as it is written.
struct Written<'a>(Vec<u8>, Stop<'a>);

impl Write for Written<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.1.check()?;
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Restart for Written<'_> {
    fn restart(&mut self) -> io::Result<()> {
        self.0.clear();
        Ok(())
    }
}
