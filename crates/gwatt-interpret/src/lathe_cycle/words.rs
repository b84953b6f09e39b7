//! Turning cycles along a contour, as blocks call them.

use super::contour::Reader;
use super::passes::{Cut, CutKind};
use super::{Cycle, FIXED, LatheCycle, Pockets, RoughCycle, SAME_PLACE_MM, X, Z};
use crate::arc::{self, Ends, Slack};
use crate::arc_words::report_fault;
use crate::code::Motion;
use crate::control::{Control, Effects, HeldBlock, Run};
use crate::execute::Interpreter;
use crate::facts::Facts;
use crate::jump::Transfer;
use crate::label::Label;
use crate::places::POSITION_MAX_MM;
use crate::report::Report;
use crate::vector::Vector;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{ALL_AXES, AxisKind, AxisSet};
use gwatt_motion::{MoveKind, Step};
use gwatt_syntax::source::Span;

impl Control<'_> {
    pub(crate) fn lathe_cycle(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        run.facts.cycle = true;
        run.facts.boundary = true;
        run.facts.uses_motion = true;
        let Some(contour) = run.words.take(b'Q') else {
            let message = match number {
                72 | 720 => "without Q, the number of the contour's subroutine",
                _ => {
                    "without Q, the number of the contour's subroutine; inches are G20 here, \
                     millimetres G21"
                }
            };
            return fault(message, span, run);
        };
        let contour = contour.round();
        if !(0.0..=f64::from(u32::MAX)).contains(&contour) {
            let span = run.words.span(b'Q', run.block);
            return fault("Q is no number of a subroutine", span, run);
        }
        if run.facts.motion_word.is_some() {
            return fault("another motion word next to the cycle", span, run);
        }
        if let Some(message) = self.lathe_cycle_forbidden(run) {
            return fault(&message, span, run);
        }
        let unit = self.modal.mm_per_unit;
        let here = self.position.program();
        let mut start = [here[Z] / unit, here[X] / unit];
        for (place, axis) in start.iter_mut().zip([Z, X]) {
            if let Some(value) = run.words.take(ALL_AXES[axis].letter()) {
                let given = self.length_mm(axis, value) / unit;
                *place = if self.modal.absolute {
                    given
                } else {
                    *place + given
                };
            }
        }
        let mut take = |letter: u8, default: f64| run.words.take(letter).unwrap_or(default);
        let distance = take(b'D', 0.0);
        let [last, depth, times] = [take(b'E', 0.0), take(b'I', 1.0), take(b'P', 1.0)];
        let [retract, shift_x, shift_z] = [take(b'R', 0.5), take(b'U', 0.0), take(b'W', 0.0)];
        let lengths = [distance, last, depth, retract, shift_x, shift_z];
        let cycle = if number == 700 {
            if !(1.0..=10_000.0).contains(&times) || times.fract() != 0.0 {
                let span = run.words.span(b'P', run.block);
                return fault("P is no number of passes", span, run);
            }
            Cycle::Finish {
                first: distance,
                last,
                times: times as u32,
            }
        } else {
            if depth <= 0.0 || retract < 0.0 {
                let message = "the depth of cut I must be above 0, the retraction R not below it";
                return fault(message, span, run);
            }
            Cycle::Rough(RoughCycle {
                facing: number >= 720,
                pockets: match number % 10 {
                    0 => Pockets::Cut,
                    1 => Pockets::Left,
                    _ => Pockets::Only,
                },
                left: distance,
                shift: [shift_z, shift_x],
                depth,
                retract,
            })
        };
        if lengths.into_iter().any(|length| length.abs() > 1e6) {
            return fault("a length beyond reason", span, run);
        }
        self.transfer = Some(Transfer::LatheCycle(Box::new(LatheCycle {
            contour: Label::Number(contour as u32),
            start,
            cycle,
        })));
    }

    fn lathe_cycle_forbidden(&self, run: &Run<'_, '_>) -> Option<String> {
        for axis in [X, Z] {
            let letter = ALL_AXES[axis].letter() as char;
            if self.machine.axes[axis].is_none_or(|data| data.kind != AxisKind::Linear) {
                return Some(format!(
                    "the cycle needs the linear axis {letter}, which the machine does not have"
                ));
            }
            if self.position.unknown.contains(axis) {
                return Some(format!("where {letter} stands is not known"));
            }
        }
        let message = if self.modal.plane != [Z, X, 1] {
            "the cycle outside of G18"
        } else if run.facts.machine_coordinates || !self.position.frame.is_plain() {
            "the cycle in machine or turned coordinates"
        } else if self.feed_mode_is(gwatt_motion::FeedMode::InverseTime) {
            "the cycle under G93"
        } else if self.special.left.is_some() {
            "the cycle after G88"
        } else {
            return None;
        };
        Some(message.to_owned())
    }
}

/// Rapids of a cycle under compensation, in the steps from `first` on: `LinuxCNC` 2.9 takes the
/// contour's end for their start at a corner, so that the tool may go there first.
fn approaches_anyhow(run: &mut Run<'_, '_>, first: usize) {
    let whole = run.whole();
    let message = "how LinuxCNC approaches the contour under cutter compensation is not followed: the \
                   rapids of G70 count at full speed and acceleration";
    run.report.note_once("unknown-moves", message, whole);
    for step in run.steps.iter_mut().skip(first) {
        if let Step::Move(mv) = step
            && mv.kind == MoveKind::Rapid
        {
            mv.unknown_start.insert(X);
            mv.unknown_start.insert(Z);
        }
    }
}

/// Reports what is wrong about a cycle.
fn fault(message: &str, span: Span, run: &mut Run<'_, '_>) {
    run.report
        .error("lathe-cycle", format!("G70 to G72: {message}"), span)
        .help("LinuxCNC manual, \"G71 G72 Lathe roughing cycles\"; or write the passes out");
}

impl Interpreter<'_> {
    /// Makes the moves of the cycle.
    pub(crate) fn run_lathe_cycle(
        &mut self,
        cycle: &LatheCycle,
        reader: Reader,
        held: HeldBlock<'_>,
        effects: &mut Effects<'_>,
    ) {
        let HeldBlock { line, text, block } = held;
        let errors = effects.diagnostics.errors;
        let mut run = Run {
            line,
            block,
            words: &mut self.words,
            facts: &mut Facts::default(),
            steps: effects.steps,
            report: Report {
                diagnostics: effects.diagnostics,
                line,
                text,
            },
        };
        let control = &mut self.control;
        // Those of the contour's last block have had their turn.
        run.words.groups = 0;
        let approach = Cut {
            to: cycle.start,
            kind: CutKind::Rapid,
        };
        let first = run.steps.len();
        control.compensated_cut(&approach, errors, &mut run);
        match super::passes::cuts(&cycle.cycle, reader.pieces, cycle.start) {
            Ok(cuts) => {
                for cut in cuts {
                    if run.report.diagnostics.errors != errors {
                        return;
                    }
                    control.compensated_cut(&cut, errors, &mut run);
                }
            }
            Err(found) => {
                let whole = run.whole();
                fault(found.message(), whole, &mut run);
            }
        }
        if control.compensation.is_some() {
            approaches_anyhow(&mut run, first);
        }
    }
}

impl Control<'_> {
    /// One move of a cycle, as compensation makes it run (G70).
    fn compensated_cut(&mut self, cut: &Cut, errors: u64, run: &mut Run<'_, '_>) {
        let before = run.steps.len();
        self.cut(cut, run);
        if self.compensation.is_some() {
            self.compensate(run, before, errors);
        }
    }

    /// One move of a cycle.
    fn cut(&mut self, cut: &Cut, run: &mut Run<'_, '_>) {
        let unit = self.modal.mm_per_unit;
        let machine = |control: &Self, [z, x]: Vector| {
            [(Z, z), (X, x)].map(|(axis, value)| control.position.absolute(axis, value * unit))
        };
        let mut end = self.believed();
        [end[Z], end[X]] = machine(self, cut.to);
        if [end[Z], end[X]]
            .iter()
            .any(|place| place.is_nan() || place.abs() > POSITION_MAX_MM)
        {
            let whole = run.whole();
            return fault("a position beyond any machine", whole, run);
        }
        let round = match cut.kind {
            CutKind::Rapid => {
                self.modal.motion = Motion::Rapid;
                return self.part(run, MoveKind::Rapid, &end);
            }
            CutKind::Straight => {
                self.modal.motion = Motion::Linear;
                return self.part(run, MoveKind::Feed, &end);
            }
            CutKind::Arc(round) => round,
        };
        let here = self.position.at;
        if [X, Z]
            .iter()
            .all(|&axis| (here[axis] - end[axis]).abs() < SAME_PLACE_MM)
        {
            return;
        }
        let whole = run.whole();
        self.modal.motion = if round.ccw {
            Motion::ArcCcw
        } else {
            Motion::ArcCw
        };
        let at = self.position.at;
        let ends = Ends {
            plane: [Z, X],
            start: [at[Z], at[X]],
            end: [end[Z], end[X]],
            clockwise: !round.ccw,
            turns: 1.0,
            slack: Slack::of(&self.machine.controller.language, unit == MM_PER_INCH),
        };
        match arc::from_center(&ends, machine(self, round.center)) {
            Ok(arc) => self.go(run, MoveKind::Arc, &end, AxisSet::default(), Some(arc)),
            Err(found) => report_fault(found, run, whole),
        }
    }
}
