//! Several programs and the files of subprograms that they call, limited together: a line
//! that several of them run gets the lowest change of all its runs, and each program is
//! certified with the files as they are written.

mod discover;
mod expanding;
mod rounds;
mod rows;

use std::path::PathBuf;
use std::sync::Arc;

use super::conclusion::holds_one_way;
use super::readable::readable;
use super::strategy::{check_strategy, trusting};
use super::ways::{has_ways, ways};
use super::{Failure, LimitOptions, LimitSummary, Options, RestartRows};
use crate::diagnostic::Severity;
use crate::interpret::Shelf;
use crate::machine::Machine;
use discover::discover;
use rounds::Job;

/// A program of a set.
#[derive(Debug)]
pub struct SetProgram {
    /// What reports call it.
    pub name: String,
    /// Where it lies: another program may call it.
    pub path: PathBuf,
    /// Its bytes.
    pub text: Arc<[u8]>,
    /// How it is read, with the folders where its subprograms are looked for.
    pub options: Options,
}

/// A file as it is to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SetFile {
    /// What reports call it.
    pub name: String,
    /// Where the original lies, its folder without links.
    pub path: PathBuf,
    /// Its bytes; those of the original where nothing is changed.
    pub text: Vec<u8>,
    /// Number of lines that were changed or inserted.
    pub edited_lines: u64,
}

/// What was done to a set.
#[derive(Debug)]
pub struct SetSummary {
    /// What became of each program, in the order given.
    pub programs: Vec<LimitSummary>,
    /// The programs in the same order, then the files of subprograms.
    pub files: Vec<SetFile>,
}

impl SetSummary {
    /// True when the certificate holds for all programs: only then may the files be
    /// delivered.
    #[must_use]
    pub fn certified(&self) -> bool {
        self.programs.iter().all(|program| program.certified)
    }

    /// True where the written programs are at least the originals made slower.
    #[must_use]
    pub fn slower(&self) -> bool {
        let mut programs = self.programs.iter();
        programs.all(|program| program.certified || program.slower)
    }

    /// How a program is read together with all files as they are written.
    #[must_use]
    pub fn options_after(&self, programs: &[SetProgram], place: usize) -> Options {
        let mut shelf = Shelf::default();
        for file in &self.files {
            shelf.put(&file.path, &file.name, file.text.as_slice());
        }
        let mut options = programs
            .get(place)
            .map_or_else(Options::default, |it| it.options.clone());
        options.reading.shelf = Some(Arc::new(shelf));
        options.reading.text = place as u16;
        options
    }
}

/// Why a set came to no result.
#[derive(Debug)]
pub struct SetFailure {
    /// The program at fault, if it is one.
    pub program: Option<usize>,
    /// What is wrong.
    pub failure: Failure,
}

impl From<Failure> for SetFailure {
    fn from(failure: Failure) -> Self {
        Self {
            program: None,
            failure,
        }
    }
}

impl SetFailure {
    /// Names the program at fault.
    fn of(program: usize) -> impl FnOnce(Failure) -> Self {
        move |failure| Self {
            program: Some(program),
            failure,
        }
    }
}

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
