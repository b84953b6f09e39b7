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

/// Where a path heads.
#[derive(Debug, Clone, Copy)]
pub(in crate::power) struct Heading {
    /// Change of each axis per unit of path, of an arc without its plane.
    along: AxisValues,
    arc: Option<Turning>,
}

/// How an arc turns.
#[derive(Debug, Clone, Copy)]
struct Turning {
    plane: [usize; 2],
    radius_mm: f64,
    start_rad: f64,
    rad_per_mm: f64,
}

impl Heading {
    /// Along the path of a move.
    #[inline]
    pub fn of(mv: &Move) -> Self {
        let mut along = [0.0; AXES];
        let per_mm = 1.0 / mv.length_mm;
        for axis in mv.moving.iter() {
            if let Some(part) = along.get_mut(axis) {
                *part = (mv.end[axis] - mv.start[axis]) * per_mm;
            }
        }
        let arc = mv.arc.as_ref().map(|arc| Turning {
            plane: arc.plane,
            radius_mm: arc.radius_mm,
            start_rad: arc.start_angle_rad,
            rad_per_mm: arc.sweep_rad * per_mm,
        });
        Self { along, arc }
    }

    /// That of the chord which a controller runs for a piece of an arc, mm.
    #[inline]
    pub fn of_chord(&self, [from_mm, to_mm]: [f64; 2]) -> Self {
        Self {
            along: self.at(0.5 * (from_mm + to_mm)),
            arc: None,
        }
    }

    /// Change of each axis per unit of path at a place on it, mm.
    #[inline]
    pub fn at(&self, at_mm: f64) -> AxisValues {
        let mut direction = self.along;
        if let Some(arc) = &self.arc {
            let (sin, cos) = libm::sincos(arc.start_rad + arc.rad_per_mm * at_mm);
            let flat = arc.radius_mm * arc.rad_per_mm;
            for (axis, part) in arc.plane.into_iter().zip([-flat * sin, flat * cos]) {
                if let Some(value) = direction.get_mut(axis) {
                    *value = part;
                }
            }
        }
        direction
    }

    /// The least and the largest part of each axis in it, at any place.
    pub fn extremes(&self) -> [AxisValues; 2] {
        let mut parts = [self.along; 2];
        if let Some(arc) = &self.arc {
            let flat = (arc.radius_mm * arc.rad_per_mm).abs();
            for axis in arc.plane {
                for (values, part) in parts.iter_mut().zip([-flat, flat]) {
                    if let Some(value) = values.get_mut(axis) {
                        *value = part;
                    }
                }
            }
        }
        parts
    }

    /// By which it turns over a length, rad.
    fn turn_rad(&self, length_mm: f64) -> f64 {
        self.arc
            .as_ref()
            .map_or(0.0, |arc| (arc.rad_per_mm * length_mm).abs())
    }
}

/// A phase on the path of a move, whose positions count from the move's start: one
/// span on a line, several where the direction or the acceleration changes. `joint`:
/// it begins at a joint.
pub(in crate::power) fn spans(
    heading: &Heading,
    phase: &Phase,
    joint: bool,
    out: &mut impl FnMut(&Span),
) {
    let steady = phase.kind == PhaseKind::ConstantAcceleration;
    let least = if steady { 1.0 } else { CHANGING };
    let turn_rad = heading.turn_rad(phase.length_mm());
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
            direction: heading.at(middle_mm),
            speeds_mm_s: [state.velocity_mm_s, next.velocity_mm_s],
            joint: joint && index <= 1.0,
        });
        state = next;
    }
}
