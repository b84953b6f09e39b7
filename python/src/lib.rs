//! gwatt from Python: a program and a machine in, figures as columns or a program that fits out.
//!
//! Names and figures are those of the commands' JSON and CSV; `gwatt.pyi` has all signatures.

mod columns;
mod diagnostic;
mod error;
mod limited;
mod machine;
mod program;
mod reading;
mod run;
mod summary;
mod worker;

use pyo3::prelude::*;

/// Power of CNC part programs, and programs that fit.
#[pymodule]
mod gwatt {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::diagnostic::Diagnostic;
    #[pymodule_export]
    use crate::error::{DoesNotFit, Error, MachineError, Refused, Unsuitable};
    #[pymodule_export]
    use crate::limited::{Limited, limit};
    #[pymodule_export]
    use crate::machine::{Machine, machines};
    #[pymodule_export]
    use crate::run::{Report, check, report, series};
    #[pymodule_export]
    use crate::summary::Summary;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
