//! Words for the jerk: one share of it for all axes, since the axis with the largest share is
//! the one that counts.

use super::case::{Case, Ends};
use super::change::{Change, round_to_step};
use super::root::largest;
use super::solver::Solver;
use gwatt_machine::AXES;

impl Solver<'_> {
    /// The jerk at a share of what is in force, rounded down; `None` where the word does not
    /// go that low.
    pub(super) fn jerk_change(&self, case: Case<'_>, knob: usize, share: f64) -> Option<Change> {
        let data = self.machine.controller.knobs.get(knob)?;
        let percent = case.mv.jerk_factor * share * 100.0;
        let percent = round_to_step(percent * (1.0 + 1e-12), data.step);
        (percent >= data.min && percent > 0.0).then_some(Change {
            accel: Some((knob, [percent; AXES])),
            ..Change::NONE
        })
    }

    /// The highest jerk with which a move fits at the speed that it has. Next to others, which
    /// it may begin and end with at any acceleration, the jerk does not matter.
    pub(super) fn jerk_alone(&self, case: Case<'_>, knob: usize) -> Option<Change> {
        if case.ends != Ends::Rest {
            return None;
        }
        let mut moved = case.mv.clone();
        let mut load_at = |share: f64| {
            moved.jerk_factor = case.mv.jerk_factor * share;
            self.load(case, &moved)
        };
        let load_top = load_at(1.0);
        let share = if load_top <= 1.0 {
            1.0
        } else {
            largest(1.0, load_top, load_at)?
        };
        self.jerk_change(case, knob, share)
    }
}
