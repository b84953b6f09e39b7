//! Where the axes are along a piece of motion, and how far a point is from it.
//!
//! Input: moves and blends with their profiles. Output: position, speed and
//! acceleration of each axis at an instant, and the nearest point of the path in
//! X, Y and Z.

use super::lookahead::Blend;
use super::phase::State;
use super::profile::Profile;
use gwatt_machine::{AXES, AxisValues};
use gwatt_motion::Move;

/// The motion of all axes at one instant; mm (or degrees) and s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisStates {
    /// Positions.
    pub position: AxisValues,
    /// Speeds.
    pub velocity: AxisValues,
    /// Accelerations.
    pub accel: AxisValues,
}

/// The shape of a piece of motion, by the distance s along it.
#[derive(Debug, Clone, PartialEq)]
pub enum Track {
    /// Nothing moves.
    Rest(AxisValues),
    /// All axes in proportion.
    Line {
        /// At s = 0.
        start: AxisValues,
        /// By s.
        direction: AxisValues,
    },
    /// A circle in a plane, all other axes in proportion.
    Arc {
        /// Where it starts; only axes outside the plane count.
        start: AxisValues,
        /// By s; 0 in the plane.
        direction: AxisValues,
        /// First and second axis of the plane.
        plane: [usize; 2],
        /// Centre.
        center: [f64; 2],
        /// Radius at s = 0, mm.
        radius_mm: f64,
        /// Its change by s, where start and end are not on one circle.
        radius_slope: f64,
        /// At s = 0.
        angle_rad: f64,
        /// By s, signed.
        rad_per_mm: f64,
    },
    /// A corner that the controller rounds.
    Blend {
        /// At s = 0.
        start: AxisValues,
        /// Its shape in X, Y and Z.
        blend: Blend,
    },
    /// Each axis for itself, by its own profile.
    Axes {
        /// Where they start.
        start: AxisValues,
        /// Axis, sign and profile.
        profiles: Vec<(usize, f64, Profile)>,
    },
}

/// A point of a track near to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The point, X, Y and Z.
    pub point: [f64; 3],
    /// Distance squared, mm².
    pub distance2: f64,
}

impl Track {
    /// The path of a move.
    #[must_use]
    pub fn of(mv: &Move) -> Self {
        let length = mv.length_mm;
        let mut direction = [0.0; AXES];
        if length > 0.0 {
            for axis in mv.moving.iter() {
                if let Some(slot) = direction.get_mut(axis) {
                    *slot = (mv.end[axis] - mv.start[axis]) / length;
                }
            }
        }
        let Some(arc) = mv.arc.filter(|_| length > 0.0) else {
            return Self::Line {
                start: mv.start,
                direction,
            };
        };
        let from_center = |at: &AxisValues| {
            let [a, b] = arc.plane.map(|axis| at.get(axis).copied().unwrap_or(0.0));
            libm::hypot(a - arc.center[0], b - arc.center[1])
        };
        let radius_mm = from_center(&mv.start);
        for axis in arc.plane {
            if let Some(slot) = direction.get_mut(axis) {
                *slot = 0.0;
            }
        }
        Self::Arc {
            start: mv.start,
            direction,
            plane: arc.plane,
            center: arc.center,
            radius_mm,
            radius_slope: (from_center(&mv.end) - radius_mm) / length,
            angle_rad: arc.start_angle_rad,
            rad_per_mm: arc.sweep_rad / length,
        }
    }

    /// All axes where the path is at a state of its profile; of axes that run
    /// each for itself, `t` s after the start.
    #[must_use]
    pub fn at(&self, path: State, t: f64) -> AxisStates {
        let (s, v, a) = (path.position_mm, path.velocity_mm_s, path.accel_mm_s2);
        let mut states = AxisStates::default();
        let along = |states: &mut AxisStates, start: &AxisValues, direction: &AxisValues| {
            states.position = std::array::from_fn(|n| start[n] + direction[n] * s);
            states.velocity = direction.map(|d| d * v);
            states.accel = direction.map(|d| d * a);
        };
        match self {
            Self::Rest(position) => states.position = *position,
            Self::Line { start, direction } => along(&mut states, start, direction),
            Self::Arc {
                start,
                direction,
                plane,
                center,
                radius_mm,
                radius_slope,
                angle_rad,
                rad_per_mm,
            } => {
                along(&mut states, start, direction);
                let radius = radius_mm + radius_slope * s;
                let (sin, cos) = libm::sincos(angle_rad + rad_per_mm * s);
                let turn = rad_per_mm * v;
                let sides = [
                    (plane[0], center[0], cos, -sin),
                    (plane[1], center[1], sin, cos),
                ];
                for (axis, center, outward, tangent) in sides {
                    states.position[axis] = center + radius * outward;
                    states.velocity[axis] = radius * tangent * turn;
                    states.accel[axis] =
                        radius * (tangent * rad_per_mm * a - outward * turn * turn);
                }
            }
            Self::Blend { start, blend } => {
                states.position = *start;
                let arc = (s - blend.lead_mm).max(0.0);
                let (sin, cos) = libm::sincos(arc / blend.radius_mm);
                let lead = s.min(blend.lead_mm);
                let turning = if arc > 0.0 {
                    v * v / blend.radius_mm
                } else {
                    0.0
                };
                for n in 0..3 {
                    let (t, r) = (blend.tangent[n], blend.normal[n]);
                    let (along, across) = (t * cos + r * sin, r * cos - t * sin);
                    states.position[n] +=
                        t * (lead + blend.radius_mm * sin) + r * blend.radius_mm * (1.0 - cos);
                    states.velocity[n] = along * v;
                    states.accel[n] = along * a + across * turning;
                }
            }
            Self::Axes { start, profiles } => {
                states.position = *start;
                for (axis, sign, profile) in profiles {
                    let state = profile.state_at(t).unwrap_or_default();
                    let ended = t > profile.duration_s();
                    states.position[*axis] += sign * state.position_mm;
                    states.velocity[*axis] = sign * state.velocity_mm_s;
                    states.accel[*axis] = if ended { 0.0 } else { sign * state.accel_mm_s2 };
                }
            }
        }
        states
    }

    /// The point of the track between s = `from` and `to` that is nearest to
    /// `p`. Of a path of several turns that turn counts which is next to s =
    /// `hint`; of axes that run each for itself, the ends.
    #[must_use]
    pub fn nearest(&self, p: [f64; 3], [from, to]: [f64; 2], hint: f64) -> Nearest {
        let at = |s: f64| {
            let state = State {
                position_mm: s.clamp(from, to.max(from)),
                ..State::default()
            };
            self.point(p, state, 0.0)
        };
        match self {
            Self::Rest(_) => at(0.0),
            Self::Line { start, direction } => {
                let mut along = 0.0;
                let mut size2 = 0.0;
                for n in 0..3 {
                    along += (p[n] - start[n]) * direction[n];
                    size2 += direction[n] * direction[n];
                }
                // A line of rotary axes alone is a point.
                at(if size2 > 0.0 { along / size2 } else { from })
            }
            Self::Arc {
                plane,
                center,
                angle_rad,
                rad_per_mm,
                ..
            } => {
                let side = |n: usize| {
                    let axis = plane[n];
                    p.get(axis).copied().unwrap_or(0.0) - center[n]
                };
                let angle = libm::atan2(side(1), side(0));
                let turn = std::f64::consts::TAU / rad_per_mm.abs();
                let s = (angle - angle_rad) / rad_per_mm;
                let turns = ((hint - s) / turn).round();
                let by_angle = at(s + turns * turn);
                // Beyond an end the angle may be nearer to the other one.
                [at(from), at(to)]
                    .into_iter()
                    .fold(by_angle, Nearest::nearer)
            }
            Self::Blend { start, blend } => {
                let (mut x, mut y) = (0.0, 0.0);
                for n in 0..3 {
                    let d = p[n] - start[n];
                    x += d * blend.tangent[n];
                    y += d * blend.normal[n];
                }
                let on_lead = at(x.min(blend.lead_mm));
                let angle = libm::atan2(x - blend.lead_mm, blend.radius_mm - y);
                let on_arc =
                    at(blend.lead_mm + blend.radius_mm * angle.clamp(0.0, blend.sweep_rad));
                on_lead.nearer(on_arc)
            }
            Self::Axes { profiles, .. } => {
                let start = self.point(p, State::default(), 0.0);
                let duration = profiles
                    .iter()
                    .map(|(_, _, profile)| profile.duration_s())
                    .fold(0.0, f64::max);
                start.nearer(self.point(p, State::default(), duration))
            }
        }
    }

    fn point(&self, p: [f64; 3], state: State, t: f64) -> Nearest {
        let [x, y, z, ..] = self.at(state, t).position;
        let point = [x, y, z];
        let mut distance2 = 0.0;
        for (a, b) in p.iter().zip(point) {
            distance2 += (a - b) * (a - b);
        }
        Nearest { point, distance2 }
    }
}

impl Nearest {
    /// The nearer of two.
    #[must_use]
    pub fn nearer(self, other: Self) -> Self {
        if other.distance2 < self.distance2 {
            other
        } else {
            self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(s: f64) -> State {
        State {
            position_mm: s,
            velocity_mm_s: 10.0,
            accel_mm_s2: 3.0,
        }
    }

    /// Speed and acceleration are the derivatives of position under
    /// s'' = 3, s' = 10, and the nearest point of a point of the track is itself.
    #[test]
    fn tracks_agree_with_their_derivatives() {
        let mut start = [0.0; AXES];
        start[..3].copy_from_slice(&[1.0, 2.0, 3.0]);
        let mut rise = [0.0; AXES];
        rise[2] = 0.6;
        let tracks = [
            Track::Arc {
                start,
                direction: rise,
                plane: [0, 1],
                center: [-4.0, 1.0],
                radius_mm: 8.0,
                radius_slope: 0.0,
                angle_rad: 0.3,
                rad_per_mm: -0.1,
            },
            Track::Blend {
                start,
                blend: Blend {
                    lead_mm: 0.5,
                    radius_mm: 2.0,
                    sweep_rad: 2.0,
                    tangent: [0.6, 0.8, 0.0],
                    normal: [0.0, 0.0, 1.0],
                },
            },
            Track::Line {
                start,
                direction: rise,
            },
        ];
        for track in tracks {
            for s in [0.2, 1.0, 3.0] {
                let h = 1e-4;
                let moved = |t: f64| track.at(state(s + 10.0 * t + 1.5 * t * t), 0.0).position;
                let (before, here, after) = (moved(-h), track.at(state(s), 0.0), moved(h));
                for n in 0..3 {
                    let v = (after[n] - before[n]) / (2.0 * h);
                    let a = (after[n] - 2.0 * here.position[n] + before[n]) / (h * h);
                    assert!((v - here.velocity[n]).abs() < 1e-5, "{track:?} {s} {n}");
                    assert!((a - here.accel[n]).abs() < 1e-3, "{track:?} {s} {n}: {a}");
                }
                let [x, y, z, ..] = here.position;
                let near = track.nearest([x, y, z], [0.0, 4.0], s);
                assert!(near.distance2 < 1e-20, "{track:?} {s} {near:?}");
            }
        }
    }

    #[test]
    fn beyond_its_ends_the_end_is_nearest() {
        let mut direction = [0.0; AXES];
        direction[0] = 1.0;
        let line = Track::Line {
            start: [0.0; AXES],
            direction,
        };
        let near = line.nearest([-3.0, 4.0, 0.0], [0.0, 9.0], 0.0);
        assert_eq!((near.point, near.distance2), ([0.0; 3], 25.0));
        let quarter = Track::Arc {
            start: [0.0; AXES],
            direction: [0.0; AXES],
            plane: [0, 1],
            center: [0.0, 0.0],
            radius_mm: 10.0,
            radius_slope: 0.0,
            angle_rad: 0.0,
            rad_per_mm: 0.1,
        };
        let length = 5.0 * std::f64::consts::PI;
        let near = quarter.nearest([10.0, -1.0, 0.0], [0.0, length], 0.0);
        assert!((near.distance2 - 1.0).abs() < 1e-12);
        let near = quarter.nearest([6.0, 6.0, 0.0], [0.0, length], 0.0);
        assert!((near.distance2.sqrt() - (10.0 - 72_f64.sqrt())).abs() < 1e-12);
    }
}
