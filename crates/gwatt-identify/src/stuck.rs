//! The speed of an axis near standstill, where Coulomb friction holds it: a model that rubs is
//! driven by the recorded force, and led back to the recorded position.
//!
//! While an axis turns round it may stick or creep for many samples. Friction then is as large
//! as the force, and steps of an encoder do not show which way it goes. Driven by the force, a
//! model sticks where the axis does, whatever it was wrong by before.

use std::sync::Arc;

use super::column::Quantity;
use super::parallel::{Parallel, Section};
use super::recording::Recording;
use super::speeds::{Followed, Speed, gone};
use super::state_space::Measured;
use super::transfer::TransferFunction;

/// Steps from sample to sample.
const STEPS: usize = 8;
/// Below this frequency the position leads, above it the model.
const LED_HZ: f64 = 10.0;

/// Speeds below which friction grows with the speed: the least and the most, as shares of the
/// rms speed, and by which factor the next one is higher. Besides it there is none.
const CREEPS: [f64; 2] = [0.001, 0.04];
const NEXT_CREEP: f64 = std::f64::consts::SQRT_2;

/// A model that rubs.
struct Rubbed<'a> {
    sections: Vec<(&'a Section, [f64; 2], [f64; 2])>,
    direct: f64,
    by: Followed,
    /// Speed below which friction grows with it.
    creep: f64,
    step_s: f64,
    position: f64,
    speed: f64,
    /// Acceleration that the model does not know of.
    bias: f64,
}

impl Rubbed<'_> {
    /// A step under a force; with the friction's share of Coulomb friction.
    fn step(&mut self, force: f64) -> f64 {
        let h = self.step_s;
        let swing: f64 = self
            .sections
            .iter()
            .map(|(_, w, x)| w[0] * x[0] + w[1] * x[1])
            .sum();
        let pushed = force - self.by.viscous * self.speed;
        let free = self.speed + h * (swing + self.direct * pushed + self.bias);
        let stops = h * self.direct * self.by.coulomb;
        let share = (free / (stops + self.creep)).clamp(-1.0, 1.0);
        let next = free - stops * share;
        self.position += 0.5 * h * (self.speed + next);
        self.speed = next;
        let through = pushed - self.by.coulomb * share;
        for (section, _, state) in &mut self.sections {
            let [a, b, c, d] = section.phi;
            let [[p, q], ..] = section.gamma;
            let [x, y] = *state;
            *state = [a * x + b * y + p * through, c * x + d * y + q * through];
        }
        share
    }

    /// Leads it to where it was seen, by an α-β-γ filter.
    fn lead(&mut self, seen: f64, period_s: f64) {
        let kept = libm::exp(-std::f64::consts::TAU * LED_HZ * period_s);
        let new = 1.0 - kept;
        let apart = seen - self.position;
        self.position += (1.0 - kept * kept * kept) * apart;
        self.speed += 1.5 * new * new * (1.0 + kept) * apart / period_s;
        self.bias += new * new * new * apart / (period_s * period_s);
    }
}

/// Speeds by a position and a model with this friction that sticks where the axis does, by
/// how slow it creeps. `None` without a position, or where a model has no such speed.
pub(super) fn stuck(
    recording: &Recording,
    model: &TransferFunction,
    by: Followed,
) -> Option<Vec<Speed>> {
    let t = recording.period_s;
    let force = &recording.get(Quantity::Force)?.values;
    let position = &recording.get(Quantity::Position)?.values;
    let means = Arc::new(gone(position, t));
    let steps = means.iter().map(|v| v * v).sum::<f64>();
    let rms = (steps / means.len().max(1) as f64).sqrt();
    let [least, most] = CREEPS;
    let shares = std::iter::successors(Some(least), |share| Some(share * NEXT_CREEP));
    let shares = shares.take_while(|share| *share < most);
    let found = std::iter::once(0.0).chain(shares).filter_map(|share| {
        let (plain, signs) = followed((force, position), model, by, share * rms, t)?;
        Some(Speed {
            means: Some(Arc::clone(&means)),
            signs: Some(Arc::new(signs)),
            ..Speed::alone(plain)
        })
    });
    let all: Vec<Speed> = found.collect();
    (!all.is_empty()).then_some(all)
}

/// Speeds at each sample and the mean direction until the next one, from −1 to 1, of an axis
/// with this model, which has no delay, and friction. `None` where it follows a force with a lag.
fn followed(
    (force, position): (&[f64], &[f64]),
    model: &TransferFunction,
    by: Followed,
    creep: f64,
    period_s: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let step_s = period_s / STEPS as f64;
    let sampled = Parallel::new(model, Measured::Direct, step_s)?;
    let [direct, ..] = sampled.direct;
    if direct <= 0.0 {
        return None;
    }
    let (first, second) = (position.first()?, position.get(1)?);
    let weighed = sampled.sections.iter().zip(&sampled.weights);
    let mut axis = Rubbed {
        sections: weighed
            .map(|(section, w)| (section, *w, [0.0; 2]))
            .collect(),
        direct,
        by,
        creep,
        step_s,
        position: *first,
        speed: (second - first) / period_s,
        bias: 0.0,
    };
    let (mut speeds, mut signs) = (Vec::new(), Vec::new());
    for (seen, force) in position.iter().zip(force) {
        axis.lead(*seen, period_s);
        speeds.push(axis.speed);
        let sum: f64 = (0..STEPS).map(|_| axis.step(*force)).sum();
        signs.push(sum / STEPS as f64);
    }
    Some((speeds, signs))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 kg with 5 N, which 9 N move and 3 N do not: it speeds up by 2 m/s² for 0.2 s, slows
    /// down by 1 m/s² for 0.4 s, and sticks with the friction as large as the force.
    #[test]
    fn an_axis_sticks_where_friction_is_as_large_as_the_force() {
        let force: Vec<f64> = (0..1000).map(|k| if k < 200 { 9.0 } else { 3.0 }).collect();
        let position: Vec<f64> = (0..1000)
            .map(|k| {
                let t = 1e-3 * f64::from(k);
                let late = (t - 0.2).clamp(0.0, 0.4);
                let early = t.min(0.2);
                early * early + 0.4 * late - 0.5 * late * late
            })
            .collect();
        let model = TransferFunction::constant(0.5);
        let by = Followed {
            mass: 2.0,
            viscous: 0.0,
            coulomb: 5.0,
        };
        let (speeds, signs) = followed((&force, &position), &model, by, 0.0, 1e-3).unwrap();
        assert!((speeds[200] - 0.4).abs() < 1e-3, "{}", speeds[200]);
        assert!((signs[300] - 1.0).abs() < 1e-12);
        assert!(speeds[900].abs() < 1e-3, "{}", speeds[900]);
        assert!((signs[900] - 0.6).abs() < 0.02, "{}", signs[900]);
    }
}
