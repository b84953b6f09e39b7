//! Arcs ("Circular interpolation", "Helical interpolation"): by centre, by
//! radius (CR), by opening angle (AR), through a point (CIP), about the pole.

use super::target::Target;
use super::{Measure, Siemens};
use crate::arc::{self, ArcFault, Ends, Slack};
use crate::arc_words::report_fault;
use crate::code::Motion;
use crate::control::{Control, Run};
use crate::turned_arc::Tilted;
use gwatt_machine::{ALL_AXES, AxisKind, AxisValues};
use gwatt_motion::{Arc, MoveKind};

/// How far a point of an arc may lie off its plane, mm.
const FLAT_MM: f64 = 1e-3;

impl Control<'_> {
    pub(super) fn siemens_arc(
        &mut self,
        state: &mut Siemens,
        mut target: Target,
        run: &mut Run<'_, '_>,
    ) {
        if !self.siemens_arc_fits(state, &target, run) {
            return;
        }
        let whole = run.whole();
        let plane = self.modal.plane;
        let [first, second, _] = plane;
        let start = state.program_place(&self.position.at);
        let mut ends = Ends {
            plane: [first, second],
            start: [start[first], start[second]],
            end: [target.program[first], target.program[second]],
            clockwise: self.modal.motion == Motion::ArcCw,
            turns: run.words.take(b'P').unwrap_or(1.0),
            slack: Slack::usual(self.in_inches()),
        };
        if !(ends.turns >= 1.0 && ends.turns <= 1e6 && ends.turns.fract() == 0.0) {
            run.report
                .error(
                    "arc-turns",
                    "TURN of an arc must be a whole number from 0",
                    whole,
                )
                .help("write the number of additional turns, up to 999999");
            return;
        }
        let through = state.extra.through_point || state.extra.via.iter().any(Option::is_some);
        let arc = if through {
            run.facts.fixed = Some("it is an arc through a point (CIP)");
            self.arc_through(state, &start, &target, &mut ends, run)
        } else {
            self.arc_by_words(state, &mut target, &mut ends, run)
        };
        let arc = match arc {
            Some(Ok(arc)) => arc,
            Some(Err(fault)) => return report_fault(fault, run, whole),
            None => return,
        };
        let Some((scale, flipped)) = state.frame.plane(plane) else {
            if !self.siemens_tilted(state, &arc, &start, &target, run) {
                Self::refuse_tilted(whole, run);
            }
            return;
        };
        let mut middle = start;
        middle[first] = arc.center[0];
        middle[second] = arc.center[1];
        let middle = state.machine_place(&middle);
        let center = [middle[first], middle[second]];
        let at = &self.position.at;
        let arc = Arc {
            plane: arc.plane,
            center,
            radius_mm: arc.radius_mm * scale,
            start_angle_rad: libm::atan2(at[second] - center[1], at[first] - center[0]),
            sweep_rad: if flipped {
                -arc.sweep_rad
            } else {
                arc.sweep_rad
            },
        };
        self.siemens_go(state, run, MoveKind::Arc, &target, Some(arc));
    }

    /// Whether an arc may go to a target; reports why not.
    fn siemens_arc_fits(&self, state: &Siemens, target: &Target, run: &mut Run<'_, '_>) -> bool {
        let whole = run.whole();
        let [first, second, _] = self.modal.plane;
        let unknown = self.position.unknown;
        let refused = if state.extra.machine_coordinates {
            Some((
                "arc-in-g53",
                "an arc with G53, G153 or SUPA",
                "write a straight move",
            ))
        } else if !target.unknown.is_empty() || unknown.contains(first) || unknown.contains(second)
        {
            let help = "move the axes to a known position first, or give --start X0,Y0,Z0";
            Some((
                "arc-from-unknown",
                "an arc from a position that is not known",
                help,
            ))
        } else {
            None
        };
        if let Some((rule, message, help)) = refused {
            run.report.error(rule, message, whole).help(help);
            return false;
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
                return false;
            }
        }
        true
    }

    /// An arc in a tilted plane, as chords; false where it is not followed.
    fn siemens_tilted(
        &mut self,
        state: &mut Siemens,
        arc: &Arc,
        start: &AxisValues,
        target: &Target,
        run: &mut Run<'_, '_>,
    ) -> bool {
        let tilted = Tilted {
            arc,
            ends: [start, &target.program],
            to: &target.machine,
        };
        let before = run.steps.len();
        let followed = target.unknown.is_empty()
            && state.frame.keeps_circles()
            && self.tilted_arc(&tilted, |point| state.machine_place(point), run);
        if followed {
            state.arrive(target, before, run);
        }
        followed
    }

    /// An arc by its centre, radius or opening angle; `None` when it was
    /// reported.
    fn arc_by_words(
        &self,
        state: &Siemens,
        target: &mut Target,
        ends: &mut Ends,
        run: &mut Run<'_, '_>,
    ) -> Option<Result<Arc, ArcFault>> {
        let unit = self.modal.mm_per_unit;
        let whole = run.whole();
        let [first, second, normal] = self.modal.plane;
        // It has no part in the geometry, which the plane decides.
        run.words.take(b"IJK"[normal]);
        let offsets = [first, second].map(|axis| run.words.take(b"IJK"[axis]));
        let radius = run.words.take(b'R');
        let opening = state.extra.opening_deg;
        let given = usize::from(radius.is_some()) + usize::from(opening.is_some());
        let by_center = offsets.iter().any(Option::is_some);
        if given > 1 || radius.is_some() && by_center {
            run.report
                .error("arc-center", "an arc with two of centre, CR and AR", whole)
                .help("keep one of them");
            return None;
        }
        let mut center = ends.start;
        for (index, offset) in offsets.into_iter().enumerate() {
            let axis = ends.plane[index];
            match (offset, state.extra.center_absolute[axis]) {
                // A place like others: of X a diameter where these are; increments are radii.
                (Some(value), Some(true)) if axis == 0 && state.in_diameters() => {
                    center[index] = value * unit / 2.0;
                }
                (Some(value), Some(true)) => center[index] = value * unit,
                (Some(value), _) => center[index] += value * unit,
                (None, _) => {}
            }
        }
        if let Some(opening) = opening {
            return Self::arc_by_opening(
                state,
                opening,
                by_center.then_some(center),
                target,
                ends,
                run,
            );
        }
        if let Some(radius) = radius {
            return Some(arc::from_radius(ends, radius * unit));
        }
        if by_center {
            return Some(arc::from_center(ends, center));
        }
        if state.extra.polar_angle.is_some() || state.extra.polar_radius.is_some() {
            // "With polar coordinates": the pole is the centre.
            let pole = [state.polar.pole[first], state.polar.pole[second]];
            return Some(arc::from_center(ends, pole));
        }
        run.report
            .error(
                "arc-center",
                "an arc without a centre (I J K), CR or AR",
                whole,
            )
            .help("write the centre or the radius");
        None
    }

    /// AR: with the end, or with the centre.
    fn arc_by_opening(
        state: &Siemens,
        opening_deg: f64,
        center: Option<[f64; 2]>,
        target: &mut Target,
        ends: &mut Ends,
        run: &mut Run<'_, '_>,
    ) -> Option<Result<Arc, ArcFault>> {
        if !(opening_deg > 0.0 && opening_deg < 360.0) {
            let whole = run.whole();
            run.report
                .error(
                    "arc-center",
                    "an opening angle (AR) that is not between 0 and 360",
                    whole,
                )
                .help("write a full circle with I, J or K");
            return None;
        }
        let Some(center) = center else {
            let chord = libm::hypot(ends.end[0] - ends.start[0], ends.end[1] - ends.start[1]);
            let radius = chord / 2.0 / libm::sin((opening_deg / 2.0).to_radians());
            let long = opening_deg > 180.0;
            return Some(arc::from_radius(ends, if long { -radius } else { radius }));
        };
        let angle = if ends.clockwise {
            -opening_deg
        } else {
            opening_deg
        };
        let (sin, cos) = super::frame::sin_cos_deg(angle);
        let arm = [ends.start[0] - center[0], ends.start[1] - center[1]];
        ends.end = [
            center[0] + arm[0] * cos - arm[1] * sin,
            center[1] + arm[0] * sin + arm[1] * cos,
        ];
        for (axis, place) in ends.plane.into_iter().zip(ends.end) {
            target.program[axis] = place;
            target.named.insert(axis);
        }
        let place = state.machine_place(&target.program);
        for (axis, place) in place.into_iter().enumerate().take(3) {
            if target.named.iter().any(|by| state.frame.depends(axis, by)) {
                target.machine[axis] = place;
            }
        }
        Some(arc::from_center(ends, center))
    }

    /// CIP: through I1, J1, K1. Only in the plane that is in force.
    fn arc_through(
        &self,
        state: &Siemens,
        start: &AxisValues,
        target: &Target,
        ends: &mut Ends,
        run: &mut Run<'_, '_>,
    ) -> Option<Result<Arc, ArcFault>> {
        let whole = run.whole();
        let mut via = [start[0], start[1], start[2]];
        for (axis, (place, word)) in via.iter_mut().zip(state.extra.via).enumerate() {
            if let Some((measure, value)) = word {
                let relative = measure == Measure::Increment
                    || measure == Measure::Modal && !self.modal.absolute;
                // A place like that of an arc's centre: of X a diameter where these are.
                let halved = axis == 0 && !relative && state.in_diameters();
                let unit = self.modal.mm_per_unit;
                let value = value * if halved { unit / 2.0 } else { unit };
                *place = if relative { *place + value } else { value };
            }
        }
        let [first, second, normal] = self.modal.plane;
        let flat = (via[normal] - start[normal]).abs() <= FLAT_MM
            && (target.program[normal] - start[normal]).abs() <= FLAT_MM;
        if !flat {
            run.report
                .error(
                    "arc-in-space",
                    "an arc through a point (CIP) that leaves its plane",
                    whole,
                )
                .help("gwatt follows arcs in the plane of G17, G18 or G19");
            return None;
        }
        let side = |point: [f64; 2]| [point[0] - ends.start[0], point[1] - ends.start[1]];
        let [bx, by] = side([via[first], via[second]]);
        let [cx, cy] = side(ends.end);
        let cross = bx * cy - by * cx;
        let (b, c) = (bx * bx + by * by, cx * cx + cy * cy);
        if cross.abs() <= 1e-9 * (b * c).sqrt() {
            run.report
                .error("arc-center", "the three points of CIP lie on a line", whole)
                .help("check I1, J1, K1 and the end");
            return None;
        }
        // The centre has the same distance from all three points.
        let center = [
            ends.start[0] + (cy * b - by * c) / (2.0 * cross),
            ends.start[1] + (bx * c - cx * b) / (2.0 * cross),
        ];
        ends.clockwise = cross < 0.0;
        Some(arc::from_center(ends, center))
    }
}
