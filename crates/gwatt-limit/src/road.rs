//! The way of a block in stretches: where they end, and their accelerations.
//!
//! Input: a straight move, the speeds at its ends, and the knob. Output: stretches that
//! fit, begun and ended as the move is. Stages up and stages down (`stages`) meet at the
//! speed that the length of the way leaves, or with a cruise between them.

use super::accel_grid::{Accels, GRID};
use super::along::straight_accel_mm_s2;
use super::case::Case;
use super::change::Change;
use super::solver::Solver;
use super::stages::{Stages, Terms, stages};
use gwatt_machine::AxisValues;
use gwatt_motion::Move;
use gwatt_plan::lookahead::Speeds2;
use gwatt_plan::{Plan, Profile, Trajectory, plan};
use gwatt_power::Want;

/// How often pieces are tried next to the block's neighbours, each time coarser ones.
pub(super) const SPLIT_TRIES: u8 = 4;

/// The load that stretches are designed for, and the one that they must keep as they will
/// be written: places are rounded.
const AIM: f64 = 1.0 - 4e-5;
pub(super) const MOST: f64 = 1.0 - 1e-5;
/// What the drives' response takes where it is modelled, as a share of the limit.
const RESPONSE: f64 = 4e-4;
/// By which factor stretches are longer, and for how much less of the limit, each time that
/// others did not fit: short ones next to what bounds say of the drives' response, and all
/// next to the block's neighbours.
const COARSER: [(f64, f64); SPLIT_TRIES as usize] =
    [(1.0, 0.0), (1.0, 3e-3), (2.5, 5e-3), (6.0, 1e-2)];
/// Halvings in the search for an acceleration and for the top speed.
pub(super) const HALVINGS: u32 = 40;
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
/// By what share the square of the speed is below the top where a hill begins on which
/// nothing but its acceleration holds the speed.
const HILL: f64 = 0.01;
/// By how much stages are designed longer than they must be, since their ends still move.
const SPARE: f64 = 1.02;

/// Why there are no stretches.
pub(super) const NO_FIT: &str =
    "friction, or the steps of speed at its ends, leave no acceleration";
pub(super) const SHORT: &str = "its pieces would be shorter than the control can use";

/// An acceleration that the knob can say, mm/s², with its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub(super) accel_mm_s2: f64,
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
    pub(super) brakes_from: usize,
}

/// The line, and what holds on it.
pub(super) struct Road<'a> {
    pub(super) solver: &'a Solver<'a>,
    case: Case<'a>,
    knob: usize,
    /// Speeds at its ends, that of its F or axes, and the largest that is aimed at, mm/s.
    pub(super) ends_mm_s: [f64; 2],
    pub(super) limit_mm_s: f64,
    pub(super) top_mm_s: f64,
    /// Acceleration along the path that is in force, and what the knob acts on of it.
    pub(super) accel_mm_s2: f64,
    axes_accel_mm_s2: f64,
    /// The load that is aimed at.
    pub(super) aim: f64,
    /// The shortest piece, s.
    pub(super) shortest_s: f64,
}

/// What stretches have to keep to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lengths {
    /// They last as long as a block has to.
    Usable,
    /// The control runs none of them at a lower F than their speed while its queue is short.
    AtSpeed,
}

impl<'a> Road<'a> {
    /// The way of a move with this plan.
    pub(super) fn new(solver: &'a Solver<'a>, case: Case<'a>, knob: usize, planned: &Plan) -> Self {
        let Case { mv, assessment, .. } = case;
        let machine = solver.machine;
        let planner = &machine.controller.planner;
        let mut aim = AIM;
        if planner.look_ahead.is_some() {
            aim -= RESPONSE;
        }
        let axes_accel_mm_s2 = straight_accel_mm_s2(mv);
        let own_mm_s2 = solver.along_path(knob, mv).unwrap_or(axes_accel_mm_s2);
        Self {
            solver,
            case,
            knob,
            ends_mm_s: assessment.ends2.map(f64::sqrt),
            limit_mm_s: planned.speed_limit_mm_s,
            top_mm_s: planned.speed_limit_mm_s,
            accel_mm_s2: planned.accel_mm_s2,
            axes_accel_mm_s2: own_mm_s2,
            aim,
            shortest_s: planner.shortest_block_s,
        }
    }

    /// Begins a way at a lower speed than the move did.
    pub(super) fn begin(&mut self, start_mm_s: f64) {
        let [start, _] = &mut self.ends_mm_s;
        *start = start.min(start_mm_s);
    }

    /// Holds a way to a speed that is below its F, or that of its axes.
    pub(super) fn hold(&mut self, top_mm_s: f64) {
        self.top_mm_s = self.top_mm_s.min(top_mm_s);
    }

    /// Longer pieces, for less of the limit, after so many tries.
    pub(super) fn coarser(&mut self, tries: u8) {
        if let Some((longer, less)) = COARSER.get(usize::from(tries)) {
            self.shortest_s *= longer;
            self.aim -= less;
        }
    }

    /// The least ratio of speeds at the ends of a piece: a control that sees `n` blocks ahead
    /// must be able to stop in the next `n`, which takes v² of what they gain together.
    fn least_ratio(&self) -> f64 {
        let rules = self.solver.machine.controller.planner.look_ahead;
        match rules.and_then(|rules| rules.blocks) {
            Some(blocks) if blocks > 1 => libm::exp2(0.5 / f64::from(blocks - 1)),
            _ => 1.0,
        }
    }

    /// The load ratio of a profile.
    pub(super) fn load(&self, profile: Profile) -> f64 {
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
        model.load_with_spindle(&demand, share, top_speed_mm_s)
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

    /// Stages up to one speed and down from another.
    fn ramps(
        &self,
        accels: &Accels,
        lengths: Lengths,
        [crest_mm_s, top_mm_s]: [f64; 2],
    ) -> Option<[Stages; 2]> {
        let at_speed_s = match lengths {
            Lengths::Usable => 0.0,
            Lengths::AtSpeed => SPARE * self.solver.machine.controller.planner.shortest_at_feed_s,
        };
        let terms = Terms {
            shortest_s: SPARE * self.shortest_s,
            shortest_mm: SPARE * SHORTEST_MM,
            at_foot_s: 0.0,
            at_top_s: 0.0,
            ratio: 1.0,
            price_s: PRICE * (self.case.mv.length_mm / self.top_mm_s),
        };
        // What speeds up must not be held back at its top; what brakes, not below its end.
        let rising = Terms {
            at_top_s: at_speed_s,
            ratio: self.least_ratio(),
            ..terms
        };
        let falling = Terms {
            at_foot_s: at_speed_s,
            ..terms
        };
        let [start_mm_s, end_mm_s] = self.ends_mm_s;
        let up = stages(start_mm_s, crest_mm_s, |v| accels.at(v, false), rising)?;
        let down = stages(end_mm_s, top_mm_s, |v| accels.at(v, true), falling)?;
        Some([up, down])
    }

    /// The way in stretches, each with its acceleration.
    pub(super) fn way(&self, lengths: Lengths) -> Result<Way, &'static str> {
        let accels = self.accels();
        let reach_mm_s = self.top_mm_s * accels.known() as f64 / GRID as f64;
        let [start_mm_s, end_mm_s] = self.ends_mm_s;
        let least_mm_s = start_mm_s.max(end_mm_s);
        if reach_mm_s <= start_mm_s {
            return Err(NO_FIT);
        }
        let ramps = |speeds| {
            let ramps = self.ramps(&accels, lengths, speeds)?;
            let length_mm = ramps.iter().map(|it| it.length_mm).sum::<f64>();
            Some((ramps, length_mm <= self.case.mv.length_mm))
        };
        if reach_mm_s <= least_mm_s {
            return self.open(ramps, reach_mm_s).ok_or(NO_FIT);
        }
        let top = ramps([reach_mm_s; 2]);
        if accels.known() < GRID && matches!(top, Some((_, true))) {
            return Err(NO_FIT);
        }
        let mut most_mm_s = reach_mm_s;
        if self.top_mm_s < self.limit_mm_s {
            // Nothing but accelerations holds it to its largest speed. A hill with this share
            // of v² lasts for two of the shortest pieces, however short the way.
            let lasts_s = 2.0 * self.shortest_s;
            let share = lasts_s * accels.at(reach_mm_s, false) / reach_mm_s;
            for share in [HILL, share.clamp(HILL, 0.5)] {
                let foot_mm_s = reach_mm_s * (1.0 - share).sqrt();
                most_mm_s = foot_mm_s.max(least_mm_s);
                let Some(([mut up, down], true)) = ramps([most_mm_s, reach_mm_s]) else {
                    continue;
                };
                up.tops_mm_s.push(reach_mm_s);
                let hill = self.close(&up.tops_mm_s, &down.tops_mm_s, true);
                if let Ok(way) = hill
                    && self.duration_s(&way.stretches).is_some()
                {
                    return Ok(way);
                }
            }
        }
        let mut found = ramps([most_mm_s; 2]).filter(|(_, fits)| *fits);
        if found.is_none() {
            found = highest([least_mm_s, most_mm_s], |speed_mm_s| ramps([speed_mm_s; 2]));
        }
        match found {
            Some(([up, down], _)) => self.close(&up.tops_mm_s, &down.tops_mm_s, false),
            None => self.open(ramps, reach_mm_s).ok_or(SHORT),
        }
    }

    /// A way that speeds up all along, and ends more slowly than the move did.
    fn open(
        &self,
        ramps: impl Fn([f64; 2]) -> Option<([Stages; 2], bool)>,
        reach_mm_s: f64,
    ) -> Option<Way> {
        let [start_mm_s, end_mm_s] = self.ends_mm_s;
        let most_mm_s = end_mm_s.min(reach_mm_s);
        if most_mm_s <= start_mm_s || matches!(ramps([most_mm_s, end_mm_s]), Some((_, true))) {
            return None;
        }
        let ramps = |speed_mm_s| ramps([speed_mm_s, end_mm_s]);
        let ([up, _], _) = highest([start_mm_s, most_mm_s], ramps)?;
        let (mut stretches, low_mm_s, mut step) = self.side(&up.tops_mm_s, start_mm_s, false)?;
        let length_mm = self.case.mv.length_mm - gone_mm(&stretches);
        for _ in 0..TRIES {
            let top2 = low_mm_s * low_mm_s + 2.0 * step.accel_mm_s2 * length_mm;
            if self.ramp_load(low_mm_s, top2.sqrt(), step.accel_mm_s2) <= self.aim {
                stretches.push(Stretch { length_mm, step });
                let brakes_from = stretches.len();
                return Some(Way {
                    stretches,
                    brakes_from,
                });
            }
            step = self.lower(step)?;
        }
        None
    }

    /// The stretches of stages but the last one, the speed at which that begins, and its
    /// acceleration.
    fn side(
        &self,
        tops_mm_s: &[f64],
        from_mm_s: f64,
        brakes: bool,
    ) -> Option<(Vec<Stretch>, f64, Step)> {
        let (top, lower) = tops_mm_s.split_last()?;
        let mut stretches = Vec::with_capacity(tops_mm_s.len() + 1);
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
    }

    /// Stretches for the stages, of which the last before the top and the first after it
    /// meet at the speed that the way leaves. On a hill the acceleration of the last before
    /// the top is what takes it there, and no further.
    fn close(&self, up: &[f64], down: &[f64], hill: bool) -> Result<Way, &'static str> {
        let [start_mm_s, end_mm_s] = self.ends_mm_s;
        let mut first = self.side(up, start_mm_s, false).ok_or(SHORT)?;
        let mut last = self.side(down, end_mm_s, true).ok_or(SHORT)?;
        let left_mm = self.case.mv.length_mm - gone_mm(&first.0) - gone_mm(&last.0);
        let kept = 1.0 - EARLIER;
        let foot2 = last.1 * last.1;
        if hill {
            // The same as below, for a.
            let (low2, top2) = (first.1 * first.1, self.top_mm_s * self.top_mm_s);
            let way_mm = 2.0 * left_mm - kept * (top2 - foot2) / last.2.accel_mm_s2;
            let rise_mm_s2 = ((1.0 + EARLIER) * top2 - low2 - EARLIER * foot2) / way_mm;
            first.2 = self.step(rise_mm_s2).ok_or(SHORT)?;
        }
        for _ in 0..TRIES {
            let (low, rise) = (first.1, first.2);
            let (foot, fall) = (last.1, last.2);
            let (a, d) = (rise.accel_mm_s2, fall.accel_mm_s2);
            // The stretch before the brakes has to slow down for the last hundredth of
            // v² − foot²: 2·a·l = 2·v² − low² − (foot² + kept·(v² − foot²)) with
            // l = left − kept·(v² − foot²)/2d.
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

    /// How long the way lasts in one piece with a change.
    pub(super) fn whole_s(&self, change: &Change) -> f64 {
        let (machine, largest) = (self.solver.machine, self.solver.largest);
        let changed: Move = change.apply(machine, self.case.mv, self.case.permit);
        let planned = plan(machine, &changed, largest);
        let top2 = planned.speed_limit_mm_s * planned.speed_limit_mm_s;
        let [start, end] = self.ends_mm_s.map(|end| (end * end).min(top2));
        let gain2 = 2.0 * planned.accel_mm_s2 * changed.length_mm;
        let (start, end) = (start.min(end + gain2), end.min(start + gain2));
        let speeds2 = Speeds2 {
            start,
            end,
            top: top2,
        };
        Profile::between(changed.length_mm, speeds2, planned.accel_mm_s2).duration_s()
    }
}

/// The stages to the highest of the speeds between two for which there is room.
fn highest(
    [mut low, mut high]: [f64; 2],
    ramps: impl Fn(f64) -> Option<([Stages; 2], bool)>,
) -> Option<([Stages; 2], bool)> {
    let mut found = None;
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        match ramps(middle) {
            Some((ramps, true)) => (low, found) = (middle, Some((ramps, true))),
            // Ramps to lower speeds have shorter stages.
            None => low = middle,
            Some(_) => high = middle,
        }
    }
    found
}

/// How far stretches reach.
fn gone_mm(stretches: &[Stretch]) -> f64 {
    stretches.iter().map(|it| it.length_mm).sum()
}

impl Stretch {
    /// By how much the square of the speed may change in it, mm²/s².
    pub(super) fn gain2(&self) -> f64 {
        2.0 * self.step.accel_mm_s2 * self.length_mm
    }
}
