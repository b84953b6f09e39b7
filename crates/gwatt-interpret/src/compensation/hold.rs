//! Moves that wait until the next one says where they end.

use super::corner::Track;
use super::fault::Fault;
use crate::arc::{self, Ends, Slack};
use crate::places::STANDSTILL_MM;
use crate::stray;
use crate::vector::{Vector, add, distance, dot, sub};
use gwatt_machine::AxisSet;
use gwatt_motion::{Arc, Move, MoveKind, Step, Stray, path_length};

/// Steps that may wait: a program that stays longer in one place of the plane
/// is refused.
const HELD_MAX: usize = 1000;
/// An arc may grow by so much, rad, in a program in mm and in inches (measured
/// with LinuxCNC 2.9).
const SWEEP_TOLERANCE_RAD: [f64; 2] = [0.0254, 0.001];

/// The moves that wait, and where the tool is.
#[derive(Debug)]
pub(super) struct Hold {
    /// The first is a move along `track`; all after it stay in their place.
    pub(super) steps: Vec<Step>,
    /// Something was passed on since this was last asked.
    pub(super) handed_on: bool,
    /// What the first move runs on.
    track: Option<Track>,
    /// What it must not be turned round against.
    guard: Guard,
    /// Where it ends if nothing shortens it.
    pub(super) end: Vector,
    /// The tool's centre after what was passed on.
    from: Vector,
    /// The same as the machine sees it.
    pub(super) tool: Vector,
    /// From the tool's centre to the point that the machine moves.
    nose: Vector,
    plane: [usize; 2],
    inch: bool,
}

/// What a move that is shortened must still be.
#[derive(Debug, Clone, Copy)]
pub(super) enum Guard {
    /// A first move is long enough.
    None,
    /// A line of this direction.
    Along(Vector),
    /// An arc of at most this sweep, rad.
    Sweep(f64),
}

impl Hold {
    /// Nothing waits; the machine stands at `tool`.
    pub(super) fn new(plane: [usize; 2], tool: Vector, nose: Vector, inch: bool) -> Self {
        Self {
            steps: Vec::new(),
            handed_on: false,
            track: None,
            guard: Guard::None,
            end: tool,
            from: tool,
            tool,
            nose,
            plane,
            inch,
        }
    }

    /// The track of the move that waits.
    pub(super) fn track(&self) -> Option<&Track> {
        self.track.as_ref()
    }

    /// Keeps a move that ends at `end` unless the next one shortens it.
    pub(super) fn keep(&mut self, mv: Move, track: Track, guard: Guard, end: Vector) {
        self.track = Some(track);
        self.guard = guard;
        self.end = end;
        self.steps.push(Step::Move(mv));
    }

    /// Keeps what stays in its place in the plane, or hands it on if nothing
    /// waits.
    pub(super) fn stay(&mut self, mut step: Step, out: &mut Vec<Step>) -> Result<(), Fault> {
        if !self.steps.is_empty() {
            if self.steps.len() >= HELD_MAX {
                return Err(Fault::TooMany);
            }
            self.steps.push(step);
            return Ok(());
        }
        if let Step::Move(mv) = &mut step {
            place(mv, self.plane, self.tool, self.tool, None);
        }
        out.push(step);
        Ok(())
    }

    /// Passes on what waits as it is: the next move does not touch its end.
    pub(super) fn release(&mut self, out: &mut Vec<Step>) -> Result<(), Fault> {
        self.guard = Guard::None;
        self.emit(self.end, out)
    }

    /// Passes on what waits; it ends at `end`.
    pub(super) fn release_to(&mut self, end: Vector, out: &mut Vec<Step>) -> Result<(), Fault> {
        self.guard = Guard::None;
        self.emit(end, out)
    }

    /// Passes on what waits at the end of the compensation.
    pub(super) fn finish(&mut self, out: &mut Vec<Step>) -> Result<(), Fault> {
        self.release_at(self.end, out)
    }

    /// Passes on what waits; it ends at `end` and must not turn round for that.
    pub(super) fn release_at(&mut self, end: Vector, out: &mut Vec<Step>) -> Result<(), Fault> {
        if let Guard::Along(direction) = self.guard
            && dot(sub(end, self.from), direction) < 0.0
        {
            return Err(Fault::LineGouges);
        }
        self.emit(end, out)
    }

    fn emit(&mut self, end: Vector, out: &mut Vec<Step>) -> Result<(), Fault> {
        let mut steps = std::mem::take(&mut self.steps);
        for step in steps.drain(..) {
            match step {
                Step::Move(mut mv) => {
                    self.go(&mut mv, end)?;
                    out.push(Step::Move(mv));
                }
                action @ Step::Action(_) => out.push(action),
            }
        }
        self.steps = steps;
        self.handed_on = true;
        self.guard = Guard::None;
        self.end = end;
        Ok(())
    }

    /// Puts a waiting move where it really runs.
    fn go(&mut self, mv: &mut Move, end: Vector) -> Result<(), Fault> {
        let from = self.tool;
        let to = add(end, self.nose);
        let track = if mv.kind == MoveKind::Dwell {
            None
        } else {
            self.track.take()
        };
        let arc = match track {
            Some(Track::Circle(circle)) => Some(self.arc(mv, circle.center, from, to)?),
            _ => None,
        };
        let from = if track.is_some() { from } else { to };
        place(mv, self.plane, from, to, arc);
        self.from = end;
        self.tool = to;
        Ok(())
    }

    /// The arc of a waiting move.
    fn arc(&self, mv: &Move, center: Vector, start: Vector, end: Vector) -> Result<Arc, Fault> {
        let programmed = mv.arc.as_ref().map_or(0.0, |arc| arc.sweep_rad);
        let ends = Ends {
            plane: self.plane,
            start,
            end,
            clockwise: programmed < 0.0,
            turns: turns(programmed),
            slack: Slack::of_part(self.inch),
        };
        let arc = arc::from_center(&ends, add(center, self.nose)).map_err(|_| Fault::NoArc)?;
        let tolerance_rad = SWEEP_TOLERANCE_RAD[usize::from(self.inch)];
        match self.guard {
            Guard::Sweep(most) if arc.sweep_rad.abs() > most + tolerance_rad => {
                Err(Fault::ArcGouges)
            }
            _ => Ok(arc),
        }
    }

    /// The tool goes round the corner at `pivot` to `end`, in front of `mv`:
    /// by an arc, or straight for a rapid. In LinuxCNC (`shares`) the axes
    /// outside the three of space do their part of the block here.
    pub(super) fn round(
        &mut self,
        mv: &mut Move,
        [pivot, end]: [Vector; 2],
        side: f64,
        shares: bool,
        out: &mut Vec<Step>,
    ) -> Result<(), Fault> {
        let mut first = mv.clone();
        first.arc = None;
        first.stray = Stray::NONE;
        if shares {
            for axis in 0..3 {
                first.end[axis] = mv.start[axis];
                first.unknown_start.0 &= !(1 << axis);
            }
            for axis in 3..first.end.len() {
                mv.start[axis] = mv.end[axis];
            }
            mv.unknown_start.0 &= 0b111;
        } else {
            first.end = mv.start;
            first.unknown_start = AxisSet::default();
        }
        let to = add(end, self.nose);
        let arc = if mv.kind == MoveKind::Rapid {
            None
        } else {
            first.kind = MoveKind::Arc;
            let ends = Ends {
                plane: self.plane,
                start: self.tool,
                end: to,
                clockwise: side > 0.0,
                turns: 1.0,
                slack: Slack::of_part(self.inch),
            };
            let center = add(pivot, self.nose);
            Some(arc::from_center(&ends, center).map_err(|_| Fault::NoArc)?)
        };
        place(&mut first, self.plane, self.tool, to, arc);
        out.push(Step::Move(first));
        self.from = end;
        self.tool = to;
        Ok(())
    }
}

impl Hold {
    /// A straight move to `end` in front of `mv`, at its feed; none where the
    /// tool is there already.
    pub(super) fn cross(&mut self, mv: &Move, end: Vector, out: &mut Vec<Step>) {
        let to = add(end, self.nose);
        if distance(self.tool, to) <= STANDSTILL_MM {
            return;
        }
        let mut first = mv.clone();
        first.end = mv.start;
        first.unknown_start = AxisSet::default();
        if first.kind == MoveKind::Arc {
            first.kind = MoveKind::Feed;
        }
        place(&mut first, self.plane, self.tool, to, None);
        out.push(Step::Move(first));
        self.from = end;
        self.tool = to;
    }
}

/// Number of started turns of a sweep.
fn turns(sweep_rad: f64) -> f64 {
    let more = (sweep_rad.abs() - arc::FULL_CIRCLE_RAD) / std::f64::consts::TAU;
    libm::floor(more).max(0.0) + 1.0
}

/// Gives a move its ends in the plane, and what follows from them. True where
/// its length is one of linear axes.
pub(super) fn place(
    mv: &mut Move,
    plane: [usize; 2],
    from: Vector,
    to: Vector,
    arc: Option<Arc>,
) -> bool {
    for (axis, (from, to)) in plane.into_iter().zip(from.into_iter().zip(to)) {
        mv.start[axis] = from;
        mv.end[axis] = to;
    }
    if mv.kind == MoveKind::Dwell {
        return true;
    }
    let mut moving = AxisSet::default();
    for (axis, (start, end)) in mv.start.iter().zip(&mv.end).enumerate() {
        if (end - start).abs() > STANDSTILL_MM {
            moving.insert(axis);
        }
    }
    moving.0 &= !mv.unknown_start.0;
    if arc.is_some() {
        for axis in plane {
            moving.insert(axis);
        }
    }
    let (length_mm, linear) = path_length(&mv.start, &mv.end, moving, arc.as_ref());
    mv.moving = moving;
    mv.stray = arc.map_or(Stray::NONE, |arc| stray::of_arc(&arc, &mv.start, &mv.end));
    mv.arc = arc;
    mv.length_mm = length_mm;
    linear
}
