//! G74 and G84 of mills: taps, in one stroke or in pecks (Fanuc operator's manual for machining
//! centres, "Rigid tapping": "Peck rigid tapping", "Rigid tapping with extraction override"; Haas
//! mill operator's manual, Setting 130).

use super::hole::Hole;
use crate::control::{Control, Run};
use crate::special::Turning;
use gwatt_machine::AxisValues;
use gwatt_motion::{ActionKind, MoveKind};

impl Control<'_> {
    /// Q of a tap, as it was written; it holds until the cycle ends.
    pub(super) fn tap_peck(&mut self, run: &mut Run<'_, '_>) -> Option<f64> {
        if self.rules.cycle_levels_by_m {
            return None;
        }
        self.special.held.tap_q = self.cycle_q(None, run).or(self.special.held.tap_q);
        let q = self.special.held.tap_q.filter(|q| *q != 0.0)?;
        let message = "a parameter of the control says whether a tap in pecks returns to R or by a \
                       short way: it counts as to R";
        let whole = run.whole();
        run.report.note_once("tap-pecks", message, whole);
        Some(q)
    }

    /// The strokes of a tap; false where they are too many.
    pub(super) fn iso_tap(
        &mut self,
        hole: &Hole,
        place: &mut AxisValues,
        run: &mut Run<'_, '_>,
    ) -> bool {
        let Ok(feed_mm_s) = self.tap_feed_mm_s(run) else {
            return false;
        };
        self.note_return(run);
        let into = if hole.number == 840 {
            Turning::Clockwise
        } else {
            Turning::CounterClockwise
        };
        let (mut depth_mm, mut again) = (hole.r_mm, false);
        loop {
            depth_mm = if hole.peck_mm > 0.0 {
                (depth_mm - hole.peck_mm).max(hole.bottom_mm)
            } else {
                hole.bottom_mm
            };
            if !run.within_limits() {
                return false;
            }
            // Back to the last depth it may be as fast as on the way out.
            let factor = again.then(|| self.tap_factor()).flatten();
            again = true;
            self.tap_stroke(depth_mm, [feed_mm_s, factor], place, run);
            run.spin(Turning::Stopped);
            self.iso_wait(hole, run);
            run.spin(into.reversed());
            self.tap_stroke(hole.r_mm, [feed_mm_s, self.tap_factor()], place, run);
            run.spin(into);
            if depth_mm <= hole.bottom_mm + 1e-9 {
                return true;
            }
        }
    }

    /// How many times as fast as F a tap is retracted, where that is faster.
    fn tap_factor(&self) -> Option<f64> {
        let by_word = self.tap_return_by_word();
        let factor = by_word.or(self.machine.controller.language.tap_return_factor);
        factor.filter(|factor| *factor > 1.0)
    }

    /// A stroke to a level at a speed, else that of F; axis and spindle by a factor faster.
    fn tap_stroke(
        &mut self,
        level_mm: f64,
        [base_mm_s, factor]: [Option<f64>; 2],
        place: &mut AxisValues,
        run: &mut Run<'_, '_>,
    ) {
        let normal = self.modal.plane[2];
        let length_mm = (place[normal] - level_mm).abs();
        place[normal] = level_mm;
        let rpm = self.modal.spindle_rpm;
        let asked = factor.or(base_mm_s.map(|_| 1.0));
        let feed_mm_s = asked.filter(|_| length_mm > 0.0).and_then(|factor| {
            let feed_mm_s = base_mm_s.or_else(|| {
                let linear = true;
                self.feed_speed(run, place, None, length_mm, linear)
            })?;
            Some(feed_mm_s * factor)
        });
        let faster =
            factor.filter(|_| feed_mm_s.is_some() && self.machine.spindle.is_some() && rpm > 0.0);
        self.special.speed_mm_s = feed_mm_s;
        if let Some(factor) = faster {
            run.act(ActionKind::SpindleRpm, rpm * factor);
        }
        self.part(run, MoveKind::Tap, place);
        self.special.speed_mm_s = None;
        if faster.is_some() {
            run.act(ActionKind::SpindleRpm, rpm);
        }
    }

    fn note_return(&self, run: &mut Run<'_, '_>) {
        let language = &self.machine.controller.language;
        if language.tap_return_factor.is_none() && self.tap_return_by_word().is_none() {
            let message = "the way out of a tap counts at the speed of the way in: if the control \
                           returns faster (Haas: Setting 130; Fanuc: extraction override), give \
                           tap_return_factor under [language] in the machine file";
            let whole = run.whole();
            run.report.note_once("tap-return", message, whole);
        }
    }
}
