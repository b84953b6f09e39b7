//! Friction of a flexible axis: what acts against its force with the speed, and with the
//! sign of the speed.
//!
//! A model from force to acceleration has no place for it: without friction the gain at
//! 0 Hz is 1/J, with it 0, and whatever stands for that takes the inertia along. So the
//! speed, taken from the recording, and its sign are further inputs, each with a factor
//! that is estimated next to the model. Whether there is any shows where motion is slow
//! and the axis as good as rigid.

use super::certainty;
use super::column::Quantity;
use super::equations::Equations;
use super::figure::Figure;
use super::filter::{derivative, low_pass};
use super::friction::{Solved, Terms, moves_one_way, solve};
use super::recording::Recording;

/// Band in which friction is looked for, Hz.
const SLOW_HZ: f64 = 5.0;
/// Speeds are smoothed up to this share of the sampling rate.
const SMOOTH: f64 = 0.1;

/// Friction of a speed that is a sum of accelerations, as a share: what instants of sticking
/// made of it in simulations.
const SUMMED_VISCOUS: f64 = 0.04;
const SUMMED_COULOMB: f64 = 0.12;

/// A term of friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Term {
    /// It grows with the speed.
    Viscous,
    /// It has the sign of the speed.
    Coulomb,
    /// What a sensor of acceleration adds makes a ramp of its sum, the speed.
    Drift,
}

/// Friction as further inputs of a model.
#[derive(Debug, Clone, Default)]
pub(super) struct Rubbing {
    /// What there is.
    pub(super) terms: Vec<Term>,
    /// By term: speeds (m/s or rad/s) or their signs, as means from sample to sample.
    pub(super) inputs: Vec<Vec<f64>>,
    /// By term: about how much it is; that is taken off the force beforehand.
    pub(super) about: Vec<f64>,
}

/// The speed at each sample.
struct Speed {
    /// What viscous friction goes with: what noise adds is little next to what it adds to the
    /// acceleration.
    plain: Vec<f64>,
    /// What Coulomb friction goes with: noise would turn its sign.
    smooth: Vec<f64>,
}

impl Speed {
    fn alone(plain: Vec<f64>) -> Self {
        Self {
            smooth: plain.clone(),
            plain,
        }
    }
}

/// The speed. Of an acceleration there are two: as it is summed up from rest, and so that the
/// axis ends as it began, which takes off what a sensor adds.
fn speeds(recording: &Recording) -> Vec<Speed> {
    let t = recording.period_s;
    let values = |quantity| recording.get(quantity).map(|signal| &signal.values);
    let smooth = |x: &[f64]| low_pass(x, SMOOTH / t, t);
    if let Some(velocity) = values(Quantity::Velocity) {
        return vec![Speed {
            smooth: smooth(velocity),
            plain: velocity.clone(),
        }];
    }
    if let Some(position) = values(Quantity::Position) {
        return vec![Speed::alone(derivative(&smooth(position), t))];
    }
    let Some(acceleration) = values(Quantity::Acceleration) else {
        return Vec::new();
    };
    let mean = acceleration.iter().sum::<f64>() / acceleration.len().max(1) as f64;
    [0.0, mean]
        .into_iter()
        .map(|bias| {
            let mut sum = 0.0;
            let steps = acceleration.windows(2).map(|pair| {
                sum += t * (0.5 * pair.iter().sum::<f64>() - bias);
                sum
            });
            Speed::alone(std::iter::once(0.0).chain(steps).collect())
        })
        .collect()
}

/// Whether speeds are sums of accelerations.
fn are_sums(recording: &Recording) -> bool {
    let has = |quantity| recording.get(quantity).is_some();
    !has(Quantity::Velocity) && !has(Quantity::Position)
}

/// Means from each sample to the next one: a force is held as long, and its friction
/// changes meanwhile.
fn between(x: &[f64], mean: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let last = x.last().copied();
    let next = x.iter().skip(1).copied().chain(last);
    x.iter().zip(next).map(|(a, b)| mean(*a, b)).collect()
}

/// The mean sign of a speed that runs straight from one value to another.
fn mean_sign(a: f64, b: f64) -> f64 {
    let size = a.abs() + b.abs();
    if size > 0.0 { (a + b) / size } else { 0.0 }
}

/// How sure a figure is, in standard errors; below 0 where it is negative.
fn sureness(value: f64, std: f64) -> f64 {
    value / std.max(f64::MIN_POSITIVE)
}

impl Rubbing {
    /// What a recording shows of friction. `None` where it shows none, or has no force
    /// or motion.
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        let tried = speeds(recording).into_iter().filter_map(|speed| {
            let solved = slow(recording, &speed.smooth)?;
            let left: f64 = solved.residuals.iter().flatten().map(|x| x * x).sum();
            Some((left, solved, speed))
        });
        let (_, solved, speed) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let figure = |index: usize| {
            let value = solved.theta.get(index).copied().unwrap_or_default();
            let std = solved.covariance[(index, index)].sqrt();
            (value, sureness(value, std))
        };
        let mut found = vec![(Term::Viscous, figure(1))];
        if solved.terms == Terms::Symmetric {
            found.push((Term::Coulomb, figure(2)));
        }
        if found
            .iter()
            .all(|(_, (_, sure))| *sure < certainty::FRICTION)
        {
            return None;
        }
        let mut out = Self::default();
        for (term, (value, sure)) in found {
            if sure > certainty::FRICTION_TERM {
                out.add(term, &speed, value);
            }
        }
        if are_sums(recording) {
            out.add(Term::Drift, &speed, 0.0);
        }
        Some(out)
    }

    fn add(&mut self, term: Term, speed: &Speed, about: f64) {
        self.terms.push(term);
        self.inputs.push(term.input(speed));
        self.about.push(about);
    }

    /// Takes what is known of friction off a force.
    pub(super) fn take_off(&self, force: &mut [f64]) {
        for (input, about) in self.inputs.iter().zip(&self.about) {
            for (slot, x) in force.iter_mut().zip(input) {
                *slot -= about * x;
            }
        }
    }

    /// Whether the speed is a sum of accelerations.
    pub(super) fn is_summed(&self) -> bool {
        self.terms.contains(&Term::Drift)
    }

    /// Viscous and Coulomb friction: what was taken off beforehand, and what was found of
    /// each term besides.
    pub(super) fn figures(&self, found: &[Figure]) -> [Option<Figure>; 2] {
        let of = |wanted: Term, summed: f64| {
            let at = self.terms.iter().position(|term| *term == wanted)?;
            let found = found.get(at)?;
            let value = self.about.get(at)? + found.value;
            // A sum misses what stops the axis between samples.
            let share = if self.is_summed() { summed } else { 0.0 };
            Some(Figure {
                value,
                std: libm::hypot(found.std, share * value),
            })
        };
        [
            of(Term::Viscous, SUMMED_VISCOUS),
            of(Term::Coulomb, SUMMED_COULOMB),
        ]
    }

    /// Whether there is friction for sure.
    pub(super) fn is_clear(&self, found: &[Figure]) -> bool {
        let figures = self.figures(found);
        let mut figures = figures.iter().flatten();
        figures.any(|figure| figure.value > certainty::FRICTION_OF_MODEL * figure.std)
    }

    /// This much friction in another recording.
    pub(super) fn known(recording: &Recording, figures: [(Term, Option<f64>); 2]) -> Option<Self> {
        let speed = speeds(recording).pop()?;
        let mut out = Self::default();
        for (term, value) in figures {
            if let Some(value) = value {
                out.add(term, &speed, value);
            }
        }
        Some(out)
    }
}

/// Mass and friction where motion is slow.
fn slow(recording: &Recording, speed: &[f64]) -> Option<Solved> {
    let band_hz = SLOW_HZ.min(SMOOTH / recording.period_s);
    let equations = Equations::with_speed(recording, speed, band_hz).ok()?;
    let mut all = [equations];
    // One way Coulomb friction is as good as an offset. Sums of accelerations do not show
    // which way.
    let is_one_way = !are_sums(recording) && moves_one_way(&mut all);
    let terms = if is_one_way {
        Terms::OneWay
    } else {
        Terms::Symmetric
    };
    solve(&all, terms)
}

impl Term {
    fn input(self, speed: &Speed) -> Vec<f64> {
        match self {
            Self::Viscous => between(&speed.plain, |a, b| 0.5 * (a + b)),
            Self::Coulomb => between(&speed.smooth, mean_sign),
            Self::Drift => {
                let samples = speed.plain.len();
                let n = samples.max(1) as f64;
                (0..samples).map(|k| k as f64 / n).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_is_the_mean_over_a_sample() {
        assert_eq!(mean_sign(2.0, 3.0), 1.0);
        assert_eq!(mean_sign(-1.0, 3.0), 0.5);
        assert_eq!(mean_sign(0.0, 0.0), 0.0);
        assert_eq!(
            between(&[1.0, 3.0, 5.0], |a, b| 0.5 * (a + b)),
            [2.0, 4.0, 5.0]
        );
    }
}
