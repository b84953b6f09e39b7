//! Words that turn, scale and mirror program coordinates.

use super::{NO_OFFSETS, Polar, Programmed, SAME_MM};
use crate::control::{Control, Run};
use crate::data_setting::out_of_range;
use crate::frame::{Affine, SPACE, sin_cos_deg};
use crate::offsets::{FURTHER, FURTHER_MAX, Offsets};
use gwatt_machine::{ALL_AXES, AXES, AxisSet, AxisValues};
use gwatt_syntax::source::Span;

/// A factor. Without a point it is in thousandths on one control and in
/// units on the next.
fn factor(letter: u8, run: &mut Run<'_, '_>) -> Option<f64> {
    let value = run.words.take(letter)?;
    let word = run.words.word(letter, run.block)?;
    let text = word.number.of(run.report.text);
    if text
        .iter()
        .all(|byte| byte.is_ascii_digit() || matches!(byte, b'-' | b'+'))
    {
        run.report
            .error("scaling", "a scale without a decimal point", word.span)
            .help("write it with one, as in P2.0: controls differ in its unit");
        return None;
    }
    Some(value)
}

impl Control<'_> {
    /// G68 (`on`) and G69.
    pub(crate) fn rotation(&mut self, on: bool, span: Span, run: &mut Run<'_, '_>) {
        if !on {
            if self.programmed.rotation.is_some() {
                self.reprogram(|programmed| programmed.rotation = None);
            }
            return;
        }
        let [first, second, normal] = self.modal.plane;
        let center = self.centers(run);
        let angle = run.words.take(b'R');
        let tilted = [b'I', b'J', b'K']
            .into_iter()
            .filter(|letter| run.words.take(*letter).is_some())
            .count();
        let refused = if center[normal].is_some() || tilted > 0 {
            Some((
                "a turn out of its plane is not supported",
                "write G68 with the two axes of the plane and R",
            ))
        } else if self.programmed.rotation.is_some() {
            Some(("a turn is in force already", "end it by G69 before"))
        } else if self.programmed.mirrored() {
            Some((
                "a turn in mirrored coordinates is not supported",
                "end mirroring before",
            ))
        } else if !self.modal.absolute {
            Some((
                "under G91 the control's parameters say what G68 means",
                "write G90 before G68",
            ))
        } else {
            None
        };
        if let Some((message, help)) = refused {
            run.report.error("rotation", message, span).help(help);
            return;
        }
        let Some(angle) = angle else {
            run.report
                .error("rotation", "G68 without its angle", span)
                .help("write the angle as R");
            return;
        };
        let Some(mut at) = self.filled(center, [first, second], run) else {
            return;
        };
        if let Some(scaling) = &self.programmed.scaling {
            // The centre is scaled like any point, the angle is not.
            at = scaling.apply(at);
        }
        let turn = Affine::rotation([first, second], [at[first], at[second]], angle);
        self.reprogram(|programmed| programmed.rotation = Some(turn));
    }

    /// The coordinate system that all others stand in.
    pub(crate) fn place_system(&mut self, system: Option<Affine>) {
        if self.programmed.system != system {
            self.reprogram(|programmed| programmed.system = system);
        }
    }

    /// G51 (`on`) and G50.
    pub(crate) fn scaling(&mut self, on: bool, span: Span, run: &mut Run<'_, '_>) {
        if !on {
            if self.programmed.scaling.is_some() {
                self.reprogram(|programmed| programmed.scaling = None);
            }
            return;
        }
        let center = self.centers(run);
        if self.programmed.rotation.is_some()
            || self.programmed.scaling.is_some()
            || self.programmed.mirrored()
        {
            run.report
                .error(
                    "scaling",
                    "G51 in scaled, turned or mirrored coordinates",
                    span,
                )
                .help("end those before");
            return;
        }
        let Some(center) = self.filled(center, [0, 1, 2], run) else {
            return;
        };
        let common = factor(b'P', run);
        let each = [b'I', b'J', b'K'].map(|letter| factor(letter, run));
        let mut factor = [1.0; SPACE];
        for (axis, factor) in factor.iter_mut().enumerate() {
            let known = self.machine.axes[axis].is_some();
            match each[axis].or(common) {
                Some(value) if value != 0.0 && value.abs() <= 1e4 => *factor = value,
                None if !known => {}
                _ => {
                    run.report
                        .error("scaling", "G51 needs a factor for every axis", span)
                        .help("write P2.0, or I, J and K, with a point");
                    return;
                }
            }
        }
        let map = Affine::scaling(center, factor);
        self.reprogram(|programmed| programmed.scaling = Some(map));
    }

    /// G51.1 (`on`) and G50.1.
    pub(crate) fn mirror(&mut self, on: bool, span: Span, run: &mut Run<'_, '_>) {
        let center = self.centers(run);
        let all = center.iter().all(Option::is_none);
        if self.programmed.rotation.is_some() || self.programmed.scaling.is_some() {
            run.report
                .error("mirror", "mirroring in turned or scaled coordinates", span)
                .help("end those before");
            return;
        }
        if on && all {
            run.report
                .error("mirror", "G51.1 without axes", span)
                .help("name the axes, with the coordinates of the mirror");
            return;
        }
        self.reprogram(|programmed| {
            for (mirror, at) in programmed.mirror.iter_mut().zip(center) {
                if on && at.is_some() {
                    *mirror = at;
                } else if !on && (all || at.is_some()) {
                    *mirror = None;
                }
            }
        });
    }

    /// Coordinates of X, Y and Z that are given, mm; other axes are errors.
    fn centers(&self, run: &mut Run<'_, '_>) -> [Option<f64>; SPACE] {
        let mut center = [None; SPACE];
        let words: arrayvec::ArrayVec<_, AXES> = run.words.axes().collect();
        for (axis, value) in words {
            let letter = ALL_AXES[axis].letter();
            let value = self.length_mm(axis, value);
            run.words.take(letter);
            if let Some(slot) = center.get_mut(axis) {
                *slot = Some(value);
            } else {
                let span = run.words.span(letter, run.block);
                run.report
                    .error("rotation", "only X, Y and Z are turned and scaled", span)
                    .help("take the axis out");
            }
        }
        center
    }

    /// Coordinates that are not given are those of the place, which must be
    /// known for the axes that count.
    fn filled<const N: usize>(
        &self,
        center: [Option<f64>; SPACE],
        counting: [usize; N],
        run: &mut Run<'_, '_>,
    ) -> Option<[f64; SPACE]> {
        let here = self.position.program();
        let missing = counting.iter().any(|&axis| {
            center.get(axis).is_some_and(Option::is_none)
                && self.machine.axes[axis].is_some()
                && self.position.unknown.contains(axis)
        });
        if missing {
            let span = run.whole();
            run.report
                .error(
                    "turned-from-unknown",
                    "a turn or a scale about a position that is not known",
                    span,
                )
                .help("name its centre, or give --start X0,Y0,Z0");
            return None;
        }
        Some(std::array::from_fn(|axis| {
            center[axis].unwrap_or(here[axis])
        }))
    }

    /// Changes the map. Axes whose coordinate is no longer what the program
    /// last said are adrift.
    fn reprogram(&mut self, change: impl FnOnce(&mut Programmed)) {
        let before = self.position.program();
        for (axis, before) in before.into_iter().enumerate() {
            if !self.position.adrift.contains(axis) {
                self.programmed.believed[axis] = before;
            }
        }
        change(&mut self.programmed);
        let map = self.programmed.affine();
        self.position.change(|offsets| offsets.programmed = map);
        let after = self.position.program();
        let mut adrift = AxisSet::default();
        for (axis, believed) in self.programmed.believed.iter().enumerate() {
            if axis < SPACE && (after[axis] - believed).abs() > SAME_MM {
                adrift.insert(axis);
            }
        }
        adrift.0 &= self.machine.axis_set.0;
        self.position.adrift = adrift;
        self.note_bent();
    }

    /// Turned coordinates and places of the machine do not go together.
    pub(crate) fn refuse_turned(&self, named: AxisSet, span: Span, run: &mut Run<'_, '_>) {
        let frame = &self.position.frame;
        let turned = named
            .iter()
            .any(|axis| (0..AXES).any(|by| by != axis && frame.depends(axis, by)));
        if turned && self.rules.no_turned_machine_places {
            run.report
                .error(
                    "turned-machine",
                    "a place of the machine in turned coordinates",
                    span,
                )
                .help("end the turn by G69 before");
        }
    }

    /// G16 (`on`) and G15.
    pub(crate) fn polar_mode(&mut self, on: bool, span: Span, run: &mut Run<'_, '_>) {
        let [first, second, _] = self.modal.plane;
        let linear = [first, second].map(|axis| self.position.offsets().is_linear(axis));
        if on && linear != [true; 2] {
            run.report
                .error("polar", "G16 in a plane of rotary axes", span)
                .help("choose the plane with G17, G18 or G19");
            return;
        }
        self.polar = on.then_some(Polar {
            center: [0.0; 2],
            radius: 0.0,
            angle_deg: 0.0,
        });
        self.note_bent();
    }

    /// Under G16 the plane's first axis word is the radius, the second the
    /// angle: from the origin under G90, from the place under G91.
    pub(crate) fn polar_targets(
        &mut self,
        words: &[(usize, f64)],
        program: &mut AxisValues,
        named: &mut AxisSet,
        absolute: &mut AxisSet,
        run: &mut Run<'_, '_>,
    ) {
        let Some(mut polar) = self.polar else {
            return;
        };
        let [first, second, _] = self.modal.plane;
        let value = |axis: usize| words.iter().find(|word| word.0 == axis).map(|word| word.1);
        if value(first).is_none() && value(second).is_none() {
            return;
        }
        let arc = [b'I', b'J', b'K']
            .iter()
            .any(|letter| run.words.has(*letter));
        let unknown = self.position.unknown;
        let from_unknown =
            !self.modal.absolute && (unknown.contains(first) || unknown.contains(second));
        if arc || from_unknown {
            let span = run.whole();
            let (message, help) = if arc {
                ("an arc with a centre under G16", "write R")
            } else {
                (
                    "a polar move from a position that is not known",
                    "give --start X0,Y0,Z0",
                )
            };
            run.report.error("polar", message, span).help(help);
            return;
        }
        if let Some(radius) = value(first) {
            polar.radius = radius * self.modal.mm_per_unit;
            let here = self.position.program();
            polar.center = if self.modal.absolute {
                [0.0; 2]
            } else {
                [here[first], here[second]]
            };
        }
        if let Some(angle) = value(second) {
            polar.angle_deg = if self.modal.absolute {
                angle
            } else {
                polar.angle_deg + angle
            };
        }
        let (sin, cos) = sin_cos_deg(polar.angle_deg);
        program[first] = polar.center[0] + polar.radius * cos;
        program[second] = polar.center[1] + polar.radius * sin;
        for axis in [first, second] {
            named.insert(axis);
            absolute.insert(axis);
        }
        self.polar = Some(polar);
    }

    /// G52: Fanuc's local coordinate system; in `LinuxCNC` ("G52 Local
    /// Coordinate System Offset") the offset of G92, given outright.
    pub(crate) fn local_offset(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let words: arrayvec::ArrayVec<_, AXES> = run.words.axes().collect();
        if words.is_empty() {
            run.report
                .error("offset-axes", "G52 without axes", span)
                .help("name the axes, as in G52 X0 Y0");
            return;
        }
        if self.refuse_while_turned(span, run) {
            return;
        }
        let as_g92 = self.rules.g52_is_g92;
        for (axis, value) in words {
            let letter = ALL_AXES[axis].letter();
            run.words.take(letter);
            let value = self.length_mm(axis, value);
            if !self.axis_exists_at(axis, letter, run) || out_of_range(value, letter, run) {
                continue;
            }
            self.position.change(|offsets| {
                if as_g92 {
                    offsets.set_g92(axis, value);
                } else {
                    offsets.local[axis] = value;
                }
            });
        }
    }

    /// G54.1 P and Haas' G154 P.
    pub(crate) fn further_offset(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let number = run.words.take(b'P').unwrap_or(0.0);
        if number.fract() != 0.0 || !(1.0..=f64::from(FURTHER_MAX)).contains(&number) {
            run.report
                .error(
                    "work-offset",
                    "G54.1 without the number of its offset",
                    span,
                )
                .help("write it as P, from 1 to 300");
            return;
        }
        self.select_system(FURTHER + number as u16, span, run);
    }

    /// G54 to G59.3 and further ones: the axes stay where they are.
    pub(crate) fn select_system(&mut self, system: u16, span: Span, run: &mut Run<'_, '_>) {
        let before = self.position.offsets();
        if system == before.system || self.refuse_while_turned(span, run) {
            return;
        }
        let zero = before.origin_of(system) == [0.0; AXES] && before.rotation_of(system) == 0.0;
        self.position.change(|offsets| offsets.select(system));
        if system > 1 && zero && !self.position.offsets().is_known() {
            run.report.note_once("no-offsets", NO_OFFSETS, span);
        }
        self.note_bent();
    }

    /// G92.3: what G92 has stored, in this program or before.
    pub(crate) fn restore_offset(&mut self, span: Span, run: &mut Run<'_, '_>) {
        let offsets = self.position.offsets();
        let unknown =
            (0..AXES).any(|axis| self.machine.axes[axis].is_some() && !offsets.is_g92_told(axis));
        self.position.change(Offsets::restore_g92);
        if unknown {
            run.report.note_once("no-offsets", NO_OFFSETS, span);
            self.set_all_unknown();
        }
    }

    /// Fanuc forbids new coordinate systems while the program is turned.
    pub(crate) fn refuse_while_turned(&self, span: Span, run: &mut Run<'_, '_>) -> bool {
        let turned = self.programmed.rotation.is_some() || self.programmed.scaling.is_some();
        if turned {
            run.report
                .error(
                    "turned-system",
                    "another coordinate system while the program is turned or scaled",
                    span,
                )
                .help("end that by G69 or G50 before");
        }
        turned
    }
}
