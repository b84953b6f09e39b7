//! Blocks in several pieces of one line, each with an acceleration of its own.
//!
//! Under a limit of power a line is run soonest with all force up to the speed at which
//! the power reaches the limit, and from there on with the acceleration that the limit
//! leaves. One acceleration for the block cannot do that; stepped ones come near it. The
//! pieces run on into each other at one F, so that the controller's own planner drives
//! them as designed here: an acceleration of each holds in it for speeding up and for
//! braking, and the way is divided so that it has no other choice.

use super::change::{Change, Permit};
use super::lever::{Levers, levers};
use super::solver::{Case, Ends, Solver};
use super::stages::{Stages, Terms, stages};
use super::steps;
use crate::interpret::{Move, MoveKind};
use crate::machine::{AxisValues, PathMode};
use crate::plan::lookahead::Speeds2;
use crate::plan::{Phase, PhaseKind, Plan, Profile, Trajectory, is_independent, plan};
use crate::power::{Assessment, Certificate, Want};

/// The load that pieces are designed for, and the one that they must keep as they will be
/// written: places are rounded.
const AIM: f64 = 1.0 - 4e-5;
const MOST: f64 = 1.0 - 1e-5;
/// Halvings in the search for an acceleration and for the top speed.
const HALVINGS: u32 = 40;
/// Speeds at which the largest accelerations are looked up.
const GRID: usize = 48;
/// The shortest piece, mm: many times what places are rounded by.
const SHORTEST_MM: f64 = 0.1;
/// What a piece more must bring in, as a share of the time, and what all of them must.
const PRICE: f64 = 1e-4;
const GAIN: f64 = 1e-3;
/// By what share of its path a brake begins earlier than it must. On its stretch more than
/// the limit may be had for speeding up: a control that comes there a little late and slow
/// must not find room for that.
const EARLIER: f64 = 0.01;
/// Accelerations that are tried for the last stages.
const TRIES: u32 = 60;

/// Why a block stays one.
const NO_LOOK_AHEAD: &str = "its pieces would not run on into each other as planned";
const UNLIKE: &str = "an axis limits its jerk, has a curve of force, or runs for itself";
const NO_FIT: &str = "friction, or the steps of speed at its ends, leave no acceleration";
const SHORT: &str = "its pieces would be shorter than the control can use";
const NOT_SOONER: &str = "one acceleration is as good";
const BESIDE: &str = "beside its neighbours the pieces would exceed the limit";

/// A block in several pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// In their order, at least two.
    pub pieces: Vec<Piece>,
}

/// A piece of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The share of the way at which it ends.
    pub share: f64,
    /// The knob for acceleration, and its value for each axis; `None`: what is in force.
    pub accel: Option<(usize, AxisValues)>,
}

/// An acceleration that the knob can say, mm/s², with its value.
#[derive(Debug, Clone, Copy)]
struct Step {
    accel_mm_s2: f64,
    value: Option<(usize, AxisValues)>,
}

/// A stretch of the way with one acceleration.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    length_mm: f64,
    step: Step,
}

/// The line, and what holds on it.
struct Road<'a> {
    solver: &'a Solver<'a>,
    case: Case<'a>,
    knob: usize,
    /// Speeds at its ends and its largest, mm/s.
    ends_mm_s: [f64; 2],
    top_mm_s: f64,
    /// Acceleration along the path that is in force, and what the axes alone permit.
    accel_mm_s2: f64,
    axes_accel_mm_s2: f64,
}

impl Solver<'_> {
    /// The pieces in which a block fits and is done sooner than with the change
    /// `otherwise`.
    ///
    /// # Errors
    /// Why it stays one block.
    pub(super) fn pieces(
        &self,
        mv: &Move,
        assessment: &Assessment,
        permit: &Permit,
        ends: Ends,
        otherwise: Option<&Change>,
    ) -> Result<Split, &'static str> {
        if let Some(reason) = permit.unsplit {
            return Err(reason);
        }
        let case = Case {
            mv,
            assessment,
            permit,
            ends,
            exact_stop: false,
        };
        if ends > Ends::Any(0) {
            return Err(BESIDE);
        }
        let road = self.road(case, levers(self.machine, self.how, mv, permit))?;
        let stretches = road.stretches()?;
        let soonest_s = road.duration_s(&stretches).ok_or(NO_FIT)?;
        let whole_s = otherwise.map_or(f64::INFINITY, |change| road.whole_s(change));
        if stretches.len() < 2 || soonest_s >= whole_s * (1.0 - GAIN) {
            return Err(NOT_SOONER);
        }
        let mut at_mm = 0.0;
        let count = stretches.len();
        let pieces = stretches.iter().enumerate().map(|(index, stretch)| {
            at_mm += stretch.length_mm;
            let last = index + 1 == count;
            Piece {
                share: if last { 1.0 } else { at_mm / case.mv.length_mm },
                accel: stretch.step.value,
            }
        });
        Ok(Split {
            pieces: pieces.collect(),
        })
    }

    fn road<'a>(&'a self, case: Case<'a>, levers: Levers) -> Result<Road<'a>, &'static str> {
        let Case { mv, assessment, .. } = case;
        let controller = &self.machine.controller;
        let straight = matches!(mv.kind, MoveKind::Rapid | MoveKind::Feed) && mv.arc.is_none();
        let acts = |index: &usize| {
            let knob = controller.knobs.get(*index);
            knob.is_some_and(|knob| knob.between_moves)
        };
        let knob = levers.accel.filter(acts).filter(|_| straight);
        let rules = controller.planner.look_ahead;
        let flows = mv.path_mode == PathMode::LookAhead
            && assessment.certificate == Certificate::Planned
            && assessment.ends2.iter().all(|end2| end2.is_finite())
            && match rules {
                Some(rules) => assessment.ahead && rules.min_cruise_ratio == 0.0,
                // Between two stops, since nothing is known of corners.
                None => !assessment.blended && assessment.ends2 == [0.0; 2],
            };
        let Some(knob) = knob.filter(|_| flows && mv.unknown_start.is_empty()) else {
            return Err(NO_LOOK_AHEAD);
        };
        let jerk = |axis: usize| {
            let data = self.machine.axes[axis].as_ref();
            data.is_some_and(|axis| axis.jerk_mm_s3 > 0.0 && axis.jerk_mm_s3.is_finite())
        };
        let unlike = !self.machine.force_curves.is_empty()
            || mv.moving.iter().any(jerk)
            || is_independent(self.machine, mv);
        if unlike {
            return Err(UNLIKE);
        }
        if steps::load(self, case, mv).is_some() || assessment.loads.steps > MOST {
            return Err(NO_FIT);
        }
        let planned = plan(self.machine, mv, self.largest);
        let axes_accel_mm_s2 = mv.moving.iter().map(|axis| {
            let change = (mv.end[axis] - mv.start[axis]).abs();
            mv.accel_mm_s2[axis] * mv.length_mm / change
        });
        Ok(Road {
            solver: self,
            case,
            knob,
            ends_mm_s: assessment.ends2.map(f64::sqrt),
            top_mm_s: planned.speed_limit_mm_s,
            accel_mm_s2: planned.accel_mm_s2,
            axes_accel_mm_s2: axes_accel_mm_s2.fold(f64::INFINITY, f64::min),
        })
    }
}

impl Road<'_> {
    /// The load ratio of a profile.
    fn load(&self, profile: Profile) -> f64 {
        let top_speed_mm_s = profile.top_speed_mm_s();
        let plan = Plan {
            duration_s: profile.duration_s(),
            trajectory: Trajectory::Path(profile),
            speed_limit_mm_s: top_speed_mm_s,
            accel_mm_s2: self.accel_mm_s2,
            top_speed_mm_s,
        };
        let model = &self.solver.model;
        let demand = model.demand(self.case.mv, &plan, Want::PEAKS);
        let demand = model.with_cruises(demand, self.case.mv, top_speed_mm_s);
        let share = &self.case.assessment.spindle;
        model.load_beside(&demand, share, top_speed_mm_s)
    }

    /// The load of a ramp between two speeds.
    fn ramp_load(&self, from_mm_s: f64, to_mm_s: f64, accel_mm_s2: f64) -> f64 {
        let mut profile = Profile::default();
        profile.phases.push(Phase {
            kind: PhaseKind::ConstantAcceleration,
            duration_s: (to_mm_s - from_mm_s).abs() / accel_mm_s2,
            position_mm: 0.0,
            velocity_mm_s: from_mm_s,
            end_velocity_mm_s: to_mm_s,
            accel_mm_s2: accel_mm_s2.copysign(to_mm_s - from_mm_s),
        });
        self.load(profile)
    }

    /// The largest acceleration with which a ramp between rest and a speed fits; `None`
    /// where hardly any does.
    fn largest_mm_s2(&self, top_mm_s: f64, brakes: bool) -> Option<f64> {
        let load = |accel: f64| match brakes {
            true => self.ramp_load(top_mm_s, 0.0, accel),
            false => self.ramp_load(0.0, top_mm_s, accel),
        };
        if load(self.accel_mm_s2) <= AIM {
            return Some(self.accel_mm_s2);
        }
        let (mut low, mut high) = (1e-4 * self.accel_mm_s2, self.accel_mm_s2);
        if !(load(low) <= AIM) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if load(middle) <= AIM {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(low)
    }

    /// An acceleration as the knob says it, rounded down.
    fn step(&self, accel_mm_s2: f64) -> Option<Step> {
        if accel_mm_s2 >= self.accel_mm_s2 {
            return Some(Step {
                accel_mm_s2: self.accel_mm_s2,
                value: None,
            });
        }
        let factor = accel_mm_s2 / self.axes_accel_mm_s2;
        let change = self
            .solver
            .accel_change(self.case, self.knob, factor, &Change::NONE)?;
        let (mv, permit) = (self.case.mv, self.case.permit);
        let moved = change.apply(self.solver.machine, mv, permit);
        let planned = plan(self.solver.machine, &moved, self.solver.largest);
        Some(Step {
            accel_mm_s2: planned.accel_mm_s2,
            value: change.accel,
        })
    }

    /// The way in stretches, each with its acceleration.
    fn stretches(&self) -> Result<Vec<Stretch>, &'static str> {
        let grid = |index: usize| self.top_mm_s * index as f64 / GRID as f64;
        let mut tables = [Vec::with_capacity(GRID), Vec::with_capacity(GRID)];
        for (table, brakes) in tables.iter_mut().zip([false, true]) {
            for index in 1..=GRID {
                match self.largest_mm_s2(grid(index), brakes) {
                    Some(accel) => table.push(accel),
                    None => break,
                }
            }
        }
        let known = tables.iter().map(Vec::len).min().unwrap_or(0);
        let reach_mm_s = grid(known);
        let [start_mm_s, end_mm_s] = self.ends_mm_s;
        let least_mm_s = start_mm_s.max(end_mm_s);
        if reach_mm_s <= least_mm_s {
            return Err(NO_FIT);
        }
        let look_up = |table: &[f64], speed_mm_s: f64| {
            let place = speed_mm_s / self.top_mm_s * GRID as f64 - 1.0;
            let low = (place.max(0.0) as usize).min(known - 1);
            let high = (low + 1).min(known - 1);
            let share = (place - low as f64).clamp(0.0, 1.0);
            table[low] + share * (table[high] - table[low])
        };
        let terms = Terms {
            shortest_s: 1.02 * self.solver.machine.controller.planner.shortest_block_s,
            shortest_mm: SHORTEST_MM,
            price_s: PRICE * (self.case.mv.length_mm / self.top_mm_s),
        };
        let [up, down] = &tables;
        let ramps = |top_mm_s: f64| {
            let up = stages(start_mm_s, top_mm_s, |v| look_up(up, v), terms)?;
            let down = stages(end_mm_s, top_mm_s, |v| look_up(down, v), terms)?;
            Some([up, down])
        };
        let length_mm = self.case.mv.length_mm;
        let has_room = |[up, down]: &[Stages; 2]| up.length_mm + down.length_mm <= length_mm;
        let mut found = ramps(reach_mm_s);
        if found.as_ref().is_some_and(has_room) {
            if reach_mm_s < self.top_mm_s {
                return Err(NO_FIT);
            }
        } else {
            found = None;
            let (mut low, mut high) = (least_mm_s, reach_mm_s);
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(low, high);
                match ramps(middle) {
                    Some(ramps) if has_room(&ramps) => (low, found) = (middle, Some(ramps)),
                    // Ramps to lower speeds have shorter stages.
                    None => low = middle,
                    Some(_) => high = middle,
                }
            }
        }
        let [up, down] = found.ok_or(SHORT)?;
        self.close(&up.tops_mm_s, &down.tops_mm_s)
    }

    /// Stretches for the stages, of which the last before the top and the first behind it
    /// meet at the speed that the way leaves.
    fn close(&self, up: &[f64], down: &[f64]) -> Result<Vec<Stretch>, &'static str> {
        let [start_mm_s, end_mm_s] = self.ends_mm_s;
        let side = |tops: &[f64], from_mm_s: f64, brakes: bool| {
            let (top, lower) = tops.split_last()?;
            let mut stretches = Vec::with_capacity(tops.len() + 1);
            let mut low = from_mm_s;
            for top in lower {
                let step = self.step(self.largest_mm_s2(*top, brakes)?)?;
                stretches.push(Stretch {
                    length_mm: 0.5 * (top * top - low * low) / step.accel_mm_s2,
                    step,
                });
                low = *top;
            }
            let step = self.step(self.largest_mm_s2(*top, brakes)?)?;
            Some((stretches, low, step))
        };
        let mut first = side(up, start_mm_s, false).ok_or(SHORT)?;
        let mut last = side(down, end_mm_s, true).ok_or(SHORT)?;
        let gone = |stretches: &[Stretch]| stretches.iter().map(|it| it.length_mm).sum::<f64>();
        let left_mm = self.case.mv.length_mm - gone(&first.0) - gone(&last.0);
        for _ in 0..TRIES {
            let (low, rise) = (first.1, first.2);
            let (foot, fall) = (last.1, last.2);
            let (a, d) = (rise.accel_mm_s2, fall.accel_mm_s2);
            // The stretch before the brakes has to slow down for the last hundredth of
            // v² − foot²: 2·a·l = 2·v² − low² − (foot² + kept·(v² − foot²)) with
            // l = left − kept·(v² − foot²)/2d.
            let kept = 1.0 - EARLIER;
            let foot2 = foot * foot;
            let top2 = (low * low + 2.0 * a * left_mm + (EARLIER + kept * a / d) * foot2)
                / (1.0 + EARLIER + kept * a / d);
            let top = top2.max(0.0).sqrt().min(self.top_mm_s);
            if !(top > low && top > foot) {
                return Err(SHORT);
            }
            let braking_mm = 0.5 * kept * (top * top - foot2) / d;
            if self.ramp_load(low, top, a) > AIM {
                first.2 = self.lower(rise).ok_or(NO_FIT)?;
            } else if self.ramp_load(top, foot, d) > AIM {
                last.2 = self.lower(fall).ok_or(NO_FIT)?;
            } else {
                let mut stretches = first.0;
                stretches.push(Stretch {
                    length_mm: left_mm - braking_mm,
                    step: rise,
                });
                stretches.push(Stretch {
                    length_mm: braking_mm,
                    step: fall,
                });
                stretches.extend(last.0.into_iter().rev());
                return Ok(stretches);
            }
        }
        Err(NO_FIT)
    }

    /// The next lower acceleration that the knob can say.
    fn lower(&self, step: Step) -> Option<Step> {
        let lower = self.step(step.accel_mm_s2 * (1.0 - 1e-6))?;
        (lower.accel_mm_s2 < step.accel_mm_s2).then_some(lower)
    }

    /// How long the way lasts in these stretches, as a planner runs them; `None` where one
    /// of them is too short, or draws too much.
    fn duration_s(&self, stretches: &[Stretch]) -> Option<f64> {
        let top2 = self.top_mm_s * self.top_mm_s;
        let [start2, end2] = self.ends_mm_s.map(|end| end * end);
        let mut joints = vec![start2];
        for stretch in stretches {
            let before = joints.last().copied()?;
            joints.push((before + stretch.gain2()).min(top2));
        }
        let last = joints.last_mut()?;
        *last = last.min(end2);
        for index in (0..stretches.len()).rev() {
            let most = joints.get(index + 1)? + stretches.get(index)?.gain2();
            let joint = joints.get_mut(index)?;
            *joint = joint.min(most);
        }
        let mut duration_s = 0.0;
        for (stretch, joint) in stretches.iter().zip(joints.windows(2)) {
            let [start, end] = *joint else { return None };
            let speeds2 = Speeds2 {
                start,
                end,
                top: top2,
            };
            let profile = Profile::between(stretch.length_mm, speeds2, stretch.step.accel_mm_s2);
            let lasts_s = profile.duration_s();
            let shortest_s = self.solver.machine.controller.planner.shortest_block_s;
            let usable = lasts_s >= shortest_s && stretch.length_mm >= SHORTEST_MM;
            if !usable || self.load(profile) > MOST {
                return None;
            }
            duration_s += lasts_s;
        }
        Some(duration_s)
    }

    /// How long the way lasts in one piece with a change.
    fn whole_s(&self, change: &Change) -> f64 {
        let (machine, largest) = (self.solver.machine, self.solver.largest);
        let changed: Move = change.apply(machine, self.case.mv, self.case.permit);
        let planned = plan(machine, &changed, largest);
        let top2 = planned.speed_limit_mm_s * planned.speed_limit_mm_s;
        let [start, end] = self.ends_mm_s.map(|end| (end * end).min(top2));
        let speeds2 = Speeds2 {
            start,
            end,
            top: top2,
        };
        Profile::between(changed.length_mm, speeds2, planned.accel_mm_s2).duration_s()
    }
}

impl Stretch {
    /// By how much the square of the speed may change in it, mm²/s².
    fn gain2(&self) -> f64 {
        2.0 * self.step.accel_mm_s2 * self.length_mm
    }
}
