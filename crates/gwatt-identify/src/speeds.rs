//! The speed that friction goes with, as recordings of several kinds show it.

use std::sync::Arc;

use super::column::Quantity;
use super::filter::{derivative, low_pass};
use super::recording::Recording;

/// Corners up to which a speed may be smoothed, as shares of the sampling rate: where it is
/// quiet, none leaves the most of its changes of sign.
const SMOOTH: [f64; 2] = [0.2, 0.1];
const SMOOTH_POSITION: [f64; 3] = [0.2, 0.1, 0.05];
/// Below this frequency force and friction show the speed, above it the acceleration.
const FOLLOWED_HZ: f64 = 1.0;

/// The speed at each sample. Of a long recording one signal is megabytes: what is the same is
/// there once.
#[derive(Debug, Clone)]
pub(super) struct Speed {
    /// As it was measured, or follows from what was.
    pub(super) plain: Arc<Vec<f64>>,
    /// What Coulomb friction goes with: noise would turn its sign.
    pub(super) smooth: Arc<Vec<f64>>,
    /// Means from each sample to the next one, where they are not those of two samples.
    means: Option<Arc<Vec<f64>>>,
}

impl Speed {
    pub(super) fn alone(plain: Vec<f64>) -> Self {
        let plain = Arc::new(plain);
        Self {
            smooth: Arc::clone(&plain),
            plain,
            means: None,
        }
    }

    /// What viscous friction goes with: means from each sample to the next one. What noise
    /// adds is little next to what it adds to the acceleration.
    pub(super) fn means(&self) -> Arc<Vec<f64>> {
        let means = self.means.clone();
        means.unwrap_or_else(|| Arc::new(between(&self.plain, mean_speed)))
    }
}

/// Means from each sample to the next one: a force is held as long, and its friction
/// changes meanwhile.
pub(super) fn between(x: &[f64], mean: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let last = x.last().copied();
    let next = x.iter().skip(1).copied().chain(last);
    x.iter().zip(next).map(|(a, b)| mean(*a, b)).collect()
}

/// Means that are held, as strong as what they are the means of: a swing loses `(ωT)²/24` as
/// its mean is taken, and as much again as that is held.
fn as_held(means: &[f64]) -> Vec<f64> {
    let mut out = means.to_vec();
    let inner = out.iter_mut().skip(1);
    for (slot, near) in inner.zip(means.windows(3)) {
        if let [before, mean, after] = near {
            *slot = mean - (before - 2.0 * mean + after) / 12.0;
        }
    }
    out
}

/// The mean of a speed that runs straight from one value to another.
pub(super) fn mean_speed(a: f64, b: f64) -> f64 {
    0.5 * (a + b)
}

/// The mean sign of a speed that runs straight from one value to another.
pub(super) fn mean_sign(a: f64, b: f64) -> f64 {
    let size = a.abs() + b.abs();
    if size > 0.0 { (a + b) / size } else { 0.0 }
}

/// Whether speeds are sums of accelerations.
pub(super) fn are_sums(recording: &Recording) -> bool {
    let has = |quantity| recording.get(quantity).is_some();
    !has(Quantity::Velocity) && !has(Quantity::Position)
}

/// Speeds that may be it, each made as it is asked for. Of an acceleration there are two: as it
/// is summed up from rest, and so that the axis ends as it began, which takes off what a sensor
/// adds.
pub(super) fn speeds(recording: &Recording) -> Box<dyn DoubleEndedIterator<Item = Speed> + '_> {
    let t = recording.period_s;
    let values = |quantity| recording.get(quantity).map(|signal| &signal.values);
    if let Some(velocity) = values(Quantity::Velocity) {
        let plain = Arc::new(velocity.clone());
        let shares = [None].into_iter().chain(SMOOTH.map(Some));
        return Box::new(shares.map(move |share| Speed {
            smooth: match share {
                Some(share) => Arc::new(low_pass(velocity, share / t, t)),
                None => Arc::clone(&plain),
            },
            plain: Arc::clone(&plain),
            means: None,
        }));
    }
    if let Some(position) = values(Quantity::Position) {
        // How far it went is the mean, of fast swings too, which a derivative makes smaller.
        let means = Arc::new(as_held(&between(position, |a, b| (b - a) / t)));
        return Box::new(SMOOTH_POSITION.into_iter().map(move |share| Speed {
            means: Some(Arc::clone(&means)),
            ..Speed::alone(derivative(&low_pass(position, share / t, t), t))
        }));
    }
    let Some(acceleration) = values(Quantity::Acceleration) else {
        return Box::new(std::iter::empty());
    };
    let mean = acceleration.iter().sum::<f64>() / acceleration.len().max(1) as f64;
    let biases = [0.0, mean].into_iter();
    Box::new(biases.map(move |bias| Speed::alone(summed(acceleration, bias, t))))
}

/// The speed of a recording of which mass and friction are known.
pub(super) fn speed_of(recording: &Recording, by: Followed) -> Option<Speed> {
    if !are_sums(recording) {
        return speeds(recording).next();
    }
    let values = |quantity| recording.get(quantity).map(|signal| &signal.values);
    let force = values(Quantity::Force)?;
    let acceleration = values(Quantity::Acceleration)?;
    let t = recording.period_s;
    Some(Speed::alone(followed(acceleration, force, by, t)))
}

/// An acceleration, less a bias, summed up from rest.
fn summed(acceleration: &[f64], bias: f64, period_s: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = acceleration.windows(2).map(|pair| {
        sum += period_s * (0.5 * pair.iter().sum::<f64>() - bias);
        sum
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// Mass and friction that a speed is followed by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    pub(super) mass: f64,
    pub(super) viscous: f64,
    pub(super) coulomb: f64,
}

/// The speed of an acceleration from rest: what is fast by its sum, what is slow by the
/// force and its friction. A sum alone drifts, and has the wrong sign for long then; what
/// friction brakes does not.
pub(super) fn followed(
    acceleration: &[f64],
    force: &[f64],
    by: Followed,
    period_s: f64,
) -> Vec<f64> {
    let share = std::f64::consts::TAU * FOLLOWED_HZ * period_s;
    let Followed {
        mass,
        viscous,
        coulomb,
    } = by;
    // The sum, the speed by the force, and what the sum has too much.
    let (mut sum, mut driven, mut drift) = (0.0, 0.0, 0.0);
    let steps = acceleration.windows(2).zip(force).map(|(pair, force)| {
        let before = sum - drift;
        sum += 0.5 * period_s * pair.iter().sum::<f64>();
        let after = sum - drift;
        let friction = viscous * mean_speed(before, after) + coulomb * mean_sign(before, after);
        driven += period_s * (force - friction) / mass;
        drift += share * (sum - driven - drift);
        sum - drift
    });
    std::iter::once(0.0).chain(steps).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_is_the_mean_over_a_sample() {
        assert_eq!(mean_sign(2.0, 3.0), 1.0);
        assert_eq!(mean_sign(-1.0, 3.0), 0.5);
        assert_eq!(mean_sign(0.0, 0.0), 0.0);
        assert_eq!(between(&[1.0, 3.0, 5.0], mean_speed), [2.0, 4.0, 5.0]);
    }

    /// A swing of 1 rad per sample: from 1 to 1 + (2 − 2·cos 1)/12; straight lines stay.
    #[test]
    fn what_is_held_is_as_strong_as_it_was() {
        let swing: Vec<f64> = (0..9).map(|k| libm::cos(f64::from(k))).collect();
        let held = as_held(&swing);
        let stronger = 1.0 + (2.0 - 2.0 * libm::cos(1.0)) / 12.0;
        assert!((held[4] / swing[4] - stronger).abs() < 1e-12);
        assert_eq!(as_held(&[1.0, 2.0, 3.0, 4.0]), [1.0, 2.0, 3.0, 4.0]);
    }

    /// 2 kg with 3 N·s/m and 1 N against a force of 7 N: 2 m/s in the end, though the sensor
    /// adds 0.1 m/s² all the time.
    #[test]
    fn a_speed_that_is_followed_does_not_drift() {
        let t = 1e-3;
        let mut v = 0.0;
        let acceleration: Vec<f64> = (0..20_000)
            .map(|_| {
                let a = (7.0 - 3.0 * v - 1.0) / 2.0;
                v += a * t;
                a + 0.1
            })
            .collect();
        let by = Followed {
            mass: 2.0,
            viscous: 3.0,
            coulomb: 1.0,
        };
        let found = followed(&acceleration, &vec![7.0; 20_000], by, t);
        let last = found.last().unwrap();
        assert!((last - 2.0).abs() < 0.02, "{last}");
        let drifted = summed(&acceleration, 0.0, t);
        assert!((drifted.last().unwrap() - 2.0).abs() > 1.0);
    }
}
