//! The estimate by instrumental variables: the continuous parameters for which
//! the difference between measured and simulated output has nothing to do with
//! the instruments.
//!
//! The instruments are the sensitivities of the simulated output to the
//! parameters, simulated from the input, or in a closed loop from that part of
//! the input which the excitation causes. For white noise on the output this is
//! the most accurate estimate there is (Young, *Recursive Estimation and
//! Time-Series Analysis*, 2011, "refined instrumental variables"), and the
//! inverse of the instruments' products gives its errors. Coloured noise is
//! made white first, by an autoregressive filter over all signals.
//!
//! Besides the parameters an offset and the state at the first sample are
//! estimated: a recording may begin in the middle of a motion.

use super::charge::charge;
use super::data::{Data, Signals};
use super::descent::{Damping, Descending, Step, descend};
use super::estimate::{Estimate, FRICTION, ROUNDING, criterion};
use super::figure::Figure;
use super::normal::{Normal, Solution};
use super::parameters::{is_admissible, parameters, with};
use super::sensitivity::{differences, gather};
use super::slow_motion::in_band;
use super::transfer::TransferFunction;

const STEPS_MAX: usize = 40;
/// An improvement of the sum of squares below this share of one row's ends the
/// search: far below what noise decides.
const LEAST_GAIN: f64 = 1e-3;
/// The same on the way where a position or speed was measured: friction, which no model
/// has, is explained a little better with each step.
const LEAST_GAIN_INTEGRATED: f64 = 2e-2;

/// Damping of a first step. In positions, most of which is slow, everything but the
/// gain is correlated: less is much there, and the last fit comes from nearby.
const DAMPING: f64 = 1e-4;
const DAMPING_LEAKY: f64 = 1e-7;
const DAMPING_LAST: f64 = 1e-12;

/// A smaller share of the squares before offset and first state are fitted has lost its digits:
/// they are taken off, and what is left is summed up again.
const LOST: f64 = 1e-8;

/// So near to the criterion that is to be beaten, a fit is given this many times
/// the steps.
const CRITERION_MARGIN: f64 = 20.0;
const LONGER: usize = 4;
/// Farther than this many times that, a fit that promises little is given up.
const GIVE_UP_RATIO: f64 = 10.0;

/// How hard a fit is tried.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Steps at most.
    pub steps: usize,
    /// A criterion: after a few steps a model that will not come near it is
    /// given up.
    pub to_beat: f64,
}

impl Effort {
    /// To the end.
    pub const FULL: Self = Self {
        steps: STEPS_MAX,
        to_beat: f64::MAX,
    };
}

/// A signal after the whitening filter, as long as it was; before its first
/// sample there was nothing.
pub fn whitened(x: &[f64], taps: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    for (index, tap) in taps.iter().enumerate() {
        let later = out.get_mut(index + 1..).unwrap_or_default();
        for (sum, x) in later.iter_mut().zip(x) {
            *sum += x * tap;
        }
    }
    for (sum, x) in out.iter_mut().zip(x) {
        *sum += x;
    }
    out
}

/// Sum of squares of what of the output is not slow motion: of a position that is nearly all,
/// and a share of it as large as any mode.
fn swinging(data: &Data<'_>) -> f64 {
    let slow = in_band(data.output, data.period_s);
    let apart = data.output.iter().zip(&slow).map(|(y, slow)| y - slow);
    apart.map(|y| y * y).sum()
}

/// The sum of squares that is left when offset and first state fit best.
fn rest(normal: &Normal, count: usize) -> Option<Solution> {
    (0..4).find_map(|power| {
        let damping = [0.0, 1e-12, 1e-9, 1e-6].get(power).copied()?;
        normal.solve_from(count, damping)
    })
}

/// Fits the parameters of a model, from a start. `whitening` are the taps of
/// the filter that makes the noise white, without the leading 1. `None` when
/// the data do not determine them.
#[must_use]
pub fn refine(
    data: &Data<'_>,
    start: &TransferFunction,
    delay_is_free: bool,
    whitening: &[f64],
    effort: Effort,
) -> Option<Estimate> {
    let fitting = Fitting::new(*data, whitening);
    fitting.settled(fitting.refine(start, delay_is_free, effort)?)
}

/// Fits of models to one recording.
pub struct Fitting<'a> {
    raw: Data<'a>,
    /// What is filtered before and after a model is the same: the signals are
    /// filtered once. Without taps they are what was recorded.
    signals: Option<Signals>,
    taps: &'a [f64],
    /// Sum of squares of the output.
    power: f64,
    /// Which share of it counts as nothing where models are compared.
    floor: f64,
}

impl<'a> Fitting<'a> {
    /// To these signals after the filter of these taps.
    #[must_use]
    pub fn new(raw: Data<'a>, taps: &'a [f64]) -> Self {
        let power: f64 = raw.output.iter().map(|y| y * y).sum();
        let floor = if raw.friction.is_empty() {
            ROUNDING
        } else {
            (FRICTION * swinging(&raw) / power).max(ROUNDING)
        };
        Self {
            signals: (!taps.is_empty()).then(|| Signals::filtered(&raw, |x| whitened(x, taps))),
            power,
            floor,
            raw,
            taps,
        }
    }

    /// Fits a model as [`refine()`] does; what it began with is to be [`settled`]
    /// yet.
    ///
    /// [`settled`]: Self::settled
    #[must_use]
    pub fn refine(
        &self,
        start: &TransferFunction,
        delay_is_free: bool,
        effort: Effort,
    ) -> Option<Estimate> {
        let raw = &self.raw;
        let filtered = self.signals.as_ref().map(|signals| signals.data(raw));
        let data = filtered.as_ref().unwrap_or(raw);
        let left_out = self.taps.len() + data.skip();
        // The search goes down on squares; instruments come at its end.
        let open = Data {
            undisturbed: None,
            ..*data
        };
        let task = Task {
            gather: &|model: &TransferFunction, known: &[f64]| {
                gather(&open, model, delay_is_free, left_out, known)
            },
            delay_is_free,
            period_s: raw.period_s,
            friction: raw.friction.len(),
            floor: self.floor,
            from_command: raw.from_command,
            power: self.power,
            effort,
            damping: Damping {
                now: match effort.steps {
                    _ if raw.leak == 0.0 => DAMPING,
                    STEPS_MAX => DAMPING_LAST,
                    _ => DAMPING_LEAKY,
                },
                least: 1e-12,
                most: 1e6,
            },
            enough: match effort.steps {
                STEPS_MAX => LEAST_GAIN,
                _ if raw.measured.integrators() > 0 && !raw.from_command => LEAST_GAIN_INTEGRATED,
                _ => LEAST_GAIN,
            },
            samples: raw.len(),
        };
        let start = task.place(start.clone(), Vec::new())?;
        let (mut end, steps) = descend(&task, start, task.damping)?;
        if data.undisturbed.is_some() {
            end = instrumental(data, end, delay_is_free, left_out)?;
        }
        task.finish(end, steps)
    }

    /// With offset and first state of the signals as they are.
    #[must_use]
    pub fn settled(&self, mut estimate: Estimate) -> Option<Estimate> {
        if !self.taps.is_empty() {
            let open = Data {
                undisturbed: None,
                ..self.raw
            };
            let delay_is_free = estimate.count > parameters(&estimate.transfer, false).len();
            let normal = gather(
                &open,
                &estimate.transfer,
                delay_is_free,
                self.raw.skip(),
                &[],
            )?;
            (estimate.state, estimate.offset) = nuisance(&rest(&normal, estimate.count)?);
        }
        Some(estimate)
    }
}

/// What is fitted.
struct Task<'a> {
    gather: &'a dyn Fn(&TransferFunction, &[f64]) -> Option<Normal>,
    delay_is_free: bool,
    period_s: f64,
    /// Terms of friction.
    friction: usize,
    /// Which share of the output counts as nothing where models are compared.
    floor: f64,
    from_command: bool,
    /// Sum of squares of the output.
    power: f64,
    samples: usize,
    effort: Effort,
    damping: Damping,
    /// The share of one row's squares below which an improvement ends the search.
    enough: f64,
}

/// Where a search stands.
struct Place {
    transfer: TransferFunction,
    /// What is known of first state, friction and offset: `normal` is of the rest.
    known: Vec<f64>,
    normal: Normal,
    /// The sum of squares with offset and first state at their best.
    least: f64,
}

impl Descending for Task<'_> {
    type Place = Place;

    fn squares(&self, at: &Place) -> f64 {
        at.least
    }

    /// What is near to the criterion that is to be beaten is worth more steps.
    fn goes_on(&self, round: usize, at: &Place) -> bool {
        let Effort { steps, to_beat } = self.effort;
        let is_near = || self.missing(at) <= CRITERION_MARGIN && to_beat != f64::MAX;
        round < steps || (round < LONGER * steps && is_near())
    }

    fn step(&self, round: usize, at: &Place, damping: f64) -> Step<Place> {
        let Some(step) = at.normal.solve_from(0, damping) else {
            return Step::Unsolved;
        };
        // What the step promises, taken as straight: without hope there is no
        // need to look.
        let missing = self.missing(at);
        if (1..4).contains(&round) && missing > GIVE_UP_RATIO * CRITERION_MARGIN {
            let promised = libm::log(at.least / step.rest.max(ROUNDING * self.power));
            if at.normal.rows as f64 * promised < 0.2 * missing {
                return Step::GivenUp;
            }
        }
        let next = moved(&at.transfer, self.delay_is_free, step.x.as_slice());
        let next = is_admissible(&next, self.period_s).then_some(next);
        let known = added(&at.known, step.x.as_slice().get(self.count(&at.transfer)..));
        next.and_then(|next| self.place(next, known))
            .map_or(Step::Nowhere, Step::To)
    }

    fn is_enough(&self, round: usize, before: &Place, after: &Place) -> bool {
        let (least, rows) = (after.least, after.normal.rows as f64);
        let gained = before.least - least;
        if gained <= self.enough * least / rows || least <= ROUNDING * self.power {
            return true;
        }
        // Against what the step brought.
        let brought = rows * gained / least;
        let missing = self.missing(before) - brought;
        let is_slow = |share: f64| missing > CRITERION_MARGIN && brought < share * missing;
        (round >= 4 && is_slow(0.05)) || (round >= 7 && is_slow(0.2))
    }
}

impl Task<'_> {
    fn place(&self, transfer: TransferFunction, mut known: Vec<f64>) -> Option<Place> {
        let count = self.count(&transfer);
        let mut normal = (self.gather)(&transfer, &known)?;
        let mut left = rest(&normal, count)?;
        if left.rest < LOST * normal.total {
            known = added(&known, Some(left.x.as_slice()));
            normal = (self.gather)(&transfer, &known)?;
            left = rest(&normal, count)?;
        }
        Some(Place {
            transfer,
            known,
            normal,
            least: left.rest,
        })
    }

    fn count(&self, transfer: &TransferFunction) -> usize {
        parameters(transfer, self.delay_is_free).len()
    }

    /// How far a place is from the criterion that is to be beaten.
    fn missing(&self, at: &Place) -> f64 {
        let (rows, count) = (at.normal.rows, self.count(&at.transfer));
        let least = self.floor * self.power;
        criterion(at.least, least, rows, count, self.samples) + self.charge(&at.transfer)
            - self.effort.to_beat
    }

    fn charge(&self, transfer: &TransferFunction) -> f64 {
        charge(transfer, self.samples, self.period_s, self.from_command)
    }

    fn finish(&self, at: Place, steps: usize) -> Option<Estimate> {
        let Place {
            transfer,
            known,
            normal,
            ..
        } = at;
        let count = self.count(&transfer);
        let mut left = rest(&normal, count)?;
        for (x, known) in left.x.iter_mut().zip(&known) {
            *x += known;
        }
        let solution = solved(&normal)?;
        let unknowns = count + left.x.len();
        let noise = left.rest / normal.rows.saturating_sub(unknowns).max(1) as f64;
        let (state, offset) = nuisance(&left);
        let terms = state.len().saturating_sub(self.friction)..state.len();
        let friction = terms.filter_map(|index| {
            let at = count + index;
            Some(Figure {
                value: *state.get(index)?,
                std: (solution.inverse[(at, at)] * noise).sqrt(),
            })
        });
        Some(Estimate {
            friction: friction.collect(),
            charge: self.charge(&transfer),
            transfer,
            covariance: solution.inverse.view((0, 0), (count, count)) * noise,
            rest: left.rest,
            rows: normal.rows,
            samples: self.samples,
            power: self.power,
            floor: self.floor,
            count,
            steps,
            offset,
            state,
        })
    }
}

/// All unknowns; a swing that was over at once is left at nil.
fn solved(normal: &Normal) -> Option<Solution> {
    normal.solve().or_else(|| normal.solve_from(0, 1e-12))
}

/// What is known with more of it; nothing is known before the first of it.
fn added(known: &[f64], more: Option<&[f64]>) -> Vec<f64> {
    let known = known.iter().copied().chain(std::iter::repeat(0.0));
    let more = more.unwrap_or_default().iter();
    more.zip(known).map(|(more, known)| more + known).collect()
}

/// Steps that bring the products of instruments and differences to zero.
fn instrumental(
    data: &Data<'_>,
    mut at: Place,
    delay_is_free: bool,
    left_out: usize,
) -> Option<Place> {
    let gathered = |at: &Place| gather(data, &at.transfer, delay_is_free, left_out, &at.known);
    for _ in 0..20 {
        let normal = gathered(&at)?;
        let step = solved(&normal)?;
        let mut size = 1.0;
        let next = loop {
            let part: Vec<f64> = step.x.iter().map(|x| x * size).collect();
            let next = moved(&at.transfer, delay_is_free, &part);
            if is_admissible(&next, data.period_s) {
                break next;
            }
            size *= 0.5;
            if size < 1e-3 {
                return None;
            }
        };
        // In standard errors: what is smaller than a thousandth is nothing.
        let noise = step.rest / normal.rows as f64;
        let far = step
            .x
            .iter()
            .zip(step.inverse.diagonal().iter())
            .map(|(x, d)| x.abs() / (d * noise).sqrt().max(f64::MIN_POSITIVE))
            .take(parameters(&at.transfer, delay_is_free).len())
            .fold(0.0, f64::max);
        at.transfer = next;
        if far < 1e-3 {
            break;
        }
    }
    at.normal = gathered(&at)?;
    Some(at)
}

fn moved(transfer: &TransferFunction, delay_is_free: bool, step: &[f64]) -> TransferFunction {
    let mut theta = parameters(transfer, delay_is_free);
    for (value, step) in theta.iter_mut().zip(step) {
        *value += step;
    }
    with(transfer, &theta)
}

/// First state and offset.
fn nuisance(solution: &Solution) -> (Vec<f64>, f64) {
    match solution.x.as_slice().split_last() {
        Some((offset, state)) => (state.to_vec(), *offset),
        None => (Vec::new(), 0.0),
    }
}

/// Differences between measured and simulated output, offset and first state
/// taken off, after the samples that do not count.
#[must_use]
pub fn residuals(data: &Data<'_>, estimate: &Estimate) -> Option<Vec<f64>> {
    let (transfer, state) = (&estimate.transfer, &estimate.state);
    let mut left = differences(data, transfer, data.skip(), state, estimate.offset)?;
    left.drain(..data.skip().min(left.len()));
    Some(left)
}
