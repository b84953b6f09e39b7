//! Which terms of friction a rigid axis has: what was asked for, or what the data decide.
//!
//! Friction of its own in each direction is taken where the difference stands clear of
//! its error, and where stretches of the recordings are predicted better with it by the
//! others (cross-validation; Stone 1974).

use nalgebra::{DMatrix, DVector};

use super::certainty;
use super::equations::{Band, Equations};
use super::normal::Normal;
use super::sandwich::{sandwich, widening};

/// How friction is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Friction {
    /// The same in both directions, besides an offset.
    Symmetric,
    /// Of its own in each direction.
    Directional,
}

/// What stands next to mass times acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Terms {
    /// An offset: no speed is known.
    Offset,
    /// Viscous and Coulomb friction and an offset.
    Symmetric,
    /// Viscous and Coulomb friction of each direction.
    Directional,
    /// Coulomb friction and an offset: one speed alone does not show how it grows.
    Dry,
    /// Viscous friction and a constant: in motion one way Coulomb friction is one.
    OneWay,
    /// A constant: one speed, one way.
    Constant,
}

/// Parts of the recordings of which each is predicted by the others.
const PARTS: usize = 8;
/// By which share the errors of prediction fall at least.
const BETTER: f64 = 0.02;
/// Motion is one way where the other has fewer equations, or a smaller share.
const OTHER_WAY: usize = 10;
const OTHER_WAY_SHARE: f64 = 0.02;
/// A band has so many independent values for each equation: 2 a period of its end, of 2.5.
const INDEPENDENT: f64 = 0.8;

/// A solution with what it leaves.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    pub(super) terms: Terms,
    /// Mass, then the terms.
    pub(super) theta: Vec<f64>,
    pub(super) covariance: DMatrix<f64>,
    /// By recording.
    pub(super) residuals: Vec<Vec<f64>>,
}

impl Terms {
    /// Unknowns, the mass among them.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Offset | Self::Constant => 2,
            Self::Dry | Self::OneWay => 3,
            Self::Symmetric => 4,
            Self::Directional => 5,
        }
    }

    /// Viscous and Coulomb friction of both directions, as a mean. `None` where the motion
    /// does not show them.
    pub(super) fn friction_in(self, theta: &[f64]) -> Option<[f64; 2]> {
        let at = |index: usize| theta.get(index).copied().unwrap_or_default();
        match self {
            Self::Symmetric => Some([at(1), at(2)]),
            Self::Directional => Some([0.5 * (at(1) + at(2)), 0.5 * (at(3) + at(4))]),
            Self::Dry => Some([0.0, at(1)]),
            Self::Offset | Self::OneWay | Self::Constant => None,
        }
    }

    /// Unknowns of these equations: the terms, and what else the force is made of.
    pub(super) fn width_of(self, equations: &Equations) -> usize {
        self.width() + equations.inside.further.len()
    }

    /// The regressors of an equation; `one` is that of a constant.
    fn row(self, band: &Band, k: usize, one: f64, row: &mut Vec<f64>) {
        let at = |x: &[f64]| x.get(k).copied().unwrap_or_default();
        row.clear();
        row.push(at(&band.acceleration));
        let [fv, bv, fs, bs] = band.speeds.as_ref().map_or([0.0; 4], |speeds| {
            [
                at(&speeds.forward),
                at(&speeds.backward),
                at(&speeds.forward_sign),
                at(&speeds.backward_sign),
            ]
        });
        match self {
            Self::Offset | Self::Constant => row.push(one),
            Self::Symmetric => row.extend([fv + bv, fs + bs, one]),
            Self::Directional => row.extend([fv, bv, fs, bs]),
            Self::Dry => row.extend([fs + bs, one]),
            Self::OneWay => row.extend([fv + bv, one]),
        }
        row.extend(band.further.iter().map(|column| at(column)));
    }

    /// Calls with each equation that counts: its regressors and its force.
    fn each(self, equations: &Equations, mut with: impl FnMut(&[f64], f64)) {
        let mut row = Vec::with_capacity(self.width_of(equations));
        let forces = equations.inside.force.iter().zip(&equations.counts);
        for (k, (force, _)) in forces.enumerate().filter(|(_, (_, counts))| **counts) {
            self.row(&equations.inside, k, 1.0, &mut row);
            with(&row, *force);
        }
    }
}

fn width_of(all: &[Equations], terms: Terms) -> usize {
    all.first()
        .map_or(terms.width(), |equations| terms.width_of(equations))
}

fn product(row: &[f64], theta: &[f64]) -> f64 {
    row.iter().zip(theta).map(|(x, t)| x * t).sum()
}

/// Calls with each equation that counts: its regressors and its force.
pub(super) fn counted_rows(equations: &Equations, terms: Terms, with: impl FnMut(&[f64], f64)) {
    terms.each(equations, with);
}

/// The sum of squares that is left with further columns, given for each recording. `None` where the motion does not determine them.
pub(super) fn rest_of(all: &[Equations], terms: Terms, further: &[Vec<Vec<f64>>]) -> Option<f64> {
    let more = further.first().map_or(0, Vec::len);
    let mut normal = Normal::new(width_of(all, terms) + more);
    let mut long = Vec::new();
    for (equations, columns) in all.iter().zip(further) {
        let counted = equations.counts.iter().enumerate();
        let mut places = counted.filter(|(_, counts)| **counts).map(|(k, _)| k);
        terms.each(equations, |row, force| {
            let Some(k) = places.next() else { return };
            long.clear();
            long.extend_from_slice(row);
            let at = |column: &Vec<f64>| column.get(k).copied().unwrap_or_default();
            long.extend(columns.iter().map(at));
            normal.add(&long, force);
        });
    }
    normal.solve().map(|solution| solution.rest)
}

/// The last unknowns of an equation, where those before are known.
pub(super) fn refit(equations: &Equations, terms: Terms, known: &[f64]) -> Option<Vec<f64>> {
    let width = terms.width_of(equations).checked_sub(known.len())?;
    if width == 0 {
        return Some(Vec::new());
    }
    let mut normal = Normal::new(width);
    terms.each(equations, |row, force| {
        let (before, last) = row.split_at(known.len().min(row.len()));
        normal.add(last, force - product(before, known));
    });
    Some(normal.solve()?.x.iter().copied().collect())
}

/// Sums of squares of what a model leaves of the force, and of the force.
pub(super) fn left_of(equations: &Equations, terms: Terms, theta: &[f64]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    terms.each(equations, |row, force| {
        let left = force - product(row, theta);
        let [rest, all] = &mut sums;
        *rest += left * left;
        *all += force * force;
    });
    sums
}

/// Sum of squares of what a model leaves above the band, where the axis moves.
pub(super) fn left_above(equations: &Equations, terms: Terms, theta: &[f64]) -> f64 {
    let mut row = Vec::new();
    let Some(above) = &equations.above else {
        return 0.0;
    };
    let forces = above.force.iter().zip(&equations.counts);
    forces
        .enumerate()
        .filter(|(_, (_, counts))| **counts)
        .map(|(k, (force, _))| {
            // A constant has nothing above 0 Hz.
            terms.row(above, k, 0.0, &mut row);
            let left = force - product(&row, theta);
            left * left
        })
        .sum()
}

/// Force less friction, of all samples.
pub(super) fn inertial(equations: &Equations, terms: Terms, theta: &[f64]) -> Vec<f64> {
    let mut row = Vec::new();
    let mass = theta.first().copied().unwrap_or_default();
    let forces = equations.inside.force.iter().enumerate();
    forces
        .map(|(k, force)| {
            terms.row(&equations.inside, k, 1.0, &mut row);
            let accelerating = row.first().map_or(0.0, |a| a * mass);
            force - product(&row, theta) + accelerating
        })
        .collect()
}

/// Solves for a set of terms. `None` where the motion does not determine them.
pub(super) fn solve(all: &[Equations], terms: Terms) -> Option<Solved> {
    let mut normal = Normal::new(width_of(all, terms));
    for equations in all {
        terms.each(equations, |row, force| normal.add(row, force));
    }
    let solution = normal.solve()?;
    let theta: Vec<f64> = solution.x.iter().copied().collect();
    if theta.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let residuals: Vec<Vec<f64>> = all
        .iter()
        .map(|equations| {
            let mut left = Vec::new();
            terms.each(equations, |row, force| {
                left.push(force - product(row, &theta));
            });
            left
        })
        .collect();
    let covariance = robust(all, terms, &residuals, &solution.inverse);
    Some(Solved {
        terms,
        theta,
        covariance,
        residuals,
    })
}

/// Covariance that holds for residuals that are correlated over some samples, widened for
/// what few equations leave unknown of them.
fn robust(
    all: &[Equations],
    terms: Terms,
    residuals: &[Vec<f64>],
    inverse: &DMatrix<f64>,
) -> DMatrix<f64> {
    let scores: Vec<Vec<f64>> = all
        .iter()
        .zip(residuals)
        .map(|(equations, residuals)| {
            let mut left = residuals.iter();
            let mut scores = Vec::with_capacity(residuals.len() * width_of(all, terms));
            terms.each(equations, |row, _| {
                let residual = left.next().copied().unwrap_or_default();
                scores.extend(row.iter().map(|x| x * residual));
            });
            scores
        })
        .collect();
    let n: usize = residuals.iter().map(Vec::len).sum();
    let known = INDEPENDENT * n as f64;
    // Two of these errors are to hold as often as those of a normal deviate: Student's
    // deviates have the variance ν/(ν − 2).
    let freedom = (known - width_of(all, terms) as f64 - 2.0).max(0.5);
    sandwich(&scores, inverse) * (known / freedom) * widening(n)
}

/// Whether the axis moves one way only; what few equations it has of the other way are
/// left out then.
pub(super) fn moves_one_way(all: &mut [Equations]) -> bool {
    let mut sums = [0_usize; 2];
    for equations in all.iter() {
        for (sum, count) in sums.iter_mut().zip(equations.directions()) {
            *sum += count;
        }
    }
    let [forward, backward] = sums;
    let (less, more) = (forward.min(backward), forward.max(backward));
    let is_one_way = less < OTHER_WAY || (less as f64) < OTHER_WAY_SHARE * more as f64;
    if is_one_way {
        for equations in all {
            equations.leave_out(forward < backward);
        }
    }
    is_one_way
}

/// Solves with the friction that is asked for, or that the data decide on; terms that
/// the motion does not distinguish are joined. `None` where it does not even
/// determine the mass.
pub(super) fn solve_best(all: &mut [Equations], asked: Option<Friction>) -> Option<Solved> {
    if all
        .iter()
        .all(|equations| equations.inside.speeds.is_none())
    {
        return solve(all, Terms::Offset);
    }
    if moves_one_way(all) {
        return solve(all, Terms::OneWay).or_else(|| solve(all, Terms::Constant));
    }
    let found = match asked {
        Some(Friction::Symmetric) => solve(all, Terms::Symmetric),
        Some(Friction::Directional) => solve(all, Terms::Directional),
        None => by_data(all),
    };
    found.or_else(|| solve(all, Terms::Dry))
}

fn by_data(all: &[Equations]) -> Option<Solved> {
    let symmetric = solve(all, Terms::Symmetric)?;
    let Some(directional) = solve(all, Terms::Directional) else {
        return Some(symmetric);
    };
    let mut apart = vec![0.0, 1.0, -1.0, 0.0, 0.0];
    apart.resize(directional.theta.len(), 0.0);
    let apart = DVector::from_vec(apart);
    let difference = product(apart.as_slice(), &directional.theta);
    let std = (&directional.covariance * &apart)
        .dot(&apart)
        .max(0.0)
        .sqrt();
    let is_better = || {
        let error = |terms| predicted(all, terms, 1);
        matches!(
            (error(Terms::Symmetric), error(Terms::Directional)),
            (Some(one), Some(two)) if two < (1.0 - BETTER) * one
        )
    };
    if difference.abs() > certainty::DIRECTIONS * std && is_better() {
        Some(directional)
    } else {
        Some(symmetric)
    }
}

/// Sum of squares of what is left of each of eight parts when it is predicted by the others.
/// The parts consist of so many stretches each, in turn.
pub(super) fn predicted(all: &[Equations], terms: Terms, stretches: usize) -> Option<f64> {
    let width = width_of(all, terms);
    // One row after the other: a list of each would be many times as large.
    let (mut rows, mut forces) = (Vec::new(), Vec::new());
    for equations in all {
        terms.each(equations, |row, force| {
            rows.extend_from_slice(row);
            forces.push(force);
        });
    }
    let rows = || rows.chunks_exact(width).zip(&forces).enumerate();
    let length = forces.len().div_ceil(PARTS * stretches).max(1);
    let mut sum = 0.0;
    for part in 0..PARTS {
        let is_in = |k: usize| k / length % PARTS == part;
        let mut normal = Normal::new(width);
        for (k, (row, force)) in rows() {
            if !is_in(k) {
                normal.add(row, *force);
            }
        }
        let solution = normal.solve()?;
        for (_, (row, force)) in rows().filter(|(k, _)| is_in(*k)) {
            let left = force - product(row, solution.x.as_slice());
            sum += left * left;
        }
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::equations::Speeds;
    use super::*;

    /// Equations of 3 kg with 2 N·s/m and 5 N, and an offset of 1 N, at these speeds;
    /// accelerations have nothing to do with them.
    fn equations(speeds: [f64; 4]) -> Equations {
        let part = |keep: fn(f64) -> f64| (0..80).map(|k| keep(speeds[k % 4])).collect::<Vec<_>>();
        let acceleration: Vec<f64> = (0..80).map(|k| f64::from(k * k % 7) - 3.0).collect();
        let force = acceleration.iter().enumerate().map(|(k, a)| {
            let v = speeds[k % 4];
            3.0 * a + 2.0 * v + 5.0 * v.signum() + 1.0
        });
        let band = Band {
            force: force.collect(),
            acceleration: Arc::new(acceleration),
            further: Vec::new(),
            speeds: Some(Arc::new(Speeds {
                forward: part(|v| v.max(0.0)),
                backward: part(|v| v.min(0.0)),
                forward_sign: part(|v| if v > 0.0 { 1.0 } else { 0.0 }),
                backward_sign: part(|v| if v < 0.0 { -1.0 } else { 0.0 }),
            })),
        };
        Equations::of_band(band)
    }

    /// What the motion does not distinguish is joined: at ±2 m/s friction is 9 N.
    #[test]
    fn terms_that_hang_together_are_one() {
        for (speeds, terms, theta) in [
            (
                [2.0, -2.0, 1.0, -1.0],
                Terms::Symmetric,
                &[3.0, 2.0, 5.0, 1.0][..],
            ),
            ([2.0, -2.0, 2.0, -2.0], Terms::Dry, &[3.0, 9.0, 1.0]),
            ([2.0, 1.0, 2.0, 3.0], Terms::OneWay, &[3.0, 2.0, 6.0]),
            ([-2.0, -1.0, -2.0, -3.0], Terms::OneWay, &[3.0, 2.0, -4.0]),
            ([2.0, 2.0, 2.0, 2.0], Terms::Constant, &[3.0, 10.0]),
        ] {
            let found = solve_best(&mut [equations(speeds)], None).unwrap();
            assert_eq!(found.terms, terms, "{speeds:?}");
            for (found, expected) in found.theta.iter().zip(theta) {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{speeds:?} {found} {expected}"
                );
            }
        }
    }
}
