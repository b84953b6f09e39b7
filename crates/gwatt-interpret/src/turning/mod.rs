//! Turning cycles of Fanuc and Haas lathes (B-63604EN, "Canned Cycle", "Multiple
//! Repetitive Cycle"; Haas lathe operator's manual, "Canned Cycles").
//!
//! Each part of a cycle is a move of its own. Numbers here are those of G-code
//! systems A and B.

mod contour;
mod drill;
mod groove;
mod piece;
mod pockets;
mod rough;
mod single;
mod thread;

pub(crate) use contour::{Contour, ContourCycle};

use super::execute::{Control, Run};
use super::words::bit;
use gwatt_machine::{ALL_AXES, AxisKind, AxisValues, Lathe};
use gwatt_motion::TURNING_CYCLE as FIXED;
use gwatt_syntax::source::Span;

/// Numbers of the special motion words of lathes: G32; G90, G92 and G94 of
/// system A, by which G77, G78 and G79 they are in system B.
pub(super) const THREAD: u16 = 320;
pub(super) const BOX: u16 = 770;
pub(super) const THREAD_BOX: u16 = 780;
pub(super) const FACE: u16 = 790;

const X: usize = 0;
const Z: usize = 2;

/// Why it is not known how a cycle goes in detail.
const BY_PARAMETER: &str = "its return, escape or chamfer is a parameter of the control: give it \
                            in the program (R)";

/// What turning cycles keep from block to block.
#[derive(Debug, Default)]
pub(super) struct Turning {
    /// A contour is read for G71, G72 or G73, which do without the compensation
    /// of the tool nose radius.
    pub(super) reads_rough: bool,
    /// End point and taper of the single cycle in force, machine coordinates.
    held: Held,
    /// Depth of cut and escape of G71 and G72, mm.
    depth: Option<f64>,
    escape: Option<f64>,
    /// G73: total relief in X and Z, mm, and the number of divisions.
    relief: Option<([f64; 2], u64)>,
    /// Return of G74 and G75, mm.
    back: Option<f64>,
    finish: thread::Finish,
    hole: drill::Hole,
}

#[derive(Debug, Default, Clone, Copy)]
struct Held {
    x: Option<f64>,
    z: Option<f64>,
    taper: f64,
}

impl Control<'_> {
    /// A block under G32, or under one of the single cycles.
    pub(super) fn turning_motion(&mut self, number: u16, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        if !self.turning_axes_fit(run) {
            return;
        }
        match number {
            THREAD => {
                self.special.active = 0;
                self.long_thread(run);
            }
            BOX | THREAD_BOX | FACE => {
                run.facts.cycle = true;
                self.single_cycle(number, run);
            }
            _ => {
                run.facts.cycle = true;
                self.drill(number, run);
            }
        }
    }

    /// G70 to G76.
    pub(super) fn turning_block(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        run.facts.boundary = true;
        run.facts.uses_motion = true;
        if !self.turning_axes_fit(run) {
            return;
        }
        // A block that only gives values for the next one moves nothing.
        run.facts.cycle = true;
        match number {
            740 | 750 => self.groove(number, run),
            760 => self.thread_cycle_of_lathe(run),
            _ => self.contour_cycle(number, span, run),
        }
    }

    /// True when the machine is a lathe with known places of X and Z.
    fn turning_axes_fit(&self, run: &mut Run<'_, '_>) -> bool {
        let whole = run.whole();
        for axis in [X, Z] {
            let letter = ALL_AXES[axis].letter() as char;
            if self.machine.axes[axis].is_none_or(|data| data.kind != AxisKind::Linear) {
                let message = format!(
                    "a turning cycle needs the linear axis {letter}, which the machine does not have"
                );
                run.report
                    .error("no-such-axis", message, whole)
                    .help("choose a lathe: -m lathe");
                return false;
            }
            if self.position.unknown.contains(axis) {
                let message = format!("a turning cycle, but where {letter} stands is not known");
                run.report
                    .error("cycle-from-unknown", message, whole)
                    .help("move the axis to a known position first, or give --start X0,Z0");
                return false;
            }
        }
        if run.facts.machine_coordinates || !self.position.frame.is_plain() {
            run.report
                .error(
                    "special-in-g53",
                    "a turning cycle in machine or turned coordinates",
                    whole,
                )
                .help("use work coordinates here");
            return false;
        }
        true
    }

    /// Machine coordinate that the X or Z word of the block asks for.
    fn take_target(&mut self, axis: usize, run: &mut Run<'_, '_>) -> Option<f64> {
        let letter = ALL_AXES[axis].letter();
        let incremental = run.words.incremental & bit(letter) != 0 || !self.modal.absolute;
        let mm = run
            .words
            .take(letter)
            .map(|value| self.length_mm(axis, value))?;
        let target = if incremental {
            self.position.at[axis] + mm
        } else {
            self.position.absolute(axis, mm)
        };
        if target.abs() > super::motion::POSITION_MAX_MM {
            let span = run.words.span(letter, run.block);
            run.report
                .error("position-range", "the position is beyond any machine", span)
                .help("check the number");
            return None;
        }
        Some(target)
    }

    /// The U and W of G71 to G73, which system A has taken for words of X and Z.
    fn take_allowance(&mut self, axis: usize, run: &mut Run<'_, '_>) -> Option<f64> {
        let system_a = self.dialect().lathe == Some(Lathe::A);
        let letter = match axis {
            X if !system_a => b'U',
            _ if !system_a => b'W',
            _ => ALL_AXES[axis].letter(),
        };
        run.words.take(letter)
    }

    /// Whether the block names X or Z.
    fn names_x_or_z(run: &Run<'_, '_>) -> bool {
        run.words.unused & (bit(b'X') | bit(b'Z')) != 0
    }
}

/// Reports a word that a cycle lacks.
fn turning_needs(what: &str, number: u16, run: &mut Run<'_, '_>) {
    let whole = run.whole();
    run.report
        .error(
            "cycle-word",
            format!("G{} without {what}", number / 10),
            whole,
        )
        .help("write it in this block, or in the first block of the cycle");
}

/// Says once that a parameter of the control is not known.
fn note_parameter(run: &mut Run<'_, '_>) {
    let whole = run.whole();
    let message = "what the program does not give of a turning cycle (return, escape, \
                   chamfer) is a parameter of the control: taken as 0";
    run.facts.guessed = Some(BY_PARAMETER);
    run.report.note_once("cycle-parameter", message, whole);
}

/// `at` with other places of X and Z.
fn xz(at: AxisValues, x: f64, z: f64) -> AxisValues {
    let mut place = at;
    place[X] = x;
    place[Z] = z;
    place
}
