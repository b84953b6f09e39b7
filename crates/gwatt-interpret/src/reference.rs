//! G28, G30 and G92: reference points and offsets.

use super::control::{Control, Run};
use super::datum::Datum;
use super::letters::bit;
use super::offsets::REFERENCE;
use super::places::POSITION_MAX_MM;
use crate::rules::BareG92;
use arrayvec::ArrayVec;
use gwatt_machine::{ALL_AXES, AXES, AxisSet, AxisValues, RapidPath};
use gwatt_motion::MoveKind;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// G28 and G30: to the intermediate point, then to the reference point.
    pub(super) fn reference(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        let Some(point) = reference_number(number, span, run) else {
            return;
        };
        run.facts.reference = Some(point);
        let mut named = AxisSet::default();
        run.words.axes().for_each(|(axis, _)| named.insert(axis));
        self.refuse_turned(named, span, run);
        if named.is_empty() {
            let language = &self.machine.controller.language;
            if self.rules.returns_name_axes && !language.dialect.g28_all {
                run.report
                    .error("reference-axes", "a reference point without axes", span)
                    .help("name the axes, as in G28 G91 Z0");
                return;
            }
            named = self.machine.axis_set;
        } else {
            let mut via = self.believed();
            let Some(unknown) = self.targets(run, false, &mut via) else {
                return;
            };
            self.go(run, MoveKind::Rapid, &via, unknown, None);
        }
        let (place, unknown) = self.reference_point(point, named, span, run);
        let mut home = self.position.at;
        if named != self.machine.axis_set && !self.position.frame.is_plain() {
            // LinuxCNC: the named coordinates of the program become those of
            // the point, which in turned coordinates moves other axes too.
            let frame = &self.position.frame;
            let mut program = frame.program(&home);
            let there = frame.program(&place);
            for axis in named.iter() {
                program[axis] = there[axis];
            }
            home = frame.machine(&program);
        } else {
            for axis in named.iter() {
                home[axis] = place[axis];
            }
        }
        let rapid_factor = self.knobs.rapid_factor;
        // On LinuxCNC and grbl G28 is a rapid; only homing has speeds of its own.
        let is_rapid = self.rules.returns_are_rapids;
        if point == 1 && !is_rapid {
            self.knobs.rapid_factor *= self.return_factor(&home, named, unknown);
        }
        self.go(run, MoveKind::Rapid, &home, unknown, None);
        self.knobs.rapid_factor = rapid_factor;
    }

    /// The point that G28 or G30 goes to, machine coordinates, and the axes of which it is not
    /// known how far it is: `LinuxCNC` keeps the first two among its parameters; without
    /// those, and for others, they are in the machine file.
    pub(super) fn reference_point(
        &mut self,
        point: u16,
        named: AxisSet,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> (AxisValues, AxisSet) {
        let mut place = [0.0; AXES];
        let mut apart = AxisSet::default();
        for axis in named.iter() {
            let datum = if let Some(place_mm) = self.known_reference(point, axis) {
                place[axis] = place_mm;
                let stored = self.position.datums.stored(point, axis);
                stored.unwrap_or_else(|| self.machine_datum(axis))
            } else {
                note_machine_zero(span, run);
                Datum::Reference(point)
            };
            let by_points = self.position.points.return_to_machine(axis);
            if self.position.is_apart(axis, datum) || by_points {
                apart.insert(axis);
            }
            self.position.datums.place(axis, datum);
        }
        (place, apart)
    }

    /// The place of one axis at that point, where it is known. What grbl's homing leads to is
    /// not its G28.
    pub(super) fn known_reference(&self, point: u16, axis: usize) -> Option<f64> {
        let stored = self.rules.places_in_parameters;
        let data = self.machine.axes[axis].as_ref()?;
        if stored {
            let first = *REFERENCE.get(usize::from(point - 1))?;
            let known = self.position.offsets().known_from(first, axis);
            let homes = self.machine.controller.language.loose_o_words;
            return known.or(data.reference_mm.filter(|_| point == 1 && !homes));
        }
        match point {
            1 => data.reference_mm,
            _ => data.further_reference_mm[usize::from(point - 2)],
        }
    }

    /// The share of the rapid speed at which the axes return to the reference point: no
    /// axis is faster than the machine file says.
    pub(super) fn return_factor(&self, home: &AxisValues, named: AxisSet, unknown: AxisSet) -> f64 {
        let mut times = [0.0_f64; 2];
        let mut largest = 0.0_f64;
        for axis in named.iter() {
            let Some(data) = &self.machine.axes[axis] else {
                continue;
            };
            let speed_mm_s = data.reference_mm_s.min(data.rapid_mm_s);
            let way_mm = (home[axis] - self.position.at[axis]).abs();
            times[0] = times[0].max(way_mm / data.rapid_mm_s);
            times[1] = times[1].max(way_mm / speed_mm_s);
            largest = largest.max(speed_mm_s / data.rapid_mm_s);
        }
        // Each axis for itself, or from an unknown place: the least slowed axis counts.
        let straight = self.machine.path.rapid == RapidPath::Linear && unknown.is_empty();
        if straight && times[1] > 0.0 {
            times[0] / times[1]
        } else {
            largest
        }
    }

    /// G28.1 and G30.1: the place becomes the point that G28 or G30 goes to.
    pub(super) fn save_reference(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
        let first = REFERENCE[usize::from(number == 301)];
        if self.position.unknown.0 & self.machine.axis_set.0 != 0 {
            run.report
                .error(
                    "offset-from-unknown",
                    "a reference point at a position that is not known",
                    span,
                )
                .help("give --start, or move the axes to a known position first");
            return;
        }
        let at = self.position.at;
        for axis in self.machine.axis_set.iter() {
            let point = usize::from(number == 301) + 1;
            self.position.datums.store(point, axis);
        }
        self.position.change(|offsets| {
            for (axis, value) in at.into_iter().enumerate() {
                offsets.store_axis(first, axis, value);
            }
        });
    }

    /// TF5200, "Reference point offset (G92)": the values are the offset itself,
    /// under G91 what is added to it.
    fn give_offset(&mut self, words: &[(usize, f64)], run: &mut Run<'_, '_>) {
        for &(axis, value) in words {
            let letter = ALL_AXES[axis].letter();
            run.words.take(letter);
            if !self.axis_exists_at(axis, letter, run) {
                continue;
            }
            let value_mm = self.length_mm(axis, value);
            let before = self.position.shifts()[axis];
            let base = if self.modal.absolute { 0.0 } else { before };
            self.position
                .change(|offsets| offsets.set_g92(axis, base + value_mm));
        }
    }

    pub(super) fn set_offset(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let mut words: ArrayVec<(usize, f64), AXES> = run.words.axes().collect();
        if self.rules.g92_gives_offset {
            return self.give_offset(&words, run);
        }
        if self.refuse_while_turned(span, run) {
            return;
        }
        if words.is_empty() {
            let clamps = run.words.present & bit(b'S') != 0;
            match self.rules.bare_g92 {
                BareG92::Clamp if clamps => return,
                BareG92::Clamp | BareG92::Refused => {
                    run.report
                        .error("offset-axes", "G92 without axes", span)
                        .help("name the axes, as in G92 X0");
                    return;
                }
                BareG92::AllAxes => {}
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
            if !self.axis_exists_at(axis, letter, run) {
                continue;
            }
            let frame = &self.position.frame;
            let unknown = self.position.unknown;
            if self.rules.relative_places {
                // Only differences of positions matter to a printer.
                self.position.unknown.0 &= !(1 << axis);
            } else if unknown.iter().any(|by| frame.depends(by, axis)) {
                run.report
                    .error(
                        "offset-from-unknown",
                        "G92 for an axis whose position is not known",
                        at,
                    )
                    .help("give --start, or move the axis to a known position first");
                continue;
            }
            let mut value = self.length_mm(axis, value);
            if run.words.incremental & bit(letter) != 0 {
                // G50 U W of a lathe: the coordinates change by so much.
                value += self.position.program()[axis];
            }
            if value.abs() > POSITION_MAX_MM {
                run.report
                    .error("position-range", "the position is beyond any machine", at)
                    .help("check the number");
                continue;
            }
            self.set_coordinate(axis, value);
        }
    }
}

fn note_machine_zero(span: Span, run: &mut Run<'_, '_>) {
    let message = "the reference points of G28 and G30 are taken as machine zero";
    run.report.note_once("reference-point", message, span);
}

/// The number of the point that G28 or G30 goes to: P of G30, which is 2 without it.
fn reference_number(number: u16, span: Span, run: &mut Run<'_, '_>) -> Option<u16> {
    if number != 300 {
        return Some(1);
    }
    let point = run.words.take(b'P').unwrap_or(2.0);
    if (1.0..=4.0).contains(&point) && point.fract() == 0.0 {
        return Some(point as u16);
    }
    run.report
        .error("reference-axes", "G30 has reference points 2 to 4", span)
        .help("write P2, P3 or P4, or none for the second");
    None
}
