//! The words of splines.

use super::{
    ControlPoint, FIXED, LINES_FOR_A_POINT, ORDER_MAX, POINTS_MAX, as_chords, point_at, unweighted,
};
use crate::control::{Control, Run};
use gwatt_machine::{AxisValues, PathMode};
use gwatt_motion::{FeedMode, MoveKind};

impl Control<'_> {
    /// A block under G5 (50), G5.1 (51), G5.2 (52) or G5.3 (53).
    pub(crate) fn spline(&mut self, number: u16, run: &mut Run<'_, '_>) {
        run.facts.fixed = Some(FIXED);
        self.special.active = 0;
        if !self.spline_permits(run) {
            return;
        }
        if number == 50 && run.facts.motion_word.is_none() {
            return run.spline_fault("G5 has to stand in every block");
        }
        match number {
            50 => self.cubic(run),
            51 => self.quadratic(run),
            52 => self.nurbs_point(run),
            _ => self.nurbs_end(run),
        }
    }

    fn spline_permits(&self, run: &mut Run<'_, '_>) -> bool {
        let unknown = self.position.unknown;
        let faults = [
            (
                self.modal.plane[2] != 2,
                "a spline outside of the plane G17",
            ),
            (
                self.feed_mode_is(FeedMode::InverseTime),
                "a spline under G93",
            ),
            (
                run.words.axes().any(|(axis, _)| axis > 1),
                "a spline moves X and Y only",
            ),
            (
                unknown.contains(0) || unknown.contains(1),
                "a spline from a position that is not known",
            ),
            (
                self.machine.axes[0].is_none() || self.machine.axes[1].is_none(),
                "a spline needs the axes X and Y",
            ),
        ];
        match faults.into_iter().find(|(found, _)| *found) {
            Some((_, message)) => {
                run.spline_fault(message);
                false
            }
            None => self
                .feed_speed(run, &self.position.at, None, 1.0, true)
                .is_some(),
        }
    }

    /// Two words as a vector in mm; `None` with a message if only one is there.
    fn spline_pair(&self, letters: [u8; 2], run: &mut Run<'_, '_>) -> Result<Option<[f64; 2]>, ()> {
        match letters.map(|letter| run.words.take(letter)) {
            [Some(a), Some(b)] => Ok(Some([a, b].map(|value| value * self.modal.mm_per_unit))),
            [None, None] => Ok(None),
            _ => {
                let [a, b] = letters.map(char::from);
                run.spline_fault(&format!("a spline with only one of {a} and {b}"));
                Err(())
            }
        }
    }

    fn cubic(&mut self, run: &mut Run<'_, '_>) {
        self.special.spline.points.clear();
        let Ok(first) = self.spline_pair([b'I', b'J'], run) else {
            return;
        };
        let Ok(last) = self.spline_pair([b'P', b'Q'], run) else {
            return;
        };
        let (Some(first), Some(last)) = (first.or(self.special.spline.first), last) else {
            return run
                .spline_fault("G5 needs P and Q, and in the first block of a series I and J");
        };
        let start = self.believed();
        let mut end = start;
        if self.targets(run, false, &mut end).is_none() {
            return;
        }
        let points = [
            [start[0], start[1]],
            [start[0] + first[0], start[1] + first[1]],
            [end[0] + last[0], end[1] + last[1]],
            [end[0], end[1]],
        ];
        self.special.spline.first = Some([-last[0], -last[1]]);
        self.curve(&points.map(unweighted), 4, run);
    }

    fn quadratic(&mut self, run: &mut Run<'_, '_>) {
        self.special.spline.end();
        let Ok(first) = self.spline_pair([b'I', b'J'], run) else {
            return;
        };
        let Some(first) = first else {
            return run.spline_fault("G5.1 needs I and J");
        };
        let start = self.believed();
        let mut end = start;
        if self.targets(run, false, &mut end).is_none() {
            return;
        }
        let points = [
            [start[0], start[1]],
            [start[0] + first[0], start[1] + first[1]],
            [end[0], end[1]],
        ];
        self.curve(&points.map(unweighted), 3, run);
    }

    /// G5.2: one more control point.
    fn nurbs_point(&mut self, run: &mut Run<'_, '_>) {
        let weight = run.words.take(b'P');
        let order = run.words.take(b'L');
        let named = run.words.axes().count();
        let begins = self.special.spline.points.is_empty();
        let faults = [
            (named == 1, "a control point needs X and Y"),
            (
                named == 0 && !begins,
                "only the first block of a NURBS may be without X and Y",
            ),
            (
                named == 2 && !weight.is_some_and(|weight| weight > 0.0),
                "a control point needs a weight P greater than 0",
            ),
            (
                weight.is_some_and(|weight| !(weight > 0.0 && weight < 1e9)),
                "the weight P is not greater than 0, or beyond reason",
            ),
            (
                order.is_some_and(|order| order.fract() != 0.0 || order > ORDER_MAX as f64),
                "L is not a whole number up to 16",
            ),
            (
                self.special.spline.points.len() >= POINTS_MAX,
                "a NURBS of more than 5000 points",
            ),
        ];
        if let Some((_, message)) = faults.into_iter().find(|(found, _)| *found) {
            return run.spline_fault(message);
        }
        let mut end = self.believed();
        if begins {
            self.special.spline.first = None;
            self.special.spline.order = 3;
            let own = weight.filter(|_| named == 0).unwrap_or(1.0);
            self.special.spline.points.push(ControlPoint {
                place: [end[0], end[1]],
                weight: own,
            });
        }
        if let Some(order) = order.filter(|order| *order > 3.0) {
            self.special.spline.order = order as usize;
        }
        if named == 2 && self.targets(run, false, &mut end).is_some() {
            self.special.spline.points.push(ControlPoint {
                place: [end[0], end[1]],
                weight: weight.unwrap_or(1.0),
            });
        }
    }

    /// G5.3: the curve through what was collected.
    fn nurbs_end(&mut self, run: &mut Run<'_, '_>) {
        let points = std::mem::take(&mut self.special.spline.points);
        let order = self.special.spline.order;
        self.modal.motion = crate::code::Motion::None;
        if points.is_empty() || points.len() < order {
            return run.spline_fault("G5.3 before enough points by G5.2");
        }
        self.curve(&points, order, run);
    }

    /// The curve as lines.
    fn curve(&mut self, points: &[ControlPoint], order: usize, run: &mut Run<'_, '_>) {
        let Some(last) = points.last() else {
            return;
        };
        let mut end: AxisValues = self.believed();
        let before = run.steps.len();
        let path_mode = self.modal.path_mode;
        self.modal.path_mode = PathMode::LookAhead;
        let spans = (points.len() + 1 - order) as f64;
        let step = spans / (points.len() * LINES_FOR_A_POINT) as f64;
        // The sum decides, with its rounding, whether one line more is made.
        let mut u = step;
        while u < spans && run.within_limits() {
            let place = point_at(points, order, u);
            end[0] = place[0];
            end[1] = place[1];
            self.part(run, MoveKind::Feed, &end);
            u += step;
        }
        end[0] = last.place[0];
        end[1] = last.place[1];
        self.part(run, MoveKind::Feed, &end);
        as_chords(run.steps.get_mut(before..).unwrap_or_default());
        self.modal.path_mode = path_mode;
    }
}

impl Run<'_, '_> {
    fn spline_fault(&mut self, message: &str) {
        let whole = self.whole();
        self.report
            .error("spline", message.to_owned(), whole)
            .help("see G5 and G5.2 in the manual of LinuxCNC");
    }
}
