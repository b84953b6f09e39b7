//! Speed and acceleration, or speed and jerk, together: the pair with the shortest time.
//!
//! For each acceleration there is one highest speed that fits, and the time of
//! the block has one minimum between the pair with full acceleration and the
//! one with full speed (for a trapezoid: minimise L/v + v/a under the limit).
//! An arc may have several, since its speed decides what is left to accelerate
//! with: the search begins next to the best of a few. A word for the jerk takes the place of
//! the acceleration in the same way; both at once bring nothing more that is worth a word.

use super::case::Case;
use super::change::Change;
use super::lever::{Levers, SpeedLever};
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
/// What another word must bring in, as a share of the time.
const SOONER: f64 = 1e-6;
/// The same where a rapid becomes a feed by it.
const SOONER_AS_FEED: f64 = 1e-3;

/// What makes a move gentler at the speed that it has: the index of a knob.
#[derive(Debug, Clone, Copy)]
enum Gentler {
    Accel(usize),
    Jerk(usize),
}

impl Gentler {
    /// At a share of what is in force.
    fn at(self, solver: &Solver<'_>, case: Case<'_>, share: f64) -> Option<Change> {
        match self {
            Self::Accel(knob) => solver.accel_change(case, knob, share, &Change::NONE),
            Self::Jerk(knob) => solver.jerk_change(case, knob, share),
        }
    }

    /// By itself, as far as the move needs it.
    fn alone(self, solver: &Solver<'_>, case: Case<'_>) -> Option<Change> {
        match self {
            Self::Accel(knob) => solver.accel_alone(case, knob),
            Self::Jerk(knob) => solver.jerk_alone(case, knob),
        }
    }

    /// The share that the move needs without a lower speed.
    fn share_alone(self, solver: &Solver<'_>, case: Case<'_>) -> Option<f64> {
        match self {
            Self::Accel(knob) => {
                let change = solver.accel(case, knob, &Change::NONE)?;
                solver.accel_share(case, knob, &change)
            }
            Self::Jerk(knob) => {
                let change = solver.jerk_alone(case, knob)?;
                let changed = change.apply(solver.machine, case.mv, case.permit);
                Some(changed.jerk_factor / case.mv.jerk_factor)
            }
        }
    }
}

/// The fastest speed with an acceleration, or with a jerk, that fits.
pub(super) fn best_pair(
    solver: &Solver<'_>,
    case: Case<'_>,
    speed: SpeedLever,
    levers: &Levers,
) -> Option<Change> {
    let by_accel = levers.accel.map(Gentler::Accel);
    let by_jerk = levers.jerk.map(Gentler::Jerk);
    let pairs = by_accel.into_iter().chain(by_jerk);
    let pairs = pairs.filter_map(|gentler| pair_with(solver, case, speed, gentler));
    pairs.reduce(|first, other| {
        if time_s(solver, case, &other) < time_s(solver, case, &first) * (1.0 - SOONER) {
            other
        } else {
            first
        }
    })
}

/// How long a move takes with a change; infinite where it does not fit.
fn time_s(solver: &Solver<'_>, case: Case<'_>, change: &Change) -> f64 {
    let changed = change.apply(solver.machine, case.mv, case.permit);
    if solver.load(case, &changed) <= 1.0 + 1e-9 {
        plan(solver.machine, &changed, solver.largest).duration_s + solver.stands_s(change)
    } else {
        f64::INFINITY
    }
}

/// The fastest pair of a speed and one of these.
fn pair_with(
    solver: &Solver<'_>,
    case: Case<'_>,
    speed: SpeedLever,
    gentler: Gentler,
) -> Option<Change> {
    let time = |change: &Change| time_s(solver, case, change);
    let pair = |share: f64| {
        let with = gentler.at(solver, case, share)?;
        solver.speed(case, speed, &with)
    };
    let time_of = |share: f64| pair(share).map_or(f64::INFINITY, |change| time(&change));

    let mut low = gentler
        .share_alone(solver, case)
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
        gentler.alone(solver, case),
        solver.speed(case, speed, &Change::NONE),
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
                SOONER_AS_FEED
            } else {
                SOONER
            };
            let sooner = time(&both) < time(&single) * (1.0 - gain);
            Some(if sooner { both } else { single })
        }
        (single, both) => single.or(both),
    }
}
