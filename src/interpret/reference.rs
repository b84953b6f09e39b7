//! G28, G30 and G92: reference points and offsets.

use super::execute::{Control, Run};
use super::motion::POSITION_MAX_MM;
use super::moves::MoveKind;
use crate::machine::{ALL_AXES, AXES, AxisKind, AxisSet, Family};
use crate::source::Span;
use arrayvec::ArrayVec;

impl Control<'_> {
    /// G28 and G30: to the intermediate point, then to the reference point.
    pub(super) fn reference(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        run.facts.reference = true;
        if number == 300 {
            // Its place is a setting of the control; P2 to P4 name further ones.
            run.words.take(b'P');
        }
        let message = "the reference points of G28 and G30 are taken as machine zero";
        run.report.note_once("reference-point", message, span);
        let mut named = AxisSet::default();
        run.words.axes().for_each(|(axis, _)| named.insert(axis));
        if named.is_empty() {
            if self.machine.controller.language.family == Family::Iso {
                run.report
                    .error("reference-axes", "a reference point without axes", span)
                    .help("name the axes, as in G28 G91 Z0");
                return;
            }
            named = self.machine.axis_set;
        } else {
            let mut via = self.position.at;
            let Some(unknown) = self.targets(run, false, &mut via) else {
                return;
            };
            self.go(run, MoveKind::Rapid, &via, unknown, None);
        }
        let mut home = self.position.at;
        for axis in named.iter() {
            home[axis] = 0.0;
        }
        let unknown = AxisSet(named.0 & self.position.unknown.0);
        self.go(run, MoveKind::Rapid, &home, unknown, None);
    }

    pub(super) fn set_offset(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let mut words: ArrayVec<(usize, f64), AXES> = run.words.axes().collect();
        if words.is_empty() {
            if self.machine.controller.language.family != Family::Marlin {
                run.report
                    .error("offset-axes", "G92 without axes", span)
                    .help("name the axes, as in G92 X0");
                return;
            }
            words = self
                .machine
                .axis_set
                .iter()
                .map(|axis| (axis, 0.0))
                .collect();
        }
        for (axis, value) in words {
            let letter = ALL_AXES[axis].letter();
            run.words.take(letter);
            let at = run.words.span(letter, run.block);
            let Some(data) = &self.machine.axes[axis] else {
                let message = format!("the machine has no {} axis", letter as char);
                run.report
                    .error("no-such-axis", message, at)
                    .help("describe it in the machine file, or take it out");
                continue;
            };
            if self.machine.controller.language.family == Family::Marlin {
                // Only differences of positions matter to a printer.
                self.position.unknown.0 &= !(1 << axis);
            } else if self.position.unknown.contains(axis) {
                run.report
                    .error(
                        "offset-from-unknown",
                        "G92 for an axis whose position is not known",
                        at,
                    )
                    .help("give --start, or move the axis to a known position first");
                continue;
            }
            let value = if data.kind == AxisKind::Linear {
                value * self.modal.mm_per_unit
            } else {
                value
            };
            if value.abs() > POSITION_MAX_MM {
                run.report
                    .error("position-range", "the position is beyond any machine", at)
                    .help("check the number");
                continue;
            }
            self.position.set_offset(axis, value);
        }
    }
}
