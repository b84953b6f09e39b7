//! The front door: a program in, figures or a program that fits out.
//!
//! ```
//! use gwatt::{Machine, check, limit};
//!
//! # fn main() -> Result<(), gwatt::Error> {
//! let (machine, _warnings) = Machine::load("three-axis")?;
//! let program = "G21 G90\nG0 X400 Y300 Z-200\nM30\n";
//!
//! let figures = check(program, &machine)?;
//! assert!(!figures.fits());
//!
//! let limited = limit(program, &machine)?;
//! assert!(check(limited.text(), &machine)?.fits());
//! # Ok(())
//! # }
//! ```
//!
//! Figures are data for serde, under the names that the commands give them in JSON:
//!
//! ```
//! # fn main() -> Result<(), gwatt::Error> {
//! let (machine, _) = gwatt::Machine::load("three-axis")?;
//! let report = gwatt::report("G21 G90\nG0 X100\nM30\n", &machine)?;
//! let report = serde_json::to_value(&report).expect("all keys are texts");
//! assert_eq!(report["summary"]["peak_line"], 2);
//! assert_eq!(report["blocks"][0]["move"], "rapid");
//! # Ok(())
//! # }
//! ```
//!
//! [`check`], [`report`] and [`limit`] take a program that is at hand and the usual
//! [`Options`]; [`Limit`] says what `limit` may do, and reads and writes streams of any
//! length. [`Moves`](crate::Moves) gives the moves of a program one by one. Rows as they
//! come, series over time and sets of programs are in [`pipeline`](crate::pipeline).

mod error;
mod limiting;

use std::io::Cursor;

use serde::Serialize;

pub use error::Error;
pub use limiting::{Limit, Limited};

use crate::machine::Machine;
use crate::pipeline::{Options, Row, RowSink, Summary, analyze, take_hints};

/// Reads a program and says what it draws, with advice for each move that does not fit.
///
/// # Errors
/// A program that is refused ([`Error::Refused`]), or what is asked of this machine cannot be
/// done. That a program does not fit is no error: see [`Summary::fits`].
///
/// ```
/// # fn main() -> Result<(), gwatt::Error> {
/// let (machine, _) = gwatt::Machine::load("three-axis")?;
/// let figures = gwatt::check("G21 G90 G1 X100 F1000\nM30\n", &machine)?;
/// assert!(figures.fits());
/// assert_eq!(figures.moves, 1);
/// // 100 mm at 1000 mm/min, and what the ramps add.
/// assert!((6.0..6.1).contains(&figures.duration_s));
/// # Ok(())
/// # }
/// ```
pub fn check(program: impl AsRef<[u8]>, machine: &Machine) -> Result<Summary, Error> {
    check_as(program, machine, &Options::default())
}

/// [`check`] for a program that is read and judged as `options` say.
///
/// # Errors
/// See [`check`].
pub fn check_as(
    program: impl AsRef<[u8]>,
    machine: &Machine,
    options: &Options,
) -> Result<Summary, Error> {
    let program = program.as_ref();
    let mut summary = analyze(Cursor::new(program), machine, options, None)?;
    take_hints(Cursor::new(program), machine, options, &mut summary)?;
    Ok(summary)
}

/// Figures of a program and of each of its moves.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Those of the whole program, its energy among them.
    pub summary: Summary,
    /// Those of each move, in the order in which they are made.
    #[serde(rename = "blocks")]
    pub rows: Vec<Row>,
}

/// Reads a program and gives the figures of each of its moves, all of which are held: for
/// programs that do not fit into memory see [`analyze`].
///
/// # Errors
/// See [`check`].
///
/// ```
/// # fn main() -> Result<(), gwatt::Error> {
/// let (machine, _) = gwatt::Machine::load("three-axis")?;
/// let report = gwatt::report("G21 G90\nG0 X100\nG0 Y50 Z-10\nM30\n", &machine)?;
/// let largest_w = report.rows.iter().map(|row| row.peak_w).fold(0.0, f64::max);
/// assert_eq!(largest_w, report.summary.peak_w);
/// assert_eq!(report.rows[1].axes.to_string(), "YZ");
/// # Ok(())
/// # }
/// ```
pub fn report(program: impl AsRef<[u8]>, machine: &Machine) -> Result<Report, Error> {
    report_as(program, machine, &Options::default())
}

/// [`report`] for a program that is read and judged as `options` say.
///
/// # Errors
/// See [`check`].
pub fn report_as(
    program: impl AsRef<[u8]>,
    machine: &Machine,
    options: &Options,
) -> Result<Report, Error> {
    struct Kept(Vec<Row>);
    impl RowSink for Kept {
        fn row(&mut self, row: &Row) -> std::io::Result<()> {
            self.0.push(row.clone());
            Ok(())
        }
    }
    let mut rows = Kept(Vec::new());
    let program = Cursor::new(program.as_ref());
    let summary = analyze(program, machine, options, Some(&mut rows))?;
    Ok(Report {
        summary,
        rows: rows.0,
    })
}

/// Writes a program that fits, with lower rapids alone: see [`Limit`] for what else may be
/// done. Nothing but what is changed differs by a byte.
///
/// # Errors
/// [`Error::DoesNotFit`] where no program can be certified; else see [`check`].
pub fn limit(program: impl AsRef<[u8]>, machine: &Machine) -> Result<Limited, Error> {
    Limit::default().run(program, machine)
}
