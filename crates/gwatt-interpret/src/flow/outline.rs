//! What the lines of a SINUMERIK text are, as far as the order of execution
//! goes: programs, labels, block numbers, and the partners of structures.

mod read;

use std::collections::HashMap;

/// The outline of a text.
#[derive(Debug, Default)]
pub(super) struct Outline {
    /// `%_N_NAME_SPF` lines with their names, in order.
    programs: Vec<(usize, String)>,
    /// Those of them that are no subprograms: `%_N_NAME_MPF`.
    mains: Vec<usize>,
    /// Lines of each label and block number (`N10`), in order.
    labels: HashMap<String, Vec<usize>>,
    /// Where a structure goes on: IF to its ELSE or ENDIF, ELSE to ENDIF, the
    /// beginning of a loop to its end and back.
    partners: HashMap<usize, usize>,
    /// Lines that begin with ENDLABEL.
    label_ends: Vec<usize>,
    /// FOR lines.
    counting: Vec<usize>,
}

/// Structures that are open while the lines are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Open {
    If,
    While,
    For,
    Loop,
    Repeat,
}

/// Whether a header is that of a main program.
fn is_main(line: &[u8]) -> bool {
    let line = line.trim_ascii().to_ascii_uppercase();
    let name = line.strip_prefix(b"%_N_").unwrap_or_default();
    let inside = |byte: &&u8| byte.is_ascii_alphanumeric() || **byte == b'_';
    let end = name.iter().take_while(inside).count();
    name.get(..end).is_some_and(|name| name.ends_with(b"_MPF"))
}

/// The name in `%_N_NAME_MPF`, upper case.
fn program_name(line: &[u8]) -> Option<String> {
    let line = line.trim_ascii().to_ascii_uppercase();
    let name = line.strip_prefix(b"%_N_")?;
    let end = name
        .iter()
        .position(|byte| !(byte.is_ascii_alphanumeric() || *byte == b'_'));
    let name = name.get(..end.unwrap_or(name.len()))?;
    let name = name
        .strip_suffix(b"_SPF")
        .or_else(|| name.strip_suffix(b"_MPF"))
        .unwrap_or(name);
    Some(String::from_utf8_lossy(name).into_owned())
}

/// What is left of a line.
struct Rest<'t>(&'t [u8]);

impl Rest<'_> {
    fn skip(&mut self, count: usize) {
        self.0 = self.0.get(count..).unwrap_or_default().trim_ascii_start();
    }

    fn digits(&self) -> usize {
        self.0
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count()
    }

    /// Block delete and block number; gives the number as `N10`.
    fn front(&mut self) -> Option<String> {
        self.skip(0);
        if let Some(rest) = self.0.strip_prefix(b"\xEF\xBB\xBF") {
            self.0 = rest;
            self.skip(0);
        }
        if self.0.first() == Some(&b'/') {
            self.skip(1);
            self.skip(self.digits());
        }
        if !matches!(self.0.first(), Some(b'N' | b'n' | b':')) {
            return None;
        }
        let mut rest = Rest(self.0);
        rest.skip(1);
        let length = rest.digits();
        let digits = std::str::from_utf8(rest.0.get(..length)?).ok()?;
        let number: u64 = digits.parse().ok()?;
        rest.skip(length);
        self.0 = rest.0;
        if self.0.first() == Some(&b'/') {
            self.skip(1);
            self.skip(self.digits());
        }
        Some(format!("N{number}"))
    }

    /// A name, upper case; empty where none is next.
    fn name(&mut self) -> String {
        if !self
            .0
            .first()
            .is_some_and(|byte| byte.is_ascii_alphabetic() || *byte == b'_')
        {
            return String::new();
        }
        let plain = |byte: &&u8| byte.is_ascii_alphanumeric() || **byte == b'_';
        let length = self.0.iter().take_while(plain).count();
        let name = self.0.get(..length).unwrap_or_default();
        let name = String::from_utf8_lossy(name).to_ascii_uppercase();
        self.skip(length);
        name
    }

    fn label(&mut self) -> Option<String> {
        let before = self.0;
        let name = self.name();
        if !name.is_empty() && self.0.first() == Some(&b':') {
            self.skip(1);
            return Some(name);
        }
        self.0 = before;
        None
    }

    /// Whether a GOTO follows, outside quotes and comments.
    fn jumps(&self) -> bool {
        let mut rest = Rest(self.0);
        let mut quoted = false;
        while let Some(&byte) = rest.0.first() {
            if byte == b'"' {
                quoted = !quoted;
            } else if byte == b';' && !quoted {
                return false;
            } else if !quoted && (byte.is_ascii_alphabetic() || byte == b'_') {
                if rest.name().starts_with("GOTO") {
                    return true;
                }
                continue;
            }
            rest.0 = rest.0.get(1..).unwrap_or_default();
        }
        false
    }
}
