//! A contour as a list of pieces: turned so that every cycle sees it alike, and
//! shifted sideways by what is left for finishing.

use super::Fault;
use super::piece::{Corner, Piece, Round, SMALL};
use crate::vector::{Vector, add, cross, distance, dot, left, scale, sub};

/// Z may go back by this much between shifted pieces; more is bridged by an arc.
const GAP: f64 = 1e-2;
/// Steps and pieces together that a shift may take.
const WORK_MAX: usize = 10_000_000;

/// A contour: its first piece leads there from where the cycle starts.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub(super) pieces: Vec<Piece>,
    /// Turned by a quarter, so that facing looks like turning.
    turned: bool,
    /// Z and X are mirrored.
    mirrored: [bool; 2],
}

impl Shape {
    /// `start`: from where the cycle works.
    pub(super) fn new(mut pieces: Vec<Piece>, start: Vector) -> Result<Self, Fault> {
        let first = pieces.first_mut().ok_or(Fault::Short)?;
        first.start = start;
        if pieces.len() < 2 {
            return Err(Fault::Short);
        }
        Ok(Self {
            pieces,
            turned: false,
            mirrored: [false; 2],
        })
    }

    pub(super) fn first(&self) -> Result<Piece, Fault> {
        self.pieces.first().copied().ok_or(Fault::Short)
    }

    pub(super) fn last(&self) -> Result<Piece, Fault> {
        self.pieces.last().copied().ok_or(Fault::Short)
    }

    /// A quarter turn: Z becomes X, and X becomes -Z.
    pub(super) fn turn(&mut self) {
        self.map(|[z, x]| [x, -z], false);
        self.turned = !self.turned;
    }

    /// Mirrors it so that the contour falls and goes to lower Z.
    pub(super) fn face(&mut self) -> Result<(), Fault> {
        let [z, x] = sub(self.first()?.end, self.last()?.end);
        if x > 0.0 {
            self.map(|[z, x]| [z, -x], true);
            self.mirrored[1] = !self.mirrored[1];
        }
        if z < 0.0 {
            self.map(|[z, x]| [-z, x], true);
            self.mirrored[0] = !self.mirrored[0];
        }
        Ok(())
    }

    /// The program's place for one of the turned and mirrored contour.
    pub(super) fn program(&self, [z, x]: Vector) -> Vector {
        let flip = |flips: bool, value: f64| if flips { -value } else { value };
        let [z, x] = [flip(self.mirrored[0], z), flip(self.mirrored[1], x)];
        if self.turned { [-x, z] } else { [z, x] }
    }

    /// The same for an arc.
    pub(super) fn program_round(&self, round: Round) -> Round {
        Round {
            center: self.program(round.center),
            ccw: round.ccw != (self.mirrored[0] != self.mirrored[1]),
        }
    }

    /// Whether it goes back on itself; a start above its beginning is put right.
    pub(super) fn check(&mut self) -> Result<(), Fault> {
        if let Some(first) = self.pieces.first_mut()
            && first.end[0] > first.start[0]
        {
            first.start[0] = first.end[0];
        }
        let fine = self.pieces.iter().all(Piece::goes_on);
        if fine { Ok(()) } else { Err(Fault::Back) }
    }

    /// Whether it is one for facing: without its first piece it goes back on
    /// itself as it lies.
    pub(super) fn is_facing(&self) -> Result<bool, Fault> {
        let mut rest = self.clone();
        rest.pieces.remove(0);
        rest.face()?;
        Ok(rest.pieces.iter().any(|piece| !piece.goes_on()))
    }

    /// Makes its broken corners, and leaves out what is next to nothing.
    pub(super) fn break_corners(&mut self) -> Result<(), Fault> {
        for index in 1..self.pieces.len().saturating_sub(1) {
            let (before, rest) = self.pieces.split_at_mut(index);
            let (Some(before), [piece, after, ..]) = (before.last_mut(), rest) else {
                break;
            };
            if let Some(corner) = piece.corner {
                break_corner(before, piece, after, corner)?;
            }
        }
        self.pieces.retain(|piece| piece.size() >= SMALL);
        if self.pieces.len() < 2 {
            return Err(Fault::Short);
        }
        Ok(())
    }

    pub(super) fn move_by(&mut self, by: Vector) {
        self.map(|place| add(place, by), false);
    }

    fn map(&mut self, place: impl Fn(Vector) -> Vector, mirrors: bool) {
        for piece in &mut self.pieces {
            *piece = piece.mapped(&place, mirrors);
        }
    }

    /// Shifts all but the first piece sideways, away from the workpiece, and
    /// joins what that has torn apart. It goes in steps of half of the shortest
    /// piece or less, so that pieces vanish one by one.
    pub(super) fn shift(&mut self, by: f64) -> Result<(), Fault> {
        let first = self.first()?;
        let towards = sub(first.end, first.start);
        let whole = sub(self.last()?.start, first.start);
        let by = if cross(whole, towards) < 0.0 { -by } else { by };
        let mut rest = self.pieces.split_off(1);
        let mut done = 0.0;
        let mut work = 0;
        while done != by {
            work += rest.len();
            if work > WORK_MAX {
                return Err(Fault::Shift);
            }
            let most = rest
                .iter()
                .map(|piece| piece.size() / 2.0)
                .fold((by - done).abs().min(1e9), f64::min);
            let step = most.copysign(by);
            if step == 0.0 || !step.is_finite() {
                return Err(Fault::Shift);
            }
            for piece in &mut rest {
                piece.shift(step);
            }
            rest.retain(|piece| piece.size() >= SMALL);
            bridge(&mut rest, step, by > 0.0);
            join_all(&mut rest)?;
            done += step;
        }
        for index in 1..rest.len() {
            let (before, after) = rest.split_at_mut(index);
            if let (Some(before), Some(after)) = (before.last_mut(), after.first_mut()) {
                let middle = scale(add(before.end, after.start), 0.5);
                before.end = middle;
                after.start = middle;
            }
        }
        let begin = rest.first().ok_or(Fault::Shift)?.start;
        self.pieces.push(Piece {
            end: begin,
            ..first
        });
        self.pieces.remove(0);
        self.pieces.append(&mut rest);
        let ends = self
            .pieces
            .iter()
            .flat_map(|piece| [piece.start, piece.end]);
        let finite = ends.flatten().all(f64::is_finite);
        if finite { Ok(()) } else { Err(Fault::Shift) }
    }
}

/// A corner between two pieces: where both, moved inwards by its size, cross,
/// is the centre of the arc; a chamfer joins the ends of that arc.
fn break_corner(
    before: &mut Piece,
    piece: &mut Piece,
    after: &mut Piece,
    corner: Corner,
) -> Result<(), Fault> {
    let (Corner::Fillet(size) | Corner::Chamfer(size)) = corner;
    let moved = |by: f64| {
        let [mut one, mut other] = [*before, *after];
        one.shift(by);
        other.shift(by);
        (one, other)
    };
    let apart = |pair: &(Piece, Piece)| pair.0.end[0] - pair.1.start[0] > GAP;
    let mut by = size;
    let mut pair = moved(by);
    if apart(&pair) {
        by = -size;
        pair = moved(by);
    }
    if apart(&pair) {
        return Err(Fault::Corner);
    }
    let (mut one, mut other) = pair;
    join(&mut one, &mut other)?;
    let center = scale(add(one.end, other.start), 0.5);
    one.shift(-by);
    other.shift(-by);
    before.end = one.end;
    after.start = other.start;
    *piece = Piece::line(one.end, other.start);
    if matches!(corner, Corner::Fillet(_)) {
        let ccw = one.end[1] > center[1] || other.start[1] > center[1];
        piece.round = Some(Round { center, ccw });
    }
    Ok(())
}

/// Arcs between pieces that a step has moved apart.
fn bridge(pieces: &mut Vec<Piece>, step: f64, ccw: bool) {
    let mut joined: Vec<Piece> = Vec::with_capacity(pieces.len());
    for piece in pieces.drain(..) {
        if let Some(before) = joined.last()
            && before.end[0] - piece.start[0] > GAP
        {
            let [mut before, mut after] = [*before, piece];
            let [from, to] = [before.end, after.start];
            before.shift(-step);
            after.shift(-step);
            let center = scale(add(before.end, after.start), 0.5);
            joined.push(Piece {
                start: from,
                end: to,
                round: Some(Round { center, ccw }),
                corner: None,
            });
        }
        joined.push(piece);
    }
    *pieces = joined;
}

/// Lets neighbours meet; takes out what goes back or has become too short.
fn join_all(pieces: &mut Vec<Piece>) -> Result<(), Fault> {
    let mut at = 0;
    while at + 1 < pieces.len() {
        let size = |index: usize| pieces.get(index).map_or(0.0, Piece::size);
        if pieces.get(at).is_some_and(|piece| !piece.goes_on()) {
            let before = at.checked_sub(1).ok_or(Fault::Shift)?;
            let out = if size(at) < size(before) { at } else { before };
            pieces.remove(out);
            at = 0;
            if pieces.len() < 2 {
                return Err(Fault::Shift);
            }
        }
        if pieces.get(at).is_some_and(|piece| piece.size() < SMALL) {
            pieces.remove(at);
            if pieces.len() < 2 {
                return Err(Fault::Shift);
            }
            // From the second on, as the control does.
            at = 1;
            continue;
        }
        let (before, after) = pieces.split_at_mut(at + 1);
        if let (Some(before), Some(after)) = (before.last_mut(), after.first_mut()) {
            join(before, after)?;
        }
        at += 1;
    }
    Ok(())
}

/// Ends one piece and starts the next where they cross.
fn join(before: &mut Piece, after: &mut Piece) -> Result<(), Fault> {
    let near = || distance(before.end, after.start) < 1e-6;
    let place = match (before.round, after.round) {
        (None, None) => {
            let first = sub(before.end, before.start);
            let second = sub(after.end, after.start);
            let sine = cross(first, second);
            if sine.abs() <= 1e-12 * distance([0.0; 2], first) * distance([0.0; 2], second) {
                return Err(Fault::Parallel);
            }
            let share = cross(sub(after.start, before.start), second) / sine;
            add(before.start, scale(first, share))
        }
        _ if before.round.is_some() != after.round.is_some() && near() => return Ok(()),
        (Some(round), None) => {
            let radius = distance(round.center, before.end);
            on_circle(after.end, after.start, round.center, radius, after.start)?
        }
        (None, Some(round)) => {
            let radius = distance(round.center, after.end);
            on_circle(before.end, before.start, round.center, radius, after.start)?
        }
        (Some(one), Some(other)) => {
            let between = sub(one.center, other.center);
            let apart = distance(one.center, other.center);
            if apart == 0.0 {
                return Err(Fault::Shift);
            }
            let radius = distance(after.start, other.center);
            let square = |value: f64| value * value;
            let cosine = (square(apart) + square(radius)
                - square(distance(before.start, one.center)))
                / 2.0
                / radius
                / apart;
            let sine = (1.0 - square(cosine).min(1.0)).sqrt();
            let arm = scale(between, radius / apart);
            let turned = add(scale(arm, cosine), scale(left(arm), sine));
            add(other.center, turned)
        }
    };
    before.end = place;
    after.start = place;
    Ok(())
}

/// Where a line meets a circle, nearest to a place.
fn on_circle(
    from: Vector,
    to: Vector,
    center: Vector,
    radius: f64,
    near: Vector,
) -> Result<Vector, Fault> {
    let length = distance(from, to);
    if length == 0.0 {
        return Err(Fault::Shift);
    }
    let along = scale(sub(to, from), 1.0 / length);
    let arm = sub(center, from);
    let foot = dot(arm, along);
    let side = cross(along, arm);
    let half = (radius * radius - side * side).max(0.0).sqrt();
    let places = [foot + half, foot - half].map(|share| add(from, scale(along, share)));
    let [first, second] = places;
    let nearer = distance(near, first) < distance(near, second);
    Ok(if nearer { first } else { second })
}
