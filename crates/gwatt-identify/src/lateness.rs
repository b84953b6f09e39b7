//! How much later a force acts than it was recorded. A drive that samples reads the position,
//! computes the force, and holds it until the next sample: on average it acts half a period
//! after the time that stands next to it, a whole one more where it is given out with the next
//! sample. Left alone that takes mass times jerk for viscous friction.

use nalgebra::DVector;

use super::certainty;
use super::effects::{self, Found};
use super::equations::Equations;
use super::figure::Figure;
use super::filter::derivative;
use super::friction::{Friction, Solved, Terms, predicted, solve, solve_best};

/// What is later than that, in samples, has another cause than a drive that samples.
const SAMPLES: f64 = 1.6;
/// By which share the errors of prediction fall at least.
const BETTER: f64 = 0.02;
/// Rounds: the second sees what the first, by slopes, left.
const ROUNDS: usize = 2;

/// How much of the mass, or of viscous friction, a lateness changes that is more than little.
const OTHER_MASS: f64 = 0.01;
const OTHER_FRICTION: f64 = 0.1;

/// By how much forces act later than recorded, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Late {
    /// Not, as far as the recordings show.
    Not,
    /// So much, as a drive that samples makes of it.
    By(Figure),
    /// More than that.
    OutOfStep(Figure),
}

impl Late {
    /// By how much forces were taken later.
    pub(super) fn by_s(self) -> Option<Figure> {
        match self {
            Self::By(figure) => Some(figure),
            Self::Not | Self::OutOfStep(_) => None,
        }
    }

    /// By how much they are too late or too early.
    pub(super) fn out_of_step_s(self) -> Option<Figure> {
        match self {
            Self::OutOfStep(figure) => Some(figure),
            Self::Not | Self::By(_) => None,
        }
    }
}

/// What was found, and by how much forces act later than recorded.
type Fitted = (Found, Late);

/// How the force changes with time where it accelerates, but for the mass.
fn jerk(equations: &Equations) -> Vec<f64> {
    derivative(&equations.raw.acceleration, equations.raw.period_s)
}

fn with_jerk(all: &[Equations]) -> Vec<Equations> {
    let mut wider = all.to_vec();
    for equations in &mut wider {
        equations.above = None;
        let column = jerk(equations);
        equations.add(&column);
    }
    wider
}

/// The lateness by the slope of the force.
fn by_slope(wider: &[Equations], terms: Terms) -> Option<Figure> {
    let joint = solve(wider, terms)?;
    let (mass, by_jerk) = (joint.theta.first()?, joint.theta.last()?);
    let last = joint.theta.len() - 1;
    let figure = Figure {
        value: by_jerk / mass,
        std: joint.covariance[(last, last)].max(0.0).sqrt() / mass.abs(),
    };
    (figure.value.is_finite() && figure.std.is_finite()).then_some(figure)
}

/// A signal so much later: cubics through four samples (Lagrange).
fn later(x: &[f64], by_s: f64, period_s: f64) -> Vec<f64> {
    let whole = libm::floor(by_s / period_s);
    let part = by_s / period_s - whole;
    let last = i64::try_from(x.len().saturating_sub(1)).unwrap_or(i64::MAX);
    let at = |k: i64| {
        let k = (k - whole as i64).clamp(0, last);
        usize::try_from(k).ok().and_then(|k| x.get(k)).copied()
    };
    // Between the sample before last, the last, this one and the next, from this one back.
    let weights = [
        -part * (1.0 - part) * (2.0 - part) / 6.0,
        (1.0 + part) * (1.0 - part) * (2.0 - part) / 2.0,
        (1.0 + part) * part * (2.0 - part) / 2.0,
        -(1.0 + part) * part * (1.0 - part) / 6.0,
    ];
    (0..=last)
        .take(x.len())
        .map(|k| {
            let each = weights.iter().zip([k + 1, k, k - 1, k - 2]);
            each.map(|(w, k)| w * at(k).unwrap_or_default()).sum()
        })
        .collect()
}

/// Takes forces as so much later.
pub(super) fn delay(equations: &mut Equations, by_s: f64) {
    let force = later(&equations.raw.force, by_s, equations.raw.period_s);
    equations.replace_force(force);
}

/// The fit with forces as late as the recordings show, where that is clear, predicts better, and
/// is no more than a drive that samples takes. Effects that the recordings have are part of both.
pub(super) fn fitted(all: &[Equations], asked: Option<Friction>, solved: &Solved) -> Fitted {
    let found = effects::found(all, asked, solved);
    let (late, by) = late(all, asked, &found);
    match (late, by) {
        (Some(mut late), Late::By(lateness_s)) => {
            widen(&late.all, &mut late.solved, lateness_s);
            (late, by)
        }
        _ => (found, by),
    }
}

fn late(all: &[Equations], asked: Option<Friction>, found: &Found) -> (Option<Found>, Late) {
    // Without a speed viscous friction would pass for it; a force that stands at its largest
    // value is looked at sample by sample.
    let is_plain = |it: &Equations| it.inside.speeds.is_some() && it.raw.cut_off.is_none();
    if found.saturation.is_some() || !all.iter().all(is_plain) {
        return (None, Late::Not);
    }
    let periods = all.iter().map(|it| it.raw.period_s);
    let most_s = SAMPLES * periods.fold(f64::INFINITY, f64::min);
    let mut late: Option<(Found, Figure)> = None;
    for _ in 0..ROUNDS {
        let (now, so_far_s) = match &late {
            Some((late, lateness_s)) => (late, lateness_s.value),
            None => (found, 0.0),
        };
        let Some(by) = further(now, late.is_none()) else {
            return (None, Late::Not);
        };
        let lateness_s = Figure {
            value: so_far_s + by.value,
            std: by.std,
        };
        let Some((moved, solved)) = moved(all, asked, lateness_s.value) else {
            return (None, Late::Not);
        };
        if lateness_s.value.abs() > most_s {
            let is_other = differ(&found.solved, &solved);
            let is_late = if is_other {
                Late::OutOfStep(lateness_s)
            } else {
                Late::Not
            };
            return (None, is_late);
        }
        late = Some((effects::found(&moved, asked, &solved), lateness_s));
    }
    late.map_or((None, Late::Not), |(late, by)| (Some(late), Late::By(by)))
}

/// By how much later than they are taken forces act; where it `must_show`, only if that is clear
/// and predicts better.
fn further(now: &Found, must_show: bool) -> Option<Figure> {
    let terms = now.solved.terms;
    let wider = with_jerk(&now.all);
    let by = by_slope(&wider, terms)?;
    let predicts = || {
        let before = predicted(&now.all, terms, 1)?;
        Some(predicted(&wider, terms, 1)? < (1.0 - BETTER) * before)
    };
    let shows = !must_show || by.value.abs() > certainty::LATENESS * by.std && predicts()?;
    shows.then_some(by)
}

/// The equations with forces so much later, and their solution.
fn moved(
    all: &[Equations],
    asked: Option<Friction>,
    lateness_s: f64,
) -> Option<(Vec<Equations>, Solved)> {
    let mut moved = all.to_vec();
    for equations in &mut moved {
        delay(equations, lateness_s);
    }
    let solved = solve_best(&mut moved, asked)?;
    Some((moved, solved))
}

/// Whether mass or viscous friction are others, for sure and by more than little.
fn differ(one: &Solved, other: &Solved) -> bool {
    let mass = |solved: &Solved| solved.theta.first().copied().unwrap_or_default();
    let viscous = |solved: &Solved| {
        let friction = solved.terms.friction_in(&solved.theta);
        friction.map_or(0.0, |[viscous, _]| viscous)
    };
    let std = |at: usize| one.covariance[(at, at)].max(0.0).sqrt();
    let is_other = |a: f64, b: f64, std: f64, share: f64| {
        let apart = (a - b).abs();
        apart > certainty::SIGN * std && apart > share * a.abs().max(b.abs())
    };
    is_other(mass(one), mass(other), std(0), OTHER_MASS)
        || is_other(viscous(one), viscous(other), std(1), OTHER_FRICTION)
}

/// Widens the errors of a solution by what the lateness leaves unknown.
fn widen(all: &[Equations], solved: &mut Solved, lateness_s: Figure) {
    let mut slopes = all.to_vec();
    for equations in &mut slopes {
        equations.inside.force = equations.in_band(&jerk(equations));
    }
    let Some(slope) = solve(&slopes, solved.terms) else {
        return;
    };
    let mass = solved.theta.first().copied().unwrap_or_default();
    let by = DVector::from_vec(slope.theta) * (mass * lateness_s.std);
    if by.len() == solved.covariance.nrows() {
        solved.covariance += &by * by.transpose();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cubics are exact for cubics, by parts of a sample and by whole ones.
    #[test]
    fn a_cubic_is_late_by_what_was_asked() {
        let cubic = |t: f64| 1.0 + t - 0.3 * t * t + 0.02 * t * t * t;
        let x: Vec<f64> = (0..40).map(|k| cubic(0.1 * f64::from(k))).collect();
        for by_s in [0.0, 0.05, 0.1, 0.13, -0.07, -0.15] {
            let moved = later(&x, by_s, 0.1);
            assert_eq!(moved.len(), x.len());
            for (k, found) in (0_u32..).zip(moved).skip(4).take(32) {
                let expected = cubic(0.1 * f64::from(k) - by_s);
                assert!((found - expected).abs() < 1e-9, "{by_s} {k}");
            }
        }
        assert!(later(&[], 0.1, 0.1).is_empty());
    }
}
