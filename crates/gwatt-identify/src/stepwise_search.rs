//! From models to start with, step by step to neighbours that explain the recording
//! better, until there is none.

use super::candidate_models::{Given, are_alike, neighbours, restarts};
use super::certainty;
use super::estimate::Estimate;
use super::output_error::{Effort, Fitting};
use super::parameters::parameters;
use super::spectrum::FrequencyResponse;
use super::transfer::{Factor, TransferFunction};

/// Models of different kinds that are gone on with.
const KEPT: usize = 5;
/// A model better by less is the same one.
const WORTH: f64 = 0.5;
/// Steps of each fit on the way.
pub const SEARCH_STEPS: usize = 20;
/// Steps that are left for what comes next.
pub const STEPS_LAST: usize = 200;
/// Steps from model to model at most.
const ROUNDS_MAX: usize = 12;

/// The best of models, one of each kind, the very best first.
pub fn best_of(mut found: Vec<Estimate>) -> impl Iterator<Item = Estimate> {
    found.sort_by(|a, b| a.criterion().total_cmp(&b.criterion()));
    let mut kept: Vec<Estimate> = Vec::new();
    for found in found {
        let is_known = kept
            .iter()
            .any(|other| is_of_kind(&found.transfer, &other.transfer));
        if !is_known && kept.len() < KEPT {
            kept.push(found);
        }
    }
    kept.into_iter()
}

/// True for models with as many zeros and poles at about the same places, and with
/// the same delay.
fn is_of_kind(a: &TransferFunction, b: &TransferFunction) -> bool {
    const SAME_CORNER: f64 = 0.2;
    let corners = |list: &[Factor]| -> Vec<f64> {
        let mut corners: Vec<f64> = list.iter().map(|x| x.corner_rad_s()).collect();
        corners.sort_by(f64::total_cmp);
        corners
    };
    let are_near = |a: &[Factor], b: &[Factor]| {
        let (a, b) = (corners(a), corners(b));
        let apart = |(a, b): (&f64, &f64)| libm::log(a / b).abs() < SAME_CORNER;
        a.len() == b.len() && a.iter().zip(&b).all(apart)
    };
    a.delay_s == b.delay_s && are_near(&a.zeros, &b.zeros) && are_near(&a.poles, &b.poles)
}

/// When a search places modes again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Restart {
    /// At first: where the first model is taken from, what shows is mostly right, and
    /// the rest not.
    First,
    /// Where no neighbour is better.
    WhereStuck,
    /// Not for a model that was searched for before, unless a neighbour is better.
    Unless,
}

/// How far a search goes.
#[derive(Debug, Clone, Copy)]
pub struct Reach {
    /// Steps of all fits at most, besides those of the starts.
    pub steps: usize,
    /// Steps to spare for what comes next, to leave a wrong path.
    pub spare: usize,
    /// Where what is placed again is looked at besides neighbours.
    pub restart: Restart,
}

/// A search from model to model.
pub struct Ladder<'a> {
    /// Fits models to what is compared.
    pub fitting: &'a Fitting<'a>,
    /// The shortest delay, and the steps of delays, s.
    pub early_s: f64,
    pub step_s: f64,
    /// Sampling period, s.
    pub period_s: f64,
    /// Where modes are looked for.
    pub response: &'a FrequencyResponse,
    /// What is not searched for.
    pub given: Given,
}

impl Ladder<'_> {
    fn is_possible(&self, start: &TransferFunction) -> bool {
        start.delay_s > self.early_s - 1e-6 * self.period_s
    }

    /// The starts, fitted. Those of which the first one was searched for before are
    /// given up where they do not come near the best of them.
    #[must_use]
    pub fn fitted(&self, starts: &[TransferFunction], is_known: bool) -> Vec<Estimate> {
        let mut all: Vec<Estimate> = Vec::new();
        let mut least = f64::MAX;
        for start in starts.iter().filter(|start| self.is_possible(start)) {
            let effort = Effort {
                steps: SEARCH_STEPS,
                to_beat: if is_known { least } else { f64::MAX },
            };
            if let Some(found) = self.fitting.refine(start, false, effort) {
                least = least.min(found.criterion());
                all.push(found);
            }
        }
        all
    }

    /// All models that were tried on the way from the best of these to what no
    /// neighbour is better than.
    #[must_use]
    pub fn climb(&self, mut all: Vec<Estimate>, reach: Reach) -> Vec<Estimate> {
        let (mut left, mut spare) = (reach.steps, reach.spare);
        let best = all.iter().reduce(|best, found| {
            if is_better(found, Some(best)) {
                found
            } else {
                best
            }
        });
        let Some(mut best) = best.cloned() else {
            return all;
        };
        let mut is_restarted = reach.restart == Restart::First;
        let mut idle = usize::from(reach.restart == Restart::Unless);
        let mut tried = vec![best.transfer.clone()];
        for _ in 0..ROUNDS_MAX {
            let mut top: Option<Estimate> = None;
            let needed = needed(&best, self.response.band_rad_s());
            let next = if is_restarted {
                restarts(&best.transfer, self.response, self.given, self.period_s)
            } else {
                neighbours(
                    &best.transfer,
                    self.response,
                    self.given,
                    self.period_s,
                    self.step_s,
                )
            };
            for start in next {
                if left == 0 {
                    break;
                }
                // What explains all is explained no better by more.
                let is_more = best.is_exact() && parameters(&start, false).len() > best.count;
                if is_more
                    || tried.iter().any(|other| are_alike(other, &start))
                    || lacks(&start, &needed)
                    || !self.is_possible(&start)
                {
                    continue;
                }
                tried.push(start.clone());
                let effort = Effort {
                    steps: SEARCH_STEPS,
                    to_beat: top.as_ref().unwrap_or(&best).criterion(),
                };
                let found = self.fitting.refine(&start, false, effort);
                left = left.saturating_sub(found.as_ref().map_or(1, |found| found.steps));
                if let Some(found) = found {
                    all.push(found.clone());
                    if is_better(&found, top.as_ref()) {
                        let is_clear = found.criterion() < best.criterion() - certainty::MODEL;
                        top = Some(found);
                        if is_clear {
                            break;
                        }
                    }
                }
            }
            // Something is left for what comes next, to leave a wrong path.
            let more = STEPS_LAST.saturating_sub(left).min(spare);
            left += more;
            spare -= more;
            let before = best.criterion();
            if let Some(top) = top.filter(|top| is_better(top, Some(&best))) {
                tried.push(top.transfer.clone());
                best = top;
            }
            if best.criterion() < before - WORTH {
                is_restarted = false;
                idle = 0;
            } else if idle == 1 {
                break;
            } else {
                is_restarted = !is_restarted;
                idle = 1;
            }
        }
        all
    }
}

/// Zeros and poles that ring and are known well: without one of them no model fits as well.
/// One that another one nearly cancels is not, nor one beyond the band, which may
/// stand for noise.
fn needed(found: &Estimate, band_rad_s: f64) -> Vec<(bool, Factor)> {
    const KNOWN: f64 = 0.05;
    const BEYOND: f64 = 1.2;
    const CANCELS: f64 = 0.05;
    let model = &found.transfer;
    let others = |is_zero: bool| {
        let others = if is_zero { &model.poles } else { &model.zeros };
        others.iter().filter(|other| other.degree() == 2)
    };
    let is_near =
        |a: &Factor, b: &Factor| libm::log(a.corner_rad_s() / b.corner_rad_s()).abs() < CANCELS;
    let mut at = 1;
    let mut out = Vec::new();
    for (index, factor) in model.zeros.iter().chain(&model.poles).enumerate() {
        if let Factor::Pair { damping, .. } = factor
            && damping.abs() < 0.25
            && factor.corner_rad_s() < BEYOND * band_rad_s
            && !others(index < model.zeros.len()).any(|other| is_near(other, factor))
            && found.std(at).is_some_and(|std| std < KNOWN)
            && found.std(at + 1).is_some_and(|std| std < KNOWN)
        {
            out.push((index < model.zeros.len(), *factor));
        }
        at += factor.degree();
    }
    out
}

/// True for a model that has nothing near to one of those.
fn lacks(model: &TransferFunction, needed: &[(bool, Factor)]) -> bool {
    const SAME_CORNER: f64 = 0.3;
    needed.iter().any(|(is_zero, factor)| {
        let have = if *is_zero { &model.zeros } else { &model.poles };
        !have.iter().any(|other| {
            let apart = libm::log(other.corner_rad_s() / factor.corner_rad_s());
            other.degree() == factor.degree() && apart.abs() < SAME_CORNER
        })
    })
}

fn is_better(found: &Estimate, than: Option<&Estimate>) -> bool {
    than.is_none_or(|than| found.criterion() < than.criterion())
}
