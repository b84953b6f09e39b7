//! The way to the holes of a canned cycle, and the block that goes on from there.

use super::single::CycleBlock;
use crate::interpret::{Move, MoveKind, Step};
use crate::machine::{ALL_AXES, AxisSet};
use crate::syntax::Word;

/// Letters that a block may say more than once without doing more.
const AGAIN: &[u8] = b"GXYZUVWRPQFNIJ";

/// Whether a word has a cycle repeated.
pub(super) fn repeats(word: &Word) -> bool {
    matches!(word.letter, b'K' | b'L') && word.value != 1.0
}

/// The rapids before each run of other moves: those that lead to a hole, and those that lead
/// on from it.
pub(super) fn ways(steps: &[Step]) -> Vec<Vec<&Move>> {
    let mut ways = vec![Vec::new()];
    let mut leads = true;
    for step in steps {
        let Step::Move(mv) = step else { continue };
        if mv.kind != MoveKind::Rapid {
            leads = false;
            continue;
        }
        if !std::mem::replace(&mut leads, true) {
            ways.push(Vec::new());
        }
        if let Some(way) = ways.last_mut() {
            way.push(mv);
        }
    }
    ways
}

/// What of a way may be gone before its block: up to R and to the hole; down to R only
/// where the cycle comes back to R. Where it begins in the plane, no more is gone than need
/// be, unless `all` is asked for.
pub(super) fn before<'w, 'm>(way: &'w [&'m Move], plane: [usize; 3], all: bool) -> &'w [&'m Move] {
    let [first, second, normal] = plane;
    let across = AxisSet(1 << first | 1 << second);
    let in_plane = |mv: &&Move| mv.moving.0 & !across.0 == 0;
    if all {
        return way;
    }
    match way {
        [to_hole, ..] if in_plane(to_hole) => &way[..1],
        [up, to_hole, ..] if up.end[normal] > up.start[normal] && in_plane(to_hole) => &way[..2],
        _ => &[],
    }
}

/// The words of a block of increments that does the same from its hole, at the level of R;
/// `None` where it does more than that.
pub(super) fn again(of: &CycleBlock<'_>) -> Option<String> {
    let [first, second, _] = of.modal.plane;
    let letters = [first, second].map(|axis| ALL_AXES[axis].letter());
    let mut words = Vec::new();
    for word in &of.block.words {
        match word.letter {
            _ if repeats(word) => {}
            b'N' => {}
            letter if letters.contains(&letter) || letter == b'R' => {
                words.push(format!("{}0", char::from(letter)));
            }
            letter if AGAIN.contains(&letter) => {
                words.push(String::from_utf8_lossy(word.span.of(of.text)).into_owned());
            }
            _ => return None,
        }
    }
    Some(words.join(" "))
}
