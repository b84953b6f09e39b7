//! Programs that go on for long without moving an axis.
//!
//! While the axes run, a controller may read across any number of such lines and
//! blend what comes after them; or its queue is empty before, and it stops. Nobody
//! knows which, and nobody can wait for ever.

mod judging;

use gwatt_motion::{Move, MoveKind};

/// Lines in a row that move no axis after which what waits is judged.
const IDLE_LINES: u64 = 4096;

/// How long nothing has moved.
#[derive(Debug, Default)]
pub(super) struct Idle {
    /// Lines in a row that move no axis.
    lines: u64,
    /// The move that was held last may run into the next one.
    in_doubt: bool,
}

impl Idle {
    /// A move follows.
    pub fn follow(&mut self, mv: &Move) {
        self.in_doubt &= !(mv.kind == MoveKind::Dwell || mv.moves_axes());
    }
}
