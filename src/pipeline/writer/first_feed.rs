//! Blocks that obey F while none is in force: what the control takes then is one speed for
//! all of them, which only the control knows. Where one of them gets an F, all that follow
//! have it too, the lowest so far, up to the first F of the program.

use std::io::{Read, Seek, Write};

use super::Writer;
use crate::diagnostic::Diagnostic;
use crate::limit::{Change, FirstFeed};
use crate::pipeline::entry::Entry;
use crate::source::{Span, split_line_end};

impl<R: Read + Seek, W: Write> Writer<'_, R, W> {
    /// The change of a block, with the F that stands for the unknown one.
    pub(super) fn with_first_feed(
        &mut self,
        entry: &Entry,
        change: Option<Change>,
    ) -> Option<Change> {
        if !entry.lacks_feed() || entry.keeps_its_words(entry.skips).is_some() {
            return change;
        }
        let Some(lowest) = self.first_feed_with(entry, change) else {
            return change;
        };
        Some(Change {
            feed: Some(lowest.in_units(entry.facts.feed_mm_per_unit)),
            ..change.unwrap_or(Change::NONE)
        })
    }

    /// The lowest F so far that stands for the unknown one, with that of this change.
    pub(super) fn first_feed_with(
        &mut self,
        entry: &Entry,
        change: Option<Change>,
    ) -> Option<FirstFeed> {
        let own = change.filter(|change| !change.as_feed);
        if let Some(feed) = own.and_then(|change| change.feed) {
            let most_mm_s = self.machine.controller.language.power_on_feed_mm_s;
            let own = FirstFeed::at_most(feed, entry.facts.feed_mm_per_unit, most_mm_s);
            let Some(known) = self.first_feed else {
                self.note_first_feed(entry);
                self.first_feed = Some(own);
                return self.first_feed;
            };
            self.first_feed = Some(known.lower(own));
        }
        self.first_feed
    }

    fn note_first_feed(&mut self, entry: &Entry) {
        let text = split_line_end(&entry.text).0;
        let message = "no F is in force, and what the control takes then is not known: the blocks \
                       that count on none get one F, at which they fit";
        let note = Diagnostic::note("first-feed", message)
            .at(entry.key.1, Span::new(0, text.len()), text)
            .help("write the F that is meant before them");
        self.unsplit.notes.push(note);
    }
}
