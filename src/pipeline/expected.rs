//! What the written program must do: what the original does.

use super::Row;
use super::split::Line;
use crate::interpret::{Action, ActionKind, Arc, Corner, FeedMode, Move, MoveKind};
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

/// What a program asks of the speed and the acceleration of a move. What the control makes of
/// it depends on the moves around it as well: whether it plans them together, and with which
/// rules for arcs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked {
    kind: MoveKind,
    feed_mode: FeedMode,
    feed_mm_s: f64,
    jerk_factor: f64,
    rapid_factor: f64,
    pace: f64,
    path_accel_mm_s2: f64,
    axis_accel_mm_s2: AxisValues,
}

impl Asked {
    pub(super) fn of(mv: &Move) -> Self {
        Self {
            kind: mv.kind,
            feed_mode: mv.feed_mode,
            feed_mm_s: mv.feed_mm_s,
            jerk_factor: mv.jerk_factor,
            rapid_factor: mv.rapid_factor,
            pace: mv.pace,
            path_accel_mm_s2: mv.path_accel_mm_s2,
            axis_accel_mm_s2: mv.accel_mm_s2,
        }
    }

    /// Whether it obeys F, and none is in force.
    pub(super) fn has_no_feed(&self) -> bool {
        self.kind == MoveKind::Feed
            && self.feed_mode == FeedMode::PerMinute
            && self.feed_mm_s == f64::INFINITY
    }

    /// Whether it is a move of the same kind, with F meant in the same way.
    fn is_like(&self, mv: &Move) -> bool {
        self.kind == mv.kind && self.feed_mode == mv.feed_mode
    }

    /// What is asked for along the path here and by a move, pair by pair.
    fn along(&self, mv: &Move) -> [(f64, f64); 5] {
        [
            (self.feed_mm_s, mv.feed_mm_s),
            (self.rapid_factor, mv.rapid_factor),
            (self.pace, mv.pace),
            (self.path_accel_mm_s2, mv.path_accel_mm_s2),
            (self.jerk_factor, mv.jerk_factor),
        ]
    }

    /// The same for each axis that moves.
    fn by_axis(&self, mv: &Move) -> impl Iterator<Item = (f64, f64)> {
        let axes = AxisSet(mv.moving.0 | mv.unknown_start.0);
        axes.iter()
            .map(|axis| (self.axis_accel_mm_s2[axis], mv.accel_mm_s2[axis]))
    }

    /// Whether a move asks for the same, to the last digit.
    pub(super) fn is_of(&self, mv: &Move) -> bool {
        let mut pairs = self.along(mv).into_iter().chain(self.by_axis(mv));
        self.is_like(mv) && pairs.all(|(before, after)| before == after)
    }

    /// Whether a move like it asks for a higher speed; `rounding` is a share.
    pub(super) fn is_faster(&self, mv: &Move, rounding: f64) -> bool {
        let [feed, rapid, pace, ..] = self.along(mv);
        let mut speeds = [feed, rapid, pace].into_iter();
        self.is_like(mv) && speeds.any(|(before, after)| after > before * (1.0 + rounding))
    }

    /// Whether a move gives an axis more acceleration or jerk; `rounding` is a share.
    pub(super) fn is_harder(&self, mv: &Move, rounding: f64) -> bool {
        let jerk = std::iter::once((self.jerk_factor, mv.jerk_factor));
        let mut limits = self.by_axis(mv).chain(jerk);
        limits.any(|(before, after)| after > before * (1.0 + rounding))
    }
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
    /// What the program asks for.
    pub(super) asked: Asked,
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
            asked: Asked::of(mv),
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
    /// Drops the first `judged`, takes the next piece, and says how much of
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
/// compared with the mode that it had.
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

#[cfg(test)]
mod tests {
    use super::Asked;
    use crate::diagnostic::Severity;
    use crate::interpret::{Diagnostics, Effects, Facts, Interpreter, Move, Reading, Step};
    use crate::machine::Machine;
    use crate::source::lines;
    use crate::syntax::{Block, scan_line};

    /// The last move of a program.
    fn last(program: &str) -> Move {
        let text = "schema = 1\nname = \"a\"\ncontroller = \"linuxcnc\"\n[converter]\n\
                    peak_power_w = 1000\n[outputs]\nspeed = 1\n\
                    [axes.X]\nrapid_mm_min = 9000\naccel_mm_s2 = 2000\nmass_kg = 100\n\
                    [axes.Y]\nrapid_mm_min = 9000\naccel_mm_s2 = 2000\nmass_kg = 100\n";
        let machine = Machine::from_toml("a.toml", text).unwrap().0;
        let mut interpreter = Interpreter::new(&machine, &Reading::default());
        let (mut block, mut steps, mut facts) = (Block::default(), Vec::new(), Facts::default());
        let mut diagnostics = Diagnostics::default();
        for (number, text) in (1..).zip(lines(program.as_bytes())) {
            scan_line(text, number == 1, &mut block);
            interpreter.execute(
                number,
                text,
                &mut block,
                Effects::new(&mut steps, &mut facts, &mut diagnostics),
            );
        }
        let mut found = diagnostics.list.iter();
        assert!(found.all(|it| it.severity != Severity::Error));
        let mut moves = steps.into_iter().rev();
        moves
            .find_map(|step| match step {
                Step::Move(mv) => Some(mv),
                Step::Action(_) => None,
            })
            .unwrap()
    }

    /// The last digit of F counts, and so do its meaning and the share of the speed; a word for
    /// the share that leaves it at 1 changes nothing.
    #[test]
    fn what_is_asked_for_is_compared_exactly() {
        let feed = last("G1 X10 F1000\n");
        let asked = Asked::of(&feed);
        let same = last("M52 P1\nM67 E1 Q1\nG1 X10 F1000\n");
        assert!(asked.is_of(&feed) && asked.is_of(&same));
        for (program, faster) in [
            ("G1 X10 F1000.01\n", true),
            ("G1 X10 F999.99\n", false),
            ("M52 P1\nM67 E1 Q0.999\nG1 X10 F1000\n", false),
            ("M52 P1\nM67 E1 Q0.5\nG1 X10 F2000\n", false),
            ("G93 G1 X10 F100\n", false),
            ("G0 X10\n", false),
        ] {
            let other = last(program);
            assert!(!asked.is_of(&other), "{program}");
            assert_eq!(asked.is_faster(&other, 1e-9), faster, "{program}");
            assert!(!asked.is_harder(&other, 1e-9), "{program}");
        }
        let mut harder = feed.clone();
        harder.accel_mm_s2[0] += 1.0;
        assert!(!asked.is_of(&harder) && asked.is_harder(&harder, 1e-9));
        // Y stands.
        let mut elsewhere = feed;
        elsewhere.accel_mm_s2[1] += 1.0;
        assert!(asked.is_of(&elsewhere));
    }
}
