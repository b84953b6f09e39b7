//! A transfer function through a measured frequency response, by weighted least
//! squares: each frequency counts by the inverse of its variance.
//!
//! The model's response is that of its samples under a held input, exactly. The
//! model grows by modes, one at a time, for every delay; Bayes' criterion says
//! how many are worth their parameters.

use std::f64::consts::PI;

use nalgebra::{Complex, DMatrix};

use super::discrete::SampledResponse;
use super::mode::with_mode;
use super::normal::Normal;
use super::parameters::{is_admissible, parameters, probes, with};
use super::spectrum::FrequencyResponse;
use super::transfer::{Factor, TransferFunction};

type C = Complex<f64>;

/// Steps of each fit while the model grows, and of the last one.
const STEPS: usize = 15;
const STEPS_LAST: usize = 80;
/// Frequencies on which models are compared; the last fit takes all.
const COMPARED: usize = 4_000;
/// Up to this share of the sampling frequency the response is used.
const BAND: f64 = 0.47;

/// A model with its misfit.
#[derive(Debug, Clone)]
pub struct ResponseFit {
    /// The model.
    pub transfer: TransferFunction,
    /// Covariance of its parameters.
    pub covariance: DMatrix<f64>,
    /// Weighted sum of squares.
    pub misfit: f64,
    /// Real and imaginary parts that it is the sum of.
    pub rows: usize,
    /// Number of parameters.
    pub count: usize,
}

impl ResponseFit {
    /// Bayes' information criterion, with the noise's level unknown.
    #[must_use]
    pub fn criterion(&self) -> f64 {
        let n = self.rows as f64;
        let count = self.count + self.transfer.zeros_on_the_right();
        n * libm::log((self.misfit / n).max(f64::MIN_POSITIVE)) + count as f64 * libm::log(n)
    }
}

/// Frequencies, responses and weights within the band.
struct Points {
    z: Vec<C>,
    response: Vec<C>,
    weight: Vec<f64>,
}

impl Points {
    /// One of so many that there are about `most`; all where there are no more.
    fn some(response: &FrequencyResponse, period_s: f64, most: usize) -> Option<Self> {
        let all = Self::new(response, period_s)?;
        let every = all.z.len().div_ceil(most).max(1);
        Some(Self {
            z: all.z.into_iter().step_by(every).collect(),
            response: all.response.into_iter().step_by(every).collect(),
            weight: all.weight.into_iter().step_by(every).collect(),
        })
    }

    fn new(response: &FrequencyResponse, period_s: f64) -> Option<Self> {
        let mut sorted = response.variance.clone();
        sorted.sort_by(f64::total_cmp);
        let strongest = response.response.iter().map(C::norm_sqr);
        let rounding = 1e-16 * strongest.fold(f64::MIN_POSITIVE, f64::max);
        // A few lucky frequencies must not rule.
        let floor = (0.01 * sorted.get(sorted.len() / 2)?).max(rounding);
        let mut points = Self {
            z: Vec::new(),
            response: Vec::new(),
            weight: Vec::new(),
        };
        for ((f, g), variance) in response
            .frequency_hz
            .iter()
            .zip(&response.response)
            .zip(&response.variance)
        {
            let weight = 1.0 / variance.max(floor);
            if f * period_s <= BAND && weight.is_finite() && g.re.is_finite() && g.im.is_finite() {
                let (sin, cos) = libm::sincos(2.0 * PI * f * period_s);
                points.z.push(C::new(cos, sin));
                points.response.push(*g);
                points.weight.push(weight.sqrt());
            }
        }
        Some(points)
    }

    /// The model's samples at these frequencies.
    fn model(&self, transfer: &TransferFunction, period_s: f64) -> Option<Vec<C>> {
        let sampled = SampledResponse::new(transfer, period_s)?;
        let lag = libm::round(transfer.delay_s / period_s) as i32;
        Some(
            self.z
                .iter()
                .map(|z| sampled.at(*z) * z.powi(-lag))
                .collect(),
        )
    }

    fn gather(&self, transfer: &TransferFunction, period_s: f64) -> Option<Normal> {
        let theta = parameters(transfer, false);
        let base = self.model(transfer, period_s)?;
        let mut columns = Vec::with_capacity(theta.len());
        for (index, probe) in probes(transfer, false, period_s).iter().enumerate() {
            let mut theta = theta.clone();
            *theta.get_mut(index)? += probe;
            let moved = self.model(&with(transfer, &theta), period_s)?;
            let column: Vec<C> = moved
                .iter()
                .zip(&base)
                .map(|(moved, base)| (moved - base) / *probe)
                .collect();
            columns.push(column);
        }
        let mut normal = Normal::new(theta.len());
        let mut rows = [vec![0.0; theta.len()], vec![0.0; theta.len()]];
        for (k, ((g, base), weight)) in self
            .response
            .iter()
            .zip(&base)
            .zip(&self.weight)
            .enumerate()
        {
            let [re, im] = &mut rows;
            for ((re, im), column) in re.iter_mut().zip(im.iter_mut()).zip(&columns) {
                let x = column.get(k)? * *weight;
                *re = x.re;
                *im = x.im;
            }
            let gap = (g - base) * *weight;
            normal.add(re, gap.re);
            normal.add(im, gap.im);
        }
        normal.total.is_finite().then_some(normal)
    }

    fn refine(&self, start: &TransferFunction, steps: usize, period_s: f64) -> Option<ResponseFit> {
        let mut transfer = start.clone();
        let mut normal = self.gather(&transfer, period_s)?;
        let mut damping = 1e-3;
        for _ in 0..steps {
            let moved = normal.solve_from(0, damping).map(|step| {
                let mut theta = parameters(&transfer, false);
                for (value, step) in theta.iter_mut().zip(step.x.iter()) {
                    *value += step;
                }
                with(&transfer, &theta)
            });
            let tried = moved
                .filter(|next| is_admissible(next, period_s))
                .and_then(|next| Some((self.gather(&next, period_s)?, next)));
            match tried {
                Some((found, next)) if found.total <= normal.total => {
                    let gained = normal.total - found.total;
                    (normal, transfer) = (found, next);
                    damping = (damping * 0.1).max(1e-12);
                    if gained < 1e-4 * normal.total / normal.rows as f64 {
                        break;
                    }
                }
                _ => {
                    damping *= 10.0;
                    if damping > 1e6 {
                        break;
                    }
                }
            }
        }
        let count = parameters(&transfer, false).len();
        let solution = normal.solve().or_else(|| normal.solve_from(0, 1e-10))?;
        let noise = normal.total / normal.rows.saturating_sub(count).max(1) as f64;
        Some(ResponseFit {
            transfer,
            covariance: solution.inverse * noise,
            misfit: normal.total,
            rows: normal.rows,
            count,
        })
    }
}

/// Models of growing order for one delay, the rigid one first.
#[must_use]
pub fn grow(
    response: &FrequencyResponse,
    lag: usize,
    order: Option<usize>,
    order_max: usize,
    period_s: f64,
) -> Option<ResponseFit> {
    let points = Points::some(response, period_s, COMPARED)?;
    let rigid = TransferFunction {
        delay_s: lag as f64 * period_s,
        ..TransferFunction::constant(mean_gain(response))
    };
    let mut best = points.refine(&rigid, STEPS, period_s)?;
    loop {
        let have = best.transfer.order();
        if have + 2 > order.unwrap_or(order_max) {
            break;
        }
        let more = with_mode(&best.transfer, response, period_s)
            .iter()
            .filter_map(|start| points.refine(start, STEPS, period_s))
            .min_by(|a, b| a.misfit.total_cmp(&b.misfit));
        match more {
            Some(found) if order.is_some() || found.criterion() < best.criterion() => best = found,
            _ => break,
        }
    }
    if order.is_some_and(|order| order == best.transfer.order() + 1) {
        let mut start = best.transfer.clone();
        start.poles.push(Factor::Real {
            time_constant_s: period_s,
        });
        best = points.refine(&start, STEPS, period_s)?;
    }
    Some(best)
}

/// The best of these models after a fit, of as many frequencies as models are compared
/// on; with a real zero far above the band, as dampers make it, where that is worth a
/// parameter. Then it is fitted to all frequencies.
#[must_use]
pub fn best_of(
    response: &FrequencyResponse,
    starts: &[TransferFunction],
    period_s: f64,
) -> Option<ResponseFit> {
    let some = Points::some(response, period_s, COMPARED)?;
    let best = starts
        .iter()
        .filter_map(|start| with_zero(&some, start, period_s))
        .min_by(|a, b| a.criterion().total_cmp(&b.criterion()))?;
    let all = Points::new(response, period_s)?;
    if all.z.len() == some.z.len() {
        return Some(best);
    }
    all.refine(&best.transfer, STEPS_LAST, period_s)
}

fn with_zero(points: &Points, start: &TransferFunction, period_s: f64) -> Option<ResponseFit> {
    let as_it_is = points.refine(start, STEPS_LAST, period_s)?;
    if start.zero_count() >= start.order() {
        return Some(as_it_is);
    }
    let mut more = as_it_is.transfer.clone();
    more.zeros.push(Factor::Real {
        time_constant_s: 0.1 * period_s,
    });
    let more = points.refine(&more, STEPS_LAST, period_s);
    Some(
        more.filter(|more| more.criterion() < as_it_is.criterion())
            .unwrap_or(as_it_is),
    )
}

/// The gain in the lowest tenth of the band.
fn mean_gain(response: &FrequencyResponse) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    let count = (response.response.len() / 10).max(3);
    for (g, variance) in response.response.iter().zip(&response.variance).take(count) {
        let weight = 1.0 / variance.max(f64::MIN_POSITIVE);
        sum += g.re * weight;
        weights += weight;
    }
    let mean = sum / weights;
    if mean.is_finite() && mean != 0.0 {
        mean
    } else {
        1.0
    }
}
