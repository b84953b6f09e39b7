//! Cycles that are called by their names, each time that a block has moved or where they
//! stand (SINUMERIK): their moves as single blocks, or the call after each block that moves.
//!
//! Input: the block, what it does, and places in the coordinates and units of the program.
//! Output: its lines. Whether they do the same is checked by the pipeline, which reads them
//! again.

use super::number::decimal;
use super::single::{CycleBlock, Lines, Singles, one_action};
use crate::interpret::{CalledCycle, FeedMode, Modal, Motion, Step};
use crate::machine::AxisValues;
use crate::source::split_line_end;
use crate::syntax::Block;
use crate::units::SECONDS_PER_MINUTE;

/// The number under which moves of such cycles are written: plain drilling, times ten.
const DRILLING: u16 = 810;

/// A block that calls a cycle.
#[derive(Debug, Clone, Copy)]
pub struct CallingBlock<'a> {
    /// The line, line end included.
    pub text: &'a [u8],
    /// Its words.
    pub block: &'a Block,
    /// What it does.
    pub steps: &'a [Step],
    /// What it calls.
    pub called: CalledCycle,
    /// The state after it.
    pub modal: &'a Modal,
}

impl CallingBlock<'_> {
    /// Whether the cycle, or the pattern at whose places it runs, stands in the block.
    fn stands_in_it(&self) -> bool {
        self.called.set_at.is_none() || self.called.pattern
    }
}

impl Singles<'_> {
    /// The block without the cycle, and after it the moves of the cycle as single blocks.
    ///
    /// # Errors
    /// Why they cannot be said in single blocks.
    pub fn write_called_out(
        &self,
        of: &CallingBlock<'_>,
        place: impl Fn(&AxisValues) -> AxisValues,
    ) -> Result<Vec<u8>, &'static str> {
        if !of.called.plain {
            return Err("it taps, or turns the spindle to a place");
        }
        if of.stands_in_it() && !only_calls(of.text) {
            return Err("its block does more than call it");
        }
        let after = match of.modal.motion {
            Motion::Rapid => "G0",
            Motion::Linear => "G1",
            _ => return Err("the motion word in force is neither G0 nor G1"),
        };
        let cycle = CycleBlock {
            text: of.text,
            block: of.block,
            cycle_word: None,
            number: DRILLING,
            steps: of.steps.get(of.called.own_steps..).unwrap_or_default(),
            modal: of.modal,
            motion_before: of.modal.motion,
        };
        let mut lines = Lines::new(&cycle, &place);
        if let (Some(feed), FeedMode::PerMinute) = (&of.modal.feed, of.modal.feed_mode) {
            lines.feed_mm_s = Some(feed.value * feed.mm_per_unit / SECONDS_PER_MINUTE);
        }
        let in_force_mm_s = lines.feed_mm_s;
        lines.out = block_alone(of);
        for step in cycle.steps {
            match step {
                Step::Move(mv) => self.one_move(mv, &cycle, &place, &mut lines)?,
                Step::Action(action) => one_action(action, &mut lines)?,
            }
        }
        if let (Some(feed), true) = (&of.modal.feed, lines.feed_mm_s != in_force_mm_s) {
            lines.push(&format!("F{}", decimal(feed.value, true)));
        }
        if lines.motion.is_some_and(|last| last != of.modal.motion) {
            lines.push(after);
        }
        Ok(lines.finish(of.text))
    }

    /// The block without the cycle, and after it the `call` on a line of its own.
    ///
    /// # Errors
    /// Why that cannot be.
    pub fn call_after(of: &CallingBlock<'_>, call: &[u8]) -> Result<Vec<u8>, &'static str> {
        if of.called.pattern {
            return Err("its holes are those of a pattern");
        }
        if of.stands_in_it() {
            return Err("its first move is not the way to the hole");
        }
        if !has_plain_arguments(call) {
            return Err("its arguments are worked out by the program");
        }
        let mut out = block_alone(of);
        out.extend_from_slice(call);
        out.extend_from_slice(line_end(of.text));
        if split_line_end(of.text).1.is_empty() {
            out.truncate(out.len() - line_end(of.text).len());
        }
        Ok(out)
    }
}

/// The line of `MCALL` with a cycle as a comment after its number, and the call that it
/// makes; `None` where it says more.
#[must_use]
pub fn without_modal_call(line: &[u8]) -> Option<(Vec<u8>, &[u8])> {
    let (text, _) = split_line_end(line);
    let start = call_start(text)?;
    let rest = &text[start..];
    let word = rest.get(..MCALL.len())?;
    if !word.eq_ignore_ascii_case(MCALL) {
        return None;
    }
    let call = rest[MCALL.len()..].trim_ascii_start();
    let end = call.iter().position(|byte| *byte == b')')? + 1;
    only_calls(call).then(|| (commented(line, start), &call[..end]))
}

/// Whether nothing but a comment comes after a call, which ends with the first parenthesis
/// that closes.
fn only_calls(text: &[u8]) -> bool {
    let (text, _) = split_line_end(text);
    let Some(end) = text.iter().position(|byte| *byte == b')') else {
        return false;
    };
    let rest = text[end + 1..].trim_ascii();
    rest.is_empty() || rest.starts_with(b";")
}

const MCALL: &[u8] = b"MCALL";

/// Where a block begins after its number.
fn call_start(text: &[u8]) -> Option<usize> {
    let blanks = |text: &[u8]| text.len() - text.trim_ascii_start().len();
    let mut start = blanks(text);
    if text.get(start)?.eq_ignore_ascii_case(&b'N') {
        let digits = text[start + 1..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit());
        let count = digits.count();
        if count > 0 {
            start += 1 + count;
            start += blanks(&text[start..]);
        }
    }
    Some(start)
}

/// A line of which what begins at `start` is a comment.
fn commented(line: &[u8], start: usize) -> Vec<u8> {
    let mut out = line[..start].to_vec();
    out.push(b';');
    out.extend_from_slice(&line[start..]);
    out
}

/// The block as it moves without the cycle: a line end after it, or, where the cycle stands
/// in it, the call as a comment.
fn block_alone(of: &CallingBlock<'_>) -> Vec<u8> {
    let mut out = if of.stands_in_it() {
        commented(of.text, call_start(of.text).unwrap_or(0))
    } else {
        of.text.to_vec()
    };
    if split_line_end(of.text).1.is_empty() {
        out.extend_from_slice(line_end(of.text));
    }
    out
}

fn line_end(text: &[u8]) -> &[u8] {
    let (_, end) = split_line_end(text);
    if end.is_empty() { b"\n" } else { end }
}

/// Whether the arguments of a call are plain numbers.
fn has_plain_arguments(call: &[u8]) -> bool {
    let arguments = call.iter().position(|byte| *byte == b'(');
    arguments.is_some_and(|at| {
        let mut bytes = call[at + 1..].iter();
        bytes.all(|byte| byte.is_ascii_digit() || b"+-., \t)".contains(byte))
    })
}
