//! Moves that exceed a limit by the steps of speed at their joints alone.
//!
//! The speeds of a polyline fall together, and with them the steps: what they ask
//! for besides friction falls with the third power of the speed where several lie
//! within the drives' response, with the second where one stands alone. The program
//! is planned again with the changes in any case; a deeper round expects less.

use super::case::{Case, Ends};
use super::options::Strategy;
use super::solver::{STEP_ROUNDS, Solver};
use gwatt_machine::AXES;
use gwatt_motion::Move;
use gwatt_plan::{blended_bound, blended_speed};

/// Powers of the speed by which the power of steps is expected to fall, by round;
/// what exceeds then is lowered as if it accelerated.
const POWERS: [f64; STEP_ROUNDS as usize] = [3.0, 2.0, 1.0];
impl Solver<'_> {
    /// Whether the steps at its joints are all that a move exceeds the limit by, changed
    /// to `mv` or not.
    pub(super) fn exceeds_by_steps(&self, case: Case<'_>, mv: &Move) -> bool {
        let loads = case.assessment.loads;
        let spindle = case.assessment.spindle;
        let alone = spindle.drawn_w == 0.0 && spindle.fed_back_w == 0.0;
        let known = mv.unknown_start.is_empty() && mv.length_mm > 0.0;
        let slows = self.how.strategy != Strategy::Accel;
        let stepped = loads.steps > 1.0 && loads.own <= 1.0;
        stepped && alone && known && slows && !self.gets_stops(case.mv, mv)
    }

    /// The load ratio of a changed move by its steps; `None` where these are not what it
    /// exceeds the limit by, or where that was expected too often.
    pub(super) fn load_by_steps(&self, case: Case<'_>, mv: &Move) -> Option<f64> {
        let depth = match case.ends {
            Ends::Any(depth) => depth,
            Ends::Rest | Ends::Alone(_) => 0,
        };
        let power = *POWERS.get(usize::from(depth))?;
        if !self.exceeds_by_steps(case, mv) {
            return None;
        }
        let drag = |mv: &Move| {
            let bound = blended_bound(self.machine, mv, self.largest);
            self.model.robust(mv, &bound, &[0.0; AXES]).load_ratio
        };
        let speed = |mv: &Move| blended_speed(self.machine, mv, self.largest);
        let share = (speed(mv) / speed(case.mv)).min(1.0);
        let inertia = (case.assessment.loads.steps - drag(case.mv)).max(0.0);
        Some(drag(mv) + inertia * libm::pow(share, power))
    }
}
