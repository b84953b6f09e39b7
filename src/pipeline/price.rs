//! What it would take to make a program fit that could not be: which permissions, and how
//! much time.

use std::io::{self, Read, Seek};

use super::limiting::limit;
use super::summary::AT_LENGTH_MAX;
use super::{Allowed, Failure, LimitOptions, LimitSummary, Options};
use crate::machine::Machine;

/// What it takes to make a program fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Price {
    /// What has to be allowed, with what is allowed already.
    pub allowed: Allowed,
    /// How long the program takes as it came, and as it would be written, s.
    pub duration_s: [f64; 2],
}

/// Limits a program that could not be made to fit with further permissions, until one is
/// enough; `None` where none is, or where the program has so many moves that to try would
/// take too long. `refused`: what came of it as it was asked for.
///
/// # Errors
/// See [`Failure`].
pub fn price<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    how: LimitOptions,
    refused: &LimitSummary,
) -> Result<Option<Price>, Failure> {
    if refused.certified || refused.before.moves > AT_LENGTH_MAX {
        return Ok(None);
    }
    for allowed in further(machine, how.allowed, refused) {
        input.rewind().map_err(Failure::Input)?;
        let how = LimitOptions { allowed, ..how };
        let found = match limit(&mut input, machine, options, how, io::sink(), None) {
            Ok(found) => found,
            // Permissions that do not go with each other or with the strategy.
            Err(Failure::Unsuitable(_)) => continue,
            Err(failure) => return Err(failure),
        };
        if found.certified {
            return Ok(Some(Price {
                allowed,
                duration_s: [refused.before.duration_s, found.after.duration_s],
            }));
        }
    }
    Ok(None)
}

/// What may be allowed in addition, from what changes least on.
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
    let mut all = vec![feed, expand, both];
    if machine.path.clearance_mm.iter().any(Option::is_some) {
        all.push(Allowed {
            straighten: true,
            ..own
        });
        all.push(Allowed {
            straighten: true,
            ..both
        });
    }
    let over_time = &refused.after.over_time;
    if over_time.iter().any(|found| !found.rating.fits()) {
        all.push(Allowed { pause: true, ..own });
        all.push(Allowed {
            pause: true,
            ..both
        });
    }
    let mut tried = vec![own];
    all.retain(|allowed| {
        let is_new = !tried.contains(allowed);
        tried.push(*allowed);
        is_new
    });
    all
}
