//! Which lines may not run: those in blocks of `if` and `while`, and files that are called there.
//!
//! Source: Duet documentation, "`GCode` Meta Commands": a block is what is indented more.

use crate::text::Place;

/// Columns of a tab.
const TAB: usize = 4;

/// A file while it is read.
struct Frame {
    file: String,
    /// The line that calls it may not run.
    is_unsure: bool,
    /// Indents of the lines whose blocks are open.
    open: Vec<usize>,
}

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Line {
    /// It begins a block, or is empty.
    Bare,
    /// It runs.
    Sure,
    /// It may run.
    Unsure,
}

/// Files that call each other, with the blocks that are open.
#[derive(Default)]
pub(super) struct Blocks {
    frames: Vec<Frame>,
}

impl Blocks {
    /// What the next line is.
    pub(super) fn next(&mut self, place: &Place<'_>) -> Line {
        let line = place.line();
        let trimmed = line.trim_start();
        if trimmed.is_empty() || trimmed.starts_with(';') {
            return Line::Bare;
        }
        let Some(frame) = self.frame(place.file()) else {
            return Line::Unsure;
        };
        let indent = indent(line);
        while frame.open.last().is_some_and(|open| *open >= indent) {
            frame.open.pop();
        }
        let is_unsure = frame.is_unsure || !frame.open.is_empty();
        let word = trimmed.split(|c: char| !c.is_ascii_alphabetic()).next();
        if matches!(word, Some("if" | "elif" | "else" | "while")) {
            frame.open.push(indent);
            return Line::Bare;
        }
        if is_unsure { Line::Unsure } else { Line::Sure }
    }

    /// That of a file, which may be called by the one before, or go on after a call.
    fn frame(&mut self, file: &str) -> Option<&mut Frame> {
        if let Some(known) = self.frames.iter().rposition(|frame| frame.file == file) {
            self.frames.truncate(known + 1);
        } else {
            let caller = self.frames.last();
            let is_unsure = caller.is_some_and(|it| it.is_unsure || !it.open.is_empty());
            self.frames.push(Frame {
                file: file.to_owned(),
                is_unsure,
                open: Vec::new(),
            });
        }
        self.frames.last_mut()
    }
}

fn indent(line: &str) -> usize {
    let blanks = line.chars().take_while(|c| c.is_whitespace());
    blanks.fold(0, |columns, c| match c {
        '\t' => (columns / TAB + 1) * TAB,
        _ => columns + 1,
    })
}
