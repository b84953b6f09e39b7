//! A blended move and its neighbours: lowered together until the robust bound
//! over the three fits.
//!
//! The bound grows with every speed and acceleration, so lowering a move for
//! one window never harms another.

use std::collections::VecDeque;

use arrayvec::ArrayVec;

use super::change::{Change, feed_unit, round_feed_down};
use super::law;
use super::lever::{Levers, Obstacle, SpeedLever, levers};
use super::limiter::Slot;
use super::options::{Law, Strategy};
use super::root::largest;
use super::solver::{Case, Solver};
use crate::machine::{AXES, AxisValues};
use crate::plan::{SpeedBound, blended_bound, blended_speed, plan};
use crate::units::SECONDS_PER_MINUTE;

/// Lowers the window around `center` if it does not fit.
pub(super) fn settle(solver: &Solver<'_>, slots: &mut VecDeque<Slot>, center: usize) {
    let range = range(slots, center);
    // Untouched, the window is the one that the assessment was made for.
    let untouched = |index: &usize| {
        slots[*index].change.is_none() && slots[*index].mv.loads == slots[center].mv.loads
    };
    if range.iter().all(untouched) && solver.model.fits(&slots[center].assessment.demand) {
        return;
    }
    if load(solver, slots, &range) <= 1.0 + 1e-9 {
        return;
    }
    let found: Vec<Levers> = range
        .iter()
        .copied()
        .map(|index| slot_levers(solver, &slots[index]))
        .collect();
    let by_speed = || found.iter().any(|levers| speed_lever(*levers).is_some());
    let by_accel = || found.iter().any(|levers| levers.accel.is_some());
    let by_rule = solver.how.strategy == Strategy::Preset || solver.how.law == Law::Patent;
    let done = match solver.how.strategy {
        _ if by_rule => by_law(solver, slots, &range, &found),
        Strategy::Accel => by_accel() && lower_accel(solver, slots, &range, &found),
        Strategy::Optimal if by_accel() => {
            faster_of_both(solver, slots, &range, &found, by_speed())
        }
        _ => by_speed() && lower_speed(solver, slots, &range, &found),
    };
    if !done {
        let slot = &mut slots[center];
        let case = Case {
            mv: &slot.mv,
            assessment: &slot.assessment,
            permit: &slot.permit,
        };
        slot.obstacle = Some(obstacle(solver, case));
    }
}

/// Gives each move of the window what preset or law say for it alone.
fn by_law(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    range: &Window,
    found: &[Levers],
) -> bool {
    for (index, levers) in range.iter().zip(found) {
        let slot = &mut slots[*index];
        let case = Case {
            mv: &slot.mv,
            assessment: &slot.assessment,
            permit: &slot.permit,
        };
        let change = match solver.how.strategy {
            Strategy::Preset => law::preset(solver, case, *levers),
            strategy => law::squared_ratio(solver, case, *levers, strategy),
        };
        // A neighbour for which there is none may fit as it is.
        if let Ok(change) = change {
            if let Err(obstacle) = solver.respect_floor(case, &change) {
                slot.obstacle = Some(obstacle);
                return false;
            }
            slot.change = change;
            slot.changed = change.apply(solver.machine, &slot.mv, &slot.permit);
        }
    }
    load(solver, slots, range) <= 1.0 + 1e-9
}

/// Indices of a move and of the neighbours that it is joined to.
type Window = ArrayVec<usize, 3>;

/// The window around `center`, across moves of no length.
fn range(slots: &VecDeque<Slot>, center: usize) -> Window {
    let mut window = Window::new();
    let before = slots.iter().take(center).rposition(|slot| !slot.rider);
    window.extend(before.filter(|before| slots[*before].joined));
    window.push(center);
    let behind = (center + 1..slots.len()).find(|index| !slots[*index].rider);
    window.extend(behind.filter(|_| slots[center].joined));
    window
}

fn slot_levers(solver: &Solver<'_>, slot: &Slot) -> Levers {
    levers(solver.machine, solver.how, &slot.mv, &slot.permit)
}

/// Blended moves are lowered by F, also a rapid written as a feed.
fn speed_lever(levers: Levers) -> Option<SpeedLever> {
    levers
        .speed
        .filter(|lever| !matches!(lever, SpeedLever::RapidPercent(_)))
}

/// Largest speeds and accelerations over a window.
fn envelope<'a>(
    parts: impl Iterator<Item = (SpeedBound, &'a AxisValues)>,
) -> (SpeedBound, AxisValues) {
    let mut bound = SpeedBound::default();
    let mut accel = [0.0_f64; AXES];
    for (part, part_accel) in parts {
        bound.include(&part);
        for axis in 0..AXES {
            accel[axis] = accel[axis].max(part_accel[axis]);
        }
    }
    (bound, accel)
}

fn own_bound(solver: &Solver<'_>, slot: &Slot) -> SpeedBound {
    blended_bound(solver.machine, &slot.changed, solver.largest)
}

/// Load ratio of the window; of several sets of switched loads the largest.
fn load(solver: &Solver<'_>, slots: &VecDeque<Slot>, range: &Window) -> f64 {
    let parts = range.iter().copied().map(|index| {
        (
            own_bound(solver, &slots[index]),
            &slots[index].changed.accel_mm_s2,
        )
    });
    let (bound, accel) = envelope(parts);
    window_load(solver, slots, range, &bound, &accel)
}

fn window_load(
    solver: &Solver<'_>,
    slots: &VecDeque<Slot>,
    range: &Window,
    bound: &SpeedBound,
    accel: &AxisValues,
) -> f64 {
    range
        .iter()
        .copied()
        .map(|index| {
            solver
                .model
                .robust(&slots[index].mv, bound, accel)
                .load_ratio
        })
        .fold(0.0, f64::max)
}

/// Lowers the axis speeds of the window to a common cap.
fn lower_speed(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    range: &Window,
    found: &[Levers],
) -> bool {
    let bounds: Vec<SpeedBound> = range
        .iter()
        .copied()
        .map(|index| own_bound(solver, &slots[index]))
        .collect();
    let accels: Vec<AxisValues> = range
        .iter()
        .copied()
        .map(|index| slots[index].changed.accel_mm_s2)
        .collect();
    let adjustable: Vec<bool> = found
        .iter()
        .map(|levers| speed_lever(*levers).is_some())
        .collect();
    let (top, accel) = envelope(bounds.iter().copied().zip(accels.iter()));
    let factors = |cap: f64| -> Vec<f64> {
        bounds
            .iter()
            .zip(&adjustable)
            .map(|(bound, adjustable)| {
                if *adjustable {
                    factor(bound, &top, cap)
                } else {
                    1.0
                }
            })
            .collect()
    };
    let load_at = |cap: f64| {
        let scaled = bounds
            .iter()
            .zip(factors(cap))
            .map(|(bound, factor)| (scale(bound, factor), &accel));
        window_load(solver, slots, range, &envelope(scaled).0, &accel)
    };
    let Some(cap) = largest(1.0, load_at(1.0), load_at) else {
        return false;
    };
    for ((index, factor), levers) in range.iter().copied().zip(factors(cap)).zip(found) {
        if factor < 1.0
            && let Some(lever) = speed_lever(*levers)
            && !lower_feed(solver, &mut slots[index], lever, factor)
        {
            return false;
        }
    }
    load(solver, slots, range) <= 1.0 + 1e-9
}

/// The share of its speed at which a move stays under the cap on every axis.
fn factor(bound: &SpeedBound, top: &SpeedBound, cap: f64) -> f64 {
    let mut factor = 1.0_f64;
    for axis in 0..AXES {
        let largest = top.positive[axis].max(top.negative[axis]);
        let own = bound.positive[axis].max(bound.negative[axis]);
        if own > 0.0 {
            factor = factor.min(cap * largest / own);
        }
    }
    factor
}

fn scale(bound: &SpeedBound, factor: f64) -> SpeedBound {
    SpeedBound {
        positive: bound.positive.map(|speed| speed * factor),
        negative: bound.negative.map(|speed| speed * factor),
    }
}

/// Sets the F of one move to a share of the speed that it has now.
fn lower_feed(solver: &Solver<'_>, slot: &mut Slot, lever: SpeedLever, factor: f64) -> bool {
    let speed_mm_s = if slot.mv.unknown_start.is_empty() {
        blended_speed(solver.machine, &slot.changed, solver.largest)
    } else {
        slot.changed.feed_mm_s.min(1e6) * solver.largest.feed
    };
    let unit = feed_unit(solver.machine, &slot.mv, &slot.permit);
    let feed =
        round_feed_down(speed_mm_s * factor / solver.largest.feed * SECONDS_PER_MINUTE / unit);
    if !(feed > 0.0 && feed.is_finite()) {
        return false;
    }
    let change = Change {
        feed: Some(feed),
        as_feed: lever == SpeedLever::AsFeed,
        ..slot.change
    };
    let case = Case {
        mv: &slot.mv,
        assessment: &slot.assessment,
        permit: &slot.permit,
    };
    if let Err(obstacle) = solver.respect_floor(case, &change) {
        slot.obstacle = Some(obstacle);
        return false;
    }
    slot.changed = change.apply(solver.machine, &slot.mv, &slot.permit);
    slot.change = change;
    true
}

/// Lowers the accelerations of the window by a common factor.
fn lower_accel(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    range: &Window,
    found: &[Levers],
) -> bool {
    let parts = range.iter().copied().map(|index| {
        (
            own_bound(solver, &slots[index]),
            &slots[index].changed.accel_mm_s2,
        )
    });
    let (bound, top) = envelope(parts);
    let accels: Vec<AxisValues> = range
        .iter()
        .copied()
        .map(|index| slots[index].changed.accel_mm_s2)
        .collect();
    let lowered = |cap: f64| -> Vec<AxisValues> {
        accels
            .iter()
            .zip(found)
            .map(|(accel, levers)| match levers.accel {
                Some(_) => std::array::from_fn(|axis| accel[axis].min(cap * top[axis])),
                None => *accel,
            })
            .collect()
    };
    let load_at = |cap: f64| {
        let accels = lowered(cap);
        let (_, accel) = envelope(accels.iter().map(|accel| (SpeedBound::default(), accel)));
        window_load(solver, slots, range, &bound, &accel)
    };
    let Some(cap) = largest(1.0, load_at(1.0), load_at) else {
        return false;
    };
    for ((index, accel), levers) in range.iter().copied().zip(lowered(cap)).zip(found) {
        if let Some(knob) = levers.accel
            && accel != slots[index].changed.accel_mm_s2
            && !set_accel(solver, &mut slots[index], knob, &accel)
        {
            return false;
        }
    }
    load(solver, slots, range) <= 1.0 + 1e-9
}

fn set_accel(solver: &Solver<'_>, slot: &mut Slot, knob: usize, accel: &AxisValues) -> bool {
    let Some(values) = solver.knob_values(knob, accel, &slot.permit) else {
        return false;
    };
    slot.change.accel = Some((knob, values));
    slot.changed = slot.change.apply(solver.machine, &slot.mv, &slot.permit);
    true
}

/// Lowers acceleration, and speed too if that is faster or the only way.
fn faster_of_both(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    range: &Window,
    found: &[Levers],
    by_speed: bool,
) -> bool {
    let save = |slots: &VecDeque<Slot>| -> Vec<Slot> {
        range.iter().map(|index| slots[*index].clone()).collect()
    };
    let restore = |slots: &mut VecDeque<Slot>, saved: Vec<Slot>| {
        for (index, slot) in range.iter().zip(saved) {
            slots[*index] = slot;
        }
    };
    let before = save(slots);
    let accel_done = lower_accel(solver, slots, range, found);
    if !by_speed {
        return accel_done;
    }
    let accel_time = if accel_done {
        time(solver, slots, range)
    } else {
        f64::INFINITY
    };
    let by_accel = save(slots);
    restore(slots, before.clone());
    let speed_done = lower_speed(solver, slots, range, found);
    if speed_done && time(solver, slots, range) < accel_time {
        return true;
    }
    restore(slots, if accel_done { by_accel } else { before });
    accel_done
}

/// Time of the window's moves with a stop at each, s.
fn time(solver: &Solver<'_>, slots: &VecDeque<Slot>, range: &Window) -> f64 {
    range
        .iter()
        .copied()
        .map(|index| plan(solver.machine, &slots[index].changed, solver.largest).duration_s)
        .sum()
}

/// Why a blended move could not be brought down.
fn obstacle(solver: &Solver<'_>, case: Case<'_>) -> Obstacle {
    match solver.solve(case.mv, case.assessment, case.permit) {
        Err(obstacle) if obstacle.rule != "no-solution" => obstacle,
        _ => Obstacle::new(
            "no-solution",
            "no value of the permitted words brings this block and its neighbours down to the limit",
            "--allow feed, a word for acceleration, or path.mode = \"exact-stop\" if the machine stops at every block",
        ),
    }
}
