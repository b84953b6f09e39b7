//! A program's figures, and its moves.

use std::collections::BTreeSet;
use std::io::{Read, Seek};
use std::path::PathBuf;
use std::slice;

use super::advice::{Adviser, Circumstances};
use super::conditions::{above_largest, conditions};
use super::drive::{MoveSink, drive_end, drive_line};
use super::executor::Executor;
use super::source::Source;
use super::summary::AT_LENGTH_MAX;
use super::totals::Totals;
use super::watching::watching_at;
use super::ways::{has_ways, ways};
use super::worker::relay;
use super::worst::{worst, worst_of};
use super::{Certificate, Failure, Options, RowSink, Summary};
use crate::diagnostic::Diagnostic;
use crate::interpret::{Move, Step};
use crate::machine::Machine;
use crate::power::{Assessment, Assessor, Lower, Want};

/// Reads a program and gives its figures; with `rows`, every move too. Where it can go on
/// in several ways, by what probes find, each figure is the worst of all, and the rows are
/// those of the way that draws the most.
///
/// # Errors
/// See [`Failure`].
pub fn analyze<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    rows: Option<&mut dyn RowSink>,
) -> Result<Summary, Failure> {
    analyze_ways(&mut input, machine, options, rows)
}

fn analyze_ways(
    mut input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    rows: Option<&mut dyn RowSink>,
) -> Result<Summary, Failure> {
    if !has_ways(options) {
        return analyze_way(input, machine, options, rows);
    }
    let ways = ways(&mut input, machine, options, false)?;
    let mut summaries = Vec::with_capacity(ways.len());
    for way in &ways {
        input.rewind().map_err(Failure::Input)?;
        summaries.push(analyze_way(input, machine, way, None)?);
    }
    let place = worst(&summaries);
    if let (Some(way), Some(summary)) = (ways.get(place), summaries.get_mut(place))
        && rows.is_some()
    {
        input.rewind().map_err(Failure::Input)?;
        *summary = analyze_way(input, machine, way, rows)?;
    }
    let mut summary = worst_of(summaries).unwrap_or_default();
    summary.conditions = conditions(machine, &ways, &summary);
    Ok(summary)
}

/// The figures of one way through a program.
fn analyze_way(
    mut input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    rows: Option<&mut dyn RowSink>,
) -> Result<Summary, Failure> {
    let mut summary = judge(&mut input, machine, &Lower::default(), options, rows)?;
    // To look at lower overrides takes many times as long as all the rest.
    if summary.fits_at_largest() || summary.moves <= AT_LENGTH_MAX {
        let mut ladder = summary.ladder(machine);
        loop {
            let rungs = ladder.ask();
            if rungs.is_empty() {
                break;
            }
            input.rewind().map_err(Failure::Input)?;
            ladder.take(&judge(&mut input, machine, &rungs, options, None)?.lower);
        }
        summary.settle(&ladder);
    }
    summary.conditions = conditions(machine, slice::from_ref(options), &summary);
    summary.notes.extend(above_largest(machine));
    Ok(summary)
}

/// The same, watched at `rungs` as well.
pub(super) fn judge<R: Read + Seek + Send>(
    input: R,
    machine: &Machine,
    rungs: &Lower,
    options: &Options,
    rows: Option<&mut dyn RowSink>,
) -> Result<Summary, Failure> {
    let mut front = Executor::new(input, machine, options);
    let mut analysis = Analysis::new(machine, rungs, options, rows);
    // Where little is to be judged, handing lines over costs as much.
    if options.threads > 1 && analysis.weighs() {
        front = relay(front, |files, line| {
            analysis.tally.learn_files(files);
            let text_of = |step, _: &Move| line.text_of(step);
            let circumstances = || *line.circumstances;
            analysis.take(line.steps(), line.turns_knob, text_of, circumstances)
        })?;
    } else {
        while let Some(line) = front.next_line()? {
            analysis.tally.learn_files(line.files);
            let text_of = |_, mv: &Move| line.text_of(mv);
            let circumstances = || Circumstances::of(line.interpreter);
            analysis.take(line.steps, line.facts.turns_knob, text_of, circumstances)?;
        }
    }
    analysis.finish(front)
}

/// What judges a program, and what it has found.
struct Analysis<'m, 'r> {
    machine: &'m Machine,
    assessor: Assessor<'m>,
    tally: Totals<'m, 'r>,
    adviser: Adviser<'m>,
    energy: bool,
}

impl<'m, 'r> Analysis<'m, 'r> {
    fn new(
        machine: &'m Machine,
        rungs: &'m Lower,
        options: &Options,
        rows: Option<&'r mut (dyn RowSink + 'r)>,
    ) -> Self {
        let energy = rows.is_some();
        Self {
            machine,
            assessor: watching_at(machine, rungs, options),
            tally: Totals::new(machine, options, rows),
            adviser: Adviser::new(machine),
            energy,
        }
    }

    /// Whether judging the program takes about as long as reading it.
    fn weighs(&self) -> bool {
        self.energy || self.assessor.weighs()
    }

    /// Takes what a line does; `text_of` gives the text that a step belongs to.
    #[inline]
    fn take<'t>(
        &mut self,
        steps: &[Step],
        turns_knob: bool,
        text_of: impl Fn(usize, &Move) -> &'t [u8],
        circumstances: impl Fn() -> Circumstances,
    ) -> Result<(), Failure> {
        let text_of = |index, step: &Step| match step {
            Step::Move(mv) => text_of(index, mv),
            Step::Action(_) => b"",
        };
        let mut advised = Advised {
            tally: &mut self.tally,
            adviser: &self.adviser,
            circumstances,
        };
        drive_line(&mut self.assessor, steps, turns_knob, text_of, &mut advised);
        self.tally.check()
    }

    /// The figures, after the last line.
    fn finish<R: Read + Seek>(self, front: Executor<'_, R>) -> Result<Summary, Failure> {
        let Self {
            machine,
            mut assessor,
            mut tally,
            adviser,
            energy,
        } = self;
        let circumstances = Circumstances::of(front.interpreter());
        let mut advised = Advised {
            tally: &mut tally,
            adviser: &adviser,
            circumstances: || circumstances,
        };
        drive_end(&mut assessor, &mut advised);
        tally.check()?;
        let lines = front.lines;
        let notes = front.finish()?;
        refuse_planned(&assessor, machine)?;
        tally.rate(assessor.ratings(), assessor.lower_ratings());
        let mut summary = tally.finish(energy);
        summary.lines = lines;
        summary.notes = notes;
        Ok(summary)
    }
}

/// Counts moves, and says of those that do not fit what would help.
struct Advised<'a, 'm, 'r, C> {
    tally: &'a mut Totals<'m, 'r>,
    adviser: &'a Adviser<'m>,
    circumstances: C,
}

impl<C: Fn() -> Circumstances> MoveSink for Advised<'_, '_, '_, C> {
    fn want(&self) -> Want {
        let want = self.tally.want();
        Want {
            accel: want.energy,
            ..want
        }
    }

    fn take(&mut self, mv: &Move, judged: &Assessment, text: &[u8]) {
        let help = || self.adviser.help(mv, judged, &(self.circumstances)());
        self.tally.take(mv, judged, text, help);
    }
}

/// Where the files of subprograms lie that a program reads, on any way through it; each once.
///
/// # Errors
/// See [`Failure`].
pub fn called_files<R: Read + Seek>(
    mut input: R,
    machine: &Machine,
    options: &Options,
) -> Result<Vec<PathBuf>, Failure> {
    let ways = if has_ways(options) {
        ways(&mut input, machine, options, false)?
    } else {
        vec![options.clone()]
    };
    let mut found = BTreeSet::new();
    for way in &ways {
        input.rewind().map_err(Failure::Input)?;
        let mut front = Executor::new(&mut input, machine, way);
        while front.next_line()?.is_some() {}
        found.extend(front.paths().iter().cloned());
        front.finish()?;
    }
    Ok(found.into_iter().collect())
}

/// Reads a program and hands over every commanded move with its duration in s
/// (`None` where it cannot be known: the start is not).
///
/// # Errors
/// See [`Failure`]; an error of `each` becomes [`Failure::Output`].
pub fn moves<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    each: &mut dyn FnMut(&Move, Option<f64>) -> std::io::Result<()>,
) -> Result<Vec<Diagnostic>, Failure> {
    moves_of(&mut input, machine, options, each)
}

fn moves_of(
    input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    each: &mut dyn FnMut(&Move, Option<f64>) -> std::io::Result<()>,
) -> Result<Vec<Diagnostic>, Failure> {
    let mut front = Executor::new(input, machine, options);
    let assessor = Assessor::new(machine, None, Want::PEAKS);
    while let Some(line) = front.next_line()? {
        for step in &*line.steps {
            if let Step::Move(mv) = step {
                let seconds = crate::plan::plan(machine, mv, assessor.nominal).duration_s;
                let known = mv.unknown_start.is_empty();
                each(mv, known.then_some(seconds)).map_err(Failure::Output)?;
            }
        }
    }
    front.finish()
}

/// The planned certificate cannot be given for moves that are blended by rules
/// that are not modelled.
pub(super) fn refuse_planned(assessor: &Assessor<'_>, machine: &Machine) -> Result<(), Failure> {
    if !assessor.needs_robust || assessor.requested() != Some(Certificate::Planned) {
        return Ok(());
    }
    Err(Failure::Unsuitable(format!(
        "the program blends moves, and how the controller `{}` does that is not modelled: \
         use --certificate robust, or path.mode = \"exact-stop\" if the machine stops at every block",
        machine.controller.name
    )))
}
