//! Threads and taps ("Thread cutting with constant lead (G33, SF)", "Tapping
//! without compensating chuck (G331, G332)", "Tapping with compensating chuck
//! (G63)"): the axes follow the spindle, overrides do not act.

use super::Siemens;
use super::target::Target;
use crate::control::{Control, Run};
use crate::thread::FIXED;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_motion::{ActionKind, MoveKind, Step};

/// Axes that have leads: X, Y and Z with I, J and K.
const LEADS: usize = 3;

impl Control<'_> {
    /// G33 (330), G331 (3310) and G332 (3320).
    pub(super) fn siemens_thread(
        &mut self,
        number: u16,
        state: &mut Siemens,
        target: &Target,
        run: &mut Run<'_, '_>,
    ) {
        run.facts.fixed = Some(FIXED);
        run.facts.boundary = true;
        let Some(speed_mm_s) = self.lead_speed(number, state, target, run) else {
            return;
        };
        let kind = if number == 330 {
            MoveKind::Thread
        } else {
            MoveKind::Tap
        };
        self.special.speed_mm_s = Some(speed_mm_s);
        if kind == MoveKind::Tap {
            // G332 reverses it ("Reversal of the spindle direction of rotation occurs
            // automatically").
            let sign = state.tap_sign * if number == 3310 { 1.0 } else { -1.0 };
            self.tap_turns(sign * self.followed_rpm(), run);
        }
        let factor = std::mem::replace(&mut state.feed_factor, 1.0);
        self.siemens_go(state, run, kind, target, None);
        state.feed_factor = factor;
        self.special.speed_mm_s = None;
        if kind == MoveKind::Tap {
            self.tap_turns(0.0, run);
        }
    }

    /// Turns the spindle in step with the axis of a tap, at a speed with its sign; 0: the tap is
    /// over.
    pub(super) fn tap_turns(&self, rpm: f64, run: &mut Run<'_, '_>) {
        self.note_spindle(run);
        if self.machine.spindle.is_some() {
            run.act(ActionKind::TapSpeed, rpm);
        }
    }

    /// The path's speed, mm/s: the lead counts along its own axis. A lead of a
    /// tap below 0 is a left-hand thread; G332 has that of G331.
    fn lead_speed(
        &self,
        number: u16,
        state: &mut Siemens,
        target: &Target,
        run: &mut Run<'_, '_>,
    ) -> Option<f64> {
        let whole = run.whole();
        let mut leads = [b'I', b'J', b'K'].map(|letter| run.words.take(letter));
        if number == 3320 && leads == [None; LEADS] {
            leads = state.tap_lead;
        }
        if number == 3310 {
            state.tap_lead = leads;
        }
        let mut given = leads
            .iter()
            .enumerate()
            .filter_map(|(axis, lead)| Some((axis, (*lead)?)));
        let (Some((axis, lead)), None) = (given.next(), given.next()) else {
            run.report
                .error("thread-pitch", "a thread needs one lead", whole)
                .help("write I, J or K for the axis X, Y or Z: the way in one revolution");
            return None;
        };
        state.tap_sign = lead.signum();
        let lead_mm = lead.abs() * self.modal.mm_per_unit;
        let here = state.program_place(&self.position.at);
        let way = |axis: usize| target.program[axis] - here[axis];
        let length_mm = (0..LEADS)
            .map(|axis| way(axis) * way(axis))
            .sum::<f64>()
            .sqrt();
        let share = length_mm / way(axis).abs();
        if !(lead_mm > 0.0 && lead_mm < 1e6 && share.is_finite()) {
            // 0/0 too: a block that goes nowhere has no speed.
            if length_mm == 0.0 && lead_mm > 0.0 && lead_mm < 1e6 {
                return Some(lead_mm);
            }
            run.report
                .error(
                    "thread-pitch",
                    "the lead is not one of an axis that moves",
                    whole,
                )
                .help("write I for X, J for Y, K for Z, greater than 0");
            return None;
        }
        if self.followed_rpm() <= 0.0 {
            run.report
                .error(
                    "no-spindle-speed",
                    "a thread, but no spindle speed is in force",
                    whole,
                )
                .help("write S before it");
            return None;
        }
        Some(lead_mm * share * self.followed_rpm() / SECONDS_PER_MINUTE)
    }

    /// G63, for its block only: F is the speed of the tap.
    pub(super) fn floating_tap(
        &mut self,
        state: &mut Siemens,
        target: &Target,
        run: &mut Run<'_, '_>,
    ) {
        run.facts.fixed = Some(FIXED);
        run.facts.boundary = true;
        let factor = std::mem::replace(&mut state.feed_factor, 1.0);
        let before = run.steps.len();
        self.siemens_go(state, run, MoveKind::Feed, target, None);
        state.feed_factor = factor;
        for step in run.steps.iter_mut().skip(before) {
            if let Step::Move(mv) = step {
                mv.kind = MoveKind::Tap;
            }
        }
    }
}
