//! What the controller's words cost against the physical limit: how long the program takes
//! where a word for acceleration acts on each move by itself, whatever the control has.
//!
//! The same limiter decides for the same machine with such a word, the same planner drives
//! what comes of it, and nothing is written: the word exists nowhere.

mod trial;

use std::io::{Read, Seek};

use super::outcome::Ideal;
use super::split::impossible;
use super::summary::AT_LENGTH_MAX;
use super::ways::has_ways;
use super::{Allowed, Failure, Law, LimitOptions, LimitSummary, Options, PresetElse, Strategy};
use crate::machine::{Knob, KnobArgument, KnobTarget, KnobUnit, Machine};
use trial::Trial;

/// What a word must bring in that is worth a line: a share of the time, and in s.
const WORTH: f64 = 0.01;
const WORTH_S: f64 = 0.1;
/// Moves that do not fit of which each is looked into: that takes as long as to lower it.
const UNFIT_MAX: u64 = 2_000;
/// The same of moves that are tried in pieces, each of which takes a hundred times as long.
const IN_PIECES_MAX: u64 = 100;

/// What an ideal word for acceleration would bring; `None` where that is not worth a line,
/// where the program has so many moves that to try would take too long, or where it would
/// not fit with it either. `limited`: what came of it with the words that there are.
///
/// # Errors
/// See [`Failure`].
pub fn ideal<R: Read + Seek>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    limited: &LimitSummary,
) -> Result<Option<Ideal>, Failure> {
    let (before, after) = (&limited.before, &limited.after);
    let lost_s = after.duration_s - before.duration_s;
    let little = limited.certified && !is_worth(lost_s, after.duration_s);
    let many = before.moves > AT_LENGTH_MAX || before.unfit_count > UNFIT_MAX;
    // Of blocks that may be skipped the times are those of the slowest way.
    let ways = has_ways(options) || limited.may_skip;
    let by_rule = how.strategy == Strategy::Preset || how.law == Law::Patent;
    if little || many || by_rule || ways || !limited.pauses.is_empty() {
        return Ok(None);
    }
    let target = with_word(machine);
    input.rewind().map_err(Failure::Input)?;
    let trial = match Trial::read(input, &target, options) {
        Ok(Some(trial)) => trial,
        // A program with words of its own for what the ideal ones act on is not read then.
        Ok(None) | Err(Failure::Refused { .. }) => return Ok(None),
        Err(failure) => return Err(failure),
    };
    let asked = LimitOptions {
        strategy: Strategy::Optimal,
        law: Law::Exact,
        allowed: Allowed {
            feed: how.allowed.feed,
            ..Allowed::NOTHING
        },
        always: false,
        preset_else: PresetElse::Refuse,
    };
    let duration_s = trial.soonest_s(options, asked);
    let split = LimitOptions {
        strategy: Strategy::Split,
        ..asked
    };
    // In pieces no program is faster than it was.
    let may_gain = duration_s.is_none_or(|it| is_worth(it - before.duration_s, it));
    let few = before.unfit_count <= IN_PIECES_MAX;
    let in_pieces_s = (few && may_gain && impossible(&target).is_none())
        .then(|| trial.soonest_s(options, split))
        .flatten();
    let Some(duration_s) = duration_s.or(in_pieces_s) else {
        return Ok(None);
    };
    let least_s = in_pieces_s.map_or(duration_s, |split_s| split_s.min(duration_s));
    if limited.certified && !is_worth(after.duration_s - least_s, after.duration_s) {
        return Ok(None);
    }
    let sooner = |split_s: &f64| is_worth(duration_s - split_s, duration_s);
    Ok(Some(Ideal {
        duration_s,
        in_pieces_s: in_pieces_s.filter(sooner),
        settings: settings(machine, how),
    }))
}

/// Whether a gain of time is worth a line.
pub(crate) fn is_worth(gain_s: f64, duration_s: f64) -> bool {
    gain_s > WORTH_S && gain_s > WORTH * duration_s
}

/// The machine with words that are exact, act on each move by itself and between two that
/// run into each other: for the accelerations of feeds and of rapids, and for the speed of
/// rapids in place of an F.
fn with_word(machine: &Machine) -> Machine {
    let word = |target| Knob {
        code: None,
        name: String::new(),
        target,
        argument: KnobArgument::Axes,
        unit: KnobUnit::Percent,
        step: 0.0,
        min: 0.0,
        verified: true,
        between_moves: true,
        with_jerk: false,
        barrier: None,
        wait: None,
        change_s: 0.0,
        levels: None,
    };
    let mut target = machine.clone();
    let own = target.controller.knobs.drain(..);
    let others = own.filter(|knob| {
        let other = matches!(
            knob.target,
            KnobTarget::Jerk | KnobTarget::Speed | KnobTarget::SpeedShare | KnobTarget::CruiseRatio
        );
        // What the program selects itself counts on.
        other || knob.levels.is_some()
    });
    let ideal = [
        KnobTarget::FeedAccel,
        KnobTarget::RapidAccel,
        KnobTarget::RapidSpeed,
    ];
    let knobs = ideal.map(word).into_iter().chain(others).collect();
    target.controller.knobs = knobs;
    target
}

/// What would give the control a word for acceleration that it has not used.
fn settings(machine: &Machine, how: LimitOptions) -> Vec<String> {
    let knobs = &machine.controller.knobs;
    let usable = |knob: &&Knob| knob.lowers_accel();
    let mut settings = Vec::new();
    if let Some(knob) = knobs.iter().find(usable) {
        let name = knob.name.trim_end_matches('=');
        if knob.argument == KnobArgument::Value && !has_path_limit(machine) {
            settings.push(format!(
                "{name} is written where X and Y have one accel_mm_s2, which it can put back"
            ));
        } else if matches!(how.strategy, Strategy::Speed) {
            settings.push(format!("--strategy optimal writes {name}"));
        } else if knob.between_moves && how.strategy != Strategy::Split {
            settings.push("--strategy split writes blocks in pieces".to_owned());
        }
    }
    let wired = machine.controller.wired.iter();
    let has_output = knobs.iter().any(|knob| knob.output().is_some());
    let mut wired = wired.filter(|knob| knob.lowers_accel() && !has_output);
    if let Some(knob) = wired.next() {
        settings.push(format!(
            "acceleration under [outputs] of the machine file, once {} is wired to it \
             (`gwatt machine show {}` has the lines)",
            knob.name, machine.controller.name
        ));
    }
    let unconfirmed = |knob: &&Knob| !knob.verified && !how.allowed.unverified;
    if let Some(knob) = knobs.iter().find(unconfirmed) {
        settings.push(format!(
            "--allow unverified writes {}, which no document confirms",
            knob.name
        ));
    }
    settings
}

/// Whether X and Y have one limit of acceleration, that along the path.
fn has_path_limit(machine: &Machine) -> bool {
    let [x, y] = [0, 1].map(|axis: usize| machine.axes.get(axis).and_then(Option::as_ref));
    match (x, y) {
        (Some(x), Some(y)) => x.accel_mm_s2 == y.accel_mm_s2,
        _ => true,
    }
}
