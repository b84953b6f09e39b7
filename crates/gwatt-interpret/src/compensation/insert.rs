//! Chamfers and rounded corners between two moves of a plane.
//!
//! Fanuc B-63944EN, "Optional Chamfering and Corner R": `,C` cuts a corner off
//! at this distance from it, `,R` rounds it. SINUMERIK, "Chamfer, rounding (CHF,
//! CHR, RND, RNDM)". The move that has the word waits for the next one.

mod words;

use super::corner::{Circle, Track, meet};
use super::fault::Fault;
use super::hold::place;
use crate::arc::{self, Ends, Slack};
use crate::vector::{Vector, along, cross, dot, left, scale, sub, unit};
use gwatt_motion::{Arc, Move};

/// Why such blocks stay as they are: the speed of a corner is that of the block before or after.
const FIXED: &str = "a corner is cut or rounded there";
/// Directions that differ by less make no corner, rad.
const STRAIGHT_RAD: f64 = 1e-6;
/// Ends may be passed by so much, mm and rad: rounding.
const ROUNDING: f64 = 1e-9;
/// Longest text of a line that is kept.
const TEXT_MAX: usize = 256;

/// What is to be put into a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Insert {
    /// A chamfer that begins and ends this far from the corner, mm (,C; CHR).
    Legs(f64),
    /// A chamfer of this length, mm (CHF).
    Chamfer(f64),
    /// An arc of this radius, mm (,R; RND); `modal`: of every corner (RNDM).
    Round { radius_mm: f64, modal: bool },
}

/// A move that waits for the next one, and what comes before that.
#[derive(Debug, Default)]
pub(crate) struct Corners {
    /// What the present block asks for.
    pub(crate) ask: Option<Insert>,
    waits: Option<(Move, Insert)>,
    /// The present block has let go of it, with its corner.
    cut: bool,
    /// The line of that move, kept for the block that lets it go.
    text: Option<((u16, u64), Vec<u8>)>,
}

impl Corners {
    /// Whether a move waits.
    pub(crate) fn holds(&self) -> bool {
        self.waits.is_some()
    }

    /// Whether the present block holds a corner with the moves next to it.
    pub(super) fn is_cut(&self) -> bool {
        self.cut
    }

    /// The line of a move that waited.
    pub(crate) fn text_of(&self, mv: &Move) -> Option<&[u8]> {
        let (key, text) = self.text.as_ref()?;
        (*key == (mv.text, mv.line)).then_some(text)
    }
}

/// A programmed move in the plane.
#[derive(Debug, Clone, Copy)]
struct Element {
    start: Vector,
    end: Vector,
    arc: Option<Arc>,
    /// Directions at its start and its end.
    directions: [Vector; 2],
}

impl Element {
    fn new(mv: &Move, plane: [usize; 2]) -> Result<Self, Fault> {
        let [start, end] = [&mv.start, &mv.end].map(|at| plane.map(|axis| at[axis]));
        let directions = match &mv.arc {
            None => [unit(sub(end, start)); 2],
            Some(arc) => [start, end].map(|at| {
                let outward = unit(sub(at, arc.center))?;
                Some(scale(left(outward), arc.sweep_rad.signum()))
            }),
        };
        let [Some(first), Some(last)] = directions else {
            return Err(Fault::NoBend);
        };
        Ok(Self {
            start,
            end,
            arc: mv.arc,
            directions: [first, last],
        })
    }

    /// What lies `radius_mm` next to it, to the left for a `side` of 1.
    fn offset(&self, side: f64, radius_mm: f64) -> Result<Track, Fault> {
        let [direction, _] = self.directions;
        let Some(arc) = &self.arc else {
            return Ok(Track::Line {
                through: along(self.start, left(direction), side * radius_mm),
                along: direction,
            });
        };
        let counterclockwise = arc.sweep_rad > 0.0;
        let inside = (side > 0.0) == counterclockwise;
        let radius = arc.radius_mm + if inside { -radius_mm } else { radius_mm };
        if radius <= 0.0 {
            return Err(Fault::LargeCorner);
        }
        Ok(Track::Circle(Circle {
            center: arc.center,
            radius,
            counterclockwise,
            inside,
            ratio: 1.0,
        }))
    }

    /// Where a circle about `center` touches it.
    fn touched_from(&self, center: Vector) -> Option<Vector> {
        match &self.arc {
            None => {
                let [direction, _] = self.directions;
                let way = dot(sub(center, self.start), direction);
                Some(along(self.start, direction, way))
            }
            Some(arc) => {
                let outward = unit(sub(center, arc.center))?;
                Some(along(arc.center, outward, arc.radius_mm))
            }
        }
    }
}

/// Two moves that meet.
struct Corner {
    plane: [usize; 2],
    inch: bool,
    before: Element,
    after: Element,
    /// How the path bends there, rad; positive to the left.
    bend_rad: f64,
}

impl Corner {
    fn new(first: &Move, second: &Move, plane: [usize; 2], inch: bool) -> Result<Self, Fault> {
        let before = Element::new(first, plane)?;
        let after = Element::new(second, plane)?;
        let (came, goes) = (before.directions[1], after.directions[0]);
        let bend_rad = libm::atan2(cross(came, goes), dot(came, goes));
        let most = std::f64::consts::PI - STRAIGHT_RAD;
        if !(STRAIGHT_RAD..most).contains(&bend_rad.abs()) {
            return Err(Fault::NoBend);
        }
        Ok(Self {
            plane,
            inch,
            before,
            after,
            bend_rad,
        })
    }

    /// Where what is put in begins and ends, and its arc.
    fn cut(&self, insert: Insert) -> Result<(Vector, Vector, Option<Arc>), Fault> {
        let leg = match insert {
            Insert::Legs(leg) => leg,
            Insert::Chamfer(length) => length / (2.0 * libm::cos(self.bend_rad / 2.0)),
            Insert::Round { radius_mm, .. } => return self.round(radius_mm),
        };
        if self.before.arc.is_some() || self.after.arc.is_some() {
            return Err(Fault::ChamferAtArc);
        }
        let from = along(self.before.end, self.before.directions[1], -leg);
        let to = along(self.after.start, self.after.directions[0], leg);
        Ok((from, to, None))
    }

    fn round(&self, radius_mm: f64) -> Result<(Vector, Vector, Option<Arc>), Fault> {
        let side = self.bend_rad.signum();
        let [before, after] = [&self.before, &self.after].map(|it| it.offset(side, radius_mm));
        let center = meet(&before?, &after?, side * radius_mm).map_err(|_| Fault::LargeCorner)?;
        let from = self.before.touched_from(center);
        let to = self.after.touched_from(center);
        let (Some(from), Some(to)) = (from, to) else {
            return Err(Fault::LargeCorner);
        };
        let ends = self.ends(from, to, side < 0.0);
        let arc = arc::from_center(&ends, center).map_err(|_| Fault::NoArc)?;
        Ok((from, to, Some(arc)))
    }

    fn ends(&self, start: Vector, end: Vector, clockwise: bool) -> Ends {
        Ends {
            plane: self.plane,
            start,
            end,
            clockwise,
            turns: 1.0,
            slack: Slack::of_part(self.inch),
        }
    }

    /// Gives a move its shorter ends, which must lie on it.
    fn shorten(&self, mv: &mut Move, from: Vector, to: Vector) -> Result<(), Fault> {
        let [a, b] = self.plane;
        let arc = match &mv.arc {
            None => {
                let way = [mv.end[a] - mv.start[a], mv.end[b] - mv.start[b]];
                let direction = unit(way).ok_or(Fault::NoBend)?;
                if dot(sub(to, from), direction) < -ROUNDING {
                    return Err(Fault::LargeCorner);
                }
                None
            }
            Some(whole) => {
                let ends = self.ends(from, to, whole.sweep_rad < 0.0);
                let arc = arc::from_center(&ends, whole.center).map_err(|_| Fault::NoArc)?;
                if arc.sweep_rad.abs() > whole.sweep_rad.abs() + ROUNDING {
                    return Err(Fault::LargeCorner);
                }
                Some(arc)
            }
        };
        place(mv, self.plane, from, to, arc);
        Ok(())
    }
}
