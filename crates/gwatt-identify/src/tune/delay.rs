//! Whether the axes answer at the same time, and what makes them.
//!
//! A slow command comes late by the dead time and by `2ζ/ω` of each pole, early
//! by that of each zero. The zeros are evened out by the filters; what is left,
//! dead time and poles, must be the same for all axes: on a circle a difference
//! Δτ alone makes an ellipse, `v·Δτ` out of round.

use super::axis::AxisResponse;
use crate::certainty;
use crate::transfer::Factor;

/// Delays that differ by less are the same: at 3 m/min they make 1 µm.
pub const DELAY_TOLERANCE_S: f64 = 2e-5;

/// The delay of an axis, and what makes it that of the slowest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advice {
    /// Delay of dead time and poles, s.
    pub delay_s: f64,
    /// Its standard error, s; not finite where it has none: the figure is then exact.
    pub delay_std_s: f64,
    /// Whether it differs from that of the slowest by more than [`DELAY_TOLERANCE_S`] and
    /// by more than two standard errors.
    pub is_earlier: bool,
    /// By which its command has to be delayed, s; 0 where it is not clearly earlier.
    pub command_delay_s: f64,
    /// Or the gain of its position loop: 1/s where the present one is known,
    /// else by which factor it has to be changed.
    pub gain: Option<Gain>,
}

/// A gain of the position loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gain {
    /// In 1/s.
    Absolute(f64),
    /// Times the present one, where the loop makes the whole delay.
    Factor(f64),
}

/// Delays and advice by axis. `None` where an axis was recorded from force, and
/// the gain of its position loop is not given: its delay is not known.
#[must_use]
pub fn advice(axes: &[AxisResponse]) -> Option<Vec<Advice>> {
    let delays: Option<Vec<f64>> = axes.iter().map(delay_s).collect();
    let delays = delays?;
    // Of the slowest axis that is known well: one that is not says nothing about others.
    let std = |axis: &AxisResponse| {
        let std = axis.lateness_std_s;
        if axis.from_command && std.is_finite() {
            std
        } else {
            0.0
        }
    };
    let is_known =
        |axis: &AxisResponse, delay: f64| std(axis) * certainty::DELAY_ADVICE <= delay.abs();
    let each = || axes.iter().zip(&delays);
    let (slowest, slowest_std) = each()
        .filter(|(axis, delay)| is_known(axis, **delay))
        .map(|(axis, delay)| (*delay, std(axis)))
        .fold(
            (0.0, 0.0),
            |most, next| if next.0 > most.0 { next } else { most },
        );
    let advice = each().map(|(axis, &delay_s)| {
        let apart_s = slowest - delay_s;
        let is_earlier = is_known(axis, delay_s)
            && apart_s > DELAY_TOLERANCE_S
            && apart_s > certainty::DELAY_ADVICE * libm::hypot(std(axis), slowest_std);
        let command_delay_s = if is_earlier { apart_s } else { 0.0 };
        Advice {
            delay_s,
            delay_std_s: if axis.from_command {
                axis.lateness_std_s
            } else {
                f64::NAN
            },
            is_earlier,
            command_delay_s,
            gain: match axis.position_gain_1_s {
                // 1/Kv of the delay is the loop's own.
                Some(gain) => Some(Gain::Absolute(1.0 / (command_delay_s + 1.0 / gain))),
                None if is_earlier && delay_s > 0.0 => Some(Gain::Factor(delay_s / slowest)),
                None => None,
            },
        }
    });
    Some(advice.collect())
}

fn delay_s(axis: &AxisResponse) -> Option<f64> {
    if !axis.from_command && axis.position_gain_1_s.is_none() {
        return None;
    }
    let follows = axis.follows();
    let poles: f64 = follows.poles.iter().map(|pole| pole.lag_s()).sum();
    // Zeros that are not evened out count too.
    let evened = axis.zero_factors();
    let zeros: f64 = follows
        .zeros
        .iter()
        .filter(|zero| !evened.contains(zero))
        .map(|zero: &Factor| zero.lag_s())
        .sum();
    Some(follows.delay_s + poles - zeros)
}

/// Whether the delays are the same, for circles of some µm, or as far as they are known.
#[must_use]
pub fn delays_agree(advice: &[Advice]) -> bool {
    !advice.iter().any(|axis| axis.is_earlier)
}
