//! Blocks whose F is by the minute among others by the revolution, or of an inverse time.

use std::fmt::Write as _;

use super::{BlockView, Rewriter};
use crate::interpret::FeedMode;
use crate::rewrite::number::feed_again;
use crate::rewrite::state::{Mark, Written};

impl Rewriter<'_> {
    /// A line that lets F be by the minute, where it is not for others. True where it is needed.
    pub(super) fn begin_apart(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) -> bool {
        let apart = apart(view) && !view.facts.compensated;
        if apart {
            self.restore(view.before, view.knobs, out);
            let [per_minute, _] = view.after.per_minute_and_back();
            self.insert_line(&g_word(per_minute), out);
            self.written.feed = None;
        }
        apart
    }

    /// A line that puts back what was in force, after a feed per minute among others.
    pub(super) fn back_to_feed_mode(&mut self, original: &Mark, out: &mut Vec<u8>) {
        self.complete_line(out);
        let mut words = String::new();
        if let Some(digit) = original.motion.digit() {
            let _ = write!(words, "G{} ", char::from(digit));
        }
        let [_, back] = original.per_minute_and_back();
        words.push_str(&g_word(back));
        // Under an inverse time each block has its own F.
        let feed = original.feed.as_ref();
        let feed = feed.filter(|_| original.feed_mode == FeedMode::PerRevolution);
        if let Some(feed) = feed {
            let _ = write!(words, " F{}", feed_again(feed, original.mm_per_unit));
        }
        self.insert_line(&words, out);
        self.written = Written {
            motion: original.motion,
            feed: original.feed_value(),
        };
        self.stopped = false;
    }
}

/// Whether the F of a block is by the minute where the others are by the revolution or an
/// inverse time.
pub(super) fn apart(view: &BlockView<'_>) -> bool {
    view.change.as_feed && !view.after.per_minute()
}

/// A G word by its number, times ten.
pub(super) fn g_word(number: u16) -> String {
    format!("G{}", f64::from(number) / 10.0)
}
