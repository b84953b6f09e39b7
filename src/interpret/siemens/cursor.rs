//! A place in the text of a block, which moves on as the text is understood.

use crate::diagnostic::excerpt;
use crate::interpret::expression::Fault;
use crate::source::Span;

pub(super) type Outcome<T> = Result<T, Fault>;

/// A place in the text of a block. What follows `;` is not there.
#[derive(Debug, Clone)]
pub(super) struct Cursor<'t> {
    pub(super) text: &'t [u8],
    pub(super) at: usize,
    /// Brackets and signs inside one another.
    pub(super) depth: u32,
}

impl<'t> Cursor<'t> {
    pub(super) fn new(text: &'t [u8]) -> Self {
        Self {
            text,
            at: 0,
            depth: 0,
        }
    }

    /// The next byte behind blanks; it stays. `None` at the end of the block.
    pub(super) fn peek(&mut self) -> Option<u8> {
        loop {
            match self.text.get(self.at)? {
                b' ' | b'\t' => self.at += 1,
                b';' => return None,
                byte => return Some(*byte),
            }
        }
    }

    /// Takes `byte` if it is next.
    pub(super) fn take(&mut self, byte: u8) -> bool {
        let next = self.peek() == Some(byte);
        self.at += usize::from(next);
        next
    }

    /// `=` that is not `==`.
    pub(super) fn assigns(&mut self) -> bool {
        self.peek() == Some(b'=') && self.text.get(self.at + 1) != Some(&b'=')
    }

    /// The name that is next, upper case; empty where none begins. It stays.
    pub(super) fn name(&mut self) -> String {
        let begins = self
            .peek()
            .is_some_and(|byte| byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$'));
        if !begins {
            return String::new();
        }
        let rest = self.text.get(self.at..).unwrap_or_default();
        let length = rest
            .iter()
            .enumerate()
            .take_while(|(index, byte)| {
                byte.is_ascii_alphanumeric() || **byte == b'_' || (*index == 0 && **byte == b'$')
            })
            .count();
        String::from_utf8_lossy(rest.get(..length).unwrap_or_default()).to_ascii_uppercase()
    }

    /// Takes a name if it is next, as a whole.
    pub(super) fn take_name(&mut self, name: &str) -> bool {
        let next = self.name() == name;
        self.at += if next { name.len() } else { 0 };
        next
    }

    /// An unsigned number, with `EX` before its exponent.
    pub(super) fn number(&mut self) -> Outcome<f64> {
        self.peek();
        let start = self.at;
        let digits = |cursor: &mut Self| {
            while cursor.text.get(cursor.at).is_some_and(u8::is_ascii_digit) {
                cursor.at += 1;
            }
        };
        digits(self);
        if self.text.get(self.at) == Some(&b'.') {
            self.at += 1;
            digits(self);
        }
        let mut text =
            String::from_utf8_lossy(self.text.get(start..self.at).unwrap_or_default()).into_owned();
        let exponent = self.text.get(self.at..self.at + 2);
        if exponent.is_some_and(|letters| letters.eq_ignore_ascii_case(b"EX")) {
            self.at += 2;
            let from = self.at;
            if matches!(self.text.get(self.at), Some(b'+' | b'-')) {
                self.at += 1;
            }
            digits(self);
            text.push('e');
            text.push_str(&String::from_utf8_lossy(
                self.text.get(from..self.at).unwrap_or_default(),
            ));
        }
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let shown = excerpt(self.text.get(start..self.at).unwrap_or_default(), 40);
                Err(self.fault(
                    "expression",
                    format!("`{shown}` is not a number"),
                    "write digits with at most one point",
                    start,
                ))
            }
        }
    }

    /// A text in quotes, without them.
    pub(super) fn quoted(&mut self) -> Outcome<String> {
        self.peek();
        let start = self.at;
        let inside = self.text.get(start + 1..).unwrap_or_default();
        let Some(length) = memchr::memchr(b'"', inside) else {
            let message = "a text in quotes is not closed";
            return Err(self.fault("expression", message, "write a second `\"`", start));
        };
        self.at = start + length + 2;
        Ok(String::from_utf8_lossy(inside.get(..length).unwrap_or_default()).into_owned())
    }

    /// Passes over `( … )`, whatever it holds.
    pub(super) fn pass_over_parentheses(&mut self) -> Outcome<()> {
        if self.peek() != Some(b'(') {
            return Ok(());
        }
        let start = self.at;
        let mut depth = 0_usize;
        while let Some(byte) = self.text.get(self.at) {
            match byte {
                b'"' => {
                    self.quoted()?;
                    continue;
                }
                b'(' => depth += 1,
                b')' => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                return Ok(());
            }
        }
        Err(self.missing(")", start))
    }

    /// Passes over the rest of the block.
    pub(super) fn pass_over_rest(&mut self) {
        while self.peek().is_some() {
            self.at += 1;
        }
    }

    /// `byte` must be next.
    pub(super) fn expect(&mut self, byte: u8) -> Outcome<()> {
        if self.take(byte) {
            return Ok(());
        }
        let at = self.at;
        Err(self.missing(char::from(byte).encode_utf8(&mut [0; 4]), at))
    }

    fn missing(&self, what: &str, at: usize) -> Fault {
        let help = "close each bracket, and write operators between values";
        self.fault("expression", format!("`{what}` is missing here"), help, at)
    }

    /// A fault of what stands from `start` to the place.
    pub(super) fn fault(
        &self,
        rule: &'static str,
        message: impl Into<String>,
        help: &'static str,
        start: usize,
    ) -> Fault {
        Fault::new(rule, message, help, self.span(start))
    }

    /// What stands from `start` to the place; a byte at least.
    pub(super) fn span(&self, start: usize) -> Span {
        let end = self.end().max(start + 1).min(self.text.len());
        Span::new(start.min(end), end)
    }

    /// The place without the blanks before it.
    pub(super) fn end(&self) -> usize {
        let before = self.text.get(..self.at).unwrap_or(self.text);
        before.trim_ascii_end().len()
    }
}
