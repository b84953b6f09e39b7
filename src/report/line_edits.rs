//! What is put in place of lines of a program.

use std::io;
use std::str;

use super::patch::{Differences, compare_texts};

/// Lines that others stand for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineEdit {
    /// The first of them, from 1; the line that new ones stand before, where there are none.
    pub first: u64,
    /// How many there are; 0 where lines are put in.
    pub count: u64,
    /// Characters of the last of them, without its line end.
    pub last_chars: u64,
    /// What stands there now: without the end of its last line, unless lines are put in.
    pub text: String,
}

/// Edits that would help nobody, for their number.
const EDITS_MAX: usize = 1000;

/// What turns `old` into `new`, line by line; `None` where a changed line is not UTF-8, where
/// lines are only added after the last one or taken out, or for more than a thousand edits.
#[must_use]
pub fn line_edits(old: &[u8], new: &[u8]) -> Option<Vec<LineEdit>> {
    let mut found = Found {
        line: 1,
        ..Found::default()
    };
    compare_texts(old, new, &mut found).ok()?;
    if !found.added.is_empty() && found.removed.is_empty() {
        // Added after the last line.
        return None;
    }
    found.close();
    (!found.lost && found.edits.len() <= EDITS_MAX).then_some(found.edits)
}

/// Edits as they are found.
#[derive(Debug, Default)]
struct Found {
    edits: Vec<LineEdit>,
    /// The next line of the old text.
    line: u64,
    removed: Vec<Vec<u8>>,
    added: Vec<Vec<u8>>,
    /// A change could not be said.
    lost: bool,
}

impl Found {
    /// Makes an edit of what differs at this place.
    fn close(&mut self) {
        let removed = std::mem::take(&mut self.removed);
        let added = std::mem::take(&mut self.added);
        if removed.is_empty() && added.is_empty() || self.edits.len() > EDITS_MAX {
            return;
        }
        let texts: Option<Vec<&str>> = added.iter().map(|line| str::from_utf8(line).ok()).collect();
        let last = removed.last().map(|line| str::from_utf8(line).ok());
        let (Some(texts), None | Some(Some(_))) = (texts, last) else {
            self.lost = true;
            return;
        };
        let last = last.flatten().map_or("", without_end);
        let whole = texts.concat();
        let ends = |line: Option<&Vec<u8>>| line.map(|it| line_end(it).to_vec());
        let same_end = removed.is_empty() || ends(removed.last()) == ends(added.last());
        self.lost |= added.is_empty() || !same_end;
        let text = if removed.is_empty() {
            &whole
        } else {
            without_end(&whole)
        };
        self.edits.push(LineEdit {
            first: self.line - removed.len() as u64,
            count: removed.len() as u64,
            last_chars: last.chars().count() as u64,
            text: text.to_owned(),
        });
    }
}

/// The end of a line.
fn line_end(line: &[u8]) -> &[u8] {
    let start = line.iter().rposition(|byte| !matches!(byte, b'\r' | b'\n'));
    line.get(start.map_or(0, |last| last + 1)..)
        .unwrap_or_default()
}

/// A line without its end.
fn without_end(line: &str) -> &str {
    let line = line.strip_suffix('\n').unwrap_or(line);
    line.strip_suffix('\r').unwrap_or(line)
}

impl Differences for Found {
    fn keep(&mut self, _: Vec<u8>) -> io::Result<()> {
        self.close();
        self.line += 1;
        Ok(())
    }

    fn change(&mut self, sign: u8, line: Vec<u8>) -> io::Result<()> {
        if sign == b'-' {
            self.line += 1;
            self.removed.push(line);
        } else {
            self.added.push(line);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{LineEdit, line_edits};

    fn edit(first: u64, count: u64, last_chars: u64, text: &str) -> LineEdit {
        LineEdit {
            first,
            count,
            last_chars,
            text: text.to_owned(),
        }
    }

    #[test]
    fn lines_are_replaced_and_put_in() {
        let old = "G0 X1\r\nM5\r\n(ä) G0 X2\r\nM30";
        let new = "G1 X1 F5\r\nM5\r\nG4\r\n(ä) G1 X2\r\nG0 F1\r\nM30";
        let found = line_edits(old.as_bytes(), new.as_bytes());
        let two = vec![
            edit(1, 1, 5, "G1 X1 F5"),
            edit(3, 1, 9, "G4\r\n(ä) G1 X2\r\nG0 F1"),
        ];
        assert_eq!(found, Some(two));
        let found = line_edits(b"A\nB\n", b"A\nC\nB\n");
        assert_eq!(found, Some(vec![edit(2, 0, 0, "C\n")]));
        assert_eq!(line_edits(b"A\n", b"A\n"), Some(vec![]));
    }

    #[test]
    fn what_cannot_be_said_is_left_out() {
        assert_eq!(line_edits(b"G0 (\xe4)\n", b"G1 (\xe4)\n"), None);
        assert_eq!(line_edits(b"A\n", b"A\nB\n"), None);
        assert_eq!(line_edits(b"A\nB\n", b"A\n"), None);
        let many = |text: &str| format!("{text}\nkept\n").repeat(1001);
        assert_eq!(line_edits(many("a").as_bytes(), many("b").as_bytes()), None);
    }

    /// The text after edits, made as a reader of SARIF makes it.
    fn applied(old: &str, edits: &[LineEdit]) -> String {
        let mut lines: Vec<String> = old.split_inclusive('\n').map(str::to_owned).collect();
        for edit in edits.iter().rev() {
            let first = edit.first as usize - 1;
            if edit.count == 0 {
                lines.insert(first, edit.text.clone());
                continue;
            }
            let last = first + edit.count as usize - 1;
            let rest: String = lines[last].chars().skip(edit.last_chars as usize).collect();
            lines.splice(first..=last, [format!("{}{rest}", edit.text)]);
        }
        lines.concat()
    }

    proptest! {
        #[test]
        fn edits_make_the_new_text(kinds in prop::collection::vec(0..4u8, 1..60)) {
            let (mut old, mut new) = (String::new(), String::new());
            for (number, kind) in kinds.iter().enumerate() {
                let line = format!("X{number} ü\n");
                old += &line;
                let changed = match kind {
                    0 => format!("G1 {line}"),
                    1 => format!("G4\n{line}"),
                    2 => format!("G1 {line}G0 F{number}\n"),
                    _ => line,
                };
                new.push_str(&changed);
            }
            old += "M30\n";
            new += "M30\n";
            let edits = line_edits(old.as_bytes(), new.as_bytes()).unwrap();
            prop_assert_eq!(applied(&old, &edits), new);
        }
    }
}
