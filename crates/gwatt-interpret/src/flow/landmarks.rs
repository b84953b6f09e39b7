//! What the lines of a text are to which programs of the ISG kernel, of OSP and of SINUMERIK go
//! on: programs, labels, and the parts of structures.

mod read;
mod rest;
mod siemens;

use std::collections::HashMap;

/// The landmarks of a text.
#[derive(Debug, Default)]
pub(super) struct Landmarks {
    /// In order of their lines.
    programs: Vec<Program>,
    /// Lines of each label (`N100`, `[NAME]`, `NLAP1`), in order.
    labels: HashMap<String, Vec<usize>>,
    parts: HashMap<usize, Part>,
    /// SINUMERIK: lines that begin with ENDLABEL.
    label_ends: Vec<usize>,
}

/// `%L NAME`, `%NAME`, `ONAME`, `%_N_NAME_SPF`.
#[derive(Debug)]
struct Program {
    line: usize,
    name: String,
    /// It is no subprogram.
    main: bool,
}

/// A line of a structure.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Part {
    /// Its first line, its last, and the next part of the same.
    pub(super) begin: usize,
    pub(super) end: usize,
    pub(super) next: usize,
    /// The next part is an $ELSEIF, a $CASE.
    pub(super) next_decides: bool,
    /// The loop or $SWITCH around a $BREAK, the loop around a $CONTINUE: its last
    /// line.
    pub(super) around: Option<usize>,
    /// The loop counts.
    pub(super) counts: bool,
}

impl Landmarks {
    /// The line where the main program begins: the first `%` line without L.
    pub(super) fn main(&self) -> Option<usize> {
        let main = self.programs.iter().find(|program| program.main);
        main.map(|program| program.line)
    }

    /// The line after the head of a subprogram, or of a main program (`main`).
    pub(super) fn program(&self, name: &str, main: bool) -> Option<usize> {
        let is_it = |program: &&Program| program.name == name && program.main == main;
        let found = self.programs.iter().find(is_it);
        found.map(|program| program.line + 1)
    }

    /// The lines of the program that a line belongs to.
    fn borders(&self, line: usize, len: usize) -> (usize, usize) {
        let next = self
            .programs
            .partition_point(|program| program.line <= line);
        let begin = next.checked_sub(1).and_then(|at| self.programs.get(at));
        (
            begin.map_or(0, |program| program.line + 1),
            self.programs.get(next).map_or(len, |program| program.line),
        )
    }

    /// The first line of the program that `line` belongs to.
    pub(super) fn start(&self, line: usize) -> usize {
        self.borders(line, usize::MAX).0
    }

    /// The next line of a label after `line`.
    pub(super) fn forwards(&self, label: &str, line: usize, len: usize) -> Option<usize> {
        self.labelled(label, line + 1, self.borders(line, len).1)
    }

    /// The same, else the first in the program.
    pub(super) fn find(&self, label: &str, line: usize, len: usize) -> Option<usize> {
        let (begin, end) = self.borders(line, len);
        let next = self.labelled(label, line + 1, end);
        next.or_else(|| self.labelled(label, begin, end))
    }

    /// The first line of a label from `from` to before `to`.
    fn labelled(&self, label: &str, from: usize, to: usize) -> Option<usize> {
        first_in(self.labels.get(label)?, from, to)
    }

    /// The last line of a label before `line`, or that line itself.
    pub(super) fn backwards(&self, label: &str, line: usize) -> Option<usize> {
        let lines = self.labels.get(label)?;
        let next = lines.partition_point(|found| *found <= line);
        let found = lines.get(next.checked_sub(1)?).copied();
        found.filter(|found| *found >= self.start(line))
    }

    /// The first ENDLABEL from `from` to before `to`.
    pub(super) fn label_end(&self, from: usize, to: usize) -> Option<usize> {
        first_in(&self.label_ends, from, to)
    }

    pub(super) fn part(&self, line: usize) -> Option<Part> {
        self.parts.get(&line).copied()
    }
}

/// The first of these lines from `from` to before `to`.
fn first_in(lines: &[usize], from: usize, to: usize) -> Option<usize> {
    let next = lines.partition_point(|line| *line < from);
    lines.get(next).copied().filter(|line| *line < to)
}

/// Finds landmarks, line by line.
#[derive(Default)]
struct Survey {
    marks: Landmarks,
    /// Structures that are open.
    open: Vec<Open>,
    /// Inside `#COMMENT BEGIN`.
    comments: bool,
}

/// A structure that is open while the lines are read.
struct Open {
    kind: &'static str,
    begin: usize,
    /// Its lines so far, with whether each decides.
    parts: Vec<(usize, bool)>,
    /// $BREAK and $CONTINUE inside.
    leaves: Vec<usize>,
}

impl Survey {
    fn program(&mut self, line: usize, name: String, main: bool) {
        self.marks.programs.push(Program { line, name, main });
    }

    fn label(&mut self, name: String, line: usize) {
        self.marks.labels.entry(name).or_default().push(line);
    }

    fn begin(&mut self, kind: &'static str, line: usize) {
        self.open.push(Open {
            kind,
            begin: line,
            parts: vec![(line, false)],
            leaves: Vec::new(),
        });
    }

    /// What is open inside a structure of this kind, without an end, has none.
    fn close_inside(&mut self, kind: &str) {
        let around = self.open.iter().rposition(|open| open.kind == kind);
        self.open.truncate(around.map_or(0, |at| at + 1));
    }

    /// The structure of this kind ends; false where none is open.
    fn end(&mut self, kind: &str, end: usize) -> bool {
        self.close_inside(kind);
        let Some(open) = self.open.pop() else {
            return false;
        };
        let part = Part {
            begin: open.begin,
            end,
            next: end,
            counts: open.kind == "FOR",
            ..Part::default()
        };
        let mut next = (end, false);
        self.marks.parts.insert(end, part);
        for (line, decides) in open.parts.into_iter().rev() {
            let (next_line, next_decides) = std::mem::replace(&mut next, (line, decides));
            let part = Part {
                next: next_line,
                next_decides,
                ..part
            };
            self.marks.parts.insert(line, part);
        }
        for line in open.leaves {
            let part = Part {
                begin: open.begin,
                end,
                around: Some(end),
                ..Part::default()
            };
            self.marks.parts.insert(line, part);
        }
        true
    }
}
