//! What a printer keeps from line to line.

use super::super::reading::Reading;
use crate::code::Motion;
use crate::knob::KnobState;
use crate::modal::{Feed, Modal};
use gwatt_machine::{AXES, AxisSet, AxisValues, Command, Machine, Printer, Retract};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What a printer keeps from line to line, besides what every controller does.
#[derive(Debug)]
pub(crate) struct State {
    /// Something below changes feeds or lengths of moves.
    pub(crate) adjusts: bool,
    /// The machine has macros in place of G0 to G3.
    pub(super) own_motion: bool,
    /// M82 (true) or M83.
    pub(super) extruder_absolute: bool,
    /// Modes that a macro may have changed.
    pub(super) unstated: Unstated,
    /// M220, as a factor, and what M220 B has put by.
    pub(super) feed_factor: f64,
    pub(super) kept_feed_factor: f64,
    /// M221 as a factor.
    pub(super) flow: f64,
    /// Axes of a move that may not be in the queue yet.
    pub(crate) pending: AxisSet,
    /// All axes stand, since nothing has moved after homing, or at all.
    pub(crate) stands: bool,
    /// M200: length of filament for one unit of E.
    pub(super) volumetric: f64,
    /// M205 S and T: smallest speeds of moves that extrude, and of others.
    pub(super) least_mm_s: [f64; 2],
    /// G10 and G11, and whether the program has set them.
    pub(super) retract: Retract,
    pub(super) retract_given: bool,
    pub(super) retracted: bool,
    pub(super) lifted_mm: f64,
    /// Where files of macros are looked for.
    pub(super) sub_paths: Arc<[PathBuf]>,
    /// Steps per unit that M92 has named; 0 for none.
    pub(super) steps: AxisValues,
    /// The tool in use.
    pub(super) tool: u32,
    /// Heaters or fans that are on, a bit for each number, for each load.
    pub(super) lit: [u32; 32],
    /// Loads that a macro may have left on, a bit for each.
    pub(super) maybe_lit: u32,
    /// The program has named more than one tool.
    pub(super) several_tools: bool,
    /// Axes whose program coordinates are shifted against the machine's by nobody knows how much.
    pub(super) shifted: AxisSet,
    /// G60.
    pub(super) positions: Vec<(u32, SavedPosition)>,
    /// Before each part that is open and may be left out.
    pub(super) optional: Vec<Before>,
    /// `SAVE_GCODE_STATE`, M120.
    pub(super) states: BTreeMap<Vec<u8>, SavedState>,
}

impl State {
    pub(crate) fn new(machine: &Machine, reading: &Reading) -> Self {
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
            stands: true,
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
            shifted: AxisSet::default(),
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

/// A position that G60 keeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct SavedPosition {
    pub(super) at: AxisValues,
    pub(super) unknown: AxisSet,
}

/// What `SAVE_GCODE_STATE` keeps.
#[derive(Debug, Clone, Copy)]
pub(super) struct SavedState {
    pub(super) position: SavedPosition,
    pub(super) offsets: AxisValues,
    pub(super) absolute: bool,
    pub(super) extruder_absolute: bool,
    pub(super) unstated: Unstated,
    pub(super) feed: Option<Feed>,
    pub(super) feed_factor: f64,
    pub(super) flow: f64,
}

/// What holds after a part that is left out.
#[derive(Debug, Clone)]
pub(super) struct Before {
    pub(super) absolute: bool,
    pub(super) extruder_absolute: bool,
    pub(super) feed: Option<Feed>,
    pub(super) motion: Motion,
    pub(super) mm_per_unit: f64,
    pub(super) feed_factor: f64,
    pub(super) flow: f64,
    pub(super) unstated: Unstated,
    pub(super) tool: u32,
    pub(super) lit: [u32; 32],
    pub(super) maybe_lit: u32,
    pub(super) loads: u32,
    pub(super) knobs: KnobState,
}

impl Before {
    pub(super) fn new(state: &State, modal: &Modal, knobs: &KnobState, loads: u32) -> Self {
        Self {
            absolute: modal.absolute,
            extruder_absolute: state.extruder_absolute,
            feed: modal.feed,
            motion: modal.motion,
            mm_per_unit: modal.mm_per_unit,
            feed_factor: state.feed_factor,
            flow: state.flow,
            unstated: state.unstated,
            tool: state.tool,
            lit: state.lit,
            maybe_lit: state.maybe_lit,
            loads,
            knobs: knobs.clone(),
        }
    }
}

/// Modes that a macro may have changed and that the program has not stated since.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Unstated {
    /// G90 or G91.
    pub(super) distance: bool,
    /// M82 or M83.
    pub(super) extruder: bool,
}

impl Unstated {
    pub(super) fn of(distance: bool, extruder: bool) -> Self {
        Self { distance, extruder }
    }

    pub(super) fn any(self) -> bool {
        self != Self::default()
    }

    /// What is unstated here or there.
    pub(super) fn or(self, other: Self) -> Self {
        Self::of(
            self.distance || other.distance,
            self.extruder || other.extruder,
        )
    }
}
