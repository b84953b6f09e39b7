//! Steps that come with a later block than their own: under cutter compensation, and next to a
//! corner that is cut or rounded, where a block ends depends on the next one. They go back to
//! the block whose words they obey.

use std::collections::VecDeque;

use super::entry::Entry;
use crate::interpret::Step;
use crate::machine::PathMode;

/// Where a step went: the place of its block among those that wait, and its own in the block.
pub(super) type Placed = (usize, usize);

/// Gives the steps of the last of these blocks to the blocks that they belong to, in order,
/// and lists in `placed` where they went. `mode` is the path mode of the move before them, and
/// then that of the last of them.
pub(super) fn hand_back(
    entries: &mut VecDeque<Box<Entry>>,
    mode: &mut PathMode,
    placed: &mut Vec<Placed>,
) {
    placed.clear();
    let Some(last) = entries.len().checked_sub(1) else {
        return;
    };
    let Some(entry) = entries.back_mut() else {
        return;
    };
    if !entry.facts.compensated {
        for (step, of) in entry.steps.iter().enumerate() {
            if let Step::Move(mv) = of {
                *mode = mv.path_mode;
            }
            placed.push((last, step));
        }
        return;
    }
    let holds = entry.awaits;
    let mut steps = std::mem::take(&mut entry.steps);
    entry.moves = 0;
    // Blocks are handed back to in their order: no step overtakes another.
    let mut owner = entries.iter().position(|it| it.awaits).unwrap_or(last);
    for step in steps.drain(..) {
        let mut from_here = entries.range(owner..last);
        owner = from_here
            .position(|entry| entry.owns(&step))
            .map_or(last, |further| owner + further);
        let Some(entry) = entries.get_mut(owner) else {
            continue;
        };
        if let Step::Move(mv) = &step {
            if entry.moves == 0 {
                entry.mode_before = *mode;
            }
            entry.moves += 1;
            *mode = mv.path_mode;
        }
        placed.push((owner, entry.steps.len()));
        entry.steps.push(step);
    }
    let complete = if holds { owner } else { last + 1 };
    for entry in entries.range_mut(..complete) {
        entry.awaits = false;
    }
}
