//! Planned pieces as spans: directions of lines and of arcs.

use super::Span;
use crate::interpret::Move;
use crate::machine::{AXES, AxisValues};
use crate::plan::{Phase, PhaseKind};

/// Turn of an arc over which it counts as straight, rad.
const TURN_RAD: f64 = 0.1;
/// Spans of one phase at most.
const SPANS_MAX: f64 = 256.0;
/// Spans of a phase whose acceleration changes, at least.
const CHANGING: f64 = 4.0;

/// Change of each axis per unit of path at a place on the path of a move, mm.
pub(in crate::power) fn tangent(mv: &Move, at_mm: f64) -> AxisValues {
    let mut direction = [0.0; AXES];
    for axis in mv.moving.iter() {
        direction[axis] = (mv.end[axis] - mv.start[axis]) / mv.length_mm;
    }
    if let Some(arc) = &mv.arc {
        let turn = arc.sweep_rad / mv.length_mm;
        let (sin, cos) = libm::sincos(arc.start_angle_rad + turn * at_mm);
        let [first, second] = arc.plane;
        direction[first] = -arc.radius_mm * turn * sin;
        direction[second] = arc.radius_mm * turn * cos;
    }
    direction
}

/// A phase on the path of a move, whose positions count from the move's start: one
/// span on a line, several where the direction or the acceleration changes. `joint`:
/// it begins at a joint.
pub(in crate::power) fn arc_spans(mv: &Move, phase: &Phase, joint: bool, out: &mut impl FnMut(&Span)) {
    let steady = phase.kind == PhaseKind::ConstantAcceleration;
    let least = if steady { 1.0 } else { CHANGING };
    let turn_rad = mv.arc.as_ref().map_or(0.0, |arc| {
        arc.sweep_rad.abs() / mv.length_mm * phase.length_mm()
    });
    let count = libm::ceil(turn_rad / TURN_RAD).clamp(least, SPANS_MAX);
    let share_s = phase.duration_s / count;
    let mut state = phase.state_at(0.0);
    let mut index = 0.0;
    while index < count {
        index += 1.0;
        let mut next = phase.state_at(index * share_s);
        if index >= count {
            next.velocity_mm_s = phase.end_velocity_mm_s;
        }
        let middle_mm = 0.5 * (state.position_mm + next.position_mm);
        out(&Span {
            duration_s: share_s,
            direction: tangent(mv, middle_mm),
            speeds_mm_s: [state.velocity_mm_s, next.velocity_mm_s],
            joint: joint && index <= 1.0,
        });
        state = next;
    }
}
