//! G70, G71 and G72 of `LinuxCNC`: finishing and roughing about a contour that
//! stands in a subroutine ("G70 Lathe finishing cycle", "G71 G72 Lathe roughing
//! cycles"; what the manual leaves open is as its interpreter 2.9 does it).
//!
//! The subroutine is executed for its O words and assignments; of its other words
//! only X, Z, U, W, I, K, R, A, C and the motion words count.

mod contour;
mod passes;
mod piece;
mod shape;

pub(crate) use self::contour::Reader;

use self::passes::{Cut, CutKind};
use super::arc::{self, Ends, Slack};
use super::arc_words::report_fault;
use super::code::{GCode, Motion};
use super::execute::{Control, Interpreter, Run};
use super::facts::Facts;
use super::jump::{Label, Transfer};
use super::motion::POSITION_MAX_MM;
use super::report::{Diagnostics, Report};
use super::vector::Vector;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_machine::{ALL_AXES, AxisKind, AxisSet, Family};
use gwatt_motion::{MoveKind, Step};
use gwatt_syntax::Block;
use gwatt_syntax::source::Span;

const X: usize = 0;
const Z: usize = 2;

/// Arcs shorter than this are left out.
const SAME_PLACE_MM: f64 = 1e-4;
/// Why no word of such a block is changed.
const FIXED: &str = "it is a turning cycle";

/// A cycle whose contour is still to be read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LatheCycle {
    /// The subroutine of the contour.
    pub(crate) contour: Label,
    /// From where it works: Z and X, program units.
    start: Vector,
    cycle: Cycle,
}

/// The cycles; lengths in program units.
#[derive(Debug, Clone, PartialEq)]
enum Cycle {
    /// G70: distances of the first and the last pass from the contour.
    Finish { first: f64, last: f64, times: u32 },
    /// G71, and G72 (facing).
    Rough {
        facing: bool,
        pockets: Pockets,
        /// What is left for finishing, next to the contour and in Z and X.
        left: f64,
        shift: Vector,
        depth: f64,
        retract: f64,
    },
}

/// What happens to valleys after the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pockets {
    /// G71, G72.
    Cut,
    /// G71.1, G72.1: they are left.
    Left,
    /// G71.2, G72.2: what that has left.
    Only,
}

/// Why a contour cannot be followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    Short,
    Back,
    Shift,
    Parallel,
    Level,
    Corner,
    Endless,
    Many,
}

impl Fault {
    fn message(self) -> &'static str {
        match self {
            Self::Short => "the contour of the cycle needs two moves at least",
            Self::Back => "the contour of the cycle goes back on itself",
            Self::Shift => "the contour of the cycle does not survive being shifted that far",
            Self::Parallel => {
                "two lines of the contour lie in one line, which the cycle cannot join"
            }
            Self::Level => "the cycle finds no way along its contour",
            Self::Corner => "a corner of the contour does not take its A or C",
            Self::Endless => "the cycle comes to no end",
            Self::Many => "the cycle makes more than 90000 moves",
        }
    }
}

/// G70 to G72.2 of `LinuxCNC`.
pub(super) fn lathe_cycle_code(number: u16, family: Family) -> Option<GCode> {
    let known = matches!(number, 700 | 710..=712 | 720..=722);
    (family == Family::Rs274 && known).then_some(GCode::LatheCycle(number))
}

impl Control<'_> {
    pub(super) fn lathe_cycle(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        run.facts.cycle = true;
        run.facts.boundary = true;
        run.facts.uses_motion = true;
        let Some(contour) = run.words.take(b'Q') else {
            return fault(
                "without Q, the number of the contour's subroutine",
                span,
                run,
            );
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
            Cycle::Rough {
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
            }
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
        } else if self.feed_mode_is(super::FeedMode::InverseTime) {
            "the cycle under G93"
        } else if self.special.left.is_some() {
            "the cycle after G88"
        } else {
            return None;
        };
        Some(message.to_owned())
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
    #[allow(clippy::too_many_arguments, reason = "a block with all that it has")]
    pub(crate) fn run_lathe_cycle(
        &mut self,
        cycle: &LatheCycle,
        reader: Reader,
        line: u64,
        text: &[u8],
        block: &Block,
        steps: &mut Vec<Step>,
        diagnostics: &mut Diagnostics,
    ) {
        let errors = diagnostics.errors;
        let mut run = Run {
            line,
            block,
            words: &mut self.words,
            facts: &mut Facts::default(),
            steps,
            report: Report {
                diagnostics,
                line,
                text,
            },
        };
        let control = &mut self.control;
        control.cut(
            &Cut {
                to: cycle.start,
                kind: CutKind::Rapid,
            },
            &mut run,
        );
        match passes::cuts(&cycle.cycle, reader.pieces, cycle.start) {
            Ok(cuts) => {
                for cut in cuts {
                    if run.report.diagnostics.errors != errors {
                        return;
                    }
                    control.cut(&cut, &mut run);
                }
            }
            Err(found) => {
                let whole = run.whole();
                fault(found.message(), whole, &mut run);
            }
        }
    }
}

impl Control<'_> {
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
