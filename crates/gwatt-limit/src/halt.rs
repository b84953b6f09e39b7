//! Exact stops between feeds where only the robust bound holds between them.
//!
//! That bound charges a move with the speeds of its neighbours. A stop at its end keeps the
//! next one out; with stops at both ends it is planned from rest to rest. What a stop costs
//! is counted as if the corner were passed at full speed otherwise, and what the lower feed
//! costs as if nothing else braked: a stop that is chosen saves time on any control.

use std::collections::VecDeque;

use super::case::Ends;
use super::change::Change;
use super::members::{Member, Window, change, put};
use super::slot::{Outcome, Slot};
use super::solver::Solver;
use super::window::lower;
use gwatt_plan::{Plan, Trajectory, plan};

/// The share of the time without stops that the time with them must stay under.
const SOONER: f64 = 0.999;

/// The slots of a window.
type Saved = Vec<Slot>;

/// Puts stops at the ends of the window's middle move where that costs less time than the
/// feeds that it has been lowered to; `before` are the slots before that.
pub(super) fn consider(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    center: usize,
    before: &Saved,
) {
    let lowered = window.iter().zip(before).any(|(member, before)| {
        let outcome = &slots[member.index].outcome;
        *outcome != before.outcome || member.index == center && outcome.change.is_some()
    });
    let known = |member: &Member<'_>| member.mv.unknown_start.is_empty();
    let Some(place) = window.iter().position(|member| member.index == center) else {
        return;
    };
    if !lowered || !window.iter().all(known) || !window[place].permit.stop_word {
        return;
    }
    let joint = Joint {
        solver,
        window,
        place,
    };
    let as_it_is = joint.save(slots);
    let mut best = (joint.time_s(slots, [false; 2]) * SOONER, as_it_is);
    for both in [false, true] {
        joint.restore(slots, before);
        if joint.put_stops(slots, both) {
            let time_s = joint.time_s(slots, [both, true]);
            if time_s < best.0 {
                best = (time_s, joint.save(slots));
            }
        }
    }
    joint.restore(slots, &best.1);
}

/// A move between the neighbours that it is joined to.
struct Joint<'w, 's, 'm, 'a> {
    solver: &'s Solver<'m>,
    window: &'w Window<'a>,
    /// Of the move in the window.
    place: usize,
}

impl Joint<'_, '_, '_, '_> {
    fn save(&self, slots: &VecDeque<Slot>) -> Saved {
        let members = self.window.iter();
        members.map(|member| slots[member.index].clone()).collect()
    }

    fn restore(&self, slots: &mut VecDeque<Slot>, saved: &Saved) {
        for (member, slot) in self.window.iter().zip(saved) {
            slots[member.index] = slot.clone();
        }
    }

    /// Ends the move at rest, and the one before it too where `both` says so; false where
    /// that may not be or does not help.
    fn put_stops(&self, slots: &mut VecDeque<Slot>, both: bool) -> bool {
        let member = &self.window[self.place];
        let previous = self.window[..self.place].first();
        // Alone it has been looked at without a stop before it.
        if both && !previous.is_some_and(|previous| previous.permit.stop_word) {
            return false;
        }
        slots[member.index].outcome = Outcome::default();
        slots[member.index].changed = None;
        let fits = match previous {
            Some(previous) if both => {
                let stopped = Change {
                    stop: true,
                    ..change(slots, previous)
                };
                put(self.solver, slots, previous, stopped);
                slots[previous.index].joined = false;
                self.solve_alone(slots)
            }
            Some(_) => {
                let group: Window<'_> = self.window[..=self.place].iter().copied().collect();
                lower(self.solver, slots, &group, member.index);
                slots[member.index].outcome.obstacle.is_none()
            }
            None => self.solve_alone(slots),
        };
        let stopped = Change {
            stop: true,
            ..change(slots, member)
        };
        put(self.solver, slots, member, stopped);
        slots[member.index].joined = false;
        fits
    }

    /// Gives the move what it needs from rest to rest.
    fn solve_alone(&self, slots: &mut VecDeque<Slot>) -> bool {
        let Self { solver, .. } = *self;
        let member = &self.window[self.place];
        let case = member.case(slots);
        if solver.load(case, member.mv) <= 1.0 {
            return true;
        }
        match solver.solve(case.mv, case.assessment, case.permit, Ends::Rest) {
            Ok(change) => {
                put(solver, slots, member, change);
                true
            }
            Err(_) => false,
        }
    }

    /// Time of the move and the one before it, with what stops at their ends (before and
    /// after the move) cost them and the next one; without such as if none braked.
    fn time_s(&self, slots: &VecDeque<Slot>, stops: [bool; 2]) -> f64 {
        let member = &self.window[self.place];
        if slots[member.index].outcome.obstacle.is_some() {
            return f64::INFINITY;
        }
        let run = |member: &Member<'_>| -> Run {
            let changed = member.changed(slots);
            let plan = plan(self.solver.machine, changed, self.solver.largest);
            Run::of(&plan, changed.length_mm)
        };
        let own = run(member);
        let previous = self.window[..self.place].last().map(run);
        let next = self.window.get(self.place + 1).map(run);
        let mut time_s = own.time_s + previous.map_or(0.0, |previous| previous.time_s);
        // Where nothing is joined to it, it stands whatever is done.
        if stops[0] || previous.is_none() {
            time_s += own.stop_s + previous.map_or(0.0, |previous| previous.stop_s);
        }
        if stops[1] || next.is_none() {
            time_s += own.stop_s + next.map_or(0.0, |next| next.stop_s);
        }
        time_s
    }
}

/// How long a move takes at its speed, and how much longer with a stop at one end.
#[derive(Debug, Clone, Copy)]
struct Run {
    time_s: f64,
    stop_s: f64,
}

impl Run {
    fn of(plan: &Plan, length_mm: f64) -> Self {
        let (speed_mm_s, accel_mm_s2) = (plan.speed_limit_mm_s, plan.accel_mm_s2);
        if matches!(plan.trajectory, Trajectory::Rest) || speed_mm_s <= 0.0 {
            return Self {
                time_s: plan.duration_s,
                stop_s: 0.0,
            };
        }
        let time_s = length_mm / speed_mm_s;
        // A short move does not reach its speed: others have the rest of the ramp.
        let ramp_s = 0.5 * speed_mm_s / accel_mm_s2.max(f64::MIN_POSITIVE);
        Self {
            time_s,
            stop_s: ramp_s.max(0.5 * (plan.duration_s - time_s)),
        }
    }
}
