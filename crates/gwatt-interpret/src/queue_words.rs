//! Words without an action of their own at which look-ahead may end: offsets,
//! tool lengths, and comments that act.

use super::code::GCode;
use super::control::{Control, Run};
use super::places::EXTRUDER;
use super::report::Report;
use gwatt_machine::{CornerRule, MESSAGES};
use gwatt_motion::{Action, ActionKind, Corner, Step};
use gwatt_syntax::Block;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// `(abort, …)` ends a program with an error (`LinuxCNC`, "Comments").
    pub(super) fn abort(&self, block: &Block, report: &mut Report<'_, '_>) {
        let text = report.text.get(..block.text_end as usize);
        let comment = text.and_then(|text| Some((text, memchr::memrchr(b'(', text)?)));
        let Some((text, start)) = comment.filter(|_| self.rules.comments_act) else {
            return;
        };
        let inside = text.get(start + 1..).unwrap_or_default();
        let letters = inside.iter().filter(|byte| !matches!(byte, b' ' | b'\t'));
        if letters.map(u8::to_ascii_lowercase).take(6).eq(*b"abort,") {
            let message = "the program ends itself with an error here";
            report
                .error("abort", message, Span::new(start, text.len()))
                .help("see why it comes to this line");
        }
    }

    /// Whether it matters: only where the look-ahead is modelled.
    fn plans_ahead(&self) -> bool {
        self.machine.controller.planner.look_ahead.is_some()
    }

    /// What a block sets that is no action of a word: before it moves.
    pub(super) fn note_queue_and_spindle(&mut self, run: &mut Run<'_, '_>) {
        self.note_offsets(run);
        self.tell_spindle(run);
    }

    /// Reports a word of the feed where lines may be put together.
    pub(super) fn note_feed(&self, value: f64, run: &mut Run<'_, '_>) {
        let joins = matches!(self.modal.corner, Corner::Round { join_mm, .. } if join_mm > 0.0);
        if joins && self.plans_ahead() {
            run.act(ActionKind::Feed, value);
        }
    }

    /// Reports words that change offsets or lengths, or the meaning of S.
    fn note_offsets(&self, run: &mut Run<'_, '_>) {
        if !self.plans_ahead() {
            return;
        }
        for index in 0..run.words.g.len() {
            let (code, number, _) = run.words.g[index];
            let reported = match code {
                // The extruder alone takes no part in the path.
                GCode::SetOffset => run.words.axes().any(|(axis, _)| axis != EXTRUDER),
                GCode::WorkOffset(_)
                | GCode::FurtherOffset
                | GCode::ToolLength(_)
                | GCode::ClearOffset { .. }
                | GCode::RestoreOffset
                | GCode::LocalOffset
                | GCode::SurfaceSpeed => true,
                GCode::DataSetting => self.sets_what_is_in_force(run),
                _ => false,
            };
            if reported {
                run.act(ActionKind::Offset, f64::from(number) / 10.0);
            }
        }
    }

    /// Whether G10 may change what is in force: `LinuxCNC` does no more than keep the
    /// origin of another work offset, and reads its tool table again without a sign.
    fn sets_what_is_in_force(&self, run: &Run<'_, '_>) -> bool {
        let value = |letter| run.words.word(letter, run.block).map(|word| word.value);
        let rules = self.machine.controller.planner.look_ahead;
        if !rules.is_some_and(|rules| matches!(rules.corner, CornerRule::LinuxCnc { .. })) {
            return true;
        }
        let active = f64::from(self.position.offsets().system);
        match value(b'L') {
            Some(0.0) => false,
            Some(2.0 | 20.0) => value(b'P').is_none_or(|p| p == 0.0 || p == active),
            _ => true,
        }
    }

    /// Reports a comment that acts, such as `(MSG, …)`: the last one of a line
    /// counts (`LinuxCNC`, "Messages").
    #[inline]
    pub(super) fn note_message(
        &self,
        line: u64,
        text: &[u8],
        block: &Block,
        steps: &mut Vec<Step>,
    ) -> bool {
        if block.words_end == block.text_end {
            return false;
        }
        let text = text.get(..block.text_end as usize).unwrap_or(text);
        if text.trim_ascii_end().ends_with(b")")
            && self.plans_ahead()
            && self.rules.comments_act
            && !self.ended
            && !self.block_delete.passes(block.delete_level)
            && let Some(place) = message(text)
        {
            steps.push(Step::Action(Action {
                line,
                kind: ActionKind::Message,
                value: place as f64,
            }));
            return true;
        }
        false
    }
}

/// Which of [`MESSAGES`] a line ends with.
pub(super) fn message(text: &[u8]) -> Option<usize> {
    let open = memchr::memrchr(b'(', text)?;
    let inside = text.get(open + 1..).unwrap_or_default();
    let mut letters = inside
        .iter()
        .filter(|byte| !matches!(byte, b' ' | b'\t'))
        .map(u8::to_ascii_uppercase);
    // The name and its comma; without one it is a comment like others.
    let word: arrayvec::ArrayVec<u8, 8> = letters.by_ref().take(8).collect();
    let named = |name: &&str| word.strip_prefix(name.as_bytes())?.first().copied();
    MESSAGES.iter().position(|name| named(name) == Some(b','))
}

#[cfg(test)]
mod tests {
    use super::message;

    #[test]
    fn the_last_comment_counts() {
        assert_eq!(message(b"(MSG, hello)"), Some(0));
        assert_eq!(message(b"G1 X1 (a) ( debug , #1)"), Some(1));
        assert_eq!(message(b"(print,1)"), Some(2));
        assert_eq!(message(b"(MSG, a) (then)"), None);
        assert_eq!(message(b"(MSGS, a)"), None);
        assert_eq!(message(b"(msg)"), None);
        assert_eq!(message(b"(msg\t,x)"), Some(0));
        assert_eq!(message(b"(DEBUG x)"), None);
        assert_eq!(message(b"G1 X1"), None);
    }
}
