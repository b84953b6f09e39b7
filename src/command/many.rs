//! Many programs, each by itself.

use anyhow::Result;
use gwatt::report::{Totals, Verdict};

use super::dialect;
use super::in_order::in_order;
use super::input::Program;
use super::places::Places;
use super::progress::Progress;
use super::setup::{Setup, share_threads};
use super::terminal::{Messages, Terminal};

/// How many programs are dealt with.
#[derive(Debug, Clone, Copy)]
pub struct OfMany {
    /// Of those that fit nothing is said.
    pub quiet: bool,
    /// How many may run at the same time.
    pub at_once: usize,
}

/// One of many programs.
#[derive(Debug)]
pub struct OneOf<'a> {
    /// What it is judged with.
    pub setup: &'a Setup,
    /// The program.
    pub program: &'a Program,
    /// Where its results go; the folders are there.
    pub places: &'a Places,
    /// What is to be said of it.
    pub messages: &'a mut Messages,
}

/// Does `work` for each program of a listing, several at once, which gives `None` where there
/// is nothing to judge; what is said of them comes in
/// order, and at the end how many fit. One that is not read, or whose results cannot be
/// written, does not keep the others from being dealt with.
pub fn each_by_itself(
    programs: Vec<Program>,
    places: Vec<Places>,
    mut setup: Setup,
    how: OfMany,
    terminal: Terminal,
    work: impl Fn(OneOf<'_>) -> Result<Option<Verdict>> + Sync,
) -> Result<Verdict> {
    let (at_once, each) = share_threads(setup.options.threads, programs.len().min(how.at_once));
    setup.options.threads = each;
    let jobs: Vec<(Program, Places)> = programs.into_iter().zip(places).collect();
    let one = |(program, places): &(Program, Places)| {
        let direct = at_once == 1 && !how.quiet;
        let mut messages = if direct {
            terminal.direct()
        } else {
            terminal.messages()
        };
        let refused = Some(Verdict::Refused);
        let done = in_own_dialect(
            &setup,
            program,
            &mut messages,
            refused,
            |setup, messages| {
                places.make_folders()?;
                work(OneOf {
                    setup,
                    program,
                    places,
                    messages,
                })
            },
        );
        (messages, done)
    };
    let progress = Progress::of_programs(terminal.progress(how.quiet), jobs.len());
    let one_done = progress.meter();
    let mut totals = Totals::default();
    in_order(&jobs, at_once, one, |(messages, done)| {
        let verdict = done
            .as_ref()
            .map_or(Some(Verdict::Refused), |verdict| *verdict);
        if !(how.quiet && matches!(verdict, Some(Verdict::Fits) | None)) {
            terminal.show(&messages);
        }
        if let Err(error) = done {
            terminal.error(format_args!("{error:#}"));
        }
        totals.count(verdict);
        one_done.add(1);
        Ok(())
    })?;
    drop(progress);
    terminal.text(&format!("{totals}\n"));
    Ok(totals.worst())
}

/// Does `work` with the program's own language where that is still to be chosen; `refused`
/// where it cannot be.
pub fn in_own_dialect<T>(
    setup: &Setup,
    program: &Program,
    messages: &mut Messages,
    refused: T,
    work: impl FnOnce(&Setup, &mut Messages) -> Result<T>,
) -> Result<T> {
    if !setup.auto {
        return work(setup, messages);
    }
    match dialect::choose(setup, program) {
        Ok((language, note)) => {
            messages.note(format_args!("{}: {note}", program.name));
            let mut own = setup.clone();
            own.machine.controller.language = language;
            work(&own, messages)
        }
        Err(failure) => {
            messages.failure(&program.name, &failure);
            Ok(refused)
        }
    }
}
