//! What gwatt has to say about a program: as data, with the line under it.

mod render;
mod printable;
mod shown;

pub use printable::excerpt;

use crate::source::{Span, split_line_end};

/// How much a diagnostic weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Worth knowing; changes nothing.
    Note,
    /// Probably a mistake; the run goes on.
    Warning,
    /// The program, or the machine file, is refused: exit 2.
    Error,
}

/// One finding, tied to a place in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How much it weighs.
    pub severity: Severity,
    /// Short stable name in kebab case, such as `arc-radius`.
    pub rule: &'static str,
    /// What is wrong, in one line without a full stop.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The file, where it is not the one that is being read.
    pub file: Option<String>,
    /// Line number from 1; 0 when the finding concerns the whole file.
    pub line: u64,
    /// Column of the span's first character, from 1, in characters of the
    /// line; 0 when the finding concerns the whole file.
    pub column: u32,
    /// Where in that line, in bytes of the whole line.
    pub span: Span,
    /// The line itself, without its line end, as bytes; long lines are cut.
    pub text: Vec<u8>,
    /// Bytes of the line that were cut off before `text`.
    pub text_offset: u32,
    /// Further findings of its kind that are not listed.
    pub alike: u64,
    /// The line of the last of them.
    pub alike_to: u64,
}

/// Bytes of a line that are kept, so that findings stay small.
const KEPT_BYTES: usize = 4096;
/// Bytes kept before the span. More than is shown even of four-byte characters.
const KEPT_BEFORE: usize = 1024;
impl Diagnostic {
    /// A finding for which the program or machine file is refused.
    ///
    /// `rule` is its stable name, `message` one line without a full stop. It
    /// concerns the whole file until [`Self::at`] ties it to a place.
    pub fn error(rule: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, rule, message.into())
    }

    /// A finding that is probably a mistake; see [`Self::error`].
    pub fn warning(rule: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, rule, message.into())
    }

    /// A finding worth knowing; see [`Self::error`].
    pub fn note(rule: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, rule, message.into())
    }

    fn new(severity: Severity, rule: &'static str, message: String) -> Self {
        Self {
            severity,
            rule,
            message,
            help: None,
            file: None,
            line: 0,
            column: 0,
            span: Span::default(),
            text: Vec::new(),
            text_offset: 0,
            alike: 0,
            alike_to: 0,
        }
    }

    /// Ties the finding to `span` of the line with number `line` from 1;
    /// `text` is the whole line, with or without its line end. A span that
    /// leaves the text is cut to it.
    #[must_use]
    pub fn at(mut self, line: u64, span: Span, text: &[u8]) -> Self {
        let (text, _) = split_line_end(text);
        let start = (span.start as usize).min(text.len());
        let end = (span.end as usize).clamp(start, text.len());
        let from = if text.len() > KEPT_BYTES {
            start.saturating_sub(KEPT_BEFORE)
        } else {
            0
        };
        let kept = text.get(from..).unwrap_or_default();
        self.line = line;
        self.span = Span::new(start, end);
        self.column = printable::decode(text.get(..start).unwrap_or_default()).count() as u32 + 1;
        self.text = kept.get(..KEPT_BYTES).unwrap_or(kept).to_vec();
        self.text_offset = from as u32;
        self
    }

    /// What makes findings alike: rule and message, whatever the numbers in it; that of a word,
    /// such as G5.1, belongs to it.
    #[must_use]
    pub fn kind(&self) -> String {
        let mut kind = String::new();
        let (mut is_number, mut is_word) = (false, false);
        for sign in self.message.chars() {
            let goes_on = (is_number || is_word) && matches!(sign, '.' | ',');
            if !(sign.is_ascii_digit() || goes_on) {
                kind.push(sign);
                (is_number, is_word) = (false, sign.is_alphabetic());
            } else if is_word {
                kind.push(sign);
            } else if !is_number {
                kind.push('…');
                is_number = true;
            }
        }
        format!("[{}] {kind}", self.rule)
    }

    /// Adds what to do about it.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}
