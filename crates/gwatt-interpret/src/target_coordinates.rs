//! Targets that are more than offsets: turned, scaled or mirrored coordinates,
//! polar coordinates, diameters.

use super::control::{Control, Run};
use super::frame::sin_cos_deg;
use super::letters::{AXIS_LETTERS, POLAR, bit};
use gwatt_machine::{ALL_AXES, AXES, AxisSet, AxisValues};
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// Whether the targets of a block need [`Self::bent_targets`].
    #[inline]
    pub(super) fn is_bent(&self, run: &Run<'_, '_>) -> bool {
        self.bent || run.words.present & POLAR != 0
    }

    /// Keeps the answer to what makes targets more than offsets.
    pub(super) fn note_bent(&mut self) {
        self.bent = !self.position.frame.is_plain()
            || self.modal.diameter
            || self.polar.is_some()
            || self.dialect().lathe.is_some()
            || !self.position.adrift.is_empty();
    }

    /// A length of an axis word in mm; degrees stay degrees.
    pub(super) fn length_mm(&self, axis: usize, value: f64) -> f64 {
        let offsets = self.position.offsets();
        let unit = if offsets.is_linear(axis) {
            self.modal.mm_per_unit
        } else {
            1.0
        };
        // G7 (LinuxCNC, "Lathe Diameter Mode"): X words are diameters.
        let share = if axis == 0 && self.modal.diameter {
            0.5
        } else {
            1.0
        };
        value * unit * share
    }

    /// Reads the axis words into `end`, machine coordinates, as
    /// [`Self::targets`] does.
    #[cold]
    pub(super) fn bent_targets(
        &mut self,
        run: &mut Run<'_, '_>,
        machine_coordinates: bool,
        end: &mut AxisValues,
    ) -> Option<AxisSet> {
        let errors = run.report.diagnostics.errors;
        let words: arrayvec::ArrayVec<_, AXES> = run.words.axes().collect();
        let start = self.position.program();
        let mut program = start;
        let mut named = AxisSet::default();
        let mut unknown = AxisSet::default();
        for &(axis, value) in &words {
            if self.axis_exists(axis, run) {
                named.insert(axis);
                let value = self.length_mm(axis, value);
                if machine_coordinates {
                    end[axis] = value;
                } else if self.is_absolute(axis, run) {
                    program[axis] = value;
                } else {
                    program[axis] += value;
                }
                if machine_coordinates || self.is_absolute(axis, run) {
                    unknown.insert(axis);
                }
            }
        }
        let whole = run.whole();
        if machine_coordinates {
            self.refuse_turned(named, whole, run);
        }
        if run.words.unused & POLAR != 0 {
            if machine_coordinates {
                run.report
                    .error("polar-in-g53", "G53 with polar coordinates", whole)
                    .help("write X and Y");
            }
            self.polar_words(&mut program, named, run);
            for axis in [0, 1] {
                named.insert(axis);
                unknown.insert(axis);
            }
        } else if self.polar.is_some() && !machine_coordinates {
            self.polar_targets(&words, &mut program, &mut named, &mut unknown, run);
        }
        run.words.unused &= !(AXIS_LETTERS | POLAR);
        if !machine_coordinates {
            self.map_targets(&program, named, unknown, end, run);
        }
        if self.rules.leaves_axes_adrift {
            self.name_adrift(named, unknown, machine_coordinates, whole, run);
        }
        if end
            .iter()
            .any(|place| place.abs() > super::places::POSITION_MAX_MM)
        {
            run.report
                .error(
                    "position-range",
                    "the position is beyond any machine",
                    whole,
                )
                .help("check the number");
        }
        let unknown = self.place_all(named, unknown, machine_coordinates);
        (run.report.diagnostics.errors == errors).then_some(unknown)
    }

    fn is_absolute(&self, axis: usize, run: &Run<'_, '_>) -> bool {
        if run.words.incremental & bit(ALL_AXES[axis].letter()) != 0 {
            return false;
        }
        if axis == super::places::EXTRUDER {
            self.modal.extruder_absolute
        } else {
            self.modal.absolute
        }
    }

    /// Program coordinates to machine coordinates, for the axes that move.
    fn map_targets(
        &self,
        program: &AxisValues,
        named: AxisSet,
        absolute: AxisSet,
        end: &mut AxisValues,
        run: &mut Run<'_, '_>,
    ) {
        let frame = &self.position.frame;
        let machine = frame.machine(program);
        for axis in 0..AXES {
            if !named.iter().any(|by| frame.depends(axis, by)) {
                // Exactly where it is, without rounding on the way.
                continue;
            }
            end[axis] = machine[axis];
            // A place that is not known must not be mixed into another axis.
            let mixed = (0..AXES).find(|&by| {
                by != axis
                    && frame.depends(axis, by)
                    && self.position.unknown.contains(by)
                    && !absolute.contains(by)
            });
            if mixed.is_some() {
                let span = run.whole();
                run.report
                    .error(
                        "turned-from-unknown",
                        "a move in turned coordinates from a position that is not known",
                        span,
                    )
                    .help("name all axes of the plane, or give --start X0,Y0,Z0");
                return;
            }
        }
    }

    /// `@` and `^` (`LinuxCNC`, "Polar Coordinates"): distance and angle in XY
    /// from the origin; under G91 each is added to that of the place.
    fn polar_words(&self, program: &mut AxisValues, named: AxisSet, run: &mut Run<'_, '_>) {
        let span = run.whole();
        let distance = run
            .words
            .take(b'@')
            .map(|value| value * self.modal.mm_per_unit);
        let angle = run.words.take(b'^');
        if named.contains(0) || named.contains(1) {
            run.report
                .error("polar-mixed", "polar coordinates with X or Y", span)
                .help("write either of them");
            return;
        }
        let [x, y, ..] = *program;
        let here = libm::hypot(x, y);
        let needs_place = !self.modal.absolute || angle.is_none();
        let known = |axis| !self.position.unknown.contains(axis);
        if !(known(0) && known(1)) && (needs_place || distance.is_none()) {
            run.report
                .error(
                    "polar-from-unknown",
                    "a polar move from a position that is not known",
                    span,
                )
                .help("write both @ and ^ under G90, or give --start X0,Y0,Z0");
            return;
        }
        if here == 0.0 && needs_place {
            run.report
                .error(
                    "polar-origin",
                    "a polar move that starts from the origin has no angle",
                    span,
                )
                .help("write both @ and ^ under G90");
            return;
        }
        let here_deg = libm::atan2(y, x).to_degrees();
        let (radius, angle_deg) = if self.modal.absolute {
            (distance.unwrap_or(here), angle.unwrap_or(here_deg))
        } else {
            (
                here + distance.unwrap_or(0.0),
                here_deg + angle.unwrap_or(0.0),
            )
        };
        let (sin, cos) = sin_cos_deg(angle_deg);
        program[0] = radius * cos;
        program[1] = radius * sin;
    }

    /// After a turn has begun or ended, Fanuc starts from the last programmed
    /// coordinates of the axes that are not named, which differ from where they
    /// stand: an absolute move must name all of them first.
    fn name_adrift(
        &mut self,
        named: AxisSet,
        absolute: AxisSet,
        machine_coordinates: bool,
        span: Span,
        run: &mut Run<'_, '_>,
    ) {
        let adrift = self.position.adrift;
        if adrift.is_empty() {
            return;
        }
        let touches = absolute.0 & adrift.0 != 0;
        if touches && adrift.0 & !absolute.0 != 0 && !machine_coordinates {
            run.report
                .error(
                    "turned-axes",
                    "the first absolute move after a turn or a scale must name all its axes",
                    span,
                )
                .help("name them all; what the others would do depends on the control");
        }
        if touches {
            self.position.adrift.0 &= !named.0;
            self.note_bent();
        }
    }
}
