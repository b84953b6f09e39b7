//! Steps in, judged moves out: how what a program does goes through an assessor.

use crate::interpret::{Move, Step};
use crate::power::{Assessment, Assessor, Want};

/// Takes moves once they are judged.
pub(super) trait MoveSink {
    /// What is wanted of the next move.
    fn want(&self) -> Want;

    /// Takes a move with the text of its line.
    fn take(&mut self, mv: &Move, judged: &Assessment, text: &[u8]);
}

/// Drives a step, with the text of its line.
#[inline]
pub(super) fn drive_step(
    assessor: &mut Assessor<'_>,
    step: &Step,
    text: &[u8],
    sink: &mut impl MoveSink,
) {
    assessor.want = sink.want();
    let mut take = |mv: &Move, judged: &Assessment, text: &[u8]| sink.take(mv, judged, text);
    match step {
        Step::Move(mv) => assessor.push(mv, text, &mut take),
        Step::Action(action) => assessor.act(action, &mut take),
    }
}

/// A line ends; `moved`: axes have moved in it, or it has turned a knob.
#[inline]
pub(super) fn drive_line_end(assessor: &mut Assessor<'_>, moved: bool, sink: &mut impl MoveSink) {
    assessor.want = sink.want();
    assessor.end_line(moved, &mut |mv, judged, text| sink.take(mv, judged, text));
}

/// Drives all steps of a line; `text_of` gives the text that a step belongs to.
#[inline]
pub(super) fn drive_line<'t>(
    assessor: &mut Assessor<'_>,
    steps: &[Step],
    turns_knob: bool,
    text_of: impl Fn(usize, &Step) -> &'t [u8],
    sink: &mut impl MoveSink,
) {
    for (index, step) in steps.iter().enumerate() {
        drive_step(assessor, step, text_of(index, step), sink);
    }
    let moved = turns_knob || steps.iter().any(Step::moves_axes);
    drive_line_end(assessor, moved, sink);
}

/// The program ends: what waited is judged.
pub(super) fn drive_end(assessor: &mut Assessor<'_>, sink: &mut impl MoveSink) {
    assessor.finish(&mut |mv, judged, text| sink.take(mv, judged, text));
}
