//! Collects what is to be said about a program while it is read.

use crate::rules::rules_of;
use std::collections::{HashMap, HashSet};

use super::g_codes::{USER_DEFINED, code_number, refused_m_name};
use gwatt_machine::Language;
use gwatt_syntax::Word;
use gwatt_syntax::diagnostic::{Diagnostic, Severity};
use gwatt_syntax::source::Span;

/// The diagnostics of a run: the first errors in full, the rest counted by their kinds.
#[derive(Debug, Default)]
pub struct Diagnostics {
    /// What is kept, in program order.
    pub list: Vec<Diagnostic>,
    /// Number of errors, listed or not.
    pub errors: u64,
    said: HashSet<&'static str>,
    /// Errors that are listed.
    listed: u64,
    /// Where the first error of each kind is listed, once further ones are counted only.
    kinds: HashMap<String, usize>,
    overflow: Option<Diagnostic>,
}

impl Diagnostics {
    /// Errors that are listed; further ones are counted only.
    pub const LISTED: u64 = 50;
    /// Errors of kinds that none of those had, listed next to them.
    const OTHER_KINDS: u64 = 50;

    /// Adds a finding; errors beyond [`Diagnostics::LISTED`] are counted only, by the first one of
    /// their kind.
    pub fn push(&mut self, diagnostic: Diagnostic) -> &mut Diagnostic {
        if diagnostic.severity == Severity::Error {
            self.errors += 1;
            if self.errors > Self::LISTED && !self.is_of_a_new_kind(&diagnostic) {
                return self.overflow.insert(diagnostic);
            }
            self.listed += 1;
        }
        self.list.push(diagnostic);
        let last = self.list.len() - 1;
        &mut self.list[last]
    }

    /// Counts an error to the first one of its kind, unless it is the first one itself and there
    /// is room for it.
    fn is_of_a_new_kind(&mut self, error: &Diagnostic) -> bool {
        if self.kinds.is_empty() {
            let listed = self.list.iter().enumerate();
            for (place, it) in listed.filter(|(_, it)| it.severity == Severity::Error) {
                self.kinds.entry(it.kind()).or_insert(place);
            }
        }
        let kind = error.kind();
        match self.kinds.get(&kind).map(|place| self.list.get_mut(*place)) {
            Some(Some(first)) => {
                first.alike += 1;
                first.alike_to = first.alike_to.max(error.line);
                false
            }
            _ if self.listed < Self::LISTED + Self::OTHER_KINDS => {
                self.kinds.insert(kind, self.list.len());
                true
            }
            _ => false,
        }
    }

    /// True for the first call with this name: what is said once.
    pub fn first(&mut self, name: &'static str) -> bool {
        self.said.insert(name)
    }

    /// Number of errors beyond those listed.
    #[must_use]
    pub fn more(&self) -> u64 {
        self.errors.saturating_sub(self.listed)
    }
}

/// Diagnostics with the line that is being read.
#[derive(Debug)]
pub(super) struct Report<'a, 'l> {
    pub(super) diagnostics: &'a mut Diagnostics,
    pub(super) line: u64,
    pub(super) text: &'l [u8],
}

impl Report<'_, '_> {
    /// Reports an error at `span`.
    pub(super) fn error(
        &mut self,
        rule: &'static str,
        message: impl Into<String>,
        span: Span,
    ) -> Finding<'_> {
        let diagnostic = Diagnostic::error(rule, message).at(self.line, span, self.text);
        Finding(self.diagnostics.push(diagnostic))
    }

    /// Reports a note once a run.
    pub(super) fn note_once(&mut self, rule: &'static str, message: &str, span: Span) {
        if self.diagnostics.first(rule) {
            let diagnostic = Diagnostic::note(rule, message).at(self.line, span, self.text);
            self.diagnostics.push(diagnostic);
        }
    }

    /// Reports a G word that is not supported.
    pub(super) fn refused_g(&mut self, word: Word, language: &Language) {
        let name = code_number(word.value)
            .map_or("a word", |number| (rules_of(language).refused_g)(number));
        self.refused(b'G', word, name);
    }

    /// Reports an M word that is not supported.
    pub(super) fn refused_m(&mut self, word: Word, language: &Language) {
        let mut name = code_number(word.value).map_or("a word", refused_m_name);
        if name == USER_DEFINED && language.family.facts().printer {
            // Users define them on LinuxCNC; firmware knows a word or does not.
            name = "a word";
        }
        self.refused(b'M', word, name);
    }

    fn refused(&mut self, letter: u8, word: Word, name: &str) {
        let code = format!("{}{}", letter as char, word.value);
        let (rule, message) = if name == "a word" {
            (
                "unknown-code",
                format!("{code} is not known to this controller profile"),
            )
        } else {
            (
                "unsupported-code",
                format!("{code} is {name}, which gwatt does not support"),
            )
        };
        let help = if letter == b'M' {
            // Firmware of printers has such words; their arguments may be anything.
            let field = if word.value.fract() == 0.0 {
                "ignored"
            } else {
                "ignored_macros"
            };
            format!(
                "if it moves no axis, say so in the machine file: {field} = [\"{code}\"] under \
                 [language]; what it switches on is a [[load]]"
            )
        } else if name == "a word" {
            format!(
                "if it moves no axis and changes no motion, say so in the machine file: \
                 ignored = [\"{code}\"] under [language]"
            )
        } else {
            "nothing is estimated for a program with motion that is not understood".to_owned()
        };
        self.error(rule, message, word.span).help(help);
    }
}

/// A diagnostic that was just reported: advice may be added.
pub(super) struct Finding<'a>(&'a mut Diagnostic);

impl Finding<'_> {
    pub(super) fn help(self, help: impl Into<String>) {
        self.0.help = Some(help.into());
    }
}
