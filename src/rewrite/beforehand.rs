//! Moves in machine coordinates and returns to the reference point, with their way gone
//! before: a rapid on a line of its own leads to where the block goes, which then has
//! nothing left to move.
//!
//! Input: the block, what it does, and places in the coordinates and units of the program.
//! Output: its lines. Whether they do the same is checked by the pipeline, which reads them again.

use std::fmt::Write as _;

use super::number::{decimal, rounded, with_blanks};
use crate::edit::{Edit, apply};
use crate::interpret::{Modal, Motion, Move, MoveKind, Step, TOOL_CHANGE_UNKNOWN};
use crate::machine::{ALL_AXES, AxisId, AxisSet, AxisValues, ToolChange};
use crate::source::split_line_end;
use crate::syntax::{Block, Word};

/// Words that may give such a block another meaning than the lines before it have.
const SETTINGS: [f64; 11] = [
    20.0, 21.0, 43.0, 44.0, 52.0, 54.0, 55.0, 56.0, 57.0, 58.0, 59.0,
];
/// The word that ends the tool's length: places are those without it, in the lines before too.
const LENGTH_OFF: f64 = 49.0;

/// M words that stop or end the program once the axes stand.
const STOPS: [f64; 4] = [0.0, 1.0, 2.0, 30.0];

/// A block that moves by rapids to places of the machine.
#[derive(Debug, Clone, Copy)]
pub struct Return<'a> {
    /// The line, line end included.
    pub text: &'a [u8],
    /// Its words.
    pub block: &'a Block,
    /// What it does.
    pub steps: &'a [Step],
    /// The motion word before it.
    pub motion_before: Motion,
    /// G2 and G3 may stand on a line of their own.
    pub arcs_stand_alone: bool,
    /// Absolute coordinates before it.
    pub absolute_before: bool,
    /// The state after it.
    pub modal: &'a Modal,
    /// Its words are the place itself (G53), not a point on the way (G28).
    pub in_machine: bool,
    /// U, V and W are increments of X, Y and Z (lathes).
    pub increments: bool,
    /// When the tool changes where M6 stands in it; `None`: not known.
    pub tool_change: Option<ToolChange>,
}

fn is_tool_change(word: &Word) -> bool {
    word.letter == b'M' && word.value == 6.0
}

impl Return<'_> {
    /// The block with its way on a line before it, which is gone in coordinates of the
    /// machine (SINUMERIK).
    ///
    /// # Errors
    /// Why that cannot be.
    pub fn write_in_machine(&self, mm_per_unit: f64) -> Result<Vec<u8>, &'static str> {
        let mut moves = self.moves();
        let (Some(mv), None) = (moves.next(), moves.next()) else {
            return Err("it makes more than one move");
        };
        let after = match self.motion_before {
            Motion::Rapid => None,
            Motion::Linear => Some("G1"),
            _ => return Err("the motion word before it is neither G0 nor G1"),
        };
        if self.switching().next().is_some() {
            return Err("it switches something too");
        }
        let (_, line_end) = split_line_end(self.text);
        let line_end: &[u8] = if line_end.is_empty() { b"\n" } else { line_end };
        let mut words = String::from("SUPA G0");
        for axis in ALL_AXES {
            if commanded(mv).contains(axis as usize) {
                let value = decimal(rounded(mv.end[axis as usize] / mm_per_unit), true);
                let _ = write!(words, " {}=AC({value})", char::from(axis.letter()));
            }
        }
        let mut out = Vec::new();
        for words in [Some(words.as_str()), after].into_iter().flatten() {
            out.extend_from_slice(words.as_bytes());
            out.extend_from_slice(line_end);
        }
        out.extend_from_slice(self.text);
        Ok(out)
    }

    /// The block with its way on lines before it; `place` gives a place of the machine in
    /// coordinates and units of the program.
    ///
    /// # Errors
    /// Why that cannot be.
    pub fn write(
        &self,
        place: impl Fn(&AxisValues) -> AxisValues,
    ) -> Result<Vec<u8>, &'static str> {
        let is_setting = |word: &Word| word.letter == b'G' && SETTINGS.contains(&word.value);
        if self.block.words.iter().any(is_setting) {
            return Err("its words change what coordinates mean");
        }
        let (text, line_end) = split_line_end(self.text);
        let line_end: &[u8] = if line_end.is_empty() { b"\n" } else { line_end };
        let mut out = Vec::new();
        let mut push = |words: &str| {
            out.extend_from_slice(words.as_bytes());
            out.extend_from_slice(line_end);
        };
        if self.tool_change.is_none() && self.changes_tool() && !self.moves_of_itself() {
            return Err(TOOL_CHANGE_UNKNOWN);
        }
        let mut last = None;
        for mv in self.moves() {
            if mv.kind != MoveKind::Rapid {
                return Err("not all of its moves are rapids");
            }
            let mut words = self.way(mv, &place(&mv.end));
            if last.is_none() {
                // What is switched before the axes move.
                for word in self.switching() {
                    words.push(' ');
                    words.push_str(&String::from_utf8_lossy(word.span.of(text)));
                }
            }
            push(&words);
            last = Some(place(&mv.end));
        }
        let last = last.ok_or("it moves no axis")?;
        if !self.absolute_before {
            push("G91");
        }
        let mut edits = self.words_at(text, &last);
        if !apply(text, &mut edits, &mut out) {
            return Err("its words overlap");
        }
        match self.motion_after() {
            None => out.extend_from_slice(split_line_end(self.text).1),
            Some(word) => {
                out.extend_from_slice(line_end);
                out.extend_from_slice(word.as_bytes());
                out.extend_from_slice(split_line_end(self.text).1);
            }
        }
        Ok(out)
    }

    fn moves(&self) -> impl Iterator<Item = &Move> {
        self.steps.iter().filter_map(|step| match step {
            Step::Move(mv) if mv.moves_axes() => Some(mv),
            _ => None,
        })
    }

    /// Words that switch something before the axes move: they move to the first line.
    fn switching(&self) -> impl Iterator<Item = &Word> {
        let words = self.block.words.iter();
        let stops = |word: &Word| word.letter == b'M' && STOPS.contains(&word.value);
        let tool_last = self.changes_tool() && self.tool_change == Some(ToolChange::AfterMotion);
        let of_itself = self.moves_of_itself();
        let stays = move |word: &Word| {
            let changes = is_tool_change(word);
            changes && of_itself || tool_last && (word.letter == b'T' || changes)
        };
        let switches = |word: &Word| matches!(word.letter, b'M' | b'S' | b'T');
        words.filter(move |word| switches(word) && !stops(word) && !stays(word))
    }

    fn changes_tool(&self) -> bool {
        self.block.words.iter().any(is_tool_change)
    }

    /// Whether the change of the tool moves the axes, for which the block has no words.
    fn moves_of_itself(&self) -> bool {
        let mut words = self.block.words.iter();
        self.changes_tool() && !words.any(|word| AxisId::from_letter(word.letter).is_some())
    }

    /// A rapid to the end of a move, in absolute coordinates: where it begins may be known
    /// less surely.
    fn way(&self, mv: &Move, end: &AxisValues) -> String {
        let mut words = String::from(if self.absolute_before { "G0" } else { "G90 G0" });
        let ends_length = |word: &Word| word.letter == b'G' && word.value == LENGTH_OFF;
        if self.block.words.iter().any(ends_length) {
            words.push_str(" G49");
        }
        for axis in ALL_AXES {
            if commanded(mv).contains(axis as usize) {
                let value = decimal(rounded(end[axis as usize]), true);
                let _ = write!(words, " {}{value}", char::from(axis.letter()));
            }
        }
        words
    }

    /// The words of a point on the way become those of the place where the axes stand.
    fn words_at(&self, text: &[u8], place: &AxisValues) -> Vec<Edit> {
        let switching = self.switching();
        let gone = switching.map(|word| Edit::replace(with_blanks(text, word.span), ""));
        let mut edits: Vec<Edit> = gone.collect();
        if self.in_machine {
            return edits;
        }
        for word in &self.block.words {
            let Some(axis) = AxisId::from_letter(word.letter) else {
                continue;
            };
            let increment = self.increments && b"UVW".contains(&word.letter);
            let value = if self.modal.absolute && !increment {
                rounded(place[axis as usize])
            } else {
                0.0
            };
            if word.value != value {
                edits.push(Edit::replace(word.number, decimal(value, true)));
            }
        }
        edits
    }

    /// The motion word to put in force again after it.
    fn motion_after(&self) -> Option<&'static str> {
        let says = |word: &Word| word.letter == b'G' && (0.0..=3.0).contains(&word.value);
        if self.block.words.iter().any(says) {
            return None;
        }
        match self.motion_before {
            Motion::Linear => Some("G1"),
            Motion::ArcCw if self.arcs_stand_alone => Some("G2"),
            Motion::ArcCcw if self.arcs_stand_alone => Some("G3"),
            _ => None,
        }
    }
}

/// Axes that move, or may, as it is not known where they start.
fn commanded(mv: &Move) -> AxisSet {
    AxisSet(mv.moving.0 | mv.unknown_start.0)
}
