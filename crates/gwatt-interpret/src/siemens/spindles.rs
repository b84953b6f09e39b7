//! The speeds of several spindles, and which of them feeds per revolution and threads follow
//! ("Spindle speed (S), spindle direction of rotation (M3, M4, M5)", "SETMS").

use super::Siemens;
use super::code::Code;
use super::spindle_speeds::{FIRST, Said};
use crate::code::GCode;
use crate::control::{Control, Run};
use crate::letters::bit;

/// G25 (number × 10).
const LEAST: u16 = 250;

impl Control<'_> {
    /// S and SETMS; before S is read.
    pub(super) fn spindles(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        let mut said = std::mem::take(&mut state.extra.spindles);
        let dwells = run.words.groups & GCode::Dwell.group() != 0;
        if dwells {
            // Revolutions to wait for.
            said.speeds.clear();
        }
        Self::speed_limits(state, &mut said, run);
        let first = said.speeds.iter().any(|(number, _)| *number == FIRST);
        let word = run.words.word(b'S', run.block);
        let speed = word.filter(|_| run.words.unused & bit(b'S') != 0);
        let speed = speed.map(|word| word.value.abs());
        let plain = if state.surface_speed {
            // S is a cutting speed, and the spindle is taken at its limit.
            state.spindle_limit
        } else {
            speed.filter(|_| !first && !dwells)
        };
        state.spindles.take(&said, plain);
        let followed = state.spindles.followed();
        self.spindle.followed_rpm = followed.filter(|_| !state.surface_speed);
    }

    /// "Programmable spindle speed limitation (G25, G26)": S is a limit there. That of G25 may
    /// raise a speed; one that G26 lowers counts as it is programmed.
    fn speed_limits(state: &mut Siemens, said: &mut Said, run: &mut Run<'_, '_>) {
        let limits = |(code, number, _): &(GCode, u16, _)| {
            (*code == GCode::Siemens(Code::Limits)).then_some(*number)
        };
        let Some(number) = run.words.g.iter().find_map(limits) else {
            return;
        };
        let own = run.words.take(b'S').map(f64::abs);
        let others = said.speeds.drain(..).map(|(_, limit)| limit);
        if number == LEAST {
            let spindles = &mut state.spindles;
            spindles.least_rpm = others.chain(own).fold(spindles.least_rpm, f64::max);
        }
    }

    /// The speed that G25 permits at least; after S is read.
    pub(super) fn raise_speed(&mut self, state: &Siemens) {
        self.modal.spindle_rpm = state.spindles.limited(self.modal.spindle_rpm);
    }

    /// The speed that threads and taps follow, 1/min.
    pub(super) fn followed_rpm(&self) -> f64 {
        self.spindle.followed_rpm.unwrap_or(self.modal.spindle_rpm)
    }
}
