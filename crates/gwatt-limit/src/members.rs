//! Moves that are decided together.

use super::case::{Case, Ends};
use super::change::{Change, Permit};
use super::slot::Slot;
use super::solver::Solver;
use arrayvec::ArrayVec;
use gwatt_motion::Move;
use std::collections::VecDeque;

/// A move of a window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member<'a> {
    /// Of its slot.
    pub(super) index: usize,
    pub(super) mv: &'a Move,
    pub(super) permit: Permit,
}

impl Member<'_> {
    /// The move with its change.
    pub(super) fn changed<'s>(&'s self, slots: &'s VecDeque<Slot>) -> &'s Move {
        slots[self.index].changed.as_deref().unwrap_or(self.mv)
    }

    /// The move with its change, for the solver.
    pub(super) fn case<'s>(&'s self, slots: &'s VecDeque<Slot>) -> Case<'s> {
        Case {
            mv: self.mv,
            assessment: &slots[self.index].assessment,
            permit: &self.permit,
            ends: Ends::Rest,
            exact_stop: false,
        }
    }
}

/// Changes a move.
pub(super) fn put(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    member: &Member<'_>,
    change: Change,
) {
    let slot = &mut slots[member.index];
    slot.changed = Some(Box::new(change.apply(
        solver.machine,
        member.mv,
        &member.permit,
    )));
    slot.outcome.change = (!change.is_none()).then(|| Box::new(change));
}

/// What a move gets so far.
pub(super) fn change(slots: &VecDeque<Slot>, member: &Member<'_>) -> Change {
    let change = slots[member.index].outcome.change.as_deref();
    change.copied().unwrap_or(Change::NONE)
}

/// A move and the neighbours that it is joined to.
pub(super) type Window<'a> = ArrayVec<Member<'a>, 3>;
