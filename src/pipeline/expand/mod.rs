//! Canned cycles written out as single blocks, and returns to the reference point with their
//! way gone before: all of that can then be limited like other moves.
//!
//! Input: a program, and the lines whose moves have to be lowered. Output: the program with
//! the cycles of these lines written out, from the block that begins each of them to the one
//! that ends it, and for each of its lines the one that it comes from. It is read again and
//! compared with the original step by step, so it makes the same moves or is not passed on.

mod called;
mod compare;
mod kept;
mod returns;
mod series;
mod trace;
mod turning;

use std::collections::BTreeMap;
use std::io::Cursor;

use kept::Notes;
use series::{Lines, Series, add};

use super::executor::{Executor, Line};
use super::{Failure, LimitSummary, Options, Summary};
pub(super) use kept::{NOT_WRITTEN_OUT, explain};
pub(super) use trace::{OriginalRows, Traced, WRITTEN_OUT};

use crate::diagnostic::Diagnostic;
use crate::interpret::{Interpreter, NO_POINT, Step};
use crate::limit::{NO_KNOB, UNTOUCHABLE};
use crate::machine::Machine;
use crate::rewrite::{CycleBlock, Singles};
use crate::source::lines;
use crate::syntax::{Block, Word};

/// A program with cycles written out.
pub(super) struct Expanded {
    pub(super) text: Vec<u8>,
    /// For each of its lines the line of the original that it comes from, from 1.
    origins: Vec<u64>,
    /// N words of the blocks that were written in another way, by line of the original.
    n_words: BTreeMap<u64, f64>,
    /// How many blocks were written out.
    pub(super) blocks: usize,
}

impl Expanded {
    /// The line of the original that a line comes from; 0 stays 0.
    pub(super) fn origin(&self, line: u64) -> u64 {
        let index = line.checked_sub(1);
        let origin = index.and_then(|index| self.origins.get(index as usize));
        origin.copied().unwrap_or(line)
    }

    /// Whether a line of the original stands as it was.
    fn stands(&self, line: u64) -> bool {
        let first = self.origins.partition_point(|origin| *origin < line);
        self.origins.get(first + 1) != Some(&line)
    }
}

/// How the moves of canned cycles are made known to the limiter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// The way to each hole stands on a line of its own.
    Placed,
    /// All moves do.
    WrittenOut,
}

/// Whether blocks that may not be changed, as those of canned cycles and returns to the
/// reference point, are among the reasons.
pub(super) fn in_fixed_blocks(summary: &LimitSummary) -> bool {
    let mut reasons = summary.reasons.iter();
    summary.reasons.len() >= Summary::KEPT
        || reasons.any(|it| [UNTOUCHABLE, NO_KNOB].contains(&it.rule))
}

/// Writes cycles in another way where `way` asks for that of one of their lines; it holds
/// on all `paths` through the program. The second result says why others stay as they are.
pub(super) fn expand(
    program: &[u8],
    machine: &Machine,
    paths: &[Options],
    way: impl Fn(u64) -> Option<Way>,
) -> Result<(Option<Expanded>, Vec<Diagnostic>), Failure> {
    let mut notes = Notes::default();
    // By their first lines.
    let (mut written, mut levels) = (BTreeMap::new(), BTreeMap::new());
    let (mut kept, mut n_words) = (BTreeMap::new(), BTreeMap::new());
    for series in survey(program, machine, paths)? {
        let mut ways = series.numbers.keys().filter_map(|line| way(*line));
        let first = ways.next();
        let asked = if ways.any(|way| way == Way::WrittenOut) {
            Some(Way::WrittenOut)
        } else {
            first
        };
        let numbers = series.numbers;
        let lines = match asked {
            None => {
                kept.extend(series.level);
                continue;
            }
            Some(Way::WrittenOut) => series.written_out.or_else(|(line, why)| {
                notes.stays(line, series.stays, why, program);
                series.placed
            }),
            Some(Way::Placed) => series.placed,
        };
        match lines {
            Ok(lines) => {
                let Some(first) = lines.keys().next().copied() else {
                    continue;
                };
                written.insert(first, (series.stays, lines));
                levels.extend(series.level.map(|level| (first, level)));
                let named = numbers.into_iter();
                n_words.extend(named.filter_map(|(line, word)| Some((line, word?))));
            }
            Err((line, why)) => {
                notes.stays(line, series.stays, why, program);
                kept.extend(series.level);
            }
        }
    }
    loop {
        if written.is_empty() {
            return Ok((None, notes.list));
        }
        let mut lines: BTreeMap<u64, Vec<u8>> = kept.clone();
        lines.extend(
            written
                .values()
                .flat_map(|(_, lines)| lines)
                .map(|(line, bytes)| (*line, bytes.clone())),
        );
        let expanded = put_together(program, &lines, &n_words);
        let mut different = None;
        for options in paths {
            if different.is_none() {
                different = compare::first_difference(program, &expanded.text, machine, options)?;
            }
        }
        let Some(line) = different else {
            return Ok((Some(expanded), notes.list));
        };
        // The last series before the place stays as it is.
        let line = expanded.origin(line);
        let place = written.range(..=line).next_back().map(|(first, _)| *first);
        let Some((stays, lines)) = place.and_then(|first| written.remove(&first)) else {
            return Ok((None, notes.list));
        };
        kept.extend(levels.remove(lines.keys().next().unwrap_or(&0)));
        notes.stays(
            line,
            stays,
            "written in another way it would not move as it does",
            program,
        );
    }
}

/// All series of cycle blocks. Those that share lines, since they run several times, are
/// one.
fn survey(program: &[u8], machine: &Machine, paths: &[Options]) -> Result<Vec<Series>, Failure> {
    let language = &machine.controller.language;
    let mut all: Vec<Series> = Vec::new();
    if language.family.facts().writes_out_cycles {
        let mut assumed = false;
        for options in paths {
            assumed |= survey_path(program, machine, options, &mut all)?;
        }
        // Places that are written with a point would be others than the program's.
        for series in all.iter_mut().filter(|_| assumed) {
            if let Some(line) = series.numbers.keys().next().copied() {
                series.refuse(line, WITHOUT_POINT);
            }
        }
    }
    Ok(all)
}

/// Why a block of a cycle stays as it is.
fn stays(line: &Line<'_, '_>) -> Option<&'static str> {
    let facts = &line.facts;
    if line.key.0 != 0 {
        return Some("it stands in the file of a subprogram");
    }
    let may_differ = line.block.delete_level > 0 || facts.checksum || facts.computed_feed;
    may_differ.then_some("its block may be skipped, or is worked out by the program")
}

/// Adds a block of a cycle to its series, in both ways in which it may be written.
fn take_in(
    series: &mut Series,
    (number, block): (u64, &Block),
    cycle: &CycleBlock<'_>,
    (interpreter, singles): (&Interpreter<'_>, &Singles<'_>),
) {
    let to_r = interpreter.returns_to_r();
    if series.numbers.is_empty() {
        let level = singles.with_level(cycle, to_r);
        series.level = level.map(|bytes| (number, bytes));
    }
    for word in &cycle.block.words {
        if HELD.contains(&word.letter) {
            let text = word.span.of(cycle.text).to_vec();
            series.held.insert(word.letter, text);
        }
    }
    let place = |place: &_| interpreter.place_in_program(place);
    let placed = singles.place_before(cycle, &series.held, to_r, place);
    add(&mut series.placed, number, placed);
    add(
        &mut series.written_out,
        number,
        singles.write_out(cycle, &series.held, to_r, place),
    );
    let n_word = block.number.map(|word| word.value);
    series.numbers.insert(number, n_word);
}

/// The series on one path through the program. True where numbers without a point count as
/// whole units, and the control may take them otherwise.
fn survey_path(
    program: &[u8],
    machine: &Machine,
    options: &Options,
    all: &mut Vec<Series>,
) -> Result<bool, Failure> {
    let singles = Singles::new(machine);
    let lathe = machine.controller.language.dialect.lathe.is_some();
    let mut front = Executor::new(Cursor::new(program), machine, options);
    let mut open: Option<Series> = None;
    // What comes next taps without a chuck that gives way.
    let mut rigid = false;
    let mut texts: Option<Vec<&[u8]>> = None;
    let mut before = returns::Before::of(front.interpreter().modal());
    // The radius of the tool's nose is compensated.
    let mut compensated = false;
    while let Some(line) = front.next_line()? {
        let (facts, interpreter) = (&*line.facts, line.interpreter);
        if let Some(cycle) = facts.called {
            let texts = texts.get_or_insert_with(|| lines(program).collect());
            close(
                &mut Some(called::series(&line, cycle, texts, &singles)),
                all,
            );
        } else if !facts.cycle {
            if !interpreter.in_cycle() {
                rigid &= open.is_none();
                close(&mut open, all);
            }
            rigid |= line.block.words.iter().any(is_rigid);
            if facts.reference.is_some() || facts.machine_coordinates {
                close(&mut returns::series(&line, &before, machine), all);
            }
        }
        before = returns::Before::of(interpreter.modal());
        // What a contour has switched on is a matter of its cycle.
        let by_contour = facts.contour.is_some() && !compensated;
        let after = interpreter.chooses_radius() && !by_contour;
        let compensated = std::mem::replace(&mut compensated, after);
        if !facts.cycle {
            continue;
        }
        let number = line.key.1;
        let fixed = stays(&line);
        if lathe && let Some(word) = turning::word(line.block) {
            close(&mut open, all);
            // One that only gives values for the next cycle moves nothing, and stays.
            if line.steps.iter().any(Step::moves_axes) {
                let series = turning::series(&line, (word, compensated), fixed, program, &singles);
                close(&mut Some(series), all);
            }
            continue;
        }
        // A block that says all of a cycle depends on none before it, save that increments
        // begin at the level of the first.
        let has = |letter| line.block.words.iter().any(|word| word.letter == letter);
        let says_all = facts.motion_word.is_some() && has(b'R') && has(b'Z');
        if !lathe && says_all && interpreter.modal().absolute {
            close(&mut open, all);
        }
        let series = open.get_or_insert_default();
        if lathe {
            series.stays = turning::STAYS;
        }
        rigid |= line.block.words.iter().any(is_rigid);
        let taps = TAPS.contains(&interpreter.cycle()) && singles.motion_survives_cycles();
        let fixed = fixed.or((rigid && taps).then_some(RIGID));
        let turned = || {
            turning::stays(&line, interpreter.cycle(), interpreter.chooses_radius())
                .filter(|_| lathe)
        };
        let fixed = fixed.or_else(turned);
        if let Some(why) = fixed {
            series.refuse(number, why);
            continue;
        }
        let cycle = cycle_of(&line);
        take_in(
            series,
            (number, line.block),
            &cycle,
            (interpreter, &singles),
        );
    }
    close(&mut open, all);
    let mut notes = front.diagnostics.list.iter();
    Ok(notes.any(|note| note.rule == NO_POINT))
}

/// A block of a cycle that holds until it is ended.
fn cycle_of<'l>(line: &'l Line<'_, '_>) -> CycleBlock<'l> {
    let interpreter = line.interpreter;
    let turning = turning_word(line.block).filter(|_| !interpreter.in_cycle());
    CycleBlock {
        text: line.text,
        block: line.block,
        cycle_word: turning.or(line.facts.motion_word).map(|word| word.span),
        number: turning.map_or(interpreter.cycle(), |word| {
            (word.value * 10.0).round() as u16
        }),
        steps: line.steps,
        modal: interpreter.modal(),
        motion_before: interpreter.motion_before_cycle(),
    }
}

/// The word of a turning cycle along a contour, which is not modal.
fn turning_word(block: &Block) -> Option<Word> {
    let turning = |word: &&Word| word.letter == b'G' && (70.0..73.0).contains(&word.value);
    block.words.iter().find(turning).copied()
}

/// Whether a word announces rigid tapping, in which nothing may come between it and the taps.
fn is_rigid(word: &Word) -> bool {
    word.letter == b'M' && word.value == 29.0
}

/// Tapping cycles, times ten.
const TAPS: [u16; 2] = [740, 840];
/// Why such a tap stays as it is.
const RIGID: &str = "M29 before it makes it rigid, which ends with any other motion word";
/// Why nothing is written in another way where places could mean something else then.
const WITHOUT_POINT: &str = "numbers of the program have no decimal point, and what they mean is \
     not known: say decimal_point under [language] of the machine file";
/// Words that hold until a cycle ends.
const HELD: &[u8] = b"ZRQPIJ";

/// The series that is open has ended.
fn close(open: &mut Option<Series>, all: &mut Vec<Series>) {
    let Some(series) = open.take() else { return };
    let own = &series.numbers;
    let shares = |other: &Series| other.numbers.keys().any(|line| own.contains_key(line));
    // Only lines that run several times are shared: there are few of those.
    let first = all.iter().position(shares);
    let Some(first) = first else {
        return all.push(series);
    };
    let mut joined = all.swap_remove(first);
    joined.join(series);
    let mut rest = Some(joined);
    close(&mut rest, all);
}

/// The program with lines in place of others.
fn put_together(
    program: &[u8],
    written: &BTreeMap<u64, Vec<u8>>,
    n_words: &BTreeMap<u64, f64>,
) -> Expanded {
    let mut expanded = Expanded {
        text: Vec::with_capacity(program.len() + program.len() / 4),
        origins: Vec::new(),
        n_words: n_words.clone(),
        blocks: written.len(),
    };
    for (number, text) in (1..).zip(lines(program)) {
        let bytes = written.get(&number).map_or(text, Vec::as_slice);
        expanded.text.extend_from_slice(bytes);
        expanded.origins.extend(lines(bytes).map(|_| number));
    }
    expanded
}
