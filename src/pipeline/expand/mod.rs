//! Canned cycles written out as single blocks, and returns to the reference point with their
//! way gone before: all of that can then be limited like other moves.
//!
//! Input: a program, and the lines whose moves have to be lowered. Output: the program with
//! the cycles of these lines written out, from the block that begins each of them to the one
//! that ends it, and for each of its lines the one that it comes from. It is read again and
//! compared with the original step by step, so it makes the same moves or is not passed on.
//!
//! Where several cycles drill at places that stand in one subprogram, its blocks take the place
//! of the calls first, and each cycle is written out there.

mod called;
mod compare;
mod expanded;
mod in_place;
mod kept;
mod origins;
mod returns;
mod rigid;
mod series;
mod survey;
mod trace;
mod turning;
mod way;
mod write;

use std::collections::BTreeMap;

use in_place::InPlace;
use kept::Notes;
use survey::Survey;
use write::{Written, write};

use super::{Failure, LimitSummary, Options, Summary};
pub(super) use expanded::Expanded;
pub(super) use kept::{NOT_WRITTEN_OUT, explain};
pub(super) use trace::{OriginalRows, Traced, WRITTEN_OUT};
pub(super) use way::{LineWays, Way};

use crate::diagnostic::Diagnostic;
use crate::limit::{NO_KNOB, UNTOUCHABLE};
use crate::machine::Machine;

/// Whether blocks that may not be changed, as those of canned cycles and returns to the
/// reference point, are among the reasons.
pub(super) fn in_fixed_blocks(summary: &LimitSummary) -> bool {
    let mut reasons = summary.reasons.iter();
    summary.reasons.len() >= Summary::KEPT
        || reasons.any(|it| [UNTOUCHABLE, NO_KNOB].contains(&it.rule))
}

/// Writes cycles in another way where that is `asked` for one of their lines; it holds
/// on all `paths` through the program. The second result says why others stay as they are.
pub(super) fn expand(
    program: &[u8],
    machine: &Machine,
    paths: &[Options],
    asked: &LineWays,
) -> Result<(Option<Expanded>, Vec<Diagnostic>), Failure> {
    let survey = Survey::of(program, machine, paths)?;
    let mut notes = Notes::default();
    let differing = survey.lines_that_differ(asked);
    if !differing.is_empty() || survey.drills_in_files(asked) {
        let calls = in_place::calls(program, machine, paths)?;
        let wanted = calls
            .iter()
            .filter(|(_, call)| call.runs(asked, &differing));
        let mut chosen = BTreeMap::new();
        for (line, call) in wanted {
            match &call.lines {
                Ok(lines) => {
                    chosen.insert(*line, lines.as_slice());
                }
                Err(why) => call.lines_here().for_each(|it| {
                    notes.not_in_place.insert(it, *why);
                }),
            }
        }
        while !chosen.is_empty() {
            let placed = InPlace::new(program, &chosen);
            let survey = Survey::of(&placed.text, machine, paths)?;
            let texts = (program, Some(&placed));
            let (written, notes) = write(survey, machine, paths, asked, texts, Notes::default())?;
            let count = chosen.len();
            // A call stays where nothing of what it runs is written in another way.
            chosen.retain(|call, _| placed.holds_any(*call, &written.lines));
            if chosen.len() == count {
                return Ok((written.expanded, notes));
            }
        }
    }
    let (Written { expanded, .. }, notes) =
        write(survey, machine, paths, asked, (program, None), notes)?;
    Ok((expanded, notes))
}
