//! The words and the comment of a block: motion word, F, and the mark of a rapid.

use super::{BlockView, Rewriter, first_word};
use crate::edit::Edit;
use crate::interpret::Motion;
use crate::rewrite::number::{Style, at_most, decimal, feed_again, has_point, with_digit};
use crate::rewrite::state::FeedValue;

impl Rewriter<'_> {
    /// The motion word: G1 for a rapid that becomes a feed, and back.
    pub(super) fn motion_word(&mut self, view: &BlockView<'_>) {
        let facts = view.facts;
        self.feeds_from_here |= facts.no_motion_word && view.change.as_feed;
        // G80 with a place moves by the word that comes back after it.
        let own = facts.motion_word;
        if let Some(word) = own.filter(|word| word.value < 4.0 || !view.change.as_feed) {
            self.feeds_from_here = false;
            self.written.motion = view.after.motion;
            if view.change.as_feed {
                self.edits.push(Edit::replace(
                    word.number,
                    with_digit(word.number.of(view.text), b'1'),
                ));
                self.written.motion = Motion::Linear;
            }
            return;
        }
        if !facts.uses_motion {
            if own.is_none() && view.before.motion != view.after.motion {
                // The block puts another word in force by itself, as the end of a program does.
                self.written.motion = view.after.motion;
            }
            return;
        }
        // An end of the program may put another word in force after the motion.
        let ends = own.is_none() && facts.stop_word.is_some();
        let wanted = match (view.change.as_feed, ends) {
            (true, _) => Motion::Linear,
            (_, true) => view.before.motion,
            _ => view.after.motion,
        };
        if wanted == self.written.motion {
            return;
        }
        if let Some(digit) = wanted.digit() {
            let style = Style::of(view.text, view.block);
            let mut text = vec![style.letter(b'G'), digit];
            if let Some(first) = first_word(view) {
                text.extend(style.spaced.then_some(b' '));
                self.edits.push(Edit::insert(first.span.start, text));
            } else {
                // A block of assignments to axes.
                text.insert(0, b' ');
                self.edits.push(Edit::insert(view.block.words_end, text));
            }
        }
        self.written.motion = wanted;
    }

    /// F: changed, inserted, or put back.
    pub(super) fn feed_word(&mut self, view: &BlockView<'_>) {
        let facts = view.facts;
        let original = view.after.feed_value();
        let wanted = match view.change.feed {
            Some(value) => Some(FeedValue {
                value,
                mm_per_unit: facts.feed_mm_per_unit,
            }),
            None => original,
        };
        if let Some(word) = facts.feed_word {
            self.written.feed = original;
            if let (Some(value), Some(_)) = (view.change.feed, wanted) {
                let number = word.number.of(view.text);
                let family = self.machine.controller.language.family;
                // What the program works out stays so, unless it stands for a rapid now.
                let computed = facts.computed_feed && !view.change.as_feed;
                let text = computed.then(|| at_most(family, number, value)).flatten();
                let point = has_point(number) || self.points(view);
                let text = text.unwrap_or_else(|| decimal(value, point));
                self.edits.push(Edit::replace(word.number, text));
                self.written.feed = wanted;
            }
            return;
        }
        if view.after.feed.is_none() && view.change.feed.is_none() {
            // G93, G94 and G95 forget the feed of another meaning.
            self.written.feed = if view.after.per_minute() {
                self.written.feed
            } else {
                None
            };
            return;
        }
        let counts = facts.uses_motion && (facts.uses_feed || view.change.as_feed);
        if !counts || wanted == self.written.feed {
            return;
        }
        let number = match (view.change.feed, &view.after.feed) {
            (Some(value), Some(feed)) => {
                let point = has_point(feed.text.as_bytes()) || self.points(view);
                decimal(value, point)
            }
            (Some(value), None) => {
                let dialect = &self.machine.controller.language.dialect;
                decimal(value, dialect.point.is_some())
            }
            (None, Some(feed)) => feed_again(feed, facts.feed_mm_per_unit),
            (None, None) => return,
        };
        let style = Style::of(view.text, view.block);
        let mut text = Vec::with_capacity(number.len() + 2);
        text.extend(style.spaced.then_some(b' '));
        text.push(style.letter(b'F'));
        text.extend_from_slice(number.as_bytes());
        self.edits.push(Edit::insert(view.block.words_end, text));
        self.written.feed = wanted;
    }

    /// Whether the F of a block is written with a point, however others are: where a setting
    /// of the control decides what it means without one. An F in place of the program's own
    /// is written like that one, which then has the same meaning.
    fn points(&self, view: &BlockView<'_>) -> bool {
        view.change.as_feed && self.machine.controller.language.dialect.point.is_some()
    }

    /// The comment of a feed that stands for a rapid, where it is asked for and not there.
    pub(super) fn mark_rapid(&mut self, view: &BlockView<'_>) {
        let Some(comment) = &self.comment else { return };
        if view.change.as_feed && !comment.is_in(view.text) {
            let style = Style::of(view.text, view.block);
            let (at, text) = comment.put_into(view.text, style.spaced);
            self.edits.push(Edit::insert(at as u32, text));
        }
    }
}
