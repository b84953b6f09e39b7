//! Whether two programs make the same moves.

use std::collections::VecDeque;
use std::io::Cursor;

use super::rigid::TAPS;
use crate::interpret::{ActionKind, Arc, Corner, FeedMode, Move, MoveKind, Step};
use crate::machine::Machine;
use crate::pipeline::executor::Executor;
use crate::pipeline::{Failure, Options};

/// Rounding of a coordinate that is written with six decimals, in inches too, mm.
const ROUNDING_MM: f64 = 2e-5;
/// Rounding of other figures, as a share.
const ROUNDING: f64 = 1e-9;
/// The same for a feed that depends on the rounded place.
const ROUNDING_TURNED: f64 = 1e-6;

/// The line of `written` in which it first does something else than `original`; the line
/// after its last where it does less.
pub(super) fn first_difference(
    original: &[u8],
    written: &[u8],
    machine: &Machine,
    options: &Options,
) -> Result<Option<u64>, Failure> {
    let [mut own, mut other] = [original, written].map(|text| Steps {
        front: Executor::new(Cursor::new(text), machine, options),
        waiting: VecDeque::new(),
        rigid: false,
        tap: None,
        line: 0,
    });
    let (_, stop_s) = machine.controller.language.shortest_dwell();
    let is_stop = |step: &Step| matches!(step, Step::Move(mv) if mv.kind == MoveKind::Dwell && mv.dwell_s == stop_s);
    // Whether the axes stand, and whether they have to before they go on.
    let (mut stands, mut must_stand) = (false, false);
    let mut first = own.next()?;
    while let Some(step) = other.next()? {
        if is_stop(&step) && !first.as_ref().is_some_and(is_stop) {
            (stands, must_stand) = (true, false);
            continue;
        }
        let Some(original) = first.take() else {
            return Ok(Some(other.line));
        };
        match (&original, &step) {
            (Step::Move(a), Step::Move(b)) if same_move(a, b) => {
                if own.tap.zip(other.tap).is_some_and(|(a, b)| a != b) {
                    return Ok(Some(other.line));
                }
                let blends = b.moves_axes() && !same_joint(a, b);
                if blends && !(a.corner == Corner::Exact && stands) || must_stand && b.moves_axes()
                {
                    return Ok(Some(other.line));
                }
                stands = b.kind == MoveKind::Dwell;
                must_stand = blends;
            }
            (Step::Action(a), Step::Action(b)) if a.kind == b.kind && a.value == b.value => {}
            _ => return Ok(Some(other.line)),
        }
        first = own.next()?;
    }
    if first.is_some() || must_stand {
        return Ok(Some(other.line));
    }
    // Errors that come up at the end alone.
    own.front.finish()?;
    Ok(match other.front.finish() {
        Ok(_) => None,
        Err(_) => Some(other.line),
    })
}

struct Steps<'p, 'm> {
    front: Executor<'m, Cursor<&'p [u8]>>,
    waiting: VecDeque<Step>,
    /// No other motion has come since rigid tapping was announced (M29).
    rigid: bool,
    /// Whether the tap that is made is rigid.
    tap: Option<bool>,
    line: u64,
}

impl Steps<'_, '_> {
    fn next(&mut self) -> Result<Option<Step>, Failure> {
        loop {
            if let Some(step) = self.waiting.pop_front() {
                return Ok(Some(step));
            }
            let Some(line) = self.front.next_line()? else {
                return Ok(None);
            };
            self.line = line.key.1;
            let facts = &*line.facts;
            let others = || facts.motion_word.is_some() || line.steps.iter().any(Step::moves_axes);
            if facts.announces_tap {
                self.rigid = true;
            } else if !facts.cycle && others() {
                self.rigid = false;
            }
            let taps = facts.cycle && TAPS.contains(&line.interpreter.cycle());
            self.tap = taps.then_some(self.rigid);
            // The word that announces taps comes again where their ways are gone before them.
            let announces = facts.announces_tap;
            let counts = |step: &Step| match step {
                Step::Move(mv) => mv.length_mm > ROUNDING_MM || mv.kind == MoveKind::Dwell,
                // The moves themselves show them.
                Step::Action(action) => {
                    !(announces || step.is_note() || action.kind == ActionKind::PathMode)
                }
            };
            self.waiting.extend(line.steps.drain(..).filter(counts));
        }
    }
}

fn same_move(a: &Move, b: &Move) -> bool {
    let places = a.end.iter().zip(&b.end);
    a.kind == b.kind
        && places
            .into_iter()
            .all(|(a, b)| (a - b).abs() <= ROUNDING_MM)
        && a.unknown_start == b.unknown_start
        && same_arc(a.arc.as_ref(), b.arc.as_ref())
        && near(a.dwell_s, b.dwell_s)
        && (a.kind == MoveKind::Rapid || same_feed(a, b))
        && a.feed_mode == b.feed_mode
        && a.accel_mm_s2 == b.accel_mm_s2
        && a.path_accel_mm_s2 == b.path_accel_mm_s2
        && a.rapid_factor == b.rapid_factor
        && a.jerk_factor == b.jerk_factor
        && a.loads == b.loads
}

/// Under constant surface speed a feed per revolution depends on the place.
fn same_feed(a: &Move, b: &Move) -> bool {
    let share = match a.feed_mode {
        FeedMode::PerRevolution => ROUNDING_TURNED,
        _ => ROUNDING,
    };
    a.feed_mm_s == b.feed_mm_s || (a.feed_mm_s - b.feed_mm_s).abs() <= share * a.feed_mm_s
}

fn same_arc(a: Option<&Arc>, b: Option<&Arc>) -> bool {
    match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            let angle = ROUNDING_MM / a.radius_mm;
            let mut centers = a.center.iter().zip(b.center);
            a.plane == b.plane
                && centers.all(|(a, b)| (a - b).abs() <= ROUNDING_MM)
                && (a.radius_mm - b.radius_mm).abs() <= 2.0 * ROUNDING_MM
                && (a.start_angle_rad - b.start_angle_rad).abs() <= 4.0 * angle
                && (a.sweep_rad - b.sweep_rad).abs() <= 8.0 * angle
        }
        _ => false,
    }
}

/// Whether two moves end in the same way.
fn same_joint(a: &Move, b: &Move) -> bool {
    a.path_mode == b.path_mode && a.corner == b.corner
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= ROUNDING * a.abs().max(b.abs())
}
