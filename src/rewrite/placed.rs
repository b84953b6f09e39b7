//! The way to the holes of a canned cycle, and the block that goes on from there.

use std::collections::BTreeMap;

use super::hole::Placed;
use super::single::{CycleBlock, Lines, Singles, TURNING};
use crate::edit::{Edit, apply};
use crate::interpret::{Move, MoveKind, Step};
use crate::machine::{AxisSet, AxisValues};
use crate::source::split_line_end;

impl Singles<'_> {
    /// Whether a word of a cycle holds until the cycle ends.
    #[must_use]
    pub fn holds(&self, letter: u8) -> bool {
        let language = self.language;
        b"ZRQPIJ".contains(&letter)
            || letter == b'K' && language.pecks_by_ijk
            || letter == b'H' && language.cycles_take_d_and_h
    }

    /// Whether a block has its cycle repeated.
    fn repeats(&self, of: &CycleBlock<'_>) -> bool {
        let by_k = !self.language.cycles_repeat_by_l;
        let mut words = of.block.words.iter();
        words.any(|word| (word.letter == b'L' || by_k && word.letter == b'K') && word.value != 1.0)
    }

    /// The block with its way to the hole on a line before it, and with the words of the
    /// cycle that such a line ends: `held` gives the last of each in this series of blocks.
    ///
    /// # Errors
    /// Why that cannot be.
    pub fn place_before(
        &self,
        of: &CycleBlock<'_>,
        held: &BTreeMap<u8, Vec<u8>>,
        returns_to_r: bool,
        place: impl Fn(&AxisValues) -> AxisValues,
    ) -> Result<Placed, &'static str> {
        if TURNING.contains(&of.number) || self.language.dialect.lathe.is_some() {
            return Err("all its moves follow from each other");
        }
        if !of.steps.iter().any(Step::moves_axes) {
            // It only says what the blocks after it do (K0, L0), and they say all of it again.
            let (way, block) = (Vec::new(), of.text.to_vec());
            return Ok(Placed { way, block });
        }
        let ways = ways(of.steps);
        if !of.modal.absolute || self.repeats(of) {
            return Err("its places are increments, or it repeats");
        }
        let mut lines = Lines::new(of, &place);
        let way = ways.first().map(Vec::as_slice).unwrap_or_default();
        let way = before(way, of.modal.plane);
        if way.is_empty() {
            return Err("its first move is not the way to the hole");
        }
        lines.out.extend_from_slice(distance(of));
        for mv in way {
            self.one_move(mv, of, &place, &mut lines)?;
        }
        let way = lines.take_whole();
        let level = self.lacks_level(of, returns_to_r).then_some("G99 ");
        restate(of, held, level, &mut lines)?;
        let block = lines.finish(of.text);
        Ok(Placed { way, block })
    }

    /// The block as it stays, with the words of the cycle that lines before it have ended; `None`
    /// where they cannot be written.
    #[must_use]
    pub fn restated(
        &self,
        of: &CycleBlock<'_>,
        held: &BTreeMap<u8, Vec<u8>>,
        returns_to_r: bool,
    ) -> Option<Vec<u8>> {
        // Increments would begin elsewhere.
        let increments = !of.modal.absolute;
        if increments || TURNING.contains(&of.number) || self.language.dialect.lathe.is_some() {
            return None;
        }
        let mut lines = Lines::new(of, |place| *place);
        let level = self.lacks_level(of, returns_to_r).then_some("G99 ");
        restate(of, held, level, &mut lines).ok()?;
        Some(lines.finish(of.text))
    }

    /// The block with all rapids before it, down to R too, and with that back to the level
    /// from which it began as lines of their own.
    pub(super) fn place_around(
        &self,
        of: &CycleBlock<'_>,
        held: &BTreeMap<u8, Vec<u8>>,
        returns_to_r: bool,
        place: impl Fn(&AxisValues) -> AxisValues,
    ) -> Result<Placed, &'static str> {
        const WHY: &str = "its rapids are not those before and after it";
        if TURNING.contains(&of.number) || self.language.dialect.lathe.is_some() {
            return Err("all its moves follow from each other");
        }
        let ways = ways(of.steps);
        if !of.modal.absolute {
            return Err(WHY);
        }
        let (way, back) = match ways.as_slice() {
            [way] if returns_to_r || keeps_level(way, of.modal.plane) => (way, None),
            [way, back] if !returns_to_r && back.len() == 1 => (way, back.first()),
            _ => return Err(WHY),
        };
        if way.is_empty() || self.repeats(of) {
            return Err(WHY);
        }
        let mut lines = Lines::new(of, &place);
        lines.out.extend_from_slice(distance(of));
        for mv in way {
            self.one_move(mv, of, &place, &mut lines)?;
        }
        let way = lines.take_whole();
        let back_to_r = back.is_some() || self.lacks_level(of, returns_to_r);
        restate(of, held, back_to_r.then_some("G99 "), &mut lines)?;
        if let Some(back) = back {
            lines.at = place(&back.start).map(lines.round);
            lines.out.extend_from_slice(b"G98 ");
            self.one_move(back, of, &place, &mut lines)?;
        }
        let block = lines.finish(of.text);
        Ok(Placed { way, block })
    }
}

/// The block with the words of the cycle that a line before it ends, and with the level
/// to return to.
fn restate(
    of: &CycleBlock<'_>,
    held: &BTreeMap<u8, Vec<u8>>,
    level: Option<&str>,
    lines: &mut Lines<'_>,
) -> Result<(), &'static str> {
    let has = |letter| of.block.words.iter().any(|word| word.letter == letter);
    let mut edits = Vec::new();
    let first = of.block.words.first().map_or(0, |word| word.span.start);
    if of.cycle_word.is_none() {
        edits.push(Edit::insert(
            first,
            format!("G{} ", f64::from(of.number) / 10.0),
        ));
    }
    let mut words = of.block.words.iter();
    let said = words.find(|word| word.letter == b'G' && word.value == 98.0);
    match (level, said) {
        (Some(level), Some(said)) => {
            edits.push(Edit::replace(said.span, level.trim_ascii_end()));
        }
        (Some(level), None) => edits.push(Edit::insert(first, level)),
        (None, _) => {}
    }
    for (_, word) in held.iter().filter(|(letter, _)| !has(**letter)) {
        let mut text = vec![b' '];
        text.extend_from_slice(word);
        edits.push(Edit::insert(of.block.words_end, text));
    }
    let (text, _) = split_line_end(of.text);
    if !apply(text, &mut edits, &mut lines.out) {
        return Err("its words overlap");
    }
    lines.out.extend_from_slice(lines.line_end);
    Ok(())
}

/// G90 where the block says so: what is gone before it obeys it too.
fn distance(of: &CycleBlock<'_>) -> &'static [u8] {
    let mut words = of.block.words.iter();
    let says = words.any(|word| word.letter == b'G' && word.value == 90.0);
    if says { b"G90 " } else { b"" }
}

/// The rapids before each run of other moves: those that lead to a hole, and those that lead
/// on from it.
fn ways(steps: &[Step]) -> Vec<Vec<&Move>> {
    let mut ways = vec![Vec::new()];
    let mut leads = true;
    for step in steps {
        let Step::Move(mv) = step else { continue };
        if mv.kind != MoveKind::Rapid {
            leads = false;
            continue;
        }
        if !std::mem::replace(&mut leads, true) {
            ways.push(Vec::new());
        }
        if let Some(way) = ways.last_mut() {
            way.push(mv);
        }
    }
    ways
}

/// Whether a way ends on the level on which it begins, so that the cycle returns there as well
/// where it begins at its end.
fn keeps_level(way: &[&Move], [_, _, normal]: [usize; 3]) -> bool {
    let ends = way.first().zip(way.last());
    ends.is_none_or(|(first, last)| first.start[normal] == last.end[normal])
}

/// What of a way may be gone before its block, whatever level it returns to: up to R and to
/// the hole.
fn before<'w, 'm>(way: &'w [&'m Move], plane: [usize; 3]) -> &'w [&'m Move] {
    let [first, second, normal] = plane;
    let across = AxisSet(1 << first | 1 << second);
    let in_plane = |mv: &&Move| mv.moving.0 & !across.0 == 0;
    match way {
        [to_hole, ..] if in_plane(to_hole) => &way[..1],
        [up, to_hole, ..] if up.end[normal] > up.start[normal] && in_plane(to_hole) => &way[..2],
        _ => &[],
    }
}
