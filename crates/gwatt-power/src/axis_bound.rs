//! What an axis draws at most along a line.

use super::axis::{AxisPower, Side};
use gwatt_motion::Move;

/// What rounding may make of a bound.
const ROUNDING: f64 = 1e-9;

/// What one axis whose share of the path does not change draws and feeds back at most, W, at
/// a speed of at most `v` (mm/s) and accelerations of size `a` (mm/s²) at most.
#[inline]
pub(super) fn axis_bound_w(
    power: &AxisPower,
    axis: usize,
    mv: &Move,
    [v, a]: [f64; 2],
) -> [f64; 2] {
    let direction = (mv.end[axis] - mv.start[axis]) * power.si_per_unit / mv.length_mm;
    let inertia = power.mass * (direction * a).abs();
    let gravity = power.gravity * direction.signum();
    let speed = direction.abs() * v;
    let drive = inertia * power.accel_factor(Side::Motor, true);
    let brake = inertia * power.accel_factor(Side::Regen, false);
    let drag = power.coulomb_most() + power.viscous_most() * speed;
    let force = drive.max(brake) + drag + gravity.abs();
    let drawn_w = (speed * (drive + drag + gravity)).max(0.0) * power.inverse_efficiency;
    let least = power.coulomb * power.friction_factor(Side::Regen) + gravity;
    let fed_back_w = (speed * (brake - least)).max(0.0) * power.efficiency;
    [drawn_w + power.copper * force * force, fed_back_w].map(|power_w| power_w * (1.0 + ROUNDING))
}
