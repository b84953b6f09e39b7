//! What the written program must do: what the original does.

use super::Row;
use super::split::Line;
use crate::interpret::{Action, ActionKind, Arc, Corner, Move, MoveKind};
use crate::machine::{AxisSet, AxisValues, Machine, PathMode};
use crate::power::Assessment;

/// What the original does, in order.
#[derive(Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "moves are the common case and live in reused buffers"
)]
pub(super) enum Expected {
    Move(ExpectedMove),
    Action(Action),
    /// A row of the spindle alone, for which the program has no step; with the
    /// number of the command that it belongs to.
    Spindle(Box<Row>, u32),
}

/// A move of the original, as far as the written one must equal it. It starts
/// where the one before ends.
#[derive(Debug)]
pub(super) struct ExpectedMove {
    pub(super) line: u64,
    pub(super) text: u16,
    pub(super) kind: MoveKind,
    pub(super) end: AxisValues,
    pub(super) arc: Option<Arc>,
    pub(super) unknown_start: AxisSet,
    pub(super) path_mode: PathMode,
    pub(super) corner: Corner,
    pub(super) loads: u32,
    pub(super) dwell_s: f64,
    pub(super) axis_accel_mm_s2: AxisValues,
    /// Effective path speed and acceleration.
    pub(super) speed_mm_s: f64,
    pub(super) accel_mm_s2: f64,
    /// Its block has been changed; a rapid was written as a feed.
    pub(super) changed: bool,
    pub(super) as_feed: bool,
    /// It was given exact stop.
    pub(super) exact_stop: bool,
    /// A word was put in it that lets it end at rest.
    pub(super) stops: bool,
    /// It does not fit and could not be helped; the reason has been given.
    pub(super) hopeless: bool,
    /// The written program runs its line in pieces.
    pub(super) split: Option<Box<Line>>,
    /// Its row, where rows are wanted.
    pub(super) row: Option<Box<Row>>,
}

impl ExpectedMove {
    /// A move that must not change.
    pub(super) fn of(mv: &Move, assessment: &Assessment) -> Self {
        Self {
            speed_mm_s: assessment.speed_mm_s,
            accel_mm_s2: assessment.accel_mm_s2,
            ..Self::standing(mv)
        }
    }

    /// The same for one without speed, as a dwell.
    pub(super) fn standing(mv: &Move) -> Self {
        Self {
            line: mv.line,
            text: mv.text,
            kind: mv.kind,
            end: mv.end,
            arc: mv.arc,
            unknown_start: mv.unknown_start,
            path_mode: mv.path_mode,
            corner: mv.corner,
            loads: mv.loads,
            dwell_s: mv.dwell_s,
            axis_accel_mm_s2: mv.accel_mm_s2,
            speed_mm_s: 0.0,
            accel_mm_s2: 0.0,
            changed: false,
            as_feed: false,
            exact_stop: false,
            stops: false,
            hopeless: false,
            split: None,
            row: None,
        }
    }
}

/// What the original does: what is left of earlier pieces, and the last piece.
#[derive(Debug, Default)]
pub(super) struct Originals {
    left: Vec<Expected>,
    piece: Vec<Expected>,
}

impl Originals {
    /// Drops the first `judged`, takes the next piece, and tells how much of
    /// earlier ones is left.
    pub(super) fn refill(&mut self, judged: usize, next: &mut Vec<Expected>) -> usize {
        let old = judged.min(self.left.len());
        let new = (judged - old).min(self.piece.len());
        self.left.drain(..old);
        self.left.extend(self.piece.drain(new..));
        self.piece.clear();
        std::mem::swap(&mut self.piece, next);
        self.left.len()
    }

    pub(super) fn get(&mut self, place: usize) -> Option<&mut Expected> {
        match place.checked_sub(self.left.len()) {
            Some(place) => self.piece.get_mut(place),
            None => self.left.get_mut(place),
        }
    }
}

/// How long the dwells last that may be put in, s: the shortest one, which only makes the
/// axes stop, and what turning a knob takes for which they stand.
#[derive(Debug, Clone)]
pub(super) struct Stops {
    shortest_s: f64,
    knobs_s: Vec<f64>,
}

impl Stops {
    pub(super) fn of(machine: &Machine) -> Self {
        let knobs = machine.controller.knobs.iter();
        Self {
            shortest_s: machine.controller.language.shortest_dwell().1,
            knobs_s: knobs
                .filter(|knob| knob.output().is_some() || knob.stands() || knob.change_s > 0.0)
                .map(|knob| knob.change_s)
                .collect(),
        }
    }
}

/// Whether a move is one of these dwells that the original does not have.
pub(super) fn added_stop(mv: &Move, original: Option<&Expected>, stops: &Stops) -> bool {
    let is_stop = |kind, dwell_s: f64| {
        kind == MoveKind::Dwell && (dwell_s == stops.shortest_s || stops.knobs_s.contains(&dwell_s))
    };
    is_stop(mv.kind, mv.dwell_s)
        && !matches!(original, Some(Expected::Move(its)) if its.kind == mv.kind && its.dwell_s == mv.dwell_s)
}

/// Whether an action sets a path mode that the original does not set here: each move is
/// held against the mode that it had.
pub(super) fn added_mode(action: &Action, original: Option<&Expected>) -> bool {
    let same = matches!(original, Some(Expected::Action(original))
        if original.kind == action.kind && original.value == action.value);
    action.kind == ActionKind::PathMode && !same
}

/// What differs in two moves, if anything.
pub(super) fn different(original: &ExpectedMove, mv: &Move) -> Option<&'static str> {
    let same_kind = original.kind == mv.kind
        || original.as_feed && original.kind == MoveKind::Rapid && mv.kind == MoveKind::Feed;
    let may_stop = original.as_feed || original.exact_stop || original.stops;
    let stops = may_stop && mv.path_mode == PathMode::ExactStop;
    let message = if !same_kind {
        "another kind of move"
    } else if original.end != mv.end {
        "another end point"
    } else if original.unknown_start != mv.unknown_start {
        "another start point"
    } else if original.arc != mv.arc {
        "another arc"
    } else if original.dwell_s != mv.dwell_s {
        "another dwell"
    } else if !original.as_feed && !stops && original.corner != mv.corner && mv.moves_axes() {
        "other corners"
    } else if original.path_mode != mv.path_mode && !stops {
        "another path mode"
    } else if original.loads != mv.loads {
        "other switched loads"
    } else {
        return None;
    };
    Some(message)
}
