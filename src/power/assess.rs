//! Judging moves in their order: which certificate each needs, and its demand.
//!
//! Input: moves in program order. Output: an [`Assessment`] for each, in the
//! same order. A move that may be blended with its successor waits for it; all
//! others are judged at once.

use super::demand::{Demand, Want};
use super::model::PowerModel;
use crate::interpret::{Move, MoveKind};
use crate::machine::{AxisValues, Machine, PathMode, RapidJoint};
use crate::plan::{Overrides, SpeedBound, blended_bound, plan};

/// Which bound a figure rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Certificate {
    /// The planner that the controller profile models.
    Planned,
    /// Any look-ahead, blending and filtering that keeps each axis inside its
    /// own limits.
    Robust,
}

impl Certificate {
    /// The name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Planned => "planned",
            Self::Robust => "robust",
        }
    }
}

/// What is known of a move once it is judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assessment {
    /// Duration from rest to rest in s; 0 where the start is not known.
    pub duration_s: f64,
    /// Path speed that feed and axes permit at 100 % override, mm/s.
    pub speed_mm_s: f64,
    /// Path acceleration, mm/s².
    pub accel_mm_s2: f64,
    /// Path speed reached at the largest override, mm/s.
    pub top_speed_mm_s: f64,
    /// Peaks at the largest overrides, and the energy at 100 %.
    pub demand: Demand,
    /// Which certificate the peaks belong to.
    pub certificate: Certificate,
    /// The move may run into or out of a neighbour without a stop: its peaks
    /// depend on both.
    pub blended: bool,
    /// The controller may run into it from its predecessor without a stop; a
    /// move of no length is passed on the way to the next.
    pub joined: bool,
}

/// Judges the moves of one program.
#[derive(Debug)]
pub struct Assessor<'m> {
    /// The machine.
    pub machine: &'m Machine,
    /// Its power model.
    pub model: PowerModel,
    /// The largest overrides, at which peaks are taken.
    pub largest: Overrides,
    /// The overrides at which times are taken: 100 %, or less where the
    /// machine permits less.
    pub nominal: Overrides,
    requested: Option<Certificate>,
    /// What is wanted of evaluations; the floor may rise as peaks are found.
    pub want: Want,
    held: Option<Held>,
    /// A blended move was found although the planned certificate was asked for.
    pub needs_robust: bool,
}

/// A move that waits for its successor.
#[derive(Debug)]
struct Held {
    mv: Move,
    text: Vec<u8>,
    assessment: Assessment,
    /// Largest speeds and accelerations of it and its predecessor.
    bound: SpeedBound,
    accel_mm_s2: AxisValues,
    /// Its own.
    own_bound: SpeedBound,
    /// Whether its predecessor runs into it.
    joined: bool,
    /// Moves of no length behind it: controllers leave them out and blend
    /// across them.
    riders: Vec<Rider>,
}

/// A move of no length that waits with the move before it.
#[derive(Debug)]
struct Rider {
    mv: Move,
    text: Vec<u8>,
    assessment: Assessment,
}

/// Moves of no length in a row that a controller may look across: more than
/// any queue holds.
const RIDERS: usize = 4096;

impl<'m> Assessor<'m> {
    /// Judges by `requested`, or by what the controller profile models.
    #[must_use]
    pub fn new(machine: &'m Machine, requested: Option<Certificate>, want: Want) -> Self {
        let largest = Overrides {
            feed: machine.limits.feed_override_max,
            rapid: machine.limits.rapid_override_max,
            spindle: machine.limits.spindle_override_max,
        };
        let nominal = Overrides {
            feed: largest.feed.min(1.0),
            rapid: largest.rapid.min(1.0),
            spindle: largest.spindle.min(1.0),
        };
        let model = PowerModel::new(machine);
        Self {
            machine,
            model,
            largest,
            nominal,
            requested,
            want,
            held: None,
            needs_robust: false,
        }
    }

    /// The certificate that was asked for.
    #[must_use]
    pub fn requested(&self) -> Option<Certificate> {
        self.requested
    }

    /// Whether the next move would wait for its successor, or others for it.
    #[must_use]
    pub fn waits(&self, mv: &Move) -> bool {
        self.held.is_some() || self.may_blend(mv)
    }

    /// Takes the next move with the text of its line, and hands on what can be
    /// judged now.
    pub fn push(
        &mut self,
        mv: &Move,
        text: &[u8],
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let joined = self
            .held
            .as_ref()
            .is_some_and(|held| self.joins(&held.mv, mv));
        let mut assessment = self.alone(mv);
        assessment.joined = joined;
        let may_blend = assessment.blended || joined;
        if mv.kind != MoveKind::Dwell
            && !moves(mv)
            && let Some(held) = &mut self.held
            && held.riders.len() < RIDERS
        {
            assessment.joined = true;
            held.riders.push(Rider {
                mv: mv.clone(),
                text: text.to_vec(),
                assessment,
            });
            return;
        }
        if !may_blend {
            self.release(None, sink);
            sink(mv, &assessment, text);
            return;
        }
        assessment.blended = true;
        let own_bound = blended_bound(self.machine, mv, self.largest);
        let mut bound = own_bound;
        let mut accel_mm_s2 = mv.accel_mm_s2;
        if joined && let Some(held) = &self.held {
            bound.include(&held.own_bound);
            include_accel(&mut accel_mm_s2, &held.mv.accel_mm_s2);
        }
        let mut text_buffer = self.release(joined.then_some((&own_bound, &mv.accel_mm_s2)), sink);
        text_buffer.clear();
        text_buffer.extend_from_slice(text);
        self.held = Some(Held {
            mv: mv.clone(),
            text: text_buffer,
            assessment,
            bound,
            accel_mm_s2,
            own_bound,
            joined,
            riders: Vec::new(),
        });
    }

    /// Hands on what was waiting, at the end of the program.
    pub fn finish(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        self.release(None, sink);
    }

    /// Judges what is held; `next` is the bound of a move that it runs into.
    /// Returns the text buffer for the next one.
    fn release(
        &mut self,
        next: Option<(&SpeedBound, &AxisValues)>,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) -> Vec<u8> {
        let Some(mut held) = self.held.take() else {
            return Vec::new();
        };
        if let Some((bound, accel_mm_s2)) = next {
            held.bound.include(bound);
            include_accel(&mut held.accel_mm_s2, accel_mm_s2);
        }
        // A rapid between two stops is planned like any other; feeds in a mode
        // that blends keep the robust bound.
        let stops = held.mv.kind == MoveKind::Rapid && !held.joined && next.is_none();
        if stops && self.requested != Some(Certificate::Robust) {
            held.assessment.blended = false;
        } else {
            self.bound(&mut held);
        }
        sink(&held.mv, &held.assessment, &held.text);
        for rider in &held.riders {
            sink(&rider.mv, &rider.assessment, &rider.text);
        }
        held.text
    }

    /// Gives a move its robust bound.
    fn bound(&mut self, held: &mut Held) {
        let energy_j = held.assessment.demand.energy_j;
        held.assessment.demand = self.model.robust(&held.mv, &held.bound, &held.accel_mm_s2);
        held.assessment.demand.energy_j = energy_j;
        held.assessment.certificate = Certificate::Robust;
        self.needs_robust |= self.requested == Some(Certificate::Planned);
    }

    /// The planned demand, and whether the move may be blended.
    fn alone(&self, mv: &Move) -> Assessment {
        let peak_plan = plan(self.machine, mv, self.largest);
        let mut demand = self.model.demand(mv, &peak_plan, self.want);
        let (mut duration_s, mut speed_mm_s) = (peak_plan.duration_s, peak_plan.speed_limit_mm_s);
        if self.largest != self.nominal {
            let nominal = plan(self.machine, mv, self.nominal);
            (duration_s, speed_mm_s) = (nominal.duration_s, nominal.speed_limit_mm_s);
            if self.want.energy {
                demand.energy_j = self.model.demand(mv, &nominal, self.want).energy_j;
            }
        }
        let unknown = !mv.unknown_start.is_empty();
        Assessment {
            duration_s,
            speed_mm_s,
            accel_mm_s2: peak_plan.accel_mm_s2,
            top_speed_mm_s: peak_plan.top_speed_mm_s,
            demand,
            certificate: if unknown {
                Certificate::Robust
            } else {
                Certificate::Planned
            },
            blended: self.may_blend(mv),
            joined: false,
        }
    }

    /// Whether a move may be blended with one that is not known yet.
    fn may_blend(&self, mv: &Move) -> bool {
        if !moves(mv) {
            return false;
        }
        let rapid = mv.kind == MoveKind::Rapid;
        self.requested == Some(Certificate::Robust)
            || mv.path_mode == PathMode::LookAhead
                && (!rapid || self.machine.controller.planner.rapid_joint != RapidJoint::Stop)
    }

    /// Whether the controller may run from `first` into `second` without a stop.
    #[must_use]
    pub fn joins(&self, first: &Move, second: &Move) -> bool {
        if !moves(first) || !moves(second) {
            return false;
        }
        if self.requested == Some(Certificate::Robust) {
            return true;
        }
        let rapids = [first, second].map(|mv| mv.kind == MoveKind::Rapid);
        first.path_mode == PathMode::LookAhead
            && match self.machine.controller.planner.rapid_joint {
                RapidJoint::Stop => rapids == [false, false],
                RapidJoint::Rapids => rapids[0] == rapids[1],
                RapidJoint::All => true,
            }
    }
}

/// Whether any axis moves.
fn moves(mv: &Move) -> bool {
    mv.kind != MoveKind::Dwell && !(mv.moving.is_empty() && mv.unknown_start.is_empty())
}

fn include_accel(accel: &mut AxisValues, other: &AxisValues) {
    for (own, other) in accel.iter_mut().zip(other) {
        *own = own.max(*other);
    }
}
