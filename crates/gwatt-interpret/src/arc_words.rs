//! G2 and G3: the words of an arc.

use super::arc::{self, ArcFault, Ends, Slack};
use super::code::{GCode, Motion};
use super::control::{Control, Run};
use super::letters::bit;
use super::places::STANDSTILL_MM;
use super::turned_arc::Tilted;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{ALL_AXES, ArcWithoutCenter, AxisKind};
use gwatt_motion::{Arc, MoveKind};
use gwatt_syntax::source::Span;

/// Reports a word for an arc in a block that has none of its words, where the control does.
pub(super) fn lone_arc(run: &mut Run<'_, '_>) {
    let arc = |code: &GCode| matches!(code, GCode::Motion(Motion::ArcCw | Motion::ArcCcw));
    let mut words = run.words.g.iter();
    let Some((_, number, span)) = words.find(|(code, ..)| arc(code)).copied() else {
        return;
    };
    let message = format!("G{} without an end or a centre", number / 10);
    run.report
        .error("arc-center", message, span)
        .help("write it in the block that moves; the control refuses it alone");
}

impl Control<'_> {
    /// Whether an arc without a centre and a radius stands for a line.
    fn is_line(&self, run: &mut Run<'_, '_>) -> bool {
        let shape = bit(b'I') | bit(b'J') | bit(b'K') | bit(self.radius_letter());
        let otherwise = self.machine.controller.language.arc_without_center;
        let line = otherwise != ArcWithoutCenter::Refused
            && run.words.unused & shape == 0
            && run.words.has_axes()
            && !run.facts.machine_coordinates;
        if line && otherwise == ArcWithoutCenter::LineOrAlarm {
            let message = "an arc without a centre and a radius: a line to its end, if no alarm \
                           (Fanuc: parameter 3403 bit CIR)";
            let span = run.whole();
            run.report.note_once("arc-as-line", message, span);
        }
        line
    }

    pub(super) fn arc(&mut self, run: &mut Run<'_, '_>) {
        if self.is_line(run) {
            run.facts.fixed = Some("it is a line under G2 or G3, without a centre");
            return self.straight(run);
        }
        let errors = run.report.diagnostics.errors;
        let mut end = self.position.at;
        let whole = run.whole();
        if run.facts.machine_coordinates {
            run.report
                .error("arc-in-g53", "G53 with an arc", whole)
                .help("G53 goes with G0 and G1 only");
        }
        let Some(unknown) = self.targets(run, false, &mut end) else {
            return;
        };
        let [first, second, normal] = self.modal.plane;
        let touched = self.position.unknown;
        let printer = self.rules.relative_places;
        if printer && (touched.contains(first) || touched.contains(second)) {
            return self.arc_from_unknown(run, &end, unknown);
        }
        if !printer && !unknown.is_empty() || touched.contains(first) || touched.contains(second) {
            run.report
                .error(
                    "arc-from-unknown",
                    "an arc from a position that is not known",
                    whole,
                )
                .help("move the axes to a known position first, or give --start X0,Y0,Z0");
        }
        let turns = self.arc_turns(run);
        if run.report.diagnostics.errors != errors {
            return;
        }
        let turned = !self.position.frame.is_plain();
        let [start_at, end_at] = if turned {
            self.arc_ends_in_program(&end)
        } else {
            [self.position.at, end]
        };
        let ends = Ends {
            plane: [first, second],
            start: [start_at[first], start_at[second]],
            end: [end_at[first], end_at[second]],
            clockwise: self.modal.motion == Motion::ArcCw,
            turns,
            slack: Slack::of(
                &self.machine.controller.language,
                self.modal.mm_per_unit == MM_PER_INCH,
            ),
        };
        let rises = (end[normal] - self.position.at[normal]).abs() > STANDSTILL_MM;
        match self.arc_geometry(run, &ends) {
            Some(Ok(arc)) if rises && arc::is_loose(&ends, &arc) => refuse_loose(run, whole),
            Some(Ok(arc)) if turned => {
                let tilted = Tilted {
                    arc: &arc,
                    ends: [&start_at, &end_at],
                    to: &end,
                };
                self.turned_arc(&tilted, unknown, run);
            }
            Some(Ok(arc)) => {
                if self.printer.adjusts {
                    self.scale_extrusion(run, &mut end, unknown, true);
                }
                self.go(run, MoveKind::Arc, &end, unknown, Some(arc));
            }
            Some(Err(ArcFault::RadiiDiffer { center, .. })) if printer => {
                self.loose_arc(run, &ends, center, end);
            }
            Some(Err(fault)) => report_fault(fault, run, whole),
            None => {}
        }
    }

    /// The turns of an arc; checks its plane and the words that go with it.
    fn arc_turns(&self, run: &mut Run<'_, '_>) -> f64 {
        let [first, second, normal] = self.modal.plane;
        for axis in [first, second] {
            if self.machine.axes[axis].is_none_or(|data| data.kind != AxisKind::Linear) {
                let letter = ALL_AXES[axis].letter() as char;
                let message = format!(
                    "an arc needs the linear axis {letter}, which the machine does not have"
                );
                let whole = run.whole();
                run.report
                    .error("no-such-axis", message, whole)
                    .help("choose the plane with G17, G18 or G19");
            }
        }
        let turns = if self.rules.arc_turns {
            run.words.take(b'P').unwrap_or(1.0)
        } else {
            1.0
        };
        if turns < 1.0 || turns.fract() != 0.0 || turns > 1e6 {
            let span = run.words.span(b'P', run.block);
            let message = "P of an arc must be a whole number from 1";
            run.report
                .error("arc-turns", message, span)
                .help("write the number of turns");
        }
        let stray = b"IJK"[normal];
        if run.words.take(stray).is_some_and(|value| value != 0.0) && !self.rules.stray_centres {
            let span = run.words.span(stray, run.block);
            let message = format!("{} does not belong to an arc in this plane", stray as char);
            run.report
                .error("arc-center", message, span)
                .help("choose the plane with G17, G18 or G19");
        }
        turns
    }

    /// The letter of an arc's radius.
    pub(crate) fn radius_letter(&self) -> u8 {
        let dialect = self.dialect();
        if dialect.lathe.is_some() || dialect.diameter {
            self.rules.lathe_radius
        } else {
            b'R'
        }
    }

    /// Geometry by R, or by I J K; `None` when it was reported.
    fn arc_geometry(&self, run: &mut Run<'_, '_>, ends: &Ends) -> Option<Result<Arc, ArcFault>> {
        let unit = self.modal.mm_per_unit;
        let letters = [b"IJK"[ends.plane[0]], b"IJK"[ends.plane[1]]];
        let offsets = letters.map(|letter| run.words.take(letter));
        let whole = run.whole();
        if let Some(radius) = run.words.take(self.radius_letter()) {
            if offsets.iter().any(Option::is_some) {
                let message = "an arc with R and with a centre";
                run.report
                    .error("arc-center", message, whole)
                    .help("keep one of them");
                return None;
            }
            return Some(arc::from_radius(ends, radius * unit));
        }
        if offsets == [None, None] {
            let radius = match self.radius_letter() {
                b'R' => self.rules.radius_word.to_owned(),
                letter => char::from(letter).to_string(),
            };
            let message = format!(
                "an arc without a centre ({} {}) or {radius}",
                letters[0] as char, letters[1] as char
            );
            let known = self.machine.controller.language.dialect.adapts();
            run.report
                .error("arc-center", message, whole)
                .help(if known {
                    "write the centre or the radius; where the control goes straight to the end \
                 (Fanuc: parameter 3403 bit CIR = 0), write arc_without_center = \"line\" under \
                 [language] in the machine file"
                } else {
                    "write the centre or the radius"
                });
            return None;
        }
        let mut center = ends.start;
        for (index, offset) in offsets.into_iter().enumerate() {
            if !self.modal.arc_absolute {
                center[index] += offset.unwrap_or(0.0) * unit;
            } else if let Some(value) = offset {
                center[index] = if self.position.frame.is_plain() {
                    self.position.absolute(ends.plane[index], value * unit)
                } else {
                    value * unit
                };
            } else {
                let message = format!(
                    "under G90.1 an arc needs {} and {}",
                    letters[0] as char, letters[1] as char
                );
                run.report
                    .error("arc-center", message, whole)
                    .help("write both");
                return None;
            }
        }
        Some(arc::from_center(ends, center))
    }
}

/// A helix that only its own controller bears.
fn refuse_loose(run: &mut Run<'_, '_>, span: Span) {
    let message = "a helix whose end is not on its circle: how fast it climbs is not followed";
    run.report
        .error("arc-radius", message, span)
        .help("write the end point or the centre with more decimals");
}

pub(super) fn report_fault(fault: ArcFault, run: &mut Run<'_, '_>, span: Span) {
    let (rule, message, help) = match fault {
        ArcFault::NoRadius => (
            "arc-center",
            "the arc has no radius: start or end is its centre".to_owned(),
            "check I, J and K",
        ),
        ArcFault::RadiiDiffer {
            start_mm, end_mm, ..
        } => (
            "arc-radius",
            format!(
                "the arc's end is not on its circle: radius {start_mm:.4} mm at the start, {end_mm:.4} mm at the end"
            ),
            "check the end point and the centre; a G90.1/G91.1 mix-up looks like this: \
             arc_centre under [language] in the machine file says how I, J and K are meant",
        ),
        ArcFault::RadiusTooSmall {
            radius_mm,
            half_chord_mm,
        } => (
            "arc-radius",
            format!(
                "R {radius_mm:.4} mm cannot reach the end: half the distance is {half_chord_mm:.4} mm"
            ),
            "write a larger R, or check the end point",
        ),
        ArcFault::NoChord => (
            "arc-radius",
            "an arc with R that ends where it starts".to_owned(),
            "write a full circle with I, J or K",
        ),
    };
    run.report.error(rule, message, span).help(help);
}
