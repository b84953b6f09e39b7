//! Machines.

use std::ffi::OsString;
use std::path::PathBuf;

use gwatt_core::machine::builtin;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::diagnostic::Diagnostic;
use crate::error;

/// A machine: its axes, what feeds them, and how its control reads programs.
#[pyclass(frozen, module = "gwatt")]
#[derive(Debug)]
pub struct Machine {
    pub machine: gwatt_core::Machine,
    warnings: Vec<Diagnostic>,
}

#[pymethods]
impl Machine {
    /// Loads a machine: the name of a built-in one, else a file.
    #[new]
    fn load(py: Python<'_>, name_or_path: PathBuf) -> PyResult<Self> {
        let name = name_or_path.into_os_string().into_string();
        let name = name.map_err(|name: OsString| {
            let name = name.to_string_lossy();
            PyValueError::new_err(format!("the path {name} is not UTF-8: rename the file"))
        })?;
        Self::of(py, gwatt_core::Machine::load(&name))
    }

    /// Reads a machine from the text of a file; `path` is where a controller profile is looked
    /// for that it names.
    #[staticmethod]
    #[pyo3(signature = (text, path = "machine.toml"))]
    fn from_toml(py: Python<'_>, text: &str, path: &str) -> PyResult<Self> {
        Self::of(py, gwatt_core::Machine::from_toml(path, text))
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.machine.name
    }

    /// The letters of its axes.
    #[getter]
    fn axes(&self) -> String {
        self.machine.axis_set.to_string()
    }

    /// How its control reads programs.
    #[getter]
    fn controller(&self) -> &str {
        &self.machine.controller.language.name
    }

    /// Peak power in W of each converter, by name, without the margin.
    #[getter]
    fn peak_power_w(&self) -> std::collections::BTreeMap<String, f64> {
        let converters = self.machine.converters.iter();
        converters
            .map(|it| (it.name.clone(), it.peak_power_w))
            .collect()
    }

    /// Share of the peak power that is kept free.
    #[getter]
    fn margin(&self) -> f64 {
        self.machine.limits.margin
    }

    /// What is doubtful in its file.
    #[getter]
    fn warnings(&self) -> Vec<Diagnostic> {
        self.warnings.clone()
    }

    fn __repr__(&self) -> String {
        format!("<gwatt.Machine {}>", self.machine.name)
    }
}

impl Machine {
    fn of(
        py: Python<'_>,
        loaded: gwatt_core::machine::Loaded<gwatt_core::Machine>,
    ) -> PyResult<Self> {
        let (machine, warnings) = loaded.map_err(|findings| error::machine(py, findings))?;
        Ok(Self {
            machine,
            warnings: Diagnostic::list(&warnings),
        })
    }
}

/// The names of the built-in machines, the default first.
#[pyfunction]
pub fn machines() -> Vec<&'static str> {
    let machines = builtin::machines().iter();
    machines.map(|machine| machine.name).collect()
}
