//! What it would take to make a program fit that could not be: which permissions, and how
//! much time.

use std::collections::BTreeMap;
use std::io::{self, Read, Seek};

use super::limiting::limit;
use super::outcome::Price;
use super::pause;
use super::source::Source;
use super::summary::AT_LENGTH_MAX;
use super::{
    Allowed, Failure, LimitOptions, LimitSummary, Options, Restart, RestartRows, Row, RowSink,
};
use crate::diagnostic::Diagnostic;
use crate::limit::FEED_NOT_ALLOWED;
use crate::machine::Machine;

/// Limits a program that could not be made to fit with further permissions: each that is
/// enough by itself, or else the first of several together, and the feeds which they take, are
/// added to `refused`, what came of it as it was asked for. Nothing is where none is enough, or
/// where the program has so many moves that to try would take too long.
///
/// # Errors
/// See [`Failure`].
pub fn price<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    refused: &mut LimitSummary,
) -> Result<(), Failure> {
    price_of(&mut input, machine, options, how, refused)
}

fn price_of(
    mut input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    refused: &mut LimitSummary,
) -> Result<(), Failure> {
    if !refused.certified && !how.allowed.pause {
        advise_pause(&mut input, machine, options, refused)?;
    }
    if refused.certified || refused.before.moves > AT_LENGTH_MAX {
        return Ok(());
    }
    let mut feeds = Feeds::of(refused);
    let own = how.allowed.count();
    for allowed in further(machine, how.allowed, refused) {
        if allowed.count() > own + 1 && !refused.prices.is_empty() {
            break;
        }
        input.rewind().map_err(Failure::Input)?;
        let how = LimitOptions { allowed, ..how };
        let rows: Option<&mut dyn RestartRows> = (!feeds.lines.is_empty()).then_some(&mut feeds);
        let found = match limit(&mut input, machine, options, how, io::sink(), rows) {
            Ok(found) => found,
            // Permissions that do not go with each other or with the strategy.
            Err(Failure::Unsuitable(_)) => continue,
            Err(failure) => return Err(failure),
        };
        if found.certified {
            refused.prices.push(Price {
                allowed,
                duration_s: [refused.before.duration_s, found.after.duration_s],
            });
            feeds.take_into(refused);
            feeds.lines.clear();
        }
    }
    Ok(())
}

/// Says where the program could wait, in the reasons too.
fn advise_pause<R: Read + Seek>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    refused: &mut LimitSummary,
) -> Result<(), Failure> {
    input.rewind().map_err(Failure::Input)?;
    let (before, after) = (&mut refused.before.over_time, &mut refused.after.over_time);
    pause::advise(
        input,
        machine,
        options,
        before.iter_mut().chain(&mut *after),
    )?;
    for found in after.iter().filter(|found| found.may_pause) {
        let said = found.reason();
        let own = |it: &&mut Diagnostic| it.rule == said.rule && it.message == said.message;
        if let Some(reason) = refused.reasons.iter_mut().find(own) {
            reason.help = said.help;
        }
    }
    Ok(())
}

/// The lowest F that lines get which ask for permission.
struct Feeds {
    lines: BTreeMap<u64, Option<f64>>,
}

impl Feeds {
    fn of(refused: &LimitSummary) -> Self {
        let asks = |it: &&Diagnostic| it.rule == FEED_NOT_ALLOWED && it.file.is_none();
        let lines = refused.reasons.iter().filter(asks);
        Self {
            lines: lines.map(|reason| (reason.line, None)).collect(),
        }
    }

    /// What was found by limiting the whole program is said in place of what a block by
    /// itself would take.
    fn take_into(&self, refused: &mut LimitSummary) {
        for reason in &mut refused.reasons {
            let feed = self.lines.get(&reason.line).copied().flatten();
            if let Some(feed) = feed.filter(|_| reason.rule == FEED_NOT_ALLOWED) {
                reason.help = Some(format!("it fits at F{feed}: --allow feed permits that"));
            }
        }
    }
}

impl RowSink for Feeds {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        let by_feed = row.knob.split(' ').next() == Some("F") && row.file.is_empty();
        if let Some(known) = self.lines.get_mut(&row.line)
            && let Some(feed) = row.value_after.filter(|_| by_feed)
        {
            *known = Some(known.map_or(feed, |lowest| lowest.min(feed)));
        }
        Ok(())
    }

    fn wants_figures(&self) -> bool {
        false
    }
}

impl Restart for Feeds {
    fn restart(&mut self) -> io::Result<()> {
        self.lines.values_mut().for_each(|feed| *feed = None);
        Ok(())
    }
}

/// What may be allowed in addition, from what changes least on: each permission by itself, then
/// several.
fn further(machine: &Machine, own: Allowed, refused: &LimitSummary) -> Vec<Allowed> {
    let feed = Allowed { feed: true, ..own };
    let expand = Allowed {
        expand: true,
        ..own
    };
    let both = Allowed {
        expand: true,
        ..feed
    };
    let (mut single, mut several) = (vec![feed, expand], vec![both]);
    if machine.path.clearance_mm.iter().any(Option::is_some) {
        single.push(Allowed {
            straighten: true,
            ..own
        });
        several.push(Allowed {
            straighten: true,
            ..both
        });
    }
    if machine.controller.language.exact_stop_word.is_some() {
        single.push(Allowed { stop: true, ..own });
        several.push(Allowed { stop: true, ..both });
    }
    let over_time = &refused.after.over_time;
    if over_time.iter().any(|found| !found.rating.fits()) {
        single.push(Allowed { pause: true, ..own });
        several.push(Allowed {
            pause: true,
            ..both
        });
    }
    let mut tried = vec![own];
    single.extend(several);
    single.retain(|allowed| {
        let is_new = !tried.contains(allowed);
        tried.push(*allowed);
        is_new
    });
    single
}
