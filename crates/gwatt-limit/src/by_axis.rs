//! Independent axes of one rapid, each with an acceleration of its own.
//!
//! Such a move ends with its slowest axis. The others may accelerate so slowly that
//! they arrive with it: that takes power off and no time. Where it is not enough all
//! arrive together a little later.

use super::case::Case;
use super::change::Change;
use super::solver::Solver;
use gwatt_machine::{AXES, AxisValues};
use gwatt_motion::Move;
use gwatt_plan::{Trajectory, is_independent, plan};

/// Halvings of a share of acceleration, and of the time of arrival.
const HALVINGS: u32 = 16;
/// Lowest share of acceleration that is tried.
const LOWEST: f64 = 1e-4;
/// How often the time of arrival is doubled at most.
const DOUBLINGS: u32 = 8;

impl Solver<'_> {
    /// The accelerations that fit and take the least time: one share for all axes, or
    /// one for each axis of an independent rapid.
    pub(super) fn accel_alone(&self, case: Case<'_>, knob: usize) -> Option<Change> {
        let together = arriving_together(self, case, knob);
        let common = self.accel(case, knob, &Change::default());
        let time_s = |change: &Change| {
            let changed = change.apply(self.machine, case.mv, case.permit);
            plan(self.machine, &changed, self.largest).duration_s
        };
        match (common, together) {
            // The word for all axes is the simpler one.
            (Some(common), Some(together))
                if time_s(&together) < time_s(&common) * (1.0 - 1e-6) =>
            {
                Some(together)
            }
            (common, together) => common.or(together),
        }
    }
}

/// The change of a knob with which the axes of an independent rapid arrive together
/// as soon as the limit permits; `None` for other moves, where the controller has no
/// word by axis, and where nothing fits.
fn arriving_together(solver: &Solver<'_>, case: Case<'_>, knob: usize) -> Option<Change> {
    let alone = case.mv.moving.iter().count() < 2 || !is_independent(solver.machine, case.mv);
    if alone
        || !case.mv.unknown_start.is_empty()
        || solver.machine.controller.knob_by_axis(knob).is_none()
    {
        return None;
    }
    let mut moved = case.mv.clone();
    let soonest_s = lasts_s(solver, &moved).into_iter().fold(0.0, f64::max);
    let positive = soonest_s > 0.0 && soonest_s.is_finite();
    let mut at = |arrival_s: f64| {
        let latest = latest(solver, case.mv, &mut moved, arrival_s);
        let accel = one_step_up(solver, case, knob, &latest);
        let values = solver.knob_values(knob, &accel, case.permit)?;
        let change = Change {
            accel: Some((knob, values)),
            ..Change::NONE
        };
        let changed = change.apply(solver.machine, case.mv, case.permit);
        (solver.load(case, &changed) <= 1.0).then_some(change)
    };
    if !positive {
        return None;
    }
    if let Some(change) = at(soonest_s) {
        return Some(change);
    }
    let (mut early_s, mut late_s) = (soonest_s, 2.0 * soonest_s);
    let mut found = at(late_s);
    for _ in 0..DOUBLINGS {
        if found.is_some() {
            break;
        }
        (early_s, late_s) = (late_s, 2.0 * late_s);
        found = at(late_s);
    }
    found?;
    for _ in 0..HALVINGS {
        let middle_s = f64::midpoint(early_s, late_s);
        match at(middle_s) {
            Some(change) => (late_s, found) = (middle_s, Some(change)),
            None => early_s = middle_s,
        }
    }
    found
}

/// Accelerations one step of a knob higher, mm/s²: rounded down they still arrive.
fn one_step_up(solver: &Solver<'_>, case: Case<'_>, knob: usize, accel: &AxisValues) -> AxisValues {
    let knob = solver.machine.controller.knobs.get(knob);
    let unit = case.permit.knob_mm_per_unit;
    std::array::from_fn(|axis| {
        let data = solver.machine.axes[axis].as_ref();
        let step = knob.zip(data);
        let step = step.map_or(0.0, |(knob, axis)| {
            knob.unit.accel_mm_s2(axis, knob.step, unit)
        });
        (accel[axis] + step).min(case.mv.accel_mm_s2[axis])
    })
}

/// How long each axis moves, s.
fn lasts_s(solver: &Solver<'_>, mv: &Move) -> AxisValues {
    let mut lasts_s = [0.0; AXES];
    if let Trajectory::Axes(profiles) = plan(solver.machine, mv, solver.largest).trajectory {
        for (axis, profile) in profiles {
            lasts_s[axis] = profile.duration_s();
        }
    }
    lasts_s
}

/// The lowest accelerations with which all axes have arrived at an instant, mm/s²;
/// `moved` is room for tries.
fn latest(solver: &Solver<'_>, mv: &Move, moved: &mut Move, arrival_s: f64) -> AxisValues {
    // As shares; the higher ones arrive in time.
    let (mut low, mut high) = ([LOWEST; AXES], [1.0; AXES]);
    for _ in 0..HALVINGS {
        let middle: AxisValues = std::array::from_fn(|axis| (low[axis] * high[axis]).sqrt());
        moved.accel_mm_s2 = std::array::from_fn(|axis| middle[axis] * mv.accel_mm_s2[axis]);
        let lasts_s = lasts_s(solver, moved);
        for axis in mv.moving.iter() {
            if lasts_s[axis] <= arrival_s {
                high[axis] = middle[axis];
            } else {
                low[axis] = middle[axis];
            }
        }
    }
    std::array::from_fn(|axis| {
        let share = if mv.moving.contains(axis) {
            high[axis]
        } else {
            1.0
        };
        share * mv.accel_mm_s2[axis]
    })
}
