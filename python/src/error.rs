//! Errors as exceptions.

use std::path::Path;

use gwatt_core::diagnostic::Diagnostic as Finding;
use gwatt_core::pipeline::LimitSummary;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

use crate::diagnostic::Diagnostic;
use crate::summary::as_data;

create_exception!(
    gwatt,
    Error,
    PyException,
    "What keeps a call from its result; `diagnostics` has the findings with their lines."
);
create_exception!(gwatt, MachineError, Error, "The machine file is wrong.");
create_exception!(
    gwatt,
    Refused,
    Error,
    "The program is refused: it cannot be read with certainty. `more` counts the errors that are \
     not listed."
);
create_exception!(
    gwatt,
    DoesNotFit,
    Error,
    "No program that fits can be written with what is allowed; `summary` has what was tried."
);
create_exception!(
    gwatt,
    Unsuitable,
    Error,
    "What is asked for cannot be done with this machine."
);

/// A machine file that is wrong.
pub fn machine(py: Python<'_>, findings: Vec<Finding>) -> PyErr {
    raise(py, gwatt_core::Error::Machine(findings))
}

/// A tool table or a parameter file that is wrong.
pub fn data(py: Python<'_>, path: &Path, findings: Vec<Finding>) -> PyErr {
    let mut text = vec![format!("{} is wrong", path.display())];
    text.extend(findings.iter().map(|finding| {
        let Finding { line, message, .. } = finding;
        format!("line {line}: {message}")
    }));
    let raised = Error::new_err(text.join("\n"));
    with(py, raised, "diagnostics", Diagnostic::list(&findings))
}

/// The exception for an error, with what is known of it as attributes.
pub fn raise(py: Python<'_>, error: gwatt_core::Error) -> PyErr {
    let text = error.to_string();
    let findings = Diagnostic::list(error.diagnostics());
    let raised = match error {
        gwatt_core::Error::Machine(_) => MachineError::new_err(text),
        gwatt_core::Error::Refused { more, .. } => with(py, Refused::new_err(text), "more", more),
        gwatt_core::Error::DoesNotFit(summary) => return not_fit(py, text, &summary, findings),
        gwatt_core::Error::Unsuitable(_) => Unsuitable::new_err(text),
        gwatt_core::Error::Input(error) | gwatt_core::Error::Output(error) => return error.into(),
        _ => Error::new_err(text),
    };
    with(py, raised, "diagnostics", findings)
}

fn not_fit(py: Python<'_>, text: String, summary: &LimitSummary, found: Vec<Diagnostic>) -> PyErr {
    match as_data(py, summary) {
        Ok(summary) => {
            let raised = with(py, DoesNotFit::new_err(text), "summary", summary);
            with(py, raised, "diagnostics", found)
        }
        Err(error) => error,
    }
}

/// The same exception with an attribute; the error of setting it in its place.
fn with<'py>(py: Python<'py>, raised: PyErr, name: &str, value: impl IntoPyObject<'py>) -> PyErr {
    match raised.value(py).setattr(name, value) {
        Ok(()) => raised,
        Err(error) => error,
    }
}
