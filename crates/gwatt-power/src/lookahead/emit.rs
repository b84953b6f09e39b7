//! Moves that nothing can change any more, on their way out.

use super::Ahead;
use super::open::Open;
use super::queue::Leaving;
use crate::assessment::{Assessment, Certificate};
use crate::demand::{Demand, Want, larger};
use crate::duty_cycle::{Known, Span};
use crate::late::unpaced;
use crate::model::PowerModel;
use crate::observer::{Observer, span};
use crate::robust::{Extremes, Part};
use gwatt_machine::{AxisValues, Machine};
use gwatt_motion::{Corner, Move, SpeedSteps};
use gwatt_plan::{Overrides, SpeedBound, blended_bound, blended_speed};

impl Ahead {
    /// Passes on the moves that are finished, and whose neighbours are. All, when
    /// nothing moves after the last one.
    #[inline]
    pub fn emit(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        observer: &mut Observer,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        if let Some(begun) = self.glider.begun()
            && self.open.first() > begun
        {
            return self.emit_gliding(sink);
        }
        let finished = self.finished();
        loop {
            let first = self.open.first();
            let Some(front) = self.open.get(first) else {
                break;
            };
            if !front.moves {
                // Those that do not move are passed.
                observer.pass();
                sink(&front.mv, &front.assessment, &front.text);
                self.open.pass();
                self.still -= 1;
                continue;
            }
            if (first + 1 >= finished || self.waits_for_corners()) && !self.at_rest {
                return;
            }
            let moves = |number: &u64| self.open.get(*number).is_some_and(|open| open.moves);
            let next = (first + 1..self.open.end()).find(moves);
            let known = first < finished && next.map_or(self.at_rest, |next| next < finished);
            if !known {
                return;
            }
            let Some(Leaving { before, own, next }) = self.open.leaving(next) else {
                return;
            };
            let next = next.filter(|_| !own.rests);
            let before = before.filter(|before| !before.rests);
            let driven = self.driven && !own.steady;
            if driven {
                let doubtful = self.in_doubt || self.unwaited.is_some();
                own.drive_between(
                    [before, next],
                    doubtful,
                    (machine, model),
                    self.largest.overrides,
                );
            }
            let overrides = self.largest.overrides;
            own.include_deviations(machine, model, self.surges.is_some(), overrides);
            let certain =
                |adjacent: Option<&Open>| adjacent.is_none_or(|adjacent| adjacent.certain);
            // What no piece speaks of is not known.
            let planned = !own.assessment.ahead || own.assessment.top_speed_mm_s > 0.0;
            if planned && own.certain && certain(before) && certain(next) {
                own.observe(
                    [before, next],
                    driven,
                    (machine, model),
                    observer,
                    overrides,
                );
            } else {
                let overrides = self.largest.overrides;
                let unwaited = &mut self.unwaited;
                own.bound(
                    [before, next],
                    unwaited,
                    (machine, model),
                    observer,
                    overrides,
                );
                if !(next.is_none() && self.at_rest && self.in_doubt) {
                    self.unwaited = None;
                }
            }
            sink(&own.mv, &own.assessment, &own.text);
            self.open.leave();
        }
        if self.at_rest && !self.in_doubt {
            self.open.begin_at_rest();
            if let Some(surges) = &mut self.surges {
                surges.runs.clear();
            }
            self.unwaited = None;
            self.driven = false;
        }
    }

    /// The same over moves where the motion glides: all move, and all is certain.
    #[inline]
    fn emit_gliding(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        while self.open.first() + 1 < self.largest.next {
            let Some(front) = self.open.get(self.open.first()) else {
                break;
            };
            sink(&front.mv, &front.assessment, &front.text);
            self.open.leave();
        }
    }
}

impl Ahead {
    /// Whether other corners may be set yet for the first move that waits.
    #[inline]
    fn waits_for_corners(&self) -> bool {
        self.held_back > 0 && self.open.len() as u64 - self.still <= self.held_back
    }

    /// The number of the first move that is not finished in one of the plans.
    #[inline]
    fn finished(&self) -> u64 {
        let nominal = self.nominal.as_ref();
        let nominal = nominal.map_or(u64::MAX, |nominal| nominal.next);
        self.largest.next.min(nominal)
    }
}

impl Open {
    /// Shows a move that is certain to what watches the power over time.
    fn observe(
        &mut self,
        adjacent: [Option<&Self>; 2],
        driven: bool,
        (machine, model): (&Machine, &PowerModel),
        observer: &mut Observer,
        overrides: Overrides,
    ) {
        self.assessment.blended = !self.alone;
        if self.assessment.ahead && self.in_turn {
            observer.kept(model, &self.mv, &mut self.kept);
        } else if self.assessment.ahead {
            let span = if driven {
                span(machine, &self.mv, overrides)
            } else {
                Span::of(self.assessment.fastest_s)
            };
            self.watch(adjacent, span, (machine, model), observer, overrides);
        } else {
            observer.alone(machine, model, &self.mv, overrides);
        }
    }

    /// Looks at what the drives leave between the speeds at its ends; any, where they are in doubt.
    fn drive_between(
        &mut self,
        adjacent: [Option<&Self>; 2],
        doubtful: bool,
        (machine, model): (&Machine, &PowerModel),
        largest: Overrides,
    ) {
        let ends_mm_s = adjacent.map(|adjacent| match adjacent {
            _ if doubtful => f64::INFINITY,
            Some(adjacent) => blended_speed(machine, &unpaced(adjacent.at_most()), largest),
            None => 0.0,
        });
        self.drive(ends_mm_s, machine, model, largest);
    }

    /// Adds what the move draws where it does not run exactly as it is planned: in cruises
    /// between surges, at a lower pace, and off its path.
    fn include_deviations(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        surges: bool,
        overrides: Overrides,
    ) {
        if surges && let Some(cruises) = model.cruises(&self.mv, self.assessment.top_speed_mm_s) {
            self.assessment.demand.include(&cruises);
        }
        if self.mv.pace < 1.0 {
            let of_plan = [self.assessment.speed_mm_s, self.assessment.accel_mm_s2];
            if let Some(late) = model.late(machine, &self.mv, of_plan, overrides) {
                self.assessment.demand.include(&late);
            }
        }
        if self.mv.stray.strays() && self.assessment.ahead {
            let top_speed_mm_s = self.assessment.top_speed_mm_s;
            let demand = self.assessment.demand;
            self.assessment.demand = model.with_stray(demand, &self.mv, top_speed_mm_s);
        }
    }

    /// Gives it the robust bound, with those before and after it. `unwaited` stands in
    /// place of the one before, where that did not wait for it, and is then what this
    /// bound covers.
    fn bound(
        &mut self,
        adjacent: [Option<&Self>; 2],
        unwaited: &mut Option<Extremes>,
        (machine, model): (&Machine, &PowerModel),
        observer: &mut Observer,
        largest: Overrides,
    ) {
        let mut kept = std::mem::take(&mut self.kept);
        let bounds = self.bounds(adjacent, machine, largest);
        let accels = self.accels(adjacent, machine);
        let mut window = window(&bounds, &accels);
        if let Some(unwaited) = unwaited {
            window[0] = unwaited.part();
        }
        observer.blended((machine, model), &self.mv, &window, &mut kept, largest);
        let mut demand = model.robust_over(&self.mv, &window, self.want);
        let covered = Extremes::of(&window);
        // Chords of a small arc may ask for more than the axes' limits.
        demand.include(&self.assessment.demand);
        self.assessment.demand = Demand {
            energy_j: self.assessment.demand.energy_j,
            ..demand
        };
        self.assessment.certificate = Certificate::Robust;
        *unwaited = Some(covered);
    }

    /// Over time it counts with no more than its peaks, where these are known of the
    /// converter, for as long as it may last.
    #[cold]
    fn watch(
        &mut self,
        adjacent: [Option<&Self>; 2],
        span: Span,
        (machine, model): (&Machine, &PowerModel),
        observer: &mut Observer,
        largest: Overrides,
    ) {
        if observer.watch.is_none() {
            return;
        }
        let mut kept = std::mem::take(&mut self.kept);
        let bounds = self.bounds(adjacent, machine, largest);
        let accels = self.accels(adjacent, machine);
        let window = window(&bounds, &accels);
        let Demand {
            peak_w, regen_w, ..
        } = self.assessment.demand;
        let Want {
            floor_w,
            regen_floor_w,
            ..
        } = self.want;
        let most_w = [larger(peak_w, floor_w), larger(regen_w, regen_floor_w)];
        let known = Known {
            span,
            most_w: (model.converters.len() == 1).then_some(most_w),
        };
        observer.unknown(model, &self.mv, &window, &mut kept, known);
    }

    /// The speeds of the one before it, its own, and those of the one after it.
    fn bounds(
        &self,
        [before, next]: [Option<&Self>; 2],
        machine: &Machine,
        largest: Overrides,
    ) -> [SpeedBound; 3] {
        // A change of pace is part of what is not known.
        [before.unwrap_or(self), self, next.unwrap_or(self)]
            .map(|open| blended_bound(machine, &unpaced(open.at_most()), largest))
    }

    /// The accelerations of the same moves.
    fn accels(&self, [before, next]: [Option<&Self>; 2], machine: &Machine) -> [AxisValues; 3] {
        [before.unwrap_or(self), self, next.unwrap_or(self)].map(|open| open.axes_accel(machine))
    }

    /// The largest acceleration of each axis. Where limits may act early and joints are steps of
    /// speed, that of the path, and on top of it the steps that may fall within the response time, as
    /// their mean over it: no more than that of the axes, unless such limits leave it in doubt.
    fn axes_accel(&self, machine: &Machine) -> AxisValues {
        let mv = self.at_most();
        let mut accel_mm_s2 = mv.accel_mm_s2;
        let steps = match mv.corner {
            Corner::Steps(steps) => Some(steps),
            _ => SpeedSteps::of(machine),
        };
        let early = machine.controller.language.printer.early_limits;
        let in_doubt = self.step_mm_s.is_some();
        let follows = (in_doubt || early) && mv.unknown_start.is_empty();
        let Some(steps) = steps.filter(|_| follows) else {
            return accel_mm_s2;
        };
        let largest_mm_s = self.step_mm_s.unwrap_or(0.0);
        let response_s = machine.path.response_time_s;
        let chords = machine
            .controller
            .planner
            .look_ahead
            .and_then(|it| it.chords);
        let per_second = match (&mv.arc, chords) {
            (None, _) => mv.feed_mm_s / mv.length_mm,
            (_, Some(chords)) if chords.per_second > 0.0 => chords.per_second,
            _ => f64::INFINITY,
        };
        let joints = 1.0 + response_s * per_second;
        for (axis, step_mm_s) in SpeedSteps::AXES.into_iter().zip(steps.mm_s) {
            // An extruder may go further than the path is long. An F that is not known is infinite.
            let way_mm = (mv.end[axis as usize] - mv.start[axis as usize]).abs();
            let share = if way_mm > mv.length_mm {
                way_mm / mv.length_mm
            } else {
                1.0
            };
            let rapid_mm_s = machine.axes[axis as usize].map_or(0.0, |it| it.rapid_mm_s);
            let top_mm_s = (share * mv.feed_mm_s).min(rapid_mm_s * mv.rapid_factor.max(1.0));
            let step_mm_s = (joints * step_mm_s.max(largest_mm_s)).min(2.0 * top_mm_s);
            let own = &mut accel_mm_s2[axis as usize];
            let most = own.min(share * mv.path_accel_mm_s2) + step_mm_s / response_s;
            *own = if in_doubt { most } else { most.min(*own) };
        }
        accel_mm_s2
    }
}

/// The largest speeds and accelerations of three moves.
fn window<'a>(bounds: &'a [SpeedBound; 3], accels: &'a [AxisValues; 3]) -> [Part<'a>; 3] {
    std::array::from_fn(|index| Part {
        bound: &bounds[index],
        accel_mm_s2: &accels[index],
    })
}
