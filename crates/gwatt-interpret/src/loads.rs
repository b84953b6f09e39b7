//! Which loads of the machine file (`[[load]]`) the words so far have on, a bit each.

use gwatt_motion::Step;

/// Loads that words switch on and off.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Loads {
    on: u32,
    /// They go off at the end of the line.
    off: u32,
    /// Those that were switched on after the last move: none has shown them.
    hidden: u32,
    /// Those that no dwell has shown either.
    unseen: u32,
}

impl Loads {
    /// Those that are on, as moves have them.
    #[inline]
    pub(super) fn on(self) -> u32 {
        self.on
    }

    /// Whether some are on that no move has shown.
    #[inline]
    pub(super) fn are_hidden(self) -> bool {
        self.hidden != 0
    }

    /// Whether not even a dwell has shown some that were switched on.
    pub(super) fn are_unseen(self) -> bool {
        self.unseen != 0
    }

    /// A dwell shows all that are on.
    pub(super) fn see(&mut self) {
        self.unseen = 0;
    }

    /// Switches loads on.
    pub(super) fn switch_on(&mut self, loads: u32) {
        self.hidden |= loads & !self.on;
        self.unseen |= loads & !self.on;
        self.on |= loads;
        self.off &= !loads;
    }

    /// Switches loads off, after the moves of the block, since controllers differ in when they do.
    pub(super) fn switch_off(&mut self, loads: u32) {
        self.off |= loads;
    }

    /// The end of a command that has come to these steps, or of a line: what it switches off is off,
    /// once a move has shown what that draws.
    #[inline]
    pub(super) fn settle<'s>(&mut self, steps: impl IntoIterator<Item = &'s Step>) {
        if self.off | self.hidden == 0 {
            return;
        }
        for step in steps {
            if matches!(step, Step::Move(_)) {
                self.unseen = 0;
            }
            // A dwell shows them too, but not alone: `limit` may write one before a move.
            if step.moves_axes() {
                self.hidden = 0;
            }
        }
        let off = self.off & !self.hidden;
        self.on &= !off;
        self.off &= !off;
    }
}
