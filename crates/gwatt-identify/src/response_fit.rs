//! A transfer function through a measured frequency response, by weighted least
//! squares: each frequency counts by the inverse of its variance.
//!
//! The model's response is that of its samples under a held input, exactly. The
//! model grows by modes, one at a time, for every delay; Bayes' criterion says
//! how many are worth their parameters.

use std::f64::consts::PI;

use nalgebra::{Complex, DMatrix};

use super::descent::{Damping, Descending, Step, descend};
use super::discrete::{LANES, Lanes, SampledResponse};
use super::mode::with_mode;
use super::normal::Normal;
use super::parameters::{is_admissible, parameters, probes, with};
use super::places::numbered;
use super::spectrum::FrequencyResponse;
use super::transfer::{Factor, TransferFunction};

type C = Complex<f64>;

/// Steps of each fit while the model grows, and of the last one.
const STEPS: usize = 15;
const STEPS_LAST: usize = 80;
/// Frequencies on which a model grows, and on which what has grown is compared; the last
/// fit takes all.
const GROWN: usize = 1_000;
const COMPARED: usize = 4_000;
/// Blocks of frequencies that are worked on at a time.
const STRETCH: usize = 32;
/// Up to this share of the sampling frequency the response is used.
const BAND: f64 = 0.47;

const DAMPING: Damping = Damping {
    now: 1e-3,
    least: 1e-12,
    most: 1e6,
};
/// An improvement below this share of one row's squares ends the search; in the last fit
/// none that depends on the way to it, and so on units, may be left.
const ENOUGH: f64 = 1e-4;
const ENOUGH_LAST: f64 = 1e-10;

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

/// Weights by a variance that is the mean of so many values are off by chance: as the best fit
/// is missed, figures scatter by `1/m` more, and by as much less than seems.
fn doubt(values: usize) -> f64 {
    if values > 0 {
        1.0 + 2.0 / values as f64
    } else {
        1.0
    }
}

/// Some frequencies with their responses and weights. Where there are fewer, the last
/// one fills up, without any weight.
#[derive(Debug, Clone, Default)]
struct Block {
    z: [Lanes; 2],
    response: [Lanes; 2],
    weight: Lanes,
}

/// Frequencies, responses and weights within the band.
#[derive(Debug, Clone, Default)]
struct Points {
    blocks: Vec<Block>,
    count: usize,
    /// By how much variances grow as weights are known from noise alone.
    doubt: f64,
}

impl Points {
    /// One of so many that there are about `most`; all where there are no more.
    fn some(response: &FrequencyResponse, period_s: f64, most: usize) -> Option<Self> {
        let all = Self::used(response, period_s)?;
        let every = all.len().div_ceil(most).max(1);
        let mut points = Self::of(all.into_iter().step_by(every));
        points.doubt = doubt(response.noise_values);
        Some(points)
    }

    fn new(response: &FrequencyResponse, period_s: f64) -> Option<Self> {
        Self::some(response, period_s, usize::MAX)
    }

    fn of(points: impl Iterator<Item = (C, C, f64)>) -> Self {
        let mut out = Self::default();
        for (z, g, weight) in points {
            let at = out.count % LANES;
            if at == 0 {
                out.blocks.push(Block::default());
            }
            out.count += 1;
            let Some(block) = out.blocks.last_mut() else {
                continue;
            };
            // Those after it are filled up by it until they come.
            let fill = |list: &mut Lanes, value: f64| {
                for slot in list.iter_mut().skip(at) {
                    *slot = value;
                }
            };
            let [re, im] = &mut block.z;
            fill(re, z.re);
            fill(im, z.im);
            let [re, im] = &mut block.response;
            fill(re, g.re);
            fill(im, g.im);
            if let Some(slot) = block.weight.get_mut(at) {
                *slot = weight;
            }
        }
        out
    }

    /// What of a response counts: z, value and weight.
    fn used(response: &FrequencyResponse, period_s: f64) -> Option<Vec<(C, C, f64)>> {
        let mut sorted = response.variance.clone();
        sorted.sort_by(f64::total_cmp);
        let strongest = response.response.iter().map(C::norm_sqr);
        let rounding = 1e-16 * strongest.fold(f64::MIN_POSITIVE, f64::max);
        // A few lucky frequencies must not rule.
        let floor = (0.01 * sorted.get(sorted.len() / 2)?).max(rounding);
        let values = response.response.iter().zip(&response.variance);
        let points = response.frequency_hz.iter().zip(values);
        let used = points.filter_map(|(f, (g, variance))| {
            let weight = 1.0 / variance.max(floor);
            let counts =
                f * period_s <= BAND && weight.is_finite() && g.re.is_finite() && g.im.is_finite();
            let (sin, cos) = libm::sincos(2.0 * PI * f * period_s);
            counts.then(|| (C::new(cos, sin), *g, weight.sqrt()))
        });
        Some(used.collect())
    }

    /// The responses so many periods earlier.
    fn earlier(&self, lag: i32) -> Self {
        let mut out = self.clone();
        for block in &mut out.blocks {
            let [re, im] = &mut block.response;
            let [x, y] = &block.z;
            for ((re, im), (x, y)) in re.iter_mut().zip(im).zip(x.iter().zip(y)) {
                let turned = C::new(*re, *im) * C::new(*x, *y).powi(lag);
                (*re, *im) = (turned.re, turned.im);
            }
        }
        out
    }

    /// Normal equations of a step from a model, its delay left out.
    fn gather(&self, transfer: &TransferFunction, period_s: f64) -> Option<Normal> {
        let theta = parameters(transfer, false);
        let base = SampledResponse::new(transfer, period_s)?;
        let probes = probes(transfer, false, period_s);
        let moved = probes.iter().enumerate().map(|(index, probe)| {
            let mut theta = theta.clone();
            *theta.get_mut(index)? += probe;
            SampledResponse::new(&with(transfer, &theta), period_s)
        });
        let moved = moved.collect::<Option<Vec<_>>>()?;
        let mut normal = Normal::new(theta.len());
        let mut columns = vec![Vec::with_capacity(2 * LANES * STRETCH); theta.len()];
        let mut gaps = Vec::with_capacity(2 * LANES * STRETCH);
        for stretch in self.blocks.chunks(STRETCH) {
            columns.iter_mut().for_each(Vec::clear);
            gaps.clear();
            for block in stretch {
                let here = base.at_each(&block.z);
                let scaled = |from: &[Lanes; 2], to: &[Lanes; 2], by: f64, out: &mut Vec<f64>| {
                    for (from, to) in from.iter().zip(to) {
                        let apart = from.iter().zip(to).zip(&block.weight);
                        out.extend(apart.map(|((from, to), w)| (to - from) / by * w));
                    }
                };
                for ((moved, probe), column) in moved.iter().zip(&probes).zip(&mut columns) {
                    scaled(&here, &moved.at_each(&block.z), *probe, column);
                }
                scaled(&here, &block.response, 1.0, &mut gaps);
            }
            normal.add_columns(&numbered(&columns), &gaps);
        }
        normal.rows = 2 * self.count;
        normal.total.is_finite().then_some(normal)
    }

    fn refine(&self, start: &TransferFunction, steps: usize, period_s: f64) -> Option<ResponseFit> {
        let points = self.earlier(libm::round(start.delay_s / period_s) as i32);
        let first = (points.gather(start, period_s)?, start.clone());
        let task = Task {
            points: &points,
            steps,
            period_s,
        };
        let ((normal, transfer), _) = descend(&task, first, DAMPING)?;
        let count = parameters(&transfer, false).len();
        let solution = normal.solve().or_else(|| normal.solve_from(0, 1e-10))?;
        let noise = points.doubt * normal.total / normal.rows.saturating_sub(count).max(1) as f64;
        Some(ResponseFit {
            transfer,
            covariance: solution.inverse * noise,
            misfit: normal.total,
            rows: normal.rows,
            count,
        })
    }
}

/// A fit of a model to points.
struct Task<'a> {
    points: &'a Points,
    steps: usize,
    period_s: f64,
}

impl Descending for Task<'_> {
    type Place = (Normal, TransferFunction);

    fn squares(&self, (normal, _): &Self::Place) -> f64 {
        normal.total
    }

    fn goes_on(&self, round: usize, _: &Self::Place) -> bool {
        round < self.steps
    }

    fn step(&self, _: usize, (normal, transfer): &Self::Place, damping: f64) -> Step<Self::Place> {
        let moved = normal.solve_from(0, damping).map(|step| {
            let mut theta = parameters(transfer, false);
            for (value, step) in theta.iter_mut().zip(step.x.iter()) {
                *value += step;
            }
            with(transfer, &theta)
        });
        moved
            .filter(|next| is_admissible(next, self.period_s))
            .and_then(|next| Some((self.points.gather(&next, self.period_s)?, next)))
            .map_or(Step::Nowhere, Step::To)
    }

    fn is_enough(&self, _: usize, (before, _): &Self::Place, (after, _): &Self::Place) -> bool {
        let enough = if self.steps == STEPS_LAST {
            ENOUGH_LAST
        } else {
            ENOUGH
        };
        before.total - after.total < enough * after.total / after.rows as f64
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
    let points = Points::some(response, period_s, GROWN)?;
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
    if all.count == some.count {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A response of eleven frequencies, a period late, is fitted to its last digits, and
    /// what fills up the second block counts nothing.
    #[test]
    fn what_fills_up_counts_nothing() {
        let truth = TransferFunction {
            poles: vec![Factor::Pair {
                omega_rad_s: 400.0,
                damping: 0.1,
            }],
            delay_s: 1e-3,
            ..TransferFunction::constant(2.0)
        };
        let sampled = SampledResponse::new(&truth, 1e-3).unwrap();
        let frequency_hz: Vec<f64> = (1..12).map(|k| 15.0 * f64::from(k)).collect();
        let at = |hz: &f64| {
            let (sin, cos) = libm::sincos(2e-3 * PI * hz);
            let z = C::new(cos, sin);
            sampled.at(z) * z.powi(-1)
        };
        let response = FrequencyResponse {
            response: frequency_hz.iter().map(at).collect(),
            variance: vec![1e-4; 11],
            noise_values: 0,
            coherence: vec![1.0; 11],
            power: vec![1.0; 11],
            periodic: true,
            frequency_hz,
        };
        let points = Points::new(&response, 1e-3).unwrap();
        assert_eq!((points.blocks.len(), points.count), (2, 11));
        assert!(points.blocks[1].weight[3..].iter().all(|w| *w == 0.0));
        assert!(points.earlier(1).gather(&truth, 1e-3).unwrap().total < 1e-18);
        let mut start = truth.clone();
        start.gain = 1.7;
        start.poles = vec![Factor::Pair {
            omega_rad_s: 430.0,
            damping: 0.2,
        }];
        let found = points.refine(&start, STEPS_LAST, 1e-3).unwrap();
        assert_eq!(found.rows, 22);
        assert!((found.transfer.gain - 2.0).abs() < 1e-6, "{found:?}");
        assert!((found.transfer.poles[0].corner_rad_s() - 400.0).abs() < 1e-3);
    }
}
