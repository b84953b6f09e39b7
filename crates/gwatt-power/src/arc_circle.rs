//! The forces of the axes along a circle.

mod peaks;

use super::circle::ArcAxis;
use arrayvec::ArrayVec;
use gwatt_machine::AXES;

/// The axes of a converter on an arc.
#[derive(Clone)]
pub(super) struct Circle<'a> {
    /// Those that move.
    pub axes: ArrayVec<ArcAxis<'a>, AXES>,
    /// Whether fed-back power feeds the other axes.
    pub credit_regen: bool,
    /// What is drawn besides the axes, W.
    pub idle_w: f64,
    /// Angle at the start of the move, rad.
    pub start_angle: f64,
    /// Sense of the sweep, ±1.
    pub sense: f64,
    /// Angle in rad per mm of path, positive.
    pub angle_per_mm: f64,
}
