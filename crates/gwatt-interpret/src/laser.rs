//! grbl's laser mode ($32): which lines the beam makes the axes wait for.

use super::code::Motion;
use super::control::{Control, Run};
use gwatt_machine::LaserMode;
use gwatt_motion::{ActionKind, MoveKind, Step};

/// M3: a beam of constant power.
const CONSTANT: u16 = 3;
/// M4: a beam whose power follows the speed.
const DYNAMIC: u16 = 4;
/// M5.
const BEAM_OFF: u16 = 5;

/// A way that may be less than a step of the motors, mm: 40 of them a millimetre are few.
const STEP_MM: f64 = 0.025;

impl Control<'_> {
    /// What S is in a block: with the motion, or by itself.
    pub(super) fn kind_of_speed(&self, run: &mut Run<'_, '_>) -> ActionKind {
        let mode = self.machine.controller.queue.laser_mode;
        if mode == LaserMode::Off || !moves_by_words(run) {
            return ActionKind::SpindleSpeed;
        }
        if mode == LaserMode::Unknown && self.switches.spindle != BEAM_OFF {
            let message = "whether laser mode ($32) is on is not known: S in blocks that move counts \
                           both as a stop and as none; `[path] laser_mode` in the machine file says \
                           which";
            let span = run.whole();
            run.report.note_once("laser-mode", message, span);
        }
        ActionKind::SpeedInMotion
    }

    /// A beam of constant power waits for the axes where a line that does not move by a motion word
    /// changes between G0 and feeds.
    ///
    /// Source: grbl, `gcode.c`, step 3b.
    pub(super) fn beam_between_lines(&self, run: &mut Run<'_, '_>) {
        if !self.beam_is_constant() || moves_by_words(run) {
            return;
        }
        if named_motion(run).is_some_and(|feed| feed != feeds(self.modal.motion)) {
            run.act(ActionKind::BeamMayStop, 0.0);
        }
    }

    /// The same at a line whose way is none, or less than a step.
    ///
    /// Source: grbl, `motion_control.c`, `mc_line` (`PLAN_EMPTY_BLOCK`).
    pub(super) fn beam_at_empty_line(&self, run: &mut Run<'_, '_>) {
        let empty = |step: &Step| matches!(step, Step::Move(mv) if mv.kind != MoveKind::Dwell && self.is_empty_way(mv.length_mm));
        if self.beam_is_constant() && run.steps.iter().any(empty) {
            run.act(ActionKind::BeamMayStop, 0.0);
        }
    }

    /// Whether a beam of constant power may wait at a line of this length.
    pub(super) fn is_empty_way(&self, length_mm: f64) -> bool {
        length_mm < STEP_MM && self.beam_is_constant()
    }

    /// Whether a beam that is off in G0 would burn along a feed in its place. Where it is not known
    /// whether there is one, M4 or an S in a block that feeds shows that there is.
    ///
    /// Source: grbl, `gcode.c`, step 4 (`GC_PARSER_LASER_DISABLE`).
    #[inline]
    pub(super) fn beam_waits_for_feed(&self) -> bool {
        let lit = self.switches.spindle != BEAM_OFF && self.modal.spindle_rpm != 0.0;
        lit && match self.machine.controller.queue.laser_mode {
            LaserMode::On => true,
            LaserMode::Unknown => self.switches.spindle == DYNAMIC || self.switches.laser_seen,
            LaserMode::Off => false,
        }
    }

    /// M4 shows that there is a laser, for the rest of the program.
    pub(super) fn look_for_laser(&mut self) {
        self.switches.laser_seen |= self.switches.spindle == DYNAMIC;
    }

    /// Whether a block feeds, by its own motion word or the one in force.
    pub(super) fn feeds(&self, run: &Run<'_, '_>) -> bool {
        named_motion(run).unwrap_or_else(|| feeds(self.modal.motion))
    }

    fn beam_is_constant(&self) -> bool {
        self.machine.controller.queue.laser_mode != LaserMode::Off
            && self.switches.spindle == CONSTANT
    }
}

/// Whether the axes of a block are where a motion word takes them, and belong to no other word.
fn moves_by_words(run: &Run<'_, '_>) -> bool {
    let other = |number: f64| matches!(number.trunc() as u16, 10 | 28 | 30 | 38 | 92);
    let words = &run.block.words;
    let taken = words
        .iter()
        .any(|word| word.letter == b'G' && other(word.value));
    run.words.has_axes() && !taken
}

/// Whether the motion word of a block, if it has one, is that of a feed.
fn named_motion(run: &Run<'_, '_>) -> Option<bool> {
    let words = run.block.words.iter().rev();
    let mut motions = words.filter_map(|word| match (word.letter, word.value) {
        (b'G', 0.0 | 80.0) => Some(false),
        (b'G', 1.0 | 2.0 | 3.0) => Some(true),
        _ => None,
    });
    motions.next()
}

fn feeds(motion: Motion) -> bool {
    matches!(motion, Motion::Linear | Motion::ArcCw | Motion::ArcCcw)
}
