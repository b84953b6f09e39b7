//! Programs that miss a limit over time and may wait: how long, and where.
//!
//! A dwell between rapids or before a tool change lets means fall and stores recover. Each
//! try is certified by the whole analysis, at every override that counts (a dwell lasts as
//! long at any), so nothing rests on how the figures depend on the dwell.

use std::io::{Read, Seek, sink};
use std::iter::once;

use super::derate::lower_further;
use super::over_time::OverTime;
use super::ways::has_ways;
use super::writer::{Plan, Streamed, Writer};
use super::{Failure, LimitOptions, LimitSummary, Options};
use crate::diagnostic::Diagnostic;
use crate::limit::{Depths, Limiter};
use crate::machine::Machine;
use crate::power::PowerModel;

/// The shortest dwell that is tried, s, and the longest that all of them may come to.
const SHORTEST_S: f64 = 0.1;
const LONGEST_S: f64 = 3600.0;
/// Each try waits so many times as long as the one before, until one is enough.
const STEP: f64 = 4.0;
/// Halvings between that one and the one before.
const HALVINGS: u32 = 5;

/// Limits the program once: the machine whose limits are aimed at, where it waits, and
/// whether something was written before.
type Attempt<'a> = dyn FnMut(&Machine, Option<Plan>, bool) -> Result<LimitSummary, Failure> + 'a;

/// Whether there is a place where a program could wait, if that were permitted.
///
/// # Errors
/// See [`Failure`].
pub(super) fn has_place<R: Read + Seek>(
    input: R,
    machine: &Machine,
    options: &Options,
) -> Result<bool, Failure> {
    let waits = machine.controller.language.dwell_block(SHORTEST_S);
    if waits.is_none() || has_ways(options) {
        return Ok(false);
    }
    let limiter = Limiter::new(machine, LimitOptions::USUAL, Depths::default());
    let model = PowerModel::new(machine);
    let writer = Writer::new(input, sink(), machine, options, limiter, model);
    let written = writer.pausing(Some(Plan::NEVER)).run(&mut |batch| {
        batch.clear();
        Ok(())
    })?;
    // What may be skipped is limited for all its ways at once, without dwells.
    Ok(matches!(written, Streamed::Written(it) if !it.may_skip && !it.places.is_empty()))
}

/// Says of the limits over time that are missed that the program could wait, where it could.
///
/// # Errors
/// See [`Failure`].
pub(super) fn advise<'a, R: Read + Seek>(
    input: R,
    machine: &Machine,
    options: &Options,
    over_time: impl Iterator<Item = &'a mut OverTime>,
) -> Result<(), Failure> {
    let missed: Vec<_> = over_time.filter(|it| it.pausing_helps()).collect();
    if missed.is_empty() || !has_place(input, machine, options)? {
        return Ok(());
    }
    for found in missed {
        found.may_pause = true;
    }
    Ok(())
}

/// Tries dwells as well as lower peaks, and takes what costs less.
pub(super) fn limit_waiting(
    machine: &Machine,
    first: LimitSummary,
    places: &[u64],
    attempt: &mut Attempt<'_>,
) -> Result<LimitSummary, Failure> {
    let waiting = shortest(&first, places, &mut |plan| {
        attempt(machine, Some(plan), true)
    })?;
    let mut lowered = lower_further(machine, first, &mut |target| attempt(target, None, true))?;
    let Some((plan, waiting)) = waiting else {
        let notes = &mut lowered.before.notes;
        match places.len() {
            0 => notes.push(no_place()),
            places if !lowered.certified => notes.push(not_enough(places)),
            _ => {}
        }
        return Ok(lowered);
    };
    if lowered.certified && lowered.after.duration_s <= waiting.after.duration_s {
        return Ok(lowered);
    }
    // What was written last is another one.
    attempt(machine, Some(plan), true)
}

/// Looks for dwells with which the limits over time are kept; `first` is what came of the
/// program without. `None` where there are none.
fn shortest(
    first: &LimitSummary,
    places: &[u64],
    attempt: &mut dyn FnMut(Plan) -> Result<LimitSummary, Failure>,
) -> Result<Option<(Plan, LimitSummary)>, Failure> {
    let mut best: Option<(Plan, LimitSummary)> = None;
    let missed = first.after.over_time.iter().filter(|it| !it.rating.fits());
    // One dwell just before the worst is reached may be enough.
    let worst = missed
        .map(|it| it.rating.line)
        .filter(|line| *line > 0)
        .max();
    let before = |line: &u64| worst.is_some_and(|worst| *line <= worst);
    let nearest = places.iter().copied().filter(before).max();
    let nearest = nearest.filter(|_| places.len() > 1);
    for place in once(None).chain(nearest.map(Some)) {
        let waits = if place.is_some() { 1 } else { places.len() };
        if waits == 0 {
            continue;
        }
        let most_s = LONGEST_S / waits as f64;
        if let Some(found) = fewest_seconds(place, most_s, attempt)?
            && best
                .as_ref()
                .is_none_or(|best| found.1.after.duration_s < best.1.after.duration_s)
        {
            best = Some(found);
        }
    }
    Ok(best)
}

/// The shortest dwells at these places.
fn fewest_seconds(
    place: Option<u64>,
    most_s: f64,
    attempt: &mut dyn FnMut(Plan) -> Result<LimitSummary, Failure>,
) -> Result<Option<(Plan, LimitSummary)>, Failure> {
    let mut enough = None;
    let mut low_s = 0.0;
    let mut each_s = SHORTEST_S;
    while enough.is_none() && each_s <= most_s {
        let plan = Plan { each_s, place };
        let summary = attempt(plan)?;
        if summary.pauses.is_empty() {
            return Ok(None);
        }
        if summary.certified {
            enough = Some((plan, summary));
        } else {
            low_s = each_s;
            each_s *= STEP;
        }
    }
    let Some(mut best) = enough else {
        return Ok(None);
    };
    for _ in 0..HALVINGS {
        let middle_s = 0.5 * (low_s + best.0.each_s);
        if best.0.each_s - low_s <= SHORTEST_S {
            break;
        }
        let plan = Plan {
            each_s: middle_s,
            place,
        };
        let summary = attempt(plan)?;
        if summary.certified {
            best = (plan, summary);
        } else {
            low_s = middle_s;
        }
    }
    Ok(Some(best))
}

/// What is said where the program may wait, and no dwells are enough.
fn not_enough(places: usize) -> Diagnostic {
    let s = if places == 1 { "" } else { "s" };
    Diagnostic::note(
        "pauses-not-enough",
        format!(
            "--allow pause: dwells at {places} place{s} between rapids, before tool changes or at \
             the end, of an hour in all, were tried and are not enough"
        ),
    )
}

/// What is said where the program may wait, but there is no place for it.
fn no_place() -> Diagnostic {
    Diagnostic::note(
        "no-place-to-pause",
        "--allow pause: there is no place to wait, after a rapid and before another one, a tool \
         change, a stop or the end, outside of cycles, loops and subprograms",
    )
}
