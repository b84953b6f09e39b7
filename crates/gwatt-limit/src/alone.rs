//! Moves that controllers run through, looked at by themselves: what their neighbours make of
//! them shows when the program is planned again.

use super::case::{Case, Ends};
use super::change::Change;
use super::depth::Depths;
use super::lever::{Levers, Obstacle};
use super::options::Strategy;
use super::solver::{Solver, share};
use super::split::cruise_ratio;
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{plan, ramps};
use gwatt_power::{Certificate, Want};

/// In how many rounds a move is looked at by itself before it has to fit whatever its
/// neighbours do, and in how many at most where that cannot be.
const STEPS: u8 = 3;
const STEPS_MOST: u8 = 10;

/// The share of the power that each step after the first leaves.
const LESS_A_STEP: f64 = 0.85;

/// Solves a move next to others that is lowered by its acceleration alone: first by
/// itself, since it may never reach the speed that its neighbours could carry it up to.
///
/// # Errors
/// What stands in the way.
pub(super) fn step_by_step(
    depth: u8,
    solved: impl Fn(Ends) -> Result<Change, Obstacle>,
) -> Result<Change, Obstacle> {
    if depth <= STEPS {
        // At its ends it will be slower than it was, if its neighbours are.
        let next = Ends::Alone(depth + 1);
        return solved(Ends::Alone(depth)).or_else(|_| solved(next));
    }
    // In what is left of the rounds all of its steps.
    let left = (depth - STEPS).saturating_mul(Depths::DEEPEST) / (Depths::DEEPEST - STEPS);
    solved(Ends::Any(left)).or_else(|obstacle| {
        if depth > STEPS_MOST {
            return Err(obstacle);
        }
        solved(Ends::Alone(depth)).map_err(|_| obstacle)
    })
}

impl Solver<'_> {
    /// Whether a move next to others has to fit by its acceleration alone, as far as a plan
    /// shows how they run. In pieces it is another matter.
    pub(super) fn by_accel_alone(&self, case: Case<'_>, levers: &Levers) -> bool {
        let planned = case.assessment.ahead && case.assessment.certificate == Certificate::Planned;
        let known = case.mv.unknown_start.is_empty();
        let whole = self.how.strategy != Strategy::Split;
        // Steps of speed do not fall with the acceleration.
        let ramps = !self.exceeds_by_steps(case, case.mv);
        whole && ramps && planned && known && levers.speed.is_none() && levers.accel.is_some()
    }

    /// The load of a move at one of these steps: from rest, then with the speeds at its ends that
    /// it had, then from rest with less and less power.
    pub(super) fn load_alone(&self, case: Case<'_>, mv: &Move, step: u8) -> f64 {
        let ends_mm_s = case.assessment.ends2.map(f64::sqrt);
        let known = ends_mm_s.iter().all(|end| end.is_finite());
        if step != 1 || mv.arc.is_some() || !known {
            let less = libm::pow(LESS_A_STEP, f64::from(step.saturating_sub(1)));
            let cruising = self.cruising(case, mv, [0.0; 2]);
            return self.planned_load(case, cruising.as_ref().unwrap_or(mv)) / less;
        }
        let cruising = self.cruising(case, mv, ends_mm_s);
        let mv = cruising.as_ref().unwrap_or(mv);
        let ramps = ramps(self.machine, mv, self.largest, ends_mm_s);
        let speed_mm_s = ramps.top_speed_mm_s;
        let demand = self.model.demand(mv, &ramps, Want::PEAKS);
        let demand = self.model.with_cruises(demand, mv, speed_mm_s);
        let share = &share(case, mv);
        self.model.load_with_spindle(&demand, share, speed_mm_s)
    }

    /// A move that is slower since the control cruises a share of each hill of speed; `None`
    /// where it does not.
    pub(super) fn cruising(&self, case: Case<'_>, mv: &Move, ends_mm_s: [f64; 2]) -> Option<Move> {
        let rules = self.machine.controller.planner.look_ahead?;
        let ratio = cruise_ratio(mv, &rules);
        let feeds = mv.kind != MoveKind::Rapid && mv.unknown_start.is_empty();
        if ratio == 0.0 || !feeds || !case.assessment.ahead {
            return None;
        }
        let planned = plan(self.machine, mv, self.largest);
        let [start, end] = ends_mm_s;
        let climb2 = (1.0 - ratio) * planned.accel_mm_s2 * mv.length_mm;
        let reached_mm_s = (0.5 * (start * start + end * end) + climb2).sqrt();
        let reached_mm_s = reached_mm_s.max(start).max(end);
        (reached_mm_s < planned.speed_limit_mm_s).then(|| Move {
            feed_mm_s: reached_mm_s / self.largest.feed,
            ..mv.clone()
        })
    }
}
