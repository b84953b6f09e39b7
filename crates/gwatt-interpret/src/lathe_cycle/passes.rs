//! The tool's way in a roughing cycle (G71, G72) and a finishing cycle (G70).
//!
//! Roughing cuts level by level: down the falling part of the contour, along Z
//! until the contour is met again, away by the retraction, back, and down to the
//! next level. At the bottom of the first valley it follows the contour up to
//! where the contour falls again; there the next valley, a pocket, begins.

use super::piece::{Piece, Round, SMALL, Way};
use super::shape::Shape;
use super::{Cycle, Fault, Pockets, RoughCycle};
use crate::vector::{Vector, add, distance};

const Z: usize = 0;
const X: usize = 1;
/// Levels and distances that are taken for the same.
const SAME: f64 = 1e-6;
/// Below any contour.
const BOTTOM: f64 = -1e9;
/// Cuts of one cycle.
const CUTS_MAX: usize = 90_000;

/// A move of the tool, in program coordinates (Z, X).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    pub(super) to: Vector,
    pub(super) kind: CutKind,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum CutKind {
    Rapid,
    Straight,
    Arc(Round),
}

/// The moves of a cycle about `pieces`, from `start`.
pub(super) fn cuts(cycle: &Cycle, pieces: Vec<Piece>, start: Vector) -> Result<Vec<Cut>, Fault> {
    let shape = Shape::new(pieces, start)?;
    match *cycle {
        Cycle::Finish { first, last, times } => finish(shape, first, last, times),
        Cycle::Rough(values) => rough(shape, values),
    }
}

/// G70: along the contour, nearer each time.
fn finish(mut shape: Shape, first: f64, last: f64, times: u32) -> Result<Vec<Cut>, Fault> {
    if shape.is_facing()? {
        shape.turn();
    }
    shape.face()?;
    shape.break_corners()?;
    shape.check()?;
    let mut out = Vec::new();
    for pass in (0..times).rev() {
        let shift = f64::from(pass) * (first - last) / f64::from(times) + last;
        let mut path = shape.clone();
        path.shift(shift)?;
        let begin = path.first()?;
        for to in [begin.start, begin.end] {
            out.push((to, CutKind::Rapid));
        }
        for piece in path.pieces.iter().skip(1) {
            out.push((piece.end, kind(piece)));
        }
        if out.len() > CUTS_MAX {
            return Err(Fault::Many);
        }
    }
    Ok(out.into_iter().map(|cut| placed(&shape, cut)).collect())
}

/// How the tool goes along a whole piece.
fn kind(piece: &Piece) -> CutKind {
    piece.round.map_or(CutKind::Straight, CutKind::Arc)
}

/// A cut in program coordinates.
fn placed(shape: &Shape, (to, kind): (Vector, CutKind)) -> Cut {
    Cut {
        to: shape.program(to),
        kind: match kind {
            CutKind::Arc(round) => CutKind::Arc(shape.program_round(round)),
            other => other,
        },
    }
}

/// G71 and G72: cuts along Z, or along X.
fn rough(mut shape: Shape, values: RoughCycle) -> Result<Vec<Cut>, Fault> {
    if values.facing {
        shape.turn();
    }
    shape.face()?;
    shape.break_corners()?;
    shape.check()?;
    shape.shift(values.left)?;
    shape.move_by(values.shift);
    let begin = shape.first()?.start;
    let last = shape.last()?;
    if last.end[X] < begin[X] {
        shape
            .pieces
            .push(Piece::line(last.end, [last.end[Z], begin[X]]));
    }
    let mut roughing = Roughing {
        pieces: &shape.pieces,
        at: begin,
        out: vec![(begin, CutKind::Rapid)],
        depth: values.depth.max(2.0 * SAME),
        retract: values.retract,
        tops: vec![begin],
    };
    roughing.run(values.pockets)?;
    let out = roughing.out;
    Ok(out.into_iter().map(|cut| placed(&shape, cut)).collect())
}

struct Roughing<'s> {
    pieces: &'s [Piece],
    at: Vector,
    out: Vec<(Vector, CutKind)>,
    depth: f64,
    retract: f64,
    /// Where the valleys begin that are being cut: the whole, and under
    /// [`Pockets::Only`] the one in it.
    tops: Vec<Vector>,
}

/// What a cut along Z came to.
enum Slice {
    Done,
    /// This piece begins at the place itself.
    Next(usize),
}

impl Roughing<'_> {
    fn run(&mut self, pockets: Pockets) -> Result<(), Fault> {
        let mut level = self.top();
        let mut index = 0;
        if pockets == Pockets::Only {
            while index < self.pieces.len() && self.descend(index, BOTTOM)? {
                index += 1;
            }
        }
        let mut last = (usize::MAX, 0);
        while index < self.pieces.len() {
            if self.out.len() > CUTS_MAX || (level - self.at[X]) / self.depth > CUTS_MAX as f64 {
                return Err(Fault::Many);
            }
            while level - SAME > self.at[X] {
                level -= self.depth;
            }
            if !self.descend(index, level)? {
                if pockets == Pockets::Left {
                    self.follow_rises(index);
                    return Ok(());
                }
                let Some(next) = self.ascend(index)? else {
                    return Ok(());
                };
                if last == (next, self.out.len()) {
                    return Err(Fault::Endless);
                }
                last = (next, self.out.len());
                if pockets == Pockets::Only {
                    self.enter_pocket();
                }
                index = next;
                level = self.top();
                continue;
            }
            if (self.at[X] - level).abs() > SAME {
                // It ends above the level.
                index += 1;
                continue;
            }
            match self.slice(index)? {
                Slice::Done => level -= self.depth,
                Slice::Next(next) => index = next,
            }
        }
        Ok(())
    }

    /// The level that the valley in work is cut from.
    fn top(&self) -> f64 {
        self.tops.last().map_or(self.at[X], |top| top[X])
    }

    /// A pocket begins here, unless it lies in the one that is open.
    fn enter_pocket(&mut self) {
        if self.tops.len() > 1 && self.at[X] > self.top() {
            self.tops.pop();
        }
        if self.tops.len() == 1 {
            self.tops.push(self.at);
        }
    }

    /// Down a piece; false where it does not fall.
    fn descend(&mut self, index: usize, level: f64) -> Result<bool, Fault> {
        let piece = self.pieces.get(index).ok_or(Fault::Endless)?;
        match piece.down(self.at, level).ok_or(Fault::Level)? {
            Way::Other | Way::ToTop(_) => return Ok(false),
            Way::Stay => {}
            Way::Past => self.at = piece.end,
            Way::To(place) if index == 0 && piece.round.is_none() => {
                self.go(place, CutKind::Rapid);
            }
            Way::To(place) => self.go(place, kind(piece)),
        }
        Ok(true)
    }

    /// Up the contour to where it falls again; gives that piece.
    fn ascend(&mut self, from: usize) -> Result<Option<usize>, Fault> {
        for (index, piece) in self.pieces.iter().enumerate().skip(from) {
            match piece.up(self.at).ok_or(Fault::Level)? {
                Way::Other => return Ok(Some(index)),
                Way::ToTop(place) => {
                    self.along(piece, place);
                    return Ok(Some(index));
                }
                Way::To(place) => self.along(piece, place),
                Way::Stay | Way::Past => {}
            }
        }
        Ok(None)
    }

    /// Along the rising parts alone, over the pockets between them.
    fn follow_rises(&mut self, from: usize) {
        for piece in self.pieces.iter().skip(from) {
            if let Some([begin, end]) = piece.rise(self.at) {
                self.go(begin, CutKind::Straight);
                self.along(piece, end);
            }
        }
    }

    /// Along Z to where the contour is met, away and back.
    fn slice(&mut self, index: usize) -> Result<Slice, Fault> {
        let at = self.at;
        for (other, piece) in self.pieces.iter().enumerate().skip(index) {
            let found = piece.crossings(at[X]);
            // The falling piece itself, if it is an arc, may rise again.
            let wall = if other == index {
                found.last()
            } else {
                found.first()
            };
            let Some(&wall) = wall else { continue };
            let far = (wall - at[Z]).abs();
            if wall - SAME > at[Z] || far < SAME && other == index {
                continue;
            }
            if far < SAME {
                let begins = distance(at, piece.start) < SAME;
                return Ok(if begins {
                    Slice::Next(other)
                } else {
                    Slice::Done
                });
            }
            let dest = [wall, at[X]];
            self.go(dest, CutKind::Straight);
            let away = self.retract * (far / 2.0 / self.retract).min(1.0);
            self.go(add(dest, [away, away]), CutKind::Rapid);
            self.go(add(at, [-away, away]), CutKind::Rapid);
            let back = if index == 0 {
                CutKind::Rapid
            } else {
                CutKind::Straight
            };
            self.go(at, back);
            return Ok(Slice::Done);
        }
        Err(Fault::Endless)
    }

    /// Along a piece; what is next to nothing of an arc is left out.
    fn along(&mut self, piece: &Piece, place: Vector) {
        if piece.round.is_some() && distance(self.at, place) <= SMALL {
            self.at = place;
            return;
        }
        self.go(place, kind(piece));
    }

    fn go(&mut self, to: Vector, kind: CutKind) {
        self.at = to;
        self.out.push((to, kind));
    }
}
