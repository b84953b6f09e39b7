//! The share of the speed of all moves that an analog output sets (`LinuxCNC`'s adaptive feed:
//! "M52", "M67", "M68"), where the machine file says that one is wired to it.
//!
//! M67 acts as the next move begins, M68 waits for the axes and acts at once, and neither does
//! anything unless M52 has switched it on. What follows the spindle keeps its speed.

use super::control::{Control, Run};
use super::knob::KnobState;
use gwatt_machine::{Knob, KnobTarget, Machine};
use gwatt_motion::{Move, MoveKind, Step};
use gwatt_syntax::source::Span;

impl KnobState {
    /// The share of the speed in force.
    pub(super) fn pace(&self) -> f64 {
        if self.adaptive { self.speed_share } else { 1.0 }
    }

    /// Whether moves have to be looked at for it.
    #[inline]
    pub(super) fn is_paced(&self) -> bool {
        self.adaptive || self.speed_share_next.is_some()
    }
}

impl Control<'_> {
    /// M67 or M68 of that output.
    pub(super) fn set_speed_share(
        &mut self,
        number: u16,
        value: Option<f64>,
        span: Span,
        run: &mut Run<'_, '_>,
    ) {
        let share = value.filter(|value| *value > 0.0 && *value <= 1.0);
        let Some(share) = share else {
            run.report
                .error(
                    "knob-value",
                    "the share of the speed is not from above 0 to 1",
                    span,
                )
                .help("1 is the programmed speed, and 0 holds the feed; see [outputs] of the machine file");
            return;
        };
        if self.refuses_compensated(span, run) {
            return;
        }
        if number == 670 {
            self.knobs.speed_share_next = Some(share);
        } else {
            self.knobs.speed_share = share;
            self.stand(run);
        }
    }

    /// M52, where what it turns on is known; false where it is not.
    pub(super) fn adapts(&mut self, span: Span, run: &mut Run<'_, '_>) -> bool {
        if self.speed_knob().is_none() {
            return false;
        }
        let on = run.words.take(b'P').is_none_or(|value| value != 0.0);
        run.facts.turns_knob = true;
        if !self.refuses_compensated(span, run) {
            self.switches.adaptive_feed = on;
            self.stand(run);
        }
        true
    }

    fn speed_knob(&self) -> Option<&Knob> {
        let mut knobs = self.machine.controller.knobs.iter();
        knobs.find(|knob| knob.target == KnobTarget::SpeedShare)
    }

    /// The axes stand for such a word.
    fn stand(&mut self, run: &mut Run<'_, '_>) {
        self.knobs.speed_share_last = 0.0;
        let change_s = self.speed_knob().map_or(0.0, |knob| knob.change_s);
        self.dwell(run, change_s);
    }

    /// Where moves are held back, which of them it holds for is not known.
    fn refuses_compensated(&self, span: Span, run: &mut Run<'_, '_>) -> bool {
        if self.compensation.is_none() {
            return false;
        }
        run.report
            .error(
                "knob-value",
                "the share of the speed changes under cutter compensation",
                span,
            )
            .help("set it before G41 or G42, or after G40 and the move after that");
        true
    }

    /// What outputs do to the moves of a block.
    #[inline]
    pub(super) fn let_knobs_act(&mut self, run: &mut Run<'_, '_>, before: usize) {
        self.refuse_too_early(run, before);
        self.pace_moves(run, before);
    }

    /// Gives the moves of a block the share of their speed.
    #[inline]
    fn pace_moves(&mut self, run: &mut Run<'_, '_>, before: usize) {
        // M72 may have put it back too.
        self.knobs.adaptive = self.switches.adaptive_feed;
        if !self.knobs.is_paced() {
            return;
        }
        let steps = run.steps.get_mut(before..).unwrap_or_default();
        for step in steps {
            if let Step::Move(mv) = step
                && mv.moves_axes()
            {
                if let Some(share) = self.knobs.speed_share_next.take() {
                    self.knobs.speed_share = share;
                }
                let pace = self.knobs.pace();
                let last = std::mem::replace(&mut self.knobs.speed_share_last, pace);
                // How fast it is entered is not known.
                let known = mv.unknown_start.is_empty();
                slow(self.machine, mv, if known { pace } else { pace.max(last) });
            }
        }
    }
}

/// A move at a share of its speed: the control takes it of the speed that F and the axes leave.
fn slow(machine: &Machine, mv: &mut Move, pace: f64) {
    match mv.kind {
        MoveKind::Rapid => mv.rapid_factor *= pace,
        MoveKind::Feed | MoveKind::Arc | MoveKind::Probe => {
            mv.feed_mm_s = pace * mv.feed_mm_s.min(axes_mm_s(machine, mv));
        }
        _ => return,
    }
    mv.pace = pace;
}

/// The speed that the axes permit along the path, mm/s, curvature not counted.
fn axes_mm_s(machine: &Machine, mv: &Move) -> f64 {
    if !mv.unknown_start.is_empty() {
        return f64::INFINITY;
    }
    let mut speed_mm_s = f64::INFINITY;
    for axis in mv.moving.iter() {
        let Some(data) = &machine.axes[axis] else {
            continue;
        };
        // In its plane each axis of an arc has to keep up with the whole speed there, of which
        // the path's is more in a helix.
        let arc = mv.arc.as_ref().filter(|arc| arc.plane.contains(&axis));
        let way_mm = match arc {
            Some(arc) => arc.radius_mm * arc.sweep_rad.abs(),
            None => (mv.end[axis] - mv.start[axis]).abs(),
        };
        speed_mm_s = speed_mm_s.min(data.rapid_mm_s * mv.length_mm / way_mm);
    }
    speed_mm_s
}
