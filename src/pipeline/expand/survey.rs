//! The series of cycle blocks, and the returns to the reference point, of a program.

use std::collections::BTreeSet;
use std::io::Cursor;

use super::rigid::{Rigid, TAPS, Tapping};
use super::series::Series;
use super::way::LineWays;
use super::{called, returns, turning};
use crate::interpret::{NO_POINT, Step};
use crate::machine::Machine;
use crate::pipeline::executor::{Executor, Line};
use crate::pipeline::{Failure, Options};
use crate::rewrite::{CycleBlock, Singles};
use crate::source::lines;
use crate::syntax::{Block, Word};

/// What was found in a program.
#[derive(Default)]
pub(super) struct Survey {
    /// Series of cycle blocks. Those that share lines, since they run several times, are one.
    pub(super) series: Vec<Series>,
    /// Blocks of cycles in files of subprograms, by the names of the files.
    in_files: BTreeSet<(String, u64)>,
}

impl Survey {
    /// Looks at all `paths` through a program.
    pub(super) fn of(
        program: &[u8],
        machine: &Machine,
        paths: &[Options],
    ) -> Result<Self, Failure> {
        let language = &machine.controller.language;
        let mut survey = Self::default();
        if language.family.facts().writes_out_cycles {
            let mut assumed = false;
            for options in paths {
                assumed |= survey_path(program, machine, options, &mut survey)?;
            }
            // Places that are written with a point would be others than the program's.
            for series in survey.series.iter_mut().filter(|_| assumed) {
                series.refuse_all(WITHOUT_POINT);
            }
        }
        Ok(survey)
    }

    /// Whether places that are asked for stand in a file.
    pub(super) fn drills_in_files(&self, asked: &LineWays) -> bool {
        let mut in_files = self.in_files.iter();
        in_files.any(|(file, line)| asked.way(Some(file), *line).is_some())
    }

    /// The lines of series that are asked for and do something else each time they run.
    pub(super) fn lines_that_differ(&self, asked: &LineWays) -> BTreeSet<u64> {
        let asks = |series: &&Series| {
            let mut lines = series.numbers.keys();
            series.differs() && lines.any(|line| asked.way(None, *line).is_some())
        };
        let series = self.series.iter().filter(asks);
        series
            .flat_map(|series| series.numbers.keys().copied())
            .collect()
    }
}

/// Why a block of a cycle stays as it is.
fn stays(line: &Line<'_, '_>, lathe: bool) -> Option<&'static str> {
    let facts = &line.facts;
    let may_differ = facts.checksum || facts.computed_feed;
    if lathe && line.block.delete_level > 0 {
        return Some("its block may be skipped");
    }
    may_differ.then_some("its block is worked out by the program, or has a checksum")
}

/// Lines in place of one, each skipped where that is.
fn skipped_alike(bytes: Vec<u8>, level: u8) -> Vec<u8> {
    let prefix = match level {
        0 => return bytes,
        1 => "/".to_owned(),
        level => format!("/{level} "),
    };
    let mut out = Vec::with_capacity(bytes.len() + 16);
    for line in lines(&bytes) {
        if !line.starts_with(b"/") {
            out.extend_from_slice(prefix.as_bytes());
        }
        out.extend_from_slice(line);
    }
    out
}

/// Adds a block of a cycle to its series, in both ways in which it may be written and as it
/// stays. `fixed` says why it has to stay, and `rigid` what lets its tap be rigid.
fn take_in(
    series: &mut Series,
    line: &Line<'_, '_>,
    (fixed, rigid): (Option<&'static str>, Option<&Rigid>),
    singles: &Singles<'_>,
) {
    let (number, interpreter) = (line.key.1, line.interpreter);
    let cycle = &cycle_of(line);
    let to_r = interpreter.returns_to_r();
    if series.numbers.is_empty() {
        let level = singles.with_level(cycle, to_r);
        series.level = level.map(|bytes| (number, bytes));
    }
    for word in &cycle.block.words {
        if singles.holds(word.letter) {
            let text = word.span.of(cycle.text).to_vec();
            series.held.insert(word.letter, text);
        }
    }
    let n_word = line.block.number.map(|word| word.value);
    series.numbers.insert(number, n_word);
    let again = singles.restated(cycle, &series.held, to_r);
    // Whether a tap that stays is rigid there depends on the ones before it.
    let follows = rigid.is_some_and(|rigid| !rigid.last);
    let again = again.filter(|_| !line.facts.checksum && !follows);
    series.restate(number, again.as_ref());
    if let Some(why) = fixed {
        return series.refuse(number, why);
    }
    let place = |place: &_| interpreter.place_in_program(place);
    let placed = singles.place_before(cycle, &series.held, to_r, place);
    let written_out = singles.write_out(cycle, &series.held, to_r, place);
    for (lines, bytes) in [
        (&mut series.placed, placed),
        (&mut series.written_out, written_out),
    ] {
        let bytes = bytes.map(|placed| match rigid {
            Some(rigid) => {
                let (bytes, before) = rigid.place(placed);
                if let Some(before) = before {
                    lines.add(rigid.line, Ok(before));
                    series.numbers.insert(rigid.line, None);
                }
                bytes
            }
            None => placed.around(&[]),
        });
        let bytes = bytes.map(|bytes| skipped_alike(bytes, line.block.delete_level));
        lines.add(number, bytes);
    }
}

/// Looks at one path through a program, line by line.
struct Surveyor<'s, 'p, 'm> {
    program: &'p [u8],
    machine: &'m Machine,
    singles: Singles<'m>,
    survey: &'s mut Survey,
    /// The series that goes on.
    open: Option<Series>,
    tapping: Tapping,
    texts: Option<Vec<&'p [u8]>>,
    before: returns::Before,
    /// The radius of the tool's nose is compensated.
    compensated: bool,
}

/// The series on one path through the program. True where numbers without a point count as
/// whole units, and the control may take them otherwise.
fn survey_path(
    program: &[u8],
    machine: &Machine,
    options: &Options,
    survey: &mut Survey,
) -> Result<bool, Failure> {
    let mut front = Executor::new(Cursor::new(program), machine, options);
    let mut surveyor = Surveyor {
        program,
        machine,
        singles: Singles::new(machine),
        survey,
        open: None,
        tapping: Tapping::default(),
        texts: None,
        before: returns::Before::of(front.interpreter().modal()),
        compensated: false,
    };
    while let Some(line) = front.next_line()? {
        if line.key.0 == 0 {
            surveyor.take(&line);
        } else {
            surveyor.pass_file(&line);
        }
        surveyor.before = returns::Before::of(line.interpreter.modal());
    }
    surveyor.close();
    let mut notes = front.diagnostics.list.iter();
    Ok(notes.any(|note| note.rule == NO_POINT))
}

impl Surveyor<'_, '_, '_> {
    /// A line of the program itself.
    fn take(&mut self, line: &Line<'_, '_>) {
        let (facts, interpreter) = (&*line.facts, line.interpreter);
        if let Some(cycle) = facts.called {
            let program = self.program;
            let texts = self.texts.get_or_insert_with(|| lines(program).collect());
            let series = called::series(line, cycle, texts, &self.singles);
            close(&mut Some(series), &mut self.survey.series);
        } else if !facts.cycle {
            let ends = !interpreter.in_cycle() && self.open.is_some();
            self.tapping.pass(line, ends);
            if ends {
                self.close();
            }
            if facts.reference.is_some() || facts.machine_coordinates {
                let mut series = returns::series(line, &self.before, self.machine);
                close(&mut series, &mut self.survey.series);
            }
        }
        // What a contour has switched on is a matter of its cycle.
        let by_contour = facts.contour.is_some() && !self.compensated;
        let after = interpreter.chooses_radius() && !by_contour;
        let compensated = std::mem::replace(&mut self.compensated, after);
        if facts.cycle {
            self.cycle(line, compensated);
        }
    }

    /// A block of a cycle.
    fn cycle(&mut self, line: &Line<'_, '_>, compensated: bool) {
        let (facts, interpreter) = (&*line.facts, line.interpreter);
        let lathe = self.machine.controller.language.dialect.lathe.is_some();
        let fixed = stays(line, lathe);
        if lathe && let Some(word) = turning::word(line.block) {
            self.close();
            // One that only gives values for the next cycle moves nothing, and stays.
            if line.steps.iter().any(Step::moves_axes) {
                let how = (word, compensated);
                let series = turning::series(line, how, fixed, self.program, &self.singles);
                close(&mut Some(series), &mut self.survey.series);
            }
            return;
        }
        // A block that says all of a cycle depends on none before it, save that increments
        // begin at the level of the first, and rigid taps on the word for the first.
        let has = |letter| line.block.words.iter().any(|word| word.letter == letter);
        let says_all = facts.motion_word.is_some() && has(b'R') && has(b'Z');
        let alone = says_all && interpreter.modal().absolute && !self.tapping.goes_on();
        if !lathe && alone {
            self.close();
        }
        let series = self.open.get_or_insert_default();
        if lathe {
            series.stays = turning::STAYS;
        }
        let taps = TAPS.contains(&interpreter.cycle()) && self.singles.motion_survives_cycles();
        let rigid = self.tapping.block(line, taps);
        let turned = || {
            turning::stays(line, interpreter.cycle(), interpreter.chooses_radius())
                .filter(|_| lathe)
        };
        let fixed = fixed.or(rigid.as_ref().err().copied()).or_else(turned);
        if let (Some(why), true) = (fixed, lathe || rigid.is_err()) {
            return series.refuse(line.key.1, why);
        }
        let rigid = rigid.ok().flatten();
        take_in(series, line, (fixed, rigid.as_ref()), &self.singles);
    }

    /// A line of a file of subprograms, which stays as it is: so does a cycle of the program
    /// itself that drills there.
    fn pass_file(&mut self, line: &Line<'_, '_>) {
        let (facts, interpreter) = (&*line.facts, line.interpreter);
        if facts.cycle || facts.called.is_some() {
            let file = line.files.get(usize::from(line.key.0) - 1).cloned();
            let place = file.map(|file| (file, line.key.1));
            self.survey.in_files.extend(place);
            let set_at = facts.called.and_then(|cycle| cycle.set_at);
            if let Some((0, set_at)) = set_at {
                let mut series = Series::default();
                series.refuse(set_at, IN_FILE);
                close(&mut Some(series), &mut self.survey.series);
            }
            if let Some(series) = &mut self.open {
                series.keep_cycle(IN_FILE);
            }
        } else if !interpreter.in_cycle() {
            self.tapping.pass(line, self.open.is_some());
            self.close();
        }
    }

    fn close(&mut self) {
        close(&mut self.open, &mut self.survey.series);
    }
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

/// Why nothing is written in another way where places could mean something else then.
const WITHOUT_POINT: &str = "numbers of the program have no decimal point, and what they mean is \
     not known: say decimal_point under [language] of the machine file";
/// Why a cycle stays as it is that drills in other files.
const IN_FILE: &str = "it drills at places that stand in the file of a subprogram";

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
