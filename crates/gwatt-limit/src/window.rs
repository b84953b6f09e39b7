//! A blended move and its neighbours: lowered together until the robust bound
//! over the three fits.
//!
//! The bound grows with every speed and acceleration, so lowering a move for
//! one window never harms another.

use super::members::{Member, Window, change, put};
use std::collections::VecDeque;

use arrayvec::ArrayVec;

use super::bounds::{envelope, factor, path_speed, scale};
use super::case::{Case, Ends};
use super::change::{Change, Permit};
use super::law;
use super::level;
use super::lever::{Levers, Obstacle, SpeedLever, levers};
use super::options::{Law, Strategy};
use super::root::largest;
use super::slot::{Outcome, Slot};
use super::solver::Solver;
use gwatt_machine::AxisValues;
use gwatt_motion::Move;
use gwatt_plan::{SpeedBound, blended_bound, plan};

/// Lowers a window if it does not fit.
pub(super) fn lower(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    center: usize,
) {
    if load(solver, slots, window) <= 1.0 + 1e-9 {
        return;
    }
    let found: Vec<Levers> = window
        .iter()
        .map(|member| levers_joined(solver, member.mv, &member.permit))
        .collect();
    let by_speed = || found.iter().any(|levers| levers.speed.is_some());
    let accel = |levers: &Levers| levers.accel_word(solver.machine);
    let by_accel = || found.iter().any(|levers| accel(levers).is_some());
    let by_rule = solver.how.strategy == Strategy::Preset || solver.how.law == Law::Patent;
    let done = match solver.how.strategy {
        _ if by_rule => by_law(solver, slots, window, &found),
        Strategy::Accel => by_accel() && lower_accel(solver, slots, window, &found),
        Strategy::Optimal | Strategy::Split if by_accel() => {
            faster_of_both(solver, slots, window, &found, by_speed())
        }
        _ => by_speed() && lower_speed(solver, slots, window, &found),
    };
    if !done && let Some(member) = window.iter().find(|member| member.index == center) {
        let obstacle = obstacle(solver, member.case(slots));
        slots[center].outcome.obstacle = Some(Box::new(obstacle));
    }
}

/// What may be used to bring a move down that runs into others.
fn levers_joined(solver: &Solver<'_>, mv: &Move, permit: &Permit) -> Levers {
    // No knob for which the axes stand.
    let permit = Permit {
        stands: false,
        rests: false,
        line_before: false,
        ..*permit
    };
    let mut found = levers(solver.machine, solver.how, mv, &permit);
    // The bound knows of limits of the axes alone.
    let by_axis = |knob: &usize| solver.along_path(*knob, mv).is_none();
    found.accel = found.accel.filter(by_axis);
    found
}

/// Gives a move that has just come what preset or law say for it, whether it fits or not.
pub(super) fn put_anyway(solver: &Solver<'_>, slot: &mut Slot, mv: &Move, permit: &Permit) {
    let case = Case {
        mv,
        assessment: &slot.assessment,
        permit,
        ends: Ends::Rest,
        exact_stop: false,
    };
    slot.outcome = Outcome::anyway(solver.anyway(case, &levers_joined(solver, mv, permit)));
    let change = slot.outcome.change.as_deref();
    slot.changed = change.map(|change| Box::new(change.apply(solver.machine, mv, permit)));
}

/// Gives each move of the window what preset or law say for it alone; where that is asked
/// for, those without a preset the speed that is left.
fn by_law(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    found: &[Levers],
) -> bool {
    for (member, levers) in window.iter().zip(found) {
        let case = member.case(slots);
        let change = match solver.how.strategy {
            Strategy::Preset => law::preset(solver, case, levers),
            strategy => law::squared_ratio(solver, case, levers, strategy),
        };
        // A neighbour for which there is none may fit as it is.
        if let Ok(change) = change {
            if let Err(obstacle) = solver.respect_floor(case, &change) {
                slots[member.index].outcome.obstacle = Some(Box::new(obstacle));
                return false;
            }
            put(solver, slots, member, change);
        }
    }
    if load(solver, slots, window) <= 1.0 + 1e-9 {
        return true;
    }
    let others = window.iter().zip(found).map(|(member, levers)| {
        let falls_back = solver.falls_back(member.mv);
        if falls_back {
            levers.clone()
        } else {
            Levers::default()
        }
    });
    let others: Vec<Levers> = others.collect();
    let by_speed = others.iter().any(|levers| levers.speed.is_some());
    by_speed && lower_speed(solver, slots, window, &others)
}

/// Indices of the window around `center`, across moves of no length.
pub(crate) fn indices(slots: &VecDeque<Slot>, center: usize) -> ArrayVec<usize, 3> {
    let mut window = ArrayVec::new();
    let before = slots.iter().take(center).rposition(|slot| !slot.rider);
    window.extend(before.filter(|before| slots[*before].joined));
    window.push(center);
    let after = (center + 1..slots.len()).find(|index| !slots[*index].rider);
    window.extend(after.filter(|_| slots[center].joined));
    window
}

fn own_bound(solver: &Solver<'_>, slots: &VecDeque<Slot>, member: &Member<'_>) -> SpeedBound {
    blended_bound(solver.machine, member.changed(slots), solver.largest)
}

/// Load ratio of the window; of several sets of switched loads the largest.
fn load(solver: &Solver<'_>, slots: &VecDeque<Slot>, window: &Window<'_>) -> f64 {
    let parts = window.iter().map(|member| {
        (
            own_bound(solver, slots, member),
            &member.changed(slots).accel_mm_s2,
        )
    });
    let (bound, accel) = envelope(parts);
    window_load(solver, slots, window, &bound, &accel)
}

fn window_load(
    solver: &Solver<'_>,
    slots: &VecDeque<Slot>,
    window: &Window<'_>,
    bound: &SpeedBound,
    accel: &AxisValues,
) -> f64 {
    window
        .iter()
        .map(|member| {
            let demand = solver.model.robust(member.mv, bound, accel);
            let share = &slots[member.index].assessment.spindle;
            solver
                .model
                .load_with_spindle(&demand, share, path_speed(bound))
        })
        .fold(0.0, f64::max)
}

/// How often speeds are lowered again: where F does not speak for all axes of a move from an
/// unknown place, the others keep theirs.
const ROUNDS: u32 = 8;
/// What each further round aims below the limit.
const AIM_BELOW: f64 = 1e-3;

/// Lowers the axis speeds of the window to a common cap.
fn lower_speed(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    found: &[Levers],
) -> bool {
    for round in 0..ROUNDS {
        let aim = 1.0 - AIM_BELOW * f64::from(round);
        if !scale_speeds(solver, slots, window, found, aim) {
            return false;
        }
        if load(solver, slots, window) <= 1.0 + 1e-9 {
            return true;
        }
    }
    false
}

/// Lowers them as if all of them went down with the words, to `aim` times the limit; whether
/// words say that.
fn scale_speeds(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    found: &[Levers],
    aim: f64,
) -> bool {
    let bounds: Vec<SpeedBound> = window
        .iter()
        .map(|member| own_bound(solver, slots, member))
        .collect();
    let accels: Vec<AxisValues> = window
        .iter()
        .map(|member| member.changed(slots).accel_mm_s2)
        .collect();
    let adjustable: Vec<bool> = found.iter().map(|levers| levers.speed.is_some()).collect();
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
        window_load(solver, slots, window, &envelope(scaled).0, &accel) / aim
    };
    let Some(cap) = largest(1.0, load_at(1.0), load_at) else {
        return false;
    };
    for ((member, factor), levers) in window.iter().zip(factors(cap)).zip(found) {
        if factor < 1.0
            && let Some(lever) = levers.speed
            && !lower_one(solver, slots, member, lever, factor)
        {
            return false;
        }
    }
    true
}

/// Lowers the speed of one move to a share of what it has now.
fn lower_one(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    member: &Member<'_>,
    lever: SpeedLever,
    factor: f64,
) -> bool {
    let before = change(slots, member);
    let Some(change) = solver.slowed(member.case(slots), lever, &before, factor) else {
        return false;
    };
    if let Err(obstacle) = solver.respect_floor(member.case(slots), &change) {
        slots[member.index].outcome.obstacle = Some(Box::new(obstacle));
        return false;
    }
    put(solver, slots, member, change);
    true
}

/// Lowers the accelerations of the window by a common factor.
fn lower_accel(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    found: &[Levers],
) -> bool {
    let parts = window.iter().map(|member| {
        (
            own_bound(solver, slots, member),
            &member.changed(slots).accel_mm_s2,
        )
    });
    let (bound, top) = envelope(parts);
    let accels: Vec<AxisValues> = window
        .iter()
        .map(|member| member.changed(slots).accel_mm_s2)
        .collect();
    let lowered = |cap: f64| -> Vec<AxisValues> {
        accels
            .iter()
            .zip(found)
            .map(|(accel, levers)| match levers.accel_word(solver.machine) {
                Some(_) => std::array::from_fn(|axis| accel[axis].min(cap * top[axis])),
                None => *accel,
            })
            .collect()
    };
    let load_at = |cap: f64| {
        let accels = lowered(cap);
        let (_, accel) = envelope(accels.iter().map(|accel| (SpeedBound::default(), accel)));
        window_load(solver, slots, window, &bound, &accel)
    };
    let Some(cap) = largest(1.0, load_at(1.0), load_at) else {
        return false;
    };
    for ((member, accel), levers) in window.iter().zip(lowered(cap)).zip(found) {
        if let Some(knob) = levers.accel_word(solver.machine)
            && accel != member.changed(slots).accel_mm_s2
            && !set_accel(solver, slots, member, knob, &accel)
        {
            return false;
        }
    }
    load(solver, slots, window) <= 1.0 + 1e-9
}

fn set_accel(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    member: &Member<'_>,
    knob: usize,
    accel: &AxisValues,
) -> bool {
    let Some(values) = solver.knob_values(knob, accel, &member.permit) else {
        return false;
    };
    let change = Change {
        accel: Some((knob, values)),
        ..change(slots, member)
    };
    put(solver, slots, member, change);
    true
}

/// Lowers acceleration, and speed too if that is faster or the only way.
fn faster_of_both(
    solver: &Solver<'_>,
    slots: &mut VecDeque<Slot>,
    window: &Window<'_>,
    found: &[Levers],
    by_speed: bool,
) -> bool {
    let save = |slots: &VecDeque<Slot>| -> Vec<Slot> {
        let saved = window.iter().map(|member| slots[member.index].clone());
        saved.collect()
    };
    let restore = |slots: &mut VecDeque<Slot>, saved: Vec<Slot>| {
        for (member, slot) in window.iter().zip(saved) {
            slots[member.index] = slot;
        }
    };
    let before = save(slots);
    let accel_done = lower_accel(solver, slots, window, found);
    if !by_speed {
        return accel_done;
    }
    let accel_time = if accel_done {
        time(solver, slots, window)
    } else {
        f64::INFINITY
    };
    let by_accel = save(slots);
    restore(slots, before.clone());
    let speed_done = lower_speed(solver, slots, window, found);
    let speed_time = if speed_done {
        time(solver, slots, window)
    } else {
        f64::INFINITY
    };
    let (mut best, mut best_time) = (accel_done.then_some(by_accel), accel_time);
    if speed_time < accel_time {
        (best, best_time) = (Some(save(slots)), speed_time);
    }
    // A level that is not gentle enough by itself leaves more speed than none.
    for depth in 1..level::DEEPEST {
        restore(slots, before.clone());
        if !level::step_down(solver, slots, window, found, depth) {
            break;
        }
        if lower_speed(solver, slots, window, found) {
            let lasts = time(solver, slots, window);
            if lasts < best_time * (1.0 - 1e-6) {
                (best, best_time) = (Some(save(slots)), lasts);
            }
        }
    }
    let done = best.is_some();
    restore(slots, best.unwrap_or(before));
    done
}

/// Time of the window's moves with a stop at each, s.
fn time(solver: &Solver<'_>, slots: &VecDeque<Slot>, window: &Window<'_>) -> f64 {
    window
        .iter()
        .map(|member| plan(solver.machine, member.changed(slots), solver.largest).duration_s)
        .sum()
}

/// Why a blended move could not be brought down.
fn obstacle(solver: &Solver<'_>, case: Case<'_>) -> Obstacle {
    match solver.solve(case.mv, case.assessment, case.permit, Ends::Rest) {
        Err(obstacle) if obstacle.rule != "no-solution" => obstacle,
        _ => solver.no_value_for_all(case),
    }
}
