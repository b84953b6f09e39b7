//! Correction filters: each axis' command through the zeros of all the others.
//!
//! With the loops alike, axis n answers `N_n(s)·H(s)`, its own zeros times what
//! all have in common. After the filter `F(s)·Π N_m(s)`, m over the *other*
//! axes, every axis answers `F·H·Π N`: the path is no longer distorted. F is a
//! low-pass, the same for all, of at least the degree of the largest numerator,
//! or else the filter would not be causal.

use std::f64::consts::PI;

use nalgebra::Complex;

use super::biquad::{Biquad, response};
use super::discretize::{Discretization, discretize};
use super::effort::Effort;
use super::low_pass::LowPass;
use crate::error::{IdentifyError, Outcome};
use crate::transfer::{Factor, TransferFunction};

/// Share of the sampling rate that zeros and the low-pass stay below: nearer to
/// half of it nothing is represented well.
const SHARE_MAX: f64 = 0.4;
/// The low-pass lies so far above the highest zero where nothing is given: its
/// delay is then short, and what it lets through of noise and of corners is no
/// more than the square of this for each zero.
const ABOVE_ZEROS: f64 = 3.0;
/// With several zeros in a filter it lies lower: as long as that helps, the largest gain
/// is at most this (26 dB), but it stays above this share of what it would be.
const GAIN_MAX: f64 = 20.0;
const LOWEST: f64 = 0.1;
const HALVINGS: usize = 20;
/// Orders that can be asked for.
const ORDER_MAX: usize = 24;

/// What may be chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Sampling period of the filters, s.
    pub period_s: f64,
    /// How they become digital.
    pub discretization: Discretization,
    /// F = 1.
    pub no_low_pass: bool,
    /// Order of F; else the least that is causal.
    pub order: Option<usize>,
    /// Bandwidth of F; else by the zeros.
    pub bandwidth_hz: Option<f64>,
}

/// The filter of one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Filter {
    /// Zeros of the other axes.
    pub numerator: Vec<Factor>,
    /// As it is put into the controller; none for 1.
    pub sections: Vec<Biquad>,
}

/// The filters of all axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    /// F.
    pub low_pass: LowPass,
    /// How the filters became digital.
    pub discretization: Discretization,
    /// Their sampling period, s.
    pub period_s: f64,
    /// By axis, in the order in which they were given.
    pub filters: Vec<Filter>,
}

/// Designs the filters for the zeros of each axis; rigid axes have none.
///
/// # Errors
///
/// What cannot be realised: too slow a period, a filter that is not causal or
/// not stable.
pub fn design(zeros: &[(char, Vec<Factor>)], wish: &Wish) -> Outcome<Correction> {
    let rate_hz = 1.0 / wish.period_s;
    if !(wish.period_s > 0.0 && rate_hz.is_finite()) {
        return Err(IdentifyError::new(
            "the period of the filters is not positive",
            "give the period of the controller's interpolation, such as --period-ms 1",
        ));
    }
    for (letter, own) in zeros {
        for zero in own {
            sound_zero(*letter, *zero, rate_hz)?;
        }
    }
    let others = |index: usize| -> Vec<Factor> {
        let rest = zeros.iter().enumerate().filter(|(m, _)| *m != index);
        rest.flat_map(|(_, (_, own))| own.iter().copied()).collect()
    };
    let numerators: Vec<Vec<Factor>> = (0..zeros.len()).map(others).collect();
    let degree = |p: &[Factor]| p.iter().map(|zero| zero.degree()).sum::<usize>();
    let needed = numerators.iter().map(|p| degree(p)).max().unwrap_or(0);
    let widest = low_pass(zeros, wish, needed)?;
    let with = |low_pass: LowPass| -> Outcome<Correction> {
        let filters = numerators
            .iter()
            .zip(zeros)
            .map(|(numerator, (letter, _))| filter(numerator, needed, low_pass, wish, *letter));
        Ok(Correction {
            low_pass,
            discretization: wish.discretization,
            period_s: wish.period_s,
            filters: filters.collect::<Outcome<Vec<_>>>()?,
        })
    };
    let found = with(widest);
    match widest {
        LowPass::Butterworth {
            order,
            bandwidth_hz,
        } if wish.bandwidth_hz.is_none() => Ok(calmer(found?, order, bandwidth_hz, with)),
        _ => found,
    }
}

fn filter(
    numerator: &[Factor],
    needed: usize,
    low_pass: LowPass,
    wish: &Wish,
    letter: char,
) -> Outcome<Filter> {
    let sections = if needed == 0 {
        Vec::new()
    } else {
        discretize(
            numerator,
            needed,
            low_pass,
            wish.discretization,
            wish.period_s,
        )
        .filter(|sections| sections.iter().all(Biquad::is_stable))
        .ok_or_else(|| {
            IdentifyError::new(
                format!("the filter of axis {letter} would not be stable"),
                "lower --low-pass-hz, or shorten --period-ms",
            )
        })?
    };
    Ok(Filter {
        numerator: numerator.to_vec(),
        sections,
    })
}

/// Filters whose low-pass is as low as their largest gain asks: what is common to all axes
/// leaves them as alike as they are.
fn calmer(
    widest: Correction,
    order: usize,
    widest_hz: f64,
    with: impl Fn(LowPass) -> Outcome<Correction>,
) -> Correction {
    let gain = |found: &Correction| {
        let efforts = found.filters.iter();
        let gains = efforts.map(|f| Effort::of(&f.sections, found.period_s, 0.0).gain);
        gains.fold(1.0, f64::max)
    };
    if gain(&widest) <= GAIN_MAX {
        return widest;
    }
    let mut best = widest;
    let (mut low, mut high) = (LOWEST * widest_hz, widest_hz);
    for _ in 0..HALVINGS {
        let bandwidth_hz = (low * high).sqrt();
        let low_pass = LowPass::Butterworth {
            order,
            bandwidth_hz,
        };
        let found = with(low_pass).ok();
        let gained = found.as_ref().map_or(f64::INFINITY, gain);
        if let Some(found) = found.filter(|_| gained < gain(&best) || gained <= GAIN_MAX) {
            best = found;
        }
        if gained <= GAIN_MAX {
            low = bandwidth_hz;
        } else {
            high = bandwidth_hz;
        }
    }
    best
}

fn sound_zero(letter: char, zero: Factor, rate_hz: f64) -> Outcome<()> {
    let hz = zero.corner_rad_s() / (2.0 * PI);
    let is_pair = matches!(zero, Factor::Pair { damping, .. } if damping.abs() < 1.0);
    if !(is_pair && hz.is_finite() && hz > 0.0) {
        return Err(IdentifyError::new(
            format!("axis {letter}: a zero that does not oscillate cannot be evened out"),
            "give zeros as frequency_hz, above 0, and damping, between -1 and 1",
        ));
    }
    if hz > SHARE_MAX * rate_hz {
        return Err(IdentifyError::new(
            format!(
                "axis {letter}: the zero at {hz:.1} Hz is too fast for filters at {rate_hz:.0} Hz"
            ),
            format!(
                "shorten --period-ms to {:.3} or less, or leave the zero out",
                1e3 * SHARE_MAX / hz
            ),
        ));
    }
    Ok(())
}

fn low_pass(zeros: &[(char, Vec<Factor>)], wish: &Wish, needed: usize) -> Outcome<LowPass> {
    let rate_hz = 1.0 / wish.period_s;
    if wish.no_low_pass {
        if wish.discretization != Discretization::Matched && needed > 0 {
            return Err(IdentifyError::new(
                format!(
                    "without a low-pass the filters are not causal as {} makes them",
                    wish.discretization.name()
                ),
                "leave --discretize at matched, or the low-pass in",
            ));
        }
        return Ok(LowPass::None);
    }
    if needed == 0 {
        return Ok(LowPass::None);
    }
    // Held, what passes directly is half a period ahead of the rest: nothing may.
    let spare = if wish.discretization == Discretization::Hold {
        2
    } else {
        0
    };
    let order = wish.order.unwrap_or(needed + spare);
    if order < needed {
        return Err(IdentifyError::new(
            format!(
                "a low-pass of order {order} under a numerator of order {needed}: the filter would not be causal"
            ),
            format!("give --low-pass-order {needed} or more"),
        ));
    }
    if order > ORDER_MAX {
        return Err(IdentifyError::new(
            format!("a low-pass of order {order}: at most {ORDER_MAX} can be had"),
            "give a lower --low-pass-order, or fewer zeros",
        ));
    }
    let highest = zeros
        .iter()
        .flat_map(|(_, own)| own)
        .map(|zero| zero.corner_rad_s() / (2.0 * PI))
        .fold(0.0, f64::max);
    let bandwidth_hz = wish
        .bandwidth_hz
        .unwrap_or_else(|| (ABOVE_ZEROS * highest).min(SHARE_MAX * rate_hz));
    if !(bandwidth_hz > 0.0 && bandwidth_hz <= SHARE_MAX * rate_hz * (1.0 + 1e-9)) {
        return Err(IdentifyError::new(
            format!("a low-pass of {bandwidth_hz} Hz cannot be had at {rate_hz:.0} Hz"),
            format!(
                "give --low-pass-hz between 0 and {:.1}, or shorten --period-ms",
                SHARE_MAX * rate_hz
            ),
        ));
    }
    Ok(LowPass::Butterworth {
        order,
        bandwidth_hz,
    })
}

impl Correction {
    /// The response of an axis' digital filter.
    #[must_use]
    pub fn at_hz(&self, axis: usize, frequency_hz: f64) -> Complex<f64> {
        self.filters.get(axis).map_or(Complex::new(1.0, 0.0), |f| {
            response(&f.sections, frequency_hz, self.period_s)
        })
    }

    /// What the filter of an axis asks for, where the command's acceleration rises in
    /// `rise_s`.
    #[must_use]
    pub fn effort(&self, axis: usize, rise_s: f64) -> Effort {
        let sections = self.filters.get(axis).map(|f| f.sections.as_slice());
        Effort::of(sections.unwrap_or_default(), self.period_s, rise_s)
    }

    /// The filter of an axis in continuous time; not proper without a low-pass.
    #[must_use]
    pub fn continuous(&self, axis: usize) -> TransferFunction {
        TransferFunction {
            gain: 1.0,
            zeros: self
                .filters
                .get(axis)
                .map(|filter| filter.numerator.clone())
                .unwrap_or_default(),
            poles: self.low_pass.poles(),
            delay_s: 0.0,
        }
    }

    /// How late the filters make a slow command, s, the same for all axes: their
    /// low-pass, and what it takes to be causal. What the other axes' zeros take
    /// off is counted apart, as the axis' own zeros take the rest off.
    #[must_use]
    pub fn delay_s(&self) -> f64 {
        const SLOW: f64 = 1e-4;
        let Some(filter) = self.filters.first() else {
            return 0.0;
        };
        let slow_hz = SLOW / self.period_s;
        let slow = self.at_hz(0, slow_hz);
        let lead_s: f64 = filter.numerator.iter().map(|zero| zero.lag_s()).sum();
        lead_s - libm::atan2(slow.im, slow.re) / (2.0 * PI * slow_hz)
    }
}
