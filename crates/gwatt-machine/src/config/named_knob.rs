//! Knobs whose words are names, such as `ACC[X]=70`, `OVRRAP=70`, `DynOvr=0.5` and
//! `SET_VELOCITY_LIMIT ACCEL=500`.

use super::findings::Findings;
use super::value::At;
use crate::knob::{KnobArgument, KnobTarget, KnobUnit};

/// Whether a knob is one of them.
pub(super) fn is_named(text: &At<String>, argument: &KnobArgument) -> bool {
    match argument {
        KnobArgument::Index | KnobArgument::Dynamics => true,
        KnobArgument::Assign => matches!(text.value.as_str(), "DynOvr" | "OVRRAP"),
        _ => false,
    }
}

/// Whether a language reads the word as the profile says.
pub(super) fn is_read_back(
    text: &At<String>,
    argument: &KnobArgument,
    target: KnobTarget,
    unit: KnobUnit,
) -> bool {
    let read = match (text.value.as_str(), argument) {
        ("ACC", KnobArgument::Index) => Some((KnobTarget::Accel, KnobUnit::Percent)),
        ("VELOLIM", KnobArgument::Index) => Some((KnobTarget::Speed, KnobUnit::Percent)),
        ("JERKLIM", KnobArgument::Index) => Some((KnobTarget::Jerk, KnobUnit::Percent)),
        ("OVRRAP", KnobArgument::Assign) => Some((KnobTarget::RapidSpeed, KnobUnit::Percent)),
        ("#set paramAxisDynamics", KnobArgument::Dynamics) => {
            Some((KnobTarget::Jerk, KnobUnit::Percent))
        }
        ("DynOvr", KnobArgument::Assign) => Some((KnobTarget::Accel, KnobUnit::Share)),
        _ => None,
    };
    read == Some((target, unit))
}

/// Only a word that is read back may be written; `None` for others, which are reported.
pub(super) fn check(
    findings: &mut Findings<'_>,
    text: &At<String>,
    argument: &KnobArgument,
    target: KnobTarget,
    unit: KnobUnit,
) -> Option<()> {
    if is_read_back(text, argument, target, unit) {
        return Some(());
    }
    let message = format!("\"{}\" is not read back in this form", text.value);
    let help = "\"ACC\" with target = \"accel\", \"VELOLIM\" with \"speed\" or \"JERKLIM\" with \
                \"jerk\", all with argument = \"index\" and unit = \"percent\", or \"OVRRAP\" with \
                target = \"rapid-speed\", argument = \"assign\" and unit = \"percent\" \
                (SINUMERIK); \"DynOvr\" with target = \"accel\", argument = \"assign\" and unit = \
                \"share\", or \"#set paramAxisDynamics\" with target = \"jerk\", argument = \
                \"dynamics\" and unit = \"percent\" (TwinCAT NC I)";
    findings.error("machine-word", &text.span, message, Some(help.to_owned()));
    None
}

/// The same with `argument = "value"`: what Klipper's command takes.
pub(super) fn check_value(
    findings: &mut Findings<'_>,
    text: &At<String>,
    target: KnobTarget,
    unit: KnobUnit,
) -> Option<()> {
    let read = match target {
        KnobTarget::Accel => Some("SET_VELOCITY_LIMIT ACCEL="),
        KnobTarget::Speed => Some("SET_VELOCITY_LIMIT VELOCITY="),
        KnobTarget::CruiseRatio => Some("SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO="),
        KnobTarget::FeedAccel
        | KnobTarget::RapidAccel
        | KnobTarget::Jerk
        | KnobTarget::RapidSpeed
        | KnobTarget::SpeedShare => None,
    };
    if read == Some(text.value.as_str()) && unit != KnobUnit::Percent {
        return Some(());
    }
    let message = format!(
        "\"{}\" with argument = \"value\" is not read back",
        text.value
    );
    let help = "\"SET_VELOCITY_LIMIT ACCEL=\" in mm/s² with target = \"accel\", \
                \"SET_VELOCITY_LIMIT VELOCITY=\" in mm/s with target = \"speed\", or \
                \"SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=\" with target = \"cruise-ratio\"";
    findings.error("machine-word", &text.span, message, Some(help.to_owned()));
    None
}
