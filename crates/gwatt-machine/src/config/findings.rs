//! Collects what is wrong or doubtful in a file, each finding with its line.

use std::collections::BTreeSet;
use std::ops::Range;

use gwatt_syntax::diagnostic::{Diagnostic, Severity};
use gwatt_syntax::source::Span;

/// Longer lines are cut in diagnostics.
const MAX_LINE: usize = 400;
/// More findings of one severity help nobody, and cost time.
const MAX_FINDINGS: usize = 100;

/// Findings in one file, in the order in which they were made.
#[derive(Debug)]
pub(crate) struct Findings<'a> {
    text: &'a str,
    list: Vec<Diagnostic>,
    /// Paths of values that were refused and taken out: that they are
    /// missing is not worth a second message.
    refused: BTreeSet<String>,
}

impl<'a> Findings<'a> {
    /// No findings yet.
    pub(crate) fn new(text: &'a str) -> Self {
        Self {
            text,
            list: Vec::new(),
            refused: BTreeSet::new(),
        }
    }

    /// Notes that the value at `path` was refused.
    pub(crate) fn refuse(&mut self, path: String) {
        self.refused.insert(path);
    }

    /// True when the value at `path`, or one that it is part of, was refused.
    pub(crate) fn is_refused(&self, path: &str) -> bool {
        let mut end = path.len();
        loop {
            if self.refused.contains(&path[..end]) {
                return true;
            }
            let Some(dot) = path[..end].rfind('.') else {
                return false;
            };
            end = dot;
        }
    }

    /// True when the value at `path`, or one inside it, was refused.
    pub(crate) fn refused_in(&self, path: &str) -> bool {
        let inside = format!("{path}.");
        self.is_refused(path)
            || self
                .refused
                .range(inside.clone()..)
                .next()
                .is_some_and(|refused| refused.starts_with(&inside))
    }

    /// A mistake: the file is refused.
    pub(crate) fn error(
        &mut self,
        rule: &'static str,
        span: &Range<usize>,
        message: impl Into<String>,
        help: Option<String>,
    ) {
        self.push(Severity::Error, rule, span, message.into(), help);
    }

    /// Probably a mistake.
    pub(crate) fn warning(
        &mut self,
        rule: &'static str,
        span: &Range<usize>,
        message: impl Into<String>,
        help: Option<String>,
    ) {
        self.push(Severity::Warning, rule, span, message.into(), help);
    }

    /// Takes over findings of another file.
    pub(crate) fn append(&mut self, other: Vec<Diagnostic>) {
        self.list.extend(other);
    }

    /// True when an error was found.
    pub(crate) fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }

    /// All findings, by line.
    pub(crate) fn into_list(mut self) -> Vec<Diagnostic> {
        self.list.sort_by_key(|d| (d.line, d.span.start));
        self.list
    }

    fn push(
        &mut self,
        severity: Severity,
        rule: &'static str,
        span: &Range<usize>,
        message: String,
        help: Option<String>,
    ) {
        let same = self.list.iter().filter(|d| d.severity == severity);
        if same.count() >= MAX_FINDINGS {
            return;
        }
        let diagnostic = diagnostic(severity, rule, message, help);
        let diagnostic = locate(self.text.as_bytes(), span, diagnostic);
        if !self.list.contains(&diagnostic) {
            self.list.push(diagnostic);
        }
    }
}

/// A diagnostic that concerns a whole file.
pub(crate) fn diagnostic(
    severity: Severity,
    rule: &'static str,
    message: String,
    help: Option<String>,
) -> Diagnostic {
    let mut diagnostic = match severity {
        Severity::Error => Diagnostic::error(rule, message),
        Severity::Warning => Diagnostic::warning(rule, message),
        Severity::Note => Diagnostic::note(rule, message),
    };
    diagnostic.help = help;
    diagnostic
}

/// Adds line, span and text; an empty span at the start means the whole file.
pub(crate) fn locate(bytes: &[u8], span: &Range<usize>, diagnostic: Diagnostic) -> Diagnostic {
    if *span == (0..0) {
        return diagnostic;
    }
    let start = span.start.min(bytes.len());
    let before = &bytes[..start];
    let line_start = before
        .iter()
        .rposition(|&b| b == b'\n')
        .map_or(0, |i| i + 1);
    let rest = &bytes[line_start..];
    let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
    let line = rest[..length]
        .strip_suffix(b"\r")
        .unwrap_or(&rest[..length]);
    let line = &line[..line.len().min(MAX_LINE)];
    let first = (start - line_start).min(line.len());
    let last = span.end.saturating_sub(line_start).clamp(first, line.len());
    let number = memchr::memchr_iter(b'\n', before).count() as u64 + 1;
    diagnostic.at(number, Span::new(first, last), line)
}
