//! G12 and G13 of Haas mills: a circular pocket, clockwise and counter-clockwise
//! (Haas mill operator's manual, "G12 Circular Pocket Milling CW / G13 Circular
//! Pocket Milling CCW").
//!
//! From the centre by a half circle onto the first circle, once round, by half
//! circles onto wider ones (Q) up to the last (K), once round each, and by a half
//! circle back. The manual shows the path in a figure, without the place where
//! the circles begin: here it is such that the axis which is harder to move has
//! to start.

use std::f64::consts::{PI, TAU};

use super::control::{Control, Run};
use crate::code::Motion;
use gwatt_machine::{AxisKind, AxisSet, AxisValues};
use gwatt_motion::{Arc, MoveKind};
use gwatt_syntax::source::Span;

const X: usize = 0;
const Y: usize = 1;
const Z: usize = 2;
/// Circles of a pocket, and its passes in depth.
const COUNT_MAX: f64 = 10_000.0;

impl Control<'_> {
    pub(super) fn circular_pocket(&mut self, clockwise: bool, span: Span, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some("it mills a pocket");
        run.facts.boundary = true;
        run.facts.uses_motion = true;
        if let Some(message) = self.pocket_forbidden(run) {
            return fault(message, span, run);
        }
        let Some(radii) = self.pocket_radii(span, run) else {
            return;
        };
        let times = run.words.take(b'L').unwrap_or(1.0);
        if !(1.0..=COUNT_MAX).contains(&times) || times.fract() != 0.0 {
            return fault("L is no count", span, run);
        }
        let incremental = !self.modal.absolute;
        if times > 1.0 && !incremental {
            return fault("L goes with G91, where Z is a step", span, run);
        }
        let before = self.position.at;
        let mut center = before;
        if self.targets(run, false, &mut center).is_none() {
            return;
        }
        let step = center[Z] - before[Z];
        center[Z] = before[Z];
        if center != before {
            let kind = match self.modal.motion {
                Motion::Linear => MoveKind::Feed,
                _ => MoveKind::Rapid,
            };
            self.part(run, kind, &center);
        }
        let errors = run.report.diagnostics.errors;
        for _ in 0..times as u32 {
            center[Z] += step;
            self.part(run, MoveKind::Feed, &center);
            if run.report.diagnostics.errors != errors {
                return;
            }
            self.pocket_circles(clockwise, &center, &radii, run);
            if !run.within_limits() || run.report.diagnostics.errors != errors {
                return;
            }
        }
    }

    fn pocket_forbidden(&self, run: &Run<'_, '_>) -> Option<&'static str> {
        let linear = |axis: usize| {
            self.machine.axes[axis]
                .as_ref()
                .is_some_and(|data| data.kind == AxisKind::Linear)
        };
        if ![X, Y, Z].into_iter().all(linear) {
            return Some("it needs the linear axes X, Y and Z");
        }
        let unknown = self.position.unknown;
        if [X, Y, Z].into_iter().any(|axis| unknown.contains(axis)) {
            return Some("where the tool stands is not known");
        }
        if self.modal.plane != [X, Y, Z] {
            return Some("it needs G17");
        }
        if run.facts.machine_coordinates || !self.position.frame.is_plain() || self.polar.is_some()
        {
            return Some("in machine, turned or polar coordinates");
        }
        if self.feed_mode_is(super::FeedMode::InverseTime) {
            return Some("under G93");
        }
        None
    }

    /// The radii of the circles of the tool's centre, mm.
    fn pocket_radii(&mut self, span: Span, run: &mut Run<'_, '_>) -> Option<Vec<f64>> {
        let first = self.plain_length(b'I', run);
        let last = self.plain_length(b'K', run);
        let step = self.plain_length(b'Q', run);
        let Some(first) = first else {
            fault("without I, the radius of the first circle", span, run);
            return None;
        };
        if !run.words.has(b'D') {
            fault(
                "without D, the number of the tool's radius; D0 for none",
                span,
                run,
            );
            return None;
        }
        let number = run
            .words
            .word(b'D', run.block)
            .map_or(0.0, |word| word.value);
        if number != 0.0 && self.tools.unknown() {
            fault(
                "the tool's radius is not known: give --tool-table, or D0",
                span,
                run,
            );
            return None;
        }
        let tool_mm = self.cutter_radius_mm(run, span)?;
        let mut radii = vec![first - tool_mm];
        match (last, step) {
            (None, None) => {}
            (Some(last), Some(step)) if step > 0.0 && last >= first => {
                if (last - first) / step > COUNT_MAX {
                    fault("more than 10000 circles", span, run);
                    return None;
                }
                let mut next = first + step;
                while next < last {
                    radii.push(next - tool_mm);
                    next += step;
                }
                if last > first {
                    radii.push(last - tool_mm);
                }
            }
            _ => {
                fault("K, not below I, and Q above 0 go together", span, run);
                return None;
            }
        }
        if !(radii.iter().all(|radius| *radius > 0.0) && tool_mm >= 0.0) {
            fault("the first circle is not wider than the tool", span, run);
            return None;
        }
        Some(radii)
    }

    /// Half circle, circles, half circle, in the plane of `center`.
    fn pocket_circles(
        &mut self,
        clockwise: bool,
        center: &AxisValues,
        radii: &[f64],
        run: &mut Run<'_, '_>,
    ) {
        let side = if clockwise { -1.0 } else { 1.0 };
        let force = |axis: usize| {
            let data = self.machine.axes[axis].as_ref();
            data.map_or(0.0, |data| {
                data.mass_kg * data.accel_mm_s2 * 1e-3 + data.coulomb_n
            })
        };
        // The half circle begins across its end.
        let mut angle = if force(X) > force(Y) { PI / 2.0 } else { 0.0 };
        let mut radius = 0.0;
        for next in radii {
            // From `radius` at `angle` to the other side; the first half circle
            // has its end, not its beginning, at the angle.
            let from = if radius == 0.0 { angle - PI } else { angle };
            self.half_circle(center, from, [radius, *next], side, run);
            angle = from + PI;
            let start = at(center, angle, *next);
            let circle = Arc {
                plane: [X, Y],
                center: [center[X], center[Y]],
                radius_mm: *next,
                start_angle_rad: angle,
                sweep_rad: side * TAU,
            };
            self.pocket_arc(circle, &start, run);
            radius = *next;
        }
        self.half_circle(center, angle, [radius, 0.0], side, run);
    }

    /// From a radius at an angle to another at the opposite side.
    fn half_circle(
        &mut self,
        center: &AxisValues,
        angle: f64,
        [from, to]: [f64; 2],
        side: f64,
        run: &mut Run<'_, '_>,
    ) {
        let middle = at(center, angle, (from - to) / 2.0);
        let end = if to == 0.0 {
            *center
        } else {
            at(center, angle + PI, to)
        };
        let half = Arc {
            plane: [X, Y],
            center: [middle[X], middle[Y]],
            radius_mm: f64::midpoint(from, to),
            start_angle_rad: angle,
            sweep_rad: side * PI,
        };
        self.pocket_arc(half, &end, run);
    }

    fn pocket_arc(&mut self, arc: Arc, end: &AxisValues, run: &mut Run<'_, '_>) {
        self.go(run, MoveKind::Arc, end, AxisSet::default(), Some(arc));
    }
}

fn at(center: &AxisValues, angle: f64, radius: f64) -> AxisValues {
    let mut place = *center;
    place[X] += radius * libm::cos(angle);
    place[Y] += radius * libm::sin(angle);
    place
}

fn fault(message: &str, span: Span, run: &mut Run<'_, '_>) {
    run.report
        .error("pocket", format!("G12 and G13: {message}"), span)
        .help("as in G13 D1 I3. K10. Q2. Z-1. F300, from the centre of the pocket");
}
