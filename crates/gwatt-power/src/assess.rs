//! Judging moves in their order: which certificate each needs, and its demand.
//!
//! Input: moves in program order. Output: an [`Assessment`] for each, in the
//! same order. A move that may be blended with its successor waits for it; all
//! others are judged at once.

use super::assessment::{Assessment, Certificate, Loads};
use super::bus::{Shown, SpindleBus};
use super::demand::{Demand, Want};
use super::duty_cycle::{DutyCycle, Rating};
use super::effect::{Effect, Switched};
use super::idle::Idle;
use super::late::unpaced;
use super::line::Line;
use super::lookahead::{Ahead, Arrival};
use super::model::PowerModel;
use super::motion::Motion;
use super::observer::Observer;
use super::pending::{Pending, Rider, Successor};
use super::spindle_share::SpindleShare;
use gwatt_machine::{Machine, PathMode};
use gwatt_motion::{Action, ActionKind, Move, MoveKind};
use gwatt_plan::{Overrides, PathFigures, path_figures, plan};

/// Judges the moves of one program.
#[derive(Debug)]
pub struct Assessor<'m> {
    /// The machine.
    pub machine: &'m Machine,
    /// Its power model.
    pub model: PowerModel,
    /// The largest overrides, at which peaks are taken.
    pub largest: Overrides,
    /// The overrides at which times are taken: 100 %, or less where the
    /// machine permits less.
    pub nominal: Overrides,
    pub(super) requested: Option<Certificate>,
    /// What is wanted of evaluations; the floor may rise as peaks are found.
    pub want: Want,
    pub(super) held: Option<Box<Pending>>,
    /// What began with a move that was held, where it goes straight on.
    pub(super) line: Line,
    /// The one that was held before, and room that is used again.
    pub(super) before: Option<Box<Pending>>,
    pub(super) spare: Option<Box<Pending>>,
    pub(super) idle: Idle,
    /// A blended move was found although the planned certificate was asked for.
    pub needs_robust: bool,
    /// The last move has ended at rest.
    pub(super) rested: bool,
    /// Moves that the controller plans together, where its rules are modelled.
    pub(super) ahead: Option<Box<Ahead>>,
    pub(super) observer: Observer,
    /// What is switched on.
    switched: Switched,
    /// The spindle next to the axes, where the machine has one.
    pub(super) bus: Option<Box<SpindleBus<'m>>>,
    /// The same program at lower overrides, for limits over time.
    pub(super) lower: Vec<Assessor<'m>>,
}

impl<'m> Assessor<'m> {
    /// Judges by `requested`, or by what the controller profile models.
    #[must_use]
    pub fn new(machine: &'m Machine, requested: Option<Certificate>, want: Want) -> Self {
        let [largest, nominal] = Overrides::of(machine);
        let model = PowerModel::new(machine);
        let requested = if machine.kinematics.shares_motors() {
            Some(Certificate::Robust)
        } else {
            requested
        };
        let rules = machine.controller.planner.look_ahead;
        let rules = rules.filter(|_| requested != Some(Certificate::Robust));
        let ahead = rules
            .map(|rules| Box::new(Ahead::new(machine, rules, [largest, nominal])))
            .filter(|ahead| {
                ahead.slows_last_arcs() || machine.path.mode != Some(PathMode::ExactStop)
            });
        Self {
            machine,
            model,
            largest,
            nominal,
            requested,
            want,
            held: None,
            line: Line::default(),
            before: None,
            spare: None,
            idle: Idle::default(),
            needs_robust: false,
            rested: false,
            ahead,
            observer: Observer::default(),
            switched: Switched::default(),
            bus: SpindleBus::new(machine, [largest, nominal], false).map(Box::new),
            lower: Vec::new(),
        }
    }

    /// Holds the motion against the converters' limits over time too, if they
    /// have any.
    #[must_use]
    pub fn watching(mut self) -> Self {
        self.observer.watch = DutyCycle::new(self.machine, &self.model);
        self.watch_spindle();
        self
    }

    /// The program runs again at once, for ever, as far as limits over time go.
    #[must_use]
    pub fn repeating(mut self, repeats: bool) -> Self {
        if let Some(watch) = &mut self.observer.watch {
            watch.repeated = repeats;
        }
        self
    }

    /// Keeps the motion at 100 % until it is taken with [`Self::motions`], and the
    /// spindle with [`Self::turnings`].
    #[must_use]
    pub fn showing(mut self) -> Self {
        self.observer.motions = Some(Vec::new());
        if let Some(bus) = &mut self.bus {
            bus.shown = Some(Shown::default());
        }
        self
    }

    /// Takes the motion that is planned since, in the order of time. Of moves
    /// whose timing depends on others that are not modelled it is the one with
    /// stops; of moves from an unknown start no more than bounds.
    pub fn motions(&mut self) -> std::vec::Drain<'_, Motion> {
        self.observer.motions.get_or_insert_default().drain(..)
    }

    /// What was found about limits over time, of the moves passed on so far.
    #[must_use]
    pub fn ratings(&self) -> Vec<Rating> {
        let watch = self.observer.watch.as_ref();
        watch.map_or_else(Vec::new, |watch| watch.ratings())
    }

    /// The certificate that was asked for.
    #[must_use]
    pub fn requested(&self) -> Option<Certificate> {
        self.requested
    }

    /// Whether moves are planned together, or checked against limits over time, which
    /// takes about as long as reading them.
    #[must_use]
    pub fn weighs(&self) -> bool {
        self.ahead.is_some() || self.observer.watch.is_some()
    }

    /// Whether the next move would wait for its successor, or others for it.
    #[must_use]
    pub fn waits(&self, mv: &Move) -> bool {
        let open = self.ahead.as_ref().is_some_and(|ahead| ahead.is_open());
        open || self.last_held().is_some() || !self.line.is_empty() || self.may_blend(mv)
    }

    /// Takes something that moves no axis: it may stop the motion. Passes on what
    /// can be judged then.
    pub fn act(&mut self, action: &Action, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        self.act_lower(action);
        let Some(bus) = self.bus.take() else {
            return self.act_on_axes(action, sink);
        };
        let mut bus = self.judge_with_spindle(bus, sink, |axes, mut sink| {
            axes.act_on_axes(action, &mut sink);
        });
        bus.act(action, sink);
        self.bus = Some(bus);
    }

    fn act_on_axes(&mut self, action: &Action, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        let Some(ahead) = &mut self.ahead else {
            return self.line.close();
        };
        match self.switched.effect(&self.machine.controller, action) {
            Effect::None => {}
            Effect::Part => ahead.part(),
            Effect::Stop => {
                ahead.stop(self.machine, &self.model, &mut self.observer);
                ahead.emit(self.machine, &self.model, &mut self.observer, sink);
            }
            Effect::Unknown => match action.kind {
                ActionKind::EarlyLimits(limits) => {
                    ahead.doubt_limits(&self.model, &mut self.observer, limits, action.value);
                }
                _ => ahead.doubt(),
            },
        }
    }

    /// A move that the controller plans together with others, or that follows
    /// such.
    #[inline]
    fn push_ahead(
        &mut self,
        mv: &Move,
        text: &[u8],
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let (machine, model, observer) = (self.machine, &self.model, &mut self.observer);
        let Some(ahead) = &mut self.ahead else {
            return;
        };
        let arrival = Arrival {
            mv,
            text,
            want: self.want,
        };
        if !ahead.push_path(machine, model, observer, arrival) {
            return self.push_between(mv, text, sink);
        }
        ahead.emit(machine, model, observer, sink);
    }

    /// The same for a dwell, and for a move that has no path.
    #[inline(never)]
    fn push_between(
        &mut self,
        mv: &Move,
        text: &[u8],
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let alone = Assessment {
            blended: false,
            ..self.alone(mv, path_figures(self.machine, mv, self.largest).as_ref())
        };
        let (machine, model, observer) = (self.machine, &self.model, &mut self.observer);
        let Some(ahead) = &mut self.ahead else {
            return;
        };
        if mv.kind == MoveKind::Dwell {
            ahead.stop(machine, model, observer);
            ahead.emit(machine, model, observer, sink);
            observer.alone(machine, model, mv, self.largest);
            observer.show(machine, mv, self.nominal);
            sink(mv, &alone, text);
        } else {
            let arrival = Arrival {
                mv,
                text,
                want: self.want,
            };
            ahead.push_other(machine, model, observer, arrival, alone);
            ahead.emit(machine, model, observer, sink);
        }
    }

    /// The last move ends at rest, and the controller sees that another one comes.
    #[inline(never)]
    fn stop_between(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        let (machine, model, observer) = (self.machine, &self.model, &mut self.observer);
        if let Some(ahead) = &mut self.ahead {
            ahead.stop_between(machine, model, observer);
            ahead.emit(machine, model, observer, sink);
        }
    }

    /// Takes the next move with the text of its line, and passes on what can be
    /// judged now. Where the machine has a spindle, its waits come among them as
    /// moves of kind [`MoveKind::Spindle`].
    #[inline]
    pub fn push(
        &mut self,
        mv: &Move,
        text: &[u8],
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        if !self.lower.is_empty() {
            self.push_lower(mv, text);
        }
        if self.bus.is_none() {
            self.push_axes(mv, text, sink);
        } else {
            self.push_beside_spindle(mv, text, sink);
        }
    }

    pub(super) fn push_axes(
        &mut self,
        mv: &Move,
        text: &[u8],
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        if self.ahead.is_none() && mv.pace < 1.0 && self.may_blend(mv) {
            // The robust bound alone does not know how fast such a move is entered.
            let whole = unpaced(mv).into_owned();
            return self.push_axes(&whole, text, sink);
        }
        if let Some(ahead) = &self.ahead {
            let open = ahead.is_open();
            let follows = open && !(ahead.rests() && self.is_alone(mv));
            if follows || self.may_blend(mv) {
                return self.push_ahead(mv, text, sink);
            }
            if open {
                self.stop_between(sink);
            }
        }
        if self.goes_straight_on(mv, text) {
            return;
        }
        if !self.line.is_empty() {
            self.end_straight(Some(mv), sink);
        }
        self.push_unmodelled(mv, text, sink);
    }

    /// A move by itself, or next to others under the robust bound.
    #[inline]
    pub(super) fn push_unmodelled(
        &mut self,
        mv: &Move,
        text: &[u8],
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        self.observer.show(self.machine, mv, self.nominal);
        let rests = self.ends_at_rest(mv).unwrap_or(self.rested);
        let rested = std::mem::replace(&mut self.rested, rests);
        let figures = path_figures(self.machine, mv, self.largest);
        let joined = self
            .last_held()
            .is_some_and(|held| self.joins(&held.mv, mv));
        self.idle.follow(mv);
        let mut assessment = self.alone(mv, figures.as_ref());
        assessment.joined = joined;
        if let Some(held) = &mut self.held
            && mv.kind != MoveKind::Dwell
            && !mv.moves_axes()
        {
            assessment.joined = true;
            held.riders.push(Rider {
                mv: mv.clone(),
                text: text.to_vec(),
                assessment,
            });
            return;
        }
        if !(assessment.blended || joined) {
            self.release(Successor::Stop, sink);
            let figures = figures.as_ref();
            self.observer
                .alone_as(self.machine, &self.model, mv, self.largest, figures);
            sink(mv, &assessment, text);
            return;
        }
        assessment.blended = true;
        let bound = self.blending_bound(mv, figures.as_ref());
        self.hold(mv, text, assessment, (bound, rested), sink);
    }

    /// Passes on what was waiting, at the end of the program.
    pub fn finish(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        self.finish_lower();
        let Some(bus) = self.bus.take() else {
            return self.finish_axes(sink);
        };
        let mut bus = self.judge_with_spindle(bus, sink, |axes, mut sink| {
            axes.finish_axes(&mut sink);
        });
        bus.finish(sink);
        self.observer
            .spindle_loads(&self.model, &mut bus.spindle_loads);
    }

    fn finish_axes(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        self.end_straight(None, sink);
        self.release(Successor::End, sink);
        if let Some(ahead) = &mut self.ahead {
            ahead.stop(self.machine, &self.model, &mut self.observer);
            ahead.emit(self.machine, &self.model, &mut self.observer, sink);
        }
    }

    /// The planned demand, and whether the move may be blended; `figures` are
    /// those of its path at the largest overrides, if it has one.
    #[inline]
    fn alone(&self, mv: &Move, figures: Option<&PathFigures>) -> Assessment {
        let blended = self.may_blend(mv);
        if let Some(path) = figures
            && !mv.stray.strays()
            && mv.pace >= 1.0
            && let Some(demand) = self.quick_demand(mv, path, blended)
        {
            let mut assessment = Assessment {
                duration_s: path.duration_s,
                speed_mm_s: path.speed_limit_mm_s,
                accel_mm_s2: path.accel_mm_s2,
                top_speed_mm_s: path.top_speed_mm_s,
                ends2: [0.0; 2],
                fastest_s: path.duration_s,
                demand,
                loads: Loads::NONE,
                certificate: Certificate::Planned,
                blended,
                joined: false,
                ahead: false,
                spindle: SpindleShare::NONE,
            };
            if self.largest != self.nominal {
                let nominal = plan(self.machine, mv, self.nominal);
                assessment.duration_s = nominal.duration_s;
                assessment.speed_mm_s = nominal.speed_limit_mm_s;
            }
            return assessment;
        }
        self.evaluate(mv, figures, blended)
    }

    /// The demand of a path where it needs no closer look: it is small, or the
    /// robust bound takes its place.
    #[inline]
    fn quick_demand(&self, mv: &Move, path: &PathFigures, blended: bool) -> Option<Demand> {
        let may_stop = mv.kind == MoveKind::Rapid && self.requested != Some(Certificate::Robust);
        if blended && !may_stop && !self.want.energy {
            return Some(Demand::NONE);
        }
        self.model.below_floor(mv, path, self.want)
    }

    /// The planned demand of any move.
    pub(super) fn evaluate(
        &self,
        mv: &Move,
        figures: Option<&PathFigures>,
        blended: bool,
    ) -> Assessment {
        let peak_plan = match figures {
            Some(path) => path.plan(mv.length_mm),
            None => plan(self.machine, mv, self.largest),
        };
        let (machine, largest) = (self.machine, self.largest);
        let mut demand = self
            .model
            .demand_at_any(machine, mv, &peak_plan, largest, self.want);
        let (mut duration_s, mut speed_mm_s) = (peak_plan.duration_s, peak_plan.speed_limit_mm_s);
        if self.largest != self.nominal {
            let nominal = plan(self.machine, mv, self.nominal);
            (duration_s, speed_mm_s) = (nominal.duration_s, nominal.speed_limit_mm_s);
            if self.want.energy {
                demand.energy_j = self.model.demand(mv, &nominal, self.want).energy_j;
            }
        }
        if mv.stray.strays() {
            demand = self.model.with_stray(demand, mv, peak_plan.top_speed_mm_s);
        }
        let of_plan = [speed_mm_s, peak_plan.accel_mm_s2];
        if let Some(late) = self.model.late(machine, mv, of_plan, largest) {
            demand.include(&late);
        }
        let unknown = !mv.unknown_start.is_empty();
        Assessment {
            duration_s,
            speed_mm_s,
            accel_mm_s2: peak_plan.accel_mm_s2,
            top_speed_mm_s: peak_plan.top_speed_mm_s,
            ends2: [0.0; 2],
            fastest_s: peak_plan.duration_s,
            demand,
            loads: Loads::NONE,
            certificate: if unknown {
                Certificate::Robust
            } else {
                Certificate::Planned
            },
            blended,
            joined: false,
            ahead: false,
            spindle: SpindleShare::NONE,
        }
    }
}
