//! Which moves wait for what comes after them.

use super::assess::Assessor;
use super::assessment::Certificate;
use super::lookahead::{Role, role};
use gwatt_machine::{PathMode, RapidJoint};
use gwatt_motion::{Move, MoveKind};

impl Assessor<'_> {
    /// Whether what comes after a move may change how it runs: it may be blended with
    /// that, or be an arc that `LinuxCNC` runs otherwise where nothing comes.
    pub(super) fn may_blend(&self, mv: &Move) -> bool {
        if !mv.moves_axes() {
            return false;
        }
        let (planner, ahead) = (&self.machine.controller.planner, self.ahead.as_ref());
        let rapid = mv.kind == MoveKind::Rapid;
        self.requested == Some(Certificate::Robust)
            || mv.stray.is_far()
            || mv.path_mode == PathMode::LookAhead
                && (!rapid || planner.rapid_joint != RapidJoint::Stop)
            || mv.arc.is_some() && ahead.is_some_and(|ahead| ahead.slows_last_arcs())
    }

    /// Whether a move has a path of its own, begun and ended at rest.
    pub(super) fn is_alone(&self, mv: &Move) -> bool {
        mv.path_mode == PathMode::ExactStop && role(self.machine, mv) == Role::Path
    }

    /// Whether a move ends at rest, whatever follows; `None` where it moves no axis.
    pub(super) fn ends_at_rest(&self, mv: &Move) -> Option<bool> {
        if mv.kind == MoveKind::Dwell {
            return Some(true);
        }
        mv.moves_axes().then(|| {
            let rapid = mv.kind == MoveKind::Rapid;
            mv.path_mode == PathMode::ExactStop
                || rapid && self.machine.controller.planner.rapid_joint == RapidJoint::Stop
        })
    }

    /// Whether the controller may run from `first` into `second` without a stop.
    #[must_use]
    pub fn joins(&self, first: &Move, second: &Move) -> bool {
        if !first.moves_axes() || !second.moves_axes() {
            return false;
        }
        if self.requested == Some(Certificate::Robust) {
            return true;
        }
        let rapids = [first, second].map(|mv| mv.kind == MoveKind::Rapid);
        first.path_mode == PathMode::LookAhead
            && match self.machine.controller.planner.rapid_joint {
                RapidJoint::Stop => rapids == [false, false],
                RapidJoint::Rapids => rapids[0] == rapids[1],
                RapidJoint::All => true,
            }
    }
}
