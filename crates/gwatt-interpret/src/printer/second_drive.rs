//! Drives that a program couples to others, which the machine file does not describe.

use super::line::Text;
use crate::control::Run;
use gwatt_syntax::source::Span;

/// A drive that a command couples to another one (Klipper documentation, "G-Codes").
pub(super) fn second_drive(text: Text<'_>, name: &[u8], at: usize) -> Option<&'static str> {
    let quote = |byte: &u8| matches!(byte, b'"' | b'\'');
    let value = |key: &str| -> Vec<u8> {
        let value = text.argument(at, key).unwrap_or_default();
        value.iter().copied().filter(|byte| !quote(byte)).collect()
    };
    let couples = |mode: &[u8]| {
        let modes: [&[u8]; 2] = [b"COPY", b"MIRROR"];
        modes.into_iter().any(|own| mode.eq_ignore_ascii_case(own))
    };
    match name {
        b"SET_DUAL_CARRIAGE" if couples(&value("MODE")) => Some(SECOND_CARRIAGE),
        b"SYNC_EXTRUDER_MOTION" => {
            let queue = value("MOTION_QUEUE");
            let other = !queue.is_empty() && queue != value("EXTRUDER");
            other.then_some("an extruder that moves with another one")
        }
        _ => None,
    }
}

/// What moves with the first carriage from here on.
pub(super) const SECOND_CARRIAGE: &str = "a second carriage that moves with the first one";

/// Refuses what lets a drive move that the machine file does not describe.
pub(super) fn refuse_second_drive(run: &mut Run<'_, '_>, what: &str, span: Span) {
    let shown = gwatt_syntax::diagnostic::excerpt(span.of(run.report.text), 60);
    let message = format!("`{shown}` here is {what}: what its drive draws is not known");
    run.report.error("unsupported-word", message, span).help(
        "for the check take it out, and describe the axis in the machine file with the mass and \
         friction of both",
    );
}
