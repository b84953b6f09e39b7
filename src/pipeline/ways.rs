//! The ways in which a program can go on where only the machine knows it: probes that
//! touch or do not, switches of block delete that are on or off.
//!
//! Each way is a reading of its own; what holds for all of them holds for the program.

use std::collections::BTreeSet;
use std::io::{Read, Seek};

use super::executor::{Executor, NO_PROGRAM};
use super::{Failure, Options};
use crate::diagnostic::Diagnostic;
use crate::interpret::{BlockDelete, ProbeResult, ProbeWay};
use crate::machine::Machine;

/// Ways that are followed at most.
const WAYS_MAX: usize = 64;

/// Whether a program may have several ways by what is asked for.
pub(super) fn has_ways(options: &Options) -> bool {
    matches!(options.reading.probe, Some(ProbeResult::Either(_)))
}

/// Options for each way, those asked for first: all results of probes where both are
/// asked for and, with `switches`, all settings of the switches of block delete that the
/// program has blocks for.
pub(super) fn ways<R: Read + Seek>(
    input: R,
    machine: &Machine,
    options: &Options,
    switches: bool,
) -> Result<Vec<Options>, Failure> {
    let mut search = Search {
        input,
        machine,
        levels: BTreeSet::new(),
        ways: Vec::new(),
    };
    let asked = options.reading.block_delete;
    let mut tried = Vec::new();
    let mut next = Some(asked);
    while let Some(block_delete) = next {
        tried.push(block_delete);
        let mut options = options.clone();
        options.reading.block_delete = block_delete;
        search.follow(options)?;
        next = settings(asked, &search.levels)
            .filter(|_| switches)
            .find(|setting| !tried.contains(setting));
    }
    Ok(search.ways)
}

/// All settings of the switches of these levels, from `asked` on.
fn settings(asked: BlockDelete, levels: &BTreeSet<u8>) -> impl Iterator<Item = BlockDelete> {
    (0_u32..1 << levels.len()).map(move |turned| {
        let levels = levels.iter().enumerate();
        let levels = levels.filter(|(place, _)| turned >> place & 1 == 1);
        levels.fold(asked, |setting, (_, level)| setting.turned(*level))
    })
}

/// What was found so far.
struct Search<'m, R> {
    input: R,
    machine: &'m Machine,
    /// Levels of block delete that have come up.
    levels: BTreeSet<u8>,
    ways: Vec<Options>,
}

impl<R: Read + Seek> Search<'_, R> {
    /// Adds a way for each sequence of results that probes may have.
    fn follow(&mut self, mut options: Options) -> Result<(), Failure> {
        let mut next = Some(ProbeWay::default());
        while let Some(way) = next {
            let either = has_ways(&options);
            if either {
                options.reading.probe = Some(ProbeResult::Either(way));
            }
            self.input.rewind().map_err(Failure::Input)?;
            let mut front = Executor::new(&mut self.input, self.machine, &options);
            while let Some(line) = front.next_line()? {
                if line.block.delete_level > 0 {
                    self.levels.insert(line.block.delete_level);
                }
            }
            let asked = front.interpreter().probe_answers();
            match front.finish() {
                Ok(_) => self.ways.push(options.clone()),
                // Nothing is done at all: nothing to be looked at.
                Err(failure) if !self.ways.is_empty() && does_nothing(&failure) => {}
                Err(failure) => return Err(on_way(failure, way, asked)),
            }
            // Each answer that was a hit opens one more way at least.
            let hits = (0..asked).filter(|answer| !way.misses(*answer)).count();
            if self.ways.len() + hits > WAYS_MAX {
                return Err(too_many());
            }
            next = way.next(asked).filter(|_| either);
        }
        Ok(())
    }
}

/// Whether a program is refused since none of its blocks does anything.
fn does_nothing(failure: &Failure) -> bool {
    match failure {
        Failure::Refused { diagnostics, .. } => diagnostics.iter().all(|it| it.rule == NO_PROGRAM),
        _ => false,
    }
}

/// Says on which way a program is refused.
fn on_way(failure: Failure, way: ProbeWay, asked: u32) -> Failure {
    let Failure::Refused {
        mut diagnostics,
        more,
    } = failure
    else {
        return failure;
    };
    if asked > 0 {
        let found: Vec<&str> = (0..asked)
            .map(|answer| if way.misses(answer) { "miss" } else { "hit" })
            .collect();
        let message = format!("this is so where the probes find: {}", found.join(", "));
        diagnostics.push(Diagnostic::note("probe-way", message));
    }
    Failure::Refused { diagnostics, more }
}

fn too_many() -> Failure {
    let message =
        format!("the program can go on in more than {WAYS_MAX} ways by what its probes find");
    let help = "--probe hit and --probe miss each follow one";
    Failure::Refused {
        diagnostics: vec![Diagnostic::error("too-many-ways", message).help(help)],
        more: 0,
    }
}

/// Whether a program is looked at with several settings of the switches of block delete.
pub(super) fn turns_switches(paths: &[Options]) -> bool {
    let switches = |options: &Options| options.reading.block_delete;
    let mut pairs = paths.windows(2);
    pairs.any(|pair| matches!(pair, [a, b] if switches(a) != switches(b)))
}
