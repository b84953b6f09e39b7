//! How the landmarks of a text are found.

use super::{ENDS, Landmarks, Open, Part, Program, Rest, close_inside};
use crate::flow::text::Text;

impl Landmarks {
    pub(crate) fn new(text: &Text, dollar: bool) -> Self {
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
    pub(crate) fn main(&self) -> Option<usize> {
        let main = self.programs.iter().find(|program| !program.local);
        main.map(|program| program.line)
    }

    /// The line of a subprogram's head.
    pub(crate) fn program(&self, name: &str) -> Option<usize> {
        self.subs.get(&name.to_ascii_uppercase()).copied()
    }

    /// The line of a label in the program that `line` belongs to: the next one,
    /// else the first.
    pub(crate) fn find(&self, label: &str, line: usize, len: usize) -> Option<usize> {
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

    pub(crate) fn part(&self, line: usize) -> Option<Part> {
        self.parts.get(&line).copied()
    }
}
