//! Moves whose drives leave less than the acceleration that the axes are given.
//!
//! The planner takes the lowest acceleration that the drives leave up to the speed of
//! a move: so much is certain, and the times hold. Where the drives leave more at
//! lower speeds, the motion may be ahead of the plan, and more is drawn. A move at
//! one speed throughout has nothing to gain; any other one between two stops may
//! run up and down the curves as far as its own speed.

use super::open::Open;
use crate::machine::Machine;
use crate::plan::{Overrides, ramps};
use crate::power::demand::Want;
use crate::power::eye::Eye;
use crate::power::model::PowerModel;

impl Open {
    /// Counts what the curves of force permit. Of an arc, and over time, the robust
    /// bound does.
    #[cold]
    pub(super) fn drive(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        eye: &Eye,
        largest: Overrides,
    ) {
        if self.mv.arc.is_some() || eye.watch.is_some() {
            self.certain = false;
            return;
        }
        let want = Want {
            energy: false,
            ..self.want
        };
        let demand = model.demand(&self.mv, &ramps(machine, &self.mv, largest), want);
        self.assessment.demand.include(&demand);
    }
}
