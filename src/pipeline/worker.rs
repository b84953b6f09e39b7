//! Executed lines on their way from one thread to another.
//!
//! One thread reads and executes, the other judges. Lines go over by the hundred,
//! and their buffers come back.

use std::io::{self, Read, Seek};
use std::mem::replace;
use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use super::Failure;
use super::advice::Circumstances;
use super::executor::{Executor, Line};
use crate::interpret::Step;

/// A batch goes over when it has so many steps or bytes.
const STEPS: usize = 256;
const BYTES: usize = 1 << 16;
/// Batches that may wait.
const BATCHES: usize = 3;

/// Executed lines.
#[derive(Debug, Default)]
struct Batch {
    steps: Vec<Step>,
    text: Vec<u8>,
    lines: Vec<Executed>,
    /// From which line on what holds.
    circumstances: Vec<(usize, Circumstances)>,
    /// Where the text of a step is that belongs to an earlier line, by index.
    held: Vec<(usize, Range<usize>)>,
    /// Names of the files of subprograms that are new.
    files: Vec<String>,
}

/// Where in a batch the steps of a line end, and where its text is.
#[derive(Debug)]
struct Executed {
    steps_end: usize,
    text: Range<usize>,
    turns_knob: bool,
}

/// A line that has been executed, in its batch.
#[derive(Debug)]
pub(super) struct Relayed<'b> {
    batch: &'b Batch,
    steps: Range<usize>,
    text: Range<usize>,
    /// The line turns a knob.
    pub(super) turns_knob: bool,
    pub(super) circumstances: &'b Circumstances,
}

impl<'b> Relayed<'b> {
    pub(super) fn steps(&self) -> &'b [Step] {
        let steps = self.batch.steps.get(self.steps.clone());
        steps.unwrap_or_default()
    }

    /// The text of the line that one of the steps belongs to.
    #[inline]
    pub(super) fn text_of(&self, step: usize) -> &'b [u8] {
        let step = self.steps.start + step;
        let held = &self.batch.held;
        let found = held.binary_search_by_key(&step, |(index, _)| *index);
        let held = found.ok().and_then(|at| held.get(at));
        let text = held.map_or(&self.text, |(_, text)| text);
        self.batch.text.get(text.clone()).unwrap_or_default()
    }
}

impl Batch {
    fn is_full(&self) -> bool {
        self.steps.len() >= STEPS || self.text.len() >= BYTES
    }

    /// Adds a line, and takes its steps.
    #[inline]
    fn push(&mut self, line: &mut Line<'_, '_>) {
        let circumstances = Circumstances::of(line.interpreter);
        let last = self.circumstances.last();
        if last.is_none_or(|(_, last)| *last != circumstances) {
            self.circumstances.push((self.lines.len(), circumstances));
        }
        for (index, step) in line.steps.iter().enumerate() {
            if let Step::Move(mv) = step
                && (mv.text, mv.line) != line.key
            {
                let text = self.append(line.text_of(mv));
                self.held.push((self.steps.len() + index, text));
            }
        }
        let text = self.append(line.text);
        self.steps.append(line.steps);
        self.lines.push(Executed {
            steps_end: self.steps.len(),
            text,
            turns_knob: line.facts.turns_knob,
        });
    }

    #[inline]
    fn append(&mut self, text: &[u8]) -> Range<usize> {
        let start = self.text.len();
        self.text.extend_from_slice(text);
        start..self.text.len()
    }

    /// Hands its lines over.
    fn hand_over(
        &self,
        mut each: impl FnMut(&Relayed<'_>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut start = 0;
        for (index, (from, circumstances)) in self.circumstances.iter().enumerate() {
            let next = self.circumstances.get(index + 1);
            let to = next.map_or(self.lines.len(), |(to, _)| *to);
            for line in self.lines.get(*from..to).unwrap_or_default() {
                each(&Relayed {
                    batch: self,
                    steps: start..line.steps_end,
                    text: line.text.clone(),
                    turns_knob: line.turns_knob,
                    circumstances,
                })?;
                start = line.steps_end;
            }
        }
        Ok(())
    }

    /// Empties it and keeps its room, unless a line was far too long.
    fn clear(&mut self) {
        if self.steps.capacity() > 8 * STEPS || self.text.capacity() > 8 * BYTES {
            *self = Self::default();
        }
        self.steps.clear();
        self.text.clear();
        self.lines.clear();
        self.circumstances.clear();
        self.held.clear();
        self.files.clear();
    }
}

/// Executes a program in another thread, and hands over what it comes to: the
/// names of the files of subprograms so far, and a line. Gives the program's end back.
///
/// # Errors
/// Those of `each`, and of the program otherwise.
pub(super) fn relay<R: Read + Seek + Send>(
    front: Executor<'_, R>,
    mut each: impl FnMut(&[String], &Relayed<'_>) -> Result<(), Failure>,
) -> Result<Executor<'_, R>, Failure> {
    thread::scope(|scope| {
        let (sender, receiver) = sync_channel(BATCHES);
        let (back, empty) = sync_channel(BATCHES + 2);
        let handle = thread::Builder::new()
            .spawn_scoped(scope, move || execute(front, &sender, &empty))
            .map_err(|error| no_thread(&error))?;
        let taken = take(receiver, &back, &mut each);
        // A panic there is a fault of gwatt: it goes on here.
        let executed = handle.join().unwrap_or_else(|panic| resume_unwind(panic));
        taken.and(executed)
    })
}

/// A thread cannot be started.
pub(super) fn no_thread(error: &io::Error) -> Failure {
    Failure::Unsuitable(format!("cannot start a thread ({error}): give --threads 1"))
}

/// Reads and executes all lines, as long as somebody takes them.
fn execute<'m, R: Read + Seek>(
    mut front: Executor<'m, R>,
    sender: &SyncSender<Batch>,
    empty: &Receiver<Batch>,
) -> Result<Executor<'m, R>, Failure> {
    let mut batch = Batch::default();
    let mut files = 0;
    let end = loop {
        let mut line = match front.next_line() {
            Ok(Some(line)) => line,
            Ok(None) => break Ok(()),
            Err(failure) => break Err(failure),
        };
        if line.files.len() > files {
            batch.files.extend(line.files.iter().skip(files).cloned());
            files = line.files.len();
        }
        batch.push(&mut line);
        if batch.is_full() {
            let mut next: Batch = empty.try_recv().unwrap_or_default();
            next.clear();
            if sender.send(replace(&mut batch, next)).is_err() {
                break Ok(());
            }
        }
    };
    // Who has stopped taking them knows why.
    let _ = sender.send(batch);
    end.map(|()| front)
}

fn take(
    receiver: Receiver<Batch>,
    back: &SyncSender<Batch>,
    each: &mut impl FnMut(&[String], &Relayed<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut files = Vec::new();
    for mut batch in receiver {
        files.append(&mut batch.files);
        batch.hand_over(|line| each(&files, line))?;
        // A full channel of empty buffers only means one more allocation.
        let _ = back.try_send(batch);
    }
    Ok(())
}
