//! One move by itself: the change that makes it fit.

use super::case::{Case, Ends};
use super::change::{
    Change, Permit, feed_unit, feed_word, limit_path_accel, round_feed_down, round_to_step,
    set_rapid_share,
};
use super::lever::{Obstacle, SpeedLever};
use super::options::LimitOptions;
use super::root::largest;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_machine::{AXES, AxisValues, KnobArgument, Machine};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{Overrides, Trajectory, blended_bound, blended_speed, plan, ramps};
use gwatt_power::{Assessment, PowerModel, SpindleShare, Want};

/// In how many rounds the power of steps is expected to fall.
pub(super) const STEP_ROUNDS: u8 = 3;

/// How often a rounded value is lowered by one more step before giving up.
pub(super) const RETRIES: u32 = 3;

/// Solves moves one by one.
#[derive(Debug)]
pub struct Solver<'m> {
    pub(super) machine: &'m Machine,
    pub(super) model: PowerModel,
    pub(super) largest: Overrides,
    pub(super) how: LimitOptions,
}

impl<'m> Solver<'m> {
    /// A solver for a machine.
    #[must_use]
    pub fn new(machine: &'m Machine, how: LimitOptions) -> Self {
        let [largest, _] = Overrides::of(machine);
        Self {
            machine,
            model: PowerModel::new(machine),
            largest,
            how,
        }
    }

    /// Whether a move fits however late it begins during a run of the spindle.
    pub(super) fn fits_later(
        &self,
        mv: &Move,
        assessment: &Assessment,
        permit: &Permit,
        ends: Ends,
    ) -> bool {
        let case = Case {
            mv,
            assessment,
            permit,
            ends,
            exact_stop: false,
        };
        self.load(case, mv) <= 1.0 + 1e-9
    }

    /// Nothing is proposed that does not fit, or that breaks a floor.
    pub(super) fn verify(&self, case: Case<'_>, change: Change) -> Result<Change, Obstacle> {
        self.respect_floor(case, &change)?;
        let load = self.load(case, &change.apply(self.machine, case.mv, case.permit));
        if load <= 1.0 + 1e-9 {
            return Ok(change);
        }
        Err(Obstacle::new(
            "not-enough",
            format!(
                "the values of this strategy leave the block at {:.1} % of the limit",
                load * 100.0
            ),
            "use --strategy optimal --law exact",
        ))
    }

    /// Load ratio of a move, changed or not, at the largest overrides.
    pub(super) fn load(&self, case: Case<'_>, mv: &Move) -> f64 {
        if let Some(load) = self.load_by_steps(case, mv) {
            return load;
        }
        let depth = match case.ends {
            Ends::Any(depth) if self.exceeds_by_steps(case, mv) => {
                depth.saturating_sub(STEP_ROUNDS)
            }
            Ends::Any(depth) if !self.gets_stops(case.mv, mv) => depth,
            _ if mv.stray.is_far() => 2,
            Ends::Alone(steps) => return self.load_alone(case, mv, steps),
            _ => return self.planned_load(case, mv),
        };
        let share = &share(case, mv);
        let speed_mm_s = blended_speed(self.machine, mv, self.largest);
        let planned = mv.unknown_start.is_empty() && !mv.stray.is_far();
        if mv.arc.is_none() && planned && depth < 2 {
            let ramps = ramps(self.machine, mv, self.largest, [f64::INFINITY; 2]);
            let demand = self.model.demand(mv, &ramps, Want::PEAKS);
            let demand = self.model.with_cruises(demand, mv, speed_mm_s);
            return self.model.load_with_spindle(&demand, share, speed_mm_s);
        }
        let bound = blended_bound(self.machine, mv, self.largest);
        let demand = self.model.robust(mv, &bound, &mv.accel_mm_s2);
        let load = self.model.load_with_spindle(&demand, share, speed_mm_s);
        load / libm::pow(0.9, f64::from(depth.saturating_sub(2)))
    }

    /// Load of a move that begins and ends at rest, with the spindle next to it.
    pub(super) fn planned_load(&self, case: Case<'_>, mv: &Move) -> f64 {
        let halved = self.halved(case.mv, mv);
        let mv = halved.as_ref().unwrap_or(mv);
        let plan = plan(self.machine, mv, self.largest);
        let demand = self.model.demand(mv, &plan, Want::PEAKS);
        let any = demand.load_ratio <= 1.0 + 1e-9;
        let demand = if any && !matches!(plan.trajectory, Trajectory::Rest) {
            // Whether another override has more is of interest only where this one fits.
            let want = self.model.around_limits(mv);
            let (machine, largest) = (self.machine, self.largest);
            self.model.demand_at_any(machine, mv, &plan, largest, want)
        } else {
            demand
        };
        let known = mv.unknown_start.is_empty();
        let speed_mm_s = if known {
            plan.top_speed_mm_s
        } else {
            mv.feed_mm_s * self.largest.feed
        };
        let share = &share(case, mv);
        self.model.load_with_spindle(&demand, share, speed_mm_s)
    }

    /// Whether a move has to fit whatever its neighbours do, changed or not.
    fn is_open(&self, case: Case<'_>, mv: &Move) -> bool {
        let known = mv.unknown_start.is_empty() && mv.length_mm > 0.0;
        let open = matches!(case.ends, Ends::Any(_)) && !self.gets_stops(case.mv, mv);
        known && (open || mv.stray.is_far())
    }

    /// The highest speed that fits, on top of what `with` changes already.
    pub(super) fn speed(&self, case: Case<'_>, lever: SpeedLever, with: &Change) -> Option<Change> {
        let Case { mv, permit, .. } = case;
        let mut trial = Change {
            as_feed: lever == SpeedLever::AsFeed,
            exact_stop: lever == SpeedLever::AsFeed && case.exact_stop || with.exact_stop,
            ..*with
        };
        let base = trial.apply(self.machine, mv, permit);
        let mut moved = base.clone();
        let mut load_at = |lever: SpeedLever, value: f64| {
            match lever {
                SpeedLever::RapidPercent(knob) => {
                    set_rapid_share(self.machine, &mut moved, knob, value);
                }
                _ => moved.feed_mm_s = value / self.largest.feed,
            }
            self.load(case, &moved)
        };
        let top = match lever {
            SpeedLever::RapidPercent(_) => base.rapid_factor * 100.0,
            // What its neighbours may carry it up to, however short it is.
            _ if self.is_open(case, &base) => blended_speed(self.machine, &base, self.largest),
            SpeedLever::Cap(_) if !mv.unknown_start.is_empty() => self.fastest_axis(&base),
            // No faster than the rapid, in whichever direction it runs.
            SpeedLever::AsFeed if !mv.unknown_start.is_empty() => self.slowest_axis(mv),
            _ if mv.unknown_start.is_empty() => {
                plan(self.machine, &base, self.largest).top_speed_mm_s
            }
            _ => base.feed_mm_s.min(1e6),
        };
        let load_top = load_at(lever, top);
        // A path that strays from its move may be bound to more than the axes reach together.
        let stands = top >= base.feed_mm_s || !mv.stray.strays() || self.load(case, &base) <= 1.0;
        if load_top <= 1.0 && lever != SpeedLever::AsFeed && stands {
            // The speed in force fits: no word is needed.
            return Some(trial);
        }
        let value = if load_top <= 1.0 {
            top
        } else {
            largest(top, load_top, |value| load_at(lever, value))?
        };
        match lever {
            SpeedLever::RapidPercent(knob) => {
                let step = self.machine.controller.knobs.get(knob)?.percent_step();
                let percent = round_to_step(value, step);
                trial.rapid_percent = (percent > 0.0).then_some((knob, percent));
                trial.rapid_percent?;
            }
            SpeedLever::Cap(knob) => trial.speed = Some(self.cap(case, &trial, knob, value)?),
            _ => trial.feed = Some(self.feed_number(case, &trial, value)?),
        }
        Some(trial)
    }

    /// The F, in program units and rounded down, for a path speed at the
    /// largest override.
    fn feed_number(&self, case: Case<'_>, trial: &Change, speed_mm_s: f64) -> Option<f64> {
        let speed_mm_s = speed_mm_s / self.largest.feed;
        let mut feed = feed_word(self.machine, case.mv, case.permit, speed_mm_s);
        for _ in 0..RETRIES {
            let rounded = Change {
                feed: Some(feed),
                ..*trial
            }
            .apply(self.machine, case.mv, case.permit);
            if feed > 0.0 && feed.is_finite() && self.load(case, &rounded) <= 1.0 {
                return Some(feed);
            }
            feed = round_feed_down(feed * (1.0 - 2e-5));
        }
        None
    }

    /// The highest acceleration that fits, on top of what `with` changes.
    pub(super) fn accel(&self, case: Case<'_>, knob: usize, with: &Change) -> Option<Change> {
        let with = &Change {
            exact_stop: with.exact_stop || self.halts(case, knob),
            ..*with
        };
        let base = with.apply(self.machine, case.mv, case.permit);
        let mut moved = base.clone();
        let along_mm_s2 = self.along_path(knob, &base);
        let mut load_at = |factor: f64| {
            match along_mm_s2 {
                Some(accel) => {
                    // Where the direction is not known axes are held to it as well.
                    moved.accel_mm_s2 = base.accel_mm_s2;
                    limit_path_accel(self.machine, &mut moved, accel * factor);
                }
                None => moved.accel_mm_s2 = base.accel_mm_s2.map(|accel| accel * factor),
            }
            self.load(case, &moved)
        };
        let load_top = load_at(1.0);
        let factor = if load_top <= 1.0 {
            1.0
        } else {
            largest(1.0, load_top, load_at)?
        };
        // The root lies a hair below the whole percentage that it may be.
        let whole = self.machine.controller.knobs.get(knob);
        let whole = whole.filter(|knob| knob.argument == KnobArgument::Index);
        let whole = whole.and_then(|_| self.accel_change(case, knob, factor * (1.0 + 1e-6), with));
        let fits = |change: &Change| {
            let changed = change.apply(self.machine, case.mv, case.permit);
            self.load(case, &changed) <= 1.0 + 1e-9
        };
        whole
            .filter(fits)
            .or_else(|| self.accel_change(case, knob, factor, with))
    }

    /// Acceleration knobs at `factor` of what is in force, rounded down;
    /// `None` when the knob does not go that low.
    pub(super) fn accel_change(
        &self,
        case: Case<'_>,
        knob: usize,
        factor: f64,
        with: &Change,
    ) -> Option<Change> {
        let rounded = if let Some(accel) = self.along_path(knob, case.mv) {
            self.path_values(knob, accel * factor)?
        } else {
            let values = case.mv.accel_mm_s2.map(|accel| accel * factor);
            self.knob_values(knob, &values, case.permit)?
        };
        Some(Change {
            accel: Some((knob, rounded)),
            exact_stop: with.exact_stop || self.halts(case, knob),
            ..*with
        })
    }

    /// Values of a knob for these acceleration limits, rounded down.
    pub(super) fn knob_values(
        &self,
        knob: usize,
        accel_mm_s2: &AxisValues,
        permit: &Permit,
    ) -> Option<AxisValues> {
        let data = self.machine.controller.knobs.get(knob)?;
        if data.levels.is_some() {
            return self.level_values(data, accel_mm_s2);
        }
        let mut values = [0.0; AXES];
        for axis in self.machine.axis_set.iter() {
            let Some(own) = &self.machine.axes[axis] else {
                continue;
            };
            let value = data
                .unit
                .value(own, accel_mm_s2[axis], permit.knob_mm_per_unit);
            // A value that is a step already must not fall by rounding.
            values[axis] = round_to_step(value * (1.0 + 1e-12), data.step);
            if values[axis] < data.min || values[axis] <= 0.0 {
                return None;
            }
        }
        if data.output().is_some() || data.is_named_for_all() {
            // One value for all axes, whatever their rounding.
            let axes = || self.machine.axis_set.iter();
            let least = axes()
                .map(|axis| values[axis])
                .fold(f64::INFINITY, f64::min);
            axes().for_each(|axis| values[axis] = least);
        }
        Some(values)
    }

    /// Load of a cruise at the wanted speed; `None` for moves without a path.
    pub(crate) fn cruise_load(&self, case: Case<'_>) -> Option<f64> {
        let mv = case.mv;
        let mut slow = mv.clone();
        // So slow a start that the ramps need next to nothing.
        slow.accel_mm_s2 = slow.accel_mm_s2.map(|accel| accel * 1e-9);
        let planned = plan(self.machine, mv, self.largest);
        let gwatt_plan::Trajectory::Path(_) = planned.trajectory else {
            return None;
        };
        let cruise = gwatt_plan::Plan::cruise(planned.speed_limit_mm_s, mv.length_mm);
        let demand = self.model.demand(&slow, &cruise, Want::PEAKS);
        let share = &case.assessment.spindle;
        let speed_mm_s = planned.speed_limit_mm_s;
        Some(self.model.load_with_spindle(&demand, share, speed_mm_s))
    }

    pub(super) fn respect_floor(&self, case: Case<'_>, change: &Change) -> Result<(), Obstacle> {
        let per_minute = SECONDS_PER_MINUTE / feed_unit(self.machine, case.mv, case.permit);
        let capped = change.speed.map(|_| {
            let changed = change.apply(self.machine, case.mv, case.permit);
            changed.feed_mm_s * per_minute
        });
        let cuts = case.mv.kind != MoveKind::Rapid && !case.permit.positions;
        let Some(feed) = change.feed.or(capped).filter(|_| cuts) else {
            return Ok(());
        };
        let limits = &self.machine.limits;
        let floor_mm_s = limits
            .min_feed_mm_s
            .max(limits.min_feed_ratio * case.assessment.speed_mm_s);
        let floor = floor_mm_s * per_minute;
        // What a firmware moves by itself has no F.
        let has_no_f = !(feed.is_finite() && floor.is_finite());
        if has_no_f || feed >= floor * (1.0 - 1e-12) {
            return Ok(());
        }
        Err(Obstacle::new(
            "feed-floor",
            format!(
                "it would need F{feed}, below the floor of F{} in [limits]",
                (floor * 1e3).round() / 1e3
            ),
            "lower min_feed_mm_min or min_feed_ratio, or use a word for acceleration",
        ))
    }
}

/// What the spindle takes of a move, changed or not: a rapid written as a feed
/// may wait until it has its speed.
pub(super) fn share(case: Case<'_>, mv: &Move) -> SpindleShare {
    let own = case.assessment.spindle;
    let waits = case.mv.kind == MoveKind::Rapid && mv.kind != MoveKind::Rapid;
    match own.settled_w.filter(|_| waits) {
        Some(settled_w) => SpindleShare {
            drawn_w: settled_w,
            fed_back_w: 0.0,
            ..own
        },
        None => own,
    }
}
