//! Where a block goes: targets in program coordinates, straight moves,
//! reference points.

use super::code::Code;
use super::{Measure, Siemens};
use crate::code::{GCode, Motion};
use crate::control::{Control, Run};
use crate::datum::Datum;
use crate::letters::AXIS_LETTERS;
use crate::places::POSITION_MAX_MM;
use gwatt_machine::{ALL_AXES, AXES, AxisKind, AxisSet, AxisValues};
use gwatt_motion::{Arc, MoveKind, Step};
use gwatt_syntax::source::Span;

/// The end of a move.
#[derive(Debug, Clone)]
pub(super) struct Target {
    /// Program coordinates, mm and degrees.
    pub(super) program: AxisValues,
    pub(super) machine: AxisValues,
    /// Axes that the block names.
    pub(super) named: AxisSet,
    /// Axes that are named but of which it is not known how far they go.
    pub(super) unknown: AxisSet,
    /// What the places rest on to which it leads.
    datums: [Option<Datum>; AXES],
    /// Full turns that DC, ACP and ACN add.
    turns: AxisValues,
}

/// Reports an axis that the machine does not have.
fn refuse_axis(letter: u8, run: &mut Run<'_, '_>) {
    let span = run.words.span(letter, run.block);
    let letter = letter as char;
    let message = format!("the machine has no {letter} axis");
    run.report
        .error("no-such-axis", message, span)
        .help(format!(
            "choose a machine with it, or describe it in the machine file: [axes.{letter}]"
        ));
}

impl Siemens {
    /// Keeps what follows from the moves to a target, those since there were `before`
    /// steps.
    pub(super) fn arrive(&mut self, target: &Target, before: usize, run: &mut Run<'_, '_>) {
        for step in run.steps.iter_mut().skip(before) {
            if let Step::Move(mv) = step {
                mv.feed_mm_s *= self.feed_factor;
            }
        }
        for axis in target.named.iter() {
            self.turns[axis] += target.turns[axis];
        }
        self.adrift.0 &= !target.named.0;
    }
}

impl Control<'_> {
    /// The motion of a block.
    pub(super) fn siemens_motion(&mut self, state: &mut Siemens, run: &mut Run<'_, '_>) {
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            match code {
                GCode::Siemens(Code::Reference) => {
                    return self.siemens_reference(number, state, run);
                }
                GCode::Siemens(Code::Pole(which)) => return self.set_pole(which, span, state, run),
                _ => {}
            }
        }
        let extra = &state.extra;
        let polar = extra.polar_angle.is_some() || extra.polar_radius.is_some();
        let through = extra.through_point || extra.via.iter().any(Option::is_some);
        let arc = through || matches!(self.modal.motion, Motion::ArcCw | Motion::ArcCcw);
        let center = extra.opening_deg.is_some()
            || [b'I', b'J', b'K']
                .iter()
                .any(|letter| run.words.has(*letter));
        if !(run.words.has_axes() || polar || arc && center || through) {
            return;
        }
        run.facts.uses_motion = true;
        run.facts.uses_feed = self.obeys_feed();
        if state.feed_factor != 1.0 {
            run.facts.fixed = Some("a feed override is in force (OVR)");
        }
        let Some(target) = self.siemens_target(state, run) else {
            return;
        };
        let tapping = GCode::Siemens(Code::Tapping);
        if run.words.g.iter().any(|(code, ..)| *code == tapping) {
            return self.at_any_mode(|control| control.floating_tap(state, &target, run));
        }
        if let Motion::Special(number) = self.modal.motion {
            return self.at_any_mode(|control| {
                control.siemens_thread(number, state, &target, run);
            });
        }
        if arc {
            run.facts.uses_feed = true;
            return self.siemens_arc(state, target, run);
        }
        let kind = match self.modal.motion {
            Motion::Linear => MoveKind::Feed,
            Motion::None if !self.goes_before_any_word(run) => return,
            _ => MoveKind::Rapid,
        };
        self.siemens_go(state, run, kind, &target, None);
    }

    /// Moves to the target, and keeps what follows from it.
    pub(super) fn siemens_go(
        &mut self,
        state: &mut Siemens,
        run: &mut Run<'_, '_>,
        kind: MoveKind,
        target: &Target,
        arc: Option<Arc>,
    ) {
        let before = run.steps.len();
        for (axis, datum) in target.datums.iter().enumerate() {
            if let Some(datum) = datum {
                self.position.datums.place(axis, *datum);
            }
        }
        self.go(run, kind, &target.machine, target.unknown, arc);
        state.arrive(target, before, run);
    }

    /// Notes what the place rests on to which an axis goes, and whether it is known how far
    /// that is.
    fn put_on(&self, target: &mut Target, axis: usize, machine_coordinates: bool) {
        let datum = if machine_coordinates {
            self.machine_datum(axis)
        } else {
            self.program_datum(axis)
        };
        target.datums[axis] = Some(datum);
        if self.position.is_apart(axis, datum) {
            target.unknown.insert(axis);
        }
    }

    /// Reads the axis words and polar coordinates. `None` when something was
    /// wrong.
    pub(super) fn siemens_target(
        &self,
        state: &mut Siemens,
        run: &mut Run<'_, '_>,
    ) -> Option<Target> {
        let errors = run.report.diagnostics.errors;
        let from = state.increments_from(&self.position.at);
        let mut target = Target {
            program: state.program_place(&self.position.at),
            machine: self.position.at,
            named: AxisSet::default(),
            unknown: AxisSet::default(),
            datums: [None; AXES],
            turns: [0.0; AXES],
        };
        let words: arrayvec::ArrayVec<(usize, f64), AXES> = run.words.axes().collect();
        run.words.unused &= !AXIS_LETTERS;
        let suppressed = state.extra.machine_coordinates;
        for (axis, value) in words {
            let letter = ALL_AXES[axis].letter();
            let Some(data) = &self.machine.axes[axis] else {
                refuse_axis(letter, run);
                continue;
            };
            let measure = match state.extra.measures[axis] {
                Measure::Modal if self.modal.absolute => Measure::Absolute,
                Measure::Modal => Measure::Increment,
                measure => measure,
            };
            let radius = state.radius_increments && measure == Measure::Increment;
            let diameter = if axis == 0 && state.diameter && !radius {
                0.5
            } else {
                1.0
            };
            let value = value * self.unit_of(axis) * diameter;
            target.named.insert(axis);
            let unknown = self.position.unknown.contains(axis);
            match measure {
                Measure::Increment => {
                    if state.adrift.contains(axis) {
                        let span = run.words.span(letter, run.block);
                        let message = "an increment right after a change of the frame: \
                                       the offset is traversed too (SD42440 = 1)";
                        run.report.note_once("frame-increment", message, span);
                    }
                    target.program[axis] = from[axis] + value;
                    target.machine[axis] += value;
                }
                Measure::Direct | Measure::Positive | Measure::Negative => {
                    if data.kind == AxisKind::Linear || unknown || suppressed {
                        let span = run.words.span(letter, run.block);
                        let message = "DC, ACP and ACN go with rotary axes whose position is known";
                        run.report
                            .error("rotary-target", message, span)
                            .help("write a plain value");
                    }
                    let way = turn(target.program[axis], value, measure);
                    target.turns[axis] = target.program[axis] + way - value;
                    target.program[axis] += way;
                }
                _ => {
                    target.program[axis] = value;
                    target.machine[axis] = value;
                    self.put_on(&mut target, axis, suppressed);
                }
            }
        }
        self.polar_target(state, &mut target, &from, run);
        if !suppressed {
            self.map_target(state, &mut target, run);
        }
        if target
            .machine
            .iter()
            .any(|place| place.is_nan() || place.abs() > POSITION_MAX_MM)
        {
            let span = run.whole();
            run.report
                .error("position-range", "the position is beyond any machine", span)
                .help("check the number");
        }
        (run.report.diagnostics.errors == errors).then_some(target)
    }

    /// Program coordinates to machine coordinates, for the axes that move.
    fn map_target(&self, state: &Siemens, target: &mut Target, run: &mut Run<'_, '_>) {
        let place = state.machine_place(&target.program);
        for (axis, place) in place.into_iter().enumerate() {
            target.machine[axis] = self.position.at[axis];
            if !target.named.iter().any(|by| state.frame.depends(axis, by)) {
                continue;
            }
            target.machine[axis] = place;
            let mixed = (0..AXES).any(|by| {
                by != axis && state.frame.depends(axis, by) && self.position.unknown.contains(by)
            });
            if mixed && !state.frame.is_plain() {
                let span = run.whole();
                run.report
                    .error(
                        "turned-from-unknown",
                        "a move in turned coordinates from a position that is not known",
                        span,
                    )
                    .help("give --start X0,Y0,Z0, or move the axes first");
                return;
            }
        }
    }

    /// A target in program coordinates of some axes, for cycles.
    pub(super) fn target_at(&self, state: &Siemens, places: &[(usize, f64)]) -> Target {
        let mut target = Target {
            program: state.program_place(&self.position.at),
            machine: self.position.at,
            named: AxisSet::default(),
            unknown: AxisSet::default(),
            datums: [None; AXES],
            turns: [0.0; AXES],
        };
        for &(axis, value) in places {
            target.program[axis] = value;
            target.named.insert(axis);
            self.put_on(&mut target, axis, false);
        }
        let place = state.machine_place(&target.program);
        for (axis, place) in place.into_iter().enumerate() {
            if target.named.iter().any(|by| state.frame.depends(axis, by)) {
                target.machine[axis] = place;
            }
        }
        target
    }

    /// G74 and G75 ("Reference point approach", "Fixed point approach"): the
    /// points are data of the machine. Those of G74 may be in the machine file, all
    /// others are taken as its zero.
    fn siemens_reference(&mut self, number: u16, state: &mut Siemens, run: &mut Run<'_, '_>) {
        let span = run.whole();
        let Some(point) = fixed_point(number, state, span, run) else {
            return;
        };
        run.facts.reference = Some(point);
        let mut named = AxisSet::default();
        run.words.axes().for_each(|(axis, _)| named.insert(axis));
        run.words.unused &= !AXIS_LETTERS;
        if named.is_empty() {
            let message = format!("G{} without axes", number / 10);
            run.report
                .error("reference-axes", message, span)
                .help("name the axes, as in G74 X1=0");
            return;
        }
        let mut target = self.target_at(state, &[]);
        for axis in named.iter() {
            if self.machine.axes[axis].is_none() {
                let message = format!(
                    "the machine has no {} axis",
                    ALL_AXES[axis].letter() as char
                );
                run.report
                    .error("no-such-axis", message, span)
                    .help("choose a machine with it, or describe it in the machine file");
                return;
            }
            let place_mm = self.known_reference(point, axis);
            if place_mm.is_none() {
                let message =
                    "the reference and fixed points of G74 and G75 are taken as machine zero";
                run.report.note_once("reference-point", message, span);
            }
            let datum = match place_mm {
                Some(_) => Datum::Machine,
                None => Datum::Reference(point),
            };
            target.datums[axis] = Some(datum);
            if self.position.is_apart(axis, datum) {
                target.unknown.insert(axis);
            }
            target.machine[axis] = place_mm.unwrap_or(0.0);
            state.turns[axis] = 0.0;
        }
        target.named = named;
        let knobs = self.knobs.clone();
        if number == 740 {
            self.unlimited_return();
            self.knobs.rapid_factor *= self.return_factor(&target.machine, named, target.unknown);
        }
        self.siemens_go(state, run, MoveKind::Rapid, &target, None);
        self.knobs = knobs;
        self.settle();
    }
}

/// The number of the point that G74, or G75 with FP, goes to; the first fixed point is the
/// second of all.
fn fixed_point(number: u16, state: &Siemens, span: Span, run: &mut Run<'_, '_>) -> Option<u16> {
    if number == 740 {
        return Some(1);
    }
    let point = state.extra.fixed_point.unwrap_or(1.0);
    if (1.0..=4.0).contains(&point) && point.fract() == 0.0 {
        return Some(point as u16 + 1);
    }
    run.report
        .error("reference-axes", "G75 has fixed points 1 to 4", span)
        .help("write FP=1 to FP=4, or none for the first");
    None
}

/// How far a rotary axis turns from `from` to `to`.
fn turn(from: f64, to: f64, measure: Measure) -> f64 {
    let up = (to - from).rem_euclid(360.0);
    match measure {
        Measure::Negative if up > 0.0 => up - 360.0,
        Measure::Direct if up > 180.0 => up - 360.0,
        _ => up,
    }
}
