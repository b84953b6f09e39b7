//! Blocks in several pieces of one line, each with an acceleration of its own.
//!
//! Under a limit of power a line is run soonest with all force up to the speed at which
//! the power reaches the limit, and from there on with the acceleration that the limit
//! leaves. One acceleration for the block cannot do that; stepped ones come near it. The
//! pieces run on into each other at one F, so that the controller's own planner drives
//! them as designed here: an acceleration of each holds in it for speeding up and for
//! braking, and the way is divided so that it has no other choice.

use super::case::{Case, Ends};
use super::change::{Change, Permit};
use super::lever::{Levers, levers};
use super::road::{Lengths, MOST, NO_FIT, Road, SHORT, SPLIT_TRIES};
use super::solver::Solver;
use gwatt_machine::{AxisValues, Knob, KnobTarget, LookAhead, PathMode};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{is_independent, plan};
use gwatt_power::{Assessment, Certificate, plans_lines};

/// What pieces must bring in, as a share of the time.
const GAIN: f64 = 1e-3;

/// Why a block stays one.
const NO_LOOK_AHEAD: &str = "its pieces would not run on into each other as planned";
const UNLIKE: &str = "an axis limits its jerk, has a curve of force, or runs for itself";
const NOT_SOONER: &str = "one acceleration is as good";
const NEIGHBOURS: &str = "next to its neighbours the pieces would exceed the limit";

/// A block in several pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// In their order, at least two.
    pub pieces: Vec<Piece>,
    /// The speed at which they end, mm/s.
    pub end_mm_s: f64,
    /// The knob by which their hills need no cruise, where they would otherwise.
    pub cruise: Option<usize>,
}

/// A piece of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The share of the way at which it ends.
    pub share: f64,
    /// The knob for acceleration, and its value for each axis; `None`: what is in force.
    pub accel: Option<(usize, AxisValues)>,
}

impl Solver<'_> {
    /// The pieces in which a block fits and is done sooner than with the change
    /// `otherwise`. What is before it ends at `arrives_mm_s`, where that is known to be
    /// slower than it was.
    ///
    /// # Errors
    /// Why it stays one block.
    pub(super) fn pieces(
        &self,
        mv: &Move,
        assessment: &Assessment,
        permit: &Permit,
        (tries, arrives_mm_s): (u8, Option<f64>),
        otherwise: Option<&Change>,
    ) -> Result<Split, &'static str> {
        if let Some(reason) = permit.unsplit {
            return Err(reason);
        }
        let case = Case {
            mv,
            assessment,
            permit,
            ends: Ends::Any(0),
            exact_stop: false,
        };
        if tries >= SPLIT_TRIES {
            return Err(NEIGHBOURS);
        }
        let mut road = self.road(case, &levers(self.machine, self.how, mv, permit))?;
        road.coarser(tries);
        road.begin(arrives_mm_s.unwrap_or(f64::INFINITY));
        let mut way = road.way(Lengths::Usable)?;
        if !road.recovers(&way) {
            way = road.way(Lengths::AtSpeed)?;
            if !road.recovers(&way) {
                return Err(SHORT);
            }
        }
        let end_mm_s = road.end_mm_s(&way).ok_or(NO_FIT)?;
        let stretches = way.stretches;
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
            end_mm_s,
            cruise: self.cruise_knob(mv),
        })
    }

    /// The knob that takes the cruise off hills, where they have one.
    fn cruise_knob(&self, mv: &Move) -> Option<usize> {
        let controller = &self.machine.controller;
        let rules = controller.planner.look_ahead?;
        let suits = |knob: &Knob| {
            knob.verified && knob.between_moves && knob.target == KnobTarget::CruiseRatio
        };
        let index = controller.knobs.iter().position(suits)?;
        (cruise_ratio(mv, &rules) > 0.0).then_some(index)
    }

    fn road<'a>(&'a self, case: Case<'a>, levers: &Levers) -> Result<Road<'a>, &'static str> {
        let Case { mv, assessment, .. } = case;
        let controller = &self.machine.controller;
        let straight = matches!(mv.kind, MoveKind::Rapid | MoveKind::Feed) && mv.arc.is_none();
        let acts = |index: &usize| {
            let knob = controller.knobs.get(*index);
            knob.is_some_and(|knob| knob.between_moves)
        };
        let knob = levers.accel.filter(acts).filter(|_| straight);
        let rules = controller.planner.look_ahead;
        let planned = plan(self.machine, mv, self.largest);
        let flows = mv.path_mode == PathMode::LookAhead
            && assessment.certificate == Certificate::Planned
            && assessment.ends2.iter().all(|end2| end2.is_finite())
            && match rules {
                Some(rules) => {
                    assessment.ahead
                        && (cruise_ratio(mv, &rules) == 0.0 || self.cruise_knob(mv).is_some())
                }
                // Between two stops, since nothing is known of corners.
                None => {
                    !assessment.blended
                        && assessment.ends2 == [0.0; 2]
                        && plans_lines(self.machine, &self.model)
                }
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
        if self.load_by_steps(case, mv).is_some() || assessment.loads.steps > MOST {
            return Err(NO_FIT);
        }
        let mut road = Road::new(self, case, knob, &planned);
        if self.cruise_knob(mv).is_some()
            && assessment.top_speed_mm_s < planned.speed_limit_mm_s * (1.0 - 1e-9)
        {
            // What is reached without a cruise is to be no faster than what was.
            road.hold(assessment.top_speed_mm_s);
        }
        Ok(road)
    }
}

/// The share of each hill of speed that is cruised at least.
pub(super) fn cruise_ratio(mv: &Move, rules: &LookAhead) -> f64 {
    let set = mv.corner.square();
    set.map_or(rules.min_cruise_ratio, |square| square.cruise_ratio)
}
