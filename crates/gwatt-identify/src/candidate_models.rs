//! Models that differ a little from one that was found: where a search goes on.

use std::f64::consts::PI;

use super::mode::with_mode;
use super::spectrum::FrequencyResponse;
use super::transfer::{Factor, TransferFunction};

/// Poles at most.
pub const ORDER_MAX: usize = 8;
/// No mode is looked for beyond, rad per period.
pub const FAST: f64 = 0.9 * std::f64::consts::PI;
/// Periods of delay that are tried.
pub const LAG_MAX: usize = 12;
/// How far above the fastest mode another one is looked for at first.
const ABOVE: [f64; 3] = [2.5, 4.0, 1.5];

/// What is given instead of searched for.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given {
    /// Number of poles.
    pub order: Option<usize>,
    /// Number of zeros.
    pub zeros: Option<usize>,
    /// Delay, s.
    pub delay_s: Option<f64>,
}

/// True for models of one shape from which a fit comes to the same end.
#[must_use]
pub fn are_alike(a: &TransferFunction, b: &TransferFunction) -> bool {
    const SAME_SHARE: f64 = 0.01;
    let factors = |x: &TransferFunction| -> Vec<Factor> {
        let all = x.zeros.iter().chain(&x.poles);
        all.copied().collect()
    };
    let same = |a: &Factor, b: &Factor| match (*a, *b) {
        (
            Factor::Pair {
                omega_rad_s,
                damping,
            },
            Factor::Pair {
                omega_rad_s: other,
                damping: than,
            },
        ) => {
            (omega_rad_s / other - 1.0).abs() < SAME_SHARE
                && (damping - than).abs() < SAME_SHARE * damping.abs().max(0.02)
        }
        (
            Factor::Real { time_constant_s },
            Factor::Real {
                time_constant_s: other,
            },
        ) => (time_constant_s / other - 1.0).abs() < 10.0 * SAME_SHARE,
        _ => false,
    };
    let (left, right) = (factors(a), factors(b));
    a.delay_s == b.delay_s
        && a.zeros.len() == b.zeros.len()
        && left.len() == right.len()
        && left.iter().zip(&right).all(|(a, b)| same(a, b))
}

/// Models that differ from one by a zero, a pair of zeros, a mode, or a step of
/// delay.
#[must_use]
pub fn neighbours(
    from: &TransferFunction,
    response: &FrequencyResponse,
    given: Given,
    period_s: f64,
    step_s: f64,
) -> Vec<TransferFunction> {
    let far_zero = far_zero(period_s);
    let mut out = reflected(from, given, period_s);
    out.extend(as_delay(from, given, period_s));
    if given.order.is_none() {
        out.extend(cancelled(from, CANCELLED_SHARE));
        out.extend(without_mode(from, far_zero, true));
        let lean = lean(from, response.band_rad_s());
        if lean.order() < from.order() {
            for less in with_lag_of(&lean, from, given, period_s) {
                if less.zero_count() < less.order() {
                    let mut more = less.clone();
                    more.zeros.push(far_zero);
                    out.push(more);
                }
                out.push(less);
            }
        }
    }
    let mut shapes = vec![from.clone()];
    if from.zero_count() < from.order() {
        let mut more = from.clone();
        more.zeros.push(far_zero);
        shapes.push(more);
    }
    for index in 0..from.zeros.len() {
        let mut less = from.clone();
        less.zeros.remove(index);
        shapes.push(less.clone());
        less.zeros.push(far_zero);
        shapes.push(less);
    }
    out.extend(shapes.iter().skip(1).cloned());
    if given.delay_s.is_none() {
        for shape in &shapes {
            let mut sooner = shape.clone();
            sooner.delay_s -= step_s;
            if sooner.delay_s > -0.5 * step_s {
                sooner.delay_s = sooner.delay_s.max(0.0);
                out.push(sooner);
            }
        }
        for shape in &shapes {
            let mut later = shape.clone();
            later.delay_s += step_s;
            out.push(later);
        }
    }
    if given.order.is_none() {
        if from.order() + 2 <= ORDER_MAX {
            out.extend(with_mode(from, response, period_s));
        }
        out.extend(without_mode(from, far_zero, false));
        if from.order() < ORDER_MAX {
            let mut lagging = from.clone();
            lagging.poles.push(lag_pole(period_s));
            out.extend(with_lag_of(&lagging, from, given, period_s));
        }
    }
    if let Some(zeros) = given.zeros {
        out.retain(|model| model.zero_count() == zeros);
    }
    out
}

/// A pole and a zero so near, as a share, may stand for nothing next to one another.
pub const CANCELLED_SHARE: f64 = 0.2;

/// Without a pole and a zero that are as near to each other as that; real ones of a pair one by
/// one.
#[must_use]
pub fn cancelled(from: &TransferFunction, near: f64) -> Vec<TransferFunction> {
    let mut out = without_near(from, near);
    let apart = from.apart();
    if apart.poles.len() + apart.zeros.len() > from.poles.len() + from.zeros.len() {
        out.extend(without_near(&apart, near));
    }
    out
}

fn without_near(from: &TransferFunction, near: f64) -> Vec<TransferFunction> {
    let mut out = Vec::new();
    for (index, pole) in from.poles.iter().enumerate() {
        let is_near = |zero: &Factor| {
            let apart = libm::log(zero.corner_rad_s() / pole.corner_rad_s());
            zero.degree() == pole.degree() && apart.abs() < near
        };
        if let Some(at) = from.zeros.iter().position(is_near) {
            let mut less = from.clone();
            less.poles.remove(index);
            less.zeros.remove(at);
            out.push(less);
        }
    }
    out
}

/// A model with the whole periods of delay that make it as late as another one:
/// the nearest number, and the next.
fn with_lag_of(
    model: &TransferFunction,
    other: &TransferFunction,
    given: Given,
    period_s: f64,
) -> Vec<TransferFunction> {
    if given.delay_s.is_some() {
        return vec![model.clone()];
    }
    let missing = other.lag_s() - model.lag_s() + model.delay_s;
    let periods = (missing / period_s).clamp(0.0, LAG_MAX as f64);
    let near = libm::round(periods);
    let next = if periods < near {
        near - 1.0
    } else {
        near + 1.0
    };
    [near, next]
        .into_iter()
        .map(|periods| TransferFunction {
            delay_s: periods * period_s,
            ..model.clone()
        })
        .collect()
}

/// Zeros on the right stand for a delay, as poles that do not swing may: without
/// one of them, and with the zero where it makes early what it made late.
fn as_delay(from: &TransferFunction, given: Given, period_s: f64) -> Vec<TransferFunction> {
    let mut out = Vec::new();
    for (index, zero) in from.zeros.iter().enumerate() {
        if zero.lag_s() >= 0.0 || zero.oscillates() {
            continue;
        }
        let mut less = from.clone();
        less.zeros.remove(index);
        out.extend(with_lag_of(&less, from, given, period_s));
        let mut mirrored = from.clone();
        if let Some(zero) = mirrored.zeros.get_mut(index) {
            match zero {
                Factor::Pair { damping, .. } => *damping = -*damping,
                Factor::Real { time_constant_s } => *time_constant_s = -*time_constant_s,
            }
        }
        out.extend(with_lag_of(&mirrored, from, given, period_s));
    }
    out
}

/// Dampers make a real zero far above the band: seldom seen in the response, but
/// not nothing.
fn far_zero(period_s: f64) -> Factor {
    Factor::Real {
        time_constant_s: 0.1 * period_s,
    }
}

/// What filters and current loops make: a lag of its own, soon over.
fn lag_pole(period_s: f64) -> Factor {
    Factor::Real {
        time_constant_s: 0.5 * period_s,
    }
}

/// Zeros that swing come from what is connected to the load, and that is damped: where
/// they came out undamped, the same ones damped, with less delay.
fn reflected(from: &TransferFunction, given: Given, period_s: f64) -> Vec<TransferFunction> {
    let mut damped = from.clone();
    let mut is_other = false;
    for zero in &mut damped.zeros {
        if zero.oscillates()
            && let Factor::Pair { damping, .. } = zero
            && *damping < 0.0
        {
            *damping = -*damping;
            is_other = true;
        }
    }
    if !is_other {
        return Vec::new();
    }
    let sooner = if given.delay_s.is_none() { 3 } else { 1 };
    (0..sooner)
        .map(|periods| from.delay_s - f64::from(periods) * period_s)
        .filter(|delay_s| *delay_s >= 0.0)
        .map(|delay_s| TransferFunction {
            delay_s,
            ..damped.clone()
        })
        .collect()
}

/// What swings of a model, up to where it shows: the rest often stands for nothing
/// but noise.
pub fn lean(from: &TransferFunction, band_rad_s: f64) -> TransferFunction {
    const BEYOND: f64 = 1.2;
    let swings = |factor: &&Factor| {
        matches!(factor, Factor::Pair { damping, omega_rad_s }
            if damping.abs() < 0.7 && *omega_rad_s < BEYOND * band_rad_s)
    };
    let poles: Vec<Factor> = from.poles.iter().filter(swings).copied().collect();
    let order = 2 * poles.len();
    let mut zeros: Vec<Factor> = from.zeros.iter().filter(swings).copied().collect();
    zeros.truncate(order / 2);
    TransferFunction {
        zeros,
        poles,
        ..from.clone()
    }
}

/// A pole and a zero no farther apart, as a share, are one.
pub const ONE: f64 = 0.02;

/// Models with less of what may stand for noise or for a part of a period of delay:
/// without what is slower than `slow_rad_s` or undoes itself, and with nothing but what
/// swings.
#[must_use]
pub fn simpler(
    from: &TransferFunction,
    band_rad_s: f64,
    slow_rad_s: f64,
    given: Given,
    period_s: f64,
) -> Vec<TransferFunction> {
    if given.order.is_some() || given.zeros.is_some() {
        return Vec::new();
    }
    let fast = |list: &[Factor]| -> Vec<Factor> {
        let each = list.iter().flat_map(|factor| factor.apart());
        each.filter(|factor| factor.corner_rad_s() > slow_rad_s)
            .collect()
    };
    let mut quick = TransferFunction {
        zeros: fast(&from.zeros),
        poles: fast(&from.poles),
        ..from.clone()
    };
    while let Some(less) = cancelled(&quick, ONE).into_iter().next() {
        quick = less;
    }
    let is_less = |less: &&TransferFunction| {
        less.order() < from.order() || less.zero_count() < from.zero_count()
    };
    let lean = [band_rad_s, f64::INFINITY].map(|band| lean(&quick, band));
    let lean = lean
        .iter()
        .filter(is_less)
        .flat_map(|lean| with_lag_of(lean, &quick, given, period_s));
    let mut out: Vec<TransferFunction> = Vec::new();
    for less in std::iter::once(quick.clone()).chain(lean) {
        let is_new = !are_alike(&less, from) && !out.iter().any(|other| are_alike(other, &less));
        if is_new && less.zero_count() <= less.order() {
            out.push(as_strong(less, from, slow_rad_s, band_rad_s));
        }
    }
    out
}

/// A model with the gain that brings it nearest to another one between two frequencies:
/// what is left out of a model counts up to the highest ones.
fn as_strong(
    mut model: TransferFunction,
    other: &TransferFunction,
    from_rad_s: f64,
    to_rad_s: f64,
) -> TransferFunction {
    const POINTS: i32 = 30;
    let bare = |model: &TransferFunction, hz: f64| {
        let bare = TransferFunction {
            delay_s: 0.0,
            ..model.clone()
        };
        bare.at_hz(hz)
    };
    let (mut product, mut square) = (0.0, 0.0);
    for point in 0..=POINTS {
        let share = f64::from(point) / f64::from(POINTS);
        let hz = from_rad_s * libm::pow(to_rad_s / from_rad_s, share) / (2.0 * PI);
        let (have, want) = (bare(&model, hz), bare(other, hz));
        product += (have.conj() * want).re;
        square += have.norm_sqr();
    }
    let times = product / square;
    if times.is_finite() && times != 0.0 {
        model.gain *= times;
    }
    model
}

/// Where no neighbour is better: the slowest of what swings, with one faster mode
/// placed again, by the response or well above. Outside the band of the excitation
/// a mode may have gone astray.
#[must_use]
pub fn restarts(
    from: &TransferFunction,
    response: &FrequencyResponse,
    given: Given,
    period_s: f64,
) -> Vec<TransferFunction> {
    if given.order.is_some() || given.zeros.is_some() {
        return Vec::new();
    }
    let lean = lean(from, response.band_rad_s());
    (1..=lean.poles.len())
        .rev()
        .flat_map(|count| {
            let mut slow = lean.clone();
            for list in [&mut slow.zeros, &mut slow.poles] {
                list.sort_by(|a, b| a.corner_rad_s().total_cmp(&b.corner_rad_s()));
                list.truncate(count);
            }
            let mut starts = Vec::new();
            for above in ABOVE {
                let mut stiff = slow.clone();
                let fastest = slow.poles.last().map(|pole| pole.corner_rad_s());
                if fastest.is_some_and(|omega| above * omega * period_s > FAST) {
                    continue;
                }
                stiff.poles.extend(fastest.map(|omega| Factor::Pair {
                    omega_rad_s: above * omega,
                    damping: 0.3,
                }));
                for mut stiff in with_lag_of(&stiff, from, given, period_s) {
                    starts.push(stiff.clone());
                    stiff.zeros.push(far_zero(period_s));
                    starts.push(stiff);
                }
                stiff.poles.push(lag_pole(period_s));
                starts.extend(with_lag_of(&stiff, from, given, period_s));
            }
            starts.extend(with_mode(&slow, response, period_s));
            starts
        })
        .collect()
}

/// Without the fastest pole, or without one of the others, and without none or one
/// of the zeros: the nearest first.
fn without_mode(from: &TransferFunction, far_zero: Factor, fastest: bool) -> Vec<TransferFunction> {
    let mut out = Vec::new();
    let corners = || from.poles.iter().map(|pole| pole.corner_rad_s());
    let most = corners().fold(0.0, f64::max);
    for (at, pole) in from.poles.iter().enumerate() {
        if (pole.corner_rad_s() == most) != fastest {
            continue;
        }
        let distance = |zero: &Factor| libm::log(zero.corner_rad_s() / pole.corner_rad_s()).abs();
        let mut less = from.clone();
        less.poles.remove(at);
        let mut zeros: Vec<(f64, usize)> = less
            .zeros
            .iter()
            .enumerate()
            .filter(|(_, zero)| zero.degree() == pole.degree())
            .map(|(index, zero)| (distance(zero), index))
            .collect();
        zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut shapes: Vec<TransferFunction> = zeros
            .iter()
            .map(|(_, index)| {
                let mut lesser = less.clone();
                lesser.zeros.remove(*index);
                lesser
            })
            .collect();
        shapes.push(less);
        for shape in shapes {
            if shape.zero_count() < shape.order() {
                let mut more = shape.clone();
                more.zeros.push(far_zero);
                out.push(more);
            }
            if shape.zero_count() <= shape.order() {
                out.push(shape);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is slow, what undoes itself and what does not swing are left out, and the
    /// gain becomes that of what is left: of fast motion it is as strong as before.
    #[test]
    fn what_may_stand_for_noise_is_left_out() {
        let pair = |omega_rad_s, damping| Factor::Pair {
            omega_rad_s,
            damping,
        };
        let lean = TransferFunction {
            gain: 40.0,
            zeros: vec![pair(250.0, 0.03)],
            poles: vec![pair(340.0, 0.04)],
            delay_s: 1e-3,
        };
        let mut from = lean.clone();
        from.zeros.extend([pair(5.0, 0.1), pair(1200.0, 0.2)]);
        from.poles
            .extend([pair(6.0, 0.05), pair(1205.0, 0.2), pair(900.0, 1.5)]);
        // (6/5)² below what is left out.
        from.gain = 40.0 * 25.0 / 36.0;
        let less = simpler(&from, 1000.0, 15.0, Given::default(), 1e-3);
        let quick = less.first().unwrap();
        assert_eq!((quick.zero_count(), quick.order()), (2, 4));
        assert!((quick.gain / 40.0 - 1.0).abs() < 0.01, "{}", quick.gain);
        // Poles that only make late: a delay of 3/900 s, in whole periods.
        let delays: Vec<f64> = less
            .iter()
            .filter(|less| less.order() == 2)
            .map(|less| libm::round(less.delay_s * 1e3))
            .collect();
        assert_eq!(delays, [4.0, 5.0]);
        let fixed = Given {
            order: Some(6),
            ..Given::default()
        };
        assert!(simpler(&from, 1000.0, 15.0, fixed, 1e-3).is_empty());
        assert!(simpler(&lean, 1000.0, 15.0, Given::default(), 1e-3).is_empty());
    }
}
