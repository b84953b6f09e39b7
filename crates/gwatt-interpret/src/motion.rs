//! Motion: straight moves, arcs, reference points, and G92.

use super::arc_words::lone_arc;
use super::code::{GCode, Motion};
use super::control::{Control, Run};
use super::letters::{AXIS_LETTERS, bit};
use super::places::{EXTRUDER, POSITION_MAX_MM, STANDSTILL_MM};
use super::printer::Course;
use super::report::Report;
use super::stray;
use gwatt_machine::{ALL_AXES, AxisKind, AxisSet, AxisValues};
use gwatt_motion::{Arc, Move, MoveKind, Step, Stray, hold_to_path, path_length};
use gwatt_syntax::source::Span;

/// Where a move goes.
#[derive(Clone, Copy)]
struct Way<'a> {
    kind: MoveKind,
    end: &'a AxisValues,
    /// Axes whose place at its start is not known.
    unknown_start: AxisSet,
    arc: Option<Arc>,
}

impl Control<'_> {
    /// The block's motion, with what else uses axis words.
    pub(super) fn motion(&mut self, run: &mut Run<'_, '_>) {
        if self.special.left.is_some() && !self.may_follow_a_stop(run) {
            return;
        }
        if run.words.only_moves() {
            return self.move_on(run);
        }
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            match code {
                GCode::Reference => return self.reference(number, span, run),
                GCode::Skip => return self.skip(run),
                GCode::Turning(number) => return self.turning_block(number, span, run),
                GCode::Pocket(clockwise) => return self.circular_pocket(clockwise, span, run),
                GCode::LatheCycle(number) => return self.lathe_cycle(number, span, run),
                GCode::SetOffset => return self.set_offset(span, run),
                GCode::ClearOffset { .. }
                    if run.words.has_axes() && !self.rules.places_in_parameters =>
                {
                    let message = "G92.1 with axes presets the coordinate system, which is not \
                                   followed";
                    run.report
                        .error("unsupported-code", message, span)
                        .help("write it without axes, or select the work offset again");
                    return;
                }
                GCode::ClearOffset { forget } => self.position.clear_offset(forget),
                GCode::RestoreOffset => self.restore_offset(span, run),
                GCode::SaveReference => self.save_reference(number, span, run),
                GCode::DataSetting => return self.data_setting(span, run),
                GCode::LocalOffset => return self.local_offset(span, run),
                GCode::Rotation(on) => self.rotation(on, span, run),
                // A lathe's G50 (G-code system A) is what G92 is elsewhere.
                GCode::Scaling(false) if run.words.has_axes() => {
                    return self.set_offset(span, run);
                }
                GCode::Scaling(on) => self.scaling(on, span, run),
                GCode::Mirror(on) => self.mirror(on, span, run),
                _ => {}
            }
        }
        self.move_on(run);
    }

    /// Moves by the motion word in force.
    #[inline]
    fn move_on(&mut self, run: &mut Run<'_, '_>) {
        if let Motion::Special(number) = self.modal.motion {
            return self.special_motion(number, run);
        }
        let arc = matches!(self.modal.motion, Motion::ArcCw | Motion::ArcCcw);
        let center = run.words.unused & (bit(b'I') | bit(b'J') | bit(b'K')) != 0;
        if !(run.words.has_axes() || arc && center) {
            let family = self.machine.controller.language.family.facts();
            if arc && family.arcs_need_words {
                lone_arc(run);
            }
            return;
        }
        run.facts.uses_motion = true;
        run.facts.uses_feed = self.obeys_feed();
        match self.modal.motion {
            Motion::None | Motion::Special(_) => {
                if self.goes_before_any_word(run) {
                    self.straight(run);
                }
            }
            Motion::Rapid | Motion::Linear => self.straight(run),
            Motion::ArcCw | Motion::ArcCcw => self.arc(run),
        }
    }

    /// A dwell where the axes stand.
    pub(super) fn dwell(&self, run: &mut Run<'_, '_>, dwell_s: f64) {
        run.steps.push(Step::Move(Move {
            line: run.line,
            number: run.block.number.map(|word| word.value),
            run: self.run,
            text: self.text,
            kind: MoveKind::Dwell,
            start: self.position.at,
            end: self.position.at,
            moving: AxisSet::default(),
            unknown_start: AxisSet::default(),
            assumed_start: AxisSet::default(),
            arc: None,
            length_mm: 0.0,
            feed_mm_s: f64::INFINITY,
            feed_excess: 1.0,
            feed_mode: self.modal.feed_mode,
            accel_mm_s2: self.knobs.feed_accel_mm_s2,
            path_accel_mm_s2: f64::INFINITY,
            jerk_factor: 1.0,
            rapid_factor: self.knobs.rapid_factor,
            pace: 1.0,
            dwell_s,
            loads: self.loads.on(),
            path_mode: self.modal.path_mode,
            corner: self.modal.corner,
            stray: Stray::NONE,
        }));
    }

    /// Reads the axis words into `end`, machine coordinates, which holds the place
    /// that incremental words count from. Returns the axes
    /// whose start is not known; `None` when something was wrong.
    pub(super) fn targets(
        &mut self,
        run: &mut Run<'_, '_>,
        machine_coordinates: bool,
        end: &mut AxisValues,
    ) -> Option<AxisSet> {
        if self.has_unstated() && self.refuses_unstated(run) {
            return None;
        }
        if self.is_bent(run) {
            return self.bent_targets(run, machine_coordinates, end);
        }
        let mut unknown = AxisSet::default();
        let mut fine = true;
        for (axis, value) in run.words.axes() {
            let letter = ALL_AXES[axis].letter();
            let Some(data) = &self.machine.axes[axis] else {
                let span = run.words.span(letter, run.block);
                no_such_axis(letter, span, &mut run.report);
                fine = false;
                continue;
            };
            let value = if data.kind == AxisKind::Linear {
                value * self.modal.mm_per_unit
            } else {
                value
            };
            let absolute = if axis == EXTRUDER {
                self.modal.extruder_absolute
            } else {
                self.modal.absolute
            };
            end[axis] = if machine_coordinates {
                value
            } else if absolute {
                self.position.frame.shifted(axis, value)
            } else {
                end[axis] + value
            };
            let placed = absolute || machine_coordinates;
            if placed && self.places(axis, machine_coordinates) || self.position.points.apart() {
                unknown.insert(axis);
            }
            if end[axis].abs() > POSITION_MAX_MM {
                let span = run.words.span(letter, run.block);
                run.report
                    .error("position-range", "the position is beyond any machine", span)
                    .help("check the number");
                fine = false;
            }
        }
        run.words.unused &= !AXIS_LETTERS;
        fine.then_some(unknown)
    }

    /// Whether the machine has an axis; reported where it has not.
    pub(super) fn axis_exists(&self, axis: usize, run: &mut Run<'_, '_>) -> bool {
        self.axis_exists_at(axis, ALL_AXES[axis].letter(), run)
    }

    /// The same for the word of that letter.
    pub(super) fn axis_exists_at(&self, axis: usize, letter: u8, run: &mut Run<'_, '_>) -> bool {
        if self.machine.axes[axis].is_some() {
            return true;
        }
        let span = run.words.span(letter, run.block);
        no_such_axis(letter, span, &mut run.report);
        false
    }

    /// Refuses G53 under G91 where that is not the same on all controls.
    fn refuses_machine_increment(&self, run: &mut Run<'_, '_>) -> bool {
        let family = self.machine.controller.language.family.facts();
        let differs = run.facts.machine_coordinates
            && !self.modal.absolute
            && family.increments_in_machine_differ;
        if differs {
            let message = "G53 under G91: controls ignore it, or take it as an increment";
            let span = run.whole();
            run.report
                .error("incremental-in-g53", message, span)
                .help("write G90 in the block, if it names a place of the machine");
        }
        differs
    }

    pub(super) fn straight(&mut self, run: &mut Run<'_, '_>) {
        if self.refuses_machine_increment(run) {
            return;
        }
        let language = &self.machine.controller.language;
        let always = run.facts.machine_coordinates && language.moves_in_machine_at_rapid;
        let rapid = (always || matches!(self.modal.motion, Motion::Rapid | Motion::None))
            && !language.rapid_uses_feed;
        if always && self.modal.motion == Motion::Linear {
            let message = "G53 under G1 counts as a rapid";
            let span = run.whole();
            run.report.note_once("rapid-in-g53", message, span);
        }
        let kind = if rapid {
            MoveKind::Rapid
        } else {
            MoveKind::Feed
        };
        let mut end = self.believed();
        let machine_coordinates = run.facts.machine_coordinates;
        if let Some(unknown) = self.targets(run, machine_coordinates, &mut end) {
            if self.printer.adjusts {
                self.scale_extrusion(run, &mut end, unknown, false);
            }
            self.go(run, kind, &end, unknown, None);
        }
    }

    /// Moves to `end`: a straight line, or `arc`.
    pub(super) fn go(
        &mut self,
        run: &mut Run<'_, '_>,
        kind: MoveKind,
        end: &AxisValues,
        unknown_start: AxisSet,
        arc: Option<Arc>,
    ) {
        let way = Way {
            kind,
            end,
            unknown_start,
            arc,
        };
        self.go_along(run, way, None);
    }

    /// A feed in a straight line to `end`, at a speed of its own instead of F.
    pub(super) fn go_at(
        &mut self,
        run: &mut Run<'_, '_>,
        end: &AxisValues,
        unknown_start: AxisSet,
        speed_mm_s: Option<f64>,
    ) {
        let way = Way {
            kind: MoveKind::Feed,
            end,
            unknown_start,
            arc: None,
        };
        self.go_along(run, way, speed_mm_s);
    }

    #[inline]
    fn go_along(&mut self, run: &mut Run<'_, '_>, way: Way<'_>, given_mm_s: Option<f64>) {
        let Way {
            kind,
            end,
            unknown_start,
            arc,
        } = way;
        let start = &self.position.at;
        let mut moving = AxisSet::default();
        for axis in self.machine.axis_set.iter() {
            if (end[axis] - start[axis]).abs() > STANDSTILL_MM {
                moving.insert(axis);
            }
        }
        let assumed_start = self.assumed(unknown_start);
        moving.0 &= !unknown_start.0 | assumed_start.0;
        if let Some(arc) = &arc {
            moving.insert(arc.plane[0]);
            moving.insert(arc.plane[1]);
        }
        let (length_mm, linear) = path_length(start, end, moving, arc.as_ref());
        let Some(mut feed_mm_s) = self.speed_of(run, &way, given_mm_s, (length_mm, linear)) else {
            return;
        };
        let commanded = AxisSet(moving.0 | unknown_start.0);
        let (mut rapid_factor, mut feed_excess) = (self.knobs.rapid_factor, 1.0);
        // Threads follow the spindle.
        if self.printer.adjusts && !matches!(kind, MoveKind::Thread | MoveKind::Tap) {
            let turning = arc
                .as_ref()
                .map_or(0, |arc| 1 << arc.plane[0] | 1 << arc.plane[1]);
            let course = Course {
                end,
                commanded,
                turning: AxisSet(turning),
                length_mm,
                unknown: !unknown_start.is_empty(),
            };
            (feed_mm_s, feed_excess) =
                self.printer_speed(run, &course, feed_mm_s, given_mm_s.is_some());
            rapid_factor *= self.speed_factor(&course, kind == MoveKind::Rapid);
        }
        let (accel_mm_s2, path_accel_mm_s2) = self.accels(kind, commanded, end, unknown_start);
        run.facts.beam_is_lit |= kind == MoveKind::Rapid && self.beam_waits_for_feed();
        let strays = |arc| stray::of_arc(arc, &self.position.at, end);
        let stray = arc.as_ref().map_or(Stray::NONE, strays);
        (self.moved, self.printer.stands) = (true, false);
        self.printer.pending = self.not_queued(arc.is_some(), commanded, length_mm);
        run.steps.push(Step::Move(Move {
            line: run.line,
            number: run.block.number.map(|word| word.value),
            run: self.run,
            text: self.text,
            kind,
            start: self.position.at,
            end: *end,
            moving,
            unknown_start,
            assumed_start,
            arc,
            length_mm,
            feed_mm_s,
            feed_excess,
            feed_mode: self.modal.feed_mode,
            accel_mm_s2,
            path_accel_mm_s2,
            jerk_factor: self.knobs.jerk_of(commanded),
            rapid_factor,
            pace: 1.0,
            dwell_s: 0.0,
            loads: self.loads.on(),
            path_mode: self.modal.path_mode,
            corner: self.modal.corner,
            stray,
        }));
        self.position.at = *end;
        self.special.left = None;
        self.position.unknown.0 &= !unknown_start.0;
    }

    /// The speed that a move is given, by its F or otherwise, mm/s; `None` when it was reported
    /// that there is none. The length of its way, and whether linear axes move.
    #[inline]
    fn speed_of(
        &mut self,
        run: &mut Run<'_, '_>,
        way: &Way<'_>,
        given_mm_s: Option<f64>,
        (length_mm, linear): (f64, bool),
    ) -> Option<f64> {
        let (kind, end) = (way.kind, way.end);
        let given = match kind {
            MoveKind::Thread | MoveKind::Tap => self.special.speed_mm_s,
            _ => given_mm_s,
        };
        if let Some(given_mm_s) = given {
            return Some(given_mm_s);
        }
        if kind == MoveKind::Rapid {
            return Some(f64::INFINITY);
        }
        let speed_mm_s = self.feed_speed(run, end, way.arc.as_ref(), length_mm, linear)?;
        Some(match kind {
            MoveKind::Feed if way.unknown_start.is_empty() => {
                let from = &self.position.at;
                speed_mm_s.min(self.machine.max_feed_mm_s(from, end, length_mm))
            }
            MoveKind::Feed | MoveKind::Arc => speed_mm_s.min(self.machine.path.max_feed_mm_s),
            _ => speed_mm_s,
        })
    }

    /// The limits of acceleration of a move of these axes: those of the axes, and that along the
    /// path. One of the extruder alone may have that along the path in place of its own.
    #[inline]
    pub(super) fn accels(
        &self,
        kind: MoveKind,
        moving: AxisSet,
        end: &AxisValues,
        unknown_start: AxisSet,
    ) -> (AxisValues, f64) {
        let printer = &self.machine.controller.language.printer;
        let mut accel_mm_s2 = *self.knobs.accel(kind);
        let extruded_mm = end[EXTRUDER] - self.position.at[EXTRUDER];
        let is_known = !unknown_start.contains(EXTRUDER);
        let path_mm_s2 = self.path_accel(moving, is_known.then_some(extruded_mm));
        if printer.retracts(moving, path_mm_s2) {
            accel_mm_s2[EXTRUDER] = path_mm_s2;
        }
        if !unknown_start.is_empty() {
            hold_to_path(self.machine, &mut accel_mm_s2, path_mm_s2);
            let [.., alone] = self.knobs.path_accel_mm_s2;
            if printer.may_retract(unknown_start) && alone.is_finite() {
                accel_mm_s2[EXTRUDER] = accel_mm_s2[EXTRUDER].max(alone);
            }
        }
        (accel_mm_s2, path_mm_s2)
    }

    /// The limit of acceleration along the path of a move by which the extruder goes on by
    /// `extruded_mm`, where that is known.
    #[inline]
    fn path_accel(&self, moving: AxisSet, extruded_mm: Option<f64>) -> f64 {
        let printer = &self.machine.controller.language.printer;
        let [prints, travels, alone] = self.knobs.path_accel_mm_s2;
        if moving.0 & !printer.path_accel_spares.0 == 0 {
            return alone;
        }
        if !moving.contains(EXTRUDER) {
            return travels;
        }
        match extruded_mm {
            _ if !printer.drawing_back_travels => prints,
            Some(extruded_mm) if extruded_mm > 0.0 => prints,
            Some(_) => travels,
            None => prints.max(travels),
        }
    }
}

fn no_such_axis(letter: u8, span: Span, report: &mut Report<'_, '_>) {
    let message = format!("the machine has no {} axis", letter as char);
    report.error("no-such-axis", message, span).help(format!(
        "choose a machine with it, or describe it in the machine file: [axes.{}]",
        letter as char
    ));
}
