//! The speeds of several spindles, and which of them feeds per revolution and threads follow
//! ("Spindle speed (S), spindle direction of rotation (M3, M4, M5)", "SETMS").

use super::Siemens;
use super::code::Code;
use crate::code::GCode;
use crate::control::{Control, Run};
use crate::letters::bit;
use std::collections::BTreeMap;

/// The spindle that is the master at power-on, and again after SETMS without a number.
const FIRST: u32 = 1;

/// G25 (number × 10).
const LEAST: u16 = 250;

/// The highest number of a spindle.
pub(super) const SPINDLES_MAX: u32 = 99;

/// What is known of the spindles.
#[derive(Debug, Default)]
pub(super) struct Spindles {
    /// 1/min.
    speeds: BTreeMap<u32, f64>,
    /// The one of SETMS; `None`: that word has not come yet.
    master: Option<u32>,
    /// The highest limit of G25, below which no spindle turns, 1/min.
    least_rpm: f64,
}

/// What a block says of them.
#[derive(Debug, Default)]
pub(super) struct Said {
    /// `S2=3000`.
    pub(super) speeds: Vec<(u32, f64)>,
    /// `SETMS(2)`.
    pub(super) master: Option<u32>,
}

impl Said {
    /// `SETMS` without a number.
    pub(super) const BACK: u32 = FIRST;
}

impl Spindles {
    fn take(&mut self, said: &Said, plain: Option<f64>) {
        self.master = said.master.or(self.master);
        if let Some(speed) = plain {
            self.speeds.insert(self.master.unwrap_or(FIRST), speed);
        }
        let speeds = said.speeds.iter().copied();
        self.speeds
            .extend(speeds.filter(|(number, _)| *number <= SPINDLES_MAX));
    }

    /// The speed that is followed, where SETMS has said of which spindle; 0 where none is known.
    fn followed(&self) -> Option<f64> {
        let master = self.master?;
        Some(self.limited(self.speeds.get(&master).copied().unwrap_or(0.0)))
    }

    /// A speed that G25 may raise.
    fn limited(&self, speed: f64) -> f64 {
        if speed > 0.0 {
            speed.max(self.least_rpm)
        } else {
            speed
        }
    }
}

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
