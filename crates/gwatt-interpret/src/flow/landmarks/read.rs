//! How the landmarks of texts of the ISG kernel and of OSP are found.

use super::rest::Rest;
use super::{Landmarks, Survey};
use crate::flow::text::Text;

/// What ends each structure of the ISG kernel.
const ENDS: [(&str, &str); 6] = [
    ("IF", "ENDIF"),
    ("WHILE", "ENDWHILE"),
    ("FOR", "ENDFOR"),
    ("DO", "ENDDO"),
    ("REPEAT", "UNTIL"),
    ("SWITCH", "ENDSWITCH"),
];

impl Landmarks {
    pub(in crate::flow) fn of_isg(text: &Text) -> Self {
        let mut survey = Survey::default();
        for line in 0..text.len() {
            survey.isg_line(line, text.line(line));
        }
        survey.marks
    }

    pub(in crate::flow) fn of_osp(text: &Text) -> Self {
        let mut survey = Survey::default();
        for line in 0..text.len() {
            survey.osp_line(line, text.line(line));
        }
        survey.marks
    }
}

impl Survey {
    fn isg_line(&mut self, line: usize, text: &[u8]) {
        let upper = text.to_ascii_uppercase();
        if self.comments {
            self.comments = memchr::memmem::find(&upper, b"#COMMENT END").is_none();
            return;
        }
        let mut rest = Rest(text.trim_ascii_start());
        if rest.0.starts_with(b"%") {
            self.open.clear();
            let local = crate::isg::is_local(rest.0);
            rest.skip(1);
            if local {
                rest.skip(1);
            }
            let name = rest.run(|byte| !matches!(byte, b' ' | b'\t' | b'(' | b';'));
            self.program(line, name, !local);
            return;
        }
        if let Some(number) = front(&mut rest) {
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
            self.isg_structure(line, &word, &rest);
        } else if let Some(begin) = memchr::memmem::find(&upper, b"#COMMENT BEGIN") {
            let after = upper.get(begin..).unwrap_or_default();
            self.comments = memchr::memmem::find(after, b"#COMMENT END").is_none();
        }
    }

    fn isg_structure(&mut self, line: usize, word: &str, rest: &Rest<'_>) {
        let jumps = || memchr::memmem::find(&rest.0.to_ascii_uppercase(), b"$GOTO").is_some();
        match word {
            "BREAK" | "CONTINUE" => {
                let around =
                    self.open.iter_mut().rev().find(|open| {
                        open.kind != "IF" && (word == "BREAK" || open.kind != "SWITCH")
                    });
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
                self.close_inside(kind);
                if let Some(open) = self.open.last_mut() {
                    open.parts.push((line, matches!(word, "ELSEIF" | "CASE")));
                }
            }
            "IF" if jumps() => {}
            _ => {
                if let Some((kind, _)) = ENDS.iter().find(|(begin, _)| *begin == word) {
                    self.begin(kind, line);
                } else if let Some((kind, _)) = ENDS.iter().find(|(_, end)| *end == word) {
                    self.end(kind, line);
                }
            }
        }
    }

    /// `ONAME` and `NNAME` at the beginning of a line.
    fn osp_line(&mut self, line: usize, text: &[u8]) {
        let mut rest = Rest(text);
        rest.skip(0);
        rest.block_delete();
        let name = rest.run(u8::is_ascii_alphanumeric);
        match name.as_bytes() {
            [b'O', _, ..] => self.program(line, name, false),
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
}

/// Passes over block delete and block number; gives the number as `N10`.
fn front(rest: &mut Rest<'_>) -> Option<String> {
    rest.byte_order_mark();
    let mut number = None;
    for _ in 0..2 {
        rest.skip(0);
        rest.comment();
        rest.block_delete();
        if number.is_none() {
            number = rest.block_number(b"Nn");
            if number.is_some() && rest.0.starts_with(b":") {
                rest.skip(1);
            }
        }
    }
    number
}
