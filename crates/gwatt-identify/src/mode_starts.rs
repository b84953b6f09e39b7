//! Models to start a search from: modes are added one at a time, each where most
//! is left unexplained, while any delay is allowed; then the delays that go with
//! these modes are distinguished.

use super::candidate_models::{Given, LAG_MAX, ORDER_MAX};
use super::modal::{Late, Modes};
use super::spectral_lines::Lines;
use super::transfer::{Factor, TransferFunction};

/// Dampings of modes that are tried.
const DAMPINGS: [f64; 4] = [0.01, 0.05, 0.2, 0.8];
/// Steps of the fit of each of them, and of the best one.
const STEPS: usize = 5;
const STEPS_BEST: usize = 12;
/// Delays that are followed to the end: what modes beyond the band make late looks
/// like a longer one.
const LAGS: usize = 3;
/// Models that are passed on.
const KEPT: usize = 4;

/// The steps of delays that are tried, in periods. A force is held from sample to
/// sample; a command may be, or may run on between them, half a period apart.
#[must_use]
pub fn delay_step(from_command: bool) -> f64 {
    if from_command { 0.5 } else { 1.0 }
}

/// Models that explain the recording well, some with zeros left out that lie
/// beyond the band.
#[must_use]
pub fn starts(lines: &Lines, given: Given) -> Vec<TransferFunction> {
    let t = lines.period_s;
    let step = delay_step(lines.from_command);
    let late = |steps: usize| {
        let periods = steps as f64 * step;
        let lag = libm::floor(periods);
        Late {
            lag: lag as usize,
            part: periods - lag,
        }
    };
    let mut found: Vec<(f64, Modes)> = Vec::new();
    if let Some(delay_s) = given.delay_s {
        let steps = libm::round(delay_s / t / step).min(LAG_MAX as f64 / step);
        if let Some(rigid) = lines.at(&[], late(steps as usize), 1) {
            found.extend(grow(lines, rigid, given.order));
        }
    } else {
        // Free taps of the input stand for any delay, and for what is fast.
        let Some(any) = lines.at(&[], late(0), LAG_MAX + 1) else {
            return Vec::new();
        };
        let any = best(grow(lines, any, given.order));
        let poles = any.as_ref().map_or(&[][..], |modes| &modes.poles);
        let at = |steps: usize| lines.at(poles, late(steps), 1);
        let most = (LAG_MAX as f64 / step) as usize;
        let first = libm::ceil(lines.early_s / t / step - 1e-6) as usize;
        let last = (first..=most)
            .filter_map(|steps| Some((at(steps)?.rest, steps)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let last = last.map_or(first, |(_, steps)| steps);
        for steps in (first..=last).rev().take(LAGS) {
            if let Some(modes) = at(steps) {
                let modes = lines.move_poles(modes, STEPS_BEST);
                found.extend(grow(lines, modes, given.order));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
        .iter()
        .take(KEPT)
        .filter_map(|(_, modes)| lines.transfer(modes))
        .flat_map(|model| without_far_zeros(&model))
        .map(|model| TransferFunction {
            delay_s: given.delay_s.unwrap_or(model.delay_s),
            ..model
        })
        .collect()
}

fn best(found: Vec<(f64, Modes)>) -> Option<Modes> {
    let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, modes)| modes)
}

fn order(modes: &Modes) -> usize {
    modes.poles.iter().map(|pole| pole.degree()).sum()
}

/// Models of growing order with their criterion, as long as it is better, or up to
/// a given order.
fn grow(lines: &Lines, start: Modes, given: Option<usize>) -> Vec<(f64, Modes)> {
    let mut now = start;
    let mut grown = vec![(lines.criterion_of(&now), now.clone())];
    while order(&now) + 2 <= given.unwrap_or(ORDER_MAX) {
        let next = lines
            .missing(&now, &DAMPINGS)
            .into_iter()
            .filter_map(|pole| {
                let modes = lines.with(&now, pole)?;
                Some(lines.move_poles(modes, STEPS))
            })
            .min_by(|a, b| a.rest.total_cmp(&b.rest));
        let Some(next) = next else { break };
        now = lines.move_poles(next, STEPS_BEST);
        let criterion = lines.criterion_of(&now);
        let is_better = grown.last().is_none_or(|(least, _)| criterion < *least);
        if given.is_none() && !is_better {
            break;
        }
        grown.push((criterion, now.clone()));
    }
    if let Some(given) = given {
        if order(&now) + 1 == given {
            let lag = Factor::Real {
                time_constant_s: 3.0 * lines.period_s,
            };
            let more = lines.with(&now, lag);
            let more = more.map(|modes| lines.move_poles(modes, STEPS_BEST));
            grown.extend(more.map(|modes| (lines.criterion_of(&modes), modes)));
        }
        grown.retain(|(_, modes)| order(modes) == given);
    }
    grown
}

/// A model, and the same with one after another of its farthest zeros left out, as
/// long as they do not swing.
fn without_far_zeros(model: &TransferFunction) -> Vec<TransferFunction> {
    let mut out = vec![model.clone()];
    let mut less = model.clone();
    less.zeros
        .sort_by(|a, b| a.corner_rad_s().total_cmp(&b.corner_rad_s()));
    while let Some(zero) = less.zeros.pop() {
        let swings = matches!(zero, Factor::Pair { damping, .. } if damping.abs() < 0.5);
        if swings || out.len() > 2 {
            break;
        }
        out.push(less.clone());
    }
    out
}
