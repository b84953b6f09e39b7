//! One row of a report: a move, what it draws, and what was done about it.

use std::io;

use crate::interpret::{Arc, Move, MoveKind};
use crate::machine::{AxisSet, AxisValues};
pub use crate::power::Certificate;
use crate::power::Want;

/// One move in program order. Reports print it in the order of the fields; a
/// value that is not known or does not apply is `None` and printed as blank.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Line from 1.
    pub line: u64,
    /// Which run of the line, from 1.
    pub run: u32,
    /// The file that the line stands in; empty for the program itself.
    pub file: String,
    /// Block number without N.
    pub n_word: Option<f64>,
    /// What kind of move.
    pub kind: MoveKind,
    /// Axes that really move and start together.
    pub axes: AxisSet,
    /// Start in s from the beginning of the program.
    pub start_s: f64,
    /// Duration in s.
    pub duration_s: f64,
    /// Largest bus power in W, base load included.
    pub peak_w: f64,
    /// Largest power fed back in W, positive.
    pub regen_w: f64,
    /// Peak power of the converter less the margin, W.
    pub limit_w: f64,
    /// `limit_w / peak_w`; `None` where the peak is not positive.
    pub ratio: Option<f64>,
    /// Integral of the bus power in J.
    pub energy_j: f64,
    /// What was done, such as `lower feed`; empty for nothing.
    pub action: &'static str,
    /// The names of the words that were used, such as `F` or `G131`; empty without one.
    pub knob: String,
    /// The words as the control takes them, each with its value, such as
    /// `SET_VELOCITY_LIMIT ACCEL=500`; empty without one.
    pub words: String,
    /// Whether lowering the F took `--allow feed`.
    pub feed_allowed: bool,
    /// Value of the first of them before, in program units.
    pub value_before: Option<f64>,
    /// Value of it after.
    pub value_after: Option<f64>,
    /// Peak in the written program; `None` in a report without limiting.
    pub peak_after_w: Option<f64>,
    /// Start in the written program in s from its beginning.
    pub start_after_s: Option<f64>,
    /// Duration in the written program.
    pub duration_after_s: Option<f64>,
    /// Regenerative peak in the written program.
    pub regen_after_w: Option<f64>,
    /// Which certificate `peak_w` and `regen_w` belong to.
    pub certificate: Certificate,
    /// Regenerative limit less the margin; `None` without one.
    pub regen_limit_w: Option<f64>,
    /// Name of the converter that is loaded most; empty where there is one only.
    pub converter: String,
    /// Where the axes go; `None` where they stand, or where their start is not known.
    pub route: Option<Route>,
}

/// The way of a move, in machine coordinates: mm, or degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Route {
    /// Where each axis starts.
    pub start: AxisValues,
    /// Where it ends.
    pub end: AxisValues,
    /// Geometry of an arc.
    pub arc: Option<Arc>,
}

impl Route {
    /// The way of a move, if its axes move and their start is known.
    pub(super) fn of(mv: &Move) -> Option<Self> {
        let known = mv.moves_axes() && mv.unknown_start.is_empty();
        known.then_some(Self {
            start: mv.start,
            end: mv.end,
            arc: mv.arc,
        })
    }
}

/// Takes the rows of a report one by one.
pub trait RowSink: Send {
    /// Takes one row; an error stops the run.
    ///
    /// # Errors
    /// Whatever the writing gives.
    fn row(&mut self, row: &Row) -> io::Result<()>;

    /// The rows that follow are those of one program of several, by its place among them.
    fn begin_program(&mut self, _place: usize) {}

    /// Whether the figures of the rows count, all of which are exact then; otherwise peaks below
    /// those that matter need not be.
    fn wants_figures(&self) -> bool {
        true
    }
}

/// What is wanted of rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Detail {
    NoRows,
    /// What was done, without exact figures.
    Words,
    Figures,
}

impl Detail {
    pub(super) fn of(rows: Option<&(impl RowSink + ?Sized)>) -> Self {
        match rows {
            None => Self::NoRows,
            Some(rows) if rows.wants_figures() => Self::Figures,
            Some(_) => Self::Words,
        }
    }

    /// Whether there are rows.
    pub(super) fn has_rows(self) -> bool {
        self != Self::NoRows
    }

    /// What is wanted of moves, where there are no rows `otherwise`.
    pub(super) fn want(self, otherwise: Want) -> Want {
        if self == Self::Figures {
            Want::ALL
        } else {
            otherwise
        }
    }
}

/// Wants no rows.
impl RowSink for () {
    fn row(&mut self, _: &Row) -> io::Result<()> {
        Ok(())
    }
}
