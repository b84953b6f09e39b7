//! Blends that touch arcs.

use super::super::super::arc_plane::LINUXCNC_NORMAL_SHARE as NORMAL_SHARE;
use super::super::vector::{Vector, add, angle, cross, dot, length, scale, sub, unit};
use super::corner::legs_give;
use super::{ANGLE_MIN, ARC_LENGTH_MIN_MM, Axes, Circle, Corner, Fit, Side};
use std::f64::consts::{FRAC_PI_2, PI};

/// Smallest half angle between two arcs.
const ARCS_ANGLE_MIN: f64 = PI / 12.0;
/// Share of its acceleration that a blend may take, over one servo cycle, where its
/// direction is not that of the arc that it touches.
const KINK_SHARE: f64 = 0.25;

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

/// The blend of a joint with an arc, if there is one that fits; `corner` is that of
/// the tangents.
pub(super) fn fit(
    corner: Corner,
    sides: [&Side; 2],
    axes: &Axes,
    accel: Vector,
    cycle_s: f64,
) -> Option<Fit> {
    let legs = sides.map(|side| &side.leg);
    let binormal = corner.binormal();
    let bisector = unit(sub(legs[1].tangent, legs[0].tangent))?;
    let theta = corner.theta();
    let mut least = theta;
    let mut most_mm = legs_give(legs);
    let shares = [2.0 / 3.0, 1.0 / 3.0];
    let mut bent: [Option<Bent>; 2] = [None, None];
    for (i, (side, share)) in sides.iter().zip(shares).enumerate() {
        if let Some(circle) = &side.circle {
            if length(cross(binormal, circle.normal)) >= ANGLE_MIN {
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
    let corner = corner.with(least);
    let rounding = corner.round(legs, most_mm, axes, accel, false)?;
    let lines = corner.fit(legs, &rounding);
    let kink_rad = KINK_SHARE * NORMAL_SHARE * lines.accel * cycle_s / lines.speed;
    let bounds = Bounds {
        binormal,
        bisector,
        tolerance,
        kink_rad,
    };
    onto_arcs(lines, sides, &bent, &bounds)
}

/// What a blend of arcs keeps to.
struct Bounds {
    /// Normal of its plane, and where in it the inside of the corner lies.
    binormal: Vector,
    bisector: Vector,
    /// How far the joint may be left.
    tolerance: f64,
    /// The largest change of direction where it touches.
    kink_rad: f64,
}

/// Moves a blend that was fitted to lines so that it touches the arcs.
fn onto_arcs(
    mut fit: Fit,
    sides: [&Side; 2],
    bent: &[Option<Bent>; 2],
    bounds: &Bounds,
) -> Option<Fit> {
    let (binormal, bisector) = (bounds.binormal, bounds.bisector);
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
    if length(center) - r > bounds.tolerance {
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
    let ends = [sides[0].along(-fit.trims[0]), sides[1].along(fit.trims[1])];
    let spokes = ends.map(|(at, _)| sub(at, center));
    let [out, back] = [unit(spokes[0])?, unit(spokes[1])?];
    fit.sweep = angle(out, back);
    fit.radius = length(spokes[0]);
    let opens = (length(spokes[1]) - fit.radius) / fit.sweep;
    for (i, (spoke, out)) in spokes.into_iter().zip([out, back]).enumerate() {
        let tangent = unit(add(cross(binormal, spoke), scale(out, opens)))?;
        if sides[i].circle.is_some() && angle(tangent, ends[i].1) > bounds.kink_rad {
            return None;
        }
    }
    fit.normal = scale(out, -1.0);
    fit.tangent = cross(binormal, out);
    (fit.radius * fit.sweep >= ARC_LENGTH_MIN_MM).then_some(fit)
}

impl Side {
    /// Where it is so far after the joint, mm of a line, rad of an arc, and its
    /// direction there.
    fn along(&self, by: f64) -> (Vector, Vector) {
        let tangent = self.leg.tangent;
        let Some(circle) = &self.circle else {
            return (scale(tangent, by), tangent);
        };
        let (sin, cos) = libm::sincos(by);
        let flat = scale(cross(circle.center, circle.normal), 1.0 / circle.radius);
        let out = scale(circle.center, -1.0 / circle.radius);
        let spoke = add(scale(out, cos), scale(flat, sin));
        let at = add(circle.center, scale(spoke, circle.radius));
        (at, sub(scale(flat, cos), scale(out, sin)))
    }
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
