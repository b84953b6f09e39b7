//! How long a path is.

use gwatt_machine::{AxisId, AxisSet, AxisValues};

use super::moves::Arc;

/// Length of the path that F speaks for, in mm or degrees, and whether that is a length of
/// linear axes: XYZ if any of them moves, else UVW, else the rotary axes, else
/// the extruder (RS274/NGC, "Feed Rate").
#[must_use]
pub fn path_length(
    start: &AxisValues,
    end: &AxisValues,
    moving: AxisSet,
    arc: Option<&Arc>,
) -> (f64, bool) {
    let distance = |axis: usize| {
        if moving.contains(axis) {
            end[axis] - start[axis]
        } else {
            0.0
        }
    };
    if let Some(arc) = arc {
        let in_plane = arc.radius_mm * arc.sweep_rad.abs();
        let rise = distance(3 - arc.plane[0] - arc.plane[1]);
        return ((in_plane * in_plane + rise * rise).sqrt(), true);
    }
    for (axes, linear) in [([0, 1, 2], true), ([6, 7, 8], true), ([3, 4, 5], false)] {
        let [x, y, z] = axes.map(distance);
        let length = (x * x + y * y + z * z).sqrt();
        if length > 0.0 {
            return (length, linear);
        }
    }
    (distance(AxisId::E as usize).abs(), true)
}
