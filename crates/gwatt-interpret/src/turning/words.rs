//! How contours of turning cycles are followed.

use super::{BOX, BY_PARAMETER, FACE, THREAD, THREAD_BOX, X, Z};
use crate::control::{Control, Run};
use crate::letters::bit;
use gwatt_machine::{ALL_AXES, AxisKind, Lathe};
use gwatt_motion::TURNING_CYCLE as FIXED;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// A block under G32, or under one of the single cycles.
    pub(crate) fn turning_motion(&mut self, number: u16, run: &mut Run<'_, '_>) {
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
    pub(crate) fn turning_block(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
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
    pub(crate) fn take_target(&mut self, axis: usize, run: &mut Run<'_, '_>) -> Option<f64> {
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
        if target.abs() > crate::places::POSITION_MAX_MM {
            let span = run.words.span(letter, run.block);
            run.report
                .error("position-range", "the position is beyond any machine", span)
                .help("check the number");
            return None;
        }
        Some(target)
    }

    /// The U and W of G71 to G73, which system A has taken for words of X and Z.
    pub(crate) fn take_allowance(&mut self, axis: usize, run: &mut Run<'_, '_>) -> Option<f64> {
        let system_a = self.dialect().lathe == Some(Lathe::A);
        let letter = match axis {
            X if !system_a => b'U',
            _ if !system_a => b'W',
            _ => ALL_AXES[axis].letter(),
        };
        run.words.take(letter)
    }

    /// Whether the block names X or Z.
    pub(crate) fn names_x_or_z(run: &Run<'_, '_>) -> bool {
        run.words.unused & (bit(b'X') | bit(b'Z')) != 0
    }
}

/// Reports a word that a cycle lacks.
pub(crate) fn turning_needs(what: &str, number: u16, run: &mut Run<'_, '_>) {
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
pub(crate) fn note_parameter(run: &mut Run<'_, '_>) {
    let whole = run.whole();
    let message = "what the program does not give of a turning cycle (return, escape, \
                   chamfer) is a parameter of the control: taken as 0";
    run.facts.guessed = Some(BY_PARAMETER);
    run.report.note_once("cycle-parameter", message, whole);
}
