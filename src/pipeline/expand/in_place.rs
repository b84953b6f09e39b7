//! Places that stand in a subprogram, or in a section that is repeated: its blocks in place of
//! each call at which a canned cycle is in force.
//!
//! Input: a program, and the lines whose moves have to be lowered. Output: the program in which
//! those of them that calls run stand where the call did, since at each call another cycle may
//! drill there.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::ops::Range;

use super::origins::Origins;
use super::way::{LineWays, Way};
use crate::interpret::Passage;
use crate::machine::Machine;
use crate::pipeline::executor::{Executor, Line};
use crate::pipeline::{Failure, Options};
use crate::rewrite::CalledBlock;
use crate::source::lines;

/// The most lines that a call may become.
const LINES_MAX: usize = 10_000;

/// A program in which blocks stand in place of calls.
pub(super) struct InPlace {
    pub(super) text: Vec<u8>,
    origins: Origins,
    /// Those of its lines that come from files of subprograms, with the places there.
    in_files: BTreeMap<u64, Place>,
    /// Lines of the original that these calls ran, and the calls.
    pub(super) moved: BTreeSet<u64>,
    /// Where the lines of each call stand, by the line of the call.
    calls: BTreeMap<u64, Range<u64>>,
}

impl InPlace {
    /// The program with these lines in place of its calls.
    pub(super) fn new(program: &[u8], calls: &BTreeMap<u64, &[CalledLine]>) -> Self {
        let mut placed = Self {
            text: Vec::with_capacity(program.len() + program.len() / 4),
            origins: Origins::default(),
            in_files: BTreeMap::new(),
            moved: BTreeSet::new(),
            calls: BTreeMap::new(),
        };
        for (number, text) in (1..).zip(lines(program)) {
            let Some(call) = calls.get(&number) else {
                placed.text.extend_from_slice(text);
                placed.origins.push(number, 1);
                continue;
            };
            let first = placed.origins.len() + 1;
            for line in *call {
                // What is said of a file is said of the call.
                let (file, own) = &line.place;
                let origin = if file.is_some() { number } else { *own };
                placed.text.extend_from_slice(&line.bytes);
                placed.origins.push(origin, 1);
                placed.moved.insert(origin);
                if file.is_some() {
                    let here = placed.origins.len();
                    placed.in_files.insert(here, line.place.clone());
                }
            }
            let next = placed.origins.len() + 1;
            placed.calls.insert(number, first..next);
        }
        placed
    }

    /// The line of the original that a line comes from; 0 stays 0.
    pub(super) fn origin(&self, line: u64) -> u64 {
        self.origins.of(line)
    }

    /// How a line is asked to be written.
    pub(super) fn way(&self, asked: &LineWays, line: u64) -> Option<Way> {
        match self.in_files.get(&line) {
            Some((file, line)) => asked.way(file.as_deref(), *line),
            None => asked.way(None, self.origin(line)),
        }
    }

    /// How many calls were replaced.
    pub(super) fn calls(&self) -> usize {
        self.calls.len()
    }

    /// Whether any of these lines stands in place of a call.
    pub(super) fn holds_any(&self, call: u64, lines: &BTreeSet<u64>) -> bool {
        let range = self.calls.get(&call).cloned().unwrap_or_default();
        lines.range(range).next().is_some()
    }
}

/// A file of subprograms by its name, or the program itself, and the number of a line.
type Place = (Option<String>, u64);

/// A line that a call becomes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CalledLine {
    /// Where it comes from.
    place: Place,
    bytes: Vec<u8>,
}

/// A call at which a canned cycle is in force.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Call {
    /// What it becomes, or why it stays.
    pub(super) lines: Result<Vec<CalledLine>, &'static str>,
    /// What it runs.
    runs: BTreeSet<Place>,
}

impl Call {
    /// Whether it runs one of the lines that are asked for, or of these.
    pub(super) fn runs(&self, asked: &LineWays, others: &BTreeSet<u64>) -> bool {
        let is_asked = |(file, line): &Place| asked.way(file.as_deref(), *line).is_some();
        self.runs.iter().any(is_asked) || self.lines_here().any(|line| others.contains(&line))
    }

    /// The lines of the program itself that it runs.
    pub(super) fn lines_here(&self) -> impl Iterator<Item = u64> {
        let here = self.runs.iter().filter(|(file, _)| file.is_none());
        here.map(|(_, line)| *line)
    }
}

/// All calls at which a canned cycle is in force, on all `paths` through the program.
pub(super) fn calls(
    program: &[u8],
    machine: &Machine,
    paths: &[Options],
) -> Result<BTreeMap<u64, Call>, Failure> {
    let mut all = BTreeMap::new();
    for options in paths {
        let mut front = Executor::new(Cursor::new(program), machine, options);
        let to_line_end = machine
            .controller
            .language
            .family
            .facts()
            .comment_to_line_end;
        let mut open: Option<Open> = None;
        while let Some(line) = front.next_line()? {
            if let Some(call) = open.take_if(|call| line.depth <= call.depth) {
                call.close(&mut all);
            }
            if let Some(call) = &mut open {
                call.take(&line, to_line_end);
            } else if line.facts.passage == Passage::Call
                && line.key.0 == 0
                && line.interpreter.drills_at_places()
            {
                open = Some(Open::new(&line, to_line_end));
            }
        }
        if let Some(call) = open {
            call.close(&mut all);
        }
    }
    Ok(all)
}

/// A call that has not returned.
struct Open {
    line: u64,
    depth: usize,
    call: Call,
}

impl Open {
    fn new(line: &Line<'_, '_>, to_line_end: bool) -> Self {
        let number = line.key.1;
        let comment = called(line, to_line_end).as_comment();
        Self {
            line: number,
            depth: line.depth,
            call: Call {
                lines: comment.map(|bytes| {
                    let place = (None, number);
                    vec![CalledLine { place, bytes }]
                }),
                runs: BTreeSet::new(),
            },
        }
    }

    /// Takes a line that it runs.
    fn take(&mut self, line: &Line<'_, '_>, to_line_end: bool) {
        let (text, number) = line.key;
        let file = text.checked_sub(1);
        let file = file.and_then(|index| line.files.get(usize::from(index)).cloned());
        let place = (file, number);
        self.call.runs.insert(place.clone());
        let Ok(lines) = &mut self.call.lines else {
            return;
        };
        match called(line, to_line_end).in_place() {
            Ok(Some(bytes)) if lines.len() < LINES_MAX => {
                lines.push(CalledLine { place, bytes });
            }
            Ok(Some(_)) => self.call.lines = Err(TOO_LONG),
            Ok(None) => {}
            Err(why) => self.call.lines = Err(why),
        }
    }

    /// It has returned: the call does the same in all its runs, or stays.
    fn close(self, all: &mut BTreeMap<u64, Call>) {
        match all.entry(self.line) {
            Entry::Vacant(place) => {
                place.insert(self.call);
            }
            Entry::Occupied(mut place) => {
                let known = place.get_mut();
                if known.lines.is_ok() && known.lines != self.call.lines {
                    known.lines = self.call.lines.and(Err(DIFFERS));
                }
                known.runs.extend(self.call.runs);
            }
        }
    }
}

fn called<'l>(line: &'l Line<'_, '_>, comment_to_line_end: bool) -> CalledBlock<'l> {
    CalledBlock {
        text: line.text,
        block: line.block,
        passage: line.facts.passage,
        comment_to_line_end,
    }
}

/// Why a call stays.
const DIFFERS: &str = "a call that runs other lines each time";
const TOO_LONG: &str = "more than 10,000 lines";
