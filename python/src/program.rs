//! A program as it is given: text, bytes, or a file.

use std::fs;
use std::path::{Path, PathBuf};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyString};

/// A program, and the folder where its subprograms are looked for first.
#[derive(Debug)]
pub struct Program {
    pub text: Vec<u8>,
    pub folder: Option<PathBuf>,
}

impl<'py> FromPyObject<'_, 'py> for Program {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let text = if let Ok(text) = given.cast::<PyString>() {
            Some(text.to_str()?.as_bytes().to_vec())
        } else if let Ok(text) = given.cast::<PyBytes>() {
            Some(text.as_bytes().to_vec())
        } else if let Ok(text) = given.cast::<PyByteArray>() {
            Some(text.to_vec())
        } else {
            None
        };
        if let Some(text) = text {
            return Ok(Self { text, folder: None });
        }
        let Ok(path) = given.extract::<PathBuf>() else {
            let kind = given.get_type().name()?;
            return Err(PyTypeError::new_err(format!(
                "a program is a str or bytes with its text, or a pathlib.Path: not {kind}"
            )));
        };
        Ok(Self {
            text: fs::read(&path)?,
            folder: path.parent().map(Path::to_owned),
        })
    }
}
