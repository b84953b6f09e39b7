//! Steps of speed at the joints between planned pieces, counted for the moves there.

use super::Ahead;
use super::queue::Queue;
use crate::interpret::Move;
use crate::machine::{AXES, AxisValues, CornerRule, LookAhead, Machine};
use crate::plan::lookahead::{Piece, Planned};
use crate::power::demand::Demand;
use crate::power::model::PowerModel;
use crate::power::steps::{Heading, Span, StepEnergy, Steps, spans, velocity};
use crate::power::surge::Surge;

/// Chords that last for less than this share of the response time at the largest
/// overrides: at lower ones, where they last for all of it, what two steps ask for in that
/// time, 2·m·v³/r, is less than what the curve asks for at the largest, since 2·x³ < 1.
const SHORT: f64 = 0.79;

/// The means over the drives' response time, where the rules know steps of speed.
pub(super) fn steps_of(machine: &Machine, rules: &LookAhead) -> Option<Box<Steps>> {
    // LinuxCNC takes the acceleration for a kink from that along the path.
    let stepped = !matches!(rules.corner, CornerRule::LinuxCnc { .. });
    let response_s = machine.path.response_time_s;
    let lower = machine.limits.override_at.is_none();
    stepped.then(|| Box::new(Steps::new(machine.axis_set, response_s, lower)))
}

impl Ahead {
    /// Follows a planned piece of a move's own path, at the largest overrides.
    #[inline]
    pub(super) fn follow(&mut self, model: &PowerModel, number: u64, planned: &Planned<u64>) {
        self.follow_piece(model, number, planned);
        let (Some(steps), Some(own)) = (&mut self.steps, self.open.get_mut(number)) else {
            return;
        };
        if own.in_doubt || self.reach2.is_some() {
            steps.doubt();
        } else if steps.has_doubtful_steps() {
            // Means reach back to where it may have stopped.
            own.certain = false;
        }
    }

    #[inline]
    fn follow_piece(&mut self, model: &PowerModel, number: u64, planned: &Planned<u64>) {
        let Some(steps) = self.steps.as_deref_mut() else {
            return;
        };
        let Piece::Along { from_mm, to_mm } = planned.piece else {
            return steps.begin();
        };
        let Some(own) = self.open.get(number) else {
            return;
        };
        let speeds2 = planned.speeds2;
        if own.mv.arc.is_none() && speeds2.start == speeds2.top && speeds2.end == speeds2.top {
            let speed_mm_s = speeds2.top.sqrt();
            let duration_s = planned.length_mm / speed_mm_s;
            return glide_over(
                steps,
                &mut self.open,
                model,
                number,
                [duration_s, speed_mm_s],
            );
        }
        let (mut heading, is_arc) = (Heading::of(&own.mv), own.mv.arc.is_some());
        if is_arc && self.largest.planner.runs_chords() {
            heading = heading.of_chord([from_mm, to_mm]);
        }
        let profile = planned.profile();
        // The power of an arc is that of the mean over its chords, where these are
        // shorter than the drives' response, at lower overrides too if those count.
        let chord = is_arc && from_mm > 0.0;
        let least = if self.surges.is_some() { SHORT } else { 1.0 };
        let mut joint = !chord || planned.duration_s() > least * steps.response_s();
        for phase in &profile.phases {
            let mut phase = *phase;
            phase.position_mm += from_mm;
            spans(&heading, &phase, joint, &mut |span| {
                take(steps, &mut self.open, model, number, span);
            });
            joint = false;
        }
    }

    /// The last piece that was followed may be sped up or braked at lower overrides:
    /// that comes on top of steps of speed next to it.
    pub(super) fn follow_surge(&mut self, model: &PowerModel, number: u64, surge: &Surge) {
        let Some(steps) = self.steps.as_deref_mut() else {
            return;
        };
        let Some(own) = self.open.get(number) else {
            return;
        };
        let sides = [surge.rises_mm_s, surge.falls_mm_s].map(|it| it.is_some());
        steps.surge(&Heading::of(&own.mv).extremes(), sides, surge.accel_mm_s2);
        if steps.is_surged() && !steps.is_quiet(model, &own.mv, own.want) {
            let demand = steps.surged_demand(model, &own.mv);
            include(&mut self.open, number, &demand);
        }
    }

    /// The axes rest after the last move: what they do until then is followed by rest.
    pub(super) fn follow_rest(&mut self, model: &PowerModel) {
        let Some(steps) = self.steps.as_deref_mut() else {
            return;
        };
        let moves = |number: &u64| self.open.get(*number).is_some_and(|open| open.moves);
        let last = (self.open.first()..self.open.end()).rev().find(moves);
        if let Some(last) = last {
            let rest = Span {
                duration_s: steps.response_s(),
                direction: [0.0; AXES],
                speeds_mm_s: [0.0; 2],
                joint: true,
            };
            take(steps, &mut self.open, model, last, &rest);
        }
        steps.begin();
    }
}

/// Follows a line at one speed, for `[s, mm/s]`.
#[inline]
pub(super) fn glide_over(
    steps: &mut Steps,
    open: &mut Queue,
    model: &PowerModel,
    number: u64,
    [duration_s, speed_mm_s]: [f64; 2],
) {
    let Some(own) = open.get(number) else { return };
    let direction = Heading::of(&own.mv).at(0.0);
    let span = Span {
        duration_s,
        direction,
        speeds_mm_s: [speed_mm_s; 2],
        joint: true,
    };
    take(steps, open, model, number, &span);
}

/// Follows a span of a move; what steps ask for there counts for it and for the one
/// before.
#[inline]
fn take(steps: &mut Steps, open: &mut Queue, model: &PowerModel, number: u64, span: &Span) {
    if !steps.push(span) {
        return;
    }
    let Some(own) = open.get(number) else { return };
    if steps.is_quiet(model, &own.mv, own.want) {
        return;
    }
    let mut demand = steps.demand(model, &own.mv);
    if steps.is_surged() {
        demand.include(&steps.surged_demand(model, &own.mv));
    }
    include(open, number, &demand);
}

#[cold]
fn include(open: &mut Queue, number: u64, demand: &Demand) {
    let before = (open.first()..number).rev();
    let before = before
        .take(8)
        .find(|it| open.get(*it).is_some_and(|it| it.moves));
    for number in before.into_iter().chain([number]) {
        if let Some(open) = open.get_mut(number) {
            open.assessment.demand.include(demand);
            let loads = &mut open.assessment.loads;
            loads.steps = loads.steps.max(demand.load_ratio);
        }
    }
}

/// The step of speed before a piece on the path of a move, where the last one ended
/// with the speeds `before`; and the speeds with which it ends. Within an arc there is none:
/// what its chords take is in the power of the arc.
pub(super) fn step_before(
    mv: &Move,
    planned: &Planned<u64>,
    before: &AxisValues,
    response_s: f64,
) -> (StepEnergy, AxisValues) {
    let [from_mm, to_mm] = match planned.piece {
        Piece::Along { from_mm, to_mm } => [from_mm, to_mm],
        Piece::Joined { .. } | Piece::Blend(_) => [0.0; 2],
    };
    let heading = Heading::of(mv);
    let [first, last] = [from_mm, to_mm].map(|at_mm| heading.at(at_mm));
    let after = velocity(&first, planned.speeds2.start.sqrt());
    let step = StepEnergy {
        speeds_mm_s: [*before, after],
        response_s,
    };
    (step, velocity(&last, planned.speeds2.end.sqrt()))
}
