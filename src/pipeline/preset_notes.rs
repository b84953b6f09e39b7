//! What is said of presets: which lines got something in their place, and where they count
//! always but cannot be written.

use std::collections::BTreeSet;

use super::line_key::LineKey;
use crate::diagnostic::Diagnostic;
use crate::interpret::Move;
use crate::limit::{Limiter, Outcome};
use crate::source::{Span, split_line_end};

/// Rule of the note on lines without a preset.
pub(super) const NO_PRESET: &str = "no-preset";
/// Rule of the note on lines that a preset cannot be written into.
pub(super) const NOT_SET: &str = "preset-not-set";

/// The lines, counted.
#[derive(Debug, Default)]
pub(super) struct PresetNotes {
    /// They got a speed in place of a preset.
    without: Lines,
    /// They stay as they are; with the first one's reason.
    unset: Lines,
    first: Option<Diagnostic>,
}

#[derive(Debug, Default)]
struct Lines {
    count: u64,
    last: Option<LineKey>,
    /// All of them, where lines run again.
    known: BTreeSet<LineKey>,
}

impl Lines {
    /// Counts a line once.
    fn add(&mut self, key: LineKey, again: bool) {
        if self.last.replace(key) != Some(key) && (!again || self.known.insert(key)) {
            self.count += 1;
        }
    }
}

impl PresetNotes {
    /// Takes what was decided for a move; `again`: its line may run several times.
    pub(super) fn take(
        &mut self,
        limiter: &Limiter<'_>,
        (mv, outcome): (&Move, &Outcome),
        text: &[u8],
        again: bool,
    ) {
        let key = (mv.text, mv.line);
        if limiter.fell_back(mv, outcome) {
            self.without.add(key, again);
        }
        let Some(unset) = outcome.unset.as_deref() else {
            return;
        };
        self.unset.add(key, again);
        self.first.get_or_insert_with(|| {
            let span = Span::new(0, split_line_end(text).0.len());
            Diagnostic::note(NOT_SET, unset.message.as_str())
                .at(mv.line, span, text)
                .help(unset.help.as_str())
        });
    }

    /// One note for each of both.
    pub(super) fn notes(self) -> impl Iterator<Item = Diagnostic> {
        let without = match self.without.count {
            0 => None,
            1 => Some("1 line moves axes for which there is no preset: it gets".to_owned()),
            count => Some(format!(
                "{count} lines move axes for which there is no preset: they get"
            )),
        };
        let without = without.map(|lines| {
            let message = format!("{lines} the speed that fits (--preset-else speed)");
            Diagnostic::note(NO_PRESET, message)
        });
        let unset = self.first.map(|first| {
            let lines = match self.unset.count {
                1 => "1 line fits and stays as it is".to_owned(),
                count => format!("{count} lines fit and stay as they are"),
            };
            let message = format!("{lines}, though --always asks for less: {}", first.message);
            Diagnostic { message, ..first }
        });
        without.into_iter().chain(unset)
    }
}
