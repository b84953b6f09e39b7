//! The figures of a whole program.

use gwatt_core::pipeline;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;

use crate::diagnostic::Diagnostic;

/// Results as the dicts, lists, numbers and texts of the commands' JSON, in its order.
pub fn as_data<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value);
    let text = text.map_err(|error| PyValueError::new_err(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// The figures of a program.
#[pyclass(frozen, module = "gwatt")]
#[derive(Debug)]
pub struct Summary(pub pipeline::Summary);

#[pymethods]
impl Summary {
    /// Whether every move fits, and all limits over time are kept.
    #[getter]
    fn fits(&self) -> bool {
        self.0.fits()
    }

    /// Cycle time in s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.0.duration_s
    }

    /// Largest bus power in W.
    #[getter]
    fn peak_w(&self) -> f64 {
        self.0.peak_w
    }

    /// Its line; 0 without moves.
    #[getter]
    fn peak_line(&self) -> u64 {
        self.0.peak_line
    }

    /// Largest power fed back in W.
    #[getter]
    fn regen_w(&self) -> f64 {
        self.0.regen_w
    }

    /// Its line; 0 without moves.
    #[getter]
    fn regen_line(&self) -> u64 {
        self.0.regen_line
    }

    /// Energy drawn in J; None where no moves were listed.
    #[getter]
    fn energy_j(&self) -> Option<f64> {
        self.0.energy_j
    }

    /// Number of lines read.
    #[getter]
    fn lines(&self) -> u64 {
        self.0.lines
    }

    /// Number of moves, dwells and runs of the spindle that do not fit included.
    #[getter]
    fn moves(&self) -> u64 {
        self.0.moves
    }

    /// Number of moves that do not fit.
    #[getter]
    fn unfit_count(&self) -> u64 {
        self.0.unfit_count
    }

    /// `planned` or `robust`.
    #[getter]
    fn certificate(&self) -> Option<&'static str> {
        self.0.certificate.map(pipeline::Certificate::name)
    }

    /// The conditions under which the figures hold.
    #[getter]
    fn conditions(&self) -> Vec<String> {
        self.0.conditions.clone()
    }

    /// Warnings and notes.
    #[getter]
    fn diagnostics(&self) -> Vec<Diagnostic> {
        Diagnostic::list(&self.0.notes)
    }

    /// All of it, with the moves that do not fit and the limits over time.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        as_data(py, &self.0)
    }

    fn __repr__(&self) -> String {
        let fits = if self.0.fits() {
            "fits"
        } else {
            "does not fit"
        };
        let (peak_w, line, duration_s) = (self.0.peak_w, self.0.peak_line, self.0.duration_s);
        format!("<gwatt.Summary {fits}: peak {peak_w:.0} W (line {line}), {duration_s:.2} s>")
    }
}
