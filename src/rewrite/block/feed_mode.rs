//! Blocks whose F is by the minute among others by the revolution, or of an inverse time.

use std::fmt::Write as _;

use super::{BlockView, Rewriter};
use crate::edit::Edit;
use crate::interpret::FeedMode;
use crate::rewrite::number::feed_again;
use crate::rewrite::state::{Mark, Written};
use crate::syntax::Word;

impl Rewriter<'_> {
    /// Lets F be by the minute, where it is not for others: by a line, or in place of the word
    /// of the block that says otherwise. True where it is needed.
    pub(super) fn begin_apart(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) -> bool {
        let apart = apart(view) && !view.facts.compensated;
        if !apart {
            return false;
        }
        let [per_minute, back] = view.after.per_minute_and_back();
        let mut words = view.block.words.iter();
        if let Some(word) = words.find(|word| says_feed_mode(word, back)) {
            self.edits
                .push(Edit::replace(word.span, g_word(per_minute)));
        } else {
            self.restore(view.before, view.knobs, out);
            self.insert_line(&g_word(per_minute), out);
        }
        self.written.feed = None;
        true
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

/// Whether a word says what F means, where this word, times ten, would say it too.
pub(super) fn says_feed_mode(word: &Word, back: u16) -> bool {
    let number = (word.value * 10.0).round();
    let same_group = match back {
        980 | 990 => (980.0..=990.0).contains(&number),
        _ => (930.0..=970.0).contains(&number) || (9300.0..=9790.0).contains(&number),
    };
    word.letter == b'G' && same_group
}
