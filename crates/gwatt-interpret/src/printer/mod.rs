//! The language of 3D printers: Marlin, RepRapFirmware, Klipper.
//!
//! In: a line that is no plain motion. Out: moves, actions and settings, or a
//! refusal by name. Sources: Marlin documentation ("G-code Index"), the `RepRap`
//! wiki and Duet documentation ("G-code dictionary"), Klipper documentation
//! ("G-Codes", "Commands templates"). What a firmware does of itself, as
//! homing, probing or changing the tool, is priced from an unknown start.

pub(super) mod language;
mod arc;
mod command;
mod corners;
mod early;
mod heat;
mod kept;
mod left_out;
mod line;
mod named;
mod optional;
mod ordinary;
mod position;
mod retract;
mod scale;
mod second_drive;
mod settings;
#[cfg(test)]
mod testing;
mod state;
mod unstated;

use crate::rules::rules_of;
pub(super) use state::State;

use super::report::Report;
use gwatt_machine::{AxisSet, AxisValues, Controller};
use gwatt_syntax::{Block, Word};

/// Where a move goes, for what depends on that.
pub(super) struct Course<'a> {
    pub(super) end: &'a AxisValues,
    /// Axes that move or may move.
    pub(super) commanded: AxisSet,
    /// Axes of the plane of an arc, whose share of the path changes along it.
    pub(super) turning: AxisSet,
    /// Length of the path, where its start is known.
    pub(super) length_mm: f64,
    /// Where it starts is not known.
    pub(super) unknown: bool,
}

/// Whether a line has to be read as a printer's command: not one of axis words
/// under G0 to G3; `own_motion`: the machine has macros in place of some of these.
fn is_command(block: &Block, own_motion: bool) -> bool {
    match block.words.first() {
        _ if !block.issues.is_empty() => true,
        Some(first) => match first.letter {
            b'G' => own_motion || !(0.0..4.0).contains(&first.value),
            letter => matches!(letter, b'M' | b'P' | b'T'),
        },
        None => false,
    }
}

/// Checks the checksum of a line: all bytes before the `*`, joined by XOR.
///
/// Source: `RepRap` wiki, "G-code", "Checking"; Marlin ignores blanks before N.
pub(super) fn verify_checksum(star: Word, controller: &Controller, report: &mut Report<'_, '_>) {
    if !rules_of(&controller.language).checksums {
        return;
    }
    let before = report.text.get(..star.span.start as usize);
    let sum = before
        .unwrap_or_default()
        .trim_ascii_start()
        .iter()
        .fold(0, |sum: u8, byte| sum ^ byte);
    if star.value == f64::from(sum) {
        return;
    }
    let message = format!("the checksum is wrong: the line's own is {sum}");
    report
        .error("checksum", message, star.span)
        .help("a printer refuses the line; a checksum of five digits (CRC-16) is not supported");
}
