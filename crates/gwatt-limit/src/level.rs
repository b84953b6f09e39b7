//! Levels: words that select one of a few accelerations or rapid speeds.
//!
//! There is nothing to solve: each level that is gentler than what is in force is tried, by
//! itself and with the speed that it leaves, and what fits and takes the least time is taken.

use super::knob_level::{level_of, put};
use super::level_groups::Groups;
use std::collections::VecDeque;

use super::case::Case;
use super::change::Change;
use super::lever::{Levers, Obstacle, SpeedLever};
use super::members::Window;
use super::options::Strategy;
use super::slot::Slot;
use super::solver::Solver;
use gwatt_machine::{AxisSet, AxisValues, Knob, KnobTarget, Level};
use gwatt_plan::plan;

/// Above which share of the time a level is not worth its words.
const SOONER: f64 = 1.0 - 1e-6;
/// The same where a rapid becomes a feed by it.
const SOONER_AS_FEED: f64 = 1.0 - 1e-3;

/// Up to how many levels below the one in force are tried with the speeds of a window.
pub(super) const DEEPEST: usize = 6;

impl Solver<'_> {
    /// The quickest level that lets no axis accelerate harder than this.
    pub(super) fn level_values(&self, knob: &Knob, accel_mm_s2: &AxisValues) -> Option<AxisValues> {
        let levels = knob.levels.as_ref()?;
        let axes = self.machine.axis_set;
        let index = levels.quickest_within(axes, accel_mm_s2, f64::INFINITY)?;
        Some(values(index))
    }

    /// What was found without levels, or what takes less time with one.
    pub(super) fn with_levels(
        &self,
        case: Case<'_>,
        levers: &Levers,
        found: Result<Change, Obstacle>,
    ) -> Result<Change, Obstacle> {
        if levers.levels.is_empty() && levers.feed_levels.is_empty() {
            return found;
        }
        let mut best = found.as_ref().ok().copied();
        let mut best_s = best.map_or(f64::INFINITY, |change| self.lasts_s(case, &change));
        let mut offer = |change: Change| {
            if self.respect_floor(case, &change).is_err() {
                return;
            }
            let lasts_s = self.lasts_s(case, &change);
            let other = best.is_none_or(|best: Change| !best.as_feed);
            let share = if change.as_feed && other {
                SOONER_AS_FEED
            } else {
                SOONER
            };
            // Where no time is known (the start of the move is not), the first one is taken.
            if best.is_none() || lasts_s < best_s * share {
                (best, best_s) = (Some(change), lasts_s);
            }
        };
        for change in self.candidates(case, &levers.levels, false) {
            let moved = change.apply(self.machine, case.mv, case.permit);
            if self.load(case, &moved) <= 1.0 + 1e-9 {
                offer(change);
            }
        }
        let speed = levers
            .speed
            .filter(|_| self.how.strategy != Strategy::Accel);
        let pairs = speed.filter(|_| self.how.strategy != Strategy::Speed);
        if let Some(lever) = pairs {
            let as_feed = lever == SpeedLever::AsFeed;
            let groups = if as_feed {
                &levers.feed_levels
            } else {
                &levers.levels
            };
            for with in self.candidates(case, groups, as_feed) {
                let pair = self.speed(case, lever, &with);
                // Without an F it is the level alone.
                if let Some(change) = pair.filter(|change| change.feed.is_some()) {
                    offer(change);
                }
            }
        }
        best.map_or(found, Ok)
    }

    /// Changes to each level that is gentler than what is in force, the quickest first.
    fn candidates<'a>(
        &'a self,
        case: Case<'a>,
        groups: &'a Groups,
        as_feed: bool,
    ) -> impl Iterator<Item = Change> + 'a {
        let mv = case.mv;
        let accel_mm_s2 = if as_feed {
            &case.permit.feed_accel_mm_s2
        } else {
            &mv.accel_mm_s2
        };
        let axes = AxisSet(mv.moving.0 | mv.unknown_start.0);
        let knobs = groups.iter().filter_map(|index| {
            let knob = self.machine.controller.knobs.get(*index)?;
            let speeds = knob.target == KnobTarget::RapidSpeed;
            let suits = match self.how.strategy {
                Strategy::Speed => speeds,
                Strategy::Accel => !speeds,
                Strategy::Preset | Strategy::Optimal | Strategy::Split => true,
            };
            let levels = knob.levels.as_ref().filter(|_| suits)?;
            Some((*index, knob, levels))
        });
        knobs.flat_map(move |(index, knob, levels)| {
            let gentler = move |level: &Level| {
                let mut moved = mv.clone();
                put(knob, level, &mut moved);
                let rapid_factor = if as_feed { 1.0 } else { mv.rapid_factor };
                let own = Level {
                    words: Vec::new(),
                    accel_mm_s2: moved.accel_mm_s2,
                    rapid_factor: if as_feed { 1.0 } else { moved.rapid_factor },
                };
                let other = !own.rapid_factor.total_cmp(&rapid_factor).is_eq()
                    || axes
                        .iter()
                        .any(|axis| own.accel_mm_s2[axis] != accel_mm_s2[axis]);
                other && own.is_within(axes, accel_mm_s2, rapid_factor)
            };
            let list = levels.list.iter().enumerate().rev();
            list.filter(move |(_, level)| gentler(level))
                .map(move |(level, _)| Change {
                    accel: Some((index, values(level))),
                    ..Change::NONE
                })
        })
    }

    /// How long a move takes with a change, with what the axes stand for its words, s.
    fn lasts_s(&self, case: Case<'_>, change: &Change) -> f64 {
        let changed = change.apply(self.machine, case.mv, case.permit);
        plan(self.machine, &changed, self.largest).duration_s + self.stands_s(change)
    }
}

/// Puts the moves of a window that have levels under the one that is this many below the
/// quickest that is gentler than what is in force; false where no move has one.
pub(super) fn step_down(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    found: &[Levers],
    depth: usize,
) -> bool {
    let mut any = false;
    for (member, levers) in window.iter().zip(found) {
        let changes = solver.candidates(member.case(slots), &levers.levels, false);
        // None that takes back what another window needs.
        let now = member.changed(slots);
        let accels = changes.filter(|change| {
            let level = level_of(solver.machine, change.accel);
            level.is_some_and(|(knob, level)| {
                knob.sets_accel() && level.is_within(now.moving, &now.accel_mm_s2, f64::INFINITY)
            })
        });
        let change: Option<Change> = accels.take(depth).last();
        let Some(accel) = change.and_then(|change| change.accel) else {
            continue;
        };
        let change = Change {
            accel: Some(accel),
            ..super::members::change(slots, member)
        };
        super::members::put(solver, slots, member, change);
        any = true;
    }
    any
}

/// The values of a knob for a level.
fn values(index: usize) -> AxisValues {
    let index = u32::try_from(index).unwrap_or(u32::MAX);
    [f64::from(index); gwatt_machine::AXES]
}
