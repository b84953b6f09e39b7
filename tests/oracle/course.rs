//! How the axes run a move from rest to rest.
//!
//! * Straight, direction u: `v ≤ v_n/|u_n|`, and so for acceleration and jerk.
//!   A drive's curve leaves `(F(v) ∓ (Fc + b·v) ∓ Fg)/m` of each axis.
//! * Arc: tangential and centripetal acceleration each at most `a_min/√2`, `a_min`
//!   the smallest limit of the moving axes; other axes follow in proportion.
//! * Independent rapids: each axis for itself.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

use gwatt::interpret::{Move, MoveKind};

use super::electrical::AxisState;
use super::plant::{Axis, LETTERS, Plant};
use super::profile::{Limits, Profile};

/// States of all axes by index.
pub type States = [AxisState; LETTERS.len()];

/// An arc: axes of its plane, radius, angle at the start, sweep.
#[derive(Debug, Clone, Copy)]
struct Circle {
    plane: [usize; 2],
    radius: f64,
    start: f64,
    sweep: f64,
}

/// How a move runs.
#[derive(Debug, Clone)]
pub enum Course {
    Rest(f64),
    Path(Path),
    /// Each axis by its index and the sign of its motion.
    Axes(Vec<(usize, f64, Profile)>),
}

/// Along one path.
#[derive(Debug, Clone)]
pub struct Path {
    length: f64,
    delta: [f64; LETTERS.len()],
    circle: Option<Circle>,
    profile: Profile,
}

/// The acceleration that the drive of an axis leaves at its speed `v`, upwards
/// (0) or downwards (1), moving in the direction of `sign`; in its units.
fn left(axis: &Axis, v: f64, sign: f64, side: usize) -> f64 {
    let drag = axis.coulomb + axis.viscous * v * axis.unit + sign * axis.gravity;
    let drag = if side == 0 { -drag } else { drag };
    (axis.force_n(v) + drag) / (axis.mass * axis.unit)
}

impl Course {
    /// The course of a move at overrides of feeds and rapids. Of the move only
    /// geometry, kind and feed are used.
    pub fn new(plant: &Plant, mv: &Move, [feed, rapid]: [f64; 2]) -> Self {
        if mv.kind == MoveKind::Dwell {
            return Self::Rest(mv.dwell_s);
        }
        let delta: [f64; LETTERS.len()] = std::array::from_fn(|i| mv.end[i] - mv.start[i]);
        let is_rapid = mv.kind == MoveKind::Rapid;
        let speed_factor = if is_rapid { rapid } else { 1.0 };
        let moving = |axis: &&Axis| delta[axis.index] != 0.0;
        if is_rapid && plant.independent {
            let axes = plant.axes.iter().filter(moving);
            return Self::Axes(
                axes.map(|axis| alone(axis, delta[axis.index], rapid))
                    .collect(),
            );
        }
        let circle = Circle::of(mv);
        let in_plane = |axis: usize| circle.is_some_and(|arc| arc.plane.contains(&axis));
        let turned = circle.map_or(0.0, |arc| arc.radius * arc.sweep.abs());
        let length = if let Some(arc) = circle {
            let rest = (0..delta.len()).filter(|axis| !arc.plane.contains(axis));
            libm::hypot(
                turned,
                rest.map(|axis| delta[axis] * delta[axis])
                    .sum::<f64>()
                    .sqrt(),
            )
        } else {
            mv.length_mm
        };
        if length <= 0.0 {
            return Self::Rest(0.0);
        }
        let mut limits = Limits {
            speed: if is_rapid {
                f64::INFINITY
            } else {
                mv.feed_mm_s * feed
            },
            accel: f64::INFINITY,
            jerk: f64::INFINITY,
            curve: None,
        };
        let mut smallest = f64::INFINITY;
        for axis in &plant.axes {
            let part = if let Some(arc) = circle.filter(|_| in_plane(axis.index)) {
                smallest = smallest.min(axis.accel);
                limits.speed = limits
                    .speed
                    .min(axis.speed * length / turned / arc.most(axis.index));
                continue;
            } else {
                delta[axis.index].abs() / length
            };
            if part > 0.0 {
                smallest = smallest.min(axis.accel);
                limits.speed = limits.speed.min(axis.speed * speed_factor / part);
                limits.accel = limits.accel.min(axis.accel / part);
                limits.jerk = limits.jerk.min(axis.jerk / part);
            }
        }
        if let Some(arc) = circle {
            let half = smallest * FRAC_1_SQRT_2;
            limits.speed = limits
                .speed
                .min((half * arc.radius).sqrt() * length / turned);
            limits.accel = limits.accel.min(half);
        }
        let share = |axis: &Axis| delta[axis.index] / length;
        let curve = |v: f64, side: usize| {
            let axes = plant
                .axes
                .iter()
                .filter(moving)
                .filter(|axis| !axis.curve.is_empty());
            let own = axes.map(|axis| {
                let u = share(axis);
                left(axis, u.abs() * v, u.signum(), side) / u.abs()
            });
            own.fold(f64::INFINITY, f64::min)
        };
        let sides: [&dyn Fn(f64) -> f64; 2] = [&|v| curve(v, 0), &|v| curve(v, 1)];
        let curved = plant
            .axes
            .iter()
            .filter(moving)
            .any(|axis| !axis.curve.is_empty());
        limits.curve = (curved && circle.is_none()).then_some(sides);
        let profile = limits.run(length);
        Self::Path(Path {
            length,
            delta,
            circle,
            profile,
        })
    }

    /// How long it lasts.
    pub fn duration_s(&self) -> f64 {
        match self {
            Self::Rest(lasts_s) => *lasts_s,
            Self::Path(path) => path.profile.duration_s(),
            Self::Axes(axes) => {
                let lasts = axes.iter().map(|(_, _, profile)| profile.duration_s());
                lasts.fold(0.0, f64::max)
            }
        }
    }

    /// Where its laws change, and where axes turn back on an arc.
    pub fn breaks_s(&self) -> Vec<f64> {
        let mut times = match self {
            Self::Rest(lasts_s) => vec![0.0, *lasts_s],
            Self::Path(path) => {
                let turned = path.quadrants_s();
                path.profile.times_s.iter().copied().chain(turned).collect()
            }
            Self::Axes(axes) => {
                let all = axes
                    .iter()
                    .flat_map(|(_, _, profile)| profile.times_s.clone());
                all.collect()
            }
        };
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Whether powers have their extremes where laws change.
    pub fn is_plain(&self) -> bool {
        match self {
            Self::Rest(_) => true,
            Self::Path(path) => path.circle.is_none() && path.profile.is_plain(),
            Self::Axes(axes) => axes.iter().all(|(_, _, profile)| profile.is_plain()),
        }
    }

    /// The turns of its arc; 0 for straight ones.
    pub fn turns(&self) -> f64 {
        match self {
            Self::Path(Path {
                circle: Some(arc), ..
            }) => arc.sweep.abs() / (4.0 * FRAC_PI_2),
            _ => 0.0,
        }
    }

    /// The axes at `t`, by the laws that hold at `inside`.
    pub fn at(&self, t: f64, inside: f64) -> States {
        let mut states = [AxisState::default(); LETTERS.len()];
        match self {
            Self::Rest(_) => {}
            Self::Axes(axes) => {
                for (index, sign, profile) in axes {
                    if let Some([_, v, a]) = profile.at(t, inside) {
                        states[*index] = AxisState {
                            v: sign * v,
                            a: sign * a,
                            sign: *sign,
                        };
                    }
                }
            }
            Self::Path(path) => path.at(t, inside, &mut states),
        }
        states
    }
}

impl Circle {
    /// The arc of a move.
    fn of(mv: &Move) -> Option<Self> {
        let arc = mv.arc?;
        let [x, y] = [0, 1].map(|i| mv.start[arc.plane[i]] - arc.center[i]);
        Some(Self {
            plane: arc.plane,
            radius: libm::hypot(x, y),
            start: libm::atan2(y, x),
            sweep: arc.sweep_rad,
        })
    }

    /// The largest part of the speed in the plane that an axis sees.
    fn most(&self, axis: usize) -> f64 {
        let tangent = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            if axis == self.plane[0] {
                sin.abs()
            } else {
                cos.abs()
            }
        };
        let offset = if axis == self.plane[0] {
            FRAC_PI_2
        } else {
            0.0
        };
        let ends = [self.start, self.start + self.sweep];
        // Whole where a multiple of π, from where it is 1, lies between the ends.
        let [from, to] = ends.map(|angle| (angle - offset) / (2.0 * FRAC_PI_2));
        if from.floor() == to.floor() {
            ends.map(tangent).into_iter().fold(0.0, f64::max)
        } else {
            1.0
        }
    }
}

impl Path {
    /// When an axis of an arc's plane turns back.
    fn quadrants_s(&self) -> Vec<f64> {
        let Some(arc) = self.circle else {
            return vec![];
        };
        let [first, last] = [arc.start, arc.start + arc.sweep].map(|angle| angle / FRAC_PI_2);
        let (low, high) = (
            first.min(last).ceil() as i64,
            first.max(last).floor() as i64,
        );
        let position = |quadrant: i64| (quadrant as f64 - first) / (last - first) * self.length;
        (low..=high)
            .map(|quadrant| self.when(position(quadrant)))
            .collect()
    }

    /// When the path is at a position.
    fn when(&self, position: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.profile.duration_s());
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match self.profile.at(middle, middle) {
                Some([s, ..]) if s < position => low = middle,
                _ => high = middle,
            }
        }
        high
    }

    fn at(&self, t: f64, inside: f64, states: &mut States) {
        let (Some([s, v, a]), Some([near_s, near_v, _])) =
            (self.profile.at(t, inside), self.profile.at(inside, inside))
        else {
            return;
        };
        for (index, state) in states.iter_mut().enumerate() {
            let u = self.delta[index] / self.length;
            *state = AxisState {
                v: u * v,
                a: u * a,
                sign: if u == 0.0 { 0.0 } else { u.signum() },
            };
        }
        let Some(arc) = self.circle else { return };
        let turn = arc.sweep / self.length;
        let (omega, alpha) = (turn * v, turn * a);
        let (sin, cos) = libm::sincos(arc.start + turn * s);
        let (near_sin, near_cos) = libm::sincos(arc.start + turn * near_s);
        let planes = [(-sin, -cos, -near_sin), (cos, -sin, near_cos)];
        for (axis, (tangent, normal, near)) in arc.plane.into_iter().zip(planes) {
            let sign = (near * turn * near_v).signum();
            let v = arc.radius * omega * tangent;
            states[axis] = AxisState {
                v,
                a: arc.radius * (alpha * tangent + omega * omega * normal),
                // Where it turns back, that of the stretch.
                sign,
            };
        }
    }
}

/// An axis by itself.
fn alone(axis: &Axis, delta: f64, rapid: f64) -> (usize, f64, Profile) {
    let sides: [&dyn Fn(f64) -> f64; 2] = [&|v| left(axis, v, delta.signum(), 0), &|v| {
        left(axis, v, delta.signum(), 1)
    }];
    let limits = Limits {
        speed: axis.speed * rapid,
        accel: axis.accel,
        jerk: axis.jerk,
        curve: (!axis.curve.is_empty()).then_some(sides),
    };
    (axis.index, delta.signum(), limits.run(delta.abs()))
}
