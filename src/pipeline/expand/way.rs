//! Which lines are asked to be written in another way, and how.

use std::collections::BTreeMap;

use crate::diagnostic::Diagnostic;

/// How the moves of canned cycles are made known to the limiter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::pipeline) enum Way {
    /// The way to each hole stands on a line of its own.
    Placed,
    /// All moves do.
    WrittenOut,
}

/// Lines that are asked to be written in another way.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(in crate::pipeline) struct LineWays {
    /// All of the program and its files.
    all: Option<Way>,
    /// Of the program itself, and of files of subprograms by their names.
    lines: BTreeMap<(Option<String>, u64), Way>,
}

impl LineWays {
    /// Asks for the lines of these reasons.
    pub(in crate::pipeline) fn extend(&mut self, reasons: &[Diagnostic], way: Way) {
        let lines = reasons.iter().map(|it| ((it.file.clone(), it.line), way));
        self.lines.extend(lines);
    }

    /// The same for all lines, or for none but those.
    pub(in crate::pipeline) fn set_all(&mut self, way: Option<Way>) {
        self.all = way;
    }

    /// Whether nothing is asked for.
    pub(in crate::pipeline) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// How a line is to be written, of a file of that name or of the program itself.
    pub(super) fn way(&self, file: Option<&str>, line: u64) -> Option<Way> {
        self.all.or_else(|| {
            let key = (file.map(str::to_owned), line);
            self.lines.get(&key).copied()
        })
    }
}
