//! What the lines of a text are to which programs of the ISG kernel and of OSP
//! go on: programs, labels, and the parts of structures.

mod read;

use std::collections::HashMap;

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
