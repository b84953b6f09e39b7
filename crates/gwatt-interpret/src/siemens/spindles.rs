//! The speeds of several spindles, and which of them feeds per revolution and threads follow
//! ("Spindle speed (S), spindle direction of rotation (M3, M4, M5)", "SETMS").

use super::Siemens;
use super::code::Code;
use super::reading::Reading;
use super::spindle_speeds::{FIRST, SPINDLES_MAX, Said};
use crate::code::{GCode, Motion};
use crate::control::{Control, Run};
use crate::expression::{Grammar, Outcome};
use crate::letters::bit;
use crate::special::Turning;
use gwatt_motion::ActionKind;

/// G25 (number × 10).
const LEAST: u16 = 250;

impl Reading<'_, '_, '_> {
    /// LIMS, SETMS, SPOS, GWPSON and similar words; false for others.
    pub(super) fn spindle_word(&mut self, name: &str, start: usize) -> Outcome<bool> {
        match name {
            // "Speed limitation with constant cutting rate (LIMS)".
            "LIMS" => {
                let indexed = self.cursor.peek() == Some(b'[');
                let [number, ..] = self.index()?;
                let number = indexed.then_some(number.min(SPINDLES_MAX as usize + 1) as u32);
                let value = self.value_behind(name, start)?;
                self.extra().spindles.limits.push((number, value.abs()));
            }
            // "Constant grinding wheel peripheral speed (GWPSON, GWPSOF)".
            "GWPSON" | "GWPSOF" => {
                self.state.spindles.grinds = name == "GWPSON";
                self.pass_over()?;
            }
            "SPOS" | "SPOSA" => self.spindle_place(start)?,
            "SETMS" => self.master_spindle(start)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// "SETMS": the spindle that feeds per revolution follow; without a number that of power-on.
    fn master_spindle(&mut self, start: usize) -> Outcome<()> {
        let mut number = f64::from(Said::BACK);
        if self.cursor.take(b'(') && !self.cursor.take(b')') {
            number = self.number()?;
            self.cursor.expect(b')')?;
        }
        if !(1.0..=f64::from(SPINDLES_MAX)).contains(&number) || number.fract() != 0.0 {
            let message = format!("SETMS({number}) names no spindle");
            let help = "write its number, from 1 on";
            return Err(self.cursor.fault("syntax", message, help, start));
        }
        self.extra().spindles.master = Some(number as u32);
        Ok(())
    }

    /// "Spindle positioning (SPOS, SPOSA)": the master spindle without a number, else the one that
    /// is named; what others than the one that is counted do is not.
    fn spindle_place(&mut self, start: usize) -> Outcome<()> {
        let mut reading = self.cursor.clone();
        let named = reading.take(b'[').then(|| reading.number().ok()).flatten();
        self.pass_over()?;
        let master = f64::from(self.state.spindles.master());
        let counted = named.is_none_or(|it| it == f64::from(FIRST) || it == master);
        if !counted {
            let message = "what other spindles than the first do is not counted";
            self.note("other-spindle", message, start);
        }
        self.extra().spindles.orients |= counted;
        Ok(())
    }
}

impl Control<'_> {
    /// S and SETMS; before S is read.
    pub(super) fn spindles(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        let mut said = std::mem::take(&mut state.extra.spindles);
        state.spindles.choose(&said);
        let dwells = run.words.groups & GCode::Dwell.group() != 0;
        if dwells {
            // Revolutions to wait for.
            said.speeds.clear();
        }
        Self::speed_limits(state, &mut said, run);
        if state.spindles.grinds && run.words.unused & bit(b'S') != 0 {
            Self::refuse_wheel(run);
        }
        let first = said.speeds.iter().any(|(number, _)| *number == FIRST);
        let word = run.words.word(b'S', run.block);
        let speed = word.filter(|_| run.words.unused & bit(b'S') != 0);
        let speed = speed.map(|word| word.value.abs());
        let plain = if state.surface_speed {
            // S is a cutting speed, and the spindle is taken at its limit.
            state.spindles.limit_rpm()
        } else {
            speed.filter(|_| !first && !dwells)
        };
        state.spindles.take(&said, plain);
        let followed = state.spindles.followed();
        self.spindle.followed_rpm = followed.filter(|_| !state.surface_speed);
        if run.words.unused & bit(b'S') != 0 {
            self.leave_speed(run);
        }
        state.extra.spindles.orients = said.orients;
    }

    /// S under GWPSON: the speed of the spindle depends on the wheel's radius, which is the
    /// control's. S of G4, G25 and G26 has been taken.
    fn refuse_wheel(run: &mut Run<'_, '_>) {
        let span = run.words.span(b'S', run.block);
        let message = "S is the speed of a grinding wheel at its edge here, in m/s (GWPSON)";
        run.report
            .error("surface-speed", message, span)
            .help("write GWPSOF before it, and S in 1/min");
    }

    /// S of a block sets the speed. That of a tap may be its own alone: what was in force counts
    /// as well, where it is more.
    fn leave_speed(&mut self, run: &Run<'_, '_>) {
        let taps = |number: u16| matches!(number, 3310 | 3320);
        let in_force = matches!(self.modal.motion, Motion::Special(number) if taps(number));
        let mut motions = run.words.g.iter().filter_map(|(code, ..)| match code {
            GCode::Motion(motion) => Some(*motion),
            _ => None,
        });
        let named = motions.next_back();
        let tap = match named {
            Some(Motion::Special(number)) => taps(number),
            Some(_) => false,
            None => in_force,
        };
        let left = self.spindle.left_rpm.max(self.modal.spindle_rpm);
        self.spindle.left_rpm = if tap { left } else { 0.0 };
    }

    /// SPOS, SPOSA and M70 stop the spindle in a place, as M19 does ("Spindle positioning"); after
    /// M words.
    pub(super) fn orient(&mut self, state: &Siemens, run: &mut Run<'_, '_>) {
        let has = |wanted: u16| run.words.m.iter().any(|(number, _)| *number == wanted);
        let [turns, axis] = [190, 700].map(has);
        let orients = state.extra.spindles.orients || axis;
        if orients {
            run.act(ActionKind::Other, Turning::Stopped.other_word());
        }
        if orients || turns {
            self.special.spindle = Turning::Stopped;
        }
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
