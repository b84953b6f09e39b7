//! Turning cycles of Fanuc's and Haas' lathes that stand in one block: the passes as single
//! blocks, and the blocks of the contour, which the cycle has jumped over, as comments.

use std::collections::BTreeMap;

use super::{Lines, Series};
use crate::pipeline::executor::Line;
use crate::rewrite::{CycleBlock, Singles, contour_as_comment};
use crate::source::lines;
use crate::syntax::{Block, Word};

/// What is said where such a cycle stays as it is.
pub(super) const STAYS: &str = "the turning cycle is not written out";
/// Why it is not looked at in parts.
const FOLLOW: &str = "all its moves follow from each other";
/// The finishing cycle, times ten.
const FINISH: u16 = 700;
/// The cycles that cut threads, times ten: G76, and G92 of system A.
const THREADS: [u16; 2] = [760, 780];

/// The word of a turning cycle that holds for its block alone: G70 to G76.
pub(super) fn word(block: &Block) -> Option<Word> {
    let turning = |word: &&Word| word.letter == b'G' && (70.0..77.0).contains(&word.value);
    block.words.iter().find(turning).copied()
}

/// Why a turning cycle of a block may not be written out; `number` is that of the cycle,
/// times ten.
pub(super) fn stays(line: &Line<'_, '_>, number: u16) -> Option<&'static str> {
    if THREADS.contains(&number) {
        return Some("it cuts a thread");
    }
    if line.facts.compensated || line.interpreter.chooses_radius() {
        return Some("it runs under tool nose radius compensation");
    }
    line.facts.guessed
}

/// What such a block becomes, with the blocks of its contour.
pub(super) fn series(
    line: &Line<'_, '_>,
    word: Word,
    fixed: Option<&'static str>,
    program: &[u8],
    singles: &Singles<'_>,
) -> Series {
    let (_, number) = line.key;
    let cycle = CycleBlock {
        text: line.text,
        block: line.block,
        cycle_word: Some(word.span),
        number: (word.value * 10.0).round() as u16,
        steps: line.steps,
        modal: line.interpreter.modal(),
        motion_before: line.interpreter.modal().motion,
    };
    let contour = line.facts.contour;
    let written = match fixed.or_else(|| stays(line, cycle.number)) {
        Some(why) => Err(why),
        None => write(&cycle, contour, number, program, singles, line),
    };
    let mut numbers = BTreeMap::from([(number, line.block.number.map(|word| word.value))]);
    if let Some([first, last]) = contour
        && (written.is_ok() || cycle.number == FINISH)
    {
        // What takes a contour away needs the finishing cycle that reads it written out.
        numbers.extend((first..=last).map(|line| (line, None)));
    }
    let placed = Err((number, *written.as_ref().err().unwrap_or(&FOLLOW)));
    let written_out: Lines = written.map_err(|why| (number, why));
    Series {
        stays: STAYS,
        numbers,
        written_out,
        placed,
        ..Series::default()
    }
}

fn write(
    cycle: &CycleBlock<'_>,
    contour: Option<[u64; 2]>,
    number: u64,
    program: &[u8],
    singles: &Singles<'_>,
    line: &Line<'_, '_>,
) -> Result<BTreeMap<u64, Vec<u8>>, &'static str> {
    let place = |place: &_| line.interpreter.place_in_program(place);
    let text = |first: u64, last: u64| {
        let count = (last + 1).saturating_sub(first) as usize;
        lines(program).skip(first as usize - 1).take(count)
    };
    let held = BTreeMap::new();
    match (cycle.number, contour) {
        (FINISH, Some([first, last])) => {
            let lines = singles.write_finish(cycle, text(first, last), place)?;
            Ok(BTreeMap::from([(number, lines)]))
        }
        (_, Some([first, last])) => {
            if first <= number {
                return Err("its contour stands before it");
            }
            let mut lines =
                BTreeMap::from([(number, singles.write_out(cycle, &held, false, place)?)]);
            // What stands between them was jumped over too.
            let jumped = (number + 1..).zip(text(number + 1, last));
            lines.extend(jumped.filter_map(|(line, text)| Some((line, contour_as_comment(text)?))));
            Ok(lines)
        }
        (_, None) => Ok(BTreeMap::from([(
            number,
            singles.write_out(cycle, &held, false, place)?,
        )])),
    }
}
