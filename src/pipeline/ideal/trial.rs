//! A program's moves, limited and judged where nothing is written.

use std::io::{Read, Seek};

use crate::interpret::{Action, Move, MoveKind, Step};
use crate::limit::{
    Change, Deeper, Depths, Limiter, Outcome, Paced, Paces, Permit, Place, Waiting,
};
use crate::machine::{AXES, CornerRule, LookAhead, Machine, PathMode};
use crate::pipeline::drive::{MoveSink, drive_end, drive_line_end, drive_step};
use crate::pipeline::entry::Entry;
use crate::pipeline::executor::Executor;
use crate::pipeline::totals::{Totals, whether_fits};
use crate::pipeline::watching::watching;
use crate::pipeline::{Failure, LimitOptions, Options};
use crate::power::{Assessment, Assessor, Certificate, PowerModel, Want};

/// Moves that are limited and judged in all rounds together.
const EFFORT: usize = 200_000;
/// How many such moves one takes that is divided.
const IN_PIECES: usize = 1_000;
/// How many times as long a move takes where drives make something of steps of speed.
const STEPS: usize = 8;

/// What a program does, in the order in which it is done.
pub(super) struct Trial<'m> {
    machine: &'m Machine,
    events: Vec<Event>,
    /// What may be changed of each move.
    permits: Vec<Permit>,
    /// The moves themselves, for the limiter.
    moves: Vec<Move>,
}

/// A step, or the end of a line.
enum Event {
    /// The move of this number.
    Move(usize),
    /// Something else.
    Other(Action),
    /// A line ends; whether axes move in it, or it turns a knob.
    EndOfLine(bool),
}

impl<'m> Trial<'m> {
    /// Reads a program; `None` where it does so much that to try would take too long.
    pub(super) fn read<R: Read + Seek>(
        input: R,
        machine: &'m Machine,
        options: &Options,
    ) -> Result<Option<Self>, Failure> {
        let mut front = Executor::new(input, machine, options);
        let comment = options.comment(machine);
        let mut mode = PathMode::ExactStop;
        let mut mm_per_unit = front.interpreter().modal().mm_per_unit;
        let mut entry: Option<Entry> = None;
        let mut trial = Self {
            machine,
            events: Vec::new(),
            permits: Vec::new(),
            moves: Vec::new(),
        };
        while let Some(mut line) = front.next_line()? {
            let entry = entry.get_or_insert_with(|| Entry::new(&line));
            entry.fill(&mut line, machine, mode, mm_per_unit);
            if let Some(comment) = &comment {
                entry.look_for(comment);
            }
            mm_per_unit = entry.mark.mm_per_unit;
            for (index, step) in entry.steps.iter().enumerate() {
                let mv = match step {
                    Step::Move(mv) => mv,
                    Step::Action(action) => {
                        trial.events.push(Event::Other(*action));
                        continue;
                    }
                };
                mode = mv.path_mode;
                trial.events.push(Event::Move(trial.moves.len()));
                trial.permits.push(permit(entry, machine, mv, index));
                trial.moves.push(mv.clone());
            }
            trial.events.push(Event::EndOfLine(entry.moves_on()));
            if trial.events.len() > EFFORT {
                return Ok(None);
            }
        }
        front.finish()?;
        Ok(Some(trial))
    }

    /// How long it takes once all of it fits, s; `None` where it does not, or not soon.
    pub(super) fn soonest_s(&self, options: &Options, how: LimitOptions) -> Option<f64> {
        let mut depths = Depths::by_measure(Paces::default());
        let mut done = 0;
        let rules = self.machine.controller.planner.look_ahead;
        let linuxcnc = |rules: LookAhead| matches!(rules.corner, CornerRule::LinuxCnc { .. });
        let each = if rules.is_some_and(|rules| !linuxcnc(rules)) {
            STEPS
        } else {
            1
        };
        while done < EFFORT {
            done += each * self.moves.len().max(1);
            let outcomes = self.decide(options, how, &depths)?;
            done += IN_PIECES * outcomes.iter().filter(|it| is_split(it)).count();
            let found = self.judge(options, &outcomes);
            if found.deeper.is_empty() {
                return found.duration_s;
            }
            if !depths.deepen(&found.deeper) {
                return None;
            }
        }
        None
    }

    /// What each move gets; `None` where one of them cannot be helped.
    fn decide(
        &self,
        options: &Options,
        how: LimitOptions,
        depths: &Depths,
    ) -> Option<Vec<Outcome>> {
        let mut limiter = Limiter::new(self.machine, how, depths.clone());
        let want = whether_fits(self.machine, &PowerModel::new(self.machine));
        let mut assessor =
            Assessor::new(self.machine, options.certificate, want).starting(options.reading.start);
        let mut outcomes: Vec<Outcome> = Vec::with_capacity(self.moves.len());
        let mut sink = |mv: &Move, assessment: &Assessment, _: &[u8]| {
            if mv.kind == MoveKind::Spindle {
                return;
            }
            let decided = outcomes.len();
            let find = |place| self.find(decided + place);
            limiter.push(mv, assessment, &find, &mut |outcome| outcomes.push(outcome));
        };
        for event in &self.events {
            match event {
                Event::Move(number) => {
                    if let Some(mv) = self.moves.get(*number) {
                        assessor.push(mv, b"", &mut sink);
                    }
                }
                Event::Other(action) => assessor.act(action, &mut sink),
                Event::EndOfLine(moved) => assessor.end_line(*moved, &mut sink),
            }
        }
        assessor.finish(&mut sink);
        let decided = outcomes.len();
        let find = |place| self.find(decided + place);
        limiter.finish(&find, &mut |outcome| outcomes.push(outcome));
        let hopeless = outcomes.iter().any(|outcome| outcome.obstacle.is_some());
        (!hopeless && outcomes.len() == self.moves.len()).then_some(outcomes)
    }

    fn find(&self, number: usize) -> Option<Waiting<'_>> {
        let (mv, permit) = (self.moves.get(number)?, self.permits.get(number)?);
        Some(Waiting {
            mv,
            permit: *permit,
        })
    }

    /// Drives the moves with their changes.
    fn judge(&self, options: &Options, outcomes: &[Outcome]) -> Found {
        let mut assessor = watching(self.machine, options);
        let mut verdict = Verdict {
            trial: self,
            model: PowerModel::new(self.machine),
            tally: Totals::new(self.machine, options, None),
            deeper: Vec::new(),
            places: Vec::new(),
            judged: 0,
            before: None,
            deepen_next: false,
        };
        let mut all = outcomes.iter();
        for event in &self.events {
            match event {
                Event::Move(number) => {
                    let outcome = all.next();
                    for mv in self.changed(*number, outcome) {
                        verdict
                            .places
                            .push((*number, outcome.is_some_and(is_split)));
                        drive_step(&mut assessor, &Step::Move(mv), b"", &mut verdict);
                    }
                }
                Event::Other(action) => {
                    drive_step(&mut assessor, &Step::Action(*action), b"", &mut verdict);
                }
                Event::EndOfLine(moved) => {
                    drive_line_end(&mut assessor, *moved, &mut verdict);
                }
            }
        }
        drive_end(&mut assessor, &mut verdict);
        verdict
            .tally
            .rate(assessor.ratings(), assessor.lower_ratings());
        let summary = verdict.tally.finish(false);
        let duration_s = summary.fits_at_largest().then_some(summary.duration_s);
        Found {
            deeper: verdict.deeper,
            duration_s,
        }
    }

    /// A move as it runs with its change: in pieces, or as one.
    fn changed(&self, number: usize, outcome: Option<&Outcome>) -> Vec<Move> {
        let Some(Waiting { mv, permit }) = self.find(number) else {
            return Vec::new();
        };
        let apply = |change: &Change, mv: &Move| change.apply(self.machine, mv, &permit);
        let Some(split) = outcome.and_then(|it| it.split.as_deref()) else {
            let change = outcome.and_then(|it| it.change.as_deref());
            return vec![change.map_or_else(|| mv.clone(), |change| apply(change, mv))];
        };
        let mut from = 0.0;
        let pieces = split.pieces.iter().map(|piece| {
            let change = Change {
                accel: piece.accel,
                cruise: split.cruise,
                ..Change::NONE
            };
            let part = part(mv, from, piece.share);
            from = piece.share;
            apply(&change, &part)
        });
        pieces.collect()
    }
}

/// What driving the moves came to.
struct Found {
    /// Lines that would have to be lowered deeper.
    deeper: Vec<Deeper>,
    /// How long they take; `None` where not all fit.
    duration_s: Option<f64>,
}

/// Holds the changed moves against the limits.
struct Verdict<'t, 'm> {
    trial: &'t Trial<'m>,
    model: PowerModel,
    tally: Totals<'m, 'm>,
    deeper: Vec<Deeper>,
    /// Of each move that was handed over: its number, and whether it is a piece.
    places: Vec<(usize, bool)>,
    judged: usize,
    before: Option<Place>,
    deepen_next: bool,
}

impl MoveSink for Verdict<'_, '_> {
    fn want(&self) -> Want {
        self.tally.want()
    }

    /// As the certifier does it.
    fn take(&mut self, mv: &Move, after: &Assessment, _text: &[u8]) {
        self.tally.add(mv, after, b"");
        if mv.kind == MoveKind::Spindle {
            return;
        }
        let Some((number, in_pieces)) = self.places.get(self.judged).copied() else {
            return;
        };
        self.judged += 1;
        let Some(original) = self.trial.moves.get(number) else {
            return;
        };
        let place = (original.text, original.line);
        if (after.ahead || in_pieces) && !self.model.fits(&after.demand) {
            // Under the robust bound the neighbours count as well.
            let robust = after.certificate == Certificate::Robust;
            let next_to = |place| Deeper { place, paced: None };
            self.deeper
                .extend(self.before.filter(|_| robust).map(next_to));
            let by_itself = !robust && !in_pieces;
            let paced = by_itself.then(|| Paced::of(&self.model, place, mv, after));
            self.deeper.push(Deeper { place, paced });
            self.deepen_next = robust;
        } else if std::mem::take(&mut self.deepen_next) {
            self.deeper.push(Deeper { place, paced: None });
        }
        self.deeper.truncate(Depths::wanted() + 1);
        self.before = Some(place);
    }
}

/// What may be changed of a move where a line before it can always turn the words: F where
/// that may stand in its block.
fn permit(entry: &Entry, machine: &Machine, mv: &Move, step: usize) -> Permit {
    let Waiting { permit, .. } = entry.waiting(machine, mv, step);
    Permit {
        edit: permit.edit || mv.kind == MoveKind::Rapid,
        unsplit: None,
        ..permit
    }
}

fn is_split(outcome: &Outcome) -> bool {
    outcome.split.is_some()
}

/// A part of a straight move, from one share of its way to another.
fn part(mv: &Move, from: f64, to: f64) -> Move {
    let at = |share: f64| -> [f64; AXES] {
        std::array::from_fn(|axis| mv.start[axis] + share * (mv.end[axis] - mv.start[axis]))
    };
    let mut part = mv.clone();
    (part.start, part.end) = (at(from), if to >= 1.0 { mv.end } else { at(to) });
    part.length_mm = mv.length_mm * (to - from);
    part
}
