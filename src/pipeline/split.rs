//! Blocks that are written as several of one line.
//!
//! ```text
//! block ─Limiter→ shares of the way ─here→ words of places ─Rewriter→ lines before the block
//! ```
//!
//! The block itself is the last piece, with all its own words, so that the line ends where
//! it ended. The certifier takes the pieces for one move if they lie on its line.

use super::ends::Places;
use super::entry::Entry;
use crate::diagnostic::Diagnostic;
use crate::interpret::{FeedMode, Interpreter, Move, MoveKind, Step};
use crate::limit::Split;
use crate::machine::{ALL_AXES, AXES, AxisId, AxisValues, Machine, PathMode};
use crate::rewrite::PieceWords;
use crate::source::{Span, split_line_end};
use crate::syntax::Word;

/// Decimals of a place in millimetres or degrees, and in inches: finer than any control
/// takes, so that the pieces have one direction.
const DECIMALS: f64 = 1e6;
const DECIMALS_INCH: f64 = 1e7;
/// How far a place may lie off the line for that, mm.
pub(super) const BESIDE_MM: f64 = 3e-6;
/// Why blocks stay one that the limiter has not tried to divide.
pub(super) const BLENDED: &str =
    "it may be blended with its neighbours, and how the control does that is not modelled";
pub(super) const SEVERAL_RUNS: &str =
    "the program has calls or loops, or there are several ways through it";
/// What is left of a place by rounding alone, as a share.
const ROUNDING: f64 = 1e-9;

impl Entry {
    /// Whether axes move in it, or it only turns a knob.
    pub(super) fn moves_on(&self) -> bool {
        self.facts.turns_knob || self.steps.iter().any(Step::moves_axes)
    }

    /// Keeps the places of its move; the interpreter has just executed the block.
    pub(super) fn keep_places(&mut self, interpreter: &Interpreter<'_>) {
        self.places = match self.steps.as_slice() {
            [Step::Move(mv)] => {
                let modal = interpreter.modal();
                Some(Places {
                    start: interpreter.place_in_program(&mv.start),
                    end: interpreter.place_in_program(&mv.end),
                    absolute: modal.absolute,
                    extruder_absolute: modal.extruder_absolute,
                    inch: modal.mm_per_unit != 1.0,
                })
            }
            _ => None,
        };
    }

    /// Why it may not be written as several blocks.
    pub(super) fn unsplit(&self, mv: &Move) -> Option<&'static str> {
        let facts = &self.facts;
        let Some(places) = &self.places else {
            return Some("it makes several moves, or does something else as well");
        };
        let increments =
            !places.absolute || mv.moving.contains(AxisId::E as usize) && !places.extruder_absolute;
        let checks = [
            (
                facts.kept().is_some() || facts.cycle || facts.reference.is_some(),
                "it is not a plain line",
            ),
            (
                facts.machine_coordinates,
                "it moves in machine coordinates (G53)",
            ),
            (facts.compensated, "it runs under cutter compensation"),
            (
                facts.checksum || self.block.tape || facts.boundary || facts.turns_knob,
                "it does something else as well, or carries a checksum",
            ),
            (self.block.delete_level > 0, "it may be skipped"),
            (
                self.feed_mode != FeedMode::PerMinute && mv.kind != MoveKind::Rapid,
                "its feed is not by the minute",
            ),
            (
                facts.computed_feed
                    || facts.reads_state
                    || !self
                        .block
                        .words
                        .iter()
                        .all(|word| written(word, &self.text)),
                "its values are worked out by the program",
            ),
            (
                facts.no_motion_word || !facts.uses_motion,
                "no motion word is in force",
            ),
            (increments, "its places are increments (G91, M83)"),
            (
                !self.block.words.iter().all(|word| plain(word, places)),
                "it has other words, or is not where its words say",
            ),
        ];
        let found = checks.iter().find(|(applies, _)| *applies);
        let unnamed = || {
            let mut moving = mv.moving.iter();
            let named = |axis| {
                let mut words = self.block.words.iter();
                words.any(|word| axis_of(word.letter) == Some(axis))
            };
            let all = moving.all(named);
            (!all).then_some("an axis moves that it does not name")
        };
        found.map(|(_, reason)| *reason).or_else(unnamed)
    }

    /// The pieces before the block itself, where it is written as several.
    pub(super) fn pieces(&self, machine: &Machine) -> Vec<PieceWords> {
        let split = self.split();
        let (Some(split), Some(places)) = (split, &self.places) else {
            return Vec::new();
        };
        let axes: Vec<usize> = self
            .block
            .words
            .iter()
            .filter_map(|word| axis_of(word.letter))
            .filter(|axis| places.start[*axis] != places.end[*axis])
            .collect();
        let point = machine.controller.language.dialect.point.is_some();
        let scale = if places.inch { DECIMALS_INCH } else { DECIMALS };
        let pieces = split.pieces.iter().filter(|piece| piece.share < 1.0);
        let words = pieces.map(|piece| {
            let words = axes.iter().map(|axis| {
                let (start, end) = (places.start[*axis], places.end[*axis]);
                let place = start + piece.share * (end - start);
                let mut text = ((place * scale).round() / scale + 0.0).to_string();
                if point && !text.contains('.') {
                    text.push('.');
                }
                let letter = ALL_AXES
                    .get(*axis)
                    .map_or('X', |axis| axis.letter() as char);
                format!("{letter}{text}")
            });
            PieceWords {
                place: words.collect::<Vec<_>>().join(" "),
                accel: piece.accel,
            }
        });
        words.collect()
    }

    /// The pieces of its only move.
    pub(super) fn split(&self) -> Option<&Split> {
        match self.decided.as_slice() {
            [(_, outcome)] => outcome.split.as_deref(),
            _ => None,
        }
    }
}

/// Why no block at all can be written in pieces on a machine.
pub(super) fn impossible(machine: &Machine) -> Option<String> {
    let controller = &machine.controller;
    let name = &controller.name;
    let words = controller.knobs.iter();
    let words = words.filter(|knob| knob.lowers_accel() && knob.levels.is_none());
    let acts: Vec<bool> = words.map(|knob| knob.between_moves).collect();
    if acts.is_empty() {
        return Some(format!(
            "the controller `{name}` has no word for acceleration"
        ));
    }
    if !acts.contains(&true) {
        return Some(format!(
            "the word for acceleration of the controller `{name}` is not known to act between \
             moving blocks (between_moves)"
        ));
    }
    if machine.path.mode == Some(PathMode::ExactStop) {
        return Some(
            "with path.mode = \"exact-stop\" each piece of a block would end at rest".to_owned(),
        );
    }
    None
}

/// Whether a word is the motion word, an F, or a place that the block really goes to.
fn plain(word: &Word, places: &Places) -> bool {
    match word.letter {
        b'G' => word.value == 0.0 || word.value == 1.0,
        b'F' => true,
        letter => axis_of(letter).is_some_and(|axis| {
            let end = places.end.get(axis).copied().unwrap_or(f64::NAN);
            (end - word.value).abs() <= ROUNDING * end.abs().max(1.0)
        }),
    }
}

/// Whether the value of a word is what its text says, and not worked out: from where the
/// axes are, it would be another one after the first piece.
fn written(word: &Word, text: &[u8]) -> bool {
    let number = std::str::from_utf8(word.number.of(text)).ok();
    number.and_then(|number| number.trim().parse::<f64>().ok()) == Some(word.value)
}

/// The axis of a letter.
fn axis_of(letter: u8) -> Option<usize> {
    AxisId::from_letter(letter).map(|axis| axis as usize)
}

/// A line of the original that the written program may run in pieces.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    start: AxisValues,
    /// How many pieces it has.
    pub(super) pieces: usize,
}

impl Line {
    /// The line of a move that is written in these pieces.
    pub(super) fn of(mv: &Move, split: &Split) -> Self {
        Self {
            start: mv.start,
            pieces: split.pieces.len(),
        }
    }

    /// Whether a move from one place to another runs along the line to `end`, forwards.
    pub(super) fn holds(&self, end: &AxisValues, [from, to]: [&AxisValues; 2]) -> bool {
        let way: AxisValues = std::array::from_fn(|axis| end[axis] - self.start[axis]);
        let length2: f64 = way.iter().map(|way| way * way).sum();
        let share = |place: &AxisValues| {
            let along = (0..AXES).map(|axis| (place[axis] - self.start[axis]) * way[axis]);
            along.sum::<f64>() / length2
        };
        let is_outside = |place: &AxisValues| {
            let share = share(place);
            (0..AXES).any(|axis| {
                let off = place[axis] - self.start[axis] - share * way[axis];
                off.is_nan() || off.abs() > BESIDE_MM
            })
        };
        let [first, last] = [share(from), share(to)];
        let rounding = BESIDE_MM / length2.sqrt();
        let forwards = first >= -rounding && last > first && last <= 1.0 + rounding;
        forwards && !is_outside(from) && !is_outside(to)
    }
}

/// Notes why blocks stay one, each reason once.
#[derive(Debug, Default)]
pub(super) struct Unsplit {
    pub(super) notes: Vec<Diagnostic>,
}

impl Unsplit {
    pub(super) fn stays(&mut self, mv: &Move, why: &str, text: &[u8]) {
        let message = format!("the block is not written in pieces: {why}");
        if self.notes.iter().any(|note| note.message == message) {
            return;
        }
        let span = Span::new(0, split_line_end(text).0.len());
        let note = Diagnostic::note("not-split", message).at(mv.line, span, text);
        self.notes.push(note);
    }
}

#[cfg(test)]
mod tests {
    use super::Line;
    use crate::machine::{AXES, AxisValues};

    fn place(x: f64, y: f64) -> AxisValues {
        let mut place = [0.0; AXES];
        (place[0], place[1]) = (x, y);
        place
    }

    /// A line from 10, 20 to 70, 100, of 100 mm.
    #[test]
    fn pieces_lie_on_the_line_and_run_forwards() {
        let line = Line {
            start: place(10.0, 20.0),
            pieces: 2,
        };
        let holds = |from, to| line.holds(&place(70.0, 100.0), [&from, &to]);
        let (start, end) = (place(10.0, 20.0), place(70.0, 100.0));
        assert!(holds(start, place(16.0, 28.0)));
        assert!(holds(place(16.0, 28.0), end));
        // A millionth next to it is rounding, a thousandth is not.
        assert!(holds(start, place(16.000_001, 28.0)));
        assert!(!holds(start, place(16.001, 28.0)));
        assert!(!holds(place(16.001, 28.0), end));
        // Backwards, before the start, beyond the end, on the spot.
        assert!(!holds(place(16.0, 28.0), place(13.0, 24.0)));
        assert!(!holds(place(7.0, 16.0), end));
        assert!(!holds(start, place(76.0, 108.0)));
        assert!(!holds(start, start));
        assert!(!holds(start, place(f64::NAN, 28.0)));
    }
}
