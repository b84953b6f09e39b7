//! The series over time of `gwatt report`.

use std::io::{BufWriter, IntoInnerError};

use anyhow::Result;
use gwatt::pipeline::{self, Failure, Law, LimitOptions, Strategy};
use gwatt::report::SeriesRows;

use super::input::Program;
use super::output::{Spool, Target};
use super::setup::Setup;
use super::terminal::Messages;
use crate::cli::{ReportArgs, allowed};

/// Writes the series of a program before and after limiting, if one is asked
/// for; false where a program was refused.
pub fn write(
    args: &ReportArgs,
    program: &Program,
    setup: &Setup,
    messages: &mut Messages,
) -> Result<Option<Spool>, Refused> {
    let Some(path) = &args.series else {
        return Ok(None);
    };
    let machine = &setup.machine;
    let spool = Target::new(path)?.spool()?;
    let mut rows = SeriesRows::new(BufWriter::new(spool), machine, "before")?;
    let step_s = args.step_ms * 1e-3;
    let options = setup.options_for(program);
    let coarse = program
        .open()
        .and_then(|input| pipeline::series(input, machine, &options, step_s, &mut rows))
        .map_err(|failure| refused(&program.name, &failure, messages))?;
    messages.diagnostics(&program.name, coarse.as_slice());
    rows.program("after");
    if let Some(path) = &args.limited {
        let limited = Program::new(path);
        let options = setup.options_for(&limited);
        let coarse = limited
            .open()
            .and_then(|input| pipeline::series(input, machine, &options, step_s, &mut rows))
            .map_err(|failure| refused(&limited.name, &failure, messages))?;
        messages.diagnostics(&limited.name, coarse.as_slice());
    } else {
        let how = LimitOptions {
            strategy: Strategy::Optimal,
            law: Law::Exact,
            allowed: allowed(&args.allow),
            ..LimitOptions::USUAL
        };
        let mut written = BufWriter::new(Target::Stdout.spool()?);
        let summary = program
            .open()
            .and_then(|input| pipeline::limit(input, machine, &options, how, &mut written, None))
            .map_err(|failure| refused(&program.name, &failure, messages))?;
        if summary.certified {
            let mut written = written.into_inner().map_err(IntoInnerError::into_error)?;
            let input = written.read()?;
            pipeline::series(input, machine, &options, step_s, &mut rows)
                .map_err(|failure| refused(&program.name, &failure, messages))?;
        } else {
            messages.note(format_args!(
                "{}: `gwatt limit` cannot make it fit: the series shows it only as it is",
                program.name
            ));
        }
    }
    let spool = rows
        .finish()?
        .into_inner()
        .map_err(IntoInnerError::into_error)?;
    Ok(Some(spool))
}

fn refused(name: &str, failure: &Failure, messages: &mut Messages) -> Refused {
    messages.failure(name, failure);
    Refused::Reported
}

/// Why there is no series.
#[derive(Debug)]
pub enum Refused {
    /// A program is refused, and that has been reported.
    Reported,
    /// Anything else.
    Error(anyhow::Error),
}

impl<E: Into<anyhow::Error>> From<E> for Refused {
    fn from(error: E) -> Self {
        Self::Error(error.into())
    }
}
