//! Findings.

use gwatt_core::diagnostic::{Diagnostic as Finding, Severity};
use pyo3::prelude::*;

/// What gwatt has to say about a line of a program or of a machine file.
#[pyclass(frozen, module = "gwatt")]
#[derive(Debug, Clone)]
pub struct Diagnostic(Finding);

#[pymethods]
impl Diagnostic {
    /// `error`, `warning` or `note`.
    #[getter]
    fn severity(&self) -> &'static str {
        match self.0.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        }
    }

    /// Its stable name, which `gwatt explain` takes.
    #[getter]
    fn rule(&self) -> &'static str {
        self.0.rule
    }

    /// What is wrong, in one line.
    #[getter]
    fn message(&self) -> &str {
        &self.0.message
    }

    /// What to do about it.
    #[getter]
    fn help(&self) -> Option<&str> {
        self.0.help.as_deref()
    }

    /// The file, where it is not the one that is being read.
    #[getter]
    fn file(&self) -> Option<&str> {
        self.0.file.as_deref()
    }

    /// The line from 1; 0 for the whole file.
    #[getter]
    fn line(&self) -> u64 {
        self.0.line
    }

    /// The column from 1; 0 for the whole file.
    #[getter]
    fn column(&self) -> u32 {
        self.0.column
    }

    /// Draws it with the line under it and a caret; `name` is that of the file.
    fn render(&self, name: &str) -> String {
        self.0.render(name, false)
    }

    fn __str__(&self) -> String {
        let place = match (&self.0.file, self.0.line) {
            (_, 0) => String::new(),
            (None, line) => format!("line {line}: "),
            (Some(file), line) => format!("{file}: line {line}: "),
        };
        let Finding { rule, message, .. } = &self.0;
        format!("{}[{rule}]: {place}{message}", self.severity())
    }

    fn __repr__(&self) -> String {
        format!("<gwatt.Diagnostic {}>", self.__str__())
    }
}

impl Diagnostic {
    /// All of a list.
    pub fn list(findings: &[Finding]) -> Vec<Self> {
        findings.iter().cloned().map(Self).collect()
    }
}
