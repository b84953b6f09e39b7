//! One block at a time: its edits, and the lines before it.

mod feed_mode;
mod label;
mod pieces;
mod tool_words;
mod view;
mod within;
mod words;

pub use view::{BlockView, FeedAround, PieceWords};

use label::Label;
use tool_words::{tool_line, without, without_tool};

use super::number::{Style, feed_again};
use super::rapid_mark::Comment;
use super::state::{Mark, Written, motion_word};
use super::turned::{InForce, Turned};
use crate::edit::{Edit, apply};
use crate::interpret::{KnobState, Motion, ToolWords};
use crate::machine::{Machine, ToolChange};
use crate::source::split_line_end;
use crate::syntax::Word;

/// Exact stop at the end of each move, on controls without a word for one block.
const EXACT_STOP: &str = "G61.1";

/// Writes the blocks of one program.
#[derive(Debug)]
pub struct Rewriter<'m> {
    machine: &'m Machine,
    written: Written,
    /// Knobs that differ from the original.
    turned: Turned<'m>,
    line_end: Vec<u8>,
    /// What lines that are inserted begin with, so that they are skipped with their block.
    skip: String,
    /// The label of the block that is written, for the first line that is inserted before it:
    /// a jump to the block executes that line too.
    label: Option<Label>,
    /// The last line that was written has an end.
    complete: bool,
    edits: Vec<Edit>,
    /// The block at which the axes stop.
    stop: String,
    /// The axes stand after the last line that was written.
    stopped: bool,
    /// The words in whose place exact stop is in force.
    blend_words: Option<String>,
    /// G1 was written where no motion word was in force: it holds up to the first one.
    feeds_from_here: bool,
    /// Marks feeds that stand for rapids.
    comment: Option<Comment>,
    /// The last block was under compensation: nothing may come between it and another such.
    compensated: bool,
    /// The word that lets F mean again what it means in the original, times ten, where a block
    /// under compensation has left another meaning in force.
    feed_mode_back: Option<u16>,
    /// The next block states all that is in force in the original.
    states: bool,
    /// Lines changed or inserted so far.
    pub edited_lines: u64,
}

impl<'m> Rewriter<'m> {
    /// Begins a program.
    #[must_use]
    pub fn new(machine: &'m Machine) -> Self {
        Self {
            machine,
            written: Written {
                motion: Motion::at_power_on(&machine.controller.language),
                feed: None,
            },
            turned: Turned::new(machine),
            line_end: b"\n".to_vec(),
            skip: String::new(),
            label: None,
            complete: true,
            edits: Vec::new(),
            stop: machine.controller.language.shortest_dwell().0,
            stopped: false,
            blend_words: None,
            feeds_from_here: false,
            comment: None,
            compensated: false,
            feed_mode_back: None,
            states: false,
            edited_lines: 0,
        }
    }

    /// Puts this comment into each block in which a rapid becomes a feed.
    #[must_use]
    pub fn marking(self, comment: Option<Comment>) -> Self {
        Self { comment, ..self }
    }

    /// Whether blocks that came before any motion word of the program run as feeds, since
    /// an earlier one was written as a feed.
    #[must_use]
    pub fn feeds_from_here(&self) -> bool {
        self.feeds_from_here
    }

    /// Writes a block to the end of `out`. False when its edits contradict
    /// each other, which leaves the block as it was.
    #[must_use]
    pub fn write(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) -> bool {
        if label::names_program(view.block) && self.label.is_none() {
            self.label = Label::of(view.text, view.block, self.machine);
        }
        self.note_end(view.text);
        let facts = view.facts;
        self.edits.clear();
        if self.compensated && !facts.executed {
            let fine = !facts.reads_state || self.stands_as_before(view);
            return fine && self.apply_edits(view.text, out);
        }
        if std::mem::replace(&mut self.compensated, facts.compensated) && facts.compensated {
            return self.write_within(view, out);
        }
        if self.feed_mode_back.take().is_some() {
            self.back_to_feed_mode(view.before, out);
        }
        if !(view.change.exact_stop || view.change.stop) {
            self.blend_again(out);
        }
        // Nothing can be put back inside a block that takes no further word.
        let sealed = facts.checksum || facts.dwell_takes_feed;
        let looked_at = facts.looks_at_state()
            // Between blocks under compensation nothing can be put right.
            || facts.compensated
            || sealed
            || view.block.tape
            || view.block.delete_level > 0;
        if looked_at {
            self.restore(view.before, view.knobs, out);
        }
        if !facts.executed {
            self.take_label_out();
            return self.apply_edits(view.text, out);
        }
        let tool_after = self.take_tool_words(view, out);
        if view.rapids || view.feeds {
            self.write_pieces(view, out);
            self.turn_knobs(view.change, view, out);
        }
        let apart = self.begin_apart(view, out);
        if view.stops && !self.stopped {
            self.insert_stop(out);
        }
        let stop = facts.stop_word.filter(|_| !view.change.is_none());
        if let Some(word) = stop {
            self.edits
                .push(Edit::replace(without(word, view.text, view.block), ""));
        }
        if view.change.exact_stop || view.change.stop {
            self.exact_stop(view, out);
        }
        if facts.compensated {
            self.per_minute_within(view);
        }
        self.motion_word(view);
        self.feed_word(view);
        self.mark_rapid(view);
        self.take_label_out();
        let fine = self.apply_edits(view.text, out);
        self.stopped = view.stops || view.rests || view.text.trim_ascii() == self.stop.as_bytes();
        if view.stops && !view.change.exact_stop {
            self.complete_line(out);
            self.insert_stop(out);
        }
        if apart {
            self.back_to_feed_mode(view.after, out);
        }
        if let Some(words) = tool_after {
            self.line_after(tool_line(&words, view.text).as_bytes(), view, out);
        }
        if let Some(word) = stop {
            self.line_after(word.of(view.text), view, out);
        }
        fine
    }

    /// Writes the block itself.
    fn apply_edits(&mut self, text: &[u8], out: &mut Vec<u8>) -> bool {
        if self.edits.is_empty() {
            out.extend_from_slice(text);
            return true;
        }
        self.edited_lines += 1;
        apply(text, &mut self.edits, out)
    }

    /// Takes the label out of its block where a line before that has it.
    fn take_label_out(&mut self) {
        if let Some(label) = self.label.take().filter(|label| label.is_taken) {
            self.edits.push(Edit::replace(label.span, ""));
        }
    }

    /// Takes the words that select and change the tool out of a block that is changed: they
    /// stand on a line before it, or, which is returned, on one after it.
    fn take_tool_words(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) -> Option<ToolWords> {
        let words = view.facts.tool_words.filter(|_| !view.change.is_none())?;
        let gone = without_tool(&words, view.text, view.block)
            .into_iter()
            .flatten();
        self.edits.extend(gone.map(|gone| Edit::replace(gone, "")));
        if words.order == ToolChange::AfterMotion {
            return Some(words);
        }
        self.insert_line(&tool_line(&words, view.text), out);
        self.stopped = false;
        None
    }

    /// What a block whose motion was changed does once the axes stand, on a line of its own:
    /// anyone who looks at the state there finds the original's.
    fn line_after(&mut self, words: &[u8], view: &BlockView<'_>, out: &mut Vec<u8>) {
        self.complete_line(out);
        self.blend_again(out);
        self.restore(view.after, view.knobs, out);
        out.extend_from_slice(self.skip.as_bytes());
        out.extend_from_slice(words);
        let (_, line_end) = split_line_end(view.text);
        out.extend_from_slice(line_end);
        self.complete = !line_end.is_empty();
        self.edited_lines += 1;
    }

    /// Ends the last line that was written, where it has no end.
    fn complete_line(&mut self, out: &mut Vec<u8>) {
        if !self.complete {
            out.extend_from_slice(&self.line_end);
            self.complete = true;
        }
    }

    /// Copies a block that moves and changes nothing else of the state `mark`;
    /// false, and nothing is written, where the written program is in another
    /// state. `rests`: see [`BlockView`].
    #[must_use]
    pub fn pass(&mut self, text: &[u8], mark: &Mark, rests: bool, out: &mut Vec<u8>) -> bool {
        let same = self.written.motion == mark.motion && self.written.feed == mark.feed_value();
        let as_it_was = same && self.turned.is_empty() && self.blend_words.is_none();
        if !as_it_was || self.feed_mode_back.is_some() {
            return false;
        }
        self.compensated = false;
        self.stopped = rests;
        self.note_end(text);
        out.extend_from_slice(text);
        true
    }

    /// Remembers how lines end, and whether this one does.
    #[inline]
    fn note_end(&mut self, text: &[u8]) {
        let (_, end) = split_line_end(text);
        self.complete = !end.is_empty();
        if !end.is_empty() && end != self.line_end {
            self.line_end = end.to_vec();
        }
    }

    /// Writes a block by itself: what it changes is put back right after it, so
    /// that it does not matter where the program comes from or goes on, nor whether the
    /// block is skipped. False when its edits contradict each other.
    #[must_use]
    pub fn write_alone(
        &mut self,
        view: &BlockView<'_>,
        around: FeedAround,
        out: &mut Vec<u8>,
    ) -> bool {
        let known = match around {
            FeedAround::PutBack | FeedAround::LeftAfter => true,
            FeedAround::NotKnownBefore | FeedAround::Stated => false,
            FeedAround::Within { known_before, .. } => known_before,
        };
        self.written = Written {
            motion: view.before.motion,
            feed: view.before.feed_value().filter(|_| known),
        };
        // Whatever the line above ends with, another may come before this one.
        self.stopped = false;
        self.compensated = matches!(around, FeedAround::Within { .. });
        let within = self.compensated;
        if within && !known {
            self.state_within(view.before);
        }
        if view.block.delete_level > 0 {
            label::delete_mark(view.text).clone_into(&mut self.skip);
        }
        self.label = Label::of(view.text, view.block, self.machine);
        let written = self.write(view, out);
        // Where only F was not known before, all is as after the original's block.
        let changes = known || within || !view.change.is_none();
        if changes && around.is_put_back() {
            let left = matches!(around, FeedAround::LeftAfter | FeedAround::Stated);
            let feed = view.after.feed.filter(|_| !left);
            let after = Mark {
                feed,
                ..*view.after
            };
            self.finish(&after, view.knobs, out);
        }
        self.skip.clear();
        (self.feed_mode_back, self.states) = (None, false);
        written
    }

    /// Puts the state right at the end of a program that has no end word.
    pub fn finish(&mut self, last: &Mark, knobs: Option<&KnobState>, out: &mut Vec<u8>) {
        let mut lines = Vec::new();
        if self.feed_mode_back.take().is_some() {
            self.back_to_feed_mode(last, &mut lines);
        }
        self.blend_again(&mut lines);
        self.restore(last, knobs, &mut lines);
        if lines.is_empty() {
            return;
        }
        if !self.complete {
            // The last line has no end: the new one takes over that habit.
            out.extend_from_slice(&self.line_end);
            lines.truncate(lines.len() - self.line_end.len());
        }
        out.append(&mut lines);
    }

    /// A line that gives motion word and feed their original values, and lines
    /// for the knobs; nothing where they have them.
    fn restore(&mut self, original: &Mark, knobs: Option<&KnobState>, out: &mut Vec<u8>) {
        let in_force = InForce {
            knobs,
            mm_per_unit: original.mm_per_unit,
        };
        for line in self.turned.restore(in_force) {
            self.insert_line(&line, out);
        }
        let family = self.machine.controller.language.family.facts();
        let arc = matches!(original.motion, Motion::ArcCw | Motion::ArcCcw);
        let mut words = Vec::new();
        // Where an arc's word may not stand alone, the next block that moves gets it.
        if self.written.motion != original.motion && !(arc && family.arcs_need_words) {
            words.extend(motion_word(original.motion));
            self.written.motion = original.motion;
        }
        let feed = original.feed_value();
        if self.written.feed != feed && original.per_minute() {
            if words.is_empty() && family.lines_need_command && feed.is_some() {
                // An arc it reads only with its centre: a line takes its place.
                let line = matches!(original.motion, Motion::Rapid | Motion::Linear);
                let motion = if line {
                    original.motion
                } else {
                    Motion::Linear
                };
                words.extend(motion_word(motion));
                self.written.motion = motion;
            }
            words.extend(
                original
                    .feed
                    .as_ref()
                    .map(|feed| format!("F{}", feed_again(feed, original.mm_per_unit))),
            );
            if feed.is_some() {
                self.written.feed = feed;
            }
        }
        if !words.is_empty() {
            self.insert_line(&words.join(" "), out);
        }
    }

    /// Lets a block end at rest: by a word in it, or by a line before it.
    fn exact_stop(&mut self, view: &BlockView<'_>, out: &mut Vec<u8>) {
        if let Some(number) = self.machine.controller.language.exact_stop_word {
            let Some(first) = first_word(view) else {
                return;
            };
            let style = Style::of(view.text, view.block);
            let mut text = vec![style.letter(b'G')];
            text.extend((f64::from(number) / 10.0).to_string().bytes());
            text.extend(style.spaced.then_some(b' '));
            self.edits.push(Edit::insert(first.span.start, text));
        } else if self.blend_words.is_none() {
            if self.machine.controller.language.stops_by_mode() {
                self.insert_line("G61", out);
                self.blend_words = view.after.blend_again();
            } else {
                self.insert_line(EXACT_STOP, out);
                self.blend_words = view.after.blend_words();
            }
        }
    }

    /// Lets corners be rounded again.
    fn blend_again(&mut self, out: &mut Vec<u8>) {
        if let Some(words) = self.blend_words.take() {
            self.insert_line(&words, out);
        }
    }

    /// A line between two blocks at which the axes stand, such as a dwell.
    pub fn put_between(&mut self, words: &str, out: &mut Vec<u8>) {
        self.complete_line(out);
        self.blend_again(out);
        self.insert_line(words, out);
        self.stopped = true;
    }

    fn insert_stop(&mut self, out: &mut Vec<u8>) {
        let stop = std::mem::take(&mut self.stop);
        self.insert_line(&stop, out);
        self.stop = stop;
    }

    fn insert_line(&mut self, words: &str, out: &mut Vec<u8>) {
        let label = self.label.as_mut().filter(|label| !label.is_taken);
        let (first, second) = match label {
            Some(label) => {
                label.is_taken = true;
                let (skip, text) = (self.skip.as_bytes(), label.text.as_slice());
                if label.before_mark {
                    (text, skip)
                } else {
                    (skip, text)
                }
            }
            None => (self.skip.as_bytes(), &[][..]),
        };
        out.extend_from_slice(first);
        out.extend_from_slice(second);
        out.extend_from_slice(words.as_bytes());
        out.extend_from_slice(&self.line_end);
        self.edited_lines += 1;
    }
}

/// The first word of a block that stays in it.
fn first_word<'v>(view: &BlockView<'v>) -> Option<&'v Word> {
    let mut words = view.block.words.iter();
    let facts = view.facts;
    words.find(|word| {
        let span = Some(word.span);
        let of_tool = facts.tool_words.iter().flat_map(ToolWords::spans);
        span != facts.stop_word && !of_tool.map(Some).any(|gone| gone == span)
    })
}
