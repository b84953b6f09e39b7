//! Codes of NC I.

use crate::code::GCode;

/// The G words (number × 10) of this language ("Command overview").
pub(crate) fn nci_g_code(number: u16, common: impl Fn(u16) -> Option<GCode>) -> Option<GCode> {
    match number {
        0 | 10 | 20 | 30 | 40 | 170 | 180 | 190 | 400 | 900 | 910 => common(number),
        // "Accurate Stop": G60 holds until G0.
        600 => Some(GCode::PathMode),
        // "Inch/metric dimensions": G71 is in force at the start. Feeds stay in the units of
        // the machine under G70, which its parameters say.
        710 => common(210),
        // "Zero Offset Shifts": G53 takes them away until further notice.
        530 => Some(GCode::WorkOffset(0)),
        540..=570 if number.is_multiple_of(10) => Some(GCode::WorkOffset((number / 10 - 53) as u8)),
        _ => None,
    }
}
