//! `[outputs]` of a machine file: what is wired to the analog outputs of the control.

use schemars::JsonSchema;
use serde::Deserialize;

use super::findings::Findings;
use super::value::{At, NotNegative};
use crate::machine::controller::Controller;
use crate::machine::knob::{KnobArgument, KnobTarget};

/// How long the axes stand for a change, s: measured with LinuxCNC's task at a cycle of
/// 10 ms, which most configurations have.
const CHANGE_S: f64 = 0.03;

/// Analog outputs of the control that act on the motion (`LinuxCNC`: what HAL connects to
/// `motion.analog-out-NN`).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OutputsTable {
    /// The output that sets the share of all axes' accelerations, from above 0 to 1 (E of
    /// M68). The controller profile has the HAL lines for it: gwatt machine show linuxcnc.
    #[schemars(required)]
    pub(crate) acceleration: Option<At<u16>>,
    /// How long the axes stand for a change, in s; default 0.03. 0.01 with `CYCLE_TIME =
    /// 0.001` under [TASK].
    pub(crate) change_s: Option<NotNegative>,
}

/// Gives the controller the words that these outputs make act.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    table: &At<OutputsTable>,
    controller: &mut Controller,
) {
    let Some(number) = &table.value.acceleration else {
        return;
    };
    let change_s = table.value.change_s.as_ref();
    let wired = controller.wired.iter();
    let mut found = wired.filter(|knob| knob.target == KnobTarget::Accel);
    let Some(knob) = found.next() else {
        let message = format!(
            "the controller `{}` has no word for an output that acts on accelerations",
            controller.name
        );
        findings.error("machine-kind", &number.span, message, None);
        return;
    };
    let mut knob = knob.clone();
    knob.argument = KnobArgument::Output(number.value);
    knob.change_s = change_s.map_or(CHANGE_S, |seconds| seconds.value);
    controller.knobs.push(knob);
}
