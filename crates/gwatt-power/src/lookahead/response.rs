//! Over how long the drives of a machine spread a step of speed.

use crate::steps::Steps;
use gwatt_machine::{CornerRule, LookAhead, Machine};

/// Servo cycles over which `LinuxCNC` spreads a step: its commands pass a cubic spline.
pub(super) const SPLINE_CYCLES: f64 = 2.0;

/// The means over the response time to steps of speed.
pub(super) fn steps_of(machine: &Machine, rules: &LookAhead) -> Box<Steps> {
    let lower = machine.limits.override_at.is_none();
    let new = |response_s| Steps::new(machine.axis_set, response_s, lower);
    Box::new(match rules.corner {
        // What is a step at a joint it takes from the acceleration along the path.
        CornerRule::LinuxCnc { cycle_s, .. } => new(SPLINE_CYCLES * cycle_s).turning(),
        _ => new(machine.path.response_time_s),
    })
}
