//! Words for the speed of the spindle.

use super::{MM_PER_FOOT, MM_PER_M};
use crate::code::GCode;
use crate::control::{Control, Run};
use crate::rules::SpindleClamp;
use gwatt_machine::AxisValues;
use gwatt_machine::units::MM_PER_INCH;
use gwatt_motion::Arc;
use std::f64::consts::TAU;

impl Control<'_> {
    /// G96, G97 and the clamp; before S is read.
    pub(crate) fn spindle_mode(&mut self, run: &mut Run<'_, '_>) {
        let lathe = self.dialect().lathe.is_some();
        let by_d = self.rules.clamp == SpindleClamp::D;
        for index in 0..run.words.g.len() {
            let (code, number, span) = run.words.g[index];
            match code {
                // G50 S and G92 S without axes: no offset, but a clamp.
                GCode::SetOffset | GCode::Scaling(false)
                    if !by_d && run.words.has(b'S') && (lathe || !run.words.has_axes()) =>
                {
                    if let Some(limit) = run.words.take(b'S') {
                        self.spindle.limit_rpm = limit.abs();
                    }
                }
                GCode::SurfaceSpeed if number == 970 => {
                    if !by_d && !run.words.has(b'S') {
                        // The speed stays what it is.
                        self.modal.spindle_rpm = self.highest_rpm(&self.position.at, None);
                    }
                    self.spindle.surface_mm_min = None;
                }
                GCode::SurfaceSpeed => {
                    if by_d {
                        let clamp = run.words.take(b'D').map(f64::abs);
                        self.spindle.limit_rpm = clamp.unwrap_or(f64::INFINITY);
                    } else {
                        // P names the axis; only X turns a workpiece.
                        let axis = run.words.take(b'P').unwrap_or(1.0);
                        if axis != 0.0 && axis != 1.0 {
                            run.report
                                .error("surface-speed", "G96 about another axis than X", span)
                                .help("take P out");
                        }
                    }
                    if by_d && !run.words.has(b'S') {
                        run.report
                            .error("surface-speed", "G96 without its speed", span)
                            .help("write the surface speed as S");
                    }
                    self.spindle.surface_mm_min.get_or_insert(0.0);
                }
                _ => {}
            }
        }
    }

    /// S: revolutions a minute, or the surface speed under G96.
    pub(crate) fn set_speed(&mut self, value: f64, run: &Run<'_, '_>) {
        self.modal.spindle_rpm = value.abs();
        if let Some(surface) = &mut self.spindle.surface_mm_min {
            let inch = run.facts.feed_mm_per_unit == MM_PER_INCH;
            *surface = value.abs() * if inch { MM_PER_FOOT } else { MM_PER_M };
        }
    }

    /// The highest speed that the spindle has on the way to `end`: under G96
    /// the one at the smallest radius.
    pub(crate) fn highest_rpm(&self, end: &AxisValues, arc: Option<&Arc>) -> f64 {
        let Some(surface) = self.spindle.surface_mm_min else {
            return self.modal.spindle_rpm;
        };
        if surface == 0.0 {
            return 0.0;
        }
        let own = self
            .machine
            .spindle
            .as_ref()
            .map_or(f64::INFINITY, |spindle| spindle.max_rpm);
        let radius = self.smallest_radius(end, arc);
        (surface / (TAU * radius))
            .min(self.spindle.limit_rpm)
            .min(own)
    }

    /// The smallest |X| on the way, in program coordinates, mm.
    fn smallest_radius(&self, end: &AxisValues, arc: Option<&Arc>) -> f64 {
        if self.position.unknown.contains(0) {
            return 0.0;
        }
        let frame = &self.position.frame;
        let from = self.position.program()[0];
        let to = frame.program(end)[0];
        let (mut low, mut high) = (from.min(to), from.max(to));
        if let Some(arc) = arc {
            // The whole circle may reach nearer than its arc: counts higher.
            for place in 0..2 {
                let mut center = *end;
                for (axis, value) in arc.plane.into_iter().zip(arc.center) {
                    center[axis] = value;
                }
                for side in [-1.0, 1.0] {
                    let mut point = center;
                    point[arc.plane[place]] += side * arc.radius_mm;
                    let x = frame.program(&point)[0];
                    low = low.min(x);
                    high = high.max(x);
                }
            }
        }
        // No negative 0: speeds are divided by it.
        if low > 0.0 {
            low
        } else if high < 0.0 {
            -high
        } else {
            0.0
        }
    }
}
