//! Blocks before any motion word of a program.

use super::control::{Control, Run};
use gwatt_machine::{PathMode, PowerOnMotion, RapidJoint};

impl Control<'_> {
    /// Whether a block that comes before any motion word counts as a rapid, which is reported; if
    /// not, it is refused.
    pub(super) fn goes_before_any_word(&self, run: &mut Run<'_, '_>) -> bool {
        let span = run.whole();
        let rule = "no-motion-word";
        if self.is_bounded_by_a_rapid() {
            let message = "no motion word yet: which one is in force then, a setting of the control \
                           says (`power_on_motion` under [language]); taken for G0, the fastest";
            run.report.note_once(rule, message, span);
            run.facts.no_motion_word = true;
            return true;
        }
        let message = "axis words without a motion word in force";
        run.report
            .error(rule, message, span)
            .help("write G0, G1, G2 or G3 in this block or before");
        false
    }

    /// Whether a block before any motion word draws no more than a rapid: with G1 it has no F, or is
    /// blended no otherwise and accelerates no harder.
    fn is_bounded_by_a_rapid(&self) -> bool {
        let (controller, knobs) = (&self.machine.controller, &self.knobs);
        let blends_alike = controller.planner.rapid_joint == RapidJoint::All
            || self.modal.path_mode == PathMode::ExactStop;
        let as_hard = knobs.feed_accel_mm_s2 == knobs.rapid_accel_mm_s2;
        controller.language.power_on_motion == PowerOnMotion::Unknown
            && (self.modal.feed.is_none() || blends_alike && as_hard && knobs.rapid_factor >= 1.0)
    }
}
