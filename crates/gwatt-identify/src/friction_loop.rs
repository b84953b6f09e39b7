//! Noise of a speed that friction goes with.
//!
//! Viscous friction `b` is taken off the force by the speed that was measured, so that its
//! noise is a force too: a model `G` from force to motion, with the mean speed `M` of its output,
//! leaves `(1 + b·G·M)` times the noise, most of all where the axis resonates. Everything goes
//! through `S = 1/(1 + b·G·M)`, as through the loop that friction makes of an axis, which leaves
//! the noise as it was measured, and the model between the signals as it is.

use std::collections::VecDeque;

use super::chosen::{CHOSEN, WHITENING_MAX, is_white};
use super::data::Data;
use super::disturbance::{as_it_is, leaks};
use super::estimate::Estimate;
use super::figure::Figure;
use super::leaky_integrator::Leaky;
use super::measured_noise::Noise;
use super::next_to_friction::with_errors_of_bursts;
use super::noise::predicting;
use super::output_error::{Effort, Fitting, refine, residuals};
use super::sensitivity::differences;
use super::state_space::{Measured, Sampled, Simulation};
use super::transfer::TransferFunction;

/// What friction makes of noise, next to a model.
#[derive(Debug, Clone)]
pub struct FrictionLoop {
    model: TransferFunction,
    /// Friction that goes with the measured speed, by unit of speed.
    viscous: f64,
    /// What the axis did before the first sample, and an offset: the loop would swing
    /// after them.
    state: Vec<f64>,
    offset: f64,
}

impl FrictionLoop {
    /// Next to a model that was fitted. `None` where no friction goes with a measured speed, or
    /// there is more than that.
    #[must_use]
    pub fn next_to(data: &Data<'_>, found: &Estimate) -> Option<Self> {
        let about = data.viscous?;
        let [Figure { value, .. }] = found.friction.as_slice() else {
            return None;
        };
        let viscous = about + value;
        (viscous > 0.0 && data.measured.integrators() > 0).then(|| Self {
            model: found.transfer.clone(),
            viscous,
            state: found.state.clone(),
            offset: found.offset,
        })
    }

    /// Puts the signals through the loop, that of the output from rest. In place: copies of all
    /// would be many times a long recording.
    #[must_use]
    pub fn pass(&self, data: &Data<'_>, leaky: &mut Leaky) -> Option<()> {
        let held = leaky.data(data);
        let sampled = Sampled::new(&self.model, held.measured, held.period_s)?;
        let (measured, period_s) = (held.measured, held.period_s);
        let from_rest = self.as_if_from_rest(&held)?;
        let signals = leaky.signals();
        signals.output = from_rest;
        signals.each(|x| self.run(&sampled, measured, period_s, x));
        Some(())
    }

    /// The output without what went before the first sample.
    fn as_if_from_rest(&self, data: &Data<'_>) -> Option<Vec<f64>> {
        let terms = data.friction.len();
        let before = self.state.len().checked_sub(terms)?;
        let mut rubbed = self.state.clone();
        rubbed.iter_mut().take(before).for_each(|x| *x = 0.0);
        let mut out = differences(data, &self.model, 0, &rubbed, 0.0)?;
        let left = differences(data, &self.model, data.skip(), &self.state, self.offset)?;
        for ((slot, left), y) in out.iter_mut().zip(&left).zip(data.output) {
            *slot = y - *slot + left;
        }
        Some(out)
    }

    /// A signal after the loop. What it is at a sample changes the mean speed since the one
    /// before, and that the output at once: each sample is solved for.
    fn run(&self, sampled: &Sampled, measured: Measured, period_s: f64, x: &mut [f64]) {
        // A mean speed up to a sample has so much of the acceleration there.
        let share = match measured {
            Measured::Position => period_s,
            _ => 0.5 * period_s,
        };
        let lag = sampled.lag();
        let at_once = if lag == 0 { sampled.at_once() } else { 0.0 };
        let first = 1.0 + self.viscous * share * at_once;
        let mut simulation = Simulation::new(sampled.clone());
        // Mean speeds after each sample, the last one first.
        let mut means = VecDeque::from(vec![0.0; lag + 2]);
        let mut speed = 0.0;
        for slot in x {
            let passed = (*slot - self.viscous * simulation.foreseen()) / first;
            if let Some(mean) = means.front_mut() {
                *mean += share * passed;
            }
            if lag == 0 {
                simulation.add(share * passed);
            }
            speed += period_s * passed;
            means.push_front(speed);
            means.pop_back();
            let mean = |back: usize| means.get(back).copied().unwrap_or_default();
            simulation.advance(mean(lag), mean(lag + 1));
            // As likelihoods are compared, a filter begins with 1.
            *slot = passed * first;
        }
    }
}

/// A model fitted once more after the loop that friction makes.
pub struct Passed {
    /// The model, with its errors.
    pub found: Estimate,
    /// The noise after the loop.
    pub noise: Noise,
    /// The loop.
    pub through: FrictionLoop,
}

/// A model fitted once more after the loop that friction makes, where what cannot be foreseen
/// is less than next to this noise without it. Only the noise of a measurement comes through the
/// loop: a force that disturbs the axis, which integrators need not hold, does not.
#[must_use]
pub fn fitted(
    data: &Data<'_>,
    noise: &Noise,
    delay_is_free: bool,
    found: &Estimate,
) -> Option<Passed> {
    if data.viscous.is_none() || noise.leak == 0.0 {
        return None;
    }
    let passed = once(data, noise.leak, delay_is_free, &found.transfer)?;
    let is_less = unforeseen(&passed.found, &passed.noise) < unforeseen(found, noise);
    is_less.then_some(passed)
}

/// Akaike's criterion of what could not be foreseen of each sample.
fn unforeseen(found: &Estimate, noise: &Noise) -> f64 {
    let rows = found.rows.max(1) as f64;
    libm::log((found.rest / rows).max(f64::MIN_POSITIVE)) + 2.0 * noise.taps.len() as f64 / rows
}

/// The leak after which, and the loop, least is left of the first samples: friction and noise
/// together pass for a larger one.
fn leak(data: &Data<'_>, most: f64, from: &TransferFunction) -> Option<f64> {
    const EFFORT: Effort = Effort {
        steps: 4,
        to_beat: f64::MAX,
    };
    let data = data.head(CHOSEN);
    let mut best: Option<(f64, f64)> = None;
    for leak in leaks(data.len()).filter(|leak| *leak > 0.0 && *leak <= most) {
        let (_, leaky) = through(&data, leak, from)?;
        let found = refine(&leaky.data(&data), from, false, &[], EFFORT)?;
        if best.is_some_and(|(least, _)| found.rest >= least) {
            break;
        }
        best = Some((found.rest, leak));
    }
    best.map(|(_, leak)| leak)
}

/// The signals after integrators of this leak and the loop next to a model.
fn through(data: &Data<'_>, leak: f64, from: &TransferFunction) -> Option<(FrictionLoop, Leaky)> {
    let mut leaky = Leaky::of(data, leak);
    let held = leaky.data(data);
    let passed = FrictionLoop::next_to(&held, &as_it_is(&held, from)?)?;
    passed.pass(data, &mut leaky)?;
    Some((passed, leaky))
}

fn once(
    data: &Data<'_>,
    most: f64,
    delay_is_free: bool,
    from: &TransferFunction,
) -> Option<Passed> {
    let leak = leak(data, most, from)?;
    let (passed, leaky) = through(data, leak, from)?;
    let looped = leaky.data(data);
    let left = residuals(&looped, &as_it_is(&looped, from)?)?;
    let taps = if is_white(&left, &[]) {
        Vec::new()
    } else {
        predicting(&left, WHITENING_MAX)
    };
    let fitting = Fitting::new(looped, &taps);
    let found = fitting.refine(from, delay_is_free, Effort::FULL)?;
    let found = fitting.settled(found)?;
    let found = with_errors_of_bursts(&looped, &taps, found);
    Some(Passed {
        found,
        noise: Noise { leak, taps },
        through: passed,
    })
}

#[cfg(test)]
mod tests {
    use super::super::state_space::simulate;
    use super::super::transfer::Factor;
    use super::*;

    /// What the loop makes of a signal, with the friction of its mean speed taken through the
    /// model, is that signal: for a position the mean since the sample before is known at once,
    /// for a speed half of it.
    #[test]
    fn the_loop_undoes_what_friction_makes_of_noise() {
        const T: f64 = 1e-3;
        let pair = |omega_rad_s, damping| Factor::Pair {
            omega_rad_s,
            damping,
        };
        for (measured, ahead, delay_s) in [
            (Measured::Position, 1.0, 0.0),
            (Measured::Position, 1.0, 1.4e-3),
            (Measured::Velocity, 0.5, 0.0),
        ] {
            let model = TransferFunction {
                gain: 0.05,
                zeros: vec![pair(200.0, 0.02)],
                poles: vec![pair(260.0, 0.02)],
                delay_s,
            };
            let by = FrictionLoop {
                model: model.clone(),
                viscous: 300.0,
                state: Vec::new(),
                offset: 0.0,
            };
            // The first differences need what was before.
            let noise = (0..800).map(|k| libm::sin(0.01 * f64::from(k * k)));
            let noise: Vec<f64> = [0.0; 3].into_iter().chain(noise).collect();
            let mut speed = 0.0;
            let means = noise.iter().zip(noise.iter().skip(1)).map(|(x, next)| {
                speed += T * x;
                speed + ahead * T * next
            });
            let means: Vec<f64> = means.collect();
            let rubbed = simulate(&model, measured, T, &means).unwrap();
            let with_friction = noise.iter().zip(&rubbed).map(|(x, by)| x + 300.0 * by);
            let mut passed: Vec<f64> = with_friction.collect();
            let sampled = Sampled::new(&model, measured, T).unwrap();
            by.run(&sampled, measured, T, &mut passed);
            let first = if delay_s == 0.0 {
                1.0 + 300.0 * ahead * T * sampled.at_once()
            } else {
                1.0
            };
            for (k, (x, noise)) in passed.iter().zip(&noise).enumerate() {
                assert!((x / first - noise).abs() < 1e-6, "{k}: {x} {noise}");
            }
        }
    }
}
