//! Whether a strategy goes with the machine.

use super::split::impossible;
use super::{Failure, LimitOptions, Strategy};
use crate::limit::Law;
use crate::machine::{KnobArgument, KnobTarget, Machine};

/// A strategy that needs a word which the controller lacks is refused.
pub(super) fn check_strategy(machine: &Machine, how: LimitOptions) -> Result<(), Failure> {
    let accel = machine.controller.knobs.iter().any(|knob| {
        knob.verified
            && knob.target != KnobTarget::RapidSpeed
            && !matches!(knob.argument, KnobArgument::Path(_))
    });
    let name = &machine.controller.name;
    let unsuitable = |message: String| Err(Failure::Unsuitable(message));
    match how.strategy {
        Strategy::Accel if !accel => unsuitable(format!(
            "--strategy accel: the controller `{name}` has no word for acceleration; use speed or optimal"
        )),
        Strategy::Preset if machine.presets.is_empty() => {
            unsuitable("--strategy preset: the machine file has no [[preset]]".to_owned())
        }
        Strategy::Preset if !accel && machine.presets.iter().any(|preset| preset.has_accel) => {
            unsuitable(format!(
                "--strategy preset: a preset limits acceleration, for which the controller `{name}` has no word"
            ))
        }
        Strategy::Preset | Strategy::Optimal | Strategy::Split if how.law == Law::Patent => {
            unsuitable("--law patent goes with --strategy speed or accel".to_owned())
        }
        Strategy::Split => match impossible(machine) {
            Some(reason) => unsuitable(format!("--strategy split: {reason}; use optimal")),
            None => Ok(()),
        },
        _ => Ok(()),
    }
}
