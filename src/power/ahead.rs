//! Moves that a controller plans together: what each of them asks for.
//!
//! Input: moves and stops in program order. Output: an [`Assessment`] for each
//! move, once nothing behind it can change it any more.
//!
//! ```text
//! moves ─→ elements ─PathPlanner→ pieces of path ─PowerModel→ demand of each move
//! ```
//!
//! A piece that the planner is not certain of, and the moves beside it, get the
//! robust bound.

use std::collections::VecDeque;

use super::assess::{Assessment, Certificate};
use super::blend;
use super::demand::{Demand, Want};
use super::model::PowerModel;
use super::robust::Part;
use crate::interpret::{Corner, Move, MoveKind};
use crate::machine::{AXES, AxisSet, LookAhead, Machine, PathMode};
use crate::plan::lookahead::{Element, Joint, PathPlanner, Piece, Planned};
use crate::plan::{
    Blend, Overrides, PathFigures, Plan, Profile, SpeedBound, Trajectory, blended_bound,
    is_independent,
};

/// The moves that are planned together.
#[derive(Debug)]
pub(super) struct Ahead {
    /// At the largest overrides: peaks.
    largest: Side,
    /// At 100 %: times and energies; where that is the same, nothing.
    nominal: Option<Side>,
    /// Moves that are not handed on, by number from `first` on.
    open: VecDeque<Box<Open>>,
    first: u64,
    /// The one that was handed on last, and room that is used again.
    before: Option<Box<Open>>,
    #[allow(clippy::vec_box, reason = "they go back and forth between two queues")]
    spare: Vec<Box<Open>>,
    /// Nothing moves behind the last move.
    at_rest: bool,
    /// The next move follows something that may or may not stop the motion.
    in_doubt: bool,
}

/// A planner and how far it has come.
#[derive(Debug)]
struct Side {
    planner: PathPlanner<u64>,
    overrides: Overrides,
    /// The first move that is not finished.
    next: u64,
}

/// A move that is not handed on.
#[derive(Debug)]
struct Open {
    mv: Move,
    text: Vec<u8>,
    assessment: Assessment,
    want: Want,
    /// Largest speeds of the axes, its neighbours left aside.
    bound: SpeedBound,
    certain: bool,
    /// It neither begins nor ends in motion.
    alone: bool,
}

impl Open {
    fn part(&self) -> Part<'_> {
        Part {
            bound: &self.bound,
            accel_mm_s2: &self.mv.accel_mm_s2,
        }
    }
}

/// How a move takes part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// It has a path that the rules speak of.
    Path,
    /// It has none, and is passed.
    Nothing,
    /// How it runs together with others is not known.
    Unknown,
}

impl Ahead {
    /// Nothing moves yet. `overrides`: the largest, and 100 % or what is
    /// permitted of it.
    pub fn new(machine: &Machine, rules: LookAhead, overrides: [Overrides; 2]) -> Self {
        let [largest, nominal] = overrides.map(|overrides| Side {
            planner: PathPlanner::new(machine, rules),
            overrides,
            next: 0,
        });
        let alike = largest.overrides == nominal.overrides;
        Self {
            largest,
            nominal: (!alike).then_some(nominal),
            open: VecDeque::new(),
            first: 0,
            before: None,
            spare: Vec::new(),
            at_rest: true,
            in_doubt: false,
        }
    }

    /// Whether a move waits.
    pub fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// Adds a move with what is known of it by itself.
    pub fn push(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        mv: &Move,
        text: &[u8],
        assessment: &Assessment,
        want: Want,
    ) {
        let number = self.first + self.open.len() as u64;
        let mut role = role(machine, mv);
        let mut elements = [None, None];
        if role == Role::Path {
            let joint = joint(mv);
            let sides = [Some(&self.largest), self.nominal.as_ref()];
            elements = sides.map(|side| Element::of(machine, mv, side?.overrides, joint, number));
            let wanted = 1 + usize::from(self.nominal.is_some());
            if elements.iter().flatten().count() < wanted {
                role = Role::Unknown;
            }
        }
        let mut open = self.room(mv, text, assessment, want);
        match role {
            Role::Path => {
                open.assessment.ahead = true;
                open.assessment.blended = true;
                open.assessment.certificate = Certificate::Planned;
                open.assessment.duration_s = 0.0;
                open.assessment.top_speed_mm_s = 0.0;
                open.assessment.demand = Demand::NONE;
                open.bound = blended_bound(machine, mv, self.largest.overrides);
            }
            Role::Nothing => {}
            Role::Unknown => {
                open.assessment.ahead = true;
                open.assessment.blended = true;
                open.bound = blended_bound(machine, mv, self.largest.overrides);
                open.certain = false;
                self.stop_planners();
            }
        }
        if role != Role::Nothing {
            open.certain &= !std::mem::take(&mut self.in_doubt);
            self.at_rest = role == Role::Path && mv.path_mode == PathMode::ExactStop;
        }
        self.open.push_back(open);
        if role == Role::Path {
            let sides = [Some(&mut self.largest), self.nominal.as_mut()];
            for (side, element) in sides
                .into_iter()
                .flatten()
                .zip(elements.into_iter().flatten())
            {
                side.planner.push(&element);
            }
        }
        self.pump(model);
    }

    /// The motion stops behind the last move.
    pub fn stop(&mut self, model: &PowerModel) {
        self.stop_planners();
        self.at_rest = true;
        self.pump(model);
    }

    /// Something stands here that may or may not stop the motion.
    pub fn doubt(&mut self) {
        self.in_doubt = true;
        if let Some(last) = self.open.back_mut() {
            last.certain = false;
        }
    }

    fn stop_planners(&mut self) {
        self.largest.planner.stop();
        if let Some(nominal) = &mut self.nominal {
            nominal.planner.stop();
        }
    }

    /// A buffer for a move.
    fn room(&mut self, mv: &Move, text: &[u8], assessment: &Assessment, want: Want) -> Box<Open> {
        if let Some(mut open) = self.spare.pop() {
            open.mv.clone_from(mv);
            open.text.clear();
            open.text.extend_from_slice(text);
            open.assessment = *assessment;
            open.want = want;
            (open.certain, open.alone) = (true, true);
            return open;
        }
        Box::new(Open {
            mv: mv.clone(),
            text: text.to_vec(),
            assessment: *assessment,
            want,
            bound: SpeedBound::default(),
            certain: true,
            alone: true,
        })
    }

    /// Takes what the planners have finished.
    fn pump(&mut self, model: &PowerModel) {
        let end = self.first + self.open.len() as u64;
        let times = self.nominal.is_none();
        while let Some(planned) = self.largest.planner.pop() {
            self.largest.next = planned.first;
            self.take(model, &planned, true, times);
        }
        while let Some(nominal) = &mut self.nominal
            && let Some(planned) = nominal.planner.pop()
        {
            nominal.next = planned.first;
            self.take(model, &planned, false, true);
        }
        if self.at_rest {
            self.largest.next = end;
            if let Some(nominal) = &mut self.nominal {
                nominal.next = end;
            }
        }
    }

    /// Counts a piece of path for the moves that it belongs to.
    fn take(&mut self, model: &PowerModel, planned: &Planned<u64>, peaks: bool, times: bool) {
        let last = planned.next.unwrap_or(planned.tag);
        let index = |number: u64| number.checked_sub(self.first).map(|index| index as usize);
        let (Some(from), Some(own), Some(to)) =
            (index(planned.first), index(planned.tag), index(last))
        else {
            return;
        };
        let Some(open) = self.open.get(own) else {
            return;
        };
        let mut demand = piece_demand(model, &open.mv, planned, open.want);
        let joined = matches!(planned.piece, Piece::Joined { .. });
        let lengths: f64 = (from..=to)
            .filter_map(|index| self.open.get(index))
            .map(|open| open.mv.length_mm)
            .sum();
        let energy_j = std::mem::take(&mut demand.energy_j);
        let duration_s = planned.profile.duration_s();
        let ends = [
            planned.profile.phases.first(),
            planned.profile.phases.last(),
        ];
        let [start, end] = ends.map(|phase| {
            phase.map_or((0.0, 0.0), |phase| {
                (phase.velocity_mm_s, phase.end_velocity_mm_s)
            })
        });
        for index in from..=to {
            let Some(open) = self.open.get_mut(index) else {
                continue;
            };
            if open.mv.length_mm <= 0.0 {
                continue;
            }
            let share = match planned.piece {
                Piece::Blend(_) => 0.5,
                _ if joined => open.mv.length_mm / lengths,
                _ => 1.0,
            };
            let assessment = &mut open.assessment;
            open.certain &= planned.certain;
            open.alone &=
                from == to && start.0 == 0.0 && end.1 == 0.0 && is_whole(&open.mv, planned);
            if times {
                assessment.duration_s += share * duration_s;
                assessment.demand.energy_j += share * energy_j;
            }
            if peaks {
                let top = planned.profile.top_speed_mm_s();
                assessment.top_speed_mm_s = assessment.top_speed_mm_s.max(top);
                assessment.demand.include(&demand);
            }
        }
    }

    /// Hands on the moves that are finished, and whose neighbours are. All, when
    /// nothing moves behind the last one.
    pub fn hand_on(
        &mut self,
        model: &PowerModel,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let nominal = self
            .nominal
            .as_ref()
            .map_or(u64::MAX, |nominal| nominal.next);
        let finished = self.largest.next.min(nominal);
        while let Some(front) = self.open.front() {
            // Those of no length behind it are passed.
            let next = self
                .open
                .iter()
                .skip(1)
                .position(|open| open.mv.length_mm > 0.0);
            let moves = front.mv.length_mm > 0.0;
            let known = self.first < finished
                && match next {
                    Some(next) => self.first + 1 + (next as u64) < finished,
                    None => self.at_rest,
                };
            if moves && !known {
                return;
            }
            let Some(mut open) = self.open.pop_front() else {
                return;
            };
            self.first += 1;
            if !moves {
                sink(&open.mv, &open.assessment, &open.text);
                self.spare.push(open);
                continue;
            }
            let next = next
                .and_then(|next| self.open.get(next))
                .map(|next| &**next);
            let before = self.before.as_deref();
            let certain = |beside: Option<&Open>| beside.is_none_or(|beside| beside.certain);
            if open.certain && certain(before) && certain(next) {
                open.assessment.blended = !open.alone;
            } else {
                let own = open.part();
                let window = [
                    before.map_or(own, Open::part),
                    own,
                    next.map_or(own, Open::part),
                ];
                let demand = model.robust_over(&open.mv, &window, open.want);
                open.assessment.demand = Demand {
                    energy_j: open.assessment.demand.energy_j,
                    ..demand
                };
                open.assessment.certificate = Certificate::Robust;
            }
            sink(&open.mv, &open.assessment, &open.text);
            self.spare.extend(self.before.replace(open));
        }
        // What comes next begins at rest.
        if self.at_rest && !self.in_doubt {
            self.spare.extend(self.before.take());
        }
    }
}

/// Whether a piece is the whole path of a move.
fn is_whole(mv: &Move, planned: &Planned<u64>) -> bool {
    matches!(planned.piece, Piece::Along { from_mm, to_mm }
        if from_mm == 0.0 && to_mm >= mv.length_mm)
}

/// What a piece asks for, at the speed of its profile.
fn piece_demand(model: &PowerModel, mv: &Move, planned: &Planned<u64>, want: Want) -> Demand {
    match &planned.piece {
        Piece::Along { from_mm, .. } => {
            if let Some(demand) = below_floor(model, mv, &planned.profile, 0.0, want) {
                return demand;
            }
            let mut profile = planned.profile.clone();
            for phase in &mut profile.phases {
                phase.position_mm += from_mm;
            }
            model.demand(mv, &path(profile), want)
        }
        Piece::Joined { direction } => {
            let length_mm = planned.profile.length_mm();
            let mut line = mv.clone();
            line.length_mm = length_mm;
            line.start = [0.0; AXES];
            line.end = line.start;
            line.moving = AxisSet::default();
            for (axis, part) in direction.iter().enumerate() {
                line.end[axis] = part * length_mm;
                if *part != 0.0 {
                    line.moving.insert(axis);
                }
            }
            model.demand(&line, &path(planned.profile.clone()), want)
        }
        Piece::Blend(blend) => {
            below_floor(model, mv, &planned.profile, 1.0 / blend.radius_mm, want)
                .unwrap_or_else(|| model.blend_demand(mv, blend, &planned.profile, want))
        }
    }
}

/// A quick bound, if it stays below what is of interest; `curvature` in 1/mm.
fn below_floor(
    model: &PowerModel,
    mv: &Move,
    profile: &Profile,
    curvature: f64,
    want: Want,
) -> Option<Demand> {
    let top_speed_mm_s = profile.top_speed_mm_s();
    let accels = profile.phases.iter().map(|phase| phase.accel_mm_s2.abs());
    let figures = PathFigures {
        duration_s: 0.0,
        speed_limit_mm_s: top_speed_mm_s,
        accel_mm_s2: accels.fold(0.0, f64::max) + curvature * top_speed_mm_s * top_speed_mm_s,
        top_speed_mm_s,
    };
    model.below_floor(mv, &figures, want)
}

fn path(profile: Profile) -> Plan {
    Plan {
        duration_s: profile.duration_s(),
        top_speed_mm_s: profile.top_speed_mm_s(),
        speed_limit_mm_s: 0.0,
        accel_mm_s2: 0.0,
        trajectory: Trajectory::Path(profile),
    }
}

/// How a move takes part in look-ahead.
fn role(machine: &Machine, mv: &Move) -> Role {
    let synchronous = matches!(mv.kind, MoveKind::Thread | MoveKind::Tap | MoveKind::Probe);
    if mv.moving.is_empty() && mv.unknown_start.is_empty() {
        Role::Nothing
    } else if synchronous || !mv.unknown_start.is_empty() || is_independent(machine, mv) {
        Role::Unknown
    } else {
        Role::Path
    }
}

/// What the planner may do at the end of a move.
fn joint(mv: &Move) -> Joint {
    match (mv.path_mode, mv.corner) {
        (PathMode::ExactStop, _) => Joint::Stop,
        (PathMode::LookAhead, Corner::Exact) => Joint::Exact,
        (
            PathMode::LookAhead,
            Corner::Round {
                tolerance_mm,
                join_mm,
            },
        ) => Joint::Blend {
            tolerance_mm,
            join_mm,
        },
    }
}

impl PowerModel {
    /// The peaks and the energy of a blend behind the move `mv`.
    pub(super) fn blend_demand(
        &self,
        mv: &Move,
        blend: &Blend,
        profile: &Profile,
        want: Want,
    ) -> Demand {
        let mut demand = Demand::NONE;
        for (index, converter) in self.converters.iter().enumerate() {
            let totals = blend::totals(self, converter, mv, blend, profile, want);
            demand.add(index, converter, totals);
        }
        demand
    }
}
