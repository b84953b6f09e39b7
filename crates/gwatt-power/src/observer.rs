//! What looks at the motion while moves are judged: the limits over time, and
//! who wants to see the motion itself.
//!
//! Input: plans and pieces of plans in the order of the program. Without anything
//! to look for it costs a branch a move.

use super::duty_cycle::{Buffered, DutyCycle, Known, Span, SpindleLoad};
use super::model::PowerModel;
use super::motion::Motion;
use super::parabolic_blend::Tandem;
use super::robust::Part;
use super::steps::StepEnergy;
use super::surge::Surge;
use gwatt_machine::Machine;
use gwatt_motion::Move;
use gwatt_plan::lookahead::Planned;
use gwatt_plan::{
    Overrides, PathFigures, Plan, SpeedBound, blended_bound, blended_speed, is_independent, plan,
};

/// See the module.
#[derive(Debug, Default)]
pub(super) struct Observer {
    pub watch: Option<Box<DutyCycle>>,
    /// The motion at 100 % that nobody has taken yet, where it is wanted.
    pub motions: Option<Vec<Motion>>,
}

impl Observer {
    /// Whether nothing is looked at.
    #[inline]
    pub fn is_closed(&self) -> bool {
        self.watch.is_none() && self.motions.is_none()
    }

    /// A move that runs from rest to rest, or rests.
    #[inline]
    pub fn alone(&mut self, machine: &Machine, model: &PowerModel, mv: &Move, largest: Overrides) {
        if self.watch.is_some() {
            let plan = plan(machine, mv, largest);
            self.watch_alone(machine, model, mv, largest, &plan);
        }
    }

    /// The same of a move whose figures are known, where it runs on one path.
    #[inline]
    pub fn alone_as(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        mv: &Move,
        largest: Overrides,
        figures: Option<&PathFigures>,
    ) {
        let Some(figures) = figures else {
            return self.alone(machine, model, mv, largest);
        };
        if self.watch.is_some() {
            let plan = figures.plan(mv.length_mm);
            self.watch_alone(machine, model, mv, largest, &plan);
        }
    }

    /// A move that takes no time.
    #[inline]
    pub fn pass(&mut self) {
        if let Some(watch) = &mut self.watch {
            watch.pass();
        }
    }

    /// What the spindle does during the moves passed on since, in their order.
    #[inline]
    pub fn spindle_loads(&mut self, model: &PowerModel, loads: &mut Option<Vec<SpindleLoad>>) {
        if let (Some(watch), Some(loads)) = (&mut self.watch, loads) {
            for load in loads.drain(..) {
                watch.spindle_load(model, &load);
            }
        }
    }

    /// The motion of a move that runs from rest to rest, or of which no more is
    /// known.
    #[inline]
    pub fn show(&mut self, machine: &Machine, mv: &Move, nominal: Overrides) {
        if let Some(motions) = &mut self.motions {
            let plan = plan(machine, mv, nominal);
            if plan.duration_s > 0.0 {
                motions.extend(Motion::of_plan(mv, &plan));
            }
        }
    }

    /// The motion of a piece of a plan at 100 %, which belongs to the move `mv`.
    #[inline]
    pub fn show_piece(&mut self, mv: &Move, planned: &Planned<u64>) {
        if let Some(motions) = &mut self.motions {
            motions.push(Motion::of_piece(mv, planned));
        }
    }

    /// The same of a blend, the second half of which belongs to the move `next`.
    #[inline]
    pub fn show_blend(&mut self, mv: &Move, next: &Move, planned: &Planned<u64>) {
        if let Some(motions) = &mut self.motions {
            motions.extend(Motion::of_piece(mv, planned).halves(next));
        }
    }

    #[cold]
    fn watch_alone(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        mv: &Move,
        largest: Overrides,
        plan: &Plan,
    ) {
        let Some(watch) = &mut self.watch else { return };
        if mv.unknown_start.is_empty() {
            watch.plan(model, mv, plan);
        } else {
            let bound = blended_bound(machine, mv, largest);
            let part = part(mv, &bound);
            let known = Known::lasting(Span::ANY);
            watch.unknown(model, mv, &[part], &mut Buffered::default(), known);
        }
    }

    /// A piece of a plan, which belongs to the move `mv`, and the step of speed with
    /// which it begins.
    #[inline]
    pub fn keep(
        &self,
        model: &PowerModel,
        mv: &Move,
        planned: &Planned<u64>,
        step: Option<&StepEnergy>,
        kept: &mut Buffered,
    ) {
        if let Some(watch) = &self.watch {
            watch.keep(model, mv, planned, step, kept);
        }
    }

    /// A piece that may be sped up or braked at lower overrides where it is not at the
    /// largest.
    #[cold]
    pub fn surge(
        &self,
        model: &PowerModel,
        mv: &Move,
        planned: &Planned<u64>,
        surge: &Surge,
        kept: &mut Buffered,
    ) {
        if let Some(watch) = &self.watch {
            watch.surge(model, mv, planned, surge, kept);
        }
    }

    /// Two moves that share some of their time, of which the pieces are kept.
    #[inline]
    pub fn together(
        &self,
        model: &PowerModel,
        mv: &Move,
        tandem: &Tandem,
        kept: [&mut Buffered; 2],
    ) {
        if let Some(watch) = &self.watch {
            watch.together(model, mv, tandem, kept);
        }
    }

    /// A move that runs as planned: its pieces.
    #[inline]
    pub fn kept(&mut self, model: &PowerModel, mv: &Move, kept: &mut Buffered) {
        if let Some(watch) = &mut self.watch {
            watch.kept(model, mv, kept);
        }
    }

    /// A move that may be blended in a way that is not known, with the largest speeds around.
    #[inline]
    pub fn blended(
        &mut self,
        (machine, model): (&Machine, &PowerModel),
        mv: &Move,
        parts: &[Part<'_>],
        kept: &mut Buffered,
        largest: Overrides,
    ) {
        if self.watch.is_some() {
            let known = Known::lasting(span(machine, mv, largest));
            self.unknown(model, mv, parts, kept, known);
        }
    }

    /// A move that does not run in turn, with the largest speeds around and what else is
    /// known of it.
    pub fn unknown(
        &mut self,
        model: &PowerModel,
        mv: &Move,
        parts: &[Part<'_>],
        kept: &mut Buffered,
        known: Known,
    ) {
        if let Some(watch) = &mut self.watch {
            watch.unknown(model, mv, parts, kept, known);
        }
    }
}

/// For how long a move may last: no longer than with a stop at both ends, and no shorter
/// than at full speed.
pub(super) fn span(machine: &Machine, mv: &Move, largest: Overrides) -> Span {
    let mut span = Span::ANY;
    if mv.unknown_start.is_empty() && !mv.stray.is_far() {
        span.longest_s = plan(machine, mv, largest).duration_s;
        let shortest_s = mv.length_mm / blended_speed(machine, mv, largest);
        if shortest_s < span.longest_s && !is_independent(machine, mv) {
            span.shortest_s = shortest_s;
        }
    }
    span
}

/// The largest speeds and accelerations of a move.
fn part<'a>(mv: &'a Move, bound: &'a SpeedBound) -> Part<'a> {
    Part {
        bound,
        accel_mm_s2: &mv.accel_mm_s2,
    }
}
