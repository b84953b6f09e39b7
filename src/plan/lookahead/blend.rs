//! Blend arcs: how `LinuxCNC` 2.9 rounds the corner of two elements in G64.
//!
//! Input: both sides of a joint. Output: the circle, what it takes from each
//! side, and the speed that it is planned for. Facts from the planner's source
//! (`blendmath.c`) and measurements; lengths in mm, angles in rad.
//!
//! ```text
//!        P          θ half the inside angle, φ = π − 2θ the turn. A circle of
//!       ╱│╲         radius R stands R/sin θ from P on the bisector, touches
//!      ╱ │ ╲        the sides d = R/tan θ from P and passes P at a distance of
//!     ╱ (R) ╲       R/sin θ − R: the tolerance, so R = s·p/(1 − s).
//! ```

use super::super::arc::LINUXCNC_NORMAL_SHARE as NORMAL_SHARE;
use super::super::limits;
use super::vector::{Vector, add, angle, cross, dot, length, scale, sub, unit};
use crate::machine::{AxisValues, Machine};
use std::f64::consts::{FRAC_PI_2, PI};

/// Share of an element that one blend may take.
const LENGTH_SHARE: f64 = 0.5;
/// Share of an element that the tolerance may be.
const TOLERANCE_SHARE: f64 = 0.25;
const ANGLE_MIN: f64 = 1e-6;
const ARC_LENGTH_MIN_MM: f64 = 1e-6;
/// Smallest half angle between two arcs.
const ARCS_ANGLE_MIN: f64 = PI / 12.0;

/// The machine's limits of X, Y and Z; 0 for axes that it does not have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    exists: [bool; 3],
    pub speed: Vector,
    /// The lowest of them.
    least_speed: f64,
    pub jerk: Vector,
}

impl Axes {
    pub fn of(machine: &Machine) -> Self {
        let axis = |i: usize| machine.axes.get(i).and_then(Option::as_ref);
        let speeds = [0, 1, 2].map(|i| axis(i).map(|axis| axis.rapid_mm_s));
        Self {
            exists: speeds.map(|speed| speed.is_some()),
            speed: speeds.map(Option::unwrap_or_default),
            least_speed: speeds.into_iter().flatten().fold(f64::INFINITY, f64::min),
            jerk: [0, 1, 2].map(|i| axis(i).map_or(f64::INFINITY, limits::jerk)),
        }
    }

    pub fn accel(&self, limits: &AxisValues) -> Vector {
        self.masked([limits[0], limits[1], limits[2]])
    }

    /// The same of X, Y and Z.
    #[inline]
    pub fn masked(&self, limits: Vector) -> Vector {
        [0, 1, 2].map(|i| if self.exists[i] { limits[i] } else { 0.0 })
    }
}

/// One side of a joint.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub leg: Leg,
    /// Of an arc: from the joint to its centre, its radius, its angle and the
    /// normal of its plane.
    pub circle: Option<Circle>,
}

/// What a side of a joint is, straight or not.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg {
    /// Unit direction of motion at the joint.
    pub tangent: Vector,
    /// Length as programmed, and what earlier blends left of it.
    pub nominal_mm: f64,
    pub length_mm: f64,
    /// Largest speed, and the one asked for.
    pub max_speed: f64,
    pub asked_speed: f64,
    /// P of the program.
    pub tolerance_mm: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    pub center: Vector,
    pub radius: f64,
    pub angle: f64,
    pub normal: Vector,
}

/// A blend between two elements.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub radius: f64,
    pub sweep: f64,
    pub tangent: Vector,
    pub normal: Vector,
    /// What it takes from the first side and the second: mm of a line, rad of
    /// an arc.
    pub trims: [f64; 2],
    /// Speed that it is planned for, and acceleration of its plane.
    pub speed: f64,
    pub asked_speed: f64,
    pub accel: f64,
}

impl Leg {
    fn target_speed(&self) -> f64 {
        self.asked_speed.min(self.max_speed)
    }

    fn tolerance(&self) -> f64 {
        let most = self.nominal_mm * TOLERANCE_SHARE;
        if self.tolerance_mm == 0.0 {
            most
        } else {
            self.tolerance_mm.min(most)
        }
    }
}

/// Diameter of the circle that fits into the box of the limits, cut through its
/// centre by the plane with this normal.
fn inscribed(normal: Vector, limits: Vector) -> f64 {
    let mut smallest2 = f64::INFINITY;
    for (limit, part) in limits.into_iter().zip(normal) {
        if limit > 0.0 {
            let across2 = (1.0 - part * part).max(1e-24);
            smallest2 = smallest2.min(limit * limit / across2);
        }
    }
    smallest2.sqrt()
}

/// The corner that a blend rounds.
#[derive(Debug, Clone, Copy)]
struct Corner {
    /// Of half the angle inside.
    sin: f64,
    cos: f64,
    /// By which the path turns.
    turn: f64,
    /// Unit normal of its plane.
    binormal: Vector,
}

impl Corner {
    /// Of two lines; with `θ = (π − φ)/2` the sum of their directions is as long
    /// as `2·sin θ`, the difference as `2·cos θ`. `None` where there is none.
    #[inline]
    fn of([u, w]: [Vector; 2]) -> Option<Self> {
        let (sin, cos) = (0.5 * length(add(u, w)), 0.5 * length(sub(w, u)));
        let least = if cos < sin { cos } else { sin };
        let small = libm::asin(least);
        if small < ANGLE_MIN {
            return None;
        }
        Some(Self {
            sin,
            cos,
            turn: 2.0 * if cos < sin { small } else { FRAC_PI_2 - small },
            binormal: scale(cross(u, w), 0.5 / (sin * cos)),
        })
    }

    /// Half the angle inside.
    fn theta(&self) -> f64 {
        FRAC_PI_2 - 0.5 * self.turn
    }

    /// The same corner with another angle, half of it given.
    fn with(self, theta: f64) -> Self {
        Self {
            sin: libm::sin(theta),
            cos: libm::cos(theta),
            turn: PI - 2.0 * theta,
            ..self
        }
    }

    /// The speed that both sides and the plane permit.
    #[inline]
    fn goal(&self, [first, second]: [&Leg; 2], axes: &Axes, straight: bool) -> f64 {
        let asked = first.target_speed().max(second.target_speed());
        // Whatever the plane, that much fits into it.
        if axes.least_speed >= asked {
            return asked;
        }
        let planar = inscribed(self.binormal, axes.speed);
        if !straight || planar >= asked {
            return asked.min(planar);
        }
        let cos = libm::cos(self.turn.min(PI * 0.49));
        let v1 = first.max_speed.min(second.max_speed / cos);
        let v2 = second.max_speed.min(first.max_speed / cos);
        let base = length(sub(scale(second.tangent, v2), scale(first.tangent, v1)));
        let altitude = v1 * v2 * libm::sin(self.turn) / base;
        asked.min(altitude.max(planar))
    }

    /// The blend between two legs that give up so much at most, mm.
    #[inline]
    fn round(
        &self,
        legs: [&Leg; 2],
        most_mm: [f64; 2],
        axes: &Axes,
        accel: Vector,
        straight: bool,
    ) -> Option<Fit> {
        let [first, second] = legs;
        let a = inscribed(self.binormal, accel);
        let v_goal = self.goal(legs, axes, straight);
        let (s, c, turn) = (self.sin, self.cos, self.turn);
        let tolerance = first.tolerance().min(second.tolerance());
        // cos θ/(1 − sin θ) without a difference.
        let d_most = ((1.0 + s) * tolerance / c).min(most_mm[0].min(most_mm[1]));
        let r_most = s / c * d_most;
        let v = (a * NORMAL_SHARE * r_most).sqrt().min(v_goal);
        // A circle no larger than a blend by two ramps at half the acceleration,
        // each over its side, takes; nor smaller than the speed needs.
        let half = 0.5 * a;
        let ramp_s = (2.0 * half * d_most).sqrt().min(v) / half;
        let radius = (v * v / (a * NORMAL_SHARE)).max((ramp_s * v / turn).min(r_most));
        if radius < 1e-12 || radius * turn < ARC_LENGTH_MIN_MM {
            return None;
        }
        Some(Fit {
            radius,
            sweep: turn,
            tangent: first.tangent,
            normal: cross(self.binormal, first.tangent),
            trims: [radius * c / s; 2],
            speed: v,
            asked_speed: first.target_speed().max(second.target_speed()),
            accel: a,
        })
    }
}

/// The blend between two lines, if there is one that fits.
#[inline]
pub(super) fn between_lines(legs: [&Leg; 2], axes: &Axes, accel: Vector) -> Option<Fit> {
    let corner = Corner::of(legs.map(|leg| leg.tangent))?;
    corner.round(legs, legs_give(legs), axes, accel, true)
}

/// A line gives at most half of its programmed length and what is left of it.
#[inline]
fn legs_give([first, second]: [&Leg; 2]) -> [f64; 2] {
    [
        first.length_mm.min(first.nominal_mm * LENGTH_SHARE),
        second.length_mm * LENGTH_SHARE,
    ]
}

/// How an arc enters the fit: the blend lies inside its circle, how much of it
/// the blend may take, and the length that this stands for.
struct Bent {
    convex: bool,
    most: f64,
}

impl Bent {
    fn of(circle: &Circle, bisector: Vector, theta: f64, share: f64) -> Self {
        let convex = dot(circle.center, bisector) > 0.0;
        let blend = if convex { theta } else { FRAC_PI_2 };
        Self {
            convex,
            most: (circle.angle * share).min(blend),
        }
    }

    fn reach(&self, circle: &Circle) -> f64 {
        if self.convex {
            libm::sin(self.most / 4.0) * circle.radius
        } else {
            self.most * circle.radius
        }
    }
}

/// The blend of a joint, if there is one that fits.
pub(super) fn fit(sides: [&Side; 2], axes: &Axes, accel: Vector) -> Option<Fit> {
    let legs = sides.map(|side| &side.leg);
    if sides.iter().all(|side| side.circle.is_none()) {
        return between_lines(legs, axes, accel);
    }
    let corner = Corner::of(legs.map(|leg| leg.tangent))?;
    let bisector = unit(sub(legs[1].tangent, legs[0].tangent))?;
    let theta = corner.theta();
    let mut least = theta;
    let mut most_mm = legs_give(legs);
    let shares = [2.0 / 3.0, 1.0 / 3.0];
    let mut bent: [Option<Bent>; 2] = [None, None];
    for (i, (side, share)) in sides.iter().zip(shares).enumerate() {
        if let Some(circle) = &side.circle {
            if length(cross(corner.binormal, circle.normal)) >= ANGLE_MIN {
                return None;
            }
            let of = Bent::of(circle, bisector, theta, share);
            if of.convex {
                least = least.min(theta - of.most / 4.0);
            }
            most_mm[i] = of.reach(circle);
            bent[i] = Some(of);
        }
    }
    if bent.iter().all(Option::is_some) && least < ARCS_ANGLE_MIN {
        return None;
    }
    let tolerance = legs[0].tolerance().min(legs[1].tolerance());
    let lines = corner
        .with(least)
        .round(legs, most_mm, axes, accel, false)?;
    onto_arcs(lines, sides, &bent, corner.binormal, bisector, tolerance)
}

/// Moves a blend that was fitted to lines so that it touches the arcs.
fn onto_arcs(
    mut fit: Fit,
    sides: [&Side; 2],
    bent: &[Option<Bent>; 2],
    binormal: Vector,
    bisector: Vector,
    tolerance: f64,
) -> Option<Fit> {
    let r = fit.radius;
    // Distance between the centres of blend and arc.
    let apart = |i: usize| -> Option<f64> {
        let circle = sides[i].circle.as_ref()?;
        Some(if bent[i].as_ref()?.convex {
            circle.radius - r
        } else {
            circle.radius + r
        })
    };
    let center = match (&sides[0].circle, &sides[1].circle) {
        (Some(first), Some(second)) => {
            between_arcs(first.center, second.center, apart(0)?, apart(1)?, binormal)?
        }
        (None, Some(circle)) => {
            let (center, d) = beside_line(
                scale(sides[0].leg.tangent, -1.0),
                circle.center,
                apart(1)?,
                r,
                binormal,
                bisector,
            )?;
            fit.trims[0] = d;
            center
        }
        (Some(circle), None) => {
            let (center, d) = beside_line(
                sides[1].leg.tangent,
                circle.center,
                apart(0)?,
                r,
                binormal,
                bisector,
            )?;
            fit.trims[1] = d;
            center
        }
        (None, None) => return None,
    };
    if length(center) - r > tolerance {
        return None;
    }
    for (i, side) in sides.iter().enumerate() {
        if let (Some(circle), Some(bent)) = (&side.circle, &bent[i]) {
            let to_joint = unit(scale(circle.center, -1.0))?;
            let trim = angle(unit(sub(center, circle.center))?, to_joint);
            if trim > bent.most {
                return None;
            }
            fit.trims[i] = trim;
        }
    }
    let touch = |i: usize, sign: f64| -> Option<Vector> {
        Some(match &sides[i].circle {
            None => scale(sides[i].leg.tangent, sign * fit.trims[i]),
            Some(circle) => {
                let out = unit(sub(center, circle.center))?;
                add(circle.center, scale(out, circle.radius))
            }
        })
    };
    let (from, to) = (touch(0, -1.0)?, touch(1, 1.0)?);
    let (out, back) = (unit(sub(from, center))?, unit(sub(to, center))?);
    fit.sweep = angle(out, back);
    fit.radius = length(sub(from, center));
    fit.normal = scale(out, -1.0);
    fit.tangent = cross(binormal, out);
    (fit.radius * fit.sweep >= ARC_LENGTH_MIN_MM).then_some(fit)
}

/// Centre of a circle of radius `r` that touches a line through the joint on
/// the side of the bisector and stands `apart` from the arc's centre; and how
/// far from the joint it touches the line. `away` points along the line.
fn beside_line(
    away: Vector,
    arc_center: Vector,
    apart: f64,
    r: f64,
    binormal: Vector,
    bisector: Vector,
) -> Option<(Vector, f64)> {
    let mut side = unit(cross(binormal, away))?;
    if dot(side, bisector) < 0.0 {
        side = scale(side, -1.0);
    }
    let (along, across) = (dot(arc_center, away), dot(arc_center, side));
    let rest2 = apart * apart - (r - across) * (r - across);
    if rest2 < 0.0 {
        return None;
    }
    let root = rest2.sqrt();
    let d = (along + root).abs().min((along - root).abs());
    Some((add(scale(away, d), scale(side, r)), d))
}

/// Centre of a circle at given distances from two centres, the one nearer to
/// the joint.
fn between_arcs(
    first: Vector,
    second: Vector,
    d1: f64,
    d2: f64,
    binormal: Vector,
) -> Option<Vector> {
    let apart = sub(second, first);
    let c = length(apart);
    let along = unit(apart)?;
    let x = (d1 * d1 - d2 * d2 + c * c) / (2.0 * c);
    let y2 = d1 * d1 - x * x;
    if y2 < 0.0 {
        return None;
    }
    let side = scale(unit(cross(binormal, along))?, y2.sqrt());
    let base = add(first, scale(along, x));
    let (one, other) = (add(base, side), sub(base, side));
    Some(if length(other) < length(one) {
        other
    } else {
        one
    })
}

/// The inside angle of a corner.
pub(super) fn angle_between(before: Vector, after: Vector) -> f64 {
    angle(scale(before, -1.0), after)
}
