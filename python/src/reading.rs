//! How programs are read and judged: keyword arguments, by the names of the commands' options.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;

use gwatt_core::diagnostic::Diagnostic as Finding;
use gwatt_core::interpret::{
    BlockDelete, GivenVariable, ParameterFile, ProbeResult, ProbeWay, ToolTable,
};
use gwatt_core::machine::{AXES, AxisId, builtin, builtin_controller};
use gwatt_core::pipeline::{Certificate, Options, Start};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};

use crate::error;
use crate::machine::Machine;

/// A machine and how programs are read for it.
#[derive(Debug, Clone)]
pub struct Reading {
    pub machine: gwatt_core::Machine,
    pub options: Options,
}

impl Reading {
    /// That of keyword arguments; `folder` is where subprograms are looked for first.
    ///
    /// # Errors
    /// A name or a value that is none, with those that there are.
    pub fn of(
        machine: &Machine,
        folder: Option<PathBuf>,
        given: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let threads = thread::available_parallelism().map_or(1, Into::into);
        let mut reading = Self {
            machine: machine.machine.clone(),
            options: Options {
                threads,
                ..Options::default()
            },
        };
        let mut folders: Vec<PathBuf> = folder.into_iter().collect();
        let mut variables = BTreeMap::new();
        for (name, value) in given.into_iter().flatten() {
            let name: String = name.extract()?;
            match name.as_str() {
                "sub_paths" => folders.extend(value.extract::<Vec<PathBuf>>()?),
                "variables" => variables = value.extract::<BTreeMap<String, f64>>()?,
                _ => reading.set(&name, &value)?,
            }
        }
        for folder in folders
            .iter()
            .filter(|folder| !folder.as_os_str().is_empty())
        {
            if !folder.is_dir() {
                let text = format!("sub_paths: there is no folder {}", folder.display());
                return Err(PyValueError::new_err(text));
            }
        }
        reading.options.reading.sub_paths = folders.into();
        // After the dialect, which says what variables there are.
        reading.variables(variables)?;
        Ok(reading)
    }

    fn set(&mut self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = value.py();
        let reading = &mut self.options.reading;
        match name {
            "start" => reading.start = start(&self.machine, value)?,
            "dialect" => {
                let name: String = value.extract()?;
                let own = &mut self.machine.controller.language;
                if *own.name != *name {
                    *own = builtin_controller(&name)
                        .ok_or_else(|| no_dialect(&name))?
                        .language;
                }
            }
            "tool_table" => reading.tools = Some(data(py, value, ToolTable::parse)?),
            "parameters" => reading.parameters = Some(data(py, value, ParameterFile::parse)?),
            "probe" => reading.probe = Some(probe(value)?),
            "block_delete" => reading.block_delete = block_delete(value)?,
            "once" => self.options.once = value.extract()?,
            "certificate" => self.options.certificate = Some(certificate(value)?),
            "threads" => {
                let threads: usize = value.extract()?;
                if threads == 0 {
                    return Err(PyValueError::new_err("threads: at least 1 is needed"));
                }
                self.options.threads = threads;
            }
            _ => {
                let text = format!(
                    "there is no option `{name}`; there are start, dialect, tool_table, \
                     parameters, variables, probe, block_delete, sub_paths, once, certificate \
                     and threads"
                );
                return Err(PyTypeError::new_err(text));
            }
        }
        Ok(())
    }

    fn variables(&mut self, given: BTreeMap<String, f64>) -> PyResult<()> {
        let language = &self.machine.controller.language;
        let mut variables = Vec::with_capacity(given.len());
        for (name, value) in given {
            let variable: GivenVariable = format!("{name}={value}")
                .parse()
                .map_err(PyValueError::new_err)?;
            if !variable.suits(language) {
                let controller = &language.name;
                let text = format!("variables: `{controller}` has no {name}");
                return Err(PyValueError::new_err(text));
            }
            variables.push(variable);
        }
        self.options.reading.given = variables.into();
        Ok(())
    }

    /// Refuses what follows several ways through a program where one is shown.
    pub fn one_way(&self) -> PyResult<()> {
        if matches!(self.options.reading.probe, Some(ProbeResult::Either(_))) {
            return Err(PyValueError::new_err(
                "a series shows one way through a program: give probe=\"hit\" or \"miss\"",
            ));
        }
        Ok(())
    }
}

fn no_dialect(name: &str) -> PyErr {
    let names: Vec<&str> = builtin::controllers().iter().map(|it| it.name).collect();
    let names = names.join(", ");
    PyValueError::new_err(format!("there is no dialect {name}; there are {names}"))
}

/// `"unknown"`, or a dict of axes with their positions; all others stand at 0.
fn start(machine: &gwatt_core::Machine, value: &Bound<'_, PyAny>) -> PyResult<Start> {
    if value.extract::<&str>().is_ok_and(|text| text == "unknown") {
        return Ok(Start::Unknown);
    }
    let Ok(given) = value.extract::<BTreeMap<String, f64>>() else {
        let text = "start: a dict of axes with their positions in mm, or \"unknown\" is needed";
        return Err(PyTypeError::new_err(text));
    };
    let mut at = [0.0; AXES];
    for (name, position) in given {
        let axis = match name.as_bytes() {
            [letter] => AxisId::from_letter(letter.to_ascii_uppercase()),
            _ => None,
        };
        let known = axis.filter(|axis| machine.axis_set.contains(*axis as usize));
        let Some(own) = known.and_then(|axis| at.get_mut(axis as usize)) else {
            let text = format!("start: the machine has no axis {name}");
            return Err(PyValueError::new_err(text));
        };
        if !position.is_finite() {
            let text = format!("start: {name} needs a finite position");
            return Err(PyValueError::new_err(text));
        }
        *own = position;
    }
    Ok(Start::At(at))
}

fn probe(value: &Bound<'_, PyAny>) -> PyResult<ProbeResult> {
    match value.extract::<&str>()? {
        "hit" => Ok(ProbeResult::Hit),
        "miss" => Ok(ProbeResult::Miss),
        "both" => Ok(ProbeResult::Either(ProbeWay::default())),
        _ => Err(PyValueError::new_err(
            "probe: `hit`, `miss` or `both` is needed",
        )),
    }
}

fn certificate(value: &Bound<'_, PyAny>) -> PyResult<Certificate> {
    match value.extract::<&str>()? {
        "planned" => Ok(Certificate::Planned),
        "robust" => Ok(Certificate::Robust),
        _ => Err(PyValueError::new_err(
            "certificate: `planned` or `robust` is needed",
        )),
    }
}

/// True for all, or the levels.
fn block_delete(value: &Bound<'_, PyAny>) -> PyResult<BlockDelete> {
    if let Ok(all) = value.cast::<PyBool>() {
        let all = all.is_true();
        return Ok(if all {
            BlockDelete::ALL
        } else {
            BlockDelete::NONE
        });
    }
    let mut levels = BlockDelete::NONE;
    for level in value.extract::<Vec<i64>>()? {
        let own = u8::try_from(level).ok().filter(|own| (1..=9).contains(own));
        let own = own.ok_or_else(|| {
            PyValueError::new_err(format!("block_delete: {level} is no level from 1 to 9"))
        })?;
        levels = levels.with(own);
    }
    Ok(levels)
}

/// Reads a file of the control's data.
fn data<T>(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    parse: fn(&[u8]) -> Result<T, Vec<Finding>>,
) -> PyResult<Arc<T>> {
    let path: PathBuf = path.extract()?;
    let found = parse(&fs::read(&path)?);
    let found = found.map_err(|findings| error::data(py, &path, findings))?;
    Ok(Arc::new(found))
}
