//! Turning cycles about a contour that stands in the program: its blocks where the cycle no
//! longer reads them, and the finishing cycle, which follows them, written out.

use super::number::{decimal, rounded, with_blanks};
use super::single::{CycleBlock, Lines, Singles};
use crate::edit::{Edit, apply};
use crate::interpret::{Motion, MoveKind, Step};
use crate::machine::{ALL_AXES, AxisValues};
use crate::source::split_line_end;
use crate::syntax::{Block, scan_line};

/// A line of a contour that no cycle reads any more: a comment. `None` where it says nothing.
#[must_use]
pub fn contour_as_comment(line: &[u8]) -> Option<Vec<u8>> {
    let mut block = Block::default();
    scan_line(line, false, &mut block);
    if block.words.is_empty() && block.number.is_none() && block.issues.is_empty() {
        return None;
    }
    let (text, line_end) = split_line_end(line);
    let mut out = vec![b'('];
    out.extend(text.trim_ascii().iter().map(|byte| match byte {
        b'(' => b'[',
        b')' => b']',
        other => *other,
    }));
    out.push(b')');
    out.extend_from_slice(line_end);
    Some(out)
}

impl Singles<'_> {
    /// The lines that do what a finishing cycle does: those of its contour, and the way
    /// back; `place` gives a place of the machine in coordinates and units of the program.
    ///
    /// # Errors
    /// Why it cannot be said in single blocks.
    pub fn write_finish<'c>(
        &self,
        of: &CycleBlock<'_>,
        contour: impl Iterator<Item = &'c [u8]>,
        place: impl Fn(&AxisValues) -> AxisValues,
    ) -> Result<Vec<u8>, &'static str> {
        let mut lines = Lines::new(of, &place);
        self.first_line(of, &mut lines)?;
        let mut compensated = false;
        for line in contour {
            lines.out.extend(without_number(line, &mut compensated)?);
            lines.out.extend_from_slice(lines.line_end);
        }
        let back = of.steps.iter().rev().find_map(|step| match step {
            Step::Move(mv) if mv.kind == MoveKind::Rapid => Some(mv),
            _ => None,
        });
        let back = back.ok_or("it does not come back to where it began")?;
        // G40 stands before the next move: the way back ends where the cycle began.
        let mut words = String::from(if compensated { "G0 G40" } else { "G0" });
        for axis in ALL_AXES {
            let index = axis as usize;
            if back.moving.contains(index) {
                let [from, to] = [&back.start, &back.end].map(|at| rounded(place(at)[index]));
                let value = if of.modal.absolute {
                    to
                } else {
                    rounded(to - from)
                };
                words.push(' ');
                words.push(char::from(axis.letter()));
                words.push_str(&decimal(value, true));
            }
        }
        lines.push(&words);
        match of.modal.motion {
            Motion::Rapid => {}
            Motion::Linear => lines.push("G1"),
            _ => return Err("the motion word before it is neither G0 nor G1"),
        }
        Ok(lines.finish(of.text))
    }
}

/// A line of a contour without its N word, and without its line end; `compensated`: the nose
/// radius is compensated after it.
fn without_number(line: &[u8], compensated: &mut bool) -> Result<Vec<u8>, &'static str> {
    let mut block = Block::default();
    scan_line(line, false, &mut block);
    let (text, _) = split_line_end(line);
    if !block.issues.is_empty() {
        return Err("its contour is worked out by the program");
    }
    for word in block.words.iter().filter(|word| word.letter == b'G') {
        match word.value {
            40.0 => *compensated = false,
            41.0 | 42.0 => *compensated = true,
            _ => {}
        }
    }
    let mut edits = Vec::new();
    if let Some(number) = block.number {
        edits.push(Edit::replace(with_blanks(text, number.span), ""));
    }
    let mut out = Vec::with_capacity(text.len());
    if !apply(text, &mut edits, &mut out) {
        return Err("its words overlap");
    }
    Ok(out.trim_ascii().to_vec())
}
