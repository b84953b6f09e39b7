//! What a run is asked to do.

pub use crate::interpret::{Limits, Reading, Start};

use super::line_count::LineCount;
use super::row::Certificate;
pub use crate::limit::{Allowed, Law, LimitOptions, PresetElse, Strategy};
use crate::machine::Machine;
use crate::rewrite::Comment;
pub use crate::rewrite::{RapidMark, RapidMarkError};

/// How a program is read and judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// How the program is to be read.
    pub reading: Reading,
    /// The certificate asked for; `None`: planned where the controller's
    /// planner is modelled, else robust.
    pub certificate: Option<Certificate>,
    /// The program runs once; limits over time need not allow an immediate repeat.
    pub once: bool,
    /// Of `limit` alone: feeds that it writes in place of rapids get a comment that says
    /// so, and feeds with this comment are taken for what it says: their F may be lowered
    /// like that of a rapid. `None`: comments say nothing.
    pub rapid_mark: Option<RapidMark>,
    /// Threads that one program may use, at least 1.
    pub threads: usize,
    /// Counts the lines that are executed.
    pub count: Option<LineCount>,
}

impl Options {
    /// The comment of a feed that stands for a rapid, as a control has it.
    pub(super) fn comment(&self, machine: &Machine) -> Option<Comment> {
        let mark = self.rapid_mark.as_ref()?;
        Some(mark.comment(&machine.controller.language))
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            reading: Reading::default(),
            certificate: None,
            once: false,
            rapid_mark: None,
            threads: 1,
            count: None,
        }
    }
}
