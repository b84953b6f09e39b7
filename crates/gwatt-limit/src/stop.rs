//! Rapids that are written as feeds between two stops, and how they run there.

use super::case::{Case, Ends};
use super::change::{Change, Permit};
use super::lever::Obstacle;
use super::solver::Solver;
use gwatt_machine::{CornerRule, Knob, Machine, PathMode, RapidJoint};
use gwatt_motion::{Corner, Move, MoveKind};
use gwatt_plan::plan;
use gwatt_power::Assessment;

/// The share of its time between dwells in which a feed must run in exact stop to be
/// written so.
const SOONER: f64 = 0.999;

impl Change {
    /// A rapid as a feed at the speed that it has, stopping where the rapid does. `assessment` is
    /// that of the rapid.
    #[must_use]
    pub fn as_feed_in_place(
        machine: &Machine,
        mv: &Move,
        permit: &Permit,
        assessment: &Assessment,
    ) -> Self {
        let feed = Self::as_feed_at(machine, mv, permit, assessment.speed_mm_s);
        let blends = feed.apply(machine, mv, permit).path_mode == PathMode::LookAhead;
        let stops = if machine.controller.planner.rapid_joint == RapidJoint::All {
            permit.stop_word && !assessment.blended && !assessment.ahead
        } else {
            permit.exact_stop
        };
        Self {
            exact_stop: blends && stops,
            ..feed
        }
    }
}

impl Solver<'_> {
    /// Whether a rapid became a feed that begins and ends at rest, since feeds
    /// would be blended otherwise than rapids, or runs in exact stop while a knob is turned
    /// for which the axes stand.
    pub(super) fn gets_stops(&self, rapid: &Move, changed: &Move) -> bool {
        // A word for an exact stop that is written for its own sake stops its end alone.
        let halts = changed.path_mode == PathMode::ExactStop
            && rapid.path_mode != PathMode::ExactStop
            && self.machine.controller.knobs.iter().any(Knob::stands);
        self.machine.controller.planner.rapid_joint != RapidJoint::All
            && rapid.kind == MoveKind::Rapid
            && (changed.kind != MoveKind::Rapid || halts)
    }

    /// Whether a change of acceleration needs exact stop: next to a stop that the knob
    /// makes, `LinuxCNC` leaves a blended move only half of its acceleration.
    pub(super) fn halts(&self, case: Case<'_>, knob: usize) -> bool {
        let knob = self.machine.controller.knobs.get(knob);
        knob.is_some_and(Knob::stands) && case.mv.path_mode == PathMode::LookAhead
    }

    /// How long the axes stand for a change and for what takes it back, s.
    pub(super) fn stands_s(&self, change: &Change) -> f64 {
        let knob = change
            .accel
            .and_then(|(knob, _)| self.machine.controller.knobs.get(knob));
        knob.map_or(0.0, |knob| 2.0 * knob.change_s)
    }

    /// Such a feed as it runs where the dwells that make the stops leave it only half
    /// of its acceleration: `LinuxCNC` has no element after it to blend with. From a place
    /// that is not known it counts with all of it.
    pub(super) fn halved(&self, rapid: &Move, changed: &Move) -> Option<Move> {
        let planner = &self.machine.controller.planner;
        let rule = planner.look_ahead.map(|rules| rules.corner);
        let halves = self.gets_stops(rapid, changed)
            && changed.unknown_start.is_empty()
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

    /// Whether a rapid that stood at both ends by itself becomes a feed of which nobody says
    /// that it does, on a control that blends rapids like feeds.
    fn stood(&self, case: Case<'_>, changed: &Move) -> bool {
        self.machine.controller.planner.rapid_joint == RapidJoint::All
            && case.ends == Ends::Rest
            && !case.assessment.ahead
            && case.mv.kind == MoveKind::Rapid
            && changed.kind != MoveKind::Rapid
            && changed.path_mode == PathMode::LookAhead
    }

    /// Solves a case. Where a word in the block stops it at its end, that is taken: nothing
    /// is lost by it. Where the feed that stands for a rapid has half of its acceleration
    /// between dwells, exact stop is tried as well: it leaves the whole, so that the feed
    /// is lower. The sooner one is taken: on short ways exact stop, on long ones dwells.
    pub(super) fn sooner_stopped(
        &self,
        case: Case<'_>,
        solve: impl Fn(Case<'_>) -> Result<Change, Obstacle>,
    ) -> Result<Change, Obstacle> {
        let between_dwells = solve(case)?;
        let changed = self.changed(case, &between_dwells);
        if self.stood(case, &changed) {
            if case.permit.stop_word {
                return Ok(Change {
                    exact_stop: true,
                    ..between_dwells
                });
            }
            return solve(Case {
                ends: Ends::Any(2),
                ..case
            });
        }
        if !case.permit.exact_stop || !self.gets_stops(case.mv, &changed) {
            return Ok(between_dwells);
        }
        let halved = self.halved(case.mv, &changed);
        let knob = between_dwells.accel.map(|(knob, _)| knob);
        let knob = knob.and_then(|knob| self.machine.controller.knobs.get(knob));
        if halved.is_none() && !knob.is_some_and(Knob::stands) {
            return Ok(Change {
                exact_stop: changed.path_mode == PathMode::LookAhead,
                ..between_dwells
            });
        }
        let exact = Case {
            exact_stop: true,
            ..case
        };
        let time_s = |mv: &Move, change: &Change| {
            plan(self.machine, mv, self.largest).duration_s + self.stands_s(change)
        };
        let between_s = time_s(halved.as_ref().unwrap_or(&changed), &between_dwells);
        Ok(match solve(exact) {
            Ok(change) if time_s(&self.changed(case, &change), &change) < SOONER * between_s => {
                change
            }
            _ => between_dwells,
        })
    }

    /// The move as it runs with a change.
    fn changed(&self, case: Case<'_>, change: &Change) -> Move {
        change.apply(self.machine, case.mv, case.permit)
    }
}
