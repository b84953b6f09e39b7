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
//! robust bound; and so does all whose speed depends on what happens there: the
//! moves before it that may have to brake for it, and those behind it until they
//! run as fast as planned even from rest.

use std::collections::VecDeque;

use super::assessment::{Assessment, Certificate};
use super::demand::{Demand, Want};
use super::eye::Eye;
use super::model::PowerModel;
use super::piece::piece_demand;
use super::robust::Part;
use super::watch::Kept;
use crate::interpret::{Corner, Move, MoveKind};
use crate::machine::{LookAhead, Machine, PathMode};
use crate::plan::lookahead::{Element, Joint, PathPlanner, Piece, Planned};
use crate::plan::{Overrides, blended_bound, is_independent};

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
    /// Something stands behind the last move that may or may not stop it.
    in_doubt: bool,
    /// What the motion reaches at least, from rest where it was in doubt last,
    /// mm²/s²; nothing once that is as fast as planned.
    reach2: Option<f64>,
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
    certain: bool,
    /// The speed with which it begins is not certain.
    in_doubt: bool,
    /// It ends at rest whatever follows.
    rests: bool,
    /// Some axis moves.
    moves: bool,
    /// It neither begins nor ends in motion.
    alone: bool,
    /// Its pieces over time, where they are looked at.
    kept: Kept,
}

/// How a move takes part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
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
            reach2: None,
        }
    }

    /// Whether a move waits.
    pub fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// Adds a move with what is known of it by itself.
    #[allow(clippy::too_many_arguments, reason = "what is known of a move")]
    pub fn push(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        eye: &mut Eye,
        mv: &Move,
        text: &[u8],
        assessment: impl FnOnce() -> Assessment,
        want: Want,
    ) {
        let number = self.first + self.open.len() as u64;
        let mut role = role(machine, mv);
        let element = |side: &Side| {
            let joint = joint(mv);
            Element::of(machine, mv, side.overrides, joint, number)
        };
        let (mut largest, mut nominal) = (None, None);
        if role == Role::Path {
            largest = element(&self.largest);
            nominal = self.nominal.as_ref().and_then(element);
            if largest.is_none() || nominal.is_some() != self.nominal.is_some() {
                role = Role::Unknown;
            }
        }
        if role == Role::Unknown || role == Role::Path && self.in_doubt {
            self.brake_in_doubt(model, eye);
        }
        let mut open = self.room(mv, text, want);
        match role {
            Role::Path => {
                let own = nominal.as_ref().or(largest.as_ref());
                open.assessment = Assessment {
                    speed_mm_s: own.map_or(0.0, Element::top_mm_s),
                    accel_mm_s2: own.map_or(0.0, |own| own.accel_mm_s2),
                    ..Assessment::AHEAD
                };
            }
            Role::Nothing => open.assessment = assessment(),
            Role::Unknown => {
                open.assessment = Assessment {
                    blended: true,
                    ahead: true,
                    ..assessment()
                };
                open.certain = false;
                self.stop_planners();
            }
        }
        if role != Role::Nothing {
            open.moves = true;
            open.in_doubt = std::mem::replace(&mut self.in_doubt, role == Role::Unknown);
            // The planner holds it back, even if it ends at rest.
            self.at_rest = false;
            open.rests = role == Role::Path && mv.path_mode == PathMode::ExactStop;
        }
        self.open.push_back(open);
        if role == Role::Path {
            if let Some(element) = &largest {
                self.largest.planner.push(element);
            }
            if let (Some(side), Some(element)) = (&mut self.nominal, &nominal) {
                side.planner.push(element);
            }
        }
        self.pump(model, eye);
        if role == Role::Unknown {
            let side = self.nominal.as_ref().unwrap_or(&self.largest);
            eye.show(machine, mv, side.overrides);
        }
    }

    /// The motion stops behind the last move.
    pub fn stop(&mut self, model: &PowerModel, eye: &mut Eye) {
        self.stop_planners();
        self.at_rest = true;
        self.in_doubt = false;
        self.pump(model, eye);
    }

    /// Something stands here that may or may not stop the motion.
    pub fn doubt(&mut self) {
        let rests = self.at_rest || self.open.back().is_some_and(|last| last.rests);
        self.in_doubt |= !rests;
    }

    /// The moves that a stop here would change are in doubt.
    fn brake_in_doubt(&mut self, model: &PowerModel, eye: &mut Eye) {
        self.largest.planner.settle();
        self.pump(model, eye);
        let finished = self.largest.next.saturating_sub(self.first) as usize;
        for open in self.open.iter_mut().skip(finished) {
            open.certain = false;
        }
    }

    fn stop_planners(&mut self) {
        self.largest.planner.stop();
        if let Some(nominal) = &mut self.nominal {
            nominal.planner.stop();
        }
    }

    /// A buffer for a move.
    fn room(&mut self, mv: &Move, text: &[u8], want: Want) -> Box<Open> {
        if let Some(mut open) = self.spare.pop() {
            open.mv.clone_from(mv);
            open.text.clear();
            open.text.extend_from_slice(text);
            open.want = want;
            (open.certain, open.alone) = (true, true);
            (open.in_doubt, open.rests, open.moves) = (false, false, false);
            open.kept.clear();
            return open;
        }
        Box::new(Open {
            mv: mv.clone(),
            text: text.to_vec(),
            assessment: Assessment::AHEAD,
            want,
            certain: true,
            in_doubt: false,
            rests: false,
            moves: false,
            alone: true,
            kept: Kept::default(),
        })
    }

    /// Takes what the planners have finished.
    fn pump(&mut self, model: &PowerModel, eye: &mut Eye) {
        let end = self.first + self.open.len() as u64;
        let times = self.nominal.is_none();
        while let Some(planned) = self.largest.planner.pop() {
            self.largest.next = planned.first;
            self.take(model, eye, &planned, true, times);
        }
        while let Some(nominal) = &mut self.nominal
            && let Some(planned) = nominal.planner.pop()
        {
            nominal.next = planned.first;
            self.take(model, eye, &planned, false, true);
        }
        if self.at_rest {
            self.largest.next = end;
            if let Some(nominal) = &mut self.nominal {
                nominal.next = end;
            }
        }
    }

    /// Counts a piece of path for the moves that it belongs to.
    fn take(
        &mut self,
        model: &PowerModel,
        eye: &mut Eye,
        planned: &Planned<u64>,
        peaks: bool,
        times: bool,
    ) {
        let last = planned.next.unwrap_or(planned.tag);
        let index = |number: u64| number.checked_sub(self.first).map(|index| index as usize);
        let (Some(from), Some(own), Some(to)) =
            (index(planned.first), index(planned.tag), index(last))
        else {
            return;
        };
        let Some(open) = self.open.get_mut(own) else {
            return;
        };
        if peaks {
            eye.keep(model, &open.mv, planned, &mut open.kept);
        }
        if times {
            eye.show_piece(&open.mv, planned);
        }
        let mut demand = piece_demand(model, &open.mv, planned, open.want);
        let certain = !peaks || self.is_certain(planned, from, to);
        // Half of a blend belongs to what is behind it.
        let halves = if planned.next.is_some() { 0.5 } else { 1.0 };
        let lengths: f64 = (from..=own)
            .filter_map(|index| self.open.get(index))
            .map(|open| open.mv.length_mm)
            .sum();
        let energy_j = std::mem::take(&mut demand.energy_j);
        let duration_s = planned.duration_s();
        let rests = planned.speeds2.start == 0.0 && planned.speeds2.end == 0.0;
        for index in from..=to {
            let Some(open) = self.open.get_mut(index) else {
                continue;
            };
            if open.mv.length_mm <= 0.0 {
                continue;
            }
            let share = if index > own {
                1.0 - halves
            } else {
                halves * open.mv.length_mm / lengths
            };
            let assessment = &mut open.assessment;
            open.certain &= certain;
            open.alone &= from == to && rests && is_whole(&open.mv, planned);
            if times {
                assessment.duration_s += share * duration_s;
                assessment.demand.energy_j += share * energy_j;
            }
            if peaks {
                assessment.fastest_s += share * duration_s;
                let top_speed_mm_s = planned.top_speed_mm_s();
                assessment.top_speed_mm_s = assessment.top_speed_mm_s.max(top_speed_mm_s);
                assessment.demand.include(&demand);
            }
        }
    }

    /// Whether a piece runs as planned whatever happened where the motion was in
    /// doubt before it.
    fn is_certain(&mut self, planned: &Planned<u64>, from: usize, to: usize) -> bool {
        let blend = matches!(planned.piece, Piece::Blend(_));
        for index in from..=to {
            if let Some(open) = self.open.get_mut(index)
                && open.in_doubt
            {
                // Behind a stop there is no blend: the line begins at rest.
                open.in_doubt = blend;
                self.reach2 = Some(0.0);
            }
        }
        let end2 = planned.speeds2.end;
        if !planned.certain {
            self.reach2 = (end2 > 0.0).then_some(0.0);
            return false;
        }
        let Some(reach2) = self.reach2 else {
            return true;
        };
        // Half of the acceleration, since the blends differ as well.
        let reached2 = planned.reached2(reach2);
        self.reach2 = (reached2 < end2).then_some(reached2);
        false
    }

    /// Hands on the moves that are finished, and whose neighbours are. All, when
    /// nothing moves behind the last one.
    pub fn hand_on(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        eye: &mut Eye,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let nominal = self
            .nominal
            .as_ref()
            .map_or(u64::MAX, |nominal| nominal.next);
        let finished = self.largest.next.min(nominal);
        while let Some(front) = self.open.front() {
            // Those that do not move are passed.
            let next = self.open.iter().skip(1).position(|open| open.moves);
            let moves = front.moves;
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
                eye.pass();
                sink(&open.mv, &open.assessment, &open.text);
                self.spare.push(open);
                continue;
            }
            let next = next
                .and_then(|next| self.open.get(next))
                .map(|next| &**next)
                .filter(|_| !open.rests);
            let before = self.before.as_deref().filter(|before| !before.rests);
            let certain = |beside: Option<&Open>| beside.is_none_or(|beside| beside.certain);
            // What no piece speaks of is not known.
            let planned = !open.assessment.ahead || open.assessment.top_speed_mm_s > 0.0;
            if planned && open.certain && certain(before) && certain(next) {
                open.assessment.blended = !open.alone;
                if open.assessment.ahead {
                    eye.kept(model, &open.mv, &mut open.kept);
                } else {
                    eye.alone(machine, model, &open.mv, self.largest.overrides);
                }
            } else {
                let mut kept = std::mem::take(&mut open.kept);
                let beside = [before.unwrap_or(&open), &open, next.unwrap_or(&open)];
                let overrides = self.largest.overrides;
                let bounds = beside.map(|open| blended_bound(machine, &open.mv, overrides));
                let [first, own, last] = &bounds;
                let part = |bound, index: usize| Part {
                    bound,
                    accel_mm_s2: &beside[index].mv.accel_mm_s2,
                };
                let window = [part(first, 0), part(own, 1), part(last, 2)];
                let mut demand = model.robust_over(&open.mv, &window, open.want);
                let largest = self.largest.overrides;
                eye.blended(machine, model, &open.mv, &window, &mut kept, largest);
                // Chords of a small arc may ask for more than the axes' limits.
                demand.include(&open.assessment.demand);
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
        if self.at_rest {
            self.spare.extend(self.before.take());
        }
    }
}

/// Whether a piece is the whole path of a move.
fn is_whole(mv: &Move, planned: &Planned<u64>) -> bool {
    matches!(planned.piece, Piece::Along { from_mm, to_mm }
        if from_mm == 0.0 && to_mm >= mv.length_mm)
}

/// How a move takes part in look-ahead.
pub(crate) fn role(machine: &Machine, mv: &Move) -> Role {
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
pub(crate) fn joint(mv: &Move) -> Joint {
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
