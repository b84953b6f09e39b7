//! G74 and G84 of mills: taps, in one stroke or in pecks (Fanuc operator's manual for machining
//! centres, "Rigid tapping": "Peck rigid tapping", "Rigid tapping with extraction override"; Haas
//! mill operator's manual, Setting 130).

use super::iso::Hole;
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
        let message = "whether a tap in pecks goes back to R or by a parameter, that parameter says: \
                       it counts as back to R, which takes longer";
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
        let normal = self.modal.plane[2];
        let into = if hole.number == 840 {
            Turning::Clockwise
        } else {
            Turning::CounterClockwise
        };
        let mut depth_mm = hole.r_mm;
        loop {
            depth_mm = if hole.peck_mm > 0.0 {
                (depth_mm - hole.peck_mm).max(hole.bottom_mm)
            } else {
                hole.bottom_mm
            };
            if !run.within_limits() {
                return false;
            }
            place[normal] = depth_mm;
            self.part(run, MoveKind::Tap, place);
            run.spin(Turning::Stopped);
            self.iso_wait(hole, run);
            self.tap_return(into.reversed(), hole.r_mm, place, run);
            run.spin(into);
            if depth_mm <= hole.bottom_mm + 1e-9 {
                return true;
            }
        }
    }

    /// The way out of a tap, with the spindle turned back: as fast as the machine file says.
    fn tap_return(
        &mut self,
        back: Turning,
        r_mm: f64,
        place: &mut AxisValues,
        run: &mut Run<'_, '_>,
    ) {
        let from = *place;
        place[self.modal.plane[2]] = r_mm;
        let factor = self.machine.controller.language.tap_return_factor;
        let rpm = self.modal.spindle_rpm;
        let faster = factor.filter(|factor| *factor > 1.0 && from != *place);
        let feed_mm_s = faster.and_then(|_| {
            let length_mm = (from[self.modal.plane[2]] - r_mm).abs();
            self.feed_speed(run, place, None, length_mm, true)
        });
        let turns = self.machine.spindle.is_some() && rpm > 0.0;
        if let (Some(factor), Some(feed_mm_s)) = (faster, feed_mm_s) {
            self.special.speed_mm_s = Some(feed_mm_s * factor);
            if turns {
                run.act(ActionKind::SpindleRpm, rpm * factor);
            }
        }
        run.spin(back);
        self.part(run, MoveKind::Tap, place);
        if self.special.speed_mm_s.take().is_some() && turns {
            run.act(ActionKind::SpindleRpm, rpm);
        }
        if factor.is_none() {
            let message = "the way out of a tap counts at the speed of the way in: where the control \
                           returns faster (Haas: Setting 130; Fanuc: extraction override), \
                           tap_return_factor under [language] of the machine file says how much";
            let whole = run.whole();
            run.report.note_once("tap-return", message, whole);
        }
    }
}
