//! Rounds of limiting a set, until no program asks for more.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::discover::Found;
use super::rows::{OfProgram, as_its_own};
use super::{SetFile, SetProgram, SetSummary};
use crate::interpret::Shelf;
use crate::limit::Depths;
use crate::machine::Machine;
use crate::pipeline::certify::Certified;
use crate::pipeline::conclusion::conclude;
use crate::pipeline::derate::lower_further;
use crate::pipeline::expand::Expanded;
use crate::pipeline::looped_program::{Decided, LoopedProgram, Source, write};
use crate::pipeline::rounds::last_round;
use crate::pipeline::row::Detail;
use crate::pipeline::table::Table;
use crate::pipeline::ways::turns_switches;
use crate::pipeline::worst::worst_of;
use crate::pipeline::{Failure, LimitOptions, LimitSummary, Options, RestartRows, RowSink};
use crate::power::{Ladder, Lower};

/// What is to be limited.
pub(super) struct Job<'a> {
    pub(super) programs: &'a [SetProgram],
    pub(super) machine: &'a Machine,
    pub(super) how: LimitOptions,
    /// How each program is read, on each way through it.
    paths: Vec<Vec<Options>>,
    /// What stands in all files.
    shelf: Arc<Shelf>,
    /// The numbers of the files that each program calls.
    called: &'a [BTreeSet<usize>],
    /// Programs whose cycles are written in another way.
    pub(super) expanded: Vec<Option<Expanded>>,
}

/// What a round needs to know of a program, and what came of the ones before.
#[derive(Default)]
struct Round {
    depths: Depths,
    rungs: Lower,
    ladder: Option<Ladder>,
    /// It asks for more than can be.
    stopped: bool,
}

impl<'a> Job<'a> {
    pub(super) fn new(
        programs: &'a [SetProgram],
        machine: &'a Machine,
        how: LimitOptions,
        ways: &[Vec<Options>],
        found: &'a Found,
    ) -> Self {
        Self {
            programs,
            machine,
            how,
            paths: ways.to_vec(),
            shelf: Arc::clone(&found.shelf),
            called: &found.called,
            expanded: programs.iter().map(|_| None).collect(),
        }
    }

    /// Limits the set as it stands; where a limit over time is missed, by lower peaks.
    pub(super) fn limit(
        &self,
        rows: &mut Option<&mut dyn RestartRows>,
    ) -> Result<SetSummary, Failure> {
        let first = self.attempt(self.machine, rows)?;
        let after =
            |set: &SetSummary, done: fn(&LimitSummary) -> bool| set.programs.iter().all(done);
        let in_time = after(&first, |it| {
            it.after.over_time.iter().all(|found| found.rating.fits())
        });
        if first.certified() || in_time || !after(&first, |it| it.after.unfit_count == 0) {
            return Ok(first);
        }
        let originals: Vec<_> = first.programs.iter().map(|it| it.before.clone()).collect();
        let mut last = None;
        lower_further(self.machine, as_one(&first), &mut |target| {
            let set = self.attempt(target, rows)?;
            let one = as_one(&set);
            last = Some(set);
            Ok(one)
        })?;
        let mut set = last.unwrap_or(first);
        for (program, before) in set.programs.iter_mut().zip(originals) {
            program.before = before;
        }
        Ok(set)
    }

    /// The text of a program, or of a file.
    fn text(&self, number: usize) -> &[u8] {
        let expanded = self.expanded.get(number).and_then(Option::as_ref);
        let file = || self.shelf.files().nth(number).map(|(_, text)| text);
        let text = expanded.map(|expanded| expanded.text.as_slice());
        text.or_else(file).unwrap_or_default()
    }

    /// What a program, or a file, is called.
    fn name(&self, number: usize) -> &str {
        let program = self
            .programs
            .get(number)
            .map(|program| program.name.as_str());
        program
            .or_else(|| self.shelf.name(number))
            .unwrap_or_default()
    }

    /// Lines that were changed in a program and in the files that it calls.
    fn edited_lines(&self, number: usize, files: &[SetFile]) -> u64 {
        let called = self.called.get(number).into_iter().flatten().copied();
        let others = called.filter(|file| *file != number);
        let files = others.chain([number]).filter_map(|file| files.get(file));
        files.map(|file| file.edited_lines).sum()
    }

    /// The ways through a program with the files of that shelf.
    fn paths(&self, number: usize, shelf: &Arc<Shelf>) -> Vec<Options> {
        let paths = self.paths.get(number).map_or(&[][..], Vec::as_slice);
        let with_shelf = |options: &Options| {
            let mut options = options.clone();
            options.reading.shelf = Some(Arc::clone(shelf));
            options.reading.text = number as u16;
            options
        };
        paths.iter().map(with_shelf).collect()
    }

    /// Limits the set with the limits of `target`.
    fn attempt(
        &self,
        target: &Machine,
        rows: &mut Option<&mut dyn RestartRows>,
    ) -> Result<SetSummary, Failure> {
        let whole = LoopedProgram {
            machine: self.machine,
            target,
            how: self.how,
        };
        let count = self.programs.len();
        let paths: Vec<_> = (0..count)
            .map(|number| self.paths(number, &self.shelf))
            .collect();
        let mut rounds: Vec<Round> = self.programs.iter().map(|_| Round::default()).collect();
        loop {
            if let Some(rows) = rows {
                rows.restart().map_err(Failure::Output)?;
            }
            let sources: Vec<_> = (0..)
                .zip(rounds.iter().zip(&paths))
                .map(|(number, (round, paths))| Source {
                    program: self.text(number),
                    paths,
                    depths: &round.depths,
                    rungs: &round.rungs,
                })
                .collect();
            let skips = paths.iter().any(|paths| turns_switches(paths));
            let table = Table::new(skips).with_files(count as u16);
            let (decided, table) = whole.decide(&sources, table, Detail::of(rows.as_deref()))?;
            let first = paths.iter().flatten().next();
            let comment = first.and_then(|it| it.comment(self.machine));
            let files = self.shelf.files().enumerate().map(|(number, (path, _))| {
                let text = self.text(number);
                let comment = comment.clone();
                let (text, edited_lines) =
                    write(number as u16, text, self.machine, &table, comment);
                let expanded = self.expanded.get(number).and_then(Option::as_ref);
                SetFile {
                    name: self.name(number).to_owned(),
                    path: path.to_owned(),
                    text,
                    edited_lines: edited_lines
                        + expanded.map_or(0, |expanded| expanded.blocks as u64),
                }
            });
            let files: Vec<SetFile> = files.collect();
            let texts = files.iter().map(|file| file.text.clone());
            let written = Arc::new(self.shelf.with_texts(texts));
            let mut certified = Vec::with_capacity(count);
            for (number, (source, decided)) in sources.iter().zip(&decided).enumerate() {
                let paths = self.paths(number, &written);
                let text = files
                    .get(number)
                    .map_or(&[][..], |file| file.text.as_slice());
                let mut own = self.rows_of(number, rows);
                let own = own.as_mut().map(|rows| rows as &mut dyn RowSink);
                certified.push(whole.certify(source, (text, &paths), decided, &table, own)?);
            }
            drop(sources);
            if !again(&mut rounds, &certified, self.machine) {
                let programs =
                    self.concluded(target, (decided, certified), &paths, &files, &rounds)?;
                return Ok(SetSummary { programs, files });
            }
        }
    }

    /// Where the rows of a program go.
    fn rows_of<'r>(
        &'r self,
        number: usize,
        rows: &'r mut Option<&mut dyn RestartRows>,
    ) -> Option<OfProgram<'r>> {
        let own = &self.programs.get(number)?.name;
        let rows = rows.as_mut()?;
        rows.begin_program(number);
        Some(OfProgram {
            rows: &mut **rows,
            own,
            shown: if self.programs.len() > 1 { own } else { "" },
            expanded: self.expanded.get(number).and_then(Option::as_ref),
        })
    }

    fn concluded(
        &self,
        target: &Machine,
        (decided, certified): (Vec<Decided>, Vec<Certified>),
        paths: &[Vec<Options>],
        files: &[SetFile],
        rounds: &[Round],
    ) -> Result<Vec<LimitSummary>, Failure> {
        let mut programs = Vec::with_capacity(self.programs.len());
        let found = decided.into_iter().zip(certified).zip(rounds);
        for (number, ((decided, mut certified), round)) in found.enumerate() {
            if let Some(ladder) = &round.ladder {
                certified.summary.settle(ladder);
            }
            let edited_lines = self.edited_lines(number, files);
            let written = decided.written(edited_lines)?;
            let paths = paths.get(number).map_or(&[][..], Vec::as_slice);
            let (machine, how) = (self.machine, self.how);
            let mut summary = conclude(machine, target, paths, how, written, certified);
            if round.stopped {
                summary.certified = false;
                summary
                    .reasons
                    .push(last_round(&round.depths, how.allowed, machine));
            }
            if let Some(program) = self.programs.get(number) {
                as_its_own(&mut summary, &program.name);
                if let Some(Some(expanded)) = self.expanded.get(number) {
                    expanded.trace(&program.text, &mut summary);
                    summary.edited_lines = edited_lines;
                }
            }
            programs.push(summary);
        }
        share_reasons(&mut programs);
        Ok(programs)
    }
}

/// Why a line of a shared file cannot be helped is found in the first of its runs: it is the
/// reason of all programs that run it.
fn share_reasons(programs: &mut [LimitSummary]) {
    let all = programs.iter().flat_map(|it| &it.reasons);
    let shared: Vec<_> = all.filter(|it| it.file.is_some()).cloned().collect();
    for program in programs.iter_mut().filter(|it| !it.certified) {
        for reason in &shared {
            let unfit = &program.after.unfit;
            let runs = unfit
                .iter()
                .any(|it| Some(&it.file) == reason.file.as_ref() && it.line == reason.line);
            if runs && !program.reasons.contains(reason) {
                program.reasons.push(reason.clone());
            }
        }
    }
}

/// Whether another round is wanted: changes made neighbours exceed the limit, or lower
/// overrides are to be looked at, where the same is written again.
fn again(rounds: &mut [Round], certified: &[Certified], machine: &Machine) -> bool {
    let mut again = false;
    for (round, certified) in rounds.iter_mut().zip(certified) {
        round.stopped = !certified.deeper.is_empty() && !round.depths.deepen(&certified.deeper);
        again |= !certified.deeper.is_empty() && !round.stopped;
    }
    if again || rounds.iter().any(|round| round.stopped) {
        return again;
    }
    for (round, certified) in rounds.iter_mut().zip(certified) {
        let summary = &certified.summary;
        let ladder = round.ladder.get_or_insert_with(|| summary.ladder(machine));
        ladder.take(&summary.lower);
        let worth = certified.reasons.count == 0 && summary.fits_at_largest();
        round.rungs = if worth {
            ladder.ask()
        } else {
            Lower::default()
        };
        again |= !round.rungs.is_empty();
    }
    again
}

/// The figures of all programs as those of one.
fn as_one(set: &SetSummary) -> LimitSummary {
    let of = |figures: fn(&LimitSummary) -> &crate::pipeline::Summary| {
        let all = set.programs.iter().map(|it| figures(it).clone());
        worst_of(all.collect()).unwrap_or_default()
    };
    LimitSummary {
        before: of(|it| &it.before),
        after: of(|it| &it.after),
        certified: set.certified(),
        ..LimitSummary::default()
    }
}
