//! A piece of a contour: a line or an arc, and how a tool goes along it.
//!
//! Coordinates are of the plane (Z, X). The tool comes from greater Z, and a
//! contour goes to lower Z; it falls where X becomes less along it.

use arrayvec::ArrayVec;

use crate::vector::{Vector, add, cross, distance, scale, sub};

/// Places that are taken for one, program units.
const SAME: f64 = 1e-6;
/// Moves that are left out, and steps back that are put up with.
pub(super) const SMALL: f64 = 1e-3;

const Z: usize = 0;
const X: usize = 1;

/// An arc's centre and sense.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Round {
    pub(super) center: Vector,
    /// Counter-clockwise, seen with Z to the right and X up.
    pub(super) ccw: bool,
}

/// A line, or an arc of less than a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub(super) start: Vector,
    pub(super) end: Vector,
    pub(super) round: Option<Round>,
    /// A corner between its neighbours that is still to be made; all of it is in
    /// one place then.
    pub(super) corner: Option<Corner>,
}

/// A corner that is broken (A and C of the contour's lines), by so much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Corner {
    Fillet(f64),
    Chamfer(f64),
}

/// How the tool goes along a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Way {
    /// The piece goes the other way: up instead of down, or down instead of up.
    Other,
    /// It does not have to move.
    Stay,
    /// The piece is done: its end counts as reached.
    Past,
    /// To this place on it.
    To(Vector),
    /// To this place, after which the piece goes the other way.
    ToTop(Vector),
}

impl Piece {
    pub(super) fn line(start: Vector, end: Vector) -> Self {
        Self {
            start,
            end,
            round: None,
            corner: None,
        }
    }

    /// A corner at a place.
    pub(super) fn corner(place: Vector, corner: Corner) -> Self {
        Self {
            corner: Some(corner),
            ..Self::line(place, place)
        }
    }

    /// Every point of it, mapped.
    pub(super) fn mapped(&self, place: impl Fn(Vector) -> Vector, mirrors: bool) -> Self {
        Self {
            start: place(self.start),
            end: place(self.end),
            round: self.round.map(|round| Round {
                center: place(round.center),
                ccw: round.ccw != mirrors,
            }),
            corner: self.corner,
        }
    }

    /// How far its ends are apart; for an arc not more than its radius.
    pub(super) fn size(&self) -> f64 {
        let chord = distance(self.start, self.end);
        self.round
            .map_or(chord, |round| chord.min(distance(round.center, self.start)))
    }

    /// Whether it goes to lower Z all the way.
    pub(super) fn goes_on(&self) -> bool {
        let step = self.end[Z] - self.start[Z];
        if matches!(self.corner, Some(Corner::Fillet(_))) {
            return true;
        }
        let Some(round) = self.round else {
            return step <= SMALL;
        };
        let side = if round.ccw { 1.0 } else { -1.0 };
        let beyond = |place: Vector| (place[X] - round.center[X]) * side >= -SMALL;
        beyond(self.start) && beyond(self.end) && step <= -SMALL
    }

    /// Moves it sideways, to the right of its direction by `by`.
    pub(super) fn shift(&mut self, by: f64) {
        if let Some(round) = self.round {
            let radius = distance(round.center, self.start);
            let factor = (radius + if round.ccw { by } else { -by }) / radius;
            let grown = |place| add(scale(sub(place, round.center), factor), round.center);
            self.start = grown(self.start);
            self.end = grown(self.end);
            return;
        }
        let back = sub(self.start, self.end);
        let shift = scale([-back[X], back[Z]], by / distance(self.start, self.end));
        self.start = add(self.start, shift);
        self.end = add(self.end, shift);
    }

    /// Z of the places where it is at a level of X; of an arc the greater first.
    pub(super) fn crossings(&self, level: f64) -> ArrayVec<f64, 2> {
        let mut found = ArrayVec::new();
        let ([z0, x0], [z1, x1]) = (self.start, self.end);
        let Some(round) = self.round else {
            if x0.min(x1) <= level + SAME && x0.max(x1) >= level - SAME {
                if (x0 - x1).abs() < SAME {
                    found.extend([z0, z1]);
                } else {
                    found.push((level - x0) / (x1 - x0) * (z1 - z0) + z0);
                }
            }
            return found;
        };
        let radius = distance(round.center, self.start);
        let height = level - round.center[X];
        let square = (radius - height) * (radius + height);
        if square < -SAME {
            return found;
        }
        let half = square.max(0.0).sqrt();
        let places = [round.center[Z] + half, round.center[Z] - half];
        found.extend(places.into_iter().filter(|&z| self.holds([z, level])));
        found
    }

    /// Whether a place on its circle is on the arc itself.
    fn holds(&self, place: Vector) -> bool {
        let Some(round) = self.round else { return true };
        let side = if round.ccw { 1.0 } else { -1.0 };
        let arm = |place| sub(place, round.center);
        cross(arm(self.start), arm(place)) * side >= -SAME
            && cross(arm(self.end), arm(place)) * side <= SAME
    }

    /// Down along it from `at`, not below `level`; `None` where a line has no
    /// such place.
    pub(super) fn down(&self, at: Vector, level: f64) -> Option<Way> {
        let Some(round) = self.round else {
            return if self.start[X] <= self.end[X] + SAME {
                Some(Way::Other)
            } else if level < self.end[X] {
                Some(Way::To(self.end))
            } else {
                Some(Way::To([*self.crossings(level).first()?, level]))
            };
        };
        if distance(at, self.end) < SAME || at[Z] - self.end[Z] <= SAME {
            return Some(Way::Past);
        }
        let middle = round.center[Z];
        let mut found = self.crossings(level);
        if found.is_empty() {
            found = self.crossings(level - SAME);
        }
        // Counter-clockwise it falls after its top, clockwise before its bottom.
        let rises = if round.ccw {
            at[Z] - SAME > middle
        } else {
            at[Z] <= middle
        };
        if rises {
            return Some(Way::Other);
        }
        Some(if round.ccw {
            match found.last().filter(|&&z| z <= middle) {
                Some(&z) => Way::To([z, level]),
                None => Way::To(self.end),
            }
        } else {
            match found.first() {
                Some(&z) if z >= middle => Way::To([z, level]),
                // It is met where it rises again: the next level may do better.
                Some(_) => Way::Stay,
                None => Way::To(self.end),
            }
        })
    }

    /// Up along it from `at`; `None` where `at` is not its start.
    pub(super) fn up(&self, at: Vector) -> Option<Way> {
        let Some(round) = self.round else {
            if self.end[X] + SAME < self.start[X] {
                return Some(Way::Other);
            }
            return (distance(at, self.start) <= SAME).then_some(Way::To(self.end));
        };
        let middle = round.center[Z];
        if round.ccw {
            if at[Z] < middle {
                return Some(Way::Other);
            }
            return Some(Way::ToTop(self.top(round)));
        }
        if at[Z] > middle {
            return Some(Way::Other);
        }
        Some(Way::To(self.end))
    }

    /// Where a rising part of it begins at the level of `at`, and where it ends;
    /// without such a part, nothing.
    pub(super) fn rise(&self, at: Vector) -> Option<[Vector; 2]> {
        let found = self.crossings(at[X]);
        let Some(round) = self.round else {
            if self.end[X] < self.start[X] {
                return None;
            }
            return Some([[*found.first()?, at[X]], self.end]);
        };
        let middle = round.center[Z];
        let (z, end) = if round.ccw {
            (found.first().filter(|&&z| z >= middle)?, self.top(round))
        } else {
            (found.last().filter(|&&z| z <= middle)?, self.end)
        };
        Some([[*z, at[X]], end])
    }

    /// Where a counter-clockwise arc stops rising.
    fn top(&self, round: Round) -> Vector {
        if self.end[Z] < round.center[Z] {
            let radius = distance(round.center, self.start);
            return [round.center[Z], round.center[X] + radius];
        }
        self.end
    }
}
