//! Moves that a controller plans together: what each of them asks for.
//!
//! Input: moves and stops in program order. Output: an [`Assessment`] for each
//! move, once nothing after it can change it any more.
//!
//! ```text
//! moves ─→ elements ─PathPlanner→ pieces of path ─PowerModel→ demand of each move
//! ```
//!
//! A piece that the planner is not certain of, and the moves next to it, get the
//! robust bound; and so does all whose speed depends on what happens there: the
//! moves before it that may have to brake for it, and those after it until they
//! run as fast as planned even from rest.

mod count;
mod driven;
mod constant_speed;
mod glided;
mod emit;
mod joints;
mod lower_overrides;
mod open;
mod pace;
mod queue;
mod ranged;
mod response;
mod runs;
mod surges;

use super::assessment::Assessment;
use super::demand::Want;
use super::model::PowerModel;
use super::observer::Observer;
use super::parabolic_blend::Ride;
use super::robust::Extremes;
use super::steps::Steps;
use constant_speed::Glider;
use gwatt_machine::{AXES, AxisValues, CornerRule, LookAhead, Machine, PathMode};
use gwatt_motion::{EarlyLimits, Move, MoveKind};
use gwatt_plan::Overrides;
use gwatt_plan::lookahead::{Element, PathPlanner};
use queue::Queue;
use surges::Surges;

pub use open::{Role, joint, role};

/// A move that is added, with the text of its line and what is wanted of it.
#[derive(Clone, Copy)]
pub struct Arrival<'a> {
    pub mv: &'a Move,
    pub text: &'a [u8],
    pub want: Want,
}

/// The moves that are planned together.
#[derive(Debug)]
pub(super) struct Ahead {
    /// At the largest overrides: peaks.
    largest: Side,
    glider: Glider,
    /// At 100 %: times and energies; where that is the same, nothing.
    nominal: Option<Side>,
    /// Moves that are not passed on.
    open: Queue,
    /// As many of the last moves are not passed on while they may move: other corners may be set
    /// for them yet.
    held_back: u64,
    /// How many lines of those that are not passed on do not move: they have no place in the
    /// control's queue.
    still: u64,
    /// Nothing moves after the last move.
    at_rest: bool,
    /// Something stands after the last move that may or may not stop it.
    in_doubt: bool,
    /// What the motion reaches at least, from rest where it was in doubt last,
    /// mm²/s²; nothing once that is as fast as planned.
    reach2: Option<f64>,
    /// How far a lower pace may still come late, mm, and up to which speed, mm/s.
    late: Option<(f64, f64)>,
    /// What was passed on last, and what before that, where nobody waited for what
    /// may be blended with it.
    unwaited: Option<Extremes>,
    /// Since the last stop a drive leaves less than the axis' own acceleration at the
    /// speed of some move.
    driven: bool,
    /// What lower overrides may make of them, if these count.
    surges: Option<Surges>,
    /// Steps of speed at joints.
    steps: Box<Steps>,
}

/// A planner and how far it has come.
#[derive(Debug)]
struct Side {
    planner: PathPlanner<u64>,
    overrides: Overrides,
    /// Of the last move.
    element: Element<u64>,
    /// The first move that is not finished.
    next: u64,
    /// Speeds of the axes at the end of the last piece, mm/s, where they are of
    /// interest.
    end_mm_s: AxisValues,
    /// The last piece, where the next one may run already while it does.
    last_ride: Option<Ride>,
}

impl Side {
    /// Describes a move for the planner; false where it has no path.
    #[inline]
    fn describe(&mut self, machine: &Machine, mv: &Move, number: u64) -> bool {
        self.element.tag = number;
        self.element
            .describe(machine, mv, self.overrides, joint(mv))
    }

    /// Whether the move that was described can be followed.
    #[inline]
    fn follows(&self) -> bool {
        self.planner.follows(&self.element)
    }
}

/// How many moves wait in a queue where words for corners hold for them too.
fn held_back(machine: &Machine, rules: &LookAhead) -> u64 {
    let early = machine.controller.language.printer.early_limits;
    match rules.corner {
        CornerRule::SpeedStep { .. } if early => {
            let seen = rules.blocks_at_most.max(rules.blocks);
            // Another one waits for room in the queue.
            seen.map_or(0, |blocks| u64::from(blocks) + 1)
        }
        _ => 0,
    }
}

impl Ahead {
    /// Nothing moves yet. `overrides`: the largest, and 100 % or what is
    /// permitted of it.
    pub fn new(machine: &Machine, rules: LookAhead, overrides: [Overrides; 2]) -> Self {
        let most_feed = machine.limits.feed_override_max;
        let [largest, nominal] = overrides.map(|overrides| Side {
            planner: PathPlanner::new(machine, rules).expecting(most_feed / overrides.feed),
            overrides,
            element: Element::blank(0),
            next: 0,
            end_mm_s: [0.0; AXES],
            last_ride: None,
        });
        let alike = largest.overrides == nominal.overrides;
        let held_back = held_back(machine, &rules);
        // What is decided for another override does not glide, nor what may change later.
        let blocks = if alike && largest.overrides.feed >= most_feed && held_back == 0 {
            largest.planner.glide_blocks()
        } else {
            0
        };
        Self {
            glider: Glider::new(machine, &rules, largest.overrides, blocks),
            largest,
            nominal: (!alike).then_some(nominal),
            open: Queue::new(),
            held_back,
            still: 0,
            at_rest: true,
            in_doubt: false,
            reach2: None,
            late: None,
            unwaited: None,
            driven: false,
            surges: machine
                .limits
                .counts_lower()
                .then(|| Surges::new(machine, &rules)),
            steps: response::steps_of(machine, &rules),
        }
    }

    /// Whether an arc that ends at rest runs otherwise with nothing after it.
    pub fn slows_last_arcs(&self) -> bool {
        self.largest.planner.slows_last_arcs()
    }

    /// Whether a move waits, or the next one may be blended with the last.
    pub fn is_open(&self) -> bool {
        self.in_doubt || !self.open.is_empty()
    }

    /// Adds a move that has a path which the rules speak of; false, and nothing
    /// done, for all others.
    #[inline]
    pub fn push_path(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        observer: &mut Observer,
        arrival: Arrival<'_>,
    ) -> bool {
        let Arrival { mv, text, want } = arrival;
        if self.glide(model, observer, mv, text, want) {
            return true;
        }
        if role(machine, mv) != Role::Path {
            return false;
        }
        self.catch_up(machine);
        let number = self.open.end();
        if !(self.largest.describe(machine, mv, number) && self.largest.follows()) {
            return false;
        }
        if let Some(nominal) = &mut self.nominal
            && !(nominal.describe(machine, mv, number) && nominal.follows())
        {
            return false;
        }
        // At lower overrides what is in doubt may brake for this one.
        let surges = self.surges.as_mut();
        let pace = surges.map(|surges| surges.push(number, &self.largest.element));
        if self.in_doubt {
            self.brake_in_doubt(model, observer);
        }
        let open = self.open.push(mv, text, want);
        if let Some(pace) = pace {
            open.pace = pace;
        }
        let own = &self.nominal.as_ref().unwrap_or(&self.largest).element;
        open.assessment.speed_mm_s = own.top_mm_s();
        open.assessment.accel_mm_s2 = own.accel_mm_s2;
        open.moves = true;
        open.in_doubt = std::mem::take(&mut self.in_doubt);
        open.rests = mv.path_mode == PathMode::ExactStop;
        self.driven |= self.largest.element.is_driven();
        // The planner holds it back, even if it ends at rest.
        self.at_rest = false;
        let chords2 = self.largest.planner.push(&self.largest.element);
        if let (Some(surges), Some(chords2)) = (&mut self.surges, chords2)
            && let Some(open) = self.open.back_mut()
        {
            surges.run_chords(&mut open.pace, chords2);
        }
        if let Some(side) = &mut self.nominal {
            side.planner.push(&side.element);
        }
        self.pump(model, observer);
        true
    }

    /// Adds any other move with what is known of it by itself.
    pub fn push_other(
        &mut self,
        machine: &Machine,
        model: &PowerModel,
        observer: &mut Observer,
        arrival: Arrival<'_>,
        assessment: Assessment,
    ) {
        let Arrival { mv, text, want } = arrival;
        self.catch_up(machine);
        if role(machine, mv) == Role::Nothing {
            if mv.kind == MoveKind::Rapid {
                // Nothing is put together over a rapid, wherever it leads.
                self.part();
            }
            self.open.push(mv, text, want).assessment = assessment;
            self.still += 1;
            return self.pump(model, observer);
        }
        self.brake_in_doubt(model, observer);
        self.stop_planners();
        let open = self.open.push(mv, text, want);
        open.assessment = Assessment {
            blended: true,
            ahead: true,
            ..assessment
        };
        open.certain = false;
        open.moves = true;
        open.in_doubt = std::mem::replace(&mut self.in_doubt, true);
        self.at_rest = false;
        self.pump(model, observer);
        self.rest_after(model);
        // No piece will speak of it.
        self.finish();
        let side = self.nominal.as_ref().unwrap_or(&self.largest);
        observer.show(machine, mv, side.overrides);
    }

    /// Where the motion stops after the last move, or whether it does, cannot be
    /// waited for.
    pub fn run_dry(&mut self, machine: &Machine, model: &PowerModel, observer: &mut Observer) {
        if self.at_rest {
            return;
        }
        let stops = self.rests();
        self.catch_up(machine);
        self.brake_in_doubt(model, observer);
        self.stop_planners();
        self.rest(model, observer);
        self.in_doubt = !stops;
    }

    /// The motion stops after the last move.
    pub fn stop(&mut self, machine: &Machine, model: &PowerModel, observer: &mut Observer) {
        self.catch_up(machine);
        self.stop_planners();
        self.rest(model, observer);
    }

    /// The motion stops after the last move; the controller sees that another one
    /// comes.
    pub fn stop_between(&mut self, machine: &Machine, model: &PowerModel, observer: &mut Observer) {
        self.catch_up(machine);
        self.largest.planner.stop_between();
        if let Some(nominal) = &mut self.nominal {
            nominal.planner.stop_between();
        }
        self.rest(model, observer);
    }

    fn rest(&mut self, model: &PowerModel, observer: &mut Observer) {
        self.at_rest = true;
        self.in_doubt = false;
        self.pump(model, observer);
    }

    /// Lines before and after this place are not put together. Where the motion
    /// glides nothing is.
    pub fn part(&mut self) {
        self.largest.planner.part();
        if let Some(nominal) = &mut self.nominal {
            nominal.planner.part();
        }
    }

    /// Whether the last move ends at rest whatever comes.
    pub fn rests(&self) -> bool {
        self.open.back().is_some_and(|last| last.rests)
    }

    /// Something stands here that may or may not stop the motion.
    pub fn doubt(&mut self) {
        self.in_doubt |= !(self.at_rest || self.rests());
    }

    /// New limits may hold for moves that wait already: they may be higher by this factor; of
    /// corners it is the largest step, mm/s.
    pub fn doubt_limits(
        &mut self,
        model: &PowerModel,
        observer: &mut Observer,
        limits: EarlyLimits,
        factor: f64,
    ) {
        if self.at_rest || self.rests() {
            return;
        }
        self.doubt();
        self.brake_in_doubt(model, observer);
        if limits == EarlyLimits::Corners {
            // They hold for all moves that wait.
            self.doubt_from(self.open.first());
            return self.doubt_steps_from(self.open.first(), factor);
        }
        self.doubt_steps_from(self.largest.next.max(self.open.first()), 0.0);
        if let Some(last) = self.open.back_mut() {
            last.act_early(limits, factor);
        }
    }

    /// The moves from this one on take corners with steps of speed up to this one, mm/s, or those
    /// that they have themselves.
    fn doubt_steps_from(&mut self, first: u64, step_mm_s: f64) {
        for number in first..self.open.end() {
            if let Some(open) = self.open.get_mut(number) {
                open.step_mm_s = Some(open.step_mm_s.unwrap_or(0.0).max(step_mm_s));
            }
        }
    }

    /// The moves that a stop here would change are in doubt.
    fn brake_in_doubt(&mut self, model: &PowerModel, observer: &mut Observer) {
        self.largest.planner.settle();
        self.pump(model, observer);
        self.doubt_from(self.largest.next.max(self.open.first()));
    }

    /// The moves from this one on are in doubt.
    fn doubt_from(&mut self, first: u64) {
        for number in first..self.open.end() {
            if let Some(open) = self.open.get_mut(number) {
                open.certain = false;
            }
        }
    }

    fn stop_planners(&mut self) {
        self.largest.planner.stop();
        if let Some(nominal) = &mut self.nominal {
            nominal.planner.stop();
        }
    }

    /// Nothing more comes of the moves so far.
    fn finish(&mut self) {
        self.largest.next = self.open.end();
        if let Some(nominal) = &mut self.nominal {
            nominal.next = self.largest.next;
        }
    }

    /// Takes what the planners have finished.
    fn pump(&mut self, model: &PowerModel, observer: &mut Observer) {
        let times = self.nominal.is_none();
        while let Some(planned) = self.largest.planner.pop() {
            self.largest.next = planned.first;
            self.take(model, observer, &planned, true, times);
        }
        while let Some(nominal) = &mut self.nominal
            && let Some(planned) = nominal.planner.pop()
        {
            nominal.next = planned.first;
            self.take(model, observer, &planned, false, true);
        }
        if self.at_rest {
            self.rest_after(model);
            self.finish();
        }
    }

    /// What was planned ends at rest.
    fn rest_after(&mut self, model: &PowerModel) {
        self.follow_rest(model);
        self.largest.end_mm_s = [0.0; AXES];
        if let Some(nominal) = &mut self.nominal {
            nominal.end_mm_s = [0.0; AXES];
        }
    }
}
