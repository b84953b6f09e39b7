//! Blocks that run again and again, without their text.
//!
//! While such a block is read, the steps to its values are recorded. Its next
//! runs follow them. Where a run comes to anything else than the recorded one
//! did, a wrong value above all, the text is read as if there were no record.

mod run;

use arrayvec::ArrayVec;

use crate::expression::{Name, Op, Reader, Value};
use crate::jump::Transfer;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Word};

/// Assignments of a block that is recorded.
const ASSIGNMENTS_MAX: usize = 8;
/// The run of a line that is recorded: most lines of a program run once.
const FIRST_RUN: u32 = 3;
/// Lines that may have a record, and bytes of all records.
const LINES_MAX: usize = 1 << 20;
const BYTES_MAX: usize = 1 << 26;

/// How a block was read.
#[derive(Debug)]
pub(crate) struct Trace {
    text: Box<[u8]>,
    ops: Vec<Op>,
    items: Vec<Item>,
    transfer: Option<Transfer>,
    words_end: u32,
}

/// What was read, in the order of the text. `end` is where the steps to its
/// value end.
#[derive(Debug)]
enum Item {
    Word {
        word: Word,
        end: usize,
    },
    Assign {
        name: Target,
        span: Span,
        end: usize,
    },
    /// A condition that was so.
    Guard {
        holds: bool,
        end: usize,
    },
    /// The condition of the transfer.
    Condition {
        end: usize,
    },
    /// A value of the transfer: of `repeat`, `endsub` and `return`.
    Value {
        end: usize,
    },
    /// The arguments of a call, one by one.
    Argument {
        end: usize,
    },
}

/// What is assigned.
#[derive(Debug)]
pub(super) enum Target {
    Known(Name<'static>),
    /// Its number is worked out; the end of the steps to it.
    Number(usize),
}

impl Target {
    /// The name of what is assigned was read, from step `from` on.
    pub(super) fn read(name: &Name<'_>, from: usize, reader: &mut Reader<'_>) -> Option<Target> {
        if !reader.tape.records {
            return None;
        }
        Some(match name {
            Name::Text(text) => Target::Known(Name::Text(text.to_string().into())),
            Name::Number(number) if reader.tape.forget_number(from) => {
                Target::Known(Name::Number(*number))
            }
            Name::Number(_) => Target::Number(reader.tape.ops.len()),
        })
    }
}

/// Notes what is read.
#[derive(Debug, Default)]
pub(super) struct Recorder {
    items: Vec<Item>,
    /// Something was read that items do not show.
    pub(super) lost: bool,
    /// Where the block goes on if its condition holds.
    pub(super) goes: Option<Transfer>,
}

/// What the steps of a value are for.
#[derive(Debug, Clone, Copy)]
pub(super) enum For {
    Word(Word),
    Guard(bool),
    Condition,
    Value,
    Argument,
}

impl Recorder {
    /// A value was read.
    pub(super) fn value(&mut self, what: For, reader: &Reader<'_>) {
        if !reader.tape.records {
            return;
        }
        let end = reader.tape.ops.len();
        self.items.push(match what {
            For::Word(word) => Item::Word { word, end },
            For::Guard(holds) => Item::Guard { holds, end },
            For::Condition => Item::Condition { end },
            For::Value => Item::Value { end },
            For::Argument => Item::Argument { end },
        });
    }

    /// The value for it was read too.
    pub(super) fn assign(&mut self, target: Option<Target>, span: Span, reader: &Reader<'_>) {
        let end = reader.tape.ops.len();
        if let Some(name) = target {
            self.items.push(Item::Assign { name, span, end });
        }
    }

    /// A value was read that is part of what is recorded: the same in every
    /// run, if it is written as a number.
    pub(super) fn fixed(&mut self, from: usize, reader: &mut Reader<'_>) {
        self.lost |= reader.tape.records && !reader.tape.forget_number(from);
    }

    /// The record of a block that was read.
    pub(super) fn finish(
        self,
        text: &[u8],
        reader: Reader<'_>,
        transfer: Option<&Transfer>,
        block: &Block,
    ) -> Option<Box<Trace>> {
        let transfer = self.goes.as_ref().or(transfer);
        let assigns = |item: &&Item| matches!(item, Item::Assign { .. });
        let tape = reader.tape;
        if !tape.records
            || tape.lost
            || self.lost
            || self.items.iter().filter(assigns).count() > ASSIGNMENTS_MAX
        {
            return None;
        }
        Some(Box::new(Trace {
            text: Box::from(text),
            ops: tape.ops,
            items: self.items,
            transfer: transfer.cloned(),
            words_end: block.words_end,
        }))
    }
}

/// The records of lines, by text and line.
#[derive(Debug, Default)]
pub(crate) struct Traces {
    lines: Vec<Vec<Slot>>,
    count: usize,
    bytes: usize,
}

#[derive(Debug, Default)]
enum Slot {
    #[default]
    Empty,
    /// It cannot be recorded.
    Never,
    Trace(Box<Trace>),
}

impl Traces {
    /// Whether a line should be recorded.
    pub(crate) fn wants(&self, text: u16, line: u64, run: u32) -> bool {
        run >= FIRST_RUN
            && (line as usize) < LINES_MAX
            && self.bytes < BYTES_MAX
            && !matches!(self.slot(text, line), Some(Slot::Never))
    }

    fn slot(&self, text: u16, line: u64) -> Option<&Slot> {
        self.lines.get(usize::from(text))?.get(line as usize)
    }

    /// Takes the record of a line out.
    fn take(&mut self, text: u16, line: u64) -> Option<Box<Trace>> {
        let lines = self.lines.get_mut(usize::from(text))?;
        let slot = lines.get_mut(line as usize)?;
        match slot {
            Slot::Trace(_) => match std::mem::take(slot) {
                Slot::Trace(trace) => Some(trace),
                _ => None,
            },
            _ => None,
        }
    }

    /// Puts it back.
    fn put(&mut self, text: u16, line: u64, trace: Box<Trace>) {
        let lines = self.lines.get_mut(usize::from(text));
        if let Some(slot) = lines.and_then(|lines| lines.get_mut(line as usize)) {
            *slot = Slot::Trace(trace);
        }
    }

    /// Keeps the record of a line, or that it has none.
    pub(crate) fn keep(&mut self, text: u16, line: u64, trace: Option<Box<Trace>>) {
        let (text, line) = (usize::from(text), line as usize);
        if self.lines.len() <= text {
            self.lines.resize_with(text + 1, Vec::new);
        }
        let Some(lines) = self.lines.get_mut(text) else {
            return;
        };
        if lines.len() <= line {
            let more = line + 1 - lines.len();
            if self.count + more > LINES_MAX {
                return;
            }
            self.count += more;
            lines.resize_with(line + 1, Slot::default);
        }
        if let Some(slot) = lines.get_mut(line) {
            if let Slot::Trace(before) = slot {
                self.bytes -= before.size();
            }
            self.bytes += trace.as_ref().map_or(0, |trace| trace.size());
            *slot = trace.map_or(Slot::Never, Slot::Trace);
        }
    }
}

/// What a run of a recorded block comes to besides its words.
struct Outcome {
    assignments: ArrayVec<(Value, Option<u32>), ASSIGNMENTS_MAX>,
    transfer: Option<Transfer>,
}

impl Trace {
    fn size(&self) -> usize {
        size_of::<Self>()
            + self.text.len()
            + self.ops.len() * size_of::<Op>()
            + self.items.len() * size_of::<Item>()
    }
}
