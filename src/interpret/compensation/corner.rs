//! What the tool's centre does where two programmed elements meet.
//!
//! LinuxCNC, "Cutter Compensation": outside corners are rounded by an arc about
//! the corner, inside corners end where the two shifted elements cross, and
//! bends of less than 0.05 rad count as none (measured with LinuxCNC 2.9).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::Fault;
use super::vector::{Vector, add, along, cross, dot, left, length, scale, sub, unit};

/// Bends below it are passed as if the path were smooth, rad.
const SMOOTH_RAD: f64 = 0.05;

/// What the tool's centre runs on: a shifted element.
#[derive(Debug, Clone, Copy)]
pub(super) enum Track {
    /// A line through a point of it, with its direction of length 1.
    Line { through: Vector, along: Vector },
    /// A circle; `inside`: the tool is on the side of its centre.
    Circle {
        center: Vector,
        radius: f64,
        counterclockwise: bool,
        inside: bool,
    },
}

/// How a path bends, seen from the tool's side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bend {
    /// No corner to speak of.
    Smooth,
    /// The tool goes round it.
    Outside,
    /// The tool stops short of it.
    Inside,
}

/// How the path bends where the tool stands at `offset` from the corner (to its
/// `side`, +1 left), came on `before` and leaves on `after` in the direction
/// `tangent`.
pub(super) fn bend(
    side: f64,
    offset: Vector,
    tangent: Vector,
    before: &Track,
    after: &Track,
) -> Bend {
    let came = scale(left(offset), -side);
    let mut bend = -side * libm::atan2(cross(came, tangent), dot(came, tangent));
    if bend < -FRAC_PI_2 {
        bend += TAU;
    }
    if !(-SMOOTH_RAD..=PI + SMOOTH_RAD).contains(&bend) {
        return Bend::Inside;
    }
    if bend > PI - SMOOTH_RAD {
        // Back along where it came from: a line that leaves an arc which the
        // tool went round, and an arc that the tool goes round, are met from
        // above and not by another turn about the corner.
        let round = |track: &Track| matches!(track, Track::Circle { inside: false, .. });
        let met = match after {
            Track::Line { .. } => round(before),
            Track::Circle { .. } => round(after),
        };
        if met {
            return Bend::Inside;
        }
    }
    if bend > SMOOTH_RAD {
        Bend::Outside
    } else {
        Bend::Smooth
    }
}

/// Where the tool changes from one track to the next in an inside corner.
pub(super) fn meet(before: &Track, after: &Track) -> Result<Vector, Fault> {
    match (*before, *after) {
        (
            Track::Line {
                through,
                along: first,
            },
            Track::Line {
                through: other,
                along: second,
            },
        ) => {
            let turn = cross(first, second);
            if turn == 0.0 {
                return Err(Fault::NoCorner);
            }
            let way = cross(sub(other, through), second) / turn;
            Ok(along(through, first, way))
        }
        (
            Track::Circle {
                center,
                radius,
                inside,
                ..
            },
            Track::Line { through, along },
        ) => line_and_circle(through, along, center, radius, !inside).ok_or(Fault::ArcToLine),
        (
            Track::Line { through, along },
            Track::Circle {
                center,
                radius,
                inside,
                ..
            },
        ) => line_and_circle(through, along, center, radius, inside).ok_or(Fault::LineToArc),
        (
            Track::Circle {
                center,
                radius,
                inside,
                ..
            },
            Track::Circle {
                center: other,
                radius: other_radius,
                counterclockwise,
                ..
            },
        ) => {
            let between = sub(other, center);
            let apart = length(between);
            let Some(toward) = unit(between).filter(|_| radius != 0.0) else {
                return Err(Fault::SameCenter);
            };
            let way =
                (radius * radius + apart * apart - other_radius * other_radius) / (2.0 * apart);
            let square = radius * radius - way * way;
            if !(square >= 0.0) {
                return Err(Fault::ArcToArc);
            }
            let aside = square.sqrt()
                * if inside == counterclockwise {
                    1.0
                } else {
                    -1.0
                };
            Ok(add(along(center, toward, way), scale(left(toward), aside)))
        }
    }
}

/// Where a line crosses a circle: the later point, or the earlier one.
fn line_and_circle(
    through: Vector,
    direction: Vector,
    center: Vector,
    radius: f64,
    later: bool,
) -> Option<Vector> {
    let foot = along(through, direction, dot(sub(center, through), direction));
    let off = length(sub(center, foot));
    let square = radius * radius - off * off;
    (square >= 0.0).then(|| {
        let half = square.sqrt();
        along(foot, direction, if later { half } else { -half })
    })
}
