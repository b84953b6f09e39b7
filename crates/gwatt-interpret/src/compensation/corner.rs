//! What the tool's centre does where two programmed elements meet.
//!
//! LinuxCNC, "Cutter Compensation": outside corners are rounded by an arc about
//! the corner, inside corners end where the two shifted elements cross, and
//! bends of less than 0.05 rad count as none (measured with LinuxCNC 2.9).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::fault::Fault;
use crate::vector::{Vector, along, cross, dot, left, length, scale, sub, unit};

/// Bends below it are passed by LinuxCNC as if the path were smooth, rad.
pub(super) const SMOOTH_RAD: f64 = 0.05;

/// What the tool's centre runs on: a shifted element.
#[derive(Debug, Clone, Copy)]
pub(super) enum Track {
    /// A line through a point of it, with its direction of length 1.
    Line { through: Vector, along: Vector },
    /// A circle.
    Circle(Circle),
}

/// A shifted arc.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    pub(super) center: Vector,
    pub(super) radius: f64,
    pub(super) counterclockwise: bool,
    /// The tool is on the side of its centre.
    pub(super) inside: bool,
    /// Programmed radius at the end over that at the start: 1 but for rounding.
    pub(super) ratio: f64,
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
/// `tangent`; bends below `smooth_rad` count as none.
pub(super) fn bend(
    side: f64,
    offset: Vector,
    tangent: Vector,
    [before, after]: [&Track; 2],
    smooth_rad: f64,
) -> Bend {
    let came = scale(left(offset), -side);
    let mut bend = -side * libm::atan2(cross(came, tangent), dot(came, tangent));
    if bend < -FRAC_PI_2 {
        bend += TAU;
    }
    if !(-smooth_rad..=PI + smooth_rad).contains(&bend) {
        return Bend::Inside;
    }
    if bend > PI - smooth_rad {
        // Back along where it came from: a line that leaves an arc which the
        // tool went round, and an arc that the tool goes round, are met from
        // above and not by another turn about the corner.
        let round = |track: &Track| matches!(track, Track::Circle(circle) if !circle.inside);
        let met = match after {
            Track::Line { .. } => round(before),
            Track::Circle(_) => round(after),
        };
        if met {
            return Bend::Inside;
        }
    }
    if bend > smooth_rad {
        Bend::Outside
    } else {
        Bend::Smooth
    }
}

/// Where the tool changes from one track to the next in an inside corner;
/// `shift` is how far the tracks lie to the left of the programmed path.
pub(super) fn meet(before: &Track, after: &Track, shift: f64) -> Result<Vector, Fault> {
    match (before, after) {
        (
            Track::Line { through, along },
            Track::Line {
                through: other,
                along: next,
            },
        ) => lines(*through, *along, *other, *next).ok_or(Fault::NoCorner),
        (Track::Circle(circle), Track::Line { through, along }) => {
            let aside = cross(*along, sub(circle.center, *through));
            circle
                .cross_line(*along, aside, !circle.inside)
                .ok_or(Fault::ArcToLine)
        }
        (Track::Line { through, along }, Track::Circle(circle)) => {
            // LinuxCNC measures the programmed line by the radius at the arc's
            // end, which may differ from that at its start by rounding.
            let aside = cross(*along, sub(circle.center, *through)) + shift;
            circle
                .cross_line(*along, aside * circle.ratio - shift, circle.inside)
                .ok_or(Fault::LineToArc)
        }
        (Track::Circle(circle), Track::Circle(next)) => circle.cross_circle(next),
    }
}

fn lines(through: Vector, direction: Vector, other: Vector, next: Vector) -> Option<Vector> {
    let turn = cross(direction, next);
    (turn != 0.0).then(|| along(through, direction, cross(sub(other, through), next) / turn))
}

impl Circle {
    /// The later or the earlier of the points that a line of this direction
    /// passes, from which the centre lies `aside` to the left.
    fn cross_line(&self, direction: Vector, aside: f64, later: bool) -> Option<Vector> {
        let square = self.radius * self.radius - aside * aside;
        (square >= 0.0).then(|| {
            let half = if later { square.sqrt() } else { -square.sqrt() };
            let foot = along(self.center, left(direction), -aside);
            along(foot, direction, half)
        })
    }

    fn cross_circle(&self, next: &Self) -> Result<Vector, Fault> {
        let between = sub(next.center, self.center);
        let apart = length(between);
        let toward = unit(between)
            .filter(|_| self.radius != 0.0)
            .ok_or(Fault::SameCenter)?;
        let square = self.radius * self.radius;
        let way = (square + apart * apart - next.radius * next.radius) / (2.0 * apart);
        let aside = square - way * way;
        if aside.is_nan() || aside < 0.0 {
            return Err(Fault::ArcToArc);
        }
        let side = if self.inside == next.counterclockwise {
            1.0
        } else {
            -1.0
        };
        let foot = along(self.center, toward, way);
        Ok(along(foot, left(toward), side * aside.sqrt()))
    }
}
