//! What settings do to a move: M220, M221, M200, M203, M205.

use super::Course;
use crate::interpret::execute::{Control, Run};
use crate::interpret::motion::EXTRUDER;
use crate::machine::{AxisSet, AxisValues};

/// X and Y, which Klipper's velocity limit speaks for.
const XY: u16 = 0b11;

impl Control<'_> {
    /// The feed of a move, mm/s, of which F asks for `feed_mm_s`.
    pub(in crate::interpret) fn printer_feed(
        &self,
        run: &mut Run<'_, '_>,
        course: &Course<'_>,
        feed_mm_s: f64,
    ) -> f64 {
        let state = &self.printer;
        let mut feed = feed_mm_s * state.feed_factor;
        if state.feed_factor != 1.0 {
            run.facts.fixed = Some("M220 scales its feed");
        }
        let extrudes = course.commanded.contains(EXTRUDER);
        feed = feed.max(state.least_mm_s[usize::from(!extrudes)]);
        if course.length_mm <= 0.0 {
            return feed;
        }
        if course.commanded.0 & !(1 << EXTRUDER) != 0 {
            feed = feed.min(state.velocity_mm_s);
        }
        for axis in course.commanded.iter() {
            let distance = (course.end[axis] - self.position.at[axis]).abs();
            if distance > 0.0 {
                feed = feed.min(state.speed_caps[axis] * course.length_mm / distance);
            }
        }
        feed
    }

    /// By how much the program raised the speed limits of the axes that move,
    /// above what the machine file says; at least 1.
    pub(in crate::interpret) fn printer_speed_factor(&self, course: &Course<'_>) -> f64 {
        let state = &self.printer;
        let mut factor = 1.0_f64;
        for axis in course.commanded.iter() {
            let Some(data) = &self.machine.axes[axis] else {
                continue;
            };
            let mut cap = state.speed_caps[axis];
            if XY & 1 << axis != 0 && state.velocity_mm_s.is_finite() {
                cap = state.velocity_mm_s;
            }
            if cap.is_finite() {
                factor = factor.max(cap / data.rapid_mm_s);
            }
        }
        factor
    }

    /// M221 and M200: of what E names, the extruder moves more or less; E
    /// itself counts on as it is written.
    pub(in crate::interpret) fn scale_extrusion(&mut self, end: &mut AxisValues, unknown: AxisSet) {
        let factor = self.printer.flow * self.printer.volumetric;
        if factor == 1.0 || unknown.contains(EXTRUDER) {
            return;
        }
        let written = end[EXTRUDER] - self.position.at[EXTRUDER];
        let moved = written * factor;
        end[EXTRUDER] = self.position.at[EXTRUDER] + moved;
        self.position.shift(EXTRUDER, moved - written);
    }
}
