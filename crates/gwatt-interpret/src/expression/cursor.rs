//! A place in the text of a block, which moves on as the text is understood.

use super::fault::{Fault, Outcome};
use super::ident::Ident;
use gwatt_syntax::diagnostic::excerpt;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Word};

/// Most words of a block.
const WORDS_MAX: usize = 256;

/// What a language writes in a way of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lexis {
    /// `( … )` is a comment.
    Comments,
    /// RS274/NGC and Fanuc: the same, and blanks may stand in a name.
    Blanks,
    /// SINUMERIK: `( … )` belongs to expressions, names also begin with `$` or
    /// `_`, and `EX` stands before the exponent of a number.
    Sinumerik,
}

/// A place in the text of a block. Comments are not there.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'t> {
    pub(crate) text: &'t [u8],
    pub(crate) at: usize,
    /// Brackets and signs inside one another.
    pub(crate) depth: u32,
    lexis: Lexis,
}

impl<'t> Cursor<'t> {
    pub(crate) fn new(text: &'t [u8], lexis: Lexis) -> Self {
        Self {
            text,
            at: 0,
            depth: 0,
            lexis,
        }
    }

    /// The next byte after blanks and comments, upper case; it stays. `None` at the end.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        loop {
            match self.text.get(self.at)? {
                b' ' | b'\t' => self.at += 1,
                b';' => return None,
                b'(' if self.lexis != Lexis::Sinumerik => {
                    let rest = self.text.get(self.at..)?;
                    self.at += match memchr::memchr(b')', rest) {
                        Some(end) => end + 1,
                        None if self.lexis == Lexis::Blanks => return None,
                        None => rest.len(),
                    };
                }
                byte => return Some(byte.to_ascii_uppercase()),
            }
        }
    }

    /// The byte at the place itself, upper case; 0 at the end.
    pub(crate) fn byte(&self, ahead: usize) -> u8 {
        let byte = self.text.get(self.at + ahead).copied();
        byte.unwrap_or_default().to_ascii_uppercase()
    }

    /// Takes `byte` if it is next.
    pub(crate) fn take(&mut self, byte: u8) -> bool {
        let next = self.peek() == Some(byte);
        self.at += usize::from(next);
        next
    }

    /// `=` that is not `==`.
    pub(crate) fn assigns(&mut self) -> bool {
        self.peek() == Some(b'=') && self.byte(1) != b'='
    }

    /// The name that is next, upper case; empty where none begins. It stays.
    pub(crate) fn name(&mut self) -> Ident {
        let marks = self.lexis == Lexis::Sinumerik;
        let begins = |byte: u8| byte.is_ascii_alphabetic() || marks && matches!(byte, b'_' | b'$');
        let begins = self.peek().is_some_and(begins);
        if !begins {
            return Ident::new(&[]);
        }
        let rest = self.text.get(self.at..).unwrap_or_default();
        let inside = |byte: &&u8| byte.is_ascii_alphanumeric() || **byte == b'_';
        let length = 1 + rest.iter().skip(1).take_while(inside).count();
        Ident::new(rest.get(..length).unwrap_or_default())
    }

    /// Takes a name if it is next, as a whole.
    pub(crate) fn take_name(&mut self, name: &str) -> bool {
        self.peek();
        let rest = self.text.get(self.at..).unwrap_or_default();
        let inside = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        let next = rest
            .get(..name.len())
            .is_some_and(|text| text.eq_ignore_ascii_case(name.as_bytes()))
            && !rest.get(name.len()).is_some_and(inside);
        self.at += if next { name.len() } else { 0 };
        next
    }

    /// Passes over digits.
    pub(crate) fn digits(&mut self) {
        while self.text.get(self.at).is_some_and(u8::is_ascii_digit) {
            self.at += 1;
        }
    }

    /// An unsigned number.
    pub(crate) fn number(&mut self) -> Outcome<f64> {
        self.peek();
        let start = self.at;
        self.digits();
        if self.text.get(self.at) == Some(&b'.') {
            self.at += 1;
            self.digits();
        }
        let exponent = self.text.get(self.at..self.at + 2);
        let raised = self.lexis == Lexis::Sinumerik
            && exponent.is_some_and(|letters| letters.eq_ignore_ascii_case(b"EX"));
        let digits = self.text.get(start..self.at).unwrap_or_default();
        if !raised && let Some(value) = exact_decimal(digits) {
            return Ok(value);
        }
        let mut digits = self.since(start);
        if raised {
            self.at += 2;
            let from = self.at;
            if matches!(self.text.get(self.at), Some(b'+' | b'-')) {
                self.at += 1;
            }
            self.digits();
            digits.push('e');
            digits.push_str(&self.since(from));
        }
        self.parsed(digits.as_bytes(), start)
    }

    /// The number that `digits` are, which were taken from `start` on.
    pub(super) fn parsed(&self, digits: &[u8], start: usize) -> Outcome<f64> {
        let value = std::str::from_utf8(digits).ok();
        let value = value.and_then(|digits| digits.parse::<f64>().ok());
        if let Some(value) = value.filter(|value| value.is_finite()) {
            return Ok(value);
        }
        let text = self.text.get(start..self.at).unwrap_or_default();
        let message = format!("`{}` is not a number", excerpt(text, 40));
        let help = "write digits with at most one point";
        Err(self.fault("expression", message, help, start))
    }

    /// The text from `start` to the place.
    fn since(&self, start: usize) -> String {
        String::from_utf8_lossy(self.text.get(start..self.at).unwrap_or_default()).into_owned()
    }

    /// Passes over the rest of the block.
    pub(crate) fn pass_over_rest(&mut self) {
        while self.peek().is_some() {
            self.at += 1;
        }
    }

    /// Adds the word that stands from `start` to the place, with its number
    /// from `number` on.
    pub(crate) fn add_word(
        &self,
        letter: u8,
        value: f64,
        start: usize,
        number: usize,
        block: &mut Block,
    ) -> Outcome<()> {
        if block.words.len() >= WORDS_MAX {
            let message = "more than 256 words in a block";
            let help = "write two blocks";
            return Err(self.fault("too-many-words", message, help, start));
        }
        block.words.push(Word {
            letter,
            value,
            span: self.span(start),
            number: Span::new(number, self.end().max(number)),
        });
        Ok(())
    }

    /// Passes over `[ … ]`, whatever it holds; gives what is inside.
    pub(crate) fn brackets(&mut self) -> Outcome<&'t [u8]> {
        let start = self.at;
        self.expect(b'[')?;
        let from = self.at;
        let mut depth = 1_usize;
        while let Some(byte) = self.text.get(self.at) {
            match byte {
                b'[' => depth += 1,
                b']' => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                return Ok(self.text.get(from..self.at - 1).unwrap_or_default());
            }
        }
        Err(self.missing("]", start))
    }

    /// `byte` must be next.
    pub(crate) fn expect(&mut self, byte: u8) -> Outcome<()> {
        if self.take(byte) {
            return Ok(());
        }
        let at = self.at;
        Err(self.missing(char::from(byte).encode_utf8(&mut [0; 4]), at))
    }

    pub(crate) fn missing(&self, what: &str, at: usize) -> Fault {
        let help = "close each bracket, and write operators between values";
        self.fault("expression", format!("`{what}` is missing here"), help, at)
    }

    /// A result, or the fault of what stands from `start` to the place.
    pub(crate) fn worked_out(
        &self,
        result: Result<f64, &'static str>,
        start: usize,
    ) -> Outcome<f64> {
        let help = "check the values that go into it";
        result.map_err(|wrong| self.fault("arithmetic", wrong, help, start))
    }

    /// A fault of what stands from `start` to the place.
    pub(crate) fn fault(
        &self,
        rule: &'static str,
        message: impl Into<String>,
        help: &'static str,
        start: usize,
    ) -> Fault {
        Fault::new(rule, message, help, self.span(start))
    }

    /// What changes the motion in a way that is not followed.
    pub(crate) fn refused(&self, name: &str, reason: &str, start: usize) -> Fault {
        let message = format!("{name} is {reason}, which gwatt does not follow");
        let help = "nothing is estimated for a program with motion that is not understood";
        self.fault("unsupported-word", message, help, start)
    }

    /// A command that raises an alarm: whether and where the program ends by it the control
    /// decides.
    pub(crate) fn alarm(&self, name: &str, start: usize) -> Fault {
        let message = format!("{name} raises an alarm: whether the program fits is not known");
        let help = "give what is checked before it (arguments, --set, --parameters), or see why the \
                    program comes to this line";
        self.fault("alarm", message, help, start)
    }

    /// What stands from `start` to the place; a byte at least.
    pub(crate) fn span(&self, start: usize) -> Span {
        let place = match self.lexis {
            Lexis::Blanks => self.at,
            _ => self.end(),
        };
        let end = place.max(start + 1).min(self.text.len());
        Span::new(start.min(end), end)
    }

    /// The place without the blanks before it.
    pub(crate) fn end(&self) -> usize {
        let before = self.text.get(..self.at).unwrap_or(self.text);
        before.trim_ascii_end().len()
    }
}

/// A number of so few digits that a division of whole numbers gives it exactly as
/// the nearest one.
pub(super) fn exact_decimal(text: &[u8]) -> Option<f64> {
    let (mut whole, mut scale, mut after_point) = (0_u64, 1_u64, false);
    if text.len() < 2 && !text.first().is_some_and(u8::is_ascii_digit) || text.len() > 16 {
        return None;
    }
    for byte in text {
        match byte {
            b'0'..=b'9' => {
                whole = whole * 10 + u64::from(byte - b'0');
                scale *= if after_point { 10 } else { 1 };
            }
            b'.' if !after_point => after_point = true,
            _ => return None,
        }
    }
    (whole < 1 << 53).then(|| whole as f64 / scale as f64)
}
