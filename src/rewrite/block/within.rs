//! Blocks under compensation: the control looks from each to the next, so that no line comes
//! between them. What a block needs, and what is put back after another, stands in it.

use super::feed_mode::{apart, g_word, says_feed_mode};
use super::{BlockView, Rewriter, first_word};
use crate::edit::Edit;
use crate::interpret::{FeedMode, Motion};
use crate::rewrite::number::{Style, feed_again};
use crate::rewrite::state::{Mark, Written, motion_word};

impl Rewriter<'_> {
    /// Writes a block that follows another one under compensation. False where it cannot take
    /// the words that it needs.
    pub(super) fn write_within(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) -> bool {
        let facts = view.facts;
        let counts = facts.uses_motion || facts.feed_word.is_some();
        let looked_at = facts.looks_at_state() || counts && takes_no_words(view);
        let states = self.states && !facts.uses_motion;
        if (looked_at || states) && !self.stands_as_before(view) {
            return self.put_right_within(view) && self.end_within(view, out);
        }
        if view.change.exact_stop || view.change.stop {
            self.exact_stop(view, out);
        }
        self.per_minute_within(view);
        self.feed_mode_within(view);
        self.motion_word(view);
        self.feed_word(view);
        self.rest_within(view);
        self.mark_rapid(view);
        self.end_within(view, out)
    }

    /// Another block may have left anything in force: the next one states the original's.
    pub(super) fn state_within(&mut self, original: &Mark) {
        self.written = Written {
            motion: Motion::None,
            feed: None,
        };
        let [_, back] = original.per_minute_and_back();
        self.feed_mode_back = (!original.per_minute()).then_some(back);
        self.states = true;
    }

    fn end_within(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) -> bool {
        self.stopped = view.rests;
        self.take_label_out();
        self.apply_edits(view.text, out)
    }

    /// Whether the written program has in force what the original has before a block.
    pub(super) fn stands_as_before(&self, view: &BlockView<'_>) -> bool {
        let feeds = !view.before.per_minute() || self.written.feed == view.before.feed_value();
        feeds && self.written.motion == view.before.motion && self.feed_mode_back.is_none()
    }

    /// Gives a block whose words are looked at, or that does not move, those of the original
    /// that are not in force. False where it takes none.
    fn put_right_within(&mut self, view: &BlockView<'_>) -> bool {
        let facts = view.facts;
        let shows = facts.reads_state || facts.turns_knob;
        if shows || takes_no_words(view) || !view.change.is_none() {
            return false;
        }
        self.feed_mode_within(view);
        if facts.motion_word.is_none()
            && self.written.motion != view.before.motion
            && let Some(word) = motion_word(view.before.motion)
        {
            self.put_first(view, &word);
        }
        if facts.feed_word.is_none()
            && self.written.feed != view.before.feed_value()
            && let Some(feed) = &view.before.feed
        {
            self.put_last(
                view,
                &format!("F{}", feed_again(feed, facts.feed_mm_per_unit)),
            );
        }
        self.written.motion = view.after.motion;
        self.written.feed = view.after.feed_value();
        true
    }

    /// Lets the F of a rapid that becomes a feed be by the minute.
    pub(super) fn per_minute_within(&mut self, view: &BlockView<'_>) {
        if !apart(view) {
            return;
        }
        let [per_minute, back] = view.after.per_minute_and_back();
        self.put_first(view, &g_word(per_minute));
        self.feed_mode_back = Some(back);
        self.written.feed = None;
    }

    /// Lets F mean again what it means in the original, where a block before has left another
    /// meaning in force and this one needs none of its own.
    fn feed_mode_within(&mut self, view: &BlockView<'_>) {
        let facts = view.facts;
        let shows = facts.boundary
            || facts.stop_word.is_some()
            || facts.selects_tool
            || facts.announces_tap;
        let needed = facts.uses_motion || facts.feed_word.is_some() || shows || self.states;
        if apart(view) || !needed {
            return;
        }
        let Some(back) = self.feed_mode_back.take() else {
            return;
        };
        let mut words = view.block.words.iter();
        if !words.any(|word| says_feed_mode(word, back)) {
            self.put_first(view, &g_word(back));
        }
        if facts.feed_word.is_none()
            && view.after.feed_mode == FeedMode::PerRevolution
            && let Some(feed) = &view.after.feed
        {
            self.put_last(
                view,
                &format!("F{}", feed_again(feed, facts.feed_mm_per_unit)),
            );
        }
        self.written.feed = view.after.feed_value();
    }

    /// States the F in force in a block that does not count on it, where it is not known what a
    /// block before has left.
    fn rest_within(&mut self, view: &BlockView<'_>) {
        let facts = view.facts;
        if self.written.feed.is_none()
            && facts.uses_motion
            && facts.feed_word.is_none()
            && view.after.per_minute()
            && let Some(feed) = &view.after.feed
        {
            self.put_last(
                view,
                &format!("F{}", feed_again(feed, facts.feed_mm_per_unit)),
            );
            self.written.feed = view.after.feed_value();
        }
    }

    /// Puts a word before all others of a block.
    fn put_first(&mut self, view: &BlockView<'_>, word: &str) {
        let style = Style::of(view.text, view.block);
        let mut text: Vec<u8> = word.bytes().map(|byte| style.letter(byte)).collect();
        if let Some(first) = first_word(view) {
            text.extend(style.spaced.then_some(b' '));
            self.edits.push(Edit::insert(first.span.start, text));
        } else {
            self.put_last(view, word);
        }
    }

    /// Puts a word after all others of a block.
    fn put_last(&mut self, view: &BlockView<'_>, word: &str) {
        let style = Style::of(view.text, view.block);
        let mut text: Vec<u8> = style.spaced.then_some(b' ').into_iter().collect();
        text.extend(word.bytes().map(|byte| style.letter(byte)));
        self.edits.push(Edit::insert(view.block.words_end, text));
    }
}

/// Whether a block takes no further words.
fn takes_no_words(view: &BlockView<'_>) -> bool {
    let facts = view.facts;
    facts.checksum || facts.dwell_takes_feed || view.block.tape || view.block.delete_level > 0
}
