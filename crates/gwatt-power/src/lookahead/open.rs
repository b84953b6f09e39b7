//! A move that waits for what is planned after it, and how moves take part.

use super::glided::Glided;
use super::pace::Pace;
use crate::assessment::Assessment;
use crate::demand::Want;
use crate::duty_cycle::Buffered;
use gwatt_machine::{AxisId, Machine, PathMode};
use gwatt_motion::{Corner, EarlyLimits, Move, MoveKind};
use gwatt_plan::is_independent;
use gwatt_plan::lookahead::Joint;

/// A move that is not passed on.
#[derive(Debug)]
pub(super) struct Open {
    pub mv: Move,
    pub text: Vec<u8>,
    pub assessment: Assessment,
    pub want: Want,
    pub certain: bool,
    /// It runs in turn, and as planned over time; else only its figures are known.
    pub in_turn: bool,
    /// The speed with which it begins is not certain.
    pub in_doubt: bool,
    /// It ends at rest whatever follows.
    pub rests: bool,
    /// Some axis moves.
    pub moves: bool,
    /// It neither begins nor ends in motion.
    pub alone: bool,
    /// It runs at one speed throughout.
    pub steady: bool,
    /// What is asked of it.
    pub pace: Pace,
    /// How it comes out where the motion glides.
    pub glided: Glided,
    /// Its pieces over time, where they are looked at.
    pub kept: Buffered,
    /// The same move under limits that may hold for it already.
    pub early: Option<Box<Move>>,
    /// It is in doubt by limits that may act early: then so large a step of speed may be permitted at
    /// its ends, mm/s, or that which it says itself.
    pub step_mm_s: Option<f64>,
}

/// How a move takes part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// It has a path that the rules speak of.
    Path,
    /// It has none, and is passed.
    Nothing,
    /// How it runs together with others is not known.
    Unknown,
}

impl Open {
    /// A move of which no piece is planned yet.
    #[cold]
    pub fn new(mv: &Move, text: &[u8], want: Want) -> Self {
        Self {
            mv: mv.clone(),
            text: text.to_vec(),
            assessment: Assessment::AHEAD,
            want,
            certain: true,
            in_turn: true,
            in_doubt: false,
            rests: false,
            moves: false,
            alone: true,
            steady: true,
            pace: Pace::default(),
            glided: Glided::default(),
            kept: Buffered::default(),
            early: None,
            step_mm_s: None,
        }
    }

    /// Limits that are higher by a factor may hold for it already. With those of speed it may be as
    /// fast as F asks.
    pub fn act_early(&mut self, limits: EarlyLimits, factor: f64) {
        let mut early = self.at_most().clone();
        let mut as_asked = |factor: f64| {
            early.feed_mm_s *= factor * std::mem::replace(&mut early.feed_excess, 1.0);
        };
        match limits {
            EarlyLimits::AxisAccel => {
                early.accel_mm_s2 = early.accel_mm_s2.map(|limit| factor * limit);
            }
            EarlyLimits::PathAccel => early.path_accel_mm_s2 *= factor,
            EarlyLimits::Speed => {
                as_asked(1.0);
                early.rapid_factor = factor * early.rapid_factor.max(1.0);
            }
            EarlyLimits::Feed => as_asked(factor),
            EarlyLimits::Filament => {
                let extruder = AxisId::E as usize;
                let way_mm = early.end[extruder] - early.start[extruder];
                early.end[extruder] = early.start[extruder] + factor * way_mm;
            }
            // Of its joints.
            EarlyLimits::Corners => {}
        }
        self.early = Some(Box::new(early));
    }

    /// The move under the highest limits that may hold for it.
    pub fn at_most(&self) -> &Move {
        self.early.as_deref().unwrap_or(&self.mv)
    }

    /// The same in place.
    #[inline]
    pub fn renew(&mut self, mv: &Move, text: &[u8], want: Want) {
        // At once, without a copy between.
        self.mv = Move { ..*mv };
        self.text.clear();
        self.text.extend_from_slice(text);
        self.assessment = Assessment::AHEAD;
        self.want = want;
        (self.certain, self.in_turn) = (true, true);
        (self.alone, self.steady) = (true, true);
        (self.in_doubt, self.rests, self.moves) = (false, false, false);
        self.kept.clear();
        (self.early, self.step_mm_s) = (None, None);
    }
}

/// How a move takes part in look-ahead.
#[must_use]
pub fn role(machine: &Machine, mv: &Move) -> Role {
    let synchronous = matches!(mv.kind, MoveKind::Thread | MoveKind::Tap | MoveKind::Probe);
    if mv.moving.is_empty() && mv.unknown_start.is_empty() {
        Role::Nothing
    } else if synchronous
        || !mv.unknown_start.is_empty()
        || mv.stray.is_far()
        || is_independent(machine, mv)
    {
        Role::Unknown
    } else {
        Role::Path
    }
}

/// What the planner may do at the end of a move.
#[must_use]
pub fn joint(mv: &Move) -> Joint {
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
        (PathMode::LookAhead, Corner::Square(_) | Corner::Steps(_) | Corner::Deviation(_)) => {
            Joint::Blend {
                tolerance_mm: 0.0,
                join_mm: 0.0,
            }
        }
    }
}
