//! `[outputs]` of a machine file: what is wired to the analog outputs of the control.

use schemars::JsonSchema;
use serde::Deserialize;

use super::findings::Findings;
use super::value::{At, NotNegative};
use crate::controller::Controller;
use crate::knob::{KnobArgument, KnobTarget};

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
    pub(crate) acceleration: Option<At<u16>>,
    /// The output that sets the share of the speed of all moves, from above 0 to 1 (E of M67
    /// under M52 P1). The controller profile has the HAL lines for it.
    pub(crate) speed: Option<At<u16>>,
    /// How long the axes stand for M66 after M68, and for M52, in s; default 0.03. 0.01 with
    /// `CYCLE_TIME = 0.001` under [TASK].
    pub(crate) change_s: Option<NotNegative>,
}

/// Gives the controller the words that these outputs make act.
pub(crate) fn take(
    findings: &mut Findings<'_>,
    table: &At<OutputsTable>,
    controller: &mut Controller,
) {
    let OutputsTable {
        acceleration,
        speed,
        change_s,
    } = &table.value;
    if acceleration.is_none() && speed.is_none() {
        let message = "no output is named".to_owned();
        let help = "acceleration = 0, or speed = 1: the number of the output";
        findings.error(
            "machine-missing",
            &table.span,
            message,
            Some(help.to_owned()),
        );
    }
    if let (Some(one), Some(other)) = (acceleration, speed)
        && one.value == other.value
    {
        let message = format!("analog output {} has two meanings", other.value);
        findings.error("machine-value", &other.span, message, None);
        return;
    }
    let change_s = change_s.as_ref().map_or(CHANGE_S, |seconds| seconds.value);
    let outputs = [
        (acceleration, KnobTarget::Accel, "accelerations"),
        (speed, KnobTarget::SpeedShare, "the speed"),
    ];
    for (number, target, what) in outputs {
        let Some(number) = number else { continue };
        let found = controller.wired.iter().find(|knob| knob.target == target);
        let Some(knob) = found else {
            let message = format!(
                "the controller `{}` has no word for an output that acts on {what}",
                controller.name
            );
            findings.error("machine-kind", &number.span, message, None);
            continue;
        };
        let mut knob = knob.clone();
        knob.argument = KnobArgument::Output(number.value);
        knob.change_s = change_s;
        controller.knobs.push(knob);
    }
}
