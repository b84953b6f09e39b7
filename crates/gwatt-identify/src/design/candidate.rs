//! Signals that are compared: their shapes, made for an axis.

use std::fmt;

use super::known::Known;
use super::line_power::line_powers;
use super::multisine::{Above, from_rest, multisine};
use crate::error::{IdentifyError, Outcome};
use crate::excitation::{Excitation, Shape, make};
use crate::transfer::Factor;

/// What a signal is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A multisine with its power where the figures of the axis need it.
    Shaped {
        /// From, Hz.
        from_hz: f64,
        /// To, Hz.
        to_hz: f64,
        /// For an acceleration of one size, not for a force of one: what resonates is
        /// excited less.
        quiet: bool,
    },
    /// A multisine with the same power at all its frequencies.
    Flat {
        /// From, Hz.
        from_hz: f64,
        /// To, Hz.
        to_hz: f64,
    },
    /// A maximum-length sequence.
    MSequence {
        /// Length of the register.
        order: u32,
        /// Samples that each step is held.
        hold: usize,
        /// How often it is repeated.
        repetitions: usize,
    },
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shaped {
                from_hz,
                to_hz,
                quiet,
            } => {
                let quiet = if *quiet { ", quiet at resonances" } else { "" };
                write!(f, "shaped multisine{quiet}, {from_hz:.3} to {to_hz:.1} Hz")
            }
            Self::Flat { from_hz, to_hz } => {
                write!(f, "flat multisine, {from_hz:.3} to {to_hz:.1} Hz")
            }
            Self::MSequence {
                order,
                hold,
                repetitions,
            } => write!(
                f,
                "M-sequence of order {order}, held {hold}, {repetitions} times"
            ),
        }
    }
}

/// Share of the sampling rate up to which multisines go.
const HIGHEST: f64 = 0.4;
/// They end so far above the highest zero, or root.
const ABOVE: f64 = 1.1;
const WELL_ABOVE: f64 = 1.5;
/// The lowest frequency where nothing asks for another, and how many periods of it there
/// are at least.
const LOWEST_HZ: f64 = 1.0;
const PERIODS: f64 = 2.0;
/// Steps of a sequence are held for so many periods of a zero.
const HELD: f64 = 1.5;
/// Steps between lowest frequencies that are tried.
const OCTAVES: i32 = 8;

fn hz(factor: &Factor) -> f64 {
    factor.corner_rad_s() / std::f64::consts::TAU
}

/// The lowest frequencies that may be tried for a signal of so many seconds: the first
/// one, and octaves above it, up to half of the lowest root.
pub(super) fn lowest_hz(known: &Known, seconds: f64) -> Vec<f64> {
    let first = LOWEST_HZ.max(PERIODS / seconds);
    let lowest_root = known
        .roots
        .iter()
        .map(|(factor, _)| hz(factor))
        .fold(0.1 / known.period_s, f64::min);
    let octaves = (0..OCTAVES).map(|k| first * libm::exp2(f64::from(k)));
    octaves
        .enumerate()
        .filter(|(k, f)| *k == 0 || *f <= 0.5 * lowest_root)
        .map(|(_, f)| f)
        .collect()
}

/// The signals that are compared, from a lowest frequency on.
pub(super) fn kinds(known: &Known, from_hz: f64, seconds: f64) -> Vec<Kind> {
    let limit = HIGHEST / known.period_s;
    let zeros = || {
        let all = known.roots.iter().map(|(factor, _)| factor);
        all.filter(|factor| known.transfer.zeros.contains(factor))
    };
    let highest_zero = zeros().map(hz).fold(0.0, f64::max);
    let highest = known.roots.iter().map(|(f, _)| hz(f)).fold(0.0, f64::max);
    let mut kinds = Vec::new();
    let mut ends: Vec<f64> = [ABOVE * highest_zero, ABOVE * highest, limit]
        .into_iter()
        .filter(|end| *end > 2.0 * from_hz && *end <= limit)
        .collect();
    ends.dedup();
    if highest > 0.0 {
        let to_hz = (WELL_ABOVE * highest).min(limit);
        if to_hz > from_hz {
            kinds.extend([false, true].map(|quiet| Kind::Shaped {
                from_hz,
                to_hz,
                quiet,
            }));
        }
    }
    kinds.extend(ends.into_iter().map(|to_hz| Kind::Flat { from_hz, to_hz }));
    let held = zeros().map(|zero| libm::round(HELD / hz(zero) / known.period_s) as usize);
    let mut holds: Vec<usize> = std::iter::once(1).chain(held).collect();
    holds.sort_unstable();
    holds.dedup();
    kinds.extend(holds.into_iter().filter_map(|hold| {
        let steps = seconds / known.period_s / hold.max(1) as f64;
        let order = (3..=20)
            .rev()
            .find(|order| f64::from((1_u32 << order) - 1) <= steps * (1.0 + 1e-9))?;
        let repetitions = (steps / f64::from((1_u32 << order) - 1)) as usize;
        Some(Kind::MSequence {
            order,
            hold,
            repetitions: repetitions.max(1),
        })
    }));
    kinds
}

/// A signal of this kind.
pub(super) fn made(kind: Kind, known: &Known, amplitude: f64, seconds: f64) -> Outcome<Excitation> {
    let t = known.period_s;
    let (from_hz, to_hz, shaped) = match kind {
        Kind::MSequence {
            order,
            hold,
            repetitions,
        } => {
            let shape = Shape::MSequence {
                order,
                hold,
                repetitions,
            };
            return make(shape, amplitude, t);
        }
        Kind::Shaped {
            from_hz,
            to_hz,
            quiet,
        } => (from_hz, to_hz, Some(quiet)),
        Kind::Flat { from_hz, to_hz } => (from_hz, to_hz, None),
    };
    // A length that Fourier transforms like.
    let count = libm::round(seconds / t) as usize / 40 * 40;
    let step_hz = 1.0 / (count.max(1) as f64 * t);
    let first = libm::ceil(from_hz / step_hz - 1e-9).max(1.0) as usize;
    let last = (libm::floor(to_hz / step_hz + 1e-9) as usize).min(count.saturating_sub(1) / 2);
    let lines: Vec<f64> = (first..=last).map(|bin| bin as f64 * step_hz).collect();
    let powers = match shaped {
        Some(quiet) => line_powers(known, &lines, quiet),
        None => Some(vec![1.0; lines.len()]),
    };
    let signal = powers.and_then(|powers| {
        let mut amplitudes = vec![0.0; first];
        amplitudes.extend(powers.iter().map(|p| p.max(0.0).sqrt()));
        // What is to stay quiet may have a resonance there.
        let above = match shaped {
            Some(false) => Above::Free,
            _ => Above::Still,
        };
        multisine(&amplitudes, count, above)
    });
    let mut values = signal.ok_or_else(|| {
        IdentifyError::new(
            format!("{kind} does not determine the axis in {seconds} s"),
            "give more --seconds",
        )
    })?;
    from_rest(&mut values);
    for x in &mut values {
        *x *= amplitude;
    }
    let square: f64 = values.iter().map(|x| x * x).sum();
    Ok(Excitation {
        peak: amplitude,
        rms: (square / values.len().max(1) as f64).sqrt(),
        values,
        period_s: t,
        band_hz: (from_hz, to_hz),
        resolution_hz: step_hz,
    })
}
