//! Feeds that an earlier run of `limit` may have written in place of rapids, in a
//! program without marks.

use super::{LimitOptions, LimitSummary, Options};
use crate::diagnostic::Diagnostic;
use crate::limit::FEED_NOT_ALLOWED;
use crate::syntax::{Block, scan_line};

/// Digits that an F as `limit` writes it has, zeros at its end left aside: those of programs
/// by hand are rounder.
const DIGITS: usize = 4;

/// A note where lower cutting feeds are asked for, and blocks look as an earlier run wrote
/// them.
pub(super) fn unmarked(
    options: &Options,
    how: LimitOptions,
    limited: &LimitSummary,
) -> Option<Diagnostic> {
    if limited.certified || how.allowed.feed || options.rapid_mark.is_some() {
        return None;
    }
    let mut reasons = limited.reasons.iter();
    let found = reasons.find(|reason| {
        let whole = reason.text_offset == 0 && reason.file.is_none();
        reason.rule == FEED_NOT_ALLOWED && whole && looks_written(&reason.text)
    })?;
    let message = "its F looks as an earlier run of `limit` writes one for a rapid: without \
                   marks it counts as a cutting feed";
    let note = Diagnostic::note("unmarked-rapid", message).at(found.line, found.span, &found.text);
    Some(note.help("limit the original, with --mark-rapids; or permit lower feeds"))
}

/// Whether a block has G1 and an F of as many digits as `limit` writes.
fn looks_written(text: &[u8]) -> bool {
    let mut block = Block::default();
    scan_line(text, false, &mut block);
    let feed = |word: &crate::syntax::Word| {
        let digits = word.number.of(text).iter().filter(|it| it.is_ascii_digit());
        let digits: Vec<u8> = digits.copied().collect();
        let first = digits.iter().position(|it| *it != b'0');
        let last = digits.iter().rposition(|it| *it != b'0');
        let count = first.zip(last).map_or(0, |(first, last)| last + 1 - first);
        word.letter == b'F' && count >= DIGITS
    };
    let linear = |word: &crate::syntax::Word| word.letter == b'G' && word.value == 1.0;
    block.words.iter().any(feed) && block.words.iter().any(linear)
}
