//! Forces that end at a largest value: in the recording, or in the drive alone.

use nalgebra::DVector;

use super::super::equations::{Equations, sign};
use super::super::friction::{Friction, Solved, counted_rows, solve_best};
use super::effect::Saturation;
use super::search::{left_share, share};
use crate::certainty;

/// Limits that are tried, as shares of the samples below them.
const BELOW: [f64; 14] = [
    0.3, 0.4, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.84, 0.88, 0.92, 0.95, 0.97, 0.985,
];
/// By which factor the error falls at least where there is a limit.
const BETTER: f64 = 0.6;
/// Rounds of a finer search, each between half of the distance.
const ROUNDS: usize = 5;
/// What accelerates the axis is so many times as large as what is left, at least: a force that
/// is cut off near friction is explained by friction alone, whatever it was.
const ACCELERATES: f64 = 2.0;
/// What is missing at the limit is such a share of it at least, where the motion shows more
/// than was recorded.
const MISSING: f64 = 0.03;

/// Equations by which a mass is known next to a force that stands, at least.
const ROWS_MIN: usize = 50;
/// Where more than this share of the force is left, the motion does not agree with it.
const EXPLAINED: f64 = 0.25;

/// The force with all that is above a limit cut off.
fn clamped(force: &[f64], limit: f64) -> Vec<f64> {
    force.iter().map(|f| f.clamp(-limit, limit)).collect()
}

/// What is left of the force by a limit.
fn error(
    all: &[Equations],
    asked: Option<Friction>,
    limit: f64,
) -> Option<(f64, Solved, Vec<Equations>)> {
    let mut with = all.to_vec();
    for equations in &mut with {
        let force = clamped(&equations.raw.force, limit);
        equations.replace_force(force);
    }
    let solved = solve_best(&mut with, asked)?;
    Some((left_share(&with, &solved), solved, with))
}

/// A force that stands at a value.
pub struct Stands {
    /// The value, and what the motion says of it.
    pub saturation: Saturation,
    /// Equations of where it does not stand, with their solution: those of the whole where
    /// the motion agrees, none where the rest does not show the mass.
    pub elsewhere: Option<(Vec<Equations>, Solved)>,
}

/// A value at which the recorded force stands, and what the motion says of it.
pub fn cut_off(all: &[Equations], asked: Option<Friction>, solved: &Solved) -> Option<Stands> {
    let cut_off = all.iter().filter_map(|equations| equations.raw.cut_off);
    let found = cut_off.max_by(|a, b| a.share.total_cmp(&b.share))?;
    let (limit, share) = (found.level.abs(), found.share);
    let elsewhere = elsewhere(all, asked);
    let shows_more = match &elsewhere {
        Some((_, known)) => missing_by(all, known, limit),
        None => left_share(all, solved) > EXPLAINED || shows_more(all, asked),
    };
    Some(if shows_more {
        Stands {
            saturation: Saturation::Recording { limit, share },
            elsewhere,
        }
    } else {
        Stands {
            saturation: Saturation::Drive { limit, share },
            elsewhere: Some((all.to_vec(), solved.clone())),
        }
    })
}

/// The sign of a force where it stands at its largest or smallest value, else 0.
fn stands(equations: &Equations) -> Vec<f64> {
    let force = &equations.raw.force;
    if equations.raw.cut_off.is_none() {
        return vec![0.0; force.len()];
    }
    let (low, high) = ends(force);
    let at_end = |f: &f64| {
        let stands = *f >= high || *f <= low;
        if stands { sign(*f) } else { 0.0 }
    };
    force.iter().map(at_end).collect()
}

/// Equations of where no force stands, as far as the common filter reaches, with their
/// solution. `None` where they do not show the mass.
fn elsewhere(all: &[Equations], asked: Option<Friction>) -> Option<(Vec<Equations>, Solved)> {
    let mut apart = all.to_vec();
    for equations in &mut apart {
        let reach = (1.0 / (equations.bandwidth_hz * equations.raw.period_s)) as usize;
        let near = equations.thinned(&near(&stands(equations), reach));
        for (counts, near) in equations.counts.iter_mut().zip(near) {
            *counts = *counts && near == 0.0;
        }
    }
    let counted = |all: &[Equations]| -> usize {
        let counts = all.iter().flat_map(|it| &it.counts);
        counts.filter(|counts| **counts).count()
    };
    if counted(&apart) < ROWS_MIN {
        return None;
    }
    let solved = solve_best(&mut apart, asked)?;
    let (mass, std) = (*solved.theta.first()?, solved.covariance[(0, 0)].sqrt());
    let is_known = std < certainty::SIGN_SHARE * mass && counted(&apart) >= ROWS_MIN;
    is_known.then_some((apart, solved))
}

/// 1 for what has a value other than 0 within so many places.
fn near(x: &[f64], reach: usize) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    let mut next = 0;
    for (at, _) in x.iter().enumerate().filter(|(_, x)| **x != 0.0) {
        let from = at.saturating_sub(reach).max(next);
        next = (at + reach + 1).min(x.len());
        if let Some(part) = out.get_mut(from..next) {
            part.fill(1.0);
        }
    }
    out
}

/// Whether a solution of elsewhere shows more force than was recorded where that stands.
fn missing_by(all: &[Equations], known: &Solved, limit: f64) -> bool {
    let mut sums = vec![0.0; known.theta.len()];
    let (mut missing, mut rows) = (0.0, 0.0);
    for equations in all {
        let signs = equations.thinned(&stands(equations));
        let mut at_end = equations.clone();
        for (counts, sign) in at_end.counts.iter_mut().zip(&signs) {
            *counts = *counts && *sign != 0.0;
        }
        let counted = signs.iter().zip(&at_end.counts);
        let mut signs = counted
            .filter(|(_, counts)| **counts)
            .map(|(sign, _)| *sign);
        counted_rows(&at_end, known.terms, |row, force| {
            let sign = signs.next().unwrap_or_default();
            let modelled: f64 = row.iter().zip(&known.theta).map(|(x, t)| x * t).sum();
            for (sum, x) in sums.iter_mut().zip(row) {
                *sum += sign * x;
            }
            missing += sign * (modelled - force);
            rows += 1.0;
        });
    }
    let mean = DVector::from_vec(sums) / rows;
    let std = (&known.covariance * &mean).dot(&mean).max(0.0).sqrt();
    let missing = missing / rows;
    missing > certainty::LIMIT * std && missing > MISSING * limit
}

/// Whether the motion shows more force than was recorded where the recording stands at its
/// largest value, where it stands so often that the rest does not show the mass.
fn shows_more(all: &[Equations], asked: Option<Friction>) -> bool {
    let mut with = all.to_vec();
    let mut limit: f64 = 0.0;
    for equations in &mut with {
        let Some(cut_off) = equations.raw.cut_off else {
            equations.add(&[]);
            continue;
        };
        limit = limit.max(cut_off.level.abs());
        let column = stands(equations);
        equations.add(&column);
    }
    let Some(solved) = solve_best(&mut with, asked) else {
        return true;
    };
    let last = solved.theta.len() - 1;
    let missing = -solved.theta.last().copied().unwrap_or_default();
    let std = solved.covariance[(last, last)].max(0.0).sqrt();
    missing > certainty::LIMIT * std && missing > MISSING * limit
}

fn ends(x: &[f64]) -> (f64, f64) {
    x.iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(*x), high.max(*x))
        })
}

/// Where a parabola through three values, the least in the middle, has its vertex: in steps
/// from the middle.
fn vertex([below, least, above]: [f64; 3]) -> Option<f64> {
    let bend = below - 2.0 * least + above;
    let by = 0.5 * (below - above) / bend;
    (bend > 0.0 && by.abs() <= 1.0).then_some(by)
}

/// A limit above which the motion does not follow the recorded force, with the equations of
/// the force up to it.
pub fn beyond(
    all: &[Equations],
    asked: Option<Friction>,
    solved: &Solved,
) -> Option<(Saturation, Solved, Vec<Equations>)> {
    let now = left_share(all, solved);
    let mut sizes: Vec<f64> = all
        .iter()
        .flat_map(|equations| equations.raw.force.iter().map(|f| f.abs()))
        .collect();
    sizes.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let index = (share * sizes.len() as f64) as usize;
        sizes.get(index).copied()
    };
    let limits: Vec<f64> = BELOW.iter().filter_map(|share| at(*share)).collect();
    // What is above the band is of no use for a search.
    let mut light = all.to_vec();
    for equations in &mut light {
        equations.above = None;
    }
    let rest = |limit: f64| {
        let found = (limit > 0.0).then(|| error(&light, asked, limit)).flatten();
        found.map_or(f64::INFINITY, |(rest, ..)| rest)
    };
    let each = limits.iter().map(|limit| (rest(*limit), *limit));
    let (mut least, mut best) = each.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if least > 0.5 * (1.0 + BETTER) * now {
        return None;
    }
    let near = limits.windows(2).map(|pair| match pair {
        [a, b] if *a == best || *b == best => b - a,
        _ => 0.0,
    });
    let mut step = near.fold(0.0, f64::max);
    for _ in 0..ROUNDS {
        step *= 0.5;
        for limit in [best - step, best + step] {
            let rest = rest(limit);
            if rest < least {
                (least, best) = (rest, limit);
            }
        }
    }
    if least > BETTER * now {
        return None;
    }
    // Near the least the squares run as a parabola: its vertex.
    let [below, above] = [best - step, best + step].map(&rest);
    if let Some(by) = vertex([below, least, above].map(|rest| rest * rest))
        && rest(best + by * step) < least
    {
        best += by * step;
    }
    let (left, next, with) = error(all, asked, best)?;
    if share(&with, &next, 0, 1) < ACCELERATES * left {
        return None;
    }
    let above = sizes.iter().filter(|size| **size > best).count();
    let limited = Saturation::Beyond {
        limit: best,
        share: above as f64 / sizes.len().max(1) as f64,
    };
    Some((limited, next, with))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_to_something() {
        let mut x = [0.0; 9];
        (x[1], x[6]) = (1.0, -1.0);
        assert_eq!(near(&x, 2), [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(near(&x, 1), [1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0]);
    }

    /// (x − 0.3)² at −1, 0 and 1.
    #[test]
    fn the_vertex_of_a_parabola() {
        let by = vertex([1.69, 0.09, 0.49]).unwrap();
        assert!((by - 0.3).abs() < 1e-12, "{by}");
        assert_eq!(vertex([1.0, 1.0, 1.0]), None);
        assert_eq!(vertex([1.0, 1.0, f64::INFINITY]), None);
    }
}
