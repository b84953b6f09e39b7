//! Planned pieces as spans: directions of lines and of arcs.

use super::{Beyond, Span, velocity};
use gwatt_machine::{AXES, AxisValues};
use gwatt_motion::Move;
use gwatt_plan::lookahead::Piece;
use gwatt_plan::{Blend, Phase, PhaseKind};

/// Turn of an arc over which it counts as straight, rad.
const TURN_RAD: f64 = 0.1;
/// Spans of one phase at most.
const SPANS_MAX: f64 = 256.0;
/// Spans of a phase whose acceleration changes, at least.
const CHANGING: f64 = 4.0;
/// Share of the acceleration along a path by which the mean over a response time may be off
/// where the path turns and is followed closely, and the least and the largest turns of a span
/// then, rad.
const CLOSE: f64 = 0.01;
const CLOSE_RAD: [f64; 2] = [0.02, 0.5];

/// Where a path heads.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Heading {
    /// Change of each axis per unit of path, of an arc without its plane.
    along: AxisValues,
    arc: Option<Turning>,
    blend: Option<Blend>,
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
        Self {
            along,
            arc,
            blend: None,
        }
    }

    /// Along a piece of a plan, which belongs to a move.
    #[inline]
    pub fn of_piece(mv: &Move, piece: &Piece) -> Self {
        let straight = |along: AxisValues| Self {
            along,
            arc: None,
            blend: None,
        };
        match piece {
            Piece::Along { .. } => Self::of(mv),
            Piece::Joined { direction } => straight(*direction),
            Piece::Blend(blend) => Self {
                blend: Some(*blend),
                ..straight([0.0; AXES])
            },
        }
    }

    /// That of the chord which a controller runs for a piece of an arc, mm.
    #[inline]
    pub fn of_chord(&self, [from_mm, to_mm]: [f64; 2]) -> Self {
        Self {
            along: self.at(0.5 * (from_mm + to_mm)),
            arc: None,
            blend: None,
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
        if let Some(blend) = &self.blend {
            let turned = (at_mm - blend.lead_mm).max(0.0) / blend.radius_mm;
            let (sin, cos) = libm::sincos(turned.min(blend.sweep_rad));
            for (value, (first, normal)) in (direction.iter_mut()).zip(frame(blend)) {
                *value = first * cos + normal * sin;
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
        if let Some(blend) = &self.blend {
            let [least, largest] = &mut parts;
            let both = least.iter_mut().zip(largest).zip(frame(blend));
            for ((least, largest), (first, normal)) in both {
                *largest = (first * first + normal * normal).sqrt();
                *least = -*largest;
            }
        }
        parts
    }

    /// Whether it is one all along.
    fn is_straight(&self) -> bool {
        self.arc.is_none() && self.blend.is_none()
    }

    /// By which it turns at most over a length, rad.
    fn turn_rad(&self, length_mm: f64) -> f64 {
        match (&self.arc, &self.blend) {
            (Some(arc), _) => (arc.rad_per_mm * length_mm).abs(),
            (None, Some(blend)) => (length_mm / blend.radius_mm).min(blend.sweep_rad),
            (None, None) => 0.0,
        }
    }
}

/// Tangent and normal of a blend by axis.
fn frame(blend: &Blend) -> impl Iterator<Item = (f64, f64)> {
    blend.tangent.into_iter().zip(blend.normal)
}

/// A phase on the path of a move, whose positions count from the move's start: one
/// span on a line, several where the direction or the acceleration changes. `joint`:
/// it begins at a joint.
pub(crate) fn spans(
    heading: &Heading,
    phase: &Phase,
    joint: bool,
    beyond: Beyond,
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
        let first = index <= 1.0;
        let span = Span::straight(
            share_s,
            &heading.at(middle_mm),
            [state.velocity_mm_s, next.velocity_mm_s],
            joint && first,
        );
        let joint = if first { beyond.joint } else { 1.0 };
        let beyond = Beyond { joint, ..beyond };
        out(&Span { beyond, ..span });
        state = next;
    }
}

/// The same where what the path turns by within a span counts too: the speeds of the axes are
/// those of the path at both ends of it. What is further from both ends of the phase than steps
/// at joints reach (`reach_s`) is one span.
pub(crate) fn close_spans(
    heading: &Heading,
    phase: &Phase,
    joint: bool,
    [response_s, accel_mm_s2]: [f64; 2],
    out: &mut impl FnMut(&Span),
) {
    if heading.is_straight() {
        return spans(heading, phase, joint, Beyond::NONE, out);
    }
    let reach_s = 2.0 * response_s;
    let whole_s = phase.duration_s;
    let edges_s = if whole_s > 2.0 * reach_s {
        [0.0, reach_s, whole_s - reach_s, whole_s]
    } else {
        [0.0, 0.0, 0.0, whole_s]
    };
    let top_mm_s = phase.velocity_mm_s.max(phase.end_velocity_mm_s);
    // A chord of the turn θ has speeds off by up to v·θ²/8, at both ends of a mean.
    let turn_rad = (4.0 * CLOSE * accel_mm_s2 * response_s / top_mm_s).sqrt();
    let turn_rad = turn_rad.clamp(CLOSE_RAD[0], CLOSE_RAD[1]);
    let mut state = phase.state_at(0.0);
    let mut first = velocity(&heading.at(state.position_mm), state.velocity_mm_s);
    let mut joint = joint;
    for (part, ends_s) in edges_s.windows(2).enumerate() {
        let &[from_s, to_s] = ends_s else { continue };
        let last_mm = phase.state_at(to_s).position_mm;
        let turns = heading.turn_rad(last_mm - state.position_mm) / turn_rad;
        let count = if part == 1 {
            1.0
        } else {
            libm::ceil(turns).clamp(1.0, SPANS_MAX)
        };
        let share_s = (to_s - from_s) / count;
        let mut index = 0.0;
        while share_s > 0.0 && index < count {
            index += 1.0;
            let mut next = phase.state_at(from_s + index * share_s);
            if part == 2 && index >= count {
                next.velocity_mm_s = phase.end_velocity_mm_s;
            }
            let last = velocity(&heading.at(next.position_mm), next.velocity_mm_s);
            out(&Span {
                duration_s: share_s,
                axes_mm_s: [first, last],
                top_mm_s: state.velocity_mm_s.max(next.velocity_mm_s),
                joint,
                beyond: Beyond::NONE,
            });
            (state, first, joint) = (next, last, false);
        }
    }
}
