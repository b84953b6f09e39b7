//! Steps of speed at the joints between planned pieces, counted for the moves there.

use super::Ahead;
use super::queue::Queue;
use crate::demand::Demand;
use crate::model::PowerModel;
use crate::steps::{Beyond, Heading, Span, StepEnergy, Steps, close_spans, spans, velocity};
use crate::surge::Surge;
use gwatt_machine::{AXES, AxisValues};
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned};
use std::ops::RangeInclusive;

/// The moves that a piece belongs to.
pub(super) fn moves_of(planned: &Planned<u64>) -> RangeInclusive<u64> {
    planned.first..=planned.next.unwrap_or(planned.tag)
}

impl Ahead {
    /// Follows a planned piece, at the largest overrides.
    #[inline]
    pub(super) fn follow(&mut self, model: &PowerModel, planned: &Planned<u64>) {
        self.follow_piece(model, planned);
        if planned.slack.begins2 > 0.0 && self.surges.is_some() {
            self.follow_own_start(model, planned);
        }
        let moves = moves_of(planned);
        let in_doubt = |number| self.open.get(number).is_some_and(|own| own.in_doubt);
        if self.reach2.is_some() || moves.clone().any(in_doubt) {
            self.steps.doubt();
        } else if self.steps.has_doubtful_steps() {
            // Means reach back to where it may have stopped.
            for number in moves {
                if let Some(own) = self.open.get_mut(number) {
                    own.certain = false;
                }
            }
        }
    }

    #[inline]
    fn follow_piece(&mut self, model: &PowerModel, planned: &Planned<u64>) {
        let steps = &mut *self.steps;
        let number = planned.tag;
        let Some(own) = self.open.get(number) else {
            return;
        };
        if steps.turns() {
            return follow_turns(steps, &mut self.open, model, planned);
        }
        let Piece::Along { from_mm, to_mm } = planned.piece else {
            return steps.begin();
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
        let mut beyond = (self.surges.as_ref()).map_or(Beyond::NONE, |it| it.beyond(planned));
        let profile = planned.profile();
        let mut joint = true;
        for phase in &profile.phases {
            let mut phase = *phase;
            phase.position_mm += from_mm;
            spans(&heading, &phase, joint, beyond, &mut |span| {
                take(steps, &mut self.open, model, number..=number, span);
            });
            (joint, beyond.joint) = (false, 1.0);
        }
    }

    /// A piece that begins at a speed of its own: at the lowest override what is before it
    /// has none. With the speed before, `v` of which it is a share, and `w` of the piece a mean
    /// asks for no more than one of both ends, as `(v·w)² ≤ v²·w²` over the masses.
    #[cold]
    fn follow_own_start(&mut self, model: &PowerModel, planned: &Planned<u64>) {
        let Some(own) = self.open.get(planned.tag) else {
            return;
        };
        let from_mm = match planned.piece {
            Piece::Along { from_mm, .. } => from_mm,
            Piece::Joined { .. } | Piece::Blend(_) => 0.0,
        };
        let direction = Heading::of_piece(&own.mv, &planned.piece).at(from_mm);
        let mut steps = self.steps.at_rest();
        let speeds = [planned.slack.begins2.sqrt(); 2];
        let span = Span::straight(steps.response_s(), &direction, speeds, true);
        take(&mut steps, &mut self.open, model, moves_of(planned), &span);
    }

    /// The last piece that was followed may be sped up or braked at lower overrides:
    /// that comes on top of steps of speed next to it.
    pub(super) fn follow_surge(
        &mut self,
        model: &PowerModel,
        planned: &Planned<u64>,
        surge: &Surge,
    ) {
        let steps = &mut *self.steps;
        let Some(own) = self.open.get(planned.tag) else {
            return;
        };
        let sides = [surge.rises_mm_s, surge.falls_mm_s].map(|it| it.is_some());
        let extremes = Heading::of_piece(&own.mv, &planned.piece).extremes();
        // Of an S-curve no more is known than how fast it may be.
        let speed_mm_s = surge.section.map_or(0.0, |_| surge.speed_mm_s());
        steps.surge(&extremes, sides, surge.accel_mm_s2, speed_mm_s);
        if steps.is_surged() && !steps.is_quiet(model, &own.mv, own.want) {
            let demand = steps.surged_demand(model, &own.mv);
            include(&mut self.open, moves_of(planned), &demand);
        }
    }

    /// The axes rest after the last move: what they do until then is followed by rest.
    pub(super) fn follow_rest(&mut self, model: &PowerModel) {
        let steps = &mut *self.steps;
        let moves = |number: &u64| self.open.get(*number).is_some_and(|open| open.moves);
        let last = (self.open.first()..self.open.end()).rev().find(moves);
        if let Some(last) = last {
            let rest = Span::straight(steps.response_s(), &[0.0; AXES], [0.0; 2], true);
            take(steps, &mut self.open, model, last..=last, &rest);
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
    let span = Span::straight(duration_s, &direction, [speed_mm_s; 2], true);
    take(steps, open, model, number..=number, &span);
}

/// Follows a piece closely where it turns.
fn follow_turns(steps: &mut Steps, open: &mut Queue, model: &PowerModel, planned: &Planned<u64>) {
    let Some(own) = open.get(planned.tag) else {
        return;
    };
    let heading = Heading::of_piece(&own.mv, &planned.piece);
    let from_mm = match planned.piece {
        Piece::Along { from_mm, .. } => from_mm,
        Piece::Joined { .. } | Piece::Blend(_) => 0.0,
    };
    let terms = [steps.response_s(), planned.accel_mm_s2];
    let mut joint = true;
    for phase in &planned.profile().phases {
        let mut phase = *phase;
        phase.position_mm += from_mm;
        close_spans(&heading, &phase, joint, terms, &mut |span| {
            take(steps, open, model, moves_of(planned), span);
        });
        joint = false;
    }
}

/// Follows a span of a piece; what steps ask for there counts for its moves and for the
/// one before.
#[inline]
fn take(
    steps: &mut Steps,
    open: &mut Queue,
    model: &PowerModel,
    moves: RangeInclusive<u64>,
    span: &Span,
) {
    if !steps.push(span) {
        return;
    }
    let Some(own) = open.get(*moves.start()) else {
        return;
    };
    if steps.is_quiet(model, &own.mv, own.want) {
        return;
    }
    let mut demand = steps.demand(model, &own.mv, own.want);
    if steps.is_surged() {
        demand.include(&steps.surged_demand(model, &own.mv));
    }
    include(open, moves, &demand);
}

#[cold]
fn include(open: &mut Queue, moves: RangeInclusive<u64>, demand: &Demand) {
    let before = (open.first()..*moves.start()).rev();
    let before = before
        .take(8)
        .find(|it| open.get(*it).is_some_and(|it| it.moves));
    for number in before.into_iter().chain(moves) {
        if let Some(open) = open.get_mut(number) {
            open.assessment.demand.include(demand);
            let loads = &mut open.assessment.loads;
            loads.steps = loads.steps.max(demand.load_ratio);
        }
    }
}

/// The step of speed before a piece, where the last one ended
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
        Piece::Joined { .. } | Piece::Blend(_) => [0.0, planned.length_mm],
    };
    let heading = Heading::of_piece(mv, &planned.piece);
    let [first, last] = [from_mm, to_mm].map(|at_mm| heading.at(at_mm));
    let after = velocity(&first, planned.speeds2.start.sqrt());
    let step = StepEnergy {
        speeds_mm_s: [*before, after],
        response_s,
    };
    (step, velocity(&last, planned.speeds2.end.sqrt()))
}
