//! What a strategy asks of the controller's words.

use super::Failure;
use super::split::impossible;
use crate::diagnostic::Diagnostic;
use crate::limit::{Law, LimitOptions, PresetElse, Strategy};
use crate::machine::{Knob, Machine};

/// Where there are no presets none can be missing.
const PRESET_ELSE: &str = "--preset-else goes with --strategy preset";

/// The words of a controller that no document confirms, such as `G131, G231`.
fn unconfirmed(machine: &Machine) -> String {
    let knobs = machine.controller.knobs.iter();
    let names = knobs
        .filter(|knob| !knob.verified)
        .map(|knob| knob.name.as_str());
    names.collect::<Vec<_>>().join(", ")
}

/// With `--allow unverified` the machine whose words that no document confirms are words
/// like all others, if it has any, and the note that names them.
pub(super) fn trusting(machine: &Machine, how: LimitOptions) -> Option<(Machine, Diagnostic)> {
    let unconfirmed = unconfirmed(machine);
    if !how.allowed.unverified || unconfirmed.is_empty() {
        return None;
    }
    let mut trusting = machine.clone();
    for knob in &mut trusting.controller.knobs {
        knob.verified = true;
    }
    let message = format!("--allow unverified: no document confirms {unconfirmed}");
    Some((trusting, Diagnostic::note("unverified", message)))
}

/// A strategy that needs a word which the controller lacks is refused.
pub(super) fn check_strategy(machine: &Machine, how: LimitOptions) -> Result<(), Failure> {
    let accel = machine.controller.knobs.iter().any(Knob::lowers_accel);
    let unconfirmed = unconfirmed(machine);
    let language = &machine.controller.language.name;
    let permit = if unconfirmed.is_empty() && *language != machine.controller.name {
        format!(" that `{language}` reads")
    } else if unconfirmed.is_empty() {
        String::new()
    } else {
        format!(" (--allow unverified permits {unconfirmed}, which no document confirms)")
    };
    let name = &machine.controller.name;
    check_presets(how)?;
    let unsuitable = |message: String| Err(Failure::Unsuitable(message));
    match how.strategy {
        Strategy::Accel if !accel => unsuitable(format!(
            "--strategy accel: the controller `{name}` has no word for acceleration{permit}; use speed or optimal"
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

/// What is asked of presets needs a strategy that has them.
fn check_presets(how: LimitOptions) -> Result<(), Failure> {
    let presets = how.strategy == Strategy::Preset;
    let message = if how.always && !presets && how.law != Law::Patent {
        "--always goes with --strategy preset or --law patent: the others have no value for a \
         move that fits"
    } else if how.always && how.allowed.stop {
        "--always does not go with --allow stop, which looks for what costs the least time"
    } else if how.preset_else != PresetElse::Refuse && !presets {
        PRESET_ELSE
    } else {
        return Ok(());
    };
    Err(Failure::Unsuitable(message.to_owned()))
}
