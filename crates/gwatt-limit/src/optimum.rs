//! Speed and acceleration together: the pair with the shortest time.
//!
//! For each acceleration there is one highest speed that fits, and the time of
//! the block has one minimum between the pair with full acceleration and the
//! one with full speed (for a trapezoid: minimise L/v + v/a under the limit).
//! An arc may have several, since its speed decides what is left to accelerate
//! with: the search begins next to the best of a few.

use super::case::Case;
use super::change::Change;
use super::lever::SpeedLever;
use super::solver::Solver;
use gwatt_plan::plan;

/// Steps of the search; each narrows the bracket to 0.618.
const STEPS: u32 = 24;
/// Parts of the range that are looked at first on an arc.
const ARC_STEPS: u32 = 12;
/// The golden section.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Lowest acceleration that is tried, as a share.
const LOWEST: f64 = 0.01;

/// The fastest pair of speed and acceleration that fits.
pub(super) fn best_pair(
    solver: &Solver<'_>,
    case: Case<'_>,
    speed: SpeedLever,
    accel: usize,
) -> Option<Change> {
    let none = Change::default();
    let time = |change: &Change| {
        let changed = change.apply(solver.machine, case.mv, case.permit);
        if solver.load(case, &changed) <= 1.0 + 1e-9 {
            plan(solver.machine, &changed, solver.largest).duration_s + solver.stands_s(change)
        } else {
            f64::INFINITY
        }
    };
    let pair = |factor: f64| {
        let with = solver.accel_change(case, accel, factor, &none)?;
        solver.speed(case, speed, &with)
    };
    let time_of = |factor: f64| pair(factor).map_or(f64::INFINITY, |change| time(&change));

    let by_accel = solver.accel(case, accel, &none);
    let mut low = by_accel
        .and_then(|change| solver.accel_share(case, accel, &change))
        .unwrap_or(LOWEST)
        .clamp(LOWEST, 1.0);
    let mut high = 1.0;
    if case.mv.arc.is_some() {
        let at = |step: u32| low + (high - low) * f64::from(step) / f64::from(ARC_STEPS);
        let best = (0..=ARC_STEPS)
            .map(|step| (step, time_of(at(step))))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((step, _)) = best {
            (low, high) = (at(step.saturating_sub(1)), at((step + 1).min(ARC_STEPS)));
        }
    }
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut time_left, mut time_right) = (time_of(left), time_of(right));
    for _ in 0..STEPS {
        if time_left <= time_right {
            (high, right, time_right) = (right, left, time_left);
            left = high - GOLDEN * (high - low);
            time_left = time_of(left);
        } else {
            (low, left, time_left) = (left, right, time_right);
            right = low + GOLDEN * (high - low);
            time_right = time_of(right);
        }
    }
    // Fewer words are better where they cost no time.
    let single = [
        solver.accel_alone(case, accel),
        solver.speed(case, speed, &none),
    ];
    let best_single = single
        .into_iter()
        .flatten()
        .min_by(|a, b| time(a).total_cmp(&time(b)));
    let both = pair(f64::midpoint(low, high));
    match (best_single, both) {
        (Some(single), Some(both)) => {
            // A rapid stays one where a feed gains next to nothing.
            let gain = if both.as_feed && !single.as_feed {
                1e-3
            } else {
                1e-6
            };
            let sooner = time(&both) < time(&single) * (1.0 - gain);
            Some(if sooner { both } else { single })
        }
        (single, both) => single.or(both),
    }
}
