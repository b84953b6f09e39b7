//! Several programs and the files of subprograms that they call, limited together: a line
//! that several of them run gets the lowest change of all its runs, and each program is
//! certified with the files as they are written.

mod discover;
mod expanding;
mod programs;
mod rounds;
mod rows;

pub use programs::{SetFailure, SetFile, SetProgram, SetSummary};

use super::conclusion::holds_one_way;
use super::readable::readable;
use super::strategy::{check_strategy, trusting};
use super::ways::{has_ways, ways};
use super::{Failure, LimitOptions, Options, RestartRows};
use crate::diagnostic::Severity;
use crate::machine::Machine;
use discover::discover;
use rounds::Job;

/// Limits programs together with the files of subprograms that they call.
///
/// # Errors
/// See [`Failure`]. Programs that cannot be made to fit are no error: see
/// [`SetSummary::certified`].
pub fn limit_set(
    programs: &[SetProgram],
    machine: &Machine,
    how: LimitOptions,
    mut rows: Option<&mut dyn RestartRows>,
) -> Result<SetSummary, SetFailure> {
    if let Some((machine, note)) = trusting(machine, how) {
        let mut summary = limit_set(programs, &machine, how, rows)?;
        if let Some(first) = summary.programs.first_mut() {
            first.before.notes.push(note);
        }
        return Ok(summary);
    }
    if let Some((machine, note)) = readable(machine) {
        let mut summary = limit_set(programs, &machine, how, rows)?;
        if let Some(first) = summary.programs.first_mut() {
            first.before.notes.push(note);
        }
        return Ok(summary);
    }
    check_strategy(machine, how)?;
    if how.allowed.pause {
        let message = "--allow pause does not go with --with-subprograms";
        return Err(Failure::Unsuitable(message.to_owned()).into());
    }
    let mut marks = programs.iter().map(|program| &program.options.rapid_mark);
    let first = marks.next();
    if marks.any(|mark| Some(mark) != first) {
        let message = "programs that share files take one mark for rapids";
        return Err(Failure::Unsuitable(message.to_owned()).into());
    }
    let mut asked = Vec::with_capacity(programs.len());
    for (place, program) in programs.iter().enumerate() {
        asked.push(if has_ways(&program.options) {
            ways_of(program, machine, false).map_err(SetFailure::of(place))?
        } else {
            vec![program.options.clone()]
        });
    }
    let (mut as_asked, may_skip) = limit_ways(programs, machine, how, &asked, &mut rows)?;
    if !may_skip {
        return Ok(as_asked);
    }
    // Blocks that may be skipped: what is right with them and without is written, if
    // anything is.
    let all = programs.iter().enumerate();
    let all: Result<Vec<_>, _> = all
        .map(|(place, program)| ways_of(program, machine, true).map_err(SetFailure::of(place)))
        .collect();
    let tried = all.and_then(|all| limit_ways(programs, machine, how, &all, &mut rows));
    let otherwise = match tried {
        Ok((summary, _)) if summary.certified() || !as_asked.certified() => return Ok(summary),
        Ok((summary, _)) => summary.programs.into_iter().map(|it| it.reasons).collect(),
        Err(SetFailure {
            failure: Failure::Refused { diagnostics, .. },
            program,
        }) => {
            let mut all = vec![Vec::new(); programs.len()];
            if let Some(own) = program.and_then(|place| all.get_mut(place)) {
                *own = diagnostics;
            }
            all
        }
        Err(failure) => return Err(failure),
    };
    if !as_asked.certified() {
        return Ok(as_asked);
    }
    (as_asked, _) = limit_ways(programs, machine, how, &asked, &mut rows)?;
    for (summary, found) in as_asked.programs.iter_mut().zip(otherwise) {
        let error = found.into_iter().find(|it| it.severity == Severity::Error);
        summary.before.notes.extend(error.map(holds_one_way));
    }
    Ok(as_asked)
}

fn ways_of(
    program: &SetProgram,
    machine: &Machine,
    switches: bool,
) -> Result<Vec<Options>, Failure> {
    let text = std::io::Cursor::new(&*program.text);
    ways(text, machine, &program.options, switches)
}

/// Limits the programs for these ways through each; says whether some blocks may be
/// skipped.
fn limit_ways(
    programs: &[SetProgram],
    machine: &Machine,
    how: LimitOptions,
    ways: &[Vec<Options>],
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<(SetSummary, bool), SetFailure> {
    let found = discover(programs, machine, ways)?;
    let job = Job::new(programs, machine, how, ways, &found);
    let set = expanding::limit(&job, ways, &found, rows)?;
    let may_skip = set.programs.iter().any(|program| program.may_skip);
    Ok((set, may_skip))
}
