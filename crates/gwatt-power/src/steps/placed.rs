//! Spans of the motion in their place, as means over the response time look at them.

use super::energy::velocity;
use gwatt_machine::AxisValues;

/// A stretch of time in which the speed of each axis changes evenly.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    pub duration_s: f64,
    /// Of each axis at both ends, mm/s.
    pub axes_mm_s: [AxisValues; 2],
    /// The larger one along the path, mm/s.
    pub top_mm_s: f64,
    /// It begins at a joint.
    pub joint: bool,
    pub beyond: Beyond,
}

/// By which factors a span may go beyond the plan at lower overrides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beyond {
    /// How much faster the joint before it may be passed.
    pub joint: f64,
    /// How much larger its acceleration along the path may be.
    pub ramp: f64,
}

impl Beyond {
    /// Not at all.
    pub const NONE: Self = Self {
        joint: 1.0,
        ramp: 1.0,
    };
}

impl Span {
    /// In one direction, with the speeds at both ends.
    #[inline]
    pub fn straight(
        duration_s: f64,
        direction: &AxisValues,
        [from, to]: [f64; 2],
        joint: bool,
    ) -> Self {
        Self {
            duration_s,
            axes_mm_s: [velocity(direction, from), velocity(direction, to)],
            top_mm_s: if from > to { from } else { to },
            joint,
            beyond: Beyond::NONE,
        }
    }
}

/// A span in its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub(super) span: Span,
    pub(super) start_s: f64,
    /// Where the axes are at its start, mm, from anywhere.
    pub(super) place_mm: AxisValues,
    /// Some axis makes a step at its start.
    pub(super) steps: bool,
    /// By what the speed of each axis changes at its start, mm/s.
    pub(super) step_mm_s: AxisValues,
}

impl Placed {
    pub(super) fn end_s(&self) -> f64 {
        self.start_s + self.span.duration_s
    }

    /// Share of its time that has passed at an instant.
    pub(super) fn passed(&self, t: f64) -> f64 {
        let duration_s = self.span.duration_s;
        (t - self.start_s).clamp(0.0, duration_s) / duration_s
    }

    /// Speed of an axis, mm/s, and its way since the start, mm, after a share of the time.
    pub(super) fn at(&self, axis: usize, passed: f64) -> [f64; 2] {
        let [first, last] = &self.span.axes_mm_s;
        let (from, to) = (first[axis], last[axis]);
        let change = (to - from) * passed;
        let way_mm = (from + 0.5 * change) * (passed * self.span.duration_s);
        [from + change, way_mm]
    }
}

/// A piece that lower overrides may speed up or brake.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surged {
    pub end_s: f64,
    /// What they may add to the acceleration of each axis, up and down.
    pub(super) accel_mm_s2: [AxisValues; 2],
    /// The least and the largest speeds that they may bring.
    pub(super) speed_mm_s: [AxisValues; 2],
}
