//! Turning cycles of Fanuc's and Haas' lathes that stand in one block: the passes as single
//! blocks, and the blocks of the contour, which the cycle has jumped over, as comments.

use std::collections::BTreeMap;

use super::series::{Lines, Series};
use crate::pipeline::executor::Line;
use crate::rewrite::{CycleBlock, Singles, contour_as_comment};
use crate::source::lines;
use crate::syntax::{Block, Word, scan_line};

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
/// times ten, and `compensated` says whether the nose radius is compensated around it.
pub(super) fn stays(line: &Line<'_, '_>, number: u16, compensated: bool) -> Option<&'static str> {
    if THREADS.contains(&number) {
        return Some("it cuts a thread");
    }
    if compensated {
        return Some("it runs under tool nose radius compensation");
    }
    line.facts.guessed
}

/// Whether the nose radius is compensated around a cycle: before it, or after it, where the
/// contour has switched that on and nothing switches it off before the next move.
fn is_compensated(line: &Line<'_, '_>, before: bool, program: &[u8]) -> bool {
    let (_, number) = line.key;
    let last = match line.facts.contour {
        Some([_, last]) if last > number => last,
        _ => number,
    };
    before || line.interpreter.chooses_radius() && !is_switched_off(program, last)
}

/// Whether G40 comes after a line before anything that moves, or that leads elsewhere.
fn is_switched_off(program: &[u8], line: u64) -> bool {
    let mut block = Block::default();
    for text in lines(program).skip(line as usize) {
        scan_line(text, false, &mut block);
        let is = |letter, value| {
            let mut words = block.words.iter();
            words.any(|word: &Word| word.letter == letter && word.value == value)
        };
        // The contour of a finishing cycle switches it on for itself.
        if is(b'G', 40.0) || is(b'G', 70.0) {
            return block.delete_level == 0;
        }
        let harmless = |word: &Word| match word.letter {
            b'S' | b'F' => true,
            b'M' => (3.0..=9.0).contains(&word.value) && word.value != 6.0,
            b'G' => (96.0..=99.0).contains(&word.value),
            _ => false,
        };
        if !block.issues.is_empty() || !block.words.iter().all(harmless) {
            return false;
        }
    }
    false
}

/// What such a block becomes, with the blocks of its contour; `compensated`: the nose radius
/// was, before it.
pub(super) fn series(
    line: &Line<'_, '_>,
    (word, compensated): (Word, bool),
    fixed: Option<&'static str>,
    program: &[u8],
    singles: &Singles<'_>,
) -> Series {
    let compensated = is_compensated(line, compensated, program);
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
    let written = match fixed.or_else(|| stays(line, cycle.number, compensated)) {
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
    let mut placed = Lines::default();
    placed.add(number, Err(*written.as_ref().err().unwrap_or(&FOLLOW)));
    Series {
        stays: STAYS,
        numbers,
        written_out: written.map_err(|why| (number, why)).into(),
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
            let written = singles.write_out(cycle, &held, false, place)?;
            let mut lines = BTreeMap::from([(number, written.around(&[]))]);
            // What stands between them was jumped over too.
            let jumped = (number + 1..).zip(text(number + 1, last));
            lines.extend(jumped.filter_map(|(line, text)| Some((line, contour_as_comment(text)?))));
            Ok(lines)
        }
        (_, None) => {
            let written = singles.write_out(cycle, &held, false, place)?;
            Ok(BTreeMap::from([(number, written.around(&[]))]))
        }
    }
}
