//! The spindle next to the axes on the bus.
//!
//! Input: actions in program order, and the judged moves in the same order.
//! Output: the assessments with the spindle in them, and before a move a row of
//! kind `spindle` where the program waits for a run, or where a run by itself
//! does not fit.
//!
//! The spindle is followed twice, at the largest overrides for the peaks, and at
//! the nominal ones for times and energies; and where lower overrides count once more
//! for those.

mod alone;
mod assessor;
mod command;
mod queued;
mod figures;
mod follow;
mod levels;
mod show;
mod shown;
mod slower;
mod lowered;

use std::collections::VecDeque;

use self::lowered::Slower;
use self::queued::Queued;
pub(super) use self::shown::Shown;
pub use self::shown::Turning;
use crate::assessment::{Assessment, Certificate};
use crate::cutting::CuttingPower;
use crate::demand::{Demand, Want};
use crate::duty_cycle::SpindleLoad;
use crate::model::PowerModel;
use crate::overlap;
use crate::spindle_share::SpindleShare;
use crate::spindle_state::{SpindleMotor, SpindleState, Window};
use crate::spindle_trace::SpindleTrace;
use crate::surface_speed::Surface;
use gwatt_machine::{Machine, Spindle, SpindleWait};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{Overrides, Plan, plan};

/// The spindle of a machine during a program.
#[derive(Debug)]
pub(super) struct SpindleBus<'m> {
    machine: &'m Machine,
    spindle: &'m Spindle,
    model: PowerModel,
    motor: SpindleMotor,
    /// Of peaks, and of times.
    overrides: [Overrides; 2],
    states: [SpindleState; 2],
    /// At lower overrides, where these count.
    slower: Option<Slower>,
    queue: VecDeque<Queued>,
    pushed: u64,
    handed: u64,
    /// ±1, or 0 at rest.
    direction: f64,
    /// It is switched on: what its drive draws before and after is not certain.
    switched_on: bool,
    /// S; `None`: the program has not said.
    rpm: Option<f64>,
    /// In step with the axis of a tap, 1/min, signed.
    tap_rpm: Option<f64>,
    /// After a tap: it turns on by itself, or waits for a word.
    lost: bool,
    surface: Option<Surface>,
    clamp_rpm: f64,
    center_mm: f64,
    cutting: CuttingPower,
    /// The line of a word that may act before or after the motion of its block, as long as that
    /// moves; and what the spindle may draw before the word: largest and smallest power at the
    /// largest overrides and at lower ones, W.
    unsure: Option<u64>,
    before_w: Option<[[f64; 2]; 2]>,
    /// A new speed was asked for, here.
    asked: Option<u64>,
    /// Commands so far.
    commands: u32,
    /// What it does during the moves passed on, where that is watched over time.
    pub(super) spindle_loads: Option<Vec<SpindleLoad>>,
    /// The same at 100 %, where that is wanted.
    pub(super) shown: Option<Shown>,
    last: Option<Move>,
    /// No more than this is drawn and fed back before the commands that wait
    /// have been looked at, W.
    reserve_w: [f64; 2],
}

impl<'m> SpindleBus<'m> {
    /// The spindle at the beginning of a program: at rest, or if nothing is known
    /// of the machine, at any speed. `None` without one.
    pub fn new(machine: &'m Machine, overrides: [Overrides; 2], unknown: bool) -> Option<Self> {
        let spindle = machine.spindle.as_ref()?;
        // A machine whose numbers are out of range has been refused.
        let motor = SpindleMotor::new(spindle).ok()?;
        let begin = |unknown: bool| {
            if unknown {
                SpindleState::anywhere(&motor, -spindle.max_rpm, spindle.max_rpm)
            } else {
                SpindleState::steady(0.0)
            }
        };
        let lower = machine.limits.override_at.is_none();
        let slower = lower.then(|| Slower::new(begin(unknown)));
        let states = [begin(unknown), begin(false)];
        let mut bus = Self {
            machine,
            spindle,
            model: PowerModel::new(machine),
            motor,
            overrides,
            states,
            slower,
            queue: VecDeque::new(),
            pushed: 0,
            handed: 0,
            direction: 0.0,
            switched_on: false,
            rpm: None,
            tap_rpm: None,
            lost: false,
            surface: None,
            clamp_rpm: spindle.max_rpm,
            center_mm: f64::NAN,
            cutting: CuttingPower::new(machine),
            unsure: None,
            before_w: None,
            asked: None,
            commands: 0,
            spindle_loads: None,
            shown: None,
            last: None,
            reserve_w: [0.0; 2],
        };
        bus.reserve();
        Some(bus)
    }

    /// What may be passed over of the axes' peaks, so that nothing is passed over
    /// of the sum.
    pub fn want(&self, want: Want) -> Want {
        if self.reserve_w == [f64::INFINITY; 2] {
            return Want {
                energy: want.energy,
                accel: want.accel,
                ..Want::PEAKS
            };
        }
        Want {
            energy: want.energy,
            floor_w: want.floor_w - self.reserve_w[0],
            regen_floor_w: want.regen_floor_w - self.reserve_w[1],
            accel: want.accel,
        }
    }

    /// A move has been given to the planner.
    pub fn push(&mut self) {
        self.pushed += 1;
    }

    /// Takes a judged move, and hands it on with the spindle in it.
    pub fn take(
        &mut self,
        mv: &Move,
        assessment: &Assessment,
        text: &[u8],
        want: Want,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        self.catch_up(Some(mv), sink);
        self.set_off(sink, Some(mv), false);
        if self.waits(mv) {
            self.wait(mv, sink);
        }
        let mut judged = *assessment;
        let duration_s = assessment.fastest_s;
        let followed = self.follow_surface(mv, assessment);
        let covered = self.covered(mv, followed.as_ref());
        let either = self.either_order(covered);
        let covered = either.map(|[own, _]| own).or(covered);
        let cutting_w = self.cut(mv, &mut judged);
        if self.shown.is_some() {
            self.show(mv, &judged, followed.as_ref());
        }
        let window = self.states[0].window(&self.motor, duration_s);
        let load = self.spindle_loads.is_some().then(|| {
            let covered = covered.map(Window::Between);
            let window = covered.as_ref().unwrap_or(&window);
            SpindleLoad {
                levels: self.levels(window, (duration_s, judged.ahead), cutting_w),
                alone: None,
            }
        });
        let later = covered.unwrap_or_else(|| self.states[0].henceforth(&self.motor));
        let runs = !matches!(window, Window::Steady(_)) || covered.is_some();
        let (mut exact, mut own) = (None, None);
        let planned = assessment.certificate == Certificate::Planned;
        let known = planned && !assessment.ahead && duration_s > 0.0;
        if known && runs {
            own = Some(plan(self.machine, mv, self.overrides[0]));
        }
        let extremes = match (&window, covered) {
            (_, Some(extremes)) => extremes,
            (Window::Steady(power_w), None) => [*power_w; 2],
            (Window::Between(extremes), None) => *extremes,
            (Window::Run(trace, from_s), None) => {
                let span = trace.over(*from_s, from_s + duration_s);
                let extremes = [span.largest_w, span.least_w];
                if known && self.reaches(&judged.demand, extremes, cutting_w, want) {
                    exact = Some((*trace, *from_s));
                }
                extremes
            }
        };
        let exact = exact.zip(own.as_ref());
        self.meet(mv, exact, (extremes, cutting_w), &mut judged.demand);
        match (covered, &followed) {
            (None, _) => self.count_slower(mv, assessment, own.as_ref(), cutting_w, &mut judged),
            (Some(extremes), followed) if self.slower.is_some() => {
                let lower = followed.as_ref().and_then(|it| it.lower);
                let lower = either.map(|[_, lower]| lower).or(lower);
                let lower = lower.unwrap_or(extremes);
                self.count_following(assessment, lower, cutting_w, &mut judged);
            }
            (Some(_), _) => {}
        }
        self.share_of(mv, later, runs, &mut judged.spindle);
        if want.energy {
            self.count_energy(mv, &mut judged, followed.as_ref());
        }
        self.move_on(mv, &judged, followed.is_some());
        if let (Some(list), Some(load)) = (&mut self.spindle_loads, load) {
            list.push(load);
        }
        match &mut self.last {
            Some(last) => last.clone_from(mv),
            None => self.last = Some(mv.clone()),
        }
        sink(mv, &judged, text);
    }

    /// Adds the spindle to what the axes ask for: exactly, where its run and their plan are
    /// known, or else between its extremes.
    fn meet(
        &self,
        mv: &Move,
        exact: Option<((&SpindleTrace, f64), &Plan)>,
        (extremes, cutting_w): ([f64; 2], f64),
        demand: &mut Demand,
    ) {
        let index = self.spindle.converter;
        if let (Some((run, plan)), Some(converter)) = (exact, self.model.converters.get(index)) {
            let [peak_w, regen_w] = overlap::peaks(&self.model, converter, mv, plan, run);
            let base_w = self.spindle.base_load_w;
            let fed_back_w = (regen_w - self.credited_w()).max(0.0);
            let peaks = [peak_w + base_w + cutting_w, fed_back_w];
            demand.set_spindle(index, &self.model, peaks);
        } else {
            let rests = mv.moving.is_empty() && mv.unknown_start.is_empty();
            let idle_w = if rests { self.idle_w(mv) } else { 0.0 };
            self.add(demand, extremes, idle_w, cutting_w);
        }
    }

    /// What the spindle asks for next to a move: from then on it may be anything between `later`.
    fn share_of(&self, mv: &Move, later: [f64; 2], runs: bool, share: &mut SpindleShare) {
        share.drawn_w = later[0].max(0.0) + self.spindle.base_load_w;
        share.fed_back_w = (-later[1]).max(0.0);
        share.runs = runs;
        share.command = self.commands;
        if self.spindle.wait == SpindleWait::Feeds && mv.kind == MoveKind::Rapid {
            let target = self.states[0].target();
            let settled_w = self.motor.holding_w(target) + self.spindle.base_load_w;
            share.settled_w = (target != 0.0).then_some(settled_w);
        }
        share.drawn_w += self.taken(mv).power_w / self.spindle.efficiency;
    }

    /// The end of the program: what is still asked for.
    pub fn finish(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        self.handed = self.pushed;
        self.catch_up(None, sink);
        self.set_off(sink, None, false);
    }
}
