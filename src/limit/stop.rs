//! Rapids that are written as feeds between two stops, and how they run there.

use super::solver::Solver;
use crate::interpret::{Corner, Move, MoveKind};
use crate::machine::{CornerRule, PathMode, RapidJoint};

impl Solver<'_> {
    /// Whether a rapid became a feed that begins and ends at rest, since feeds
    /// would be blended otherwise than rapids.
    pub(super) fn gets_stops(&self, rapid: &Move, changed: &Move) -> bool {
        self.machine.controller.planner.rapid_joint != RapidJoint::All
            && rapid.kind == MoveKind::Rapid
            && changed.kind != MoveKind::Rapid
    }

    /// Such a feed as it runs where the dwells that make the stops leave it only half
    /// of its acceleration: `LinuxCNC` has no element after it to blend with.
    pub(super) fn halved(&self, rapid: &Move, changed: &Move) -> Option<Move> {
        let planner = &self.machine.controller.planner;
        let rule = planner.look_ahead.map(|rules| rules.corner);
        let halves = self.gets_stops(rapid, changed)
            && planner.dwell_stops
            && changed.path_mode == PathMode::LookAhead
            && matches!(changed.corner, Corner::Round { .. })
            && matches!(rule, Some(CornerRule::LinuxCnc { .. }));
        halves.then(|| Move {
            accel_mm_s2: changed.accel_mm_s2.map(|accel| 0.5 * accel),
            path_accel_mm_s2: 0.5 * changed.path_accel_mm_s2,
            ..changed.clone()
        })
    }
}
