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
mod early;
mod heat;
mod kept;
mod line;
mod named;
mod optional;
mod position;
mod retract;
mod scale;
mod settings;
#[cfg(test)]
mod testing;
mod unstated;

use crate::rules::rules_of;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::position::Reading;
use super::report::Report;
use gwatt_machine::{AXES, AxisSet, AxisValues, Command, Controller, Machine, Printer, Retract};
use gwatt_syntax::{Block, Word};
use kept::{SavedPosition, SavedState};
use optional::Before;
use unstated::Unstated;

/// What a printer keeps from line to line, besides what every controller does.
#[derive(Debug)]
pub(super) struct State {
    /// Something below changes feeds or lengths of moves.
    pub(super) adjusts: bool,
    /// The machine has macros in place of G0 to G3.
    own_motion: bool,
    /// M82 (true) or M83.
    extruder_absolute: bool,
    /// Modes that a macro may have changed.
    unstated: Unstated,
    /// M220, as a factor, and what M220 B has put by.
    feed_factor: f64,
    kept_feed_factor: f64,
    /// M221 as a factor.
    flow: f64,
    /// Axes of a move that may not be in the queue yet.
    pub(super) pending: AxisSet,
    /// M200: length of filament for one unit of E.
    volumetric: f64,
    /// M205 S and T: smallest speeds of moves that extrude, and of others.
    least_mm_s: [f64; 2],
    /// G10 and G11, and whether the program has set them.
    retract: Retract,
    retract_given: bool,
    retracted: bool,
    lifted_mm: f64,
    /// Where files of macros are looked for.
    sub_paths: Arc<[PathBuf]>,
    /// Steps per unit that M92 has named; 0 for none.
    steps: AxisValues,
    /// The tool in use.
    tool: u32,
    /// Heaters or fans that are on, a bit for each number, for each load.
    lit: [u32; 32],
    /// Loads that a macro may have left on, a bit for each.
    maybe_lit: u32,
    /// The program has named more than one tool.
    several_tools: bool,
    /// G60.
    positions: Vec<(u32, SavedPosition)>,
    /// Before each part that is open and may be left out.
    optional: Vec<Before>,
    /// `SAVE_GCODE_STATE`, M120.
    states: BTreeMap<Vec<u8>, SavedState>,
}

impl State {
    pub(super) fn new(machine: &Machine, reading: &Reading) -> Self {
        let language = &machine.controller.language;
        Self {
            adjusts: false,
            own_motion: own_motion(&language.printer),
            extruder_absolute: true,
            unstated: Unstated::default(),
            feed_factor: 1.0,
            kept_feed_factor: 1.0,
            flow: 1.0,
            pending: AxisSet::default(),
            volumetric: 1.0,
            least_mm_s: [0.0; 2],
            retract: language.printer.retract,
            retract_given: false,
            retracted: false,
            lifted_mm: 0.0,
            sub_paths: Arc::clone(&reading.sub_paths),
            steps: [0.0; AXES],
            tool: 0,
            lit: [0; 32],
            maybe_lit: 0,
            several_tools: false,
            positions: Vec::new(),
            optional: Vec::new(),
            states: BTreeMap::new(),
        }
    }
}

/// Whether G0 to G3 are macros of the machine.
fn own_motion(printer: &Printer) -> bool {
    let lists = [&printer.unknown_moves, &printer.unknown_macros];
    let mut all = lists.into_iter().flatten();
    all.any(|one| matches!(one, Command::Code(b'G', 0..40)))
}

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
            letter => matches!(letter, b'M' | b'T'),
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
