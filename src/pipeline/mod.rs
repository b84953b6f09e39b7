//! From bytes to figures, and from bytes to a certified program.

mod advice;
mod analyze;
mod assumptions;
mod batch;
mod by_line;
mod certify;
mod conclusion;
mod conditions;
mod decision;
mod describe;
mod drive;
mod drives;
mod each_move;
mod ends;
mod entry;
mod expand;
mod expected;
mod executor;
mod hints;
mod ideal;
mod judge;
mod limiting;
mod line_count;
mod line_key;
mod left_feed;
mod derate;
mod motion;
mod options;
mod outcome;
mod own_steps;
mod over_time;
mod pace;
mod pause;
mod preset_notes;
mod price;
mod quoted;
mod readable;
mod worker;
mod restart;
mod rounds;
mod row;
mod schedule;
mod series;
mod series_volts;
mod source;
mod set;
pub mod size;
mod spindle;
mod spindle_rows;
mod split;
mod stop_before;
mod stops;
mod strategy;
mod summary;
mod table;
mod totals;
mod unmarked;
mod untouched;
mod watching;
mod ways;
mod within;
mod word_choice;
mod looped_program;
mod worst;
mod writer;

pub use analyze::{analyze, called_files, moves};
pub use assumptions::assumptions;
pub use by_line::LineSummary;
pub use drives::{
    Done, DriveCommand, DriveId, DriveSample, DriveSchedule, DrivesSample, DrivesSummary, For,
    run_drives,
};
pub use each_move::Moves;
pub use hints::{as_advised, take_hints};
pub use ideal::ideal;
pub use limiting::limit;
pub use line_count::LineCount;
pub use motion::{MotionNotes, Stretch, motion};
pub use options::{
    Allowed, Law, LimitOptions, Limits, Options, PresetElse, RapidMark, RapidMarkError, Reading,
    Start, Strategy,
};
pub use outcome::{Ideal, Pause, Price};
pub use over_time::OverTime;
pub use price::price;
pub use restart::{Restart, RestartRows};
pub use row::{Certificate, Route, Row, RowSink};
pub use schedule::{Command, Schedule};
pub use series::{SeriesSink, series};
pub use set::{SetFailure, SetFile, SetProgram, SetSummary, limit_set};
pub use spindle::{Change, Sample, SpindleSummary, run_schedule};
pub use summary::{LimitSummary, Summary, Unfit};

use crate::diagnostic::Diagnostic;

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
