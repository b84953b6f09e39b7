//! What the lines of a text are to which programs of the ISG kernel and of OSP
//! go on: programs, labels, and the parts of structures.

use std::collections::HashMap;

use super::text::Text;

/// The landmarks of a text.
#[derive(Debug, Default)]
pub(super) struct Landmarks {
    /// Where programs begin, in order: the line of `%L NAME`, `%NAME` or
    /// `ONAME`.
    programs: Vec<Program>,
    /// Lines of the heads of subprograms, by name; the first counts.
    subs: HashMap<String, usize>,
    /// Lines of each label (`N100`, `[NAME]`, `NLAP1`), in order.
    labels: HashMap<String, Vec<usize>>,
    parts: HashMap<usize, Part>,
}

#[derive(Debug)]
struct Program {
    line: usize,
    /// `%L`.
    local: bool,
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

/// A structure that is open while the lines are read.
struct Open {
    kind: &'static str,
    begin: usize,
    /// Its lines so far, with whether each decides.
    parts: Vec<(usize, bool)>,
    /// $BREAK and $CONTINUE inside, with which of them it is.
    leaves: Vec<usize>,
}

/// What ends each structure.
const ENDS: [(&str, &str); 6] = [
    ("IF", "ENDIF"),
    ("WHILE", "ENDWHILE"),
    ("FOR", "ENDFOR"),
    ("DO", "ENDDO"),
    ("REPEAT", "UNTIL"),
    ("SWITCH", "ENDSWITCH"),
];

impl Landmarks {
    pub(super) fn new(text: &Text, dollar: bool) -> Self {
        let mut marks = Self::default();
        let mut open = Vec::new();
        let mut comments = false;
        for line in 0..text.len() {
            if dollar {
                marks.dollar_line(line, text.line(line), &mut open, &mut comments);
            } else {
                marks.osp_line(line, text.line(line));
            }
        }
        marks
    }

    fn dollar_line(&mut self, line: usize, text: &[u8], open: &mut Vec<Open>, comments: &mut bool) {
        let upper = text.to_ascii_uppercase();
        if *comments {
            *comments = memchr::memmem::find(&upper, b"#COMMENT END").is_none();
            return;
        }
        let mut rest = Rest(text.trim_ascii_start());
        if rest.0.starts_with(b"%") {
            open.clear();
            let local = crate::isg::is_local(rest.0);
            rest.skip(1);
            if local {
                rest.skip(1);
            }
            let name = rest.run(|byte| !matches!(byte, b' ' | b'\t' | b'(' | b';'));
            self.program_head(line, name, local);
            return;
        }
        if let Some(number) = rest.front() {
            self.label(number, line);
        }
        if rest.0.starts_with(b"[")
            && let Some(end) = memchr::memchr(b']', rest.0)
        {
            let name = rest.0.get(1..end).unwrap_or_default().trim_ascii();
            let label = format!("[{}]", String::from_utf8_lossy(name));
            self.label(label, line);
            rest.skip(end + 1);
        }
        rest.comment();
        if rest.0.starts_with(b"$") {
            rest.skip(1);
            let word = rest.run(u8::is_ascii_alphabetic);
            self.structure(line, &word, &rest, open);
        } else if let Some(begin) = memchr::memmem::find(&upper, b"#COMMENT BEGIN") {
            let after = upper.get(begin..).unwrap_or_default();
            *comments = memchr::memmem::find(after, b"#COMMENT END").is_none();
        }
    }

    fn program_head(&mut self, line: usize, name: String, local: bool) {
        self.programs.push(Program { line, local });
        if local {
            self.subs.entry(name).or_insert(line);
        }
    }

    fn label(&mut self, name: String, line: usize) {
        self.labels.entry(name).or_default().push(line);
    }

    fn structure(&mut self, line: usize, word: &str, rest: &Rest<'_>, open: &mut Vec<Open>) {
        let jumps = || memchr::memmem::find(&rest.0.to_ascii_uppercase(), b"$GOTO").is_some();
        match word {
            "BREAK" | "CONTINUE" => {
                let around = open
                    .iter_mut()
                    .rev()
                    .find(|open| open.kind != "IF" && (word == "BREAK" || open.kind != "SWITCH"));
                if let Some(open) = around {
                    open.leaves.push(line);
                }
            }
            "ELSEIF" | "ELSE" | "CASE" | "DEFAULT" => {
                let kind = if word.starts_with('E') {
                    "IF"
                } else {
                    "SWITCH"
                };
                close_inside(open, kind);
                if let Some(open) = open.last_mut() {
                    open.parts.push((line, matches!(word, "ELSEIF" | "CASE")));
                }
            }
            "IF" if jumps() => {}
            _ => {
                if let Some((kind, _)) = ENDS.iter().find(|(begin, _)| *begin == word) {
                    open.push(Open {
                        kind,
                        begin: line,
                        parts: vec![(line, false)],
                        leaves: Vec::new(),
                    });
                } else if let Some((kind, _)) = ENDS.iter().find(|(_, end)| *end == word) {
                    close_inside(open, kind);
                    if let Some(structure) = open.pop() {
                        self.close(line, &structure);
                    }
                }
            }
        }
    }

    fn close(&mut self, end: usize, open: &Open) {
        let counts = open.kind == "FOR";
        let lines = open.parts.iter().copied().chain([(end, false)]);
        let mut next = None;
        for (line, decides) in lines.rev() {
            let (next_line, next_decides) = next.unwrap_or((end, false));
            self.parts.insert(
                line,
                Part {
                    begin: open.begin,
                    end,
                    next: next_line,
                    next_decides,
                    around: None,
                    counts,
                },
            );
            next = Some((line, decides));
        }
        for &line in &open.leaves {
            let part = Part {
                begin: open.begin,
                end,
                around: Some(end),
                ..Part::default()
            };
            self.parts.insert(line, part);
        }
    }

    /// `ONAME` and `NNAME` at the beginning of a line.
    fn osp_line(&mut self, line: usize, text: &[u8]) {
        let mut rest = Rest(text);
        rest.skip(0);
        if rest.0.starts_with(b"/") {
            rest.skip(1);
            rest.digits();
        }
        let name = rest.run(u8::is_ascii_alphanumeric);
        match name.as_bytes() {
            [b'O', _, ..] => self.program_head(line, name, true),
            [b'N', _, ..] => {
                // `N0010` and `N10` are one number.
                let digits = name.get(1..).unwrap_or_default();
                let label = match digits.parse::<u64>() {
                    Ok(number) => format!("N{number}"),
                    Err(_) => name,
                };
                self.label(label, line);
            }
            _ => {}
        }
    }

    /// The line where the main program begins: the first `%` line without L.
    pub(super) fn main(&self) -> Option<usize> {
        let main = self.programs.iter().find(|program| !program.local);
        main.map(|program| program.line)
    }

    /// The line of a subprogram's head.
    pub(super) fn program(&self, name: &str) -> Option<usize> {
        self.subs.get(&name.to_ascii_uppercase()).copied()
    }

    /// The line of a label in the program that `line` belongs to: the next one,
    /// else the first.
    pub(super) fn find(&self, label: &str, line: usize, len: usize) -> Option<usize> {
        let next = self
            .programs
            .partition_point(|program| program.line <= line);
        let begin = next.checked_sub(1).and_then(|at| self.programs.get(at));
        let begin = begin.map_or(0, |program| program.line);
        let end = self.programs.get(next).map_or(len, |program| program.line);
        let lines = self.labels.get(label)?;
        let from = |line: usize| {
            let next = lines.partition_point(|found| *found < line);
            lines.get(next).copied().filter(|found| *found < end)
        };
        from(line + 1).or_else(|| from(begin))
    }

    pub(super) fn part(&self, line: usize) -> Option<Part> {
        self.parts.get(&line).copied()
    }
}

/// What is open inside a structure of this kind, without an end, has none.
fn close_inside(open: &mut Vec<Open>, kind: &str) {
    if open.iter().any(|open| open.kind == kind) {
        while open.last().is_some_and(|open| open.kind != kind) {
            open.pop();
        }
    } else {
        open.clear();
    }
}

/// What is left of a line.
struct Rest<'t>(&'t [u8]);

impl Rest<'_> {
    fn skip(&mut self, count: usize) {
        self.0 = self.0.get(count..).unwrap_or_default().trim_ascii_start();
    }

    /// Takes bytes for which `inside` holds, upper case.
    fn run(&mut self, inside: impl Fn(&u8) -> bool) -> String {
        let text = self.0.trim_ascii_end();
        let length = text.iter().take_while(|byte| inside(byte)).count();
        let taken = String::from_utf8_lossy(text.get(..length).unwrap_or_default());
        let taken = taken.to_ascii_uppercase();
        self.skip(length);
        taken
    }

    fn digits(&mut self) -> String {
        self.run(u8::is_ascii_digit)
    }

    fn comment(&mut self) {
        while self.0.starts_with(b"(") {
            let end = memchr::memchr(b')', self.0).unwrap_or(self.0.len());
            self.skip(end + 1);
        }
    }

    /// Block delete and block number; gives the number as `N10`.
    fn front(&mut self) -> Option<String> {
        if let Some(rest) = self.0.strip_prefix(b"\xEF\xBB\xBF") {
            self.0 = rest;
        }
        let mut number = None;
        for _ in 0..2 {
            self.skip(0);
            self.comment();
            if self.0.starts_with(b"/") {
                self.skip(1);
                self.digits();
            }
            if number.is_none() && matches!(self.0.first(), Some(b'N' | b'n')) {
                let before = self.0;
                self.skip(1);
                let digits = self.digits();
                if let Ok(value) = digits.parse::<u64>() {
                    number = Some(format!("N{value}"));
                    if self.0.starts_with(b":") {
                        self.skip(1);
                    }
                } else {
                    self.0 = before;
                }
            }
        }
        number
    }
}
