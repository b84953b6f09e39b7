//! The way of a block in stretches: where they end, and their accelerations.
//!
//! Input: a straight move, the speeds at its ends, and the knob. Output: stretches that
//! fit, begun and ended as the move is. Stages up and stages down (`stages`) meet at the
//! speed that the length of the way leaves, or with a cruise between them.

use super::along::straight_accel_mm_s2;
use super::case::Case;
use super::change::Change;
use super::solver::Solver;
use super::stages::{Stages, Terms, stages};
use crate::interpret::Move;
use crate::machine::AxisValues;
use crate::plan::lookahead::Speeds2;
use crate::plan::{Phase, PhaseKind, Plan, Profile, Trajectory, plan};
use crate::power::Want;

/// The load that stretches are designed for, and the one that they must keep as they will
/// be written: places are rounded.
const AIM: f64 = 1.0 - 4e-5;
pub(super) const MOST: f64 = 1.0 - 1e-5;
/// What the drives' response takes where it is modelled, as a share of the limit.
const RESPONSE: f64 = 4e-4;
/// How much longer stretches are, and for how much less of the limit, where finer ones did
/// not fit next to the block's neighbours.
const LONGER: f64 = 3.0;
const LESS: f64 = 5e-3;
/// Halvings in the search for an acceleration and for the top speed.
const HALVINGS: u32 = 40;
/// Speeds at which the largest accelerations are looked up.
const GRID: usize = 96;
/// The shortest stretch, mm: many times what places are rounded by.
pub(super) const SHORTEST_MM: f64 = 0.1;
/// What a stretch more must bring in, as a share of the time.
const PRICE: f64 = 2e-5;
/// By what share of its path a brake begins earlier than it must. On its stretch more than
/// the limit may be had for speeding up: a control that comes there a little late and slow
/// must not find room for that.
const EARLIER: f64 = 0.01;
/// Accelerations that are tried for the last stages.
const TRIES: u32 = 60;

/// Why there are no stretches.
pub(super) const NO_FIT: &str =
    "friction, or the steps of speed at its ends, leave no acceleration";
pub(super) const SHORT: &str = "its pieces would be shorter than the control can use";

/// An acceleration that the knob can say, mm/s², with its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    accel_mm_s2: f64,
    pub(super) value: Option<(usize, AxisValues)>,
}

/// A stretch of the way with one acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) length_mm: f64,
    pub(super) step: Step,
}

/// The whole way.
#[derive(Debug)]
pub(super) struct Way {
    pub(super) stretches: Vec<Stretch>,
    /// The first one that is meant for braking.
    brakes_from: usize,
}

/// The line, and what holds on it.
pub(super) struct Road<'a> {
    solver: &'a Solver<'a>,
    case: Case<'a>,
    knob: usize,
    /// Speeds at its ends and its largest, mm/s.
    ends_mm_s: [f64; 2],
    pub(super) top_mm_s: f64,
    /// Acceleration along the path that is in force, and what the knob acts on of it.
    accel_mm_s2: f64,
    axes_accel_mm_s2: f64,
    /// The load that is aimed at.
    aim: f64,
    /// The shortest piece, s.
    shortest_s: f64,
}

impl<'a> Road<'a> {
    /// The way of a move with this plan.
    pub(super) fn new(solver: &'a Solver<'a>, case: Case<'a>, knob: usize, planned: &Plan) -> Self {
        let Case { mv, assessment, .. } = case;
        let machine = solver.machine;
        let planner = &machine.controller.planner;
        let mut shortest_s = planner.shortest_block_s;
        let mut aim = AIM;
        if planner.look_ahead.is_some() {
            // Shorter ones are lost in the response of the drives.
            shortest_s = shortest_s.max(machine.path.response_time_s);
            aim -= RESPONSE;
        }
        let axes_accel_mm_s2 = straight_accel_mm_s2(mv);
        let own_mm_s2 = solver.along_path(knob, mv).unwrap_or(axes_accel_mm_s2);
        Self {
            solver,
            case,
            knob,
            ends_mm_s: assessment.ends2.map(f64::sqrt),
            top_mm_s: planned.speed_limit_mm_s,
            accel_mm_s2: planned.accel_mm_s2,
            axes_accel_mm_s2: own_mm_s2,
            aim,
            shortest_s,
        }
    }

    /// Longer pieces, for less of the limit.
    pub(super) fn coarser(&mut self, tries: u8) {
        for _ in 0..tries {
            self.shortest_s *= LONGER;
            self.aim -= LESS;
        }
    }

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
        let [from_mm_s, to_mm_s] = if brakes {
            [top_mm_s, 0.0]
        } else {
            [0.0, top_mm_s]
        };
        let load = |accel: f64| self.ramp_load(from_mm_s, to_mm_s, accel);
        if load(self.accel_mm_s2) <= self.aim {
            return Some(self.accel_mm_s2);
        }
        let (mut low, mut high) = (1e-4 * self.accel_mm_s2, self.accel_mm_s2);
        let least = load(low);
        if least > self.aim || least.is_nan() {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if load(middle) <= self.aim {
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
    pub(super) fn way(&self, shortest_mm: f64) -> Result<Way, &'static str> {
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
            shortest_s: 1.02 * self.shortest_s,
            shortest_mm: 1.02 * shortest_mm,
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
            if known < GRID {
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

    /// Stretches for the stages, of which the last before the top and the first after it
    /// meet at the speed that the way leaves.
    fn close(&self, up: &[f64], down: &[f64]) -> Result<Way, &'static str> {
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
            if self.ramp_load(low, top, a) > self.aim {
                first.2 = self.lower(rise).ok_or(NO_FIT)?;
            } else if self.ramp_load(top, foot, d) > self.aim {
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
                let brakes_from = stretches.len() - 1;
                stretches.extend(last.0.into_iter().rev());
                return Ok(Way {
                    stretches,
                    brakes_from,
                });
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
    pub(super) fn duration_s(&self, stretches: &[Stretch]) -> Option<f64> {
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
            let usable = lasts_s >= self.shortest_s && stretch.length_mm >= SHORTEST_MM;
            if !usable || self.load(profile) > MOST {
                return None;
            }
            duration_s += lasts_s;
        }
        Some(duration_s)
    }

    /// Whether the top speed is reached before the brakes even where the control runs short
    /// pieces at a lower F. After a slower one there would be room to speed up in a stretch
    /// that is meant for braking.
    pub(super) fn recovers(&self, way: &Way) -> bool {
        let at_feed_s = self.solver.machine.controller.planner.shortest_at_feed_s;
        if at_feed_s == 0.0 {
            return true;
        }
        let before = way.brakes_from.checked_sub(1);
        let Some(last) = before.and_then(|last| way.stretches.get(last)) else {
            return false;
        };
        let slowest = way.stretches.iter().map(|it| it.length_mm / at_feed_s);
        let slowest_mm_s = slowest.fold(self.top_mm_s, f64::min);
        let missing2 = self.top_mm_s * self.top_mm_s - slowest_mm_s * slowest_mm_s;
        slowest_mm_s >= self.top_mm_s || missing2 <= (1.0 - EARLIER) * last.gain2()
    }

    /// How long the way lasts in one piece with a change.
    pub(super) fn whole_s(&self, change: &Change) -> f64 {
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
