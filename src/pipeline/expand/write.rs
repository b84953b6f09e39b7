//! Cycles written in another way, as far as the program moves as it did.

use std::collections::{BTreeMap, BTreeSet};

use super::compare::first_difference;
use super::expanded::Expanded;
use super::in_place::InPlace;
use super::kept::Notes;
use super::survey::Survey;
use super::way::{LineWays, Way};
use crate::diagnostic::Diagnostic;
use crate::machine::Machine;
use crate::pipeline::{Failure, Options};

/// What came of it.
#[derive(Default)]
pub(super) struct Written {
    pub(super) expanded: Option<Expanded>,
    /// Lines of the text with calls in place that were written in another way.
    pub(super) lines: BTreeSet<u64>,
}

/// Writes the series of a program that are asked for. The program is the original, or stands
/// with blocks in place of calls. Why others stay is added to `notes`.
pub(super) fn write(
    survey: Survey,
    machine: &Machine,
    paths: &[Options],
    asked: &LineWays,
    (program, placed): (&[u8], Option<&InPlace>),
    mut notes: Notes,
) -> Result<(Written, Vec<Diagnostic>), Failure> {
    let origin = |line| placed.map_or(line, |placed| placed.origin(line));
    let text = placed.map_or(program, |placed| &placed.text);
    // By their first lines.
    let (mut written, mut levels) = (BTreeMap::new(), BTreeMap::new());
    let (mut kept, mut n_words) = (BTreeMap::new(), BTreeMap::new());
    for series in survey.series {
        let way = |line| match placed {
            Some(placed) => placed.way(asked, line),
            None => asked.way(None, line),
        };
        let mut ways = series.numbers.keys().filter_map(|line| way(*line));
        let first = ways.next();
        let wish = if ways.any(|way| way == Way::WrittenOut) {
            Some(Way::WrittenOut)
        } else {
            first
        };
        let Some(wish) = wish else {
            kept.extend(series.level);
            continue;
        };
        let (lines, refused) = series.settle(wish == Way::WrittenOut);
        let whole = lines.as_ref().err().copied();
        let own = refused.into_iter().filter(|(line, _)| way(*line).is_some());
        for (line, why) in own.chain(whole) {
            notes.stays(origin(line), series.stays, why, program);
        }
        let numbers = series.numbers;
        match lines {
            Ok(lines) => {
                let Some(first) = lines.keys().next().copied() else {
                    continue;
                };
                written.insert(first, (series.stays, lines));
                levels.extend(series.level.map(|level| (first, level)));
                let named = numbers.into_iter();
                n_words.extend(named.filter_map(|(line, word)| Some((origin(line), word?))));
            }
            Err(_) => kept.extend(series.level),
        }
    }
    loop {
        if written.is_empty() {
            return Ok((Written::default(), notes.list));
        }
        let mut lines: BTreeMap<u64, Vec<u8>> = kept.clone();
        let all = written.values().flat_map(|(_, lines)| lines);
        lines.extend(all.map(|(line, bytes)| (*line, bytes.clone())));
        let expanded = Expanded::new((text, placed), &lines, &n_words);
        let mut different = None;
        for options in paths {
            if different.is_none() {
                different = first_difference(program, &expanded.text, machine, options)?;
            }
        }
        let Some(line) = different else {
            let changed = written
                .into_values()
                .flat_map(|(_, lines)| lines.into_keys());
            let lines = changed.collect();
            let expanded = Some(expanded);
            return Ok((Written { expanded, lines }, notes.list));
        };
        // The last series before the place stays as it is.
        let line = expanded.line_before(line);
        let place = written.range(..=line).next_back().map(|(first, _)| *first);
        let Some((stays, lines)) = place.and_then(|first| written.remove(&first)) else {
            return Ok((Written::default(), notes.list));
        };
        kept.extend(levels.remove(lines.keys().next().unwrap_or(&0)));
        notes.stays(
            origin(line),
            stays,
            "written in another way it would not move as it does",
            program,
        );
    }
}
