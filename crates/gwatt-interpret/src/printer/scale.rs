//! What settings do to a move: M220, M221, M200, M203, M205.

use super::Course;
use crate::control::{Control, Run};
use crate::letters::bit;
use crate::places::EXTRUDER;
use gwatt_machine::{ALL_AXES, AxisSet, AxisValues};

/// X and Y, which Klipper's velocity limit speaks for.
const XY: u16 = 0b11;

impl Control<'_> {
    /// The feed of a move under the limits that the program has set, mm/s, of which F asks
    /// for `feed_mm_s` unless it `is_given` otherwise; and by what factor it would be more
    /// without them.
    pub(crate) fn printer_speed(
        &self,
        run: &mut Run<'_, '_>,
        course: &Course<'_>,
        feed_mm_s: f64,
        is_given: bool,
    ) -> (f64, f64) {
        let asked = if is_given {
            feed_mm_s
        } else {
            self.printer_feed(run, course, feed_mm_s)
        };
        let capped = self.capped(course, asked);
        let held_back = capped < asked && asked.is_finite();
        (capped, if held_back { asked / capped } else { 1.0 })
    }

    /// The feed of a move before the program's limits, mm/s, of which F asks for `feed_mm_s`.
    fn printer_feed(&self, run: &mut Run<'_, '_>, course: &Course<'_>, feed_mm_s: f64) -> f64 {
        let state = &self.printer;
        let spared = self.is_spared(run, course.commanded);
        let factor = if spared { 1.0 } else { state.feed_factor };
        let feed = feed_mm_s * factor;
        if state.feed_factor != 1.0 {
            run.facts.own_feed = Some("M220 scales its feed");
        }
        let extrudes = course.commanded.contains(EXTRUDER);
        feed.max(state.least_mm_s[usize::from(!extrudes)])
    }

    /// Whether M220 leaves a move alone, and M221: it names none of the axes that they are for
    /// (RepRapFirmware, GCodes.cpp, `applyM220M221`).
    fn is_spared(&self, run: &Run<'_, '_>, moving: AxisSet) -> bool {
        let spares = self.machine.controller.language.printer.feed_factor_spares;
        let others = ALL_AXES
            .iter()
            .filter(|axis| !spares.contains(**axis as usize));
        let named = others.fold(0, |bits, axis| bits | bit(axis.letter()));
        moving.0 & !spares.0 == 0 && run.words.present & named == 0
    }

    /// A speed along the path, mm/s, under the limits that the program has set.
    fn capped(&self, course: &Course<'_>, feed_mm_s: f64) -> f64 {
        let knobs = &self.knobs;
        let mut feed = feed_mm_s;
        if course.commanded.0 & !(1 << EXTRUDER) != 0 {
            feed = feed.min(knobs.path_speed_mm_s);
        }
        if course.unknown {
            // In whatever direction: no axis is faster than the largest of their limits.
            let caps = || course.commanded.iter().map(|axis| knobs.speed_mm_s[axis]);
            if caps().all(f64::is_infinite) {
                return feed;
            }
            let speeds = course.commanded.iter().map(|axis| {
                let own_mm_s = self.machine.axes[axis].map_or(f64::INFINITY, |it| it.rapid_mm_s);
                let cap_mm_s = knobs.speed_mm_s[axis];
                if cap_mm_s.is_finite() {
                    cap_mm_s
                } else {
                    own_mm_s
                }
            });
            return feed.min(speeds.fold(0.0, f64::max));
        }
        // Chords of an arc that run along one axis of its plane are as fast as the other permits.
        for axis in AxisSet(course.commanded.0 & !course.turning.0).iter() {
            let distance = (course.end[axis] - self.position.at[axis]).abs();
            if distance > 0.0 && course.length_mm > 0.0 {
                feed = feed.min(knobs.speed_mm_s[axis] * course.length_mm / distance);
            }
        }
        feed
    }

    /// The limits of speed of the axes that move, as a share of what the machine file
    /// says, the largest of them: of rapids as it is, of feeds at least 1, since what
    /// lowers them is in their feed already.
    pub(crate) fn speed_factor(&self, course: &Course<'_>, rapid: bool) -> f64 {
        let knobs = &self.knobs;
        let mut factor = if rapid { 0.0_f64 } else { 1.0 };
        for axis in course.commanded.iter() {
            let Some(data) = &self.machine.axes[axis] else {
                continue;
            };
            let mut cap = knobs.speed_mm_s[axis];
            if XY & 1 << axis != 0 && knobs.path_speed_mm_s.is_finite() {
                cap = knobs.path_speed_mm_s;
            }
            let share = if cap.is_finite() {
                cap / data.rapid_mm_s
            } else {
                1.0
            };
            factor = factor.max(share);
        }
        if factor > 0.0 { factor } else { 1.0 }
    }

    /// M221 and M200: of what E names, the extruder moves more or less; E
    /// itself counts on as it is written.
    pub(crate) fn scale_extrusion(
        &mut self,
        run: &Run<'_, '_>,
        end: &mut AxisValues,
        unknown: AxisSet,
        is_arc: bool,
    ) {
        // Arcs are of X and Y, whatever their words name.
        let moving = AxisSet(if is_arc { XY } else { 0 });
        let spared = self.is_spared(run, moving);
        let flow = if spared { 1.0 } else { self.printer.flow };
        let factor = flow * self.printer.volumetric;
        if factor == 1.0 || unknown.contains(EXTRUDER) {
            return;
        }
        let written = end[EXTRUDER] - self.position.at[EXTRUDER];
        let moved = written * factor;
        end[EXTRUDER] = self.position.at[EXTRUDER] + moved;
        self.position.shift(EXTRUDER, moved - written);
    }
}
