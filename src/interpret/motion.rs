//! Motion: straight moves, arcs, reference points, and G92.

use arrayvec::ArrayVec;

use super::arc::{self, ArcFault, Ends};
use super::code::{GCode, Motion};
use super::execute::{Control, Run};
use super::moves::{Arc, FeedMode, Move, MoveKind, Step};
use super::words::{AXIS_LETTERS, bit};
use crate::machine::{ALL_AXES, AXES, AxisKind, AxisSet, AxisValues, Family};
use crate::source::Span;
use crate::units::{MM_PER_INCH, SECONDS_PER_MINUTE};

/// Differences of position below this are rounding, not motion (mm, degrees).
const STANDSTILL_MM: f64 = 1e-9;
/// Positions beyond this are refused (mm, degrees): no machine is that large.
const POSITION_MAX_MM: f64 = 1e9;
/// Index of the extruder axis.
const EXTRUDER: usize = 9;

impl Control<'_> {
    /// The block's motion, with what else uses axis words.
    pub(super) fn motion(&mut self, run: &mut Run<'_, '_>) {
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            match code {
                GCode::Reference => return self.reference(number, span, run),
                GCode::SetOffset => return self.set_offset(span, run),
                GCode::ClearOffset { forget } => self.position.clear_offset(forget),
                GCode::RestoreOffset => self.position.restore_offset(),
                _ => {}
            }
        }
        let arc = matches!(self.modal.motion, Motion::ArcCw | Motion::ArcCcw);
        let center = run.words.unused & (bit(b'I') | bit(b'J') | bit(b'K')) != 0;
        if !run.words.has_axes() && !(arc && center) {
            return;
        }
        run.facts.uses_motion = true;
        run.facts.uses_feed = self.obeys_feed();
        match self.modal.motion {
            Motion::None => {
                let span = run.whole();
                run.report
                    .error(
                        "no-motion-word",
                        "axis words without a motion word in force",
                        span,
                    )
                    .help("write G0, G1, G2 or G3 in this block or before");
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
            kind: MoveKind::Dwell,
            start: self.position.at,
            end: self.position.at,
            moving: AxisSet::default(),
            unknown_start: AxisSet::default(),
            arc: None,
            length_mm: 0.0,
            feed_mm_s: f64::INFINITY,
            feed_mode: self.modal.feed_mode,
            accel_mm_s2: self.knobs.feed_accel_mm_s2,
            path_accel_mm_s2: f64::INFINITY,
            rapid_factor: self.knobs.rapid_factor,
            dwell_s,
            loads: self.loads,
            path_mode: self.modal.path_mode,
        }));
    }

    /// Reads the axis words into `end`, machine coordinates. Returns the axes
    /// whose start is not known; `None` when something was wrong.
    fn targets(
        &self,
        run: &mut Run<'_, '_>,
        machine_coordinates: bool,
        end: &mut AxisValues,
    ) -> Option<AxisSet> {
        let mut unknown = AxisSet::default();
        let mut fine = true;
        for (axis, value) in run.words.axes() {
            let letter = ALL_AXES[axis].letter();
            let Some(data) = &self.machine.axes[axis] else {
                let span = run.words.span(letter, run.block);
                let message = format!("the machine has no {} axis", letter as char);
                run.report
                    .error("no-such-axis", message, span)
                    .help(format!(
                        "choose a machine with it, or describe it in the machine file: [axes.{}]",
                        letter as char
                    ));
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
                self.position.absolute(axis, value)
            } else {
                self.position.at[axis] + value
            };
            if self.position.unknown.contains(axis) && (absolute || machine_coordinates) {
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

    fn straight(&mut self, run: &mut Run<'_, '_>) {
        let rapid =
            self.modal.motion == Motion::Rapid && !self.machine.controller.language.rapid_uses_feed;
        let kind = if rapid { MoveKind::Rapid } else { MoveKind::Feed };
        let mut end = self.position.at;
        let machine_coordinates = run.facts.machine_coordinates;
        if let Some(unknown) = self.targets(run, machine_coordinates, &mut end) {
            self.go(run, kind, &end, unknown, None);
        }
    }

    /// Moves to `end`: a straight line, or `arc`.
    fn go(
        &mut self,
        run: &mut Run<'_, '_>,
        kind: MoveKind,
        end: &AxisValues,
        unknown_start: AxisSet,
        arc: Option<Arc>,
    ) {
        let start = &self.position.at;
        let mut moving = AxisSet::default();
        for axis in self.machine.axis_set.iter() {
            if (end[axis] - start[axis]).abs() > STANDSTILL_MM {
                moving.insert(axis);
            }
        }
        moving.0 &= !unknown_start.0;
        if let Some(arc) = &arc {
            moving.insert(arc.plane[0]);
            moving.insert(arc.plane[1]);
        }
        let (length_mm, linear) = path_length(start, end, moving, arc.as_ref());
        let mut feed_mm_s = f64::INFINITY;
        if kind != MoveKind::Rapid {
            let Some(speed_mm_s) = self.feed_speed(run, length_mm, linear) else { return };
            feed_mm_s = speed_mm_s;
        }
        let extrudes = moving.contains(EXTRUDER);
        run.steps.push(Step::Move(Move {
            line: run.line,
            number: run.block.number.map(|word| word.value),
            kind,
            start: self.position.at,
            end: *end,
            moving,
            unknown_start,
            arc,
            length_mm,
            feed_mm_s,
            feed_mode: self.modal.feed_mode,
            accel_mm_s2: *self.knobs.accel(kind),
            path_accel_mm_s2: self.knobs.path_accel_mm_s2[usize::from(!extrudes)],
            rapid_factor: self.knobs.rapid_factor,
            dwell_s: 0.0,
            loads: self.loads,
            path_mode: self.modal.path_mode,
        }));
        self.position.at = *end;
        self.position.unknown.0 &= !unknown_start.0;
    }

    /// The path speed that F asks for, mm/s; reports an F that is missing.
    fn feed_speed(&self, run: &mut Run<'_, '_>, length_mm: f64, linear: bool) -> Option<f64> {
        let span = run.whole();
        let feed = match &self.modal.feed {
            Some(feed) if feed.value > 0.0 => feed,
            Some(_) => {
                run.report
                    .error("no-feed", "a feed move with F0", span)
                    .help("write the feed: F…");
                return None;
            }
            None if self.machine.controller.language.family == Family::Marlin => {
                let message = "no F yet: the first moves count at the speed limits of the axes";
                run.report.note_once("no-feed-yet", message, span);
                return Some(f64::INFINITY);
            }
            None => {
                run.report
                    .error("no-feed", "a feed move, but no F is in force", span)
                    .help("write F in this block or before; after G93, G94 or G95 it must be written anew");
                return None;
            }
        };
        if self.feed_mode_is(FeedMode::InverseTime) {
            if run.facts.feed_word.is_none() {
                let help = "under G93 every block needs its own F";
                run.report
                    .error("no-feed", "a feed move without F under G93", span)
                    .help(help);
                return None;
            }
            return Some(length_mm * feed.value / SECONDS_PER_MINUTE);
        }
        let per_unit = if linear {
            feed.linear_mm_s()
        } else {
            feed.rotary_deg_s()
        };
        if self.feed_mode_is(FeedMode::PerMinute) {
            return Some(per_unit);
        }
        if self.modal.spindle_rpm > 0.0 {
            return Some(per_unit * self.modal.spindle_rpm);
        }
        run.report
            .error(
                "no-spindle-speed",
                "a feed per revolution, but no spindle speed is in force",
                span,
            )
            .help("write S before the first move under G95");
        None
    }

    fn arc(&mut self, run: &mut Run<'_, '_>) {
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
        if !unknown.is_empty() || touched.contains(first) || touched.contains(second) {
            run.report
                .error(
                    "arc-from-unknown",
                    "an arc from a position that is not known",
                    whole,
                )
                .help("move the axes to a known position first, or give --start X0,Y0,Z0");
        }
        for axis in [first, second] {
            if self.machine.axes[axis].is_none_or(|data| data.kind != AxisKind::Linear) {
                let letter = ALL_AXES[axis].letter() as char;
                let message = format!(
                    "an arc needs the linear axis {letter}, which the machine does not have"
                );
                run.report
                    .error("no-such-axis", message, whole)
                    .help("choose the plane with G17, G18 or G19");
            }
        }
        let turns = run.words.take(b'P').unwrap_or(1.0);
        if turns < 1.0 || turns.fract() != 0.0 || turns > 1e6 {
            let span = run.words.span(b'P', run.block);
            run.report
                .error(
                    "arc-turns",
                    "P of an arc must be a whole number from 1",
                    span,
                )
                .help("write the number of turns");
        }
        let stray = b"IJK"[normal];
        if run.words.take(stray).is_some_and(|value| value != 0.0) {
            let span = run.words.span(stray, run.block);
            let message = format!("{} does not belong to an arc in this plane", stray as char);
            run.report
                .error("arc-center", message, span)
                .help("choose the plane with G17, G18 or G19");
        }
        if run.report.diagnostics.errors != errors {
            return;
        }
        let ends = Ends {
            plane: [first, second],
            start: [self.position.at[first], self.position.at[second]],
            end: [end[first], end[second]],
            clockwise: self.modal.motion == Motion::ArcCw,
            turns,
            inch: self.modal.mm_per_unit == MM_PER_INCH,
        };
        match self.arc_geometry(run, &ends) {
            Some(Ok(arc)) => self.go(run, MoveKind::Arc, &end, unknown, Some(arc)),
            Some(Err(fault)) => report_fault(fault, run, whole),
            None => {}
        }
    }

    /// Geometry by R, or by I J K; `None` when it was reported.
    fn arc_geometry(
        &self,
        run: &mut Run<'_, '_>,
        ends: &Ends,
    ) -> Option<Result<Arc, ArcFault>> {
        let unit = self.modal.mm_per_unit;
        let letters = [b"IJK"[ends.plane[0]], b"IJK"[ends.plane[1]]];
        let offsets = letters.map(|letter| run.words.take(letter));
        let whole = run.whole();
        if let Some(radius) = run.words.take(b'R') {
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
            let message = format!(
                "an arc without a centre ({} {}) or R",
                letters[0] as char, letters[1] as char
            );
            run.report
                .error("arc-center", message, whole)
                .help("write the centre or the radius");
            return None;
        }
        let mut center = ends.start;
        for (index, offset) in offsets.into_iter().enumerate() {
            if !self.modal.arc_absolute {
                center[index] += offset.unwrap_or(0.0) * unit;
            } else if let Some(value) = offset {
                center[index] = self.position.absolute(ends.plane[index], value * unit);
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

    /// G28 and G30: to the intermediate point, then to the reference point.
    fn reference(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) {
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

    fn set_offset(&mut self, span: Span, run: &mut Run<'_, '_>) {
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
            if self.position.unknown.contains(axis) {
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

/// Length of the path that F speaks for, and whether that is a length of
/// linear axes: XYZ if any of them moves, else UVW, else the rotary axes, else
/// the extruder (RS274/NGC, "Feed Rate").
fn path_length(
    start: &AxisValues,
    end: &AxisValues,
    moving: AxisSet,
    arc: Option<&Arc>,
) -> (f64, bool) {
    let distance = |axis: usize| if moving.contains(axis) { end[axis] - start[axis] } else { 0.0 };
    if let Some(arc) = arc {
        let in_plane = arc.radius_mm * arc.sweep_rad.abs();
        let rise = distance(3 - arc.plane[0] - arc.plane[1]);
        return ((in_plane * in_plane + rise * rise).sqrt(), true);
    }
    for (axes, linear) in [([0, 1, 2], true), ([6, 7, 8], true), ([3, 4, 5], false)] {
        let [x, y, z] = axes.map(distance);
        let length = (x * x + y * y + z * z).sqrt();
        if length > 0.0 {
            return (length, linear);
        }
    }
    (distance(EXTRUDER).abs(), true)
}

fn report_fault(fault: ArcFault, run: &mut Run<'_, '_>, span: Span) {
    let (rule, message, help) = match fault {
        ArcFault::NoRadius => (
            "arc-center",
            "the arc has no radius: start or end is its centre".to_owned(),
            "check I, J and K",
        ),
        ArcFault::RadiiDiffer { start_mm, end_mm } => (
            "arc-radius",
            format!(
                "the arc's end is not on its circle: radius {start_mm:.4} mm at the start, {end_mm:.4} mm at the end"
            ),
            "check the end point and the centre; a G90.1/G91.1 mix-up looks like this",
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
