//! How idle moves are judged.

use super::IDLE_LINES;
use crate::assess::Assessor;
use crate::assessment::Assessment;
use crate::pending::{Pending, Successor};
use gwatt_motion::Move;

impl Assessor<'_> {
    /// Takes the end of a line whose steps have been taken; `moved`: some axis moves
    /// in it, or it only turns a knob. After some thousands of lines in a row that move none, what waits is
    /// passed on with the robust bound, and what follows begins in doubt.
    #[inline]
    pub fn end_line(&mut self, moved: bool, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        for lower in &mut self.lower {
            lower.end_line_lower(moved);
        }
        if moved {
            self.idle.lines = 0;
            return;
        }
        self.line.close();
        self.idle.lines += 1;
        if self.idle.lines == IDLE_LINES {
            self.run_dry(sink);
        }
    }

    #[cold]
    #[inline(never)]
    fn run_dry(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        let Some(bus) = self.bus.take() else {
            return self.run_axes_dry(sink);
        };
        let bus = self.judge_with_spindle(bus, sink, |axes, mut sink| {
            axes.run_axes_dry(&mut sink);
        });
        self.bus = Some(bus);
    }

    fn run_axes_dry(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        if let Some(ahead) = &mut self.ahead {
            ahead.run_dry(self.machine, &self.model, &mut self.observer);
            ahead.emit(self.machine, &self.model, &mut self.observer, sink);
        }
        self.bound_line(sink);
        self.idle.in_doubt |= self.held.is_some();
        self.release(Successor::Doubt, sink);
    }

    /// The move without modelled rules that the next one may be blended with.
    pub(crate) fn last_held(&self) -> Option<&Pending> {
        let before = self.before.as_deref().filter(|_| self.idle.in_doubt);
        self.held.as_deref().or(before)
    }
}
