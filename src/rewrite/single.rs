//! A canned cycle written out: its moves as single blocks, in the words of the language.
//!
//! Input: the cycle's block and what it does, with places in the coordinates and units of
//! the program. Output: lines that do the same without the cycle. What cannot be said in
//! single blocks is refused with the reason; whether the lines do the same is checked by
//! the pipeline, which reads them again.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use super::hole::Placed;
use super::number::{decimal, rounded, rounded_finely, with_blanks};
use crate::edit::{Edit, apply};
use crate::interpret::{
    Action, ActionKind, Arc, Corner, FeedMode, Modal, Motion, Move, MoveKind, Step,
};
use crate::machine::{ALL_AXES, AXES, AxisSet, AxisValues, Language, Lathe, Machine};
use crate::source::{Span, split_line_end};
use crate::syntax::{Block, Word};
use crate::units::SECONDS_PER_MINUTE;

/// Cycles of plain moves, times ten: drilling, pecking, counterboring and boring.
const PLAIN: [u16; 7] = [730, 810, 820, 830, 850, 860, 890];
/// Turning cycles along a contour of `LinuxCNC`, times ten.
pub(super) const TURNING: std::ops::RangeInclusive<u16> = 700..=722;
/// Drilling and boring along X of Fanuc's lathes, times ten; along Z they have the numbers of
/// milling machines.
const ACROSS: [u16; 2] = [870, 890];
/// Those whose way out is a feed of its own.
const OUT_FASTER: [u16; 2] = [850, 890];
/// Those of Fanuc's lathes, times ten: roughing, grooving, and cycles of four moves, which
/// are G90 and G94 in system A.
const LATHE: [u16; 7] = [710, 720, 730, 740, 750, BOX, FACE];
const BOX: u16 = 770;
const FACE: u16 = 790;
/// Words that belong to a cycle alone.
const CYCLE_LETTERS: &[u8] = b"XYZABCUVWIJKRQPLDE@^";

/// A block of a canned cycle.
#[derive(Debug, Clone, Copy)]
pub struct CycleBlock<'a> {
    /// The line, line end included.
    pub text: &'a [u8],
    /// Its words.
    pub block: &'a Block,
    /// The word of the cycle, if it stands in this block.
    pub cycle_word: Option<Span>,
    /// Number of the cycle, times ten.
    pub number: u16,
    /// What it does.
    pub steps: &'a [Step],
    /// The state after it.
    pub modal: &'a Modal,
    /// The motion word before the cycle, which its end puts in force again.
    pub motion_before: Motion,
}

/// Writes blocks of cycles out.
#[derive(Debug, Clone)]
pub struct Singles<'m> {
    pub(super) language: &'m Language,
    /// The block at which the axes stop, where there is one.
    stop: Option<String>,
}

/// What has been written of a block so far.
pub(super) struct Lines<'a> {
    /// How coordinates are rounded.
    pub(super) round: fn(f64) -> f64,
    pub(super) out: Vec<u8>,
    pub(super) line_end: &'a [u8],
    pub(super) at: AxisValues,
    /// The last motion word that was written.
    pub(super) motion: Option<Motion>,
    /// The last line is a dwell.
    stopped: bool,
    /// The feed in force, mm/s, as soon as one is known.
    pub(super) feed_mm_s: Option<f64>,
}

impl<'m> Singles<'m> {
    /// For programs that run on this machine.
    #[must_use]
    pub fn new(machine: &'m Machine) -> Self {
        let controller = &machine.controller;
        let stop = || controller.language.shortest_dwell().0;
        Self {
            language: &controller.language,
            stop: controller.planner.dwell_stops.then(stop),
        }
    }

    /// Whether the motion word before a canned cycle is in force again after it, as on a Fanuc.
    #[must_use]
    pub fn motion_survives_cycles(&self) -> bool {
        self.language.family.facts().motion_survives_cycles
    }

    /// The lines that do what a block of a canned cycle does; `place` gives a place of the
    /// machine in coordinates and units of the program. Of a tap these are the positioning
    /// moves before and after it; `held` and `returns_to_r` as in [`Self::place_before`].
    ///
    /// # Errors
    /// Why it cannot be said in single blocks.
    pub fn write_out(
        &self,
        of: &CycleBlock<'_>,
        held: &BTreeMap<u8, Vec<u8>>,
        returns_to_r: bool,
        place: impl Fn(&AxisValues) -> AxisValues,
    ) -> Result<Placed, &'static str> {
        if let Err(why) = self.may_write_out(of.number) {
            let around = self.place_around(of, held, returns_to_r, place);
            return around.map_err(|_| why);
        }
        let lathe = self.language.dialect.lathe.is_some();
        if lathe && OUT_FASTER.contains(&of.number) && of.modal.feed_mode != FeedMode::PerMinute {
            return Err("its way out is faster than its F, which is per revolution");
        }
        let mut lines = Lines::new(of, &place);
        let feed_mm_s = lines.feed_mm_s;
        self.first_line(of, &mut lines)?;
        let mut moved = false;
        for step in of.steps {
            match step {
                Step::Move(mv) => {
                    moved = true;
                    self.one_move(mv, of, &place, &mut lines)?;
                }
                // What stands before the moves is said by the words of the first line.
                Step::Action(_) if !moved => {}
                Step::Action(action) => one_action(action, &mut lines)?,
            }
        }
        if let (Some(feed), true) = (&of.modal.feed, lines.feed_mm_s != feed_mm_s) {
            lines.push(&format!("F{}", decimal(feed.value, true)));
        }
        self.restore_motion(of, &mut lines)?;
        let (way, block) = (Vec::new(), lines.finish(of.text));
        Ok(Placed { way, block })
    }

    /// Whether the moves of a cycle may stand as single blocks.
    fn may_write_out(&self, number: u16) -> Result<(), &'static str> {
        let lathe = self.language.dialect.lathe.is_some();
        let by_hand = self.language.dialect.holes_along_z && matches!(number, 870 | 880);
        match number {
            _ if by_hand => Err("it stops the spindle, or waits for the operator"),
            _ if lathe && (LATHE.contains(&number) || ACROSS.contains(&number)) => Ok(()),
            _ if PLAIN.contains(&number) || TURNING.contains(&number) => Ok(()),
            740 | 840..=849 => Err("it taps"),
            760 | 870 => Err("it turns the spindle to one angle and moves aside from the wall"),
            _ => Err("it stops the spindle, or waits for the operator"),
        }
    }

    /// Puts the motion word in force that holds after the cycle.
    fn restore_motion(
        &self,
        of: &CycleBlock<'_>,
        lines: &mut Lines<'_>,
    ) -> Result<(), &'static str> {
        let lathe = self.language.dialect.lathe.is_some();
        let after = match of.modal.motion {
            // The next block that moves has a motion word of the same group.
            Motion::Special(_) if lathe => return Ok(()),
            // The end of the cycle puts no motion word of another group back.
            Motion::Special(_) if self.motion_survives_cycles() => of.motion_before,
            Motion::Special(_) => return Ok(()),
            other => other,
        };
        if lines.motion.is_none() || lines.motion == Some(after) {
            return Ok(());
        }
        match after {
            Motion::Rapid => lines.push("G0"),
            Motion::Linear => lines.push("G1"),
            Motion::None if self.language.family.facts().g80_stays => lines.push("G80"),
            Motion::None => {}
            _ => return Err("an arc's motion word is in force again after it"),
        }
        Ok(())
    }

    /// Whether G99 is the level of cycles; on lathes it is the feed per revolution.
    fn level_by_g99(&self) -> bool {
        self.language.family.facts().level_by_g99 && self.language.dialect.lathe.is_none()
    }

    /// Whether a block returns to R only because an earlier block says so.
    pub(super) fn lacks_level(&self, of: &CycleBlock<'_>, returns_to_r: bool) -> bool {
        let says = |word: &Word| word.letter == b'G' && [98.0, 99.0].contains(&word.value);
        self.level_by_g99() && returns_to_r && !of.block.words.iter().any(says)
    }

    /// The block with the word for the level to which it returns, where that is R and only
    /// an earlier block of a cycle says so.
    #[must_use]
    pub fn with_level(&self, of: &CycleBlock<'_>, returns_to_r: bool) -> Option<Vec<u8>> {
        if !self.lacks_level(of, returns_to_r) {
            return None;
        }
        let at = of.cycle_word?.start;
        let mut out = Vec::with_capacity(of.text.len() + 4);
        apply(of.text, &mut [Edit::insert(at, "G99 ")], &mut out).then_some(out)
    }

    /// The block without the words of the cycle, and a comment that names it.
    pub(super) fn first_line(
        &self,
        of: &CycleBlock<'_>,
        lines: &mut Lines<'_>,
    ) -> Result<(), &'static str> {
        let (text, _) = split_line_end(of.text);
        let mut edits: Vec<Edit> = Vec::new();
        let by_g99 = self.level_by_g99();
        for word in &of.block.words {
            // G99 stands in the block of a cycle alone.
            let returns = by_g99 && word.letter == b'G' && word.value == 99.0;
            let own = CYCLE_LETTERS.contains(&word.letter)
                || returns
                || of.cycle_word.is_some_and(|cycle| cycle == word.span);
            if own {
                edits.push(Edit::replace(with_blanks(text, word.span), ""));
            }
        }
        let mut rest = Vec::with_capacity(text.len());
        if !apply(text, &mut edits, &mut rest) {
            return Err("its words overlap");
        }
        lines.out.extend_from_slice(rest.trim_ascii());
        if lines
            .out
            .last()
            .is_some_and(|byte| !byte.is_ascii_whitespace())
        {
            lines.out.push(b' ');
        }
        let name = f64::from(self.name(of.number)) / 10.0;
        lines.push(&format!("(G{name} written out)"));
        Ok(())
    }

    /// The number of a cycle as programs have it, times ten.
    fn name(&self, number: u16) -> u16 {
        match number {
            BOX if self.language.dialect.lathe == Some(Lathe::A) => 900,
            FACE if self.language.dialect.lathe == Some(Lathe::A) => 940,
            _ => number,
        }
    }

    /// Which axes a way across says though they stand: those of the block, which say the place of
    /// a hole wherever the one before it is, since that may be skipped.
    fn says_place(
        &self,
        mv: &Move,
        of: &CycleBlock<'_>,
        from: &AxisValues,
        to: &AxisValues,
    ) -> AxisSet {
        let [first, second, _] = of.modal.plane;
        let milling = self.language.dialect.lathe.is_none();
        let rapid = milling && mv.kind == MoveKind::Rapid && of.modal.absolute;
        let across = rapid && [first, second].iter().any(|axis| from[*axis] != to[*axis]);
        let mut said = AxisSet::default();
        for axis in ALL_AXES.into_iter().filter(|_| across) {
            let index = axis as usize;
            let mut words = of.block.words.iter();
            let named = words.any(|word| word.letter == axis.letter());
            if named && [first, second].contains(&index) {
                said.insert(index);
            }
        }
        said
    }

    pub(super) fn one_move(
        &self,
        mv: &Move,
        of: &CycleBlock<'_>,
        place: &impl Fn(&AxisValues) -> AxisValues,
        lines: &mut Lines<'_>,
    ) -> Result<(), &'static str> {
        if !mv.unknown_start.is_empty() {
            return Err("it starts from a place that is not known");
        }
        // A cycle may follow its path exactly where the program does not: the move stands
        // between two stops then.
        let stop = match &self.stop {
            _ if (mv.path_mode, mv.corner) == (of.modal.path_mode, of.modal.corner) => None,
            Some(stop) if mv.corner == Corner::Exact => Some(stop.as_str()),
            _ => return Err("it runs in a path mode of its own"),
        };
        let (word, motion) = match mv.kind {
            MoveKind::Dwell => {
                let dwell = self
                    .dwell(mv.dwell_s)
                    .ok_or("no dwell is as long as its own")?;
                lines.push(&dwell);
                lines.stopped = true;
                return Ok(());
            }
            MoveKind::Rapid => ("G0", Motion::Rapid),
            MoveKind::Feed => ("G1", Motion::Linear),
            MoveKind::Arc => match &mv.arc {
                Some(arc) if arc.sweep_rad < 0.0 => ("G2", Motion::ArcCw),
                _ => ("G3", Motion::ArcCcw),
            },
            _ => return Err("not all of its moves are straight"),
        };
        let end = place(&mv.end).map(lines.round);
        let from = lines.at;
        let mut words = word.to_owned();
        let says = self.says_place(mv, of, &lines.at, &end);
        let mut moves = false;
        for axis in ALL_AXES {
            let index = axis as usize;
            let (from, to) = (lines.at[index], end[index]);
            if from == to && !says.contains(index) {
                continue;
            }
            moves |= from != to;
            let value = if of.modal.absolute {
                to
            } else {
                (lines.round)(to - from)
            };
            let letter = char::from(axis.letter());
            let _ = write!(words, " {letter}{}", decimal(value, true));
        }
        lines.at = end;
        // Written, an arc shorter than a digit would be a full circle.
        let is_short = |arc: &Arc| arc.sweep_rad.abs() < PI;
        if !moves && mv.arc.as_ref().is_none_or(is_short) {
            return Ok(());
        }
        if let Some(arc) = &mv.arc {
            words.push_str(&center_words(mv, arc, &from, of, place)?);
        }
        // On a lathe all moves of a cycle have the F in force, but for the way out of a bore.
        let lathe = self.language.dialect.lathe.is_some() && !OUT_FASTER.contains(&of.number);
        if mv.kind != MoveKind::Rapid && !lathe && lines.feed_mm_s != Some(mv.feed_mm_s) {
            let feed = mv.feed_mm_s * SECONDS_PER_MINUTE / of.modal.mm_per_unit;
            let _ = write!(words, " F{}", decimal(rounded(feed), true));
            lines.feed_mm_s = Some(mv.feed_mm_s);
        }
        lines.motion = Some(motion);
        if let Some(stop) = stop.filter(|_| !lines.stopped) {
            lines.push(stop);
        }
        lines.push(&words);
        if let Some(stop) = stop {
            lines.push(stop);
        }
        lines.stopped = stop.is_some();
        Ok(())
    }

    /// A dwell as a block; `None` where no letter says exactly this time.
    fn dwell(&self, dwell_s: f64) -> Option<String> {
        let near = |value: f64, unit_s: f64| (value * unit_s - dwell_s).abs() <= 1e-9;
        for (letter, unit_s) in &self.language.dialect.dwell_whole {
            let count = (dwell_s / unit_s).round();
            if near(count, *unit_s) {
                return Some(format!("G4 {}{count}", char::from(*letter)));
            }
        }
        let (letter, unit_s) = self.language.dwell.first()?;
        let value = rounded(dwell_s / unit_s);
        let point = self.language.family.facts().dwell_with_point;
        near(value, *unit_s).then(|| format!("G4 {}{}", char::from(*letter), decimal(value, point)))
    }
}

/// The words of an arc's centre, which count from its start as it is written.
fn center_words(
    mv: &Move,
    arc: &Arc,
    from: &AxisValues,
    of: &CycleBlock<'_>,
    place: &impl Fn(&AxisValues) -> AxisValues,
) -> Result<String, &'static str> {
    if of.modal.arc_absolute || arc.sweep_rad.abs() >= TAU {
        return Err("its arcs are full circles, or have absolute centres");
    }
    let unit_mm = of.modal.mm_per_unit;
    let mut words = String::new();
    for (axis, center) in arc.plane.into_iter().zip(arc.center) {
        let letter = b"IJK".get(axis).ok_or("its arcs lie in no plane")?;
        // A unit further is two on a diameter.
        let mut next = mv.start;
        next[axis] += unit_mm;
        let [start, next] = [place(&mv.start)[axis], place(&next)[axis]];
        let moved = (from[axis] - start) / (next - start);
        let offset = rounded((center - mv.start[axis]) / unit_mm - moved);
        let _ = write!(words, " {}{}", char::from(*letter), decimal(offset, true));
    }
    Ok(words)
}

impl<'a> Lines<'a> {
    pub(super) fn new(of: &CycleBlock<'a>, place: impl Fn(&AxisValues) -> AxisValues) -> Self {
        let (_, line_end) = split_line_end(of.text);
        let mut moves = of.steps.iter().filter_map(as_move);
        let start = moves.next().map(|mv| place(&mv.start));
        let moves = of.steps.iter().filter_map(as_move);
        let mut feeds = moves.filter(|mv| matches!(mv.kind, MoveKind::Feed | MoveKind::Arc));
        // Blocks in polar coordinates go on from the place where this one ends.
        let polar = |word: &Word| matches!(word.letter, b'@' | b'^');
        let round = if of.block.words.iter().any(polar) {
            rounded_finely
        } else {
            rounded
        };
        Self {
            round,
            out: Vec::new(),
            line_end: if line_end.is_empty() { b"\n" } else { line_end },
            at: start.unwrap_or([0.0; AXES]).map(round),
            motion: None,
            stopped: false,
            feed_mm_s: feeds.next().map(|mv| mv.feed_mm_s),
        }
    }

    /// The lines; the last one has a line end if the block `text` has one.
    pub(super) fn finish(mut self, text: &[u8]) -> Vec<u8> {
        if split_line_end(text).1.is_empty() {
            self.out.truncate(self.out.len() - self.line_end.len());
        }
        self.out
    }

    /// The lines so far; what has no end yet stays.
    pub(super) fn take_whole(&mut self) -> Vec<u8> {
        let ends = self.out.ends_with(self.line_end);
        if ends {
            std::mem::take(&mut self.out)
        } else {
            Vec::new()
        }
    }

    pub(super) fn push(&mut self, words: &str) {
        self.out.extend_from_slice(words.as_bytes());
        self.out.extend_from_slice(self.line_end);
    }
}

fn as_move(step: &Step) -> Option<&Move> {
    match step {
        Step::Move(mv) => Some(mv),
        Step::Action(_) => None,
    }
}

/// What a cycle does besides moving.
pub(super) fn one_action(action: &Action, lines: &mut Lines<'_>) -> Result<(), &'static str> {
    match action.kind {
        ActionKind::Spindle => {
            lines.push(&format!("M{}", action.value));
            Ok(())
        }
        // Said again wherever the path mode or the feed is.
        ActionKind::PathMode | ActionKind::Feed => Ok(()),
        _ => Err("it does more than move and turn the spindle"),
    }
}
