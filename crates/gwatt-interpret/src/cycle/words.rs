//! Words of a cycle that every family has.

use super::Initial;
use crate::control::{Control, Run};
use gwatt_machine::{ALL_AXES, AxisKind};

impl Control<'_> {
    /// True when the axes of the plane and the one that drills can be used.
    pub(super) fn cycle_axes_fit(&self, run: &mut Run<'_, '_>) -> bool {
        let whole = run.whole();
        for axis in self.modal.plane {
            let letter = ALL_AXES[axis].letter() as char;
            if self.machine.axes[axis].is_none_or(|data| data.kind != AxisKind::Linear) {
                let message = format!(
                    "a canned cycle needs the linear axis {letter}, which the machine does not have"
                );
                run.report.error("no-such-axis", message, whole).help(
                    "choose the plane with G17, G18 or G19; for a lathe, take a machine or --dialect with a lathe's language",
                );
                return false;
            }
        }
        let normal = self.modal.plane[2];
        if self.position.unknown.contains(normal) {
            let letter = ALL_AXES[normal].letter() as char;
            run.report
                .error(
                    "cycle-from-unknown",
                    format!("a canned cycle, but where {letter} stands is not known"),
                    whole,
                )
                .help("move the axis to a known position first, or give --start X0,Y0,Z0");
            return false;
        }
        true
    }

    /// Machine coordinate of a level in program units along an axis.
    pub(super) fn level(&self, axis: usize, value: f64) -> f64 {
        self.position.absolute(axis, value * self.modal.mm_per_unit)
    }

    /// The level at which the series of cycles began, machine coordinates: the
    /// place where the axis stands, if it begins here. After a change of unit or
    /// offset it is the same number (as `LinuxCNC` has it).
    pub(super) fn initial_level(&mut self, axis: usize, begins: bool) -> f64 {
        let offset_mm = self.position.absolute(axis, 0.0);
        let mm_per_unit = self.modal.mm_per_unit;
        if begins {
            self.special.held.initial = Initial {
                at_mm: self.believed()[axis],
                offset_mm,
                mm_per_unit,
            };
        }
        let initial = self.special.held.initial;
        if initial.offset_mm == offset_mm && initial.mm_per_unit == mm_per_unit {
            return initial.at_mm;
        }
        let number = (initial.at_mm - initial.offset_mm) / initial.mm_per_unit;
        self.level(axis, number)
    }
}

impl Run<'_, '_> {
    /// Reports a word that a cycle needs.
    pub(super) fn cycle_needs(&mut self, what: &str, number: u16) {
        let whole = self.whole();
        let message = format!("G{} without {what}", number / 10);
        self.report
            .error("cycle-word", message, whole)
            .help(format!("write {what} in the first block of the cycle"));
    }

    /// The number of repeats after `letter`: whole, and not negative.
    pub(super) fn repeats(&mut self, letter: u8) -> Option<u64> {
        let Some(value) = self.words.take(letter) else {
            return Some(1);
        };
        if (0.0..=1e9).contains(&value) && value.fract() == 0.0 {
            return Some(value as u64);
        }
        let span = self.words.span(letter, self.block);
        self.report
            .error(
                "cycle-repeats",
                "the number of repeats is not a whole number from 0 to 1e9",
                span,
            )
            .help("write how often the hole is to be made");
        None
    }

    /// Reports a value that makes no sense.
    pub(super) fn cycle_value(&mut self, letter: u8, message: &str) {
        let span = self.words.span(letter, self.block);
        self.report
            .error("cycle-word", message.to_owned(), span)
            .help("check the number");
    }
}
