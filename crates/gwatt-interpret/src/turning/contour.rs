//! G70 to G73: cycles about a contour, which stands in the blocks from P to Q
//! ("Stock Removal in Turning (G71)", "Stock Removal in Facing (G72)", "Pattern
//! Repeating (G73)", "Finishing Cycle (G70)").
//!
//! These blocks are executed where the cycle stands, and what they do is kept:
//! it is the contour. The program then goes on after them; after G70 it goes
//! on at the next block.

use super::state::{Contour, ContourCycle};
use super::words::{note_parameter, turning_needs};
use super::{X, Z};
use crate::control::{Control, Effects, HeldBlock, Run};
use crate::execute::Interpreter;
use crate::jump::Transfer;
use crate::loads::Loads;
use crate::modal::Modal;
use crate::position::Position;
use crate::report::Report;
use crate::spindle_speed::SpindleMode;
use crate::state_words::Switches;
use gwatt_motion::{Move, MoveKind, Step};
use gwatt_syntax::source::Span;

/// Divisions of G73, and lines of a contour.
const DIVISIONS_MAX: f64 = 10_000.0;

/// The state before a contour.
#[derive(Debug)]
pub(crate) struct Before {
    modal: Modal,
    position: Position,
    spindle: SpindleMode,
    switches: Switches,
    loads: Loads,
}

impl Control<'_> {
    pub(super) fn contour_cycle(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        let first = run.words.take(b'P');
        let last = run.words.take(b'Q');
        if first.is_none() && last.is_none() && number != 700 {
            self.first_of_contour(number, run);
            return;
        }
        let block = |value: Option<f64>| {
            value
                .filter(|value| (0.0..1e9).contains(value) && value.fract() == 0.0)
                .map(|value| value as u64)
        };
        let (Some(first), Some(last)) = (block(first), block(last)) else {
            turning_needs("the block numbers P and Q", number, run);
            return;
        };
        let unit = self.modal.mm_per_unit;
        let x = self.take_allowance(X, run).unwrap_or(0.0);
        let z = self.take_allowance(Z, run).unwrap_or(0.0);
        let allowance = [self.length_mm(X, x), z * unit];
        let cycle = match number {
            700 => Some(ContourCycle::Finish),
            730 => self.pattern(run),
            _ => self.rough_words(number, run),
        };
        let Some(cycle) = cycle else { return };
        let fits = allowance.iter().all(|length| length.abs() < 1e6);
        if !fits {
            contour_value("an allowance beyond reason", span, run);
            return;
        }
        self.transfer = Some(Transfer::Contour(Box::new(Contour {
            first,
            last,
            cycle,
            allowance,
            two_axes: false,
            lines: None,
        })));
    }

    /// `G71 U R`, `G72 W R`, `G73 U W R`: values that hold from now on.
    fn first_of_contour(&mut self, number: u16, run: &mut Run<'_, '_>) {
        let unit = self.modal.mm_per_unit;
        let x = self.take_allowance(X, run).map(|value| value * unit);
        let z = self.take_allowance(Z, run).map(|value| value * unit);
        // As it stands: it may be a count.
        let count = run.words.word(b'R', run.block).map(|word| word.value);
        let escape = self.plain_length(b'R', run).map(f64::abs);
        if number == 730 {
            let relief = [x.unwrap_or(0.0), z.unwrap_or(0.0)];
            let times = divisions(count, run);
            if let Some(times) = times {
                self.turning.relief = Some((relief, times));
            }
            return;
        }
        let depth = if number == 710 { x } else { z };
        self.turning.depth = depth.map(f64::abs).or(self.turning.depth);
        self.turning.escape = escape.or(self.turning.escape);
    }

    fn pattern(&mut self, run: &mut Run<'_, '_>) -> Option<ContourCycle> {
        if run.words.has(b'D') {
            let x = self.plain_length(b'I', run).unwrap_or(0.0);
            let z = self.plain_length(b'K', run).unwrap_or(0.0);
            let count = run.words.take(b'D');
            let times = divisions(count, run)?;
            let relief_mm = [x, z];
            return Some(ContourCycle::Pattern { relief_mm, times });
        }
        let Some((relief_mm, times)) = self.turning.relief else {
            turning_needs("its first block U W R", 730, run);
            return None;
        };
        Some(ContourCycle::Pattern { relief_mm, times })
    }

    fn rough_words(&mut self, number: u16, run: &mut Run<'_, '_>) -> Option<ContourCycle> {
        let mut depth_mm = self.turning.depth;
        let mut escape_mm = self.turning.escape;
        if run.words.has(b'D') {
            depth_mm = self.fine_length(b'D', run).map(f64::abs);
        }
        if run.words.has(b'R') {
            escape_mm = self.plain_length(b'R', run).map(f64::abs);
        }
        for letter in [b'I', b'K'] {
            if run.words.take(letter).is_some_and(|value| value != 0.0) {
                let span = run.words.span(letter, run.block);
                let message =
                    "I and K of a roughing cycle (a pass before the last) are not supported";
                contour_value(message, span, run);
                return None;
            }
        }
        let Some(depth_mm) = depth_mm.filter(|depth| *depth > 0.0) else {
            turning_needs("a depth of cut", number, run);
            return None;
        };
        let escape_mm = escape_mm.or(self.machine.controller.language.escape_mm);
        if escape_mm.is_none() {
            note_parameter(run);
        }
        Some(ContourCycle::Rough {
            deep: if number == 710 { X } else { Z },
            depth_mm,
            escape_mm: escape_mm.unwrap_or(0.0),
        })
    }
}

impl Interpreter<'_> {
    /// Keeps the state, before a contour is executed to be known.
    pub(crate) fn before_contour(&mut self, contour: &Contour) -> Box<Before> {
        self.control.turning.reads_rough = contour.cycle != ContourCycle::Finish;
        let control = &self.control;
        Box::new(Before {
            modal: control.modal.clone(),
            position: control.position.clone(),
            spindle: control.spindle,
            switches: control.switches,
            loads: control.loads,
        })
    }

    /// Makes the moves of a cycle whose contour has done `found`.
    pub(crate) fn turn(
        &mut self,
        contour: &Contour,
        before: Box<Before>,
        found: Vec<Step>,
        held: HeldBlock<'_>,
        effects: &mut Effects<'_>,
    ) {
        let HeldBlock { line, text, block } = held;
        let control = &mut self.control;
        control.turning.reads_rough = false;
        let from = before.position.at;
        let motion = before.modal.motion;
        let finish = contour.cycle == ContourCycle::Finish;
        if finish {
            control.modal.motion = motion;
        } else {
            control.modal = before.modal;
            control.position = before.position;
            control.spindle = before.spindle;
            control.switches = before.switches;
            control.loads = before.loads;
        }
        let mut run = Run {
            line,
            block,
            words: &mut self.words,
            facts: effects.facts,
            steps: effects.steps,
            report: Report {
                diagnostics: effects.diagnostics,
                line,
                text,
            },
        };
        let compensation = control.compensation.as_ref();
        if compensation.is_some_and(|compensation| compensation.shifts()) {
            let message = "a contour of a turning cycle under tool nose radius compensation, \
                           where the radius is known";
            let whole = run.whole();
            contour_value(message, whole, &mut run);
            return;
        }
        if control
            .corners
            .as_ref()
            .is_some_and(|corners| corners.holds())
        {
            let whole = run.whole();
            contour_value("a contour that ends with a rounded corner", whole, &mut run);
            return;
        }
        if !check(&found, &mut run) {
            return;
        }
        if finish {
            let number = block.number.map(|word| word.value);
            for mut step in found {
                match &mut step {
                    Step::Move(mv) => (mv.line, mv.number) = (line, number),
                    Step::Action(action) => action.line = line,
                }
                run.steps.push(step);
            }
            control.part(&mut run, MoveKind::Rapid, &from);
            return;
        }
        let moves: Vec<Move> = found
            .into_iter()
            .filter_map(|step| match step {
                Step::Move(mv) => Some(mv),
                Step::Action(_) => None,
            })
            .collect();
        control.rough(contour, &moves, &mut run);
    }
}

/// The number of divisions of G73.
fn divisions(count: Option<f64>, run: &mut Run<'_, '_>) -> Option<u64> {
    let count = count
        .filter(|count| (1.0..=DIVISIONS_MAX).contains(count) && count.fract() == 0.0)
        .map(|count| count as u64);
    if count.is_none() {
        turning_needs("its number of divisions, from 1", 730, run);
    }
    count
}

/// Reports what is wrong about a contour.
pub(super) fn contour_value(message: &str, span: Span, run: &mut Run<'_, '_>) {
    run.report
        .error("contour", message, span)
        .help("write the passes out, or check the words of the cycle");
}

/// Whether a contour consists of what cycles can follow.
fn check(found: &[Step], run: &mut Run<'_, '_>) -> bool {
    let fine = found.iter().all(|step| match step {
        Step::Move(mv) => {
            matches!(
                mv.kind,
                MoveKind::Rapid | MoveKind::Feed | MoveKind::Arc | MoveKind::Dwell
            ) && mv.moving.iter().all(|axis| axis == X || axis == Z)
        }
        Step::Action(_) => true,
    });
    if !fine {
        let whole = run.whole();
        run.report
            .error(
                "contour",
                "the contour of a turning cycle holds more than straight moves and arcs in X and Z",
                whole,
            )
            .help("write G0 to G3 with X and Z between the blocks of P and Q");
    }
    fine
}
