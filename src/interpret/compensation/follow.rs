//! The tool's centre beside the programmed moves.

use super::corner::{Bend, Circle, Track, bend, meet};
use super::hold::Guard;
use super::vector::{Vector, add, along, distance, dot, left, scale, sub, unit};
use super::{Compensation, Fault, State};
use crate::interpret::moves::{Arc, FeedMode, Move, MoveKind, Step};

/// The shifted element of a programmed move.
struct Element {
    /// What the tool's centre runs on, and where it begins and ends.
    track: Track,
    start: Vector,
    end: Vector,
    /// Its direction at the start.
    tangent: Vector,
    guard: Guard,
}

impl Compensation {
    /// Takes the next step of a block; hands on what is known by it.
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
        if mv.feed_mode == FeedMode::InverseTime && mv.kind != MoveKind::Rapid {
            return Err(Fault::InverseTime);
        }
        let [first, second] = self.plane;
        if mv.unknown_start.contains(first) || mv.unknown_start.contains(second) {
            return Err(Fault::UnknownStart);
        }
        let corner = [mv.start[first], mv.start[second]];
        let target = [mv.end[first], mv.end[second]];
        let stays = mv.arc.is_none() && corner == target;
        if self.state == State::Entry {
            return self.enter(mv, corner, target);
        }
        if stays {
            return self.hold.stay(Step::Move(mv), out);
        }
        let element = self.element(&mv, corner, target)?;
        let Some(before) = self.hold.track().copied() else {
            return Err(Fault::NoCorner);
        };
        let offset = sub(self.hold.end, corner);
        match bend(self.side, offset, element.tangent, &before, &element.track) {
            Bend::Smooth => self.hold.release(out)?,
            Bend::Inside => {
                let end = meet(&before, &element.track, self.side * self.radius_mm)?;
                self.hold.release_at(end, out)?;
            }
            Bend::Outside => {
                // LinuxCNC looks back only where a line follows.
                if mv.arc.is_none() {
                    self.hold.finish(out)?;
                } else {
                    self.hold.release(out)?;
                }
                self.hold
                    .round(&mut mv, corner, element.start, self.side, out)?;
            }
        }
        self.hold
            .keep(mv, element.track, element.guard, element.end);
        Ok(())
    }

    /// The first move: from where the tool is to beside its programmed end.
    fn enter(&mut self, mv: Move, from: Vector, to: Vector) -> Result<(), Fault> {
        if distance(from, to) <= self.radius_mm {
            return Err(Fault::ShortEntry);
        }
        let (track, end) = match &mv.arc {
            None => {
                let direction = unit(sub(to, from)).ok_or(Fault::ShortEntry)?;
                let end = along(to, left(direction), self.side * self.radius_mm);
                // Its real direction is another one; the corner behind it goes
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

    /// An arc as first move: from the tool's place to beside the programmed
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
    fn element(&self, mv: &Move, from: Vector, to: Vector) -> Result<Element, Fault> {
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
