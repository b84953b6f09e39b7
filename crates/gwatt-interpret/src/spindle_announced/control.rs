//! What is announced of the spindle after each block.

use crate::control::{Control, Run};
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_motion::ActionKind;

impl Control<'_> {
    /// Announces what has changed about the spindle.
    pub(crate) fn tell_spindle(&mut self, run: &mut Run<'_, '_>) {
        let Some(spindle) = &self.machine.spindle else {
            return;
        };
        let max_rpm = spindle.max_rpm;
        let mut now = self.announced;
        now.tool = self.tool_in_use();
        now.rpm = self.modal.spindle_rpm.max(self.spindle.left_rpm);
        (now.surface_mm_s, now.clamp_rpm, now.center) = (0.0, 0.0, None);
        if let Some(limit_rpm) = self.spindle.unknown_up_to_rpm {
            // Any speed up to the limit: how it follows X is not known.
            now.surface_mm_s = f64::MAX;
            now.clamp_rpm = limit_rpm.min(max_rpm);
            now.center = Some(f64::NAN.to_bits());
        } else if let Some(surface) = self.spindle.surface_mm_min {
            now.surface_mm_s = surface / SECONDS_PER_MINUTE;
            now.clamp_rpm = self.spindle.limit_rpm().min(max_rpm);
            let known = !self.bent && !self.position.unknown.contains(0);
            let center = if known {
                self.position.frame.shifted(0, 0.0)
            } else {
                f64::NAN
            };
            now.center = Some(center.to_bits());
            // Where it stands; on the way it follows X.
            now.rpm = self.highest_rpm(&self.position.at, None);
        }
        let before = std::mem::replace(&mut self.announced, now);
        if now.tool != before.tool {
            run.act(ActionKind::ToolLoaded, now.tool);
        }
        let follows = (now.surface_mm_s, now.clamp_rpm, now.center);
        if follows != (before.surface_mm_s, before.clamp_rpm, before.center) {
            if let Some(center) = now.center {
                run.act(ActionKind::SpindleClamp, now.clamp_rpm);
                run.act(ActionKind::SpindleCenter, f64::from_bits(center));
            }
            run.act(ActionKind::SurfaceSpeed, now.surface_mm_s);
        }
        if now.rpm != before.rpm {
            run.act(ActionKind::SpindleRpm, now.rpm);
        }
    }

    /// The tool that cuts: on a lathe T turns the turret at once, and its last
    /// two digits are an offset.
    fn tool_in_use(&self) -> f64 {
        let selected = self.tools.selected;
        let number = if self.dialect().lathe.is_some() {
            if selected >= 100 {
                selected / 100
            } else {
                selected
            }
        } else {
            self.tools.loaded
        };
        f64::from(number)
    }
}
