//! How the moves of a window are settled, one after the other.

use super::halt;
use super::members::{Member, Window};
use super::slot::{Slot, Waiting};
use super::solver::Solver;
use super::window::{indices, lower};
use std::collections::VecDeque;

/// Lowers the window around `center` if it does not fit; `find` gives the move of a slot.
pub(super) fn settle<'a>(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    find: &impl Fn(usize) -> Option<Waiting<'a>>,
    center: usize,
) {
    let loads = slots[center].loads;
    // Untouched, the window is the one that the assessment was made for.
    let untouched = |slot: &Slot| slot.outcome.change.is_none() && slot.loads == loads;
    if solver.model.fits(&slots[center].assessment.demand) && slots.iter().all(untouched) {
        return;
    }
    let window: Window<'a> = indices(slots, center)
        .into_iter()
        .filter_map(|index| {
            let Waiting { mv, permit } = find(index)?;
            Some(Member { index, mv, permit })
        })
        .collect();
    if !solver.how.allowed.stop {
        return lower(solver, slots, &window, center);
    }
    let before = window.iter().map(|member| slots[member.index].clone());
    let before = before.collect();
    lower(solver, slots, &window, center);
    halt::consider(solver, slots, &window, center, &before);
}
