//! A program's motion in time, at 100 % override: what the axes are commanded,
//! stretch by stretch.
//!
//! Where the controller's look-ahead is modelled, moves are planned together;
//! otherwise each runs from rest to rest.

use std::collections::VecDeque;
use std::io::{Read, Seek};

use super::executor::Executor;
use super::source::Source;
use super::{Failure, Options};
use crate::diagnostic::Diagnostic;
use crate::interpret::{Action, Arc, Move, MoveKind, Step};
use crate::machine::{AxisValues, Machine, PathMode};
use crate::plan::lookahead::{Element, PathPlanner, Piece, Planned};
use crate::plan::{Overrides, Plan, Profile, State, Track, Trajectory, plan};
use crate::power::{Effect, Role, Switched, joint, role};

/// A stretch of motion with one law.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Number of its move in the program, from 0. Of a rounded corner that of
    /// the move before.
    pub number: u64,
    /// Line of the move, from 1.
    pub line: u64,
    /// Which run of its line, from 1.
    pub run: u32,
    /// What the move is.
    pub kind: MoveKind,
    /// Its shape.
    pub track: Track,
    /// The arc that it is a part of, be it run in chords.
    pub arc: Option<Arc>,
    /// How the path is run; without phases where there is none.
    pub profile: Profile,
    /// From where to where on the track, mm.
    pub range_mm: [f64; 2],
    /// How long it lasts, s.
    pub duration_s: f64,
}

/// What a motion was planned by.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionNotes {
    /// Warnings and notes of the program.
    pub notes: Vec<Diagnostic>,
    /// The controller blends, and how is not modelled: moves were planned from
    /// rest to rest instead.
    pub stops_instead: bool,
}

impl Stretch {
    /// The profile's state `t` s after the start.
    #[must_use]
    pub fn path_at(&self, t: f64) -> State {
        self.profile.state_at(t).unwrap_or_default()
    }
}

/// A planner of stretches.
struct Mover<'m, 'e> {
    machine: &'m Machine,
    overrides: Overrides,
    planner: Option<PathPlanner<u64>>,
    switched: Switched,
    /// Moves that are not planned to their ends, by number from `first` on.
    open: VecDeque<Move>,
    first: u64,
    next: u64,
    /// Where the last stretch ends.
    position: AxisValues,
    stops_instead: bool,
    each: &'e mut dyn FnMut(Stretch) -> Result<(), Failure>,
}

/// Reads a program and hands over its motion, in order.
///
/// # Errors
/// See [`Failure`]; an unknown start is one, and so is what `each` gives.
pub fn motion<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    each: &mut dyn FnMut(Stretch) -> Result<(), Failure>,
) -> Result<MotionNotes, Failure> {
    motion_of(&mut input, machine, options, each)
}

fn motion_of(
    input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    each: &mut dyn FnMut(Stretch) -> Result<(), Failure>,
) -> Result<MotionNotes, Failure> {
    let mut front = Executor::new(input, machine, options);
    let [largest, overrides] = Overrides::of(machine);
    let rules = machine.controller.planner.look_ahead;
    let rules = rules.filter(|_| machine.path.mode != Some(PathMode::ExactStop));
    let mut mover = Mover {
        machine,
        overrides,
        planner: rules
            .map(|rules| PathPlanner::new(machine, rules).expecting(largest.feed / overrides.feed))
            .map(PathPlanner::at_one_override),
        switched: Switched::default(),
        open: VecDeque::new(),
        first: 0,
        next: 0,
        position: [0.0; crate::machine::AXES],
        stops_instead: false,
        each,
    };
    while let Some(line) = front.next_line()? {
        for step in &*line.steps {
            match step {
                Step::Move(mv) => mover.push(mv)?,
                Step::Action(action) => mover.act(action)?,
            }
        }
    }
    mover.stop()?;
    let stops_instead = mover.stops_instead;
    Ok(MotionNotes {
        notes: front.finish()?,
        stops_instead,
    })
}

impl Mover<'_, '_> {
    fn push(&mut self, mv: &Move) -> Result<(), Failure> {
        if !mv.unknown_start.is_empty() {
            let message = format!(
                "line {}: the motion cannot be known from an unknown start",
                mv.line
            );
            return Err(Failure::Unsuitable(message));
        }
        let number = self.next;
        let element = match (&self.planner, role(self.machine, mv)) {
            (Some(_), Role::Path) => {
                Element::of(self.machine, mv, self.overrides, joint(mv), number)
            }
            _ => None,
        };
        if let (Some(planner), Some(element)) = (&mut self.planner, &element)
            && planner.follows(element)
        {
            if self.open.is_empty() {
                self.first = number;
            }
            self.next += 1;
            self.open.push_back(mv.clone());
            planner.push(element);
            return self.pump();
        }
        // A move of no length is passed; a dwell stops.
        if mv.kind != MoveKind::Dwell && mv.length_mm <= 0.0 {
            if let (MoveKind::Rapid, Some(planner)) = (mv.kind, &mut self.planner) {
                planner.part();
            }
            if self.open.is_empty() {
                self.next += 1;
                self.position = mv.end;
            } else {
                self.next += 1;
                self.open.push_back(mv.clone());
            }
            return Ok(());
        }
        self.stop()?;
        self.next += 1;
        self.stops_instead |= (self.planner.is_none() || element.is_some())
            && self.machine.path.mode != Some(PathMode::ExactStop)
            && mv.path_mode != PathMode::ExactStop;
        self.alone(mv, number)
    }

    /// A move from rest to rest.
    fn alone(&mut self, mv: &Move, number: u64) -> Result<(), Failure> {
        let Plan {
            trajectory,
            duration_s,
            ..
        } = plan(self.machine, mv, self.overrides);
        if !duration_s.is_finite() {
            let message = format!("line {}: the move never ends", mv.line);
            return Err(Failure::Unsuitable(message));
        }
        let (track, profile) = match trajectory {
            Trajectory::Path(profile) => (Track::of(mv), profile),
            Trajectory::Axes(list) => {
                let profiles = list.into_iter().map(|(axis, profile)| {
                    let sign = (mv.end[axis] - mv.start[axis]).signum();
                    (axis, sign, profile)
                });
                let track = Track::Axes {
                    start: mv.start,
                    profiles: profiles.collect(),
                };
                (track, Profile::default())
            }
            Trajectory::Rest | Trajectory::Unknown(_) => {
                (Track::Rest(mv.start), Profile::default())
            }
        };
        self.position = mv.end;
        (self.each)(Stretch {
            number,
            line: mv.line,
            run: mv.run,
            kind: mv.kind,
            track,
            arc: mv.arc,
            profile,
            range_mm: [0.0, mv.length_mm],
            duration_s,
        })
    }

    fn act(&mut self, action: &Action) -> Result<(), Failure> {
        match self.switched.effect(&self.machine.controller, action) {
            Effect::Stop => self.stop(),
            Effect::Part => {
                if let Some(planner) = &mut self.planner {
                    planner.part();
                }
                Ok(())
            }
            // What may or may not stop is taken not to.
            Effect::None | Effect::Unknown => Ok(()),
        }
    }

    fn stop(&mut self) -> Result<(), Failure> {
        if let Some(planner) = &mut self.planner {
            planner.stop();
        }
        self.pump()?;
        if let Some(last) = self.open.back() {
            self.position = last.end;
        }
        self.open.clear();
        self.first = self.next;
        Ok(())
    }

    /// Passes on what the planner has finished.
    fn pump(&mut self) -> Result<(), Failure> {
        while let Some(planned) = self.planner.as_mut().and_then(PathPlanner::pop) {
            self.take(&planned)?;
            // The move of a blend and those after it are still needed.
            while self.first < planned.tag && self.open.len() > 1 {
                self.open.pop_front();
                self.first += 1;
            }
        }
        Ok(())
    }

    fn take(&mut self, planned: &Planned<u64>) -> Result<(), Failure> {
        let index = planned.tag.checked_sub(self.first);
        let Some(mv) = index.and_then(|index| self.open.get(index as usize)) else {
            return Ok(());
        };
        let mut profile = planned.profile();
        let duration_s = profile.duration_s();
        let mut range_mm = [0.0, planned.length_mm];
        let mut arc = None;
        let track = match &planned.piece {
            Piece::Along { from_mm, to_mm } if is_chord(planned, to_mm - from_mm) => {
                arc = mv.arc;
                chord(&Track::of(mv), [*from_mm, *to_mm], planned.length_mm)
            }
            Piece::Along { from_mm, to_mm } => {
                arc = mv.arc;
                for phase in &mut profile.phases {
                    phase.position_mm += from_mm;
                }
                range_mm = [*from_mm, *to_mm];
                Track::of(mv)
            }
            Piece::Joined { direction } => Track::Line {
                start: self.position,
                direction: *direction,
            },
            Piece::Blend(blend) => Track::Blend {
                start: self.position,
                blend: *blend,
            },
        };
        let stretch = Stretch {
            number: planned.tag,
            line: mv.line,
            run: mv.run,
            kind: mv.kind,
            track,
            arc,
            profile,
            range_mm,
            duration_s,
        };
        let end = State {
            position_mm: range_mm[1],
            ..State::default()
        };
        self.position = stretch.track.at(end, duration_s).position;
        (self.each)(stretch)
    }
}

/// Whether a piece of an arc is run straight: it is then shorter than the arc.
fn is_chord(planned: &Planned<u64>, along_mm: f64) -> bool {
    along_mm - planned.length_mm > 1e-9 * along_mm
}

/// The straight line between two places of a track.
fn chord(track: &Track, range_mm: [f64; 2], length_mm: f64) -> Track {
    let [start, end] = range_mm.map(|position_mm| {
        let state = State {
            position_mm,
            ..State::default()
        };
        track.at(state, 0.0).position
    });
    Track::Line {
        start,
        direction: std::array::from_fn(|n| (end[n] - start[n]) / length_mm),
    }
}
