//! Arcs that other controllers refuse.

use crate::arc::{self, Ends};
use crate::control::{Control, Run};
use gwatt_machine::{AxisSet, AxisValues};
use gwatt_motion::MoveKind;

/// Angles below it count as none.
const NO_ANGLE_RAD: f64 = 1e-9;

impl Control<'_> {
    /// An arc whose end is not on its circle: the firmwares run the circle of
    /// the start up to the angle of the end, and from there straight to the end.
    ///
    /// Source: Marlin `G2_G3.cpp`, Klipper `gcode_arcs.py`. Without an angle
    /// between start and end, Marlin 2 stays where it is and the others run
    /// straight: it counts as a straight line, and the place after it as
    /// unknown.
    pub(crate) fn loose_arc(
        &mut self,
        run: &mut Run<'_, '_>,
        ends: &Ends,
        center: [f64; 2],
        mut end: AxisValues,
    ) {
        let whole = run.whole();
        let message = "the arc's end is not on its circle: it counts as the circle of its start \
                       with a straight line to the end";
        run.report.note_once("arc-end", message, whole);
        if self.printer.adjusts {
            self.scale_extrusion(run, &mut end, AxisSet::default(), true);
        }
        let from = [ends.start[0] - center[0], ends.start[1] - center[1]];
        let to = [ends.end[0] - center[0], ends.end[1] - center[1]];
        let share = libm::hypot(from[0], from[1]) / libm::hypot(to[0], to[1]);
        let angle = libm::atan2(
            from[0] * to[1] - from[1] * to[0],
            from[0] * to[0] + from[1] * to[1],
        );
        if angle.abs() > NO_ANGLE_RAD && share.is_finite() {
            let on_circle = [center[0] + to[0] * share, center[1] + to[1] * share];
            let ends = Ends {
                end: on_circle,
                ..*ends
            };
            if let Ok(circle) = arc::from_center(&ends, center) {
                let mut middle = end;
                middle[ends.plane[0]] = on_circle[0];
                middle[ends.plane[1]] = on_circle[1];
                self.go(
                    run,
                    MoveKind::Arc,
                    &middle,
                    AxisSet::default(),
                    Some(circle),
                );
                self.go(run, MoveKind::Feed, &end, AxisSet::default(), None);
                return;
            }
        }
        let before = self.position.at;
        self.go(run, MoveKind::Feed, &end, AxisSet::default(), None);
        for axis in self.machine.axis_set.iter() {
            if before[axis] != end[axis] {
                self.position.unknown.insert(axis);
            }
        }
    }

    /// An arc from a position that is not known: its axes count at the feed
    /// in every direction.
    pub(crate) fn arc_from_unknown(
        &mut self,
        run: &mut Run<'_, '_>,
        end: &AxisValues,
        unknown: AxisSet,
    ) {
        for letter in *b"IJKRP" {
            run.words.take(letter);
        }
        let [first, second, _] = self.modal.plane;
        let mut unknown = unknown;
        unknown.insert(first);
        unknown.insert(second);
        unknown.0 &= self.machine.axis_set.0;
        self.go(run, MoveKind::Feed, end, unknown, None);
        if !self.modal.absolute {
            // The distance is known, the place is not.
            self.position.unknown.insert(first);
            self.position.unknown.insert(second);
        }
    }
}
