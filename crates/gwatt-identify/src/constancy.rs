//! Whether an axis is the same throughout: a mass that is another one from some place of its
//! recordings on, as after a workpiece was put on, or in recordings of two axes.

use super::certainty;
use super::equations::Equations;
use super::figure::Figure;
use super::friction::{Solved, solve};

/// Parts of the recordings between which the mass may change.
const PARTS: usize = 8;
/// Masses that differ by less, as a share, count as one.
const SHARE: f64 = 0.05;

/// By which share the mass is larger from one of seven places on, where that is sure and more
/// than little; the surest one.
pub(super) fn mass_changes(all: &[Equations], solved: &Solved) -> Option<Figure> {
    let mass = solved.theta.first()?;
    let counted = all
        .iter()
        .map(|it| it.counts.iter().filter(|c| **c).count());
    let rows: usize = counted.sum();
    let changes = (1..PARTS).filter_map(|part| {
        let figure = change_after(all, solved, part * rows / PARTS)?;
        Some(Figure {
            value: figure.value / mass,
            std: figure.std / mass.abs(),
        })
    });
    surest(changes)
}

/// The surest of changes that are sure and more than little.
fn surest(changes: impl Iterator<Item = Figure>) -> Option<Figure> {
    let is_clear = |change: &Figure| {
        change.value.abs() > SHARE && change.value.abs() > certainty::CHANGE * change.std
    };
    let sureness = |change: &Figure| change.value.abs() / change.std;
    changes
        .filter(is_clear)
        .max_by(|a, b| sureness(a).total_cmp(&sureness(b)))
}

/// The mass that is added after so many equations that count.
fn change_after(all: &[Equations], solved: &Solved, rows: usize) -> Option<Figure> {
    let mut wider = all.to_vec();
    let mut before = rows;
    for equations in &mut wider {
        let samples = equations.inside.acceleration.iter().zip(&equations.counts);
        let column = samples.map(|(acceleration, counts)| {
            if before > 0 {
                before -= usize::from(*counts);
                0.0
            } else {
                *acceleration
            }
        });
        let column = column.collect();
        equations.above = None;
        equations.inside.further.push(column);
    }
    let joint = solve(&wider, solved.terms)?;
    let last = joint.theta.len().checked_sub(1)?;
    let std = joint.covariance[(last, last)].max(0.0).sqrt();
    let value = *joint.theta.last()?;
    (std.is_finite() && value.is_finite()).then_some(Figure { value, std })
}

/// By which share the mass is larger from one of seven places on, by what a model leaves of its
/// output and what it makes of it, both after what makes the noise white. `wider` is by how much
/// the variance is larger than that of white noise.
pub(super) fn inertia_changes(white: &[f64], modelled: &[f64], wider: f64) -> Option<Figure> {
    let samples = white.len().min(modelled.len());
    let rows = || white.iter().zip(modelled).take(samples);
    let variance = wider * rows().map(|(left, _)| left * left).sum::<f64>() / samples as f64;
    // The mass that suits these samples, by that of all, and its variance.
    let mass = |from: usize, to: usize| {
        let (mut both, mut squares) = (0.0, 0.0);
        for (left, modelled) in rows().skip(from).take(to - from) {
            both += left * modelled;
            squares += modelled * modelled;
        }
        let mass = 1.0 / (1.0 + both / squares);
        (mass, mass * mass * mass * mass * variance / squares)
    };
    let changes = (1..PARTS).map(|part| {
        let at = part * samples / PARTS;
        let ((before, one), (after, other)) = (mass(0, at), mass(at, samples));
        Figure {
            value: after - before,
            std: (one + other).sqrt(),
        }
    });
    surest(changes)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::equations::Band;
    use super::super::friction::Terms;
    use super::*;

    /// Equations of 2 kg, and of another mass from an equation on; noise of ±0.1 N.
    fn equations(mass: f64, from: usize) -> Equations {
        let accelerations: Vec<f64> = (0..400).map(|k| f64::from(k * k % 7) - 3.0).collect();
        let force = accelerations.iter().enumerate().map(|(k, a)| {
            let noise = if k * k % 11 < 5 { 0.1 } else { -0.1 };
            a * if k < from { 2.0 } else { mass } + noise
        });
        Equations::of_band(Band {
            force: force.collect(),
            acceleration: Arc::new(accelerations),
            speeds: None,
            further: Vec::new(),
        })
    }

    fn change(all: &[Equations]) -> Option<Figure> {
        mass_changes(all, &solve(all, Terms::Offset).unwrap())
    }

    #[test]
    fn a_mass_that_is_put_on_is_seen() {
        // 2 kg, and 3 kg from a half on: 1 kg more than 2 kg, by the mean of 2.5 kg.
        let found = change(&[equations(3.0, 200)]).unwrap();
        assert!((found.value - 0.4).abs() < 0.01, "{found:?}");
        assert_eq!(change(&[equations(3.0, 400)]), None);
        // 2 % is little, however sure.
        assert_eq!(change(&[equations(2.04, 200)]), None);
    }

    /// Two recordings of two axes: 2 kg and 2.5 kg, by 2.25 kg.
    #[test]
    fn recordings_of_two_axes_are_not_joined() {
        let found = change(&[equations(2.0, 400), equations(2.5, 0)]).unwrap();
        assert!((found.value - 0.5 / 2.25).abs() < 0.01, "{found:?}");
    }

    /// A model of 2.5 kg, of an axis of 2 kg and then of 3 kg: 1.25 times as much motion as
    /// it says, and five sixths; the mass is (3 − 2)/2.5 larger.
    #[test]
    fn a_model_of_two_masses_leaves_what_goes_with_the_motion() {
        let modelled: Vec<f64> = (0..800).map(|k| f64::from(k * k % 7) - 3.0).collect();
        let noise = |k: usize| if k * k % 11 < 5 { 0.1 } else { -0.1 };
        let left = |masses: [f64; 2]| -> Vec<f64> {
            let each = modelled.iter().enumerate();
            each.map(|(k, x)| x * (2.5 / masses[k / 400] - 1.0) + noise(k))
                .collect()
        };
        let found = inertia_changes(&left([2.0, 3.0]), &modelled, 1.0).unwrap();
        assert!((found.value - 0.4).abs() < 0.01, "{found:?}");
        assert_eq!(inertia_changes(&left([2.5, 2.5]), &modelled, 1.0), None);
        assert_eq!(inertia_changes(&left([2.5, 2.4]), &modelled, 1.0), None);
        assert_eq!(inertia_changes(&left([2.0, 3.0]), &modelled, 1e4), None);
        assert_eq!(inertia_changes(&[], &[], 1.0), None);
    }
}
