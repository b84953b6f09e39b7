//! Moves whose drives leave less than the acceleration that the axes are given.
//!
//! The planner takes the lowest acceleration that the drives leave up to the speed of
//! a move: so much is certain, and the times hold. Where the drives leave more at
//! lower speeds, the motion may be ahead of the plan, and more is drawn. A move at
//! one speed throughout has nothing to gain; any other one may run up and down the
//! curves as far as its own speed, or as its length permits after the speeds of its
//! neighbours.

use super::open::Open;
use crate::demand::Want;
use crate::model::PowerModel;
use gwatt_machine::Machine;
use gwatt_plan::{Overrides, blended_bound, ramps};

impl Open {
    /// Counts what the curves of force permit, over time for as long as it may last.
    /// It begins and ends at `ends_mm_s` at most.
    #[cold]
    pub(super) fn drive(
        &mut self,
        ends_mm_s: [f64; 2],
        machine: &Machine,
        model: &PowerModel,
        largest: Overrides,
    ) {
        self.in_turn = false;
        let mv = &self.mv;
        if mv.arc.is_some() {
            // Where on its circle it speeds up is not known.
            let bound = blended_bound(machine, mv, largest);
            let demand = model.robust(mv, &bound, &mv.accel_mm_s2);
            self.assessment.demand.include(&demand);
            return;
        }
        let want = Want {
            energy: false,
            ..self.want
        };
        let ramps = ramps(machine, mv, largest, ends_mm_s);
        let demand = model.demand(mv, &ramps, want);
        self.assessment.demand.include(&demand);
    }
}
