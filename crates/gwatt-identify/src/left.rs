//! What a model leaves of a recording, and how much wider that makes standard errors.

use super::chosen::filtered;
use super::constancy::inertia_changes;
use super::data::Data;
use super::disturbance::as_it_is;
use super::figure::Figure;
use super::methods::{Estimator, Modelled};
use super::missed::{missed_energy, peak_of_colour};
use super::output_error::residuals;
use super::spectrum::explained_share;

/// Norm of what is left by norm of the output, means taken off.
fn share(data: &Data<'_>, left: &[f64]) -> f64 {
    let power = |x: &[f64]| -> f64 {
        let n = x.len().max(1) as f64;
        let mean = x.iter().sum::<f64>() / n;
        x.iter().map(|x| (x - mean) * (x - mean)).sum()
    };
    let all = power(data.output.get(data.skip()..).unwrap_or_default());
    (power(left) / all).sqrt()
}

/// What figures are off by at most counts as so many standard errors.
const AT_MOST: f64 = 2.0;

/// What a model leaves.
pub(super) struct Left {
    /// What makes the noise white.
    pub(super) white: Vec<f64>,
    /// Norm of it by norm of the output.
    pub(super) rel_error: f64,
    /// Which share of it the input explains.
    pub(super) missed_share: f64,
    /// The energy of that, in units of the noise.
    pub(super) missed_energy: f64,
    /// By which share the inertia is larger from some place on, where it is.
    pub(super) change: Option<Figure>,
    /// By how much the highest point of its spectrum exceeds the mean.
    colour: f64,
}

impl Left {
    pub(super) fn of(found: &Modelled, data: &Data<'_>) -> Self {
        let mut leaky = found.noise.held(data);
        if let (Some(leaky), Some(passed)) = (&mut leaky, &found.friction_loop) {
            // What it was found with passes.
            let _ = passed.pass(data, leaky);
        }
        let compared = leaky.as_ref().map_or(*data, |leaky| leaky.data(data));
        let left = residuals(&compared, &found.estimate).unwrap_or_default();
        let mut rel_error = share(&compared, &left);
        if leaky.is_some() {
            let plain = as_it_is(data, &found.estimate.transfer);
            let plain = plain.and_then(|plain| residuals(data, &plain));
            rel_error = rel_error.min(plain.map_or(f64::MAX, |left| share(data, &left)));
        }
        let white = filtered(&left, &found.noise.taps);
        let known = data.undisturbed.unwrap_or(compared.input);
        let known = known.get(data.skip()..).unwrap_or_default();
        let colour = peak_of_colour(&white);
        let output = compared.output.get(compared.skip()..).unwrap_or_default();
        let modelled: Vec<f64> = output.iter().zip(&left).map(|(y, e)| y - e).collect();
        let modelled = filtered(&modelled, &found.noise.taps);
        Self {
            change: inertia_changes(&white, &modelled, colour),
            colour,
            rel_error,
            missed_share: explained_share(known, &left, data.period_s),
            missed_energy: missed_energy(known, &white, data.period_s),
            white,
        }
    }

    /// Widens standard errors by what is more than white noise.
    pub(super) fn widen(&self, found: &mut Modelled, method: &dyn Estimator) {
        let colour = if method.knows_colour() {
            1.0
        } else {
            self.colour
        };
        let wider = colour + self.missed_energy / (AT_MOST * AT_MOST);
        found.estimate.covariance *= wider;
        for figure in &mut found.estimate.friction {
            figure.std *= wider.sqrt();
        }
    }
}
