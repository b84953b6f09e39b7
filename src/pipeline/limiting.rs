//! A program that fits: analysed, changed, written, and handed to the
//! certifier piece by piece, so that nothing of it is held for long.

use std::cell::Cell;
use std::io::{self, Cursor, Read, Seek, Write};

use super::analyze::judge;
use super::conclusion::holds_one_way;
use super::derate::{aim_lower, lower_further, missed_narrowly};
use super::executor::read_whole;
use super::expand::{
    LineWays, NOT_WRITTEN_OUT, OriginalRows, Traced, Way, expand, explain, in_fixed_blocks,
};
use super::pace::{by_acceleration, sooner};
use super::pause::limit_waiting;
use super::preset_notes::{NO_PRESET, NOT_SET};
use super::quoted::quote_program;
use super::readable::readable;
use super::rounds::{Job, Rounds, restart};
use super::row::Detail;
use super::source::{Source, Target};
use super::stops;
use super::strategy::check_strategy;
use super::unmarked::unmarked;
use super::ways::{has_ways, ways};
use super::word_choice::with_words;
use super::writer::Plan;
use super::{Failure, LimitOptions, LimitSummary, Options, Restart, RestartRows, Summary};
use crate::diagnostic::{Diagnostic, Severity};
use crate::limit::{Allowed, Depths};
use crate::machine::Machine;
use crate::power::Lower;

/// Reads a program, writes one that fits to `output`, and certifies it.
///
/// `output` is a spool: its contents may be delivered only when the result
/// says `certified`.
///
/// # Errors
/// See [`Failure`]. A program that cannot be made to fit is no error: see
/// [`LimitSummary::certified`].
pub fn limit<R: Read + Seek + Send, W: Write + Restart + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    mut output: W,
    mut rows: Option<&mut dyn RestartRows>,
) -> Result<LimitSummary, Failure> {
    let wanted = Wanted {
        how,
        rounds: Rounds::All,
    };
    let mut summary =
        limit_as_wanted(&mut input, machine, options, wanted, &mut output, &mut rows)?;
    quote_program(input, &mut summary)?;
    Ok(summary)
}

/// Why moves of a program cannot be lowered, as far as its first round of limiting shows: of long
/// programs that takes a small part of the time of [`limit`].
///
/// # Errors
/// See [`Failure`].
pub(super) fn first_reasons(
    input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
) -> Result<Vec<Diagnostic>, Failure> {
    let wanted = Wanted {
        how,
        rounds: Rounds::First,
    };
    limit_as_wanted(input, machine, options, wanted, &mut io::sink(), &mut None)
        .map(|summary| summary.reasons)
}

/// What is wanted of the limiter.
#[derive(Clone, Copy)]
struct Wanted {
    how: LimitOptions,
    rounds: Rounds,
}

/// See [`limit`].
fn limit_as_wanted(
    input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    wanted: Wanted,
    mut output: &mut dyn Target,
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<LimitSummary, Failure> {
    let mut begun = false;
    let mut run = |machine: &Machine, how: LimitOptions| {
        if std::mem::replace(&mut begun, true) {
            input.rewind().map_err(Failure::Input)?;
            restart(&mut output, rows)?;
        }
        limit_once(
            input,
            machine,
            options,
            Wanted { how, ..wanted },
            output,
            rows,
        )
    };
    with_words(machine, wanted.how, wanted.rounds == Rounds::All, &mut run)
}

/// The same with the machine's words as they are.
fn limit_once(
    input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    wanted: Wanted,
    output: &mut dyn Target,
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<LimitSummary, Failure> {
    if let Some((machine, note)) = readable(machine) {
        let mut summary = limit_once(input, &machine, options, wanted, output, rows)?;
        summary.before.notes.push(note);
        return Ok(summary);
    }
    check_strategy(machine, wanted.how)?;
    let mut summary = limit_ways(input, machine, options, wanted, output, rows)?;
    let notes = unmarked(options, wanted.how, &summary);
    summary.before.notes.extend(notes);
    Ok(summary)
}

/// What is asked of a program.
#[derive(Clone, Copy)]
struct Asked<'a> {
    machine: &'a Machine,
    /// How it is read, on each path through it.
    paths: &'a [Options],
    how: LimitOptions,
    rounds: Rounds,
}

/// Limits a program on all ways through it.
fn limit_ways<R: Read + Seek + Send, W: Write + Restart + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    wanted: Wanted,
    mut output: W,
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<LimitSummary, Failure> {
    let Wanted { how, rounds } = wanted;
    let paths = if has_ways(options) {
        let paths = ways(&mut input, machine, options, false)?;
        input.rewind().map_err(Failure::Input)?;
        paths
    } else {
        vec![options.clone()]
    };
    let asked = |paths| Asked {
        machine,
        paths,
        how,
        rounds,
    };
    let mut as_asked = limit_paths(&mut input, asked(&paths), &mut output, rows)?;
    if !as_asked.may_skip {
        return Ok(as_asked);
    }
    // Blocks that may be skipped: what is right with them and without is written, if
    // anything is.
    let otherwise = match ways(&mut input, machine, options, true) {
        Ok(all) if all.len() <= paths.len() => return Ok(as_asked),
        Ok(all) => {
            input.rewind().map_err(Failure::Input)?;
            restart(&mut output, rows)?;
            let summary = limit_paths(&mut input, asked(&all), &mut output, rows)?;
            if summary.certified || !as_asked.certified {
                return Ok(summary);
            }
            input.rewind().map_err(Failure::Input)?;
            restart(&mut output, rows)?;
            as_asked = limit_paths(input, asked(&paths), output, rows)?;
            summary.reasons
        }
        Err(Failure::Refused { diagnostics, .. }) => diagnostics,
        Err(failure) => return Err(failure),
    };
    let errors = |found: &&Diagnostic| found.severity == Severity::Error;
    if let Some(found) = otherwise.iter().find(errors).filter(|_| as_asked.certified) {
        let warning = holds_one_way(found.clone());
        as_asked.before.notes.push(warning);
    }
    Ok(as_asked)
}

/// Limits a program for all `paths` through it: as it stands, or else with its canned
/// cycles written in another way.
fn limit_paths<R: Read + Seek + Send, W: Write + Restart + Send>(
    mut input: R,
    mut asked: Asked<'_>,
    mut output: W,
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<LimitSummary, Failure> {
    let wished = asked.how;
    let mut first = limit_text(&mut input, asked, &mut output, rows)?;
    if wished.allowed.stop && stops::in_the_way(&first) {
        asked.how.allowed.stop = false;
        input.rewind().map_err(Failure::Input)?;
        restart(&mut output, rows)?;
        first = limit_text(&mut input, asked, &mut output, rows)?;
    }
    first
        .before
        .notes
        .extend(stops::without_word(asked.machine, wished));
    if first.certified || !in_fixed_blocks(&first) {
        return Ok(first);
    }
    limit_expanded(input, asked, output, rows, first)
}

/// Writes canned cycles in another way: first the ways to their holes stand by themselves,
/// then, where that is not enough and permitted, all their moves do, and those of cycles that
/// draw more next to them. What came of the program as it stands is `first`.
fn limit_expanded<R: Read + Seek + Send, W: Write + Restart + Send>(
    mut input: R,
    asked: Asked<'_>,
    mut output: W,
    rows: &mut Option<&mut dyn RestartRows>,
    mut first: LimitSummary,
) -> Result<LimitSummary, Failure> {
    let Asked {
        machine,
        paths,
        how,
        ..
    } = asked;
    let Some(program) = read_whole(&mut input)? else {
        return Ok(first);
    };
    let mut original = OriginalRows::default();
    if let ([options, ..], Detail::Figures) = (paths, Detail::of(rows.as_deref())) {
        let lower = Lower::default();
        judge(
            Cursor::new(&program),
            machine,
            &lower,
            options,
            Some(&mut original),
        )?;
    }
    let mut ways = LineWays::default();
    let mut last: Option<LimitSummary> = None;
    for way in [
        Way::Placed,
        Way::WrittenOut,
        Way::WrittenOut,
        Way::WrittenOut,
    ] {
        let refused = last.as_ref().unwrap_or(&first);
        if refused.certified || way == Way::WrittenOut && !how.allowed.expand {
            break;
        }
        let all = refused.reasons.len() >= Summary::KEPT;
        let before = ways.clone();
        ways.set_all(all.then_some(way));
        ways.extend(&refused.reasons, way);
        if ways == before {
            break;
        }
        let (expanded, notes) = expand(&program, machine, paths, &ways)?;
        if last.is_none() || way == Way::WrittenOut {
            first
                .before
                .notes
                .retain(|note| note.rule != NOT_WRITTEN_OUT);
            first.before.notes.extend(notes);
        }
        let Some(expanded) = expanded else { continue };
        restart(&mut output, rows)?;
        let text = Cursor::new(&expanded.text);
        let mut next = match rows {
            Some(rows) => {
                let mut rows = Traced::new(&mut **rows, &expanded, &original);
                let mut rows: Option<&mut dyn RestartRows> = Some(&mut rows);
                limit_text(text, asked, &mut output, &mut rows)?
            }
            None => limit_text(text, asked, &mut output, &mut None)?,
        };
        expanded.trace(&program, &mut next);
        last = Some(next);
    }
    Ok(of_original(first, last, how.allowed))
}

/// What came of a program of which parts were written in another way, `last`, with what is said
/// of the program itself, `first`.
fn of_original(
    mut first: LimitSummary,
    last: Option<LimitSummary>,
    allowed: Allowed,
) -> LimitSummary {
    let Some(mut last) = last else {
        explain(&mut first.reasons, &first.before.notes, allowed);
        return first;
    };
    // Presets are those of the program as it was written.
    let of_presets = |note: &Diagnostic| [NO_PRESET, NOT_SET].contains(&note.rule);
    let notes = &mut first.before.notes;
    notes.retain(|note| !of_presets(note));
    notes.extend(last.before.notes.drain(..).filter(of_presets));
    explain(&mut last.reasons, notes, allowed);
    LimitSummary {
        before: first.before,
        ..last
    }
}

/// Limits a program as it stands, for all `paths` through it.
fn limit_text<R: Read + Seek + Send, W: Write + Restart + Send>(
    mut input: R,
    asked: Asked<'_>,
    mut output: W,
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<LimitSummary, Failure> {
    let Asked {
        machine,
        paths,
        how,
        rounds,
    } = asked;
    let places = Cell::new(Vec::new());
    let learned = Cell::new(None);
    let mut attempt_with = |how, target: &Machine, plan: Option<Plan>, start, again: bool| {
        if again {
            input.rewind().map_err(Failure::Input)?;
            restart(&mut output, rows)?;
        }
        let job = Job {
            machine,
            target,
            paths,
            how,
            plan,
            rounds,
        };
        let found = job.rounds(start, &mut input, &mut output, rows, again)?;
        places.set(found.places);
        learned.set(found.paces);
        Ok(found.summary)
    };
    let stands = how.allowed.pause.then_some(Plan::NEVER);
    let first = attempt_with(how, machine, stands, Depths::default(), false)?;
    if rounds == Rounds::First {
        return Ok(first);
    }
    let first = sooner(how, first, &mut |paces| {
        let start = paces.map_or_else(Depths::default, Depths::by_measure);
        let found = attempt_with(how, machine, stands, start, true)?;
        Ok((found, learned.take().unwrap_or_default()))
    })?;
    let (how, first) = by_acceleration(machine, how, first, &mut |how| {
        attempt_with(how, machine, stands, Depths::default(), true)
    })?;
    let mut attempt = |target: &Machine, plan: Option<Plan>, again: bool| {
        attempt_with(how, target, plan, Depths::default(), again)
    };
    if missed_narrowly(&first) {
        return aim_lower(machine, first, &mut |target| attempt(target, None, true));
    }
    let in_time = first.after.over_time.iter().all(|it| it.rating.fits());
    if first.certified || in_time || first.after.unfit_count > 0 {
        return Ok(first);
    }
    if !how.allowed.pause {
        return lower_further(machine, first, &mut |target| attempt(target, None, true));
    }
    limit_waiting(machine, first, &places.take(), &mut attempt)
}
