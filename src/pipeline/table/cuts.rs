//! Which lines move by the F in force alone.

use crate::interpret::{FeedMode, MoveKind};
use crate::pipeline::entry::Entry;

/// Whether a line counts on the F in force and moves by it alone, so that a lower one may be
/// written into it.
pub(super) fn cuts_by_feed(entry: &Entry, skips: bool) -> bool {
    let facts = &entry.facts;
    let feeds = entry.moves_by(|kind| !matches!(kind, MoveKind::Rapid | MoveKind::Dwell));
    feeds
        && !entry.moves_by(|kind| kind == MoveKind::Rapid)
        && !(facts.compensated || facts.cycle || facts.reads_state || facts.looks_at_state())
        && facts.kept().is_none()
        && facts.feed_word.is_none()
        && entry.feed_mode == FeedMode::PerMinute
        && entry.keeps_its_words(skips).is_none()
}
