//! The tool's centre next to the programmed moves.

use super::corner::{Bend, Circle, SMOOTH_RAD, Track, bend, meet};
use super::hold::Guard;
use super::{Compensation, Fault, State};
use crate::vector::{Vector, add, along, distance, dot, left, scale, sub, unit};
use gwatt_machine::{CompensationCorner, CompensationLead};
use gwatt_motion::{Arc, FeedMode, Move, MoveKind, Step};

/// Bends below it, where an arc meets its neighbour, come from rounded numbers:
/// the path is off by less than a ten thousandth of the radius.
const ROUNDED_RAD: f64 = 0.01;
/// Bends above it are rounded by an arc in spite of G451, rad.
const INTERSECTION_MAX_RAD: f64 = 100.0 * std::f64::consts::PI / 180.0;
/// Two lines are one line.
const STRAIGHT_RAD: f64 = 1e-9;

/// The shifted element of a programmed move.
pub(super) struct Element {
    /// What the tool's centre runs on, and where it begins and ends.
    pub(super) track: Track,
    pub(super) start: Vector,
    end: Vector,
    /// Its direction at the start.
    pub(super) tangent: Vector,
    guard: Guard,
}

impl Compensation {
    /// Takes the next step of a block; passes on what is known by it.
    pub(super) fn follow(&mut self, step: Step, out: &mut Vec<Step>) -> Result<(), Fault> {
        let mut mv = match step {
            Step::Move(mv) if self.radius_mm > 0.0 && mv.kind != MoveKind::Dwell => mv,
            other if self.radius_mm > 0.0 => return self.hold.stay(other, out),
            other => {
                out.push(other);
                return Ok(());
            }
        };
        if !matches!(mv.kind, MoveKind::Rapid | MoveKind::Feed | MoveKind::Arc) {
            return Err(Fault::OtherMotion);
        }
        // LinuxCNC takes the time for the way that is programmed, so that the speed is
        // known already (`inverse_time_rate_straight`, `inverse_time_rate_arc`).
        let at_end = self.style.lead == CompensationLead::AtEnd;
        if mv.feed_mode == FeedMode::InverseTime && mv.kind != MoveKind::Rapid && !at_end {
            return Err(Fault::InverseTime);
        }
        let [first, second] = self.plane;
        if mv.unknown_start.contains(first) || mv.unknown_start.contains(second) {
            return Err(Fault::UnknownStart);
        }
        let corner = [mv.start[first], mv.start[second]];
        let target = [mv.end[first], mv.end[second]];
        let stays = mv.arc.is_none() && corner == target;
        if self.state == State::Entry && (at_end || !stays) {
            return self.enter(mv, corner, target);
        }
        if stays {
            return self.hold.stay(Step::Move(mv), out);
        }
        let element = self.element(&mv, corner, target)?;
        let Some(before) = self.hold.track().copied() else {
            return Err(Fault::NoCorner);
        };
        let entering = std::mem::take(&mut self.entering);
        let bend = self.bend(corner, &before, &element);
        if !at_end && bend != Bend::Smooth && self.idle > self.style.idle_blocks {
            return Err(Fault::Idle);
        }
        if entering && (self.style.lead == CompensationLead::Perpendicular || bend != Bend::Outside)
        {
            self.hold.release_to(element.start, out)?;
        } else {
            match bend {
                Bend::Smooth => self.hold.release(out)?,
                Bend::Inside => {
                    let end = meet(&before, &element.track, self.side * self.radius_mm)?;
                    self.hold.release_at(end, out)?;
                }
                Bend::Outside if self.rounds(&before, &element)? => {
                    // LinuxCNC looks back only where a line follows.
                    if at_end && mv.arc.is_some() {
                        self.hold.release(out)?;
                    } else {
                        self.hold.finish(out)?;
                    }
                    self.hold
                        .round(&mut mv, [corner, element.start], self.side, at_end, out)?;
                }
                Bend::Outside => self.straight_round(&mv, corner, &before, &element, out)?,
            }
        }
        self.moved = true;
        if let (Track::Circle(circle), Some(arc)) = (&element.track, &mv.arc) {
            mv.feed_mm_s *= self.feed.factor(circle, arc.radius_mm);
        }
        self.hold
            .keep(mv, element.track, element.guard, element.end);
        Ok(())
    }

    /// How the path bends at `corner`.
    pub(super) fn bend(&self, corner: Vector, before: &Track, after: &Element) -> Bend {
        let lines = |track: &Track| matches!(track, Track::Line { .. });
        let smooth_rad = if self.style.lead == CompensationLead::AtEnd {
            SMOOTH_RAD
        } else if lines(before) && lines(&after.track) {
            STRAIGHT_RAD
        } else {
            ROUNDED_RAD
        };
        let offset = sub(self.hold.end, corner);
        bend(
            self.side,
            offset,
            after.tangent,
            [before, &after.track],
            smooth_rad,
        )
    }

    /// Whether the tool goes round an outside corner by an arc.
    fn rounds(&self, before: &Track, after: &Element) -> Result<bool, Fault> {
        match self.style.corner {
            CompensationCorner::Arc => Ok(true),
            CompensationCorner::Line => Ok(false),
            CompensationCorner::Intersection => {
                let (Track::Line { along, .. }, Track::Line { .. }) = (before, &after.track) else {
                    return Err(Fault::Intersection);
                };
                // MD20210 CUTCOM_CORNER_LIMIT: 100°.
                Ok(dot(*along, after.tangent) < libm::cos(INTERSECTION_MAX_RAD))
            }
        }
    }

    /// The first move: from where the tool is to next to its programmed end.
    fn enter(&mut self, mv: Move, from: Vector, to: Vector) -> Result<(), Fault> {
        if self.style.lead != CompensationLead::AtEnd {
            return self.lead_in(mv, from, to);
        }
        if distance(from, to) <= self.radius_mm {
            return Err(Fault::ShortEntry);
        }
        let (track, end) = match &mv.arc {
            None => {
                let direction = unit(sub(to, from)).ok_or(Fault::ShortEntry)?;
                let end = along(to, left(direction), self.side * self.radius_mm);
                // Its real direction is another one; the corner after it goes
                // by the programmed one.
                let track = Track::Line {
                    through: end,
                    along: direction,
                };
                (track, end)
            }
            Some(arc) if !self.straight_first && self.nose == [0.0; 2] => {
                self.enter_by_arc(arc, from, to)?
            }
            Some(_) => return Err(Fault::ArcFirst),
        };
        self.state = State::On;
        self.hold.keep(mv, track, Guard::None, end);
        Ok(())
    }

    /// The first move, straight, to where the next one says; until then next to
    /// its programmed end.
    fn lead_in(&mut self, mv: Move, from: Vector, to: Vector) -> Result<(), Fault> {
        if mv.arc.is_some() {
            return Err(Fault::ArcFirst);
        }
        let direction = unit(sub(to, from)).ok_or(Fault::ShortEntry)?;
        let end = along(to, left(direction), self.side * self.radius_mm);
        let track = Track::Line {
            through: end,
            along: direction,
        };
        self.state = State::On;
        self.entering = true;
        self.moved = true;
        self.hold.keep(mv, track, Guard::None, end);
        Ok(())
    }

    /// An arc as first move: from the tool's place to next to the programmed
    /// end, where it runs in the programmed direction (measured with LinuxCNC).
    fn enter_by_arc(&self, arc: &Arc, from: Vector, to: Vector) -> Result<(Track, Vector), Fault> {
        let shifted = self.element_of_arc(arc, from, to)?;
        let Track::Circle(circle) = shifted.track else {
            return Err(Fault::EntryArc);
        };
        let inward = unit(sub(circle.center, to)).ok_or(Fault::EntryArc)?;
        let chord = sub(shifted.end, from);
        let radius = -dot(chord, chord) / (2.0 * dot(chord, inward));
        if radius == 0.0 || !radius.is_finite() {
            return Err(Fault::EntryArc);
        }
        let track = Track::Circle(Circle {
            center: along(shifted.end, inward, radius),
            radius: radius.abs(),
            ..circle
        });
        Ok((track, shifted.end))
    }

    /// The shifted element of a move.
    pub(super) fn element(&self, mv: &Move, from: Vector, to: Vector) -> Result<Element, Fault> {
        if let Some(arc) = &mv.arc {
            return self.element_of_arc(arc, from, to);
        }
        let way = sub(to, from);
        let direction = unit(way).ok_or(Fault::NoCorner)?;
        let shift = scale(left(direction), self.side * self.radius_mm);
        let start = add(from, shift);
        Ok(Element {
            track: Track::Line {
                through: start,
                along: direction,
            },
            start,
            end: add(to, shift),
            tangent: direction,
            guard: Guard::Along(way),
        })
    }

    fn element_of_arc(&self, arc: &Arc, from: Vector, to: Vector) -> Result<Element, Fault> {
        let center = arc.center;
        let counterclockwise = arc.sweep_rad > 0.0;
        let inside = (self.side > 0.0) == counterclockwise;
        let radius = distance(center, to);
        if inside && radius <= self.radius_mm {
            return Err(Fault::SmallArc);
        }
        let outward = if inside {
            -self.radius_mm
        } else {
            self.radius_mm
        };
        let first = unit(sub(from, center)).ok_or(Fault::SmallArc)?;
        let last = unit(sub(to, center)).ok_or(Fault::SmallArc)?;
        Ok(Element {
            track: Track::Circle(Circle {
                center,
                radius: radius + outward,
                counterclockwise,
                inside,
                ratio: radius / distance(center, from),
            }),
            start: along(from, first, outward),
            end: along(to, last, outward),
            tangent: scale(left(first), if counterclockwise { 1.0 } else { -1.0 }),
            guard: Guard::Sweep(arc.sweep_rad.abs()),
        })
    }
}
