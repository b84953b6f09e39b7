//! Programs whose lines are executed in another order than they stand in,
//! limited: the program is held whole, each line gets the lowest change of all
//! its runs, and the certificate compares both programs run by run.

use std::collections::VecDeque;
use std::io::{Cursor, Read, Seek, Write};
use std::slice;

mod original;

use original::Original;

use super::certify::{Certified, Reasons, Verdict};
use super::drive::drive_end;
use super::entry::Entry;
use super::executor::{Executor, read_whole, too_large};
use super::own_steps::hand_back;
use super::row::Detail;
use super::stop_before::Stopping;
use super::table::Table;
use super::watching::watching_at;
use super::ways::turns_switches;
use super::worst::{worst, worst_of};
use super::writer::{Writer, Written};
use super::{Failure, LimitOptions, Options, RowSink, Summary};
use crate::interpret::Step;
use crate::limit::{Depths, Limiter};
use crate::machine::{Machine, PathMode};
use crate::power::{Lower, PowerModel};
use crate::rewrite::{BlockView, Comment, Mark, Rewriter};
use crate::source::lines;

/// What programs that are held whole are limited by.
#[derive(Clone, Copy)]
pub(super) struct LoopedProgram<'a> {
    pub(super) machine: &'a Machine,
    /// The same with the limits that are aimed at.
    pub(super) target: &'a Machine,
    pub(super) how: LimitOptions,
}

/// A program that is held whole.
pub(super) struct Source<'a> {
    pub(super) program: &'a [u8],
    /// How it is read, on each path through it.
    pub(super) paths: &'a [Options],
    pub(super) depths: &'a Depths,
    /// The machine with its knobs where they are looked at as well.
    pub(super) rungs: &'a Lower,
}

impl LoopedProgram<'_> {
    /// Limits a program, and certifies what was written on each path; `rows` are those
    /// of the path that draws the most.
    pub(super) fn limit<R: Read + Seek>(
        &self,
        mut input: R,
        mut output: impl Write,
        (paths, depths, rungs): (&[Options], &Depths, &Lower),
        rows: Option<&mut dyn RowSink>,
    ) -> Result<(Written, Certified), Failure> {
        let program = read_whole(&mut input)?.ok_or_else(too_large)?;
        let source = Source {
            program: &program,
            paths,
            depths,
            rungs,
        };
        let table = Table::new(turns_switches(paths));
        let detail = Detail::of(rows.as_deref());
        let (decided, table) = self.decide(slice::from_ref(&source), table, detail)?;
        let [decided] = <[Decided; 1]>::try_from(decided).map_err(|_| no_way())?;
        let comment = paths.first().and_then(|it| it.comment(self.machine));
        let (text, edited_lines) = write(0, &program, self.machine, &table, comment);
        let certified = self.certify(&source, (&text, paths), &decided, &table, rows)?;
        output.write_all(&text).map_err(Failure::Output)?;
        output.flush().map_err(Failure::Output)?;
        Ok((decided.written(edited_lines)?, certified))
    }

    /// Where a program is stopped by words before rapids that become feeds: what it takes to
    /// know that of a block lies after it.
    pub(super) fn stopping<R: Read + Seek>(
        &self,
        mut input: R,
        (paths, depths, rungs): (&[Options], &Depths, &Lower),
    ) -> Result<Stopping, Failure> {
        let program = read_whole(&mut input)?.ok_or_else(too_large)?;
        let source = Source {
            program: &program,
            paths,
            depths,
            rungs,
        };
        let table = Table::new(turns_switches(paths)).written_in_order();
        let (_, table) = self.decide(slice::from_ref(&source), table, Detail::NoRows)?;
        input.rewind().map_err(Failure::Input)?;
        Ok(table.stopping(self.machine))
    }

    /// Decides about the lines of programs that share files of subprograms, in an empty
    /// table: the lowest of all their runs counts.
    pub(super) fn decide(
        &self,
        sources: &[Source<'_>],
        mut table: Table,
        detail: Detail,
    ) -> Result<(Vec<Decided>, Table), Failure> {
        let Self {
            machine,
            target,
            how,
        } = *self;
        for source in sources {
            for options in source.paths {
                survey(source.program, machine, options, &mut table)?;
            }
        }
        table.settle();
        let mut all = Vec::with_capacity(sources.len());
        for source in sources {
            let mut decided = Decided::default();
            for options in source.paths {
                let writer = Writer::new(
                    Cursor::new(source.program),
                    std::io::sink(),
                    target,
                    options,
                    Limiter::new(target, how, source.depths.clone()),
                    PowerModel::new(machine),
                )
                .detailed(detail)
                .deciding(table);
                let written;
                (written, table) = writer.decide_all()?;
                decided.originals.push(written.before);
                decided.reasons.join(written.reasons);
                decided.may_skip |= written.may_skip;
            }
            all.push(decided);
        }
        table.spread_word(machine);
        table.spread_feed();
        table.spread_stops(machine);
        table.spread_left_feeds();
        table.spread_within();
        Ok((all, table))
    }

    /// Certifies what was written for a program; `paths` are the same as those of the
    /// program, with the files as they are written.
    pub(super) fn certify(
        &self,
        source: &Source<'_>,
        (text, paths): (&[u8], &[Options]),
        decided: &Decided,
        table: &Table,
        mut rows: Option<&mut dyn RowSink>,
    ) -> Result<Certified, Failure> {
        let machine = self.machine;
        let worst = worst(&decided.originals);
        let mut certified: Option<Certified> = None;
        for (place, (options, written)) in source.paths.iter().zip(paths).enumerate() {
            let rows = if place == worst { rows.take() } else { None };
            let original = Original::new(
                source.program,
                machine,
                options,
                table,
                Detail::of(rows.as_deref()),
            );
            let path = certify(original, text, (machine, source.rungs), written, rows)?;
            certified = Some(match certified {
                Some(certified) => certified.join(path),
                None => path,
            });
        }
        certified.ok_or_else(no_way)
    }
}

fn no_way() -> Failure {
    Failure::Unsuitable("no way to read the program is given".to_owned())
}

/// What was decided about a program.
#[derive(Default)]
pub(super) struct Decided {
    /// The figures of the original on each path.
    originals: Vec<Summary>,
    /// What cannot be helped.
    reasons: Reasons,
    /// Some of its blocks may be skipped.
    may_skip: bool,
}

impl Decided {
    /// What the writing half comes to, with the number of lines that were changed.
    pub(super) fn written(self, edited_lines: u64) -> Result<Written, Failure> {
        Ok(Written {
            before: worst_of(self.originals).ok_or_else(no_way)?,
            edited_lines,
            reasons: self.reasons,
            may_skip: self.may_skip,
            places: Vec::new(),
            pauses: Vec::new(),
        })
    }
}

/// What each line meets in its runs.
fn survey(
    program: &[u8],
    machine: &Machine,
    options: &Options,
    table: &mut Table,
) -> Result<(), Failure> {
    let mut front = Executor::new(Cursor::new(program), machine, options);
    // The axes stand before the first move.
    let mut mode = PathMode::ExactStop;
    let mut before = Mark::of(front.interpreter().modal());
    let mut mm_per_unit = before.mm_per_unit;
    let mut entries = VecDeque::new();
    let mut spare: Option<Box<Entry>> = None;
    let mut placed = Vec::new();
    while let Some(mut line) = front.next_line()? {
        let known = spare.take();
        let mut entry = known.unwrap_or_else(|| Box::new(Entry::new(&line)));
        entry.fill(&mut line, machine, mode, mm_per_unit);
        mm_per_unit = entry.mark.mm_per_unit;
        entries.push_back(entry);
        hand_back(&mut entries, &mut mode, &mut placed);
        while let Some(entry) = entries.pop_front_if(|entry| !entry.awaits) {
            table.see(machine, entry.key, &entry, &before);
            before = entry.mark;
            spare = Some(entry);
        }
    }
    table.end();
    front.finish()?;
    Ok(())
}

/// A text, of that number, with its changes, and how many lines were edited; `comment`
/// marks what stands for a rapid.
pub(super) fn write(
    number_of_text: u16,
    program: &[u8],
    machine: &Machine,
    table: &Table,
    comment: Option<Comment>,
) -> (Vec<u8>, u64) {
    let mut rewriter = Rewriter::new(machine).marking(comment);
    let mut out = Vec::with_capacity(program.len() + program.len() / 8);
    for (number, text) in lines(program).enumerate() {
        let Some(decision) = table.written((number_of_text, number as u64 + 1)) else {
            out.extend_from_slice(text);
            continue;
        };
        let view = BlockView {
            text,
            block: &decision.block,
            facts: &decision.facts,
            before: &decision.before,
            after: &decision.after,
            knobs: decision.knobs.as_ref(),
            rapids: decision.rapids,
            feeds: decision.feeds,
            change: &decision.change,
            pieces: &[],
            stops: decision.stops && machine.controller.planner.dwell_stops,
            rests: false,
        };
        // Contradicting edits leave the line as it was, which the certificate
        // then finds.
        if !rewriter.write_alone(&view, decision.around, &mut out) {
            out.extend_from_slice(text);
        }
    }
    (out, rewriter.edited_lines)
}

/// Runs both programs side by side.
fn certify(
    mut original: Original<'_, '_>,
    text: &[u8],
    (machine, rungs): (&Machine, &Lower),
    options: &Options,
    rows: Option<&mut dyn RowSink>,
) -> Result<Certified, Failure> {
    let mut verdict = Verdict::new(machine, options, rows);
    let mut written = Executor::new(Cursor::new(text), machine, options);
    let mut assessor = watching_at(machine, rungs, options);
    let mut expected = Vec::new();
    let mut more = true;
    while more {
        more = original.read(&mut expected)?;
        verdict.refill(&mut expected);
        while verdict.expects() || !more {
            let Some(line) = written.next_line()? else {
                break;
            };
            verdict.learn_files(line.files);
            let mut steps = std::mem::take(line.steps);
            let turns_knob = line.facts.turns_knob;
            let text_of = |step: &Step| match step {
                Step::Move(mv) => line.text_of(mv),
                Step::Action(_) => line.text,
            };
            verdict.certify_line(&mut assessor, &mut steps, turns_knob, text_of);
            *line.steps = steps;
        }
        verdict.check()?;
    }
    drive_end(&mut assessor, &mut verdict);
    verdict.rate(assessor.ratings(), assessor.lower_ratings());
    verdict.expect_nothing();
    let lines = written.lines;
    verdict.finish(&written.diagnostics.list, lines)
}
